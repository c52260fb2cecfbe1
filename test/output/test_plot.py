#!/usr/bin/python3
"""test_plot.py EPAFI_PLOT: pictures from a small synthetic run, and one sentence where there is nothing to draw."""

import importlib.machinery
import importlib.util
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import traceback
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import elastic_runs  # noqa: E402
import h5py  # noqa: E402
import model_problem  # noqa: E402
import numpy  # noqa: E402

PROGRAM = sys.argv[1]
TABLE = """problem,H_inverse,H_over_h,primal_dimension,dual_dimension,corners,cg_iterations,paper_cg_iterations
coercive,2,4,200,33,10,14,19
coercive,4,4,800,161,42,18,24
semicoercive,2,4,200,33,10,20,
semicoercive,4,4,800,161,42,22,28
"""
HISTORY = """iteration,outer,step,projected_gradient,constraint_residual,objective,active_bounds,hessian_multiplications
0,0,s,1,0.5,0,3,1
1,0,c,0.1,0.25,-1,3,2
"""
QP = """problem,size,method,preconditioner,start,hessian_multiplications,status,permon_multiplications
journal_bearing,100,fixed_step,none,zero,504,Converged,444
journal_bearing,200,fixed_step,none,zero,1780,MaxIterations,1393
journal_bearing,100,projected_cg,none,zero,416,Converged,
journal_bearing,200,projected_cg,none,zero,1078,Converged,
torsion,100,projected_cg,face_multigrid,nested,18,Converged,
"""
SCALING = "problem,H_inverse,H_over_h,ranks,operator,preconditioner,hessian_multiplications,assembly_seconds,setup_seconds," \
          "solve_seconds,apply_seconds,apply_bytes,stream_bytes_per_second,precision,unknowns\n"
ONE_RANK = "".join(f"coercive,{inverse},8,1,{form},dirichlet,20,0.1,0.2,0.3,1e-3,1e6,1e10,double,1000\n"
                   for inverse in (2, 4, 8) for form in ("implicit", "explicit", "shared"))
TWO_RANKS = "coercive,8,8,2,shared,dirichlet,20,0.1,0.2,0.3,1e-3,1e6,1e10,double,1000\n"
HERTZ = """scene,block_factor,h,hertz_radius,radius_error,radius_by_area_error,pressure_error
hertz_cylinder,1,0.1,0.5,0.04,0.2,0.03
hertz_cylinder,1,0.05,0.5,0.01,0.1,0.02
hertz_cylinder,4,0.1,0.5,0.04,0.2,0
hertz_sphere,1,0.1,0.5,0.04,0.2,0.03
"""
TRACTION = """source,x,pressure,shear,bound
computed,-0.5,0,0,0
computed,0,1000,100,300
computed,0.5,0,0,0
closed form,-0.5,0,0,0
closed form,0.5,0,0,0
"""
LOOP = """source,step,displacement,force
computed,press,0,-80
computed,half way,0.01,400
computed,to the right,0.02,600
computed,to the left,-0.02,-700
thin strip,,0,-80
thin strip,,0.02,600
"""
TARGETS = """scene,order,target,unknowns,seconds,estimated_error,true_error
punch,2,0.05,1348,0.014,0.044,0.033
punch,2,0.025,4058,0.036,0.017,0.014
punch,1,0.05,3000,0.1,0.05,0.045
three_cubes,2,0.05,3000,0.1,0.05,0.045
"""
MESHES = """mesh,order,unknowns,hessian_multiplications,relative_error,discretisation_error,algebraic_error,effectivity,seconds
0,1,60,3,0.3,1.7,0,0.9,0.003
1,2,180,4,0.12,0.76,0.02,0.75,0.002
"""
STABILITY = """case,parameter,expected,outcome,ok,hessian_multiplications,family,value,variant
jump between the bodies,1e+0,solved,solved,1,20,jumps,1,default
jump between the bodies,1e+8,solved,wrong answer,0,90,jumps,1e8,default
jump between the bodies,1e+0,solved,solved,1,40,jumps,1,plain
jump between the bodies,1e+8,solved or stopped,stopped,1,9000,jumps,1e8,plain
zero load,floating,refused: not unique,refused: not unique,1,0,input,,default
"""
HETEROGENEITY = """bodies,pattern,cut,jump,adaptive,constraints,hessian_multiplications,condition,converged
held membranes,stripes,grid,1,no,0,20,4.3,1
held membranes,stripes,grid,1,auto,0,20,4.3,1
held membranes,stripes,grid,1e+06,no,0,26,6.7,1
held membranes,stripes,grid,1e+06,auto,0,26,6.7,1
cubes in space,columns,grid,1,no,0,24,22.5,1
cubes in space,columns,grid,1,auto,0,24,22.5,1
cubes in space,columns,grid,1e+06,no,0,1132,4e5,1
cubes in space,columns,grid,1e+06,auto,36,83,8.3,1
"""
SPECTRA = """problem,cluster,series,value,part,preconditioner,smallest_eigenvalue,largest_eigenvalue
""" + "".join(f"coercive,{cluster},{series},{value},{part},{kind},0.5,{top}\n" for kind, top in (("none", 30), ("dirichlet", 4))
              for cluster, part in ((0, "all"), (0, "gluing"), (0, "contact"), (1, "all"))
              for series, value in (("H/h", 4), ("H/h", 8), ("1/H", 2), ("1/H", 4)))
