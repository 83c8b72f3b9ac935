"""Monitor a CSV log: an array file, a calibration, the log; what changed, and how much of the output is valid."""
import sys

import plumb

array = plumb.Array.read(sys.argv[1])
monitor = plumb.Monitor(array, plumb.Calibration.read(array, sys.argv[2]))
verdicts = monitor.run(plumb.read_log(array, sys.argv[3]))  # a numpy structured array, one row per sample

previous = None
for v in verdicts:
    if v["state"] != previous:
        out = [name for i, name in enumerate(array.sensors) if v["excluded"] >> i & 1]
        print(f"{v['time_s']:6.2f} s  {plumb.STATES[v['state']]:9}  excluded: {', '.join(out) or 'none'}")
    previous = v["state"]
valid = verdicts["validity"] == plumb.VALIDITIES.index("valid")
print(f"valid: {100 * valid.mean():.0f} %")
