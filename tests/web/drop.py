"""drop.py PLUMB SOURCE: logs dropped on the explorer. What the tool in the page says of a log is what the tool on the command line
says of it, byte for byte: reviews of ULog, DataFlash, MCAP (zstd and lz4) and CSV, the monitor with array file and calibration, and
the sentence with which a bad file is refused. A long log does not freeze the page, its reading is told and can be cancelled. Needs
what scripts/web builds and what group `more` of scripts/packages names; it is skipped, saying so, where that is not there."""

import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from browser import Page, WIDTHS, open_browser, skip
from selenium.webdriver.common.by import By

EXIT_CODES_THAT_ANSWER = (0, 5, 7, 8, 9)
MOST_ULP_OF_ANGLES = 8  # the C libraries round the functions of angles differently; no limit and no statistic comes of them
LONG_LOG_BYTES = 100_000_000
LONGEST_STANDSTILL_MS = 3000  # of the page, on a machine that may be busy with other things; the reading lasts much longer


class DropPage(Page):
    def forget(self):
        button = self.browser.find_element(By.ID, "drop-forget")
        if button.is_enabled():
            button.click()

    def drop(self, *files):
        self.forget()
        self.browser.execute_script("document.body.dataset.log = ''")
        self.browser.find_element(By.ID, "drop-files").send_keys("\n".join(str(file.resolve()) for file in files))

    def answer(self, *files):
        self.drop(*files)
        self.wait("['done', 'ended'].includes(document.body.dataset.log)", 300)
        assert self.script("document.body.dataset.log") == "done", self.script("document.getElementById('drop-result').textContent")
        return self.script("(({code, out, error, files}) => ({code, out, error, files: Object.fromEntries("
                           "Object.entries(files).map(([n, b]) => [n, new TextDecoder().decode(b)]))}))(window.plumb.drop.answer)")


def tool_says(plumb, folder, *arguments):
    """Where no other program is installed, gnuplot among them: in a page there is none."""
    done = subprocess.run([os.path.abspath(plumb), *arguments], cwd=folder, capture_output=True, text=True, check=False,
                          env={**os.environ, "PATH": "/nonexistent"})
    return {"code": done.returncode, "out": done.stdout, "error": done.stderr}


def same_text(what, page, tool):
    if page == tool:
        return
    pairs = zip(page.splitlines() + ["(end)"], tool.splitlines() + ["(end)"])
    one, other = next((pair for pair in pairs if pair[0] != pair[1]), (page, tool))
    at = max(0, next((k for k, (a, b) in enumerate(zip(one, other)) if a != b), 0) - 60)
    raise AssertionError(f"{what} differs, the page says\n{one[at:at + 300]}\nthe tool\n{other[at:at + 300]}")


def distances(one, other, name="", into=None):
    """By name how far the figures of two records are apart at most, in units in the last place; all else is equal."""
    into = {} if into is None else into
    if isinstance(one, dict) and isinstance(other, dict):
        assert list(one) == list(other), (name, one, other)
        for key in one:
            distances(one[key], other[key], key, into)
    elif isinstance(one, list) and isinstance(other, list):
        assert len(one) == len(other), (name, one, other)
        for a, b in zip(one, other):
            distances(a, b, name, into)
    elif isinstance(one, float) and isinstance(other, float):
        into[name] = max(into.get(name, 0.0), abs(one - other) / math.ulp(max(abs(one), abs(other))))
    else:
        assert one == other, (name, one, other)
    return into


def same(what, page, tool):
    for key in ("error", "code", "out"):
        same_text(f"{what}: {key}", str(page[key]), str(tool[key]))


def logs_of(source, folder):
    """ULog, DataFlash, MCAP; a table; and a real log of PX4 where the folder of recordings is there."""
    fixtures = pathlib.Path(source) / "tests/logs/fixtures"
    for file in sorted(fixtures.iterdir()):
        if file.suffix in (".ulg", ".bin", ".mcap"):
            yield file
    table = folder / "table.csv"
    rows = ["t_s,ax1,ay1,az1,ax2,ay2,az2"]
    for k in range(4000):
        wobble = [0.01 * ((k * (7 + i)) % 11 - 5) for i in range(6)]
        rows.append(",".join([f"{k / 100:.2f}", *(f"{w + (9.81 if i % 3 == 2 else 0):.4f}" for i, w in enumerate(wobble))]))
    table.write_text("\n".join(rows) + "\n", encoding="utf-8")
    yield table
    recordings = pathlib.Path(os.environ.get("PLUMB_DATA_DIR", pathlib.Path(source) / "../shared/data")).resolve()
    real = recordings / "logs/sample_log_small.ulg"
    if real.is_file():
        yield real
    else:
        print("no real log of PX4 (set PLUMB_DATA_DIR to the directory that holds logs/)")


