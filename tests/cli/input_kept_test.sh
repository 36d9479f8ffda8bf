#!/usr/bin/env bash
# An output never destroys what is read, nor somebody's own file; no pipe, device or socket given as input is waited for.
source "$(dirname "$0")/lib.sh"
umask 022

small_scenario s.yaml 'explorer: {return_home: false}'
sed -i 's/time_limit_s: 240/time_limit_s: 12/' s.yaml
"$rubble" run s.yaml --out run >/dev/null 2>&1
[[ -s run/map.rmap ]] || fail "the run to attack was not made: $(ls run)"
find run -type f | sort | xargs sha256sum >run.sums

# kept FOLDER: it holds what `run` holds, or the test fails.
kept() {
  sed "s| run/| $1/|" run.sums | sha256sum -c --quiet >sums.txt 2>&1 || fail "$1 lost something: $(head -3 sums.txt)"
}

# refused FILE TEXT COMMAND...: exit 3 with that text in its one line, and FILE keeps its bytes.
refused() {
  local file=$1 text=$2 before
  shift 2
  before=$(sha256sum <"$file")
  expect_exit 3 "$text" "$@"
  [[ $(sha256sum <"$file") == "$before" ]] || fail "'$*' destroyed $file"
}
# behind_cost COMMAND...: a batch that begins, without the line of what it costs.
behind_cost() {
  "$@" 2>behind.txt
  local code=$?
  head -1 behind.txt | grep -qE '^rubble: [0-9]+ runs? *(left of [0-9]+)?,' || fail "'$*' does not tell its cost: $(cat behind.txt)"
  tail -n +2 behind.txt >&2
  return $code
}
lost="would be lost"

# --- run folders
cp -r run a && expect_exit 3 "$lost" "$rubble" map a/log.rlog --out a --force && kept a
expect_exit 3 "$lost" "$rubble" merge a run --out a --force && kept a
expect_exit 3 "$lost" "$rubble" map run/log.rlog --continue a --out a --force && kept a
ln -s a link_to_a
expect_exit 3 "$lost" "$rubble" map ./link_to_a/../a/log.rlog --out link_to_a --force && kept a
expect_exit 3 "$lost" "$rubble" run a/scenario.yaml --out a --force && kept a
echo mine >a/thesis.txt
refused a/thesis.txt "thesis.txt: is not of a run" "$rubble" run s.yaml --out a --force && kept a
rm a/thesis.txt && mkdir a/notes
expect_exit 3 "notes: is not of a run" "$rubble" run s.yaml --out a --force && kept a
rmdir a/notes
mkdir project && cp s.yaml project/scenario.yaml && echo x >project/arena.yaml
refused project/scenario.yaml "is not a run folder" "$rubble" run s.yaml --out project --force
expect_exit 0 "" "$rubble" map run/log.rlog --out a --force
[[ -s a/map.rmap && ! -e a/truth.tif ]] || fail "--force does not replace a run folder any more: $(ls a)"
expect_exit 3 "give another folder with --out" "$rubble" replay run --out a
grep -q -- "--force" err.txt && fail "replay names an option that it does not have: $(cat err.txt)"

