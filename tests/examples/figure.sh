#!/usr/bin/env bash
# figure.sh REPOSITORY NAME PROGRAM argument...: docs/NAME.svg, with dashes, is what the example and gnuplot draw now.
# 77 = skipped.
set -euo pipefail
repository="$1" name="$2"
shift 2
version="$(gnuplot --version 2>/dev/null || true)"
if [[ "$version" != "gnuplot 5.4 patchlevel 4"* ]]; then
  echo "skipped: the figure was drawn by gnuplot 5.4 patchlevel 4; here: ${version:-none}"
  exit 77
fi
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
"$@" >"$name.txt"
gnuplot "$repository/examples/navigation/$name.gp" >drawn.svg
cmp drawn.svg "$repository/docs/${name//_/-}.svg"
