#!/usr/bin/python3
"""test_faults.py EPAFI SOURCE_DIR SHORT_OF_MEMORY FAULTY_RANKS MPIRUN ARGUMENTS...: what goes wrong around the program: errors on
one rank alone, signals, checkpoints and restarts, disks that are full, runs that are killed. Nothing may hang, and nothing
that was found may be lost without a word."""

import concurrent.futures
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

import h5py
import numpy

PROGRAM, SOURCE, SHORT_OF_MEMORY, FAULTY_RANKS = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4]
LAUNCH = sys.argv[5:]
SOLVED, FAILED, WRONG_INPUT, NOT_SOLVABLE = range(4)
LIMIT = 60   # seconds that a run may take on a busy machine
ANSWER = 10  # seconds from a fault to the end of all ranks

# An iteration that takes long: no preconditioner, F by sparse solves with the whole factor.
SLOW = ["--set", "Solver/Preconditioner/Type=none", "--set", "Solver/Dual Operator/Mode=implicit",
        "--set", "Solver/Direct Solvers/Subdomains=KLU2",
        "--set", "Solver/Tolerance=1e-10", "--set", "Solver/Equilibrium Tolerance=1e-10"]


def scene(name):
    return str(SOURCE / "xml" / f"{name}.xml")


def elements(count, *bodies):
    return [word for body in bodies for word in ("--set", f"Bodies/{body}/Elements={{{count},{count}}}")]


def on_ranks(ranks, *command):
    return [*(LAUNCH + [str(ranks)] if ranks > 1 else []), *map(str, command)]


def run(*command, ranks=1, **options):
    return subprocess.run(on_ranks(ranks, *command), capture_output=True, text=True, timeout=LIMIT, check=False, **options)


def said(text):
    """The lines the program itself wrote to the error stream; mpirun adds some about the exit code."""
    return [line for line in text.splitlines() if line.startswith("epafi: ")]


def report_of(directory):
    root = xml.etree.ElementTree.parse(pathlib.Path(directory) / "report.xml").getroot()
    return {part.get("name"): {p.get("name"): p.get("value") for p in part.findall("Parameter")}
            for part in root.findall("ParameterList")}


def fields_of(file):
    """u of all bodies."""
    with h5py.File(file) as fields:
        return numpy.concatenate([body["u"][:].ravel() for body in fields["bodies"].values()])


def wait_for(condition, what, seconds=LIMIT):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain for {what}")
        time.sleep(0.002)


def ranks_of(launcher):
    """Process numbers of the ranks that a mpirun has started."""
    children = pathlib.Path(f"/proc/{launcher}/task/{launcher}/children")
    return [int(number) for number in children.read_text().split()]


