#!/usr/bin/env bash
# stories.sh NATIVE SOURCE: builds the explorer, and has its core say under node what it says as a native program (plumb_web_native):
# every story of the page, bit for bit in every field of every verdict, and every built-in geometry. Skipped, saying so, where a
# package of scripts/web is not there, or what npm fetches for it.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=needs.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/needs.sh"
native="$1" source="$2"
need_web "$source"
command -v npm >/dev/null || skip "no npm (scripts/web installs it)"
cmp -s "$source/web/package-lock.json" "$source/web/node_modules/.plumb-lock" || skip "the packages of web/package-lock.json are not fetched (scripts/web does it)"

work="$source/build/web"
mkdir -p "$work"
"$source/scripts/web" --core >"$work/core_build.log" 2>&1 || { tail -n 20 "$work/core_build.log" >&2; fail "scripts/web failed"; }
exec node "$source/web/stories.mjs" "$native" "$work/core/plumb_web.wasm"
