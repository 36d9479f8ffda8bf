#!/bin/bash
# The operator's means to stop the robot, tried at a terminal: keys, signals, heartbeat.
source "$(dirname "$0")/lib.sh"
cat >flat.yaml <<YAML
name: flat
arena: {file: $source/arenas/shipped/flat_room.yaml}
seed: 2
YAML
python3 "$source/tests/cli/operator.py" "$rubble" "$source/robots/pioneer_urg.yaml" flat.yaml || fail "see above"
finish
