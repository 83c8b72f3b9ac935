#!/usr/bin/env bash
# prints.sh EXPECTED PROGRAM [argument...]: fails where the program fails, or prints anything but the file EXPECTED.
set -euo pipefail
expected=$1
shift
test -s "$expected"
"$@" | diff -u "$expected" -
