"""Runs the Python blocks of docs/python.md, one after the other, in an empty folder: what the page shows works."""

import os
import pathlib
import re
import tempfile

source = pathlib.Path(os.environ["PLUMB_SOURCE_DIR"])
page = (source / "docs" / "python.md").read_text()
blocks = re.findall(r"^```python\n(.*?)^```", page, flags=re.DOTALL | re.MULTILINE)
assert len(blocks) >= 5, "the page has lost its examples"
with tempfile.TemporaryDirectory() as folder:
    os.symlink(source / "examples", pathlib.Path(folder) / "examples")
    os.chdir(folder)
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
print(f"{len(blocks)} blocks of docs/python.md ran")
