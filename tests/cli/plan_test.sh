# rubble plan: the picture of the Exploration Transform over any map, as in Fig. 9 of the paper.
. "$(dirname "$0")/lib.sh"

# A room of 6 x 3 m, the east end open to what nobody has seen; a post stands in the way.
python3 - <<'PY'
width, height = 140, 62
cell = lambda x, y: 205 if x >= 121 or y in (0, 61) or x == 0 else 0 if y in (1, 60) or x == 1 or (50 <= x < 54 and 20 <= y < 24) else 254
with open('room.pgm', 'wb') as f:
    f.write(b'P5\n%d %d\n255\n' % (width, height))
    f.write(bytes(cell(x, y) for y in reversed(range(height)) for x in range(width)))
open('room.yaml', 'w').write('image: room.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n')
PY

expect_exit 0 '' "$rubble" plan room.yaml --out a.png
head -c 4 a.png | grep -q PNG || fail "a.png is no PNG"
expect_exit 0 '' "$rubble" plan room.yaml --out b.png
cp out.txt a.txt
cmp -s a.png b.png || fail "the same map gave another picture"

# Axes and a legend stand around the map, which is as large as is said.
python3 - "$(sed -n 's/^picture .*, \(.*\) pixels a metre$/\1/p' out.txt)" <<'PY' || fail "no axes and legend around the map"
import struct, sys
width, height = struct.unpack('>II', open('a.png', 'rb').read(24)[16:])
metre = float(sys.argv[1])
sys.exit(0 if 10 < width - 7.1 * metre < 100 and 40 < height - 3.2 * metre < 200 else 1)
PY

# The larger alpha, the longer the way from beside the wall and the farther from it, summed either way.
way() { "$rubble" plan room.yaml --from 1.0,0.6 --d-min 0.3 --out way.png "$@" | awk '/^way/ {print $2, $7}'; }
for discomfort in per_metre per_cell; do
  read -r short near <<<"$(way --discomfort $discomfort --alpha 0)"
  read -r long far <<<"$(way --discomfort $discomfort --alpha 500)"
  awk "BEGIN {exit !($long > $short && $far >= $near)}" || fail "$discomfort: $short m at $near, then $long m at $far"
done
way >/dev/null
cmp -s a.png way.png && fail "--from draws no way"

# A target takes the place of the frontiers; from where it stands the way is nothing.
expect_exit 0 '' "$rubble" plan room.yaml --from 1.0,0.6 --to 5.0,1.0 --d-min 0.3 --out to.png
grep -q '^frontiers' out.txt && fail "frontiers are told though there is a target"
awk '/^way/ {exit !($2 >= 4.0 && $2 < 5.0)}' out.txt || fail "the way to the target: $(cat out.txt)"
cmp -s way.png to.png && fail "--to changes nothing"
expect_exit 3 '--to: no free floor' "$rubble" plan room.yaml --to 90,1
expect_exit 2 '--to x' "$rubble" plan room.yaml --to x
expect_exit 2 '--to nan,1: needs the form' "$rubble" plan room.yaml --to nan,1
expect_exit 2 "needs a value, and '' is none" "$rubble" plan room.yaml --to ''
expect_exit 2 '--out is given more than once' "$rubble" plan room.yaml --out a.png --out b.png
expect_exit 3 'no free floor' "$rubble" plan room.yaml --from 90,1
expect_exit 3 'nearer to a wall' "$rubble" plan room.yaml --from 1.0,0.15
expect_exit 2 'X,Y' "$rubble" plan room.yaml --from here
expect_exit 2 '--d-opt' "$rubble" plan room.yaml --d-min 0.7
expect_exit 3 'nowhere.yaml' "$rubble" plan nowhere.yaml
expect_exit 4 'missing/plan.png' "$rubble" plan room.yaml --out missing/plan.png

# Start and end are marked, in the colours of the legend, the target too where the way ends on it.
python3 - "$(sed -n 's/^picture .*, \(.*\) pixels a metre$/\1/p' a.txt)" <<'PY' || fail "start and target are not marked"
import struct, sys, zlib
def colours(name):
    data, at, rows = open(name, 'rb').read(), 8, b''
    while at < len(data):
        size, kind = struct.unpack('>I4s', data[at:at + 8])
        if kind == b'IHDR':
            width, height, depth, colour = struct.unpack('>IIBB', data[at + 8:at + 18])
            assert depth == 8 and colour == 2
        if kind == b'IDAT': rows += data[at + 8:at + 8 + size]
        at += size + 12
    raw, step, before, count = zlib.decompress(rows), 3 * width + 1, bytearray(3 * width), {}
    for y in range(height):
        way, line = raw[y * step], bytearray(raw[y * step + 1:(y + 1) * step])
        for i in range(3 * width):
            a, b, c = (line[i - 3] if i > 2 else 0), before[i], (before[i - 3] if i > 2 else 0)
            p = a + b - c
            paeth = min((a, b, c), key=lambda v: abs(p - v))
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[way]) % 256
        for x in range(width):
            pixel = tuple(line[3 * x:3 * x + 3])
            count[pixel] = count.get(pixel, 0) + 1
        before = line
    return count
start, goal = (40, 170, 60), (40, 90, 220)
none, both = colours('a.png'), colours('to.png')
cell = int(float(sys.argv[1]) * 0.05) ** 2
# Besides the patch of the legend there is a disc of several cells of each.
sys.exit(0 if start not in none and min(both[start], both[goal]) > 4 * cell else 1)
PY

# Frontiers that no way leads to: the east end of a passage narrower than twice d_min.
expect_exit 0 '' "$rubble" plan room.yaml --d-min 1.6 --d-opt 1.7
grep -q '^frontiers *1$' out.txt || fail "no frontier in: $(cat out.txt)"
grep -q '^way *none: no frontier can be reached' out.txt || fail "an unreachable frontier: $(cat out.txt)"
grep -q '^way' a.txt && fail "a way that was not asked for: $(cat a.txt)"
sed -i 's/room.pgm/full.pgm/' room.yaml
python3 -c "open('full.pgm', 'wb').write(b'P5\n40 40\n255\n' + bytes([0]) * 1600)"
expect_exit 3 'no frontier' "$rubble" plan room.yaml

# Who names a place that is not there is told where the map is, and in which axes: they differ by the kind of file.
sed -i 's/full.pgm/room.pgm/' room.yaml
expect_exit 3 "the map reaches from 0.00,0.00 to 7.00,3.10 m; x and y of the yaml's frame" "$rubble" plan room.yaml --to 90,1
cp room.pgm scanned.pgm
expect_exit 3 'to 7.00,3.10 m; from the lower left corner, x right, y up' \
  "$rubble" plan scanned.pgm --resolution 0.05 --from 90,1
finish
