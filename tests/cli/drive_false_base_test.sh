#!/bin/bash
# A base that is not what it says, in real time: dead encoders, and motors that no order reaches.
source "$(dirname "$0")/lib.sh"

drive= stranger=
clean_up() { for it in $emulator $drive $stranger; do kill $it 2>/dev/null; done; }

small_scenario small.yaml
robot=$source/robots/pioneer_urg.yaml

# Encoders that die on the way and stay dead: scans show that the robot moves; it is stopped, and nobody lets it go.
# shellcheck disable=SC2046
start_emulator small.yaml $(printf -- "--fault base-encoders@%s " $(seq 9 3 60))
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --time-limit 50 --out blind --set safety.give_up_s=5 >out.txt 2>err.txt
code=$?
stop_emulator
[[ $code == 4 ]] || fail "a drive whose encoders are dead ends with $code: $(tail -3 err.txt)"
grep -q "^rubble: base: encoders and scans disagree: its wheels report that they stand, scans show " err.txt && grep -q "see to its encoders" err.txt ||
  fail "dead encoders are not named: $(cat err.txt)"
tail -n 1 err.txt | grep -q "encoders and scans disagree.*; nobody has let it go" || fail "the end does not say why: $(tail -3 err.txt)"
[[ -s blind/score.json && ! -e blind/.partial ]] || fail "the folder of a drive whose encoders died is not complete"

# A base that no order to stop reaches and that somebody else drives on, whatever else is in trouble: the end says so.
# shellcheck disable=SC2046
start_emulator small.yaml $(printf -- "--fault levelling-sensor@%s " $(seq 6 0.9 40))
python3 "$source/tests/cli/disobedient_line.py" "$(sed -n 's/^base tcp://p' emulator.txt)" >line.txt &
stranger=$!
for _ in $(seq 100); do
  grep -q '^port' line.txt && break
  sleep 0.1
done
ports=$(sed "s#--base [^ ]*#--base tcp:127.0.0.1:$(sed -n 's/^port //p' line.txt)#" <<<"$ports")
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --out driven_on >out.txt 2>err.txt &
drive=$!
for _ in $(seq 300); do
  grep -q 'gives no signal' err.txt && break
  sleep 0.1
done
kill -USR1 $stranger
sleep 0.3
kill -INT $drive
wait $drive
[[ $? == 130 ]] || fail "a drive whose base does not hear ends otherwise: $(tail -3 err.txt)"
drive=
kill $stranger
wait $stranger 2>/dev/null
stranger=
stop_emulator
grep -q "^rubble: base: its motors stay on though switched off" err.txt || fail "the end is silent about a base that does not stop: $(tail -5 err.txt)"
finish
