#!/usr/bin/env bash
# proofs/check_gappa.sh FILE.g: the bounds of the file must be proved by gappa, and must not be proved any more when the
# constant named in "# constant NAME LITERAL" is made four times smaller (so that no contradiction among the premises
# proves everything). Where Coq and its Gappa library are installed, Coq checks gappa's proof again.
# Exit 0 as said; 1 not; 77 gappa absent (skipped).
set -euo pipefail

[[ $# -eq 1 && -r "$1" ]] || { echo "usage: proofs/check_gappa.sh FILE.g" >&2; exit 2; }
if ! command -v gappa >/dev/null; then
  echo "skipped: gappa is not installed (Debian package gappa)"
  exit 77
fi
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
begin="$(date +%s.%N)"

read -r name literal < <(sed -nE 's/^# constant ([A-Za-z0-9_]+) (0x[0-9a-f.]+p-?[0-9]+)$/\1 \2/p' "$1")
mantissa="${literal%p*}" exponent="${literal##*p}"
sed -E "/^#/! s/<= ${mantissa//./\\.}p${exponent}([^0-9]|$)/<= ${mantissa}p$(( exponent - 2 ))\1/" "$1" >"$work/tight.g"
if cmp -s "$1" "$work/tight.g"; then
  echo "$1: the constant $name = $literal bounds nothing" >&2
  exit 1
fi

gappa "$1" || { echo "$1: not proved" >&2; exit 1; }
if gappa "$work/tight.g" >/dev/null 2>&1; then
  echo "$1: a fourth of $literal is proved as well: the premises contradict each other, or the bound is poor" >&2
  exit 1
fi

figure="by gappa"
if command -v coqc >/dev/null && [[ -d "$(coqc -where)/user-contrib/Gappa" ]]; then
  gappa -Bcoq "$1" >"$work/generated.v" 2>/dev/null
  (cd "$work" && timeout 600 coqc -q generated.v >coq.log 2>&1) || { cat "$work/coq.log" >&2; echo "$1: Coq does not accept gappa's proof" >&2; exit 1; }
  figure="by gappa, checked by Coq"
fi
printf 'proved\t%s\t%s = %s, %s\t%s\n' "$(basename "$1" .g)" "$name" "$literal" "$figure" \
  "$(awk -v a="$begin" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')"
printf 'figure: %s <= %.4g\n' "${name##*_}" "$literal"
