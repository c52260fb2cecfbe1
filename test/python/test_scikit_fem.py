#!/usr/bin/python3
"""test_scikit_fem.py NOTEBOOK: bodies of scikit-fem's are those of numpy's, where scikit-fem is installed."""

import json
import pathlib
import sys
import unittest

import numpy

try:
    import skfem
except ImportError:
    skfem = None

BODIES, CONTACT = [cell for cell in json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))["cells"]
                   if cell["cell_type"] == "code"][:2]


class ScikitFem(unittest.TestCase):
    @unittest.skipUnless(skfem, "scikit-fem is not installed")
    def test_two_assemblies_have_one_solution(self):
        found = []
        for assembly in ("of_numpy", "of_scikit_fem"):
            names: dict = {}
            exec("".join(BODIES["source"]), names)
            names["assembled"] = names[assembly]
            exec("".join(CONTACT["source"]).replace("tolerance=1e-8", "tolerance=1e-13"), names)
            found.append(names["solution"])
        self.assertAlmostEqual(found[1].energy / found[0].energy, 1, delta=1e-12)
        for numbers in ("u", "forces", "tangential"):  # in other orders of nodes
            first, second = (numpy.sort(getattr(solution, numbers)) for solution in found)
            numpy.testing.assert_allclose(second, first, rtol=0, atol=1e-10 * abs(first).max())

    def test_the_contact_takes_thirty_lines_at_most(self):
        self.assertLessEqual(len(CONTACT["source"]), 30)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
