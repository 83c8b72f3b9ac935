"""A property of one's own array with Hypothesis: whatever one sensor does, no other is taken out, and what plumb calls
valid is true. An example for users: put your own array and scenario in the place of this one."""

import os
import pathlib
import sys
import unittest

import numpy as np

try:
    from hypothesis import given, settings
    from hypothesis import strategies as st
except ImportError:
    print("skipped: Hypothesis is not installed (Debian: apt-get install python3-hypothesis)")
    sys.exit(77)

import plumb

EXAMPLES = pathlib.Path(os.environ["PLUMB_SOURCE_DIR"]) / "examples"
ARRAY, STAND = plumb.simulate(str(EXAMPLES / "stand.toml"))
CALIBRATION = plumb.calibrate(ARRAY, STAND)
TRUTH = STAND.truth["gravity_mps2"]


class OneFault(unittest.TestCase):
    found = 0  # examples in which the faulty sensor was taken out: the property is not about runs without an event

    @classmethod
    def tearDownClass(cls):
        assert cls.found >= 5, f"only {cls.found} faults were found"

    @settings(max_examples=25, deadline=None, derandomize=True)
    @given(
        sensor=st.integers(0, len(ARRAY) - 1),
        begin=st.floats(0.0, 0.9),
        bias=st.floats(-5.0, 5.0),
        scale=st.floats(-2.0, 2.0),
    )
    def test_nobody_else_is_blamed_and_valid_is_true(self, sensor, begin, bias, scale):
        raw = np.array(STAND.raw)
        start = int(begin * len(raw))
        raw[start:, sensor] = raw[start:, sensor] * scale + bias
        log = plumb.Log(STAND.time_s, raw, STAND.temperature_degc, station=STAND.station)
        rows = plumb.Monitor(ARRAY, CALIBRATION).run(log)
        OneFault.found += bool(rows["excluded"][-1])
        others = ~np.uint32(1 << sensor)
        self.assertFalse(((rows["excluded"] | rows["provisionally_excluded"]) & others).any())
        valid = (rows["validity"] == plumb.VALIDITIES.index("valid")) & rows["tick"]
        g = rows["gravity_mps2"][valid]
        cross = np.linalg.norm(np.cross(g, TRUTH[valid]), axis=1)
        angle = np.arctan2(cross, (g * TRUTH[valid]).sum(axis=1))
        self.assertTrue((angle <= rows["protection_level_calibrated_axes_rad"][valid]).all())


if __name__ == "__main__":
    unittest.main()
