#!/usr/bin/python3
"""The library beside CalculiX. Run by bench/peers/run."""
import argparse
import json
import re
import subprocess
import sys
from pathlib import Path

import calculix

ROOT = Path(__file__).resolve().parents[2]
GRAVITY = 0.05      # parts of the earth's
SMALL, LARGE = 8, 16
INCREMENTS = [1, 2, 5, 10]
ACCURACY = 1e-4     # mm, of within()
APART = 1e-6        # of the largest displacement


class Case:
    """One mesh of the bar, for both programs."""

    def __init__(self, program, out, n):
        self.program, self.out, self.n = program, out, n
        out.mkdir(parents=True, exist_ok=True)
        self.bar = self.bench("mesh", n, GRAVITY, out / f"bar_{n}")
        self.mesh = calculix.Mesh.read(out / f"bar_{n}.mesh")

    def bench(self, *words):
        run = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, check=False)
        return json.loads(run.stdout) if run.returncode == 0 else None

    def ours(self, increments):
        prefix = self.out / f"bar_{self.n}_{increments}"
        run = self.bench("solve", self.n, GRAVITY, increments, ACCURACY, prefix)
        if not run:
            return None
        u = [tuple(map(float, line.split())) for line in Path(f"{prefix}.u").read_text().splitlines()]
        return {**run, "step": str(increments), "increments": increments, "u": u}

    def theirs(self, step):
        run = calculix.run(self.out / f"calculix_{self.n}_{step}", self.mesh, self.bar, step)
        if not run:
            return None
        run["smallest_jacobian"] = min(self.jacobians(run["u"]))
        return run

    def jacobians(self, u):
        """det F of each tet."""
        rest = [tuple(map(float, p)) for p in self.mesh.nodes]
        now = [tuple(a + b for a, b in zip(p, d)) for p, d in zip(rest, u)]
        return (volume(now, tet) / volume(rest, tet) for tet in self.mesh.tets)


def volume(points, tet):
    """Six times that of a tet."""
    (a, b, c), (d, e, f), (g, h, i) = (tuple(x - y for x, y in zip(points[k], points[tet[0]])) for k in tet[1:])
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def tried(solve, steps, repeats):
    """The quickest run of each number of increments that ends in balance, tets upright; quickest first."""
    best = {}
    for step in steps:
        for _ in range(repeats):
            run = solve(step)
            if not run or not run["smallest_jacobian"] > 0.0:
                break
            if step not in best or run["seconds"] < best[step]["seconds"]:
                best[step] = run
    if not best:
        sys.exit(f"peers: none of the increments {', '.join(map(str, steps))} ends in balance with all tets upright")
    return sorted(best.values(), key=lambda run: run["seconds"])


def two_to_try(runs):
    """The quickest, and the quickest of another number of increments."""
    others = [run["step"] for run in runs if run["increments"] != runs[0]["increments"]]
    return [runs[0]["step"], *others[:1]]


def apart(a, b):
    largest = max(abs(x) for row in a for x in row)
    return max(abs(x - y) for row, other in zip(a, b, strict=True) for x, y in zip(row, other)) / largest


class Pair:
    """The best runs of both on one mesh."""

    def __init__(self, case, our_steps, their_steps, repeats):
        self.all_ours = tried(case.ours, our_steps, repeats)
        self.all_theirs = tried(case.theirs, their_steps, repeats)
        self.ours, self.theirs = self.all_ours[0], self.all_theirs[0]
        self.sag = max(abs(x) for row in self.ours["u"] for x in row)
        self.apart = apart(self.ours["u"], self.theirs["u"])
        if not self.apart <= APART:
            sys.exit(f"peers: at {self.ours['nodes']} nodes the results are {self.apart:.1e} of the largest "
                     f"displacement apart, more than {APART:.0e}")

    def whole(self):
        return self.theirs["seconds"] / self.ours["seconds"]

    def each(self):
        return each(self.theirs) / each(self.ours)

    def each_of_the_same(self):
        """As if ours were as many as theirs."""
        return min(self.each(), self.whole())


def each(run):
    return run["seconds"] / run["iterations"]


def row(nodes, program, run):
    increments = f"{run['increments']}, automatic" if run["step"] == "automatic" else run["increments"]
    return (f"| {nodes} | {program} | {increments} | {run['iterations']} | {run['factorisations']} | "
            f"{run['seconds']:.2f} | {each(run):.3f} | {run['smallest_jacobian']:.3f} |")


