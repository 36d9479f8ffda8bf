#!/usr/bin/env bash
# The same bits whatever the surroundings: locale, time zone, terminal, home, folder, processors, threads, memory, stack.
. "$(dirname "$0")/lib.sh"
fault_scenario s.yaml 25
here=$PWD
"$rubble" run s.yaml --out reference >/dev/null || fail "the reference ended with $?"

# same NAME COMMAND...: the command, given the run as its last words, gives the hashes of the reference.
same() {
  local name=$1
  shift
  rm -rf "$here/other"
  "$@" "$rubble" run "$here/s.yaml" --out "$here/other" >"$here/out.txt" 2>"$here/err.txt" ||
    fail "$name: ended with $?: $(head -c 300 "$here/err.txt")"
  cmp -s "$here/reference/hashes.json" "$here/other/hashes.json" || fail "$name: other bits"
  struck=$((struck + 1))
}

# Made here: a system has only those that somebody asked for, and an unknown one is the same as C.
mkdir locales
for locale in de_DE tr_TR; do
  localedef -i $locale -f UTF-8 locales/$locale.UTF-8 >locale.txt 2>&1 || fail "no locale $locale: $(head -c 200 locale.txt)"
done
[[ $(LOCPATH=$here/locales LC_ALL=de_DE.UTF-8 locale decimal_point) == , ]] || fail "the German locale has no comma"
for locale in de_DE.UTF-8 tr_TR.UTF-8 C bogus_LOCALE; do
  same "locale $locale" env LOCPATH="$here/locales" LC_ALL=$locale LANG=$locale
done
same "time zone" env TZ=Pacific/Kiritimati
same "dumb terminal" env TERM=dumb
same "no home" env -u HOME
same "empty environment" env -i RUBBLE_HOME="$source"
same "cwd /" env -C /
same "one thread" env OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
same "seven threads" env OMP_NUM_THREADS=7 OPENBLAS_NUM_THREADS=7
same "filled memory" env MALLOC_PERTURB_=165
same "one arena" env MALLOC_ARENA_MAX=1
command -v taskset >/dev/null && same "one processor" taskset -c 0
command -v setarch >/dev/null && setarch -R true 2>/dev/null && same "no address randomisation" setarch -R
same "small stack" bash -c 'ulimit -s 1024; exec "$@"' bash
[[ $(id -u) == 0 ]] && same "umask 777" bash -c 'umask 777; exec "$@"' bash
same "lowest priority" nice -n 19

printf 'name: e\nscenarios: [s.yaml]\nseeds: 1-3\n' >sweep.yaml
for workers in 1 2 3; do
  "$rubble" batch sweep.yaml --out batch$workers --workers $workers >/dev/null || fail "batch with $workers ended with $?"
  sort batch$workers/results.jsonl >results$workers.txt
  cmp -s results1.txt results$workers.txt || fail "$workers workers: other results"
  struck=$((struck + 1))
done
finish_faults
