"""Makes pocket-power.csv: what a meter shows while examples/pocket.ngc runs on the machine vmc.

    gwatt report examples/pocket.ngc -m vmc --series series.csv
    python3 examples/recordings/pocket_power.py series.csv > pocket-power.csv

The meter shows the mean of every 20 ms, with 15 W of noise. The machine draws 4.5 % more than
planned, takes 1.2 % longer, and begins at 3.2 s.
"""

import bisect
import csv
import random
import sys

START_S, PACE, GAIN, STEP_S, REST_W = 3.2, 1.012, 1.045, 0.02, 150.0

rows = [row for row in csv.DictReader(open(sys.argv[1])) if row["program"] == "before"]
times = [float(row["time_s"]) for row in rows]
powers = [float(row["bus_w"]) - float(row["regen_w"]) for row in rows]
energies = [0.0]
for k in range(1, len(times)):
    energies.append(energies[-1] + (times[k] - times[k - 1]) * (powers[k] + powers[k - 1]) / 2)


def energy(time):
    """Up to a time of the program."""
    if time <= 0:
        return REST_W * time
    k = bisect.bisect_right(times, time) - 1
    since = time - times[k]
    if k + 1 == len(times):
        return energies[k] + REST_W * since
    slope = (powers[k + 1] - powers[k]) / (times[k + 1] - times[k])
    return energies[k] + since * (powers[k] + slope * since / 2)


random.seed(1)
print("time_s,power_w")
for k in range(1, int((START_S + PACE * times[-1] + 3) / STEP_S)):
    begin, end = ((k * STEP_S - back - START_S) / PACE for back in (STEP_S, 0.0))
    mean = (energy(end) - energy(begin)) * PACE / STEP_S
    print(f"{k * STEP_S:.2f},{GAIN * mean + random.gauss(0, 15):.0f}")
