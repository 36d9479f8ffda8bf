#!/usr/bin/env bash
# A disk that fills, a folder that may not be written, one that is deleted under way: one line, the documented code, and
# nothing that was good before is lost.
. "$(dirname "$0")/lib.sh"
fault_scenario s.yaml

told() {
  struck=$((struck + 1))
  [[ $2 == 3 || $2 == 4 ]] || fail "$1: ended with $2: $(head -c 300 err.txt)"
  [[ $(wc -l <err.txt) == 1 ]] || fail "$1: not one line: $(head -c 600 err.txt)"
}

# Files of at most so many blocks of 1 kB stand for a disk of that size.
for blocks in 1 16 64 256; do
  rm -rf full
  (ulimit -f $blocks; trap '' XFSZ; exec "$rubble" run s.yaml --out full) >out.txt 2>err.txt
  code=$?
  [[ $code == 0 ]] || told "run on a disk of $blocks kB" $code
done
"$rubble" run s.yaml --out whole >/dev/null || fail "the run ended with $?"
cp whole/map.tif before.tif
for command in "export whole copy.rawlog" "score whole/map.tif whole/truth.tif --html page.html" "arena generate --out made"; do
  echo older >copy.rawlog
  echo older >page.html
  (ulimit -f 1; trap '' XFSZ; exec "$rubble" $command) >out.txt 2>err.txt
  told "$command" $?
  [[ $(cat copy.rawlog page.html) == $'older\nolder' ]] || fail "$command: an older file is lost"
done
if [[ $(id -u) == 0 ]] && mkdir -p small && mount -t tmpfs -o size=200k tmpfs small 2>/dev/null; then
  clean_up() { umount small 2>/dev/null; }
  "$rubble" run s.yaml --out small/run >out.txt 2>err.txt
  told "run on a full tmpfs" $?
  mount -o remount,ro small
  "$rubble" run s.yaml --out small/again >out.txt 2>err.txt
  told "run on a read-only disk" $?
fi
if [[ $(id -u) == 0 ]] && command -v setpriv >/dev/null; then
  mkdir locked && chmod 700 locked && chmod 755 .
  setpriv --reuid=65534 --regid=65534 --clear-groups "$rubble" run s.yaml --out locked/run >out.txt 2>err.txt
  told "run into somebody else's folder" $?
  mkdir secret && cp s.yaml secret && chmod 700 secret
  setpriv --reuid=65534 --regid=65534 --clear-groups "$rubble" run secret/s.yaml --out /nowhere >out.txt 2>err.txt
  told "a scenario that may not be read" $?
fi
cmp -s whole/map.tif before.tif || fail "a good map was touched"
finish_faults
