#!/usr/bin/env bash
# quick.sh PLUMB_REPLAY SOURCE WORK: the same corpus twice gives the same digests; one sample that is one unit in the last place
# off, another seed, a word that is called otherwise and a case too few are all found, so that scripts/replay can fail.
set -euo pipefail
replay="$1" source="$2" work="$3"
rm -rf "$work"
mkdir -p "$work"
cd "$work"
fail() { echo "quick.sh: $*" >&2; exit 1; }

# expect CODE TEXT A B: what the comparison of two outputs says.
expect() {
  local code="$1" text="$2" status=0
  "$source/scripts/replay" --compare "$3" "$4" >said.txt 2>&1 || status=$?
  [[ "$status" -eq "$code" ]] || { cat said.txt >&2; fail "$3 and $4: exit code $status, expected $code"; }
  grep -qF -- "$text" said.txt || { cat said.txt >&2; fail "$3 and $4: nothing says '$text'"; }
}

"$replay" --quick >one.txt
"$replay" --quick >two.txt
cmp one.txt two.txt || fail "the same corpus gives other digests"
expect 0 "63 of 63 cases are equal" one.txt two.txt

# The monitor gets one sample otherwise than told: inputs are equal, verdicts are not, and that case alone differs.
"$replay" --quick --perturb s0018 >perturbed.txt
expect 1 "differs s0018-n7-cap8-settings-F19: verdicts" one.txt perturbed.txt
expect 1 "62 of 63 cases are equal" one.txt perturbed.txt

# A renamed word is another digest, and the same one where both call it so.
printf '# old new\nsuspect doubtful\n' >words.txt
printf 'doubtful suspect\n' >nothing.txt
"$replay" --quick --only s001 >few.txt
"$replay" --quick --only s001 --words words.txt >renamed.txt
"$replay" --quick --only s001 --words nothing.txt >same.txt
expect 1 "0 of 10 cases are equal" few.txt renamed.txt
expect 0 "10 of 10 cases are equal" few.txt same.txt

"$replay" --quick --seed 2 --only s0000 >seed.txt
expect 2 "the corpora differ" one.txt seed.txt
sed '/^s0007/d' one.txt >short.txt
expect 2 "1 cases are gone" one.txt short.txt
sed '1s/format [0-9]*/format 99/; /^#/!s/[0-9a-f]*$/0/' one.txt >format.txt
expect 0 "snapshots have format" one.txt format.txt

# The text of a case names the first figure that differs.
"$replay" --trace s0018 >one.trace
"$replay" --trace s0018 --perturb s0018 >perturbed.trace
if cmp -s one.trace perturbed.trace; then fail "the text does not show what the digests do"; fi
diff one.trace perturbed.trace >difference.txt || true
grep -E '^> ' difference.txt | head -n 1 | grep -qE '^> row 40 t [0-9.]+ verdicts ' \
  || fail "the first figure that differs is not in the sample that was disturbed: $(head -n 3 difference.txt)"
echo "replay.quick: $(grep -c '^[ds]' one.txt) cases, twice the same, and six differences found"
