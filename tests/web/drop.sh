#!/usr/bin/env bash
# drop.sh PLUMB SOURCE PYTHON: builds the explorer and drops logs on it in a browser (drop.py). Skipped, saying so, where a package
# of scripts/web is not there, or what npm fetches for it.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=needs.sh
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/needs.sh"
plumb="$1" source="$2" python="$3"
need_web "$source" weblogs
command -v npm >/dev/null || skip "no npm (scripts/web installs it)"
cmp -s "$source/web/package-lock.json" "$source/web/node_modules/.plumb-lock" || skip "the packages of web/package-lock.json are not fetched (scripts/web does it)"

work="$source/build/web"
mkdir -p "$work"
"$source/scripts/web" >"$work/page_build.log" 2>&1 || { tail -n 20 "$work/page_build.log" >&2; fail "scripts/web failed"; }
exec "$python" -B "$source/tests/web/drop.py" "$plumb" "$source"
