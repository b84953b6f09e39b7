#!/usr/bin/env python3
"""Whether what `check` promises is what `limit` does.

    benches/hints.py target/release/gwatt fanuc=FOLDER haas=FOLDER siemens=FOLDER ...

Programs and machines are those of fit-rate.py. At a share of the program's own largest peak
every hint "fits with ..." of `check` is compared with a run of `limit --allow feed,expand`:
the line must be lowered there, not refused, and an F that the hint names must be the one
that is written (the lowest, where the line makes several moves). A line of which `check`
says that no word helps must not be lowered.
"""

import argparse
import collections
import concurrent.futures
import csv
import importlib.util
import json
import pathlib
import re
import tempfile

PATH = pathlib.Path(__file__).with_name("fit-rate.py")
SPEC = importlib.util.spec_from_file_location("fit_rate", PATH)
fit_rate = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(fit_rate)

HINT = re.compile(r"fits with (?:G1 )?F([0-9.]+)")
# F is written with five digits.
ROUNDING = 1e-3
# Advice that promises what `limit` writes, and the spindle's, which no word lowers.
PROMISES = ("fits ", "by itself it fits ", "`limit --allow expand`", "a lower S")


def judge(gwatt, profile, program, share, seconds):
    """Hints that hold, and those that do not, as (line, hint, what limit does)."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        common = fit_rate.common(profile, program, folder)
        peak_w, _ = fit_rate.peak(gwatt, program, common, seconds)
        if not peak_w:
            return None
        (folder / "machine.toml").write_text(fit_rate.machine(profile, share * peak_w))
        _, out, _ = fit_rate.run([gwatt, "check", str(program), *common, "--format", "json"], seconds)
        if not out:
            return None
        found = json.loads(out)
        unfit = [it for it in found[0].get("unfit", []) if not it["file"]]
        hints = [it for it in unfit if it["help"].startswith("fits with")]
        others = [it for it in unfit if not it["help"].startswith(PROMISES)]
        rows = folder / "rows.csv"
        options = ["--allow", "feed,expand", "--report", str(rows), "-o", str(folder / "written")]
        code, _, errors = fit_rate.run([gwatt, "limit", str(program), *common, *options], seconds)
        if code not in (0, 1):
            return [], [(0, "", errors.splitlines()[0])] if hints else []
        done = collections.defaultdict(list)
        with open(rows, newline="", encoding="latin1") as file:
            for row in csv.DictReader(file):
                if row["action"] and not row["file"]:
                    done[int(row["line"])].append(row)
        good, bad = [], []
        for hint in hints:
            its = done[hint["line"]]
            if not its or any(row["action"] == "none possible" for row in its):
                bad.append((hint["line"], hint["help"], "refused" if its else "not lowered"))
                continue
            named = HINT.match(hint["help"])
            values = [float(row["value_after"]) for row in its if "F" in row["knob"].split() and row["value_after"]]
            if named and not any(abs(value / float(named[1]) - 1.0) <= ROUNDING for value in values):
                bad.append((hint["line"], hint["help"], f"F {values}"[:60]))
                continue
            good.append(hint["line"])
        for other in others:
            its = done[other["line"]]
            if its and all(row["action"] not in ("", "none possible") for row in its):
                bad.append((other["line"], other["help"], its[0]["action"]))
        return good, bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gwatt")
    parser.add_argument("folders", nargs="+", metavar="PROFILE=FOLDER")
    parser.add_argument("--share", type=float, default=0.6)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--half", choices=("tune", "rest"), help="only this half of each folder")
    given = parser.parse_args()
    jobs = fit_rate.programs(given.folders, given.half)
    work = lambda job: (job, judge(given.gwatt, job[0], job[1], given.share, given.seconds))
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        results = list(pool.map(work, jobs))
    counts = collections.defaultdict(collections.Counter)
    for (profile, file), found in results:
        if found is None:
            continue
        good, bad = found
        counts[profile].update(true=len(good), false=len(bad))
        for line, hint, what in bad:
            print(f"{profile} {file}:{line}: {hint} / {what}")
    for profile, found in sorted(counts.items()):
        print(f"{profile:14} {found['true']:6} hints come true, {found['false']:4} do not")


if __name__ == "__main__":
    main()
