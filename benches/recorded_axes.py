#!/usr/bin/env python3
"""Recordings of axes that others published, identified by gwatt and by SciPy.

    benches/recorded_axes.py target/release/gwatt --hsm150 FOLDER --lorenz FOLDER --camber FOLDER --emps FOLDER

Each folder is a copy of a public repository: malik-robert/HSM150-data,
TeacherRock/Lorenz_Friction, nicolazande/camber-control, forgi86/sysid-neural-continuous (with the
EMPS benchmark of Janot, Gautier and Brunot, 2019). The recordings are written as CSV, as a
technician would name their columns, and given to `gwatt identify`. The reference next to it is
least squares of the inverse dynamic model with the true structure: position and force through
the same Butterworth filter there and back (scipy.signal.filtfilt), central differences, friction
of its own in each direction, rows at rest left out (--still, as a share of the largest speed).
Both are printed, with the catalogue's figure where the repository has one.

Needs numpy and scipy. Exit status 1 where the masses differ by more than --apart.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy
import scipy.io
import scipy.ndimage
import scipy.signal

# Inertia of the motors of HSM150 in the data's own variable J, kg m2.
HSM150_CATALOGUE = 1.2e-4
# LinA of camber-control: torque constant in N m/A, and rad of the motor per m of the slide, by
# its model_setup.m.
LIN_TORQUE_CONSTANT = 42.9e-3
LIN_RAD_M = 1000 * 2 * numpy.pi * 85.58 / 24

# EMPS: the authors' least squares of the standard set, kg.
EMPS_PUBLISHED = 95.109


class Run:
    """A recording: seconds per sample, position and force in SI."""

    def __init__(self, name, period_s, position, force):
        self.name, self.period_s, self.position, self.force = name, period_s, position, force

    def write(self, folder, rotary):
        path = folder / f"{self.name}.csv"
        names = "position_rad,torque_nm" if rotary else "position_m,force_n"
        time = self.period_s * numpy.arange(len(self.position))
        numpy.savetxt(path, numpy.c_[time, self.position, self.force], delimiter=",", header="time_s," + names, comments="", fmt="%.9g")
        return path


def hsm150(folder):
    """Steps of torque of a motor that turns one way: the torque is that of the input column."""
    for path in sorted(folder.glob("Data/Identification/idf_*.mat")):
        data = scipy.io.loadmat(path)["data"]
        yield Run(path.stem, 1e-3, data[:, 2], data[:, 4])


def lorenz(folder):
    """Ramps of speed to and fro, controlled without feedforward: position and torque."""
    for path in sorted(folder.glob("data/Lorenz_Jm_*.txt")):
        data = numpy.loadtxt(path)
        yield Run(path.stem, 1e-3, data[:, 0], data[:, 4])


def camber(folder):
    """Sweeps of a screw actuator: position in mm and current in mA every 10 ms."""
    path = folder / "actuators/LinA/data/no-pp-sine-sweep-10mm-0.5Hz.txt"
    data = numpy.loadtxt(path)
    force_n_ma = 1e-3 * LIN_TORQUE_CONSTANT * LIN_RAD_M
    yield Run("LinA", 1e-2, 1e-3 * data[:, 3], force_n_ma * data[:, 5])


def emps(folder):
    """A slide in closed loop, the standard set and that with pulses: position and the drive's volts."""
    for name in ("DATA_EMPS", "DATA_EMPS_PULSES"):
        data = scipy.io.loadmat(folder / f"examples/EMPS/data/{name}.mat")
        yield Run(name, 1e-3, data["qm"][:, 0], data["gtau"][0, 0] * data["vir"][:, 0])