def tables(pairs):
    lines = ["| nodes | program | increments | Newton iterations | factors | CPU seconds | an iteration "
             "| smallest det F |",
             "|---|---|---|---|---|---|---|---|"]
    for pair in pairs:
        nodes = pair.ours["nodes"]
        for name, runs in (("libbrainshift", pair.all_ours), ("CalculiX", pair.all_theirs)):
            lines += [row(nodes, f"**{name}**" if run is runs[0] else name, run) for run in runs]
    lines += ["", "| nodes | CalculiX, times ours: whole solve | an iteration | the smaller of both "
              "| bare factor and solve, CPU seconds | results apart |", "|---|---|---|---|---|---|"]
    lines += [f"| {p.ours['nodes']} | {p.whole():.1f} | {p.each():.1f} | {p.each_of_the_same():.1f} | "
              f"{p.ours['factor_and_solve_seconds']:.3f} | {p.apart:.1e} |" for p in pairs]
    return lines


def goals(small, large):
    """What was asked for, and what came out."""
    found = [("an iteration at 3 321 nodes", small.each_of_the_same(), 3, 10),
             ("the whole solve at 23 409 nodes", large.whole(), 8, 30)]
    lines = ["| CalculiX, times ours | asked for | aim | measured | |", "|---|---|---|---|---|"]
    return lines + [f"| {what} | {least} | {aim} | {value:.1f} | {'met' if value >= least else '**missed**'} |"
                    for what, value, least, aim in found]


def page(small, large):
    version, spooles = calculix.version()
    model = re.search(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text())
    return f"""# Peers

Written by `bench/peers/run --write-docs`: the library beside CalculiX {version} (Debian's calculix-ccx, its solver
SPOOLES {spooles}) in one run, on {model[1] if model else "an unnamed processor"}.

A bar of St. Venant-Kirchhoff tissue (CalculiX: `*ELASTIC` with `NLGEOM`), 200 x 40 x 40 mm, clamped at one end,
E 6 kPa, nu 0.45, from zero to a twentieth of its weight; its end moves by {small.sag:.0f} mm in the coarser and
{large.sag:.0f} mm in the finer mesh. Both programs have the same linear tets, the same density and dead load, and one
thread. Seconds are CPU seconds of that thread: the library's from the begin of its solve to the end, with the symbolic
analysis; CalculiX' from the end of reading (`STEP 1`) to the last `convergence`. Reading and writing are in neither.

Tolerances: `within({ACCURACY:g} mm)` here, `*CONTROLS, PARAMETERS=FIELD` {calculix.FIELD} there, the loosest power of ten for
which the results agree to {APART:.0e} of the largest displacement. Tried at {small.ours['nodes']} nodes: the load in 1, 2, 5 and
10 equal increments, and CalculiX' automatic ones from the full load on, the best of three runs of each. At
{large.ours['nodes']} nodes the quickest of those, and the quickest with another number of increments, once. Bold: the quickest,
which counts. A run with a tet inside out does not count.

""" + "\n".join([*tables([small, large]), "", *goals(small, large)]) + f"""

CalculiX makes a factor in each iteration. Here the first one serves to the end, turned with the tissue: it preconditions
conjugate gradients, [theory](theory.md) (27), a few solves in each iteration. Where that takes more iterations of
Newton's method than CalculiX needs, an iteration is not counted as quicker than the whole solve. Solves wait for
memory, factors for arithmetic: a machine that is busy slows the former more.
"""


def small_alone(program, out):
    """The chain on a mesh of seconds, for the tests."""
    pair = Pair(Case(program, out, 4), [1], ["1"], 1)
    print("\n".join(tables([pair])))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write-docs", action="store_true")
    parser.add_argument("--try", dest="trial", action="store_true", help="a mesh of seconds only")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bench/bench_bar")
    parser.add_argument("--out", type=Path, default=ROOT / "out/peers")
    options = parser.parse_args()
    if options.trial:
        small_alone(options.program, options.out)
        return
    small = Pair(Case(options.program, options.out, SMALL), INCREMENTS, calculix.STEPS, 3)
    large = Pair(Case(options.program, options.out, LARGE), two_to_try(small.all_ours), two_to_try(small.all_theirs), 1)
    text = page(small, large)
    print(text)
    if options.write_docs:
        (ROOT / "docs/peers.md").write_text(text)


if __name__ == "__main__":
    main()
