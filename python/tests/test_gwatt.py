"""What the wheel gives, in a fresh virtual environment; see `test.sh`."""

import _thread
import csv
import importlib.util
import math
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from array import array
from pathlib import Path

import gwatt

PYTHON = Path(__file__).resolve().parents[1]
EXAMPLES = PYTHON.parent / "examples"
PROGRAM = "G21 G90\nG0 X400 Y300 Z-200\nG1 X0 F1000\nM30\n"


def has(*names):
    """Skips a test where packages are missing."""
    missing = [name for name in names if importlib.util.find_spec(name) is None]
    return unittest.skipIf(missing, f"without {', '.join(missing)}")


class Machines(unittest.TestCase):
    def test_built_in(self):
        self.assertEqual(gwatt.machines()[0], "three-axis")
        machine = gwatt.Machine("three-axis")
        self.assertEqual((machine.axes, machine.controller), ("XYZ", "iso"))
        self.assertEqual(list(machine.peak_power_w.values()), [4000.0])
        self.assertEqual(machine.margin, 0.1)
        self.assertEqual(repr(machine), f"<gwatt.Machine {machine.name}>")

    def test_a_file(self):
        path = EXAMPLES / "circle-mill.toml"
        machine = gwatt.Machine(path)
        self.assertEqual(machine.name, gwatt.Machine(str(path)).name)
        text = gwatt.Machine.from_toml(path.read_text(), str(path))
        self.assertEqual(machine.name, text.name)
        self.assertTrue(all(isinstance(it, gwatt.Diagnostic) for it in machine.warnings))

    def test_a_wrong_file(self):
        with self.assertRaisesRegex(gwatt.MachineError, "the machine file is wrong") as raised:
            gwatt.Machine.from_toml("schema = 1\nnmae = 'mill'\n")
        found = raised.exception.diagnostics
        self.assertIn(2, [it.line for it in found])
        wrong = next(it for it in found if it.line == 2)
        self.assertIn("^^^^", wrong.render("mill.toml"))
        with self.assertRaises(gwatt.MachineError):
            gwatt.Machine("no-such-machine")