ACCURACY = ("problem,variant,order,elements,tolerance,unknowns,seconds,hessian_multiplications,energy_error,algebraic_error,"
            "estimated_error,on_pareto_front,discretisation_error\n") + "".join(
    f"coercive,{variant},1,{elements},{tolerance},{elements**2},{elements / 1000},20,{1 / elements},1e-5,{1 / elements},1,"
    f"{1 / elements}\n" for variant, tolerance in (("default", "1e-6"), ("balanced", "balanced"), ("tolerance_1e-10", "1e-10"),
                                                   ("ladder_plain", "1e-4"), ("ladder_plain", "1e-7"))
    for elements in (16, 32))
PEERS = """problem,solver,order,size,energy,total_seconds,status
held_blocks,epafi,2,{0},{1},0.1,ok
held_blocks,snesvi_hypre,2,{0},,,missing
held_blocks,calculix,2,{0},{1},3,ok
"""
EFFECTIVITY = """scene,level,estimated_error,discretisation_error,effectivity
coercive,0,0.02,0.02,1
coercive,1,0.01,0.02,0.5
stacked_blocks,0,1e-12,1e-13,10
"""
PREDICTION = """problem,method,ranks,subdomains_a_rank,local_seconds,neighbour_seconds,reduction_seconds,coarse_sum_seconds,coarse_solve_seconds,efficiency
coercive,feti-dp,1,1,1e-3,0,0,0,1e-6,1
coercive,feti-dp,1000,1,1e-3,1e-5,1e-5,1e-5,1e-3,0.5
blocks,hybrid,1,1,1e-3,0,0,0,1e-6,1
blocks,hybrid,1000,1,1e-3,1e-5,1e-5,1e-5,1e-4,0.8
"""


def loaded(file):
    """The program as a module, with what it draws by: loading that takes longer than most pictures."""
    loader = importlib.machinery.SourceFileLoader("epafi_plot", file)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    import plot.gallery  # noqa: F401 # the program puts its place on the path
    return module


EPAFI_PLOT = loaded(PROGRAM)


