"""replay_browser.py PROGRAM.wasm SOURCE: the corpus of bench/replay in Chromium: every byte of what it tells is what it tells under
node, which replay.mjs holds against the native program. Skipped, saying so, where the browser or its driver is not there."""

import base64
import pathlib
import shutil
import subprocess
import sys

from browser import open_browser, skip

ARGUMENTS = ["--scenarios", "200"]
MOST_S = 1200


def in_browser(program, wasi):
    """The program in an empty page, by the same WASI as under node."""
    script = wasi.replace("export async function", "async function") + """
      const [program, args, done] = arguments;
      const bytes = Uint8Array.from(atob(program), (c) => c.charCodeAt(0));
      WebAssembly.compile(bytes).then((module) => runWasi(module, ["plumb_web_replay", ...args]))
        .then((said) => done(said), (error) => done({code: -1, out: "", error: String(error)}));"""
    browser = open_browser()
    browser.set_script_timeout(MOST_S)
    browser.command_executor.set_timeout(MOST_S)
    try:
        browser.get("data:text/html,<!doctype html><title>replay</title>")
        said = browser.execute_async_script(script, base64.b64encode(program).decode(), ARGUMENTS)
        name = browser.capabilities["browserName"] + " " + browser.capabilities["browserVersion"]
    finally:
        browser.quit()
    assert said["code"] == 0, said["error"]
    return name, said["out"]


def main(program, source):
    if not shutil.which("chromedriver"):
        skip("no chromedriver (Debian package chromium-driver)")
    web = pathlib.Path(source) / "web"
    name, here = in_browser(pathlib.Path(program).read_bytes(), (web / "wasi.mjs").read_text())
    there = subprocess.run(["node", web / "run.mjs", program, *ARGUMENTS], capture_output=True, text=True, check=True).stdout
    cases = [line for line in here.splitlines() if not line.startswith("#")]
    assert len(cases) > int(ARGUMENTS[1]), here[-500:]
    differing = [a for a, b in zip(here.splitlines(), there.splitlines()) if a != b]
    assert here == there, differing[:3]
    print(f"{len(cases)} cases in {name}: what node says, byte for byte")


if __name__ == "__main__":
    main(*sys.argv[1:])
