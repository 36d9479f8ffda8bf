#!/bin/bash
# Measures and judges the figures of map scoring. Exit code 1: a figure missed its bound; 2: data or a program is missing.
#
#   tests/scoring_figures.sh [-v] [alignment] [strangers] [rooms] [ranking] [attacks] [speed]      (default: all)
#
# RUBBLE_DATA   folder with `alignment` and `rooms` (docs/scoring_measured.md), needed by the first three; `attacks`
#               also judges the competition arenas of its `arenas_raf`, where there are any
# RUBBLE_BUILD  build folder (default: build/release)
# -v            also prints what the benchmarks print, pair by pair and map by map
#
# Times are CPU times, the least of several repetitions: other work on the machine does not count.
set -u
cd "$(dirname "$0")/.."
build=${RUBBLE_BUILD:-build/release}
export RUBBLE_HOME=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
misses=0
verbose=0

stop() {
  echo "scoring_figures: $*" >&2
  exit 2
}

need_data() {
  [[ -n ${RUBBLE_DATA:-} ]] || stop "set RUBBLE_DATA to the folder with '$1' (docs/scoring_measured.md, \"Public data\")"
  [[ -d $RUBBLE_DATA/$1 ]] || stop "$RUBBLE_DATA/$1: no such folder; docs/scoring_measured.md, \"Public data\", says what belongs in it"
}

need_program() {
  [[ -x $build/$1 ]] || stop "$build/$1 is missing: cmake --preset release && ninja -C build/release ${1##*/}"
}

# bench PROGRAM FILTER [option...]: runs it; `value` then reads its counters and times.
bench() {
  local program=$1 filter=$2
  shift 2
  need_program "bench/$program"
  "$build/bench/$program" --benchmark_filter="$filter" --benchmark_out="$work/result.json" \
    --benchmark_out_format=json "$@" >&3 2>"$work/errors.txt" || stop "$program: $(tail -1 "$work/errors.txt")"
  local error
  error=$(python3 - "$work/result.json" <<'PYTHON'
import json, sys
for run in json.load(open(sys.argv[1]))["benchmarks"]:
    if run.get("error_occurred"):
        print(run["error_message"])
        break
PYTHON
  )
  [[ -z $error ]] || stop "$error"
}

# value BENCHMARK KEY: of the last `bench`; the least of its repetitions.
value() {
  python3 - "$work/result.json" "$1" "$2" <<'PYTHON'
import json, sys
path, name, key = sys.argv[1:]
runs = [run for run in json.load(open(path))["benchmarks"] if run.get("run_type") != "aggregate"]
print(min(run[key] for run in runs if run["run_name"] == name or run["run_name"].startswith((name + "/iterations:", name + "/process_time"))))
PYTHON
}

# judge WHAT VALUE '>='|'<='|'==' BOUND [UNIT]
judge() {
  local verdict
  verdict=$(awk -v a="$2" -v op="$3" -v b="$4" \
    'BEGIN { good = op == ">=" ? a >= b : op == "<=" ? a <= b : a == b; print good ? "ok  " : "MISS" }')
  [[ $verdict == MISS ]] && misses=$((misses + 1))
  printf '%s  %-58s %8.4g %-3s (%s %g)\n' "$verdict" "$1" "$2" "${5:-}" "$3" "$4"
}

tell() { printf '      %-58s %8.4g %-3s\n' "$1" "$2" "${3:-}"; }

percent() { awk -v a="$1" -v b="$2" 'BEGIN { print 100 * a / b }'; }

alignment() {
  need_data alignment
  bench scoring_alignment_bench BM_AlignSensorMaps
  local pairs aligned
  pairs=$(value BM_AlignSensorMaps pairs)
  aligned=$(value BM_AlignSensorMaps aligned)
  tell "alignment: labelled pairs of sensor maps, no guess" "$pairs"
  judge "alignment: right pose" "$(percent "$(value BM_AlignSensorMaps right)" "$pairs")" ">=" 98.8 %
  judge "alignment: right pose, and said to be" "$(percent "$(value BM_AlignSensorMaps right_and_aligned)" "$pairs")" ">=" 97 %
  judge "alignment: wrong ones among the $aligned said to be right" "$(value BM_AlignSensorMaps wrong_but_aligned)" "==" 0
}

