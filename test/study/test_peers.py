#!/usr/bin/python3
"""test_peers.py PEERS SOURCE_DIR: the side-by-side runs from outside. All of it is skipped, with code 77 and a sentence, where the
peers' packages are not installed."""

import csv
import ctypes.util
import glob
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # as ctest is told
try:
    import numpy
    import scipy.sparse
except ImportError:
    scipy = None

PEERS, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
COMPLETE, FAILED, WRONG_USAGE = range(3)
LIMIT = 120  # seconds
COLUMNS = ["problem", "unknowns", "solver", "total_seconds", "iterations", "energy", "peak_bytes"]
OURS = "epafi,linear_cholmod,linear_muelu"
BLOCKS = "epafi,epafi_separate,snesvi_cholmod,snesvi_hypre,snesvi_gamg,calculix,calculix_tetrahedra"
HAS_PETSC = (glob.glob("/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages/petsc4py") and
             importlib.util.find_spec("mpi4py") is not None)
if scipy is None or not HAS_PETSC or not shutil.which("ccx"):
    print("Skipped: SciPy, PETSc for Python or CalculiX is not installed; ./setup packages peers installs them.")
    sys.exit(SKIPPED)

sys.path.insert(0, str(SOURCE / "drivers/compare"))
import calculix  # noqa: E402
import calculix_scenes  # noqa: E402
import contact_bounds  # noqa: E402


def active_set_energy(file):
    """Energy of an exported problem by dense linear algebra, without a change of variables: rows with a force or a penetration
    are equations, until the set of them settles."""
    source = contact_bounds.PetscFile(file)
    k, f = dense(source), source.array(">f8")
    b, c = dense(source), source.array(">f8")
    offset = source.array(">f8")[0]
    active = numpy.ones(len(c), dtype=bool)
    for _ in range(50):
        rows = b[active]
        matrix = numpy.block([[k, rows.T], [rows, numpy.zeros((len(rows), len(rows)))]])
        both = numpy.linalg.solve(matrix, numpy.concatenate([f, c[active]]))
        u, force = both[:len(f)], numpy.zeros(len(c))
        force[active] = both[len(f):]
        following = force + numpy.abs(numpy.diag(k)).max() * (b @ u - c) > 0
        if (following == active).all():
            return 0.5 * u @ k @ u - f @ u + offset, int(active.sum())
        active = following
    raise AssertionError("the active set does not settle")


def dense(source):
    return source.matrix().toarray()


def reference_energy(problem, size):
    with open(SOURCE / "test/reference/membranes.csv", newline="", encoding="utf-8") as table:
        found = [row for row in csv.DictReader(table)
                 if (row["problem"], row["elements_per_unit_side"]) == (problem, str(size))]
    return float(found[0]["energy"])


