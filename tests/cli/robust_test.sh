# Bad input gives one line and its exit code; kill and interrupt lose nothing.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
expect_exit 2 '' "$rubble"
expect_exit 2 '' "$rubble" run --sed 3
expect_exit 2 'key.key=value' "$rubble" run s.yaml --set robot.levelling
expect_exit 3 'nowhere.yaml' "$rubble" run nowhere.yaml
expect_exit 3 '--set robot.leveling' "$rubble" run s.yaml --set robot.leveling=false
expect_exit 3 'particles' "$rubble" run s.yaml --set mapper.particles=-1
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
expect_exit 3 'cut.yaml' "$rubble" arena cut.yaml
expect_exit 2 '--cells' "$rubble" arena generate --cells 10
mkdir full && touch full/something
expect_exit 3 'full' "$rubble" run s.yaml --out full
expect_exit 3 'full' "$rubble" run s.yaml --out full --force
[[ -e full/something ]] || fail "--force removed a folder that is no run"
expect_exit 3 '/proc/nothing' "$rubble" run s.yaml --out /proc/nothing
small_scenario strict.yaml 'expect: {score: {min: 1.5}}'
expect_exit 1 '' "$rubble" run strict.yaml --out strict
grep -q 'expected at least 1.5' out.txt || fail "the broken expectation is not named"
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
wait_for test -s killed/map.tif
wait_for has_lines killed/estimate.tum 200
kill -KILL $pid
wait $pid 2>/dev/null
[[ -s killed/map.tif && -s killed/estimate.tum ]] || fail "after a kill the last map is missing"
"$rubble" map killed/log.rlog --out again >/dev/null || fail "the log of a killed run cannot be read"
json_holds again/score.json "j['scans'] > 100"
finish
