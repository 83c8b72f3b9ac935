#!/usr/bin/env python3
"""The names that other programs rely on, beside docs/stable-interface.md.

interface.py ROOT TOOL          fails where a name of the page is gone or one is new
interface.py ROOT TOOL --write  puts the names of this build into the page
interface.py --self-test        a name that is gone and one that is new are both found

Names are taken from where they are made: keys of files from what the tool TOOL accepts (it lists them when it refuses
another), of the calibration file from one that it writes, of JSON from the schemas and the writers, C from plumb.h,
commands and options from the completion, Python from the bindings."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

MARK = re.compile(r"<!-- names: ([^>]+) -->\n```\n(.*?)```\n", re.S)
WIDTH = 118
TRUE_SCENARIO = 'tool = "paper"\n[attitude]\nlaw = "fixed"\ndirection = [0, 0, 1]\n'
CAMPAIGN = 'scenarios = 1\n'
ROLLS = ('name = "rolls"\narray = "array.toml"\n[attitude]\nlaw = "list"\nrecord_motion = false\ntag_stations = true\n'
         "directions = [%s]\n[truth]\nlaw = \"uniform\"\nbias = \"20 mg0\"\nscale = \"2 %%\"\ntilt = \"2 deg\"\n")


def run(tool, folder, *arguments):
    return subprocess.run([tool, *arguments], cwd=folder, capture_output=True, text=True, check=False)


# --- Keys of files. ---------------------------------------------------------------------------------------------------


def known_keys(tool, folder, text, *command):
    """What the tool lists when it refuses the key zzzz in that text."""
    (folder / "probe.toml").write_text(text, encoding="utf-8")
    said = run(tool, folder, *command).stderr
    found = re.search(r"zzzz: is not a known key.*known keys here: (.*)\.\n", said, re.S)
    assert found, f"{' '.join(command)} lists no keys:\n{text}\n{said}"
    return found[1].split(", ")


def array_keys(root, tool, folder):
    array = (root / "examples/paper_tool.toml").read_text(encoding="utf-8")
    probe = "zzzz = 1\n"
    yield "", known_keys(tool, folder, probe + array, "geometry", "probe.toml")
    for table in ("gravity", "input", "monitor", "output", "motion", "gyro"):
        has = f"[{table}]\n" in array
        text = array.replace(f"[{table}]\n", f"[{table}]\n{probe}") if has else array + f"\n[{table}]\n{probe}"
        yield table, known_keys(tool, folder, text, "geometry", "probe.toml")
    yield "clock", known_keys(tool, folder, array + f"\n[[clock]]\n{probe}", "geometry", "probe.toml")
    yield "sensor", known_keys(tool, folder, array.replace("[[sensor]]\n", "[[sensor]]\n" + probe, 1), "geometry", "probe.toml")
    prior = array.replace("prior = {", "prior = {zzzz = 1, ", 1)
    yield "sensor.prior", known_keys(tool, folder, prior, "geometry", "probe.toml")


def scenario_keys(tool, folder):
    probe = "zzzz = 1\n"
    yield "", known_keys(tool, folder, probe + TRUE_SCENARIO, "simulate", "probe.toml")
    yield "attitude", known_keys(tool, folder, TRUE_SCENARIO + probe, "simulate", "probe.toml")
    for table in ("truth", "temperature", "noise", "rotation", "depth", "[sensor_truth]", "[fault]"):
        text = f"{TRUE_SCENARIO}[{table}]\n{probe}"
        yield table.strip("[]"), known_keys(tool, folder, text, "simulate", "probe.toml")


def campaign_keys(root, tool, folder):
    campaign = (root / "examples/guaranteed.toml").read_text(encoding="utf-8")
    yield "", known_keys(tool, folder, "zzzz = 1\n" + campaign, "campaign", "probe.toml", "--out", "r.json")
    for table in ("[tool]", "run", "gravity", "calibration", "[attitude]", "[fault]", "expect"):
        has = f"\n[{table}]\n" in campaign
        text = campaign.replace(f"\n[{table}]\n", f"\n[{table}]\nzzzz = 1\n", 1) if has else f"{campaign}\n[{table}]\nzzzz = 1\n"
        yield table.strip("[]"), known_keys(tool, folder, text, "campaign", "probe.toml", "--out", "r.json")


def calibration_file(root, tool, folder):
    """One with all of its sections: roll groups, the paper's fits, and where coefficients come from that were not fitted."""
    array = (root / "examples/paper_tool.toml").read_text(encoding="utf-8")
    (folder / "array.toml").write_text(array.replace("[input]\n", '[input]\nroll_group = "ring"\n'), encoding="utf-8")
    attitudes = [f'{{inclination = "{inclination} deg", toolface = "{45 * k} deg"}}'
                 for inclination in (0, 45, 90, 120) for k in range(8)]
    (folder / "rolls.toml").write_text(ROLLS % ", ".join(attitudes), encoding="utf-8")
    for arguments in (["simulate", "rolls.toml", "--out", "log.csv"],
                      ["calibrate", "--array", "array.toml", "--log", "log.csv", "--out", "cal.json", "--paper",
                       "--date", "2026-01-31", "--serial", "7"],
                      ["calibrate", "--array", "array.toml", "--calibration", "cal.json", "--export", "csv", "--out", "known.csv"],
                      ["calibrate", "--array", "array.toml", "--from", "known.csv", "--out", "known.json"]):
        done = run(tool, folder, *arguments)
        assert done.returncode == 0, done.stderr + done.stdout
    root = json.loads((folder / "cal.json").read_text(encoding="utf-8"))
    known = json.loads((folder / "known.json").read_text(encoding="utf-8"))
    root["provenance"]["coefficients"] = known["provenance"]["coefficients"]
    return root


