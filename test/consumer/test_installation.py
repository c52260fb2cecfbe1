#!/usr/bin/python3
"""test_installation.py BUILD_DIR: Epafi as it is installed from a finished build, moved to another place: what lies where, that
nothing remembers the build, that the programs run, and that projects of somebody else find, link and run it on one and on
three ranks. All of it in BUILD_DIR/test/consumer."""

import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

import h5py
import numpy

BUILD = pathlib.Path(sys.argv[1]).resolve()
HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
WORK = BUILD / "test" / "consumer"
FIRST, PREFIX = WORK / "first", WORK / "moved"
PROJECTS = WORK / "projects"
LIMIT = 600  # seconds, against hanging

os.environ.update({"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OPENBLAS_NUM_THREADS": "1",
                   "MPLBACKEND": "Agg", "PYTHONDONTWRITEBYTECODE": "1"})


@functools.cache
def cache():
    """The variables of the build, by name."""
    lines = (BUILD / "CMakeCache.txt").read_text(encoding="utf-8").splitlines()
    return dict(re.match(r"([^:#/]+):[^=]*=(.*)", line).groups() for line in lines if re.match(r"[^:#/]+:[^=]*=", line))


def run(*command):
    return subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=LIMIT, check=False)


def must(*command):
    """What the command printed. \\raises AssertionError if it fails"""
    result = run(*command)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))} ended with {result.returncode}:\n{result.stdout}")
    return result.stdout


def on_ranks(ranks, *command):
    return must(cache()["MPIEXEC_EXECUTABLE"], "--oversubscribe", "--bind-to", "none", cache()["MPIEXEC_NUMPROC_FLAG"], ranks,
                *command)


def configure(project, *definitions):
    """Configures test/consumer/<project> for the installed Epafi; the folder it will be built in."""
    folder = PROJECTS / project.name
    same = [f"-D{name}={cache()[name]}" for name in ("CMAKE_CXX_COMPILER", "CMAKE_CXX_COMPILER_LAUNCHER") if name in cache()]
    must(cache()["CMAKE_COMMAND"], "-G", cache()["CMAKE_GENERATOR"], "-S", project, "-B", folder,
         f"-DCMAKE_PREFIX_PATH={PREFIX};{cache().get('CMAKE_PREFIX_PATH', '')}", *same, *definitions)
    return folder


def is_shared():
    return cache()["BUILD_SHARED_LIBS"] == "ON"


def has_adapters():
    return cache()["EPAFI_ADAPTERS"] == "ON"


