#!/usr/bin/env bash
# tests/fuzz.sh [SECONDS [TARGET...]]: builds the fuzz targets and runs each for so long, its corpus (fuzz/corpus/TARGET, tests/fuzz/TARGET)
# first. One line a target: name, executions, findings, largest memory [MB]. Ends with 1 when there is a finding.
set -uo pipefail
seconds=${1:-20}
shift || true
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$top/build/fuzz
found=$build/findings
[[ -f $build/build.ninja ]] || cmake --preset fuzz -S "$top" >/dev/null || exit 4
cmake --build "$build" --target fuzzers >"$build/build.log" 2>&1 ||
  { grep -E 'error|FAILED' -A 5 "$build/build.log" | tail -n 30 >&2; exit 4; }
mkdir -p "$found"
targets=("$@")
((${#targets[@]})) || for binary in "$build"/fuzz/fuzz_*; do [[ -x $binary ]] && targets+=("${binary##*/fuzz_}"); done
# MRPT and OpenCV are not instrumented: what they hold at the end is no finding.
export ASAN_OPTIONS=detect_leaks=0
findings=0
printf '%-14s %12s %9s %8s\n' target executions findings 'max MB'
for target in "${targets[@]}"; do
  corpus=$top/fuzz/corpus/$target
  [[ -d $corpus ]] || corpus=$top/tests/fuzz/$target
  grown=$build/corpus/$target
  mkdir -p "$grown" "$found/$target"
  [[ -d $corpus ]] || corpus=
  "$build/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=1 -rss_limit_mb=512 -max_len=65536 -print_final_stats=1 \
    -artifact_prefix="$found/$target/" "$grown" $corpus >"$build/$target.log" 2>&1
  code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log")
  memory=$(sed -n 's/^stat::peak_rss_mb: *//p' "$build/$target.log")
  here=$((code != 0))
  findings=$((findings + here))
  printf '%-14s %12s %9s %8s\n' "$target" "${runs:-0}" "$here" "${memory:--}"
  ((here)) && grep -E 'ERROR|SUMMARY|Test unit' "$build/$target.log" | head -4 | sed 's/^/    /'
done
exit $((findings > 0))
