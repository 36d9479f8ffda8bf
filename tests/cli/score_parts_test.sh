# What only some options of rubble score show: eq. (7), features and their pictures, a map that came apart, a refused pose.
. "$(dirname "$0")/lib.sh"
command -v gdal_translate >/dev/null || { echo "gdal-bin is not installed"; exit 77; }
"$rubble" arena generate --cells 8x8 --seed 3 --out . >/dev/null || fail "no arena"
"$rubble" arena generate --cells 8x8 --seed 4 --out other >/dev/null || fail "no other arena"
truth=$(ls ./*-truth.tif) other=$(ls other/*-truth.tif)

# Eq. (7) as the way to the pose.
"$rubble" score "$truth" "$truth" --align eq7 --json >eq7.json || fail "--align eq7 ended with $?"
json_holds eq7.json "j['aligned'] and j['score'] > 0.99 and abs(j['align_x_m']) < 0.02 and abs(j['align_y_m']) < 0.02"
json_holds eq7.json "j['align_tried'] == 'eq7' and 'eq7' in j['align_source']"

# Each kind of features, their mean, and a picture of the partners.
"$rubble" score "$truth" "$truth" --warp --out warped --json >same.json || fail "--warp ended with $?"
json_holds same.json "j['feature_error_m2'] < 1e-9 and j['feature_matched'] > 12 and j['feature_stranger_m2'] > 0.2"
json_holds same.json "all(j[k] > 0.99 for k in ('feature_score', 'surf_score', 'corner_score', 'room_score'))"
for kind in surf corners rooms; do
  [[ $(head -c 4 warped/matches_$kind.png | tail -c 3) == PNG ]] || fail "no picture of the $kind"
done
"$rubble" score "$truth" "$truth" --out plain >/dev/null || fail "--out"
ls plain/matches_* 2>/dev/null && fail "pictures of features that nobody asked for"

# East of the middle 0.4 m further north: two parts of one map.
gdal_translate -q -of PNM "$truth" truth.ppm
python3 <<'PY'
data = open("truth.ppm", "rb").read()
head, size, top, rest = data.split(b"\n", 3)
w, h = map(int, size.split())
unknown, middle, by = bytes((226, 226, 227)), w // 2, 8
row = lambda y: rest[3 * w * y : 3 * w * (y + 1)] if 0 <= y < h else unknown * w
rows = [row(y - by)[: 3 * middle] + row(y)[3 * middle :] for y in range(h + by)]
open("apart.ppm", "wb").write(b"P6\n%d %d\n255\n" % (w, h + by) + b"".join(rows))
PY
"$rubble" score apart.ppm "$truth" --resolution 0.05 --warp --json >apart.json || fail "a map that came apart ended with $?"
json_holds apart.json "j['aligned'] and j['broken'] and abs(j['break_m'] - 0.4) < 0.1 and j['mended_score'] > j['score'] + 0.1"
json_holds apart.json "abs(j['break_from_x_m'] - j['break_to_x_m']) < 1.2 and abs(j['break_from_y_m'] - j['break_to_y_m']) > 7"
json_holds apart.json "j['corner_score'] < 0.95 and min(j[k] for k in ('surf_score', 'corner_score', 'room_score')) <= j['feature_score'] <= max(j[k] for k in ('surf_score', 'corner_score', 'room_score'))"
"$rubble" score apart.ppm "$truth" --resolution 0.05 --warp >apart.txt || fail "table"
grep -qE '^came apart +two parts, 0\.[345][0-9] m and -?[0-9.]+ deg apart, seam from' apart.txt || fail "not told: $(cat apart.txt)"

# The pose of a refused map is shown, and what the score would be there.
"$rubble" score "$other" "$truth" --json >refused.json || fail "another arena ended with $?"
json_holds refused.json "not j['aligned'] and j['score'] == 0 and 0 <= j['score_at_best_pose'] < 0.2 and j['align_source'] and j['worst_places'] == []"
pose=$(python3 -c "import json, math; j = json.load(open('refused.json')); print('%.6f,%.6f,%.6f' % (j['align_x_m'], j['align_y_m'], math.degrees(j['align_rad'])))")
"$rubble" score "$other" "$truth" --pose="$pose" --json >there.json || fail "at the pose that was refused"
python3 -c "
import json
refused, there = json.load(open('refused.json')), json.load(open('there.json'))
assert abs(refused['score_at_best_pose'] - there['score']) < 1e-4, (refused['score_at_best_pose'], there['score'])" ||
  fail "the score at the best pose is another one than at that pose"
"$rubble" score "$other" "$truth" >refused.txt || fail "table"
grep -qE '^score there, not trusted +0\.[01]' refused.txt || fail "not told: $(cat refused.txt)"
finish
