"""browser.py NATIVE SOURCE [SHOTS]: the explorer in a browser. No message on the console, no request, what the page says is what the
native core says (NATIVE: plumb_web_native), a slider changes the verdicts, an axis can be typed and dragged, a phone has no
horizontal scroll, keyboard and screen reader find their way (axe-core). Needs what scripts/web builds and what group `more` of
scripts/packages names; it is skipped, saying so, where that is not there. With SHOTS, screenshots go into that directory."""

import base64
import gzip
import json
import pathlib
import shutil
import subprocess
import sys
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    print("skipped: no selenium (Debian packages python3-selenium chromium-driver)")
    sys.exit(77)

WIDTHS = {"phone": 360, "desk": 1280}
AXE_TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]
MOST_FIRST_PICTURE_MS = 1000  # on a machine that does nothing else; a loaded one is told, not failed
MOST_PAGE_BYTES = 1_400_000  # compressed, without the tool for logs, which is unpacked when it is asked for
MOST_LOGS_BYTES = 1_200_000


def skip(why):
    print("skipped:", why)
    sys.exit(77)


def open_browser():
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--hide-scrollbars", "--disable-dev-shm-usage",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


class Page:
    def __init__(self, browser, native, source):
        self.browser, self.native, self.source = browser, native, source
        self.runs = 0

    def script(self, text, *arguments):
        return self.browser.execute_script("return " + text, *arguments)

    def wait(self, what, seconds=60):
        end = time.monotonic() + seconds
        while not self.script(what):
            assert time.monotonic() < end, f"not within {seconds} s: {what}"
            time.sleep(0.05)

    def open(self, file):
        list(self.requests())
        self.browser.get(file.as_uri())
        self.wait("document.body.dataset.ready === 'yes'")
        self.check_silence(file)

    def requests(self):
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                yield message["params"]["request"]["url"]

    def check_silence(self, file):
        """Nothing is said on the console, and nothing is fetched but the page and what lies beside it."""
        console = [entry for entry in self.browser.get_log("browser") if "GPU stall" not in entry["message"]]
        assert not console, console
        beside = file.parent.as_uri() + "/"
        foreign = [url for url in self.requests() if not url.startswith(("data:", "blob:", beside))]
        assert not foreign, foreign

    def view(self, width, dark):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
        time.sleep(0.3)

    def choose(self, select, value):
        self.browser.execute_script("const s = document.getElementById(arguments[0]); s.value = arguments[1]; "
                                    "s.dispatchEvent(new Event('change', {bubbles: true}));", select, value)

    def tab(self, view):
        self.browser.find_element(By.ID, f"tab-{view}").click()

    def says(self, what, text):
        done = subprocess.run([self.native, what], input=text, capture_output=True, text=True, check=True)
        return done.stdout

    def settle(self):
        """The digest of the run once all of its samples are stepped."""
        time.sleep(0.15)
        self.wait("document.body.dataset.run.length === 16")
        return self.script("document.body.dataset.run")

    def check_run(self):
        """Every decision is the native core's, and every bit of every verdict."""
        digest = self.settle()
        scene = self.script("JSON.stringify(window.plumb.second.scene)")
        told = self.says("begin", scene).splitlines()
        decisions = self.script("window.plumb.core.decisions()")
        assert told[-2] == f"decisions {decisions}", (told[-2], decisions, scene)
        assert told[-1] == f"digest {digest}", (told[-1], digest, scene)
        self.runs += 1
        return digest


def check_design(page):
    for option in page.script("[...document.querySelectorAll('#geometry option')].map(o => o.value)"):
        if option == "own":
            continue
        page.choose("geometry", option)
        design = page.script("JSON.stringify({...window.plumb.design.geometry, samples: 32})")
        said = page.script("JSON.stringify(window.plumb.core.study(JSON.parse(arguments[0])))", design)
        assert json.loads(said) == json.loads(page.says("study", design)), option
    check_chips(page)
    check_compare(page)
    page.choose("geometry", "paper-tetrahedron")
    figures = "document.getElementById('design-figures').textContent"
    before = page.script(figures)
    box = page.browser.find_elements(By.CSS_SELECTOR, "#axes input")[3]
    box.send_keys(Keys.CONTROL, "a")
    box.send_keys("0.3")
    page.wait(f"{figures} !== {json.dumps(before)}")
    assert page.script("document.getElementById('geometry').value") == "own"
    check_drag(page)
    # Three axes in one plane are refused, with a remedy; then all is well again.
    page.choose("geometry", "triad")
    for box, value in zip(page.browser.find_elements(By.CSS_SELECTOR, "#axes input")[6:], ("1", "1", "0")):
        box.send_keys(Keys.CONTROL, "a")
        box.send_keys(value)
    page.wait("!document.getElementById('design-error').hidden")
    assert "emedy" in page.script("document.getElementById('design-error').textContent")
    page.choose("geometry", "platonic:6")
    assert page.script("document.getElementById('design-error').hidden")


