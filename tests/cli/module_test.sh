# What takes long to load (most of MRPT, GDAL behind OpenCV's image formats) is loaded by those alone who use it; where a
# module is missing, one line says so.
. "$(dirname "$0")/lib.sh"
[[ -f $(dirname "$rubble")/rubble_mrpt_slam.so ]] || exit 77
ldd "$rubble" | grep -E 'libmrpt-(slam|hwdrivers|obs|maps|img)|libopencv_imgcodecs|libgdal' && fail "the program loads it at every start"

small_scenario s.yaml
mkdir alone
cp "$rubble" alone/rubble
"alone/rubble" run s.yaml --out robust --set time_limit_s=2 >/dev/null || fail "robust needs the module: $?"
for kind in paper mrpt-icp mrpt-rbpf; do
  "$rubble" run s.yaml --out "with-$kind" --set mapper.kind=$kind --set time_limit_s=2 >/dev/null ||
    fail "$kind with the module: $?"
  json_holds "with-$kind/score.json" "j['scans_mapped'] > 0"
done
expect_exit 4 "MRPT's mapping: rubble_mrpt_slam.so cannot be loaded" \
  alone/rubble run s.yaml --out paper --set mapper.kind=paper --set time_limit_s=2
"$rubble" export robust robust.rawlog >/dev/null || fail "export with the module: $?"
expect_exit 4 "MRPT's files: rubble_mrpt_logs.so cannot be loaded" alone/rubble export robust other.rawlog
"$rubble" score robust/map.tif robust/truth.tif >/dev/null || fail "score without an image: $?"
alone/rubble score robust/map.tif robust/truth.tif --out scored >/dev/null || fail "GeoTIFF and PNG need a module: $?"
expect_exit 4 "reading images: rubble_image_codecs.so cannot be loaded" \
  alone/rubble score scored/overlay.png robust/truth.tif --resolution 0.05
mkdir -p prefix/bin prefix/lib/rubble
cp "$rubble" prefix/bin/rubble
cp "$(dirname "$rubble")/rubble_mrpt_slam.so" prefix/lib/rubble/
prefix/bin/rubble run s.yaml --out installed --set mapper.kind=paper --set time_limit_s=2 >/dev/null ||
  fail "the installed module is not found: $?"
echo "no module" >alone/rubble_mrpt_slam.so
expect_exit 4 "file too short" alone/rubble run s.yaml --out broken --set mapper.kind=paper --set time_limit_s=2
finish
