# Debug and Release builds give the same bits.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
debug=$source/build/debug
cmake -G Ninja -S "$source" -B "$debug" -DCMAKE_BUILD_TYPE=Debug -DRUBBLE_TESTS=OFF -DRUBBLE_BENCH=OFF >/dev/null || fail "configure"
ninja -C "$debug" rubble >build.log 2>&1 || { tail -20 build.log; fail "build"; }
"$rubble" run s.yaml --out release --set time_limit_s=40 >/dev/null || fail "release run ended with $?"
"$debug/rubble" run s.yaml --out debug --set time_limit_s=40 >/dev/null || fail "debug run ended with $?"
diff release/hashes.json debug/hashes.json || fail "Debug and Release differ"
finish
