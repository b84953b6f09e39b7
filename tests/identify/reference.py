"""Reference figures for tests/identify.rs: samples of a continuous system under
a held input, and the system that SciPy makes of it.

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
