#!/bin/bash
# Somebody else drives, 'rubble drive --map-only' maps: with the scanner alone, and with the base's reports that another's line brings.
source "$(dirname "$0")/lib.sh"
clean_up() { kill $(jobs -p) 2>/dev/null; }
robot=$source/robots/pioneer_urg.yaml
printf 'name: flat\narena: {file: %s/arenas/shipped/flat_room.yaml}\nseed: 2\nexplorer: {victims: {search: false}}\n' "$source" >flat.yaml
"$rubble" run flat.yaml --set time_limit_s=60 --out truth >/dev/null || fail "the flat run fails"

expect_exit 3 "add --map-only" "$rubble" drive "$robot" --urg pty:no1 --base none --levelling none --out nobody
expect_exit 3 "add --map-only" "$rubble" calibrate "$robot" --urg pty:no1 --base none --levelling none --out nobody.yaml

# A base on a shared line that somebody drives, and who is away for a while: not one byte is said to it, also when the mapping never
# begins and other devices are asked who is there.
cat >shared_base.py <<'PY'
import select, socket, sys, time
sys.path.append(sys.argv[1])  # behind: one of the scripts there is called as a module of Python
from arcos_wire import packet
payload = bytes([0x32] + [0] * 10 + [128] + [0] * 6 + [0, 0])
report = packet(payload)
line = socket.socket()
line.bind(("127.0.0.1", 0))
line.listen()
print("port %d" % line.getsockname()[1], flush=True)
clients, heard, reports, begin = [], 0, 0, None
while begin is None or time.time() - begin < 9:
    for one in select.select([line, *clients], [], [], 0.1)[0]:
        if one is line:
            clients.append(line.accept()[0])
            begin = begin or time.time()
            continue
        data = one.recv(4096)
        heard += len(data)
        if not data:
            clients.remove(one)
    if begin and time.time() - begin < 1.5:
        for one in clients:
            one.sendall(report)
            reports += 1
print("heard %d bytes, %d reports" % (heard, reports))
PY
python3 shared_base.py "$source/tests/cli" >shared.txt &
shared=$!
for _ in $(seq 100); do grep -q '^port' shared.txt && break; sleep 0.1; done
"$rubble" drive "$robot" --map-only --urg tcp:127.0.0.1:9 --base "tcp:127.0.0.1:$(sed -n 's/^port //p' shared.txt)" --levelling none \
  --set safety.start_s=4 --out never >out.txt 2>err.txt
[[ $? == 4 ]] || fail "mapping without a scanner ends otherwise: $(tail -3 err.txt)"
wait $shared
cat shared.txt
grep -q "^heard 0 bytes, [1-9]" shared.txt || fail "who only maps speaks to a base that others drive, or did not listen to it: $(cat shared.txt err.txt)"

"$rubble" emulate flat.yaml --urg tcp:127.0.0.1:0 --base tcp:127.0.0.1:0 --truth true.tum >emulator.txt 2>&1 &
emulator=$!
for _ in $(seq 200); do grep -q '^ready$' emulator.txt && break; sleep 0.1; done
urg=$(sed -n 's/^urg //p' emulator.txt)
base=$(sed -n 's/^base tcp://p' emulator.txt)
python3 "$source/tests/cli/foreign_driver.py" "$base" 56 >driver.txt 2>&1 &
driver=$!
for _ in $(seq 100); do grep -q '^tee' driver.txt && break; sleep 0.1; done
tee=$(sed -n 's/^tee /tcp:/p' driver.txt)

# One who has the base to himself does not let go: that is said, and there is a way without it.
"$rubble" drive "$robot" --map-only --urg "$urg" --base "tcp:$base" --levelling none --set safety.start_s=2 --out kept_out >out.txt 2>err.txt
[[ $? == 4 ]] && grep -q "another program uses the device" err.txt || fail "a base that is in use is not named: $(cat err.txt)"

for way in alone listening; do
  port=none
  [[ $way == listening ]] && port=$tee
  "$rubble" drive "$robot" --map-only --urg "$urg" --base "$port" --levelling none --time-limit 20 --out "$way" >out.txt 2>err.txt
  [[ $? == 0 ]] || fail "mapping $way ends with an error: $(tail -3 err.txt)"
  python3 -c 'import json, sys; s = json.load(open(sys.argv[1]))["cpu_share"]; print("cpu_share", s); sys.exit(s > 0.5)' "$way/score.json" ||
    fail "mapping $way keeps a core busy"
  "$rubble" replay "$way" >replay.txt || fail "the run $way does not replay: $(tail -3 replay.txt)"
  "$rubble" replay --raw "$way" >raw.txt || fail "the raw bytes of $way do not give the same: $(cat raw.txt)"
done
wait $driver || fail "the driver was disturbed: $(cat driver.txt)"
kill -INT $emulator
wait $emulator
cat driver.txt
read -r _ heard _ _ _ on _ reports _ _ turned _ < <(tail -1 driver.txt)
[[ $heard == 0 ]] || fail "who only listens said $heard bytes"
((on >= reports - 15 && turned > 720)) || fail "the driver was disturbed: $(tail -1 driver.txt)"
# The map begins where the robot was when it was first seen.
start_of() {
  python3 - "$1/estimate.tum" <<'PY'
import math, sys
first = float(next(l for l in open(sys.argv[1]) if not l.startswith("#")).split()[0])
for line in open("true.tum"):
    f = list(map(float, line.split()))
    if f[0] >= first:
        print("%.3f,%.3f,%.2f" % (f[1], f[2], math.degrees(2 * math.atan2(f[6], f[7]))))
        break
PY
}
for way in alone listening; do
  "$rubble" score "$way/map.tif" truth/truth.tif "--start=$(start_of $way)" --json >"$way.json" || fail "the map made $way is not scored"
done
# Where the robot was, by who watched it: as far apart as in truth, in a frame of its own.
cat >compare.py <<'PY'
import json, math, sys

def rows(path):
    table = [list(map(float, l.split())) for l in open(path) if l.strip() and not l.startswith("#")]
    return [(r[0], r[1], r[2]) for r in table if len(r) == 8]

truth = rows("true.tum")
for way in ("alone", "listening"):
    score = json.load(open(way + ".json"))  # of what was seen from those circles: the rest of the room is not its fault
    estimate = rows(way + "/estimate.tum")
    i, pairs = 0, []
    for t, x, y in estimate[::10]:
        while i + 1 < len(truth) and truth[i + 1][0] <= t:
            i += 1
        pairs.append((x, y, truth[i][1], truth[i][2]))
    worst = 0.0
    for a in pairs[::5]:
        for b in pairs[::5]:
            worst = max(worst, abs(math.hypot(a[0] - b[0], a[1] - b[1]) - math.hypot(a[2] - b[2], a[3] - b[3])))
    way_driven = sum(math.hypot(b[2] - a[2], b[3] - a[3]) for a, b in zip(pairs, pairs[1:]))
    print("%s: %.3f of the walls are walls, kappa of what was seen %.3f, %.1f m driven, distances between places wrong by %.3f m at most" %
          (way, score["precision"], score["sight_kappa"], way_driven, worst))
    if not (score["precision"] > 0.95 and score["sight_kappa"] > 0.85 and way_driven > 2.0 and worst < 0.08):
        sys.exit(1)
PY
python3 compare.py || fail "the map of a robot that somebody else drove is bad"
grep -q ' odometry 0' err.txt && fail "no reports were listened to"
finish
