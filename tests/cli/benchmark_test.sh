# rubble benchmark: a small list by all outputs; logs that are not there; lists that cannot be.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
"$rubble" run s.yaml --out run --set time_limit_s=60 >/dev/null || fail "run ended with $?"
"$rubble" export run/log.rlog drive.rawlog >/dev/null || fail "export ended with $?"
cat >list.yaml <<'YAML'
name: small
about: a drive <by> a robot
mappers:
  - {kind: paper}
  - {kind: robust}
  - {kind: robust, name: open, set: {loops: false}}
cases:
  - {name: arena, scenario: s.yaml, seed: 3, goal_m: 5}
  - name: drive
    log: drive.rawlog
    published: [{by: Somebody, error_m: 0.5, source: "A paper | with a bar"}]
  - {name: lost, log: nowhere.log, goal_m: 1}
YAML
"$rubble" benchmark list.yaml --json --html b.html --markdown b.md >b.json 2>err.txt || fail "benchmark ended with $?: $(cat err.txt)"
json_holds b.json "[c['name'] for c in j['cases']] == ['arena', 'drive', 'lost']"
json_holds b.json "all([r['mapper'] for r in c['results']] == ['paper', 'robust', 'open'] for c in j['cases'])"
json_holds b.json "all(r['goal_met'] and r['error_m'] < 0.5 and r['scans'] > 100 and r['peak_mb'] > 5 for r in j['cases'][0]['results'])"
json_holds b.json "all(0.01 < r['usual_ms'] <= r['slow_ms'] <= r['worst_ms'] for r in j['cases'][0]['results'])"
json_holds b.json "all(r['scans'] > 100 and r['goal_met'] is None for r in j['cases'][1]['results'])"
json_holds b.json "all(r['missing'] == 'nowhere.log' and r['error_m'] is None and r['goal_met'] is None for r in j['cases'][2]['results'])"
json_holds b.json "j['cases'][1]['published'][0]['error_m'] == 0.5"
json_holds b.json "j['cases'][0]['results'][2]['loops_closed'] == 0"
json_holds b.json "[r['loops_false'] for r in j['cases'][0]['results']] == [None, 0, 0]"
json_holds b.json "[None if r['most_work_ms'] is None else 0.01 < r['most_work_ms'] < 20 for r in j['cases'][0]['results']] == [None, True, True]"
json_holds b.json "list(j['cases'][0]['results'][0]).index('most_work_ms') == list(j['cases'][0]['results'][0]).index('worst_ms') + 1"
for page in b.html b.md; do
  tr '\n' ' ' <$page | grep -qE 'worst ms( \| |</th><th>)most work( \| |</th><th>)finish ms' || fail "$page does not tell the work beside the times"
done
for page in b.html b.md; do
  grep -qF 'loops and doubts the sums, and scans/s is all scans by all CPU time' $page || fail "$page does not tell what figures of several runs are"
done
grep -q '&lt;by&gt;' b.html || fail "the page does not escape what the list says"
grep -qE '(src|href)=' b.html && fail "the page refers to other files"
grep -q 'A paper / with a bar' b.md || fail "the document's table is broken by a bar"
"$rubble" benchmark list.yaml --mapper robust >b.txt 2>/dev/null || fail "the table ended with $?"
grep -q 'worst ms  most work  finish ms' b.txt || fail "the table does not tell the work beside the times"
grep -q 'not there: nowhere.log' b.txt || fail "the table does not tell the missing log"
"$rubble" benchmark list.yaml --mapper robust >out.txt 2>err.txt || fail "the table ended with $?"
tail -n 1 err.txt | grep -qF '1 of 3 cases were left out, as what they name is not there; give the folder of the logs with --data' ||
  fail "cases that were left out are not told: $(cat err.txt)"
