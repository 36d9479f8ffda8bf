# Shared by the tests of faults: those of tests/cli, a short scenario, and how often a fault strikes.
. "$(dirname "$0")/../cli/lib.sh"
# Moments at which a fault strikes each command: a few in the daily suite, 100 in the nightly one.
moments=${RUBBLE_MOMENTS:-4}
struck=0

# A run of about a second whose folder is written to again and again.
fault_scenario() {
  small_scenario "$1"
  sed -i "s/time_limit_s: 240/time_limit_s: ${2:-40}/" "$1"
}

# strike NUMBER SIGNAL COMMAND...: starts the command, sends it the signal after a time that differs for each number,
# and leaves its exit code in $code.
strike() {
  local number=$1 signal=$2
  shift 2
  "$@" >struck.out 2>struck.err &
  local pid=$!
  sleep "$(awk -v n="$number" -v m="$moments" 'BEGIN { printf "%.3f", 0.02 + 1.2 * n / m }')"
  kill -"$signal" $pid 2>/dev/null
  wait $pid 2>/dev/null
  code=$?
  struck=$((struck + 1))
}

# listens PID: waits until the program has taken over its signals (Ctrl-C among them); before that they are what its starter
# left them, and a busy machine may take a second to get there.
listens() {
  local caught
  for _ in $(seq 2000); do
    caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$1/status" 2>/dev/null)
    [[ -n $caught ]] && ((!(16#$caught & 2))) || return 0
    sleep 0.01
  done
}

# The one line that tests/nightly.sh reads: how often, and how many findings.
finish_faults() {
  echo "faults: $struck, findings: $failures"
  finish
}
