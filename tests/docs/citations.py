#!/usr/bin/env python3
"""Resolves every citation in comments: `docs/NAME.md`, with a section or a "heading"; theorems T1, T2 ...; equations of the
paper; requirement ids. What is cited must exist, and nothing may be cited that is not in the project. The links of the pages
among one another lead somewhere, too.

citations.py ROOT        every file of the folders below
citations.py --self-test each rule finds what it is for
"""
import pathlib
import re
import sys
import tempfile

FOLDERS = ("include", "src", "tests", "bench", "proofs", "model", "fuzz", "examples", "baremetal")
SUFFIXES = {".hpp", ".cpp", ".h", ".c", ".v", ".g", ".smt2", ".pml", ".txt", ".defect"}
STRICT = ("include", "src")  # theorems, equations and requirements: elsewhere tests make up their own
EQUATIONS = 29
EVERYWHERE_GONE = [
    (r"\bdesign(,| \()\s*section\b", "cites a design that the project does not hold"),
    (r"\b(safety|isolation|calibration|domain|limits|motion|paper)('s)? notes?\b", "cites a note that the project does not hold"),
    (r"\bnotes? \d+\b", "cites a numbered note"),
]
COMMENT = re.compile(r"^\s*(?:///?<?|\*|#|;|\(\*)\s?(.*)$|(?://+<?|/\*|\(\*)\s?(.*)$")
EQUATION = re.compile(r"\beqs?\.? (\(?\d+\)?(?:(?:-|, | and )\(?\d+\)?)*)", re.I)


def comments(text):
    """(line number, text) of each run of comment lines, joined: a citation may be broken over two."""
    block, start = [], 0
    for number, line in enumerate(text.splitlines(), 1):
        found = COMMENT.search(line)
        alone = bool(found and found.group(1) is not None)
        if block and not alone:
            yield start, " ".join(block)
            block = []
        if found:
            said = found.group(1) if alone else found.group(2)
            if not block:
                start = number
            block.append(said.strip())
            if not alone:
                yield start, " ".join(block)
                block = []
    if block:
        yield start, " ".join(block)


class House:
    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.headings = {}
        self.theorems = set(re.findall(r"^### T(\d+)\. ", self.page("docs/theory.md") or "", re.M))
        ids = (self.root / "docs/requirements").glob("*.sdoc")
        self.requirements = {i for f in ids for i in re.findall(r"^UID: (REQ-\d+)", f.read_text(), re.M)}

    def page(self, path):
        file = self.root / path
        return file.read_text(encoding="utf-8") if file.is_file() else None

    def headings_of(self, path):
        if path not in self.headings:
            text = self.page(path)
            self.headings[path] = None if text is None else re.findall(r"^#+ (.+?)\s*$", text, re.M)
        return self.headings[path]

    def wrong_pages(self, text):
        for path, section, heading in re.findall(
                r"(docs/[\w/-]+\.md)(?:,? sections? (\d+(?:\.\d+)?)|, \"([^\"]+)\")?", text):
            there = self.headings_of(path)
            if there is None:
                yield f"{path} does not exist"
            elif section and not any(re.match(re.escape(section) + r"\.? ", h) for h in there):
                yield f"{path} has no section {section}"
            elif heading and heading not in there:
                yield f'{path} has no heading "{heading}"'

    def wrong_names(self, text):
        for number in re.findall(r"\bT(\d{1,2})\b", text):
            if number not in self.theorems:
                yield f"docs/theory.md has no theorem T{number}"
        for numbers in EQUATION.findall(text):
            for number in re.findall(r"\d+", numbers):
                if not 1 <= int(number) <= EQUATIONS:
                    yield f"the paper has no eq ({number})"
        for name in re.findall(r"\bREQ-\d+\b", text):
            if name not in self.requirements:
                yield f"no requirement {name}"

    def wrong(self, folder, text):
        for pattern, why in EVERYWHERE_GONE:
            if re.search(pattern, text, re.I):
                yield why
        yield from self.wrong_pages(text)
        if folder in STRICT:
            yield from self.wrong_names(text)

    def wrong_proofs(self):
        """What docs/theory.md says that a machine proved stands in the proofs."""
        proofs = "\n".join(f.read_text(encoding="utf-8") for f in sorted((self.root / "proofs").rglob("*.v")))
        known = set(re.findall(r"\b(?:Theorem|Lemma|Corollary|Remark|Fact|Definition)\s+(\w+)", proofs))
        for name in re.findall(r"`([TLR]\d+_\w+)`", self.page("docs/theory.md") or ""):
            if name not in known:
                yield f"docs/theory.md: no theorem {name} in proofs/"

    def anchors_of(self, file):
        """As GitHub makes them: in small letters, without marks, spaces as hyphens; and those written by hand."""
        text = re.sub(r"^```.*?^```", "", file.read_text(encoding="utf-8"), flags=re.M | re.S)
        headings = re.findall(r"^#+ (.+?)\s*$", text, re.M)
        plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", h) for h in headings]
        made = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in plain}
        return made | set(re.findall(r'<a id="([^"]+)"', text))

    def wrong_links(self):
        """Links from one page to another, or to a heading of it, lead somewhere."""
        pages = [self.root / name for name in ("README.md", "CONTRIBUTING.md")] + sorted((self.root / "docs").rglob("*.md"))
        for page in (p for p in pages if p.is_file()):
            text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
            for target, anchor in re.findall(r"\]\(([^)#\s:]*)(?:#([^)\s]+))?\)", text):
                file = page.parent / target if target else page
                if not file.exists():
                    yield f"{page.relative_to(self.root)}: links to {target}, which does not exist"
                elif anchor and file.suffix == ".md" and anchor not in self.anchors_of(file):
                    yield f"{page.relative_to(self.root)}: {target or 'itself'} has no anchor #{anchor}"

    def check(self):
        """(what is wrong, how many citations of sections and theorems were met)"""
        found, met = list(self.wrong_proofs()) + list(self.wrong_links()), 0
        for folder in FOLDERS:
            for file in sorted((self.root / folder).rglob("*")):
                if file.suffix not in SUFFIXES or not file.is_file():
                    continue
                for line, text in comments(file.read_text(encoding="utf-8", errors="replace")):
                    met += len(re.findall(r"docs/theory\.md", text)) + (
                        len(re.findall(r"\bT\d{1,2}\b", text)) if folder in STRICT else 0)
                    found += [f"{file.relative_to(self.root)}:{line}: {why}" for why in self.wrong(folder, text)]
        return found, met


