#!/usr/bin/python3
"""test_notebooks.py NOTEBOOK...: their cells of code run in order, and no output is stored in them."""

import json
import os
import pathlib
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")

books = [(path, json.loads(path.read_text(encoding="utf-8"))) for path in map(pathlib.Path, sys.argv[1:])]
if not books:
    sys.exit("no notebook is named")
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for path, book in books:
        names: dict = {}
        cells = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
        if not cells or any(cell["outputs"] or cell["execution_count"] for cell in cells):
            sys.exit(f"{path.name} has no code, or outputs: strip them")
        for number, cell in enumerate(cells):
            exec(compile("".join(cell["source"]), f"{path.name}, piece {number}", "exec"), names)
