#!/usr/bin/env bash
# proofs/check_coq.sh FOLDER [PLUMB]: compiles all Coq files of the folder in a temporary place and asks Coq, for every
# Theorem in them, which assumptions its proof rests on. A folder with a table.jq is about the state machine: PLUMB is then
# the tool, and Table.v is made from what `plumb model --format json` prints. One line per theorem:
#   proved | refused <tab> name <tab> what it rests on <tab> seconds of its file
# Exit 0 all proved; 1 not; 77 Coq or a library is absent (skipped). --self-test: shows that a gap is refused.
set -euo pipefail

# The real numbers of Coq's standard library rest on these three. Nothing else may appear, except what the file
# allowed_axioms of a folder names (Flocq needs the excluded middle).
allowed=(ClassicalDedekindReals.sig_forall_dec ClassicalDedekindReals.sig_not_dec
         FunctionalExtensionality.functional_extensionality_dep)

skip() { echo "skipped: $*"; exit 77; }
fail() { printf '%s\n' "$*" >&2; exit 1; }

command -v coqc >/dev/null || skip "coqc is not installed (Debian package coq)"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

if [[ "${1:-}" == --self-test ]]; then
  # Each of these must be refused: an unfinished proof, an axiom that no word betrays, a proof that does not compile.
  mkdir -p "$work"/{admitted,axiom,wrong}
  printf 'Theorem t : 0 = 1.\nProof. Admitted.\n' >"$work/admitted/A.v"
  printf 'From Coq Require Import Classical.\nTheorem t : forall p : Prop, p \\/ ~ p.\nProof. exact classic. Qed.\n' >"$work/axiom/A.v"
  printf 'Theorem t : 0 = 1.\nProof. reflexivity. Qed.\n' >"$work/wrong/A.v"
  for kind in admitted axiom wrong; do
    status=0
    bash "$0" "$work/$kind" >/dev/null 2>&1 || status=$?
    [[ $status -eq 1 ]] || fail "the case '$kind' was not refused (exit $status)"
  done
  echo "figure: 3 of 3 refused"
  exit 0
fi

[[ $# -ge 1 && $# -le 2 && -d "$1" ]] || { echo "usage: proofs/check_coq.sh FOLDER [PLUMB] | --self-test" >&2; exit 2; }
folder="$1" tool="${2:-}"

libraries="$(coqc -where)/user-contrib"
for library in Flocq Gappa Interval; do
  if grep -qsE "^From $library " "$folder"/*.v && [[ ! -d "$libraries/$library" ]]; then
    skip "the Coq library $library is not installed (Debian package libcoq-${library,,})"
  fi
done

if grep -nE '\b(Admitted|admit|Axioms?|Parameters?|Conjecture|bypass_check|Unset Guard Checking|Unset Universe Checking|Unset Positivity Checking)\b' "$folder"/*.v; then
  fail "$folder: the words above have no place in a finished proof"
fi

cp "$folder"/*.v "$work"
extra=()
[[ ! -e "$folder/allowed_axioms" ]] || mapfile -t extra <"$folder/allowed_axioms"
if [[ -e "$folder/table.jq" ]]; then
  [[ -n "$tool" ]] || { echo "usage: proofs/check_coq.sh $folder PLUMB" >&2; exit 2; }
  command -v jq >/dev/null || skip "jq is not installed (Debian package jq)"
  "$tool" model --format json | jq -r -f "$folder/table.jq" >"$work/Table.v"
fi

cd "$work"
order="$(coqdep -R . Plumb -sort ./*.v)"
modules=()
declare -A seconds=()
for file in $order; do
  module="$(basename "$file" .v)"
  begin="$(date +%s.%N)"
  timeout 900 coqc -q -R . Plumb "$module.v" >"$module.log" 2>&1 || { cat "$module.log" >&2; fail "$module.v does not compile"; }
  seconds[$module]="$(awk -v a="$begin" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')"
  modules+=("$module")
done

declare -A home=()
names=()
{
  printf 'From Plumb Require %s.\n' "${modules[*]}"
  for module in "${modules[@]}"; do
    while read -r name; do
      home[$name]="$module"
      names+=("$name")
      printf 'Goal True. idtac "== %s". Abort.\nPrint Assumptions %s.%s.\n' "$name" "$module" "$name"
    done < <(sed -nE 's/^[[:space:]]*Theorem[[:space:]]+([A-Za-z0-9_]+).*/\1/p' "$module.v")
  done
} >Assumptions.v
[[ ${#names[@]} -gt 0 ]] || fail "$folder: no theorem"
coqc -q -R . Plumb Assumptions.v >assumptions.log 2>&1 || { cat assumptions.log >&2; fail "the assumptions could not be printed"; }

# name <tab> axiom, axiom, ... of every theorem; a name starts in the first column, its type is indented.
awk '
  /^== / { if (name != "") print name "\t" list; name = $2; list = ""; next }
  /^Closed under the global context/ { list = "none"; next }
  /^Axioms:/ || /^[[:space:]]/ || /^$/ { next }
  { list = list (list == "" ? "" : " ") $1 }
  END { if (name != "") print name "\t" list }
' assumptions.log >assumptions.txt

status=0
while IFS=$'\t' read -r name axioms; do
  verdict=proved figure="the axioms of the reals"
  if [[ "$axioms" == none ]]; then
    figure="no axiom"
  elif [[ -z "$axioms" ]]; then
    verdict=refused figure="no answer from Coq"
  else
    for axiom in $axioms; do
      if [[ " ${extra[*]} " == *" $axiom "* ]]; then
        figure="the axioms of the reals and $axiom"
      elif [[ " ${allowed[*]} " != *" $axiom "* ]]; then
        verdict=refused figure="$axiom"
        break
      fi
    done
  fi
  [[ "$verdict" == proved ]] || status=1
  printf '%s\t%s\t%s\t%s\n' "$verdict" "$name" "$figure" "${seconds[${home[$name]}]}"
done <assumptions.txt
[[ "$(wc -l <assumptions.txt)" -eq ${#names[@]} ]] || fail "$folder: ${#names[@]} theorems, but not as many answers"
[[ $status -eq 0 ]] || fail "$folder: a theorem rests on more than it may"
