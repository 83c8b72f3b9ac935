"""browser.py TOOL SOURCE [SHOTS]: the pages of plumb verify, plumb monitor --report and plumb survey --report in a browser: no message on the console,
no request but for the page itself, every link leads somewhere, every chart is to be seen, nothing wider than the window, no table
cut on paper; on a phone charts fit and their letters can be read; zoom and readout work, and without a script nothing is
missing; on paper marks keep their colours, and the sign-off is one sheet with lines to sign on. With SHOTS, screenshots go into
that directory: light, dark, phone, and the page as PDF."""

import base64
import json
import pathlib
import re
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

WIDTHS = {"phone": 360, "desk": 1280}
LEAST_LETTERS_PX = 8.0  # of a chart on a phone, exponents included


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
    sizes = browser.execute_script("return [...document.querySelectorAll('figure')].map(f => { const s = [...f.querySelectorAll('svg')].find(s => s.getBoundingClientRect().width); "
                                   "return s ? [s.getBoundingClientRect().width, s.getBoundingClientRect().height, s.querySelectorAll('path,rect,line,circle,image,use').length] : null })")
    assert len(sizes) >= least, sizes
    for size in sizes:
        assert size and size[0] > 100 and size[1] > 100 and size[2] > 5, sizes
    assert browser.execute_script("return [...document.querySelectorAll('[role=img]')].every(e => e.getAttribute('aria-label'))")


def check_phone_charts(browser, name):
    """Every picture is as wide as the screen, without pushing; charts that are drawn by a program have letters that can be read."""
    found = browser.execute_script("""return [...document.querySelectorAll('figure')].flatMap(f => {
      const plot = [...f.querySelectorAll('.plot')].find(p => p.offsetParent), svg = plot.querySelector('svg');
      const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
      const letters = [...svg.querySelectorAll('[font-size]')].filter(t => t.textContent.trim()).map(t => scale * parseFloat(t.getAttribute('font-size')));
      return [[plot.scrollWidth - plot.clientWidth, Math.min(...letters, 99)]];
    })""")
    assert found, name
    for over, letters in found:
        assert over <= 1 and letters >= LEAST_LETTERS_PX, (name, found)


def check_script(browser, name):
    """A chart tells the value under the pointer and can be enlarged, by a button and by a key, and comes back."""
    found = browser.execute_script("""
      const figure = [...document.querySelectorAll('figure')].find(f => f.querySelector('svg[data-axes] .m'));
      figure.scrollIntoView();
      const svg = figure.querySelector('.broad svg'), mark = [...svg.querySelectorAll('.m')].pop(), r = mark.getBoundingClientRect();
      const at = {bubbles: true, clientX: r.x + r.width / 2, clientY: r.y + r.height / 2};
      svg.dispatchEvent(new PointerEvent('pointermove', at));
      const tip = figure.querySelector('.tip'), told = tip.hidden ? '' : tip.textContent, whole = svg.getAttribute('viewBox');
      figure.querySelector('.tools button').click();
      const near = svg.getAttribute('viewBox');
      svg.parentElement.dispatchEvent(new KeyboardEvent('keydown', {key: '0', bubbles: true}));
      const back = svg.getAttribute('viewBox').split(' ').map(Number).join(' ');
      return {told, whole, near, back};""")
    assert re.match(r".+ -?[\d.e+-]+; .+ -?[\d.e+-]+$", found["told"]), (name, found)
    assert found["near"] != found["whole"] and found["back"] == found["whole"], (name, found)


def check_without_script(browser, page, charts):
    """The same page where no script may run."""
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    browser.get(page.as_uri())
    check_charts(browser, charts)
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})


def check_print(page, folder, name):
    """On paper, as `plumb verify --pdf` prints it: every colour of a mark on the page is on a sheet too."""
    html, pdf = page.read_text(), page.with_name("report.pdf")
    if not pdf.exists() or not shutil.which("pdftoppm"):
        return  # the page has none, or what prints it or looks at it is not installed
    subprocess.run(["pdftoppm", "-r", "60", str(pdf), str(pathlib.Path(folder, "sheet"))], check=True)
    colours = set()
    sheets = sorted(pathlib.Path(folder).glob("sheet*.ppm"))
    for sheet in sheets:
        raw = sheet.read_bytes()
        head = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", raw)
        pixels = raw[head.end():]
        colours |= {pixels[k:k + 3] for k in range(0, len(pixels), 3)}
        sheet.unlink()
    broad = "".join(re.findall(r'<div class="plot broad".*?</svg>', html, re.S))
    marks = {tuple(int(v) for v in m) for m in re.findall(r"class='m'[^>]*?(?:fill|stroke)='rgb\(\s*(\d+),\s*(\d+),\s*(\d+)\)'", broad)}
    assert marks, name
    for mark in marks:
        assert any(all(abs(a - b) <= 24 for a, b in zip(mark, seen)) for seen in colours), (name, mark)
    check_sign_off(pdf, name)


def check_sign_off(pdf, name):
    """The first sheet holds the whole sign-off, down to the lines that are signed."""
    text = subprocess.run(["pdftotext", "-f", "1", "-l", "1", "-layout", str(pdf), "-"], capture_output=True, text=True, check=True).stdout
    if "Sign-off" not in text:
        return
    for word in ("Sign-off", "What not to trust?", "serial number", "calibration date", "sha256", "Approved by"):
        assert word in text, (name, word, text)


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
            if view == "phone":
                check_phone_charts(browser, name)
            if shots:
                high = browser.execute_script("return document.documentElement.scrollHeight")
                clip = {"x": 0, "y": 0, "width": width, "height": min(high, 12000), "scale": 1}
                shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True, "clip": clip})
                pathlib.Path(shots, f"{name}{view}-{'dark' if dark else 'light'}.png").write_bytes(base64.b64decode(shot["data"]))
    check_paper(browser)
    set_view(browser, WIDTHS["desk"], False)
    check_script(browser, name)
    check_without_script(browser, page, charts)
    check_print(page, page.parent, name)
    if shots:
        pdf = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True, "printBackground": True})
        pathlib.Path(shots, f"{name}paper.pdf").write_bytes(base64.b64decode(pdf["data"]))


def verification_page(tool, source, folder):
    array = str(pathlib.Path(source) / "examples/paper_tool.toml")
    done = subprocess.run([tool, "verify", "--array", array, "--scenarios", "1500", "--pdf", "--out", folder + "/r"], capture_output=True, text=True)
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


def check_demo(browser, tool, folder, shots):
    done = subprocess.run([tool, "demo", "--out", folder + "/demo"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    page = pathlib.Path(folder, "demo", "index.html")
    browser.get(page.as_uri())
    check_links(browser, page)
    for width in WIDTHS.values():
        set_view(browser, width, False)
        assert browser.execute_script("return document.documentElement.scrollWidth") <= width, width
    set_view(browser, WIDTHS["phone"], False)
    check_phone_charts(browser, "demo")
    if shots:
        high = browser.execute_script("return document.documentElement.scrollHeight")
        clip = {"x": 0, "y": 0, "width": WIDTHS["phone"], "height": min(high, 12000), "scale": 1}
        shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True, "clip": clip})
        pathlib.Path(shots, "demo-phone.png").write_bytes(base64.b64decode(shot["data"]))


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
            check_demo(browser, tool, folder, shots)
        finally:
            browser.quit()
    print("the pages are sound")


main(*sys.argv[1:])
