# Sourced by the tests of tests/web: what scripts/web installs has to be there, for a test installs nothing.
# shellcheck shell=bash
skip() { echo "skipped: $1"; exit 77; }
fail() { echo "$(basename "$0"): $*" >&2; exit 1; }

# need_web SOURCE [GROUP...]: sets nothing, returns where the packages are there; groups of scripts/packages beside build and web.
need_web() {
  local missing
  # shellcheck source=scripts/lib.sh
  source "$1/scripts/lib.sh"
  command -v dpkg-query >/dev/null || skip "no dpkg, so nothing is known of the packages that scripts/web needs"
  mapfile -t missing < <(packages_of build web "${@:2}" | xargs -r bash -c 'source "$0/scripts/lib.sh"; missing_of "$@"' "$1")
  [[ ${#missing[@]} -eq 0 ]] || skip "not installed: ${missing[*]} (scripts/web installs them)"
}
