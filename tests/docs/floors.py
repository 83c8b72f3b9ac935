"""Who includes whom: every room of src/ and include/plumb/ keeps to the floors of the table in CONTRIBUTING.md, and no circle
arises on one floor. An instrument's part (baremetal/ too) knows nothing of the paper's algorithm. What the tool's commands are
made of (src/cli) is nobody else's: no other program compiles, links or includes it. What judges (verification) includes no JSON,
not by way of another header either.

    floors.py DIR          prints what breaks the order, with file and line; exit code 1 where something does
    floors.py --self-test  the check sees what it must
"""
import pathlib
import re
import sys
import tempfile

ROW = re.compile(r"^\|\s*(\d+)\s*\|\s*`(\w+)`\s*\|")
ANY_INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"](?:plumb/|(?:\.\./)+(?:src/)?)(\w+)/')
STATEMENT = re.compile(r"(\w+)\(([^()]*)\)")
TOOL, OF_TOOL = "src/cli/", {"plumb_cli", "plumb_tool", "plumb_web_logs"}  # its files; the targets made of them, the last for WebAssembly
TAKES_SOURCES = {"add_executable", "add_library", "target_sources", "target_include_directories"}
NO_JSON = ("verification",)
ABOVE_ALL = {"mpi": 99, "testing": 99, "trace": 99}  # programs, and what users test with: no room of the table may need them


def floors_of(root):
    rows = [ROW.match(line) for line in (root / "CONTRIBUTING.md").read_text().splitlines()]
    return {row[2]: int(row[1]) for row in rows if row}


def includes_of(root, folder):
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".hpp", ".cpp", ".h"):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                found = INCLUDE.match(line)
                if found:
                    yield f"{path.relative_to(root)}:{number}", found[1]


def way_to_json(root, path, seen):
    """The headers of plumb by which a file comes to include JSON, the last one named as it stands there; nothing where it does not."""
    for name in ANY_INCLUDE.findall(path.read_text()):
        if "json" in name:
            return [name]
        header = next((h for h in (path.parent / name, root / "include" / name) if h.is_file()), None)
        if header and header not in seen:
            seen.add(header)
            way = way_to_json(root, header, seen)
            if way:
                return [name] + way
    return []


def circle_in(uses):
    """The rooms that reach themselves."""
    def reached(room, seen):
        for other in uses.get(room, ()):
            if other not in seen:
                seen.add(other)
                reached(other, seen)
        return seen
    return sorted(room for room in uses if room in reached(room, set()))


def builds_of(root):
    """The build's files, without what a build wrote."""
    for top in sorted(root.iterdir()):
        if top.name == "CMakeLists.txt":
            yield top
        elif top.is_dir() and top.name != "build" and not top.name.startswith("."):
            yield from sorted(top.rglob("CMakeLists.txt"))
            yield from sorted(top.rglob("*.cmake"))


def uses_of_tool(root):
    """Targets outside of the tool that link its commands, or compile a file of theirs; and sources that include one."""
    for path in builds_of(root):
        text = re.sub(r"#.*", "", path.read_text())
        for name, arguments in STATEMENT.findall(text):
            words = arguments.split()
            if not words or words[0] in OF_TOOL:
                continue
            if "plumb_cli" in words or name in TAKES_SOURCES and any(TOOL in word for word in words):
                yield f"{path.relative_to(root)}: {words[0]} is made of the tool's commands"
    others = [root / top for top in ("src", "include", "python", "bench", "examples", "fuzz", "tests") if (root / top).is_dir()]
    for folder in others:
        for path in sorted(folder.rglob("*.[ch]pp")):
            if not path.is_relative_to(root / TOOL) and re.search(rf'#\s*include\s*"(?:\.\./)+(?:{TOOL}|cli/(?!tool_runner))', path.read_text()):
                yield f"{path.relative_to(root)}: includes a header of the tool's commands"


