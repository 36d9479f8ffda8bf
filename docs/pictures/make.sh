#!/usr/bin/env bash
# docs/pictures/make.sh [NAME...]: makes pictures of README.md and docs/ anew, all of these or the named: standard film
# rigid plan arenas league; only where it is named, logs: its logs (docs/benchmark.md) lie in $RUBBLE_DATA/logs. rigid
# and logs scale their pictures with gdal_translate, and rigid prints the scores of its maps and trajectories; league
# takes its pages' pictures with Chromium. RUBBLE: the program, if not ./rubble.
set -euo pipefail
top=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
pictures=$top/docs/pictures
export RUBBLE_HOME=$top
rubble=$(realpath -- "${RUBBLE:-$top/rubble}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# The run of `./rubble run`, in README.md.
standard() {
  "$rubble" run --out standard >/dev/null
  for name in arena map error; do cp "standard/$name.png" "$pictures/yellow_$name.png"; done
}

# Nine moments of a run, in README.md.
film() {
  "$rubble" run yellow --seed 1003 --set arena.generate.kind=orange --set arena.generate.ramps=0.3 \
    --set arena.generate.paper=0.2 --set arena.generate.victims=6 --set time_limit_s=1800 --out orange >/dev/null
  "$rubble" replay orange --out again --film 9 >/dev/null
  cp again/film.png "$pictures/orange_film.png"
}

# Three mappers on one drive with a laser that is not levelled, in README.md; docs/slam.md has their figures.
rigid() {
  "$rubble" run yellow --seed 2 --set arena.generate.columns=12 --set arena.generate.rows=12 --set arena.generate.ramps=0.4 \
    --set arena.generate.paper=0.2 --set robot.levelling=false --out rigid >/dev/null
  local kind
  for kind in paper robust mrpt-rbpf; do
    "$rubble" map rigid/log.rlog --set mapper.kind=$kind --out rigid-$kind >/dev/null
    echo "rigid: $kind"
    "$rubble" score rigid-$kind/map.tif rigid/truth.tif --out judged-$kind
    "$rubble" score rigid-$kind/estimate.tum rigid/truth.tum
    GDAL_PAM_ENABLED=NO gdal_translate -q -of PNG -outsize 420 0 -r average judged-$kind/error.png \
      "$pictures/rigid_12x12_${kind#mrpt-}.png"
  done
}

# Two mappers on logs of real robots, in README.md and docs/slam.md. (intel_rbpf.png is of what mrpt-rbpf kept in the
# end, after hours.)
logs() {
  local log kind
  for log in intel-raw.clf.bz2 exp1.dat; do
    for kind in paper robust; do
      "$rubble" map "$RUBBLE_DATA/logs/$log" --set mapper.kind=$kind --out "log-$kind" >/dev/null
      GDAL_PAM_ENABLED=NO gdal_translate -q -of PNG -outsize 420 0 -r average "log-$kind/map.png" \
        "$pictures/${log%%[-.]*}_$kind.png"
      rm -r "log-$kind"
    done
  done
}

# Fig. 9 of the paper, in docs/explore.md.
plan() {
  "$rubble" run yellow --set mapper.kind=robust --set explorer.victims.search=false \
    --set explorer.return_home=false --set time_limit_s=75 --out plan >/dev/null
  "$rubble" plan plan/map.yaml --alpha 0 --from 0,0 --out "$pictures/plan_alpha_0.png"
  "$rubble" plan plan/map.yaml --alpha 20 --from 0,0 --out "$pictures/plan_alpha_20.png"
  "$rubble" plan plan/map.yaml --alpha 1 --discomfort per_cell --from 0,0 --out "$pictures/plan_per_cell.png"
}

# Arena files and generated arenas, in docs/arenas.md.
arenas() {
  for kind in yellow orange red; do
    "$rubble" arena generate --kind $kind --cells 10x8 --seed 3 --ramps 0.3 --paper 0.2 --victims 6 --loops 0.2 --out drawn >/dev/null
    cp drawn/$kind-10x8-seed3.png "$pictures/${kind}_10x8.png"
  done
  "$rubble" arena "$pictures/elements.yaml" --out drawn >/dev/null
  "$rubble" arena "$top/arenas/shipped/four_corners.yaml" --out drawn >/dev/null
  cp drawn/elements.png drawn/four_corners.png "$pictures"
}

# photo FILE.html WIDTHxHEIGHT OUT.png
photo() {
  rm -f photo.png
  if ! chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --virtual-time-budget=5000 --window-size="${2/x/,}" \
    --screenshot="$work/photo.png" "file://$work/$1" >chromium.txt 2>&1 || [[ ! -s photo.png ]]; then
    cat chromium.txt >&2
    echo "make.sh: chromium took no picture of $1" >&2
    exit 4
  fi
  cp photo.png "$3"
}

# A league and the page for judging by hand, in docs/league.md.
league() {
  mkdir -p maps/empty
  "$rubble" run --seed 7 --out truth >/dev/null
  cp -r truth maps/level
  cp -r truth maps/twin
  "$rubble" run --seed 7 --set mapper.kind=paper --set robot.levelling=false --out maps/no-level >/dev/null
  "$rubble" run --seed 8 --out maps/other >/dev/null
  head -c 1000 truth/map.tif >maps/cut.tif
  printf 'team,points\nlevel,30\n' >judge.csv
  "$rubble" score --league maps truth/truth.tif --judge judge.csv --out league >/dev/null
  photo league/league.html 1400x1250 "$pictures/league.png"
  "$rubble" score maps/no-level/map.tif truth/truth.tif --html page.html >/dev/null
  photo page.html 1400x1100 "$pictures/evaluation_page.png"
}

# needs NAME PROGRAM PACKAGE
needs() {
  command -v "$2" >/dev/null || { echo "make.sh: $1 needs $2; apt-get install $3" >&2; exit 4; }
}

all="standard film rigid plan arenas league"
read -ra names <<<"${*:-$all}"
for name in "${names[@]}"; do  # before anything is made
  case $name in
    rigid) needs rigid gdal_translate gdal-bin ;;
    logs)
      needs logs gdal_translate gdal-bin
      [[ -d ${RUBBLE_DATA:-}/logs ]] || { echo "make.sh: logs needs RUBBLE_DATA, the folder that has logs/" >&2; exit 3; }
      ;;
    league) needs league chromium chromium ;;
    *) [[ " $all " == *" $name "* ]] || { echo "make.sh: $name is none of: $all" >&2; exit 2; } ;;
  esac
done
for name in "${names[@]}"; do "$name"; done