def check_chips(page):
    """A chip is added, taken apart, and named in the array file; every sensor has its thresholds."""
    text = "document.getElementById('design-merit').textContent"
    page.choose("geometry", "triad")
    page.browser.find_element(By.ID, "add-triad").click()
    assert page.script("window.plumb.design.geometry.chips.join()") == "0,0,0,1,1,1"
    assert "chip 1 (a4 a5 a6)" in page.script(text), page.script(text)
    assert page.script("window.plumb.design.arrayFile()").count('package = "chip1"') == 3
    assert len(page.browser.find_elements(By.CSS_SELECTOR, "#design-sensors tbody tr")) == 6
    page.browser.execute_script("const s = document.querySelectorAll('#axes select')[3]; s.value = 0; "
                                "s.dispatchEvent(new Event('change', {bubbles: true}));")
    assert page.script("window.plumb.design.geometry.chips.join()") == "0,0,0,0,1,1"


def check_compare(page):
    """Six sensors against four: more faults are isolated, smaller ones are found; the same design differs in nothing."""
    rows = ("Object.fromEntries([...document.querySelectorAll('#compare tbody tr')].map(r => "
            "[r.children[0].textContent, r.className || 'same']))")
    page.choose("geometry", "paper-tetrahedron")
    page.browser.find_element(By.ID, "keep-design").click()
    same = page.script(rows)
    assert len(same) > 10 and set(same.values()) == {"same"}, same
    page.choose("geometry", "platonic:6")
    now = page.script(rows)
    assert now["faulty units isolated at rest"] == "better" and now["sensors"] == "differs", now
    assert now["guaranteed isolation threshold"] == "better", now


def check_drag(page):
    """The tip of the first axis is where its label is, less the label's distance."""
    page.choose("geometry", "paper-tetrahedron")
    canvas = page.browser.find_element(By.CSS_SELECTOR, "#design-sphere canvas")
    page.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", canvas)
    at = page.script("(() => { const l = document.querySelector('#design-sphere .sphere-labels span').style; "
                     "return [parseFloat(l.left) / 100 - 0.5, parseFloat(l.top) / 100 - 0.5]; })()")
    size = canvas.size
    x, y = at[0] * size["width"] / 1.14, at[1] * size["height"] / 1.14
    axis = "JSON.stringify(window.plumb.design.geometry.axes[0])"
    before = page.script(axis)
    actions = ActionChains(page.browser)
    actions.move_to_element_with_offset(canvas, int(x), int(y)).click_and_hold().move_by_offset(-25, -20).release().perform()
    assert page.script(axis) != before, "the axis was not dragged"


def check_break(page):
    page.tab("break")
    digests = set()
    for preset in page.script("[...document.querySelectorAll('#preset option')].map(o => o.value)"):
        page.choose("preset", preset)
        digests.add(page.check_run())
    assert len(digests) == len(page.script("[...document.querySelectorAll('#preset option')]")), "two stories are the same"
    check_table2(page)
    check_motions(page)
    check_rules(page)
    page.choose("preset", "drift")
    before = page.check_run()
    slider = page.browser.find_element(By.CSS_SELECTOR, "#faults input[type=range]")
    page.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", slider)
    slider.send_keys(Keys.PAGE_UP)
    assert page.check_run() != before, "a slider changes nothing"
    for entry in page.script("[...document.querySelectorAll('#faults option')].map(o => o.value).filter(v => /^F\\d/.test(v))"):
        page.browser.execute_script("const s = document.querySelector('#faults select.grow'); s.value = arguments[0]; "
                                    "s.dispatchEvent(new Event('change'))", entry)
        page.settle()
        assert page.script("document.getElementById('break-error').hidden"), (entry, page.script("document.getElementById('break-error').textContent"))
        page.check_run()
    page.choose("tool", "design")
    page.check_run()
    page.choose("preset", "drill-a")
    page.settle()
    page.browser.find_elements(By.CSS_SELECTOR, "#events button")[0].click()
    assert page.script("document.querySelector('#machine .was-taken') !== null")
    # Of three sensors that could be the faulty one, attitude by attitude fewer are left.
    left = "[...document.querySelectorAll('#shrink button')].map(b => b.textContent)"
    assert "a2 alone" in page.script(left)[0], page.script(left)
    page.browser.find_element(By.ID, "play").click()
    then = page.script("document.getElementById('time').textContent")
    page.wait(f"document.getElementById('time').textContent !== {json.dumps(then)}")
    page.browser.find_element(By.ID, "play").click()


