#!/usr/bin/env bash
# Makes every standard sweep and writes docs/results.md. Interrupted, it goes on where it was.
#   scenarios/sweeps/results.sh [more options for each `rubble batch`, for example --workers 4]
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$top"
folders=()
for sweep in levelling paper slip lidar_noise icp cell_size particles lidar_range; do
  # 4: a run failed or was too slow; the tables say so, and the other sweeps go on.
  ./rubble batch "$sweep" --out "runs/results/$sweep" "$@" || [[ $? == 4 ]]
  folders+=("runs/results/$sweep")
done
sections=$(mktemp)
trap 'rm -f "$sections"' EXIT
./rubble batch report --markdown "${folders[@]}" --out "$sections"
{
  printf '# Results of the standard sweeps\n\n'
  printf 'Made by `scenarios/sweeps/results.sh`; what the columns mean is in [batch.md](batch.md).\n\n'
  cat "$sections"
} >docs/results.md
echo "docs/results.md is written" >&2
