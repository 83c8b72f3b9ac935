#!/usr/bin/env bash
# model/check.sh [--quick] LIBRARY: the model checker's whole account. LIBRARY is libplumb_8.a of a build: the decision layer that
# runs in lock-step. One line per item: verdict <tab> name <tab> figure <tab> seconds. Exit 0 only if every item holds; 77
# where spin is absent. --quick: four sensors only, but for what needs five or chips. Trails of what should not have failed are left in build/model for model/replay.
set -euo pipefail

model="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$(dirname "$model")"
quick=""
if [[ "${1:-}" == --quick ]]; then quick=yes; shift; fi
[[ $# -eq 1 && -r "$1" ]] || { echo "usage: model/check.sh [--quick] LIBRARY (libplumb_8.a of a build)" >&2; exit 2; }
library="$(realpath "$1")"
command -v spin >/dev/null || { echo "skipped: spin is not installed (Debian package spin)"; exit 77; }
work="$root/build/model"
rm -rf "$work"
mkdir -p "$work"

# prepare NAME SENSORS SPIN-DEFINITIONS COMPILER-DEFINITIONS: the checker of one variant, in a folder of its own.
prepare() {
  local dir="$work/$1" sensors="$2" words=() extra=()
  read -ra words <<<"$3"
  read -ra extra <<<"$4"
  mkdir -p "$dir"
  cp "$model"/*.pml "$model"/*.h "$model/shim.cpp" "$dir"
  cd "$dir"
  spin -a -DSENSORS="$sensors" "${words[@]}" lockstep.pml >spin.log 2>&1 || { tail -n 5 spin.log >&2; return 1; }
  ! grep -q 'Error' spin.log || { grep 'Error' spin.log >&2; return 1; }
  # Kept as a script: model/replay --short builds the same checker with another option.
  if [[ " $3 " == *" -DCODE "* ]]; then
    printf '#include "shim.h"\nplumb_model_state S;\nplumb_model_input I;\nplumb_model_answer A;\n' >state.c
    g++ -std=c++17 -O2 -ffp-contract=off -DPLUMB_CAPACITY=8 "${extra[@]}" -I"$root/include" -c shim.cpp -o shim.o
    gcc -O2 -c state.c -o state.o
    echo "gcc -O2 -w -DSENSORS=$sensors ${words[*]} ${extra[*]} \"\$@\" pan.c state.o shim.o $(printf '%q' "$library") -lstdc++ -lm" >compile
  else
    echo "gcc -O2 -w -DSENSORS=$sensors ${words[*]} ${extra[*]} \"\$@\" pan.c -lm" >compile
  fi
  bash compile -o pan
}

# pan exits with 0 whatever it finds: its words decide.
explore() { ./pan -m2000000 "$@" >pan.log 2>&1 || true; }
complete() { ! grep -qE 'search depth too small|out of memory|Search not completed' pan.log && grep -q 'errors: ' pan.log; }
states() { sed -nE 's/^ *([0-9.e+]+) states, stored.*/\1/p' pan.log | head -n 1; }
passes() { complete && grep -q 'errors: 0' pan.log; }
fails_by() { grep -q 'errors: 1' pan.log && grep -qF "$1" pan.log; }

# --- The items: each is run in a shell of its own and prints its figure. ---------------------------------------------
lockstep() {  # lockstep NAME SENSORS [CHIPS]: every safety property, specification and library in lock-step, states as counted by the breadth-first search
  local expected counted
  prepare "$1" "$2" "-DCODE${3:+ -DCHIPS=$3}" "-DSAFETY"
  explore
  passes || { grep -E 'assertion|error|depth' pan.log >&2; return 1; }
  counted="$(( $(states) - 1 ))"  # less the one before anything is set up
  expected="$(awk -v n="${3:-$2}" '$1 == n { print $2 }' "$model/states.txt")"
  [[ "$counted" == "$expected" ]] || { echo "$counted states, states.txt says $expected" >&2; return 1; }
  echo "$counted states"
}
liveness() {  # L1 to L6
  prepare "$1" "$2" "-DCLAIMS" ""
  explore -a -N liveness
  passes || { grep -E 'acceptance|error|depth' pan.log >&2; return 1; }
  echo "$(states) states, no run against L1 to L6"
}
false_claim() {
  prepare "$1" 4 "-DCLAIMS" ""
  explore -a -N never_degraded
  fails_by "assertion violated" || fails_by "acceptance cycle" || return 1
  echo "refuted"
}
must_fail() {  # must_fail NAME SENSORS SPIN-DEFINITIONS COMPILER-DEFINITIONS ASSERTION
  prepare "$1" "$2" "$3" "-DSAFETY $4"
  explore
  fails_by "$5" || { grep -E 'assertion violated|errors:' pan.log >&2; return 1; }
  echo "found"
}
untracked() {  # with the library's state untracked the checker still says "errors: 0"; the count does not
  local counted
  prepare "$1" 4 "-DCODE -DUNTRACKED" "-DSAFETY"
  explore
  counted="$(( $(states) - 1 ))"
  [[ "$counted" != "$(awk '$1 == 4 { print $2 }' "$model/states.txt")" ]] || grep -q 'errors: 1' pan.log
  echo "noticed"
}

item() {  # item NAME COMMAND...
  local name="$1" begin status=0 figure
  shift
  begin="$(date +%s.%N)"
  figure="$( (set -e; "$@") 2>"$work/$name.err")" || status=$?
  if [[ $status -eq 0 ]]; then
    printf 'proved\t%s\t%s\t' "$name" "$figure"
  else
    printf 'refused\t%s\t%s\t' "$name" "$(tr '\n\t' '; ' <"$work/$name.err" | cut -c1-200)"
  fi
  awk -v a="$begin" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f\n", b - a }'
}
export -f item prepare explore complete states passes fails_by lockstep liveness false_claim must_fail untracked
export model root library work

# Two at a time, the long ones first.
run_items() {
  printf '%s\0' \
    "item lockstep_5 lockstep lockstep_5 5" \
    "item lockstep_6 lockstep lockstep_6 6" \
    "item liveness_5 liveness liveness_5 5" \
    "item liveness_6 liveness liveness_6 6" \
    "item lockstep_2111 lockstep lockstep_2111 5 2111" \
    "item lockstep_222 lockstep lockstep_222 6 222" \
    "item lockstep_4 lockstep lockstep_4 4" \
    "item liveness_4 liveness liveness_4 4" \
    "item false_claim_is_refuted false_claim false_claim" \
    "item moving_fault_is_found must_fail moving 4 '-DMOVING' '' 'moved& ~(ever0_)'" \
    "item planted_defect_is_found must_fail defect 4 '-DCODE' -DPLUMB_MODEL_DEFECT agreed" \
    "item forgotten_chips_are_found must_fail forgotten 6 '-DCODE -DCHIPS=222' -DPLUMB_MODEL_FORGETS_CHIPS agreed" \
    "item axis_alone_is_found must_fail axis 6 '-DCHIPS=222 -DAXES_ALONE' '' whole_of" \
    "item untracked_state_is_noticed untracked untracked" \
    "item old_patience_is_found must_fail patience 5 -DOLD_PATIENCE '' '(kind==4)||(kind==5)'" \
    "item old_reset_is_found must_fail reset 4 -DOLD_RESET '' '(mode==6))||(clean_run==0)'" \
    "item confirming_motion_is_found must_fail motion 4 -DMOTION_CONFIRMS '' in_motion" \
    "item old_ban_is_found must_fail ban 5 -DOLD_BAN '' '(out& ~(out0_))& ~(moved)'" \
    | if [[ -n "$quick" ]]; then grep -zvE 'item (lockstep|liveness)_([56]|2111) '; else cat; fi \
    | xargs -0 -P 2 -I{} bash -c '{}'
}
run_items | tee "$work/items.txt"
total="$(wc -l <"$work/items.txt")"
printf 'figure: %d of %d items\n' "$(grep -c '^proved' "$work/items.txt" || true)" "$total"
[[ "$total" -eq "$([[ -n "$quick" ]] && echo 13 || echo 18)" ]] && ! grep -q '^refused' "$work/items.txt"
