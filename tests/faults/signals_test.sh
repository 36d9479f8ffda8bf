#!/usr/bin/env bash
# Ctrl-C, a polite kill and a closed terminal at many moments, and a second Ctrl-C: 130 with a whole folder, or,
# before the work has begun, 130 with one line and none.
. "$(dirname "$0")/lib.sh"
fault_scenario s.yaml 4000

# strike_amid SIGNAL DELAY SIGN COMMAND...: starts the command, waits until the command SIGN prints something and DELAY
# seconds more, stops the program, looks again, and lets it go on to the signal. $amid: whether SIGN still printed then.
strike_amid() {
  local signal=$1 delay=$2 sign=$3 pid state
  shift 3
  "$@" >struck.out 2>struck.err &
  pid=$!
  listens $pid
  while [[ -z $($sign 2>/dev/null) ]] && kill -0 $pid 2>/dev/null; do :; done
  [[ $delay == 0 ]] || sleep "$delay"
  kill -STOP $pid 2>/dev/null
  for _ in $(seq 1000); do  # T: stopped, Z: over
    state=$(ps -o stat= -p $pid)
    [[ -n $state && $state != [TZ]* ]] || break
  done
  amid=
  [[ $state != T* ]] || amid=$($sign 2>/dev/null)
  kill -"$signal" $pid 2>/dev/null
  kill -CONT $pid 2>/dev/null
  wait $pid
  code=$?
  struck=$((struck + 1))
}

for signal in INT TERM HUP; do
  for i in $(seq "$moments"); do
    rm -rf run
    strike "$i" "$signal" "$rubble" run s.yaml --out run
    case $code in
      0) [[ -s run/score.json && ! -e run/.partial ]] || fail "SIG$signal at moment $i: ended with $code, but no whole folder" ;;
      129 | 143 | 130) # before the program has taken the signal over, on the spot, or with a whole folder
        if [[ $code != 130 || $(<struck.err) == "rubble: interrupted" || ! -e run ]]; then
          [[ ! -e run ]] || fail "SIG$signal at moment $i: ended with $code on the spot and left a folder"
        else
          [[ -s run/score.json && ! -e run/.partial ]] || fail "SIG$signal at moment $i: ended with $code, but no whole folder"
        fi ;;
      *) fail "SIG$signal at moment $i: ended with $code: $(head -c 300 struck.err)" ;;
    esac
    [[ $(wc -l <struck.err) -le 1 ]] || fail "SIG$signal at moment $i: more than one line: $(head -c 300 struck.err)"
  done
  # At least one strike hits work that is under way.
  for _ in $(seq 20); do
    rm -rf run
    strike_amid "$signal" 0 "ls run/.partial" "$rubble" run s.yaml --out run
    [[ $code != 130 || ! -s run/score.json ]] || break
  done
  [[ $code == 130 && -s run/score.json && ! -e run/.partial ]] || fail "no SIG$signal ended a run under way: $code"
  grep -q '"end_code": "interrupted"' run/score.json || fail "SIG$signal: $(grep end_code run/score.json)"
  tail -1 run/decisions.txt | grep -q ' ends: interrupted$' || fail "SIG$signal: $(tail -1 run/decisions.txt)"
done
for i in $(seq "$moments"); do
  rm -rf run
  "$rubble" run s.yaml --out run >struck.out 2>struck.err &
  pid=$!
  sleep 0.5
  kill -INT $pid 2>/dev/null
  sleep "$(awk -v n="$i" 'BEGIN { printf "%.3f", 0.01 * (n % 20) }')"
  kill -INT $pid 2>/dev/null
  wait $pid
  code=$?
  struck=$((struck + 1))
  [[ $code == 130 || $code == 0 ]] || fail "a second SIGINT ended with $code: $(head -c 300 struck.err)"
