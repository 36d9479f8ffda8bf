# A run writes its whole folder, the same seed gives the same bits, a replay is bit-identical.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
"$rubble" run s.yaml --out a >table.txt || fail "run ended with $?"
grep -q 'times real time' table.txt || fail "no summary table"
for name in scenario.yaml versions.json arena.yaml arena.png log.rlog truth.tum estimate.tum estimate_live.tum map.tif map.tfw map.png \
  map.pgm map.yaml pois.csv truth.tif truth.png overlay.png error.png sight.png hashes.json score.json; do
  [[ -s a/$name ]] || fail "a/$name is missing or empty"
done
(mkdir -p at && cd at && "$rubble" run ../s.yaml --set time_limit_s=5 >/dev/null)
[[ -e at/runs/latest/score.json ]] || fail "the link latest does not lead to the run"
(cd at && "$rubble" run ../s.yaml --mapper-command false >/dev/null 2>&1)
[[ $(readlink at/runs/latest) == small-seed3-001 && -d at/runs/small-seed3-002 ]] ||
  fail "a run that maps nothing becomes runs/latest: $(ls -l at/runs)"
[[ -e latest ]] && fail "a link was put beside a folder given with --out"
json_holds a/score.json "all(k in j for k in 'score precision recall psi_m aligned ate_first_m ate_aligned_m ate_live_m known \
victims_found victims_total sim_s wall_s real_time_factor peak_mb'.split())"
json_holds a/score.json "j['aligned'] and 0.5 < j['score'] <= 1 and j['known'] > 0.7"
version=$(sed -n 's/^constexpr int kScoreVersion = \([0-9]*\);$/\1/p' "$source/scoring/scorecard.h")
json_holds a/score.json "j['victims_withdrawn'] >= 0 and j['victims_visible'] <= j['victims_total'] and \
('unseen_victims' in j) == (j['victims_visible'] < j['victims_total'])"
json_holds a/score.json "j['overlap'] == min(j['precision'], j['recall']) and j['score_version'] == $version and j['score_at_best_pose'] == j['score']"

# A victim has one number, and its name is the same wherever it is said.
id=$(sed -n '2s/,.*//p' a/victims.csv)
[[ $id == 1 ]] && grep -q "^1,.*,victim,victim_1," a/pois.csv && grep -q 'victim 1 confirmed at ' a/decisions.txt ||
  fail "victim 1 has several names: $(tail -n 1 a/pois.csv a/victims.csv; grep confirmed a/decisions.txt)"
"$rubble" score a/map.tif a/truth.tif --pois a/pois.csv --html named.html >/dev/null || fail "score of the list ended with $?"
grep -qF '"victim 1"],[' named.html && grep -qF '"true victim1"]' named.html || fail "the page has other names for victim 1"

"$rubble" run s.yaml --out b >/dev/null || fail "second run ended with $?"
cmp a/hashes.json b/hashes.json || fail "one seed, two results"
"$rubble" run s.yaml --seed 4 --out c >/dev/null || fail "third run ended with $?"
cmp -s a/hashes.json c/hashes.json && fail "two seeds, one result"
"$rubble" run a/scenario.yaml --out d >/dev/null || fail "the resolved scenario does not run"
cmp a/hashes.json d/hashes.json || fail "the resolved scenario gives another result"

"$rubble" run s.yaml -v --out told >told.txt 2>decisions.txt || fail "run -v ended with $?"
cmp a/hashes.json told/hashes.json || fail "telling why changes the run"
sed 's/^ *\([0-9.]*\) s  /\1 /' decisions.txt | cmp - <(sed 's/^ *//' told/decisions.txt) || fail "-v tells other decisions than the folder"
[[ -s decisions.txt ]] || fail "-v tells nothing"

"$rubble" replay a >replay.txt || fail "replay ended with $?"
grep -qx 'bit-identical' replay.txt || fail "replay: $(cat replay.txt)"
"$rubble" replay a --out filmed --film 5 >replay.txt || fail "a replay that draws a film ended with $?"
grep -qx 'bit-identical' replay.txt || fail "drawing a film changes the replay: $(cat replay.txt)"
[[ $(head -c 4 filmed/film.png | tail -c 3) == PNG ]] || fail "there is no film"
expect_exit 2 "film" "$rubble" replay a --film 5
expect_exit 2 "film" "$rubble" replay a --out other --film 0
[[ -e other ]] && fail "a film of no moments leaves a folder"
sed -i 's/map_distance_m: 0.15/map_distance_m: 0.16/' d/scenario.yaml
"$rubble" replay d >replay.txt && fail "replay must notice another mapper"
grep -qx 'NOT bit-identical' replay.txt || fail "replay of a changed run: $(cat replay.txt)"

"$rubble" score a/map.tif a/truth.tif --json --out judged >score.json || fail "score ended with $?"
python3 - <<'PY' || fail "rubble score and the run disagree"
import json, sys
a, b = json.load(open('a/score.json')), json.load(open('score.json'))
same = ('score', 'precision', 'recall', 'psi_m', 'known', 'phantom_m', 'missing_m', 'ignored_m', 'worst_places', 'map')
# Of the mapper alone: a judge does not know it.
own = ('key_frames', 'frames_reused', 'slips', 'relocated', 'unseen', 'odometry_silent', 'scans_repeated', 'lost', 'odometry_jumps',
       'loops_searched', 'loops_ambiguous', 'loops_contradicted', 'loops_needless', 'loops_closed',
       'loops_removed', 'near_edges', 'frames_astray', 'frames_doubled', 'scans_unfit', 'turns_against', 'map_doubted', 'graph_solved',
       'last_work_ms', 'work_ms',
       'most_work_ms')
