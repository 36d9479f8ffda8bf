#!/bin/bash
# A robot that was stopped by hand goes on when the operator says so, by a key or a signal.
source "$(dirname "$0")/lib.sh"
cat >flat.yaml <<YAML
name: flat
arena: {file: $source/arenas/shipped/flat_room.yaml}
seed: 2
YAML
python3 "$source/tests/cli/operator.py" "$rubble" "$source/robots/pioneer_urg.yaml" flat.yaml held || fail "see above"
finish
