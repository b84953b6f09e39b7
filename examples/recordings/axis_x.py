"""Makes axis-x.csv: a slide of 120 kg with 400 N·s/m and 35 N of friction, moved
to and fro; noise of 3 N on the force and of 0.1 µm on the position.

    python3 examples/recordings/axis_x.py > examples/recordings/axis-x.csv
"""

import math
import random

random.seed(1)
print("time_s,force_n,position_mm")
for k in range(1000):
    t = k * 0.004
    x = v = a = 0.0
    for amplitude, hz in ((0.06, 0.6), (0.02, 1.7), (0.003, 5.3)):
        w = 2 * math.pi * hz
        x += amplitude * math.sin(w * t)
        v += amplitude * w * math.cos(w * t)
        a -= amplitude * w * w * math.sin(w * t)
    force = 120 * a + 400 * v + math.copysign(35, v) + random.gauss(0, 3)
    print(f"{t:.3f},{force:.2f},{1e3 * x + random.gauss(0, 1e-4):.4f}")