def version():
    """As CMakeLists.txt names it."""
    return re.search(r"project\(Epafi VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


def report(file):
    """{list: {parameter: value as text}}."""
    return {part.get("name"): {entry.get("name"): entry.get("value") for entry in part.findall("Parameter")}
            for part in xml.etree.ElementTree.parse(file).getroot().findall("ParameterList")}


def setUpModule():
    shutil.rmtree(WORK / "first", ignore_errors=True)
    for folder in (PREFIX, PROJECTS):
        shutil.rmtree(folder, ignore_errors=True)
    must(cache()["CMAKE_COMMAND"], "--install", BUILD, "--prefix", FIRST)
    FIRST.rename(PREFIX)


class Places(unittest.TestCase):
    def libraries(self):
        return sorted((PREFIX / cache()["CMAKE_INSTALL_LIBDIR"]).glob("libepafi*"))

    def headers(self):
        return sorted((PREFIX / "include").rglob("*.hpp"))

    def test_everything_lies_where_the_platform_has_it(self):
        for name in ("bin/epafi", "bin/epafi-plot", "share/epafi/xml/coercive.xml",
                     "share/epafi/xml/meshes/bracket.geo", "share/epafi/plot/run.py", "share/doc/epafi/README.md",
                     "share/doc/epafi/LICENSE", "share/doc/epafi/docs/user-guide.md", "include/epafi/ContactSolver.hpp",
                     "include/epafi/qp/solve/QpSolver.hpp"):
            self.assertTrue((PREFIX / name).is_file(), name)
        rooms = {"base", "direct", "qp/operators", "qp/constraints", "qp", "benchmarks", "deck", "scene", "decomposition", "mesh", "meshing", "assembly", "fem", "contact", "model", "accuracy",
                 "fetidp/operator", "fetidp/precondition", "fetidp/equilibrium", "fetidp/solve", "simulation", "output"}
        if has_adapters():
            rooms |= {"linear", "adapters"}
        ending = f"so.{version()}" if is_shared() else "a"
        names = {file.name for file in self.libraries()}
        self.assertLessEqual({"libepafi." + ending, *(f"libepafi_{room.replace('/', '_')}.{ending}" for room in rooms)}, names)
        for room in rooms:
            self.assertTrue((PREFIX / "include/epafi" / room).is_dir(), room)

    def test_every_header_that_a_header_names_is_installed(self):
        self.assertGreater(len(self.headers()), 100)
        for header in self.headers():
            text = header.read_text(encoding="utf-8")
            for name in re.findall(r'#include "([^"]+)"', text):
                self.assertTrue((PREFIX / "include" / name).is_file(), f"{header.name} includes {name}")
            for name in ("cholmod.h", "metis.h", "hdf5.h", "gmshc.h", "Amesos2.hpp"):
                self.assertNotIn(f"#include <{name}>", text, f"{header.name}: Epafi's targets do not pass it on")

    def test_no_text_remembers_where_it_was_built_or_first_installed(self):
        files = [file for file in PREFIX.rglob("*") if file.suffix in (".cmake", ".py", ".hpp", ".xml") or file.name == "epafi-plot"]
        self.assertGreater(len([file for file in files if file.suffix == ".cmake"]), 10)
        for file in files:
            text = file.read_text(encoding="utf-8")
            for place in (BUILD, SOURCE, FIRST, cache()["CMAKE_INSTALL_PREFIX"] + "/", cache()["Trilinos_DIR"]):
                self.assertNotIn(str(place), text, file)

    def test_programs_and_libraries_find_their_own_by_their_place(self):
        for file in [PREFIX / "bin/epafi", *self.libraries()]:
            if file.suffix == ".a":
                continue
            header = must(cache()["CMAKE_READELF"], "-d", file)
            paths = [path for found in re.findall(r"R(?:UN)?PATH\).*\[(.*)\]", header) for path in found.split(":")]
            self.assertEqual([path for path in paths if path.startswith("$ORIGIN")] != [], is_shared(), f"{file}: {paths}")
            for path in paths:
                self.assertFalse(path.startswith((str(BUILD), str(FIRST))), f"{file}: {path}")

    def test_versions_agree(self):
        citation = (SOURCE / "CITATION.cff").read_text(encoding="utf-8")
        self.assertEqual(re.search(r"^version: (.*)$", citation, re.MULTILINE)[1], version())
        self.assertEqual(must(PREFIX / "bin/epafi", "--version"), f"epafi {version()}\n")


class Programs(unittest.TestCase):
    def test_a_scene_that_was_installed_is_solved_and_drawn(self):
        output = WORK / "coercive"
        shutil.rmtree(output, ignore_errors=True)
        text = on_ranks(2, PREFIX / "bin/epafi", PREFIX / "share/epafi/xml/coercive.xml", "--output", output)
        self.assertIn(f"Epafi {version()}: ", text)
        self.assertEqual(report(output / "report.xml")["Epafi"]["Version"], version())
        pictures = must(PREFIX / "bin/epafi-plot", output, "--dpi", 30).split()
        self.assertGreaterEqual(len(pictures), 3)
        for picture in pictures:
            self.assertTrue(pathlib.Path(picture).is_file(), picture)


class Consumer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = configure(HERE)
        must(cache()["CMAKE_COMMAND"], "--build", cls.folder)

    def test_the_documents_show_these_programs(self):
        for document, program in (("docs/qp.md", "string.cpp"), ("README.md", "contact.cpp")):
            self.assertIn(f"```cpp\n{(HERE / program).read_text(encoding='utf-8')}```\n",
                          (SOURCE / document).read_text(encoding="utf-8"), f"{document} shows another {program}")

    def test_a_quadratic_program_is_solved(self):
        length, h = 1 - 2 * 0.2**0.5, 1 / 101  # of the string that lies on the floor, which carries as much; the mesh size
        for ranks in (1, 3):
            text = on_ranks(ranks, self.folder / "string")
            self.assertTrue(text.startswith("Converged: "), text)
            self.assertAlmostEqual(float(re.search(r"the floor carries (\S+)", text)[1]), length, delta=h**2)

    def test_a_contact_problem_has_the_energy_that_the_driver_finds(self):
        file = WORK / "coercive.xml"
        must(PREFIX / "bin/epafi", PREFIX / "share/epafi/xml/coercive.xml", "--set", "Solver/Tolerance=1e-10", "--report", file)
        energy = 1.1**2 * float(report(file)["Accuracy"]["Energy"])  # without gaps all is in proportion to the loads
        for ranks in (1, 3):
            text = on_ranks(ranks, self.folder / "contact")
            self.assertTrue(text.startswith("Converged, "), text)
            self.assertAlmostEqual(float(re.search(r"energy (\S+),", text)[1]) / energy, 1, delta=1e-10)

    def test_a_mesh_of_its_own_has_the_displacements_that_the_driver_finds(self):
        output = WORK / "circle"
        shutil.rmtree(output, ignore_errors=True)
        must(PREFIX / "bin/epafi", HERE / "circle.xml", "--output", output)
        with h5py.File(output / "circle.h5") as file:
            expected = file["/bodies/block/u"][:, :2]
        for ranks in (1, 3):
            text = on_ranks(ranks, self.folder / "elasticity")
            found = numpy.array([[float(number) for number in line.split()] for line in text.splitlines()])
            self.assertEqual(found.shape, expected.shape)
            self.assertLessEqual(abs(found - expected).max(), 1e-10 * abs(expected).max())
        self.assertLessEqual(len((SOURCE / "docs/examples/elasticity.cpp").read_text(encoding="utf-8").splitlines()), 120)

    def test_heat_is_conducted_through_stratimikos(self):
        self.assertEqual((self.folder / "heat-conduction").is_file(), has_adapters())
        for ranks in (1, 3) if has_adapters() else ():
            text = on_ranks(ranks, self.folder / "heat-conduction", PREFIX / "share/epafi/xml/linear/fetidp.xml", 40, 4)
            self.assertIn("as small as was asked for", text)


class Lookup(unittest.TestCase):
    def test_find_package_says_what_is_missing_and_looks_for_no_more_than_is_asked(self):
        configure(HERE / "lookup", f"-DEPAFI_IS_SHARED={is_shared()}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
