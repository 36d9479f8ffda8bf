# Public logs: URG-04LX of a real robot, MRPT's and CARMEN's; and our own log as .rawlog in MRPT's programs.
. "$(dirname "$0")/lib.sh"
simul=/usr/share/mrpt/datasets/graphslam-engine-demos/action_observations_map/simul.rawlog
if [[ -e $simul ]]; then
  "$rubble" map $simul --out simul >/dev/null || fail "simul.rawlog ended with $?"
  json_holds simul/score.json "j['scans'] > 100 and j['area_known_m2'] > 20 and j['ate_aligned_m'] < 4"
fi
if [[ -n ${RUBBLE_DATA:-} ]]; then
  "$rubble" map "$RUBBLE_DATA/logs/exp1.dat" --out exp1 >/dev/null || fail "exp1.dat ended with $?"
  json_holds exp1/score.json "j['scans'] == 756 and j['score'] is None and j['area_known_m2'] > 50"
  if command -v gdalinfo >/dev/null; then
    gdalinfo exp1/map.tif | grep -q 'Pixel Size = (0.025' || fail "gdalinfo sees no metric pixel size"
  fi
  "$rubble" map "$RUBBLE_DATA/logs/intel-corrected.log.gz" --out intel >/dev/null || fail "intel ended with $?"
  json_holds intel/score.json "j['scans'] == 910 and j['ate_aligned_m'] < 5 and j['area_known_m2'] > 300"
else
  echo "RUBBLE_DATA is not set: exp1 and intel are skipped"
fi
small_scenario s.yaml
"$rubble" run s.yaml --out run --set time_limit_s=60 >/dev/null || fail "run ended with $?"
"$rubble" export run/log.rlog run.rawlog >/dev/null || fail "export ended with $?"
if command -v rawlog-edit >/dev/null; then
  rawlog-edit --info -i run.rawlog >info.txt 2>&1 || fail "rawlog-edit cannot read the export: $(tail -3 info.txt)"
  grep -q LASER info.txt || fail "rawlog-edit sees no LASER"
fi
# A map of nothing is no success.
for i in 1 2 3; do echo "FLASER 5 0 0 0 0 0 0 0 0 0 0 0 $i host $i"; done >dark.log
expect_exit 1 '' "$rubble" map dark.log --out dark
grep -q 'dark.log: nothing is mapped: none of its 3 scans can be used' out.txt || fail "an empty map is not told: $(cat out.txt)"
# What is only assumed about a log is told.
for i in 1 2 3; do echo "FLASER 5 1 1 1 1 1 0 0 0 0 0 0 $i host $i"; done >fan.log
"$rubble" map fan.log --out fan >/dev/null 2>err.txt
grep -q 'fan.log: nothing tells the field of view of FLASER lines of 5 beams' err.txt || fail "an assumed fan is not told: $(cat err.txt)"
sed 's/$/\r/' run/log.rlog >text.rlog
expect_exit 3 'a transfer as text' "$rubble" map text.rlog
# Of a log whose first frame is damaged nothing is worth keeping.
{ head -c 40 run/log.rlog; printf 'damage'; tail -c +47 run/log.rlog; } >torn.rlog
expect_exit 3 'byte 13: ' "$rubble" map torn.rlog
grep -q 'head -c' err.txt && fail "advises to keep nothing: $(cat err.txt)"
"$rubble" map run.rawlog --out from-rawlog >/dev/null || fail "our own export cannot be mapped"
# What a log whose clock jumps back loses on the way is told, and of another log nothing.
python3 - <<'PY'
def line(stamp, x):
    beams = " ".join(["2.00"] * 181)
    return f"FLASER 181 {beams} {x:.3f} 0 0 {x:.3f} 0 0 {stamp:.3f} host {stamp:.3f}\n"
stamps = [0.2 * i for i in range(40)]
open("even.log", "w").writelines(line(s, 0.01 * i) for i, s in enumerate(stamps))
stamps[20], stamps[21] = stamps[21], stamps[20]
open("jumps.log", "w").writelines(line(s, 0.01 * i) for i, s in enumerate(stamps))
PY
expect_exit 0 'jumps.log: its clock jitters or runs backwards, so 2 of 40 scans have other stamps in the export; relations and references' \
  "$rubble" export jumps.log jumps.rawlog
"$rubble" export even.log even.rawlog >/dev/null 2>err.txt || fail "export of a CARMEN log ended with $?"
[[ -s err.txt ]] && fail "of a log in order other stamps are told: $(cat err.txt)"
# Packed with bzip2 a log gives the same; one that is cut is told in one line.
python3 -c "import bz2, gzip; open('run.rawlog.bz2', 'wb').write(bz2.compress(gzip.open('run.rawlog').read()))"
"$rubble" map run.rawlog.bz2 --out from-bz2 >/dev/null || fail "a log in bzip2 ended with $?"
for name in estimate.tum scans.csv map.pgm; do
  cmp -s from-rawlog/$name from-bz2/$name || fail "$name of a log in bzip2 differs from that of the plain one"
done
head -c $(($(wc -c <run.rawlog.bz2) / 2)) run.rawlog.bz2 >cut.rawlog.bz2
expect_exit 3 'cut.rawlog.bz2: the bzip2 data stop at byte ' "$rubble" map cut.rawlog.bz2
finish
