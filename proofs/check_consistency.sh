#!/usr/bin/env bash
# proofs/check_consistency.sh: what is written about the proofs is what they prove.
# Bounds: every "constant NAME LITERAL" in a proof stands as "NAME = LITERAL;" in tests/detection/rounding_bounds.hpp, its
# literal in the text of the proof as well, and the header names no bound that is not proved.
# Theorems: the tables of README.md name, in their first column, exactly the theorems of the Coq files.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
header="$root/tests/detection/rounding_bounds.hpp"
count=0
while IFS=: read -r file name literal; do
  grep -qF " $name = $literal;" "$header" || { echo "$file proves $name = $literal, $header says otherwise" >&2; exit 1; }
  [[ "$(grep -cF "$literal" "$root/$file")" -ge 2 ]] || { echo "$file: $literal stands in the comment only" >&2; exit 1; }
  count=$(( count + 1 ))
done < <(cd "$root" && grep -oE 'constant k[A-Za-z0-9_]+ [0-9][0-9a-fx.p-]*' proofs/*.g proofs/*/*.v \
  | sed -E 's/:constant ([^ ]+) /:\1:/')
named="$(grep -cE '^inline constexpr double k' "$header")"
[[ $count -gt 0 && $count -eq $named ]] || { echo "$count bounds are proved, $named stand in $header" >&2; exit 1; }

theorems="$(sed -nE 's/^[[:space:]]*Theorem[[:space:]]+([A-Za-z0-9_]+).*/\1/p' "$root"/proofs/*/*.v | sort)"
told="$(awk -F'|' '/^\| (theorem: )?`[A-Za-z0-9_]+`/ { print $2 }' "$root/proofs/README.md" \
  | grep -oE '[A-Za-z0-9_]*_[A-Za-z0-9_]+' | sort)"
if ! diff <(echo "$theorems") <(echo "$told") >&2; then
  echo "proofs/README.md (>) and the Coq files (<) name different theorems" >&2
  exit 1
fi
printf 'figure: %d bounds, %d theorems\n' "$count" "$(wc -l <<<"$theorems")"
