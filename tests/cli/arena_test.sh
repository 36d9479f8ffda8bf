# rubble arena: other tools read its files, and a league's file says in one line each what was made of it.
. "$(dirname "$0")/lib.sh"
arena=$source/arenas/shipped/demo_ramps.yaml
expect_exit 0 '' "$rubble" arena "$arena" --resolution 0.02 --slice-height 0.2 --walls walls.csv --out out
expect_exit 0 '' "$rubble" arena "$arena" --walls walls.geojson --out coarse
head -1 walls.csv | grep -q '^x0,y0,x1,y1,bottom,top,kind' || fail "walls.csv begins with $(head -1 walls.csv)"
json_holds walls.geojson "len(j['features']) == $(($(wc -l <walls.csv) - 1))"
json_holds walls.geojson "{'wall', 'step', 'victim_box'} <= {f['properties']['kind'] for f in j['features']}"
if command -v gdalinfo >/dev/null; then
  gdalinfo out/demo_ramps-truth.tif | grep -q 'Pixel Size = (0.02' || fail "gdalinfo: $(gdalinfo out/demo_ramps-truth.tif)"
fi
if command -v ogrinfo >/dev/null; then
  for file in walls.csv walls.geojson; do
    ogrinfo -so "$file" walls | grep -q "Feature Count: $(($(wc -l <walls.csv) - 1))" || fail "ogrinfo $file"
  done
fi
expect_exit 2 '.geojson' "$rubble" arena "$arena" --walls walls.shp
expect_exit 2 '--slice-height' "$rubble" arena "$arena" --slice-height 0
expect_exit 4 'nowhere/walls.csv' "$rubble" arena "$arena" --walls nowhere/walls.csv --out untouched
[[ -z $(ls untouched) ]] || fail "files beside walls that could not be written: $(ls untouched)"
expect_exit 0 '' "$rubble" arena --elements
"$rubble" arena --elements | grep -q '^half_ramp  *floor  *rises' || fail "rubble arena --elements"
expect_exit 2 '--range' "$rubble" arena "$arena" --range 0
expect_exit 0 '' "$rubble" arena "$arena" --range 0.6 --out near
cmp -s near/demo_ramps-truth.tif coarse/demo_ramps-truth.tif || fail "--range changed the truth"
cmp -s near/demo_ramps-visible.tif coarse/demo_ramps-visible.tif && fail "--range 0.6 sees as far as 4 m"

expect_exit 0 '' "$rubble" arena "$source/arenas/shipped/four_corners.yaml" --out out
expect_exit 3 'pieces/cycle.yaml:6:6: the file includes itself' "$rubble" arena \
  "$source/tests/invalid/arenas/include_cycle.yaml" --out out

printf '<elements><element type="small_wall" x="0" y="0"/>\n<element type="zorp" x="1" y="0"/></elements>\n' >league.raf
"$rubble" arena league.raf --out out >/dev/null 2>err.txt || fail "an unknown part stopped rubble arena"
grep -qx 'rubble: league.raf: 1 parts built; UNKNOWN, left out: zorp 1' err.txt || fail "unknown part: $(cat err.txt)"
grep -q 'the file names no start: the robot starts on pallet' err.txt || fail "start: $(cat err.txt)"
printf 'arena: {file: league.raf}\ntime_limit_s: 2\nexplorer: {return_home: false}\n' >league.yaml
"$rubble" run league.yaml --out run >/dev/null 2>err.txt || fail "rubble run of a league's file"
[[ $(wc -l <err.txt) == 2 ]] || fail "two notes wanted: $(cat err.txt)"
for bad in '' '<elements>' '<elements><element type="a" x="0"/></elements>' '<elements><element type="a" x="0" y=0/></elements>'; do
  printf '%s' "$bad" >bad.raf
  expect_exit 3 'bad.raf:1:' "$rubble" arena bad.raf --out out
done

printf 'maze: |\n  +---+---+---+\n  |S. |.   .  |\n  +---+---+---+\n' >sealed.yaml
printf 'arena: {file: sealed.yaml}\ntime_limit_s: 2\nexplorer: {return_home: false}\n' >sealed_run.yaml
for command in 'arena sealed.yaml --out out' 'run sealed_run.yaml --out sealed_run'; do
  "$rubble" $command >/dev/null 2>err.txt || fail "a start without a way out stopped rubble $command"
  grep -q 'sealed.yaml: from the start (0.60, 0.60) the robot gets to .* % of .*with start: {x_m: .*: move the start$' err.txt || fail "sealed: $(cat err.txt)"
done

# Victims that no camera can find from floor the robot gets to are named, also in the table of a run.
cat >hidden.yaml <<YAML
maze: |
  +---+---+---+---+---+
  |S.   .   .  A.  B. |
  +---+---+---+---+---+
victims:
  - {name: anna, cell: A, wall: north}
  - {name: bert, cell: B, wall: east}