def breaches(root):
    floors = floors_of(root)
    if not floors:
        return ["CONTRIBUTING.md has no table of floors"]
    out, same_floor = [], {}
    rooms = {p.name for top in ("src", "include/plumb") if (root / top).is_dir() for p in (root / top).iterdir() if p.is_dir()}
    out += [f"room {room} stands on no floor of CONTRIBUTING.md" for room in sorted(rooms - set(floors) - set(ABOVE_ALL))]
    floors.update(ABOVE_ALL)
    for room in sorted(rooms & set(floors)):
        for top in ("src", "include/plumb"):
            for place, other in includes_of(root, root / top / room):
                if other == room or other not in floors:
                    continue
                if floors[other] > floors[room]:
                    out.append(f"{place}: {room} (floor {floors[room]}) includes {other} (floor {floors[other]})")
                elif floors[other] == floors[room]:
                    same_floor.setdefault(room, set()).add(other)
    out += [f"room {room} includes itself by way of others on its floor" for room in circle_in(same_floor)]
    for place, other in includes_of(root, root / "baremetal"):
        if other == "paper":
            out.append(f"{place}: an instrument's part includes the paper's algorithm")
    for room in NO_JSON:
        for folder in (root / "src" / room, root / "include/plumb" / room):
            for path in sorted(folder.rglob("*.[ch]pp")):
                way = way_to_json(root, path, set())
                if way:
                    out.append(f"{path.relative_to(root)}: {room} includes JSON: {' -> '.join(way)}")
    return out + list(uses_of_tool(root))


def self_test():
    table = "| 6 | `io` | x |\n| 7 | `verification` | x |\n| 1 | `core` | x |\n| 4 | `health` | x |\n| 5 | `paper` | x |\n| 5 | `scenario` | x |\n"
    cases = [
        ({"src/paper/a.cpp": '#include "plumb/health/b.hpp"\n'}, ""),
        ({"src/health/a.cpp": '#include "plumb/paper/b.hpp"\n'}, "health (floor 4) includes paper (floor 5)"),
        ({"include/plumb/core/a.hpp": '#include "../../../src/health/b.hpp"\n'}, "core (floor 1) includes health (floor 4)"),
        ({"src/paper/a.cpp": '#include "plumb/scenario/b.hpp"\n', "src/scenario/a.cpp": '#include "plumb/paper/b.hpp"\n'},
         "includes itself by way of others"),
        ({"baremetal/a.cpp": "#include <plumb/paper/b.hpp>\n"}, "an instrument's part"),
        ({"src/attic/a.cpp": "\n"}, "room attic stands on no floor"),
        ({"src/verification/a.cpp": '#include "plumb/io/b.hpp"\n', "include/plumb/io/b.hpp": "#include <string>\n"}, ""),
        ({"include/plumb/verification/a.hpp": "#include <nlohmann/json_fwd.hpp>\n"}, "verification includes JSON: nlohmann/json_fwd.hpp"),
        ({"src/verification/a.cpp": '#include "plumb/io/b.hpp"\n', "include/plumb/io/b.hpp": '#include "plumb/io/json_fields.hpp"\n'},
         "verification includes JSON: plumb/io/b.hpp -> plumb/io/json_fields.hpp"),
        ({"cmake/Tool.cmake": "add_library(plumb_cli STATIC src/cli/a.cpp)\ntarget_link_libraries(plumb_tool PRIVATE plumb_cli)\n"}, ""),
        ({"cmake/Tests.cmake": "# not plumb_cli\ntarget_link_libraries(some_tests PRIVATE plumb_io)\n"}, ""),
        ({"cmake/Python.cmake": "target_link_libraries(plumb_python\n  PRIVATE plumb_session plumb_cli)\n"},
         "plumb_python is made of the tool's commands"),
        ({"bench/CMakeLists.txt": "add_executable(plumb_bench a.cpp ../src/cli/b.cpp)\n"}, "plumb_bench is made of"),
        ({"src/mpi/a.cpp": '#include "../cli/b.hpp"\n'}, "src/mpi/a.cpp: includes a header of the tool's commands"),
    ]
    for files, wanted in cases:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "CONTRIBUTING.md").write_text(table)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            told = "\n".join(breaches(root))
            if (wanted not in told) if wanted else told:
                print(f"expected {wanted!r}, found {told!r}")
                return 1
    print(f"{len(cases)} cases are judged as they should be")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    found = breaches(pathlib.Path(sys.argv[1]))
    print("\n".join(found) if found else "every room keeps to its floor")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
