#!/usr/bin/env bash
# `rubble devices`: what it says of ports where nothing is, and its exit codes.
source "$(dirname "$0")/lib.sh" "$@"

expect_exit 3 "port 'ttyUSB0': is no port; give /dev/ttyUSB0" "$rubble" devices ttyUSB0
expect_exit 3 "'70000x' is no port number" "$rubble" devices /dev/null tcp:localhost:70000x
expect_exit 3 "nobody can be reached at port number 0" "$rubble" devices tcp:localhost:0
expect_exit 3 "is no serial line" "$rubble" devices /dev/null
expect_exit 4 "" "$rubble" devices "$work/no-such-line"
grep -q "there is no such device; plug it in" out.txt || fail "a missing line is not named: $(cat out.txt)"

# A port where somebody accepts and says nothing.
python3 - <<'PY' >port.txt &
import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
s.listen()
print(s.getsockname()[1], flush=True)
s.settimeout(20)
kept = []
try:
    while True:
        kept.append(s.accept()[0])
except OSError:
    pass
PY
server=$!
for _ in $(seq 100); do [[ -s port.txt ]] && break; sleep 0.05; done
expect_exit 4 "" "$rubble" devices "tcp:127.0.0.1:$(cat port.txt)"
grep -q "no device that rubble knows answers" out.txt || fail "a silent port is not named: $(cat out.txt)"
kill $server 2>/dev/null

# MRPT's hardware drivers and what they pull are loaded by nobody but a scanner that asks for them.
ldd "$rubble" | grep -q hwdrivers && fail "the program itself loads mrpt-hwdrivers"

finish
