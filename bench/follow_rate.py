#!/usr/bin/env python3
"""Does `plumb monitor --follow` keep up? Appends rows to a log at a fixed rate, as a recorder does, and times every
verdict from the moment its last sample was appended.

    bench/follow_rate.py [--plumb build/release/plumb] [--rate 10000] [--seconds 20] [--stdin]

Prints the delay (median, 99 %, largest), the processor time per sample, and how many samples a second one core would
bear. A delay that grows with the length of the run would mean that it does not keep up: first and last quarter are told
apart."""

import argparse
import csv
import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
CHUNK_s = 0.01


def calibrated_tool(plumb, folder):
    """The paper's tool from the examples, calibrated; what its sensors read, still, at one attitude."""
    array = ROOT / "examples/paper_tool.toml"
    stand, calibration = folder / "stand.csv", folder / "cal.json"
    subprocess.run([plumb, "simulate", ROOT / "examples/stand.toml", "--out", stand], check=True, capture_output=True)
    subprocess.run([plumb, "calibrate", "--array", array, "--log", stand, "--out", calibration], check=True,
                   capture_output=True)
    with stand.open() as lines:
        rows = list(csv.DictReader(lines))
    still = [row for row in rows if row["station"] == rows[0]["station"]]
    names = ["a1", "a2", "a3", "a4"]
    return array, calibration, names, [sum(float(row[name]) for row in still) / len(still) for name in names]


def rows_of(clean_v, count, rate_hz, seed=1):
    luck = random.Random(seed)
    noise_v = 200e-6 * 3.0  # as the array file says
    return [
        f"{k / rate_hz:.6f}," + ",".join(f"{c + luck.gauss(0.0, noise_v):.6f}" for c in clean_v) + ",\n"
        for k in range(count)
    ]


def read_verdicts(stream, arrived):
    for line in stream:
        now = time.monotonic()
        verdict = json.loads(line)
        if "t_s" in verdict:
            arrived.append((verdict["t_s"], now))


def write_rows(out, rows, rate_hz):
    """Appends in chunks of 10 ms; when each was due to be there is when it was written."""
    step = max(1, round(rate_hz * CHUNK_s))
    start = time.monotonic()
    written = []
    for first in range(0, len(rows), step):
        due = start + (first + step) / rate_hz
        time.sleep(max(0.0, due - time.monotonic()))
        out.write("".join(rows[first : first + step]))
        out.flush()
        written.append(time.monotonic())
    return step, written


def run(options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        array, calibration, names, clean_v = calibrated_tool(options.plumb, folder)
        rows = rows_of(clean_v, options.rate * options.seconds, options.rate)
        log = folder / "log.csv"
        header = "t_s," + ",".join(names) + ",station\n"
        command = [options.plumb, "monitor", "--array", array, "--calibration", calibration, "--verdicts", "-"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        if options.stdin:
            process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            out = process.stdin
            out.write(header)
        else:
            log.write_text(header)
            command += ["--follow", "--log", log]
            process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            out = log.open("a")
        arrived = []
        reader = threading.Thread(target=read_verdicts, args=(process.stdout, arrived))
        reader.start()
        step, written = write_rows(out, rows, options.rate)
        time.sleep(0.5)
        if options.stdin:
            out.close()
        else:
            process.send_signal(signal.SIGINT)
        reader.join()
        process.wait()
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    delays = []
    for t_s, at in arrived:
        chunk = int(round(t_s * options.rate)) // step
        if chunk < len(written):
            delays.append(at - written[chunk])
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return delays, cpu_s, len(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plumb", default=ROOT / "build/release/plumb")
    parser.add_argument("--rate", type=int, default=10000)
    parser.add_argument("--seconds", type=int, default=20)
    parser.add_argument("--stdin", action="store_true", help="through a pipe instead of a growing file")
    options = parser.parse_args()
    delays, cpu_s, samples = run(options)
    if not delays:
        raise SystemExit("no verdict came: is the tool built? see the message above")
    quarter = max(1, len(delays) // 4)
    ordered = sorted(delays)

    def ms(x):
        return f"{1e3 * x:.1f} ms"

    print(f"{samples} samples at {options.rate} Hz, {len(delays)} verdicts, load {os.getloadavg()[0]:.1f}")
    print(f"delay: median {ms(ordered[len(ordered) // 2])}, 99 % {ms(ordered[int(0.99 * len(ordered))])}, "
          f"largest {ms(ordered[-1])}")
    print(f"median of the first quarter {ms(sorted(delays[:quarter])[quarter // 2])}, "
          f"of the last {ms(sorted(delays[-quarter:])[quarter // 2])}")
    print(f"processor time {1e6 * cpu_s / samples:.2f} us a sample: {samples / cpu_s:.3g} samples/s on one core")


if __name__ == "__main__":
    main()