# --- files
cp run/log.rlog s.rawlog && refused s.rawlog "$lost" "$rubble" export s.rawlog s.rawlog
cp run/map.rmap s.g2o && refused s.g2o "$lost" "$rubble" export s.g2o ./s.g2o
cp run/map.rmap s.simplemap && refused s.simplemap "$lost" "$rubble" export s.simplemap s.simplemap
ln s.g2o hard.g2o && refused s.g2o "$lost" "$rubble" export hard.g2o s.g2o
expect_exit 0 "" "$rubble" export run good.simplemap
for name in plan.png rooms.png overlay.png; do cp run/map.png $name; done
refused plan.png "$lost" "$rubble" plan plan.png --resolution 0.025
refused rooms.png "$lost" "$rubble" rooms rooms.png --resolution 0.025 --out .
refused overlay.png "$lost" "$rubble" score overlay.png run/truth.tif --resolution 0.025 --out .
# A run's score.json knows its trajectory and how it ended: what a map alone has to say does not take its place unasked.
cp -r run judged
refused judged/score.json "judged: is the folder of a run" "$rubble" score run/map.tif run/truth.tif --out judged
kept judged
expect_exit 0 "" "$rubble" score run/map.tif run/truth.tif --out judged --force
cmp -s run/score.json judged/score.json && fail "score --force wrote nothing"
expect_exit 0 "" "$rubble" score run/map.tif run/truth.tif --out fresh
expect_exit 0 "" "$rubble" score run/map.tif run/truth.tif --out fresh
cp run/map.tif h.tif && refused h.tif "$lost" "$rubble" score h.tif run/truth.tif --html h.tif
cp run/truth.tum own.tum && mkdir t && ln -s ../own.tum t/trajectory.json
refused own.tum "is a symbolic link" "$rubble" score own.tum run/truth.tum --out t
printf 'name: b\nscenarios: [s.yaml]\nseeds: 1-2\n' >sweep.yaml
refused sweep.yaml "$lost" behind_cost "$rubble" batch sweep.yaml --out batch --save-baseline sweep.yaml
[[ -s batch/results.jsonl ]] || fail "the batch was not made"
expect_exit 0 "" "$rubble" batch sweep.yaml --out batch --save-baseline base.json
for option in --csv --json --html; do
  refused batch/results.jsonl "$lost" "$rubble" compare batch batch $option batch/results.jsonl
done
refused batch/results.jsonl "$lost" "$rubble" batch report batch --out batch/results.jsonl
refused base.json "$lost" behind_cost "$rubble" check sweep.yaml --baseline base.json --out checked --junit base.json
printf 'name: l\nmappers: {paper: {}}\narenas: {small: {scenario: s.yaml, seeds: 1}}\n' >list.yaml
for option in --markdown --html; do
  before=$(sha256sum <list.yaml)
  "$rubble" benchmark list.yaml $option list.yaml >/dev/null 2>&1
  [[ $? == 3 && $(sha256sum <list.yaml) == "$before" ]] || fail "benchmark $option replaces its list"
done
expect_exit 0 "" "$rubble" batch merge batch --out all.sqlite
echo mine >all.sqlite.partial
expect_exit 0 "" "$rubble" batch merge batch --out all.sqlite
[[ $(cat all.sqlite.partial) == mine ]] || fail "merge took somebody's file for its own"
ln -s there.sqlite linked.sqlite && cp all.sqlite there.sqlite
expect_exit 0 "" "$rubble" batch merge batch --out linked.sqlite
[[ -L linked.sqlite ]] && cmp -s all.sqlite there.sqlite || fail "merge put a file in the place of a link"

# --- what the user is told to edit, and pictures of his own
expect_exit 0 "" "$rubble" arena generate --cells 3x3 --seed 1
expect_exit 0 "" "$rubble" arena generate --cells 3x3 --seed 1
echo "# edited" >>yellow-3x3-seed1.yaml
refused yellow-3x3-seed1.yaml "--force" "$rubble" arena generate --cells 3x3 --seed 1
expect_exit 0 "" "$rubble" arena yellow-3x3-seed1.yaml
expect_exit 0 "" "$rubble" arena generate --cells 3x3 --seed 1 --force
grep -q edited yellow-3x3-seed1.yaml && fail "--force does not replace the arena file"
cp run/arena.yaml arena.yaml && echo own >arena.png
refused arena.png "--force" "$rubble" arena arena.yaml --out .
expect_exit 0 "" "$rubble" arena arena.yaml --out . --force
expect_exit 0 "" "$rubble" arena arena.yaml --out .

# --- planted links
echo secret >victim
mkdir f && for name in score.json rooms.csv arena.png league.csv; do ln -s ../victim f/$name; done
refused victim "is a symbolic link" "$rubble" score run/map.tif run/truth.tif --out f
refused victim "is a symbolic link" "$rubble" rooms run/map.tif --out f
refused victim "is a symbolic link" "$rubble" arena arena.yaml --out f --force
mkdir maps && cp run/map.tif maps/team.tif
refused victim "is a symbolic link" "$rubble" score --league maps run/truth.tif --out f
cp -r batch planted && ln -sf ../victim planted/report.html
refused victim "is a symbolic link" "$rubble" batch report planted
rm planted/report.html && ln -sf ../victim planted/sweep.json
refused victim "is a symbolic link" behind_cost "$rubble" batch sweep.yaml --out planted

