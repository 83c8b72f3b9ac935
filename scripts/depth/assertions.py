#!/usr/bin/env python3
"""assertions.py [--self-test]: the tests that cannot fail, because they assert nothing, or only under a condition.

Nothing: neither itself nor by a helper. A helper counts where it returns nothing (`void expect_kept(...)`): one that
returns a value makes something, and that a tool or a file could be made says nothing about what is tested. A helper that
does both is named in tests/assertions/justified.txt ("helper NAME"), as is a test that is right as it is.
Under a condition: every assertion stands in an `if` without an `else` that asserts too, or behind an early return; what the
condition is nobody asks. Loops are taken to run. A law discards by RC_PRE, which counts, and not by a return.
Exit 1 where a test is found that is not justified, or an entry no longer applies."""
import pathlib
import re
import sys

import reviewed

TEST = re.compile(r"^\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST|TYPED_TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\s*\(", re.M)
ASSERTION = re.compile(r"\b(?:(?:EXPECT|ASSERT)_(?!NO_FATAL_FAILURE)[A-Z]\w*|RC_ASSERT\w*|RC_FAIL|FAIL|ADD_FAILURE(?:_AT)?|"
                       r"GTEST_FAIL|static_assert)\s*\(")
NOTHING = re.compile(r"\b(?:EXPECT|ASSERT)_TRUE\s*\(\s*true\s*\)|\b(?:EXPECT|ASSERT)_FALSE\s*\(\s*false\s*\)")
CALL = re.compile(r"\b([A-Za-z_]\w*)\s*(?:<[^<>;(){}]*>)?\s*\(")
WORDS = {"if", "for", "while", "switch", "catch", "return", "sizeof", "alignof", "decltype", "noexcept", "static_cast"}
SKIPPED = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)|(?P<raw>\bu?8?R"(?P<mark>[^ ()\\\n]*)\(.*?\)(?P=mark)")|"""
    r"""(?P<text>"(?:[^"\\\n]|\\.)*")|(?P<number>\b\d[\w'.]*)|(?P<char>'(?:[^'\\\n]|\\.)+')|(?P<hash>^[ \t]*\#(?:[^\n\\]|\\.|\\\n)*)""",
    re.S | re.M | re.X)


def bare(text):
    """The text without comments, strings and directives, every character in its place."""
    def blank(match):
        if match.lastgroup == "number":
            return match.group().replace("'", "0")
        kept = '""' if match.lastgroup in ("raw", "text", "mark") else ""
        return kept + re.sub(r"[^\n]", " ", match.group())[len(kept):]
    return SKIPPED.sub(blank, text)


def closing(text, at):
    """The place of the bracket that closes the one at `at`."""
    depth = 0
    for match in re.finditer(r"[(){}\[\]]", text[at:]):
        depth += 1 if match.group() in "({[" else -1
        if depth == 0:
            return at + match.start()
    return len(text)


HEAD = re.compile(r"\s*(?:const\b|noexcept\b|override\b|final\b|mutable\b|->\s*[\w:<>,&*\s]+?)*\s*(?=[{:])")


class Function:
    def __init__(self, name, gives_nothing, body):
        self.name, self.gives_nothing, self.body = name, gives_nothing, body


class Test:
    def __init__(self, name, line, body):
        self.name, self.line, self.body = name, line, body


class Source:
    """One file: its tests, the functions that it defines, and what it includes."""

    def __init__(self, path, text):
        self.path, self.tests, self.functions = path, [], []
        self.includes = re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.M)
        code = bare(text)
        for match in TEST.finditer(code):
            open_bracket = match.end() - 1
            close = closing(code, open_bracket)
            name = ".".join(part.strip() for part in code[open_bracket + 1:close].split(",")[:2])
            begin = code.find("{", close)
            self.tests.append(Test(name, code.count("\n", 0, open_bracket) + 1, code[begin:closing(code, begin) + 1]))
        for match in CALL.finditer(code):
            if match.group(1) in WORDS or match.group(1).isupper():
                continue
            close = closing(code, match.end() - 1)
            head = HEAD.match(code, close + 1)
            if head is None:
                continue
            begin = head.end()
            if code[begin] == ":":  # a constructor makes something
                continue
            before = code[max(0, match.start() - 200):match.start()]
            nothing = re.search(r"\bvoid\s+(?:\w+::)*$", before) is not None
            self.functions.append(Function(match.group(1), nothing, code[begin:closing(code, begin) + 1]))


def load(root, folders, suffixes):
    return {path: Source(path, path.read_text()) for folder in folders for path in sorted((root / folder).rglob("*"))
            if path.suffix in suffixes and path.is_file()}


def reach(root, sources, source):
    """The file and everything that it includes, as far as it was read."""
    seen, left = [], [source.path]
    while left:
        path = left.pop()
        if path in seen or path not in sources:
            continue
        seen.append(path)
        for name in sources[path].includes:
            left += [base / name for base in (path.parent, root / "tests", root / "include", root / "examples")]
    return [sources[path] for path in seen]


def asserts(body):
    return ASSERTION.search(NOTHING.sub("", body)) is not None


def asserting_helpers(files, named):
    """Names of the functions that assert, by themselves or by others of them."""
    functions = [f for file in files for f in file.functions if f.gives_nothing or f.name in named]
    names = set()
    while True:
        more = {f.name for f in functions
                if f.name not in names and (asserts(f.body) or any(n in names for n in CALL.findall(f.body)))}
        if not more:
            return names
        names |= more


LAMBDA = re.compile(r"\[[^\[\]]*\]\s*(?:\([^{};]*\))?\s*(?:mutable\b|noexcept\b|->\s*[\w:<>&*]+)?\s*(?=\{)")


