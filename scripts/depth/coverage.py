"""Which branches and which conditions (MC/DC) of floors 1 to 4 the core's tests reach, against the list of those they do not.

Called by scripts/coverage with what llvm-cov exported.
"""
import argparse
import json
import pathlib
import sys
from collections import Counter, defaultdict

import reviewed

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = ROOT / "tests/coverage/justified.txt"
OPEN = ROOT / "tests/coverage/open.txt"
OPEN_SAYS = """# Branches and conditions of floors 1 to 4 that the core's tests do not reach yet, not judged yet: file | line | what.
# This list may only get shorter: reach them by a test, remove them, or move them to justified.txt with a reason.
# Written by scripts/coverage --open.
"""
KEYS = ("file", "line", "what", "reason")
CONDITION = 6  # the kind of a branch that is a condition of a decision


class Sources:
    """Quotes regions of files below the root."""

    def __init__(self):
        self.lines = {}

    def of(self, file):
        if file not in self.lines:
            self.lines[file] = (ROOT / file).read_text().split("\n")
        return self.lines[file]

    def name(self, file, region):
        """The trimmed line, and the region in words that stay true when lines above it change."""
        first, column, last, end = region
        lines = self.of(file)
        line = lines[first - 1]
        if first == last:
            text = line[column - 1:end - 1]
        else:
            text = " ".join([line[column - 1:], *lines[first:last - 1], lines[last - 1][:end - 1]])
        words = f"`{' '.join(text.split())}`"
        if first == last and line.count(text) > 1:
            words += f" at {line.count(text, 0, column - 1) + 1}"
        alike = [number for number, other in enumerate(lines, 1) if other.strip() == line.strip()]
        if len(alike) > 1:
            words += f" in line {alike.index(first) + 1} of {len(alike)}"
        return line.strip(), words


def room_of(path, rooms):
    """The room of a file of floors 1 to 4, else nothing."""
    try:
        parts = pathlib.Path(path).relative_to(ROOT).parts
    except ValueError:
        return None
    if parts[:2] == ("include", "plumb"):
        parts = parts[1:]
    elif parts[:1] != ("src",):
        return None
    return parts[1] if len(parts) > 2 and parts[1] in rooms else None


def gather(exports, rooms):
    """Per file: branch -> [taken, not taken], and condition -> whether it was seen to decide alone. A function that exists
    several times (a template, a header, one of several builds) has reached what any of them has."""
    branches, conditions = defaultdict(lambda: defaultdict(lambda: [0, 0])), defaultdict(dict)
    for path in exports:
        gather_build(json.loads(path.read_text()), rooms, branches, conditions)
    return branches, conditions


def gather_build(export, rooms, branches, conditions):
    whole = conditions_by_file(export)
    for function in export["data"][0]["functions"]:
        names = function["filenames"]
        here = defaultdict(list)
        for *region, taken, passed, file, _, kind in function["branches"]:
            if room_of(names[file], rooms) is None:
                continue
            found = branches[names[file]][tuple(region)]
            found[0] += taken
            found[1] += passed
            if kind == CONDITION:
                here[names[file]].append(tuple(region))
        for record in function["mcdc_records"]:
            first, column, last, end, file = record[:5]
            if room_of(names[file], rooms) is None:
                continue
            note_conditions(conditions[names[file]], (first, column, last, end), record[-1], whole[names[file]],
                            set(here[names[file]]))


def conditions_by_file(export):
    """All conditions of each file, those that the compiler folds among them."""
    return {entry["filename"]: sorted({tuple(b[:4]) for b in entry["branches"] if b[-1] == CONDITION})
            for entry in export["data"][0]["files"]}


def note_conditions(found, decision, seen, of_file, of_function):
    begin, end = decision[:2], decision[2:]
    inside = [c for c in of_file if begin <= c[:2] and c[2:] <= end]
    if len(inside) != len(seen):
        raise SystemExit(f"coverage: the decision at {decision} has {len(seen)} conditions, {len(inside)} were found")
    for condition, covered in zip(inside, seen):
        if condition in of_function:  # else folded: a constant of this build
            found[condition] = found.get(condition, False) or covered


def open_list():
    """What is open by the list, as it is written there."""
    return {text for text in OPEN.read_text().splitlines() if text and text[0] != "#"}


def entry(item):
    return " | ".join(item)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--open", action="store_true", help="write what is open to tests/coverage/open.txt")
    parser.add_argument("summary", type=pathlib.Path)
    parser.add_argument("--rooms", nargs="+", required=True)
    parser.add_argument("--exports", nargs="+", type=pathlib.Path, required=True, help="of llvm-cov, one a build")
    options = parser.parse_args()
    branches, conditions = gather(options.exports, options.rooms)
    sources, tally, open_items = Sources(), {room: Counter() for room in options.rooms}, {}
    for path in sorted(branches):
        file, room = str(pathlib.Path(path).relative_to(ROOT)), room_of(path, options.rooms)
        count = tally[room]
        for region in sorted(branches[path]):
            line, words = sources.name(file, region)
            sides = branches[path][region]
            decides = conditions[path].get(region)
            count.update(branches=2, reached=sum(side > 0 for side in sides))
            if decides is not None:
                count.update(conditions=1, shown=int(decides))
            for side, what in zip(sides, ("never true", "never false")):
                if side == 0:
                    open_items[file, line, f"{words} {what}"] = region[0]
            if all(sides) and decides is False:
                open_items[file, line, f"{words} never decides alone"] = region[0]

    listed = {tuple(e[k] for k in KEYS[:3]): e["reason"] for e in reviewed.entries(LIST, KEYS)}
    unjudged = {entry(item): number for item, number in open_items.items() if item not in listed}
    if options.open:
        OPEN.write_text(OPEN_SAYS + "".join(f"{text}\n" for text in sorted(unjudged)))
    known = open_list()
    wrong = [f"not reached, and not in a list: line {unjudged[text]}: {text}" for text in sorted(unjudged.keys() - known)]
    wrong += [f"listed as open, and reached or gone: {text}" for text in sorted(known - unjudged.keys())]
    wrong += [f"listed as justified, and reached or gone: {entry(item)}" for item in listed if item not in open_items]
    print("\n".join(wrong))
    whole = Counter()
    for room in options.rooms:
        c = tally[room]
        whole.update(c)
        print(f"{room:12} branches {c['reached']:5} of {c['branches']:5}   conditions {c['shown']:5} of {c['conditions']:5}")
    figure = (f"{whole['reached']} of {whole['branches']} branches, {whole['shown']} of {whole['conditions']} conditions, "
              f"{len(listed)} justified, {len(unjudged)} open")
    if not whole["branches"] or not whole["conditions"]:
        wrong.append("nothing was counted")
    options.summary.write_text(json.dumps({
        "schema": 1, "rooms": {room: dict(tally[room]) for room in options.rooms}, "holds": not wrong,
        "open": [{"file": f, "line": l, "what": w, "reason": listed.get((f, l, w))} for f, l, w in open_items]}, indent=1) + "\n")
    print(f"figure: {figure}")
    return not wrong


if __name__ == "__main__":
    sys.exit(0 if main() else 1)
