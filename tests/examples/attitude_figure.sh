#!/usr/bin/env bash
# attitude_figure.sh PROGRAM REPOSITORY: docs/attitude-filter.svg is what the example and gnuplot draw now.
# 77 = skipped.
set -euo pipefail
program="$1" repository="$2"
version="$(gnuplot --version 2>/dev/null || true)"
if [[ "$version" != "gnuplot 5.4 patchlevel 4"* ]]; then
  echo "skipped: the figure was drawn by gnuplot 5.4 patchlevel 4; here: ${version:-none}"
  exit 77
fi
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" >attitude_filter.txt
gnuplot "$repository/examples/navigation/attitude_filter.gp" >drawn.svg
cmp drawn.svg "$repository/docs/attitude-filter.svg"
