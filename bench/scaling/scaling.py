#!/usr/bin/python3
"""Runs every case in a process of its own, and writes table and chart. Run by bench/scaling/run."""
import argparse
import hashlib
import json
import os
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


class Runner:
    """Runs cases, each once for a program; every run holds the yardstick that was taken next before it."""

    def __init__(self, program, folder):
        self.program, self.folder, self.yardstick = program, folder, None
        self.build = hashlib.sha256(program.read_bytes()).hexdigest()
        folder.mkdir(parents=True, exist_ok=True)

    def solve(self, case):
        done = subprocess.run([self.program, ROOT / "examples/head/data", json.dumps(case)], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{json.dumps(case)}: {done.stderr.strip()}")
        return {"case": case, **json.loads(done.stdout)}

    def run(self, case):
        name = hashlib.sha256((self.build + json.dumps(case, sort_keys=True)).encode()).hexdigest()[:16]
        kept = self.folder / f"{name}.json"
        if not kept.is_file():
            begin = time.monotonic()
            self.yardstick = self.yardstick or self.solve({"scene": "yardstick"})["cpu_seconds"]
            run = {**self.solve(case), "yardstick": self.yardstick, "load": os.getloadavg()[0]}
            kept.write_text(json.dumps(run, indent=1) + "\n")
            print(f"{json.dumps(case)}: {time.monotonic() - begin:.1f} s", flush=True)
        return json.loads(kept.read_text())


def measure(runner, series):
    results = {}
    for name, cases in series.items():
        runner.yardstick = None   # what else the machine does may have changed
        results[name] = [runner.run(case) for case in cases]
    rows = [row for some in results.values() for row in some]
    unit = statistics.median(row["yardstick"] for row in rows)
    for row in rows:
        row["yardsticks"] = row["cpu_seconds"] / unit
    return {"series": results, "yardstick": unit, "load": max(row["load"] for row in rows)}


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
    result = measure(Runner(options.program, options.out / "runs"), SHORT if options.short else FULL)
    result["processor"], result["cores"] = processor(), os.cpu_count()
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
