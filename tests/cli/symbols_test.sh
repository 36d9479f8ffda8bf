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
json_holds grey.json "j['victims_from'] == 'none' and j['victim_symbols'] == 0 and 'victims_found' not in j"
printf 'name,x,y\nghost,50,50\n' >ghost.csv
"$rubble" score a/map.tif a/truth.tif --pois ghost.csv --json >ghost.json || fail "ghost"
json_holds ghost.json "j['victims_from'] == 'csv' and j['victims_found'] == 0 and j['victims_false'] == 1"
pose=$(python3 -c "import json, math; j = json.load(open('drawn.json')); print('%.6f,%.6f,%.6f' % (j['align_x_m'], j['align_y_m'], math.degrees(j['align_rad'])))")
"$rubble" score a/map.tif a/truth.tif --pose="$pose" --json >posed.json || fail "pose"
json_holds posed.json "j['victims_from'] == 'symbols' and j['victims_found'] >= 2 and j['victims_error_m'] < 0.3"
expect_exit 3 'nowhere.csv' "$rubble" score a/map.tif a/truth.tif --pois nowhere.csv
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
finish
