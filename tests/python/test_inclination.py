"""Inclination in motion from Python: of a drill string that rotates, against the tool.

Run by ctest with PYTHONPATH (the module), PLUMB_TOOL (the tool) and PLUMB_SOURCE_DIR.
"""

import csv
import pathlib
import tempfile
import unittest

import numpy as np

import plumb
from motion_support import DRONE, tool

KNOWN = plumb.INCLINATION_STATUSES.index("known")
ANGLES = ("inclination_rad", "low_rad", "high_rad")


class ADrillString(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        text = DRONE.read_text().replace("rate_bound_radps = 8", "rate_bound_radps = 25")
        stated = text.replace("[motion]\n", "[motion]\nvelocity_bound_mps = 2\ninclination_window_s = 2\n")
        for name, of in (("plain", text), ("array", stated)):
            (cls.at / f"{name}.toml").write_text(of)
        tool("simulate", "--flight", "drilling", cls.at / "array.toml", "--seed", 4, "--out", cls.at / "flight.csv")
        cls.array = plumb.Array.read(str(cls.at / "array.toml"))
        cls.log = plumb.read_log(cls.array, str(cls.at / "flight.csv"))
        cls.rows = plumb.MotionMonitor(cls.array).run(cls.log)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def windows(self):
        return self.rows["inclination"][self.rows["inclination_ended"]]

    def test_windows_are_those_that_plumb_monitor_writes(self):
        told = self.at / "inclination.csv"
        tool("monitor", "--array", self.at / "array.toml", "--calibrate-first", "--log", self.at / "flight.csv",
             "--inclination", told, may_end=(0, 5))
        with open(told, newline="") as file:
            lines = list(csv.DictReader(file))
        windows = self.windows()
        self.assertEqual(len(lines), len(windows))
        for line, window in zip(lines, windows):
            self.assertEqual(line["status"], plumb.INCLINATION_STATUSES[window["status"]])
            self.assertEqual(line["widest"], plumb.INCLINATION_TERMS[window["widest"]])
            self.assertEqual(float(line["t_s"]), window["time_s"])
            for name in ANGLES:
                self.assertAlmostEqual(float(line[name.replace("_rad", "_deg")]), np.degrees(window[name]), 9)

    def test_one_inclination_is_in_all_of_them(self):
        windows = self.windows()
        self.assertEqual(len(windows), 5)
        self.assertTrue((windows["status"] == KNOWN).all())
        self.assertLess(windows["low_rad"].max(), windows["high_rad"].min())
        self.assertTrue((windows["low_rad"] < windows["inclination_rad"]).all())

    def test_step_says_the_same(self):
        motion = plumb.MotionMonitor(self.array)
        for k, row in enumerate(self.rows[:2500]):
            said = motion.step(self.log.time_s[k], self.log.raw[k], self.log.rate_radps[k],
                               self.log.second_rate_radps[k])
            self.assertEqual(said.inclination_ended, row["inclination_ended"])
            self.assertEqual(said.inclination.status, plumb.INCLINATION_STATUSES[row["inclination"]["status"]])
            for name in ANGLES:
                self.assertEqual(np.float64(getattr(said.inclination, name)).tobytes(),
                                 row["inclination"][name].tobytes())
        self.assertEqual(motion.verdict.inclination.status, "known")
        self.assertIn("plumb.Inclination known", repr(motion.verdict.inclination))

    def test_without_a_rate_there_is_none_and_it_says_so(self):
        silent = np.full_like(self.log.rate_radps, np.nan)
        motion = plumb.MotionMonitor(self.array)
        rows = motion.run(plumb.Log(self.log.time_s, self.log.raw, rate_radps=silent, second_rate_radps=silent))
        self.assertFalse((rows["inclination"]["status"] == KNOWN).any())
        self.assertTrue(all(np.isnan(rows["inclination"][name]).all() for name in ANGLES))
        self.assertIsNone(motion.verdict.inclination.widest)

    def test_without_a_bound_of_the_velocity_there_is_none(self):
        motion = plumb.MotionMonitor(plumb.Array.read(str(self.at / "plain.toml")))
        rows = motion.run(self.log)
        self.assertFalse(rows["inclination_ended"].any())
        self.assertTrue(np.isnan(rows["inclination"]["inclination_rad"]).all())
        self.assertIsNone(motion.verdict.inclination)


if __name__ == "__main__":
    unittest.main()
