#!/bin/bash
# The signals that a drive may get: it stops the robot and ends with a whole folder.
source "$(dirname "$0")/lib.sh"
operator_tries signals
finish
