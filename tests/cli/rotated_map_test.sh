# The score of a map does not depend on how its image lies: turned by 37 deg and shifted by 3 m, within 0.02.
. "$(dirname "$0")/lib.sh"
command -v gdalwarp >/dev/null || { echo "gdalwarp (package gdal-bin) is missing"; exit 77; }
small_scenario s.yaml
"$rubble" run s.yaml --out a --set arena.generate.columns=5 --set arena.generate.rows=5 >/dev/null || fail "run ended with $?"
python3 - <<'PY'
# An affine world file that turns by 37 deg; gdalwarp then resamples the picture onto an upright raster.
import math
a, d, b, e, c, f = [float(x) for x in open('a/map.tfw')]
r = math.radians(37)
co, si = math.cos(r), math.sin(r)
c, f = c + 3.0, f + 3.0
x, y = co * c - si * f, si * c + co * f
open('turned.tfw', 'w').write('\n'.join('%.9f' % v for v in (
    co * a - si * d, si * a + co * d, co * b - si * e, si * b + co * e, x, y)) + '\n')
PY
gdal_translate -q -co PROFILE=BASELINE a/map.tif turned.tif
for method in near bilinear cubic; do
  gdalwarp -q -r $method -tr 0.025 0.025 -dstalpha turned.tif upright-$method.tif 2>/dev/null || fail "gdalwarp"
  gdal_translate -q -b 1 -b 2 -b 3 upright-$method.tif map37-$method.tif
done
# Coarser pixels, wider than the walls are thick: interpolation leaves them pale, but they are there.
for method in bilinear average cubic; do
  gdalwarp -q -r $method -tr 0.0625 0.0625 a/map.tif coarse-alpha.tif 2>/dev/null || fail "gdalwarp"
  gdal_translate -q -b 1 -b 2 -b 3 coarse-alpha.tif coarse-$method.tif
  rm coarse-alpha.tif
done
for m in coarse-bilinear.tif coarse-average.tif coarse-cubic.tif turned.tif map37-near.tif map37-bilinear.tif map37-cubic.tif; do
  "$rubble" score $m a/truth.tif --json >turned.json || fail "score of $m ended with $?"
  python3 - $m <<'PY' || fail "the score of $m differs"
import json, sys
a, b = json.load(open('a/score.json')), json.load(open('turned.json'))
print(sys.argv[1], a['score'], b['score'], b['align_note'])
sys.exit(0 if b['aligned'] and abs(a['score'] - b['score']) <= 0.02 else 1)
PY
done
finish