class Programs(unittest.TestCase):
    machine = gwatt.Machine("three-axis")

    def test_check(self):
        figures = gwatt.check(PROGRAM, self.machine)
        self.assertFalse(figures.fits)
        self.assertEqual((figures.moves, figures.lines, figures.unfit_count), (2, 4, 1))
        self.assertEqual((figures.peak_line, figures.certificate), (2, "planned"))
        self.assertIsNone(figures.energy_j)
        data = figures.to_dict()
        self.assertAlmostEqual(data["peak_w"], figures.peak_w, places=5)
        self.assertIn("F", data["unfit"][0]["help"])

    def test_text_bytes_and_files_are_one(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "part.nc"
            path.write_text(PROGRAM)
            for given in (PROGRAM.encode(), bytearray(PROGRAM.encode()), path):
                own = gwatt.check(given, self.machine).to_dict()
                self.assertEqual(own, gwatt.check(PROGRAM, self.machine).to_dict())

    def test_subprograms_next_to_the_file(self):
        machine = gwatt.Machine("linuxcnc-mill")
        call = "G21 G90 G94 G17 G40 G49 G80\no<deep> call\nM2\n"
        with tempfile.TemporaryDirectory() as folder:
            sub = Path(folder) / "deep.ngc"
            sub.write_text("o<deep> sub\nG0 X100\no<deep> endsub\n")
            (Path(folder) / "part.ngc").write_text(call)
            self.assertEqual(gwatt.check(Path(folder) / "part.ngc", machine).moves, 1)
            self.assertEqual(gwatt.check(call, machine, sub_paths=[folder]).moves, 1)
            with self.assertRaises(gwatt.Refused):
                gwatt.check(call, machine)

    def test_a_program_that_is_refused(self):
        with self.assertRaisesRegex(gwatt.Refused, "line 2") as raised:
            gwatt.report("G21 G90\nG1 X10 X20 F600\nM30\n", self.machine)
        error = raised.exception
        self.assertIsInstance(error, gwatt.Error)
        [found] = error.diagnostics
        place = (found.severity, found.rule, found.line, found.column, found.file)
        self.assertEqual(place, ("error", "word-twice", 2, 8, None))
        self.assertEqual(str(found), f"error[word-twice]: line 2: {found.message}")
        self.assertEqual(found.help, "write each letter once in a block")
        self.assertEqual(error.more, 0)

    def test_report(self):
        report = gwatt.report(PROGRAM, self.machine)
        blocks = report.blocks
        self.assertEqual(list(blocks)[:4], ["line", "n_word", "move", "axes"])
        self.assertEqual({len(column) for column in blocks.values()}, {2})
        self.assertEqual(blocks["line"], array("q", [2, 3]))
        self.assertEqual(blocks["move"], ["rapid", "feed"])
        self.assertEqual(blocks["axes"], ["XYZ", "X"])
        self.assertEqual(max(blocks["peak_w"]), report.summary.peak_w)
        self.assertAlmostEqual(sum(blocks["energy_j"]), report.summary.energy_j)
        self.assertTrue(math.isnan(blocks["value_after"][0]))
        self.assertEqual(repr(report), "<gwatt.Report of 2 moves>")

    def test_columns_are_those_of_the_command(self):
        page = (PYTHON.parent / "docs/report.md").read_text()
        header = next(line for line in page.splitlines() if line.startswith("line,n_word,"))
        self.assertEqual(list(gwatt.report(PROGRAM, self.machine).blocks), header.split(","))

    def test_series(self):
        rows = gwatt.series(PROGRAM, self.machine, step_ms=0.5)
        self.assertEqual({len(column) for column in rows.values()}, {len(rows["line"])})
        self.assertEqual(list(rows)[:4], ["time_s", "line", "x_velocity_mm_s", "x_accel_mm_s2"])
        self.assertEqual(list(rows["time_s"]), sorted(rows["time_s"]))
        # The exact peak lies at a switching instant, which the series has.
        peak_w = gwatt.report(PROGRAM, self.machine).summary.peak_w
        self.assertAlmostEqual(max(rows["bus_w"]), peak_w, delta=0.002 * peak_w)
        with self.assertRaisesRegex(ValueError, "more than 10 rows: give a larger step_ms"):
            gwatt.series(PROGRAM, self.machine, max_rows=10)
        for step_ms in (0, -1, math.nan, math.inf):
            with self.assertRaisesRegex(ValueError, "step_ms: a number from"):
                gwatt.series(PROGRAM, self.machine, step_ms=step_ms)
        with self.assertRaisesRegex(ValueError, "one way through a program"):
            gwatt.series(PROGRAM, self.machine, probe="both")

    def test_a_series_with_fewer_rows_warns(self):
        slow = "G21 G90\nG1 X400 F1\nM30\n"
        with self.assertWarnsRegex(UserWarning, "line 2 lasts 24000 s"):
            gwatt.series(slow, self.machine, step_ms=1)

    def test_limit(self):
        limited = gwatt.limit(PROGRAM, self.machine)
        self.assertFalse(limited.before.fits)
        self.assertTrue(limited.after.fits)
        self.assertTrue(gwatt.check(limited.program, self.machine).fits)
        self.assertIn(b"G1 ", limited.program.splitlines()[1].replace(b"G01", b"G1"))
        self.assertLessEqual(max(limited.blocks["peak_after_w"]), 3600.0 * (1 + 1e-9))
        self.assertTrue(limited.to_dict()["certified"])
        self.assertEqual(repr(limited), f"<gwatt.Limited: {limited.edited_lines} lines changed>")

    def test_feeds_on_request_alone(self):
        program = "G21 G90\nG1 X400 Y300 Z-200 F30000\nM30\n"
        with self.assertRaisesRegex(gwatt.DoesNotFit, "cannot be made to fit") as raised:
            gwatt.limit(program, self.machine)
        self.assertEqual(raised.exception.diagnostics[0].line, 2)
        self.assertFalse(raised.exception.summary["certified"])
        self.assertTrue(gwatt.limit(program, self.machine, allow=["feed"]).after.fits)

    def test_what_a_machine_cannot_do(self):
        with self.assertRaisesRegex(gwatt.Unsuitable, "no word for acceleration"):
            gwatt.limit(PROGRAM, self.machine, strategy="accel")

    def test_options(self):
        at = gwatt.check("G21 G90\nG0 X400\nM30\n", self.machine, start={"X": 400})
        self.assertEqual(at.duration_s, 0)
        skipped = "G21 G90\n/G0 X400\nM30\n"
        self.assertEqual(gwatt.check(skipped, self.machine, block_delete=True).moves, 0)
        self.assertEqual(gwatt.check(skipped, self.machine, block_delete=[1]).moves, 0)
        self.assertEqual(gwatt.check(skipped, self.machine, block_delete=False).moves, 1)
        macro = "G21 G90 G94\nG0 X#500\nM30\n"
        fanuc = gwatt.check(macro, self.machine, dialect="fanuc", variables={"#500": 100})
        self.assertEqual(fanuc.moves, 1)
        robust = gwatt.check(PROGRAM, self.machine, certificate="robust", once=True, threads=1)
        self.assertEqual(robust.certificate, "robust")
        gwatt.check(PROGRAM, self.machine, start="unknown", probe="hit")

    def test_files_of_the_control(self):
        machine = gwatt.Machine("linuxcnc-mill")
        with tempfile.TemporaryDirectory() as folder:
            tools = Path(folder) / "tool.tbl"
            tools.write_text("T1 P1 Z10\n")
            kept = Path(folder) / "linuxcnc.var"
            kept.write_text("5221 0.0\n")
            program = "G21 G90 G17 G40 G80\nG43 H1\nG0 Z5\nM2\n"
            gwatt.check(program, machine, tool_table=tools, parameters=kept)
            tools.write_text("T1 T2 P1\n")
            with self.assertRaisesRegex(gwatt.Error, r"tool\.tbl is wrong\nline 1: ") as raised:
                gwatt.check(program, machine, tool_table=tools)
            self.assertEqual(raised.exception.diagnostics[0].line, 1)

    def test_wrong_options(self):
        def says(text, error=ValueError, **options):
            with self.assertRaisesRegex(error, text):
                gwatt.check(PROGRAM, self.machine, **options)

        says("there is no option `feed`; there are start, ", TypeError, feed=1)
        says("start: a dict of axes with their positions", TypeError, start=3)
        says("start: the machine has no axis A", start={"A": 0})
        says("start: the machine has no axis XY", start={"XY": 0})
        says("start: X needs a finite position", start={"X": math.inf})
        says("there is no dialect fancu; there are ", dialect="fancu")
        says("`#500=nan` is no variable|is no ", variables={"#500": math.nan}, dialect="fanuc")
        says("variables: `iso` has no R1", variables={"R1": 1.0})
        says("probe: `hit`, `miss` or `both` is needed", probe="no")
        says("certificate: `planned` or `robust` is needed", certificate="best")
        says("block_delete: 10 is no level from 1 to 9", block_delete=[10])
        says("sub_paths: there is no folder /no/such", sub_paths=["/no/such"])
        says("threads: at least 1 is needed", threads=0)
        with self.assertRaisesRegex(ValueError, "`rapids` cannot be allowed; there are feed"):
            gwatt.limit(PROGRAM, self.machine, allow=["rapids"])
        with self.assertRaisesRegex(ValueError, "there is no strategy `best`; there are preset"):
            gwatt.limit(PROGRAM, self.machine, strategy="best")

    def test_what_is_no_program(self):
        with self.assertRaisesRegex(TypeError, "a program is a str or bytes .* not int"):
            gwatt.check(3, self.machine)
        with self.assertRaises(FileNotFoundError):
            gwatt.check(Path("/no/such/part.nc"), self.machine)


class Long(unittest.TestCase):
    # Long enough to be interrupted.
    program = "G21 G91\n" + "G1 X1 F600\nG1 X-1\n" * 100_000 + "M30\n"

    def test_other_threads_run(self):
        worker = threading.Thread(
            target=gwatt.check, args=(self.program, gwatt.Machine("three-axis"))
        )
        worker.start()
        counted = 0
        while worker.is_alive() and counted < 10:
            counted += 1
            time.sleep(0.001)
        worker.join()
        self.assertGreater(counted, 0)

    def test_an_interrupt_ends_it(self):
        timer = threading.Timer(0.2, _thread.interrupt_main)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(1000):
                gwatt.report(self.program, gwatt.Machine("three-axis"))
        timer.join()


class Tables(unittest.TestCase):
    blocks = gwatt.report(PROGRAM, gwatt.Machine("three-axis")).blocks

    @has("numpy")
    def test_numpy(self):
        import numpy as np

        peak_w = np.asarray(self.blocks["peak_w"])
        self.assertEqual((peak_w.dtype, peak_w.shape), (np.float64, (2,)))
        self.assertEqual(np.asarray(self.blocks["line"]).dtype, np.int64)
        # The same memory, no copy.
        peak_w[1] += 1
        self.assertEqual(self.blocks["peak_w"][1], peak_w[1])
        peak_w[1] -= 1

    @has("pandas")
    def test_pandas(self):
        import pandas as pd

        frame = pd.DataFrame(self.blocks)
        self.assertEqual(list(frame.columns), list(self.blocks))
        self.assertEqual(frame.loc[frame["peak_w"].idxmax(), "line"], 2)
        self.assertEqual(str(frame["peak_w"].dtype), "float64")

    @has("pyarrow")
    def test_arrow(self):
        import pyarrow as pa

        table = pa.table(self.blocks)
        self.assertEqual(table.num_rows, 2)
        self.assertEqual(table.schema.field("peak_w").type, pa.float64())
        self.assertEqual(table.schema.field("axes").type, pa.string())

    @has("matplotlib", "numpy")
    def test_the_timeline(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "timeline.png"
            program = EXAMPLES / "simultaneous-start.ngc"
            script = [sys.executable, PYTHON / "examples/timeline.py"]
            run = subprocess.run(
                [*script, program, "three-axis", picture], capture_output=True, text=True
            )
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("peak 6001 W, limited 36", run.stdout)
            self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
            self.assertGreater(picture.stat().st_size, 10_000)

    @has("distributed")
    def test_the_recipe_for_dask(self):
        with tempfile.TemporaryDirectory() as folder:
            programs = Path(folder) / "programs"
            (programs / "more").mkdir(parents=True)
            (programs / "unfit.nc").write_text(PROGRAM)
            (programs / "more/fits.NGC").write_text("G21 G90\nG1 X10 F600\nM30\n")
            (programs / "notes.txt").write_text("not a program\n")
            out = Path(folder) / "out.csv"
            script = [sys.executable, EXAMPLES / "fleet/dask_fleet.py"]
            arguments = [*script, programs, "three-axis", out]
            run = subprocess.run(arguments, capture_output=True, text=True, timeout=300)
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertEqual(run.stdout, "2 programs: 1 fit, 1 do not, 0 not read\n")
            (programs / "broken.nc").write_text("G1 X1 X2\n")
            run = subprocess.run(arguments, capture_output=True, text=True, timeout=300)
            self.assertEqual(run.returncode, 2, run.stderr)
            with open(out, newline="") as file:
                rows = {Path(it["program"]).name: it for it in csv.DictReader(file)}
            self.assertEqual(rows["fits.NGC"]["fits"], "True")
            self.assertEqual(rows["unfit.nc"]["peak_line"], "2")
            self.assertIn("line 1: ", rows["broken.nc"]["error"])


if __name__ == "__main__":
    unittest.main()
