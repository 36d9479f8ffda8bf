#!/bin/bash
# Whole drives of an emulated robot in real time that meet a fault: named, picked up again, and the map is none the worse. A short form
# of tests/device_faults.py, which also judges how the robot stops.
source "$(dirname "$0")/lib.sh"

small_scenario small.yaml

# Each a drive of its own, side by side with what follows; without a finding.
python3 "$source/tests/device_faults.py" --rubble "$rubble" --jobs 4 \
  --faults "base-unplug base-battery urg-upside-down urg-upside-down-said" >table.txt 2>&1 &
faults=$!

# Wheels that stand whatever they are told: named, tried on, and told when they turn again.
"$rubble" emulate small.yaml --urg tcp:127.0.0.1:0 --base tcp:127.0.0.1:0 --levelling tcp:127.0.0.1:0 --fault base-stuck@10 >emulator.txt 2>&1 &
emulator=$!
for _ in $(seq 200); do
  grep -qs '^ready$' emulator.txt && break
  sleep 0.1
done
# shellcheck disable=SC2046
"$rubble" drive "$source/robots/pioneer_urg.yaml" $(sed -n 's/^\(urg\|base\|levelling\) /--\1 /p' emulator.txt) --time-limit 30 --out stuck \
  --set explorer.return_home=false >out.txt 2>err.txt
[[ $? == 0 ]] || fail "a drive whose wheels stood for a while failed: $(tail -3 err.txt)"
stop_emulator
sed -n '/reports, but does not obey: its wheels stand/,$p' err.txt | grep -q "^rubble: base: obeys again" ||
  fail "wheels that stand are not named, or not that they turn again: $(grep ^rubble err.txt)"

wait $faults || fail "faults under way, and a scanner that hangs upside down: $(cat table.txt)"
grep '^| `' table.txt
[[ $(grep -c '^| `' table.txt) == 4 ]] || fail "not four faults were tried: $(cat table.txt)"

# Mounts that make no sense.
expect_exit 2 "the scanner is not played; give --urg too" "$rubble" emulate small.yaml --base tcp:127.0.0.1:0 --urg-upside-down
expect_exit 2 "--urg-yaw" "$rubble" emulate small.yaml --urg tcp:127.0.0.1:0 --urg-yaw 400
finish