def check_table2(page):
    """All 23 experiments, at the press of a button: nobody who is healthy is named, and single faults are found."""
    page.choose("preset", "table2")
    page.check_run()
    page.browser.find_element(By.ID, "table2-all").click()
    answers = "[...document.querySelectorAll('#table2 tbody tr')].map(r => r.lastElementChild.textContent)"
    page.wait(f"{answers}.every(text => text !== '')", 120)
    told = page.script(answers)
    assert len(told) == 23 and set(told) <= {"right", "withheld"}, told
    assert told[0] == "right" and told[17:] == ["withheld"] * 6, told
    page.settle()
    page.browser.find_elements(By.CSS_SELECTOR, "#table2 tbody button")[13].click()
    page.check_run()
    assert page.script("window.plumb.second.scene.faults.join()").startswith("a4:stuck=0V")


def check_motions(page):
    """Every motion, of chips and of single sensors; what is shown there is of a flight."""
    for preset in ("chip", "drift"):
        for motion in page.script("[...document.querySelectorAll('#motion option')].map(o => o.value)"):
            page.choose("preset", preset)
            page.choose("motion", motion)
            page.check_run()
            flight = motion not in ("stations", "roll")
            assert page.script("document.getElementById('machine-card').hidden") == flight, motion
            assert ("its bound" in page.script("document.getElementById('verdict').textContent")) == flight, motion


def check_rules(page):
    """A chip that fails in flight is named by plumb, in the table of rules and in the list of explanations; PX4 names it later."""
    page.choose("preset", "flight")
    page.check_run()
    cells = "[...document.querySelectorAll('#rules tbody tr')].map(r => [...r.children].map(c => c.textContent))"
    plumb, paper, px4, _ = page.script(cells)
    assert plumb[2] == px4[2] == "a1 a2 a3" and plumb[5] == px4[5] == "no" and paper[1] == "not there", (plumb, paper, px4)
    after = [float(told[4].removeprefix("after ").removesuffix(" s")) for told in (plumb, px4)]
    assert after[0] < 0.1 < after[1], after
    assert "chip 1 (a1 a2 a3) excluded" in page.script("document.getElementById('sets').textContent")
    assert set(page.script("Object.keys(window.plumb.second.files())")) == {"array.toml", "play.sh"}
    page.choose("preset", "drilling")
    page.check_run()
    plumb, paper, _, plain = page.script(cells)
    assert plumb[2] == "a2" and plumb[5] == "no" and paper[1] != "not there" and plain[5] == "no", (plumb, paper, plain)


