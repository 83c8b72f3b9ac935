"""Simulate, calibrate, monitor; and hold what is called valid against the truth."""
import numpy as np

import plumb

array, stand = plumb.simulate("examples/stand.toml")
calibration = plumb.calibrate(array, stand)
_, run = plumb.simulate("examples/drilling.toml")  # a2 gets stuck at the sixth station
v = plumb.Monitor(array, calibration).run(run)

valid = v["tick"] & (v["validity"] == plumb.VALIDITIES.index("valid"))
g, truth = v["gravity_mps2"][valid], run.truth["gravity_mps2"][valid]
error_rad = np.linalg.norm(np.cross(g, truth), axis=1) / 9.8**2
print(f"{valid.sum()} blocks valid, {(error_rad > v['protection_level_calibrated_axes_rad'][valid]).sum()} beyond the protection level")
print(f"largest error {np.degrees(error_rad.max()):.3f} deg")
