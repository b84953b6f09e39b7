#!/usr/bin/env python3
"""What LinuxCNC's interpreter makes of programs before and after `limit`.

    benches/canon.py target/release/gwatt linuxcnc=FOLDER linuxcnc=FOLDER ...

Each program is limited for a converter of a share of its own largest peak (0.6 unless given)
and read by `rs274` before and after. Its canonical calls must be the same: end points, arcs,
dwells, spindle, coolant, tools and outputs. Three things may differ: a path mode that is
exact stop where it was not (or another before a dwell), a dwell of no time, and a rapid that
became a feed; lines of no length are passed over. No feed may
be higher. Needs rs274 (Debian: linuxcnc-uspace) on the path.
"""

import argparse
import collections
import concurrent.futures
import importlib.util
import json
import pathlib
import re
import subprocess
import tempfile

here = pathlib.Path(__file__).resolve().parent
spec = importlib.util.spec_from_file_location("fit_rate", here / "fit-rate.py")
fit_rate = importlib.util.module_from_spec(spec)
spec.loader.exec_module(fit_rate)

CALL = re.compile(r"^\s*\d+\s+N(?:\.+|\d*)\s*([A-Za-z_0-9]+)\((.*)\)\s*$")
MOVES = {"STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED", "NURBS_FEED", "STRAIGHT_PROBE", "RIGID_TAP"}
OFFSETS = {"SET_G5X_OFFSET", "SET_G92_OFFSET", "SET_XY_ROTATION", "USE_TOOL_LENGTH_OFFSET"}
# Moves that obey F.
FED = {"STRAIGHT_FEED", "ARC_FEED", "NURBS_FEED", "STRAIGHT_PROBE"}
# What says nothing of the motion, or only how it is run.
PASSED = {"COMMENT", "MESSAGE", "SET_FEED_RATE", "SET_FEED_MODE", "SET_MOTION_CONTROL_MODE", "SET_NAIVECAM_TOLERANCE",
          "SELECT_PLANE", "USE_LENGTH_UNITS"}
# rs274 prints four decimals.
TOLERANCE = 0.00011
MM_PER_INCH = 25.4
# Said after the whole of a program; LinuxCNC runs it.
NO_END = b"File ended with no percent sign or program end"
# The work offsets of fit-rate.py's machines, G54 to G59; rs274 by itself counts in inches.
KEPT_PARAMETERS = "".join(
    f"{5221 + 20 * (n - 4) + axis}\t{value / 25.4!r}\n"
    for n in range(4, 10)
    for axis, value in enumerate((-100 * n, -250, -400))
)


