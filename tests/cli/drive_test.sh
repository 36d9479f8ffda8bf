#!/bin/bash
# A robot in real time: 'rubble emulate' plays its devices, 'rubble drive' maps with it as with a real one.
source "$(dirname "$0")/lib.sh"

drive=
clean_up() { for it in $emulator $drive; do kill $it 2>/dev/null; done; }

small_scenario small.yaml
robot=$source/robots/pioneer_urg.yaml

# Bad words and files: one line, and the documented exit codes.
expect_exit 2 "no device is asked for" "$rubble" emulate small.yaml
expect_exit 2 "there is no fault 'base-fire'" "$rubble" emulate small.yaml --base tcp:127.0.0.1:0 --fault base-fire@3
expect_exit 2 "NAME@SECONDS" "$rubble" emulate small.yaml --base tcp:127.0.0.1:0 --fault base-silence
expect_exit 2 "that device is not played" "$rubble" emulate small.yaml --base tcp:127.0.0.1:0 --fault urg-silence@3
expect_exit 3 "flat_room: is an arena, and what is played is a scenario" "$rubble" emulate flat_room --base tcp:127.0.0.1:0
expect_exit 2 "give --base too" "$rubble" emulate small.yaml --urg tcp:127.0.0.1:0 --as-hardware
for start in inf,0,0 0,nan,0 0,0,1e300; do
  expect_exit 2 "--odometry-start" "$rubble" emulate small.yaml --base tcp:127.0.0.1:0 --time-limit 1 --odometry-start $start
done
expect_exit 3 "did you mean" "$rubble" drive "$robot" --set safety.lidar_silense_s=1
expect_exit 3 "tcp:nowhere" "$rubble" drive "$robot" --urg tcp:nowhere
for device in urg base levelling; do
  expect_exit 3 "--$device: port 'tcp:127.0.0.1:': '' is no port number" "$rubble" drive "$robot" --$device tcp:127.0.0.1:
  expect_exit 2 "--$device: needs a value, and '' is none" "$rubble" drive "$robot" --$device ""
  expect_exit 3 "--$device: port 'tcp:127.0.0.1:0': nobody can be reached at port number 0" "$rubble" drive "$robot" --$device tcp:127.0.0.1:0
  expect_exit 2 "--$device: needs a value, and --set is an option" "$rubble" drive "$robot" --$device --set safety.start_s=1
done
expect_exit 3 "devices.urg and devices.base have the same port '/dev/ttyUSB0'" "$rubble" drive "$robot" --urg /dev/ttyUSB0
expect_exit 4 "tcp:127.0.0.1:18940: leads to a device that another port of this robot names as well" \
  "$rubble" drive "$robot" --urg tcp:localhost:18940 --base tcp:127.0.0.1:18940 --levelling none --out same
# A reason that takes the place of the first one at once is told too.
"$rubble" drive "$robot" --urg pty:no1 --base tcp:127.0.0.1:9 --levelling none --set safety.start_s=8 --out reason >/dev/null 2>err.txt
grep -q "^rubble: base: .*nobody answers (Connection refused)" err.txt ||
  fail "why a device is missing is not told before the end: $(cat err.txt)"
[[ $(grep -cE "^rubble: waits for .*base.*; Ctrl-C ends; to try without hardware: rubble emulate" err.txt) == 1 ]] ||
  fail "what is waited for, and what else to try, is not told once: $(cat err.txt)"
expect_exit 3 "nonsense.yaml" "$rubble" drive nonsense.yaml
# A time that is all needed for the way home is legal, and said.
"$rubble" drive "$robot" --urg pty:no1 --base pty:no2 --levelling pty:no3 --set safety.start_s=1 --time-limit 12 --out hasty >out.txt 2>err.txt </dev/null
[[ $? == 4 ]] && grep -qF "all of the 12 s are kept for the way home" err.txt || fail "too short a time is not said: $(cat err.txt)"
[[ $(grep -c "no terminal, so no key stops the robot; 'kill -USR1 [0-9]*' does, and --heartbeat" err.txt) == 1 ]] ||
  fail "that no key stops it is not said: $(cat err.txt)"

