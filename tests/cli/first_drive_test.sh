#!/bin/bash
# What goes wrong on a first drive is said in words that help: mixed-up ports, another scanner than the robot file's, no
# room to calibrate, a heartbeat that nobody can touch, a full disk.
source "$(dirname "$0")/lib.sh"

emulator=
trap '[[ -z $emulator ]] || kill $emulator 2>/dev/null; rm -rf "$work"' EXIT

# start_emulator SCENARIO [options]: ports in $urg, $base and $levelling. Waits until they are open.
start_emulator() {
  rm -f emulator.txt
  "$rubble" emulate "$@" --urg tcp:127.0.0.1:0 --base tcp:127.0.0.1:0 --levelling tcp:127.0.0.1:0 >emulator.txt 2>emulator_err.txt &
  emulator=$!
  for _ in $(seq 200); do
    grep -qs '^ready$' emulator.txt && break
    sleep 0.1
  done
  grep -q '^ready$' emulator.txt || fail "the emulator is not ready: $(cat emulator.txt emulator_err.txt)"
  for device in urg base levelling; do declare -g $device="$(sed -n "s/^$device //p" emulator.txt)"; done
}

stop_emulator() {
  kill -INT $emulator
  wait $emulator
  emulator=
}

small_scenario small.yaml
robot=$source/robots/pioneer_urg.yaml

# A file that nobody can touch is refused before anything is opened; one that can be made later is not.
expect_exit 3 "--heartbeat $work/none/hb: there is no folder $work/none" "$rubble" drive "$robot" --heartbeat "$work/none/hb"

start_emulator small.yaml
# Two ports exchanged, and all three in a ring: who answers there is told, and the drive fails as ever.
"$rubble" drive "$robot" --urg "$base" --base "$urg" --levelling "$levelling" --set safety.start_s=4 --out swapped >out.txt 2>err.txt
[[ $? == 4 ]] || fail "a drive with swapped ports ends otherwise: $(tail -3 err.txt)"
grep -qF "rubble: urg: at its port $base a robot base (ARCOS) answers; are the ports mixed up?" err.txt &&
  grep -qF "rubble: base: at its port $urg a laser scanner answers; are the ports mixed up?" err.txt ||
  fail "who answers at swapped ports is not said: $(cat err.txt)"
[[ $(grep -c "mixed up" err.txt) == 2 ]] || fail "more is said of swapped ports than is so: $(cat err.txt)"
"$rubble" drive "$robot" --urg "$base" --base "$levelling" --levelling "$urg" --set safety.start_s=4 --out ring >out.txt 2>err.txt
[[ $? == 4 && $(grep -c "are the ports mixed up?" err.txt) == 3 ]] || fail "ports in a ring: $(cat err.txt)"
grep -qF "rubble: base: at its port $levelling a levelling unit answers" err.txt || fail "ports in a ring: $(cat err.txt)"

# A disk that is full (here: a file that may not grow): the folder is named, and that it is not complete.
(ulimit -f 300 && exec "$rubble" drive "$robot" --urg "$urg" --base "$base" --levelling "$levelling" --time-limit 60 --out full) >out.txt 2>err.txt
[[ $? == 4 ]] || fail "a drive on a full disk ends otherwise: $(tail -3 err.txt)"
grep -q '^folder  *full (not complete)$' out.txt || fail "the folder that a full disk left is not named: $(cat out.txt; tail -3 err.txt)"
[[ ! -e full/score.json ]] || fail "the folder is complete after all"

# The scanner that the file says: not a word of it.
"$rubble" drive "$robot" --map-only --urg "$urg" --base "$base" --levelling "$levelling" --time-limit 2 --out right >out.txt 2>err.txt || fail "map-only: $(tail -3 err.txt)"
! grep -q "the robot file is of a" err.txt || fail "the right scanner is said to be another: $(cat err.txt)"
stop_emulator

# Another scanner: one line, with what to do; done so, none.
start_emulator small.yaml --set robot.laser.model=UTM-30LX
ports="--urg $urg --base $base --levelling $levelling"
# shellcheck disable=SC2086
"$rubble" drive "$robot" --map-only $ports --time-limit 2 --out other >out.txt 2>err.txt || fail "map-only: $(tail -3 err.txt)"
[[ $(grep -c "urg: it is a UTM-30LX (1081 beams .* but the robot file is of a URG-04LX (682 beams .*; give --set robot.laser.model=UTM-30LX" err.txt) == 1 ]] ||
  fail "another scanner is not named once: $(cat err.txt)"
# shellcheck disable=SC2086
"$rubble" drive "$robot" --map-only $ports --set robot.laser.model=UTM-30LX --time-limit 2 --out mended >out.txt 2>err.txt || fail "map-only: $(tail -3 err.txt)"
! grep -q "the robot file is of a" err.txt || fail "the advice does not help: $(cat err.txt)"
stop_emulator

# No room to calibrate: that is how it ended, not that it is complete.
start_emulator yellow --seed 1
"$rubble" calibrate "$robot" --urg "$urg" --base "$base" --levelling "$levelling" --folder blocked --out blocked.yaml >out.txt 2>err.txt
[[ $? == 4 ]] || fail "a calibration without room ends otherwise: $(cat out.txt; tail -3 err.txt)"
grep -q '^ended  *something stands in the way' out.txt && ! grep -q "the drive is complete" out.txt blocked/score.json ||
  fail "a calibration without room says how it ended: $(cat out.txt)"
stop_emulator
finish
