#!/usr/bin/env python3
"""What LinuxCNC's axes do, recorded in every servo cycle, compared with gwatt's plan.

    benches/recorded.py target/release/gwatt TOOLS --axes XYZABC --seed 1 --count 50
    benches/recorded.py target/release/gwatt TOOLS --axes XYZ --limited FOLDER PROGRAM ...

Makes random programs and machines, runs each in LinuxCNC without a display and compares
peak power and time with those of `gwatt report --override 100%`: the peak of the program,
and of each line that of the recording with those of the plan there and in its neighbours
(blends lie in either; a line number that LinuxCNC shows is that of the last line of those
that it joins). With --limited: limits the given programs (folders are searched) to --share of
their own peak, runs what was written, and compares its peak with the limit and its time
with the plan's.

TOOLS is the folder with simrun.sh, of which sim/display.py and lab.tbl are used, and its
lock: one simulation runs at a time. LinuxCNC is set up here, for any axes; simrun.sh has X,
Y and Z alone. Needs linuxcnc-uspace and faketime (Debian) and root, as simrun.sh does.

Power is v*F, F = m*a + b*v + Fc*sign(v) + Fg, by 1/efficiency where it drives; what one
axis feeds back, no other gets. v is the speed that LinuxCNC commands, a its change over the
two cycles around. LinuxCNC's commands pass a cubic spline, in which a step of acceleration
takes two to three cycles, so that no longer mean is needed. Each block begins and ends
within a cycle, which LinuxCNC rounds: TOLERANCE, 1 %, is by what two cycles of 1 ms change
the speed at the end of a ramp of 0.2 s. Lines that draw less than a hundredth of
the program's peak count as that hundredth.

--outputs declares the adaptive feed at an analog output, so that --limited lowers rapids by it.

--fine adds runs of very short lines before a long block: LinuxCNC's optimiser stops after five
blocks that reach their limit, and leaves the blocks before them at the speeds that they had
as the last of the queue, so that it brakes and speeds up. --bends adds rows of lines that
hardly bend, on machines of light and heavy axes: joints that LinuxCNC passes without a blend
take up to a tenth of an axis' acceleration for a cycle.

Where a recorded peak is above the plan, or the time differs by more than 0.5 %, the program
runs again at real time, and that run counts: speeded up, the queue may run empty. Waits are
the cycles in which all axes stand less the dwells of the plan: words that wait for the
axes, and the rest of a cycle at each stop; the times are compared without them. Exit status
1 where a peak is above, of a program or of a line; those programs, with machine and recording, go to --keep.
"""

import argparse
import collections
import contextlib
import csv
import fcntl
import json
import math
import os
import pathlib
import random
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile

from recorded_programs import FIELDS, ROTARY, Maker, random_machine

CYCLE_S = 0.001
TOLERANCE = 0.01
# Simulations that do not start on a busy host are tried again.
TRIES = 3
# Difference of times that is looked at again, and that counts as met.
TIME_TOLERANCE = 0.005
# What a machine file calls FIELDS, by kind of axis.
NAMES = {False: ("rapid_mm_min", "accel_mm_s2", "mass_kg", "coulomb_n", "viscous_n_s_m", "gravity_n", "efficiency"),
         True: ("rapid_deg_min", "accel_deg_s2", "inertia_kg_m2", "friction_nm", "viscous_nm_s_rad", "gravity_nm", "efficiency")}
# The machine of --limited.
LINEAR_AXIS = dict(zip(FIELDS, (150.0, 2000.0, 250.0, 200.0, 0.0, 0.0, 0.8)))
ROTARY_AXIS = dict(zip(FIELDS, (150.0, 1500.0, 3.0, 10.0, 0.0, 0.0, 0.8)))


# The machine, for gwatt and for LinuxCNC

def fixed_machine(axes):
    machine = {axis: dict(ROTARY_AXIS if axis in ROTARY else LINEAR_AXIS) for axis in axes}
    if "Z" in machine:
        machine["Z"].update(rapid=100.0, accel=1500.0, weight=100.0)
    return machine


# The adaptive feed at an analog output, as the controller profile says it.
OUTPUTS = "[outputs]\nspeed = 1\nchange_s = 0.01\n"
PACE = """loadrt comp names=pace-given
loadrt mux2 names=pace
addf pace-given servo-thread
addf pace servo-thread
setp pace-given.in0 0.000001
setp pace.in0 1
net pace-asked motion.analog-out-01 => pace-given.in1 pace.in1
net pace-is-given pace-given.out => pace.sel
net pace-now pace.out => motion.adaptive-feed
"""


