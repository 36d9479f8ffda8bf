# Victims without a list: read from the symbols that the map shows; a list that is given wins.
. "$(dirname "$0")/lib.sh"
cat >s.yaml <<'YAML'
name: small
arena: {generate: {columns: 5, rows: 4, ramps: 0, paper: 0, loops: 0.3, victims: 3}}
seed: 3
time_limit_s: 600
YAML
"$rubble" run s.yaml --out a >/dev/null || fail "run ended with $?"
json_holds a/score.json "j['victims_found'] >= 2"

# The symbols earn what the list of the same run earns, and say so.
"$rubble" score a/map.tif a/truth.tif --json >drawn.json || fail "score ended with $?"
"$rubble" score a/map.tif a/truth.tif --pois a/pois.csv --json >listed.json || fail "score --pois ended with $?"
python3 - <<'PY' || fail "symbols and list differ: $(cat drawn.json listed.json)"
import json
run, drawn, listed = (json.load(open(f)) for f in ('a/score.json', 'drawn.json', 'listed.json'))
assert drawn['victims_from'] == 'symbols' and listed['victims_from'] == 'csv', (drawn, listed)
assert drawn['victim_symbols'] == listed['victim_symbols'] == run['victims_reported'], (drawn, run)
for j in (drawn, listed):
    assert j['victims_found'] == run['victims_found'] and j['victims_total'] == 3, (j, run)
    assert j['victims_false'] == run['victims_false'], (j, run)
assert abs(drawn['victims_error_m'] - listed['victims_error_m']) < 0.025, (drawn, listed)
assert abs(drawn['points_location'] - listed['points_location']) < 1, (drawn, listed)
assert abs(drawn['points_quality'] - listed['points_quality']) < 1, (drawn, listed)
PY
"$rubble" score a/map.tif a/truth.tif >table.txt || fail "table"
grep -qE '^victims reported +[0-9] from symbols' table.txt || fail "the table does not say where victims came from: $(cat table.txt)"
grep -qE '^victims found +[0-9] of 3' table.txt || fail "the table does not say how many: $(cat table.txt)"

# A grey map has none; the wrong list is the user's word; a pose by hand finds them too.
"$rubble" score a/map.yaml a/truth.tif --json >grey.json || fail "grey map"
json_holds grey.json "j['victims_from'] == 'none' and j['victim_symbols'] == 0 and j['victims_found'] is None"
printf 'name,x,y\nghost,50,50\n' >ghost.csv
"$rubble" score a/map.tif a/truth.tif --pois ghost.csv --json >ghost.json || fail "ghost"
json_holds ghost.json "j['victims_from'] == 'csv' and j['victims_found'] == 0 and j['victims_false'] == 1 and j['victims_error_m'] is None"
pose=$(python3 -c "import json, math; j = json.load(open('drawn.json')); print('%.6f,%.6f,%.6f' % (j['align_x_m'], j['align_y_m'], math.degrees(j['align_rad'])))")
"$rubble" score a/map.tif a/truth.tif --pose="$pose" --json >posed.json || fail "pose"
json_holds posed.json "j['victims_from'] == 'symbols' and j['victims_found'] >= 2 and j['victims_error_m'] < 0.3"
expect_exit 3 'nowhere.csv' "$rubble" score a/map.tif a/truth.tif --pois nowhere.csv

# A list that counts from the robot's start lies right on ROS maps, too; where the start is not known the symbols are taken.
found=$(python3 -c "import json; print(json.load(open('a/score.json'))['victims_found'])")
"$rubble" score a/map.yaml a/truth.tif --pois a/pois.csv --json >ros.json || fail "ROS map with a list"
json_holds ros.json "j['victims_from'] == 'csv' and j['victims_found'] == $found and j['victims_error_m'] < 0.3"
expect_exit 0 'does not say; the symbols on the map are taken' \
  "$rubble" score a/map.png a/truth.tif --resolution 0.025 --pois a/pois.csv --json
