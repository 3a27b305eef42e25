#!/usr/bin/python3
"""The chart of speed against accuracy. Run by bench/speed_accuracy/run."""
import argparse
import csv
import json
import platform
import re
import sys
import time
from pathlib import Path

import cases
import chart
import page
from measure import References, Refused, Runner, differences, judge, largest

ROOT = Path(__file__).resolve().parents[2]
BUDGET = 30 * 60   # s of wall, on two cores that nothing else uses
LIMIT = 120        # s of wall for one case; what takes longer is given up, and the page says so


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--coarse", action="store_true")
    parser.add_argument("--write-docs", action="store_true")
    parser.add_argument("--draw-only", action="store_true")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bench/bench_speed_accuracy")
    parser.add_argument("--heads", type=Path, default=ROOT / "examples/head/data")
    parser.add_argument("--references", type=Path, default=ROOT / "bench/speed_accuracy/references")
    parser.add_argument("--out", type=Path, default=ROOT / "out/speed_accuracy")
    options = parser.parse_args()
    if options.coarse and options.write_docs:
        parser.error("the documents show the whole chart: --write-docs without --coarse")
    return options


def processor():
    found = re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text())
    return found[1] if found else platform.processor()


def measure(options, runner, references):
    """Points of the ladder and of the factors, one after the other: they are timed. And what is not measured yet."""
    begin = time.monotonic()
    heads, scenes = (["coarse"], ["csf_loss"]) if options.coarse else (cases.HEADS, list(cases.SCENES))
    ladder = cases.ladder(heads, scenes, cases.SHORT if options.coarse else None)
    wanted = {} if options.coarse else cases.FACTORS
    for case in [*(c for _, c in ladder), *(c for pairs in wanted.values() for _, c in pairs)]:
        references.of(case)   # one that does not fit is refused before anything is run
    points, missing = [], []

    def judged(case, name):
        if options.draw_only and not runner.has(case):
            missing.append(f"{case['head']} head, {cases.SCENES[case['scene']]}: {name}")
            return []
        return [judge(case, runner, references, not options.draw_only)]

    for i, (rung, case) in enumerate(ladder):
        for found in judged(case, rung.name):
            points.append({"rung": rung.name, "family": rung.family, **found})
            print(f"{time.monotonic() - begin:5.0f} s of {BUDGET}: {i + 1} of {len(ladder)}, {case['head']}, {case['scene']}, "
                  f"{rung.name}: {page.brief(found)}", flush=True)
    factors = {name: [{"value": value, **found} for value, case in pairs for found in judged(case, f"{name} {value:g}")]
               for name, pairs in wanted.items()}
    print(f"{time.monotonic() - begin:.0f} s in all")
    return points, {name: rows for name, rows in factors.items() if rows}, missing


def context_of(points, factors, runner, references):
    rows = [*points, *(r for some in factors.values() for r in some)]
    yardsticks = sorted(r["yardstick"] for r in rows if "yardstick" in r)
    used, remarks = {}, []
    for case in cases.all_references():
        if references.path(case).is_file() and cases.name_of(case) in {r.get("reference") for r in rows}:
            used[cases.name_of(case)] = references.read(case)
    finest = cases.references_of(cases.DEFAULT)
    if len(finest) > 1 and all(references.path(c).is_file() for c in finest):
        fine, own = (references.read(c) for c in finest)
        off, stage, probe = largest(differences(fine, own))
        remarks.append(f"On the coarse head, CSF loss, quadratic tets on its own mesh are {off:.3f} mm off those on its "
                       f"refinement ({probe}, stage {stage}): so much, or less on the medium head, may any *own* reference "
                       "be off itself.")
    both = [cases.references_of({**cases.DEFAULT, "head": head})[-1] for head in cases.HEADS]
    if all(references.path(c).is_file() for c in both):
        remarks.append(heads_apart(*(references.read(c) for c in both)))
    run = runner.run(next(p["case"] for p in points if p["converged"]))
    return {"yardstick": yardsticks[len(yardsticks) // 2], "processor": processor(), "points": len(run["probes"]),
            "air": run["air_mL"], "references": used, "remarks": remarks}


def heads_apart(coarse, medium):
    """Points inside tissue are the same in both heads; those on the surface are not."""
    same = [p["name"] for p in coarse["probes"] if p["kind"] in ("STN", "track")]
    both = [{**r, "probes": [p for p in r["probes"] if p["name"] in same],
             "stages": [{**s, "shift_mm": {k: v for k, v in s["shift_mm"].items() if k in same}} for s in r["stages"]]}
            for r in (coarse, medium)]
    names = [set(r["stages"][0]["shift_mm"]) for r in both]
    for r in both:
        for s in r["stages"]:
            s["shift_mm"] = {k: v for k, v in s["shift_mm"].items() if k in names[0] & names[1]}
    off, stage, probe = largest(differences(*both))
    return (f"The two heads are two geometries of one brain. Their references differ by up to {off:.3f} mm at the "
            f"nuclei and along the tracks ({probe}, stage {stage}, CSF loss): no rung removes that.")


def write_table(path, points):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "head", "rung", "yardsticks", "cpu_seconds", "wall_seconds", "error_mm", "probe", "stage",
                         "off_exact_mm", "reference"])
        writer.writerows([p["case"]["scene"], p["case"]["head"], p["rung"], p.get("yardsticks", ""), p.get("cpu", ""),
                          p.get("wall", ""), p.get("error", ""), p.get("probe", ""), p.get("stage", ""), p.get("off_exact", ""),
                          p.get("reference", "")] for p in points)


def main():
    options = parse()
    runner = Runner(options.program, options.heads, options.out / "runs", LIMIT)
    references = References(options.references, options.heads)
    points, factors, missing = measure(options, runner, references)
    folder = ROOT / "docs/charts" if options.write_docs else options.out
    folder.mkdir(parents=True, exist_ok=True)
    chart.draw([p for p in points if "error" in p], factors, [folder / "speed_accuracy.svg", folder / "speed_accuracy.png"])
    write_table(options.out / "points.csv", points)
    (options.out / "points.json").write_text(json.dumps({"points": points, "factors": factors}, indent=1) + "\n")
    context = context_of(points, factors, runner, references)
    context["missing"] = missing
    (folder / "speed_accuracy.md").write_text(page.text(points, factors, context,
                                                        " --coarse" if options.coarse else " --write-docs"))
    print(folder / "speed_accuracy.md")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Refused as problem:
        sys.exit(f"speed_accuracy: {problem}")
