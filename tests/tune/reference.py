"""Reference figures for tests/tune.rs: filters as SciPy makes them.

    python3 tests/tune/reference.py
"""

import numpy as np
from scipy import signal

T = 1e-3


def pair(hz, damping):
    w = 2 * np.pi * hz
    return [1 / w**2, 2 * damping / w, 1]


def tustin(b, a, hz):
    """Pre-warped at hz: the rate that makes s = 2·fs·(z − 1)/(z + 1) exact there."""
    return signal.bilinear(b, a, np.pi * hz / np.tan(np.pi * hz * T))


def at(b, a, hz):
    z = np.exp(2j * np.pi * hz * T)
    return np.polyval(b, z) / np.polyval(a, z)


zeros = [(40, 0.03), (75, 0.02)]
butter = signal.butter(4, 1, analog=True, output="zpk")[1]
poles = [(200.0, -p.real) for p in sorted(butter, key=lambda p: p.real) if p.imag > 0]
print("damping of the low-pass", [float(d) for _, d in poles])
for hz in (10, 40, 55, 180):
    value = 1
    for (zero, zeta), (pole, damping) in zip(zeros, poles):
        b, a = tustin(pair(zero, zeta), [1], zero)
        value *= at(b, a, hz)
        b, a = tustin([1], pair(pole, damping), pole)
        # (z + 1)² of both: the numerator's stands below, the low-pass' above.
        value *= at(b, a, hz)
    print("tustin", hz, f"{value.real:.12f}, {value.imag:.12f}")
num = np.polymul(pair(*zeros[0]), pair(*zeros[1]))
six = signal.butter(6, 2 * np.pi * 200, analog=True)
b, a, _ = signal.cont2discrete((np.array(num) * six[0][-1], six[1]), T, "zoh")
for hz in (10, 40, 55, 180):
    value = at(np.ravel(b), a, hz)
    print("zoh", hz, f"{value.real:.12f}, {value.imag:.12f}")
