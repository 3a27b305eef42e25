#!/usr/bin/python3
"""Times in milliseconds and yardsticks. Run by bench/speed/run."""
import argparse
import csv
import json
import os
import platform
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/bench/bench_speed"
UNIT = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}


def reference_blas():
    """Environment in which the program finds Debian's reference BLAS and LAPACK first."""
    folders = sorted(Path("/usr/lib").glob("*/blas")) + sorted(Path("/usr/lib").glob("*/lapack"))
    if len(folders) < 2:
        raise SystemExit("the reference BLAS is not here; Debian has it in libblas3 and liblapack3")
    return {**os.environ, "LD_LIBRARY_PATH": ":".join(map(str, folders))}


def measure(head, only, environment=None):
    command = [PROGRAM, ROOT / "examples/head/data" / head, "--benchmark_out_format=json",
               f"--benchmark_filter={'^yardstick|' + only if only else '.'}", "--benchmark_format=json"]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout
    result = json.loads(text)
    result["context"].pop("host_name", None)
    result["context"].pop("executable", None)
    return result


def processor():
    found = re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text())
    return found[1] if found else platform.processor()


def yardstick(result):
    """Milliseconds: the mean of before and after."""
    times = [b["real_time"] * UNIT[b["time_unit"]] for b in result["benchmarks"] if b["name"].startswith("yardstick")]
    return sum(times) / len(times)


def add_yardsticks(result, of_one):
    for b in result["benchmarks"]:
        b["milliseconds"] = b["real_time"] * UNIT[b["time_unit"]]
        b["yardsticks"] = b["milliseconds"] / of_one


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--head", choices=["coarse", "medium"], default="medium")
    parser.add_argument("--only", default="")
    parser.add_argument("--out")
    parser.add_argument("--reference-blas", action="store_true")
    parser.add_argument("--write-docs", action="store_true")
    options = parser.parse_args()
    if options.reference_blas and options.write_docs:
        parser.error("docs/speed.md is of the BLAS that is installed")
    result = measure(options.head, options.only, reference_blas() if options.reference_blas else None)
    result["context"]["processor"] = processor()
    of_medium = result if options.head == "medium" else measure("medium", "^yardstick")
    add_yardsticks(result, yardstick(of_medium))
    out = ROOT / "out/speed"
    out.mkdir(parents=True, exist_ok=True)
    name = options.out or options.head
    (out / f"{name}.json").write_text(json.dumps(result, indent=1) + "\n")
    with (out / f"{name}.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["benchmark", "milliseconds", "yardsticks"])
        writer.writerows([b["name"], b["milliseconds"], b["yardsticks"]] for b in result["benchmarks"])
    lines = table(result)
    print("\n".join(lines))
    if options.write_docs:
        page = ["# Speed", "", "Written by `bench/speed/run --write-docs`. A yardstick is one numeric factor and one",
                "solve of the stiffness of both halves of the medium head as one system, one thread, in the",
                "same run, the mean of before and after. Iterations: of Newton's method, for complementarity of the method named.", "", *lines]
        (ROOT / "docs/speed.md").write_text("\n".join(page) + "\n")


def table(result):
    c = result["context"]
    lines = [f"{c['head']}: {c['nodes']} nodes, {c['tets']} tets. {c['processor']}, {c['num_cpus']} cores; "
             f"{c['blas'].strip()}; compiler {c['compiler']}.", "",
             "| | ms | yardsticks | iterations | factors | left open |", "|---|---|---|---|---|---|"]
    for b in result["benchmarks"]:
        name = re.sub(r"/iterations:\d+|/real_time", "", b["name"])
        work = [f"{b[k]:.0f}" for k in ("iterations_of_newton", "iterations_of_method") if k in b] or [""]
        work.append(f"{b['factorisations']:.0f}" if "factorisations" in b else "")
        work.append(f"{b['left_open']:.1e}" if "left_open" in b else "")
        lines.append(f"| {name} | {b['milliseconds']:.4g} | {b['yardsticks']:.3g} | {' | '.join(work)} |")
    return lines


if __name__ == "__main__":
    main()
