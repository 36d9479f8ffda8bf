#!/bin/bash
# The signals that a drive may get: it stops the robot and ends with a whole folder.
source "$(dirname "$0")/lib.sh"
cat >flat.yaml <<YAML
name: flat
arena: {file: $source/arenas/shipped/flat_room.yaml}
seed: 2
YAML
python3 "$source/tests/cli/operator.py" "$rubble" "$source/robots/pioneer_urg.yaml" flat.yaml signals || fail "see above"
finish
