# Shared by scripts/* and .ci/run: source it, do not run it. It needs bash and set -euo pipefail.
# shellcheck shell=bash

# The same folder by whatever link it was reached, or a build folder would be taken for another checkout's.
PLUMB_ROOT="$(CDPATH="" cd -P -- "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd -P)"
PLUMB_STEP=""
PLUMB_CORE_ROOMS=(core numeric array gravity calibration detection navigation motion health c)  # floors 1 to 4
export CCACHE_SLOPPINESS="${CCACHE_SLOPPINESS:-pch_defines,time_macros,locale}"  # without the first two ccache passes precompiled headers by

# step TEXT...: says what comes next, and how long the script has run; named again if it fails.
step() {
  PLUMB_STEP="$*"
  printf '\n== %s  (at %d s)\n' "$*" "$SECONDS"
}

# die TEXT...: the reason on standard error, exit 1.
die() {
  printf 'plumb: %s\n' "$*" >&2
  PLUMB_STEP=""
  exit 1
}

# on_exit [STATUS]: names the step that failed.
on_exit() {
  local status="${1:-$?}"
  if [[ $status -ne 0 && -n "$PLUMB_STEP" ]]; then
    printf 'plumb: failed (exit %s) at: %s\n' "$status" "$PLUMB_STEP" >&2
  fi
}
trap on_exit EXIT

# Number of compile jobs: one per core, but 1.5 GB of free memory for each (Eigen is hungry).
jobs_count() {
  local cores memory_kb
  cores="$(nproc 2>/dev/null || echo 1)"
  memory_kb="$(awk '/^MemAvailable:/ { print $2 }' /proc/meminfo 2>/dev/null || true)"
  if [[ -n "$memory_kb" ]] && (( memory_kb / 1500000 < cores )); then
    cores=$(( memory_kb / 1500000 ))
  fi
  echo $(( cores > 0 ? cores : 1 ))
}

# packages_of GROUP...: the package names of these groups, one per line.
packages_of() {
  local group
  for group in "$@"; do
    awk -v group="$group" '$1 == group { print $2 }' "$PLUMB_ROOT/scripts/packages"
  done
}

