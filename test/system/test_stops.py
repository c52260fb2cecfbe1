#!/usr/bin/python3
"""test_stops.py EPAFI SOURCE_DIR WITH_FAULTS FAULTY_RANKS MPIRUN ARGUMENTS...: runs that are stopped, killed and go on. Moments are found
by what a run prints, by its files and by what the system says of it, never by time: a machine may be busy."""

import os
import random
import signal
import sys
import unittest
import xml.etree.ElementTree

import h5py
import numpy

from running import (FAILED, PROGRAM, SLOW, SOLVED, WITH_FAULTS, WRONG_INPUT, Run, elements, fields_of, has, ranks_of,
                     report_of, run, said, scene, wait_for)


class Signals(Run):
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

    def assembling(self, *arguments, size=512):
        """A run that is before or in its assembly, METIS's part of which takes a while."""
        process = self.start(PROGRAM, scene("coercive"), *elements(size, "left", "right"), "--set", "Decomposition/Method=metis",
                             "--set", "Decomposition/Parts=16", *arguments)
        self.reach(process, "Epafi")
        return process

    def test_before_the_iteration_there_is_nothing_to_keep(self):
        for is_cutting in (False, True):
            process = self.assembling("--output", self.place / "out")
            if is_cutting:  # METIS traps SIGTERM for itself, so that it is held meanwhile
                wait_for(lambda: has(process, "SigBlk", signal.SIGTERM), "METIS")
            process.send_signal(signal.SIGTERM)
            self.expect(self.finish(process), FAILED, "SIGTERM", "before the iteration", "start again")
            self.assertEqual(list((self.place / "out").iterdir()), [])

    def test_a_second_signal_ends_at_once(self):
        process = self.assembling(size=1200)
        process.send_signal(signal.SIGINT)

        def has_ended():  # what comes 0.2 s later or sooner is the same wish
            process.send_signal(signal.SIGINT)
            return process.poll() is not None
        wait_for(has_ended, "the end")
        self.assertEqual(process.returncode, -signal.SIGINT)

    def test_in_a_later_mesh_the_last_complete_one_is_kept(self):
        for ranks, number in ((1, signal.SIGTERM), (2, signal.SIGUSR1)):  # mpirun passes this on, and waits
            with self.subTest(ranks=ranks):
                directory = self.place / f"out{ranks}"
                process = self.start(PROGRAM, scene("punch"), "--accuracy", "0.02%", "--output", directory, ranks=ranks)
                self.reach(process, "  mesh ", 3)  # of six or more
                process.send_signal(number)
                ended = self.finish(process)
                self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
                self.assertEqual(said(ended.stderr), [])
                report = self.assert_one_mesh(directory, "punch")
                self.assertEqual(report["Status"]["Status"], "Interrupted")
                self.assertIn("0.02 % was asked for: a signal came", report["Status"]["Reason"])
                self.assertEqual(report["Levels"], ended.stdout.count("\n  mesh "))
                self.assertEqual([file.name for file in directory.iterdir() if file.suffix == ".partial"], [])

    def test_a_launcher_without_patience_leaves_the_last_complete_mesh(self):
        """Told SIGTERM, mpirun kills the ranks a second later, whatever they are at."""
        directory = self.place / "out"
        process = self.start(PROGRAM, scene("punch"), "--accuracy", "0.02%", "--output", directory, ranks=2)
        self.reach(process, "  mesh ", 3)
        process.send_signal(signal.SIGTERM)
        self.assertNotEqual(self.finish(process).returncode, SOLVED)
        report = self.assert_one_mesh(directory, "punch")
        self.assertIn(report["Status"]["Status"], ("Interrupted", "Running"))
        self.assertGreaterEqual(report["Levels"], 3)

    def test_without_output_the_results_are_printed(self):
        process = self.start(PROGRAM, scene("punch"), "--accuracy", "0.02%")
        self.reach(process, "  mesh ", 3)
        process.send_signal(signal.SIGHUP)
        ended = self.finish(process)
        self.assertEqual((ended.returncode, said(ended.stderr)), (FAILED, []))
        self.assertIn("energy", ended.stdout)
        self.assertIn("SIGHUP, without a checkpoint", ended.stdout)


class Restarts(Run):
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


