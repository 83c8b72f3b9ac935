#!/usr/bin/env bash
# scenarios.sh PLUMB SOURCE: builds the explorer, exports every story of it, and has the tool say of the files what the page says
# (web/scenarios.mjs). Skipped, saying so, where a package of scripts/web is not there, or what npm fetches for it.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=needs.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/needs.sh"
plumb="$1" source="$2"
need_web "$source"
command -v npm >/dev/null || skip "no npm (scripts/web installs it)"
cmp -s "$source/web/package-lock.json" "$source/web/node_modules/.plumb-lock" || skip "the packages of web/package-lock.json are not fetched (scripts/web does it)"

build="$source/build/web"
mkdir -p "$build"
"$source/scripts/web" --core >"$build/core_build.log" 2>&1 || { tail -n 20 "$build/core_build.log" >&2; fail "scripts/web failed"; }
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
node "$source/web/scenarios.mjs" "$plumb" "$build/core/plumb_web.wasm" "$work"