strangers() {
  need_data alignment
  bench scoring_alignment_bench BM_AlignStrangers
  tell "strangers: mirrored maps and maps of another building" "$(value BM_AlignStrangers tried)"
  judge "strangers: said to be aligned" "$(value BM_AlignStrangers wrongly_aligned)" "==" 0
  need_data rooms
  bench scoring_strangers_bench BM_Strangers
  judge "strangers: pairs of all classes (-v: a table)" "$(value BM_Strangers strangers)" ">=" 1000
  judge "strangers: of these said to be aligned" "$(value BM_Strangers wrongly_aligned)" "==" 0
  tell "strangers: beside them right pairs" "$(value BM_Strangers right)"
  judge "strangers: of these said to be aligned" "$(percent "$(value BM_Strangers right_aligned)" "$(value BM_Strangers right)")" ">=" 97.3 %
  judge "strangers: of these at a wrong pose" "$(value BM_Strangers right_misplaced)" "==" 0
}

rooms() {
  need_data rooms
  bench scoring_rooms_bench BM_Rooms/visibility:0
  local kind bound name
  for kind in plain furnished; do
    name=BM_Rooms/visibility:0/furnished:$([[ $kind == plain ]] && echo 0 || echo 1)
    bound=$([[ $kind == plain ]] && echo 95 || echo 92)
    judge "rooms, $kind: precision" "$(percent "$(value $name precision)" 1)" ">=" "$bound" %
    judge "rooms, $kind: recall" "$(percent "$(value $name recall)" 1)" ">=" "$bound" %
    judge "rooms, $kind: one-to-one IoU" "$(value $name iou)" ">=" 0.82
    judge "rooms, $kind: slowest of $(value $name maps) maps" "$(value $name slowest_s)" "<=" 1 s
  done
}

ranking() {
  bench scoring_ranking_bench .
  local pairs
  pairs=$(value BM_RankPairs pairs)
  judge "ranking: pairs of maps with more and less damage" "$pairs" ">=" 200
  judge "ranking: pairs in the right order" "$(percent "$(value BM_RankPairs right)" "$pairs")" "==" 100 %
  tell "ranking: maps distorted in five ways" "$(value BM_RankAcrossKinds maps)"
  judge "ranking: Spearman, score and trajectory error" "$(value BM_RankAcrossKinds spearman_score)" ">=" 0.959
  tell "ranking: Spearman, psi and trajectory error" "$(value BM_RankAcrossKinds spearman_psi)"
  judge "ranking: Spearman, features and trajectory error" "$(value BM_RankAcrossKinds spearman_features)" ">=" 0.8
  tell "ranking: the same of E of eq. (7) alone" "$(value BM_RankAcrossKinds spearman_eq7)"
  tell "features: another arena at its best pose, mean" "$(value BM_FeaturesOfStrangers stranger)"
  judge "features: the same, worst" "$(value BM_FeaturesOfStrangers stranger_worst)" "<=" 0.25
  tell "features: the arena itself, damaged, mean" "$(value BM_FeaturesOfStrangers damaged)"
  judge "features: the same, worst" "$(value BM_FeaturesOfStrangers damaged_least)" ">=" 0.35
}

