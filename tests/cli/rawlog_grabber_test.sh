#!/bin/bash
# MRPT's own recorder (rawlog-grabber of Debian's mrpt-apps) takes the emulated scanner's scans over TCP and pty while
# somebody drives the base; `rubble map` makes a map of that rawlog.
source "$(dirname "$0")/lib.sh"
command -v rawlog-grabber >/dev/null || { echo "skipped: mrpt-apps is not installed"; exit 77; }
printf 'name: flat\narena: {file: %s/arenas/shipped/flat_room.yaml}\n' "$source" >flat.yaml
"$rubble" run flat.yaml --set time_limit_s=1 --out truth >/dev/null || fail "no truth"

# A tour of the base: to the left, then on through the room, as any client of ARCOS would.
cat >tour.py <<'PY'
import sys
sys.path.insert(0, sys.argv[2])
sys.argv = sys.argv[:2]
from arcos_client import Base, order, synchronise
base = Base(sys.argv[1])
synchronise(base)
base.send(order(1, 1), order(4, 1), order(6, 250), order(10, 25))
for step, seconds in ((order(12, 45), 4), (order(8, 600), 5), (order(12, 0), 4), (order(8, 700), 5), (order(12, 180), 9)):
    base.send(step)
    base.reports(seconds, [order(0)])
base.send(order(29), order(4, 0), order(2, 1))
PY

for line in tcp pty; do
  mkdir $line
  port=tcp:127.0.0.1:0
  [[ $line == pty ]] && port=pty:$work/urg
  "$rubble" emulate flat.yaml --urg "$port" --base tcp:127.0.0.1:0 --time-limit 200 >$line.emulator 2>&1 &
  emulator=$!
  for _ in $(seq 300); do grep -q '^ready$' $line.emulator && break; sleep 0.1; done
  number=$(sed -n 's/^urg tcp:.*://p' $line.emulator)
  where="COM_port_LIN = $work/urg"
  [[ $line == tcp ]] && where="IP_DIR = 127.0.0.1
PORT_DIR = $number"
  cat >$line/grab.ini <<INI
[global]
rawlog_prefix = $work/$line/grabbed
time_between_launches = 100
use_sensoryframes = 0
GRABBER_PERIOD_MS = 100
[LASER]
driver = CHokuyoURG
process_rate = 200
sensorLabel = LASER
pose_x = 0.145
pose_y = 0
pose_z = 0.35
pose_yaw = 0.176
pose_pitch = 0
pose_roll = 0
$where
INI
  # It ends with its input. The tour begins when scans are being saved: the first one lays the map's frame.
  (cd $line && (until [[ -e toured ]]; do sleep 0.2; done; echo) | timeout 120 rawlog-grabber grab.ini >grab.txt 2>&1) &
  grabber=$!
  for _ in $(seq 150); do grep -q 'Saved [1-9]' $line/grab.txt && break; sleep 0.1; done
  timeout 60 python3 tour.py "$(sed -n 's/^base //p' $line.emulator)" "$source/tests/cli" >tour.txt 2>&1 ||
    fail "the tour fails: $(tail -3 tour.txt)"
  sleep 1
  touch $line/toured
  wait $grabber
  kill -INT $emulator
  wait $emulator
  rawlog=$(ls $line/*.rawlog 2>/dev/null | head -n 1)
  [[ -s $rawlog ]] || { fail "$line: nothing was grabbed: $(tail -n 3 $line/grab.txt)"; continue; }
  "$rubble" map "$rawlog" --set mapper.kind=robust --out $line/map >$line/map.txt 2>&1 || fail "$line: map fails: $(tail -n 3 $line/map.txt)"
  # Where the robot started is known: half a room has no place of its own.
  "$rubble" score $line/map/map.tif truth/truth.tif --pose=0.6,0.6,-90 --json >$line/score.json || fail "$line: score fails"
  python3 - $line $line/score.json <<'PY' || fail "$line: the map of the grabbed scans is not that of the room"
import json, sys
j = json.load(open(sys.argv[2]))
print(sys.argv[1], {k: round(j[k], 3) for k in ("precision", "sight_kappa", "sight_known", "psi_m")})
sys.exit(0 if j["precision"] >= 0.95 and j["sight_kappa"] >= 0.95 and j["sight_known"] >= 0.4 else 1)
PY
done
finish