# Nobody there: exit 4, and the device is named.
mkdir -p runs/before && ln -s before runs/latest
"$rubble" drive "$robot" --urg pty:no1 --base pty:no2 --levelling pty:no3 --set safety.start_s=1 >/dev/null 2>err.txt
[[ $? == 4 && -d runs/pioneer_urg-seed1-001 && $(readlink runs/latest) == before ]] ||
  fail "a drive that never began becomes runs/latest: $(readlink runs/latest), $(cat err.txt)"
"$rubble" drive "$robot" --urg pty:no1 --base pty:no2 --levelling pty:no3 --set safety.start_s=1 --out nobody \
  >out.txt 2>err.txt
[[ $? == 4 ]] || fail "a drive without devices must fail with 4: $(cat err.txt)"
for device in urg base levelling; do grep -q "rubble: $device: has not reported yet" err.txt || fail "$device is not named"; done
[[ $(wc -l <out.txt) == 1 ]] && grep -q "^folder .*nobody (nothing is mapped" out.txt || fail "a drive that never began shows figures: $(cat out.txt)"
! grep -q "motors off" err.txt || fail "a drive that never began tells its state: $(cat err.txt)"

expect_exit 3 "nobody: no bytes were recorded" "$rubble" replay --raw nobody

# A robot that somebody holds by its button to the end: the end says so.
start_emulator small.yaml --fault base-button@3
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --time-limit 8 --out held --set explorer.return_home=false >out.txt 2>err.txt
code=$?
stop_emulator
[[ $code == 0 ]] || fail "a drive that is held ends with $code: $(cat err.txt)"
grep -q 'the drive was waiting: base: ' out.txt || fail "nothing says that the robot was held to the end: $(cat out.txt err.txt)"

# The same from the start on: the state is shown each second all the same.
# shellcheck disable=SC2046
start_emulator small.yaml $(printf -- "--fault base-button@%s " 0 1.5 3 4.5 6 7.5 9 10.5)  # pressed for 2 s each time: all along, however slow this machine is
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --time-limit 4 --set safety.start_s=2 --out pressed >out.txt 2>err.txt
code=$?
stop_emulator
[[ $code == 4 ]] || fail "a drive that never began ends with $code: $(cat out.txt err.txt)"
grep -q 'the drive was waiting: base: emergency button pressed.*; nothing is mapped' err.txt || fail "nothing says why nothing is mapped: $(cat out.txt err.txt)"
grep -q "rubble: base: emergency button pressed" err.txt || fail "the pressed button is not named: $(cat err.txt)"
shown=$(grep -c '^ *0 s  held .* V  motors off ' err.txt)
((shown >= 4)) || fail "a robot that is held from the start shows its state $shown times in 6 s: $(cat err.txt)"

# The whole job in real time, with a base that is unplugged on the way: it is named and picked up again, how the robot
# came to rest meanwhile the scans tell, and the map loses nothing by it.
"$rubble" run small.yaml --set mapper.kind=robust --out in_process >/dev/null || fail "the same scenario in process fails"
start_emulator small.yaml --fault base-unplug@12
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --time-limit 80 --out driven --set mapper.kind=robust --set explorer.victims.search=true >out.txt 2>err.txt
code=$?
stop_emulator
[[ $code == 0 ]] || fail "the drive ended with $code: $(tail -3 err.txt)"
# Only what is said once the motors are on is about the fault: at the start each device is named until it reports.
sed -n '/motors on/,$p' err.txt >underway.txt
grep -q "rubble: base: " underway.txt || fail "the unplugged base is not named"
sed -n '/rubble: base: /,$p' underway.txt | grep -q "base: reports" || fail "the base did not come back"
! sed -n '/rubble: base: /,/base: reports/p' underway.txt | grep -q "rubble: urg: " || fail "the scanner is named in the base's place"
! grep -E "does not obey|answers? .* late|not answered|do not come on" underway.txt || fail "a base that is well is said to be in trouble"
for file in log.rlog devices.bytes robot.yaml scenario.yaml estimate.tum map.tif map.png score.json; do
  [[ -s driven/$file ]] || fail "driven/$file is missing"
