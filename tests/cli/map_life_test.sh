#!/usr/bin/env bash
# A map goes on in another run, is only looked at, is exported; what is wrong with it is told in one line.
source "$(dirname "$0")/lib.sh"

# near A.tum B.tum: poses of one stamp lie within 6 cm of each other.
near() {
  python3 - "$1" "$2" <<'PYTHON' || fail "$1 and $2 do not agree"
import sys
def read(path): return {l.split()[0]: [float(w) for w in l.split()[1:3]] for l in open(path)}
a, b = read(sys.argv[1]), read(sys.argv[2])
both = [s for s in a if s in b]
off = [((a[s][0] - b[s][0]) ** 2 + (a[s][1] - b[s][1]) ** 2) ** 0.5 for s in both]
print(len(both), "poses, at most", max(off), "m apart")
sys.exit(0 if len(both) > 100 and max(off) < 0.06 else 1)
PYTHON
}

small_scenario s.yaml
"$rubble" run s.yaml --out first >/dev/null || fail "the run ended with $?"
for name in map.rmap scans.csv scans.png loops.csv loops.png; do [[ -s first/$name ]] || fail "first/$name is missing"; done
[[ $(head -c 12 first/map.rmap) == "RUBBLE MAP 2" ]] || fail "map.rmap does not begin with its name"
[[ $(wc -l <first/scans.csv) -gt 100 ]] || fail "scans.csv has but $(wc -l <first/scans.csv) lines"
"$rubble" map first --out mapped >/dev/null || fail "map ended with $?"
# Relations between moments of the log judge a map: those of its own poses are met, others are not, and of another time none.
python3 - <<'PYTHON'
import math
rows = [[float(w) for w in l.split()] for l in open('mapped/estimate.tum')]
a, b = rows[10], rows[len(rows) // 2]
yaw = lambda row: 2 * math.atan2(row[6], row[7])
c, s, dx, dy = math.cos(yaw(a)), math.sin(yaw(a)), b[1] - a[1], b[2] - a[2]
line = lambda x, y: f'{a[0]:.6f} {b[0]:.6f} {x} {y} 0 0 0 {yaw(b) - yaw(a)}\n'
open('own.relations', 'w').write(line(c * dx + s * dy, c * dy - s * dx))
open('off.relations', 'w').write(line(c * dx + s * dy + 0.5, c * dy - s * dx))
open('other.relations', 'w').write('1e6 1000010 1 0 0 0 0 0\n')
PYTHON
"$rubble" map first --relations own.relations --out own >own.txt 2>err.txt || fail "--relations ended with $?"
[[ -s err.txt ]] && fail "relations of the scans are doubted: $(cat err.txt)"
json_holds own/score.json "j['relations'] == 1 and j['relation_m'] < 0.001"
grep -q '^error of a relation  *0.000' own.txt || fail "the error of the relation is not shown: $(cat own.txt)"
"$rubble" map first --relations off.relations --out off >/dev/null || fail "--relations ended with $?"
json_holds off/score.json "abs(j['relation_m'] - 0.5) < 0.001"
awk '{$1 += 0.02; $2 += 0.02; print}' own.relations >between.relations
expect_exit 0 'between.relations: of 1 relations 1 name a moment at which first/log.rlog has no scan (within 1 ms), and are judged by poses in between' \
  "$rubble" map first --relations between.relations --out between
expect_exit 3 'README.md:3:1: is no file of relations: ' "$rubble" map first --relations "$source/README.md" --out none
grep -qF "is no number; a line of them is 'stamp stamp x y z roll pitch yaw', in s, m and rad" err.txt || fail "it is not told what relations look like: $(cat err.txt)"
expect_exit 1 "" "$rubble" map first --relations other.relations --out other
grep -q 'none of its relations lies in the time' out.txt || fail "relations of another time are not told"
expect_exit 3 "nowhere.relations" "$rubble" map first --relations nowhere.relations --out none
"$rubble" map first --continue mapped --out more --start 0,0,0 >/dev/null || fail "--continue ended with $?"
json_holds more/score.json "j['place_known'] == 1"
near more/estimate.tum first/estimate.tum
"$rubble" map first --localise first --start 0,0,0 --out found >/dev/null || fail "--localise ended with $?"
json_holds found/score.json "j['place_known'] == 1 and j['carried_off'] == 0"
near found/estimate_live.tum first/estimate.tum
cmp -s found/map.rmap first/map.rmap || fail "--localise changed the map"
"$rubble" map first --localise first --start 0,0,0 --out found2 >/dev/null
cmp -s found/estimate_live.tum found2/estimate_live.tum || fail "the same again is not the same"

# Where the laser sits can be told; a mount that is not the map's is refused and leaves nothing in the way.
expect_exit 3 'was made with the laser mounted at' "$rubble" map first --continue first --laser 0.3,0,0 --out moved
[[ ! -e moved ]] || fail "a refused command leaves a folder: $(ls -A moved)"
"$rubble" map first --laser 0.147,0,0 --continue first --out moved >/dev/null || fail "a mount 2 mm off ended with $?"
grep -q '^    x_m: 0.147$' moved/scenario.yaml || fail "scenario.yaml does not have the mount: $(grep -A3 laser moved/scenario.yaml)"
"$rubble" map first --set robot.laser.x_m=0.3 --set time_limit_s=2 --out vain >/dev/null 2>err.txt || fail "vain settings ended with $?"
grep -q -- '--set robot.laser.x_m: has no effect on a log.*--laser' err.txt && grep -q -- '--set time_limit_s: has no effect' err.txt ||
  fail "settings without effect are not told: $(cat err.txt)"
cmp -s vain/estimate.tum mapped/estimate.tum || fail "settings without effect have one"
"$rubble" map first --upside-down --out wrong >table.txt || fail "--upside-down ended with $?"
grep -q '^DOUBTFUL MAP .*the scans turn the other way than the wheels' table.txt || fail "a mirrored map is believed: $(cat table.txt)"
json_holds wrong/score.json "j['turns_against'] == 1 and j['map_doubted'] == 1"

# A log too short for its place to be found: told in one line, in the exit code, and no map or pose is made up.
"$rubble" run s.yaml --set time_limit_s=8 --set explorer.return_home=false --out brief >/dev/null || fail "a brief run ended with $?"
for how in --localise --continue; do
  "$rubble" map brief $how first --out "lost$how" >table.txt 2>err.txt
  [[ $? == 1 ]] || fail "$how without a place ended otherwise: $(cat table.txt err.txt)"
  [[ $(grep -c 'NOT AS EXPECTED .*does not know its place in first/map.rmap: give --start' table.txt) == 1 ]] ||
    fail "$how without a place is not told: $(cat table.txt)"
  json_holds lost$how/score.json "j['place_known'] == 0"
  [[ ! -s lost$how/estimate.tum ]] || fail "$how made up poses"
done
(mkdir kept && cd kept && "$rubble" map ../brief >/dev/null && "$rubble" map ../brief --localise ../first >/dev/null)
[[ $(readlink kept/runs/latest) == map-log-seed1-001 && -d kept/runs/map-log-seed1-002 ]] ||
  fail "a run without a place becomes runs/latest: $(ls -l kept/runs)"
# What was given is not asked for, and a log that is cut is the first thing to mend.
"$rubble" map brief --localise first --start 8,8,0 --out astray >table.txt
[[ $? == 1 ]] && grep -q 'NOT AS EXPECTED .*does not know its place .*: check --start, or give a longer log or' table.txt ||
  fail "a start that does not hold is not told: $(cat table.txt)"
"$rubble" map first --localise first --start 3,3,90 --out elsewhere >table.txt || fail "a wrong --start ended with $?: $(cat table.txt)"
grep -q 'place in the map .*found .*, but it began at -\?0\.0[0-9], -\?0\.0[0-9] m, heading -\?[01] deg, not at --start$' table.txt ||
  fail "a wrong --start is not told: $(cat table.txt)"
"$rubble" map first --localise first --start 0.2,0,0 --out there >table.txt
grep -q 'place in the map .*found [0-9.]* s after the first scan$' table.txt || fail "a right --start is doubted: $(cat table.txt)"
head -c "$(($(stat -c %s brief/log.rlog) - 100))" brief/log.rlog >torn.rlog
"$rubble" map torn.rlog --localise first --out torn >table.txt
[[ $? == 1 ]] && grep -q 'NOT AS EXPECTED .*does not know its place .*: give --start, the whole log, or' table.txt ||
  fail "a torn log without a place is not told: $(cat table.txt)"
# Ctrl-C before the place is found: no more is wrong than that. Struck anew where the program was too early or too late.
for _ in $(seq 30); do
  rm -rf cut
  "$rubble" map first --localise first --out cut >table.txt 2>err.txt &
  mapping=$!
  until [[ -e cut/versions.json ]] || ! kill -0 $mapping 2>/dev/null; do sleep 0.005; done
  kill -INT $mapping 2>/dev/null
  wait $mapping
  code=$?
  [[ $code == 130 ]] && grep -q '"place_known": 0' cut/score.json 2>/dev/null && break
done
[[ $code == 130 ]] || fail "no Ctrl-C came before the place was found: $code"
json_holds cut/score.json "j['place_known'] == 0 and j['end'] == 'interrupted'"
! grep 'NOT AS EXPECTED' table.txt || fail "Ctrl-C counts as a place that is not found"

"$rubble" export first graph.g2o >/dev/null && grep -q '^EDGE_SE2' graph.g2o || fail "no graph.g2o"
"$rubble" export first map.simplemap >/dev/null && [[ -s map.simplemap ]] || fail "no map.simplemap"

"$rubble" merge first mapped --out both >/dev/null || fail "merge ended with $?"
for name in map.rmap map.tif map.pgm; do [[ -s both/$name ]] || fail "both/$name is missing"; done
[[ -z $(find both -empty) ]] || fail "a merged folder has empty files: $(find both -empty)"
grep -q '"commit"' both/versions.json || fail "a merged folder does not say what made it: $(ls both)"
for name in pois.csv victims.csv estimate_live.tum; do [[ ! -e both/$name ]] || fail "a merged folder has $name, of nothing"; done
grep -q '^# no way' both/estimate.tum || fail "of two drives at one time there is a way: $(head -3 both/estimate.tum)"
"$rubble" merge first mapped --out both --force >merge.txt || fail "a merged folder is not replaced: $?"
grep -qx 'stays with the runs  *victims, logs and scores, and trajectories: both drives cover the same time' merge.txt || fail "what a merged folder has not is not told: $(cat merge.txt)"
"$rubble" map first --localise both --start 0,0,0 --out in_both >/dev/null || fail "the merged map is no map"
json_holds in_both/score.json "j['place_known'] == 1"

# A second robot starts where the first one did, turned by a quarter: so its map is told to lie, and what is worked at.
python3 - <<'PY'
import re
text = open('first/arena.yaml').read()
open('turned.yaml', 'w').write(re.sub(r'(heading_deg: )(-?\d+)', lambda m: m[1] + str(int(m[2]) + 90), text, count=1))
PY
cmp -s first/arena.yaml turned.yaml && fail "the arena names no heading"
"$rubble" run s.yaml --set "arena={file: $work/turned.yaml}" --seed 4 --out rosie >/dev/null || fail "the second robot: $?"
"$rubble" merge first rosie --out two >merge.txt 2>err.txt || fail "merge ended with $?: $(cat err.txt)"
python3 - <<'PY' || fail "how the two maps lie is not told: $(cat merge.txt)"
import re, sys
text = open('merge.txt').read()
x, y, turned = map(float, re.search(r'^start of the second in the first +(\S+), (\S+) m, heading (\S+) deg$', text, re.M).groups())
common, way = map(float, re.search(r"^way in common +(\S+) m of the second one's (\S+) m$", text, re.M).groups())
sys.exit(0 if abs(x) < 0.1 and abs(y) < 0.1 and abs(turned - 90) < 3 and 1 < common <= way else 1)
PY
[[ $(grep -cx 'looks for a place that both show' merge.txt) == 1 ]] || fail "what is done is not told once: $(cat merge.txt)"
[[ -s err.txt ]] && fail "two maps are said to be one: $(cat err.txt)"
expect_exit 0 'first: is the same map as first' "$rubble" merge first first --out twice

# Why two maps are not merged; on a terminal how far the search is, and the reason on a line of its own.
expect_exit 3 'brief: shows no place of first for sure: they have too little in common' "$rubble" merge first brief --out none
[[ ! -e none ]] || fail "a merge that is refused leaves a folder"
script -qec "$rubble merge first brief --out none" /dev/null </dev/null >terminal.txt 2>&1
grep -qE 'looks for a place that both show  [0-9]+ %' terminal.txt || fail "a terminal is not told how far it is: $(cat terminal.txt)"
python3 - "$rubble" >terminal2.txt <<'PY' || fail "an interrupted merge ends otherwise: $(cat terminal2.txt)"
import os, pty, signal, sys
child, end = pty.fork()
if child == 0:
    os.execv(sys.argv[1], [sys.argv[1], "merge", "first", "rosie", "--out", "none"])
said = b""
try:
    while piece := os.read(end, 4096):
        if b"%" in piece and b"%" not in said: os.kill(child, signal.SIGINT)
        said += piece
except OSError: pass
code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
print(code, said)
sys.exit(0 if code == 130 and said.endswith(b"\r\033[Krubble: interrupted\r\n") else 1)
PY
grep -qE $'\r\033\\[Krubble: brief: shows no place' terminal.txt || fail "the reason shares its line: $(cat -v terminal.txt)"

# Of a folder that was mapped from a log the truth is not known, and the run beside it has one.
touch first/truth.tif
expect_exit 3 "own/truth.tif: is not there; 'rubble map' wrote the folder, and of a log the truth is not known; give that of a folder that 'rubble run' wrote, the newest beside it is " \
  "$rubble" score own/map.tif own/truth.tif

# A replay that is interrupted says so, and what its folder is.
"$rubble" replay first --out again >/dev/null 2>err.txt &
replay=$!
until [[ -e again/estimate.tum ]]; do sleep 0.01; done
kill -INT $replay
wait $replay
[[ $? == 130 ]] || fail "an interrupted replay must end with 130: $(cat err.txt)"
grep -qx 'rubble: interrupted, so nothing is compared; again holds the run up to then' err.txt || fail "an interrupted replay does not say so: $(cat err.txt)"

expect_exit 2 '--continue' "$rubble" map first --continue first --localise first
expect_exit 2 'x,y,heading_deg' "$rubble" map first --continue first --start here
expect_exit 2 'needs a map' "$rubble" map first --start 0,0,0
expect_exit 3 'nowhere' "$rubble" map first --continue nowhere
mkdir empty
expect_exit 3 'holds no map.rmap' "$rubble" map first --continue empty
head -c 5000 first/map.rmap >cut.rmap
expect_exit 3 'cut.rmap: holds' "$rubble" map first --continue cut.rmap
expect_exit 3 'is no map with a graph' "$rubble" map first --localise s.yaml
expect_exit 3 "cannot go on with a map" "$rubble" map first --continue first --set mapper.kind=paper
expect_exit 3 'holds no map.rmap' "$rubble" export empty graph2.g2o
finish
