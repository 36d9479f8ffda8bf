#!/bin/bash
# A robot that was stopped by hand goes on when the operator says so, by a key or a signal.
source "$(dirname "$0")/lib.sh"
operator_tries held
finish
