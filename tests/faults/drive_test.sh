#!/usr/bin/env bash
# kill -9 at many moments of a drive: the base stops by itself, what was written stays readable, the next drive finds all
# devices again.
. "$(dirname "$0")/lib.sh"
trap '[[ -z $emulator ]] || kill "$emulator" 2>/dev/null; rm -rf "$work"' EXIT
small_scenario s.yaml
robot=$source/robots/pioneer_urg.yaml
longest=8  # [s]: the start, the look round and the first metres
start_emulator s.yaml --truth truth.tum

# Seconds until the robot has stood for one, by its truth; 'never' after 12 s.
standstill() {
  python3 - <<'PY'
import time
start = time.monotonic()
while time.monotonic() < start + 12:
    rows = [line.split() for line in open("truth.tum").read().splitlines()[-400:]]
    rows = [tuple(map(float, row)) for row in rows if len(row) == 8]
    last = [row for row in rows if row[0] > rows[-1][0] - 1.0] if rows else []
    span = lambda i: max(row[i] for row in last) - min(row[i] for row in last)
    if last and last[-1][0] - last[0][0] > 0.9 and span(1) < 0.002 and span(2) < 0.002 and span(6) < 0.002:
        print("%.1f" % (time.monotonic() - start))
        break
    time.sleep(0.1)
else:
    print("never")
PY
}

# One line and exit code 3, or success: nothing in between.
whole_or_told() {
  "$@" >out.txt 2>err.txt
  local got=$?
  [[ $got == 0 || ($got == 3 && $(wc -l <err.txt) == 1) ]] || fail "'$*' ended with $got: $(head -c 300 err.txt)"
}

moved=0
for i in $(seq "$moments"); do
  rm -rf killed
  # shellcheck disable=SC2086
  "$rubble" drive "$robot" $ports --out killed >struck.out 2>struck.err </dev/null &
  pid=$!
  sleep "$(awk -v n="$i" -v m="$moments" -v s=$longest 'BEGIN { printf "%.3f", 0.02 + s * n / m }')"
  kill -KILL $pid 2>/dev/null
  wait $pid 2>/dev/null
  struck=$((struck + 1))
  grep -q 'motors on' struck.err && moved=$((moved + 1))
  [[ $(standstill) != never ]] || fail "moment $i: the robot goes on without its drive"
  [[ ! -e killed/log.rlog ]] || whole_or_told "$rubble" export killed/log.rlog read.rawlog
  [[ ! -e killed/devices.bytes ]] || whole_or_told "$rubble" replay --raw killed
done
((moved > 0)) || fail "no drive had its motors on: nothing was tested"
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --time-limit 15 --set explorer.return_home=false --out after >out.txt 2>err.txt </dev/null ||
  fail "the drive after the kills ended with $?: $(tail -3 err.txt)"
[[ -s after/score.json && ! -e after/.partial ]] || fail "the drive after the kills leaves no whole folder"
"$rubble" replay after >replay.txt || fail "the drive after the kills does not replay: $(tail -1 replay.txt)"
stop_emulator
finish_faults