def run(*arguments):
    """The program in a process of its own, which has its libraries already."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as errors:
        sys.stdout.flush()
        child = os.fork()
        if child == 0:
            os.dup2(out.fileno(), 1)
            os.dup2(errors.fileno(), 2)
            status = 1
            try:
                status = EPAFI_PLOT.main([*map(str, arguments)])
            except SystemExit as end:
                status = end.code
            except BaseException:
                traceback.print_exc()
            sys.stdout.flush()
            os._exit(status)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        out.seek(0)
        errors.seek(0)
        return subprocess.CompletedProcess(arguments, status, out.read(), errors.read())


def size_of_png(file):
    head = file.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", file
    return struct.unpack(">II", head[16:24])


class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.sample = pathlib.Path(cls.shared.name) / "sample.h5"
        model_problem.write(cls.sample, n=8, parts=2, outer=3)

    @classmethod
    def tearDownClass(cls):
        cls.shared.cleanup()

    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.directory = pathlib.Path(self.place.name)

    def tearDown(self):
        self.place.cleanup()

    def pictures(self, *arguments):
        """The pictures that a good run names, all of which exist, and nothing unfinished beside them."""
        result = run(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        found = [pathlib.Path(line) for line in result.stdout.splitlines()]
        for picture in found:
            self.assertGreater(picture.stat().st_size, 5000, picture)
            self.assertEqual(list(picture.parent.glob(f".{picture.stem}*")), [])
        return found

    def refused(self, *arguments):
        result = run(*arguments)
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        return result.stderr

    def test_a_run_gives_four_pictures(self):
        found = self.pictures(self.sample, "--output", self.directory / "new" / "place", "--dpi", 60)
        self.assertEqual([picture.name for picture in found],
                         ["sample_deflection.png", "sample_decomposition.png", "sample_contact_middle.png",
                          "sample_convergence.png"])
        for picture in found:
            width, height = size_of_png(picture)
            self.assertTrue(300 < width < 900 and 200 < height < 900, (picture, width, height))

    def test_the_program_draws_without_a_display_or_a_home(self):
        (self.directory / "tables.csv").write_text(TABLE)
        result = subprocess.run([PROGRAM, str(self.directory)], capture_output=True, text=True, env={"PATH": "/usr/bin:/bin"})
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, f"{self.directory / 'tables.png'}\n", ""))

    def test_a_directory_is_searched_and_pictures_lie_beside_their_source(self):
        shutil.copy(self.sample, self.directory / "run.h5")
        (self.directory / "tables.csv").write_text(TABLE)
        (self.directory / ".hidden.partial.h5").write_text("unfinished")
        found = self.pictures(self.directory, "--format", "svg")
        self.assertEqual([picture.name for picture in found],
                         ["run_deflection.svg", "run_decomposition.svg", "run_contact_middle.svg",
                          "run_convergence.svg", "tables.svg"])
        self.assertEqual({picture.parent for picture in found}, {self.directory})

    def test_pictures_can_be_pdf(self):
        (self.directory / "tables.csv").write_text(TABLE)
        found = self.pictures(self.directory / "tables.csv", "--format", "pdf")
        self.assertEqual(found[0].read_bytes()[:5], b"%PDF-")

    def test_products_of_quadratic_programs_are_drawn(self):
        (self.directory / "qp.csv").write_text(QP)
        self.assertEqual([picture.name for picture in self.pictures(self.directory)], ["qp.png"])
        (self.directory / "qp.csv").write_text(QP.replace("1780", "many"))
        self.assertIn("many", self.refused(self.directory))

    def test_hard_cases_are_drawn_with_those_that_ended_otherwise_than_expected(self):
        (self.directory / "stability.csv").write_text(STABILITY)
        (picture,) = self.pictures(self.directory, "--format", "svg")
        self.assertEqual(picture.name, "stability.svg")
        for words in ("Jumps, default", "between bodies", "not as expected", "input"):
            self.assertIn(words, picture.read_text())
        (self.directory / "stability.csv").write_text(STABILITY.replace("9000", "many"))
        self.assertIn("many", self.refused(self.directory))

    def test_jumps_of_the_stiffness_are_drawn_without_and_with_adaptive_constraints(self):
        (self.directory / "heterogeneity.csv").write_text(HETEROGENEITY)
        (picture,) = self.pictures(self.directory, "--format", "svg")
        self.assertEqual(picture.name, "heterogeneity.svg")
        drawn = picture.read_text()
        for words in ("held membranes", "cubes in space", "stripes", "columns", "with adaptive constraints", "condition number"):
            self.assertIn(words, drawn)
        for words in ("channels", "stopped early"):
            self.assertNotIn(words, drawn)
        # What did not converge is ringed; without constraints a line is drawn only where it differs.
        lines = drawn.count("stroke-dasharray: ")
        stripes = HETEROGENEITY.replace("1e+06,no,0,26", "1e+06,no,0,90")
        (self.directory / "heterogeneity.csv").write_text(stripes.replace("83,8.3,1", "83,8.3,0"))
        self.pictures(self.directory, "--format", "svg")
        self.assertIn("stopped early", picture.read_text())
        self.assertGreater(picture.read_text().count("stroke-dasharray: "), lines)
        (self.directory / "heterogeneity.csv").write_text(HETEROGENEITY.replace("1132", "many"))
        self.assertIn("many", self.refused(self.directory))

    def test_spectra_are_drawn_over_size_and_number_of_subdomains(self):
        (self.directory / "spectra.csv").write_text(SPECTRA)
        (picture,) = self.pictures(self.directory, "--format", "svg")
        self.assertEqual(picture.name, "spectra.svg")
        drawn = picture.read_text()
        for words in ("FETI-DP", "contact alone", "eigenvalues of MF", "1/H, H/h = 8", "(H/h)²"):
            self.assertIn(words, drawn)
        self.assertNotIn("hybrid", drawn)
        (self.directory / "spectra.csv").write_text(SPECTRA.replace(",30", ",many"))
        self.assertIn("many", self.refused(self.directory))

    def test_scaling_is_drawn_as_far_as_it_was_measured(self):
        for rows, prediction in ((ONE_RANK, None), (TWO_RANKS, None), (ONE_RANK + TWO_RANKS, PREDICTION)):
            (self.directory / "scaling.csv").write_text(SCALING + rows)
            if prediction:
                (self.directory / "scaling_prediction.csv").write_text(prediction)
            self.assertEqual([picture.name for picture in self.pictures(self.directory)], ["scaling.png"])
        (self.directory / "scaling.csv").write_text(SCALING + ONE_RANK.replace("1e6", "many"))
        self.assertIn("many", self.refused(self.directory))
        (self.directory / "scaling.csv").write_text(SCALING + ONE_RANK.splitlines()[0])
        self.assertIn("no series", self.refused(self.directory))

    def test_accuracy_is_drawn_beside_time_products_and_mesh_size(self):
        (self.directory / "accuracy.csv").write_text(ACCURACY)
        names = [f"accuracy_{name}.png" for name in ("work", "products", "convergence", "spectrum")]
        self.assertEqual([picture.name for picture in self.pictures(self.directory)], names)
        (self.directory / "accuracy_effectivity.csv").write_text(EFFECTIVITY)
        found = self.pictures(self.directory, "--format", "svg")
        self.assertIn("balanced", found[0].read_text())
        self.assertIn("coercive", found[-1].read_text())
        self.assertNotIn("stacked blocks", found[-1].read_text())  # a mesh without error has no effectivity
        self.assertNotIn("CalculiX", found[0].read_text())
        for size, energy in ((4, -0.75), (8, -0.9375), (16, -0.984375)):  # their limit is -1: errors of a half, a quarter, an eighth
            folder = self.directory / "peers" / str(size)
            folder.mkdir(parents=True)
            (folder / "peers.csv").write_text(PEERS.format(size, energy))
        drawn = self.pictures(self.directory, "--format", "svg")[0].read_text()
        for words in ("CalculiX, order 2", "Epafi, order 2"):
            self.assertIn(words, drawn)
        self.assertNotIn("hypre", drawn)
        (folder / "peers.csv").write_text(PEERS.format(32, -1))
        self.assertNotIn("CalculiX", self.pictures(self.directory, "--format", "svg")[0].read_text())  # no limit to compare with
        (folder / "peers.csv").write_text(PEERS.format(16, "low"))
        self.assertIn("low", self.refused(self.directory))
        (folder / "peers.csv").unlink()
        (self.directory / "accuracy_effectivity.csv").write_text("scene,level\ncoercive,0\n")
        self.assertIn("effectivity", self.refused(self.directory))
        (self.directory / "accuracy.csv").write_text(ACCURACY.replace("0.03125", "little"))
        self.assertIn("little", self.refused(self.directory))
        (self.directory / "accuracy.csv").write_text(ACCURACY.replace("default", "other"))
        self.assertIn("default", self.refused(self.directory))

    def test_errors_of_hertzs_contacts_are_drawn(self):
        (self.directory / "hertz.csv").write_text(HERTZ)
        (picture,) = self.pictures(self.directory, "--format", "svg")
        for words in ("Hertz: cylinder", "Hertz: sphere", "block 4 times as large", "largest pressure"):
            self.assertIn(words, picture.read_text())
        (self.directory / "hertz.csv").write_text(HERTZ.replace("0.05", "fine"))
        self.assertIn("fine", self.refused(self.directory))

    def test_friction_is_drawn_beside_its_closed_forms(self):
        (self.directory / "friction_traction.csv").write_text(TRACTION)
        (self.directory / "friction_loop.csv").write_text(LOOP)
        pictures = self.pictures(self.directory, "--format", "svg")
        self.assertEqual([picture.name for picture in pictures], ["friction_traction.svg", "friction_loop.svg"])
        for picture, words in zip(pictures, (("closed form", "computed", "friction [MPa]"), ("thin strip", "to the right", "press"))):
            for word in words:
                self.assertIn(word, picture.read_text())
        self.assertNotIn("half way", pictures[1].read_text())  # names stand at turns
        (self.directory / "friction_loop.csv").write_text(LOOP.replace("600", "strong"))
        self.assertIn("strong", self.refused(self.directory / "friction_loop.csv"))

    def test_contacts_with_friction_show_what_slips(self):
        elastic_runs.write(self.directory / "run.h5", "quadrilateral")
        self.assertNotIn("sticks", self.pictures(self.directory, "--format", "svg")[2].read_text())
        with h5py.File(self.directory / "run.h5", "a") as content:
            pair = content["contact/joint"]
            number = len(pair["points"])
            pair["traction"], pair["friction_state"] = numpy.ones((number, 3)), numpy.arange(number) % 3
        picture = self.pictures(self.directory, "--format", "svg")[2]
        for word in ("slips", "sticks", "friction, along the line"):
            self.assertIn(word, picture.read_text())

    def test_contacts_in_space_show_the_boundary_of_what_sticks(self):
        elastic_runs.write(self.directory / "run.h5", "hexahedron")
        with h5py.File(self.directory / "run.h5", "a") as content:
            pair = content["contact/joint"]
            number = len(pair["points"])
            pair["traction"], pair["friction_state"] = numpy.ones((number, 3)), numpy.arange(number) % 3
        (picture,) = [picture for picture in self.pictures(self.directory, "--format", "svg") if "contact" in picture.name]
        for word in ("boundary of what sticks", "nodes stick,"):
            self.assertIn(word, picture.read_text())

    def test_runs_to_a_target_are_drawn(self):
        (self.directory / "targets.csv").write_text(TARGETS)
        (self.directory / "meshes.csv").write_text(MESHES)
        pictures = self.pictures(self.directory, "--format", "svg")
        self.assertEqual([picture.name for picture in pictures], ["targets.svg", "meshes.svg"])
        for picture, words in zip(pictures, (("punch, order 1", "three cubes", "a tenth above"), ("order 1", "order 2", "0.003 s"))):
            for word in words:
                self.assertIn(word, picture.read_text())
        (self.directory / "targets.csv").write_text(TARGETS.replace("0.036", "soon"))
        self.assertIn("soon", self.refused(self.directory))

    def test_elements_with_errors_give_the_mesh(self):
        shutil.copy(self.sample, self.directory / "run.h5")
        with h5py.File(self.directory / "run.h5", "a") as content:
            for body in content["bodies"].values():
                body["error"] = numpy.linspace(1e-6, 1, len(body["cells"]))
        self.assertIn("run_mesh.png", [picture.name for picture in self.pictures(self.directory)])
        with h5py.File(self.directory / "run.h5", "a") as content:
            for body in content["bodies"].values():
                del body["error"]
                body["error"] = numpy.ones(1)
        self.assertIn("do not fit", self.refused(self.directory))

    def test_a_history_table_alone_gives_the_convergence(self):
        (self.directory / "history.csv").write_text(HISTORY)
        self.assertEqual([picture.name for picture in self.pictures(self.directory)], ["history_convergence.png"])

    def test_a_run_without_contact_or_history_is_drawn_too(self):
        shutil.copy(self.sample, self.directory / "run.h5")
        with h5py.File(self.directory / "run.h5", "a") as content:
            del content["contact"], content["history"]
        self.assertEqual([picture.name for picture in self.pictures(self.directory)],
                         ["run_deflection.png", "run_decomposition.png"])

    def test_cells_in_any_order_are_drawn_too(self):
        shutil.copy(self.sample, self.directory / "run.h5")
        with h5py.File(self.directory / "run.h5", "a") as content:
            for body in content["bodies"].values():
                for name in ("cells", "subdomain"):
                    body[name][...] = body[name][:][::-1]
        self.assertEqual(len(self.pictures(self.directory)), 4)

    def test_elastic_bodies_of_all_cells_give_four_pictures(self):
        for cell_type in elastic_runs.CUTS:
            elastic_runs.write(self.directory / f"{cell_type}.h5", cell_type)
            found = self.pictures(self.directory / f"{cell_type}.h5", "--dpi", 60)
            self.assertEqual([picture.name for picture in found],
                             [f"{cell_type}_{what}.png" for what in ("deformed", "decomposition", "contact_joint", "convergence")])

    def test_elastic_bodies_without_contact_or_with_loose_contact_nodes_are_drawn_too(self):
        for cell_type in ("triangle", "hexahedron"):
            file = self.directory / f"{cell_type}.h5"
            elastic_runs.write(file, cell_type, n=3)
            with h5py.File(file, "a") as content:
                group = content["contact/joint"]
                del group["cells"]
                group["cells"] = numpy.arange(len(group["points"]))[:, None]
            self.assertEqual(len(self.pictures(file, "--dpi", 60)), 4)
            with h5py.File(file, "a") as content:
                content["contact/joint/active"][...] = 0
                for name in ("pressure", "multiplier"):
                    content[f"contact/joint/{name}"][...] = 0
            self.assertEqual(len(self.pictures(file, "--dpi", 60)), 4)
            with h5py.File(file, "a") as content:
                del content["contact"]
                for body in content["bodies"].values():
                    body["u"][...] = 0
                    body["von_mises"][...] = 0
            self.assertEqual(len(self.pictures(file, "--dpi", 60)), 3)

    def test_titles_state_how_much_displacements_are_enlarged(self):
        for amplitude, gap, said in ((0.002, 0.0, "20 times enlarged"), (0.2, 0.0, "as they are"),
                                     (0.002, 0.001, "2 times enlarged")):  # more would let the bodies cross
            elastic_runs.write(self.directory / "run.h5", "quadrilateral", amplitude=amplitude, gap=gap)
            self.pictures(self.directory / "run.h5", "--format", "svg")
            self.assertTrue(said in (self.directory / "run_deformed.svg").read_text(), said)

    def test_a_box_shows_a_part_of_the_shape_alone(self):
        for cell_type, box in (("triangle", "0.2,0.8,0.6,1.4"), ("hexahedron", "0,0.6,0,0.6,0,2")):
            elastic_runs.write(self.directory / f"{cell_type}.h5", cell_type)
            whole, part = self.directory / "whole", self.directory / "part"
            self.pictures(self.directory / f"{cell_type}.h5", "--dpi", 40, "--output", whole)
            self.pictures(self.directory / f"{cell_type}.h5", "--dpi", 40, "--output", part, f"--box={box}")
            differ = {file.name for file in whole.iterdir() if file.read_bytes() != (part / file.name).read_bytes()}
            self.assertEqual({name for name in differ if name.startswith(cell_type)}, {f"{cell_type}_deformed.png"})
        beside = self.refused(self.directory / "hexahedron.h5", "--box", "3,4,0,1")
        self.assertIn("the bodies fill x 0 … 1, y 0 … 1.", beside)
        for wrong in ("0,1,0", "0,1,1,0", "0,1,nan,1", "a,b,c,d", "0,inf,0,1"):
            self.assertIn("argument --box", run(self.directory / "hexahedron.h5", f"--box={wrong}").stderr)

    def test_a_load_step_is_drawn_by_its_name_or_number(self):
        file = self.directory / "run.h5"
        elastic_runs.write(file, "quadrilateral", amplitude=0.002)
        self.assertIn("it has no load steps", self.refused(file, "--step", "1"))
        with h5py.File(file, "a") as content:
            for number, (group, name) in enumerate((("to_the_left", "to the left"), ("1", "1")), 1):
                step = content.create_group(f"steps/{group}")
                step.attrs["name"], step.attrs["number"] = name, number
                for part in ("bodies", "contact", "history"):
                    content.copy(part, step)
                for body in step["bodies"].values():
                    body["u"][...] *= number
        last = self.pictures(file, "--format", "svg")[0]
        for word, stem, said in (("to the left", "run_to_the_left", "20 times"), ("2", "run_1", "10 times"),
                                 ("1", "run_1", "10 times")):
            picture = self.pictures(file, "--format", "svg", "--step", word)[0]
            self.assertEqual(picture.name, f"{stem}_deformed.svg")
            self.assertIn(said, picture.read_text())
        self.assertEqual(last.name, "run_deformed.svg")
        self.assertIn("its steps are 1 'to the left', 2 '1'.", self.refused(file, "--step", "3"))

    def test_a_hundred_thousand_nodes_in_space_are_drawn(self):
        elastic_runs.write(self.directory / "run.h5", "hexahedron", n=36)  # twice 37³ nodes
        self.assertEqual(len(self.pictures(self.directory / "run.h5")), 4)

    def test_cells_of_another_kind_than_said_are_refused(self):
        elastic_runs.write(self.directory / "run.h5", "triangle")
        with h5py.File(self.directory / "run.h5", "a") as content:
            content["bodies/lower"].attrs["cell_type"] = "hexahedron"
        self.assertIn("lower", self.refused(self.directory / "run.h5"))

    def test_what_cannot_be_drawn_is_refused_in_one_sentence(self):
        (self.directory / "text.h5").write_text("no HDF5")
        (self.directory / "other.csv").write_text("a,b\n1,2\n")
        with h5py.File(self.directory / "foreign.h5", "w") as content:
            content["x"] = [1, 2]
        for name in ("missing.h5", "text.h5", "foreign.h5", "other.csv"):
            self.assertIn(name, self.refused(self.directory / name))
        empty = self.directory / "empty"
        empty.mkdir()
        self.assertIn(str(empty), self.refused(empty))
        self.assertIn("text.h5", self.refused(self.sample, "--output", self.directory / "text.h5"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
