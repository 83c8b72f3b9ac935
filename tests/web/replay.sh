#!/usr/bin/env bash
# replay.sh WHERE NATIVE SOURCE [PYTHON]: plays the corpus of bench/replay in WebAssembly: WHERE = node against the native program
# (NATIVE: plumb_replay), WHERE = browser against node. Skipped, saying so, where a package of scripts/web is not there.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=needs.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/needs.sh"
where="$1" native="$2" source="$3" python="${4:-}"
need_web "$source"

work="$source/build/web"
mkdir -p "$work"
"$source/scripts/web" --replay >"$work/replay_build.log" 2>&1 || { tail -n 20 "$work/replay_build.log" >&2; fail "scripts/web --replay failed"; }
program="$work/core/plumb_web_replay.wasm"
case "$where" in
  node) exec node "$source/web/replay.mjs" "$native" "$program" ;;
  browser) exec "$python" -B "$source/tests/web/replay_browser.py" "$program" "$source" ;;
  *) fail "$where: node or browser" ;;
esac
