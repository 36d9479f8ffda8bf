#!/bin/bash
# Whole drives of an emulated robot in real time that meet a fault: named, picked up again, and the map is none the worse. A short form
# of tests/device_faults.py, which also judges how the robot stops.
source "$(dirname "$0")/lib.sh"

small_scenario small.yaml

# Each a drive of its own; without a finding.
python3 "$source/tests/device_faults.py" --rubble "$rubble" --jobs 3 --faults "base-unplug base-stuck base-battery" >table.txt 2>&1 ||
  fail "faults under way: $(cat table.txt)"
grep '^| `' table.txt
python3 "$source/tests/device_faults.py" --rubble "$rubble" --jobs 2 --faults "urg-upside-down urg-upside-down-said" >table.txt 2>&1 ||
  fail "a scanner that hangs upside down: $(cat table.txt)"
grep '^| `' table.txt

# Mounts that make no sense.
expect_exit 2 "the scanner is not played; give --urg too" "$rubble" emulate small.yaml --base tcp:127.0.0.1:0 --urg-upside-down
expect_exit 2 "--urg-yaw" "$rubble" emulate small.yaml --urg tcp:127.0.0.1:0 --urg-yaw 400
finish
