#!/usr/bin/env python3
"""How many real programs `limit` can make fit, by control.

    benches/fit-rate.py target/release/gwatt fanuc=FOLDER haas=FOLDER siemens=FOLDER ...

Each program is read with a machine that suits its control: linear rapids, the control's
own path modes, known reference points, work offsets and tools, a converter of 60 % and of
80 % of the program's own largest peak, no margin. Printed are, by control and share, how
many programs are certified, and why the others are not, by the rules that refuse them.
With --rapids-only nothing but rapids may be lowered, and only programs count of which all
else fits.
"""

import argparse
import collections
import concurrent.futures
import csv
import hashlib
import json
import pathlib
import subprocess
import tempfile

PRINTERS = {"marlin", "klipper", "reprap"}
LATHES = {"fanuc-lathe", "fanuc-lathe-b", "haas-lathe", "okuma-lathe"}
# Controls that return to reference points of the machine, from places that offsets and tool
# lengths make known.
MILLS = {"fanuc", "haas", "mitsubishi", "mazak", "syntec", "iso"}
# Those whose reference points are kept in the control, from places that offsets make known.
KEPT = {"grbl", "linuxcnc"}
OFFSETS = "".join(f"G5{n} = {{ X = -{100 * n}, Y = -250, Z = -400 }}\n" for n in range(4, 10))
POINTS = "".join(f"{word} = {{ X = 0, Y = 0, Z = 0 }}\n" for word in ("G28", "G30"))
LATHE_OFFSETS = "".join(f"G5{n} = {{ X = -150, Z = {-100 * n} }}\n" for n in range(4, 10))
TOOLS = "".join(f"T{n} P{n} Z{50 + n}\n" for n in range(1, 1000))
# Rapid in mm/min or deg/min, acceleration in mm/s² or deg/s², mass or inertia, friction.
MILL = {"X": (30000, 4000, 600, 500), "Y": (30000, 4000, 700, 500), "Z": (30000, 4000, 500, 700)}
PRINTER = {"X": (12000, 3000, 0.5, 2), "Y": (12000, 3000, 1.2, 3), "Z": (900, 100, 2, 5), "E": (3000, 3000, 0.2, 5)}
LATHE = {"X": (20000, 6000, 150, 250), "Z": (24000, 6000, 250, 400)}
ROTARY = {"A": (9000, 600, 5, 20), "B": (9000, 600, 5, 20), "C": (9000, 600, 3, 15)}


def machine(profile, peak_w):
    """A machine file for a profile."""
    if profile in PRINTERS:
        axes, rotary, rest = PRINTER, {}, "[path]\nrapid = \"linear\"\n"
    elif profile in LATHES:
        axes, rotary, rest = LATHE, {}, "[path]\nrapid = \"linear\"\n"
    else:
        axes, rotary, rest = MILL, ROTARY, "[path]\nrapid = \"linear\"\n"
    text = f'schema = 1\nname = "fit rate"\ncontroller = "{profile}"\n{rest}'
    text += f"[converter]\npeak_power_w = {peak_w!r}\n[limits]\nmargin = 0.0\n"
    if profile == "siemens":
        text += "[language]\npower_on_feed_mm_min = 1000\n"
    if profile in MILLS | LATHES:
        text += "[language]\n"
        if profile != "iso":
            text += 'decimal_point = "calculator"\n'
        text += 'units = "mm"\n'
    if profile in LATHES:
        text += "escape_mm = 1\ngroove_return_mm = 1\n"
    if profile in MILLS | KEPT:
        text += "[offsets]\n" + OFFSETS
    if profile in KEPT:
        text += POINTS
    if profile in LATHES:
        text += "[offsets]\n" + LATHE_OFFSETS
    for name, (rapid, accel, mass, friction) in axes.items():
        text += f"[axes.{name}]\nrapid_mm_min = {rapid}\naccel_mm_s2 = {accel}\nmass_kg = {mass}\ncoulomb_n = {friction}\n"
        if profile in MILLS | LATHES | KEPT:
            text += "reference_mm = 0\n"
        if profile in PRINTERS and name != "E":
            text += f"reference_mm = 0\nreference_mm_min = {min(rapid, 3000)}\n"
    for name, (rapid, accel, inertia, friction) in rotary.items():
        text += f'[axes.{name}]\nkind = "rotary"\nrapid_deg_min = {rapid}\naccel_deg_s2 = {accel}\ninertia_kg_m2 = {inertia}\nfriction_nm = {friction}\n'
    return text


def half(file):
    """"tune" or "rest", by the file's name: what is worked on and what is looked at once."""
    return "tune" if hashlib.sha256(file.name.encode()).digest()[0] % 2 == 0 else "rest"


