#!/bin/bash
# Other people's clients on the emulated devices: oracles written from the protocols' documents, over TCP and pty.
source "$(dirname "$0")/lib.sh"
printf 'name: flat\narena: {file: %s/arenas/shipped/flat_room.yaml}\n' "$source" >flat.yaml

# client NAME DEVICE PORT SCRIPT [its words]: an emulator of its own, and the client's verdict.
client() {
  local name=$1 device=$2 port=$3 script=$4
  shift 4
  local options=()
  [[ ${1:-} == hardware ]] && options=(--as-hardware)
  "$rubble" emulate flat.yaml "--$device" "$port" --time-limit 300 "${options[@]}" >"$name.emulator" 2>&1 &
  local emulator=$!
  for _ in $(seq 300); do grep -q '^ready$' "$name.emulator" && break; sleep 0.1; done
  timeout 280 python3 "$source/tests/cli/$script" "$(awk -v d="$device" '$1 == d {print $2}' "$name.emulator")" "$@" \
    >"$name.txt" 2>&1
  echo $? >"$name.code"
  kill -INT $emulator
  wait $emulator
}

client scip_tcp urg tcp:127.0.0.1:0 scip_client.py &
client scip_pty urg "pty:$work/urg" scip_client.py &
client arcos_tcp base tcp:127.0.0.1:0 arcos_client.py &
client arcos_pty base "pty:$work/base" arcos_client.py &
client arcos_hardware base tcp:127.0.0.1:0 arcos_client.py hardware &
wait
for name in scip_tcp scip_pty arcos_tcp arcos_pty arcos_hardware; do
  sed "s/^/$name: /" "$name.txt"
  [[ $(cat "$name.code") == 0 ]] || fail "the client $name finds fault"
done
finish
