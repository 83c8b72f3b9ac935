# Worst-case stack of functions, from the disassembly of a linked image (objdump -d -C --no-show-raw-insn): the call
# graph of what really runs, the C and compiler libraries included.
#   awk -v roots='name prefix|name prefix' [-v apart='regular expression'] -f stack.awk LISTING
# `apart`: functions that are left out, with all that they call.
# A frame is the sum of everything that a function ever takes off the stack pointer: an upper bound. Refused: recursion,
# calls through a register, frames whose size is not in the code.
function hex(text,   i, value) {
  value = 0
  for (i = 1; i <= length(text); ++i) value = 16 * value + index("0123456789abcdef", substr(text, i, 1)) - 1
  return value
}
function registers(list,   part, count, k, ends, total) {  # of "{r4, r5, d8-d11}"
  gsub(/[{} ]/, "", list)
  count = split(list, part, ",")
  total = 0
  for (k = 1; k <= count; ++k) {
    if (split(part[k], ends, "-") == 2) {
      sub(/^[a-z]+/, "", ends[1]); sub(/^[a-z]+/, "", ends[2])
      total += ends[2] - ends[1] + 1
    } else {
      ++total
    }
  }
  return total
}
function refuse(what) { refusal[current] = refusal[current] (refusal[current] == "" ? "" : "; ") what }
function call(target) { if (target != current) calls[current] = calls[current] " " target }

/^[0-9a-f]+ <.*>:$/ {
  current = $1
  sub(/^0+/, "", current)
  if (current == "") current = "0"
  name[current] = substr($0, index($0, "<") + 1)
  sub(/>:$/, "", name[current])
  place[name[current]] = current
  frame[current] = 0
  order[++functions] = current
  next
}
current == "" || !/^ *[0-9a-f]+:\t/ { next }
{
  split($0, column, "\t")
  mnemonic = column[2]
  operands = column[3]
  if (mnemonic ~ /^(push|stmdb)/ && (mnemonic ~ /^push/ || operands ~ /^sp!/)) {
    list = operands; sub(/^[^{]*/, "", list); sub(/}.*/, "}", list)
    frame[current] += 4 * registers(list)
  } else if (mnemonic ~ /^vpush/ || (mnemonic ~ /^vstmdb/ && operands ~ /^sp!/)) {
    list = operands; sub(/^[^{]*/, "", list); sub(/}.*/, "}", list)
    frame[current] += (list ~ /d/ ? 8 : 4) * registers(list)
  } else if (mnemonic ~ /^str/ && operands ~ /\[sp, #-[0-9]+\]!/) {
    bytes = operands; sub(/.*\[sp, #-/, "", bytes); sub(/\].*/, "", bytes)
    frame[current] += bytes
  } else if (mnemonic ~ /^sub/ && operands ~ /^sp/) {
    if (operands ~ /#[0-9]+/) { bytes = operands; sub(/.*#/, "", bytes); sub(/[^0-9].*/, "", bytes); frame[current] += bytes }
    else refuse("a frame of unknown size (" mnemonic " " operands ")")
  } else if (mnemonic ~ /^add/ && operands ~ /^sp, (sp, )?r/) {
    loaded = 1  # the way back of a frame refused above
  } else if (mnemonic ~ /^mov/ && operands ~ /^sp,/ ) {
    refuse("the stack pointer is set (" mnemonic " " operands ")")
  }
  if (mnemonic ~ /^(bl|b|cbz|cbnz)([a-z]*)(\.[nw])?$/ && operands ~ /</) {
    target = operands; sub(/ <.*/, "", target); sub(/.*[ ,]/, "", target)
    inside = operands; sub(/^[^<]*</, "", inside); sub(/>[^>]*$/, "", inside)
    if (mnemonic ~ /^bl(\.w)?$/) { call(target) }
    else if (inside !~ /\+0x[0-9a-f]+$/ && target != current) { call(target) }     # a call at the end
    else if (inside ~ /\+0x[0-9a-f]+$/) { sub(/\+0x[0-9a-f]+$/, "", inside); if (inside != name[current]) jumps[current] = jumps[current] "\n" inside }
  } else if (mnemonic ~ /^blx/ || (mnemonic ~ /^bx/ && operands !~ /^lr/) || (mnemonic ~ /^mov/ && operands ~ /^pc,/ && operands !~ /lr/)) {
    refuse("a call through a register (" mnemonic " " operands ")")
  }
}
function depth_of(f,   part, count, k, deepest, inner) {
  if (f in depth) return depth[f]
  if (f in active) { recursive = name[f]; return 0 }
  active[f] = 1
  if (refusal[f] != "") { problem[++problems] = name[f] ": " refusal[f] }
  if (!(f in frame)) problem[++problems] = "a call into nowhere: " f
  # The compiler's own assembly jumps from one function into the middle of another: like a call at the end.
  count = split(jumps[f], part, "\n")
  for (k = 2; k <= count; ++k) calls[f] = calls[f] " " place[part[k]]
  count = split(calls[f], part, " ")
  deepest = 0
  for (k = 1; k <= count; ++k) {
    if (apart != "" && name[part[k]] ~ apart) continue
    inner = depth_of(part[k])
    if (inner > deepest) { deepest = inner; next_of[f] = part[k] }
  }
  delete active[f]
  if (recursive != "") problem[++problems] = "recursion through " recursive
  recursive = ""
  depth[f] = frame[f] + deepest
  return depth[f]
}
END {
  count = split(roots, root, "|")
  for (k = 1; k <= count; ++k) {
    found = 0
    for (i = 1; i <= functions; ++i) {
      f = order[i]
      if (index(name[f], root[k]) == 0 || name[f] ~ /\.(part|constprop)\.[0-9]+$/) continue
      found = 1
      printf "stack %d %s\n", depth_of(f), root[k]
      if (path) for (g = f; g != ""; g = next_of[g]) printf "  %6d  %s\n", frame[g], name[g]
      break
    }
    if (!found) problem[++problems] = "no function " root[k]
  }
  for (k = 1; k <= problems; ++k) printf "refused %s\n", problem[k]
  exit problems > 0
}
