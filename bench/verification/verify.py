#!/usr/bin/python3
"""The library against known numbers. Run by bench/verification/run."""
import argparse
import csv
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"
PROGRAMS = ["test_verify", "test_coupling", "test_stepper", "test_mcp"]

TITLES = {   # of suites; others stand under their own name
    "ThickSphere": "Thick sphere under pressure (Lame)",
    "Manufactured": "Manufactured solution",
    "ContactPatch": "Contact patch test",
    "NeutrallyBuoyant": "Neutrally buoyant body",
    "KuhnGrid": "Bar on a grid with a direction",
    "CooksMembrane": "Cook's membrane, nearly incompressible",
}


def run(program):
    """Test name -> (passed, lines printed)."""
    text = subprocess.run([BUILD / "tests" / program], capture_output=True, text=True,
                          check=False).stdout
    found, name, lines = {}, None, []
    for line in text.split("\n"):
        if m := re.match(r"\[ RUN      \] (\S+)", line):
            name, lines = m[1], []
        elif m := re.match(r"\[ +(OK|FAILED|SKIPPED) +\] (\S+) \(", line):
            if m[2] == name:
                found[name] = (m[1], [x for x in lines if x])
            name = None
        elif name:
            lines.append(line.strip())
    return found


def head_table(name, finest):
    """The shifts of a head on refined meshes, as bench_head_accuracy prints them."""
    path = ROOT / f"out/verification/head_{name}.csv"
    if not path.is_file():
        text = subprocess.run([BUILD / "bench/bench_head_accuracy", ROOT / "examples/head/data" / name,
                               str(finest)], check=True, stdout=subprocess.PIPE, text=True).stdout
        path.write_text(text)
    with path.open() as file:
        return list(csv.DictReader(file))


def head_rows(rows):
    lines = ["| tets | refined | nodes | landmark | shift mm | off the reference mm | estimate mm | "
             "estimate / error |", "|---|---|---|---|---|---|---|---|"]
    for r in rows:
        shift = (float(r["x"]) ** 2 + float(r["y"]) ** 2 + float(r["z"]) ** 2) ** 0.5
        error, estimate = float(r["error"]), r["estimate"]
        ratio = f"{float(estimate) / error:.2f}" if estimate and error > 1e-6 else ""
        shown = f"{float(estimate):.3f}" if estimate else ""
        lines.append(f"| {r['element']} | {r['refined']} | {r['nodes']} | {r['landmark']} | {shift:.3f} | "
                     f"{error:.3f} | {shown} | {ratio} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--heads", nargs="+", choices=["coarse", "medium"], default=["coarse", "medium"])
    parser.add_argument("--write-docs", action="store_true")
    options = parser.parse_args()
    out = ROOT / "out/verification"
    out.mkdir(parents=True, exist_ok=True)
    command = "--long --heads " + " ".join(options.heads) + " --write-docs" if options.long else "--write-docs"
    page = ["# Verification", "", f"Written by `bench/verification/run {command}`: what the tests against",
            "known numbers print. Derivatives, orders and closed forms that print nothing are tests all the",
            "same; `tests/run` runs all of them."]
    failed, counts = [], []
    for program in PROGRAMS:
        suites = {}
        for name, (status, lines) in run(program).items():
            if status == "FAILED":
                failed.append(name)
            suites.setdefault(name.split(".")[0], []).append((name.split(".")[1], status, lines))
        total = sum(len(tests) for tests in suites.values())
        counts.append(f"{program}: {total} tests")
        for suite, tests in suites.items():
            if not any(lines for _, _, lines in tests):
                continue
            page += ["", f"## {TITLES.get(suite, suite)}", ""]
            for name, status, lines in tests:
                if lines:
                    page += [f"`{suite}.{name}`{'' if status == 'OK' else ': ' + status}", "", "```",
                             *lines, "```", ""]
    if options.long:
        for name in options.heads:
            page += ["", f"## The {name} head", "", "22 mL of air on both sides, no devices; the reference "
                     "is the finest quadratic solution on the same", "geometry. Extrapolated: linear tets on "
                     "both meshes, to order two (Richardson).", "", *head_rows(head_table(name, 250000))]
    print(", ".join(counts))
    target = ROOT / "docs/verification.md" if options.write_docs else out / "verification.md"
    target.write_text("\n".join(page) + "\n")
    if failed:
        print(f"failed: {failed}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
