"""The Python package beside the program: python3 encounter_test.py, with ENCOUNTER_PROGRAM, ENCOUNTER_MODELS and PYTHONPATH
set (cmake/tests.cmake). Needs numpy."""
import contextlib
import csv
import gc
import importlib.util
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

import encounter

PROGRAM = encounter.program_file()
ALL = bool(os.environ.get("ENCOUNTER_ALL_SEEDS"))  # ./check --full
DATA = pathlib.Path(__file__).resolve().parents[1] / "data"


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


def hash_of(text):
    return text.rpartition("state hash")[2].split()[0]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def press(self, scene="tennis_ball", **how):
        return encounter.run(scene, record=self.folder / "r.encrec", force=True, **{"for_s": 4, **how})


class Runs(InFolder):
    def test_a_run_is_the_programs(self):
        run = encounter.run("tennis_ball", for_s=2, seed=3)
        said = program("run", "tennis_ball", "--for-s", 2, "--seed", 3)
        self.assertEqual(run.state_hash, hash_of(said))
        self.assertEqual((run.code, run.record, run.figures["simulated_s"]), (0, None, 2.001))

    def test_set_takes_values_of_python(self):
        values = {"object.ball.radius_mm": 30, "truth.tracker.bias_mm": [0, 0, 0.25], "truth.ball.set": "vented"}
        run = encounter.run("tennis_ball", values, for_s=0.5)
        words = []
        for value in ("object.ball.radius_mm=30", "truth.tracker.bias_mm=[0,0,0.25]", "truth.ball.set=vented"):
            words += ["--set", value]
        self.assertEqual(run.state_hash, hash_of(program("run", "tennis_ball", "--for-s", 0.5, *words)))
        self.assertNotEqual(run.state_hash, encounter.run("tennis_ball", for_s=0.5).state_hash)

    def test_values_of_numpy_are_written_as_those_of_python(self):
        values = [numpy.bool_(True), numpy.float64(0.1), numpy.array(90.0), numpy.array([0, 0.25]), numpy.int64(3)]
        texts = ["true", "0.1", "90.0", "[0.0,0.25]", "3"]
        self.assertEqual([encounter.program.value_text(value) for value in values], texts)

    def test_texts_are_utf_8_whatever_the_locale(self):
        scene = self.folder / "s.toml"
        shipped = DATA.parents[1] / "models/scenes/plane.toml"
        scene.write_text(shipped.read_text(encoding="utf-8").replace('name = "wall"', 'name = "w\u00e4ll"'), encoding="utf-8")
        code = f"import encounter; print('w\\u00e4ll' in str(encounter.run({str(scene)!r}, for_s=0.1).figures))"
        plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
        said = subprocess.run([sys.executable, "-c", code], env=os.environ | plain, capture_output=True, text=True)
        self.assertEqual((said.stdout, said.stderr), ("True\n", ""))

    def test_a_mistake_is_the_programs_line(self):
        with self.assertRaisesRegex(encounter.Error, r"--set object.ball.radius=30: .*radius_mm") as refusal:
            encounter.run("tennis_ball", {"object.ball.radius": 30})
        self.assertEqual(refusal.exception.code, 2)

    def test_a_run_that_ends_in_hold_has_its_figures(self):
        gone = {"truth.tracker.blackout_at_s": 1, "truth.tracker.blackout_for_s": 100}
        run = encounter.run("plane", gone, for_s=1.5)
        self.assertEqual((run.code, run.figures["holds"][0]["why"]), (4, "tool lost"))


