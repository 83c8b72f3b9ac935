"""Redundant gyros from Python: the group of examples/six_axis.toml, against the fault, against itself, and refused.

Run by ctest with PYTHONPATH (the module) and PLUMB_SOURCE_DIR.
"""

import os
import pathlib
import unittest

import numpy as np

import plumb

TOOL = str(pathlib.Path(os.environ["PLUMB_SOURCE_DIR"]) / "examples" / "six_axis.toml")
DEGREE = np.pi / 180.0


class Rates(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gyros = plumb.Array.read(TOOL + "#gyros")
        cls.period_s = 0.02  # 50 Hz

    def turning(self, rows, spoil=lambda raw, t: None, rate=True, seed=1):
        """A log [deg/s] of a tool that turns smoothly, or stands."""
        t = self.period_s * np.arange(rows)
        turn = np.column_stack([0.8 * np.sin(0.5 * t), 0.5 * np.cos(0.3 * t), 0.3 * np.sin(0.2 * t)]) * rate
        raw = turn @ self.gyros.axes.T / DEGREE + np.random.default_rng(seed).normal(0.0, 0.05, (rows, 6))
        spoil(raw, t)
        return plumb.Log(t, raw), turn

    def test_healthy_axes_give_a_rate_within_its_bound_and_no_alarm(self):
        log, turn = self.turning(600)
        rows = plumb.RateMonitor(self.gyros).run(log)
        self.assertEqual(rows.dtype, plumb.rates_dtype)
        self.assertFalse(rows["alarm"].any() or rows["suspects"].any() or rows["turned_at_rest"].any())
        sample = rows["sample"][2:]
        self.assertTrue((sample["validity"] == plumb.FORCE_VALIDITIES.index("bounded")).all())
        k = np.rint(sample["time_s"] / self.period_s).astype(int)
        error = np.linalg.norm(sample["rate_radps"] - turn[k], axis=1)
        self.assertTrue((error < sample["bound_radps"]).all())
        self.assertLess(sample["bound_radps"].max(), 0.3)

    def test_the_axis_that_sticks_is_excluded_and_no_other(self):
        def stick(raw, t):
            raw[t > 4.0, 3] = 0.0

        rows = plumb.RateMonitor(self.gyros).run(self.turning(900, stick)[0])
        self.assertEqual(rows["excluded"][-1], 1 << 3)
        self.assertFalse((rows["excluded"] & ~np.uint32(1 << 3)).any())
        self.assertFalse(rows["alarm"][rows["time_s"] <= 4.0].any())
        self.assertEqual(rows["sample"]["used"][-1], 0b110111)

    def test_at_rest_a_turn_of_the_tool_blames_nobody(self):
        log, _ = self.turning(200, lambda raw, t: raw.__iadd__(self.gyros.axes @ [0.0, 0.0, 3.0]), rate=False)
        rest = np.ones(200, dtype=bool)
        rows = plumb.RateMonitor(self.gyros).run(log, at_rest=rest, force_mps2=np.full(200, 9.81))
        self.assertTrue(rows["turned_at_rest"][-1])
        self.assertFalse(rows["isolated"].any())
        moving = plumb.RateMonitor(self.gyros).run(log)
        self.assertFalse(moving["turned_at_rest"].any())

    def test_a_run_goes_on_where_the_last_one_ended(self):
        def offset(raw, t):
            raw[t > 2.0, 1] += 30.0

        log, _ = self.turning(400, offset)
        whole = plumb.RateMonitor(self.gyros).run(log)
        monitor = plumb.RateMonitor(self.gyros)
        for a, b in ((0, 1), (1, 150), (150, 400)):
            part = monitor.run(plumb.Log(log.time_s[a:b], log.raw[a:b]))
            self.assertEqual(part.tobytes(), whole[a:b].tobytes())
        self.assertTrue(whole["excluded"][-1])
        monitor.forget()
        later = plumb.Log(log.time_s[:1] + 400 * self.period_s, log.raw[:1])
        self.assertFalse(monitor.run(later)["excluded"].any())

    def test_every_figure_is_explained(self):
        self.assertEqual(set(plumb.RATES_FIELDS), set(plumb.rates_dtype.names))
        self.assertEqual(set(plumb.RATE_FIELDS), set(plumb.rates_dtype["sample"].names))

    def test_what_is_no_group_of_gyros_is_refused(self):
        with self.assertRaisesRegex(plumb.Error, "gravity.*field = \"rate\""):
            plumb.RateMonitor(plumb.Array.read(TOOL))
        log, _ = self.turning(10)
        monitor = plumb.RateMonitor(self.gyros)
        for name in ("at_rest", "force_mps2"):
            with self.assertRaisesRegex(plumb.Error, name):
                monitor.run(log, **{name: np.zeros(9)})
        with self.assertRaises(plumb.Error):
            monitor.run(plumb.Log(log.time_s, log.raw[:, :5]))


if __name__ == "__main__":
    unittest.main()
