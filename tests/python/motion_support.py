"""What the tests of the monitor in motion share: the example, the tool, and its CSV beside the rows of the module."""

import csv
import os
import pathlib
import subprocess

import plumb

SOURCE = pathlib.Path(os.environ["PLUMB_SOURCE_DIR"])
DRONE = SOURCE / "examples" / "motion" / "drone.toml"
STAND = SOURCE / "examples" / "motion" / "stand.toml"
SECOND_CHIP = 0b000111000
DEAD = ("--fault", "imu2:stuck=0g0@3s")


def tool(*arguments, may_end=(0,)):
    told = subprocess.run([os.environ["PLUMB_TOOL"], *map(str, arguments)], capture_output=True, text=True)
    assert told.returncode in may_end, told.stderr
    return told


def with_gaps(from_path, to_path, gaps):
    """The log with these texts in place of numbers, each in a column from a row to another, and with 50 rows less."""
    with open(from_path, newline="") as file:
        head, *rows = list(csv.reader(file))
    for name, text, begin, end in gaps:
        for row in rows[begin:end]:
            row[head.index(name)] = text
    del rows[4500:4550]
    with open(to_path, "w", newline="") as file:
        csv.writer(file).writerows([head, *rows])


def names_of(array, bits):
    return [sensor for i, sensor in enumerate(array.sensors) if int(bits) >> i & 1]


def force_at(force, k):
    """One force of a row as the tool's CSV writes it: empty where there is none."""
    known = plumb.FORCE_VALIDITIES[force["validity"][k]] != "none"
    numbers = [force["time_s"][k], *force["force_mps2"][k], force["bound_mps2"][k]]
    return [n if known else None for n in numbers] + [
        plumb.FORCE_VALIDITIES[force["validity"][k]], plumb.FORCE_TERMS[force["dominant"][k]] if known else ""]


def as_the_tool_writes(test, array, rows, path):
    """Every cell of `plumb monitor --motion`, bit for bit: what it writes reads back as the number it was."""
    with open(path, newline="") as file:
        lines = list(csv.reader(file))[1:]
    test.assertEqual(len(lines), len(rows))

    for k, (line, row) in enumerate(zip(lines, rows)):
        block = force_at(rows["block"], k) if row["block_ended"] else 5 * [None] + ["", ""]
        sets = [" ".join(names_of(array, row[name])) for name in ("suspects", "isolated", "excluded")]
        expected = [row["time_s"], *force_at(rows["sample"], k), int(row["sample"]["gyro_assumed"]), *block,
                    int(row["alarm"]), *sets, plumb.MOTION_CAUSES[row["cause"]], int(row["gyros_disagree"])]
        test.assertEqual([one if isinstance(want, str) else float(one) if one else None
                          for one, want in zip(line, expected)], expected)