sys.exit(0 if all(a[k] == b[k] for k in same) and [k for k in a if k not in own] == list(b) else 1)
PY
[[ -s judged/overlay.png && -s judged/sight.png && -s judged/score.json ]] || fail "score --out leaves no pictures"
if command -v gdalinfo >/dev/null; then
  gdalinfo a/map.tif | grep -q 'Pixel Size = (0.025' || fail "gdalinfo sees no metric pixel size"
fi

# A file that was being written when the run was ended on the spot is the run's own.
small_scenario part.yaml
expect_exit 0 '' "$rubble" run part.yaml --out part
mkdir part/.partial && touch part/.partial/map.tif.4711.part part/.partial/map.png.4711-2.part
expect_exit 0 '' "$rubble" run part.yaml --out part --force
mkdir part/.partial && touch part/.partial/letter.part
expect_exit 3 'none of that name is shipped; shipped are equal_cells, on_earth, yellow' "$rubble" run nosuch
expect_exit 3 "did you mean 'yellow'" "$rubble" run yelow
expect_exit 2 "'--sed' is no option of run, did you mean '--seed'?" "$rubble" run --sed 3
expect_exit 2 "'--sed' is no option of run, did you mean '--seed'?" "$rubble" run --sed=3
expect_exit 2 "'--ou' is no option of merge, did you mean '--out'?" "$rubble" batch merge --ou x y
expect_exit 2 'see rubble run --help' "$rubble" run --nothing-like-it
expect_exit 0 '' "$rubble" --help
cp out.txt help.txt
for word in mapper-process test; do grep -qw -- "$word" help.txt || fail "--help does not tell of $word"; done
expect_exit 0 '' "$rubble" help
cmp -s out.txt help.txt || fail "help is not --help: $(cat out.txt)"
expect_exit 0 '' "$rubble" help run
"$rubble" run --help | cmp -s - out.txt || fail "help run is not run --help: $(cat out.txt)"
expect_exit 3 'say --set arena.generate.kind=orange' "$rubble" run orange
touch hall.raf
expect_exit 3 'is an arena, and what is played is a scenario; write one, of this line: arena: {file: ' "$rubble" run hall.raf
expect_exit 3 'flat_room: is an arena' "$rubble" run flat_room
expect_exit 3 "'maze' is of an arena, and what is played is a scenario; write one, of this line: arena: {file: /" \
  "$rubble" run "$source/arenas/shipped/flat_room.yaml"
sed 's/^arena:/arna:/' part.yaml >misspelt.yaml
expect_exit 3 "misspelt.yaml:2:1: unknown key 'arna', did you mean 'arena'?" "$rubble" run misspelt.yaml
echo 'time_limit_s: 3' >none.yaml
expect_exit 3 "'arena' is missing" "$rubble" run none.yaml
expect_exit 3 'letter.part' "$rubble" run part.yaml --out part --force

# Settings that can only be mistakes are refused; those without effect are told in a line, and the run is made.
expect_exit 3 'sim.battery_wh: 0.001 Wh last 0.1 s' "$rubble" run part.yaml --out refused --set sim.battery_wh=0.001
expect_exit 3 'd_min_floor_m, 0.6, must not be larger than d_min_m, 0.4' \
  "$rubble" run part.yaml --out refused --set explorer.d_min_floor_m=0.6
[[ -e refused ]] && fail "a refused run leaves a folder"
expect_exit 0 'explorer.cruise_speed=1.5: the robot drives no faster than robot.max_v=0.7' \
  "$rubble" run part.yaml --out fast --set time_limit_s=3 --set explorer.return_home=false --set explorer.cruise_speed=1.5
expect_exit 0 'explorer.victims.other_senses=everywhere: the robot has neither microphones nor a CO2 probe' \
  "$rubble" run part.yaml --out deaf --set time_limit_s=3 --set explorer.return_home=false \
  --set explorer.victims.other_senses=everywhere --set sim.microphones=false --set sim.co2_probe=false
expect_exit 0 ', to be heard only: it lacks the sense; give it sim.microphones=true' \
  "$rubble" run part.yaml --out mute --set time_limit_s=3 --set explorer.return_home=false \
  --set arena.generate.victims=2 --set arena.generate.sound_alone=1 --set sim.microphones=false

# What holds no log says why, and where one is.
expect_exit 3 'nofolder: does not exist' "$rubble" replay nofolder
mkdir beside
expect_exit 0 '' "$rubble" run part.yaml --out beside/run --set time_limit_s=3
expect_exit 0 '' "$rubble" map beside/run/log.rlog --out beside/mapped
for command in 'replay beside/mapped' 'export beside/mapped run.rawlog' 'map beside/mapped --out again'; do
  # shellcheck disable=SC2086
  expect_exit 3 "no log.rlog in it; 'rubble map' wrote it" "$rubble" $command
  grep -q 'the newest beside it is beside/run$' err.txt || fail "$command: the recorded run is not named: $(cat err.txt)"
done
[[ -e run.rawlog || -e again ]] && fail "a refused command leaves a file"
expect_exit 0 '' "$rubble" export beside/run run.rawlog
finish
