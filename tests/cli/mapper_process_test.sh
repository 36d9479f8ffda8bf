# Mappers that are programs of the user's: they map, they fail in one line with a saved folder, they run only when the
# user says so, and nothing of them is left behind.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
python_mapper="python3 $source/examples/python_mapper.py"

# The examples map.
"$rubble" run s.yaml --out py --mapper-command "$python_mapper" >table.txt || fail "the Python example ended with $?"
head -n 1 table.txt | grep -q "^mapper command .*python_mapper.py" || fail "the command is not told first"
json_holds py/score.json "j['aligned'] and j['score'] > 0.8 and j['scans_mapped'] > 20"
[[ -e py/mapper.log ]] || fail "there is no mapper.log"
"$rubble" run s.yaml --out py2 --mapper-command "$python_mapper" >/dev/null
cmp py/hashes.json py2/hashes.json || fail "the Python example is not deterministic"
"$rubble" map py/log.rlog --out mapped --mapper-command "$python_mapper" >/dev/null || fail "map with it ended with $?"
cmp py/estimate.tum mapped/estimate.tum || fail "mapping its log gives another trajectory"
c++ -O1 -Wall -Wextra -Werror -o cpp_mapper "$source/examples/cpp_mapper/mapper.cpp" || fail "the C++ example does not compile"
"$rubble" run s.yaml --out cpp --mapper-command ./cpp_mapper >/dev/null || fail "the C++ example ended with $?"
json_holds cpp/score.json "j['score'] is not None and j['area_known_m2'] > 8"

# However the laser is mounted, what the examples draw of the same walls is the same.
cat >mounts.py <<'PYTHON'
import math
import subprocess
import sys

BEAMS, FIRST, STEP = 401, -2.0, 0.01
RANGES = [2.0 + 0.4 * (FIRST + i * STEP) for i in range(BEAMS)]  # farther to the left