done
# A scheduler or a service manager ends a batch with its workers, all at once: no run counts as failed by that, and the same
# command goes on.
printf 'name: b\nscenarios: [s.yaml]\nseeds: 1-4\n' >sweep.yaml
for signal in INT TERM HUP; do
  rm -rf batch
  for i in $(seq "$moments"); do
    setsid "$rubble" batch sweep.yaml --out batch --workers 2 >struck.out 2>struck.err &
    pid=$!
    listens $pid
    sleep "$(awk -v n="$i" -v m="$moments" 'BEGIN { printf "%.3f", 0.8 * n / m }')"
    kill -"$signal" -- -$pid 2>/dev/null
    wait $pid
    code=$?
    struck=$((struck + 1))
    [[ $code == 0 || $code == 130 ]] || fail "SIG$signal to a batch and its workers ended with $code: $(head -c 300 struck.out struck.err)"
    ! grep -qs '"status":"failed"' batch/results.jsonl || fail "SIG$signal to a batch and its workers: $(grep -o '"error":"[^"]*"' batch/results.jsonl | tail -n 1)"
  done
done
# Short work that writes one large file ends on the spot: the older file stays as it was, and nothing lies beside it.
"$rubble" run s.yaml --set time_limit_s=400 --out long >/dev/null || fail "a run to export ended with $?"
mkdir exported
"$rubble" export long exported/run.rawlog >/dev/null || fail "export ended with $?"
cp exported/run.rawlog whole.rawlog
# strike_export SIGNAL DELAY: into its writing, which $mid_write counts, or after its end.
strike_export() {
  strike_amid "$1" "$2" "find exported -name *.part -size +0" "$rubble" export long exported/run.rawlog
  if [[ -n $amid ]]; then
    mid_write=$((mid_write + 1))
    [[ $code == 130 ]] || fail "SIG$1 to export that writes ended with $code: $(head -c 300 struck.err)"
  fi
  [[ $code == 0 || $code == 130 ]] || fail "SIG$1 to export ended with $code: $(head -c 300 struck.err)"
  [[ $(ls exported) == run.rawlog ]] || { fail "SIG$1 to export leaves: $(ls exported)"; rm -f exported/*.part; }
  cmp -s exported/run.rawlog whole.rawlog || fail "SIG$1 to export cut the file"
}
for signal in INT TERM HUP; do
  mid_write=0
  for i in $(seq "$moments"); do
    strike_export "$signal" "$(awk -v n="$i" 'BEGIN { printf "%.3f", 0.02 * (n % 10) }')"
  done
  for _ in $(seq 20); do
    ((mid_write == 0)) && strike_export "$signal" 0
  done
  ((mid_write > 0)) || fail "no SIG$signal found export at its writing"
done

# A pipe for errors that nobody reads, which is full, as a terminal that is held by Ctrl-S: who ends work that is not asked
# twice does not wait for it.
mkfifo held
exec 7<>held
python3 - <<'PY'
import os
os.set_blocking(7, False)
try:
    while True:
        os.write(7, b"." * 4096)
except BlockingIOError:
    os.set_blocking(7, True)
PY
for i in $(seq "$moments"); do
  "$rubble" arena generate --cells 50x50 --force --out generated >struck.out 2>&7 7>&- &
  pid=$!
  listens $pid
  sleep "$(awk -v n="$i" 'BEGIN { printf "%.3f", 0.02 * (n % 20) }')"
  kill -INT $pid 2>/dev/null
  for tenth in $(seq 200); do
    kill -0 $pid 2>/dev/null && [[ $(ps -o stat= -p $pid) != Z* ]] || break
    sleep 0.1
  done
  ((tenth < 200)) || { fail "SIGINT beside a full pipe for errors: still there after 20 s"; kill -9 $pid; }
  wait $pid 2>/dev/null
  code=$?
  struck=$((struck + 1))
  [[ $code == 130 || $code == 0 || $code == 137 ]] || fail "SIGINT beside a full pipe for errors ended with $code"
done
exec 7>&-
finish_faults
