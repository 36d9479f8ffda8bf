# Bad input gives one line and its exit code; kill and interrupt lose nothing.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
expect_exit 2 'see rubble --help' "$rubble"
expect_exit 2 "'bogus' is no subcommand" "$rubble" bogus
expect_exit 2 '--sed' "$rubble" run --sed 3
expect_exit 2 '--seed' "$rubble" run s.yaml --seed -1
expect_exit 2 '--tau' "$rubble" score a.tif b.tif --tau nan
expect_exit 2 '--ramps' "$rubble" arena generate --ramps 2
expect_exit 3 'is a folder' "$rubble" score . .
expect_exit 2 'key.key=value' "$rubble" run s.yaml --set robot.levelling
expect_exit 3 'nowhere.yaml' "$rubble" run nowhere.yaml
expect_exit 3 '--set robot.leveling' "$rubble" run s.yaml --set robot.leveling=false
expect_exit 3 'particles' "$rubble" run s.yaml --set mapper.kind=paper --set mapper.particles=-1
expect_exit 3 "'cell_m' is '0.0001'; give a number from 0.02 to 1" "$rubble" run s.yaml --set mapper.matching.cell_m=0.0001
printf 'name: x\nname: y\n' >twice.yaml
expect_exit 3 'twice.yaml:2:1' "$rubble" run twice.yaml
printf 'name: x\narena: {generate: [}\n' >broken.yaml
expect_exit 3 'broken.yaml:2:' "$rubble" run broken.yaml
expect_exit 3 'nothing.log' "$rubble" map nothing.log
head -c 3000 /dev/urandom >noise.log
expect_exit 3 'noise.log' "$rubble" map noise.log
: >empty.log
expect_exit 3 'empty.log' "$rubble" map empty.log
expect_exit 3 'nowhere.tif' "$rubble" score nowhere.tif nowhere.tif
expect_exit 3 'noise.log' "$rubble" score noise.log noise.log
printf 'name: cut\nmaze: |\n' >cut.yaml
expect_exit 3 'cut.yaml' "$rubble" arena cut.yaml
expect_exit 2 '--cells' "$rubble" arena generate --cells 10
expect_exit 2 '--cells' "$rubble" arena generate --cells 1x1
expect_exit 2 '--ramps' "$rubble" arena s.yaml --ramps 0.5
mkdir full && touch full/something
expect_exit 3 'full' "$rubble" run s.yaml --out full
expect_exit 3 'full' "$rubble" run s.yaml --out full --force
[[ -e full/something ]] || fail "--force removed a folder that is no run"
expect_exit 3 '/proc/nothing' "$rubble" run s.yaml --out /proc/nothing
small_scenario strict.yaml 'expect: {score: {min: 1.5}}'
expect_exit 1 '' "$rubble" run strict.yaml --out strict
grep -q 'expected at least 1.5' out.txt || fail "the broken expectation is not named"
head -c 3000 strict/map.tif >cut.tif
expect_exit 3 'cut.tif' "$rubble" score cut.tif strict/truth.tif
cp strict/map.png bare.png
expect_exit 3 'resolution' "$rubble" score bare.png strict/truth.tif
printf 'ROBOTLASER1 0 -1.57 3.14 0.0174 1e30 0.01 0 2 1.0 1e20 0 0 0 0 0 0 0 0 0 0 0 0 1.0 host 1.0\n' >far.log
expect_exit 3 'far.log:1:' "$rubble" map far.log
small_scenario odd.yaml
"$rubble" run odd.yaml --set 'name="#x"' --set 'team="a\"b,c"' --set time_limit_s=20 --out odd >/dev/null || fail "an odd name ended with $?"
"$rubble" replay odd >/dev/null || fail "a run with an odd name cannot be replayed"
grep -q '"a""b,c"' odd/pois.csv || fail "a quote in the team's name is not doubled"
expect_exit 0 '' "$rubble" run s.yaml --out strict --force

# wait_for COMMAND...: until it succeeds, two minutes at most (a loaded machine is slow).
wait_for() {
  for ((i = 0; i < 1200; ++i)); do
    "$@" 2>/dev/null && return
    sleep 0.1
  done
  fail "waited in vain for: $*"
}
has_lines() { [[ $(wc -l <"$1") -gt $2 ]]; }

# A long run is interrupted: 130, and the folder is complete.
cat >long.yaml <<'YAML'
name: long
arena: {generate: {columns: 20, rows: 20, ramps: 0.2, loops: 0.3}}
time_limit_s: 100000
YAML
"$rubble" run long.yaml --out stopped >out.txt 2>err.txt &
pid=$!
wait_for has_lines stopped/estimate.tum 200
kill -INT $pid
wait $pid
[[ $? == 130 ]] || fail "an interrupt must end with 130: $(cat err.txt)"
for name in map.tif score.json hashes.json estimate.tum pois.csv; do
  [[ -s stopped/$name ]] || fail "after an interrupt $name is missing"
done
json_holds stopped/score.json "j['end'] == 'interrupted'"

# A kill leaves a readable log and the last map.
"$rubble" run long.yaml --out killed >/dev/null 2>&1 &
pid=$!
wait_for has_lines killed/estimate.tum 30
kill -KILL $pid
wait $pid 2>/dev/null
for name in map.tif map.pgm pois.csv estimate.tum log.rlog; do
  [[ -s killed/$name ]] || fail "after a kill $name is missing"
done
"$rubble" replay killed >out.txt || fail "a killed run cannot be replayed: $(cat out.txt)"
grep -q 'did not end' out.txt || fail "replay does not tell that the run did not end"
"$rubble" map killed/log.rlog --out again >/dev/null || fail "the log of a killed run cannot be read"
json_holds again/score.json "j['scans'] > 20"
finish
