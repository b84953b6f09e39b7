"""Makes flexible-x.csv and flexible-y.csv: two axes, each a motor, a table on a
spring, and a side mass on another, excited with an M-sequence of 1 N·m (2 N·m);
noise of 3 % on the table's acceleration. The side masses make anti-resonances
of 40 Hz and of 31 Hz, both with 3 % of damping.

    python3 examples/recordings/flexible.py
"""

import numpy as np
from scipy import signal

PERIOD_S = 2e-3
ORDER = 10


def spring(mass, hz, damping):
    w = 2 * np.pi * hz
    return np.array([2 * damping * mass * w, mass * w * w])


def axis(motor, table, drive, side, branch):
    """From torque to the table's acceleration; polynomials in s, descending."""
    ring = np.array([side, *branch])
    apparent = np.polyadd(table * ring, side * branch)
    denominator = np.polyadd(
        np.polymul(drive, np.polyadd(apparent, motor * ring)),
        np.polymul([motor, 0, 0], apparent),
    )
    return np.polymul(drive, ring), denominator


def m_sequence(n):
    """Taps 10 and 7."""
    state = [1] * ORDER
    out = []
    for _ in range(n):
        out.append(1.0 if state[-1] else -1.0)
        state = [state[9] ^ state[6]] + state[:-1]
    return np.array(out)


def record(name, amplitude, parts, seed):
    b, a, _ = signal.cont2discrete(axis(*parts), PERIOD_S, "zoh")
    torque = amplitude * m_sequence(1000)
    clean = signal.lfilter(np.ravel(b), a, torque)
    noise = 0.03 * np.std(clean) * np.random.default_rng(seed).standard_normal(1000)
    with open(name, "w") as out:
        out.write("time_s,torque_nm,accel_rad_s2\n")
        for k, (u, y) in enumerate(zip(torque, clean + noise)):
            out.write(f"{k * PERIOD_S:.3f},{u:g},{y:.2f}\n")


folder = __file__.rsplit("/", 1)[0] if "/" in __file__ else "."
drive = spring(0.0045, 150, 0.05)
record(f"{folder}/flexible-x.csv", 1, (0.006, 0.010, drive, 0.008, spring(0.008, 40, 0.03)), 1)
record(f"{folder}/flexible-y.csv", 2, (0.006, 0.014, drive, 0.009, spring(0.009, 31, 0.03)), 2)