def self_test():
    """A small project in which each rule is broken once, beside one in which none is."""
    sound = ["/// By theorem T1 (docs/theory.md, section 1.2), eqs (26)-(29), REQ-001;", "/// docs/theory.md, section\n/// 1.",
             '/// Contract: docs/theory.md, "1. Words".', "int t = 0;  ///< as T1 has it", "constexpr int T9 = 3;"]
    broken = {
        "/// (design, section 5)": "design", "/// as the design (section\n/// 4) has it": "design",
        "/// Safety note 12: so.": "note", "/// (isolation\n/// note, bar 13)": "note", "// see notes 1 and 10": "numbered note",
        "/// docs/gone.md says so": "does not exist", "/// docs/theory.md, section 1.9": "no section 1.9",
        "/// docs/theory.md,\n/// section 12": "no section 12", '/// docs/theory.md, "Gone"': "no heading",
        "/// by theorem T2": "no theorem T2", "int a = 0;  ///< T3": "no theorem T3", "/// eq (30)": "no eq (30)",
        "/// eqs (1), (2) and (31)": "no eq (31)", "// REQ-002": "no requirement REQ-002"}
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("docs/requirements", "include", "proofs"):
            (root / name).mkdir(parents=True)
        theory = "# Theory\n## 1. Words\n### 1.2 More\n### T1. Mirror\n`T1_proved`\n"
        (root / "docs/theory.md").write_text(theory)
        (root / "docs/requirements/a.sdoc").write_text("UID: REQ-001\n")
        (root / "proofs/a.v").write_text("Theorem T1_proved : True.\n")
        code = root / "include/a.hpp"
        for text in sound:
            code.write_text(text + "\n")
            assert House(root).check()[0] == [], (text, House(root).check()[0])
        for text, why in broken.items():
            code.write_text("int before = 0;\n" + text + "\nint after = 0;\n")
            found = House(root).check()[0]
            assert found and all(why in one for one in found), (text, found)
        code.write_text("")
        (root / "docs/theory.md").write_text(theory + "`T1_imagined`\n")
        assert ["T1_imagined" in one for one in House(root).check()[0]] == [True]
        for link, why in {"gone.md": "does not exist", "#13-gone": "no anchor", "theory.md#gone": "no anchor"}.items():
            (root / "docs/theory.md").write_text(theory + f"[sound](theory.md#12-more) [broken]({link})\n")
            assert [why in one for one in House(root).check()[0]] == [True], link
    print(f"each of {len(broken) + 4} broken citations is found, {len(sound)} sound ones pass")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) != 2:
        sys.exit("usage: citations.py ROOT | --self-test")
    found, met = House(sys.argv[1]).check()
    for one in found:
        print(one)
    if met < 50:  # else the reader of comments sees none
        sys.exit(f"only {met} citations of docs/theory.md and its theorems were met")
    if found:
        sys.exit(f"{len(found)} citations lead nowhere")
    print(f"{met} citations of docs/theory.md and its theorems, all resolved")


main()
