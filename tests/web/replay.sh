#!/usr/bin/env bash
# replay.sh PLUMB_REPLAY SOURCE [CASES]: the core in WebAssembly says what the native core says, bit for bit: both play the corpus
# of scripts/replay, and every digest of inputs, answers, verdicts (all fields at every sample), events and snapshots is equal.
# CASES: generated cases, by default all 2000. Skipped, saying so, where a package of scripts/web is not there.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=needs.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/needs.sh"
replay="$1" source="$2" cases="${3:-2000}"
need_web "$source"

work="$source/build/web"
mkdir -p "$work"
"$source/scripts/web" --replay >"$work/replay_build.log" 2>&1 || { tail -n 20 "$work/replay_build.log" >&2; fail "scripts/web --replay failed"; }
begin=$SECONDS
"$replay" --scenarios "$cases" | grep -v '^drill' >"$work/native.txt"
middle=$SECONDS
node "$source/web/run.mjs" "$work/core/plumb_web_replay.wasm" --scenarios "$cases" >"$work/wasm.txt"
end=$SECONDS
[[ "$(grep -vc '^#' "$work/wasm.txt")" -eq $(( cases + 12 )) ]] || fail "not all of the $cases generated cases and 12 of the paper were played"
"$source/scripts/replay" --compare "$work/native.txt" "$work/wasm.txt" || fail "the core in WebAssembly says something else"
# The comparison can fail: one sample of one case, one unit in the last place more.
node "$source/web/run.mjs" "$work/core/plumb_web_replay.wasm" --scenarios "$cases" --perturb s0018 --only s001 >"$work/perturbed.txt"
if diff -q <(grep '^s001' "$work/native.txt") <(grep '^s001' "$work/perturbed.txt") >/dev/null; then fail "a sample that differs is not noticed"; fi
echo "native $(( middle - begin )) s, WebAssembly under node $(( end - middle )) s"