def places_of_lambdas(text):
    """Where the bodies of the outermost ones begin and end."""
    at, out = 0, []
    for match in LAMBDA.finditer(text):
        if match.start() >= at:
            at = closing(text, match.end()) + 1
            out.append((match.end(), at))
    return out


def lambdas(text):
    return [text[begin:end] for begin, end in places_of_lambdas(text)]


def without_lambdas(text):
    for begin, end in reversed(places_of_lambdas(text)):
        text = text[:begin] + "{}" + text[end:]
    return text


# ---- How surely an assertion is reached: 2 in any case, 1 under a condition, 0 not at all. ---------------------------

class Reached:
    def __init__(self, helpers):
        self.helpers = helpers

    def plain(self, text):
        return 2 if asserts(text) or any(n in self.helpers for n in CALL.findall(text)) else 0

    def block(self, text):
        """Of the statements between two braces."""
        at, best, surely = 1, 0, True
        while at < len(text) - 1:
            at, value, leaves = self.statement(text, at)
            best = max(best, value if surely else min(value, 1))
            surely = surely and not leaves
        return best

    def statement(self, text, at):
        """Where it ends, how surely it asserts, and whether what follows it may be left out."""
        at += len(text[at:]) - len(text[at:].lstrip())
        if at >= len(text) - 1:
            return len(text), 0, False
        if text[at] == "{":
            end = closing(text, at)
            return end + 1, self.block(text[at:end + 1]), False
        word = re.match(r"(if\s+constexpr|if|for|while|switch|else|do)\b\s*", text[at:])
        if word is None:
            end = at  # to the next semicolon that is in no bracket
            while end < len(text) and text[end] not in ";}":
                end = (closing(text, end) if text[end] in "([{" else end) + 1
            return end + 1, self.expression(text[at:end]), False
        if word.group(1) in ("else", "do"):
            return self.statement(text, at + word.end())
        close = closing(text, at + word.end())
        asked = self.plain(text[at + word.end():close + 1])
        end, value, _ = self.statement(text, close + 1)
        leaves = False
        if word.group(1) == "if":
            inner = without_lambdas(text[close + 1:end])
            leaves = value < 2 and re.search(r"\breturn\b", inner) is not None and "GTEST_SKIP" not in inner
            other = 0
            if re.match(r"\s*else\b", text[end:]):
                end, other, _ = self.statement(text, end)
            value = 2 if value == other == 2 else min(max(value, other), 1)
        return end, max(value, asked), leaves

    def expression(self, text):
        """The bodies of lambdas are blocks of their own."""
        return max([self.plain(without_lambdas(text)), *(self.block(body) for body in lambdas(text))])


class Found:
    """What was found in all sources: the tests without an assertion, those with none but under a condition."""

    def __init__(self, root, sources, named):
        self.tests, self.without, self.conditional, self.used = 0, [], [], set()
        for source in sources.values():
            if not source.tests:
                continue
            files = reach(root, sources, source)
            helpers, void_ones = asserting_helpers(files, named), asserting_helpers(files, ())
            for test in source.tests:
                self.tests += 1
                where = f"{source.path.relative_to(root)}:{test.line}"
                reached = Reached(helpers)
                if reached.plain(test.body) == 0:
                    self.without.append((where, test.name))
                elif reached.block(test.body) < 2:
                    self.conditional.append((where, test.name))
                if Reached(void_ones).plain(test.body) == 0:
                    self.used |= {n for n in CALL.findall(test.body) if n in helpers}


def judge(root, folders, justified, suffixes=(".cpp", ".hpp", ".h")):
    """The findings that nobody has justified, and the entries that no longer apply; and the figure."""
    listed = {e["test"] for e in reviewed.entries(justified, ("test", "reason"))}
    helpers = {name.removeprefix("helper ") for name in listed if name.startswith("helper ")}
    found = Found(root, load(root, folders, suffixes), helpers)
    findings = [(where, name, "asserts nothing") for where, name in found.without]
    findings += [(where, name, "every assertion stands under a condition") for where, name in found.conditional]
    out = [f"{where}: {name}: {what}" for where, name, what in findings if name not in listed]
    applies = {name for _, name, _ in findings} | {"helper " + name for name in found.used}
    out += [f"{justified.name}: {name} asserts something, or is gone" for name in sorted(listed - applies)]
    return out, f"{found.tests} tests, {len(listed)} justified, {len(out)} findings"


def self_test(root):
    """tests/assertions/examples says in the line above each of its tests what must be said of it."""
    folder = root / "tests/assertions/examples"
    path = folder / "tests.txt"
    lines = path.read_text().splitlines()
    wanted = {f"{path.relative_to(root)}:{test.line}: {test.name}: {lines[test.line - 2].removeprefix('// found: ')}"
              for test in Source(path, path.read_text()).tests if lines[test.line - 2].startswith("// found: ")}
    wanted.add("justified.txt: Example.IsGone asserts something, or is gone")
    got = set(judge(root, (folder.relative_to(root),), folder / "justified.txt", (".txt",))[0])
    for text in sorted(wanted ^ got):
        print(f"{text}: {'not found' if text in wanted else 'found, and should not be'}")
    print(f"figure: {len(wanted & got)} of {len(wanted)} planted findings")
    return 0 if len(wanted) > 5 and wanted == got else 1


if __name__ == "__main__":
    home = pathlib.Path(__file__).resolve().parents[2]
    if sys.argv[1:] == ["--self-test"]:
        sys.exit(self_test(home))
    if sys.argv[1:]:
        sys.exit(__doc__.splitlines()[0])
    lines, figure = judge(home, ("tests", "examples", "include/plumb/testing"), home / "tests/assertions/justified.txt")
    for text in lines:
        print(text)
    print(f"figure: {figure}")
    sys.exit(1 if lines else 0)
