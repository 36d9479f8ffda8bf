# Shared by the tests that run the program: $rubble is the binary, $source the checkout, $work an empty folder.
set -u
rubble=$1
source=$2
export RUBBLE_HOME=$source
work=$(mktemp -d)
# What a test leaves running or mounted; a test that does so says how it ends in a clean_up of its own.
clean_up() { :; }
# A child in the background that is killed before it has become its command is still this shell, with this trap: the
# folder is the test's, not the child's to remove.
leave() {
  [[ $BASHPID == "$$" ]] || return
  clean_up
  rm -rf "$work"
}
trap leave EXIT
cd "$work"
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect_exit CODE "text that the one line on stderr must hold" COMMAND...
expect_exit() {
  local code=$1 text=$2
  shift 2
  "$@" >out.txt 2>err.txt
  local got=$?
  [[ $got == "$code" ]] || fail "'$*' ended with $got, not $code: $(head -c 300 err.txt)"
  if [[ -n $text ]]; then
    grep -qF -- "$text" err.txt || fail "'$*' does not say '$text' but: $(head -c 300 err.txt)"
    [[ $(wc -l <err.txt) == 1 ]] || fail "'$*' needs more than one line: $(head -c 600 err.txt)"
  fi
}

# instrumented: whether the program was built with a sanitizer, whose tables are larger than any limit of memory.
instrumented() { grep -qaE '__(asan|tsan)_init' "$rubble"; }

# small_scenario FILE [extra yaml]: a 3 x 3 arena that takes a second.
small_scenario() {
  cat >"$1" <<YAML
name: small
arena: {generate: {columns: 3, rows: 3, ramps: 0.2, paper: 0.2, loops: 0.3, victims: 1}}
seed: 3
time_limit_s: 240
${2:-}
YAML
}

# json FILE PYTHON-EXPRESSION over j: true or the test fails.
json_holds() {
  python3 -c "import json,sys; j=json.load(open('$1')); sys.exit(0 if ($2) else 1)" || fail "$1: not true: $2"
}

# start_emulator SCENARIO [options]: the devices of a robot in the background, as $emulator; waits until their ports are open.
# They are in $urg, $base and $levelling, and as words for a drive in $ports; they are pseudo-terminals where $kind is pty.
emulator=
start_emulator() {
  local offered=(--urg tcp:127.0.0.1:0 --base tcp:127.0.0.1:0 --levelling tcp:127.0.0.1:0) device
  [[ ${kind:-tcp} == tcp ]] || offered=(--urg "pty:$work/p_urg" --base "pty:$work/p_base" --levelling "pty:$work/p_levelling")
  rm -f emulator.txt  # the one before was ready too
  "$rubble" emulate "$@" "${offered[@]}" >emulator.txt 2>emulator_err.txt &
  emulator=$!
  for _ in $(seq 200); do
    grep -qs '^ready$' emulator.txt && break
    sleep 0.1
  done
  grep -q '^ready$' emulator.txt || fail "the emulator is not ready: $(cat emulator.txt emulator_err.txt)"
  for device in urg base levelling; do declare -g $device="$(sed -n "s/^$device //p" emulator.txt)"; done
  ports="--urg $urg --base $base --levelling $levelling"
}

# Ends the emulator that a test runs in the background as $emulator.
stop_emulator() {
  kill -INT $emulator
  wait $emulator
  emulator=
}

finish() {
  ((failures == 0)) && echo "all checks passed"
  exit $((failures > 0))
}

# operator_tries WHAT: a part of operator.py, on a drive in a flat room.
operator_tries() {
  cat >flat.yaml <<YAML
name: flat
arena: {file: $source/arenas/shipped/flat_room.yaml}
seed: 2
YAML
  python3 "$source/tests/cli/operator.py" "$rubble" "$source/robots/pioneer_urg.yaml" flat.yaml "$1" || fail "see above"
}
