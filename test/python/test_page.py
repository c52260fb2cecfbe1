#!/usr/bin/python3
"""test_page.py PAGE XML: all that a page has in Python runs, one piece after the other."""

import os
import pathlib
import re
import sys
import tempfile

page, scenes = map(pathlib.Path, sys.argv[1:])
pieces = re.findall(r"^```python\n(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
if not pieces:
    sys.exit(f"{page} has no Python")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.symlink(scenes, "xml")
    exec(compile("\n".join(pieces), str(page), "exec"), {})
