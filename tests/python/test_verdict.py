"""A row of the Python monitor holds every figure of a verdict: held to the headers of C++ and C, and to the tool's JSON.

Run by ctest with PYTHONPATH (the module), PLUMB_TOOL (the tool) and PLUMB_SOURCE_DIR.
"""

import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import numpy as np

import plumb

SOURCE = pathlib.Path(os.environ["PLUMB_SOURCE_DIR"])
HEALTH = SOURCE / "include" / "plumb" / "health"
EXAMPLES = SOURCE / "examples"

# Parts of plumb::Verdict with parts of their own: header, what a member's column begins with, and columns named otherwise.
PARTS = {
    "transition": ("verdict.hpp", "TransitionRecord", "transition_", {"sequence": "transition"}),
    "rotation": ("rotation.hpp", "RotationRequest", "turn_", {"wanted": "wants_rotation"}),
    "recalibration": ("recalibration_progress.hpp", "RecalibrationProgress", "recalibration_",
                      {"stations_wanted": "stations_wanted", "last_refusal": "recalibration_refusal"}),
    "norm_mismatch": ("reference_study.hpp", "NormMismatch", "norm_mismatch_",
                  {"configure_mps2": "gravity_to_configure_mps2"}),
    "calibration": ("calibration_check.hpp", "CalibrationFinding", "calibration_", {}),
}
OTHERWISE = {"triples_passed": "triples_failing"}
# Keys of --verdicts that are not a column under their own name: the column that says it; angles of it are derived from it.
OF_JSON = {
    "t_s": "time_s",
    "rotation": "turn_along",
    "recalibration": "recalibration_phase",
    "norm_mismatch": "norm_mismatch_kind",
    "covariance_mps2_2": "covariance",
    "inclination_deg": "gravity_mps2",
    "inclination_sigma_deg": "covariance",
    "toolface_deg": "gravity_mps2",
    "toolface_sigma_deg": "covariance",
    "protection_level_calibrated_axes_deg": "protection_level_calibrated_axes_rad",
    "protection_level_housing_deg": "protection_level_housing_rad",
    "snapshot_refused": "snapshot_refusal",
}
SETS = ("configured", "in_service", "provisionally_excluded", "excluded", "absent", "suspects", "clipped", "scattering", "not_finite",
        "noisy", "stuck", "contradicted_clip")


def members(header, struct):
    """What the `fields()` of that struct list; the core's own tests hold them to be all there are."""
    text = (HEALTH / header).read_text()
    body = text[text.index(f"struct {struct} "):]
    found = re.search(r"auto fields\(\) noexcept \{(.*?)\n  \}", body, re.DOTALL).group(1)
    names = re.findall(r"&\w+::(\w+)", found)
    assert len(names) >= 4, (struct, names)
    return names


def c_members(struct):
    text = (SOURCE / "include" / "plumb" / "c" / "plumb.h").read_text()
    body = re.search(rf"typedef struct {struct} \{{(.*?)\}} {struct};", text, re.DOTALL).group(1)
    body = re.sub(r"/\*.*?\*/", "", body, flags=re.DOTALL)
    names = []
    for declaration in body.split(";"):
        if declaration.strip():
            first, *others = declaration.split(",")
            names += [re.sub(r"\[.*", "", name).split()[-1] for name in (first, *others)]
    assert len(names) >= 10, (struct, names)
    return names