def check_share(page, file):
    """The address holds the scene: another window with it shows the same page."""
    page.tab("design")
    page.choose("geometry", "cone:5")
    box = page.browser.find_elements(By.CSS_SELECTOR, "#axes input")[4]
    box.send_keys(Keys.CONTROL, "a")
    box.send_keys("0.37")
    page.tab("break")
    page.choose("preset", "drift")
    page.choose("tool", "design")
    page.browser.find_element(By.ID, "add-fault").click()
    page.settle()
    page.browser.execute_script("const s = document.getElementById('scrub'); s.value = 21.5; s.dispatchEvent(new Event('input'))")
    shown = ("[JSON.stringify(window.plumb.design.geometry), JSON.stringify(window.plumb.second.scene), document.body.dataset.run, "
             "document.getElementById('time').textContent, document.querySelector('[role=tab][aria-selected=true]').id, "
             "document.getElementById('verdict').textContent, document.getElementById('tool').value]")
    digest = page.check_run()
    before = page.script(shown)
    assert before[3] == "21.5 s", before
    page.wait("location.hash === window.plumb.share.fragment() && location.hash.length > 20")
    address = page.script("location.href")
    page.browser.get("about:blank")
    page.browser.get(address)
    page.wait("document.body.dataset.ready === 'yes'")
    assert page.check_run() == digest
    assert page.script(shown) == before, (page.script(shown), before)
    # Pasted into a page that is open; and what holds no scene is refused, with a remedy, and the page goes on.
    page.browser.execute_script("location.hash = '#design'")
    page.wait("!document.getElementById('view-design').hidden")
    for bad in ("#break=e30x", "#break=" + base64.urlsafe_b64encode(b'{"run":{"story":"none"}}').decode().rstrip("="),
                "#break=" + base64.urlsafe_b64encode(b'{"design":{"axes":[[1,2]],"noise_mps2":1}}').decode().rstrip("=")):
        page.browser.execute_script("location.hash = arguments[0]", bad)
        page.wait("!document.getElementById('share-error').hidden")
        assert "emedy" in page.script("document.getElementById('share-error').textContent")
    page.choose("preset", "healthy")
    assert page.check_run() != digest
    scene = address[address.index("#"):]
    page.wait(f"location.hash === window.plumb.share.fragment() && location.hash !== '{scene}'")
    page.browser.execute_script("location.hash = arguments[0]", scene)
    page.wait("document.getElementById('share-error').hidden")
    assert page.check_run() == digest
    page.browser.find_element(By.ID, "copy-address").click()
    page.wait("document.getElementById('share-told').textContent.length > 0")
    assert set(page.script("Object.keys(window.plumb.second.files())")) == {"array.toml", "stand.toml", "run.toml", "play.sh"}
    page.check_silence(file)


def check_looks(page, shots):
    axe = (pathlib.Path(page.source) / "web/node_modules/axe-core/axe.min.js").read_text(encoding="utf-8")
    page.browser.execute_script(axe)
    for view in ("design", "break", "table2", "flight", "drop"):
        page.tab(view if view in ("design", "drop") else "break")
        if view in ("table2", "flight"):
            page.choose("preset", view)
            page.settle()
        for name, width in WIDTHS.items():
            for dark in (False, True):
                page.view(width, dark)
                where = f"{view}-{name}-{'dark' if dark else 'light'}"
                if shots:
                    shoot(page, pathlib.Path(shots) / f"{where}.png", width)
                wide = page.script("document.documentElement.scrollWidth")
                assert wide <= width, (where, wide)
                found = page.browser.execute_async_script(
                    "const done = arguments[1]; axe.run({runOnly: arguments[0]}).then(r => done(r.violations.map(v => "
                    "v.id + ': ' + v.nodes.map(n => n.target + ' ' + n.failureSummary).join(' | '))))", AXE_TAGS)
                assert not found, (where, found)


def shoot(page, path, width):
    high = page.script("document.documentElement.scrollHeight")
    clip = {"x": 0, "y": 0, "width": width, "height": min(high, 12000), "scale": 1}
    shot = page.browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True, "clip": clip})
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(base64.b64decode(shot["data"]))


def main(native, source, shots=None):
    built = pathlib.Path(source) / "build/web"
    if not (built / "explorer.html").is_file():
        skip("the page is not built (scripts/web)")
    if not shutil.which("chromedriver"):
        skip("no chromedriver (Debian package chromium-driver)")
    whole = len(gzip.compress((built / "explorer.html").read_bytes()))
    logs = len(gzip.compress((built / "explorer" / "logs.js").read_bytes()))
    assert whole - logs < MOST_PAGE_BYTES and logs < MOST_LOGS_BYTES, (whole, logs)
    browser = open_browser()
    browser.set_script_timeout(120)
    try:
        page = Page(browser, native, source)
        page.view(WIDTHS["desk"], False)
        page.open((built / "explorer" / "index.html").resolve())
        page.open((built / "explorer.html").resolve())
        first = page.script("performance.getEntriesByName('first-contentful-paint')[0].startTime")
        print(f"first picture after {first:.0f} ms, {MOST_FIRST_PICTURE_MS} are meant")
        check_design(page)
        check_break(page)
        page.check_silence((built / "explorer.html").resolve())
        print(f"{page.runs} runs, every decision and every bit of every verdict as the native core's")
        check_share(page, (built / "explorer.html").resolve())
        check_looks(page, shots)
        page.check_silence((built / "explorer.html").resolve())
    finally:
        browser.quit()
    print("the page is sound")


if __name__ == "__main__":
    main(*sys.argv[1:])
