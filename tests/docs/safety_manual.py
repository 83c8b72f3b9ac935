#!/usr/bin/env python3
"""Holds docs/safety-manual.md to the project: every row of every table ends with requirements, hazards and evidence, each of which
exists; a hazard and a requirement of one row belong together; a measured figure stands, with its interval, in the document that the
cell links to, figures of other columns (WITH_FIGURES) in one that the evidence links to; and every hazard of docs/requirements has a row.

safety_manual.py ROOT        the manual of the project
safety_manual.py --self-test each rule refuses what breaks it
"""
import math
import pathlib
import re
import sys
import tempfile

MANUAL = "docs/safety-manual.md"
LINK_COLUMNS = ["requirements", "hazards", "evidence"]
WITH_FIGURES = ["where it is broken", "within", "limit", "open", "what there is"]  # columns whose figures the evidence holds
PARTS = "ACFIQKO"  # first letters of the row ids, in the order of the parts
EVIDENCE = re.compile(r"\[[^\]]*\]\(([^)#\s]*)(?:#([^)\s]+))?\)|`([^`]+)`(?: \((Coq|spin|defect|ctest|assure)\))?")
NUMBER = re.compile(r"(?<![\w.])\d{1,3}(?: \d{3})+(?![\d.])|(?<![\w.])\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w])")


def text_of(path):
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def all_below(folder, pattern):
    return "\n".join(text_of(f) for f in sorted(folder.rglob(pattern)))


def anchors_of(file):
    """As GitHub makes them, and those written by hand."""
    text = re.sub(r"^```.*?^```", "", text_of(file), flags=re.M | re.S)
    headings = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", h) for h in re.findall(r"^#+ (.+?)\s*$", text, re.M)]
    made = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}
    return made | set(re.findall(r'<a id="([^"]+)"', text))


def numbers_of(text):
    """(value, unit of its last digit) of every number; thousands may be parted by spaces."""
    for found in NUMBER.findall(text):
        plain = found.replace(" ", "")
        digits, _, power = plain.partition("e")
        places = len(digits.partition(".")[2])
        yield float(plain), 10.0 ** (int(power or 0) - places)


class Project:
    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.parents = {}
        for file in sorted((self.root / "docs/requirements").glob("*.sdoc")):
            for block in re.split(r"^\[(?=REQUIREMENT\]|HAZARD\])", text_of(file), flags=re.M)[1:]:
                uid = re.search(r"^UID: (\S+)", block, re.M)
                if uid:
                    self.parents[uid.group(1)] = set(re.findall(r"^  VALUE: (\S+)", block, re.M))
        theorems = re.findall(r"\b(?:Theorem|Lemma|Corollary)\s+(\w+)", all_below(self.root / "proofs", "*.v"))
        cmake = all_below(self.root / "cmake", "*.cmake")
        self.known = {
            "": set(text_of(self.root / "tests/inventory.txt").split()),
            "Coq": set(theorems),
            "spin": set(re.findall(r'"item (\w+) ', text_of(self.root / "model/check.sh"))),
            "assure": set(re.findall(r"^\s*item \w+ \w+ (\w+) ", text_of(self.root / "scripts/assure"), re.M)),
            "ctest": set(re.findall(r"(?:add_test\(NAME|plumb_compile_check\()\s*([\w.]+)", cmake)),
            "defect": {f.stem for f in (self.root / "tests/laws/defects").glob("*.defect")},
        }

    def ids(self, kind):
        return {uid for uid in self.parents if uid.startswith(kind)}

    def hazards_of(self, requirement):
        """The hazards above a requirement, directly or by way of other requirements."""
        seen, to_visit = set(), [requirement]
        while to_visit:
            for parent in self.parents.get(to_visit.pop(), ()):
                if parent not in seen:
                    seen.add(parent)
                    to_visit.append(parent)
        return {uid for uid in seen if uid.startswith("HAZ-")}

    def wrong_link(self, target, anchor):
        manual = self.root / MANUAL
        file = manual.parent / target if target else manual
        if not file.is_file():
            return f"links to {target}, which does not exist"
        if file.suffix != ".md":
            return None
        if not anchor:
            return f"links to {target} without a section"
        return None if anchor in anchors_of(file) else f"{target} has no section #{anchor}"


def tables_of(text):
    """(names of the columns, [(line number, cells)]) of each table."""
    header, rows = None, []
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.startswith("|"):
            cells = [c.strip() for c in line.strip().strip("|").split("|")]
            if header is None:
                header = cells
            elif not re.fullmatch(r"[\s|:-]+", line):
                rows.append((number, cells))
        elif header is not None:
            yield header, rows
            header, rows = None, []


def wrong_ids(project, cells):
    """Requirements and hazards of a row: there are some, they exist, and they belong together."""
    requirements, hazards = re.findall(r"REQ-\w+", cells[-3]), re.findall(r"HAZ-\w+", cells[-2])
    for kind, cell, found in (("REQ", cells[-3], requirements), ("HAZ", cells[-2], hazards)):
        if ", ".join(found) != cell or not found:
            yield f"{kind} ids are expected, separated by commas, and not {cell!r}"
        for uid in found:
            if uid not in project.parents:
                yield f"{uid} does not exist"
    known = [r for r in requirements if r in project.parents]
    for hazard in hazards:
        if known and hazard in project.parents and not any(hazard in project.hazards_of(r) for r in known):
            yield f"{hazard} is above no requirement of the row"
    for requirement in known:
        if hazards and not project.hazards_of(requirement) & set(hazards):
            yield f"{requirement} is below no hazard of the row"