def paths(value, prefix=""):
    if isinstance(value, dict):
        for key, part in value.items():
            yield prefix + key
            yield from paths(part, prefix + key + ".")
    elif isinstance(value, list):
        for part in value:
            yield from paths(part, prefix)


# --- JSON, words, identifiers. ----------------------------------------------------------------------------------------


def schema_paths(schema, root, prefix=""):
    if "$ref" in schema:
        schema = root["definitions"][schema["$ref"].rsplit("/", 1)[1]]
    for part in schema.get("oneOf", []) + schema.get("anyOf", []):
        yield from schema_paths(part, root, prefix)
    for key in schema.get("required", []):
        yield prefix + key
    for key, part in schema.get("properties", {}).items():
        yield prefix + key
        yield from schema_paths(part, root, prefix + key + ".")
    if isinstance(schema.get("items"), dict):
        yield from schema_paths(schema["items"], root, prefix)


def record_keys(source):
    """Of src/io/records.cpp: function by function what is written into an object, and into one inside."""
    inner = ""
    for call in re.finditer(r"\b(object|inner)\.(\w+)\(\s*((?:[^\"()]|\([^()]*\))*)\"(\w+)\"", source):
        where, what, _, key = call.groups()
        if what == "object":
            inner = key
        yield key if where == "object" else f"{inner}.{key}"


def words_of(source, kind):
    body = source[source.index(f"const char* to_string({kind} "):]
    return re.findall(r'return "([^"]+)"', body[: body.index("\n}")])[:-1]


def names_in(source, array):
    return re.findall(r'"(\w+)"', source[source.index(array):].split("};")[0])


def c_names(header):
    code = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    yield from (f"{name} {value}" for name, value in re.findall(r"#define (PLUMB_\w+) ([\w-]+)\s*$", code, re.M))
    for kind in re.finditer(r"enum (plumb_\w+) \{(.*?)\}", code, re.S):
        yield "enum " + kind[1]
        yield from (f"{name} {k}" for k, name in enumerate(re.findall(r"PLUMB_\w+", kind[2])))
    for struct in re.finditer(r"typedef struct (plumb_\w+) \{(.*?)\} \w+;", code, re.S):
        yield "struct " + struct[1]
        for line in struct[2].split(";"):
            for name in re.sub(r"\[[^\]]*\]", "", line).split(","):
                if name.strip():
                    yield struct[1] + "." + re.findall(r"[A-Za-z_]\w*", name)[-1]
    yield from (f"{name}()" for name in re.findall(r"\b(plumb_\w+)\([^;{]*\) PLUMB_NOEXCEPT", code))


