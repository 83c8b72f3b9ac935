#!/usr/bin/env bash
# proofs/check.sh FILE.smt2: runs z3 and compares its answers, in order, with the lines "; expect: unsat" or
# "; expect: sat" of the file, one per (check-sat). Exit 0 all as expected, 1 not, 77 z3 absent (skipped).
set -euo pipefail

[[ $# -eq 1 && -r "$1" ]] || { echo "usage: proofs/check.sh FILE.smt2" >&2; exit 2; }
if ! command -v z3 >/dev/null; then
  echo "skipped: z3 is not installed (Debian package z3)"
  exit 77
fi

expected="$(sed -nE 's/^;[[:space:]]*expect:[[:space:]]*(sat|unsat)[[:space:]]*$/\1/p' "$1")"
questions="$(grep -cE '^[[:space:]]*\(check-sat\)' "$1" || true)"
if [[ -z "$expected" || "$(grep -c . <<<"$expected")" -ne "$questions" ]]; then
  echo "$1: $(grep -c . <<<"$expected" || true) expectations for $questions (check-sat)" >&2
  exit 1
fi

begin="$(date +%s.%N)"
output="$(z3 -smt2 -T:300 "$1" 2>&1)" || true
if grep -qE '^\(error|^unsupported' <<<"$output"; then
  echo "$1: z3 did not understand the file:" >&2
  echo "$output" >&2
  exit 1
fi
answers="$(grep -xE 'sat|unsat|unknown|timeout' <<<"$output" || true)"
if [[ "$answers" != "$expected" ]]; then
  echo "$1: expected | answered" >&2
  paste -d'|' <(echo "$expected") <(echo "$answers") >&2
  exit 1
fi
printf 'proved\t%s\t%d answers as expected\t%s\n' "$(basename "$1" .smt2)" "$questions" \
  "$(awk -v a="$begin" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')"
echo "figure: $questions answers as expected"
