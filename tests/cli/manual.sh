# manual.sh TOOL WORK: the manual page as man reads it, and the completion as bash, zsh and fish do.
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

# The same of the other shells: every option of --help and no other, what it takes, and the commands.
options_of() {
  "$tool" "$1" --help | awk '/^Options:/{on=1;next} on&&/^ +-/{print} on&&/^[^ ]/{exit}' |
    grep -oE '^ +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u
}
compared="bash"
if command -v zsh >/dev/null; then
  "$tool" --completion-zsh >_plumb
  zsh -fn _plumb || fail "zsh cannot read the completion"
  # zask WORD...: what zsh is told to offer after these words.
  zask() {
    zsh -fc 'compdef() { : }; _arguments() { print -rl -- "$@" }; _describe() { local name=$2; print -rl -- "${(@P)name}" }
             source ./_plumb; words=(plumb "$@" ""); CURRENT=$#words; _plumb' - "$@"
  }
  [ "$(zask | sed 's/:.*//' | sort)" = "$(echo "$commands" | sort)" ] || fail "commands offered by zsh: $(zask)"
  for command in $commands; do
    options_of "$command" >help
    zask "$command" | grep -oE '^\*?--[a-z-]+' | tr -d '*' | sort -u | diff help - || fail "options of plumb $command: --help (<) and zsh (>) differ"
  done
  zask monitor | grep -q '^--on-bad-row\[.*\]:value:(skip stop)$' || fail "choices in zsh: $(zask monitor)"
  zask verify | grep -q '^--array\[.*\]:value:_files$' || fail "files in zsh: $(zask verify)"
  zask verify | grep -q '^--seed\[.*\]:value:$' || fail "a number is no file in zsh: $(zask verify)"
  compared="$compared, zsh"
fi
if command -v fish >/dev/null; then
  "$tool" --completion-fish >plumb.fish
  fish --no-config --no-execute plumb.fish || fail "fish cannot read the completion"
  # fask LINE: what fish offers at the end of this line.
  fask() { HOME="$PWD" fish --no-config -c 'source plumb.fish; complete -C "$argv[1]"' "$1" | cut -f 1 | sort -u; }
  [ "$(fask 'plumb ')" = "$(echo "$commands" | sort -u)" ] || fail "commands offered by fish: $(fask 'plumb ')"
  for command in $commands; do
    options_of "$command" >help
    fask "plumb $command --" | diff help - || fail "options of plumb $command: --help (<) and fish (>) differ"
  done
  [ "$(fask 'plumb monitor --on-bad-row ')" = "$(printf 'skip\nstop')" ] || fail "choices in fish: $(fask 'plumb monitor --on-bad-row ')"
  [ "$(fask 'plumb monitor --array to')" = tool.toml ] || fail "files in fish: $(fask 'plumb monitor --array to')"
  [ -z "$(fask 'plumb verify --seed t')" ] || fail "a number is no file in fish: $(fask 'plumb verify --seed t')"
  compared="$compared, fish"
fi
echo "the manual page is sound, and completion in $compared"
