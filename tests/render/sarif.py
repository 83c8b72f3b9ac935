"""sarif.py TOOL SOURCE: analysis.sarif of plumb verify is SARIF 2.1.0: no member that the standard's object model (Debian package
python3-sarif-python-om) does not know, none missing that it requires, and of every member what the standard says of its value, as
far as plumb writes it. With SARIF_SCHEMA in the environment, the name of the official schema file, that is asked too."""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import urllib.parse

try:
    import attr
    import jsonschema
    import sarif_om
except ImportError as error:
    print(f"skipped: {error} (Debian packages python3-jsonschema python3-sarif-python-om)")
    sys.exit(77)

# Which class of the object model stands behind a member; the others hold plain values or, in "properties", anything.
CLASSES = {
    "runs": sarif_om.Run, "tool": sarif_om.Tool, "driver": sarif_om.ToolComponent, "rules": sarif_om.ReportingDescriptor,
    "results": sarif_om.Result, "message": sarif_om.Message, "locations": sarif_om.Location, "relatedLocations": sarif_om.Location,
    "physicalLocation": sarif_om.PhysicalLocation, "artifactLocation": sarif_om.ArtifactLocation, "region": sarif_om.Region,
}


def of_model(model, value, where):
    """Builds `value` from the classes of the object model; what they do not know or miss is an error."""
    assert isinstance(value, dict), f"{where}: no object"
    names = {field.metadata["schema_property_name"]: field for field in attr.fields(model)}
    arguments = {}
    for key, held in value.items():
        assert key in names, f"{where}: the standard knows no member {key}"
        if key in CLASSES and isinstance(held, list):
            held = [of_model(CLASSES[key], one, f"{where}.{key}[{k}]") for k, one in enumerate(held)]
        elif key in CLASSES:
            held = of_model(CLASSES[key], held, f"{where}.{key}")
        arguments[names[key].name] = held
    for key, field in names.items():
        assert field.default is not attr.NOTHING or key in value, f"{where}: {key} is missing"
    return model(**arguments)


def is_reference(uri):
    allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~:/?#[]@!$&'()*+,;=%"
    return uri != "" and all(c in allowed for c in uri) and urllib.parse.quote(urllib.parse.unquote(uri), safe="/:") == uri


def check_place(place, where):
    physical = place["physicalLocation"]
    assert is_reference(physical["artifactLocation"]["uri"]), f"{where}: {physical['artifactLocation']['uri']} is no URI"
    for name in ("startLine", "startColumn"):
        assert type(physical["region"][name]) is int and physical["region"][name] >= 1, f"{where}: {name}"


def check_values(log):
    assert log["version"] == "2.1.0" and urllib.parse.urlsplit(log["$schema"]).scheme == "https"
    for run in log["runs"]:
        assert run["columnKind"] in ("utf16CodeUnits", "unicodeCodePoints")
        driver = run["tool"]["driver"]
        assert urllib.parse.urlsplit(driver["informationUri"]).scheme == "https"
        rules = [rule["id"] for rule in driver["rules"]]
        assert len(set(rules)) == len(rules), "a rule stands twice"
        for k, result in enumerate(run["results"]):
            where = f"results[{k}]"
            assert result["level"] in ("none", "note", "warning", "error"), where
            assert type(result["ruleIndex"]) is int and rules[result["ruleIndex"]] == result["ruleId"], where
            assert result["message"]["text"], where
            for place in result["locations"] + result.get("relatedLocations", []):
                check_place(place, where)
            ids = [place["id"] for place in result.get("relatedLocations", [])]
            assert ids == sorted(set(ids)) and all(type(i) is int and i >= 0 for i in ids), where


def check(log, schema):
    of_model(sarif_om.SarifLog, log, "log")
    check_values(log)
    if schema:
        jsonschema.validate(log, schema)


FINDINGS = """/home/a user/src/a%20b.cpp:3:7: warning: narrowing of "x" [bugprone-narrowing,-warnings-as-errors]
/home/a user/src/a%20b.cpp:1:1: note: declared here
/home/a user/src/a%20b.cpp:2:5: note: and here
src/ö.cpp:12:1: error: unknown type name 'y' [clang-diagnostic-error]
src/c.cpp:4:2: warning: narrowing [bugprone-narrowing]
"""


def main(tool, source):
    name = os.environ.get("SARIF_SCHEMA")
    schema = json.loads(pathlib.Path(name).read_text()) if name else None
    array = str(pathlib.Path(source) / "examples/paper_tool.toml")
    with tempfile.TemporaryDirectory() as folder:
        for findings, number in ((FINDINGS, 3), ("", 0)):
            pathlib.Path(folder, "tidy.log").write_text(findings)
            done = subprocess.run([tool, "verify", "--array", array, "--scenarios", "50", "--analysis", "tidy.log", "--out", "r"],
                                  capture_output=True, text=True, cwd=folder)
            assert done.returncode == 6, done.stderr
            log = json.loads(pathlib.Path(folder, "r", "analysis.sarif").read_text())
            check(log, schema)
            assert len(log["runs"][0]["results"]) == number
            found = found if number == 0 else log
    places = [result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] for result in found["runs"][0]["results"]]
    assert places == ["file:///home/a%20user/src/a%2520b.cpp", "src/%C3%B6.cpp", "src/c.cpp"], places
    # The check is not so wide that everything passes.
    for break_it in (
        lambda log: log.pop("runs"),
        lambda log: log.update(more=1),
        lambda log: log["runs"][0].pop("tool"),
        lambda log: log["runs"][0]["tool"]["driver"].pop("name"),
        lambda log: log["runs"][0]["results"][0].pop("message"),
        lambda log: log["runs"][0]["results"][0].update(level="bad"),
        lambda log: log["runs"][0]["results"][0].update(ruleIndex=1),
        lambda log: log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"].update(startLine=0),
        lambda log: log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"].update(uri="a b"),
    ):
        broken = copy.deepcopy(found)
        break_it(broken)
        try:
            check(broken, schema)
        except (AssertionError, KeyError, TypeError, jsonschema.ValidationError):
            continue
        raise AssertionError("a damaged copy passes")
    print("analysis.sarif is SARIF 2.1.0" + (", by the official schema too" if schema else "; the official schema was not asked"))


main(*sys.argv[1:])