class Columns(unittest.TestCase):
    columns = plumb.verdict_dtype.names

    def test_every_figure_of_the_cpp_verdict_is_a_column(self):
        names = members("verdict.hpp", "Verdict")
        for part in PARTS:
            self.assertIn(part, names)
        for name in names:
            if name in PARTS:
                header, struct, prefix, otherwise = PARTS[name]
                for inner in members(header, struct):
                    self.assertIn(otherwise.get(inner, prefix + inner), self.columns, f"{struct}::{inner}")
            else:
                self.assertIn(OTHERWISE.get(name, name), self.columns, f"Verdict::{name}")

    def test_every_figure_of_the_c_verdict_is_a_column_of_that_name(self):
        for name in c_members("plumb_verdict"):
            if name != "struct_size":
                self.assertIn(name, self.columns)
        for name in c_members("plumb_transition"):
            if name not in ("sequence", "reserved"):
                self.assertIn("transition_" + name, self.columns)

    def test_every_key_of_the_tools_verdicts_is_a_column(self):
        array, stand = plumb.simulate(str(EXAMPLES / "stand.toml"))
        monitor = plumb.Monitor(array, plumb.calibrate(array, stand))
        monitor.run(stand)
        keys = monitor.verdict.keys()
        self.assertGreater(len(keys), 40)
        for key in keys:
            self.assertIn(OF_JSON.get(key, key), self.columns)
        self.assertLessEqual(OF_JSON.keys(), keys)

    def test_every_column_says_what_it_is_and_in_which_unit(self):
        self.assertEqual(tuple(plumb.VERDICT_FIELDS), self.columns)
        units = {"_mps2": "m/s^2", "_rad": "[rad]", "_s": "[s]", "_degc": "[degC]", "_per_min": "per minute]",
                 "_per_h": "per hour]"}
        for name, text in plumb.VERDICT_FIELDS.items():
            self.assertGreater(len(text), 5, name)
            for end, unit in units.items():
                if name.endswith(end):
                    self.assertIn(unit, text, name)
            tuple_named = re.search(r"\b(?:index into|named in) ([A-Z_]+)", text)
            if tuple_named:
                self.assertGreaterEqual(len(getattr(plumb, tuple_named.group(1))), 4, name)

    def test_the_names_of_the_bits(self):
        text = (HEALTH / "state.hpp").read_text()
        bits = dict(re.findall(r"constexpr std::uint16_t (\w+) = (\d+);", text[text.index("struct Qualifier"):]))
        self.assertEqual({name: 1 << k for k, name in enumerate(plumb.QUALIFIERS)}, {n: int(b) for n, b in bits.items()})
        text = (HEALTH / "verdict.hpp").read_text()
        usable = text[text.index("struct Usable"):text.index("struct Verdict ")]
        bits = dict(re.findall(r"constexpr std::uint16_t (\w+) = (\d+);", usable))
        self.assertEqual({name: 1 << k for k, name in enumerate(plumb.USABLE)}, {n: int(b) for n, b in bits.items()})
        self.assertEqual(len(plumb.error_text(0)) > 0, True)
        with self.assertRaises(plumb.Error):
            plumb.error_text(-1)


