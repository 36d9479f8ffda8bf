#!/usr/bin/env bash
# Makes the standard sweeps and writes docs/results.md. Interrupted, it goes on where it was.
#   scenarios/sweeps/results.sh [--only "slip mappers"] [more options for each `rubble batch`: --seeds 6, --workers 4]
# --only: these sweeps are made, the sections of the others stay as they are. RUBBLE: the program, if not ./rubble.
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$top"
export RUBBLE_HOME=$top
rubble=${RUBBLE:-./rubble}
all="levelling paper slip lidar_noise icp cell_size particles lidar_range mappers"
only=$all
[[ ${1:-} != --only ]] || { only=$2; shift 2; }
# Of other code, results lie in other folders.
code=$("$rubble" --version | sed 's/.*"rubble":"\([^"]*\)","commit":"\([^"]*\)".*/rubble \1, commit \2/')
sections=$(mktemp -d)
trap 'rm -rf "$sections"' EXIT
for sweep in $only; do
  [[ " $all " == *" $sweep "* ]] || { echo "results.sh: $sweep is none of: $all" >&2; exit 2; }
  folder="runs/results/${code//[^A-Za-z0-9.]/_}/$sweep"
  # 4: a run failed or was too slow; the tables say so, and the other sweeps go on.
  "$rubble" batch "$sweep" --allow-commands --out "$folder" "$@" || [[ $? == 4 ]]
  "$rubble" batch report --markdown "$folder" --out "$sections/$sweep"
done
python3 - "$sections" "$code" "$*" $all <<'PY'
import os
import re
import sys

sections, code, options, *order = sys.argv[1:]
page = "docs/results.md"
old = open(page).read() if os.path.exists(page) else ""
kept = {part.split("\n", 1)[0]: part for part in re.split(r"^## ", old, flags=re.M)[1:]}
for name in os.listdir(sections):
    made = open(os.path.join(sections, name)).read().split("\n", 1)[1].strip()
    how = "`scenarios/sweeps/results.sh%s`, %s." % (" " + options if options else "", code)
    kept[name] = "%s\n\n%s\n\n%s\n\n" % (name, how, made)
with open(page, "w") as out:
    out.write("# Results of the standard sweeps\n\n"
              "Each section is made by the command below its heading; what the columns mean is in [batch.md](batch.md). "
              "All sweeps but\n`mappers` are of the paper's mapper (`mapper.kind: paper`), which is not the default one; "
              "how well that does stands in [robust_mapper.md](robust_mapper.md).\nAll are driven with cameras alone, so that no drive depends on what is heard.\n\n")
    out.write("".join("## " + kept[name] for name in order if name in kept).rstrip() + "\n")
PY
echo "docs/results.md is written" >&2