class Records(InFolder):
    # Written again, each value is the text of the table.
    def expect_equal(self, record, table):
        rows = list(csv.reader(table.splitlines()))
        self.assertEqual(list(record), rows[0])
        for (name, column), cells in zip(record.items(), zip(*rows[1:])):
            if column.dtype.kind == "f":
                texts = ["" if x != x else repr(x).removesuffix(".0") for x in column.tolist()]
            else:
                texts = [str(x) for x in column.tolist()]
            self.assertEqual(texts, [cell.removesuffix(".0") for cell in cells], name)

    def test_columns_equal_the_table_of_each_scene(self):
        few = {"tennis_ball": 1, "wall": 1.5, "keypad": 0.5, "tracking": 1, "rig_identify": 1, "hit_ball": 0.5}
        all_scenes = {line.split()[0] for line in program("scenes").splitlines()}
        self.assertLess(set(few), all_scenes)
        for scene in sorted(all_scenes) if ALL else few:
            with self.subTest(scene):
                record = self.press(scene, for_s=few.get(scene, 0.2 if scene.startswith("camera/") else 1.5)).record
                self.expect_equal(encounter.read(record), program("export", record))
                self.expect_equal(encounter.read(record, truth=True), program("export", record, "--truth"))

    def test_only_a_line_end_ends_a_row(self):
        table = encounter.columns.columns('id,error\n1,"a\u2028b"\n2,"c\nd"\n')
        self.assertEqual(table["error"].tolist(), ["a\u2028b", "c\nd"])

    def test_units_stand_in_the_names(self):
        record = encounter.read(DATA / "press.encrec")
        self.assertEqual(record.units["force_N"], "N")
        self.assertEqual(record.units["gap_mm"], "mm")
        self.assertNotIn("mode", record.units)
        self.assertEqual(record["mode"].dtype.kind, "U")
        self.assertEqual(record["repeat"].dtype.kind, "i")

    # The report's peak is that of the truth, which the record alone does not hold.
    def test_truth_is_that_of_the_run(self):
        run = self.press("plane", for_s=4)
        record = encounter.read(run.record, truth=True)
        force = record["true_force_z_N"]
        self.assertAlmostEqual(numpy.abs(force).max(), run.figures["presses"][0]["peak_force_N"], delta=0.05)
        touching = record["true_touching"] == 1
        self.assertTrue(touching.any() and not touching.all())
        self.assertEqual(numpy.abs(force[~touching]).max(), 0.0)

    def test_truth_of_another_run_is_refused(self):
        with self.assertRaisesRegex(encounter.Error, "press.encrec: .*leave out --truth"):
            encounter.read(DATA / "press.encrec", truth=True)

    def test_a_ledger_has_a_row_for_each_contact(self):
        run = self.press("wall", for_s=4)
        ledger = encounter.read(run.record).ledger()
        self.assertEqual(len(ledger["contact"]), len(run.figures["ledger"]))
        self.assertEqual(ledger["contact"].dtype.kind, "i")

    def test_a_cut_record_needs_partial(self):
        whole = pathlib.Path(self.press(for_s=1).record)
        cut = self.folder / "cut.encrec"
        cut.write_bytes(whole.read_bytes()[:-5000])
        with self.assertRaisesRegex(encounter.Error, "--partial"):
            encounter.read(cut)
        ticks = len(encounter.read(cut, partial=True)["time_s"])
        self.assertTrue(0 < ticks < len(encounter.read(whole)["time_s"]))


