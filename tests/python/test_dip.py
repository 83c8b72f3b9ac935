"""The dip from Python: four accelerometers of which one dies, a mirror fault that the length of gravity does not show.

Run by ctest with PYTHONPATH (the module) and PLUMB_SOURCE_DIR.
"""

import os
import pathlib
import unittest

import numpy as np

import plumb

TOOL = str(pathlib.Path(os.environ["PLUMB_SOURCE_DIR"]) / "examples" / "six_axis.toml")
NOISE_MPS2 = 0.003


def scattered(count, seed):
    v = np.random.default_rng(seed).normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1)[:, None]


class Dip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.array = plumb.Array.read(TOOL)
        cls.magnetic = plumb.Array.read(TOOL + "#mag")
        cls.calibration = plumb.calibrate(cls.array, cls.stay(scattered(30, 1)))

    @classmethod
    def stay(cls, downs, start_s=0.0, dead=(), fault_mps2=0.0, seed=2):
        """A log of 3 s at each attitude, turned for half a second in between."""
        random = np.random.default_rng(seed)
        rows = []
        for down in downs:
            g = cls.array.gravity_mps2 * cls.array.axes @ down
            still = g + random.normal(0.0, NOISE_MPS2, (200, 4))
            still[:, 1] += fault_mps2
            rows += [still, g + random.normal(0.0, 1.0, (25, 4))]
        raw = np.vstack(rows[:-1])
        raw[:, list(dead)] = np.nan
        return plumb.Log(start_s + np.arange(len(raw)) / 50.0, raw)

    def field(self, down):
        across = np.cross(down, [0.3, -0.5, 0.8])
        across /= np.linalg.norm(across)
        dip, total_nt = np.deg2rad(72.96), 51375.0
        return total_nt * (np.sin(dip) * down + np.cos(dip) * across)

    def three_left(self, last, fault_mps2=0.0):
        """A monitor after its validation, the death of sensor 0, and a block at the last attitude."""
        monitor = plumb.Monitor(self.array, self.calibration)
        monitor.run(self.stay(scattered(12, 3), 0.0))
        monitor.run(self.stay(scattered(4, 5), 100.0, dead=[0]))
        log = self.stay([last], 200.0, dead=[0], fault_mps2=fault_mps2)
        for k in range(len(log.time_s)):  # to the last block that is complete
            row = monitor.run(plumb.Log(log.time_s[k : k + 1], log.raw[k : k + 1]))[0]
            if row["tick"] and k > 120:
                break
        return monitor

    def test_three_healthy_sensors_are_consistent_and_bounded(self):
        down = np.array([0.5, 0.3, np.sqrt(1.0 - 0.34)])
        monitor = self.three_left(down)
        self.assertEqual(len(monitor.verdict["in_service"]), 3)
        report = plumb.DipWatch(monitor, self.magnetic).add(self.field(down), 20.0)
        self.assertEqual(report.verdict, "consistent", report.refusal)
        self.assertIsNone(report.named)
        angle = np.arccos(report.gravity_mps2 @ down / np.linalg.norm(report.gravity_mps2))
        self.assertLess(angle, report.protection_level_calibrated_axes_rad)
        self.assertLessEqual(report.protection_level_calibrated_axes_rad, report.protection_level_housing_rad)

    def test_a_mirror_fault_is_seen_and_named(self):
        down = np.array([0.5, 0.3, np.sqrt(1.0 - 0.34)])
        column = np.linalg.inv(self.array.axes[1:])[:, 0]
        mirror_mps2 = -2.0 * self.array.gravity_mps2 * (down @ column) / (column @ column)
        watch = plumb.DipWatch(self.three_left(down, mirror_mps2), self.magnetic)
        report = watch.add(self.field(down), 20.0)
        self.assertEqual(report.verdict, "fault", report.refusal)
        self.assertEqual(report.named, self.array.sensors[1])
        watch.forget()

    def test_four_in_service_are_not_judged(self):
        monitor = plumb.Monitor(self.array, self.calibration)
        monitor.run(self.stay(scattered(3, 3)))
        report = plumb.DipWatch(monitor, self.magnetic, "constant bias").add(self.field(np.array([0, 0, 1.0])), 20.0)
        self.assertEqual(report.verdict, "not_judged")
        self.assertFalse(report.protected_by_dip)

    def test_what_does_not_fit_is_refused(self):
        monitor = plumb.Monitor(self.array, self.calibration)
        for magnetic, assumption, words in (
            (self.array, "any fault", "measure gravity"),
            (plumb.Array.read(TOOL + "#gyros"), "any fault", "measure rate"),
            (self.magnetic, "often", "constant bias"),
        ):
            with self.assertRaisesRegex(plumb.Error, words):
                plumb.DipWatch(monitor, magnetic, assumption)
        with self.assertRaisesRegex(plumb.Error, "three numbers"):
            plumb.DipWatch(monitor, self.magnetic).add(np.zeros(4), 20.0)


if __name__ == "__main__":
    unittest.main()
