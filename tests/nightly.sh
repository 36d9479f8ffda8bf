#!/usr/bin/env bash
# The long suite and its table: whole suite, each file compiled alone, sanitizers, faults at 100 moments, each fault of
# each device, three emulated robots at once, a calibration in real time, growth, 10 minutes of fuzzing for each parser.
# Prints the table and puts it into docs/reliability.md between its marks. Rows of parts that were not asked for stay as they are.
#   tests/nightly.sh [--minutes N] [--only "suite alone sanitize threads faults devices three calibration growth fuzz"] [--fuzz-seconds 600]
#                    [--moments 100] [--keep-docs]
# --minutes N: what can be cut is cut, no part is left out: a third of the time for fuzzing, shared by the targets; a moment
# of faults each two minutes (3 to 100); below 120 minutes the small sizes of growth and one fault of each device. The
# suites take what they take.
set -uo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
only="suite alone sanitize threads faults devices three calibration growth fuzz"
fuzz_seconds=600
moments=100
growth=()
faults=()
keep=0
least() { echo $(($1 < $2 ? $1 : $2)); }
most() { echo $(($1 > $2 ? $1 : $2)); }
# for_minutes N: the lengths of a night of so many minutes.
for_minutes() {
  [[ $1 =~ ^[1-9][0-9]{0,4}$ ]] || { echo "--minutes takes a whole number from 1, not '$1'" >&2; exit 2; }
  local targets
  targets=$(find "$top/fuzz" -maxdepth 1 -name '*.cpp' | wc -l)
  fuzz_seconds=$(least 600 $(most 5 $(($1 * 20 / targets))))
  moments=$(least 100 $(most 3 $(($1 / 2))))
  if (($1 < 120)); then
    growth=(--quick)
    faults=(--faults "urg-unplug base-unplug levelling-unplug")
  fi
}
while (($#)); do
  case $1 in
    --minutes) for_minutes "${2:-}"; shift 2 ;;
    --only) only=$2; shift 2 ;;
    --fuzz-seconds) fuzz_seconds=$2; shift 2 ;;
    --moments) moments=$2; shift 2 ;;
    --keep-docs) keep=1; shift ;;
    *) echo "unknown option $1; see the head of $0" >&2; exit 2 ;;
  esac
done
out=$top/build/nightly
mkdir -p "$out"
table=$out/table.md
failed=0
printf '| tests | count | findings | skipped | time | on |\n|---|---|---|---|---|---|\n' | tee "$table"

# row NAME COUNT FINDINGS SKIPPED SECONDS
row() {
  local time="$5 s"
  (($5 < 600)) || time="$(($5 / 60)) min"
  printf '| %s | %s | %s | %s | %s | %s |\n' "$1" "$2" "$3" "$4" "$time" "$(date +%F)" | tee -a "$table"
  [[ $3 == 0 ]] || failed=1
}

# counted NAME LOG COMMAND...: a run of ctest and its last words.
counted() {
  local name=$1 log=$out/$2.txt start=$SECONDS
  shift 2
  "$@" >"$log" 2>&1
  local total bad skipped
  total=$(sed -n 's/.*tests failed out of \([0-9]*\).*/\1/p' "$log" | tail -1)
  bad=$(sed -n 's/.* \([0-9]*\) tests failed out of.*/\1/p' "$log" | tail -1)
  skipped=$(grep -c '\*\*\*Skipped' "$log")
  row "$name" "${total:-0 (did not run)}" "${bad:-1}" "$skipped" $((SECONDS - start))
}

has() { [[ " $only " == *" $1 "* ]]; }

has suite && counted "whole suite (Release)" suite env RUBBLE_LONG=1 "$top/rubble" test
if has alone; then  # the other presets compile the files of a folder as one
  start=$SECONDS
  dev=$top/build/dev
  files=0 left=1
  if cmake --preset dev -S "$top" >"$out/alone.txt" 2>&1; then
    ninja -C "$dev" -k 0 all >>"$out/alone.txt" 2>&1
    files=$(grep -c '"file"' "$dev/compile_commands.json")
    left=$(ninja -C "$dev" -n all | grep -c 'Building CXX')
  fi
  row "files compiled alone (Debug)" "$files" "$left" 0 $((SECONDS - start))
