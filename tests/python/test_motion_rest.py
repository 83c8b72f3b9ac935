"""The monitor in motion beside the one at rest: against the tool, and sample by sample.

Run by ctest with PYTHONPATH (the module), PLUMB_TOOL (the tool) and PLUMB_SOURCE_DIR.
"""

import json
import pathlib
import tempfile
import unittest

import numpy as np

import plumb
from motion_support import DEAD, DRONE, SECOND_CHIP, STAND, as_the_tool_writes, names_of, tool, with_gaps


class BesideRest(unittest.TestCase):
    """Calibrated on a stand; the run stands still, flies with a chip that dies, and stands again with that chip alive."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        cls.array = plumb.Array.read(str(DRONE))
        tool("simulate", STAND, "--out", cls.at / "stand.csv")
        cls.stand = plumb.read_log(cls.array, str(cls.at / "stand.csv"))
        cls.calibration = plumb.calibrate(cls.array, cls.stand)
        cls.calibration.save(str(cls.at / "cal.json"))
        tool("simulate", "--flight", "drone", DRONE, "--calibration", cls.at / "cal.json", "--seed", 1, *DEAD, "--out",
             cls.at / "flight.csv")
        cls.log = cls.written_run()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def written_run(cls):
        """A second without a sample lies between the parts: no tool goes from rest to flight within a sample."""
        flight = plumb.read_log(cls.array, str(cls.at / "flight.csv"))
        noise = np.random.default_rng(3)
        level = cls.calibration.axes @ np.array([0.0, 0.0, cls.array.gravity_mps2])  # specific force: upwards
        still = cls.calibration.scale[:, 0] * (level + cls.calibration.bias_mps2[:, 0])
        parts, start_s = [], 0.0
        for rows, raw, rates, second in (
            (4000, still + noise.normal(0.0, 0.02, (4000, 9)), np.zeros((4000, 3)), np.zeros((4000, 3))),
            (6000, flight.raw[:6000], flight.rate_radps[:6000], flight.second_rate_radps[:6000]),
            (4000, still + noise.normal(0.0, 0.02, (4000, 9)), np.zeros((4000, 3)), np.zeros((4000, 3))),
        ):
            parts.append(np.column_stack([start_s + 0.001 * np.arange(rows), rates, second, raw]))
            start_s = parts[-1][-1, 0] + 1.0
        run = np.concatenate(parts)
        path = cls.at / "run.csv"
        head = "t_s,wx,wy,wz,ux,uy,uz," + ",".join(cls.array.sensors)
        path.write_text("\n".join([head, *(",".join(map(repr, map(float, row))) for row in run)]) + "\n")
        return plumb.read_log(cls.array, str(path))

    def monitors(self):
        """With the stand as the roll test."""
        monitor = plumb.Monitor(self.array, self.calibration)
        monitor.run(self.stand)
        monitor.begin_time_base()
        return monitor, plumb.MotionMonitor(self.array, self.calibration)

    def both_as_the_tool(self, log):
        told, verdicts = self.at / "force.csv", self.at / "verdicts.jsonl"
        tool("monitor", "--array", DRONE, "--calibration", self.at / "cal.json", "--roll-test", self.at / "stand.csv",
             "--log", log, "--motion", told, "--verdicts", verdicts, "--every-sample")
        at_rest, in_motion = plumb.run_both(*self.monitors(), plumb.read_log(self.array, str(log)))
        as_the_tool_writes(self, self.array, in_motion, told)
        lines = verdicts.read_text().splitlines()
        self.assertEqual(len(lines), len(at_rest))
        for line, row in zip(map(json.loads, lines), at_rest):
            self.assertEqual(line["state"], plumb.STATES[row["state"]])
            self.assertEqual(line["cause"], plumb.CAUSES[row["cause"]])
            self.assertEqual(line["gravity_mps2"], list(row["gravity_mps2"]))
            self.assertEqual(line["statistic"], row["statistic"])
            self.assertEqual(line["in_service"], names_of(self.array, row["in_service"]))
        return at_rest, in_motion

    def test_both_answer_as_plumb_monitor_does(self):
        self.both_as_the_tool(self.at / "run.csv")

    def test_both_answer_as_plumb_monitor_does_where_numbers_are_missing(self):
        with_gaps(self.at / "run.csv", self.at / "gaps.csv", (
            ("wx", "", 4800, 5200), ("uz", "nan", 5000, 5400), ("x1", "", 5500, 5700), ("y3", "nan", 5600, 5800),
            ("z3", "156.9", 5900, 5950), ("wy", "", 11000, 11100)))
        at_rest, in_motion = self.both_as_the_tool(self.at / "gaps.csv")
        self.assertTrue((at_rest["absent"] & 1).any())
        self.assertTrue((in_motion["sample"]["used"][(at_rest["absent"] & 1) != 0] & 1 == 0).all())

    def test_rest_takes_up_what_motion_found_and_motion_forgets_what_rest_has_judged(self):
        at_rest, in_motion = plumb.run_both(*self.monitors(), self.log)
        changes = at_rest[at_rest["transition"] > 0]
        from_motion = changes[changes["transition_cause"] == plumb.CAUSES.index("parity_in_motion")]
        self.assertEqual([plumb.EVENTS[event] for event in from_motion["transition_event"]],
                         ["alarm", "provisional_exclusion"])
        self.assertEqual(from_motion["transition_sensors"][-1], SECOND_CHIP)
        found = np.flatnonzero(in_motion["alarm"])[0]
        self.assertEqual(from_motion["time_s"][0], in_motion["time_s"][found + 1])  # one row later
        settled = np.flatnonzero(np.diff((in_motion["excluded"] == SECOND_CHIP).astype(int)) < 0)
        self.assertEqual(len(settled), 1)
        judged = at_rest[settled[0] + 1]
        self.assertEqual(plumb.EVENTS[judged["transition_event"]], "passed_block")
        self.assertEqual(judged["provisionally_excluded"], SECOND_CHIP)

    def test_sample_by_sample_it_is_the_same(self):
        at_rest, in_motion = plumb.run_both(*self.monitors(), self.log)
        monitor, motion = self.monitors()
        log, found, settled = self.log, motion.verdict, 0
        for k in range(len(log)):
            monitor.set_motion(found)
            one = slice(k, k + 1)
            row = monitor.run(plumb.Log(log.time_s[one], log.raw[one], rate_radps=log.rate_radps[one]))[0]
            self.assertEqual(row.tobytes(), at_rest[k].tobytes(), k)
            if monitor.settles_motion:
                settled += 1
                motion.forget()
            motion.set_in_service(row["in_service"])
            found = motion.step(log.time_s[k], log.raw[k], log.rate_radps[k], log.second_rate_radps[k])
            self.assertEqual(found.block.bound_mps2, in_motion["block"]["bound_mps2"][k])
            self.assertEqual(found.excluded, names_of(self.array, in_motion["excluded"][k]))
        self.assertEqual(settled, 1)

    def test_a_finding_may_be_taken_back(self):
        monitor, motion = self.monitors()
        alarmed = next(said for said in (motion.step(*row) for row in zip(
            self.log.time_s, self.log.raw, self.log.rate_radps, self.log.second_rate_radps)) if said.alarm)
        flight = plumb.Log(self.log.time_s[5000:5100], self.log.raw[5000:5100],
                           rate_radps=self.log.rate_radps[5000:5100])
        monitor.set_motion(alarmed)
        monitor.set_motion(None)
        self.assertFalse((monitor.run(flight)["transition_cause"] == plumb.CAUSES.index("parity_in_motion")).any())
        monitor, _ = self.monitors()
        monitor.set_motion(alarmed)
        self.assertTrue((monitor.run(flight)["transition_cause"] == plumb.CAUSES.index("parity_in_motion")).any())

    def test_rest_goes_by_the_rates_of_the_log(self):
        """As plumb monitor does; a log that has none does not turn, whatever the one before said."""
        still = plumb.Log(self.log.time_s[:4000], self.log.raw[:4000])
        turning = plumb.Log(still.time_s, still.raw, rate_radps=np.full((4000, 3), 0.5))
        plain = self.monitors()[0].run(still)
        self.assertTrue(plain["tick"].any())
        self.assertNotEqual(self.monitors()[0].run(turning).tobytes(), plain.tobytes())
        monitor = self.monitors()[0]
        monitor.run(turning)
        monitor.begin_time_base()
        states = monitor.run(still)["validity"]
        self.assertEqual(plumb.VALIDITIES[states[-1]], plumb.VALIDITIES[plain["validity"][-1]])


if __name__ == "__main__":
    unittest.main()