done
"$rubble" score driven/map.tif in_process/truth.tif --json >driven_score.json
python3 - driven_score.json in_process/score.json <<'PY' || fail "the driven map is not as good as the one in process"
import json, sys
driven, simulated = (json.load(open(name))["score"] for name in sys.argv[1:])
print(f"driven {driven:.3f}, in process {simulated:.3f}")
sys.exit(0 if driven >= simulated - 0.05 else 1)
PY
"$rubble" replay driven >replay.txt || fail "the driven run does not replay to the same bits: $(tail -3 replay.txt)"

# Pictures while it drives; and when a device is lost the map is saved at once: while all is waited for nothing else saves it.
start_emulator small.yaml
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --out watched >out.txt 2>err.txt &
drive=$!
saved() { stat -c %y watched/map.tif 2>/dev/null; }
for _ in $(seq 300); do
  [[ -s watched/map.png && -s watched/map.tif && -s watched/estimate.tum ]] && break
  sleep 0.1
done
kill -0 $drive && [[ -s watched/map.png && ! -e watched/score.json ]] || fail "no picture while the robot drives: $(ls watched; tail -3 err.txt)"
before=$(saved)
for _ in $(seq 1000); do
  [[ $(saved) != "$before" ]] && break
  sleep 0.02
done
before=$(saved)
kill -KILL $emulator
wait $emulator 2>/dev/null
emulator=
for _ in $(seq 100); do
  sed -n '/motors on/,$p' err.txt | grep -q 'rubble: base: ' && [[ $(saved) != "$before" ]] && break
  sleep 0.1
done
kill -0 $drive && [[ $(saved) != "$before" ]] || fail "the map is not saved as the robot is lost: $(tail -3 err.txt)"
kill -INT $drive
wait $drive
[[ $? == 130 ]] || fail "a drive that waits for its devices does not end by Ctrl-C"
drive=

# A mapper of the user's whose program dies on the way, or when all is said: exit 4, one line, the folder complete. A
# command of the robot file runs only when the user says so, and no folder is made before.
sed 's#^time_limit_s:.*#&\nmapper: {kind: process, command: "touch ran"}#' "$robot" >evil.yaml
expect_exit 3 "runs only with --allow-commands" "$rubble" drive evil.yaml --out evil
[[ -e ran || -e evil ]] && fail "a command of a robot file ran, or a folder was made for it"
answer='while read -r word rest; do case $word in end)'
dies_early="echo ready 1; n=0; $answer n=\$((n+1)); [ \$n = 200 ] && exit 7; echo pose 0.25 0 0; echo end;; esac; done"
dies_late="echo ready 1; $answer echo pose 0.25 0 0; echo end;; finish) exit 8;; esac; done"
for death in early late; do
  start_emulator small.yaml
  command=dies_$death
  # shellcheck disable=SC2086
  "$rubble" drive "$robot" $ports --map-only --time-limit 6 --out "lost_$death" --mapper-command "${!command}" \
    >out.txt 2>err.txt
  code=$?
  stop_emulator
  [[ $code == 4 ]] || fail "a drive whose mapper dies ($death) ended with $code: $(tail -3 err.txt)"
  grep '^rubble: mapper' err.txt >said.txt
  [[ $(wc -l <said.txt) == 1 ]] && grep -q "ended with exit code [78]" said.txt || fail "the mapper's death: $(cat said.txt)"
  for file in log.rlog devices.bytes scenario.yaml mapper.log map.tif map.png score.json hashes.json; do
    [[ -e lost_$death/$file ]] || fail "lost_$death/$file is missing"
  done
  grep -q '^[0-9.]* 0.25' "lost_$death/estimate.tum" || fail "the trajectory up to the death is lost"
  [[ -e lost_$death/.partial ]] && fail "lost_$death is not closed"
done

# Ctrl-C: the robot is left at rest, its folder complete.
start_emulator small.yaml
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --out stopped >out.txt 2>err.txt &
drive=$!
sleep 5
kill -INT $drive
wait $drive
[[ $? == 130 ]] || fail "Ctrl-C must end a drive with 130"
[[ -s stopped/score.json ]] || fail "an interrupted drive leaves its folder incomplete"
stop_emulator
finish