attacks() {
  bench scoring_attacks_bench .
  judge "attacks: seeds" "$(value BM_Attacks seeds)" ">=" 50
  judge "attacks: most that one kind gains in the mean" "$(value BM_Attacks most_gained)" "<=" 0.01
  judge "attacks: an arena out of nothing, mean" "$(value BM_Attacks guess)" "<=" 0.03
  judge "attacks: the truth with walls 10 cm thicker, lowest" "$(value BM_Attacks thicker_10cm)" ">=" 0.95
  judge "attacks: the truth with walls 20 cm thicker, lowest" "$(value BM_Attacks thicker_20cm)" ">=" 0.9
  judge "attacks: half a map, off its share, most" "$(value BM_Shares most_off)" "<=" 0.05
  judge "attacks: another arena at its best pose, mean" "$(value BM_OtherArenas mean)" "<=" 0.1
  judge "attacks: another arena at its best pose, worst" "$(value BM_OtherArenas worst)" "<=" 0.2
  judge "attacks: other arenas said to be aligned" "$(value BM_OtherArenas aligned)" "==" 0
  if [[ ! -d ${RUBBLE_DATA:-}/arenas_raf ]]; then
    echo "      attacks: without RUBBLE_DATA/arenas_raf the competition arenas are left out"
    return
  fi
  bench scoring_schemes_bench BM_CompetitionArenas
  tell "attacks: pairs of competition arenas" "$(value BM_CompetitionArenas pairs)"
  judge "attacks: one on another at its best pose, mean" "$(value BM_CompetitionArenas mean)" "<=" 0.1
  judge "attacks: one on another at its best pose, worst" "$(value BM_CompetitionArenas worst)" "<=" 0.2
  judge "attacks: of these said to be aligned" "$(value BM_CompetitionArenas aligned)" "==" 0
}

# command_s COMMAND...: the least CPU time of five runs of a program [s].
command_s() {
  local TIMEFORMAT='%U %S'
  for _ in 1 2 3 4 5; do
    { time "$@" >/dev/null 2>"$work/errors.txt"; } 2>&1 || stop "$*: $(tail -1 "$work/errors.txt")"
  done | awk '{ t = $1 + $2; if (NR == 1 || t < least) least = t } END { print least }'
}

# beside WHAT BENCHMARK WHAT BENCHMARK: ours and the one with nothing but OpenCV.
beside() {
  tell "speed: $1" "$(value "$2" cpu_time)" ms
  tell "speed: $3" "$(value "$4" cpu_time)" ms
}

speed() {
  need_program rubble
  RUBBLE_MAPS=$work bench scoring_bench . --benchmark_repetitions=5 --benchmark_min_time=0.1
  judge "speed: psi, 800 x 800" "$(value BM_Psi cpu_time)" "<=" 3 ms
  tell "speed: psi, OpenCV only" "$(value BM_PsiOpenCv cpu_time)" ms
  beside "poses from walls" BM_Correlate "poses from walls, OpenCV only" BM_CorrelateOpenCv
  beside "features, SURF (dlib)" BM_Features/0 "features, AKAZE (OpenCV)" BM_Features/1
  tell "speed: features, ORB (OpenCV)" "$(value BM_Features/2 cpu_time)" ms
  judge "speed: score_map, 800 x 800" "$(value BM_ScoreMap cpu_time)" "<=" 400 ms
  judge "speed: score_map from files" "$(value BM_ScoreFiles cpu_time)" "<=" 400 ms
  judge "speed: score_map with warp and features" "$(value BM_ScoreMapWithWarp cpu_time)" "<=" 1000 ms
  judge "speed: rubble score" "$(command_s "$build/rubble" score "$work/map.tif" "$work/truth.tif")" "<=" 0.4 s
  judge "speed: rubble score --warp" "$(command_s "$build/rubble" score "$work/map.tif" "$work/truth.tif" --warp)" "<=" 1.3 s
  judge "speed: start-up (rubble --version)" "$(command_s "$build/rubble" --version)" "<=" 0.3 s
}

figures=()
for argument in "$@"; do
  case $argument in
    -v) verbose=1 ;;
    alignment | strangers | rooms | ranking | attacks | speed) figures+=("$argument") ;;
    *) stop "unknown figure '$argument': use alignment, strangers, rooms, ranking, attacks, speed" ;;
  esac
done
((${#figures[@]})) || figures=(alignment strangers rooms ranking attacks speed)
if ((verbose)); then exec 3>&1; else exec 3>/dev/null; fi
command -v python3 >/dev/null || stop "python3 is missing: apt-get install python3"
for figure in "${figures[@]}"; do "$figure"; done
((misses == 0)) || echo "$misses of the figures missed their bounds"
exit $((misses > 0))