walls: [{from_m: [4.81, 0], to_m: [4.81, 1.2]}]
YAML
expect_exit 0 '' "$rubble" arena hidden.yaml --out out
grep -qx 'cannot be seen from floor the robot reaches: bert' out.txt || fail "who is hidden: $(cat out.txt)"
printf 'arena: {file: hidden.yaml}\ntime_limit_s: 2\nexplorer: {return_home: false}\n' >hidden_run.yaml
expect_exit 0 '' "$rubble" run hidden_run.yaml --out hidden_run
grep -qE '^victims out of sight +cannot be seen from floor the robot reaches: true victim bert$' out.txt ||
  fail "who is hidden in a run: $(cat out.txt)"
json_holds hidden_run/score.json "j['victims_visible'] == 1 and j['victims_total'] == 2"

# What of an arena the robot cannot see is said with its cause, and nothing where all can be seen.
"$rubble" arena generate --kind red --cells 6x6 --seed 3 --ramps 0.4 --out red >told.txt 2>&1 || fail "a red arena"
grep -qE '^not asked for: [0-9.]+ % behind (slopes of more than 22 deg|steps and blocks of more than 0.10 m)$' told.txt ||
  fail "what cannot be seen: $(cat told.txt)"
"$rubble" arena generate --kind yellow --cells 4x4 --seed 3 --out plain | grep -q 'not asked for' && fail "all of it can be seen"

# What is generated is run with the line that is printed, wherever that is typed and whatever the folder is called.
odd="odd, {it's} \$x"
expect_exit 0 '' "$rubble" arena generate --cells 3x3 --seed 2 --out "$odd"
line=$(sed -n 's/^to run it: rubble //p' out.txt)
(mkdir elsewhere && cd elsewhere && eval "$rubble $line --set time_limit_s=2 --out run" >/dev/null 2>&1) || fail "'$line' does not run"
cmp "$odd/yellow-3x3-seed2.yaml" elsewhere/run/arena.yaml || fail "'$line' runs another arena"

expect_exit 2 '--kind blue: a blue arena asks to grasp objects' "$rubble" arena generate --kind blue --out out
expect_exit 2 '--kind pink' "$rubble" arena generate --kind pink --out out
printf 'arena:\n  generate:\n    kind: blue\n' >blue.yaml
expect_exit 3 'a blue arena asks to grasp objects' "$rubble" run blue.yaml --out blue

# A room behind a gap too narrow to pass, with a corner nobody can look into: it counts against a map only when asked to.
cat >gap.yaml <<YAML
maze: |
  +---+---+---+---+---+
  |S.   .   .   .   . |
  +   +---+   +---+---+
  | .   . |
  +---+---+
boxes: [{x_m: 2.2, y_m: 2.3, length_m: 0.3, width_m: 0.2}]
walls: [{from_m: [3.6, 1.2], to_m: [3.6, 2.2]}]
YAML
printf 'arena: {file: gap.yaml}\ntime_limit_s: 200\n' >gap_run.yaml
expect_exit 0 '' "$rubble" run gap_run.yaml --out seen
expect_exit 0 '' "$rubble" run gap_run.yaml --set scoring.visible_truth=false --out all
for run in seen all; do
  "$rubble" score $run/map.tif $run/truth.tif --json >$run/again.json || fail "rubble score of $run"
done
python3 - <<'PY' || fail "the visible truth does not count as it should"
import json
seen, all_, again = (json.load(open(f)) for f in ("seen/score.json", "all/score.json", "seen/again.json"))
assert seen["aligned"] and all_["aligned"]
assert seen["known"] > all_["known"] + 0.05, (seen["known"], all_["known"])
assert abs(seen["score"] - again["score"]) < 1e-12 and abs(seen["known"] - again["known"]) < 1e-12
PY
cmp -s seen/map.tif all/map.tif || fail "the truth to score with changed the map"
expect_exit 0 '' "$rubble" replay seen
# Interrupted in the middle: one line, 130, no file cut in two; and under nohup a closed terminal is not heard.
for signal in INT TERM HUP; do
  mkdir cut
  setsid "$rubble" arena generate --cells 40x40 --out cut >out.txt 2>err.txt &
  pid=$!
  for _ in $(seq 200); do
    [[ -s out.txt || -s cut/yellow-40x40-seed1.yaml ]] && break
    sleep 0.02
  done
  kill -$signal $pid
  wait $pid
  code=$?
  [[ $code == 130 && $(cat err.txt) == "rubble: interrupted" ]] || fail "SIG$signal ends a generation with $code: $(head -c 300 err.txt)"
  for file in cut/*; do
    case $file in
      cut/*.yaml) "$rubble" arena "$file" --out whole >/dev/null 2>err.txt || fail "SIG$signal left a torn $file: $(cat err.txt)" ;;
      cut/*.png | cut/*.tif) head -c 4 "$file" | grep -qaE 'PNG|II' || fail "SIG$signal left a torn $file" ;;
      *) fail "SIG$signal left $file" ;;
    esac
  done
  rm -rf cut
done
(trap '' HUP; exec "$rubble" arena generate --cells 12x12 --out kept) >out.txt 2>err.txt &
pid=$!
for _ in $(seq 200); do
  [[ -s kept/yellow-12x12-seed1.yaml ]] && break
  sleep 0.02
done
kill -HUP $pid
wait $pid || fail "a closed terminal ends what nohup started: $(head -c 300 err.txt)"
finish