def check_reviews(page, plumb, source, folder):
    reviewed = 0
    for file in logs_of(source, folder):
        told = page.answer(file)
        same(file.name, told, tool_says(plumb, file.parent, "review", file.name, "--json", "--html", str(folder / "review.html")))
        assert told["files"]["review.html"] == (folder / "review.html").read_text(encoding="utf-8"), file.name
        assert page.script("document.querySelector('#drop-result iframe').srcdoc.length > 1000")
        reviewed += 1
    return reviewed


def make_run(plumb, source, folder):
    """A stand, a calibration and a drilling run in which a sensor fails."""
    for name in ("paper_tool.toml", "stand.toml", "drilling.toml"):
        shutil.copy(pathlib.Path(source) / "examples" / name, folder / name)
    for arguments in (("simulate", "stand.toml", "--out", "stand.csv"),
                      ("calibrate", "--array", "paper_tool.toml", "--log", "stand.csv", "--out", "cal.json"),
                      ("simulate", "drilling.toml", "--out", "run.csv")):
        done = tool_says(plumb, folder, *arguments)
        assert done["code"] == 0, done


def monitored(plumb, folder, array, calibration, log):
    out = folder / "tool"
    out.mkdir(exist_ok=True)
    told = tool_says(plumb, folder, "monitor", "--array", array, "--calibration", calibration, "--log", log, "--json",
                     "--verdicts", str(out / "verdicts.jsonl"), "--report", str(out / "health.html"))
    return told, out


def check_monitor(page, plumb, folder):
    told = page.answer(folder / "run.csv", folder / "paper_tool.toml", folder / "cal.json")
    tool, out = monitored(plumb, folder, "paper_tool.toml", "cal.json", "run.csv")
    same("the monitor", told, tool)
    records = [[json.loads(line) for line in text.splitlines()]
               for text in (told["files"]["verdicts.jsonl"], (out / "verdicts.jsonl").read_text(encoding="utf-8"))]
    apart = {name: ulp for name, ulp in distances(*records).items() if ulp > 0}
    print(f"{len(records[0])} verdicts, equal but for the last places of {apart}")
    too_far = {name: ulp for name, ulp in apart.items() if ulp > (MOST_ULP_OF_ANGLES if name.endswith("_deg") else 0)}
    assert not too_far, too_far
    assert '"a2"' in told["files"]["verdicts.jsonl"], "a2 fails in this run"
    assert set(told["files"]) == {"verdicts.jsonl", "health.html", "health.json"}, set(told["files"])


# What tests/cli/bad_input_test.cpp changes in a good array file, calibration or log: file, old, new.
BAD = [
    ("paper_tool.toml", 'unit = "V"', ""),
    ("paper_tool.toml", 'unit = "V"', 'unit = "furlong"'),
    ("paper_tool.toml", 'noise = "200 ug0"', 'noise = "200"'),
    ("paper_tool.toml", 'noise = "200 ug0"', 'noise = "0.0002 g"'),
    ("paper_tool.toml", "axis = [0.0, 0.0, 1.0]", "axis = [0.0, 0.0, 1.02]"),
    ("paper_tool.toml", "[monitor]", "[monitor"),
    ("paper_tool.toml", "[monitor]", "[monitor]\nwindow = 257"),
    ("paper_tool.toml", "[monitor]", "[monitor]\nwindw = 16"),
    ("paper_tool.toml", 'id = "a2"', 'id = "a1"'),
    ("paper_tool.toml", None, ""),
    ("cal.json", '"', "'"),
    ("cal.json", None, ""),
    ("cal.json", None, "{}"),
    ("run.csv", "t_s,", "seconds,"),
    ("run.csv", "\n0.02,", "\n0.02,,"),
    ("run.csv", "\n0.02,", "\nnever,"),
    ("run.csv", None, ""),
    ("run.csv", None, "\x00\x01\x02"),
]


