#!/usr/bin/env bash
# tests/fuzz.sh [SECONDS [TARGET...]]: builds the fuzz targets (these only) and runs each for so many seconds of processor
# time (what the machine does beside it does not count), its corpus (fuzz/corpus/TARGET, tests/fuzz/TARGET) first. One line a
# target: name, executions, processor seconds, findings, largest memory [MB]. Ends with 1 when there is a finding.
# As many at a time as there are processors; RUBBLE_FUZZ_JOBS says another number. RUBBLE_FUZZ_SEED makes the inputs the
# same ones each time, as far as the time goes.
set -uo pipefail
seconds=${1:-20}
shift || true
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$top/build/fuzz
found=$build/findings
[[ -f $build/build.ninja ]] || cmake --preset fuzz -S "$top" >/dev/null || exit 4
targets=("$@")
wanted=("${targets[@]/#/fuzz_}")
cmake --build "$build" --target "${wanted[@]:-fuzzers}" >"$build/build.log" 2>&1 ||
  { grep -E 'error|FAILED' -A 5 "$build/build.log" | tail -n 30 >&2; exit 4; }
mkdir -p "$found"
((${#targets[@]})) || for binary in "$build"/fuzz/fuzz_*; do [[ -x $binary ]] && targets+=("${binary##*/fuzz_}"); done
# MRPT and OpenCV are not instrumented: what they hold at the end is no finding. What was freed is held back for 32 MB only:
# the sanitizer's own 256 MB grow through minutes and reach libFuzzer's limit of memory with a parser that leaks nothing.
export ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=32
jobs=${RUBBLE_FUZZ_JOBS:-$(nproc)}
seed=${RUBBLE_FUZZ_SEED:+-seed=$RUBBLE_FUZZ_SEED}

# cpu_of PID: processor time of a process and of its children that ended [hundredths of a second].
ticks=$(getconf CLK_TCK)
cpu_of() {
  local fields
  read -r -a fields 2>/dev/null <"/proc/$1/stat" || return 1
  echo $(((fields[13] + fields[14] + fields[15] + fields[16]) * 100 / ticks))
}

# fuzz TARGET HUNDREDTHS FOLDER...: one run of so much processor time, which is left in $used; what it says goes to the
# target's log. Whether it had to be killed is left in $killed.
used=0 killed=0
fuzz() {
  local target=$1 left=$2 code=0 now asked=0
  shift 2
  killed=0
  "$build/fuzz/fuzz_$target" $seed -timeout=1 -rss_limit_mb=512 -max_len=65536 -print_final_stats=1 -handle_usr1=1 \
    -max_total_time=$((left + 60)) -artifact_prefix="$found/$target/" "$@" >"$build/$target.log" 2>&1 &
  # A hundred times as long; whom nobody watches any more ends then by himself.
  local pid=$! patience=$((SECONDS + left + 120))
  used=0
  while now=$(cpu_of $pid); do
    # Once it is asked to end it is given a minute in which it gets no processor time, or a minute of that.
    ((asked && now > used && now < left + 6000)) && patience=$((SECONDS + 60))
    used=$now
    if ((used >= left && !asked)); then
      kill -USR1 $pid 2>/dev/null  # ends after this input and says its figures
      asked=1
      patience=$((SECONDS + 60))
    fi
    # Its own alarm may strike within malloc and then waits for itself for ever.
    ((SECONDS < patience)) || { kill -9 $pid 2>/dev/null && killed=1; }
    sleep 0.2
    [[ $(ps -o stat= -p $pid) == Z* ]] && break
  done
  wait $pid 2>/dev/null || code=$?
  return $code
}

# machine_was_slow TARGET: the run ended by an input that took more than a second by the clock, and again the same input
# takes less than one of the processor's time: the machine stalled. That input is forgotten.
machine_was_slow() {
  local input cpu
  input=$(sed -n 's/.*Test unit written to \(.*\/timeout-.*\)/\1/p' "$build/$1.log" | tail -1)
  [[ -f $input ]] || return 1
  local TIMEFORMAT='%U %S'
  cpu=$({ time "$build/fuzz/fuzz_$1" -timeout=60 "$input" >"$build/$1.again" 2>&1; } 2>&1) || return 1
  awk '{exit !($1 + $2 < 1)}' <<<"$cpu" && rm "$input"
}

# fell_silent TARGET: the run was killed for it waited without a word of an error: its alarm had struck within malloc. Once
# or twice that is the machine, which stalled for the second after which it strikes; what does so each time is a finding.
fell_silent() {
  ((killed && ++silences < 3)) && ! grep -qE 'ERROR|SUMMARY' "$build/$1.log"
}

# run TARGET: its line; fails when there is a finding.
run() {
  local target=$1 corpus=$top/fuzz/corpus/$1 grown=$build/corpus/$1 left=$((seconds * 100)) spent=0 runs=0 memory=0 here=0
  local silences=0 code more peak
  [[ -d $corpus ]] || corpus=$top/tests/fuzz/$target
  mkdir -p "$grown" "$found/$target"
  [[ -d $corpus ]] || corpus=
  while ((!here && left > spent)); do
    fuzz "$target" $((left - spent)) "$grown" $corpus
    code=$?
    spent=$((spent + used))
    more=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log")
    peak=$(sed -n 's/^stat::peak_rss_mb: *//p' "$build/$target.log")
    runs=$((runs + ${more:-0}))
    memory=$((${peak:-0} > memory ? ${peak:-0} : memory))
    ((code != 0)) || break
    machine_was_slow "$target" || fell_silent "$target" || here=1
  done
  local line
  line=$(printf '%-16s %12s %9s %9s %8s' "$target" "$runs" $((spent / 100)) "$here" "$memory")
  # Without an error its last words tell what ended it.
  ((here)) && line+=$'\n'$({ grep -E 'ERROR|SUMMARY|Test unit' "$build/$target.log" || { echo "ended with $code"; tail -n 3 "$build/$target.log"; }; } |
    head -4 | cut -c1-200 | sed 's/^/    /')
  printf '%s\n' "$line"
  return $here
}

printf '%-16s %12s %9s %9s %8s\n' target executions 'CPU s' findings 'max MB'
failed=0 under_way=0
trap 'exit $((failed ? 1 : 124))' TERM  # cut short: what was found counts
for target in "${targets[@]}"; do
  ((under_way < jobs)) || { wait -n || failed=1; under_way=$((under_way - 1)); }
  run "$target" &
  under_way=$((under_way + 1))
done
for ((; under_way > 0; --under_way)); do wait -n || failed=1; done
exit $failed
