"""Where a source file can be wrong in a small way: mutants from its syntax tree (libclang 19)."""
import hashlib
from dataclasses import dataclass

from clang.cindex import CursorKind, Index, TokenKind

RELATIONAL = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
}
OTHERS = {
    "&&": ("||",), "||": ("&&",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",),
    "&": ("|",), "|": ("&",),
    "+=": ("-=",), "-=": ("+=",), "|=": ("&=",), "&=": ("|=",),
}
SETS = {"operator|": ("&",), "operator&": ("|",), "operator-": ("|", "&"), "operator==": ("!=",), "operator!=": ("==",)}
STEPS = {"++": "--", "--": "++"}
FUNCTIONS = {CursorKind.FUNCTION_DECL, CursorKind.FUNCTION_TEMPLATE, CursorKind.CXX_METHOD, CursorKind.CONSTRUCTOR}
LEAVES = {CursorKind.RETURN_STMT, CursorKind.BREAK_STMT, CursorKind.CONTINUE_STMT}


@dataclass(frozen=True)
class Mutant:
    """One text put in the place of another."""
    file: str        # below the root
    begin: int       # in bytes
    end: int
    text: str        # what is put there
    operator: str    # relational, logical, condition, constant, deletion, cell
    number: int      # line, from 1
    line: str        # the source line, trimmed
    change: str      # in words: `old` -> `new`, with its place in the line where it stands there more than once
    function: str    # in which it stands; with the line's place where that stands there more than once

    @property
    def identity(self):
        return "|".join((self.file, self.function, self.line, self.change))

    @property
    def key(self):
        """Short, for names of files."""
        return hashlib.sha256(self.identity.encode()).hexdigest()[:16]

    def apply(self, source):
        return source[:self.begin] + self.text.encode() + source[self.end:]


class Finder:
    """All mutants of one file."""

    def __init__(self, root, file, arguments, functions=None):
        self.root, self.file = root, file
        self.source = (root / file).read_bytes()
        self.lines = self.source.split(b"\n")
        self.functions = functions  # None: all of the file
        self.found = {}
        unit = Index.create().parse(str(root / file), args=arguments)
        errors = [d for d in unit.diagnostics if d.severity >= 3]
        if errors:
            raise SystemExit(f"mutants: {file} cannot be read: {errors[0]}")
        self.unit = unit

    def all(self):
        top = self.unit.cursor
        self.tokens = [t for t in self.unit.get_tokens(extent=top.extent) if t.kind != TokenKind.COMMENT]
        self.function, self.function_begin = "", 0
        self.visit(top, False)
        return sorted(self.found.values(), key=lambda m: (m.begin, m.end, m.text))

    # --- the walk ------------------------------------------------------------------------------------------------
    def visit(self, node, inside):
        for child in node.get_children():
            if child.location.file is not None and child.location.file.name != str(self.root / self.file):
                continue
            within = inside
            if child.kind in FUNCTIONS and not inside:
                within = self.functions is None or child.spelling in self.functions
            elif child.kind == CursorKind.VAR_DECL and not inside and self.functions is None:
                within = True  # a named constant
            if not inside and (child.kind in FUNCTIONS or child.kind == CursorKind.VAR_DECL):
                self.function, self.function_begin = child.spelling, child.extent.start.offset
            if child.kind in (CursorKind.STATIC_ASSERT, CursorKind.ENUM_DECL):
                continue
            if within:
                self.mutate(child)
                self.delete_statements(child)
            self.visit(child, within)

    def mutate(self, node):
        kind = node.kind
        if kind in (CursorKind.BINARY_OPERATOR, CursorKind.COMPOUND_ASSIGNMENT_OPERATOR):
            self.operator(node, {**RELATIONAL, **OTHERS})
        elif kind == CursorKind.CALL_EXPR and node.spelling in SETS:
            self.operator(node, {node.spelling[len("operator"):]: SETS[node.spelling]})
        elif kind == CursorKind.UNARY_OPERATOR:
            self.steps(node)
        elif kind in (CursorKind.INTEGER_LITERAL, CursorKind.FLOATING_LITERAL):
            old = self.text(*self.range(node))
            if old:
                self.add(node, f"({old} + 1)", "constant")
                self.add(node, f"({old} - 1)", "constant")
        elif kind == CursorKind.CXX_BOOL_LITERAL_EXPR:
            self.add(node, "false" if self.text(*self.range(node)) == "true" else "true", "constant")
        elif kind in (CursorKind.IF_STMT, CursorKind.CONDITIONAL_OPERATOR):
            self.condition(node)

    def operator(self, node, table):
        parts = list(node.get_children())
        if len(parts) < 2:
            return
        after, before = parts[0].extent.end.offset, parts[-1].extent.start.offset
        for token in self.tokens:
            at = token.extent.start.offset
            if after <= at < before and token.spelling in table:
                kind = ("logical" if token.spelling in ("&&", "||") else
                        "relational" if token.spelling in RELATIONAL else "arithmetic")
                for new in table[token.spelling]:
                    self.add_range(at, token.extent.end.offset, new, kind)
                return

    def steps(self, node):
        begin, end = self.range(node)
        text = self.text(begin, end)
        for old, new in STEPS.items():
            if text.startswith(old):
                self.add_range(begin, begin + 2, new, "arithmetic")
            elif text.endswith(old):
                self.add_range(end - 2, end, new, "arithmetic")

    def condition(self, node):
        parts = list(node.get_children())
        if not parts or not parts[0].kind.is_expression():
            return
        if self.text(*self.range(node)).startswith("if constexpr"):
            return
        old = self.text(*self.range(parts[0]))
        for new in (f"!({old})", "true", "false"):
            self.add(parts[0], new, "condition")

    def delete_statements(self, node):
        if node.kind not in (CursorKind.COMPOUND_STMT, CursorKind.IF_STMT, CursorKind.FOR_STMT):
            return
        parts = list(node.get_children())
        if node.kind == CursorKind.IF_STMT:
            parts = parts[1:]
        elif node.kind == CursorKind.FOR_STMT:
            parts = parts[-1:]
        for part in parts:
            if part.kind.is_expression() or (part.kind in LEAVES and node.kind == CursorKind.IF_STMT):
                self.add(part, "", "deletion")

    # --- the harvest -----------------------------------------------------------------------------------------------
    @staticmethod
    def range(node):
        return node.extent.start.offset, node.extent.end.offset

    def text(self, begin, end):
        return self.source[begin:end].decode()

    def add(self, node, new, operator):
        self.add_range(*self.range(node), new, operator)

    def add_range(self, begin, end, new, operator):
        old = self.text(begin, end)
        if not old or old == new or (begin, end, new) in self.found:
            return
        number = self.source.count(b"\n", 0, begin) + 1
        line = self.lines[number - 1]
        column = begin - (self.source.rfind(b"\n", 0, begin) + 1)
        shown = " ".join(old.split())
        change = f"`{shown}` -> `{' '.join(new.split())}`" if new else f"`{shown}` left out"
        if line.count(old.encode()) > 1:
            change += f" at {line.count(old.encode(), 0, column) + 1}"
        start = self.source.count(b"\n", 0, self.function_begin)
        before = [text.strip() for text in self.lines[start:number - 1]].count(line.strip())
        function = self.function + (f" ({before + 1})" if before else "")
        self.found[begin, end, new] = Mutant(
            self.file, begin, end, new, operator, number, line.decode().strip(), change, function)


def sources(root, arguments):
    """The decision code and the isolation rule: of `diagnosis.cpp` what turns answers at several attitudes into isolated sensors."""
    header = ["-x", "c++", *arguments]
    sources = {
        "src/health/decision.cpp": None,
        "src/health/serve_event.cpp": None,
        "src/health/diagnosis.cpp": {"vote", "is_vote_due", "suspect", "isolated_by_scatter", "note_suspicion",
                                     "isolated", "corroborating"},
        "src/detection/isolation.cpp": None,
        "src/detection/norm_mismatch_doubt.cpp": None,
        "include/plumb/health/detail/decision.hpp": {"decide"},
        "include/plumb/health/transition_table.hpp": {"bit", "first_taken", "mode_by_size", "resolve"},
        "include/plumb/detection/isolation.hpp": {"is_rejected", "reject"},
        "include/plumb/detection/detail/norm_mismatch_doubt.hpp": {"index_of", "refuted"},
    }
    out = []
    for file, functions in sources.items():
        out += Finder(root, file, header if file.endswith(".hpp") else arguments, functions).all()
    return out