def check_refusals(page, plumb, folder):
    told_of = set()
    for k, (name, old, new) in enumerate(BAD):
        bad = folder / f"bad{k}"
        bad.mkdir()
        for other in ("paper_tool.toml", "cal.json", "run.csv"):
            shutil.copy(folder / other, bad / other)
        text = (bad / name).read_text(encoding="utf-8")
        assert old is None or old in text, (name, old)
        (bad / name).write_text(new if old is None else text.replace(old, new, 1), encoding="utf-8")
        told = page.answer(bad / "run.csv", bad / "paper_tool.toml", bad / "cal.json")
        tool, _ = monitored(plumb, bad, "paper_tool.toml", "cal.json", "run.csv")
        same(f"{name} with {old!r} as {new!r}", told, tool)
        assert tool["code"] not in EXIT_CODES_THAT_ANSWER and tool["error"], (name, old, new, tool)
        assert tool["error"].strip().splitlines()[0] in page.script("document.querySelector('#drop-result [role=alert]').textContent")
        told_of.add(tool["error"])
    for name, content in (("empty.csv", b""), ("zip.ulg", b"PK\x03\x04" + bytes(60)), ("noise.bin", bytes(range(256)) * 4),
                          ("cut.ulg", b"ULog\x01\x12\x35"), ("words.csv", b"this is no table\n")):
        (folder / name).write_bytes(content)
        tool = tool_says(plumb, folder, "review", name, "--json", "--html", str(folder / "review.html"))
        same(name, page.answer(folder / name), tool)
        told_of.add(tool["error"])
    return len(told_of)


def check_long(page, folder):
    """100 MB: the page goes on, tells how far the reading is, and can cancel it; then the next log is read."""
    rows = (folder / "run.csv").read_text(encoding="utf-8").splitlines()
    body = [row.split(",", 1)[1] for row in rows[1:]]
    long = folder / "long.csv"
    with long.open("w", encoding="utf-8") as out:
        out.write(rows[0] + "\n")
        k = written = 0
        while written < LONG_LOG_BYTES:
            written += out.write(f"{k / 100:.2f},{body[k % len(body)]}\n")
            k += 1
    page.browser.execute_script(
        "window.longest = 0; let before = performance.now(); const tick = now => { window.longest = Math.max(window.longest, now - before); "
        "before = now; window.ticking = requestAnimationFrame(tick); }; requestAnimationFrame(tick);")
    page.drop(long, folder / "paper_tool.toml", folder / "cal.json")
    page.wait("document.getElementById('drop-progress').value > 0.02", 120)
    half = page.script("document.getElementById('drop-progress').value")
    page.wait(f"document.getElementById('drop-progress').value > {half}", 120)
    longest = page.script("(cancelAnimationFrame(window.ticking), window.longest)")
    print(f"longest standstill of the page while 100 MB are read: {longest:.0f} ms")
    assert longest < LONGEST_STANDSTILL_MS, longest
    page.browser.find_element(By.ID, "drop-cancel").click()
    page.wait("document.body.dataset.log === 'ended'")
    assert "Cancelled" in page.script("document.getElementById('drop-result').textContent")


def main(plumb, source):
    built = pathlib.Path(source) / "build/web"
    file = (built / "explorer.html").resolve()
    if not file.is_file():
        skip("the page is not built (scripts/web)")
    if not shutil.which("chromedriver"):
        skip("no chromedriver (Debian package chromium-driver)")
    browser = open_browser()
    browser.set_script_timeout(300)
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            page = DropPage(browser, None, source)
            page.view(WIDTHS["desk"], False)
            for place in ((built / "explorer/index.html").resolve(), file):  # the folder, and the one file
                page.open(place)
                page.tab("drop")
                page.answer(pathlib.Path(source) / "tests/logs/fixtures/mcap_core_chunks.mcap")
                page.check_silence(place)
            reviewed = check_reviews(page, plumb, source, folder)
            make_run(plumb, source, folder)
            check_monitor(page, plumb, folder)
            refused = check_refusals(page, plumb, folder)
            check_long(page, folder)
            check_monitor(page, plumb, folder)
            page.check_silence(file)
    finally:
        browser.quit()
    print(f"{reviewed} reviews, a monitored run and {refused} refusals: the page says what the tool says")


if __name__ == "__main__":
    main(*sys.argv[1:])