# --- pipes, devices and sockets
mkfifo fifo.yaml fifo.tif fifo.png fifo.tum fifo.csv fifo.json fifo.rmap fifo.raf
python3 -c "import socket; socket.socket(socket.AF_UNIX).bind('sock.yaml')"
# prompt TEXT COMMAND...: exit 3 with TEXT within 20 s.
prompt() {
  local text=$1
  shift
  expect_exit 3 "$text" timeout -s KILL 20 "$@"
}
prompt "is a pipe" "$rubble" run fifo.yaml
prompt "is a socket" "$rubble" run sock.yaml
prompt "is a device" "$rubble" run /dev/zero
prompt "is a pipe" "$rubble" batch fifo.yaml
prompt "is a pipe" "$rubble" benchmark fifo.yaml
prompt "is a pipe" "$rubble" drive fifo.yaml
prompt "is a pipe" "$rubble" arena fifo.yaml
prompt "is a pipe" "$rubble" arena fifo.raf
prompt "is a pipe" "$rubble" score fifo.tif run/truth.tif
prompt "is a pipe" "$rubble" score run/map.tif fifo.png --truth-resolution 0.05
prompt "is a pipe" "$rubble" score fifo.tum run/truth.tum
prompt "is a pipe" "$rubble" score run/map.tif run/truth.tif --pois fifo.csv
prompt "is a pipe" "$rubble" score run/map.tif run/truth.tif --victims fifo.csv
prompt "is a pipe" "$rubble" score --league maps run/truth.tif --judge fifo.csv
prompt "is a pipe" "$rubble" rooms fifo.png --resolution 0.05
prompt "is a pipe" "$rubble" plan fifo.tif
prompt "is a pipe" "$rubble" check sweep.yaml --baseline fifo.json
prompt "is a pipe" "$rubble" map run/log.rlog --continue fifo.rmap
prompt "is a pipe" "$rubble" export fifo.rmap out.g2o
prompt "is a pipe" "$rubble" calibrate fifo.yaml --log run --out c.yaml
# What a file names is no stream of the terminal, and what lies beside one is not opened.
for stream in /dev/stdin /dev/fd/0; do
  printf 'name: p\narena: {file: %s}\n' $stream >names.yaml
  prompt "is a pipe" "$rubble" run names.yaml < <(sleep 60)
  printf 'include: [{file: %s, at: [0, 0]}]\n' $stream >includes.yaml
  prompt "is no regular file" "$rubble" arena includes.yaml < <(sleep 60)
done
printf 'name: l\nmappers: [{kind: paper}]\ncases: [{name: a, log: fifo.log}]\n' >names.yaml
mkfifo fifo.log && prompt "is a pipe" "$rubble" benchmark names.yaml && rm fifo.log
mkfifo all.sqlite-journal all.sqlite-wal
timeout -s KILL 20 "$rubble" batch report all.sqlite >/dev/null 2>err.txt || fail "a pipe beside a database: $?, $(cat err.txt)"
truncate -s 9G long.jsonl && mkdir long && mv long.jsonl long/results.jsonl
(instrumented || ulimit -v 4000000; prompt "is over 8 GB" "$rubble" batch sweep.yaml --out long; exit $((failures > 0))) || failures=1
expect_exit 4 "/dev/full: cannot be written" "$rubble" emulate s.yaml --urg tcp:127.0.0.1:0 --truth /dev/full --time-limit 3
(yes 1 | head -c 3000000 | tr '\n' 1; echo x) >relations.txt
printf 'name: l\nmappers: [{kind: paper}]\ncases: [{name: a, log: run/log.rlog, relations: relations.txt}]\n' >names.yaml
"$rubble" benchmark names.yaml >out.txt 2>err.txt
[[ $(cat out.txt err.txt | wc -c) -lt 5000 ]] || fail "a line of megabytes is quoted whole"
mkfifo w.png && printf '1\n' | timeout -s KILL 20 "$rubble" plan run/map.tif --out w.png 2>err.txt >out.txt
[[ $? == 4 ]] && grep -q "nobody reads" err.txt || fail "a pipe that nobody reads as output: $(cat err.txt)"

