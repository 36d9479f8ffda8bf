# An installed rubble: the program finds what it ships, and a project outside the tree builds with its libraries.
. "$(dirname "$0")/lib.sh"
unset RUBBLE_HOME
build=$(dirname "$rubble")
[[ -f $build/CMakeCache.txt ]] || exit 77
for room in base robot slam explore arenas sim scoring scenarios; do
  [[ -f $build/librubble_$room.a ]] || exit 77
done
[[ -f $build/rubble_mrpt_devices.so ]] || exit 77
grep -q '^CMAKE_CXX_FLAGS:.*-fsanitize' "$build/CMakeCache.txt" && exit 77
cmake --install "$build" --prefix "$work/prefix" >install.txt || fail "install: $(tail -n 3 install.txt)"
grep -rl "$source" prefix/lib/cmake && fail "the installed package points into the source tree"

"$work/prefix/bin/rubble" run --out run --set time_limit_s=2 >/dev/null || fail "the installed program ended with $?"
[[ -s run/score.json ]] || fail "it left no score"
grep -q '^name: "yellow"' run/scenario.yaml || fail "it did not find the scenario that it ships"

# What it loads on demand comes from the installed tree: MRPT's ICP, MRPT's files, image formats.
"$work/prefix/bin/rubble" run --out paper --set mapper.kind=paper --set time_limit_s=2 >/dev/null 2>err.txt ||
  fail "the installed program does not find MRPT's mapping: $(tail -n 1 err.txt)"
json_holds paper/score.json "j['scans_mapped'] > 0"
"$work/prefix/bin/rubble" export run run.rawlog >/dev/null 2>err.txt && [[ -s run.rawlog ]] ||
  fail "the installed program does not find MRPT's files: $(tail -n 1 err.txt)"
"$work/prefix/bin/rubble" score run/overlay.png run/truth.tif --resolution 0.05 >/dev/null 2>err.txt ||
  fail "the installed program does not find its image formats: $(tail -n 1 err.txt)"

"$work/prefix/bin/rubble" drive --urg pty:no1 --base pty:no2 --levelling pty:no3 --set safety.start_s=1 --out driven \
  >/dev/null 2>err.txt
[[ $? == 4 ]] || fail "the installed program does not take the robot that it ships: $(tail -n 1 err.txt)"

# Nothing that an installed header includes of ours was left at home.
(cd prefix/include/rubble && grep -rhoE '^#include "[a-z_/0-9]+\.h"' . | sort -u | sed 's/.*"\(.*\)"/\1/') >included.txt
[[ $(wc -l <included.txt) -gt 20 ]] || fail "the installed headers include only $(wc -l <included.txt) files"
while read -r header; do
  [[ -f prefix/include/rubble/$header ]] || fail "an installed header includes $header, which is not installed"
done <included.txt

cp -r "$source/examples/library" project
cmake -S project -B project/build -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" >configure.txt 2>&1 ||
  fail "configure: $(tail -n 5 configure.txt)"
cmake --build project/build >build.txt 2>&1 || fail "build: $(grep -m 3 error build.txt)"
./project/build/my_robot >said.txt || fail "the project's program ended with $?"
awk '{ known = $(NF - 2) } END { exit !(known > 25 && known < 40) }' said.txt || fail "it mapped: $(cat said.txt)"
finish
