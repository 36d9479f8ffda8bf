#!/usr/bin/env bash
# Ctrl-C, a polite kill and a closed terminal at many moments, and a second Ctrl-C: 130 with a whole folder, or,
# before the work has begun, 130 with one line and none.
. "$(dirname "$0")/lib.sh"
fault_scenario s.yaml 4000
for signal in INT TERM HUP; do
  for i in $(seq "$moments"); do
    rm -rf run
    strike "$i" "$signal" "$rubble" run s.yaml --out run
    case $code in
      0) [[ -s run/score.json && ! -e run/.partial ]] || fail "SIG$signal at moment $i: ended with $code, but no whole folder" ;;
      129 | 143 | 130) # before the program has taken the signal over, on the spot, or with a whole folder
        if [[ $code != 130 || $(<struck.err) == "rubble: interrupted" || ! -e run ]]; then
          [[ ! -s run/score.json ]] || fail "SIG$signal at moment $i: ended with $code behind its end"
        else
          [[ -s run/score.json && ! -e run/.partial ]] || fail "SIG$signal at moment $i: ended with $code, but no whole folder"
        fi ;;
      *) fail "SIG$signal at moment $i: ended with $code: $(head -c 300 struck.err)" ;;
    esac
    [[ $(wc -l <struck.err) -le 1 ]] || fail "SIG$signal at moment $i: more than one line: $(head -c 300 struck.err)"
  done
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
finish_faults