def rows(run, cutoff_hz, still):
    """Columns of one recording (acceleration, speed and sign in each direction) and the force."""
    b, a = scipy.signal.butter(4, 2 * cutoff_hz * run.period_s)
    position = scipy.signal.filtfilt(b, a, run.position)
    speed = numpy.gradient(position, run.period_s)
    acceleration = numpy.gradient(speed, run.period_s)
    force = scipy.signal.filtfilt(b, a, run.force)
    moves = numpy.abs(speed) > still * numpy.abs(speed).max()
    # Where it sets off or stops, the filter mixes rest and motion.
    edge = int(1 / (cutoff_hz * run.period_s))
    moves[:edge] = moves[-edge:] = False
    moves = scipy.ndimage.binary_erosion(moves, iterations=edge)
    forward, backward = moves & (speed > 0), moves & (speed < 0)
    columns = numpy.c_[acceleration, speed * forward, forward, speed * backward, -1.0 * backward]
    every = max(int(0.4 / (cutoff_hz * run.period_s)), 1)
    return columns[moves][::every], force[moves][::every]


def reference(runs, cutoff_hz, still):
    """Mass with its standard error, and what is left of the force."""
    each = [rows(run, cutoff_hz, still) for run in runs]
    columns, force = numpy.concatenate([row[0] for row in each]), numpy.concatenate([row[1] for row in each])
    columns = columns[:, numpy.abs(columns).max(axis=0) > 0]
    theta, *_ = numpy.linalg.lstsq(columns, force, rcond=None)
    left = force - columns @ theta
    variance = left @ left / (len(force) - len(theta)) * numpy.linalg.inv(columns.T @ columns)[0, 0]
    return theta[0], variance**0.5, numpy.linalg.norm(left) / numpy.linalg.norm(force)


def identified(gwatt, runs, rotary):
    """What gwatt finds: mass with its standard error, what is left, the verdict."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        paths = [run.write(folder, rotary) for run in runs]
        out = folder / "found.json"
        done = subprocess.run([gwatt, "identify", *paths, "--axis", "A" if rotary else "X", "--json", out], capture_output=True, text=True, check=False)
        if not out.exists():
            return None, done.stderr.strip().splitlines()[0]
        return json.loads(out.read_text()), None


SETS = {
    "hsm150": (hsm150, True, 25.0, HSM150_CATALOGUE),
    "lorenz": (lorenz, True, 25.0, None),
    "camber": (camber, False, 10.0, None),
    "emps": (emps, False, 30.0, EMPS_PUBLISHED),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gwatt")
    for name in SETS:
        parser.add_argument(f"--{name}", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--still", type=float, default=0.02, help="share of the largest speed below which the axis rests")
    parser.add_argument("--apart", type=float, default=0.05, help="by which share masses may differ")
    given = parser.parse_args()
    far = 0
    print(f"{'recording':24} {'SciPy':>11} {'± ':>9} {'left':>6}   {'gwatt':>11} {'± ':>9} {'left':>6} {'apart':>7} {'catalogue':>10}  verdict")
    for name, (load, rotary, cutoff_hz, catalogue) in SETS.items():
        folder = getattr(given, name)
        if folder is None:
            continue
        runs = list(load(folder))
        sets = [(name + ", joined", runs)] if len(runs) > 1 else []
        sets += [(run.name, [run]) for run in runs]
        for title, some in sets:
            mass, std, left = reference(some, cutoff_hz, given.still)
            found, wrong = identified(given.gwatt, some, rotary)
            line = f"{title[:24]:24} {mass:11.4e} {std:9.1e} {left:6.1%}   "
            if found is None:
                print(line + wrong)
                continue
            key = "inertia_kg_m2" if rotary else "mass_kg"
            own, own_std = found[key], found[key + "_std"]
            apart = own / mass - 1
            far += abs(apart) > given.apart and found["verdict"] == "good"
            known = f"{own / catalogue - 1:+10.1%}" if catalogue else " " * 10
            print(line + f"{own:11.4e} {own_std:9.1e} {found['rel_error']:6.1%} {apart:+7.1%} {known}  {found['verdict']}", flush=True)
    sys.exit(1 if far else 0)


if __name__ == "__main__":
    main()
