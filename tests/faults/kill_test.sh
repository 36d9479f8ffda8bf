#!/usr/bin/env bash
# kill -9 at many moments: what was written stays readable, the same command again gives the undisturbed result.
. "$(dirname "$0")/lib.sh"
fault_scenario s.yaml
"$rubble" run s.yaml --out whole >/dev/null || fail "the undisturbed run ended with $?"

# One line, or a log that can be read: nothing in between.
readable_log() {
  [[ -e $1 ]] || return 0
  "$rubble" export "$1" read.rawlog >/dev/null 2>err.txt
  local got=$?
  [[ $got == 0 || ($got == 3 && $(wc -l <err.txt) == 1) ]] || fail "$2: the log ended export with $got: $(head -c 300 err.txt)"
}

for i in $(seq "$moments"); do
  rm -rf killed
  strike "$i" KILL "$rubble" run s.yaml --out killed
  readable_log killed/log.rlog "run, moment $i"
  for picture in killed/map.png killed/truth.png; do
    [[ ! -e $picture ]] || python3 -c "
import sys; d=open('$picture','rb').read(); sys.exit(0 if d[:4]==b'\x89PNG' and b'IEND' in d[-12:] else 1)" ||
      fail "run, moment $i: $picture is torn"
  done
done
rm -rf killed
"$rubble" run s.yaml --out killed >/dev/null || fail "the run after the kills ended with $?"
cmp -s whole/hashes.json killed/hashes.json || fail "the run after the kills has another result"

for i in $(seq "$moments"); do
  rm -rf mapped
  strike "$i" KILL "$rubble" map whole/log.rlog --out mapped
done
rm -rf mapped
"$rubble" map whole/log.rlog --out mapped >/dev/null || fail "map after the kills ended with $?"
"$rubble" map whole/log.rlog --out mapped-whole >/dev/null || fail "the undisturbed map ended with $?"
cmp -s mapped/hashes.json mapped-whole/hashes.json || fail "map after the kills has another result"

# A run that --force replaces is lost only to one that is whole.
find whole -type f -printf '%P\n' | sort >names.txt
for i in $(seq "$moments"); do
  rm -rf older && cp -r whole older
  strike "$i" KILL "$rubble" run s.yaml --seed 9 --out older --force
  place=older
  [[ ! -d older/.replaced.part && ! -d older/.replaced ]] || place="older/.replaced.part older/.replaced older"
  while read -r name; do
    kept=
    for folder in $place; do cmp -s "whole/$name" "$folder/$name" && kept=1; done
    [[ $kept ]] || [[ ! -d older/.replaced && -s older/hashes.json ]] || fail "--force, moment $i: the older $name is lost"
  done <names.txt
done

printf 'name: k\nscenarios: [s.yaml]\nseeds: 1-4\n' >sweep.yaml
"$rubble" batch sweep.yaml --out batch-whole --workers 2 >/dev/null || fail "the undisturbed batch ended with $?"
for i in $(seq "$moments"); do strike "$i" KILL "$rubble" batch sweep.yaml --out batch-killed --workers 2; done
"$rubble" batch sweep.yaml --out batch-killed --workers 2 >/dev/null || fail "the batch after the kills ended with $?"
for batch in batch-whole batch-killed; do
  python3 - $batch/results.jsonl >$batch.txt <<'PY'
import json, sys
runs = [json.loads(line) for line in open(sys.argv[1])]
for run in sorted({(r["run_id"], r["status"], r["hash"]) for r in runs}): print(*run)
PY
done
cmp -s batch-whole.txt batch-killed.txt || fail "the batch after the kills has other results"
finish_faults
