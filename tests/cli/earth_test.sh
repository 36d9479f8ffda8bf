# The shipped scenario with a place on Earth: PROJ, by GDAL's tools, finds the start where the scenario put it, and the
# map is the one that the same run draws in a local frame.
. "$(dirname "$0")/lib.sh"
for tool in gdalinfo gdaltransform gdal_translate; do
  command -v $tool >/dev/null || { echo "$tool is not installed (gdal-bin)"; exit 77; }
done
"$rubble" run on_earth --out earth >/dev/null || fail "on_earth ended with $?"
sed -e '/^geo:/d' -e "s|\.\./arenas|$source/arenas|" "$source/scenarios/on_earth.yaml" >local.yaml
"$rubble" run local.yaml --out local >/dev/null || fail "the same run in a local frame ended with $?"
cmp earth/estimate.tum local/estimate.tum || fail "the place on Earth changes the run"
json_holds earth/score.json "j['aligned'] and j['score'] > 0.9 and j['victims_found'] == 1 and j['victims_false'] == 0"
# Without a list of the true victims none that is reported is called false.
mkdir alone && cp local/map.t* local/truth.tif alone
"$rubble" score alone/map.tif alone/truth.tif --html alone/page.html >/dev/null 2>err.txt || fail "score ended with $?"
grep -qF "alone/truth.tif: there is no list of the true victims beside it" err.txt || fail "not said: $(cat err.txt)"
python3 - alone/page.html <<'PY' || fail "the page judges victims without a list"
import re, sys
marks = re.search(r'"what":"victims","pairs":\[(.*?)\],"map":\[(.*?)\],"truth":\[(.*?)\],"unjudged":\[(.+?)\]\}', open(sys.argv[1]).read())
assert marks and not any(marks.groups()[:3]), marks
PY

gdalinfo -json earth/map.tif >info.json
json_holds info.json "'ID[\"EPSG\",32632]' in j['coordinateSystem']['wkt']"
for run in earth local; do gdalinfo -checksum $run/map.tif | grep Checksum >$run.sum; done
[[ $(wc -l <earth.sum) == 3 ]] || fail "the map has no three bands"
cmp earth.sum local.sum || fail "the map shows something else on Earth"

# Where the map frame's (0, 0) and (1, 0) lie, from the local frame (easting = -y, northing = x) over the pixel.
degrees() { echo "$1 $2" | gdaltransform -i local/map.tif | gdaltransform earth/map.tif | gdaltransform -s_srs EPSG:32632 -t_srs EPSG:4326; }
degrees 0 0 >start.txt
degrees 0 1 >ahead.txt
python3 - "$source/scenarios/on_earth.yaml" <<'PY' || fail "the start is not where geo says: $(cat start.txt ahead.txt)"
import math, re, sys
geo = {k: float(v) for k, v in re.findall(r'(\w+_deg): ([-\d.]+)', open(sys.argv[1]).read())}
lon, lat = map(float, open('start.txt').read().split()[:2])
lon1, lat1 = map(float, open('ahead.txt').read().split()[:2])
metre = math.pi / 180 * 6371000
east, north = (lon - geo['longitude_deg']) * metre * math.cos(math.radians(lat)), (lat - geo['latitude_deg']) * metre
heading = math.degrees(math.atan2((lon1 - lon) * math.cos(math.radians(lat)), lat1 - lat))
print(f'{math.hypot(east, north):.4f} m off, heading {heading:.2f} deg')
sys.exit(0 if math.hypot(east, north) < 0.02 and abs(heading - geo['heading_deg']) < 0.5 else 1)
PY
finish
