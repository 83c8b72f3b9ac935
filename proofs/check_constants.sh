#!/usr/bin/env bash
# proofs/check_constants.sh: a bound that is proved and a bound that is tested must be one and the same. Every "constant NAME
# LITERAL" in a proof has to stand as "NAME = LITERAL;" in tests/detection/rounding_bounds.hpp, its literal in the text of the
# proof as well, and the header may name no bound that is not proved.
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
printf 'figure: %d bounds\n' "$count"
