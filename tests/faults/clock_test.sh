#!/usr/bin/env bash
# Somebody sets the computer's clock during a drive, forth and back: nothing is said, nothing waits, no stamp moves. The same
# bits in simulation.
. "$(dirname "$0")/lib.sh"
clean_up() { [[ -z $emulator ]] || kill "$emulator" 2>/dev/null; }
cc -shared -fPIC -O1 -o jumps.so "$source/tests/faults/clock_jumps.c" -ldl >cc.txt 2>&1 || fail "the clock's setter does not compile: $(head -3 cc.txt)"
# A sanitizer wants to be loaded first; beside this it need not.
set_clock() { env LD_PRELOAD="$work/jumps.so" ASAN_OPTIONS="${ASAN_OPTIONS:-}:verify_asan_link_order=0" CLOCK_JUMPS="$1" "${@:2}"; }
# The setter works: else all below tests nothing.
(($(set_clock 0:86400 date +%s) - $(date +%s) > 80000)) || fail "the clock was not set for another program"
(($(set_clock 0:86400 python3 -c 'import time; print(int(time.time()))') - $(date +%s) > 80000)) || fail "the clock was not set for Python"

# An hour on, a day back, a second on, a year on, two seconds back; the last one stays.
jumps="2:3600 4:-86400 5:1 6:31536000 7:-2 8:7 9:-3600"
small_scenario s.yaml
robot=$source/robots/pioneer_urg.yaml
sed 's/driver: scip/driver: mrpt\n    class: CHokuyoURG/; s/model: URG-04LX, //' "$robot" >mrpt.yaml
start_emulator s.yaml
for driver in scip mrpt; do
  file=$robot
  [[ $driver == scip ]] || file=mrpt.yaml
  # shellcheck disable=SC2086
  set_clock "$jumps" timeout 120 "$rubble" drive "$file" $ports --time-limit 14 --set explorer.return_home=false --out "drive_$driver" >out.txt 2>err.txt </dev/null
  code=$?
  struck=$((struck + 7))
  [[ $code == 0 ]] || fail "$driver: a drive whose clock is set ends with $code: $(tail -3 err.txt)"
  sed -n '/motors on/,$p' err.txt | grep '^rubble: ' >said.txt && fail "$driver: setting the clock is taken for a fault: $(cat said.txt)"
  # Stamps go on as if nothing had been: from tick to tick, and over the whole drive.
  python3 - "drive_$driver/estimate.tum" <<'PY' || fail "$driver: the stamps follow the clock"
import sys
times = [float(line.split()[0]) for line in open(sys.argv[1]) if line.strip() and not line.startswith("#")]
steps = [b - a for a, b in zip(times, times[1:])]
print("%d poses over %.1f s, steps %.3f to %.3f s" % (len(times), times[-1] - times[0], min(steps), max(steps)))
sys.exit(0 if len(times) > 100 and min(steps) > 0 and max(steps) < 1.0 and times[-1] - times[0] < 30 else 1)
PY
  "$rubble" replay "drive_$driver" >replay.txt || fail "$driver: the drive does not replay: $(tail -1 replay.txt)"
done
stop_emulator

"$rubble" run s.yaml --set time_limit_s=25 --out reference >/dev/null || fail "the reference ended with $?"
set_clock "0:7 0.2:-86400 0.5:31536000" "$rubble" run s.yaml --set time_limit_s=25 --out jumped >/dev/null || fail "a run whose clock is set ended with $?"
cmp -s reference/hashes.json jumped/hashes.json || fail "a run whose clock is set has other bits"
struck=$((struck + 3))
finish_faults