# missing_of PACKAGE...: those that are not installed, one per line.
missing_of() {
  local package
  for package in "$@"; do
    if [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" != installed ]]; then
      echo "$package"
    fi
  done
}

# ensure_packages GROUP...: installs what is missing, after saying so. Nothing missing: nothing done.
ensure_packages() {
  local wanted missing runner=()
  mapfile -t wanted < <(packages_of "$@")
  [[ ${#wanted[@]} -gt 0 ]] || die "scripts/packages names nothing for: $*"
  if ! command -v dpkg-query >/dev/null; then
    die "this script installs Debian packages, and there is no dpkg here. Needed: ${wanted[*]}"
  fi
  mapfile -t missing < <(missing_of "${wanted[@]}")
  if [[ ${#missing[@]} -eq 0 ]]; then
    echo "packages ($*): all ${#wanted[@]} are installed"
    return 0
  fi
  echo "packages ($*): these will be installed with apt-get: ${missing[*]}"
  if [[ "$(id -u)" -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
      die "neither root nor sudo: ask an administrator to install: ${missing[*]}"
    fi
    runner=(sudo)
  fi
  step "apt-get update"
  "${runner[@]}" apt-get update -qq || die "apt-get update failed; still missing: ${missing[*]}"
  step "apt-get install ${missing[*]}"
  "${runner[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o Dpkg::Use-Pty=0 --no-install-recommends "${missing[@]}" \
    || die "apt-get could not install: $(missing_of "${missing[@]}" | tr '\n' ' ')"
  mapfile -t missing < <(missing_of "${missing[@]}")
  [[ ${#missing[@]} -eq 0 ]] || die "still missing after apt-get: ${missing[*]}"
}

# configure PRESET [cmake arguments...]: starts afresh where the build folder stems from another checkout.
configure() {
  local preset="$1" cache="$PLUMB_ROOT/build/$1/CMakeCache.txt" fresh=()
  shift
  if [[ -f "$cache" ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PLUMB_ROOT" "$cache"; then
    fresh=(--fresh)
  fi
  step "configure (preset $preset)"
  (cd "$PLUMB_ROOT" && cmake --preset "$preset" "${fresh[@]}" "$@" --log-level=NOTICE)
}

# What a build has beyond one capacity for the core and one for the host.
# shellcheck disable=SC2034  # used by the scripts that source this
PLUMB_MORE_BUILDS=(-DPLUMB_ALL_CAPACITIES=ON -DPLUMB_BUILD_PYTHON=AUTO -DPLUMB_BUILD_MPI=ON -DPLUMB_PLANT_DEFECTS=ON)

# usual_builds: sets PLUMB_USUAL_BUILDS for build/release: none of these; a folder that has them already keeps them.
usual_builds() {
  PLUMB_USUAL_BUILDS=()
  if ! grep -qxF PLUMB_ALL_CAPACITIES:BOOL=ON "$PLUMB_ROOT/build/release/CMakeCache.txt" 2>/dev/null; then
    PLUMB_USUAL_BUILDS=(-DPLUMB_ALL_CAPACITIES=OFF -DPLUMB_BUILD_PYTHON=OFF -DPLUMB_BUILD_MPI=OFF -DPLUMB_PLANT_DEFECTS=OFF)
  fi
}

# build_targets BUILDDIR TARGET...
build_targets() {
  local dir="$1" jobs
  shift
  jobs="$(jobs_count)"
  step "build $* in ${dir#"$PLUMB_ROOT/"} ($jobs jobs)"
  cmake --build "$dir" --parallel "$jobs" --target "$@"
}

# junit_summary FILE: "passed failed skipped" of a ctest JUnit file, then one line per test that did not run:
# name, tab, reason. A test that could not run for want of its executable counts as failed.
junit_summary() {
  awk '
    function attribute(line, name,   rest) {
      if (!match(line, " " name "=\"[^\"]*\"")) return ""
      rest = substr(line, RSTART, RLENGTH)
      sub("^ " name "=\"", "", rest)
      sub("\"$", "", rest)
      return rest
    }
    function plain(text) {
      gsub(/<[^>]*>/, "", text); gsub(/&lt;/, "<", text); gsub(/&gt;/, ">", text)
      gsub(/&quot;/, "\"", text); gsub(/&apos;/, "\x27", text); gsub(/&amp;/, "\\&", text)
      sub(/^[ \t]+/, "", text); sub(/[ \t\r]+$/, "", text)
      return text
    }
    function finish() {
      if (status == "run") ++passed
      else if (status == "disabled") { ++skipped; notes = notes name "\tdisabled in the source\n" }
      else if (status == "notrun" && cause ~ /^SKIP_/) {
        ++skipped; notes = notes name "\t" (reason == "" ? "no reason given" : reason) "\n"
      }
      else ++failed
      name = ""
    }
    /<testcase / {
      name = attribute($0, "name"); status = attribute($0, "status"); cause = ""; reason = ""; take = 0
      if ($0 ~ /\/>[ \t]*$/) finish()
      next
    }
    name == "" { next }
    /<skipped / { cause = attribute($0, "message") }
    # GoogleTest: "file:line: Skipped", then the reason; a script: "skipped: reason"
    take && reason == "" && plain($0) != "" { reason = plain($0); take = 0 }
    /: Skipped[ \t\r]*$/ { take = 1 }
    plain($0) ~ /^skipped: / && reason == "" { reason = plain($0); sub(/^skipped: /, "", reason) }
    /<\/testcase>/ { finish() }
    END { printf "%d %d %d\n%s", passed, failed, skipped, notes }
  ' "$1"
}

# name_build JUNIT HEADER: writes into a JUnit file which build it is a result of, as the build's header says it, for
# plumb verify --test-results. A build without that header stays unnamed.
name_build() {
  [[ -f "$2" ]] || return 0
  python3 - "$1" "$2" <<'PYTHON'
import re
import sys
from xml.sax.saxutils import quoteattr

junit, header = sys.argv[1:]
found = dict(re.findall(r'#define (PLUMB_COMMIT|PLUMB_BUILD_COMPILER|PLUMB_BUILD_FLAGS) "(.*)"', open(header).read()))
names = {"plumb.commit": "PLUMB_COMMIT", "plumb.compiler": "PLUMB_BUILD_COMPILER", "plumb.flags": "PLUMB_BUILD_FLAGS"}
lines = "".join(f"\n\t\t<property name={quoteattr(name)} value={quoteattr(found.get(macro, ''))}/>" for name, macro in names.items())
text = open(junit, encoding="utf-8", errors="replace").read()
end = text.index(">", text.index("<testsuite")) + 1
with open(junit, "w", encoding="utf-8") as out:
    out.write(text[:end] + "\n\t<properties>" + lines + "\n\t</properties>" + text[end:])
PYTHON
}

# run_ctest BUILDDIR [ctest arguments...]: runs the tests, lists the skipped ones with their reason, sets PASSED,
# FAILED and SKIPPED. Returns 0 only if something ran and nothing failed.
run_ctest() {
  local dir="$1" junit="$1/junit.xml" summary status=0
  shift
  PASSED=0 FAILED=0 SKIPPED=0
  rm -f "$junit"
  step "ctest in ${dir#"$PLUMB_ROOT/"}"
  ctest --test-dir "$dir" --parallel "$(nproc)" --output-on-failure --no-tests=error --output-junit "$junit" "$@" \
    || status=$?
  [[ -f "$junit" ]] || die "ctest wrote no result in $dir (no tests, or it was stopped)"
  name_build "$junit" "$dir/generated/build_identity.hpp"
  summary="$(junit_summary "$junit")"
  read -r PASSED FAILED SKIPPED <<<"$summary"
  if [[ "$SKIPPED" -gt 0 ]]; then
    printf '\nskipped:\n'
    tail -n +2 <<<"$summary" | sed 's/^/  /; s/\t/: /'
  fi
  if [[ "$status" -ne 0 || "$FAILED" -ne 0 || $(( PASSED + FAILED )) -eq 0 ]]; then
    return 1
  fi
}
