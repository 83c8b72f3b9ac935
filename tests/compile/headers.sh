#!/usr/bin/env bash
# headers.sh INCLUDE COMPILER [flag...]: every header of the rooms that run in an instrument compiles alone.
set -euo pipefail
cd "$1"
shift
headers="$(find plumb/{core,numeric,array,gravity,calibration,detection,navigation,health} -name '*.hpp')"
[[ $(wc -l <<<"$headers") -gt 60 ]]
# shellcheck disable=SC2016 # expanded by the shell that xargs starts
xargs -P 2 -I{} sh -c 'header=$1; shift; echo "#include \"$header\"" | "$@" -std=c++17 -I. -fsyntax-only -Wall -Wextra -Werror -x c++ - ||
  { echo "$header does not stand alone" >&2; exit 1; }' -- {} "$@" <<<"$headers"
