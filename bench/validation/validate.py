#!/usr/bin/python3
"""The main job against the paper of 2011 and the clinic. Run by bench/validation/run."""
import argparse
import os
import sys
import time
from pathlib import Path

import numpy as np

import charts
import report
import studies
from runs import Runner

ROOT = Path(__file__).resolve().parents[2]
SWEEP = {"short": (22, 62), "long": (5, 12, 22, 35, 50, 62, 70)}
SAMPLES = 24


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--short", dest="tier", action="store_const", const="short", default="short")
    parser.add_argument("--long", dest="tier", action="store_const", const="long")
    parser.add_argument("--head", type=Path, default=ROOT / "examples/head/data/coarse")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/examples/dbs/dbs")
    parser.add_argument("--write-docs", action="store_true")
    return parser.parse_args()


def main():
    options = parse()
    out = ROOT / "out/validation"
    out.mkdir(parents=True, exist_ok=True)
    docs = ROOT / "docs" if options.write_docs else out
    pictures = docs / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    runner = Runner(str(options.program), options.head, out / "runs",
                    options.jobs)
    long = options.tier == "long"
    start = time.monotonic()
    done, refused = {}, []

    def study(name, *arguments):
        table, runs = getattr(studies, name)(runner, *arguments)
        report.write_csv(out / f"{name}.csv", table)
        done[name] = (table, runs)
        print(f"\r{name}: {len(runs)} runs, {time.monotonic() - start:.0f} s so far")
        refused.extend(key for key, run in runs.items() if run.refused)

    if long:
        study("ablation")   # first: timed, one after the other
    study("sweep", SWEEP[options.tier])
    table = studies.paper_table(done["sweep"][1])
    report.write_csv(out / "paper.csv", table)
    done["paper"] = (table, {})
    study("claims")
    if long:
        study("sensitivity")
        study("movers")
        study("uncertainty", SAMPLES)
        data = ROOT / "examples/head/data"
        study("mesh", {"coarse": data / "coarse", "medium": data / "medium",
                       "finer": ROOT / "build/head/edge-5"})
    study("clinic")
    study("posture")
    draw(done, pictures)
    report.write_page(docs / "validation.md", done, long)
    failed = [key for _, runs in done.values() for key, run in runs.items() if not run.converged]
    print(f"tables in {out}; {docs / 'validation.md'}")
    if failed:
        print(f"without a balance: {failed}")
    if refused:   # a balance that was not found is a result; a refusal is a mistake in the study
        print(f"refused: {refused}", file=sys.stderr)
    return 1 if refused or (failed and not long) else 0


def draw(done, pictures):
    charts.retraction(done["sweep"][1], pictures / "validation_retraction.png")
    claims = done["claims"][1]
    charts.stages(claims["default", "as it is"], pictures / "validation_stages.png")
    good = {preset: claims[preset, "as it is"] for preset in studies.PRESETS
            if claims[preset, "as it is"].converged}
    charts.lead(good, pictures / "validation_lead.png")
    if "sensitivity" in done:
        runs = done["sensitivity"][1]
        charts.tornado(runs, lambda r: float(np.linalg.norm(r.shift("STN_right"))),
                       "shift of the right STN", pictures / "validation_tornado_stn.png")
        charts.tornado(runs, lambda r: r.mean_retraction("tissue"), "D against tissue",
                       pictures / "validation_tornado_d.png")


if __name__ == "__main__":
    sys.exit(main())