def options_of(tool, folder):
    for line in run(tool, folder, "--completion-fish").stdout.splitlines():
        command = re.search(r"__fish_use_subcommand -a (\S+)", line)
        if command:
            yield command[1]
        option = re.search(r"__fish_seen_subcommand_from (\S+)' -l (\S+)", line)
        if option:
            yield f"{option[1]} --{option[2]}"


def python_names(root):
    for file in sorted((root / "python").glob("*.?pp")):
        source, inside = file.read_text(encoding="utf-8"), ""
        for found in re.finditer(r'module\.attr\("(\w+)"|module\.def\(\s*"(\w+)"|class_<[^;(]*?>\(\s*module, "(\w+)"|'
                                 r'\.def\w*\(\s*"(\w+)"|^  (\w*)COLUMN\([^,]+, (\w+),', source, re.M):
            attribute, function, kind, member, row, column = found.groups()
            inside = kind or inside
            of_row = {None: "", "": "verdict", "MOTION_": "motion", "FORCE_": "force", "INCLINATION_": "inclination",
                      "RATE_": "rate", "RATES_": "rates"}[row]
            yield attribute or function or kind or (column and f"{of_row}.{column}") or f"{inside}.{member}"


# --- The page. --------------------------------------------------------------------------------------------------------


def names_of(root, tool):
    def text(path):
        return (root / path).read_text(encoding="utf-8")

    def dotted(sections):
        return [f"{table}.{key}" if table else key for table, keys in sections for key in keys]

    out = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        out["array file"] = dotted(array_keys(root, tool, folder))
        out["scenario file"] = dotted(scenario_keys(tool, folder))
        out["campaign file"] = dotted(campaign_keys(root, tool, folder))
        out["calibration file"] = list(dict.fromkeys(paths(calibration_file(root, tool, folder))))
        table = text("src/coefficients/sensor_table.cpp")
        out["table of coefficients"] = names_in(table, "columns = {")
        out["forms of coefficients"] = words_of(text("src/coefficients/coefficient_file.cpp"), "Form")
        out["commands and options"] = list(options_of(tool, folder))
        out["exit codes"] = [" ".join(code) for code in
                             re.findall(r"^  (\d)  (.*)$", run(tool, folder, "--help").stdout, re.M)]
    out["health.json"] = list(dict.fromkeys(schema_paths(*2 * [json.loads(text("docs/health.schema.json"))])))
    out["report.json"] = list(dict.fromkeys(schema_paths(*2 * [json.loads(text("docs/report.schema.json"))])))
    out["events and verdicts"] = list(dict.fromkeys(record_keys(text("src/io/records.cpp"))))
    motion = text("src/io/motion_records.cpp")
    out["motion events"] = list(dict.fromkeys(record_keys(motion)))
    out["columns of --motion"] = names_in(motion, "kColumns[] = {")
    out["columns of --inclination"] = re.search(r'return "(t_s,span_s,[a-z_,]+)\\n"', motion)[1].split(",")
    out["kinds of motion events"] = words_of(motion, "MotionEventKind")
    out["causes in motion"] = words_of(text("src/motion/motion_monitor.cpp"), "MotionCause")
    out["what became of a sample of a chip"] = words_of(text("src/motion/motion_clocks.cpp"), "ClockPush")
    out["validities in motion"] = words_of(text("src/motion/motion_force.cpp"), "ForceValidity")
    out["parts of a bound"] = words_of(text("src/motion/motion_force.cpp"), "ForceTerm")
    inclination = text("src/motion/continuous_inclination.cpp")
    out["statuses of an inclination"] = words_of(inclination, "InclinationStatus")
    out["parts of an interval"] = words_of(inclination, "InclinationTerm")
    out["notes on motion"] = re.findall(r'push_back\(\s*\{"(\w+)"', text("src/render/motion_notes.cpp"))
    state = text("src/health/state.cpp")
    for title, kind in (("states", "HealthState"), ("events", "HealthEvent"), ("causes", "Cause"),
                        ("validities", "Validity"), ("grades", "Grade")):
        out[title] = words_of(state, kind)
    out["qualifiers"] = names_in(text("include/plumb/io/records.hpp"), "kQualifierNames = {")
    out["uses"] = names_in(text("include/plumb/io/records.hpp"), "kUsableNames = {")
    out["norm mismatches"] = words_of(text("src/health/reference_study.cpp"), "NormMismatchKind")
    out["phases of a recalibration"] = words_of(text("src/health/recalibration.cpp"), "RecalibrationPhase")
    out["reasons of a station"] = words_of(text("src/verification/tool_health_words.cpp"), "StationReason")
    out["concerns of a calibration"] = words_of(text("src/calibration/acceptance.cpp"), "Concern")
    out["findings"] = re.findall(r'\{FindingCode::\w+, "(\w+)"\}', text("include/plumb/findings/finding.hpp"))
    out["C"] = list(dict.fromkeys(name for header in ("plumb", "plumb_dip", "plumb_motion", "plumb_rates")
                                  for name in c_names(text(f"include/plumb/c/{header}.h"))))
    out["Python"] = list(dict.fromkeys(python_names(root)))
    return out


