# The program and its modules are built with Debian's hardening flags: they lie at random places, their tables are read-only
# before the first line runs, arrays on the stack have guards, and the C library checks sizes where the compiler knows them.
. "$(dirname "$0")/lib.sh"
build=$(dirname "$rubble")
instrumented && exit 77  # sanitizers check more
optimised=1
grep -q '^CMAKE_BUILD_TYPE:STRING=Debug' "$build/CMakeCache.txt" && optimised=0

# hardened FILE: what linker and compiler left in it.
hardened() {
  local file=$1 name=${1##*/}
  readelf -hldW "$file" >elf.txt 2>elf.err || { fail "$name: $(head -1 elf.err)"; return; }
  grep -qE 'Type: +DYN' elf.txt || fail "$name does not lie at a random place"
  grep -q 'GNU_RELRO' elf.txt || fail "$name: no GNU_RELRO"
  grep -qE 'FLAGS.*(BIND_NOW|NOW)' elf.txt || fail "$name: symbols are bound late, so their table stays writable"
  grep -E 'GNU_STACK' elf.txt | grep -q 'RWE' && fail "$name: the stack may be run"
  nm -D "$file" >symbols.txt
  grep -q '__stack_chk_fail' symbols.txt || fail "$name: no guards on the stack"
}

hardened "$rubble"
((optimised)) && { grep -qE '__(mem|str|sn?printf|vsn?printf|fread|read|realpath)[a-z]*_chk' symbols.txt || fail "_FORTIFY_SOURCE is off"; }
found=0
for module in "$build"/rubble_*.so; do
  [[ -f $module ]] || continue
  hardened "$module"
  found=$((found + 1))
done
((found >= 4)) || fail "only $found modules"
finish