class Values(unittest.TestCase):
    """Row by row what the tool prints of the same samples."""

    text = (EXAMPLES / "paper_tool.toml").read_text()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.at = pathlib.Path(self.folder.name)

    def both(self, text, log_csv):
        """Rows of the module and lines of the tool over the same log. The array file is that text; the calibration is
        that of the plain one."""
        (self.at / "array.toml").write_text(text)
        array = plumb.Array.parse(text)
        plain = plumb.Array.parse(self.text)
        stand = plumb.read_log(plain, str(self.simulated("stand")))
        plumb.calibrate(plain, stand).save(str(self.at / "cal.json"))
        calibration = plumb.Calibration.read(array, str(self.at / "cal.json"))
        verdicts = self.at / "verdicts.jsonl"
        told = subprocess.run([os.environ["PLUMB_TOOL"], "monitor", "--array", self.at / "array.toml", "--calibration",
                               self.at / "cal.json", "--log", log_csv, "--verdicts", verdicts, "--every-sample"],
                              capture_output=True, text=True)
        self.assertIn(told.returncode, (0, 5), told.stderr)
        rows = plumb.Monitor(array, calibration).run(plumb.read_log(array, str(log_csv)))
        lines = [json.loads(line) for line in verdicts.read_text().splitlines()]
        self.assertEqual(len(rows), len(lines))
        for row, line in zip(rows, lines):
            self.compare(array, row, line)
        return array, rows, lines

    def names(self, array, bits):
        return [sensor for i, sensor in enumerate(array.sensors) if int(bits) >> i & 1]

    def compare(self, array, row, line):
        n = len(array)
        for key in SETS:
            self.assertEqual(self.names(array, row[key]), line[key], key)
        for key, words in (("state", plumb.STATES), ("validity", plumb.VALIDITIES), ("cause", plumb.CAUSES),
                           ("decided_by", plumb.CAUSES), ("grade", plumb.GRADES)):
            self.assertEqual(words[row[key]], line[key], key)
        for key, words in (("qualifiers", plumb.QUALIFIERS), ("usable", plumb.USABLE)):
            self.assertEqual([word for k, word in enumerate(words) if int(row[key]) >> k & 1], line[key])
        for key in ("tick", "accepted", "alert", "protection_available", "wants_rotation", "transition", "faults_covered",
                    "confirmed_grade", "provisional_grade", "consistent_hypotheses", "stations_on_record", "triples_tested", "statistic",
                    "limit", "margin", "mae_all_mps2", "mae_worst_mps2", "mae_worst_limit_mps2", "parity", "parity_limit",
                    "norm_error_mps2", "noise_factor", "noise_correlation", "temperature_degc",
                    "temperature_rate_degc_per_min", "age_s"):
            self.assertEqual(row[key], line[key], key)
        for key in ("gravity_mps2", "latest_mps2"):
            self.assertEqual(list(row[key]), line[key], key)
        self.assertEqual(list(row["covariance"]), line["covariance_mps2_2"])
        self.assertEqual(row["time_s"], line["t_s"])
        self.assertEqual(row["triples_failing"], len(line["triples_failing"]))
        self.assertEqual(f"{int(row['config_hash']):016x}", line["config_hash"])
        self.assertEqual([plumb.CAUSES[c] for c in row["sensor_cause"][:n]], line["sensor_cause"])
        self.assertEqual([None if s == 255 else s for s in row["minimum_faults"][:n].tolist()], line["minimum_faults"])
        self.assertEqual([float(d) for d in row["drift_mps2_per_h"][:n]], line["drift_mps2_per_h"])
        for frame in ("calibrated_axes", "housing"):
            said, column = line[f"protection_level_{frame}_deg"], row[f"protection_level_{frame}_rad"]
            if said is None:
                self.assertTrue(math.isnan(column) and math.isnan(row["toolface_protection_housing_rad"]))
            else:
                self.assertAlmostEqual(math.degrees(column), said, 9)
        self.compare_parts(array, row, line)

    def compare_parts(self, array, row, line):
        if line["rotation"] is not None:
            along = line["rotation"]["along"]
            self.assertEqual(list(row["turn_along"]) if along is not None else None, along)
            self.assertEqual(row["turn_change_mps2"], line["rotation"]["change_mps2"])
            self.assertAlmostEqual(math.degrees(row["turn_angle_rad"]), line["rotation"]["angle_deg"], 9)
        reference = line["norm_mismatch"]
        self.assertEqual(plumb.NORM_MISMATCH_KINDS[row["norm_mismatch_kind"]], reference["kind"] if reference else "none")
        if reference is not None:
            self.assertEqual(row["norm_mismatch_attitudes"], reference["attitudes"])
            self.assertEqual(row["norm_mismatch_length_mps2"], reference["length_mps2"])
            self.assertEqual(row["gravity_to_configure_mps2"], reference.get("configure_mps2") or 0.0)
            self.assertEqual(list(row["norm_mismatch_bias_mps2"]), reference["bias_mps2"])
        told = line["calibration_contradicted"]
        self.assertEqual(row["calibration_contradicted"], told is not None)
        if told is not None:
            for key in ("attitudes", "ratio", "refused"):
                self.assertEqual(row["calibration_" + key], told[key])
        fit = line["recalibration"]
        if fit is not None:
            self.assertEqual(plumb.RECALIBRATION_PHASES[row["recalibration_phase"]], fit["phase"])
            for key in ("stations", "held_out", "offered"):
                self.assertEqual(row["recalibration_" + key], fit[key], key)
            self.assertEqual(row["stations_wanted"], fit["stations_wanted"])
            self.assertEqual(self.names(array, row["recalibration_lacking"]), fit["lacking"])
            self.assertEqual(plumb.error_text(row["recalibration_refusal"]) if fit["refused"] else None, fit["refused"])

    def simulated(self, name):
        csv = self.at / f"{name}.csv"
        told = subprocess.run([os.environ["PLUMB_TOOL"], "simulate", EXAMPLES / f"{name}.toml", "--out", csv],
                              capture_output=True, text=True)
        self.assertEqual(told.returncode, 0, told.stderr)
        return csv

    def changed(self, name, change):
        """The simulated log with other raw values."""
        lines = self.simulated(name).read_text().splitlines()
        first = lines[0].split(",").index("a1")
        cells = [line.split(",") for line in lines[1:]]
        raw = change(np.array([row[first : first + 4] for row in cells], dtype=float))
        path = self.at / "changed.csv"
        rows = (",".join(row[:first] + [repr(float(v)) for v in values]) for row, values in zip(cells, raw))
        path.write_text("\n".join([lines[0], *rows]) + "\n")
        return path

    def test_of_a_run_with_two_faults(self):
        array, rows, _ = self.both(self.text, self.simulated("drill_a"))
        bits = {name: 1 << k for k, name in enumerate(plumb.QUALIFIERS)}
        self.assertTrue((rows["qualifiers"] & bits["standstill_assumed"]).all())
        self.assertTrue((rows["qualifiers"][1:] & bits["stability_unstated"]).all())
        self.assertEqual(set(rows["faults_covered"]), {0, 1})
        changed = rows[rows["transition"] > 0]
        out = changed[changed["transition_sensors"] > 0][0]
        self.assertEqual(self.names(array, out["transition_sensors"]), ["a2"])
        self.assertEqual(plumb.EVENTS[out["transition_event"]], "exclusion")
        self.assertEqual(plumb.STATES[out["transition_to"]], "degraded")
        self.assertEqual(out["transition_time_s"], out["time_s"])
        self.assertEqual(list(rows["sample"]), list(range(1, len(rows) + 1)))

    def test_of_what_is_stated_and_of_noise_that_is_not_as_stated(self):
        keys = '[monitor]\nacceleration_bound = "1 mg0"\nstability = "50 ug0"\nalert_limit = "3 deg"\n'
        noise = np.random.default_rng(7)
        louder = self.changed("stand", lambda raw: raw + noise.normal(0.0, 0.0011, raw.shape))  # 2 sigma of 0.6 mV
        _, rows, _ = self.both(self.text.replace("[monitor]\n", keys, 1), louder)
        bits = {name: 1 << k for k, name in enumerate(plumb.QUALIFIERS)}
        self.assertFalse((rows["qualifiers"] & (bits["standstill_assumed"] | bits["stability_unstated"])).any())
        self.assertGreater(rows["noise_factor"][-1], 1.5)
        self.assertEqual(rows["noise_factor"][0], 1.0)

    def test_of_a_log_that_says_how_the_tool_turns(self):
        lines = self.simulated("stand").read_text().splitlines()
        turning = [",0,0,0", ",0.5,0,-0.1", ",0,,0"]  # the last: at a rate that is not known
        path = self.at / "turning.csv"
        rows = (line + turning[k // 400 % 3] for k, line in enumerate(lines[1:]))
        path.write_text("\n".join([lines[0] + ",wx,wy,wz", *rows]) + "\n")
        array, rows, _ = self.both(self.text.replace("[input]\n", '[input]\nrotation_radps = ["wx", "wy", "wz"]\n', 1), path)
        log = plumb.read_log(array, str(path))
        self.assertEqual([list(log.rate_radps[k]) for k in (0, 400)], [[0.0, 0.0, 0.0], [0.5, 0.0, -0.1]])
        self.assertTrue(np.isnan(log.rate_radps[800]).all())
        self.assertIsNone(log.second_rate_radps)
        plain = plumb.Log(log.time_s, log.raw, log.temperature_degc, station=log.station, count=log.count)
        calibration = plumb.Calibration.read(array, str(self.at / "cal.json"))
        self.assertNotEqual(plumb.Monitor(array, calibration).run(plain).tobytes(), rows.tobytes())

    def test_of_gravity_that_is_off(self):
        text = self.text.replace('value = "9.80665 m/s^2"', 'value = "9.77 m/s^2"')
        _, rows, _ = self.both(text, self.simulated("stand"))
        self.assertEqual(plumb.NORM_MISMATCH_KINDS[rows["norm_mismatch_kind"][-1]], "common_scale")
        self.assertAlmostEqual(rows["gravity_offset_mps2"][-1], 0.03665, 3)
        self.assertAlmostEqual(rows["gravity_to_configure_mps2"][-1], 9.80665, 3)
        self.assertAlmostEqual(rows["reference_mps2"][-1], 9.77, 6)

    def test_of_a_calibration_that_is_contradicted(self):
        shift_v = np.array([0.003, -0.002, -0.003, 0.002])
        shifted = self.changed("stand", lambda raw: raw + shift_v)
        _, rows, _ = self.both(self.text, shifted)
        self.assertTrue(rows["calibration_contradicted"][-1])
        self.assertGreater(rows["calibration_ratio"][-1], 1.0)
        self.assertGreater(rows["calibration_attitudes"][-1], 3)
        self.assertEqual(rows["calibration_ratio"][0], 0.0)

    def test_a_recorded_roll_test_validates_beforehand(self):
        array, stand = plumb.simulate(str(EXAMPLES / "stand.toml"))
        calibration = plumb.calibrate(array, stand)
        unproven = 1 << plumb.QUALIFIERS.index("not_yet_validated")
        still = plumb.Log(0.01 * np.arange(200), np.array(stand.raw[:200]))
        self.assertTrue((plumb.Monitor(array, calibration).run(still)["qualifiers"] & unproven).all())
        monitor = plumb.Monitor(array, calibration)
        monitor.run(stand)
        monitor.begin_time_base()
        rows = monitor.run(still)
        self.assertFalse((rows["qualifiers"] & unproven).any())
        self.assertTrue(rows["accepted"].all())
        self.assertEqual(plumb.VALIDITIES[rows["validity"][30]], "invalid")
        self.assertEqual(plumb.VALIDITIES[rows["validity"][31]], "valid")


if __name__ == "__main__":
    unittest.main()