def listed(names, lines):
    """One a line, or as many as fit."""
    if lines:
        return "".join(name + "\n" for name in names)
    out, row = "", ""
    for name in names:
        if row and len(row) + 2 + len(name) > WIDTH:
            out, row = out + row + "\n", ""
        row += ("  " if row else "") + name
    return out + row + "\n"


def on_page(page):
    return {title: block.split("\n")[:-1] if title in LINES else block.split() for title, block in MARK.findall(page)}


LINES = ("exit codes", "commands and options", "C", "states", "parts of a bound")


def differences(stated, found):
    for title in [*found, *(title for title in stated if title not in found)]:
        old, new = stated.get(title, []), found.get(title, [])
        for name in old:
            if name not in new:
                yield f"{title}: {name} is gone, and somebody may rely on it"
        for name in new:
            if name not in old:
                yield f"{title}: {name} is new: add it to the list (tests/docs/interface.py ROOT TOOL --write)"
        if sorted(old) == sorted(new) and old != new:
            yield f"{title}: the order is another one (--write)"


def self_test():
    assert list(differences({"a": ["x", "y"]}, {"a": ["x", "z"]})) == [
        "a: y is gone, and somebody may rely on it",
        "a: z is new: add it to the list (tests/docs/interface.py ROOT TOOL --write)"]
    assert list(differences({"a": ["x"]}, {"a": ["x"]})) == []
    assert list(differences({"a": ["x"]}, {})) and list(differences({}, {"a": ["x"]}))
    assert list(differences({"a": ["x", "y"]}, {"a": ["y", "x"]})) == ["a: the order is another one (--write)"]
    assert list(record_keys('object.number("a", 1); Object inner = object.object("b"); inner.number_if(f(x) > 0.0, "c", 2);')) == [
        "a", "b", "b.c"]
    assert list(c_names('typedef struct plumb_x {\n int32_t a; /* b */\n uint8_t c, d[3];\n} plumb_x;')) == [
        "struct plumb_x", "plumb_x.a", "plumb_x.c", "plumb_x.d"]
    return 0


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    root, tool = pathlib.Path(arguments[0]).resolve(), str(pathlib.Path(arguments[1]).resolve())
    file = root / "docs/stable-interface.md"
    page, found = file.read_text(encoding="utf-8"), names_of(root, tool)
    empty = [title for title, names in found.items() if not names]
    assert not empty, f"nothing found: {empty}"
    if arguments[2:] == ["--write"]:
        missing = set(found) - {title for title, _ in MARK.findall(page)}
        assert not missing, f"the page has no block for {sorted(missing)}"
        file.write_text(MARK.sub(lambda m: f"<!-- names: {m[1]} -->\n```\n{listed(found[m[1]], m[1] in LINES)}```\n", page),
                        encoding="utf-8")
        return 0
    wrong = list(differences(on_page(page), found))
    print("\n".join(wrong) or f"{sum(map(len, found.values()))} names, as the page lists them")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
