#!/usr/bin/python3
"""test_faults.py EPAFI SOURCE_DIR WITH_FAULTS FAULTY_RANKS MPIRUN ARGUMENTS...: what goes wrong around the program: errors on
one rank alone, disks that are full. Nothing may hang, and nothing that was found may be lost without a word."""

import concurrent.futures
import os
import re
import resource
import shutil
import subprocess
import sys
import unittest

import h5py

from running import (FAILED, FAULTY_RANKS, LAUNCH, LIMIT, NOT_SOLVABLE, PROGRAM, SOLVED, WITH_FAULTS, WRONG_INPUT, Run, elements,
                     report_of, run, said, scene)

AT_ONCE = 4


class OneRankFails(Run):
    def together(self, cases, ranks):
        """Runs with faults, several at a time, as most of them wait most of the time: of each {case: (command, environment)} how it
        ended. The first one has no fault."""
        def one(case):
            command, environment = cases[case]
            return run(*command, ranks=ranks, env={**os.environ, **environment})
        first, *others = cases
        ended = one(first)
        self.assertEqual(ended.returncode, SOLVED, ended.stderr)
        yield first, ended
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            yield from zip(others, pool.map(one, others))

    def test_whoever_throws_what(self):
        expected = {"operator": (FAILED, "rank 1", "product number 15 went wrong"),
                    "input": (WRONG_INPUT, "rank 1", "nonsense"),
                    "unsolvable": (NOT_SOLVABLE, "rank 1", "slides"),
                    "several": (FAILED, "rank 1 has no memory left", "more machines"),
                    "all": (WRONG_INPUT, "all say so"),
                    "agreed": (FAILED, "rank 1 has no memory left"),
                    "nothing": (FAILED, "unknown error")}
        cases = {kind: ([FAULTY_RANKS, kind], {}) for kind in ("none", *expected)}
        for kind, ended in self.together(cases, ranks=3):
            if kind != "none":
                with self.subTest(kind):
                    self.expect(ended, *expected[kind])

    def test_no_memory_on_one_rank_wherever_that_is(self):
        command = [WITH_FAULTS, scene("semicoercive"), "--set", "Solver/Tolerance=1e-9", "--output"]
        counted = run(*command, self.place / "whole", ranks=2, env={**os.environ, "EPAFI_TEST_FAIL": "1:0"})
        self.assertEqual(counted.returncode, SOLVED, counted.stderr)
        total = int(next(line for line in counted.stderr.splitlines() if line.startswith("allocations: ")).split()[1])
        writing = [0.95 + 0.005 * step for step in range(10)]
        cases = {share: ([*command, self.place / f"{share}"], {"EPAFI_TEST_FAIL": f"1:{int(share * total)}"})
                 for share in (2.0, 0.2, 0.5, 0.8, 0.9, *writing)}
        for share, ended in self.together(cases, ranks=2):
            if share > 1:
                continue
            with self.subTest(share):
                if "SharedAllocationRecordCommonINS_9HostSpaceEED1Ev" in ended.stderr:  # Kokkos 4.5 allocates in a destructor
                    self.assertIn("std::bad_alloc", ended.stderr)
                    continue
                self.expect(ended, FAILED, "rank 1 has no memory left")
                directory = self.place / f"{share}"
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
        sentences = said(ended.stderr) or [line for line in ended.stderr.splitlines() if line.startswith("OpenBLAS error: Memory")]
        self.assertEqual(len(sentences), 1, ended.stderr)  # OpenBLAS may end a program by itself
        self.assertIn("memory", sentences[0].lower())

    def test_processes_that_nobody_launched_share_no_directory(self):
        """One that ends would take it away from one that starts. From release 5 on Open MPI gives each its own."""
        release = subprocess.run([LAUNCH[0], "--version"], capture_output=True, text=True, check=True).stdout
        if int(re.search(r"(\d+)\.\d+", release)[1]) >= 5:
            self.skipTest("this Open MPI gives each process a directory of its own")
        ended = run(PROGRAM, scene("coercive"), "--output", self.place / "out", env={**os.environ, "TMPDIR": "/proc/none"})
        self.assertEqual((ended.returncode, ended.stderr), (SOLVED, ""))


