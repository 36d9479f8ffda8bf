# Odd and bad map files: each gets a defined answer, none a good score; damaged ones one line.
. "$(dirname "$0")/lib.sh"
command -v gdal_translate >/dev/null || { echo "gdal-bin is not installed"; exit 77; }

"$rubble" arena generate --cells 7x6 --seed 5 --out . >/dev/null || fail "no arena"
truth=$(ls ./*-truth.tif)

# expect_score EXPRESSION COMMAND...: python over j, what --json prints.
expect_score() {
  local expression=$1
  shift
  "$rubble" score "$@" --json >score.json 2>err.txt || fail "score $* ended with $?: $(head -c 300 err.txt)"
  python3 -c "import json; j = json.load(open('score.json')); assert $expression, j" 2>err.txt ||
    fail "score $*: not $expression: $(tail -c 600 err.txt)"
}

# Any layout of a TIFF is the same map.
gdal_translate -q -co TILED=YES -co COMPRESS=DEFLATE "$truth" tiled.tif
gdal_translate -q -co COMPRESS=LZW -co INTERLEAVE=BAND "$truth" planes.tif
gdal_translate -q -ot UInt16 -scale 0 255 0 65535 "$truth" deep.tif
gdal_translate -q -ot UInt16 "$truth" unscaled.tif
for map in tiled.tif planes.tif deep.tif unscaled.tif; do expect_score "j['aligned'] and j['score'] > 0.99" "$map" "$truth"; done

# What it is called: by its tags; shares as people write them, though the file holds 0.0500000007.
gdal_translate -q -co PROFILE=BASELINE "$truth" bare.tif 2>/dev/null
rm -f bare.tfw bare.tif.aux.xml
gdal_translate -q -b 1 -ot Float32 -scale 0 255 0.05 0.95 "$truth" shares.tif
expect_score "j['map'].startswith('TIFF 0.05 m') and j['truth'].startswith('GeoTIFF 0.05 m')" bare.tif "$truth" --resolution 0.05
expect_score "'from 0.05 to 0.95' in j['map']" shares.tif "$truth"

# A mirror image, another arena, a wrong scale, no wall at all.
python3 <<'PY'
open("white.pgm", "wb").write(b"P5 300 300 255\n" + b"\xff" * 90000)
wall = bytearray(b"\xff" * 90000)
for x in range(50, 250):
    wall[150 * 300 + x] = 0
open("wall.pgm", "wb").write(b"P5 300 300 255\n" + bytes(wall))
PY
gdal_translate -q -of PNG "$truth" truth.png
expect_score "not j['aligned'] and j['score'] == 0" white.pgm "$truth" --resolution 0.05
expect_score "not j['aligned'] and j['score'] == 0" wall.pgm "$truth" --resolution 0.05
expect_score "j['aligned']" truth.png "$truth" --resolution 0.05
expect_score "not j['aligned'] and j['scale_hint'] == 0.5 and '--resolution 0.05' in j['align_note']" \
  truth.png "$truth" --resolution 0.1
expect_score "not j['aligned'] and j['scale_hint'] == 2 and '--resolution 0.05' in j['align_note']" \
  truth.png "$truth" --resolution 0.025
for wrong in 0.02 0.03 0.04 0.0625 0.08; do
  expect_score "not j['aligned'] and j['score'] == 0 and abs(j['scale_hint'] * $wrong - 0.05) < 0.0005 and 'give --resolution 0.05' in j['align_note']" \
    truth.png "$truth" --resolution $wrong
done
"$rubble" arena generate --cells 7x6 --seed 77 --out other >/dev/null || fail "no other arena"
expect_score "not j['aligned'] and j['score'] == 0 and j['align_note']" other/*-truth.tif "$truth"

# The truth's mirror image, both ways; and every refusal says why in one line.
gdal_translate -q -of PNM "$truth" truth.ppm
python3 <<'PY'
data = open("truth.ppm", "rb").read()
_, size, top, rest = data.split(b"\n", 3) if data.split(b"\n", 3)[2] == b"255" else (None, None, None, None)
w, h = map(int, size.split())
rows = [rest[3 * w * y : 3 * w * (y + 1)] for y in range(h)]
head = b"P6\n%d %d\n255\n" % (w, h)
open("upside_down.ppm", "wb").write(head + b"".join(reversed(rows)))
left = [b"".join(row[3 * x : 3 * x + 3] for x in range(w - 1, -1, -1)) for row in rows]
open("mirrored.ppm", "wb").write(head + b"".join(left))
PY
for map in upside_down.ppm mirrored.ppm; do
  expect_score "not j['aligned'] and j['score'] == 0 and j['psi_m'] >= 5" $map "$truth" --resolution 0.05
done
for map in white.pgm wall.pgm upside_down.ppm other/*-truth.tif; do
  "$rubble" score $map "$truth" --resolution 0.05 >table.txt 2>err.txt || fail "$map ended with $?"
  [[ $(grep -c '^not aligned ' table.txt) == 1 && ! -s err.txt ]] || fail "$map: no reason in one line: $(cat table.txt err.txt)"
  grep -qE '^(overlap|precision|recall|psi) ' table.txt && fail "$map: figures that nobody measured: $(cat table.txt)"
  grep -qE '^score +0\.000' table.txt || fail "$map: no score: $(cat table.txt)"
done

# What can be done about a refusal: nothing of a map without walls; --start of one that counts from there.
"$rubble" score white.pgm "$truth" --resolution 0.05 >table.txt || fail "white.pgm"
grep -q '^to go on' table.txt && fail "a map without walls is laid by hand: $(cat table.txt)"
"$rubble" score upside_down.ppm "$truth" --resolution 0.05 >table.txt || fail "upside_down.ppm"
grep -q '^to go on .*--html.*--pose' table.txt || fail "a refused map has no way on: $(cat table.txt)"
grep -q '^to go on .*--start' table.txt && fail "--start of a picture that does not count from there: $(cat table.txt)"
"$rubble" score other/*-truth.tif "$truth" >table.txt || fail "another arena"
grep -q '^to go on .*--html.*--pose.*--start=X,Y,DEG' table.txt || fail "--start is not named: $(cat table.txt)"
"$rubble" score other/*-truth.tif "$truth" --start=0,0,0 >table.txt || fail "another arena with a start"
grep -q '^to go on .*--start' table.txt && fail "--start was given: $(cat table.txt)"

# Walls that the truth knows nothing about are in no score, but counted.
expect_score "j['ignored_m'] == 0" "$truth" "$truth"
gdal_translate -q -srcwin 0 0 $(($(gdalinfo "$truth" | sed -n 's/^Size is \([0-9]*\), \([0-9]*\)/\1 * 7 \/ 10/p'))) \
  $(($(gdalinfo "$truth" | sed -n 's/^Size is \([0-9]*\), \([0-9]*\)/\2/p'))) "$truth" part.tif
expect_score "j['aligned'] and j['ignored_m'] > 3 and j['phantom_m'] < 0.5 and j['precision'] > 0.98" "$truth" part.tif

# Methods, and the parts of the score.
expect_score "j['align_source'] == 'walls' and j['phantom_m'] == 0 and j['worst_places'] == []" "$truth" "$truth"
expect_score "j['aligned'] and 'features' in j['align_source']" "$truth" "$truth" --align surf
expect_score "j['warped_score'] == 1 and j['warp_m'] == 0 and j['feature_error_m2'] < 1e-9" "$truth" "$truth" --warp
expect_score "j['aligned'] and j['align_tried'] == 'features+rooms' and j['align_source'] != 'walls'" \
  "$truth" "$truth" --align rooms,features
expect_score "j['align_tried'] == 'walls' and j['align_measure'] == 'agreement' and 0 < j['align_margin'] <= j['align_agreement'] <= 2 and j['align_runner_up_source']" \
  "$truth" "$truth"
"$rubble" score "$truth" "$truth" >table.txt || fail "table"
grep -qE '^proposed by +walls' table.txt && grep -qE '^runner-up pose +0\.[0-9]+ of the best .*by walls' table.txt ||
  fail "the table does not name winner and runner-up: $(cat table.txt)"
grep -qE '^score +1\.000 +1 the truth, 0 ' table.txt || fail "the table does not say what a score of 1 means: $(cat table.txt)"

# Scripts that shall stop where a map is too bad, or not aligned.
expect_exit 0 "" "$rubble" score "$truth" "$truth" --fail-under 1
expect_exit 0 "" "$rubble" score white.pgm "$truth" --resolution 0.05
expect_exit 1 "is not aligned" "$rubble" score white.pgm "$truth" --resolution 0.05 --fail-under 0
expect_exit 1 "is not aligned" "$rubble" score white.pgm "$truth" --resolution 0.05 --fail-under 0 --json
expect_exit 1 "the score is below 0.9" "$rubble" score "$truth" "$truth" --pose=0.2,0,0 --fail-under 0.9
expect_exit 2 "--fail-under" "$rubble" score "$truth" "$truth" --fail-under 2
expect_exit 2 "--fail-under" "$rubble" score --league . "$truth" --fail-under 0.5

for wrong in magic rooms,magic auto,rooms surf,orb rooms, ,rooms; do
  expect_exit 2 '--align' "$rubble" score "$truth" "$truth" --align "$wrong"
done

# What cannot be read.
head -c $(($(stat -c %s "$truth") / 2)) "$truth" >cut.tif
printf 'name: a\nmaze: |\n  +---+\n  | . |\n  +---+\n' >arena.yaml
expect_exit 3 'is an arena, not a map' "$rubble" score arena.yaml "$truth"
printf 'image: wall.pgm\nresolution: 2.5\norigin: [0, 0, 0]\n' >centimetres.yaml
expect_exit 3 'centimetres.yaml:2:' "$rubble" score centimetres.yaml "$truth" --pose=0,0,0
grep -qF '2.5' err.txt || fail "the scale that is none is not named: $(cat err.txt)"
expect_exit 3 'cut.tif' "$rubble" score cut.tif "$truth"
gdal_translate -q -of JPEG -co QUALITY=95 "$truth" truth.jpg
gdal_translate -q -of BMP "$truth" truth.bmp
gdal_translate -q -b 1 -of PNM "$truth" truth.pgm
for type in png jpg bmp pgm ppm; do
  for share in 10 50 90; do
    head -c $(($(stat -c %s truth.$type) * share / 100)) truth.$type >cut.$type
    expect_exit 3 "cut.$type" "$rubble" score cut.$type "$truth" --resolution 0.05
  done
done
python3 <<'PY'
for name in "truth.png", "truth.jpg":
    data = bytearray(open(name, "rb").read())
    open(name.replace("truth", "trailing"), "wb").write(data + b"anything" * 20)
    data[len(data) // 2 : len(data) // 2 + 40] = b"\xff\x17" * 20
    open(name.replace("truth", "damaged"), "wb").write(data)
data = open("truth.jpg", "rb").read()
open("endless.jpg", "wb").write(data[:-2])
# Coded pixels of which a piece is gone: every marker is in its place.
open("short.jpg", "wb").write(data[: len(data) // 2] + data[len(data) // 2 + 3000 :])
PY
for map in damaged.png damaged.jpg endless.jpg short.jpg; do
  expect_exit 3 "$map" "$rubble" score $map "$truth" --resolution 0.05
done
expect_score "j['aligned']" trailing.png "$truth" --resolution 0.05
expect_score "j['aligned']" trailing.jpg "$truth" --resolution 0.05
[[ ! -s err.txt ]] || fail "a whole JPEG is complained of: $(cat err.txt)"
printf 'P5 20000 20000 255\n' >huge.pgm
head -c 400000000 /dev/zero >>huge.pgm
expect_exit 3 '20000 x 20000' "$rubble" score huge.pgm "$truth" --resolution 0.05
rm huge.pgm
gdal_create -q -outsize 20000 20000 -ot Byte -co SPARSE_OK=TRUE -co TILED=YES huge.tif 2>/dev/null &&
  expect_exit 3 '20000 x 20000' "$rubble" score huge.tif "$truth" --resolution 0.05
gdal_create -q -outsize 20001 3 -ot Byte wide.tif 2>/dev/null &&
  expect_exit 3 '20001 x 3' "$rubble" score wide.tif "$truth" --resolution 0.05
finish
