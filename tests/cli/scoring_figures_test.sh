# The script that judges the figures of scoring says in one line what is missing.
. "$(dirname "$0")/lib.sh"

figures() { env -u RUBBLE_DATA "$source/tests/scoring_figures.sh" "$@"; }

for figure in alignment strangers rooms; do
  expect_exit 2 "set RUBBLE_DATA to the folder with" figures $figure
  RUBBLE_DATA=$work expect_exit 2 "" env "$source/tests/scoring_figures.sh" $figure
  grep -q "no such folder; docs/scoring_measured.md" err.txt || fail "$figure does not say where the data is described"
done
expect_exit 2 "unknown figure 'beauty': use alignment, strangers, rooms, ranking, attacks, speed" figures beauty
RUBBLE_BUILD=$work expect_exit 2 "scoring_ranking_bench is missing: cmake --preset release && ninja" figures ranking

# -v adds what a benchmark prints and loses nothing that was written before, also in a file.
mkdir -p build/bench
cat >build/bench/scoring_ranking_bench <<'BENCH'
#!/bin/bash
for argument in "$@"; do [[ $argument == --benchmark_out=* ]] && out=${argument#*=}; done
echo '{"benchmarks": [{"run_name": "BM_RankPairs", "pairs": 200, "right": 200},
  {"run_name": "BM_RankAcrossKinds", "maps": 1, "spearman_score": 1, "spearman_psi": 1,
   "spearman_features": 1, "spearman_eq7": 1},
  {"run_name": "BM_FeaturesOfStrangers", "stranger": 0, "damaged": 1, "stranger_worst": 0, "damaged_least": 1}]}' >"$out"
echo "table of the benchmark"
BENCH
chmod +x build/bench/scoring_ranking_bench
RUBBLE_BUILD=$work/build figures -v ranking ranking >log.txt || fail "ranking ended with $?"
[[ $(grep -c '^table of the benchmark' log.txt) == 2 && $(grep -c '^ok .*in the right order' log.txt) == 2 ]] ||
  fail "-v loses its own lines: $(cat log.txt)"
RUBBLE_BUILD=$work/build figures ranking >log.txt || fail "ranking ended with $?"
! grep -q '^table' log.txt || fail "the tables are printed without -v"

# Right maps that are refused are judged too: nine of 342 may be, ten may not.
mkdir -p data/alignment data/rooms
for bench in scoring_alignment_bench scoring_strangers_bench; do
  cat >build/bench/$bench <<'BENCH'
#!/bin/bash
for argument in "$@"; do [[ $argument == --benchmark_out=* ]] && out=${argument#*=}; done
echo '{"benchmarks": [{"run_name": "BM_AlignStrangers", "tried": 100, "wrongly_aligned": 0},
  {"run_name": "BM_Strangers", "strangers": 1000, "wrongly_aligned": 0, "right": 342, "right_aligned": '"$ALIGNED"',
   "right_misplaced": 0}]}' >"$out"
BENCH
  chmod +x build/bench/$bench
done
strangers() { ALIGNED=$1 RUBBLE_DATA=$work/data RUBBLE_BUILD=$work/build "$source/tests/scoring_figures.sh" strangers; }
strangers 333 >log.txt || fail "nine lost ended with $?: $(cat log.txt)"
strangers 332 >log.txt && fail "ten lost are not told"
grep -q '^MISS .*of these said to be aligned .*97' log.txt || fail "ten lost are not told: $(cat log.txt)"

finish
