#!/bin/bash
# The operator's means to stop the robot, tried at a terminal: keys and heartbeat. Signals and a robot that was stopped by
# hand are tests of their own, since each waits in real time.
source "$(dirname "$0")/lib.sh"
operator_tries keys

# The black box: the drivers say the same again, on bytes of drives with a change of speed, a stop, and a pause.
for run in teleop heartbeat; do
  "$rubble" replay --raw $run >raw.txt || fail "the raw bytes of $run do not give the same: $(cat raw.txt)"
  grep -q "the drivers say the same again" raw.txt || fail "replay --raw says: $(cat raw.txt)"
done
# Bytes that were changed give something else, and a folder without them is named.
python3 - <<'PY'
import re
data = bytearray(open("teleop/devices.bytes", "rb").read())
reports = [m.start() for m in re.finditer(rb"\xfa\xfb[\x20-\x40][\x32\x33]", data, re.DOTALL)]
data[reports[len(reports) // 2] + 4] ^= 0x04  # where the base is
open("teleop/devices.bytes", "wb").write(data)
PY
"$rubble" replay --raw teleop >raw.txt
[[ $? == 1 ]] || fail "a changed byte passes unseen: $(cat raw.txt)"
grep -q "^NOT the same" raw.txt || fail "replay --raw says: $(cat raw.txt)"
rm teleop/devices.bytes
expect_exit 3 "devices.bytes" "$rubble" replay --raw teleop
finish