def numbers(text):
    return [float(word) for word in re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", text)]


def interpret(program, tools):
    """Canonical calls, each with the feed, the path mode, units and plane in force; None if
    rs274 does not read the program to its end."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "kept.var").write_text(KEPT_PARAMETERS)
        (folder / "tools.tbl").write_text(tools)
        place = program.resolve().parent
        (folder / "rs274.ini").write_text(
            f"[RS274NGC]\nSUBROUTINE_PATH = {place}\nPARAMETER_FILE = kept.var\n[DISPLAY]\nPROGRAM_PREFIX = {place}\n")
        command = ["rs274", "-g", "-n", "2", "-i", folder / "rs274.ini", "-t", folder / "tools.tbl",
                   "-v", folder / "kept.var", program.resolve()]
        try:
            # Tool data are shared through a file under the home folder.
            found = subprocess.run(command, capture_output=True, timeout=120, check=False, cwd=folder,
                                   stdin=subprocess.DEVNULL, env={"HOME": str(folder), "PATH": "/usr/bin:/bin"})
        except subprocess.TimeoutExpired:
            return None
        if found.returncode != 0 and NO_END not in found.stderr:
            return None
    # Before the first word for it paths are blended.
    calls, feed, mode, unit, plane = [], 0.0, "CANON_CONTINUOUS, 0.000000", "", ""
    at, lengths = None, [0.0] * 9
    for line in found.stdout.decode("latin1").splitlines():
        match = CALL.match(line)
        if not match:
            continue
        name, argument = match.groups()
        if name == "SET_FEED_RATE":
            feed = numbers(argument)[0]
        elif name == "SET_MOTION_CONTROL_MODE":
            mode = argument
        elif name == "USE_LENGTH_UNITS":
            unit = argument
        elif name == "SELECT_PLANE":
            plane = argument
        if name == "DWELL" and numbers(argument) == [0.0]:
            if calls:
                calls[-1] = (*calls[-1][:-1], True)
            continue
        if name in PASSED:
            continue
        if name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            # Where a line ends at which the axes are already, nothing moves.
            end = numbers(argument)
            if at and all(abs(a - b) <= TOLERANCE for a, b in zip(end, at)):
                continue
            at = end
        elif name == "ARC_FEED":
            at = arc_end(numbers(argument), plane)
        elif name == "USE_TOOL_LENGTH_OFFSET":
            # The axes stay, their coordinates do not.
            lengths, before = numbers(argument), lengths
            at = at and [place + old - new for place, old, new in zip(at, before, lengths)]
        elif name in MOVES or name in OFFSETS:
            at = None
        calls.append((name, argument, feed, mode, unit, plane, False))
    return calls


def arc_end(values, plane):
    """Where an arc ends: X, Y, Z, A, B, C."""
    first, second, _, _, _, third, *rotary = values
    if plane.endswith("YZ"):
        return [third, first, second, *rotary[:3]]
    if plane.endswith("XZ"):
        return [second, third, first, *rotary[:3]]
    return [first, second, third, *rotary[:3]]


def difference(before, after):
    """The first difference of two lists of calls; None where there is none."""
    for place, (was, now) in enumerate(zip(before, after)):
        turned = was[0] == "STRAIGHT_TRAVERSE" and now[0] == "STRAIGHT_FEED"
        if was[0] != now[0] and not turned:
            return f"call {place}: {was[:2]} became {now[:2]}"
        if was[4:6] != now[4:6]:
            return f"call {place}: units or plane of {was} became those of {now}"
        if was[1] != now[1]:
            values = [numbers(argument) for argument in (was[1], now[1])]
            far = len(values[0]) != len(values[1]) or not values[0]
            if far or any(abs(a - b) > TOLERANCE for a, b in zip(*values)):
                return f"call {place}: {was[:2]} became {now[:2]}"
        if was[0] in MOVES:
            if was[0] in FED and not turned and now[2] > was[2] * (1.0 + 1e-6) + 1e-4:
                return f"call {place}: the feed of {was[:2]} went up from {was[2]} to {now[2]}"
            # A line that ends at rest is the same in every mode.
            stops = "EXACT_STOP" in now[3] or now[6] and was[0] != "ARC_FEED"
            if was[3] != now[3] and not stops:
                return f"call {place}: the path mode of {was[:2]} was {was[3]} and is {now[3]}"
    if len(before) != len(after):
        longer = (before if len(before) > len(after) else after)[min(len(before), len(after))]
        return f"{len(before)} calls became {len(after)}: {longer[:2]}"
    return None


def judge(gwatt, profile, program, share, options, seconds):
    """What became of a program, and a reason where there is one."""
    tools_mm = "".join(f"T{n} P{n} Z{10 + n}.0 D6.0\n" for n in range(1, 100))
    tools_inch = "".join(f"T{n} P{n} Z{(10 + n) / MM_PER_INCH:.9f} D{6 / MM_PER_INCH:.9f}\n" for n in range(1, 100))
    before = interpret(program, tools_inch)
    if before is None:
        return "not read by rs274", ""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        file, tools = folder / "machine.toml", folder / "tools.tbl"
        tools.write_text(tools_mm)
        file.write_text(fit_rate.machine(profile, 1e9))
        common = ["-m", str(file), "--sub-path", str(program.resolve().parent), "--tool-table", str(tools)]
        code, out, _ = fit_rate.run([gwatt, "check", str(program), *common, "--format", "json"], seconds)
        if code != 0:
            return "not read by gwatt", ""
        found = json.loads(out)
        found = found[0] if isinstance(found, list) else found
        peak_w = found.get("peak_w") or 0.0
        if peak_w <= 0.0:
            return "nothing to limit", ""
        file.write_text(fit_rate.machine(profile, share * peak_w))
        with tempfile.TemporaryDirectory() as output:
            written = pathlib.Path(output) / program.name
            code, _, errors = fit_rate.run([gwatt, "limit", str(program), *common, *options, "-o", str(written)], seconds)
            if code != 0:
                return "refused", (errors.strip().splitlines() or [""])[0][:100]
            # Subprograms stand next to the original.
            for other in program.resolve().parent.iterdir():
                if other.is_file() and other.suffix == ".ngc" and not (written.parent / other.name).exists():
                    (written.parent / other.name).symlink_to(other)
            after = interpret(written, tools_inch)
        if after is None:
            return "DIFFERS", "what was written is not read by rs274"
        found = difference(before, after)
        return ("DIFFERS", found) if found else ("same", "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gwatt")
    parser.add_argument("folders", nargs="+", metavar="PROFILE=FOLDER")
    parser.add_argument("--allow", default="feed,expand")
    parser.add_argument("--share", type=float, default=0.6)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=60.0)
    given = parser.parse_args()
    options = ["--allow", given.allow] if given.allow else []
    jobs = []
    for pair in given.folders:
        profile, folder = pair.split("=", 1)
        jobs += [(profile, file) for file in sorted(pathlib.Path(folder).rglob("*")) if file.is_file()]
    work = lambda job: judge(given.gwatt, *job, given.share, options, given.seconds)
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        results = list(pool.map(work, jobs))
    counts = collections.Counter(outcome for outcome, _ in results)
    for (_, file), (outcome, why) in zip(jobs, results):
        if why:
            print(f"{outcome}: {file}: {why}")
    for outcome, count in counts.most_common():
        print(f"{count:5} {outcome}")
    raise SystemExit(1 if counts["DIFFERS"] else 0)


if __name__ == "__main__":
    main()
