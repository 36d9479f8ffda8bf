#!/bin/bash
# 'rubble calibrate': bad words and bad drives are refused in one line; a recorded drive gives a robot file.
source "$(dirname "$0")/lib.sh"
robot=$source/robots/pioneer_urg.yaml

touch there.yaml
expect_exit 3 "exists already" "$rubble" calibrate "$robot" --out there.yaml
expect_exit 3 "nowhere" "$rubble" calibrate "$robot" --log nowhere --out new.yaml
expect_exit 3 "did you mean" "$rubble" calibrate "$robot" --set devices.base.turn_skale=1 --out new.yaml

# A command of the robot file runs only when the user says so; no folder is made before.
sed 's#^time_limit_s:.*#&\nmapper: {kind: process, command: "touch ran"}#' "$robot" >evil.yaml
expect_exit 3 "runs only with --allow-commands" "$rubble" calibrate evil.yaml --folder evil --out new.yaml
[[ -e ran || -e evil ]] && fail "a command of a robot file ran, or a folder was made for it"
ports="--urg pty:no1 --base pty:no2 --levelling pty:no3 --set safety.start_s=1"
# shellcheck disable=SC2086
"$rubble" calibrate evil.yaml $ports --allow-commands --folder allowed --out new.yaml >out.txt 2>err.txt
[[ $? == 4 ]] || fail "calibrate does not take an allowed command: $(cat err.txt)"
# shellcheck disable=SC2086
"$rubble" calibrate "$robot" $ports --mapper-command "true" --folder typed --out new.yaml >out.txt 2>err.txt
[[ $? == 4 ]] || fail "calibrate does not take a typed command: $(cat err.txt)"
# The cause is told where errors are.
cause=$(sed -n 's/^ended  *//p' out.txt)
[[ -n $cause && $(grep -cF -- "$cause" err.txt) == 1 ]] || fail "stderr does not tell the cause '$cause': $(cat err.txt)"
grep -q 'new.yaml: is not written' err.txt || fail "it is not said that no robot file was written: $(cat err.txt)"

# A run that explores turns and drives enough in a flat arena; its truth: distance 1, laser as in the scenario.
cat >flat.yaml <<YAML
name: flat
arena: {file: $source/arenas/shipped/flat_room.yaml}
robot: {laser: {x_m: 0.10, y_m: 0.04}}
explorer: {victims: {search: false}}
time_limit_s: 120
seed: 2
YAML
"$rubble" run flat.yaml --out flat >/dev/null || fail "the flat run fails"
expect_exit 2 "name the robot file" "$rubble" calibrate --log flat --out new.yaml
"$rubble" calibrate "$robot" --log flat --out found.yaml --set devices.levelling.driver=none >out.txt 2>err.txt ||
  fail "a recorded drive is refused: $(cat err.txt)"
cat out.txt
python3 - found.yaml <<'PY' || fail "the laser's mount is not found"
import re, sys
text = open(sys.argv[1]).read()
value = lambda key: float(re.search(r"\b%s: *([-0-9.e]+)" % key, text).group(1))
ok = abs(value("x_m") - 0.10) < 0.005 and abs(value("y_m") - 0.04) < 0.005 and abs(value("yaw_deg")) < 0.3
ok = ok and abs(value("distance_scale") - 1) < 0.01 and abs(value("turn_scale") - 1.0066) < 0.01
sys.exit(0 if ok else 1)
PY
# The file is one that drive takes.
"$rubble" drive found.yaml --urg pty:no1 --base pty:no2 --set safety.start_s=1 --out nobody >drive.txt 2>&1
[[ $? == 4 ]] || fail "drive does not take the calibrated file: $(cat drive.txt)"

# Half a minute of it is too little.
"$rubble" run flat.yaml --set time_limit_s=8 --out brief >/dev/null || fail "the brief run fails"
expect_exit 3 "no calibration comes of it" "$rubble" calibrate "$robot" --log brief --out brief.yaml
[[ ! -e brief.yaml ]] || fail "a refused drive leaves a robot file"
finish
