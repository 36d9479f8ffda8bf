# Many runs: the same bytes for 1, 2 and 3 workers, kill and go on, disk full, merge, report, compare, check.
. "$(dirname "$0")/lib.sh"
small_scenario small.yaml
cat >sweep.yaml <<'YAML'
scenarios: [small.yaml]
seeds: 1-6
set: {time_limit_s: 60, robot.levelling: [true, false]}
YAML

for n in 1 2 3; do
  "$rubble" batch sweep.yaml --workers $n --out w$n >table$n.txt 2>err$n.txt ||
    fail "$n workers ended with $?: $(cat table$n.txt err$n.txt)"
  sort w$n/results.jsonl >sorted$n
done
[[ $(wc -l <sorted1) == 12 ]] || fail "not 12 runs: $(wc -l <sorted1)"
cmp sorted1 sorted2 || fail "1 and 2 workers differ"
cmp sorted1 sorted3 || fail "1 and 3 workers differ"
[[ -e w1/latest || -e w1/runs/latest ]] && fail "a batch must not touch the link latest"
[[ -e $(ls -d w1/runs/*/ | head -1)/log.rlog ]] && fail "logs are kept without --record"

# What it costs is told before the first run, beside the table, not in it: what is left, not what is there.
for n in 1 2 3; do
  [[ $(head -1 err$n.txt) == "rubble: 12 runs, $n at a time, into w$n" ]] || fail "the cost is not told: $(cat err$n.txt)"
  grep -q 'at a time' table$n.txt && fail "the table holds what is told at the start"
done
"$rubble" batch sweep.yaml --workers 1 --out w1 >table.txt 2>err.txt || fail "a finished sweep ended with $?"
[[ $(cat err.txt) == 'rubble: 0 runs left of 12, all are in w1' ]] || fail "nothing is left: $(cat err.txt)"
expect_exit 3 "shipped are" "$rubble" batch nosweep
grep -q regression_arena err.txt && fail "a scenario is listed as a sweep: $(cat err.txt)"
expect_exit 3 "'arena' is of a scenario, and a batch makes the runs of a sweep" "$rubble" batch regression_arena
# A sweep may begin with its seeds; a neighbour that cannot be read is no sweep, and no hindrance.
mkdir -p home/scenarios/sweeps/folder.yaml
printf 'seeds: 1-2\nscenarios: [small.yaml]\n' >home/scenarios/sweeps/seeds_first.yaml
expect_exit 3 'shipped are seeds_first' env RUBBLE_HOME="$work/home" "$rubble" batch nosweep
sed 's/^seeds:/seed:/' sweep.yaml >misspelt.yaml
expect_exit 3 "misspelt.yaml:2:1: unknown key 'seed', did you mean 'seeds'?" "$rubble" batch misspelt.yaml

# Runs and batches do not write into each other's folders; neither is touched.
(cd w1 && find . -type f -exec cksum {} + | sort) >before.txt
for force in '' --force; do
  # shellcheck disable=SC2086
  expect_exit 3 "w1: is the folder of a batch (it holds results.jsonl); give the run a folder of its own with --out" \
    "$rubble" run small.yaml --out w1 $force
done
(cd w1 && find . -type f -exec cksum {} + | sort) | cmp - before.txt || fail "a run was made in the folder of a batch"
one=$(ls -d w1/runs/*/ | head -1)
cp -r "$one" single && ls -A single >before.txt
for how in '' '--slurm --no-submit'; do
  # shellcheck disable=SC2086
  expect_exit 3 "single: is the folder of a single run (it holds score.json); give the batch a folder of its own with --out" \
    "$rubble" batch sweep.yaml --out single $how
done
ls -A single | cmp - before.txt || fail "a batch was made in the folder of a run"

# A finished sweep is found finished.
"$rubble" batch sweep.yaml --out w1 | grep -q '12 of 12 (0 made now' || fail "finished runs are made again"

# Killed in the middle and started again: no run lost, none twice.
for wait in 0.8 1.2 1.6; do
  "$rubble" batch sweep.yaml --workers 2 --out killed >/dev/null 2>&1 &
  pid=$!
  sleep $wait
  kill -KILL $pid 2>/dev/null
  wait $pid 2>/dev/null
done
"$rubble" batch sweep.yaml --workers 2 --out killed >/dev/null || fail "going on after a kill ended with $?"
sort killed/results.jsonl | cmp - sorted1 || fail "after kills the results differ"
# A torn last line is dropped and its run made again.
head -c -30 killed/results.jsonl >torn && cp torn killed/results.jsonl
"$rubble" batch sweep.yaml --workers 1 --out killed 2>err.txt | grep -q '12 of 12 (1 made now' ||
  fail "a torn line must cost one run"
grep -qx 'rubble: 1 run left of 12, 1 at a time, into killed' err.txt || fail "what is left is not told: $(cat err.txt)"
sort killed/results.jsonl | cmp - sorted1 || fail "after a torn line the results differ"

# Interrupted: 130, what is finished stays.
"$rubble" batch sweep.yaml --workers 1 --out stopped --set time_limit_s=240 >out.txt 2>&1 &
pid=$!
sleep 2
kill -INT $pid
wait $pid
code=$?
[[ $code == 130 || $(wc -l <stopped/results.jsonl) == 12 ]] || fail "an interrupt must end with 130, not $code: $(cat out.txt)"

# A run that takes too long, and one that cannot start, are recorded; the sweep goes on.
cat >long.yaml <<'YAML'
name: long
arena: {generate: {columns: 20, rows: 20, loops: 0.3}}
time_limit_s: 100000
YAML
cat >faults.yaml <<'YAML'
scenarios: [small.yaml, long.yaml]
seeds: 1
run_limit_s: 6
set: {scoring.tau_m: 0.5}
YAML
"$rubble" batch faults.yaml --out faults >/dev/null 2>err.txt
[[ $? == 4 ]] || fail "a sweep with a run that hangs must end with 4: $(cat err.txt)"
grep -q '"status":"timeout"' faults/results.jsonl || fail "the run that hangs is not recorded"
[[ $(wc -l <faults/results.jsonl) == 2 ]] || fail "the sweep did not go on after a run that hangs"

# How far it is, also where no terminal is: in lines of their own, few, and not in the table.
printf 'scenarios: [long.yaml, small.yaml]\nseeds: 1\nrun_limit_s: 11\n' >slow.yaml
"$rubble" batch slow.yaml --workers 1 --out slow >table.txt 2>err.txt
# After the cost: what is gone is the limit at least, more on a busy machine; ten seconds lie between two lines.
python3 - err.txt <<'PY' || fail "how far a batch is is not told: $(cat err.txt)"
import re, sys
seconds = lambda t: sum(int(n) * f for n, f in zip(t.split(':'), (3600, 60, 1)))
said = []
for line in open(sys.argv[1]).read().splitlines()[1:]:
    m = re.fullmatch(r'rubble: ([0-2]) of 2 runs, [01] running(, [12] FAILED)?, (\d+:\d\d:\d\d) gone(?:, (\d+:\d\d:\d\d) to go)?', line)
    if not m: sys.exit('not understood: ' + line)
    said.append((int(m[1]), m[2], seconds(m[3]), m[4]))
after_first = [s for s in said if s[0] == 1]
ok = after_first and all(s[1] == ', 1 FAILED' and s[2] >= 11 and seconds(s[3]) >= 11 for s in after_first)
ok = ok and all(b[2] - a[2] >= 9 for a, b in zip(said, said[1:]))  # whole seconds
sys.exit(0 if ok else 1)
PY
grep -q 'gone' table.txt && fail "the table holds how far the batch was: $(cat table.txt)"

# Disk full: a clear end, nothing corrupt, and going on afterwards. Needs root for a small file system.
mkdir full
if mount -t tmpfs -o size=600k none full 2>/dev/null; then
  "$rubble" batch sweep.yaml --out full/out >out.txt 2>err.txt
  [[ $? == 4 ]] || fail "a full disk ends otherwise: $(cat err.txt)"
  # The cost, then one line of what went wrong.
  [[ $(wc -l <err.txt) == 2 ]] && head -1 err.txt | grep -q '12 runs' && tail -1 err.txt | grep -q 'free some space' ||
    fail "a full disk is not told in one line: $(cat err.txt)"
  python3 -c "import json; [json.loads(l) for l in open('full/out/results.jsonl')]" || fail "disk full tore a line"
  mount -o remount,size=200m full
  "$rubble" batch sweep.yaml --out full/out >/dev/null || fail "after a full disk it cannot go on: $?"
  sort full/out/results.jsonl | cmp - sorted1 || fail "after a full disk the results differ"
  umount full
else
  echo "no small file system without root: disk full is skipped"
fi

# Shards in one folder, merged: missing ones are told, all give the same content as the whole, and idempotent.
"$rubble" batch sweep.yaml --shard 1/3 --out shards >/dev/null 2>err.txt || fail "shard 1 ended with $?"
grep -qE '^rubble: [1-9][0-9]* runs? of 12 in this shard, ' err.txt || fail "the shard's part is not told: $(cat err.txt)"
"$rubble" batch sweep.yaml --shard 1/3 --out shards >/dev/null 2>err.txt || fail "shard 1 again ended with $?"
grep -qE '^rubble: 0 runs left of [0-9]+ in this shard, all are in shards$' err.txt ||
  fail "a finished shard is not told: $(cat err.txt)"
for i in 2 3 4; do
  "$rubble" batch sweep.yaml --seeds 1 --shard $i/4 --set time_limit_s=2 --set robot.levelling=true --out few >/dev/null 2>err$i.txt ||
    fail "shard $i of a batch of few runs ended with $?: $(cat err$i.txt)"
done
grep -qxE 'rubble: shard [2-4] of 4 is empty: none of the [0-9]+ runs fell to it, there is nothing to do' err[2-4].txt ||
  fail "an empty shard is not told: $(cat err[2-4].txt)"
expect_exit 3 "shards: is the folder of a batch (it holds results-1of3.jsonl)" "$rubble" run small.yaml --out shards
expect_exit 4 'of the 12 runs its sweep asked for are missing' "$rubble" batch merge shards --out part.sqlite
for i in 2 3; do
  "$rubble" batch sweep.yaml --shard $i/3 --out shards >/dev/null || fail "shard $i ended with $?"
done
cat shards/results-*of3.jsonl | sort | cmp - sorted1 || fail "shards and whole differ"
"$rubble" batch merge shards --out shards.sqlite >/dev/null || fail "merge ended with $?"
"$rubble" batch merge w1 --out whole.sqlite >/dev/null || fail "merge ended with $?"
# A file that cannot be replaced, here as a mount point: told, and nothing is left beside it.
mkdir pinned
cp whole.sqlite pinned/all.sqlite
if mount --bind pinned/all.sqlite pinned/all.sqlite 2>/dev/null; then
  expect_exit 4 'all.sqlite: cannot be written' "$rubble" batch merge w1 --out pinned/all.sqlite
  umount pinned/all.sqlite
  [[ -z $(find pinned -name '*.part') ]] || fail "a merge that cannot be written leaves: $(ls pinned)"
else
  echo "no mount without root: a merge that cannot be written is skipped"
fi
python3 - <<'PY' || fail "merged shards and merged whole differ"
import sqlite3, sys
dump = lambda f: list(sqlite3.connect(f).execute('select * from runs order by run_id'))
a, b = dump('shards.sqlite'), dump('whole.sqlite')
sys.exit(0 if a == b and len(a) == 12 else 1)
PY
cp shards.sqlite before.sqlite
"$rubble" batch merge shards --out shards.sqlite | grep -q '0 of them new' || fail "a second merge adds runs"
cmp shards.sqlite before.sqlite || fail "a second merge changes the file"
# Of two merges into one folder the second waits: it would begin with what the first one has not finished.
flock . sleep 2 &
holder=$!
sleep 0.3
"$rubble" batch merge w1 --out waited.sqlite >/dev/null || fail "a merge that waits ended with $?"
! kill -0 $holder 2>/dev/null || fail "a merge does not wait for another one in its folder"

# Reports and comparison.
grep -q '<svg' w1/report.html || fail "no plots in the report"
grep -qE 'src="[^d]|https?://' w1/report.html && fail "the report refers to other files"
"$rubble" batch report --markdown w1 | grep -q 'robot.levelling=false' || fail "no section for documents"
"$rubble" compare w1 whole.sqlite --csv c.csv --json c.json --html c.html >c.txt || fail "compare ended with $?"
grep -q 'identical' c.txt || fail "a result compared with itself is not identical: $(cat c.txt)"
json_holds c.json "all(m['verdict'] == 'identical' for m in j['groups'][0]['metrics'].values()) and j['pairs'] == 12"
"$rubble" compare w1 --config-a robot.levelling=false --config-b robot.levelling=true >c.txt || fail "compare: $(cat c.txt)"
expect_exit 2 '--config-a' "$rubble" compare w1
expect_exit 3 'nothing1, nothing2: do not exist' "$rubble" compare nothing1 nothing2
expect_exit 3 'nothing2: does not exist' "$rubble" compare w1 nothing2
expect_exit 3 "'robot.levelling=false', 'robot.levelling=true'" "$rubble" compare w1 --config-a x --config-b robot.levelling=true

# Regression: unchanged passes, a worse parameter is caught, CI systems are told.
expect_exit 3 'there is no baseline' "$rubble" check sweep.yaml
"$rubble" batch sweep.yaml --out w1 --save-baseline sweep.baseline.json >/dev/null || fail "save-baseline ended with $?"
sed 's/1-6/1-5/' sweep.yaml >fewer.yaml
expect_exit 3 'other seeds' "$rubble" check fewer.yaml --baseline sweep.baseline.json --out unfit
[[ ! -e unfit ]] || fail "runs are made for a baseline that does not fit"
"$rubble" check sweep.yaml --out same --junit same.xml >check.txt || fail "check without a change ended with $?: $(cat check.txt)"
export GITHUB_ACTIONS=true GITHUB_STEP_SUMMARY=$work/summary.md
"$rubble" check sweep.yaml --out worse --junit worse.xml --set sim.range_noise=100 >check.txt
[[ $? == 1 ]] || fail "a worse parameter is not caught: $(cat check.txt)"
unset GITHUB_ACTIONS GITHUB_STEP_SUMMARY
grep -q '^::error title=Regression' check.txt || fail "no annotation"
grep -q 'FAILED' summary.md || fail "no job summary"
python3 - <<'PY' || fail "the JUnit files are wrong"
import sys, xml.etree.ElementTree as e
same, worse = e.parse('same.xml').getroot(), e.parse('worse.xml').getroot()
sys.exit(0 if same.get('failures') == '0' and int(worse.get('failures')) > 0
         and len(worse.findall('.//failure')) == int(worse.get('failures')) else 1)
PY

# Bad input.
expect_exit 2 'sweep file' "$rubble" batch
expect_exit 2 '--shard' "$rubble" batch sweep.yaml --shard 4/3
for bad in 0 -1 1- 8-1 six 1000001 1-2000000; do
  expect_exit 2 "--seeds $bad: " "$rubble" batch sweep.yaml --seeds=$bad
done
expect_exit 2 'seeds' "$rubble" batch sweep.yaml --set seed=3
expect_exit 3 'nowhere.yaml' "$rubble" batch nowhere.yaml
printf 'scenarios: [small.yaml]\nseeds: 1-2\nsets: {}\n' >typo.yaml
expect_exit 3 'typo.yaml:3:1' "$rubble" batch typo.yaml
expect_exit 3 'nowhere' "$rubble" batch merge nowhere --out x.sqlite
finish