class Faults(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def timed(self, *command, undisturbed, **options):
        """A run with a fault: at most so much longer than one without."""
        start = time.monotonic()
        ended = run(*command, **options)
        self.assertLess(time.monotonic() - start, undisturbed + ANSWER, ended.stderr)
        return ended

    def start(self, *command, ranks=1, **options):
        process = subprocess.Popen(on_ranks(ranks, *command), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def finish(self, process):
        out, err = process.communicate(timeout=LIMIT)
        return subprocess.CompletedProcess(process.args, process.returncode, out, err)

    def expect(self, ended, code, *words):
        """One sentence of ours that holds all words, and the code."""
        self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        sentences = said(ended.stderr)
        self.assertEqual(len(sentences), 1, ended.stderr)
        for word in words:
            self.assertIn(word, sentences[0])

    def assert_no_half_files(self, directory, name):
        """What is there under its final name is complete."""
        for file in directory.iterdir():
            if file.suffix == ".h5":
                fields_of(file)
            elif file.suffix in (".xml", ".xdmf"):
                xml.etree.ElementTree.parse(file)
            elif file.name == "checkpoint.epafi":
                self.assertEqual(run(PROGRAM, scene(name), "--quiet", "--restart", file).returncode, SOLVED)
            elif file.name == "history.csv":
                self.assertTrue(file.read_text().endswith("\n"))
            else:
                self.assertTrue(file.name.startswith(".") and file.name.endswith(".partial"), file.name)


class OneRankFails(Faults):
    def test_whoever_throws_what(self):
        cases = [("operator", FAILED, ["rank 1", "product number 15 went wrong"]),
                 ("input", WRONG_INPUT, ["rank 1", "nonsense"]),
                 ("unsolvable", NOT_SOLVABLE, ["rank 1", "slides"]),
                 ("several", FAILED, ["rank 1 has no memory left", "more machines"]),
                 ("all", WRONG_INPUT, ["all say so"]),
                 ("agreed", FAILED, ["rank 1 has no memory left"]),
                 ("nothing", FAILED, ["unknown error"])]
        start = time.monotonic()
        self.assertEqual(run(FAULTY_RANKS, "none", ranks=3).returncode, SOLVED)
        undisturbed = time.monotonic() - start
        for kind, code, words in cases:
            with self.subTest(kind):
                self.expect(self.timed(FAULTY_RANKS, kind, undisturbed=undisturbed, ranks=3), code, *words)

    def test_no_memory_on_one_rank_wherever_that_is(self):
        arguments = [scene("semicoercive"), "--output", self.place / "out", "--set", "Solver/Tolerance=1e-9"]
        environment = {**os.environ, "EPAFI_TEST_FAIL": "1:0"}
        start = time.monotonic()
        counted = run(SHORT_OF_MEMORY, *arguments, ranks=2, env=environment)
        undisturbed = time.monotonic() - start
        self.assertEqual(counted.returncode, SOLVED, counted.stderr)
        total = int(next(line for line in counted.stderr.splitlines() if line.startswith("allocations: ")).split()[1])
        writing = [0.95 + 0.005 * step for step in range(10)]
        for share in (0.2, 0.5, 0.8, 0.9, *writing):
            with self.subTest(share):
                directory = self.place / f"out{share:.3f}"
                arguments[2] = directory
                environment["EPAFI_TEST_FAIL"] = f"1:{int(share * total)}"
                ended = self.timed(SHORT_OF_MEMORY, *arguments, undisturbed=undisturbed, ranks=2, env=environment)
                self.expect(ended, FAILED, "rank 1 has no memory left")
                if directory.exists():
                    self.assert_no_half_files(directory, "semicoercive")

    def apart(self, *programs):
        """A run whose ranks are started by commands of their own."""
        command = [*LAUNCH, "1", *programs[0]]
        for program in programs[1:]:
            command += [":", LAUNCH[-1], "1", *program]
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=LIMIT, check=False)

    def test_files_that_one_rank_alone_sees(self):
        here, elsewhere = self.place / "here", self.place / "elsewhere"
        here.mkdir()
        elsewhere.mkdir()
        shutil.copy(scene("coercive"), here / "scene.xml")
        program = [PROGRAM, "scene.xml", "--output", "out"]
        ended = self.apart(["-wdir", here, *program], ["-wdir", elsewhere, *program])
        self.assertEqual(ended.returncode, SOLVED, ended.stderr)
        self.assertEqual({file.name for file in (here / "out").iterdir()},
                         {"scene.h5", "scene.xdmf", "history.csv", "report.xml", "checkpoint.epafi"})
        ended = self.apart(["-wdir", elsewhere, *program], ["-wdir", here, *program])
        self.expect(ended, WRONG_INPUT, "scene.xml", "does not exist")

    def test_a_disk_that_one_rank_alone_sees(self):
        directory = self.place / "out"
        directory.mkdir()
        private = f"mount -t tmpfs none {directory}"
        if subprocess.run(["unshare", "-m", "sh", "-c", private], capture_output=True, check=False).returncode != 0:
            self.skipTest("a process can get no disk of its own here")
        program = [PROGRAM, scene("coercive"), "--output", directory]
        ended = self.apart(program, ["unshare", "-m", "sh", "-c", f'{private}; exec "$@"', "sh", *program])
        self.expect(ended, FAILED, "Rank 1 does not see", str(directory), "share")
        self.assertIn("status      Converged", ended.stdout)
        self.assertEqual({file.name for file in directory.iterdir()}, {"history.csv", "report.xml", "checkpoint.epafi"})

    def test_memory_that_one_rank_alone_lacks(self):
        """The limit of the operating system, as a batch system sets it: somewhere in assembly or setup."""
        if "ASAN_OPTIONS" in os.environ:
            self.skipTest("the address sanitizer takes more than any limit at its start")
        program = [PROGRAM, scene("coercive"), "--quiet", *elements(512, "left", "right"), "--set",
                   "Solver/Direct Solvers/Share Identical Subdomains=no"]
        ended = self.apart(program, ["prlimit", "--data=150000000", *program])
        self.assertNotEqual(ended.returncode, SOLVED)
        self.assertEqual(len(said(ended.stderr)), 1, ended.stderr)
        self.assertTrue("memory" in said(ended.stderr)[0], ended.stderr)


class Signals(Faults):
    def interrupted(self, name, *changes, ranks, send, directory):
        """Starts a run, lets its iteration get going, and sends it a signal."""
        process = self.start(PROGRAM, scene(name), *SLOW, *changes, "--output", directory, "--checkpoint-interval", "0.01",
                             ranks=ranks)
        wait_for(lambda: (directory / "checkpoint.epafi").exists() or process.poll() is not None, "the first checkpoint")
        send(process)
        ended = self.finish(process)
        self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
        self.assertIn("Interrupted", ended.stdout)
        self.assertIn(f"--restart {directory / 'checkpoint.epafi'}", ended.stdout)
        self.assertEqual(said(ended.stderr), [])
        for file in ("history.csv", "report.xml", "checkpoint.epafi", f"{name}.h5"):
            self.assertTrue((directory / file).exists(), file)
        self.assertGreater(len((directory / "history.csv").read_text().splitlines()), 2)
        self.assertEqual(report_of(directory)["Status"]["Status"], "Interrupted")
        return ended

    def goes_on(self, name, *changes, ranks, send):
        """What an interrupted run and its restart find, on other numbers of ranks, is what one run finds."""
        first, whole = self.place / "first", self.place / "whole"
        self.interrupted(name, *changes, ranks=ranks[0], send=send, directory=first)
        precise = [*SLOW[6:], *changes]
        self.assertEqual(run(PROGRAM, scene(name), "--quiet", *precise, "--output", whole).returncode, SOLVED)
        expected = fields_of(whole / f"{name}.h5")
        for number in ranks[1:]:
            second = self.place / f"second{number}"
            ended = run(PROGRAM, scene(name), *SLOW, *changes, "--output", second, "--restart", first / "checkpoint.epafi",
                        ranks=number)
            self.assertEqual(ended.returncode, SOLVED, ended.stdout + ended.stderr)
            energies = [float(report_of(directory)["Accuracy"]["Energy"]) for directory in (second, whole)]
            self.assertAlmostEqual(energies[0], energies[1], delta=1e-9 * abs(energies[1]))
            found = fields_of(second / f"{name}.h5")
            self.assertLess(numpy.abs(found - expected).max(), 1e-8 * numpy.abs(expected).max())

    def test_one_rank_told_stops_all_and_a_restart_goes_on_on_others(self):
        self.goes_on("coercive", *elements(128, "left", "right"), ranks=(2, 3, 1),
                     send=lambda process: os.kill(ranks_of(process.pid)[1], signal.SIGTERM))

    def test_a_floating_body_goes_on_too(self):
        self.goes_on("semicoercive", *elements(128, "left", "right"), ranks=(1, 2),
                     send=lambda process: process.send_signal(signal.SIGINT))

    def test_cg_goes_on_too(self):
        self.goes_on("no_contact", *elements(256, "membrane"), ranks=(2, 1),
                     send=lambda process: process.send_signal(signal.SIGUSR1))  # which mpirun passes on

    def test_before_the_iteration_there_is_nothing_to_keep(self):
        for delay in (0, 0.1, 0.3):  # METIS is at work then, which traps SIGTERM for itself
            process = self.start(PROGRAM, scene("coercive"), *elements(512, "left", "right"), "--set",
                                 "Decomposition/Method=metis", "--set", "Decomposition/Parts=16", "--output", self.place / "out")
            self.assertTrue(process.stdout.readline().startswith("Epafi"))
            time.sleep(delay)
            process.send_signal(signal.SIGTERM)
            self.expect(self.finish(process), FAILED, "SIGTERM", "before the iteration", "start again")
            self.assertEqual(list((self.place / "out").iterdir()), [])

    def test_in_a_later_mesh_the_last_complete_one_is_kept(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                directory = self.place / f"out{ranks}"
                process = self.start(PROGRAM, scene("punch"), "--accuracy", "0.02%", "--output", directory, ranks=ranks)
                told = 0
                while told < 3:  # of six or more
                    line = process.stdout.readline()
                    self.assertTrue(line, "ended early")
                    told += line.startswith("  mesh ")
                process.send_signal(signal.SIGTERM)
                ended = self.finish(process)
                self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
                self.assertEqual(said(ended.stderr), [])
                told += ended.stdout.count("\n  mesh ") + ended.stdout.startswith("  mesh ")
                status = report_of(directory)["Status"]
                self.assertEqual(status["Status"], "Interrupted")
                self.assertIn("0.02 % was asked for: a signal came", status["Reason"])
                meshes = (directory / "meshes.csv").read_text().splitlines()
                self.assertEqual(len(meshes), 1 + told)
                unknowns = int(report_of(directory)["Problem"]["Primal Dimension"])
                self.assertIn(f",{unknowns},", meshes[-1])
                self.assertTrue(numpy.isfinite(fields_of(directory / "punch.h5")).all())
                self.assertEqual([file.name for file in directory.iterdir() if file.suffix == ".partial"], [])

    def test_a_second_signal_ends_at_once(self):
        process = self.start(PROGRAM, scene("coercive"), *elements(1536, "left", "right"), "--set",
                             "Solver/Direct Solvers/Share Identical Subdomains=no")
        self.assertTrue(process.stdout.readline().startswith("Epafi"))  # seconds before the setup is done
        process.send_signal(signal.SIGTERM)
        time.sleep(0.3)
        process.send_signal(signal.SIGTERM)
        start = time.monotonic()
        process.wait(ANSWER)
        self.assertEqual(process.returncode, -signal.SIGTERM)
        self.assertLess(time.monotonic() - start, 1)

    def test_without_output_the_results_are_printed(self):
        process = self.start(PROGRAM, scene("coercive"), *SLOW, *elements(384, "left", "right"), "--set",
                             "Solver/Tolerance=1e-15")
        self.assertTrue(process.stdout.readline().startswith("Epafi"))
        time.sleep(1.5)
        process.send_signal(signal.SIGHUP)
        ended = self.finish(process)
        self.assertEqual(ended.returncode, FAILED)
        if said(ended.stderr):  # a slow machine: it came before the iteration
            self.expect(ended, FAILED, "SIGHUP")
        else:
            self.assertIn("energy", ended.stdout)
            self.assertIn("SIGHUP, without a checkpoint", ended.stdout)


class Restarts(Faults):
    def checkpoint(self, *changes, name="coercive"):
        directory = self.place / "first"
        self.assertEqual(run(PROGRAM, scene(name), *changes, "--quiet", "--output", directory).returncode, SOLVED)
        return directory / "checkpoint.epafi"

    def products(self, *arguments, name="coercive", ranks=1):
        report = self.place / "again"
        ended = run(PROGRAM, scene(name), "--quiet", "--output", report, *arguments, ranks=ranks)
        self.assertEqual(ended.returncode, SOLVED, ended.stderr)
        return int(report_of(report)["Iterations"]["Hessian Multiplications"])

    def test_from_the_solution_there_is_nothing_left_to_do(self):
        for name in ("coercive", "semicoercive", "no_contact", "single_subdomain", "stacked_blocks"):
            with self.subTest(name):
                file = self.checkpoint(name=name)
                for ranks in (1, 3):
                    self.assertLessEqual(self.products("--restart", file, name=name, ranks=ranks), 3)

    def test_a_changed_load_starts_from_the_old_answer(self):
        file = self.checkpoint()
        change = ["--set", "Bodies/left/Loads/upper strip/Value=-1.001"]
        self.assertLess(self.products("--restart", file, *change), 0.5 * self.products(*change))

    def test_what_does_not_fit_is_refused(self):
        file = self.checkpoint()
        damaged = self.place / "damaged.epafi"
        damaged.write_bytes(file.read_bytes()[:-100])
        other = self.place / "other.epafi"
        other.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(1000))
        for ranks in (1, 3):
            for words, arguments in (
                    (["checkpoint.epafi", "subdomains instead of"], [file, "--set", "Decomposition/Grid={2,2}"]),
                    (["primal unknowns"], [file, *elements(16, "left", "right")]),
                    (["stiffness"], [file, "--set", "Bodies/left/Conductivity=2"]),
                    (["damaged.epafi", "cut off"], [damaged]),
                    (["other.epafi", "no checkpoint"], [other]),
                    (["none.epafi", "does not exist"], [self.place / "none.epafi"]),
                    ([str(self.place), "no regular file"], [self.place])):
                with self.subTest(words):
                    self.expect(run(PROGRAM, scene("coercive"), "--restart", *arguments, ranks=ranks), WRONG_INPUT, *words)

    def test_the_interval_is_a_number_of_seconds(self):
        for text in ("soon", "-1", "nan", "1e999"):
            self.expect(run(PROGRAM, scene("coercive"), "--checkpoint-interval", text), WRONG_INPUT, text, "seconds")
        self.expect(run(PROGRAM, scene("coercive"), "--restart"), WRONG_INPUT, "--restart")

    def test_the_checkpoint_is_not_overwritten_by_the_report(self):
        file = self.checkpoint()
        before = file.read_bytes()
        self.expect(run(PROGRAM, scene("coercive"), "--restart", file, "--report", file), WRONG_INPUT, "overwrite")
        self.assertEqual(file.read_bytes(), before)


class Disks(Faults):
    def assert_results_are_printed(self, ended, *files):
        """The solution is on the screen, and every file that is missing is named."""
        self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
        for word in ("energy -1.19", "status      Converged"):
            self.assertIn(word, ended.stdout)
        for file in files:
            self.assertEqual(sum(str(file) in sentence for sentence in said(ended.stderr)), 1, ended.stderr)
        self.assertEqual(len(said(ended.stderr)), len(files), ended.stderr)

    def started(self, directory):
        """A run that is in its assembly, for a while yet."""
        process = self.start(PROGRAM, scene("coercive"), *elements(384, "left", "right"), "--set", "Decomposition/Method=metis",
                             "--set", "Decomposition/Parts=16", "--output", directory)
        self.assertTrue(process.stdout.readline().startswith("Epafi"))
        return process

    def limited(self, directory, most):
        """A run whose files may not grow beyond a size: as on a full disk, wherever that shows. (MPI needs large ones to start.)"""
        process = self.started(directory)
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))
        return self.finish(process)

    def test_no_file_may_grow(self):
        directory = self.place / "out"
        self.assert_results_are_printed(self.limited(directory, 0), directory / "checkpoint.epafi", directory / "history.csv",
                                        directory / "coercive.h5", directory / "report.xml")
        self.assertEqual(list(directory.iterdir()), [])

    def test_the_small_files_are_written_where_the_large_ones_have_no_room(self):
        directory = self.place / "out"
        self.assert_results_are_printed(self.limited(directory, 100000), directory / "coercive.h5")
        self.assertEqual({file.name for file in directory.iterdir()}, {"checkpoint.epafi", "history.csv", "report.xml"})
        self.assertEqual(report_of(directory)["Status"]["Converged"], "true")

    def test_a_full_file_system(self):
        disk = self.place / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", disk], capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("no file system can be mounted here: " + mounted.stderr.decode().strip())
        self.addCleanup(lambda: subprocess.run(["umount", disk], check=True))
        for ranks in (1, 2):
            ended = run(PROGRAM, scene("coercive"), "--output", disk, ranks=ranks)
            self.assert_results_are_printed(ended, disk / "coercive.h5")
            self.assert_no_half_files(disk, "coercive")

    def test_a_directory_that_goes_during_the_run(self):
        """A file has taken its place when it comes to writing."""
        directory = self.place / "out"
        process = self.started(directory)
        directory.rmdir()
        directory.write_text("in the way", encoding="utf-8")
        ended = self.finish(process)
        self.assert_results_are_printed(ended, "coercive.h5", "history.csv", "report.xml", "checkpoint.epafi")

    def test_a_full_standard_output(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            ended = subprocess.run([PROGRAM, scene("coercive")], stdout=full, stderr=subprocess.PIPE, text=True, timeout=LIMIT,
                                   check=False)
            self.assertEqual(ended.returncode, FAILED)
            self.assertEqual(len(said(ended.stderr)), 1, ended.stderr)
            self.assertIn("standard output", ended.stderr)

    def test_a_reader_that_goes_does_not_end_the_run(self):
        directory = self.place / "out"
        process = self.start(PROGRAM, scene("coercive"), "--output", directory)
        process.stdout.close()
        self.assertEqual(process.wait(LIMIT), SOLVED, process.stderr.read())
        self.assertTrue((directory / "coercive.h5").exists())


class Kills(Faults):
    def test_a_killed_run_leaves_no_half_file_under_its_name(self):
        arguments = [scene("coercive"), "--quiet", "--checkpoint-interval", "0.001", *elements(96, "left", "right")]
        whole = self.place / "whole"
        self.assertEqual(run(PROGRAM, *arguments, "--output", whole).returncode, SOLVED)
        names = {file.name for file in whole.iterdir()}
        killed = 0
        for delay in (0.0, 0.002, 0.005, 0.01, 0.02, 0.04):
            directory = self.place / f"out{delay}"
            process = self.start(PROGRAM, *arguments, "--output", directory)
            wait_for(lambda: process.poll() is not None or directory.exists() and any(directory.iterdir()), "the first file")
            time.sleep(delay)
            killed += process.poll() is None
            process.kill()
            process.communicate()
            found = {file.name for file in directory.iterdir() if not file.name.endswith(".partial")}
            self.assertLessEqual(found, names)
            for name in found:
                if name.endswith(".h5"):
                    self.assertTrue(numpy.array_equal(fields_of(directory / name), fields_of(whole / name)))
                elif name == "checkpoint.epafi":
                    again = run(PROGRAM, *arguments, "--restart", directory / name)
                    self.assertEqual(again.returncode, SOLVED, again.stderr)
                elif name.endswith(".xml") or name.endswith(".xdmf"):
                    xml.etree.ElementTree.parse(directory / name)
        self.assertGreater(killed, 2, "the runs were over before they could be killed")

    def test_a_killed_rank_ends_the_others(self):
        process = self.start(PROGRAM, scene("coercive"), *SLOW, *elements(128, "left", "right"), "--output", self.place / "out",
                             "--checkpoint-interval", "0.01", ranks=2)
        wait_for(lambda: (self.place / "out" / "checkpoint.epafi").exists(), "the first checkpoint")
        os.kill(ranks_of(process.pid)[1], signal.SIGKILL)
        self.assertNotEqual(self.finish(process).returncode, SOLVED)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
