"""Chips with clocks of their own in Python: against the tool, row by row, and what is refused.

Run by ctest with PYTHONPATH (the module), PLUMB_TOOL (the tool) and PLUMB_SOURCE_DIR.
"""

import pathlib
import tempfile
import unittest

import numpy as np

import plumb
from motion_support import DEAD, SECOND_CHIP, SOURCE, STAND, as_the_tool_writes, tool

CLOCKS = SOURCE / "examples" / "motion" / "drone_clocks.toml"


class Clocks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        cls.array = plumb.Array.read(str(CLOCKS))
        tool("simulate", "--flight", "drone", CLOCKS, "--seed", 1, "--duration", 5, *DEAD, "--out", cls.at / "flight.csv")
        tool("simulate", STAND, "--out", cls.at / "stand.csv")
        cls.log = plumb.read_log(cls.array, str(cls.at / "flight.csv"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_run_is_what_the_tool_writes_one_row_per_common_instant(self):
        tool("monitor", "--array", CLOCKS, "--calibrate-first", "--log", self.at / "flight.csv", "--motion",
             self.at / "force.csv")
        rows = plumb.MotionMonitor(self.array).run(self.log)
        as_the_tool_writes(self, self.array, rows, self.at / "force.csv")
        self.assertLess(len(rows), len(self.log))
        np.testing.assert_allclose(np.diff(rows["time_s"]), 0.001, atol=1e-9)
        self.assertEqual(rows["excluded"][-1], SECOND_CHIP)

    def test_beside_rest_it_is_what_the_tool_writes(self):
        drone = plumb.Array.read(str(SOURCE / "examples" / "motion" / "drone.toml"))
        plumb.calibrate(drone, plumb.read_log(drone, str(self.at / "stand.csv"))).save(str(self.at / "cal.json"))
        calibration = plumb.Calibration.read(self.array, str(self.at / "cal.json"))
        tool("monitor", "--array", CLOCKS, "--calibration", self.at / "cal.json", "--log", self.at / "flight.csv", "--motion",
             self.at / "both.csv")
        at_rest, in_motion = plumb.run_both(plumb.Monitor(self.array, calibration),
                                            plumb.MotionMonitor(self.array, calibration), self.log)
        self.assertEqual(len(at_rest), len(self.log))
        as_the_tool_writes(self, self.array, in_motion, self.at / "both.csv")

    def test_rows_may_come_one_by_one(self):
        whole = plumb.MotionMonitor(self.array).run(self.log)
        motion, parts, log = plumb.MotionMonitor(self.array), [], self.log
        for k in range(1500):
            one = slice(k, k + 1)
            parts.append(motion.run(plumb.Log(log.time_s[one], log.raw[one], delivered=log.delivered[one],
                                              rate_radps=log.rate_radps[one], second_rate_radps=log.second_rate_radps[one],
                                              clock_s=log.clock_s[one])))
        self.assertEqual({len(part) for part in parts}, {0, 1})
        rows = sum(map(len, parts))
        self.assertGreater(rows, 300)
        self.assertEqual(b"".join(part.tobytes() for part in parts), whole[:rows].tobytes())

    def test_what_is_missing_is_refused_with_what_to_give(self):
        log = self.log
        motion = plumb.MotionMonitor(self.array)
        plain = plumb.Log(log.time_s, log.raw, rate_radps=log.rate_radps, second_rate_radps=log.second_rate_radps)
        with self.assertRaisesRegex(plumb.Error, "clock_s: is missing, and the array file states clocks of chips"):
            motion.run(plain)
        plain.clock_s = log.clock_s[:, :1]
        with self.assertRaisesRegex(plumb.Error, r"clock_s: has the shape \(\d+, 1\), must have \(\d+, 3\)"):
            motion.run(plain)
        with self.assertRaisesRegex(plumb.Error, "give the rows that have come to run, which goes on where it was"):
            motion.step(0.0, log.raw[0], log.rate_radps[0], log.second_rate_radps[0])


if __name__ == "__main__":
    unittest.main()
