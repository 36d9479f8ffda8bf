#!/usr/bin/env bash
# Names, messages and outputs in the hands of somebody hostile: one line, the documented exit code, nothing outside.
source "$(dirname "$0")/lib.sh"
umask 022

# --- names and folders
small_scenario s.yaml
printf 'name: ../../evil\nscenarios: [s.yaml]\nseeds: 1-1\n' >sweep.yaml
expect_exit 3 "is used as a folder name" "$rubble" batch sweep.yaml
[[ ! -e ../../evil && ! -e evil ]] || fail "a sweep left its folder"
sed 's/^name: small/name: "a\\eb"/' s.yaml >named.yaml
expect_exit 3 "is used as a folder name" "$rubble" run named.yaml
expect_exit 3 "is used as a folder name" "$rubble" run s.yaml --set name=-rf

small_scenario short.yaml
sed -i 's/time_limit_s: 240/time_limit_s: 5/' short.yaml
for i in 1 2 3; do "$rubble" run short.yaml >start$i.txt 2>&1 & done
wait
[[ $(ls -d runs/small-seed3-* | wc -l) == 3 ]] || fail "three same starts share folders: $(ls runs)"
for folder in runs/small-seed3-*; do [[ -s $folder/score.json ]] || fail "$folder is not whole"; done

# Three that replace one run: one does it, the others are refused, and the folder is whole.
"$rubble" run short.yaml --out one >/dev/null || fail "the run to be replaced ended with $?"
for i in 1 2 3; do
  ("$rubble" run short.yaml --out one --force >replace$i.txt 2>&1; echo "ended $?" >>replace$i.txt) &
done
wait
for i in 1 2 3; do
  grep -q '^ended 0$' replace$i.txt ||
    { grep -q '^ended 3$' replace$i.txt && grep -q 'another rubble is writing into it' replace$i.txt; } ||
    fail "one of three that replace a run says: $(cat replace$i.txt)"
done
grep -q '^ended 0$' replace?.txt || fail "of three that replace a run none did"
"$rubble" replay one >out.txt || fail "a folder that three replaced is not whole: $(tail -n 1 out.txt; ls one)"

# What is written on each map has an end.
expect_exit 3 "is written on the map, and 5000 bytes long" "$rubble" run short.yaml --set team="$(printf 'x%.0s' $(seq 5000))"
expect_exit 3 "is written on the map, and 101 bytes long" "$rubble" run short.yaml --set mission="$(printf 'x%.0s' $(seq 101))"
sed 's/^name: .*/name: "a\\e[2Jb"/' "$source/robots/pioneer_urg.yaml" >odd_robot.yaml
expect_exit 3 "is used as a folder name" "$rubble" drive odd_robot.yaml --map-only

printf 'name: b\nscenarios: [short.yaml]\nseeds: 1-1\n' >b.yaml
mkdir -p planted elsewhere
ln -s ../elsewhere planted/runs
expect_exit 3 "is a symbolic link" "$rubble" batch b.yaml --out planted
[[ -z $(ls -A elsewhere) ]] || fail "batch followed a planted link"

"$rubble" run --out gone >gone.txt 2>gone_err.txt &
pid=$!
for _ in $(seq 200); do [[ -s gone/estimate.tum ]] && break; sleep 0.05; done
mv gone moved
wait $pid
[[ $? == 4 ]] || fail "a folder deleted under way is not told: $(cat gone.txt gone_err.txt)"

# --- messages
expect_exit 2 "run '': is no scenario" "$rubble" run ''
expect_exit 2 "a yellow arena has no obstacles" "$rubble" arena generate --rough 0.5
long=$(printf 'x%.0s' $(seq 300))
expect_exit 3 "name too long" "$rubble" run s.yaml --out "$long"
expect_exit 3 "" "$rubble" score "$long.tif" "$long.tif"
[[ $(wc -l <err.txt) == 1 ]] || fail "a long name gives more than one line"
"$rubble" run $'no\nsuch\e[2J.yaml' 2>err.txt
[[ $? == 3 && $(wc -l <err.txt) == 1 ]] || fail "a path with a line break gives several lines: $(cat -v err.txt)"
grep -q $'\e' err.txt && fail "a raw escape reaches the terminal"
printf 'not a picture' >bad.png
expect_exit 3 "not an image that can be read" "$rubble" score bad.png bad.png --resolution 0.05
if [[ $(id -u) != 0 ]]; then
  mkdir locked && chmod 000 locked
  expect_exit 3 "ermission denied" "$rubble" run locked/s.yaml
  chmod 700 locked
fi
"$rubble" run short.yaml --out replayed >/dev/null 2>&1
TMPDIR=/nowhere expect_exit 3 "check the path" "$rubble" replay replayed

# The path of an arena in a scenario that rubble writes reads back, whatever the folder is called.
mkdir 'q"\u' && cp -r replayed 'q"\u/run'
"$rubble" replay "$work/"'q"\u/run' --out again >/dev/null || fail "a run in a folder with a quote in its name cannot be replayed"
"$rubble" run again/scenario.yaml --out anew >/dev/null 2>err.txt || fail "its scenario does not read back: $(cat err.txt)"

