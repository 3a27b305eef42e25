#!/usr/bin/python3
"""How far the methods go: runs each axis, draws its chart, tabulates. Run by bench/stability/run."""
import argparse
import csv
import subprocess
import sys
import time
from pathlib import Path

import calculix
import charts
import page

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/bench/bench_stability"
AXES = ["compression", "poisson", "load_steps", "time_steps", "stiffness", "devices_on_one_track",
        "repeated_rows", "repeated_rows_by_siconos"]


def run(axis, out):
    """Other people's solvers may end the process: what is there then stays."""
    begin = time.monotonic()
    path = out / f"{axis}.csv"
    with path.open("w") as file:
        status = subprocess.run([PROGRAM, axis], stdout=file, stderr=subprocess.DEVNULL, check=False)
    print(f"{axis}: {time.monotonic() - begin:.0f} s", flush=True)
    if status.returncode != 0 and axis != "repeated_rows_by_siconos":
        sys.exit(f"{axis} ended with {status.returncode}")


def run_calculix(rows, out):
    begin = time.monotonic()
    if calculix.there():
        statuses = calculix.run_all(PROGRAM, rows, out)
        print(f"CalculiX: {time.monotonic() - begin:.0f} s, {dict(statuses)}", flush=True)
    else:
        for axis, columns in calculix.COLUMNS.items():
            (out / f"{axis}_by_calculix.csv").write_text(",".join(columns) + "\n")
        print("no CalculiX (cmake/install-deps.sh peers): the charts are without it", flush=True)


def rows_of(path):
    """Without the lines that Siconos prints in between."""
    with path.open() as file:
        return [r for r in csv.DictReader(file) if None not in r.values()]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write-docs", action="store_true")
    parser.add_argument("--draw-only", action="store_true")
    parser.add_argument("--calculix-only", action="store_true")
    options = parser.parse_args()
    out = ROOT / "out/stability"
    docs = ROOT / "docs" if options.write_docs else out
    folder = docs / "charts"
    out.mkdir(parents=True, exist_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    if not (options.draw_only or options.calculix_only):
        for axis in AXES:
            run(axis, out)
    rows = {axis: rows_of(out / f"{axis}.csv") for axis in AXES}
    if not options.draw_only:
        run_calculix(rows, out)
    theirs = {axis: rows_of(out / f"{axis}_by_calculix.csv") for axis in calculix.COLUMNS}
    for axis in AXES[:5]:
        more = [theirs[axis]] if axis in theirs else []
        getattr(charts, axis)(rows[axis], *more, folder / f"stability_{axis}.svg")
    siconos = rows["repeated_rows_by_siconos"]
    charts.repeated(rows["devices_on_one_track"], rows["repeated_rows"],
                    [] if page.absent(siconos) else siconos, folder / "stability_repeated_ties.svg")
    (docs / "stability.md").write_text(page.text(rows, theirs))


if __name__ == "__main__":
    main()
