#!/usr/bin/env bash
# scenarios/sweeps/missions.sh [SEEDS [OPTION...]]: the missions of docs/explore_measured.md (144 with eight seeds), then its
# tables, with the goals and what is met. SEEDS: as for `rubble batch` (default 1001-1008); the options are its own as well
# (--workers 2). RUBBLE: the program, default ./rubble. RUNS: the folder of the runs, default runs/missions-SEEDS.
set -euo pipefail
if [[ ${1:-} == -* ]]; then
  sed -n '2,/^set/{/^set/!s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seeds=${1:-1001-1008}
shift || true
runs=${RUNS:-runs/missions-$seeds}
"${RUBBLE:-./rubble}" batch mission --seeds "$seeds" --out "$runs" "$@"
scenarios/sweeps/mission_table.py "$runs"