def walls(pitch, roll, first, ranges):
    mount = {"x_m": 0.1, "y_m": 0.05, "z_m": 0.3, "yaw_rad": 0.3, "pitch_rad": pitch, "roll_rad": roll}
    text = "rubble-mapper 1\n" + "".join("laser.%s %r\n" % item for item in mount.items()) + "start\n"
    text += "tick 1000000000\nodometry 1000000000 0 0 0 0 0 0\nscan 1000000000 %r %r 0 0.02 5 %d %s\nend\n" % (
        first, STEP, BEAMS, " ".join(map(repr, ranges)))
    said = subprocess.run(sys.argv[1:], input=text, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    at = next(i for i, line in enumerate(said) if line.startswith("map "))
    width, height, step, x0, y0 = map(float, said[at].split()[1:])
    rows = said[at + 1 : at + 1 + int(height)]
    return {(round(x + x0 / step), round(y + y0 / step)) for y, row in enumerate(rows) for x, c in enumerate(row) if c == "#"}


last = FIRST + (BEAMS - 1) * STEP
upright = walls(0.0, 0.0, FIRST, RANGES)
for name, other in (("roll", walls(0.0, math.pi, -last, RANGES[::-1])), ("pitch", walls(math.pi, 0.0, math.pi - last, RANGES[::-1]))):
    if len(upright) < 100 or len(upright ^ other) > 4:  # at the edges of cells
        print("turned by", name, len(upright), len(upright ^ other))
PYTHON
for example in "$python_mapper" ./cpp_mapper; do
  differ=$(python3 mounts.py $example 2>&1)
  [[ -z $differ ]] || fail "$example maps a laser upside down otherwise: $differ"
done

# Our own mappers, asked through the protocol, give the same bits.
for kind in paper robust; do
  "$rubble" run s.yaml --set mapper.kind=$kind --set time_limit_s=60 --out $kind >/dev/null || fail "$kind: $?"
  "$rubble" run s.yaml --set time_limit_s=60 --out served-$kind --mapper-command "$rubble mapper-process $kind" >/dev/null || fail "served $kind: $?"
  for name in map.tif map.png map.pgm estimate.tum truth.tum pois.csv; do
    cmp "$kind/$name" "served-$kind/$name" || fail "$name of the served mapper $kind differs"
  done
done

# A command runs only when the user says so.
cat >evil.yaml <<YAML
name: evil
arena: {generate: {columns: 2, rows: 2}}
mapper: {kind: process, command: "touch $work/ran"}
YAML
cat >evil_sweep.yaml <<YAML
scenarios: [s.yaml]
seeds: 1-2
configs: {x: {mapper.kind: process, mapper.command: "touch $work/ran"}}
YAML
cp -r py foreign
sed -i "s#command: .*#command: \"touch $work/ran\"#" foreign/scenario.yaml
not_allowed="runs only with --allow-commands"
expect_exit 3 "$not_allowed" "$rubble" run evil.yaml --out evil
expect_exit 3 "$not_allowed" "$rubble" run evil.yaml --out evil --set mapper.timeout_s=5
expect_exit 3 "$not_allowed" "$rubble" batch evil_sweep.yaml --out evil
expect_exit 3 "$not_allowed" "$rubble" replay foreign
expect_exit 3 "$not_allowed" "$rubble" run foreign/scenario.yaml --out evil
[[ -e ran || -e evil ]] && fail "a command of a file ran, or a folder was made for it"
"$rubble" replay py --allow-commands >replay.txt || fail "replay with its command ended with $?: $(cat replay.txt)"
grep -qx 'bit-identical' replay.txt || fail "replay: $(cat replay.txt)"
"$rubble" run s.yaml --out typed --set mapper.kind=process --set "mapper.command=$python_mapper" \
  --set time_limit_s=2 >/dev/null || fail "a command typed with --set ended with $?"

# Whatever goes wrong: exit code 4, one line, the folder saved.
number=0
fails() {  # fails TEXT COMMAND
  number=$((number + 1))
  expect_exit 4 "$1" "$rubble" run s.yaml --out "f$number" --set mapper.timeout_s=3 --mapper-command "$2"
  for name in score.json hashes.json map.png scenario.yaml mapper.log; do
    [[ -e f$number/$name ]] || fail "f$number/$name is missing after '$2'"
  done
}
answer='while read -r word rest; do case $word in end)'
fails "ended with exit code 127" "no-such-program"
grep -q 'exit code 127' out.txt && fail "the failure is said twice: $(cat out.txt)"
# What runs on beside it, without input, has last words of its own, sooner or later: not into the same log.
fails "its last words: 'ValueError: no luck'" "$python_mapper 2> mapper_beside.log & exec python3 -c 'raise ValueError(\"no luck\")'"
fails "was ended by signal 9" "echo ready 1; n=0; $answer n=\$((n+1)); [ \$n = 500 ] && kill -9 \$\$; echo end;; esac; done"
grep -q 'ended by signal 9' out.txt && fail "the failure is said twice: $(cat out.txt)"
grep -q . f3/estimate.tum || fail "the trajectory up to the death is lost"
fails "no whole answer within 3 s" "sleep 100"
fails "where a line of the answer" "echo ready 1; $answer echo hello;; esac; done"
fails "not within 1 to 8000" "echo ready 1; $answer echo map 100000 100000 0.05 0 0;; esac; done"

# Whatever a mapper answers within the protocol, explorer, drawing and scoring go on.
cat >chaos.py <<'PY'
import random, sys
rng = random.Random(int(sys.argv[1]))
print("ready 1", flush=True)
for line in sys.stdin:
    if line.split()[0] != "end":
        continue
    out = []
    if rng.random() < 0.3:
        far = rng.choice((0.5, 3.0, 50.0, 1e8))
        out.append("pose %r %r %r" % (rng.uniform(-far, far), rng.uniform(-far, far), rng.uniform(-100, 100)))
    if rng.random() < 0.05:
        w, h = rng.choice((1, 2, 7, 60, 200)), rng.choice((1, 2, 7, 60, 200))
        out.append("map %d %d 0.05 %r %r" % (w, h, 0.05 * rng.randrange(-150, 150), 0.05 * rng.randrange(-150, 150)))
        weights = rng.choice(((1, 1, 1), (0, 50, 1), (5, 60, 1), (1, 0, 0)))
        out += ["".join(rng.choices("?.#", weights, k=w)) for _ in range(h)]
    if rng.random() < 0.02:
        out.append("trajectory 1\n%d 0 0 0" % rng.randrange(1000))
    print("\n".join(out + ["end"]), flush=True)
PY
for seed in 1 2 3; do
  "$rubble" run s.yaml --out chaos$seed --set time_limit_s=10 --mapper-command "python3 chaos.py $seed" >/dev/null ||
    fail "a mapper of random answers, seed $seed: ended with $?"
done

# One that draws and tells poses, but never that a scan is mapped: the robot waits for it, and that is said, once.
cat >unmapped.py <<'PY'
import sys
print("ready 1", flush=True)
for line in sys.stdin:
    if line.split()[0] == "end":
        print("pose 0 0 0\nmap 2 2 0.5 -0.5 -0.5\n..\n..\nend", flush=True)
PY
waits='waits for the mapper: it has mapped no scan yet (answers `mapped N`, docs/mapper_protocol.md)'
expect_exit 0 "$waits" "$rubble" run s.yaml --out unmapped --set time_limit_s=30 --mapper-command "python3 unmapped.py"
[[ $(grep -cF "$waits" unmapped/decisions.txt) == 1 ]] || fail "decisions.txt: $(cat unmapped/decisions.txt)"
expect_exit 0 '' "$rubble" run s.yaml --out soon --set time_limit_s=8 --mapper-command "python3 unmapped.py"
grep -qF 'waits for the mapper' err.txt soon/decisions.txt py/decisions.txt && fail "what need not wait long is said to"

# kill -9 of rubble leaves none of its processes.
"$rubble" run s.yaml --out killed --set time_limit_s=100000 --mapper-command \
  "sleep 1234 & echo \$! >$work/pid1; (setsid sleep 1234 & echo \$! >$work/pid2); echo \$\$ >$work/pid3; sleep 1234" \
  >/dev/null 2>&1 &
running=$!
for _ in $(seq 500); do [[ -s pid3 ]] && break; sleep 0.02; done
kill -9 "$running"
wait "$running" 2>/dev/null
for name in pid1 pid2 pid3; do
  for _ in $(seq 500); do kill -0 "$(cat $name)" 2>/dev/null || break; sleep 0.02; done
  kill -0 "$(cat $name)" 2>/dev/null && fail "$name is left behind by kill -9"
done

# MRPT's builders: a run's bits depend on its seed, not on what ran before it.
cat >peers.yaml <<YAML
scenarios: [s.yaml]
seeds: [5, 3, 4]
set: {mapper.kind: [mrpt-rbpf, mrpt-icp], time_limit_s: 12}
YAML
"$rubble" batch peers.yaml --out peers --workers 1 >/dev/null || fail "a batch of peers ended with $?"
"$rubble" batch peers.yaml --out peers2 --workers 3 >/dev/null || fail "a second batch of peers ended with $?"
for kind in mrpt-rbpf mrpt-icp; do
  "$rubble" run s.yaml --out "alone-$kind" --set mapper.kind=$kind --set time_limit_s=12 >/dev/null || fail "$kind: $?"
  for file in map.tif estimate.tum; do
    cmp alone-$kind/$file peers/runs/*"$kind"*-seed3-*/$file || fail "$file of $kind depends on what ran before"
    cmp peers/runs/*"$kind"*-seed4-*/$file peers2/runs/*"$kind"*-seed4-*/$file || fail "$file of $kind depends on workers"
  done
done
expect_exit 4 "'papr' is no mapper; known are " "$rubble" mapper-process papr </dev/null
finish
