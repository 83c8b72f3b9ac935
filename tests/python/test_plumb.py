"""The Python module against the tool: the same calibration, the same verdicts, the same words.

Run by ctest with PYTHONPATH (the module), PLUMB_TOOL (the tool) and PLUMB_SOURCE_DIR.
"""

import json
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest
import warnings

import numpy as np

import plumb

EXAMPLES = pathlib.Path(os.environ["PLUMB_SOURCE_DIR"]) / "examples"


def tool(*arguments):
    return subprocess.run([os.environ["PLUMB_TOOL"], *map(str, arguments)], capture_output=True, text=True)


class Together(unittest.TestCase):
    """One stand and one run, by the tool and by the module."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        cls.array, cls.stand = plumb.simulate(str(EXAMPLES / "stand.toml"))
        _, cls.run_log = plumb.simulate(str(EXAMPLES / "drill_a.toml"))
        cls.calibration = plumb.calibrate(cls.array, cls.stand)
        for name in ("stand", "drill_a"):
            told = tool("simulate", EXAMPLES / f"{name}.toml", "--out", cls.at / f"{name}.csv")
            assert told.returncode == 0, told.stderr
        cls.array_path = EXAMPLES / "paper_tool.toml"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_simulate_gives_the_numbers_of_the_tools_log(self):
        for name, log in (("stand", self.stand), ("drill_a", self.run_log)):
            read = plumb.read_log(self.array, str(self.at / f"{name}.csv"))
            self.assertEqual(len(read), len(log))
            for column in ("time_s", "raw", "temperature_degc", "delivered", "station", "count"):
                np.testing.assert_array_equal(getattr(read, column), getattr(log, column), err_msg=column)
        self.assertIsNone(read.truth)

    def test_truth_has_the_length_of_gravity_and_the_fault(self):
        truth = self.run_log.truth
        lengths = np.linalg.norm(truth["gravity_mps2"], axis=1)
        np.testing.assert_allclose(lengths, lengths[0], rtol=1e-9)
        self.assertTrue(truth["faulty"][:, 1].any())
        self.assertFalse(truth["faulty"][0].any())

    def test_calibrate_gives_the_coefficients_of_the_tool(self):
        out = self.at / "cal.json"
        told = tool("calibrate", "--array", self.array_path, "--log", self.at / "stand.csv", "--out", out, "--json")
        self.assertEqual(told.returncode, 0, told.stderr)
        theirs = plumb.Calibration.read(self.array, str(out))
        for figure in ("axes", "scale", "bias_mps2", "reference_degc", "e_cal_mps2"):
            np.testing.assert_array_equal(getattr(theirs, figure), getattr(self.calibration, figure), err_msg=figure)
        self.assertEqual(self.calibration.report, json.loads(told.stdout))
        self.assertIsNone(theirs.report)

    def test_the_monitor_answers_as_the_tool_does(self):
        cal, verdicts = self.at / "mine.json", self.at / "verdicts.jsonl"
        self.calibration.save(str(cal))
        told = tool("monitor", "--array", self.array_path, "--calibration", cal, "--log", self.at / "drill_a.csv",
                    "--verdicts", verdicts, "--every-sample")
        self.assertIn(told.returncode, (0, 5), told.stderr)
        rows = plumb.Monitor(self.array, self.calibration).run(self.run_log)
        lines = verdicts.read_text().splitlines()
        self.assertEqual(len(lines), len(rows))
        for line, row in zip(map(json.loads, lines), rows):
            self.assertEqual(line["state"], plumb.STATES[row["state"]])
            self.assertEqual(line["validity"], plumb.VALIDITIES[row["validity"]])
            self.assertEqual(line["gravity_mps2"], list(row["gravity_mps2"]))  # bit for bit
            self.assertEqual(line["statistic"], row["statistic"])
            in_service = [s for i, s in enumerate(self.array.sensors) if row["in_service"] >> i & 1]
            self.assertEqual(line["in_service"], in_service)
        self.assertIn(1, {int(r["excluded"]).bit_length() - 1 for r in rows if r["excluded"]})

    def test_a_log_in_parts_and_a_snapshot_go_on_where_they_were(self):
        whole = plumb.Monitor(self.array, self.calibration).run(self.run_log)
        half = len(self.run_log) // 2
        log = self.run_log
        first, second = (
            plumb.Log(log.time_s[part], log.raw[part], log.temperature_degc[part], log.delivered[part], log.station[part])
            for part in (slice(None, half), slice(half, None))
        )
        monitor = plumb.Monitor(self.array, self.calibration)
        parts = [monitor.run(first)]
        again = plumb.Monitor(self.array, self.calibration, snapshot=monitor.snapshot())
        parts.append(again.run(second))
        together = np.concatenate(parts)
        for figure in plumb.verdict_dtype.names:
            np.testing.assert_array_equal(together[figure], whole[figure], err_msg=figure)
        self.assertEqual(again.verdict["state"], plumb.STATES[whole[-1]["state"]])


class Arrays(unittest.TestCase):
    """numpy in and out."""

    @classmethod
    def setUpClass(cls):
        cls.array, cls.log = plumb.simulate(str(EXAMPLES / "stand.toml"))
        cls.calibration = plumb.calibrate(cls.array, cls.log)

    def verdicts(self, **columns):
        given = {"time_s": self.log.time_s, "raw": self.log.raw, "station": self.log.station}
        given.update(columns)
        return plumb.Monitor(self.array, self.calibration).run(plumb.Log(**given)).tobytes()

    def test_float64_is_kept_and_not_copied(self):
        raw = np.array(self.log.raw)
        kept = plumb.Log(self.log.time_s, raw)
        self.assertTrue(np.shares_memory(kept.raw, raw))
        self.assertTrue(np.shares_memory(kept.time_s, self.log.time_s))

    def test_strides_and_types_do_not_matter(self):
        plain = self.verdicts()
        wide = np.full((len(self.log), 2 * len(self.array)), np.nan)
        wide[:, ::2] = self.log.raw
        self.assertEqual(self.verdicts(raw=wide[:, ::2]), plain)  # a view with gaps
        self.assertEqual(self.verdicts(raw=np.asfortranarray(self.log.raw)), plain)
        self.assertEqual(self.verdicts(raw=self.log.raw.tolist()), plain)
        self.assertEqual(self.verdicts(station=self.log.station.astype(np.int64)), plain)
        self.assertEqual(self.verdicts(temperature_degc=25), self.verdicts(temperature_degc=np.full(len(self.log), 25.0)))

    def test_what_was_not_delivered_differs_from_what_is_not_finite(self):
        delivered = np.ones_like(self.log.raw, dtype=bool)
        delivered[:, 2] = False
        rows = np.frombuffer(self.verdicts(delivered=delivered), dtype=plumb.verdict_dtype)
        self.assertEqual(rows[-1]["absent"], 0b0100)
        applied = self.calibration.apply(plumb.Log(self.log.time_s, self.log.raw, delivered=delivered))
        self.assertTrue(np.isnan(applied[:, 2]).all())
        self.assertFalse(np.isnan(applied[:, :2]).any())

    def test_tags_are_whole_numbers_that_fit(self):
        for tag in (-1, 2**32, 0.5, np.nan, np.inf):
            station = np.full(len(self.log), 3.0)
            station[7] = tag
            for column in ("station", "count", "roll_group"):
                with self.assertRaisesRegex(plumb.Error, f"{column}: row 7 is .*whole number from 0 to 4294967295"):
                    self.verdicts(**{column: station})
        self.verdicts(station=np.full(len(self.log), 2.0**32 - 1))

    def test_fields_of_a_packed_record_and_bytes_as_bool(self):
        packed = np.zeros(
            len(self.log), np.dtype([("a", "u1"), ("time_s", "f8"), ("raw", "f8", (len(self.array),)), ("station", "u4")])
        )
        for column in ("time_s", "raw", "station"):
            packed[column] = getattr(self.log, column)
        self.assertFalse(packed["raw"].flags.aligned)
        plain = self.verdicts()
        self.assertEqual(self.verdicts(**{c: packed[c] for c in ("time_s", "raw", "station")}), plain)
        anything = np.full(self.log.raw.shape, 254, np.uint8).view(bool)
        self.assertEqual(self.verdicts(delivered=anything), plain)

    def test_any_value_is_taken(self):
        for value in (np.nan, np.inf, -np.inf, 1e308):
            raw = np.array(self.log.raw)
            raw[:, 0] = value
            rows = np.frombuffer(self.verdicts(raw=raw), dtype=plumb.verdict_dtype)
            self.assertFalse((rows["validity"] == 0).any() and np.isnan(rows["gravity_mps2"]).any())

    def test_the_module_says_what_it_is(self):
        for thing in (plumb, plumb.calibrate, plumb.simulate, plumb.Monitor, plumb.Monitor.run, plumb.Log, plumb.Array.read):
            self.assertGreater(len(thing.__doc__), 40, thing)
        self.assertEqual(plumb.STATES[3], "degraded")
        self.assertEqual(self.array.axes.shape, (4, 3))
        self.assertEqual(repr(self.log), f"<plumb.Log: {len(self.log)} rows>")


class Errors(unittest.TestCase):
    """The words of an exception are those that the tool prints."""

    @classmethod
    def setUpClass(cls):
        cls.array, cls.log = plumb.simulate(str(EXAMPLES / "stand.toml"))

    def said(self, function, *arguments, **named):
        with self.assertRaises(plumb.Error) as caught:
            function(*arguments, **named)
        self.assertIsInstance(caught.exception, ValueError)
        return str(caught.exception)

    def test_files_are_refused_in_the_words_of_the_tool(self):
        with tempfile.TemporaryDirectory() as folder:
            bad = pathlib.Path(folder) / "bad.toml"
            bad.write_text((EXAMPLES / "paper_tool.toml").read_text() + "\n[unheard]\nof = 1\n")
            told = tool("geometry", bad)
            self.assertEqual("plumb: " + self.said(plumb.Array.read, str(bad)), told.stderr.rstrip("\n"))
            missing = pathlib.Path(folder) / "none.csv"
            told = tool("calibrate", "--array", EXAMPLES / "paper_tool.toml", "--log", missing, "--out", "-")
            self.assertEqual("plumb: " + self.said(plumb.read_log, self.array, str(missing)), told.stderr.rstrip("\n"))

    def refused_alike(self, change):
        """The tool and the module on the CSV of the stand after `change` of its lines."""
        with tempfile.TemporaryDirectory() as folder:
            csv, out = pathlib.Path(folder) / "stand.csv", pathlib.Path(folder) / "cal.json"
            self.assertEqual(tool("simulate", EXAMPLES / "stand.toml", "--out", csv).returncode, 0)
            csv.write_text("\n".join(change(csv.read_text().splitlines())) + "\n")
            told = tool("calibrate", "--array", EXAMPLES / "paper_tool.toml", "--log", csv, "--out", out)
            self.assertEqual(told.returncode, 4, told.stderr)
            mine = "plumb: " + self.said(plumb.calibrate, self.array, plumb.read_log(self.array, str(csv)))
            self.assertEqual(mine.replace(". Remedy:", f". {out} was not written. Remedy:"), told.stderr.rstrip("\n"))
            return mine

    def test_too_few_attitudes_are_refused_in_the_words_of_the_tool(self):
        self.refused_alike(lambda lines: lines[: len(lines) // 16])

    def test_a_dead_channel_is_refused_in_the_words_of_the_tool(self):
        def dead(lines):
            column = lines[0].split(",").index("a2")
            rows = [line.split(",") for line in lines[1:]]
            return lines[:1] + [",".join(row[:column] + ["2.5"] + row[column + 1 :]) for row in rows]

        self.assertIn("reads 2.5 in every row", self.refused_alike(dead))

    def test_shapes_are_refused_with_what_is_needed(self):
        rows = len(self.log)
        text = self.said(plumb.calibrate, self.array, plumb.Log(self.log.time_s, self.log.raw[:, :3]))
        self.assertIn(f"raw: has the shape ({rows}, 3), must have ({rows}, 4)", text)
        text = self.said(plumb.calibrate, self.array, plumb.Log(self.log.time_s[:-1], self.log.raw))
        self.assertIn(f"time_s: has the shape ({rows - 1}), must have ({rows})", text)
        self.said(plumb.calibrate, self.array, plumb.Log([], np.zeros((0, 4))))
        self.said(plumb.calibrate, self.array, self.log, hold_out="seven")
        self.assertIn("temperature_order", self.said(plumb.calibrate, self.array, self.log, temperature_order="9"))

    def test_a_monitor_refuses_what_is_not_its_own(self):
        calibration = plumb.calibrate(self.array, self.log)
        text = self.said(plumb.Monitor, self.array, calibration, snapshot=b"no snapshot")
        self.assertTrue(text.startswith("snapshot: "), text)
        monitor = plumb.Monitor(self.array, calibration)
        self.assertIn('"a9" is not a sensor', self.said(monitor.reset, 1, ["a9"]))
        self.said(monitor.set_gravity, 1.6, 0.01)
        self.said(monitor.request_recalibration)

    def test_a_mask_is_refused(self):
        """Its values would count as measured."""
        masked = np.ma.masked_array(self.log.raw, mask=np.zeros(self.log.raw.shape, bool))
        self.assertIn("raw: is a masked array", self.said(plumb.Log, self.log.time_s, masked))
        log = plumb.Log(self.log.time_s, self.log.raw)
        self.assertIn("raw: is a masked array", self.said(setattr, log, "raw", masked))
        log.temperature_degc = masked[:, 0]
        self.assertIn("temperature_degc: is a masked array", self.said(plumb.calibrate, self.array, log))
        log.temperature_degc = np.ma.filled(masked[:, 0] * 0 + 20, np.nan)
        plumb.calibrate(self.array, log)

    def test_none_is_no_array(self):
        calibration = plumb.calibrate(self.array, self.log)
        for function, arguments in (
            (plumb.Monitor, (None, calibration)),
            (plumb.calibrate, (None, self.log)),
            (plumb.read_log, (None, "log.csv")),
            (plumb.Calibration.read, (None, "cal.json")),
        ):
            with self.assertRaises(TypeError):
                function(*arguments)

    def test_a_calibration_of_another_array_is_refused(self):
        calibration = plumb.calibrate(self.array, self.log)
        text = (EXAMPLES / "paper_tool.toml").read_text()
        same = plumb.Array.parse(text)
        plumb.Monitor(same, calibration).run(self.log)
        other = plumb.Array.parse(text.replace('id = "a1"', 'id = "b1"'))
        self.assertEqual(other.sensors[0], "b1")
        said = self.said(plumb.Monitor, other, calibration)
        self.assertIn("the calibration was made for another array", said)
        snapshot = plumb.Monitor(same, calibration).snapshot()
        self.assertEqual(self.said(plumb.Monitor, other, calibration, snapshot=snapshot), said)

    def test_a_calibration_without_uncertainty_is_warned_of_as_it_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "cal.json"
            plumb.calibrate(self.array, self.log).save(str(path))
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                plumb.Calibration.read(self.array, str(path))
            root = json.loads(path.read_text())
            root["covariance"] = [[0.0] * len(row) for row in root["covariance"]]
            del root["checksum"]
            hash_of = 0xCBF29CE484222325
            for byte in json.dumps(root, separators=(",", ":"), ensure_ascii=False).encode():
                hash_of = (hash_of ^ byte) * 0x100000001B3 % 2**64
            root["checksum"] = f"fnv1a64:{hash_of:016x}"
            path.write_text(json.dumps(root))
            with self.assertWarnsRegex(UserWarning, "states no uncertainty .* of any sensor: .*Remedy: calibrate again"):
                plumb.Calibration.read(self.array, str(path))

    def test_the_days_since_the_calibration_widen_the_bound(self):
        text = (EXAMPLES / "paper_tool.toml").read_text()
        growing = 'stability = "10 ug"\nstability_per_day = "5 ug"\n'
        array = plumb.Array.parse(text.replace("[monitor]\n", "[monitor]\n" + growing, 1))
        calibration = plumb.calibrate(array, self.log, date="2026-03-31", serial="0042")
        self.assertEqual((calibration.date, calibration.serial), ("2026-03-31", "0042"))
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder) / "cal.json")
            calibration.save(path)
            again = plumb.Calibration.read(array, path)
        self.assertEqual((again.date, again.serial), ("2026-03-31", "0042"))
        bounds = []
        for days in (0.0, 30.0):
            monitor = plumb.Monitor(array, calibration, days_since_calibration=days)
            bounds.append(np.nanmax(monitor.run(self.log)["protection_level_calibrated_axes_rad"][-1:]))
        self.assertGreater(bounds[1], bounds[0] + 1e-4)
        self.assertIn("is no date", self.said(plumb.calibrate, array, self.log, date="31.03.2026"))
        self.assertIn("days", self.said(plumb.Monitor, array, calibration, days_since_calibration=-1.0))

    def test_a_monitor_is_for_one_thread_at_a_time(self):
        calibration = plumb.calibrate(self.array, self.log)
        monitor = plumb.Monitor(self.array, calibration)
        long = plumb.Log(0.01 * np.arange(400000), np.tile(self.log.raw[:1], (400000, 1)))
        runner = threading.Thread(target=monitor.run, args=(long,))
        runner.start()
        refusals = set()
        while runner.is_alive():
            for ask in (monitor.snapshot, lambda: monitor.verdict, lambda: monitor.run(self.log), lambda: monitor.inhibit(True)):
                try:
                    ask()
                except plumb.Error as error:
                    refusals.add(str(error))
        runner.join()
        self.assertEqual(len(refusals), 1, refusals)
        self.assertIn("the monitor runs in another thread", refusals.pop())
        monitor.snapshot()


if __name__ == "__main__":
    unittest.main()