def run(arguments, seconds):
    try:
        found = subprocess.run(arguments, capture_output=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return -1, "", "took too long"
    return found.returncode, found.stdout.decode("latin1"), found.stderr.decode("latin1")


def common(profile, program, folder):
    """The arguments that all commands get; the machine file has no limit yet."""
    file = folder / "machine.toml"
    file.write_text(machine(profile, 1e9))
    arguments = ["-m", str(file), "--sub-path", str(program.resolve().parent)]
    if profile in MILLS | LATHES:
        tools = folder / "tools.tbl"
        tools.write_text(TOOLS)
        arguments += ["--tool-table", str(tools)]
    return arguments


def peak(gwatt, program, arguments, seconds):
    """The largest peak of a program, W; `None` and why where it cannot be read."""
    code, out, errors = run([gwatt, "check", str(program), *arguments, "--format", "json"], seconds)
    if code != 0:
        return None, errors
    found = json.loads(out)
    return found[0].get("peak_w") or 0.0, ""


def largest_feed(gwatt, program, arguments, folder, seconds):
    """The largest peak of all moves but rapids, W."""
    rows = folder / "rows.csv"
    run([gwatt, "report", str(program), *arguments, "--csv", str(rows)], seconds)
    if not rows.exists():
        return float("inf")
    with rows.open(encoding="latin1") as lines:
        peaks = [float(row["peak_w"]) for row in csv.DictReader(lines) if row["move"] != "rapid"]
    return max(peaks, default=0.0)


def programs(folders, which):
    """(profile, file) of all programs of PROFILE=FOLDER, or of one half of them."""
    found = []
    for pair in folders:
        profile, folder = pair.split("=", 1)
        files = [file for file in sorted(pathlib.Path(folder).rglob("*")) if file.is_file()]
        found += [(profile, file) for file in files if which in (None, half(file))]
    return found


def judge(gwatt, profile, program, shares, options, rapids_only, seconds):
    """By share: "certified", "fits", "unread", or the rules that refuse it."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        file = folder / "machine.toml"
        arguments = common(profile, program, folder)
        peak_w, _ = peak(gwatt, program, arguments, seconds)
        if peak_w is None:
            return {share: "unread" for share in shares}
        feed_w = largest_feed(gwatt, program, arguments, folder, seconds) if rapids_only else 0.0
        results = {}
        for share in shares:
            if peak_w <= 0.0 or feed_w > share * peak_w:
                results[share] = "fits"
                continue
            file.write_text(machine(profile, share * peak_w))
            written = folder / "written"
            code, _, errors = run([gwatt, "limit", str(program), *arguments, *options, "-o", str(written)], seconds)
            if code == 0:
                results[share] = "certified"
            else:
                rules = [line.split("]:", 1)[1].strip() for line in errors.splitlines() if line.startswith("error[")]
                results[share] = "; ".join(sorted(set(rules))) or errors.strip().splitlines()[0][:100]
        return results


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gwatt")
    parser.add_argument("folders", nargs="+", metavar="PROFILE=FOLDER")
    parser.add_argument("--allow", default="feed")
    parser.add_argument("--shares", default="0.6,0.8")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--half", choices=("tune", "rest"), help="only this half of each folder")
    parser.add_argument("--rapids-only", action="store_true")
    parser.add_argument("--list", action="store_true", help="name every program that is refused")
    given = parser.parse_args()
    shares = [float(share) for share in given.shares.split(",")]
    options = ["--allow", given.allow] if given.allow and not given.rapids_only else []
    jobs = programs(given.folders, given.half)
    work = lambda job: (job, judge(given.gwatt, job[0], job[1], shares, options, given.rapids_only, given.seconds))
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        results = list(pool.map(work, jobs))
    table = collections.defaultdict(collections.Counter)
    reasons = collections.defaultdict(collections.Counter)
    for (profile, file), found in results:
        for share, outcome in found.items():
            if outcome == "fits":
                continue
            kind = outcome if outcome in ("certified", "unread") else "refused"
            table[profile, share][kind] += 1
            if kind == "refused":
                reasons[profile][outcome] += 1
                if given.list:
                    print(f"{profile} {share} {file}: {outcome}")
    print(f"{'control':14} {'share':>5} {'certified':>9} {'refused':>8} {'unread':>7}  rate")
    whole = collections.Counter()
    for (profile, share), counts in sorted(table.items()):
        whole.update(counts)
        read = counts["certified"] + counts["refused"]
        rate = f"{100 * counts['certified'] / read:.0f} %" if read else "-"
        print(f"{profile:14} {share:5} {counts['certified']:9} {counts['refused']:8} {counts['unread']:7}  {rate}")
    read = whole["certified"] + whole["refused"]
    print(f"all: {whole['certified']} of {read} certified ({100 * whole['certified'] / max(read, 1):.0f} %)")
    for profile, counts in sorted(reasons.items()):
        for outcome, count in counts.most_common(8):
            print(f"  {profile}: {count} × {outcome[:160]}")


if __name__ == "__main__":
    main()
