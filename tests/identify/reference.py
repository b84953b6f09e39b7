"""Reference figures for tests/identify.rs: samples of a continuous system under
a held input, and the least standard errors (Cramér & Rao) of any estimate from
a recording of the branched axes.

    python3 tests/identify/reference.py
"""

import numpy as np
from scipy import signal

# 50·(1 + 2·0.02·s/280 + s²/280²)·(1 + s/20000)
#   / (1 + 2·0.03·s/310 + s²/310²)/(1 + 2·0.04·s/800 + s²/800²)
num = 50 * np.polymul([280**-2, 0.04 / 280, 1], [1 / 20000, 1])
den = np.polymul([310**-2, 0.06 / 310, 1], [800**-2, 0.08 / 800, 1])
period = 1e-3
step = np.ones(200)
(b, a, _) = signal.cont2discrete((num, den), period, "zoh")
out = signal.lfilter(b[0], a, step)
for k in (0, 1, 2, 3, 10, 50, 199):
    print(k, repr(float(out[k])))


# Branched axes: motor 0.006, table 0.01 kg·m², side masses (inertia, Hz) on the
# table; a mode's spring and damper are those of its mass alone.


def spring(mass, hz, damping):
    w = 2 * np.pi * hz
    return [2 * damping * mass * w, mass * w * w]


def branched(drive, sides):
    motor, table = 0.006, 0.01
    free = [[m, *spring(m, hz, 0.03)] for m, hz in sides]
    zeros = np.poly1d([1.0])
    for p in free:
        zeros *= np.poly1d(p)
    apparent = table * zeros
    for i, (m, c, k) in enumerate(free):
        others = np.poly1d([m * c, m * k])
        for j, p in enumerate(free):
            if j != i:
                others *= np.poly1d(p)
        apparent += others
    drive = np.poly1d(spring(*drive))
    numerator = drive * zeros
    denominator = drive * (apparent + motor * zeros)
    denominator += np.poly1d([motor, 0, 0]) * apparent
    gain = 1 / (motor + table + sum(m for m, _ in sides))
    return gain, numerator.roots, denominator.roots


def parameters(gain, zeros, poles):
    """Gain, then ln w and damping of each pair, time constant of the real zero."""
    theta, shape = [gain], []
    for kind, roots in (("zero", zeros), ("pole", poles)):
        for root in sorted(roots, key=abs):
            if root.imag > 0:
                theta += [np.log(abs(root)), -root.real / abs(root)]
                shape.append((kind, 2))
            elif root.imag == 0:
                theta.append(-1 / root.real)
                shape.append((kind, 1))
    return np.array(theta), shape


def simulated(theta, shape, torque):
    values = list(theta)
    sides = {"zero": np.poly1d([values.pop(0)]), "pole": np.poly1d([1.0])}
    for kind, count in shape:
        if count == 2:
            w, damping = np.exp(values.pop(0)), values.pop(0)
            sides[kind] *= np.poly1d([w**-2, 2 * damping / w, 1.0])
        else:
            sides[kind] *= np.poly1d([values.pop(0), 1.0])
    system = (sides["zero"].coeffs, sides["pole"].coeffs)
    b, a, _ = signal.cont2discrete(system, period, "zoh")
    return signal.lfilter(b[0], a, torque), a


def sequence(order, taps, hold, count):
    register, out = 1, []
    for _ in range(2**order - 1):
        out.append(1.0 if register & 1 else -1.0)
        bit = sum(register >> (order - tap) for tap in taps) & 1
        register = register >> 1 | bit << (order - 1)
    return np.resize(np.repeat(out, hold), count)


def least_errors(axis, torque, noise):
    """Offset and first state are unknown too."""
    theta, shape = parameters(*axis)
    clean, denominator = simulated(theta, shape, torque)
    columns = []
    for i, value in enumerate(theta):
        probe = np.zeros(len(theta))
        probe[i] = 1e-4 * abs(value)
        up, down = (simulated(theta + d, shape, torque)[0] for d in (probe, -probe))
        columns.append((up - down) / (2 * probe[i]))
    impulse = np.eye(1, len(torque))[0]
    swing = signal.lfilter([1.0], denominator, impulse)
    for k in range(len(denominator) - 1):
        columns.append(np.concatenate([np.zeros(k), swing[: len(swing) - k]]))
    columns.append(np.ones(len(torque)))
    columns = np.array(columns).T
    scale = np.linalg.norm(columns, axis=0)
    inverse = np.linalg.inv((columns / scale).T @ (columns / scale))
    sigma = noise * np.sqrt(np.mean(clean**2))
    std = sigma * np.sqrt(np.diag(inverse)) / scale
    return std[: len(theta)], theta


ONE = branched((0.0045, 150, 0.05), [(0.008, 40)])
TWO = branched((0.0045, 180, 0.05), [(0.008, 40), (0.004, 75)])
for name, axis, pairs in (("one", ONE, 1), ("two", TWO, 2)):
    for order, taps, count, noise in (
        (7, [7, 6], 4000, 0.05),
        (9, [9, 5], 16000, 0.2),
    ):
        std, theta = least_errors(axis, sequence(order, taps, 37, count), noise)
        print(name, count, noise, "inertia", round(std[0] / theta[0], 7))
        for pair in range(pairs):
            at = 1 + 2 * pair
            damping = std[at + 1] / theta[at + 1]
            print("  w", round(std[at], 7), "damping", round(damping, 6))
