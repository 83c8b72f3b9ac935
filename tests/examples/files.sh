#!/usr/bin/env bash
# files.sh ROOT PLUMB DIR: the array's calibration and a log for the programs of examples/ideas that read files.
set -euo pipefail
mkdir -p "$3"
"$2" simulate "$1/examples/stand.toml" --out "$3/stand.csv"
"$2" calibrate --array "$1/examples/paper_tool.toml" --log "$3/stand.csv" --out "$3/cal.json"
"$2" simulate "$1/examples/drilling.toml" --out "$3/drilling.csv"
