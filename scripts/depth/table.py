"""Every cell of the transition table, changed; and the specification that must notice."""
import re

from mutants import Mutant

HEADER = "include/plumb/health/transition_table.hpp"
TARGETS = ("stay", "by_size", "by_size_if_validated", "by_size_when_passed", "suspect", "suspect_or_failed",
           "stay_or_failed", "by_protection", "recalibrating", "base", "rearm", "failed")
CELL = re.compile(r"on\(E::\w+\)(\.to\(T::(\w+)\)(?:\.does\(([\w:| ]+)\))?|\.ignored\(\)|\.held\(\)|\.impossible\(\))")
ROW = re.compile(r"constexpr Row (k\w+) = \{\n(.*?)\n\};", re.S)


def others(match):
    """What may stand in the place of a cell."""
    text, target, actions = match.group(1), match.group(2), match.group(3)
    idle = (".ignored()", ".held()", ".impossible()")
    if target is None:
        return [t for t in (*idle, ".to(T::stay).does(A::count)", ".to(T::suspect)") if t != text]
    tail = f".does({actions})" if actions else ""
    out = [f".to(T::{t}){tail}" for t in TARGETS if t != target]
    out += idle
    bits = actions.split(" | ") if actions else []
    for bit in bits:
        left = " | ".join(b for b in bits if b != bit)
        out.append(f".to(T::{target}).does({left})" if left else f".to(T::{target})")
    for bit in ("A::exclude", "A::exclude_provisionally", "A::discard_fit", "A::not_yet_validated"):
        if bit not in bits:
            out.append(f".to(T::{target}).does({' | '.join([*bits, bit])})")
    return out


def cells(root):
    """The mutants of all rows, cell by cell."""
    source = (root / HEADER).read_text()
    out = []
    for row in ROW.finditer(source):
        for column, match in enumerate(CELL.finditer(row.group(2))):
            begin = row.start(2) + match.start(1)
            number = source.count("\n", 0, begin) + 1
            for new in others(match):
                out.append(Mutant(HEADER, begin, begin + len(match.group(1)), new, "cell", number,
                                  match.group(1), f"`{match.group(1)}` -> `{new}`", f"{row.group(1)}[{column}]"))
    if len({m.begin for m in out}) != 6 * 15:
        raise SystemExit(f"mutants: {HEADER} no longer has six rows of fifteen cells that this script can read")
    return out


def specified(root):
    """The cells that model/specification.pml was written with, as numbers; its order is that of the code's enumerations."""
    text = (root / "model/specification.pml").read_text()
    value = {name: int(number) for name, number in re.findall(r"^#define (\w+) +(\d+)\s*$", text, re.M)}
    line = re.compile(r"^\s*CELL\((\w+),\s*(\w+),\s*(\w+),\s*(\w+),\s*([\w |]+)\);", re.M)
    table = {}
    for mode, event, kind, target, actions in line.findall(text):
        bits = sum(value[a] for a in actions.replace("|", " ").split())
        table[value[mode], value[event]] = (kind, value[target], bits)
    if len(table) != 7 * 14:
        raise SystemExit("mutants: model/specification.pml does not have 7 x 14 cells")
    return table


ASSERTED = """#include "plumb/health/transition_table.hpp"
using namespace plumb;
constexpr bool is(int mode, int event, CellKind kind, int target, unsigned actions) {
  const Cell& cell = cell_of(static_cast<Mode>(mode), static_cast<HealthEvent>(event));
  return cell.kind == kind && static_cast<int>(cell.target) == target && cell.actions == actions;
}
"""


def asserted(root):
    """A source that compiles only where every cell of the table is as specified."""
    return ASSERTED + "".join(
        f'static_assert(is({mode}, {event}, CellKind::{kind.lower()}, {target}, {actions}), "specification");\n'
        for (mode, event), (kind, target, actions) in sorted(specified(root).items()))
