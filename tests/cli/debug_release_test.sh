# Debug and Release builds give the same bits, by the paper's mapper and by the robust one; a replay gives them again.
. "$(dirname "$0")/lib.sh"
small_scenario s.yaml
debug=$source/build/debug
# What tells the builds apart is optimisation and assertions; symbols would only cost time.
cmake -G Ninja -S "$source" -B "$debug" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG= -DCMAKE_UNITY_BUILD=ON -DRUBBLE_PCH=ON \
  -DRUBBLE_TESTS=OFF -DRUBBLE_BENCH=OFF >/dev/null || fail "configure"
# Of it the run alone is built: command line, drivers and emulators decide no bit of one.
ninja -C "$debug" rubble_bits >build.log 2>&1 || { tail -20 build.log; fail "build"; }
for kind in paper robust; do
  set_kind=(--set mapper.kind=$kind --set time_limit_s=40)
  "$rubble" run s.yaml --out release-$kind "${set_kind[@]}" >/dev/null || fail "$kind: release run ended with $?"
  "$debug/rubble_bits" s.yaml debug-$kind mapper.kind=$kind time_limit_s=40 >/dev/null || fail "$kind: debug run ended with $?"
  diff release-$kind/hashes.json debug-$kind/hashes.json || fail "$kind: Debug and Release differ"
  "$rubble" replay debug-$kind >/dev/null || fail "$kind: the replay of a Debug run differs in Release"
done
cmp -s release-paper/estimate.tum release-robust/estimate.tum && fail "both mappers say the same: the kind was not taken"
finish
