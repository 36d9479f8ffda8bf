# rubble rooms: the rooms of a map, by both methods, and what is left of them against a truth.
. "$(dirname "$0")/lib.sh"

# Four rooms around a cross of walls with doors, 0.05 m a pixel, the northern ones 3.05 m deep and the southern 2.25 m.
python3 <<'PY'
def plan(name, east, door=18):
    w, h, m = 10 + 81 + 3 + east + 10, 10 + 61 + 3 + 45 + 10, 10
    g = [[205] * w for _ in range(h)]
    def box(x0, y0, x1, y1, v):
        for y in range(y0, y1):
            for x in range(x0, x1):
                g[y][x] = v
    box(m - 3, m - 3, w - m + 3, h - m + 3, 0)
    x, y = m + 81, m + 61
    box(m, m, x, y, 254); box(x + 3, m, w - m, y, 254)
    box(m, y + 3, x, h - m, 254); box(x + 3, y + 3, w - m, h - m, 254)
    box(x, m + 20, x + 3, m + 20 + door, 254); box(x, y + 24, x + 3, y + 24 + door, 254)
    box(m + 30, y, m + 30 + door, y + 3, 254)
    open(name, "wb").write(b"P5 %d %d 255\n" % (w, h) + bytes(v for row in g for v in row))
plan("truth.pgm", 85)
PY
for method in passages visibility; do
  "$rubble" rooms truth.pgm --resolution 0.05 --method $method --out $method >table.txt 2>err.txt || fail "$method ended with $?: $(cat err.txt)"
  grep -qE '^rooms +4$' table.txt || fail "$method: not four rooms: $(cat table.txt)"
  [[ $(wc -l <$method/rooms.csv) == 5 && -s $method/rooms.png ]] || fail "$method: no list and picture"
done
grep -qE '^room 1 .*box 4\.[67][05], 2\.[789][05] to 8\.95, 5\.95 m' <("$rubble" rooms truth.pgm --resolution 0.05) ||
  fail "the largest room has another box: $("$rubble" rooms truth.pgm --resolution 0.05)"
"$rubble" rooms truth.pgm truth.pgm --resolution 0.05 --truth-resolution 0.05 --out same >same.txt || fail "same: $?"
[[ -s same/matched_rooms.png ]] || fail "no picture of the rooms that belong together"
grep -qE '^room agreement +1\.000$' same.txt || fail "a map has its own rooms wrong: $(cat same.txt)"

# At the pose that is found, and where a person says.
same() { "$rubble" rooms truth.pgm truth.pgm --resolution 0.05 --truth-resolution 0.05 "$@"; }
same --json >same.json || fail "--json ended with $?"
json_holds same.json "j['aligned'] and j['room_agreement'] > 0.999 and len(j['rooms']) == len(j['truth_rooms']) == len(j['pairs']) == 4"
json_holds same.json "j['rooms'][0]['name'] == 'room 1' and abs(j['rooms'][0]['area_m2'] - 4.25 * 3.05) < 0.2 and j['missing'] == j['surplus'] == []"
same --json --pose=0.5,0,0 >off.json || fail "--pose ended with $?"
json_holds off.json "all(abs(p['offset_m'] - 0.5) < 1e-6 for p in j['pairs']) and j['T_truth_map']['x_m'] == 0.5 and j['room_agreement'] < 0.95"
same --json --pose=0,0,0,0.5 >half.json || fail "--pose with a scale ended with $?"
json_holds half.json "abs(j['rooms'][0]['area_m2'] - 4.25 * 3.05 / 4) < 0.1"
"$rubble" rooms truth.pgm --resolution 0.05 --json >alone.json || fail "--json of a map alone ended with $?"
json_holds alone.json "list(j) == ['rooms'] and len(j['rooms']) == 4"
# A run's own map of an arena, where rooms end at openings that are nearly as wide as they: divided as the truth is.
"$rubble" run --seed 3 --out run >/dev/null 2>&1 || fail "no run"
"$rubble" rooms run/map.tif run/truth.tif --json --out arena >arena.json || fail "rooms of an arena ended with $?"
json_holds arena.json "j['room_agreement'] > 0.9 and j['missing'] == j['surplus'] == [] and len(j['rooms']) == len(j['truth_rooms']) > 9"
[[ $(wc -l <arena/rooms.csv) == $(wc -l <arena/truth_rooms.csv) ]] || fail "the list of rooms is of another division"
# What the page and the pictures of rubble score --warp show of rooms is the same, also where many are wrong.
counts() {
  python3 - "$1" "$2" <<'PY'
import json, re, sys
rooms = json.load(open(sys.argv[1]))
page = json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', open(sys.argv[2]).read(), re.S).group(1))
[marks] = [m for m in page['marks'] if m['what'] == 'rooms']
assert sorted((m[2], t[2]) for m, t in marks['pairs']) == sorted((p['map'], p['truth']) for p in rooms['pairs']), marks['pairs']
assert [m[2] for m in marks['map']] == rooms['surplus'] and [t[2] for t in marks['truth']] == rooms['missing']
PY
}
"$rubble" map run/log.rlog --set mapper.kind=paper --out paper >/dev/null 2>&1 || fail "no map by the paper's mapper"
for map in run paper; do
  "$rubble" rooms $map/map.tif run/truth.tif --json >rooms.json || fail "rooms of $map ended with $?"
  "$rubble" score $map/map.tif run/truth.tif --warp --html page.html >/dev/null 2>&1 || fail "page of $map ended with $?"
  counts rooms.json page.html || fail "$map: the page counts other rooms"
done
"$rubble" rooms run/map.tif run/truth.tif --method visibility >/dev/null || fail "rooms by sight ended with $?"
expect_exit 2 "--pose goes with a truth" "$rubble" rooms truth.pgm --resolution 0.05 --pose=0,0,0
expect_exit 2 "needs the form" same --pose=1
expect_exit 3 "--resolution" "$rubble" rooms truth.pgm
expect_exit 3 "nowhere.png" "$rubble" rooms nowhere.png
expect_exit 2 "" "$rubble" rooms truth.pgm --method magic
finish
