"""schema.py TOOL SOURCE [--write]: what plumb verify writes is what docs/report.schema.json says, of a magnetic group
docs/report-magnetic.schema.json, what plumb monitor --report writes is what docs/health.schema.json says, and damaged copies are not.
The schema of a magnetic group is that of accelerometers in other words and units; --write makes it anew."""

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


def validator_of(path):
    schema = json.loads(path.read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


MAGNETIC_WORDS = (("mdb_mps2", "mdb_nt"), ("gravity_mps2", "field_nt"), ("stability_0_2_mg0", "stability_7_85_nt"), ("acceleration_mps2", "disturbance_nt"),
                  ("_mps2", "_nt"), ("unseen_by_gravity", "unseen_by_field"), ("with acceleration 0", "with disturbance 0"),
                  ("stability and acceleration", "stability and disturbance"), ("stability 0 and 0.2 mg0", "stability 0 and 7.85 nT"),
                  ("that gravity cannot see", "that the field cannot see"),
                  ("of accelerometers; that of a magnetic group is report-magnetic.schema.json", "of a magnetic group; that of accelerometers is report.schema.json"),
                  ("plumb-verification, version 1", "plumb-verification, version 1, of a magnetic group"))


def magnetic_schema(text):
    for gravity, field in MAGNETIC_WORDS:
        assert gravity in text, gravity
        text = text.replace(gravity, field)
    at = text.index('"properties": {', text.index('"subject": {')) + len('"properties": {')
    required = text.index('"required": [', text.index('"subject": {')) + len('"required": [')
    assert required < at
    return text[:required] + '"field", ' + text[required:at] + '"field": {"const": "magnetic"}, ' + text[at:]


def judge(validator, reports, breaks):
    for report in reports:
        errors = [f"{list(e.absolute_path)}: {e.message}" for e in validator.iter_errors(report)]
        assert not errors, "\n".join(errors[:10])
    # The schema is not so wide that everything fits.
    for number, break_it in enumerate(breaks):
        broken = copy.deepcopy(reports[0])
        break_it(broken)
        assert not validator.is_valid(broken), number


def flown(tool, source, folder):
    """Of a flight in which a chip dies, with an inclination."""
    text = (source / "examples/motion/drone.toml").read_text()
    assert text.count("[motion]\n") == 1
    pathlib.Path(folder, "flight.toml").write_text(
        text.replace("[motion]\n", "[motion]\nvelocity_bound_mps = 2\ninclination_window_s = 1\n"))
    array = "flight.toml"
    for command in (["simulate", "--flight", "drone", array, "--duration", "4", "--fault", "imu2:stuck=0g0@3s", "--out", "flight"],
                    ["monitor", "--array", array, "--calibrate-first", "--log", "flight", "--report", "flight.html"]):
        done = subprocess.run([tool, *command], capture_output=True, text=True, cwd=folder)
        assert done.returncode == 0, done.stderr
    return json.loads(pathlib.Path(folder, "flight.json").read_text())


def health_reports(tool, source, folder):
    """Of a run in which a2 dies, of one that is too short for a station and has a bad row, and of a flight."""
    examples = source / "examples"
    array = ["--array", str(examples / "paper_tool.toml")]

    def monitored(name, *more, code=0):
        done = subprocess.run([tool, "monitor", *array, "--calibration", "cal.json", "--log", name, "--report", name + ".html", *more],
                              capture_output=True, text=True, cwd=folder)
        assert done.returncode == code, done.stderr
        return json.loads(pathlib.Path(folder, name + ".json").read_text())

    for command in (["simulate", str(examples / "stand.toml"), "--out", "stand.csv"],
                    ["calibrate", *array, "--log", "stand.csv", "--out", "cal.json"],
                    ["simulate", str(examples / "drilling.toml"), "--out", "run"]):
        done = subprocess.run([tool, *command], capture_output=True, text=True, cwd=folder)
        assert done.returncode == 0, done.stderr
    lines = pathlib.Path(folder, "run").read_text().splitlines()
    pathlib.Path(folder, "short").write_text("\n".join(lines[:9] + [lines[9].replace(",", ",x", 1)] + lines[10:20]) + "\n")
    out = [monitored("run"), monitored("short", "--on-bad-row", "skip", code=7), flown(tool, source, folder)]
    assert out[0]["motion"] is None and out[2]["motion"]["events"]
    assert out[2]["motion"]["inclination"]["last"]
    assert out[0]["stations"] and out[0]["events"] and not out[1]["stations"] and out[1]["identity"]["log"]["rows_bad"] == 1
    return out


def main(tool, source, write=None):
    source = pathlib.Path(source)
    published = source / "docs/report-magnetic.schema.json"
    magnetic = magnetic_schema((source / "docs/report.schema.json").read_text())
    if write == "--write":
        published.write_text(magnetic)
    assert published.read_text() == magnetic, f"{published} is not what docs/report.schema.json makes of it: schema.py TOOL SOURCE --write"
    with tempfile.TemporaryDirectory() as folder:
        first = verified(tool, str(source / "examples/paper_tool.toml"), folder + "/a")
        reports = [first, verified(tool, str(source / "examples/mikoff5_z.toml"), folder + "/b", "--compare", folder + "/a/report.json")]
        triad = (source / "examples/paper_tool.toml").read_text()
        pathlib.Path(folder, "triad.toml").write_text(triad[: triad.rindex("[[sensor]]")])
        reports.append(verified(tool, folder + "/triad.toml", folder + "/c"))
        fields = [verified(tool, str(source / "examples/six_axis.toml#mag"), folder + "/m")]
        health = health_reports(tool, source, folder)
    judge(validator_of(published), fields, (
        lambda r: r["subject"].update(field="rate"),
        lambda r: r["subject"].pop("field"),
        lambda r: r["array"].pop("field_nt"),
        lambda r: r["array"]["detection_sizes"]["as_stated"].update(guaranteed_isolation_mps2=1.0),
        lambda r: r["array"]["sensors"][0].pop("sigma_nt"),
    ))
    assert not validator_of(source / "docs/report.schema.json").is_valid(fields[0])
    judge(validator_of(source / "docs/report.schema.json"), reports, (
        lambda r: r.pop("verdict"),
        lambda r: r["verdict"].update(verdict="splendid"),
        lambda r: r["campaign"]["faults"]["by_fault"][0]["detected"].update(high=1.5),
        lambda r: r["identity"]["inputs"][0].update(sha256="0"),
        lambda r: r["traceability"]["requirements"][0].update(result="well"),
        lambda r: r["run"]["monitor_step"].pop("high_water_ns"),
        lambda r: r.update(more=1),
    ))
    judge(validator_of(source / "docs/health.schema.json"), health, (
        lambda r: r.pop("answer"),
        lambda r: r["answer"].update(usable_for_survey="perhaps"),
        lambda r: r["stations"][0].update(colour="blue"),
        lambda r: r.pop("residuals"),
        lambda r: r["residuals"]["points"][0].update(off_mps2=[1.0, 2.0]),
        lambda r: r["stations"][0].pop("limit"),
        lambda r: r["stations"][0].update(inclination_deg=181),
        lambda r: r["events"][0].update(to="splendid"),
        lambda r: r["extremes"]["sensors"][0].update(blocks_clipped=-1),
        lambda r: r["identity"]["inputs"][0].update(sha256="0"),
        lambda r: r.update(more=1),
    ))
    print(f"{len(reports) + len(fields)} verification reports and {len(health)} health reports fit their schemas")


main(*sys.argv[1:])