class Kills(Run):
    def kill_at(self, process, directory, beginning, victim):
        """Waits for a file whose name begins so, or the end, and kills. Returns whether it came in time."""
        wait_for(lambda: process.poll() is not None or directory.exists() and any(
            name.startswith(beginning) for name in os.listdir(directory)), beginning)
        try:
            os.kill(victim(process), signal.SIGKILL)
        except (ProcessLookupError, IndexError):
            pass
        return self.finish(process).returncode not in (SOLVED, FAILED)

    def test_a_killed_run_leaves_no_half_file_under_its_name(self):
        arguments = [scene("coercive"), "--quiet", "--checkpoint-interval", "0.001", *elements(96, "left", "right")]
        killed = 0
        for beginning in ("", ".checkpoint", "checkpoint", ".history", ".coercive.h5", ".coercive.xdmf", ".report", "report"):
            directory = self.place / f"out{beginning}"
            process = self.start(PROGRAM, *arguments, "--output", directory)
            killed += self.kill_at(process, directory, beginning, lambda process: process.pid)
            self.assert_complete(directory, "coercive")
        self.assertGreater(killed, 3, "the runs were over before they could be killed")

    def test_a_run_to_a_target_that_is_killed_leaves_its_last_complete_mesh(self):
        choose = random.Random(4).choice
        for ranks in (1, 2):
            killed = 0
            for attempt in range(5):
                directory, told = self.place / f"out{ranks}_{attempt}", choose(range(5))
                moment = choose(("", ".checkpoint", ".history", ".punch.h5", ".punch.xdmf", ".report"))
                with self.subTest(ranks=ranks, told=told, moment=moment):
                    process = self.start(PROGRAM, scene("punch"), "--accuracy", "0.02%", "--output", directory, ranks=ranks)
                    self.reach(process, "  mesh ", told)
                    which = choose(range(ranks))
                    killed += self.kill_at(process, directory, moment,
                                           lambda process: process.pid if ranks == 1 else ranks_of(process.pid)[which])
                    report = self.assert_one_mesh(directory, "punch")
                    self.assertGreaterEqual(report["Levels"] if report else 0, told)
                    self.assertIn(report["Status"]["Status"] if report else "Running", ("Running", "Converged"))
            self.assertGreater(killed, 2, "the runs were over before they could be killed")

    def test_killed_before_any_file_gets_its_name_the_files_are_of_one_mesh(self):
        """At each of the moments between two files, which no chance would find."""
        def end(number, directory):
            environment = {**os.environ, "EPAFI_TEST_KILL": f"0:{number}"}
            return run(WITH_FAULTS, scene("coercive"), "--accuracy", "10%", "--output", directory, env=environment)
        counted = end(0, self.place / "whole")
        self.assertEqual(counted.returncode, SOLVED, counted.stderr)
        total = int(counted.stderr.split("renames: ")[1].split()[0])
        levels, between = [], 0
        for number in range(1, total + 1):
            directory = self.place / f"out{number}"
            self.assertEqual(end(number, directory).returncode, -signal.SIGKILL)
            report = self.assert_one_mesh(directory, "coercive")
            if report is None:
                continue
            self.assertEqual((report["Status"]["Status"], report["Status"]["Converged"]), ("Running", "false"))
            levels.append(report["Levels"])
            between += "are being put in place" in report["Status"]["Reason"]
        meshes = report_of(self.place / "whole")["Levels"]
        self.assertEqual(levels, sorted(levels))
        self.assertEqual(set(levels), set(range(1, meshes + 1)))
        self.assertEqual(between, 5 * meshes, "five files after the report that announces them")

    def steps_in(self, directory):
        """u of each load step in the files, in their order; the XDMF file, if there is one, tells of these."""
        file = directory / "clamped_strap.h5"
        if not file.exists():
            self.assertFalse(file.with_suffix(".xdmf").exists())
            return []
        with h5py.File(file) as fields:
            steps = sorted(fields["steps"].values(), key=lambda step: step.attrs["number"])
            if file.with_suffix(".xdmf").exists():
                series = xml.etree.ElementTree.parse(file.with_suffix(".xdmf"))
                self.assertEqual(len(series.findall("./Domain/Grid/Grid/Time")), len(steps))
                for item in series.iter("DataItem"):
                    self.assertIn(item.text.split(":")[1], fields)
            return [step["bodies/strap/u"][:] for step in steps]

    def test_killed_before_any_file_gets_its_name_the_fields_of_finished_steps_are_there(self):
        def end(number, directory):
            environment = {**os.environ, "EPAFI_TEST_KILL": f"0:{number}"}
            return run(WITH_FAULTS, scene("clamped_strap"), "--output", directory, env=environment)
        self.assertEqual(end(0, self.place / "whole").returncode, SOLVED)
        expected, told = self.steps_in(self.place / "whole"), []
        for number in range(1, 23):  # seven files a step, up to the first one of the fourth
            directory = self.place / f"out{number}"
            ended = end(number, directory)
            self.assertEqual(ended.returncode, -signal.SIGKILL)
            found = self.steps_in(directory)
            told.append(ended.stdout.count("\n  step        "))
            self.assertIn(len(found) - told[-1], (0, 1))
            for u, same in zip(found, expected):
                numpy.testing.assert_array_equal(u, same)
        self.assertEqual((told[-1], len(expected)), (3, 13))

    def test_a_killed_rank_ends_the_others(self):
        process = self.start(PROGRAM, scene("coercive"), *SLOW, *elements(128, "left", "right"), "--output", self.place / "out",
                             "--checkpoint-interval", "0.01", ranks=2)
        wait_for(lambda: (self.place / "out" / "checkpoint.epafi").exists(), "the first checkpoint")
        os.kill(ranks_of(process.pid)[1], signal.SIGKILL)
        self.assertNotEqual(self.finish(process).returncode, SOLVED)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