# Whatever a file or folder is called, it reaches the terminal as text: nothing that the terminal obeys, nothing that turns
# or hides what stands beside it.
odd=$'o\e[2J\u202ed'
mkdir "$odd"
cp -r replayed "$odd/run"
cp short.yaml "$odd/s.yaml"
printf 'name: b\nscenarios: [s.yaml]\nseeds: 1-1\n' >"$odd/sweep.yaml"
cat >"$odd/list.yaml" <<'YAML'
name: "l\e[2J\u202e"
mappers: [{kind: paper, name: "m\e[2J\u202e"}]
cases: [{name: "c\e[2J\u202e", scenario: s.yaml, goal_m: 5}]
YAML
shown() {
  "$@" >out.txt 2>err.txt
  LC_ALL=C.UTF-8 grep -nP '[\x00-\x08\x0b-\x1f\x7f-\x{9f}\x{202a}-\x{202e}]' out.txt err.txt >raw.txt &&
    fail "'$*' prints $(cat -v raw.txt | head -n 3)"
}
shown "$rubble" run "$odd/s.yaml" --out "$odd/other"
shown "$rubble" export "$odd/run" "$odd/a.rawlog"
shown "$rubble" arena "$odd/run/arena.yaml" --out "$odd/arena" --walls "$odd/walls.csv"
shown "$rubble" batch "$odd/sweep.yaml" --out "$odd/batch" --save-baseline "$odd/base.json"
shown "$rubble" batch "$odd/sweep.yaml" --out "$odd/slurm" --slurm --no-submit
shown "$rubble" batch report "$odd/batch"
shown "$rubble" batch merge "$odd/batch" --out "$odd/all.sqlite"
shown env GITHUB_STEP_SUMMARY="$odd/none/summary" "$rubble" check "$odd/sweep.yaml" --baseline "$odd/base.json" --out "$odd/checked"
shown "$rubble" merge "$odd/run" "$odd/other" --out "$odd/merged"
shown "$rubble" score "$odd/run/map.tif" "$odd/run/truth.tif" --json --out "$odd/score" --html "$odd/page.html"
shown "$rubble" benchmark "$odd/list.yaml" --json
python3 -m json.tool out.txt >/dev/null || fail "benchmark --json with such a name is no JSON: $(head -c 300 out.txt)"
shown "$rubble" devices "pty:$odd/none" "tcp:$odd:1"
shown "$rubble" emulate "$odd/s.yaml" --urg "pty:$odd/urg" --time-limit 0.2
grep -q '^ready$' out.txt || fail "an emulator at an odd place is not ready: $(cat -v out.txt err.txt)"
shown "$rubble" drive --urg "pty:$odd/1" --base "pty:$odd/2" --levelling "pty:$odd/3" --set safety.start_s=1 --out "$odd/drive"

# --- numbers on the command line that are none, or lie nowhere
for place in nan,0,0 1e308,0,0 0,0,1e300 0,inf,0; do
  expect_exit 2 "X and Y must be within" "$rubble" score replayed/truth.tif replayed/truth.tif --start=$place
done
expect_exit 2 "needs the form X,Y" "$rubble" plan replayed/truth.tif --from=nan,nan
for place in 1e308,0 0,inf; do
  expect_exit 2 "lies farther off" "$rubble" plan replayed/truth.tif --from=$place
done

# --- a large picture that is one wall
python3 - <<'PY'
import struct, zlib
part = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
packed = zlib.compress(bytes([0, 128]) + bytes((1 + 5000 // 8) * 5000 - 2), 9)  # one pixel is white
open("black.png", "wb").write(b"\x89PNG\r\n\x1a\n" + part(b"IHDR", struct.pack(">IIBBBBB", 5000, 5000, 1, 0, 0, 0, 0)) +
                              part(b"IDAT", packed) + part(b"IEND", b""))
PY
expect_exit 3 "has no frontier" "$rubble" plan black.png --resolution 0.05
"$rubble" score black.png replayed/truth.tif --resolution 0.05 >out.txt 2>err.txt
[[ $? == 0 ]] && grep -q "24999999 cells of the map are walls" out.txt || fail "a black picture is scored: $(cat out.txt err.txt)"

# --- lost output
if [[ -e /dev/full ]]; then
  "$rubble" arena --elements >/dev/full 2>err.txt
  [[ $? == 4 ]] || fail "a full disk behind stdout ends well"
  grep -q "standard output: cannot be written" err.txt || fail "stdout on a full disk says: $(cat err.txt)"
  "$rubble" --help >/dev/full 2>err.txt
  [[ $? == 4 ]] || fail "help on a full disk ends well"
fi
echo "older" >out.rawlog
(ulimit -f 1; trap '' XFSZ; "$rubble" export replayed out.rawlog >/dev/null 2>err.txt)
[[ $(cat out.rawlog) == older ]] || fail "export destroyed an older file on a full disk"

# --- sizes
expect_exit 3 "is a device" "$rubble" map /dev/zero
head -c 200000000 /dev/zero | gzip -1 >zeros.gz
(instrumented || ulimit -v 1500000; expect_exit 3 "unpack to more than" "$rubble" map zeros.gz; exit $((failures > 0))) || failures=1

finish
