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
        self.assertEqual(len(one), 2 * 5 + 10 + 8)
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
        self.assertEqual(len(items), 2 * 4 + 10)
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
        self.assertEqual(fields[2], ["normal", "area", "initial_gap", "gap", "multiplier", "force", "pressure", "active"])

    def test_cells_are_counter_clockwise_and_name_existing_nodes(self):
        content = datasets(self.runs[4] / "run.h5")
        for body in ("left_body", "right"):
            points, cells = content[f"/bodies/{body}/points"], content[f"/bodies/{body}/cells"]
            corners = points[cells]
            a, b = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
            self.assertTrue((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all())
            self.assertEqual(set(cells.ravel()), set(range(len(points))))


# Numbers of VTK's cell types by XDMF's names of topologies; and how many cells a block has.
VTK_TYPE = {"Polyline": 3, "Triangle": 5, "Quadrilateral": 9, "Tetrahedron": 10, "Hexahedron": 12}
CELLS = {"triangle": 32, "quadrilateral": 16, "tetrahedron": 384, "hexahedron": 64}


class ElasticBlocks(unittest.TestCase):
    """Two blocks pressed together, in every kind of cells; the pressure is 3."""

    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.runs = {}
        for cells in CELLS:
            directory = pathlib.Path(cls.place.name) / cells
            subprocess.run([*LAUNCH, "2", WRITER, str(directory), cells], check=True)
            cls.runs[cells] = directory

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def test_displacement_has_the_components_of_the_physics_and_stress_a_value_a_node(self):
        for cells, directory in self.runs.items():
            content = datasets(directory / "run.h5")
            components = 2 if cells in ("triangle", "quadrilateral") else 3
            nodes = 5**components
            for body in ("lower", "upper"):
                u = content[f"/bodies/{body}/u"]
                self.assertEqual(u.shape, (nodes, components))
                self.assertEqual(content[f"/bodies/{body}/von_mises"].shape, (nodes,))
                self.assertEqual(f"/bodies/{body}/displacement" in content, components == 2)
                if components == 2:
                    shown = content[f"/bodies/{body}/displacement"]
                    numpy.testing.assert_array_equal(shown, numpy.column_stack([u, numpy.zeros(nodes)]))
            with h5py.File(directory / "run.h5") as file:
                self.assertEqual(file["bodies/lower"].attrs["cell_type"].decode(), cells)

    def test_multipliers_are_pressure_times_area_along_the_normal(self):
        for directory in self.runs.values():
            content = datasets(directory / "run.h5")
            fields = {name: content[f"/contact/joint/{name}"] for name in ("pressure", "area", "multiplier", "normal")}
            numpy.testing.assert_allclose(fields["pressure"], 3, rtol=1e-3)
            numpy.testing.assert_allclose(fields["pressure"] * fields["area"], fields["multiplier"], rtol=1e-12)
            numpy.testing.assert_allclose(numpy.linalg.norm(fields["normal"], axis=1), 1, rtol=1e-12)
            cells = content["/contact/joint/cells"]
            self.assertEqual(set(cells.ravel()), set(range(len(fields["area"]))))

    def test_vtk_sees_cells_of_positive_size_a_vector_to_warp_by_and_stress(self):
        vtk = self.vtk()
        for cells, directory in self.runs.items():
            grids = self.grids(vtk, directory / "run.xdmf")
            self.assertEqual(sorted(grids), ["joint", "lower", "upper"], cells)
            for body in ("lower", "upper"):
                grid = grids[body]
                self.assertEqual(grid.GetNumberOfCells(), CELLS[cells])
                self.assertEqual({grid.GetCellType(k) for k in range(grid.GetNumberOfCells())}, {VTK_TYPE[cells.title()]})
                self.assertEqual(grid.GetPointData().GetArray("displacement").GetNumberOfComponents(), 3)
                self.assertEqual(grid.GetPointData().GetArray("von_mises").GetNumberOfComponents(), 1)
                self.assertEqual(grid.GetCellData().GetArray("subdomain").GetNumberOfComponents(), 1)
                self.assertAlmostEqual(self.size(vtk, grid), 1.0, places=9)
                warp = vtk.vtkWarpVector()
                warp.SetInputData(grid)
                warp.SetInputArrayToProcess(0, 0, 0, 0, "displacement")
                warp.Update()
                up = 3 if cells in ("triangle", "quadrilateral") else 5
                self.assertLess(warp.GetOutput().GetBounds()[up], grid.GetBounds()[up] - 0.01)
            joint = grids["joint"]
            self.assertGreater(joint.GetNumberOfCells(), 0)
            self.assertEqual(joint.GetPointData().GetArray("normal").GetNumberOfComponents(), 3)
            pressure = joint.GetPointData().GetArray("pressure")
            self.assertAlmostEqual(pressure.GetRange()[0], 3, places=2)

    def vtk(self):
        try:
            import vtkmodules.all
        except ImportError:
            self.skipTest("VTK is not there; python3-vtk9 has it")
        return vtkmodules.all

    @staticmethod
    def grids(vtk, file):
        """The document's grids by their names, as it describes them. (Debian's VTK is built without its XDMF readers.)"""
        from vtkmodules.util import numpy_support
        content, result = datasets(file.parent / "run.h5"), {}

        def values(element):
            return content[element.find("DataItem").text.split(":")[1]]

        for described in xml.etree.ElementTree.parse(file).findall("./Domain/Grid/Grid"):
            grid, points, topology = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), described.find("Topology")
            points.SetData(numpy_support.numpy_to_vtk(values(described.find("Geometry")), deep=True))
            grid.SetPoints(points)
            for corners in values(topology):
                grid.InsertNextCell(VTK_TYPE[topology.get("TopologyType")], len(corners), [int(k) for k in corners])
            for attribute in described.findall("Attribute"):
                array = numpy_support.numpy_to_vtk(values(attribute), deep=True)
                array.SetName(attribute.get("Name"))
                kind = {"Scalar": 1, "Vector": 3}[attribute.get("AttributeType")]
                assert array.GetNumberOfComponents() == kind, attribute.get("Name")
                (grid.GetPointData() if attribute.get("Center") == "Node" else grid.GetCellData()).AddArray(array)
            result[described.get("Name")] = grid
        return result

    @staticmethod
    def size(vtk, grid):
        """Area or volume, 0 or less where VTK finds a cell inside out."""
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        data = sizes.GetOutput().GetCellData()
        array = data.GetArray("Volume" if grid.GetCell(0).GetCellDimension() == 3 else "Area")
        values = [array.GetValue(k) for k in range(array.GetNumberOfTuples())]
        return sum(values) if min(values) > 0 else min(values)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
