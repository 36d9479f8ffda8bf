#!/bin/bash
# What goes wrong on a first drive is said in words that help: mixed-up ports, another scanner than the robot file's, no
# room to calibrate, a heartbeat that nobody can touch, a full disk.
source "$(dirname "$0")/lib.sh"

clean_up() { [[ -z $emulator ]] || kill $emulator 2>/dev/null; }

small_scenario small.yaml
robot=$source/robots/pioneer_urg.yaml

# A file that nobody can touch is refused before anything is opened; one that can be made later is not.
expect_exit 3 "--heartbeat $work/none/hb: there is no folder $work/none" "$rubble" drive "$robot" --heartbeat "$work/none/hb"

# Two ports exchanged, and all three in a ring: who answers there is told, and the drive fails as ever. On serial lines, too.
for kind in pty tcp; do
  start_emulator small.yaml
  "$rubble" drive "$robot" --urg "$base" --base "$urg" --levelling "$levelling" --set safety.start_s=4 --out swapped_$kind >out.txt 2>err.txt
  [[ $? == 4 ]] || fail "$kind: a drive with swapped ports ends otherwise: $(tail -3 err.txt)"
  grep -qF "rubble: urg: at its port $base a robot base (ARCOS) answers; are the ports mixed up?" err.txt &&
    grep -qF "rubble: base: at its port $urg a laser scanner answers; are the ports mixed up?" err.txt ||
    fail "$kind: who answers at swapped ports is not said: $(cat err.txt)"
  [[ $(grep -c "mixed up" err.txt) == 2 ]] || fail "$kind: more is said of swapped ports than is so: $(cat err.txt)"
  "$rubble" drive "$robot" --urg "$base" --base "$levelling" --levelling "$urg" --set safety.start_s=4 --out ring_$kind >out.txt 2>err.txt
  [[ $? == 4 && $(grep -c "are the ports mixed up?" err.txt) == 3 ]] || fail "$kind: ports in a ring: $(cat err.txt)"
  grep -qF "rubble: base: at its port $levelling a levelling unit answers" err.txt || fail "$kind: ports in a ring: $(cat err.txt)"
  [[ $kind == tcp ]] || stop_emulator
done

# A heartbeat that never comes is no matter of cables.
"$rubble" drive "$robot" --urg "$urg" --base "$base" --levelling "$levelling" --heartbeat "$work/hb" --set safety.start_s=4 --out untouched >out.txt 2>err.txt
[[ $? == 4 ]] && tail -n 1 err.txt | grep -qF "$work/hb must be touched); nobody has touched it" || fail "a heartbeat that never comes: $(tail -3 err.txt)"

# A disk that is full (here: a file that may not grow): the folder is named, and that it is not complete.
(ulimit -f 300 && exec "$rubble" drive "$robot" --urg "$urg" --base "$base" --levelling "$levelling" --time-limit 60 --out full) >out.txt 2>err.txt
[[ $? == 4 ]] || fail "a drive on a full disk ends otherwise: $(tail -3 err.txt)"
grep -q '^folder  *full (not complete)$' out.txt || fail "the folder that a full disk left is not named: $(cat out.txt; tail -3 err.txt)"
[[ ! -e full/score.json ]] || fail "the folder is complete after all"

# The scanner that the file says: not a word of it.
"$rubble" drive "$robot" --map-only --urg "$urg" --base "$base" --levelling "$levelling" --time-limit 2 --out right >out.txt 2>err.txt || fail "map-only: $(tail -3 err.txt)"
! grep -q "the robot file is of a" err.txt || fail "the right scanner is said to be another: $(cat err.txt)"

# This computer stands still (suspended, swapping; here the program is): it is said, and what queued up meanwhile drives nothing for
# another second. Put to sleep, its clock stands still, too: told by another one.
for how in stopped asleep; do
  slept=
  if [[ $how == asleep ]]; then
    cat >sleeper.c <<'C'
#include <stdio.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_gettime(clockid_t clock, struct timespec* now) {
  const long result = syscall(SYS_clock_gettime, clock, now);
  if (clock == CLOCK_BOOTTIME && access("asleep_now", F_OK) == 0) now->tv_sec += 5;
  return (int)result;
}
C
    cc -shared -fPIC -o sleeper.so sleeper.c || break
    slept=$work/sleeper.so
  fi
  LD_PRELOAD=$slept "$rubble" drive "$robot" --urg "$urg" --base "$base" --levelling "$levelling" --time-limit 60 --out "$how" >out.txt 2>err.txt &
  drive=$!
  for _ in $(seq 300); do
    grep -Eq 'driving .* motors on' err.txt && break
    sleep 0.1
  done
  sleep 1
  if [[ $how == stopped ]]; then
    kill -STOP $drive
    sleep 5
    kill -CONT $drive
  else
    touch asleep_now
  fi
  woken=$(date +%s.%N)
  sleep 8
  kill -INT $drive
  wait $drive
  [[ $? == 130 ]] || fail "a drive that was $how ends otherwise: $(tail -3 err.txt)"
  grep -Eq '^rubble: this computer: stood still for [56]\.[0-9] s' err.txt || fail "nothing says that this computer was $how: $(cat err.txt)"
  grep -q '^rubble: this computer: is in time again' err.txt || fail "the drive does not go on when this computer was $how: $(cat err.txt)"
  PYTHONPATH=$source/tests python3 - "$how/devices.bytes" "$woken" <<'PY' || fail "what queued up while this computer was $how drives the robot"
import sys
import black_box
woken = float(sys.argv[2])
orders = [(t - woken, number, value) for t, number, value in black_box.orders(sys.argv[1])]
moving = [t for t, number, value in orders if number in (black_box.VEL, black_box.RVEL) and value]
early = [t for t in moving if 0.1 < t < 0.9]  # by a tenth of a second the clocks of shell and drive may differ
late = [t for t in moving if t >= 0.9]
print("orders to move after it woke:", ["%.2f" % t for t in moving if t > 0][:3])
sys.exit(0 if not early and late and any(t < 0 for t in moving) else 1)
PY
done
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
[[ $(grep -c 'something stands in the way' err.txt) == 1 ]] || fail "stderr does not say it once: $(cat err.txt)"
grep -q "blocked.yaml: is not written.*something stands in the way" err.txt || fail "nobody is told that no file was written: $(cat err.txt)"
stop_emulator
finish
