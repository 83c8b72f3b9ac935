# manual.sh TOOL WORK: the manual page as man reads it, and the completion as bash does.
set -eu
tool=$1 work=$2
mkdir -p "$work"
fail() { echo "manual.sh: $1" >&2; exit 1; }
command -v man >/dev/null || { echo "skipped: no man (Debian package man-db)"; exit 77; }
command -v groff >/dev/null || { echo "skipped: no groff (Debian package groff)"; exit 77; }

"$tool" --man >"$work/plumb.1"
LC_ALL=C.UTF-8 MANROFFSEQ="" MANWIDTH=100 man --warnings -E UTF-8 -l -Tutf8 -Z "$work/plumb.1" 2>"$work/warnings" >/dev/null
[ ! -s "$work/warnings" ] || fail "the page draws warnings: $(cat "$work/warnings")"
LC_ALL=C.UTF-8 MANWIDTH=100 man -P cat -l "$work/plumb.1" | sed 's/\x1b\[[0-9;]*m//g; s/.\x08//g' >"$work/page"
commands=$("$tool" --help | awk '/^Subcommands:/{on=1;next} on&&/^  [a-z]/{print $1} on&&/^$/{exit}')
[ "$(echo "$commands" | wc -w)" -ge 9 ] || fail "--help names too few commands: $commands"
# What --help of a command calls an option, the page and the completion know too, and the other way round.
for command in $commands; do
  grep -q "^ *plumb $command" "$work/page" || fail "the page does not name plumb $command"
  "$tool" "$command" --help | awk '/^Options:/{on=1;next} on&&/^ +-/{print} on&&/^[^ ]/{exit}' |
    grep -oE '^ +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u >"$work/help"
  sed -n "/^PLUMB $(echo "$command" | tr a-z A-Z)\$/,/^[A-Z]/p" "$work/page" |
    grep -oE '^ +(-[a-z], )?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u >"$work/man"
  diff "$work/help" "$work/man" || fail "options of plumb $command: --help (<) and the page (>) differ"
done

"$tool" --completion >"$work/plumb.bash"
cd "$work"
touch tool.toml "my run.csv"
# ask WORD...: what bash offers for the last word.
ask() {
  bash -euc 'set +e; source ./plumb.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _plumb; printf "%s\n" "${COMPREPLY[@]}"' - "$@" | sort -u
}
[ "$(ask plumb '' | grep -v -- -- | sort)" = "$(echo "$commands" | sort)" ] || fail "commands offered: $(ask plumb '')"
[ "$(ask plumb geo)" = geometry ] || fail "plumb geo<TAB>: $(ask plumb geo)"
for command in $commands; do
  "$tool" "$command" --help | awk '/^Options:/{on=1;next} on&&/^ +-/{print} on&&/^[^ ]/{exit}' |
    grep -oE '^ +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u >help
  ask plumb "$command" -- | diff help - || fail "options of plumb $command: --help (<) and the completion (>) differ"
done
[ "$(ask plumb monitor --on-bad-row s)" = "$(printf 'skip\nstop')" ] || fail "choices: $(ask plumb monitor --on-bad-row s)"
[ "$(ask plumb monitor --array to)" = tool.toml ] || fail "files: $(ask plumb monitor --array to)"
[ "$(ask plumb geometry to)" = tool.toml ] || fail "the file without an option: $(ask plumb geometry to)"
[ "$(ask plumb monitor --log my)" = "my run.csv" ] || fail "a name with a blank: $(ask plumb monitor --log my)"
[ -z "$(ask plumb verify --seed t)" ] || fail "a number is no file: $(ask plumb verify --seed t)"
echo "manual page and completion are sound"