class Peers(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def peers(self, *arguments, **environment):
        return subprocess.run([PEERS, "--output", self.place / "out", *map(str, arguments)], capture_output=True, text=True,
                              timeout=LIMIT, check=False, env={**os.environ, **environment})

    def table(self):
        with open(self.place / "out" / "peers.csv", newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            rows = {row["solver"]: row for row in reader}
        self.assertEqual(reader.fieldnames[:len(COLUMNS)], COLUMNS)
        return rows

    def test_every_energy_is_the_reference_and_every_ratio_that_of_the_times(self):
        for problem in ("coercive", "semicoercive"):
            run = self.peers("--problem", problem, "--size", 16, "--solvers", OURS, "--repeats", 1)
            self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""), run.stdout)
            rows = self.table()
            self.assertEqual(",".join(rows), OURS)
            energy = reference_energy(problem, 16)
            for name, row in rows.items():
                self.assertEqual((row["problem"], row["status"]), (problem, "ok"))
                self.assertLessEqual(abs(float(row["energy"]) - energy), 1e-6 * abs(energy), name)
                ratio = float(row["total_seconds"]) / float(rows["epafi"]["total_seconds"])
                self.assertAlmostEqual(float(row["ratio"]), ratio, delta=1e-9 * ratio)
                self.assertGreaterEqual(int(row["iterations"]), 1)
                self.assertGreater(int(row["peak_bytes"]), 1_000_000)
                self.assertIn(f"{ratio:.2f}", run.stdout)
            self.assertEqual(int(rows["epafi"]["unknowns"]), 17 * 32 + (17 if problem == "semicoercive" else 0))

    def test_the_median_lies_between_least_and_greatest(self):
        self.peers("--size", 8, "--solvers", "epafi,linear_cholmod", "--repeats", 3)
        for row in self.table().values():
            self.assertEqual(row["repeats"], "3")
            self.assertLessEqual(float(row["minimum"]), float(row["total_seconds"]))
            self.assertLessEqual(float(row["total_seconds"]), float(row["maximum"]))

    def test_a_size_without_reference_is_compared_with_epafi(self):
        run = self.peers("--size", 12, "--solvers", OURS, "--repeats", 1, "--tolerance", 1e-9)
        self.assertEqual(run.returncode, COMPLETE, run.stdout)
        self.assertIn("compared with epafi's", run.stdout)
        for name, row in self.table().items():
            self.assertLess(float(row["energy_error"]), 1e-8, name)

    def test_a_missing_package_is_named(self):
        (self.place / "petsc4py.py").write_text("raise ImportError('not here')\n", encoding="utf-8")
        run = self.peers("--size", 8, "--solvers", "epafi,snesvi_cholmod", "--repeats", 1, PYTHONPATH=str(self.place))
        self.assertEqual(run.returncode, COMPLETE, run.stdout + run.stderr)
        self.assertIn("python3-petsc4py", run.stdout)
        self.assertEqual(self.table()["snesvi_cholmod"]["status"], "missing")

    def test_a_solver_that_fails_says_why(self):
        run = self.peers("--size", 16, "--solvers", OURS, "--repeats", 2, "--epafi-options",
                         "'Solver/MPRGP/Maximum Multiplications=3'")
        self.assertEqual(run.returncode, FAILED, run.stdout)
        rows = self.table()
        self.assertEqual((rows["epafi"]["status"], rows["epafi"]["total_seconds"]), ("failed", ""))
        self.assertIn("limit of operator products", rows["epafi"]["reason"])
        self.assertIn("epafi failed", run.stdout)
        self.assertEqual((rows["linear_muelu"]["status"], rows["linear_muelu"]["ratio"]), ("ok", ""))

    def test_a_wrong_energy_is_pointed_out(self):
        run = self.peers("--size", 16, "--solvers", "epafi,linear_cholmod", "--repeats", 1, "--epafi-options",
                         "Bodies/left/Conductivity=1.001")
        self.assertEqual(run.returncode, FAILED, run.stdout)
        self.assertEqual({name: row["status"] for name, row in self.table().items()},
                         {"epafi": "inaccurate", "linear_cholmod": "ok"})
        self.assertIn("the energy is off", run.stdout)

    def export(self, scene, *arguments):
        file = self.place / "system.petsc"
        run = subprocess.run([pathlib.Path(PEERS).parent.parent / "epafi-export", scene, file, *arguments], capture_output=True,
                             text=True, timeout=LIMIT, check=False)
        return run, file

    def export_blocks(self, problem, size):
        mesh = [f"--set=Bodies/{body}/Elements={{{size},{size},{size}}}" for body in ("lower", "upper")]
        run, file = self.export(SOURCE / "drivers/compare" / f"{problem}.xml", *mesh)
        self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""))
        return file

    def test_an_exported_problem_has_the_solution_of_the_scene(self):
        for problem, unknowns in (("held_blocks", 600), ("floating_blocks", 625)):
            energy, closed = active_set_energy(self.export_blocks(problem, 4))
            run = self.peers("--problem", problem, "--size", 4, "--solvers", "epafi,epafi_separate", "--repeats", 1,
                             "--tolerance", 1e-8)
            self.assertEqual(run.returncode, COMPLETE, run.stdout + run.stderr)
            for row in self.table().values():
                self.assertEqual((int(row["unknowns"]), int(row["closed_nodes"]), row["ranks"]), (unknowns, closed, "2"))
                self.assertLess(abs(float(row["energy"]) - energy), 1e-7 * abs(energy))
                self.assertTrue(5 <= closed <= 20, closed)  # of 25: neither all open nor all closed

    def test_exported_places_and_directions_make_the_rigid_motions(self):
        source = contact_bounds.PetscFile(self.export_blocks("floating_blocks", 4))
        k = dense(source)
        source.array(">f8"), dense(source), source.array(">f8"), source.array(">f8")  # f, B, c, e
        bodies, nodes = source.array(">i4"), source.array(">i4")
        self.assertEqual((nodes.min(), nodes.max()), (0, 124))
        modes = contact_bounds.rigid_modes(source.array(">f8").reshape(-1, 3), source.array(">f8").reshape(-1, 3))
        lift = modes[:, 2] * (bodies == 1)
        self.assertGreater(numpy.linalg.norm(lift), 1)
        self.assertLess(numpy.linalg.norm(k @ lift), 1e-10 * numpy.linalg.norm(k) * numpy.linalg.norm(lift))
        free = numpy.flatnonzero(numpy.linalg.norm(k @ (modes * (bodies == 1)[:, None]), axis=0) < 1e-10 * numpy.linalg.norm(k))
        self.assertEqual(free.tolist(), [2])  # sliding planes hold the five others

    def test_the_change_of_variables_makes_jumps_bounds(self):
        # b = (2, -1, 0) on unknowns 0, 2, 4; b = 3 on 3; b = (1, 2) on 0, 4: two rows share unknowns, as mortars do.
        rows = contact_bounds.Rows(scipy.sparse.csr_matrix([[2.0, 0, -1, 0, 0], [0, 0, 0, 3, 0], [0] * 5, [1, 0, 0, 0, 2]]),
                                   numpy.array([0.5, 0.25, 9.0, 0.75]))
        change = rows.change_of_variables().toarray()
        u = numpy.arange(10.0).reshape(5, 2)**2
        z = rows.invert(u)
        numpy.testing.assert_allclose(change @ z, u, rtol=1e-14, atol=1e-14)
        self.assertEqual(rows.gap.tolist(), [0.5, 0.25, 0.75])
        numpy.testing.assert_allclose(z[rows.pivots], [2 * u[0] - u[2], 3 * u[3], u[0] + 2 * u[4]])
        with self.assertRaisesRegex(ValueError, "depend on each other"):
            contact_bounds.Rows(scipy.sparse.csr_matrix([[1.0, 2], [2, 4]]), numpy.zeros(2)).change_of_variables()

    def test_all_solvers_find_the_same_energy_of_blocks(self):
        for problem, size, order in (("held_blocks", 6, 1), ("floating_blocks", 4, 2)):
            run = self.peers("--problem", problem, "--size", size, "--order", order, "--repeats", 1)
            self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""), run.stdout)
            rows = self.table()
            self.assertEqual(",".join(rows), BLOCKS)
            for name, off in (("calculix", 0.03), ("calculix_tetrahedra", 0.3 if order == 1 else 0.03)):
                others = rows.pop(name)  # other elements: another energy
                if others["status"] != "missing":
                    self.assertEqual(others["status"], "ok", others["reason"])
                    self.assertLess(float(others["energy_error"]), off)
            for name, row in rows.items():
                self.assertEqual((row["problem"], row["order"], row["status"]), (problem, str(order), "ok"), row["reason"])
                self.assertLessEqual(float(row["energy_error"]), 1e-6, name)
                self.assertEqual(row["closed_nodes"], rows["epafi"]["closed_nodes"], name)
                self.assertEqual(row["unknowns"], rows["epafi"]["unknowns"], name)
                self.assertIn(f"{float(row['ratio']):.2f}", run.stdout)

    def test_the_deck_of_calculix_has_all_nodes_once_and_the_weight_of_the_loads(self):
        for order, nodes in ((1, 125), (2, 729 - 64 - 3 * 4 * 4 * 5)):  # of 9^3 places none in faces or inside of elements
            text, forces = calculix.deck("held_blocks", 4, order)
            self.assertEqual(len(forces), nodes)
            self.assertAlmostEqual(sum(force for force in forces.values() if force), 0.0, places=9)  # as much up as down
            listed = text.split("*ELEMENT")[0].splitlines()[1:]
            places = {tuple(map(float, line.split(",")[1:])) for line in listed}
            self.assertEqual(len(places), 2 * nodes - (25 if order == 1 else 81 - 16))  # those of the joint are at one place
        self.assertIn("C3D20", text)

    def test_tetrahedra_for_calculix_fill_the_blocks(self):
        for order, nodes in ((1, 125), (2, 729)):
            text, forces = calculix.deck("held_blocks", 4, order, "tetrahedra")
            self.assertEqual(len(forces), nodes)
            self.assertAlmostEqual(sum(force for force in forces.values() if force), 0.0, places=9)
            self.assertEqual(sum(line.endswith(("S1", "S2", "S3", "S4")) for line in text.splitlines()), 2 * 2 * 16)  # two a cube
        self.assertIn("C3D10", text)
        for corners in calculix.SHAPES["tetrahedra"].cells:
            a, b, c = (numpy.subtract(corner, corners[0]) for corner in corners[1:])
            self.assertGreater(numpy.dot(numpy.cross(a, b), c), 0)

    def test_blocks_meshed_apart_have_nearly_the_energy_of_those_alike(self):
        energies = {}
        for lower in (4, 6):
            run = self.peers("--problem", "held_blocks", "--size", 6, "--lower-size", lower, "--order", 2, "--repeats", 1, "--solvers",
                             "epafi,calculix")
            self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""), run.stdout)
            rows = self.table()
            self.assertEqual((int(rows["epafi"]["unknowns"]), rows["epafi"]["lower_size"]),
                             (sum(3 * 2 * n * (2 * n + 1)**2 for n in (lower, 6)), str(lower)))
            energies[lower] = {name: float(row["energy"]) for name, row in rows.items() if row["status"] == "ok"}
        self.assertIn("held_blocks n = 6 over 6", run.stdout)
        for name, energy in energies[4].items():
            self.assertLess(abs(energy / energies[6][name] - 1), 0.01, name)

    def test_calculix_has_its_multipliers_on_the_block_that_is_asked_for(self):
        for upper, lower, slave, first in ((4, 6, "lower", "SLAVE"), (6, 4, "upper", "MASTER")):
            text, forces = calculix.deck("held_blocks", upper, 1, n_lower=lower, slave=slave)
            self.assertEqual(len(forces), (upper + 1)**3)
            self.assertIn(f"*SURFACE, NAME={first}, TYPE=ELEMENT\n{lower**2 * (lower - 1) + 1}, S2", text)

    def test_calculix_has_the_energy_of_the_same_elements_of_the_punch(self):
        meshes = {"block": (8, 8), "punch": (2, 4)}
        settings = [word for body, (nx, ny) in meshes.items()
                    for word in (f"--set=Bodies/{body}/Elements={{{nx},{ny}}}", f"--set=Bodies/{body}/Order=1")]
        run, file = self.export(SOURCE / "xml/punch.xml", *settings)
        self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""))
        energy, _ = active_set_energy(file)
        coarse, = calculix_scenes.solve("ccx", "punch", meshes, 1, 1, LIMIT)
        fine, = calculix_scenes.solve("ccx", "punch", meshes, 2, 1, LIMIT)
        self.assertLess(abs(coarse["energy"] / energy - 1), 1e-5)  # contact yields a little
        self.assertEqual(coarse["unknowns"], 3 * 2 * (81 + 15))
        self.assertTrue(-19.2 < fine["energy"] < coarse["energy"])  # the limit is -19.195

    def test_the_forces_of_a_scene_for_calculix_are_its_loads(self):
        for order in (1, 2):
            for problem, meshes, force in (("punch", {"block": (8, 8), "punch": (2, 4)}, -200 * 5),
                                           ("three_cubes", dict.fromkeys(("lower", "middle", "upper"), (4,) * 3), 300 * 2.5**3 - 80 * 5**3)):
                deck = calculix_scenes.SCENES[problem](meshes, order)
                self.assertAlmostEqual(sum(deck.forces.values()), force, places=9)
        with self.assertRaisesRegex(calculix.Failed, "no multiple of 4"):
            calculix_scenes.three_cubes({"upper": (6, 6, 6)}, 2)

    def test_facets_have_the_area_of_the_surface_that_they_follow(self):
        corners = [(0.0, 0.0, 1.0), (3.0, 0.0, 1.0), (0.0, 2.0, 1.0)]
        middles = [(1.5, 0.0, 1.0), (1.5, 1.0, 1.0), (0.0, 1.0, 1.0)]
        numpy.testing.assert_allclose(calculix_scenes.areas(corners), [1, 1, 1], rtol=1e-12)
        numpy.testing.assert_allclose(calculix_scenes.areas(corners + middles), [0, 0, 0, 1, 1, 1], rtol=1e-12, atol=1e-12)
        angles = ((0.0, 0.0), (0.4, 0.0), (0.0, 1.0), (0.2, 0.0), (0.2, 0.5), (0.0, 0.5))  # and heights, on a cylinder of radius 1
        curved = calculix_scenes.areas([(numpy.cos(angle), numpy.sin(angle), height) for angle, height in angles])
        self.assertLess(abs(sum(curved) / 0.2 - 1), 1e-3)
        self.assertGreater(abs(sum(calculix_scenes.areas([(numpy.cos(a), numpy.sin(a), z) for a, z in angles[:3]])) / 0.2 - 1), 5e-3)

    @unittest.skipUnless(ctypes.util.find_library("gmsh"), "Gmsh's library is not installed: ./setup packages build")
    def test_the_bracket_for_calculix_is_whole(self):
        deck = calculix_scenes.bracket({"bracket": 7.0}, 2)
        along = [sum(force for (_, axis), force in deck.forces.items() if axis == k) for k in (1, 2, 3)]
        eye, washers = 2 * numpy.pi * 8 * 8, 2 * numpy.pi * (9**2 - 4.5**2)
        numpy.testing.assert_allclose(along, [5 * eye, 0, 5 * eye - 26.2 * washers], rtol=3e-3, atol=1e-9)
        heights = [z for _, _, z in deck.nodes.values()]
        self.assertAlmostEqual(max(heights), 60)

    def test_blocks_name_a_missing_package_on_two_ranks(self):
        (self.place / "petsc4py.py").write_text("raise ImportError('not here')\n", encoding="utf-8")
        run = self.peers("--problem", "held_blocks", "--size", 4, "--solvers", "epafi,snesvi_gamg", "--repeats", 1,
                         PYTHONPATH=str(self.place))
        self.assertEqual(run.returncode, COMPLETE, run.stdout + run.stderr)
        self.assertIn("install the package python3-petsc4py,", run.stdout)
        self.assertEqual(self.table()["snesvi_gamg"]["status"], "missing")

    def test_what_cannot_be_exported_is_said(self):
        run, _ = self.export(SOURCE / "xml/coercive.xml")
        self.assertEqual(run.returncode, WRONG_USAGE, run.stderr)
        self.assertIn("'left' is a membrane", run.stderr)
        for arguments in (("--set",), ("--nonsense",), ("one", "two")):
            run, _ = self.export(SOURCE / "drivers/compare/held_blocks.xml", *arguments)
            self.assertEqual(run.returncode, WRONG_USAGE, run.stderr)
            self.assertIn("epafi-export --help", run.stderr)

    def test_scenes_have_one_energy_by_whatever_solver_and_zone(self):
        for problem, order, peers in (("three_cubes", 1, "active_sets_cholmod,active_sets_gamg,snesvi_cholmod,linear_cholmod,linear_gamg"),
                                      ("hertz_sphere", 2, "active_sets_cholmod,linear_cholmod")):
            run = self.peers("--problem", problem, "--order", order, "--repeats", 1, "--ranks", 1, "--solvers", f"epafi,{peers}")
            self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""), run.stdout)
            rows = self.table()
            self.assertEqual(",".join(rows), f"epafi,{peers}")
            self.assertEqual({row["status"] for row in rows.values()}, {"ok"})
            self.assertEqual(rows["linear_cholmod"]["closed_nodes"], rows["epafi"]["closed_nodes"])
            self.assertGreater(int(rows["active_sets_cholmod"]["iterations"]), 3)  # three meshes and more
            self.assertEqual(int(rows["linear_cholmod"]["iterations"]), 1)

    def test_a_linear_solve_asks_for_a_zone(self):
        run = self.peers("--problem", "three_cubes", "--repeats", 1, "--ranks", 1, "--solvers", "epafi,linear_cholmod")
        self.assertEqual(run.returncode, FAILED, run.stdout)
        self.assertIn("let active_sets_cholmod", self.table()["linear_cholmod"]["reason"])

    def test_wrong_usage(self):
        for word, arguments in (("abaqus", ["--solvers", "epafi,abaqus"]), ("--size", ["--size", "18"]),
                                ("--repeats", ["--repeats", "0"]), ("--tolerance", ["--tolerance", "0"]),
                                ("Grd", ["--size", "8", "--solvers", "epafi", "--epafi-options", "Decomposition/Grd={2,2}"]),
                                ("membranes: 1", ["--ranks", "2"]), ("--ranks", ["--problem", "held_blocks", "--ranks", "0"]),
                                ("--order", ["--order", "2"]), ("--order", ["--problem", "held_blocks", "--order", "3"]),
                                ("within 4 ... 128", ["--problem", "held_blocks", "--size", "512"]),
                                ("snesvi_gamg", ["--problem", "held_blocks", "--solvers", "linear_muelu"]),
                                ("have mortars", ["--problem", "held_blocks", "--lower-size", "5", "--solvers", "snesvi_gamg"]),
                                ("within 4 ... 128", ["--problem", "held_blocks", "--lower-size", "2"]),
                                ("have mortars", ["--problem", "held_blocks", "--multipliers", "upper", "--solvers", "snesvi_hypre"]),
                                ("for blocks only", ["--lower-size", "8"]), ("within 1 ... 8", ["--problem", "lug", "--size", "9"]),
                                ("snesvi_cholmod", ["--problem", "bracket", "--solvers", "calculix"]),
                                ("setup studies", ["--programs", str(self.place)])):
            run = self.peers(*arguments)
            self.assertEqual(run.returncode, WRONG_USAGE, run.stdout + run.stderr)
            self.assertIn(word, run.stderr)
            self.assertFalse((self.place / "out" / "peers.csv").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
