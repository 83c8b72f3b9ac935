#!/usr/bin/env python3
"""The programs of examples/ideas, one idea each, beside the pages that show them.

ideas.py ROOT        at most 25 lines each; what they print stands beside them; a page quotes them as they are, with all that
                     they print; docs/README.md and examples/README.md list each with its first line; no example includes a
                     header of a folder detail/
ideas.py --self-test each of these is found where it is broken
"""
import pathlib
import re
import sys
import tempfile

MOST_LINES, LEAST_PROGRAMS = 25, 20
SUFFIXES = {".c": "c", ".cpp": "cpp", ".py": "python"}
INDEXES = ("docs/README.md", "examples/README.md")
# A link to the program, what is said about it, its lines, and after a word or two what it prints.
QUOTE = re.compile(r"\(\.\./examples/ideas/(\w+\.(?:cpp|c|py))\)[^`]*?\n```(\w+)\n(.*?)^```$(?:\n+prints\n+```\n(.*?)^```$)?",
                   re.S | re.M)


def idea_of(text):
    """What the first line says, without the marks of a comment."""
    return re.sub(r'^(//|/\*|""")\s*|\s*(\*/|""")$', "", text.splitlines()[0])


def wrong_quotes(root, programs):
    """Quotes that differ from their program, and programs that no page quotes."""
    quoted = set()
    for page in sorted((root / "docs").glob("*.md")):
        for name, language, lines, printed in QUOTE.findall(page.read_text(encoding="utf-8")):
            if name not in programs:
                yield f"{page.name}: quotes {name}, which does not exist"
                continue
            file = root / "examples/ideas" / name
            if language != SUFFIXES[file.suffix] or lines.count("\n") < 2 or "\n" + lines not in "\n" + programs[name]:
                yield f"{page.name}: {name} has no such lines in a row"
            elif printed != file.with_suffix(".out").read_text(encoding="utf-8"):
                yield f"{page.name}: {name} does not print that"
            quoted.add(name)
    yield from (f"{name}: no page quotes it" for name in sorted(set(programs) - quoted))


def wrong(root):
    folder = root / "examples/ideas"
    programs = {f.name: f.read_text(encoding="utf-8") for f in sorted(folder.iterdir()) if f.suffix in SUFFIXES}
    if len(programs) < LEAST_PROGRAMS:
        yield f"only {len(programs)} programs"
    for name, text in programs.items():
        if text.count("\n") > MOST_LINES:
            yield f"{name}: {text.count(chr(10))} lines, {MOST_LINES} at most"
        out = (folder / name).with_suffix(".out")
        if not out.is_file() or not out.read_text(encoding="utf-8").strip():
            yield f"{name}: what it prints does not stand beside it"
            return
        for index in INDEXES:
            if not any(f"ideas/{name})" in line and idea_of(text) in line
                       for line in (root / index).read_text(encoding="utf-8").splitlines()):
                yield f"{index} does not list {name} with its first line"
    yield from (f"{f.name}: prints of no program" for f in sorted(folder.glob("*.out"))
                if not any(f.with_suffix(s).name in programs for s in SUFFIXES))
    for file in sorted((root / "examples").rglob("*")):
        if file.suffix in (".c", ".cpp", ".h", ".hpp") and "/detail/" in file.read_text(encoding="utf-8"):
            yield f"{file.name}: includes a header that is no interface"
    yield from wrong_quotes(root, programs)


def self_test():
    """A small project that is sound, and then broken in every way."""
    page = "[a0](../examples/ideas/a0.cpp): An idea.\n\n```cpp\nint a;\nint b;\n```\n\nprints\n\n```\n1\n```\n"
    breaks = {
        "lines": ("examples/ideas/a0.cpp", "int b;", "int b;" + "\n" * 30), "beside": ("examples/ideas/a0.out", "1\n", ""),
        "in a row": ("docs/page.md", "int a;", "int aa;"), "does not print": ("docs/page.md", "\n1\n", "\n2\n"),
        "no page": ("docs/page.md", "a0.cpp)", "a1.cpp)"), "not exist": ("docs/page.md", "a0.cpp)", "b.cpp)"),
        "does not list": ("docs/README.md", "| An idea. 0", "| An"), "only": ("examples/ideas/a0.cpp", None, None),
        "of no program": ("examples/ideas/b.out", "", "1\n"),
        "no interface": ("examples/embed/b.cpp", "", '#include "plumb/core/detail/flag.hpp"\n')}
    for expected, change in [(None, None), *breaks.items()]:
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            (root / "examples/ideas").mkdir(parents=True)
            (root / "docs").mkdir()
            pages, index = "", ""
            for i in range(LEAST_PROGRAMS):
                (root / f"examples/ideas/a{i}.cpp").write_text(f"// An idea. {i}\nint a;\nint b;\n")
                (root / f"examples/ideas/a{i}.out").write_text("1\n")
                pages += page.replace("a0", f"a{i}")
                index += f"| [a{i}](ideas/a{i}.cpp) | An idea. {i} |\n"
            (root / "docs/page.md").write_text(pages)
            for readme in INDEXES:
                (root / readme).write_text(index)
            if change:
                file, old, new = root / change[0], change[1], change[2]
                if old is None:
                    file.unlink()
                else:
                    file.parent.mkdir(exist_ok=True)
                    file.write_text(file.read_text().replace(old, new, 1) if file.is_file() else new)
            found = list(wrong(root))
            assert bool(found) == bool(change) and (not change or any(expected in one for one in found)), (expected, found)
    print(f"each of {len(breaks)} breaks is found, a sound project passes")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) != 2:
        sys.exit("usage: ideas.py ROOT | --self-test")
    found = list(wrong(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "every program is short, quoted as it is, and listed")
    sys.exit(bool(found))


main()
