"""The monitor in motion from Python, on simulated flights: against the fault, against itself, and against the tool.

Run by ctest with PYTHONPATH (the module), PLUMB_TOOL (the tool) and PLUMB_SOURCE_DIR.
"""

import csv
import json
import pathlib
import re
import tempfile
import threading
import unittest

import numpy as np

import plumb
from motion_support import DEAD, DRONE, SECOND_CHIP, SOURCE, STAND, as_the_tool_writes, names_of, tool, with_gaps


class Flights(unittest.TestCase):
    """A healthy flight and one in which a chip dies, of chips that come calibrated."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        cls.array = plumb.Array.read(str(DRONE))
        cls.healthy = cls.flown("healthy")
        cls.dead = cls.flown("dead", *DEAD)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def flown(cls, name, *options):
        path = cls.at / f"{name}.csv"
        tool("simulate", "--flight", "drone", DRONE, "--seed", 1, *options, "--out", path)
        return plumb.read_log(cls.array, str(path))

    def stepped(self, log, rows):
        motion = plumb.MotionMonitor(self.array)
        for k in range(rows):
            yield motion.step(log.time_s[k], log.raw[k], log.rate_radps[k], log.second_rate_radps[k])

    def test_the_log_has_the_rates_of_both_gyros(self):
        with open(self.at / "healthy.csv", newline="") as file:
            lines = list(csv.DictReader(file))
        for rates, names in ((self.healthy.rate_radps, "wx wy wz"), (self.healthy.second_rate_radps, "ux uy uz")):
            self.assertEqual(rates.shape, (len(lines), 3))
            for column, name in enumerate(names.split()):
                np.testing.assert_array_equal(rates[:, column], [float(line[name]) for line in lines])

    def test_a_healthy_flight_is_judged_without_alarm(self):
        rows = plumb.MotionMonitor(self.array).run(self.healthy)
        self.assertEqual(len(rows), len(self.healthy))
        self.assertFalse(rows["alarm"].any() or rows["gyros_disagree"].any())
        for figure in ("rejected", "suspects", "isolated", "excluded", "least_faults"):
            self.assertFalse(rows[figure].any(), figure)
        judged = rows["cause"] == plumb.MOTION_CAUSES.index("none")
        self.assertEqual(judged.sum(), len(rows) - 2)  # the first two have no neighbours yet
        self.assertTrue(np.isfinite(rows["block"]["bound_mps2"][rows["block_ended"]]).all())

    def test_a_dead_chip_is_isolated_and_nobody_else(self):
        rows = plumb.MotionMonitor(self.array).run(self.dead)
        self.assertEqual(set(rows["isolated"]), {0, SECOND_CHIP})
        self.assertEqual(set(rows["excluded"]), {0, SECOND_CHIP})
        self.assertFalse(rows["alarm"][rows["time_s"] < 3.0].any())
        isolated = rows["time_s"][rows["isolated"] != 0][0]
        excluded = rows["time_s"][rows["excluded"] != 0][0]
        self.assertLess(isolated, 3.01)
        self.assertAlmostEqual(excluded - isolated, 0.064, 9)
        later = rows[rows["time_s"] > isolated + 0.002]
        self.assertFalse((later["sample"]["used"] & SECOND_CHIP).any())
        self.assertEqual(rows["excluded"][-1], SECOND_CHIP)

    def test_a_calibration_that_is_saved_keeps_what_a_log_in_motion_showed(self):
        stand, cal, flight, fitted, again = (self.at / name for name in "stand.csv cal.json fly.csv fitted.json again.json".split())
        tool("simulate", STAND, "--out", stand)
        tool("calibrate", "--array", DRONE, "--log", stand, "--out", cal)
        tool("simulate", "--flight", "drone", DRONE, "--calibration", cal, "--duration", 20, "--seed", 3, "--out", flight)
        tool("calibrate", "--array", DRONE, "--calibration", cal, "--motion", flight, "--out", fitted)
        plumb.Calibration.read(self.array, str(fitted)).save(str(again))
        self.assertEqual(json.loads(again.read_text())["motion"], json.loads(fitted.read_text())["motion"])

    def test_a_gyro_that_died_beside_another_is_told_and_nobody_is_blamed(self):
        motion, told = plumb.MotionMonitor(self.array), []
        for k in range(3000):
            rate = np.zeros(3) if k >= 2000 else self.healthy.rate_radps[k]
            said = motion.step(self.healthy.time_s[k], self.healthy.raw[k], rate, self.healthy.second_rate_radps[k])
            self.assertEqual((said.alarm, said.isolated), (False, []))
            told.append(said.gyros_disagree)
        self.assertFalse(any(told[:2000]))
        self.assertTrue(told[-1])

    def test_the_force_is_within_its_bound_through_the_failure(self):
        truth_path = self.at / "truth.csv"
        tool("simulate", "--flight", "drone", DRONE, "--seed", 1, *DEAD, "--out", self.at / "again.csv", "--truth",
             truth_path)
        with open(truth_path, newline="") as file:
            truth = np.array([[float(line[f"f{axis}_mps2"]) for axis in "xyz"] for line in csv.DictReader(file)])
        rows = plumb.MotionMonitor(self.array).run(self.dead)
        force = rows["sample"]
        known = force["validity"] != plumb.FORCE_VALIDITIES.index("none")
        self.assertGreater(known.mean(), 0.99)
        at = force["time_s"][known]
        true = np.stack([np.interp(at, self.dead.time_s, truth[:, axis]) for axis in range(3)], axis=1)
        error = np.linalg.norm(force["force_mps2"][known] - true, axis=1)
        self.assertTrue((error < force["bound_mps2"][known]).all())
        self.assertTrue(np.isnan(force["force_mps2"][~known]).all())
        self.assertTrue(np.isinf(force["bound_mps2"][~known]).all())

    def test_step_and_run_agree_bit_for_bit(self):
        rows = plumb.MotionMonitor(self.array).run(self.dead)
        for row, said in zip(rows, self.stepped(self.dead, len(rows))):
            self.assertEqual(said.time_s, row["time_s"])
            self.assertEqual((said.alarm, said.gyros_disagree, said.block_ended, said.least_faults),
                             (row["alarm"], row["gyros_disagree"], row["block_ended"], row["least_faults"]))
            self.assertEqual(said.cause, plumb.MOTION_CAUSES[row["cause"]])
            for name in ("rejected", "suspects", "isolated", "excluded"):
                self.assertEqual(getattr(said, name), names_of(self.array, row[name]), name)
            for name in ("sample", "block"):
                self.compare(getattr(said, name), row[name])

    def compare(self, force, row):
        for name in ("time_s", "span_s", "force_mps2", "covariance_m2ps4", "bound_mps2"):
            self.assertEqual(np.asarray(getattr(force, name)).tobytes(), np.asarray(row[name]).tobytes(), name)
        self.assertEqual(force.validity, plumb.FORCE_VALIDITIES[row["validity"]])
        self.assertEqual(force.gyro_assumed, row["gyro_assumed"])
        self.assertEqual(force.used, names_of(self.array, row["used"]))
        self.assertEqual(force.dominant,
                         None if force.validity == "none" else plumb.FORCE_TERMS[row["dominant"]])

    def test_a_log_in_parts_goes_on_where_it_was(self):
        whole = plumb.MotionMonitor(self.array).run(self.dead)
        motion, log = plumb.MotionMonitor(self.array), self.dead
        parts = [motion.run(plumb.Log(log.time_s[part], log.raw[part], rate_radps=log.rate_radps[part],
                                      second_rate_radps=log.second_rate_radps[part]))
                 for part in (slice(None, 3011), slice(3011, None))]
        self.assertEqual([part.tobytes() for part in parts], [whole[:3011].tobytes(), whole[3011:].tobytes()])
        self.assertEqual(motion.verdict.excluded, ["x2", "y2", "z2"])
        self.assertEqual(motion.verdict.time_s, log.time_s[-1])

    def test_the_module_answers_as_plumb_monitor_writes(self):
        """Rates are missing, and rows; a sensor that is silent has rest to say something (test_motion_rest.py)."""
        with_gaps(self.at / "healthy.csv", self.at / "gaps.csv", (("wx", "", 1000, 1400), ("uz", "nan", 1200, 1600)))
        for name in ("healthy", "dead", "gaps"):
            told = self.at / f"{name}_force.csv"
            tool("monitor", "--array", DRONE, "--calibrate-first", "--log", self.at / f"{name}.csv", "--motion", told,
                 may_end=(0, 5))
            rows = plumb.MotionMonitor(self.array).run(plumb.read_log(self.array, str(self.at / f"{name}.csv")))
            as_the_tool_writes(self, self.array, rows, told)

    def test_what_rest_has_taken_out_is_not_judged(self):
        for sensors in (["x1", "y1", "z1", "x3", "y3", "z3"], np.uint32(0b111000111)):
            motion = plumb.MotionMonitor(self.array)
            motion.set_in_service(sensors)
            rows = motion.run(self.dead)
            self.assertFalse(rows["alarm"].any())
            self.assertFalse((rows["sample"]["used"] & SECOND_CHIP).any())

    def test_forget_takes_exclusions_back(self):
        motion = plumb.MotionMonitor(self.array)
        motion.run(self.dead)
        motion.forget()
        self.assertEqual(motion.verdict.excluded, [])

    def test_a_rate_that_is_no_number_was_not_delivered(self):
        silent = np.full_like(self.healthy.rate_radps, np.nan)
        half = np.array(self.healthy.rate_radps)
        half[:, 1] = np.nan
        by_second = []
        for rates in (silent, half):
            log = plumb.Log(self.healthy.time_s, self.healthy.raw, rate_radps=rates,
                            second_rate_radps=self.healthy.second_rate_radps)
            rows = plumb.MotionMonitor(self.array).run(log)
            self.assertFalse(rows["alarm"].any())
            self.assertTrue(np.isfinite(rows["block"]["bound_mps2"][-1]))
            by_second.append(rows.tobytes())
        self.assertEqual(*by_second)
        self.assertNotEqual(by_second[0], plumb.MotionMonitor(self.array).run(self.healthy).tobytes())

    def test_what_is_not_delivered_and_what_is_no_number_is_not_used(self):
        motion, log = plumb.MotionMonitor(self.array), self.healthy
        delivered = np.arange(9) != 0
        for k in range(40):
            raw = np.array(log.raw[k])
            raw[1] = np.nan
            said = motion.step(log.time_s[k], raw, log.rate_radps[k], log.second_rate_radps[k], temperature_degc=20,
                               delivered=delivered)
        self.assertEqual(said.sample.used, ["z1", "x2", "y2", "z2", "x3", "y3", "z3"])

    def test_vectors_are_in_the_output_frame(self):
        turned = plumb.Array.parse(DRONE.read_text() + "\n[output]\nframe = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]\n")
        plain = plumb.MotionMonitor(self.array).run(self.healthy)["block"][-1]
        there = plumb.MotionMonitor(turned).run(self.healthy)["block"][-1]
        np.testing.assert_allclose(there["force_mps2"], plain["force_mps2"][[1, 2, 0]], rtol=1e-12)
        np.testing.assert_allclose(np.diag(there["covariance_m2ps4"]), np.diag(plain["covariance_m2ps4"])[[1, 2, 0]],
                                   rtol=1e-9)


class Words(unittest.TestCase):
    """Figures, texts and refusals."""

    @classmethod
    def setUpClass(cls):
        cls.array = plumb.Array.read(str(DRONE))
        cls.motion = plumb.MotionMonitor(cls.array)
        cls.rows = 64
        cls.time_s = 0.001 * np.arange(cls.rows)
        cls.raw = np.tile([0.0, 0.0, 9.8], (cls.rows, 3))
        cls.rate = np.zeros((cls.rows, 3))

    def said(self, function, *arguments, **named):
        with self.assertRaises(plumb.Error) as caught:
            function(*arguments, **named)
        self.assertIn(". Remedy: ", str(caught.exception))
        return str(caught.exception)

    def log(self, **columns):
        return plumb.Log(**{"time_s": self.time_s, "raw": self.raw, "rate_radps": self.rate,
                            "second_rate_radps": self.rate, **columns})

    def test_every_figure_of_the_cpp_verdict_is_a_column_and_an_attribute(self):
        for header, struct, dtype, kind in (
            ("motion_monitor.hpp", "MotionVerdict", plumb.motion_dtype, plumb.MotionVerdict),
            ("motion_force.hpp", "SpecificForce", plumb.motion_dtype["sample"], plumb.SpecificForce),
            ("continuous_inclination.hpp", "InclinationInterval", plumb.motion_dtype["inclination"], plumb.Inclination),
        ):
            text = (SOURCE / "include" / "plumb" / "motion" / header).read_text()
            body = text[text.index(f"struct {struct} {{"):].split("\n};")[0]
            members = re.findall(r"^  [\w:]+ (\w+)(?:\{\}| = [^;]+)?;", body, re.M)
            self.assertGreaterEqual(len(members), 8, struct)
            self.assertLessEqual(set(members), set(dtype.names))
            for member in members:
                self.assertGreater(len(getattr(kind, member).__doc__), 10, member)
        self.assertEqual(plumb.motion_dtype["sample"], plumb.motion_dtype["block"])

    def test_every_column_says_what_it_is_and_in_which_unit(self):
        self.assertEqual(tuple(plumb.MOTION_FIELDS), plumb.motion_dtype.names)
        self.assertEqual(tuple(plumb.FORCE_FIELDS), plumb.motion_dtype["sample"].names)
        self.assertEqual(tuple(plumb.INCLINATION_FIELDS), plumb.motion_dtype["inclination"].names)
        units = {"_mps2": "[m/s^2]", "_m2ps4": "[(m/s^2)^2]", "_rad": "[rad]", "_s": "[s]"}
        for name, text in [*plumb.MOTION_FIELDS.items(), *plumb.FORCE_FIELDS.items(), *plumb.INCLINATION_FIELDS.items()]:
            self.assertGreater(len(text), 10, name)
            for end, unit in units.items():
                if name.endswith(end):
                    self.assertIn(unit, text, name)
            if named := re.search(r"index into ([A-Z_]+)", text):
                self.assertGreaterEqual(len(getattr(plumb, named.group(1))), 3, name)

    def test_the_names_are_those_of_the_interface(self):
        page = (SOURCE / "docs" / "stable-interface.md").read_text()
        for title, names in (("causes in motion", plumb.MOTION_CAUSES), ("validities in motion", plumb.FORCE_VALIDITIES),
                             ("parts of a bound", plumb.FORCE_TERMS),
                             ("statuses of an inclination", plumb.INCLINATION_STATUSES),
                             ("parts of an interval", plumb.INCLINATION_TERMS)):
            listed = re.search(rf"<!-- names: {title} -->\n```\n(.*?)\n```", page, re.S).group(1)
            self.assertEqual(list(names), re.split(r"\n|  ", listed))

    def test_it_says_what_it_is(self):
        for thing in (plumb.MotionMonitor, plumb.MotionMonitor.run, plumb.MotionMonitor.step, plumb.run_both,
                      plumb.Monitor.set_motion, plumb.Monitor.settles_motion, plumb.MotionMonitor.forget):
            self.assertGreater(len(thing.__doc__), 60, thing)
        verdict = plumb.MotionMonitor(self.array).verdict
        self.assertTrue(np.isnan(verdict.time_s))
        self.assertIn("isolated []", repr(verdict))
        self.assertIn("plumb.SpecificForce none", repr(verdict.block))

    def test_what_is_missing_in_the_array_file_is_told(self):
        plain = plumb.Array.read(str(SOURCE / "examples" / "paper_tool.toml"))
        self.assertIn("paper_tool.toml: motion: is missing", self.said(plumb.MotionMonitor, plain))
        text = DRONE.read_text()
        for key, field in (("lag_bound_s = 70e-6", "motion.lag_bound_s"), ("noise_radps", "gyro.noise_radps"),
                           ("sample_period_s", "motion.sample_period_s")):
            lacking = "\n".join(line for line in text.splitlines() if not line.startswith(key))
            told = self.said(plumb.MotionMonitor, plumb.Array.parse(lacking))
            self.assertIn(f"{field}: is missing: motion is not judged", told)

    def test_shapes_are_refused_with_what_is_needed(self):
        self.assertIn("raw: has the shape (64, 8), must have (64, 9)",
                      self.said(self.motion.run, self.log(raw=self.raw[:, :8])))
        self.assertIn("rate_radps: has the shape (64, 2), must have (64, 3). Remedy: give one row per sample and one column "
                      "per axis", self.said(self.motion.run, self.log(rate_radps=self.rate[:, :2])))
        self.assertIn("second_rate_radps: has the shape (63, 3), must have (64, 3)",
                      self.said(self.motion.run, self.log(second_rate_radps=self.rate[1:])))
        raw, rate = self.raw[0], self.rate[0]
        for arguments, named, text in (
            ((0.0, raw[:8], rate, rate), {}, "raw: has the shape (8), must have (9). Remedy: give one value per sensor"),
            ((0.0, self.raw, rate, rate), {}, "raw: has the shape (64, 9), must have (9)"),
            ((0.0, raw, rate[:2], rate), {}, "rate_radps: has the shape (2), must have (3)"),
            ((0.0, raw, rate, 1.0), {}, "second_rate_radps: has the shape (), must have (3)"),
            ((0.0, raw, rate, rate), {"delivered": [True]}, "delivered: has the shape (1), must have (9)"),
            ((0.0, "raw", rate, rate), {}, "raw: is not an array of numbers"),
            ((0.0, [1, [2]], rate, rate), {}, "raw: is not an array of numbers"),
            ((0.0, None, rate, rate), {}, "raw: is not an array of numbers"),
            ((0.0, np.ma.masked_array(raw), rate, rate), {}, "raw: is a masked array"),
            ((0.0, raw, np.ma.masked_array(rate), rate), {}, "rate_radps: is a masked array"),
        ):
            self.assertIn(text, self.said(self.motion.step, *arguments, **named))

    def test_times_that_are_no_numbers_are_refused_before_anything_is_judged(self):
        for value in (np.nan, np.inf, -np.inf):
            time_s = np.array(self.time_s)
            time_s[40] = value
            motion = plumb.MotionMonitor(self.array)
            self.assertIn(f"time_s: row 40 is {value}, must be finite", self.said(motion.run, self.log(time_s=time_s)))
            self.assertTrue(np.isnan(motion.verdict.time_s))
            self.assertIn(f"time_s: is {value}, must be finite",
                          self.said(motion.step, value, self.raw[0], self.rate[0], self.rate[0]))

    def test_rates_are_those_that_the_array_file_names(self):
        self.assertIn("rate_radps: is missing, and the array file names a gyro in input.rotation_radps",
                      self.said(self.motion.run, plumb.Log(self.time_s, self.raw)))
        self.assertIn("second_rate_radps: is missing, and the array file names a gyro in input.second_rotation_radps",
                      self.said(self.motion.step, 0.0, self.raw[0], self.rate[0]))
        one = plumb.Array.parse("\n".join(line for line in DRONE.read_text().splitlines()
                                          if not line.startswith("second_rotation_radps")))
        motion = plumb.MotionMonitor(one)
        motion.step(0.0, self.raw[0], self.rate[0])
        self.assertIn("second_rate_radps: is given, and the array file names no such gyro",
                      self.said(motion.step, 0.001, self.raw[0], self.rate[0], self.rate[0]))

    def test_a_sample_out_of_step_is_not_judged(self):
        motion = plumb.MotionMonitor(self.array)
        motion.run(self.log())
        self.assertEqual(motion.verdict.cause, "none")
        again = motion.run(self.log())  # its times have been
        self.assertEqual(plumb.MOTION_CAUSES[again["cause"][0]], "irregular_time")
        self.assertEqual(plumb.MOTION_CAUSES[again["cause"][-1]], "none")

    def test_any_value_is_taken(self):
        for value in (np.nan, np.inf, -np.inf, 1e308):
            raw = np.array(self.raw)
            raw[:, 0] = value
            rows = plumb.MotionMonitor(self.array).run(self.log(raw=raw, temperature_degc=value))
            self.assertFalse((rows["sample"]["used"][2:] & 1).any())
            self.assertTrue(np.isfinite(rows["sample"]["force_mps2"][-1]).all())

    def test_what_belongs_to_another_array_is_refused(self):
        other = plumb.Array.parse(DRONE.read_text().replace('id = "x1"', 'id = "q1"'))
        _, stand = plumb.simulate(str(STAND))
        calibration = plumb.calibrate(self.array, stand)
        said = self.said(plumb.MotionMonitor, other, calibration)
        self.assertIn("the calibration was made for another array", said)
        monitor = plumb.Monitor(self.array, calibration)
        theirs = plumb.MotionMonitor(other)
        self.assertIn("the two monitors are of different arrays", self.said(plumb.run_both, monitor, theirs, self.log()))
        self.assertIn("found: is of another array", self.said(monitor.set_motion, theirs.verdict))
        self.assertIn('"q1" is not a sensor', self.said(self.motion.set_in_service, ["q1"]))
        self.assertIn("bits beyond the 9 sensors", self.said(self.motion.set_in_service, 1 << 9))
        self.assertIn("days_since_calibration: must be 0 or more",
                      self.said(plumb.MotionMonitor, self.array, days_since_calibration=-1.0))
        for function, arguments in ((plumb.MotionMonitor, (None,)), (plumb.run_both, (monitor, None, self.log())),
                                    (self.motion.set_in_service, (None,)), (self.motion.run, (None,))):
            with self.assertRaises(TypeError):
                function(*arguments)

    def test_a_monitor_is_for_one_thread_at_a_time(self):
        motion = plumb.MotionMonitor(self.array)
        rows = 400000
        long = plumb.Log(0.001 * np.arange(rows), np.tile(self.raw[:1], (rows, 1)), rate_radps=np.zeros((rows, 3)),
                         second_rate_radps=np.zeros((rows, 3)))
        runner = threading.Thread(target=motion.run, args=(long,))
        runner.start()
        refusals = set()
        while runner.is_alive():
            for ask in (lambda: motion.verdict, motion.forget, lambda: motion.run(self.log()),
                        lambda: motion.step(0.0, self.raw[0], self.rate[0], self.rate[0]),
                        lambda: motion.set_in_service(7)):
                try:
                    ask()
                except plumb.Error as error:
                    refusals.add(str(error))
        runner.join()
        self.assertEqual(len(refusals), 1, refusals)
        self.assertIn("the monitor runs in another thread", refusals.pop())


if __name__ == "__main__":
    unittest.main()