def machine_file(machine, peak_w, outputs=""):
    text = ('schema = 1\nname = "recorded"\ncontroller = "linuxcnc"\n[limits]\nmargin = 0.0\n'
            f"[converter]\npeak_power_w = {peak_w!r}\nbase_load_w = 0\n{outputs}")
    for axis, values in machine.items():
        rotary = axis in ROTARY
        text += f'[axes.{axis}]\nkind = "{"rotary" if rotary else "linear"}"\n'
        for name, field in zip(NAMES[rotary], FIELDS):
            value = values[field] * (60 if field == "rapid" else 1)
            text += f"{name} = {value!r}\n"
    return text


def linuxcnc_files(machine, folder, subprograms):
    """lab.ini and lab.hal: an ideal machine with LinuxCNC's default planner."""
    axes = "".join(machine)
    ini = f"""[EMC]
VERSION = 1.1
[DISPLAY]
DISPLAY = ./display.py
PROGRAM_PREFIX = .
MAX_FEED_OVERRIDE = 1.0
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = lab.var
SUBROUTINE_PATH = .:{subprograms}
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 10.0
SERVO_PERIOD = {round(CYCLE_S * 1e9)}
[HAL]
HALFILE = lab.hal
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.005
TOOL_TABLE = lab.tbl
[KINS]
KINEMATICS = trivkins coordinates={axes}
JOINTS = {len(axes)}
[TRAJ]
COORDINATES = {" ".join(axes)}
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
NO_FORCE_HOMING = 1
DEFAULT_LINEAR_VELOCITY = 50
MAX_LINEAR_VELOCITY = 10000
MAX_LINEAR_ACCELERATION = 1000000
DEFAULT_ANGULAR_VELOCITY = 50
MAX_ANGULAR_VELOCITY = 10000
MAX_ANGULAR_ACCELERATION = 1000000
"""
    cfg = "sb" + "ff" * len(axes)
    hal = f"""loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS num_aio=8 num_dio=8
loadrt sim_spindle names=lab-spindle
loadrt sampler depth=20000 cfg={cfg}
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
addf lab-spindle servo-thread
net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net tool-prep iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net tool-chg iocontrol.0.tool-change => iocontrol.0.tool-changed
setp lab-spindle.scale 0.01666667
net sp-rpm spindle.0.speed-out => lab-spindle.velocity-cmd
net sp-rps spindle.0.speed-out-rps => spindle.0.speed-in
net sp-revs lab-spindle.position-fb => spindle.0.revs
net sp-index spindle.0.index-enable <=> lab-spindle.index-enable
setp sampler.0.enable 0
net line motion.program-line => sampler.0.pin.0
net inpos motion.in-position => sampler.0.pin.1
"""
    for joint, (axis, values) in enumerate(machine.items()):
        limits = f"MIN_LIMIT = -100000\nMAX_LIMIT = 100000\nMAX_VELOCITY = {values['rapid']!r}\nMAX_ACCELERATION = {values['accel']!r}\n"
        kind = "ANGULAR" if axis in ROTARY else "LINEAR"
        ini += f"[AXIS_{axis}]\n{limits}[JOINT_{joint}]\n{limits}TYPE = {kind}\nHOME = 0\nHOME_SEQUENCE = 0\nFERROR = 100\nMIN_FERROR = 100\n"
        hal += f"net pos-{joint} joint.{joint}.motor-pos-cmd => joint.{joint}.motor-pos-fb\n"
        hal += f"net at-{joint} joint.{joint}.pos-cmd => sampler.0.pin.{2 + 2 * joint}\n"
        hal += f"net speed-{joint} joint.{joint}.vel-cmd => sampler.0.pin.{3 + 2 * joint}\n"
    hal += PACE
    (folder / "lab.ini").write_text(ini)
    (folder / "lab.hal").write_text(hal)


# Recording