cp out.txt picture.json
json_holds picture.json "j['victims_from'] == 'symbols' and j['victims_found'] == $found"
"$rubble" score a/map.tif a/truth.png --truth-resolution 0.05 --json >bare.json || fail "truth without tags"
json_holds bare.json "j['victims_found'] is None"
expect_exit 3 'does not say where to lay' \
  "$rubble" score a/map.tif a/truth.png --truth-resolution 0.05 --victims a/arena.yaml
# Anchored on Earth: the run's own score knows where the robot started, the judge's symbols need not.
"$rubble" run s.yaml --out earth --set geo.latitude_deg=49 --set geo.longitude_deg=8.4 --set geo.heading_deg=30 >/dev/null ||
  fail "run on Earth ended with $?"
json_holds earth/score.json "j['victims_found'] == $found and j['victims_false'] == 0"
expect_exit 0 'anchored on Earth' "$rubble" score earth/map.tif earth/truth.tif --pois earth/pois.csv --json
cp out.txt earth.json
json_holds earth.json "j['victims_from'] == 'symbols' and j['victims_found'] == $found"
expect_exit 2 'within 10000 m' "$rubble" score a/map.tif a/truth.tif --pose=1e9,0,0
expect_exit 2 '--league' "$rubble" score a/map.tif a/truth.tif --judge x.csv

# One resolution for the images that say nothing of theirs leaves georeferenced teams alone.
mkdir mixed && cp a/map.tif mixed/tags.tif && cp a/map.png mixed/bare.png
"$rubble" score --league mixed a/truth.tif --resolution 0.025 >mixed.txt || fail "mixed league"
grep -cE ' 0\.9[0-9]+ ' mixed.txt | grep -qx 2 || fail "one resolution for all: $(cat mixed.txt)"
mkdir coarse && gdal_translate -q -outsize 50% 50% -co PROFILE=BASELINE a/map.tif coarse/bare.tif && cp a/map.tif coarse/tags.tif
"$rubble" score --league coarse a/truth.tif --resolution 0.05 >coarse.txt || fail "mixed league"
grep -cE ' 0\.[89][0-9]+ ' coarse.txt | grep -qx 2 || fail "the tags do not hold: $(cat coarse.txt)"
expect_exit 2 '--pois' "$rubble" score --league . a/truth.tif --pois a/pois.csv

# In a league a team with a list, one with symbols only, one with neither.
mkdir maps
cp a/map.tif maps/listed.tif; cp a/pois.csv maps/listed.csv; cp a/map.tif maps/drawn.tif
"$rubble" arena a/arena.yaml --out plain >/dev/null && cp plain/*-visible.tif maps/bare.tif
"$rubble" score --league maps a/truth.tif --out judged >league.txt || fail "league"
python3 - <<'PY' || fail "the league does not read symbols: $(cat judged/league.csv)"
import csv
by = {r['team']: r for r in csv.DictReader(open('judged/league.csv'))}
assert by['listed']['victims_from'] == 'csv' and by['drawn']['victims_from'] == 'symbols', by
assert by['bare']['victims_from'] == 'none' and by['bare']['victim_symbols'] == '0', by
assert by['listed']['victims_found'] == by['drawn']['victims_found'] != '0', by
assert abs(float(by['listed']['points']) - float(by['drawn']['points'])) < 1, by
PY
grep -q 'symbols' league.txt || fail "the league's table does not say where victims came from"

# 1680 reports all over the arena and far outside earn nothing, on the terminal too.
python3 - >grid.csv <<'PY'
print('name,x,y')
for y in range(40):
    for x in range(42): print(f'r{x}_{y},{0.3 * x - 4:.2f},{0.3 * y - 4:.2f}')
PY
"$rubble" score a/map.tif a/truth.tif --pois grid.csv --json >grid.json || fail "grid"
json_holds grid.json "j['victims_found'] == 3 and j['victims_false'] == 1677 and j['points_victims'] == 0 and j['points_quality'] > 20"
"$rubble" score a/map.tif a/truth.tif --pois grid.csv >table.txt || fail "grid"
grep -qE '^points for victims +0\.0' table.txt || fail "the table does not show what the grid earns: $(cat table.txt)"
finish
