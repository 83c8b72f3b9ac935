"""schema.py TOOL SOURCE: what plumb verify writes is what docs/report.schema.json says, and a damaged copy is not."""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("skipped: no jsonschema (Debian package python3-jsonschema)")
    sys.exit(77)


def verified(tool, array, out, *more):
    done = subprocess.run([tool, "verify", "--array", array, "--scenarios", "200", "--out", out, *more], capture_output=True, text=True)
    assert done.returncode in (0, 6), done.stderr
    return json.loads((pathlib.Path(out) / "report.json").read_text())


def main(tool, source):
    source = pathlib.Path(source)
    schema = json.loads((source / "docs/report.schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    with tempfile.TemporaryDirectory() as folder:
        first = verified(tool, str(source / "examples/paper_tool.toml"), folder + "/a")
        reports = [first, verified(tool, str(source / "examples/mikoff5_z.toml"), folder + "/b", "--compare", folder + "/a/report.json")]
        triad = (source / "examples/paper_tool.toml").read_text()
        pathlib.Path(folder, "triad.toml").write_text(triad[: triad.rindex("[[sensor]]")])
        reports.append(verified(tool, folder + "/triad.toml", folder + "/c"))
    for report in reports:
        errors = [f"{list(e.absolute_path)}: {e.message}" for e in validator.iter_errors(report)]
        assert not errors, "\n".join(errors[:10])
    # The schema is not so wide that everything fits.
    for break_it in (
        lambda r: r.pop("verdict"),
        lambda r: r["verdict"].update(verdict="splendid"),
        lambda r: r["campaign"]["faults"]["by_fault"][0]["detected"].update(high=1.5),
        lambda r: r["identity"]["inputs"][0].update(sha256="0"),
        lambda r: r["traceability"]["requirements"][0].update(result="well"),
        lambda r: r.update(more=1),
    ):
        broken = copy.deepcopy(first)
        break_it(broken)
        assert not validator.is_valid(broken)
    print(f"{len(reports)} reports fit the schema")


main(*sys.argv[1:])
