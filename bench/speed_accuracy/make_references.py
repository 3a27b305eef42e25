#!/usr/bin/python3
"""Makes the references of the chart. Run by bench/speed_accuracy/make_references."""
import argparse
import sys
import time
from pathlib import Path

from cases import all_references, name_of
from measure import References, Refused, Runner

ROOT = Path(__file__).resolve().parents[2]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="references whose name holds this")
    parser.add_argument("--list", action="store_true", help="their names, nothing run")
    parser.add_argument("--missing", action="store_true", help="only those that are not there or of other inputs")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bench/bench_speed_accuracy")
    parser.add_argument("--heads", type=Path, default=ROOT / "examples/head/data")
    parser.add_argument("--references", type=Path, default=ROOT / "bench/speed_accuracy/references")
    options = parser.parse_args()
    references = References(options.references, options.heads)
    wanted = [c for c in all_references() if options.only in name_of(c)]
    if options.missing:
        wanted = [c for c in wanted if not fits(references, c)]
    if options.list:
        print("\n".join(name_of(c) for c in wanted))
        return 0
    runner = Runner(options.program, options.heads, ROOT / "out/speed_accuracy/runs")
    for case in wanted:
        begin = time.monotonic()
        run = runner.run(case)
        references.write(case, run)
        print(f"{name_of(case)}: {run['nodes']} nodes, {run['cpu_seconds']:.0f} s of CPU, "
              f"{time.monotonic() - begin:.0f} s of wall", flush=True)
    return 0


def fits(references, case):
    try:
        return bool(references.read(case))
    except (OSError, Refused):
        return False


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Refused as problem:
        sys.exit(f"make_references: {problem}")
