"""Runs the Python blocks of docs/python.md, one after the other, in an empty folder, and the commands of the tool between
them: what the page shows works."""

import os
import pathlib
import re
import shlex
import subprocess
import tempfile

source = pathlib.Path(os.environ["PLUMB_SOURCE_DIR"])
page = (source / "docs" / "python.md").read_text()
blocks = re.findall(r"^```(python)?\n(.*?)^```", page, flags=re.DOTALL | re.MULTILINE)
assert sum(language == "python" for language, _ in blocks) >= 5, "the page has lost its examples"
with tempfile.TemporaryDirectory() as folder:
    os.symlink(source / "examples", pathlib.Path(folder) / "examples")
    os.chdir(folder)
    names, ran = {}, 0
    for language, block in blocks:
        if language == "python":
            exec(compile(block, "docs/python.md", "exec"), names)
        elif block.startswith("plumb "):
            subprocess.run([os.environ["PLUMB_TOOL"], *shlex.split(block)[1:]], check=True)
        else:
            continue
        ran += 1
print(f"{ran} blocks of docs/python.md ran")