# In a foreign folder each file may be one.
for name in versions.json scenario.yaml log.rlog map.tif estimate.tum; do
  for with in fifo zero; do
    rm -rf f && cp -r run f && rm f/$name
    if [[ $with == fifo ]]; then mkfifo f/$name; else ln -s /dev/zero f/$name; fi
    (instrumented || ulimit -v 4000000; prompt "$name: is a" "$rubble" replay f; exit $((failures > 0))) || failures=1
  done
done
rm -rf f && cp -r run f && rm f/map.rmap && mkfifo f/map.rmap && prompt "is a pipe" "$rubble" map run/log.rlog --localise f
rm -rf f && cp -r run f && rm f/log.rlog && mkfifo f/log.rlog
prompt "is a pipe" "$rubble" map f
prompt "is a pipe" "$rubble" export f out.rawlog
prompt "is a pipe" "$rubble" calibrate --log f --out c.yaml "$source/robots/pioneer_urg.yaml"
echo '{"steered_by_hand": 5}' >run/versions.json
prompt "neither true nor false" "$rubble" replay run
rm -rf planted && cp -r batch planted && rm planted/results.jsonl && mkfifo planted/results.jsonl
prompt "is a pipe" "$rubble" batch report planted
prompt "is no file" "$rubble" batch sweep.yaml --out planted

# A log may come through a pipe, and waiting for it ends at a signal.
"$rubble" map <(cat s.rawlog) --out piped >/dev/null 2>err.txt || fail "a log through a pipe is not read: $(cat err.txt)"
"$rubble" map /dev/stdin --out piped2 <s.rawlog >/dev/null 2>err.txt || fail "a log on stdin is not read: $(cat err.txt)"
cat s.yaml | "$rubble" run /dev/stdin --out piped3 >/dev/null 2>err.txt || fail "a scenario on stdin: $(cat err.txt)"
mkfifo fifo.log
for signal in TERM INT HUP; do
  "$rubble" map fifo.log --out never >out.txt 2>err.txt &
  pid=$!
  for _ in $(seq 200); do ls -l /proc/$pid/fd 2>/dev/null | grep -q fifo.log && break; sleep 0.05; done
  kill -$signal $pid
  (sleep 20; kill -KILL $pid) 2>/dev/null &
  watchdog=$!
  wait $pid
  [[ $? == 130 ]] || fail "$signal does not end the wait for a pipe: $(cat err.txt)"
  kill $watchdog 2>/dev/null
done

# --- emulated devices
echo precious >line.new
"$rubble" emulate s.yaml --urg pty:line --time-limit 0.2 >out.txt 2>err.txt || fail "emulate ended with $?: $(cat err.txt)"
[[ $(<line.new) == precious ]] || fail "a line that is offered beside a file called line.new took it away"
[[ ! -e line && -z $(ls | grep '^line\.[0-9]') ]] || fail "an emulator leaves its link: $(ls)"
mkfifo truth.tum
prompt "is a pipe" "$rubble" emulate s.yaml --urg pty:line --time-limit 0.2 --truth truth.tum

# --- damaged pictures and logs
printf '\xff\xd8\xff' >short.jpg
for size in 0 1 2 3 4 5 6 7 8 11 12 20; do
  for head in '\xff\xd8\xff\xe0\x00\x10JFIFxxxxxxxxxxxxxx' '\x89PNG\r\n\x1a\nxxxxxxxxxxxxxxx' 'RIFFxxxxWEBPxxxxxxxxxx' 'BMxxxxxxxxxxxxxxxxxxxxx'; do
    printf "$head" | head -c $size >short.jpg
    prompt "short.jpg" "$rubble" score short.jpg run/truth.tif --resolution 0.05
  done
done
echo '{"groups": [7' >no.json
prompt "is no baseline" "$rubble" check sweep.yaml --baseline no.json
grep -q "json.exception" err.txt && fail "a library's text reaches the user: $(cat err.txt)"
printf 'name: b\nscenarios: [s.yaml]\nseeds: 1\nconfigs: {a: {mapper: {kind: paper}}}\n' >nested.yaml
prompt "mapper.kind" "$rubble" batch nested.yaml --out nested

finish