@contextlib.contextmanager
def one_simulation():
    """LinuxCNC's shared memory is there once; simrun.sh waits for the same file."""
    with open(pathlib.Path(tempfile.gettempdir()) / f"labsim.{os.getuid()}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def record(*arguments):
    """As `record_once`, where LinuxCNC starts."""
    for _ in range(TRIES):
        wrong = record_once(*arguments)
        if not wrong or not ("emcStatusBuffer" in wrong or "timeout" in wrong or "no status" in wrong):
            break
    return wrong


def record_once(tools, machine, program, place, speedup, seconds, raw):
    """Runs the text of a program that finds its subprograms in the folder `place`; samples go
    to `raw`. None, or what LinuxCNC said."""
    with tempfile.TemporaryDirectory(prefix="recorded-") as folder:
        folder = pathlib.Path(folder)
        for file in ("sim/display.py", "lab.tbl"):
            shutil.copy(tools / file, folder)
        (folder / "lab.var").write_text("")
        (folder / "program.ngc").write_bytes(program)
        (folder / "subprograms").symlink_to(place.resolve())
        linuxcnc_files(machine, folder, "subprograms")
        folder.chmod(0o777)
        environment = {**os.environ, "HOME": str(folder), "PATH": "/usr/bin:/bin:" + os.environ["PATH"], "LAB_PROGRAM": str(folder / "program.ngc"),
                       "LAB_SAMPLES": str(folder / "raw"), "LAB_STATUS": str(folder / "status"), "LAB_LIMIT": str(seconds)}
        for name in ("DISPLAY", "LINUXCNC_FORCE_REALTIME", "LAB_EXTRA_HAL"):
            environment.pop(name, None)
        # rtapi_app refuses plain root; it wants to know an unprivileged user instead.
        environment.setdefault("RTAPI_UID", "65534")
        if speedup != 1:
            library = next(pathlib.Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
            environment.update(LD_PRELOAD=str(library), FAKETIME=f"+0 x{speedup}", FAKETIME_NO_CACHE="0", DONT_FAKE_MONOTONIC="0")
        with one_simulation(), open(folder / "log", "w") as log:
            run = subprocess.Popen(["linuxcnc", "-r", "lab.ini"], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=log, stderr=log, start_new_session=True)
            try:
                run.wait(seconds / speedup + 60)
            except subprocess.TimeoutExpired:
                # LinuxCNC clears up what it has started.
                os.kill(run.pid, signal.SIGTERM)
                run.wait()
        status = (folder / "status").read_text() if (folder / "status").exists() else ""
        shutil.copy(folder / "raw", raw) if (folder / "raw").exists() else raw.write_text("")
        if "result ok" not in status:
            wrong = [line for line in status.splitlines() if line.startswith("error")]
            return (wrong or ["no status"])[0]
        return None if "overruns 0" in status else "samples were lost"


def evaluate(raw, machine):
    """Peaks in W of the lines, as [line, W] in their order, time from the first to the last
    motion in s, and time at rest within it in s. Raises ValueError where a cycle is missing."""
    units = [math.pi / 180 if axis in ROTARY else 0.001 for axis in machine]
    rows = []
    for text in raw.read_text().splitlines():
        fields = text.split()
        if len(fields) == 3 + 2 * len(machine):
            rows.append((int(fields[0]), int(fields[1]), [float(field) * unit for field, unit in zip(fields[4::2], units)]))
    if any(after[0] - before[0] != 1 for before, after in zip(rows, rows[1:])):
        raise ValueError("cycles are missing")
    moving, lines = [], []
    for index in range(1, len(rows) - 1):
        line, speeds = rows[index][1:]
        if not lines or lines[-1][0] != line:
            lines.append([line, 0.0])
        if not any(abs(v) > 1e-9 for v in speeds):
            continue
        moving.append(index)
        power = 0.0
        for values, v, before, after in zip(machine.values(), speeds, rows[index - 1][2], rows[index + 1][2]):
            a = (after - before) / (2 * CYCLE_S)
            force = values["mass"] * a + values["viscous"] * v + math.copysign(values["coulomb"], v) + values["weight"]
            power += max(v * force, 0.0) / values["efficiency"]
        lines[-1][1] = max(lines[-1][1], power)
    whole = moving[-1] - moving[0] + 1 if moving else 0
    return [peak for peak in lines if peak[0]], whole * CYCLE_S, (whole - len(moving)) * CYCLE_S


def worst_line(lines, planned):
    """The largest ratio of a line's recorded peak to the planned ones, and the line."""
    floor_w = 0.01 * max(planned.values(), default=0.0)
    worst = (0.0, 0)
    for index, (line, peak_w) in enumerate(lines):
        first = lines[index - 2][0] + 1 if index >= 2 else 0
        last = lines[index + 1][0] if index + 1 < len(lines) else math.inf
        bound_w = max((w for other, w in planned.items() if first <= other <= max(line, last)), default=0.0)
        worst = max(worst, (peak_w / max(bound_w, floor_w, 1e-9), line))
    return worst


def enclosed(text):
    """The program after the path mode that the plan begins with, and with an end. Up to 2.9.1
    it is chance which mode LinuxCNC has: the end of the emergency stop, in which it starts,
    makes the tolerance 0."""
    head = len(text.split(b"\n", 1)[0]) + 1 if text.startswith(b"%") else 0
    return text[:head] + b"G64 P0.0254 Q0\n" + text[head:] + (b"" if head else b"\nM2\n")


# Planning

# Peak in W, peaks by line, time from the first to the last move in s, dwells within it in s.
Planned = collections.namedtuple("Planned", "peak_w lines whole_s dwell_s")


def run(arguments):
    try:
        found = subprocess.run([str(argument) for argument in arguments], capture_output=True, timeout=300, check=False)
    except subprocess.TimeoutExpired:
        return -1, "took too long"
    lines = found.stderr.decode("utf-8", "replace").strip().splitlines()
    wrong = [line for line in lines if line.startswith("error")]
    return found.returncode, (wrong or lines or ["no message"])[0]


def plan(gwatt, program, options, folder):
    """What `report` says, or why it says nothing."""
    code, error = run([gwatt, "report", program, *options, "--override", "100%", "--json", folder / "plan.json", "--csv", folder / "plan.csv"])
    if code != 0:
        return None, error
    with open(folder / "plan.csv", encoding="utf-8", newline="") as file:
        blocks = [(int(row["line"]), not row["axes"], float(row["duration_s"]), float(row["peak_w"])) for row in csv.DictReader(file)]
    lines = {}
    for line, rests, _, peak_w in blocks:
        if not rests:
            lines[line] = max(lines.get(line, 0.0), peak_w)
    while blocks and blocks[0][1]:
        blocks.pop(0)
    while blocks and blocks[-1][1]:
        blocks.pop()
    peak_w = json.loads((folder / "plan.json").read_text())["peak_w"] or 0.0
    return Planned(peak_w, lines, sum(block[2] for block in blocks), sum(block[2] for block in blocks if block[1])), ""


# Comparison

class Table:
    def __init__(self, given):
        self.given, self.rows, self.skipped = given, [], []
        print(f"{'program':40} {'rec. W':>9} {given.against:>9} {'ratio':>7} {'by line':>8} {'rec. s':>8} {'plan s':>8} {'waits s':>8} {'time':>8}  line")

    def skip(self, name, why):
        self.skipped.append(name)
        print(f"{name[-40:]:40} left out: {why}", flush=True)

    def compare(self, name, machine, program, place, planned, limit_w, extra):
        """Records a program and holds it against the plan, or a limit where there is one. `extra`
        is kept with it where it is above."""
        with tempfile.TemporaryDirectory() as folder:
            raw, text = pathlib.Path(folder) / "raw", program.read_bytes()
            if limit_w:
                text = enclosed(text)
            for speedup in dict.fromkeys((self.given.speedup, 1)):
                try:
                    wrong = record(self.given.tools, machine, text, place, speedup, planned.whole_s * 2 + 30, raw)
                    if wrong:
                        continue
                    lines, whole_s, rest_s = evaluate(raw, machine)
                except ValueError as error:
                    wrong = str(error)
                    continue
                peak_w, bound_w = max((w for _, w in lines), default=0.0), limit_w or planned.peak_w
                ratio = peak_w / max(bound_w, 1e-9)
                by_line, line = (0.0, 0) if limit_w else worst_line(lines, planned.lines)
                late = (whole_s - rest_s) / max(planned.whole_s - planned.dwell_s, 1e-9) - 1
                above = ratio > 1 + TOLERANCE or by_line > 1 + TOLERANCE
                if not above and abs(late) <= TIME_TOLERANCE:
                    break
            if wrong:
                return self.skip(name, wrong)
            self.rows.append((ratio, by_line, late, whole_s / max(planned.whole_s, 1e-9) - 1, above))
            print(f"{name[-40:]:40} {peak_w:9.2f} {bound_w:9.2f} {ratio:7.4f} {by_line:8.4f} {whole_s:8.3f} {planned.whole_s:8.3f} "
                  f"{rest_s - planned.dwell_s:8.3f} {100 * late:+7.2f}%  {line or ''}{' ABOVE' if above else ''}", flush=True)
            if above or self.given.keep_all:
                keep = self.given.keep / name.replace("/", "--")
                keep.mkdir(parents=True, exist_ok=True)
                for file in (program, raw, *extra):
                    shutil.copy(file, keep)

    def summary(self):
        above = sum(row[-1] for row in self.rows)
        print(f"{len(self.rows)} recorded, {len(self.skipped)} left out, {above} above")
        names = ("peak by " + self.given.against[:-2], "peak by line", "time without waits", "whole time")
        for name, values in zip(names, zip(*self.rows)):
            if name == "peak by line" and self.given.limited:
                continue
            print(f"{name}: {min(values):+.4f} to {max(values):+.4f}, median {statistics.median(values):+.4f}")
        print(f"time without waits within {100 * TIME_TOLERANCE:g} %: {sum(abs(row[2]) <= TIME_TOLERANCE for row in self.rows)}")
        # What could not be run is not a pass.
        return 1 if above or len(self.skipped) > len(self.rows) else 0


def random_programs(given, table, folder):
    for number in range(given.count):
        rng = random.Random(f"{given.axes} {given.seed + number}")
        name = f"{given.axes}-{given.seed + number}"
        machine = random_machine(rng, given.axes, given.bends)
        program, file = folder / f"{name}.ngc", folder / "machine.toml"
        program.write_text(Maker(rng, machine).program(rng.uniform(2, 8), given.fine, given.bends))
        file.write_text(machine_file(machine, 1e9))
        planned, why = plan(given.gwatt, program, ["-m", file], folder)
        if planned is None:
            table.skip(name, why)
        else:
            table.compare(name, machine, program, folder, planned, None, [file])


def limited_programs(given, table, folder):
    files = []
    for path in given.limited:
        files += sorted(file for file in path.rglob("*") if file.is_file()) if path.is_dir() else [path]
    machine = fixed_machine(given.axes)
    file = folder / "machine.toml"
    outputs = OUTPUTS if given.outputs else ""
    for original in files:
        name = str(original)
        options = ["-m", file, "--sub-path", original.resolve().parent, "--tool-table", given.tools / "lab.tbl"]
        file.write_text(machine_file(machine, 1e9, outputs))
        planned, why = plan(given.gwatt, original, options, folder)
        if planned is None or planned.peak_w <= 0.0 or planned.whole_s > given.longest:
            table.skip(name, why or ("nothing moves" if planned.peak_w <= 0.0 else f"{planned.whole_s:.0f} s"))
            continue
        limit_w = given.share * planned.peak_w
        file.write_text(machine_file(machine, limit_w, outputs))
        written = folder / "limited.ngc"
        code, error = run([given.gwatt, "limit", original, *options, "--allow", "feed,expand", "-o", written])
        if code != 0:
            table.skip(name, "not limited: " + error)
            continue
        if given.outputs and b"M67" not in written.read_bytes():
            table.skip(name, "nothing is set by an output")
            continue
        planned, why = plan(given.gwatt, written, options, folder)
        if planned is None:
            table.skip(name, why)
        elif planned.whole_s > given.longest:
            table.skip(name, f"{planned.whole_s:.0f} s")
        else:
            table.compare(name, machine, written, original.resolve().parent, planned, limit_w, [file, original])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gwatt")
    parser.add_argument("tools", type=pathlib.Path)
    parser.add_argument("--axes", default="XYZ", help="letters of the axes (default XYZ)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--fine", action="store_true", help="with runs of very short lines")
    parser.add_argument("--bends", action="store_true", help="with rows of lines that hardly bend, on light and heavy axes")
    parser.add_argument("--limited", type=pathlib.Path, nargs="+", metavar="PATH", help="programs, or folders of them, to limit")
    parser.add_argument("--outputs", action="store_true", help="with the adaptive feed at an output, and only programs that use it")
    parser.add_argument("--share", type=float, default=0.6)
    parser.add_argument("--longest", type=float, default=60.0, help="longest planned time in s, with --limited")
    parser.add_argument("--speedup", type=int, default=10)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("recorded-above"), help="folder for programs that are above")
    parser.add_argument("--keep-all", action="store_true")
    given = parser.parse_args()
    given.against = "limit W" if given.limited else "plan W"
    table = Table(given)
    with tempfile.TemporaryDirectory() as folder:
        (limited_programs if given.limited else random_programs)(given, table, pathlib.Path(folder))
    sys.exit(table.summary())


if __name__ == "__main__":
    main()