def wrong_evidence(project, cell):
    """Evidence of a row: tests, theorems, items and links, each of which exists, and no other words."""
    found = list(EVIDENCE.finditer(cell))
    if not found:
        yield "names no evidence"
    if re.sub(r"[,\s]", "", EVIDENCE.sub("", cell)):
        yield f"evidence that is neither a name nor a link: {EVIDENCE.sub('', cell).strip(', ')!r}"
    for match in found:
        target, anchor, name, kind = match.groups()
        if name is None:
            wrong = project.wrong_link(target, anchor)
            if wrong:
                yield wrong
        elif name not in project.known[kind or ""]:
            yield f"no {kind or 'test'} {name}"


def figures_that_stand_nowhere(project, words, links):
    """Numbers that no linked document holds; one that is rounded may differ by less than one of its last digit."""
    there = [v for m in links for v, _ in numbers_of(text_of(project.root / "docs" / m.group(1)))]
    for value, unit in numbers_of(words):
        if not any(math.isclose(value, x, rel_tol=1e-12) or abs(x - value) < unit * (1 - 1e-9) for x in there):
            yield f"the figure {value:g} stands in no linked document"


def wrong_figures(project, cell):
    """A measured figure stands in the document that the cell links to; a rate has its interval or its bound."""
    if cell == "-":
        return
    links = [m for m in EVIDENCE.finditer(cell) if m.group(3) is None]
    words = EVIDENCE.sub("", cell)
    if not links:
        yield "a measured figure without the document that holds it"
        return
    for match in links:
        wrong = project.wrong_link(match.group(1), match.group(2))
        if wrong:
            yield wrong
            return
    yield from figures_that_stand_nowhere(project, words, links)
    if re.search(r"\bof\b|%", words) and not re.search(r"\[|97\.5 %|no interval", words):
        yield "a rate without its interval or bound"


def wrong_row(project, header, cells):
    if len(cells) != len(header):
        yield f"has {len(cells)} cells under {len(header)} columns"
        return
    if any(not cell for cell in cells):
        yield "has an empty cell"
    yield from wrong_ids(project, cells)
    yield from wrong_evidence(project, cells[-1])
    for name, cell in zip(header, cells):
        if name == "measured":
            yield from wrong_figures(project, cell)
        elif name in WITH_FIGURES:
            links = [m for m in EVIDENCE.finditer(cells[-1]) if m.group(3) is None]
            yield from figures_that_stand_nowhere(project, cell, links)


def check(root):
    """(what is wrong, how many rows were read)"""
    project, found, last, rows_read, named = Project(root), [], {}, 0, set()
    for header, rows in tables_of(text_of(project.root / MANUAL)):
        if header[-3:] != LINK_COLUMNS:
            found.append(f"{MANUAL}: the table of {header[0]!r} does not end with {', '.join(LINK_COLUMNS)}")
            continue
        for line, cells in rows:
            rows_read += 1
            part, number = cells[0][:1], cells[0][1:]
            if part not in PARTS or number != str(last.get(part, 0) + 1):
                found.append(f"{MANUAL}:{line}: {cells[0]!r} is not the next row id")
            last[part] = last.get(part, 0) + 1
            named |= set(re.findall(r"HAZ-\d+", cells[-2])) if len(cells) == len(header) else set()
            found += [f"{MANUAL}:{line}: {cells[0]}: {why}" for why in wrong_row(project, header, cells)]
    found += [f"{MANUAL}: part {part} has no row" for part in PARTS if part not in last]
    found += [f"{MANUAL}: {hazard} appears in no row" for hazard in sorted(project.ids("HAZ-") - named)]
    if not project.ids("HAZ-") or not project.ids("REQ-"):
        found.append("no requirements were read")
    return found, rows_read


SOUND = {
    "docs/requirements/hazards.sdoc": "[HAZARD]\nUID: HAZ-01\n\n[HAZARD]\nUID: HAZ-02\n\n[HAZARD]\nUID: HAZ-03\n",
    "docs/requirements/a.sdoc": "".join(
        f"[REQUIREMENT]\nUID: {uid}\nRELATIONS:\n- TYPE: Parent\n  VALUE: {parent}\n\n"
        for uid, parent in (("REQ-001", "HAZ-01"), ("REQ-002", "REQ-001"), ("REQ-003", "HAZ-02"), ("REQ-004", "HAZ-03"))),
    "docs/page.md": "# Page\n## A section\n0 of 12 345 cases, [0, 3.01e-4]; 97.5 %: <= 3e-4\n",
    "tests/inventory.txt": "Suite.Works\n",
    "proofs/a.v": "Theorem T1_holds : True.\n",
    "model/check.sh": '"item lockstep lockstep 4"\n',
    "scripts/assure": "item tested python depth \"title\"\n",
    "cmake/a.cmake": "add_test(NAME docs.a COMMAND x)\nplumb_compile_check(compile.b SOURCE c)\n",
    "tests/laws/defects/no_rule.defect": "x\n",
}
HEAD = "| id | measured | requirements | hazards | evidence |\n|---|---|---|---|---|\n"
FIGURE = "0 of 12 345 [0, 3.1e-4] ([page](page.md#a-section))"


