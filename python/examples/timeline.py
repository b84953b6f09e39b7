# The power of a program over time, before and after it was limited, as a notebook: editors show
# each `# %%` as a cell. Needs matplotlib.

# %% The program and the machine
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import gwatt

folder = Path(__file__).resolve().parents[2]
program = Path(sys.argv[1]) if len(sys.argv) > 1 else folder / "examples/pocket.ngc"
machine = gwatt.Machine(sys.argv[2] if len(sys.argv) > 2 else "three-axis")
picture = sys.argv[3] if len(sys.argv) > 3 else "timeline.png"

# %% What it draws, and a program that fits
limited = gwatt.limit(program, machine)
print(f"peak {limited.before.peak_w:.0f} W, limited {limited.after.peak_w:.0f} W")
print(f"time {limited.before.duration_s:.2f} s, limited {limited.after.duration_s:.2f} s")

# %% The line of supply and axes over time
before = gwatt.series(program, machine)
after = gwatt.series(limited.program, machine)
supply_w = sum(machine.peak_power_w.values()) * (1 - machine.margin)

figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(9, 6))
top.plot(before["time_s"], before["bus_w"], label="before", linewidth=0.8)
top.plot(after["time_s"], after["bus_w"], label="after", linewidth=0.8)
top.axhline(supply_w, color="black", linestyle="--", label="limit")
top.set_ylabel("power drawn (W)")
top.legend(loc="upper right")

# %% The share of each axis
axes = [name for name in after if name.endswith("_power_w") and len(name) == len("x_power_w")]
drawn_w = [np.maximum(after[name], 0) for name in axes]
bottom.stackplot(after["time_s"], drawn_w, labels=[name[0].upper() for name in axes])
bottom.set_xlabel("time (s)")
bottom.set_ylabel("by axis, after (W)")
bottom.legend(loc="upper right")
figure.tight_layout()
figure.savefig(picture, dpi=120)
print(f"drawn: {picture}")
