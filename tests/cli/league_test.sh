# Ranking many maps against one truth: order, ties, bad files, victims and the judge's points.
. "$(dirname "$0")/lib.sh"
arena() { "$rubble" arena generate --cells 5x4 --victims 3 "$@" >/dev/null || fail "arena $*"; }
arena --seed 4 --out a
arena --seed 9 --out b
arena --seed 4 --resolution 0.12 --out coarse
truth=a/yellow-5x4-seed4-truth.tif
mkdir -p maps/good maps/empty
cp $truth maps/good/map.tif
cp $truth maps/twin.tif
cp coarse/*truth.tif maps/coarse.tif
cp b/*truth.tif maps/stranger.tif
head -c 900 $truth >maps/cut.tif
cp $truth maps/broken_list.tif
echo 'no header' >maps/broken_list.csv

# The same three victims in the league's form, in the plain form 0.65 m off, and one of three with a false alarm.
python3 - <<'PY' || fail "no victims in the arena file"
import re
text = open('a/yellow-5x4-seed4.yaml').read()
found = [(float(x), float(y)) for x, y in re.findall(r'x_m: ([-\d.]+), y_m: ([-\d.]+), facing', text)]
assert len(found) == 3, found
head = '"pois"\n"1.3"\n"t"\n""\n"1970-01-01"\n"00:00:00"\n"m"\ndetection,time,type,name,x,y,z,robot,mode\n'
with open('maps/good/pois.csv', 'w') as f:
    f.write(head + '0,00:00:01,qr,q,1,1,0,r,A\n')
    for i, (x, y) in enumerate(found): f.write(f'{i+1},00:01:00,victim,v{i+1},{y},{-x},0,r,A\n')
with open('maps/twin_pois.csv', 'w') as f:
    f.write('name,x,y\r\n' + ''.join(f'"v, {i}",{x + 0.65},{y}\r\n' for i, (x, y) in enumerate(found)))
with open('maps/coarse.csv', 'w') as f:
    f.write(f'name,x,y\nv1,{found[0][0]},{found[0][1]}\nghost,50,50\n')
PY
printf 'team,victim,points\ntwin,v1,30\ntwin,v2,12.5\n' >judge.csv
"$rubble" score --league maps $truth --out judged --judge judge.csv >table.txt 2>err.txt || fail "league: $(cat err.txt)"
python3 - <<'PY' || fail "the ranking is not right: $(cat judged/league.csv)"
import csv
rows = list(csv.DictReader(open('judged/league.csv')))
assert all(None not in r and None not in r.values() for r in rows), rows
by = {r['team']: r for r in rows}
assert [r['team'] for r in rows] == ['twin', 'good', 'broken_list', 'coarse', 'stranger', 'cut', 'empty'], rows
assert [r['rank'] for r in rows] == ['1', '2', '3', '4', '5', '', ''], rows
good, twin, coarse = by['good'], by['twin'], by['coarse']
assert (good['points'], good['points_quality'], good['points_location']) == ('60.0', '30.0', '30.0'), good
assert twin['points_quality'] == '30.0' and twin['points_location'] == '15.0' and twin['judge'] == '42.5', twin
assert good['victims_found'] == twin['victims_found'] == '3' and coarse['victims_found'] == '1', rows
assert coarse['victims_false'] == '1' and float(coarse['points_location']) > 9, coarse
assert good['score'] == '1.000' and good['psi_m'] == '0.000', good
assert by['stranger']['aligned'] == 'no' and by['stranger']['score'] == '0.000', by['stranger']
assert 'cut.tif' in by['cut']['note'] and by['cut']['score'] == '', by['cut']
# A spoilt list does not cost the map; what has no score has no rank.
assert 'broken_list.csv' in by['broken_list']['note'] and by['broken_list']['score'] == '1.000', rows
assert 'map' in by['empty']['note'], rows
page = open('judged/league.html').read()
import os, re
links = set(re.findall(r'(?:src|href)="([^"]+)"', page))
anchors = set(re.findall(r'id="([^"]+)"', page))
assert links and all(l[1:] in anchors if l[0] == '#' else os.path.exists('judged/' + l) for l in links), links
assert 'next: good' in page and 'previous: twin' in page, page
assert any(re.fullmatch(r'stranger-map\d-overlay.png', l) for l in links), links
assert float(good['points_unfined']) == 60.0, good
PY
grep -qE '^ *1 +twin ' table.txt || fail "the table does not show the first: $(cat table.txt)"

# Other names in another order: the same figures and the same ranks; without victims equal maps share a rank.
mkdir renamed
cp $truth renamed/zz.tif; cp $truth renamed/aa.tif; cp maps/coarse.tif renamed/0.tif; cp maps/cut.tif renamed/1.tif
touch no_victims.csv && echo 'name,x,y' >no_victims.csv
"$rubble" score --league renamed $truth --out second >/dev/null || fail "second league"
cut -d, -f1,2,5 second/league.csv >ranks.txt
grep -q '^1,aa,.*the same file as the map of zz' second/league.csv && ! grep '^3,0,' second/league.csv | grep -q 'same file' ||
  fail "equal files are not told: $(cat second/league.csv)"
[[ $(sed -n '2,5p' ranks.txt | cut -d, -f1,2 | tr '\n' ' ') == '1,aa 1,zz 3,0 ,1 ' ]] || fail "ties: $(cat ranks.txt)"
"$rubble" score --league renamed $truth --out third >/dev/null && cmp second/league.csv third/league.csv ||
  fail "the same league twice gives other figures"

# Files bear the team's name; no number before it looks like a rank. What an earlier program numbered is replaced, too.
for file in overlay.png error.png sight.png; do ls second/aa-map[0-9]-$file second/zz-map[0-9]-$file >/dev/null || fail "no $file of a team: $(ls second)"; done
ls second/aa-map[0-9].html >/dev/null && ! ls second | grep -qE '^[0-9]{3}-' || fail "names of files: $(ls second)"
cp second/aa-map*-overlay.png second/001-gone-overlay.png; cp second/aa-map*-overlay.png second/gone-map9-overlay.png
echo '<a href="001-gone-overlay.png"></a><a href="gone-map9-overlay.png"></a>' >>second/league.html
echo mine >second/hall-map2.html  # a page of somebody's own, which no table leads to
cp second/aa-map*-overlay.png second/kept-overlay.png
"$rubble" score --league renamed $truth --out second >/dev/null || fail "second league again"
[[ -e second/kept-overlay.png && -e second/hall-map2.html && ! -e second/001-gone-overlay.png && ! -e second/gone-map9-overlay.png ]] ||
  fail "not the pictures of the earlier league were removed: $(ls second)"

# The truth and pictures of runs among the maps are no teams, and the program says so; the options of a single score hold.
mkdir -p mixed/run mixed/old mixed/judged
cp $truth mixed/truth.tif; cp $truth mixed/$(basename $truth); cp $truth mixed/good.tif
for name in overlay error sight arena 001-x-overlay; do cp "$(ls judged/*-overlay.png | head -1)" mixed/$name.png; done
cp $truth mixed/run/map.tif; cp $truth mixed/run/truth.tif; cp mixed/error.png mixed/run/error.png
cp mixed/overlay.png mixed/old/001-x-overlay.png; cp mixed/error.png mixed/judged/error.png
cp judged/league.csv mixed; cp judged/league.csv mixed/old; touch mixed/judged/score.json
"$rubble" score --league mixed $truth --align rooms,features --warp --out mixed_out >table.txt || fail "mixed league"
grep -q 'after warp</th>' mixed_out/league.html || fail "the page has no column of scores after the warp"
[[ $(tail -n +2 mixed_out/league.csv | cut -d, -f2 | sort | tr '\n' ' ') == 'good run ' ]] ||
  fail "not only the teams: $(cut -d, -f2 mixed_out/league.csv | tr '\n' ' ')"
for name in truth.tif overlay.png error.png sight.png arena.png run/truth.tif old/001-x-overlay.png; do
  grep -q "^no team's maps:.*$name" table.txt || fail "does not say that $name was skipped: $(cat table.txt)"
done
python3 - <<'PY' || fail "--align and --warp do not reach the league: $(cat mixed_out/league.csv)"
import csv
for r in csv.DictReader(open('mixed_out/league.csv')):
    assert r['align_source'] != 'walls' and r['align_source'], r
    assert r['warped_score'] == '1.000' and r['phantom_m'] == '0.00' and r['ignored_m'] == '0.00', r
PY
"$rubble" score --league mixed $truth --align akaze --out akaze_out >/dev/null || fail "league by akaze"
! cut -d, -f1-40 akaze_out/league.csv | grep -q ',walls,' || fail "akaze was not asked: $(cat akaze_out/league.csv)"
expect_exit 2 '--align' "$rubble" score --league mixed $truth --align magic
"$rubble" score --league mixed $truth --tau 0.3 --out tau_out >/dev/null || fail "league with --tau"
grep -q -- '--tau 0.3' tau_out/good-map*.html || fail "the page's command gives other figures than the page: no --tau"
mkdir victims && cp $truth victims/drawn.tif && cp $truth victims/listed.tif
printf 'name,x,y\nv,1,1\n' >victims/listed.csv && cp victims/listed.csv true.csv
"$rubble" score --league victims $truth --victims true.csv --out victims_out >/dev/null || fail "league with lists of victims"
grep -qF -- "--pois victims/listed.csv --victims true.csv" victims_out/listed-map*.html ||
  fail "the page's command gives other victims than the page: $(grep -o 'command":"[^"]*' victims_out/listed-map*.html)"
grep -o 'command":"[^"]*' victims_out/drawn-map*.html | grep -q -- '--pois' && fail "a list that the team has not"
# Names that only look like pictures of runs take part; a copy of the truth is said to be one, and ranked.
mkdir named
for name in search-and-error error arena ground_truth half-visible copied x; do cp maps/coarse.tif named/$name.tif; done
cp $truth named/copied.tif; cp "$(ls judged/*-overlay.png | head -1)" named/x-error.png
"$rubble" score --league named $truth --out named_out >table.txt || fail "named league"
[[ $(tail -n +2 named_out/league.csv | cut -d, -f2 | sort | tr '\n' ' ') == 'arena copied error ground_truth half-visible search-and-error x ' ]] ||
  fail "not all teams: $(cat table.txt)"
grep -q "^no team's maps: x-error.png$" table.txt || fail "x-error.png is no map of a team: $(cat table.txt)"
[[ $(grep -c 'a copy of the truth' named_out/league.csv) == 1 ]] && grep -q '^1,copied,.*a copy of the truth' named_out/league.csv ||
  fail "the copy of the truth is not said to be one: $(cat named_out/league.csv)"
# One team's link to itself, or its name that is too long for a list beside it, keeps nobody from being judged.
mkdir odd && cp $truth odd/fine.tif && ln -s self.tif odd/self.tif && cp $truth "odd/$(printf 'x%.0s' $(seq 250)).tif"
expect_exit 0 "" "$rubble" score --league odd $truth --out odd_out
grep -q '^1,fine,' odd_out/league.csv || fail "odd names in a league: $(cut -c1-200 odd_out/league.csv)"
grep -q '^[^,]*,self,.*leads to no file' odd_out/league.csv || fail "a link to itself has no row: $(cut -c1-200 odd_out/league.csv)"

# One map that can be read makes a league, none does not: the table says why, and the exit code that it is none.
mkdir bad && printf 'II*\0 no map' >bad/one.tif && printf 'no picture' >bad/two.png
expect_exit 3 'bad: none of its maps can be read' "$rubble" score --league bad $truth --out bad_out
grep -q ' one ' out.txt && grep -q ' two ' out.txt && [[ -s bad_out/league.html ]] || fail "no table: $(cat out.txt)"
cp maps/coarse.tif bad/three.tif
expect_exit 0 '' "$rubble" score --league bad $truth

mkdir none && cp $truth none/truth.tif
expect_exit 3 'truth.tif' "$rubble" score --league none $truth

expect_exit 2 'the truth is missing: rubble score --league maps TRUTH' "$rubble" score --league maps
# A picture of a kind that is not read is no reason to leave a team out without a word; beside a map it is a logo.
mkdir -p pictures/beta && cp maps/*.tif pictures/ 2>/dev/null
printf 'RIFF\x10\0\0\0WEBPVP8 ' | tee pictures/gamma.webp >pictures/beta/logo.webp
cp "$(ls maps/*.tif | head -n 1)" pictures/beta/map.tif
"$rubble" score --league pictures $truth >out.txt 2>err.txt || fail "a picture that is not read ends a league"
grep -q 'gamma .*WebP' out.txt || fail "a WebP picture is left out of the league"
grep -q 'beta .*WebP\|beta .*several' out.txt && fail "a logo beside a map is taken for one"
expect_exit 2 'truth only' "$rubble" score --league maps $truth $truth
expect_exit 2 '--pose' "$rubble" score --league maps $truth --pose 1,2,3
expect_exit 3 'nowhere' "$rubble" score --league nowhere $truth
expect_exit 3 'no maps' "$rubble" score --league maps/empty $truth
expect_exit 3 'nowhere.tif' "$rubble" score --league maps nowhere.tif
printf 'team,points\nnobody,3\n' >wrong.csv
expect_exit 3 "team 'nobody'" "$rubble" score --league maps $truth --judge wrong.csv
printf 'team,victim,points\ngood,v1,31\n' >wrong.csv
expect_exit 3 'wrong.csv:2:1' "$rubble" score --league maps $truth --judge wrong.csv
printf 'team,victim,points\ngood,v1,30\ntwin,v1,3\ngood,v1,30\n' >wrong.csv
expect_exit 3 "wrong.csv:4:1: victim 'v1' of team 'good' stands here twice" "$rubble" score --league maps $truth --judge wrong.csv
printf 'name,x,y\nv1,here,2\n' >wrong.csv
expect_exit 3 'wrong.csv:2:1' "$rubble" score --league maps $truth --victims wrong.csv
finish
