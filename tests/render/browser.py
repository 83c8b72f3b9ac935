"""browser.py TOOL SOURCE [SHOTS]: the pages of plumb verify, plumb monitor --report and plumb survey --report in a browser: no message on the console,
no request but for the page itself, every link leads somewhere, every chart is to be seen, nothing wider than the window, no table
cut on paper. With SHOTS, screenshots go into that directory: light, dark, phone, and the page as PDF."""

import base64
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("skipped: no selenium (Debian packages python3-selenium chromium-driver)")
    sys.exit(77)
if not shutil.which("chromedriver"):
    print("skipped: no chromedriver (Debian package chromium-driver)")
    sys.exit(77)

WIDTHS = {"phone": 390, "desk": 1280}


def open_browser():
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                     "--disable-dev-shm-usage"):  # containers have no /dev/shm, or a small one
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


def requests_of(browser):
    for entry in browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            yield message["params"]["request"]["url"]


def set_view(browser, width, dark):
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})


def contrast(browser):
    """Of the running text against the page."""
    script = """const of = c => c.match(/\\d+/g).slice(0, 3).map(v => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; });
    const light = c => { const [r, g, b] = of(c); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
    const style = getComputedStyle(document.body), a = light(style.color), b = light(style.backgroundColor);
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);"""
    return browser.execute_script(script)


def check_links(browser, page):
    for href in browser.execute_script("return [...document.querySelectorAll('a[href]')].map(a => a.getAttribute('href'))"):
        if href.startswith("#"):
            assert browser.execute_script("return document.getElementById(arguments[0]) !== null", href[1:]), href
        else:
            assert (page.parent / href).is_file(), href


def check_charts(browser, least):
    sizes = browser.execute_script("return [...document.querySelectorAll('figure')].map(f => { const s = f.querySelector('svg'); "
                                   "return s ? [s.getBoundingClientRect().width, s.getBoundingClientRect().height, s.querySelectorAll('path,rect,line,circle,image,use').length] : null })")
    assert len(sizes) >= least, sizes
    for size in sizes:
        assert size and size[0] > 100 and size[1] > 100 and size[2] > 5, sizes
    assert browser.execute_script("return [...document.querySelectorAll('[role=img]')].every(e => e.getAttribute('aria-label'))")


def check_paper(browser):
    """No table is wider than the text of the page when it is printed (A4 less its margins)."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 695, "height": 1000, "deviceScaleFactor": 1, "mobile": False})
    cut = browser.execute_script("return [...document.querySelectorAll('table')].filter(t => t.scrollWidth > t.parentElement.clientWidth + 1 && t.offsetParent).map(t => t.parentElement.getAttribute('aria-label'))")
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert not cut, cut


def check_page(browser, page, charts, shots, name):
    """`charts`: how many there are at least. Screenshots begin with `name`."""
    list(requests_of(browser))  # those of the page before
    browser.get(page.as_uri())
    console = browser.get_log("browser")
    assert not console, console
    foreign = [url for url in requests_of(browser) if url != page.as_uri() and not url.startswith("data:")]
    assert not foreign, foreign
    headings = browser.execute_script("return [...document.querySelectorAll('h1,h2,h3')].map(h => +h.tagName[1])")
    assert headings[0] == 1 and headings.count(1) == 1 and all(b - a <= 1 for a, b in zip(headings, headings[1:])), headings
    check_links(browser, page)
    check_charts(browser, charts)
    for view, width in WIDTHS.items():
        for dark in (False, True):
            set_view(browser, width, dark)
            wide = browser.execute_script("return document.documentElement.scrollWidth")
            assert wide <= width, (name, view, wide)
            assert contrast(browser) >= 7.0, (name, view, dark)
            if shots:
                high = browser.execute_script("return document.documentElement.scrollHeight")
                clip = {"x": 0, "y": 0, "width": width, "height": min(high, 12000), "scale": 1}
                shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True, "clip": clip})
                pathlib.Path(shots, f"{name}{view}-{'dark' if dark else 'light'}.png").write_bytes(base64.b64decode(shot["data"]))
    check_paper(browser)
    if shots:
        pdf = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True, "printBackground": True})
        pathlib.Path(shots, f"{name}paper.pdf").write_bytes(base64.b64decode(pdf["data"]))


def verification_page(tool, source, folder):
    array = str(pathlib.Path(source) / "examples/paper_tool.toml")
    done = subprocess.run([tool, "verify", "--array", array, "--scenarios", "1500", "--out", folder + "/r"], capture_output=True, text=True)
    assert done.returncode == 6, done.stderr  # its calibration is but predicted
    return pathlib.Path(folder, "r", "report.html")


def health_page(tool, source, folder):
    """Of the drilling run of the examples, in which a2 dies."""
    examples = pathlib.Path(source) / "examples"
    array = ["--array", str(examples / "paper_tool.toml")]
    for command in (["simulate", str(examples / "stand.toml"), "--out", "stand.csv"],
                    ["calibrate", *array, "--log", "stand.csv", "--out", "cal.json"],
                    ["simulate", str(examples / "drilling.toml"), "--out", "run.csv"],
                    ["monitor", *array, "--calibration", "cal.json", "--log", "run.csv", "--report", "health.html"]):
        done = subprocess.run([tool, *command], capture_output=True, text=True, cwd=folder)
        assert done.returncode == 0, done.stderr
    return pathlib.Path(folder, "health.html")


def survey_page(tool, source, folder):
    """Of the stations of docs/survey.md, two of which are spoilt."""
    text = (pathlib.Path(source) / "docs/survey.md").read_text()
    pathlib.Path(folder, "run4.csv").write_text(text.split("<!-- file: run4.csv -->\n```csv\n")[1].split("```")[0])
    command = ["survey", "run4.csv", "--place", "60.40, 2.10", "--date", "2026-03-31", "--report", "survey.html"]
    done = subprocess.run([tool, *command], capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return pathlib.Path(folder, "survey.html")


def main(tool, source, shots=None):
    with tempfile.TemporaryDirectory() as folder:
        browser = open_browser()
        try:
            check_page(browser, verification_page(tool, source, folder), 6, shots, "")
            check_page(browser, health_page(tool, source, folder), 2, shots, "health-")
            check_page(browser, survey_page(tool, source, folder), 2, shots, "survey-")
        finally:
            browser.quit()
    print("the pages are sound")


main(*sys.argv[1:])
