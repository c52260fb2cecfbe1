#!/usr/bin/python3
"""test_faults.py EPAFI SOURCE_DIR WITH_FAULTS FAULTY_RANKS MPIRUN ARGUMENTS...: what goes wrong around the program: errors on
one rank alone, disks that are full. Nothing may hang, and nothing that was found may be lost without a word."""

import concurrent.futures
import os
import resource
import shutil
import subprocess
import sys
import time
import unittest

from running import (ANSWER, FAILED, FAULTY_RANKS, LAUNCH, LIMIT, NOT_SOLVABLE, PROGRAM, SOLVED, WITH_FAULTS, WRONG_INPUT, Run, elements,
                     report_of, run, said, scene)


class OneRankFails(Run):
    def timed(self, *command, undisturbed, **options):
        """A run with a fault: at most so much longer than one without."""
        start = time.monotonic()
        ended = run(*command, **options)
        self.assertLess(time.monotonic() - start, undisturbed + ANSWER, ended.stderr)
        return ended

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
        counted = run(WITH_FAULTS, *arguments, ranks=2, env=environment)
        undisturbed = time.monotonic() - start
        self.assertEqual(counted.returncode, SOLVED, counted.stderr)
        total = int(next(line for line in counted.stderr.splitlines() if line.startswith("allocations: ")).split()[1])
        writing = [0.95 + 0.005 * step for step in range(10)]
        for share in (0.2, 0.5, 0.8, 0.9, *writing):
            with self.subTest(share):
                directory = self.place / f"out{share:.3f}"
                arguments[2] = directory
                environment["EPAFI_TEST_FAIL"] = f"1:{int(share * total)}"
                ended = self.timed(WITH_FAULTS, *arguments, undisturbed=undisturbed, ranks=2, env=environment)
                self.expect(ended, FAILED, "rank 1 has no memory left")
                if directory.exists():
                    self.assert_complete(directory, "semicoercive")

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


class Disks(Run):
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
        self.reach(process, "Epafi")
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
            self.assert_complete(disk, "coercive")

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
        with subprocess.Popen([PROGRAM, scene("coercive"), "--output", directory], stdout=subprocess.PIPE) as process:
            process.stdout.close()
            self.assertEqual(process.wait(LIMIT), SOLVED)
        self.assertTrue((directory / "coercive.h5").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