# Where nobody looks at a terminal there is a line for each mapper that is through with a case, and no more.
[[ $(head -n -1 err.txt | sed -E 's/[0-9.]+ m off/X m off/') == "rubble: case 1 of 3: arena, robust: X m off
rubble: case 2 of 3: drive, robust: done
rubble: case 3 of 3: lost, robust: not there: nowhere.log" ]] || fail "how far it is is told otherwise: $(cat err.txt)"
# On a terminal each line takes the place of the one before and tells how much of the log is done.
python3 - "$rubble" >terminal.txt <<'PY'
import os, pty, sys
child, end = pty.fork()
if child == 0:
    os.execv(sys.argv[1], [sys.argv[1], "benchmark", "list.yaml", "--mapper", "robust"])
said = b""
try:
    while piece := os.read(end, 4096): said += piece
except OSError: pass
assert os.waitpid(child, 0)[1] == 0
print("\n".join(said.decode().split("\r\033[K")))
PY
grep -q '^case 1 of 3: arena, robust$' terminal.txt || fail "a terminal is not told the case: $(cat terminal.txt)"
[[ $(grep -cE '^case 2 of 3: drive, robust  [0-9]+ %$' terminal.txt) -ge 3 ]] || fail "a terminal is not told the share of the log: $(cat terminal.txt)"
expect_exit 3 "none of that name is shipped, did you mean 'benchmark'?; shipped are benchmark, benchmark_arenas" \
  "$rubble" benchmark bencmark
grep -q 'paper  ' b.txt && fail "--mapper robust ran others"

# Relations are judged by their distance and by their heading: here those of the true path, and the same turned a bit.
python3 - <<'PY'
import math
poses = []
for line in open('run/truth.tum'):
    t, x, y, _, _, _, z, w = map(float, line.split())
    if t >= 2 and (not poses or t >= poses[-1][0] + 5): poses.append((t, x, y, 2 * math.atan2(z, w)))
for name, turn in (('true', 0), ('turned', 0.05)):
    with open(name + '.relations', 'w') as out:
        for (t, x, y, h), (u, v, w, k) in zip(poses, poses[1:]):
            c, s = math.cos(h), math.sin(h)
            out.write(f'{t} {u} {c * (v - x) + s * (w - y)} {c * (w - y) - s * (v - x)} 0 0 0 {k - h + turn}\n')
PY
cat >relations.yaml <<'YAML'
mappers: [{kind: robust}]
cases:
  - {name: by the truth, log: run/log.rlog, relations: true.relations, goal_m: 0.2, goal_deg: 2}
  - {name: by another, log: run/log.rlog, relations: turned.relations, goal_m: 0.2, goal_deg: 2}
  - {name: of the heading alone, log: run/log.rlog, relations: turned.relations, goal_deg: 2}
YAML
"$rubble" benchmark relations.yaml --json --markdown relations.md >relations.json 2>err.txt || fail "benchmark of relations ended with $?: $(cat err.txt)"
json_holds relations.json "[c['results'][0]['goals_missed'] for c in j['cases']] == [[], ['deg'], ['deg']]"
json_holds relations.json "[c['results'][0]['goal_met'] for c in j['cases']] == [True, False, False] and j['cases'][0]['goal_deg'] == 2"
json_holds relations.json "abs(j['cases'][1]['results'][0]['error_deg'] - 2.865) < 0.6"
commit=$("$rubble" --version | python3 -c 'import json, sys; print(json.load(sys.stdin)["commit"])')
grep -q "of commit $commit\\." relations.md || fail "the page does not name the commit $commit: $(cat relations.md)"
json_holds relations.json "j['commit'] == '$commit' and j['cases'][0]['results'][0]['doubted'] == 0"
grep -q '| 0.2, 2 deg | no: deg |' relations.md || fail "the goal of the heading is not told: $(cat relations.md)"
grep -q '| 2 deg | no: deg |' relations.md || fail "a goal of the heading alone is not told: $(cat relations.md)"
printf 'mappers: [{kind: robust}]\ncases: [{name: a, log: x, goal_deg: 1}]\n' >heading.yaml
expect_exit 3 "give 'relations'" "$rubble" benchmark heading.yaml

# Several seeds: medians and the worst, goals of each, and a case with settings of its own.
cat >seeds.yaml <<'YAML'
mappers: [{kind: robust}]
cases:
  - {name: three, scenario: s.yaml, seeds: 3-5, goal_m: 5, worst_goal_m: 5, live_goal_m: 5, false_loops_goal: 0}
  - {name: strict, scenario: s.yaml, seeds: 3-5, goal_m: 5, worst_goal_m: 0.00001, scans_per_s_goal: 1e9, ms_99_goal: 1e6, worst_ms_goal: 0}
  - {name: first, scenario: s.yaml, seed: 3}
  - {name: second, scenario: s.yaml, seed: 4}
  - {name: third, scenario: s.yaml, seed: 5}
  - {name: cut, scenario: s.yaml, seed: 3, set: {mapper.max_range_m: 2, time_limit_s: 20}}
YAML
"$rubble" benchmark seeds.yaml --json >seeds.json 2>err.txt || fail "benchmark of seeds ended with $?: $(cat err.txt)"
json_holds seeds.json "[c['results'][0]['runs'] for c in j['cases']] == [3, 3, 1, 1, 1, 1]"
json_holds seeds.json "(lambda e, r: (r['error_m'], r['worst_m']) == (e[1], e[2]))(sorted(c['results'][0]['error_m'] for c in j['cases'][2:5]), j['cases'][0]['results'][0])"
json_holds seeds.json "j['cases'][0]['results'][0]['scans'] == sum(c['results'][0]['scans'] for c in j['cases'][2:5])"
json_holds seeds.json "j['cases'][0]['results'][0]['most_work_ms'] == max(c['results'][0]['most_work_ms'] for c in j['cases'][2:5])"
json_holds seeds.json "all(abs(three[k] - sum(r[k] for r in one)) < 1e-9 for three, one in [(j['cases'][0]['results'][0], [c['results'][0] for c in j['cases'][2:5]])] for k in ('loops_closed', 'loops_removed', 'loops_false', 'doubted'))"
json_holds seeds.json "[c['results'][0]['goal_met'] for c in j['cases'][:3]] == [True, False, None]"
json_holds seeds.json "j['cases'][1]['results'][0]['goals_missed'] == ['worst', 'scans/s', 'worst ms']"
json_holds seeds.json "j['cases'][0]['results'][0]['goals_missed'] == [] and j['cases'][1]['scans_per_s_goal'] == 1e9"
json_holds seeds.json "j['cases'][2]['results'][0]['worst_m'] is None"
json_holds seeds.json "j['cases'][5]['results'][0]['scans'] < j['cases'][2]['results'][0]['scans']"
printf 'mappers: [{kind: robust}]\ncases: [{name: a, log: x, seeds: 1-3}]\n' >logs.yaml
expect_exit 3 'logs.yaml:2' "$rubble" benchmark logs.yaml
printf 'mappers: [{kind: robust}]\ncases: [{name: a, scenario: s.yaml, seed: 1, worst_goal_m: 1}]\n' >worst.yaml
expect_exit 3 "give 'seeds'" "$rubble" benchmark worst.yaml
printf 'mappers: [{kind: robust}]\ncases: [{name: a, scenario: s.yaml, seeds: 5-3}]\n' >range.yaml
expect_exit 3 'neither a seed nor a range' "$rubble" benchmark range.yaml
printf 'mappers: [{kind: robust}]\ncases: [{name: a, scenario: s.yaml, set: {mapper.nothing: 1}}]\n' >key.yaml
expect_exit 3 'nothing' "$rubble" benchmark key.yaml
# A key that one of the mappers lacks costs no run of the others.
printf 'mappers: [{kind: robust}, {kind: paper}]\ncases: [{name: a, scenario: s.yaml}, {name: b, scenario: s.yaml, set: {mapper.loop_search.window_m: 2}}]\n' >late.yaml
expect_exit 3 'loop_search' timeout 2 "$rubble" benchmark late.yaml
# Four scans of a UTM come in one tick: the time of one is its share, so that scans/s of it are about as many as all.
cat >utm.yaml <<'YAML'
mappers: [{kind: robust}]
cases: [{name: utm, scenario: s.yaml, seed: 3, set: {robot.laser.model: UTM-30LX, time_limit_s: 60}}]
YAML
"$rubble" benchmark utm.yaml --json >utm.json 2>err.txt || fail "benchmark of a UTM ended with $?: $(cat err.txt)"
json_holds utm.json "(lambda r: r['scans'] > 1000 and r['usual_ms'] * r['scans_per_second'] < 2000)(j['cases'][0]['results'][0])"

# Of a mapper that is another program its own processes are measured: 20 ms of each scan, once 300 ms in a process that
# ends, 100 MB in it and as much in another beside it.
python3 - "$source/examples/python_mapper.py" >busy.py <<'PY'
import sys
text = open(sys.argv[1]).read()
scan, main = "                last_scan = scan[0]\n", '\n\nif __name__ == "__main__":'
assert text.count(scan) == 1 and text.count(main) == 1
text = text.replace(scan, scan + "                work()\n")
print(text.replace(main, """
import subprocess
import time

HELD = b"1" * (100 << 20)
BESIDE = subprocess.Popen([sys.executable, "-c", "import time; held = b'1' * (100 << 20); time.sleep(1000)"])
BURN = "import time\\nwhile time.process_time() < 0.3: pass"
worked = 0


def work():
    global worked
    worked += 1
    if worked == 20:
        subprocess.run([sys.executable, "-c", BURN])
    end = time.process_time() + 0.02
    while time.process_time() < end:
        pass
""" + main))
PY
cat >program.yaml <<'YAML'
mappers: [{kind: robust}]
cases:
  - {name: arena, scenario: s.yaml, seed: 3, set: {time_limit_s: 15}}
  - {name: drive, log: drive.rawlog}
YAML
"$rubble" benchmark program.yaml --mapper-command "python3 busy.py" --json >program.json 2>err.txt || fail "benchmark of a program ended with $?: $(cat err.txt)"
grep -q '^mapper command  *python3 busy.py$' err.txt || fail "the command is not told beside the JSON: $(cat err.txt)"
json_holds program.json "all([r['mapper'] for r in c['results']] == ['robust', 'process'] and c['results'][1]['scans'] > 30 for c in j['cases'])"
json_holds program.json "all(20 <= c['results'][1]['usual_ms'] < 200 and c['results'][1]['scans_per_second'] < 50 for c in j['cases'])"
json_holds program.json "all(300 <= c['results'][1]['worst_ms'] < 3000 and 0 <= c['results'][1]['finish_ms'] < 1000 for c in j['cases'])"
json_holds program.json "all(200 < c['results'][1]['peak_mb'] < 400 for c in j['cases'])"
json_holds program.json "all(c['results'][0]['usual_ms'] < 10 and c['results'][1]['most_work_ms'] is None for c in j['cases'])"

# The list of arenas that ships can be run: here for a second of two seeds each.
python3 - "$source/scenarios" >short.yaml <<'PY'
import re, sys
folder = sys.argv[1]
text = open(folder + "/benchmark_arenas.yaml").read()
text = re.sub(r"scenario: (\S+)", rf"scenario: {folder}/\1", text)
text = re.sub(r"seeds: \S+", "seeds: 1-2", text)
text = re.sub(r"    set: \{", "    set: {time_limit_s: 1, ", text)
text = re.sub(r"(    seeds: 1-2\n)(?!    set)", r"\1    set: {time_limit_s: 1}\n", text)
print(re.sub(r"    (worst_)?goal_m: \S+\n", "", text))
PY
"$rubble" benchmark short.yaml --json >short.json 2>err.txt || fail "the shipped list ended with $?: $(cat err.txt)"
json_holds short.json "all(c['worst_ms_goal'] == 20 and c['ms_99_goal'] == 1.5 and c['scans_per_s_goal'] == 8000 for c in j['cases'])"
json_holds short.json "len(j['cases']) >= 7 and all(r['runs'] == 2 for c in j['cases'] for r in c['results'])"

# A run that cannot be judged meets no goal.
printf 'mappers: [{kind: robust}]\ncases: [{name: a, scenario: s.yaml, seed: 3, goal_m: 1, worst_ms_goal: 1e6, set: {time_limit_s: 5}}]\n' >unjudged.yaml
"$rubble" benchmark unjudged.yaml --json >unjudged.json 2>err.txt
[[ $? == 4 ]] || fail "a run that cannot be judged must end with 4: $(cat err.txt)"
json_holds unjudged.json "(lambda r: 'cannot be judged' in r['failure'] and r['goal_met'] is None)(j['cases'][0]['results'][0])"

# A log is judged by the trajectory that the list names, or that lies beside it; a run folder by its truth.
cp run/log.rlog named.rlog && cp run/log.rlog beside.rlog && cp run/log.rlog alone.rlog && cp run/truth.tum beside.tum
awk '{print $1, -$3 + 7, $2, $4, $5, $6, $7, $8}' run/truth.tum >turned.tum
cat >references.yaml <<'YAML'
mappers: [{kind: robust}]
cases:
  - {name: folder, log: run, goal_m: 0.2}
  - {name: file, log: run/log.rlog, goal_m: 0.2}
  - {name: beside, log: beside.rlog, goal_m: 0.2}
  - {name: named, log: named.rlog, reference: turned.tum, goal_m: 0.2}
  - {name: alone, log: alone.rlog, goal_m: 0.2, ms_99_goal: 1e5}
  - {name: slow, log: alone.rlog, goal_m: 0.2, ms_99_goal: 0}
  - {name: without a goal, log: alone.rlog}
YAML
"$rubble" benchmark references.yaml --json --markdown references.md >references.json 2>err.txt || fail "benchmark by references ended with $?: $(cat err.txt)"
json_holds references.json "(lambda e: 0 < e[0] < 0.2 and all(abs(x - e[0]) < 1e-6 for x in e))([c['results'][0]['error_m'] for c in j['cases'][:4]])"
json_holds references.json "[c['results'][0]['goal_met'] for c in j['cases']] == [True] * 4 + [None, False, None]"
json_holds references.json "[c['results'][0].get('not_judged') for c in j['cases']] == [None] * 4 + ['no reference'] * 2 + [None]"
json_holds references.json "all(c['results'][0]['scans_per_second'] > 0 and c['results'][0]['error_m'] is None and c['results'][0]['loops_closed'] is not None for c in j['cases'][4:])"
grep -qF '| not judged: no reference |' references.md || fail "that a goal is not judged is not told: $(cat references.md)"
grep -qF '| no: 99 % ms; not judged: no reference |' references.md || fail "a goal that is missed beside one that is not judged is not told"
tail -n 1 err.txt | grep -qF "no reference to judge by: alone, slow; give the case a trajectory, 'reference: FILE.tum'" || fail "it is not told which logs have no reference: $(cat err.txt)"
printf 'mappers: [{kind: robust}]\ncases: [{name: a, log: alone.rlog, reference: true.relations}]\n' >reference.yaml
expect_exit 3 'true.relations:1' "$rubble" benchmark reference.yaml
printf 'mappers: [{kind: robust}]\ncases: [{name: a, log: alone.rlog, reference: beside.tum, relations: true.relations}]\n' >reference.yaml
expect_exit 3 "beside 'relations'; keep one of them" "$rubble" benchmark reference.yaml

# A mapper that takes too long is stopped, the others are not.
cat >slow.yaml <<YAML
cpu_limit_s: 1
mappers: [{kind: robust}]
cases:
  - {name: long, scenario: s.yaml, seed: 3, set: {time_limit_s: 36000, arena.generate.columns: 16, arena.generate.rows: 16}}
  - {name: short, scenario: s.yaml, seed: 3, set: {time_limit_s: 20}}
YAML
"$rubble" benchmark slow.yaml --json >slow.json 2>err.txt || fail "benchmark with a limit ended with $?: $(cat err.txt)"
json_holds slow.json "'stopped after 1 s of CPU time' in j['cases'][0]['results'][0]['failure']"
json_holds slow.json "'failure' not in j['cases'][1]['results'][0] and j['cases'][1]['results'][0]['scans'] > 10"
json_holds slow.json "0.01 < j['cases'][1]['results'][0]['usual_ms']"  # a limit must not make the clock coarse

# Interrupted it ends what runs, and table, pages and JSON say what is missing: here all but the first case.
cat >cut.yaml <<YAML
mappers: [{kind: robust}, {kind: paper}]
cases:
  - {name: short, scenario: s.yaml, seed: 3, set: {time_limit_s: 20}}
  - {name: long, scenario: s.yaml, seeds: 3-4, set: {time_limit_s: 360000, arena.generate.columns: 16, arena.generate.rows: 16}}
  - {name: last, log: drive.rawlog}
YAML
"$rubble" benchmark cut.yaml --json --html cut.html --markdown cut.md >cut.json 2>err.txt &
benchmark=$!
for _ in $(seq 600); do
  grep -q 'short, paper: ' err.txt && break
  sleep 0.1
done
kill -INT $benchmark
wait $benchmark
[[ $? == 130 ]] || fail "an interrupted benchmark must end with 130: $(cat err.txt)"
json_holds cut.json "j['interrupted'] and [(g['case'], g['mapper'], g['runs'], g['seeds']) for g in j['not_run']] == [('long', 'robust', 0, 2), ('long', 'paper', 0, 2), ('last', 'robust', 0, 1), ('last', 'paper', 0, 1)]"
json_holds cut.json "[len(c['results']) for c in j['cases']] == [2]"
for page in cut.html cut.md; do
  grep -qF 'Interrupted, so these are not run to their end: long (robust, paper), last (robust, paper).' $page || fail "$page does not tell what is missing"
done
grep -qF Interrupted b.html b.md && fail "a page of a benchmark that was not interrupted says so"
json_holds b.json "not j['interrupted'] and j['not_run'] == []"

printf 'cpu_limit_s: 0\nmappers: [{kind: robust}]\ncases: [{name: a, log: x}]\n' >limit.yaml
expect_exit 3 'limit.yaml:1' "$rubble" benchmark limit.yaml

expect_exit 2 "--mapper robst: list.yaml has no mapper of that name, did you mean 'robust'?; it has paper, robust, open" \
  "$rubble" benchmark list.yaml --mapper robst
expect_exit 3 '--data /nowhere: there is no such folder' "$rubble" benchmark list.yaml --data . --data /nowhere
expect_exit 3 '--data s.yaml: there is no such folder' "$rubble" benchmark list.yaml --data s.yaml
# Slips in a list are told where they stand in it.
slip() {
  printf '%s\n' "$1" >slip.yaml
  expect_exit 3 "$2" "$rubble" benchmark slip.yaml
}
slip 'mapers: [{kind: robust}]
cases: [{name: a, scenario: s.yaml}]' "slip.yaml:1:1: unknown key 'mapers', did you mean 'mappers'?"
slip 'mappers: [{kind: robust}]
case: [{name: a, scenario: s.yaml}]' "slip.yaml:2:1: unknown key 'case', did you mean 'cases'?"
slip 'mappers: [{knid: robust}]
cases: [{name: a, scenario: s.yaml}]' "slip.yaml:1:12: unknown key 'knid', did you mean 'kind'?"
slip 'mappers: [{kind: robust}]
cases: [{name: a, scenaro: s.yaml}]' "slip.yaml:2:19: unknown key 'scenaro', did you mean 'scenario'?"
slip 'mappers: [{kind: robst}]
cases: [{name: a, scenario: s.yaml}]' "slip.yaml:1:12: 'kind' is 'robst'; give one of"
slip 'mappers:
  - {kind: robust, set: {resolution: 0.1}}
cases: [{name: a, scenario: s.yaml}]' "slip.yaml:2:26: unknown key 'resolution', did you mean 'resolution_m'?"
slip 'mappers:
  - {kind: process, set: {command: touch ran}}
cases: [{name: a, scenario: s.yaml}]' "slip.yaml:2:27: mapper.command: 'touch ran' stands in a file, and a command of a file runs only with --allow-commands"
slip 'mappers: [{kind: robust}]
cases:
  - {name: a, scenario: s.yaml, set: {time_limit: 3}}' "slip.yaml:3:39: unknown key 'time_limit', did you mean 'time_limit_s'?"
[[ -e ran ]] && fail "a command of a list ran unasked"
expect_exit 2 '--mapper nobody' "$rubble" benchmark list.yaml --mapper nobody
expect_exit 3 'nowhere.yaml' "$rubble" benchmark nowhere.yaml
printf 'mappers: [{kind: robust}]\n' >none.yaml
expect_exit 3 'none.yaml' "$rubble" benchmark none.yaml
printf 'mappers: [{kind: robust}]\ncases: [{name: a, log: x, scenario: y}]\n' >both.yaml
expect_exit 3 'both.yaml:2' "$rubble" benchmark both.yaml
printf 'mappers: [{kind: robust}, {kind: robust}]\ncases: [{name: a, log: x}]\n' >twice.yaml
expect_exit 3 'twice' "$rubble" benchmark twice.yaml
printf 'mappers: [{kind: robust}]\ncases: [{name: a, log: gone.log}]\n' >gone.yaml
"$rubble" benchmark gone.yaml >out.txt 2>err.txt
[[ $? == 3 ]] || fail "a list without any of its logs must end with 3"
grep -q -- '--data' err.txt || fail "it is not told where logs are looked for"
finish
