#!/bin/bash
# Whom a robot belongs to, in real time: our own drives and other clients on its devices, before, beside and after one another.
source "$(dirname "$0")/lib.sh"

drive= stranger=
clean_up() { for it in $emulator $drive $stranger; do kill $it 2>/dev/null; done; }

small_scenario small.yaml
robot=$source/robots/pioneer_urg.yaml

# A robot that is driven belongs to one: whoever else comes is told so and does not wait, or it would drive the robot on when the
# first one stops it. First our own drives, then a client that only the device itself can turn away.
# One of its devices is unplugged meanwhile: it still belongs to the first.
start_emulator small.yaml --fault base-unplug@8
# shellcheck disable=SC2086
"$rubble" drive "$robot" $ports --out first >/dev/null 2>first.txt &
drive=$!
for _ in $(seq 300); do
  grep -q 'motors on' first.txt && break
  sleep 0.1
done
# shellcheck disable=SC2086
expect_exit 4 "another program uses it; end that first" timeout 100 "$rubble" drive "$robot" $ports --set safety.start_s=200 --out second
[[ -e second ]] && fail "a drive that is refused leaves a folder"
# shellcheck disable=SC2086
expect_exit 4 "another program uses it" timeout 100 "$rubble" calibrate "$robot" $ports --set safety.start_s=200 --out second.yaml
base=$(sed -n 's/^base //p' emulator.txt)
"$rubble" devices "$base" >devices.txt 2>&1
[[ $? == 4 ]] && grep -q "another program uses it" devices.txt || fail "devices asks a base that is driven: $(cat devices.txt)"
for _ in $(seq 300); do
  sed -n '/motors on/,$p' first.txt | grep -q 'rubble: base: ' && break
  sleep 0.1
done
# shellcheck disable=SC2086
expect_exit 4 "another program uses it; end that first" timeout 100 "$rubble" drive "$robot" $ports --set safety.start_s=200 --out second
for _ in $(seq 300); do
  sed -n '/motors on/,$p' first.txt | grep -q 'base: reports' && break
  sleep 0.1
done
sed -n '/motors on/,$p' first.txt | grep -q 'base: reports' || fail "the first drive lost its base to another: $(tail -3 first.txt)"
kill -INT $drive
wait $drive
[[ $? == 130 ]] || fail "the first drive was disturbed: $(tail -3 first.txt)"
drive=
python3 -c '
import socket, sys, time
line = socket.create_connection((sys.argv[1].split(":")[1], int(sys.argv[1].split(":")[2])))
print("on", flush=True)
time.sleep(300)' "$base" >stranger.txt &
stranger=$!
for _ in $(seq 100); do
  [[ -s stranger.txt ]] && break
  sleep 0.1
done
# shellcheck disable=SC2086
timeout 100 "$rubble" drive "$robot" $ports --set safety.start_s=5 --out third >out.txt 2>err.txt
[[ $? == 4 ]] && tail -n 1 err.txt | grep -qF "base: has not reported yet ($base: the other side hangs up at once; another program uses the device" ||
  fail "a drive with a base in use waits or does not say so: $(tail -3 err.txt)"
"$rubble" devices "$base" >devices.txt 2>&1
[[ $? == 4 ]] && grep -q "another program uses the device" devices.txt || fail "devices at a base in use: $(cat devices.txt)"
# It is said and waited for; but who is let in when the other leaves does not drive.
rm -f err.txt  # the drive before said it too
# shellcheck disable=SC2086
timeout 100 "$rubble" drive "$robot" $ports --set safety.start_s=60 --out fourth >out.txt 2>err.txt &
drive=$!
for _ in $(seq 300); do
  grep -qs "base: .*hangs up at once" err.txt && break
  sleep 0.1
done
kill $stranger
wait $stranger 2>/dev/null
stranger=
wait $drive
[[ $? == 4 ]] && tail -n 1 err.txt | grep -q "base: hung up at first" || fail "a drive takes over a robot that was in use: $(tail -3 err.txt)"
! grep -q "motors on" out.txt err.txt || fail "it switched the motors on"
drive=
stop_emulator
finish