def manual(row="", head=HEAD):
    """A manual with one row in each part; `row` takes the place of the first."""
    rows = [row or f"| A1 | {FIGURE} | REQ-001, REQ-002 | HAZ-01 | `Suite.Works`, [page](page.md#a-section) |"]
    more = ["`T1_holds` (Coq)", "`lockstep` (spin)", "`depth` (assure)", "`docs.a` (ctest), `compile.b` (ctest)",
            "`no_rule` (defect)", "[list](../tests/inventory.txt)"]
    for part, evidence in zip(PARTS[1:], more):
        uid, hazard = ("REQ-003", "HAZ-02") if part != "O" else ("REQ-004", "HAZ-03")
        rows.append(f"| {part}1 | - | {uid} | {hazard} | {evidence} |")
    return "# Manual\n\n" + head + "\n".join(rows) + "\n"


def broken_manuals():
    """(manual, what must be said of it): each breaks one rule."""
    def row(measured="-", requirements="REQ-001", hazards="HAZ-01", evidence="`Suite.Works`", uid="A1"):
        return manual(f"| {uid} | {measured} | {requirements} | {hazards} | {evidence} |")
    return [
        (row(requirements="-"), "REQ ids are expected"), (row(hazards="-"), "HAZ ids are expected"),
        (row(evidence="-"), "names no evidence"), (row(evidence="`Suite.Works` and trust"), "neither a name nor a link"),
        (row(requirements="REQ-009"), "REQ-009 does not exist"), (row(hazards="HAZ-01, HAZ-09"), "HAZ-09 does not exist"),
        (row(hazards="HAZ-01, HAZ-02"), "HAZ-02 is above no requirement"),
        (row(requirements="REQ-001, REQ-003"), "REQ-003 is below no hazard"),
        (row(evidence="`Suite.Imagined`"), "no test Suite.Imagined"), (row(evidence="`T9_no` (Coq)"), "no Coq T9_no"),
        (row(evidence="`other` (spin)"), "no spin other"), (row(evidence="`other` (assure)"), "no assure other"),
        (row(evidence="`other.b` (ctest)"), "no ctest other.b"), (row(evidence="`other` (defect)"), "no defect other"),
        (row(evidence="[p](gone.md#a)"), "gone.md, which does not exist"),
        (row(evidence="[p](page.md#gone)"), "no section #gone"), (row(evidence="[p](page.md)"), "without a section"),
        (row(measured="0 of 12 345 [0, 3.1e-4]"), "without the document"),
        (row(measured=FIGURE.replace("12 345", "12 346")), "the figure 12346 stands in no linked"),
        (row(measured=FIGURE.replace("3.1e-4", "2.1e-4")), "the figure 0.00021 stands in no linked"),
        (row(measured="0 of 12 345 ([page](page.md#a-section))"), "without its interval"),
        (row(measured=FIGURE.replace("#a-section", "#gone")), "no section #gone"),
        (manual("| A1 | 12 346 cases | REQ-001 | HAZ-01 | [p](page.md#a-section) |", HEAD.replace("measured", "open")),
         "the figure 12346 stands in no linked"),
        (row(uid="A2"), "'A2' is not the next row id"), (row(uid="X1"), "'X1' is not the next row id"),
        (row(measured=""), "has an empty cell"), (row(hazards="HAZ-01 | HAZ-01"), "cells under 5 columns"),
        (manual(head=HEAD.replace("evidence", "proof")), "does not end with requirements"),
        (manual().replace("| O1 | - | REQ-004 | HAZ-03 | [list](../tests/inventory.txt) |\n", ""), "part O has no row"),
        (manual().replace("REQ-004 | HAZ-03", "REQ-003 | HAZ-02"), "HAZ-03 appears in no row"),
        ("", "part A has no row"),
    ]


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in SOUND.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        page = root / MANUAL
        page.write_text(manual())
        assert check(root) == ([], len(PARTS)), check(root)
        broken = broken_manuals()
        for text, why in broken:
            page.write_text(text)
            found = check(root)[0]
            assert any(why in one for one in found), (why, text, found)
        page.write_text(manual())
        (root / "docs/requirements/a.sdoc").unlink()
        assert "no requirements were read" in check(root)[0]
    print(f"each of {len(broken) + 1} broken manuals is refused, the sound one passes")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) != 2:
        sys.exit("usage: safety_manual.py ROOT | --self-test")
    found, rows = check(sys.argv[1])
    for one in found:
        print(one)
    if found:
        sys.exit(f"{len(found)} faults in {MANUAL}")
    print(f"{rows} rows of {MANUAL}: every requirement, hazard and item of evidence exists")


main()
