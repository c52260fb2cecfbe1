#!/usr/bin/python3
"""test_files.py WRITER MPIRUN ARGUMENTS...: what other programs find in the files of the sample run."""

import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import h5py
import numpy

WRITER, LAUNCH = sys.argv[1], sys.argv[2:]


def datasets(file):
    """Every dataset by its path."""
    found = {}
    with h5py.File(file, "r") as content:
        content.visititems(lambda name, item: found.update({"/" + name: item[()]}) if hasattr(item, "dtype") else None)
    return found


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.runs = {}
        for ranks in (1, 2, 3, 4):
            directory = pathlib.Path(cls.place.name) / str(ranks)
            subprocess.run([*LAUNCH, str(ranks), WRITER, str(directory)], check=True)
            cls.runs[ranks] = directory

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def test_only_complete_files_are_there(self):
        for directory in self.runs.values():
            self.assertEqual(sorted(file.name for file in directory.iterdir()), ["history.csv", "run.h5", "run.xdmf"])

    def test_content_does_not_depend_on_the_number_of_ranks(self):
        one = datasets(self.runs[1] / "run.h5")
        self.assertEqual(len(one), 2 * 5 + 6 + 8)
        for ranks in (2, 3, 4):
            other = datasets(self.runs[ranks] / "run.h5")
            self.assertEqual(one.keys(), other.keys())
            for name, values in one.items():
                self.assertEqual(values.dtype, other[name].dtype, name)
                numpy.testing.assert_array_equal(values, other[name], name)
            for name in ("run.xdmf", "history.csv"):
                self.assertEqual((self.runs[1] / name).read_bytes(), (self.runs[ranks] / name).read_bytes())

    def test_every_data_item_of_the_xdmf_file_is_a_dataset_of_that_shape_and_type(self):
        directory = self.runs[2]
        tree = xml.etree.ElementTree.parse(directory / "run.xdmf")
        items = tree.findall(".//DataItem")
        self.assertEqual(len(items), 2 * 4 + 6)
        for item in items:
            file, dataset = item.text.strip().split(":")
            with h5py.File(directory / file, "r") as content:
                data = content[dataset]
                self.assertEqual(tuple(map(int, item.get("Dimensions").split())), data.shape, dataset)
                self.assertEqual(item.get("NumberType"), {"f": "Float", "i": "Int"}[data.dtype.kind], dataset)
                self.assertEqual(int(item.get("Precision")), data.dtype.itemsize, dataset)

    def test_grids_of_the_xdmf_file_hold_together(self):
        tree = xml.etree.ElementTree.parse(self.runs[3] / "run.xdmf")
        grids = tree.findall("./Domain/Grid/Grid")
        self.assertEqual([grid.get("Name") for grid in grids], ["left body", "right", "left/right"])
        for grid in grids:
            points = int(grid.find("Geometry/DataItem").get("Dimensions").split()[0])
            cells = int(grid.find("Topology").get("NumberOfElements"))
            self.assertEqual(cells, int(grid.find("Topology/DataItem").get("Dimensions").split()[0]))
            for attribute in grid.findall("Attribute"):
                rows = int(attribute.find("DataItem").get("Dimensions").split()[0])
                self.assertEqual(rows, points if attribute.get("Center") == "Node" else cells)
        fields = [[attribute.get("Name") for attribute in grid.findall("Attribute")] for grid in grids]
        self.assertEqual(fields[0], ["u", "subdomain"])
        self.assertEqual(fields[2], ["initial_gap", "gap", "multiplier", "active"])

    def test_cells_are_counter_clockwise_and_name_existing_nodes(self):
        content = datasets(self.runs[4] / "run.h5")
        for body in ("left_body", "right"):
            points, cells = content[f"/bodies/{body}/points"], content[f"/bodies/{body}/cells"]
            corners = points[cells]
            a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
            self.assertTrue((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all())
            self.assertEqual(set(cells.ravel()), set(range(len(points))))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