class Disks(Run):
    def assert_results_are_printed(self, ended, *files):
        """The solution is on the screen, and every file that is missing is named."""
        self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
        for word in ("energy -1.19", "status      Converged"):
            self.assertIn(word, ended.stdout)
        for file in files:
            self.assertEqual(sum(str(file) in sentence for sentence in said(ended.stderr)), 1, ended.stderr)
        self.assertEqual(len(said(ended.stderr)), len(files), ended.stderr)

    def disturbed(self, directory, disturb):
        """A run that something happens to in its assembly, which takes a while. What it prints goes through pipes, not to a disk."""
        with subprocess.Popen([PROGRAM, scene("coercive"), *elements(384, "left", "right"), "--set", "Decomposition/Method=metis",
                               "--set", "Decomposition/Parts=16", "--output", directory], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, bufsize=0) as process:
            self.assertTrue(process.stdout.readline().startswith(b"Epafi"))
            disturb(process)
            out, err = process.communicate(timeout=LIMIT)
        return subprocess.CompletedProcess(process.args, process.returncode, out.decode(), err.decode())

    def limited(self, directory, most):
        """A run whose files may not grow beyond a size: as on a full disk, wherever that shows. (MPI needs large ones to start.)"""
        return self.disturbed(directory, lambda process: resource.prlimit(process.pid, resource.RLIMIT_FSIZE,
                                                                          (most, resource.RLIM_INFINITY)))

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

    def disk(self, size):
        """A file system of so many bytes, if the test may mount one."""
        disk = self.place / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", disk], capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("no file system can be mounted here: " + mounted.stderr.decode().strip())
        self.addCleanup(lambda: subprocess.run(["umount", disk], check=True))
        return disk

    def test_a_full_file_system(self):
        disk = self.disk("64k")
        for ranks in (1, 2):
            ended = run(PROGRAM, scene("coercive"), "--output", disk, ranks=ranks)
            self.assert_results_are_printed(ended, disk / "coercive.h5")
            self.assert_complete(disk, "coercive")

    def test_a_mesh_whose_fields_have_no_room_leaves_those_of_a_mesh_before(self):
        disk = self.disk("400k")
        ended = run(PROGRAM, scene("coercive"), "--accuracy", "0.05%", "--output", disk)
        self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
        on_the_way, at_the_end = said(ended.stderr)
        self.assertIn("goes on without files of this mesh", on_the_way)
        self.assertIn("coercive.h5 is not written", at_the_end)
        self.assertLessEqual({"coercive.h5", "coercive.xdmf", "report.xml"}, self.assert_complete(disk, "coercive"))
        self.assertIn("not all files of this mesh could be written", report_of(disk)["Status"]["Reason"])

    def test_load_steps_whose_fields_have_no_room_are_named_and_the_others_kept(self):
        disk = self.disk("1200k")
        ended = run(PROGRAM, scene("clamped_strap"), "--output", disk)
        self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
        on_the_way, *lost, at_the_end = said(ended.stderr)
        self.assertIn("goes on without files of this step", on_the_way)
        self.assertIn("clamped_strap.h5 is not written", at_the_end)
        with h5py.File(disk / "clamped_strap.h5") as file:
            kept = [step.attrs["name"].decode() for step in file["steps"].values()]
        self.assertEqual(len(kept) + len(lost) + 1, 13)
        for sentence in lost:
            name = re.search('fields of step "(.*)" are not in the files', sentence)[1]
            self.assertNotIn(name, kept)
            self.assertIn(f'"{name}"', report_of(disk)["Status"]["Reason"])

    def test_a_directory_that_goes_during_the_run(self):
        """A file has taken its place when it comes to writing."""
        directory = self.place / "out"
        def replace(_):
            directory.rmdir()
            directory.write_text("in the way", encoding="utf-8")
        ended = self.disturbed(directory, replace)
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