class Served(InFolder):
    def test_without_a_place_it_is_the_run(self):
        run = self.press("tennis_ball", for_s=2)
        table = encounter.read(run.record, truth=True)
        with encounter.serve("tennis_ball", for_s=2, every_ms=100) as served:
            rows = [served.row]
            while served.step():
                rows.append(served.row)
        self.assertEqual((served.run.state_hash, served.run.code), (run.state_hash, run.code))
        self.assertEqual(len(rows), 21)
        for name in table:
            self.assertEqual(str([row[name] for row in rows]), str(list(table[name][::100].tolist())), name)

    def test_a_place_moves_the_tool_and_the_record_repeats_it(self):
        record = self.folder / "served.encrec"
        for scene, place in (("tennis_ball", [20, -10, 50]), ("wall", [0, -120, 40])):
            with encounter.serve(scene, every_ms=50, record=record, force=True) as served:
                for _ in range(60):
                    served.step(place)
                tip = [served.row[f"true_tool_{axis}_mm"] for axis in "xyz"]
            self.assertLess(max(abs(numpy.subtract(tip, place))), 3.0, scene)
            said = program("run", scene, "--hand", record)
            self.assertEqual(hash_of(said), served.run.state_hash)

    def test_a_mistake_ends_it_in_a_line(self):
        with self.assertRaisesRegex(encounter.Error, "clamped_tool.*no simulated hand"):
            encounter.serve("clamped_tool")
        with self.assertRaisesRegex(encounter.Error, "standard input:2: '1.0 2.0'; expected x, y and z"):
            with encounter.serve("tennis_ball") as served:
                served.step([1, 2, 3])
                served.step([1, 2])
        for line in ("nan 0 0", "0 0 1e5", "1 2 3 4", "0 0 0x1", "a", "1,2,3", "inf 0 0", "0 1e400 0", "0 0\0 1"):
            done = subprocess.run([PROGRAM, "serve", "tennis_ball"], input=line + "\n", capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
            self.assertIn("standard input:1: '" + line.replace("\0", "\\x00"), done.stderr)
        for spaces in (2000, 100000):  # in one piece, and in many
            done = subprocess.run([PROGRAM, "serve", "tennis_ball"], input=" " * spaces + "\n", capture_output=True, text=True)
            self.assertIn("standard input:1: longer than 1000 characters", done.stderr)
        folder = os.open(self.folder, os.O_RDONLY)
        done = subprocess.run([PROGRAM, "serve", "tennis_ball"], stdin=folder, capture_output=True, text=True)
        os.close(folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard input: cannot be read: Is a directory", done.stderr)

    def test_each_end_of_the_client_ends_it(self):
        served = encounter.serve("tennis_ball")
        self.assertEqual(served.close().figures["stopped"], True)
        self.assertIsNone(served.step())
        with self.assertRaises(ZeroDivisionError), encounter.serve("tennis_ball"):
            1 / 0
        silent = subprocess.Popen([PROGRAM, "serve", "tennis_ball"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        silent.stdout.readline()
        silent.terminate()
        self.assertEqual(silent.wait(10), 128 + 15)
        silent.stdin.close()
        silent.stdout.close()

    # The program is still there at the first step of each: only the pipe says that it is dead.
    def test_a_program_that_was_killed_is_an_error(self):
        for go_on in (encounter.Served.step, encounter.Served.close):
            served = encounter.serve("tennis_ball")
            served._program.kill()
            served._program.wait()
            with self.assertRaisesRegex(encounter.Error, "exit code -9") as death:
                go_on(served)
            self.assertEqual(death.exception.code, -9)
            self.assertEqual((served.step([0, 0, 40]), served.close(), served.row), (None, None, None))

    def expect_hand(self, record, most):
        said = program("run", "tennis_ball", "--hand", record)
        self.assertTrue(1 < int(said.rpartition("after")[2].split()[0]) < most, said)

    def test_whatever_ends_a_run_its_record_is_sealed(self):
        record = self.folder / "r.encrec"
        begin = lambda: encounter.serve("tennis_ball", record=record, force=True)
        with self.assertRaises(ZeroDivisionError), begin() as served:
            served.step([0, 0, 60])
            1 / 0
        self.expect_hand(record, 9)
        self.assertIsNone(served.step())
        served = begin()
        served.step([0, 0, 60])
        ended = served._program
        del served
        gc.collect()
        self.assertEqual(ended.returncode, 128 + 15)
        self.expect_hand(record, 9)
        with self.assertRaises(encounter.Error), begin() as served:
            served.step([0, 0, 60])
            served.step([0, 0])
        self.expect_hand(record, 9)
        dead = subprocess.Popen([PROGRAM, "serve", "tennis_ball", "--record", record, "--force"], text=True,
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for _ in range(4):
            dead.stdout.readline()
            dead.stdin.write("0 0 60\n")
            dead.stdin.flush()
        dead.stdout.close()
        with contextlib.suppress(BrokenPipeError):
            dead.stdin.write("0 0 60\n" * 9)
            dead.stdin.flush()
        self.assertIn("standard output: cannot be written: Broken pipe", dead.stderr.read())
        self.assertEqual(dead.wait(), 2)
        with contextlib.suppress(BrokenPipeError):
            dead.stdin.close()
        dead.stderr.close()
        self.expect_hand(record, 20)

    def test_a_step_that_is_broken_off_ends_the_run(self):
        def ring(*_):
            raise TimeoutError

        self.addCleanup(signal.signal, signal.SIGALRM, signal.signal(signal.SIGALRM, ring))
        served = encounter.serve("tennis_ball", every_ms=10000)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with self.assertRaises(TimeoutError):
            while served.step():
                pass
        self.assertEqual((served.step(), served.row, served.close()), (None, None, None))

    def test_a_forked_child_does_not_hold_the_run(self):
        served = encounter.serve("tennis_ball")
        child = os.fork()
        if child == 0:
            code = 0 if served.step() is None and served.close() is None else 1
            time.sleep(20)  # s; is killed
            os._exit(code)
        begin = time.monotonic()
        self.assertIsNotNone(served.step())
        self.assertTrue(served.close().figures["stopped"])
        self.assertLess(time.monotonic() - begin, 10)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)

    def test_threads_may_step_together(self):
        served = encounter.serve("tennis_ball")
        threads = [threading.Thread(target=lambda: [served.step() for _ in range(300)], daemon=True) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(20)
        self.assertEqual(served.row["time_s"], 0.9)
        served.close()

    def test_the_example_presses_as_hard_as_asked(self):
        place = pathlib.Path(__file__).resolve().parents[2] / "examples/policy.py"
        spec = importlib.util.spec_from_file_location("policy", place)
        policy = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(policy)
        for wanted in (2.0, 4.0):
            self.assertAlmostEqual(policy.press(policy.PressEnv(wanted_N=wanted)), wanted, delta=0.5)


class Sweeps(InFolder):
    def test_progress_is_seen_and_ctrl_c_stops_it(self):
        class Reader(io.StringIO):
            def write(self, text):
                super().write(text)
                if " of 100000 runs" in text:
                    raise KeyboardInterrupt

        spec = self.folder / "s.toml"
        spec.write_text("format = 1\nscene = 'tennis_ball'\nfor_s = 1\ndesign = 'random'\npoints = 100000\n"
                        "keep = 'contacts'\n[[vary]]\nname = 'object.ball.radius_mm'\nfrom = 30\nto = 33\n")
        with self.assertRaises(KeyboardInterrupt), contextlib.redirect_stderr(Reader()) as said:
            encounter.sweep(spec, self.folder / "out")
        self.assertRegex(said.getvalue(), r"^encounter: \d+ of 100000 runs")
        status = subprocess.run([PROGRAM, "sweep", spec, "--out", self.folder / "out", "--status"], capture_output=True, text=True)
        self.assertIn("; stopped\n", status.stdout)

    def test_a_mistake_is_the_programs_line(self):
        spec = self.folder / "s.toml"
        spec.write_text("format = 1\n")
        with contextlib.redirect_stderr(io.StringIO()) as said, self.assertRaisesRegex(encounter.Error, "s.toml:1:1: "):
            encounter.sweep(spec, self.folder / "out")
        self.assertEqual(said.getvalue(), "")


class Notebook(InFolder):
    def test_its_cells_run(self):
        book = json.loads((pathlib.Path(__file__).resolve().parents[2] / "python/press.ipynb").read_text())
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)
        names = {}
        for cell in book["cells"]:
            needs = cell["metadata"].get("tags", [])
            if cell["cell_type"] == "code" and all(importlib.util.find_spec(name) for name in needs):
                with contextlib.redirect_stdout(io.StringIO()):
                    exec("".join(cell["source"]), names)
        self.assertEqual(len({run.state_hash for run in names["runs"].values()}), 2)
        self.assertLess(numpy.sqrt(numpy.nanmean(names["error"] ** 2)), 0.2)


if __name__ == "__main__":
    unittest.main()
