# The script that judges the figures of scoring says in one line what is missing.
. "$(dirname "$0")/lib.sh"

figures() { env -u RUBBLE_DATA "$source/tests/scoring_figures.sh" "$@"; }

for figure in alignment strangers rooms; do
  expect_exit 2 "set RUBBLE_DATA to the folder with" figures $figure
  RUBBLE_DATA=$work expect_exit 2 "" env "$source/tests/scoring_figures.sh" $figure
  grep -q "no such folder; docs/scoring.md" err.txt || fail "$figure does not say where the data is described"
done
expect_exit 2 "unknown figure 'beauty': use alignment, strangers, rooms, ranking, speed" figures beauty
RUBBLE_BUILD=$work expect_exit 2 "scoring_ranking_bench is missing: cmake --preset release && ninja" figures ranking

finish
