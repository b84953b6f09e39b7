"""Checks all programs below a folder, on as many computers as a Dask cluster has.

    python dask_fleet.py PROGRAMS MACHINE OUT.csv [SCHEDULER]

Without the address of a scheduler the cores of this computer do it. The workers need the package
gwatt, and the folder under the same path. Each program is a row: its figures, or why it is not
read. The exit code is 1 where a program does not fit, 2 where one is not read.
"""

import csv
import sys
from pathlib import Path

from dask.distributed import Client

import gwatt

# How names of part programs end, as `gwatt check` takes them from folders.
ENDINGS = """
    .ngc .nc .tap .cnc .gcode .gco .g .mpf .spf .min .ssb .eia .iso
    .din .dnc .fnc .prg .ptp .pim .ncc
""".split()
COLUMNS = ["program", "fits", "peak_w", "peak_line", "regen_w", "duration_s", "energy_j", "error"]


def row(path, machine_name):
    """The figures of a program."""
    machine = gwatt.Machine(machine_name)
    try:
        # Workers share the cores among programs.
        it = gwatt.report(Path(path), machine, threads=1).summary
    except (gwatt.Error, OSError) as error:
        return {"program": path, "error": str(error)}
    return {"program": path} | {name: getattr(it, name) for name in COLUMNS[1:-1]}


def main():
    programs, machine, out, *scheduler = sys.argv[1:]
    gwatt.Machine(machine)  # A wrong machine file ends it here, once.
    found = sorted(it for it in Path(programs).rglob("*") if it.suffix.lower() in ENDINGS)
    if not found:
        sys.exit(f"there are no programs in {programs}")
    with Client(*scheduler) as client:
        work = client.map(row, [str(it) for it in found], machine_name=machine)
        rows = client.gather(work)
    with open(out, "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        table.writerows(rows)
    unread = sum("error" in it for it in rows)
    unfit = sum(it.get("fits") is False for it in rows)
    print(f"{len(rows)} programs: {len(rows) - unread - unfit} fit, {unfit} do not, {unread} not read")
    sys.exit(2 if unread else int(unfit > 0))


if __name__ == "__main__":
    main()
