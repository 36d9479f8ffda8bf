# What takes long to load (most of MRPT, GDAL behind OpenCV's image formats) is loaded by those alone who use it; where a
# module is missing, one line says so.
. "$(dirname "$0")/lib.sh"
[[ -f $(dirname "$rubble")/rubble_mrpt_slam.so ]] || exit 77
ldd "$rubble" | grep -E 'libmrpt-(slam|hwdrivers|obs|maps|img)|libopencv_imgcodecs|libgdal' && fail "the program loads it at every start"

small_scenario s.yaml
mkdir alone
cp "$rubble" alone/rubble
"alone/rubble" run s.yaml --out robust --set time_limit_s=2 --set explorer.return_home=false >/dev/null || fail "robust needs the module: $?"
for kind in paper mrpt-icp mrpt-rbpf; do
  "$rubble" run s.yaml --out "with-$kind" --set mapper.kind=$kind --set time_limit_s=2 --set explorer.return_home=false >/dev/null ||
    fail "$kind with the module: $?"
  json_holds "with-$kind/score.json" "j['scans_mapped'] > 0"
done
remedy='install libmrpt-slam-dev and build again, or use `mapper.kind: robust`'
missing="MRPT's mapping: rubble_mrpt_slam.so cannot be loaded (cannot open shared object file: No such file or directory); $remedy"
expect_exit 4 "$missing" alone/rubble run s.yaml --out paper --set mapper.kind=paper --set time_limit_s=2 --set explorer.return_home=false
# Those that run as a process of their own: what that one said, all of it.
alone/rubble run s.yaml --out icp --set mapper.kind=mrpt-icp --set time_limit_s=2 --set explorer.return_home=false >/dev/null 2>err.txt
grep -qF "$missing" err.txt || fail "mrpt-icp does not say what is missing: $(cat err.txt)"
"$rubble" export robust robust.rawlog >/dev/null || fail "export with the module: $?"
expect_exit 4 "MRPT's files: rubble_mrpt_logs.so cannot be loaded" alone/rubble export robust other.rawlog
"$rubble" score robust/map.tif robust/truth.tif >/dev/null || fail "score without an image: $?"
alone/rubble score robust/map.tif robust/truth.tif --out scored >/dev/null || fail "GeoTIFF and PNG need a module: $?"
expect_exit 4 "reading images: rubble_image_codecs.so cannot be loaded" \
  alone/rubble score scored/overlay.png robust/truth.tif --resolution 0.05
mkdir -p prefix/bin prefix/lib/rubble
cp "$rubble" prefix/bin/rubble
cp "$(dirname "$rubble")/rubble_mrpt_slam.so" prefix/lib/rubble/
prefix/bin/rubble run s.yaml --out installed --set mapper.kind=paper --set time_limit_s=2 --set explorer.return_home=false >/dev/null ||
  fail "the installed module is not found: $?"
echo "no module" >alone/rubble_mrpt_slam.so
expect_exit 4 "alone/rubble_mrpt_slam.so cannot be loaded (file too short); $remedy" \
  alone/rubble run s.yaml --out broken --set mapper.kind=paper --set time_limit_s=2 --set explorer.return_home=false

# A module that an older or newer version left is named and not used; the right one further on is.
python3 - "$(dirname "$rubble")/rubble_mrpt_slam.so" "$rubble" alone/rubble_mrpt_slam.so <<'PY' || fail "program and module have no version in common"
import re, sys
module, program = (open(name, "rb").read() for name in sys.argv[1:3])
words = re.findall(rb"(?<![0-9a-f])[0-9a-f]{16}(?=\0)", module)  # not the end of libstdc++'s table of digits
versions = [word for word in words if word + b"\0" in program]
print(versions)
open(sys.argv[3], "wb").write(module.replace(versions[0], b"0123456789abcdef"))
PY
expect_exit 4 "alone/rubble_mrpt_slam.so cannot be loaded (it belongs to another version of rubble); $remedy" \
  alone/rubble run s.yaml --out stale --set mapper.kind=paper --set time_limit_s=2 --set explorer.return_home=false
mkdir -p alone/bin
mv alone/rubble alone/bin/rubble
cp alone/rubble_mrpt_slam.so alone/bin/
cp "$(dirname "$rubble")/rubble_mrpt_slam.so" alone/
alone/bin/rubble run s.yaml --out further --set mapper.kind=paper --set time_limit_s=2 --set explorer.return_home=false >/dev/null ||
  fail "the right module behind one of another version is not used: $?"
finish
