#!/usr/bin/env bash
# kill -9 at many moments of a drive: the base stops by itself, what was written stays readable, the next drive finds all
# devices again.
. "$(dirname "$0")/lib.sh"
clean_up() { [[ -z $emulator ]] || kill "$emulator" 2>/dev/null; }
small_scenario s.yaml
robot=$source/robots/pioneer_urg.yaml
longest=8  # [s]: the start, the look round and the first metres
start_emulator s.yaml --truth truth.tum

# watch MOMENT: says how fast the robot was in the last 0.3 s by its truth, and after how many seconds it had stood for one
# ('never' after 12 s). Positions and turns count; a robot that stood already has nothing to stop.
watch() {
  python3 - <<'PY'
import math
import time


def rows():
    lines = [line.split() for line in open("truth.tum").read().splitlines()[-400:]]
    return [tuple(map(float, line)) for line in lines if len(line) == 8]


def span(of, i):
    return max(row[i] for row in of) - min(row[i] for row in of)


def last(of, seconds):
    return [row for row in of if row[0] > of[-1][0] - seconds] if of else []


def moves(of):  # by x and y [m] and half the sine of the heading
    return bool(of) and max(span(of, 1), span(of, 2), span(of, 6)) >= 0.002


start = time.monotonic()
before = moves(last(rows(), 0.3))
stopped = "never"
while time.monotonic() < start + 12:
    second = last(rows(), 1.0)
    if second and second[-1][0] - second[0][0] > 0.9 and not moves(second):
        stopped = "%.1f" % (time.monotonic() - start)
        break
    time.sleep(0.1)
print("moved" if before else "stood", stopped)
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
  read -r way stopped < <(watch)
  # Only who moved can be seen to stop; the others' folders are read all the same.
  [[ $way != moved ]] || moved=$((moved + 1))
  [[ $stopped != never ]] || fail "moment $i: the robot goes on without its drive"
  [[ ! -e killed/log.rlog ]] || whole_or_told "$rubble" export killed/log.rlog read.rawlog
  [[ ! -e killed/devices.bytes ]] || whole_or_told "$rubble" replay --raw killed
done
echo "moments: $struck, the robot moved at $moved of them and stopped by itself"
# Most moments are of motion; with fewer than a quarter little would be tested.
((4 * moved >= moments)) || fail "the robot moved at $moved of $moments moments only"
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --time-limit 15 --set explorer.return_home=false --out after >out.txt 2>err.txt </dev/null ||
  fail "the drive after the kills ended with $?: $(tail -3 err.txt)"
[[ -s after/score.json && ! -e after/.partial ]] || fail "the drive after the kills leaves no whole folder"
"$rubble" replay after >replay.txt || fail "the drive after the kills does not replay: $(tail -1 replay.txt)"
stop_emulator
finish_faults