fi
has sanitize && counted "whole suite under ASan and UBSan" sanitize "$top/rubble" test --sanitize
has threads && counted "batch, drivers, emulators and scoring under TSan" threads "$top/rubble" test --sanitize=thread
if has faults; then
  for script in "$top"/tests/faults/*_test.sh; do
    name=$(basename "$script" _test.sh)
    start=$SECONDS
    RUBBLE_MOMENTS=$moments bash "$script" "$top/build/release/rubble" "$top" >"$out/faults-$name.txt" 2>&1
    words=$(grep '^faults: ' "$out/faults-$name.txt" | tail -1)
    count=${words#faults: }
    row "faults: $name, $moments moments" "${count%%,*}" "${words##*findings: }" 0 $((SECONDS - start))
  done
fi
if has devices; then
  start=$SECONDS
  python3 "$top/tests/device_faults.py" --jobs 4 "${faults[@]}" >"$out/device-faults.txt" 2>&1
  words=$(grep '^faults: ' "$out/device-faults.txt" | tail -1)
  found=${words##*findings: }
  count=${words#faults: }
  row "faults of devices, in real time" "${count%%,*}" "${found:-1}" 0 $((SECONDS - start))
fi
if has three; then
  start=$SECONDS
  python3 "$top/tests/device_faults.py" --three --seconds 60 >"$out/three-robots.txt" 2>&1
  words=$(grep '^robots: ' "$out/three-robots.txt" | tail -1)
  found=${words##*findings: }
  row "three emulated robots at once, rate and jitter of their scans" "${words:+3}" "${found:-1}" 0 $((SECONDS - start))
fi
if has calibration; then
  start=$SECONDS
  python3 "$top/tests/device_calibration.py" >"$out/calibration.txt" 2>&1
  words=$(grep '^calibration: ' "$out/calibration.txt" | tail -1)
  count=${words#calibration: }
  found=${words##*findings: }
  row "calibration of an emulated robot" "${count%%,*}" "${found:-1}" 0 $((SECONDS - start))
fi
if has growth; then
  start=$SECONDS
  python3 "$top/tests/growth.py" "${growth[@]}" >"$out/growth.txt" 2>&1
  words=$(grep '^growth: ' "$out/growth.txt" | tail -1)
  count=${words#growth: }
  row "time and memory against size" "${count%% *}" "${words##*findings: }" 0 $((SECONDS - start))
fi
if has fuzz; then
  start=$SECONDS
  "$top/tests/fuzz.sh" "$fuzz_seconds" >"$out/fuzz.txt" 2>&1
  while read -r target runs cpu found memory; do
    [[ $target == target || -z $memory || ! $runs =~ ^[0-9]+$ ]] && continue
    row "fuzz: $target" "$runs" "$found" 0 "$cpu"
  done <"$out/fuzz.txt"
  grep -q '^target' "$out/fuzz.txt" || row "fuzz" "0 (did not build)" 1 0 $((SECONDS - start))
fi
if ((!keep)); then
  python3 - "$top/docs/reliability.md" "$table" <<'PY'
import sys
page, table = sys.argv[1:]
text = open(page).read()
begin, end = "<!-- table: made by tests/nightly.sh -->\n", "<!-- end of table -->\n"
head, rest = text.split(begin)
old, tail = rest.split(end)
new = open(table).read().splitlines(keepends=True)


def part(row):  # the row's first words, up to what may change from night to night
    return row.split("|")[1].split(",")[0].strip()


done = {part(row) for row in new}
kept = [row for row in old.splitlines(keepends=True)[2:] if part(row) not in done]
order = ["whole suite", "files", "batch", "faults", "three", "calibration", "time", "fuzz"]
rank = lambda row: next((i for i, words in enumerate(order) if part(row).startswith(words)), len(order))
rows = sorted(kept + new[2:], key=lambda row: (rank(row), part(row)))
open(page, "w").write(head + begin + "".join(new[:2] + rows) + end + tail)
PY
fi
exit $failed
