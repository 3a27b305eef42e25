#!/usr/bin/python3
"""Runs every case in a process of its own, and writes table and chart. Run by bench/scaling/run."""
import argparse
import json
import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

import chart
import page
from cases import FULL, SHORT

ROOT = Path(__file__).resolve().parents[2]


def solve(program, case):
    done = subprocess.run([program, ROOT / "examples/head/data", json.dumps(case)], capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        sys.exit(f"{json.dumps(case)}: {done.stderr.strip()}")
    return {"case": case, **json.loads(done.stdout)}


def measure(program, series):
    """name -> rows; every one with the yardstick taken beside it."""
    results, yardsticks = {}, []
    yardstick = lambda: yardsticks.append(solve(program, {"scene": "yardstick"})["cpu_seconds"])
    yardstick()
    for name, cases in series.items():
        results[name] = []
        for case in cases:
            begin = time.monotonic()
            results[name].append(solve(program, case))
            print(f"{name}: {json.dumps(case)}: {time.monotonic() - begin:.1f} s", flush=True)
        yardstick()
    unit = statistics.median(yardsticks)
    for rows in results.values():
        for row in rows:
            row["yardsticks"] = row["cpu_seconds"] / unit
    return {"series": results, "yardstick": unit, "yardsticks": yardsticks}


def processor():
    found = re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text())
    return found[1] if found else "unknown processor"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--write-docs", action="store_true")
    parser.add_argument("--out", type=Path, default=ROOT / "out/scaling")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bench/bench_scaling")
    options = parser.parse_args()
    if options.short and options.write_docs:
        parser.error("the page is written from the full run: leave out --short or --write-docs")
    result = measure(options.program, SHORT if options.short else FULL)
    result["processor"] = processor()
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "scaling.json").write_text(json.dumps(result, indent=1) + "\n")
    docs = ROOT / "docs"
    text = page.text(result)
    (docs / "scaling.md" if options.write_docs else options.out / "scaling.md").write_text(text)
    charts = docs / "charts" if options.write_docs else options.out / "charts"
    charts.mkdir(exist_ok=True)
    chart.draw(result["series"], [charts / "scaling.svg", charts / "scaling.png"])
    print(text)


if __name__ == "__main__":
    main()
