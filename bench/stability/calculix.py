"""The axes by CalculiX: decks written by bench_stability, a run of each, how far it gets."""
import csv
import os
import re
import shutil
import subprocess
from collections import Counter

import numpy as np

LOAD = 0.8          # full pressure of the compression decks, over Young's modulus
HEAD = 40.0         # mm; the bar ends and its head begins
SECONDS = 120.0     # for one run
LAW = "st_venant_kirchhoff"
COLUMNS = {
    "compression": ["bar", "element", "stretch", "load", "jacobian", "inverted_at", "iterations", "status"],
    "poisson": ["element", "below_half", "error", "iterations", "status"],
    "load_steps": ["element", "load", "calls", "iterations", "off_mm", "status"]}


def there():
    return shutil.which("ccx") is not None


def decks(program):
    """name -> deck, from what the program prints."""
    text = subprocess.run([program, "calculix_decks"], stdout=subprocess.PIPE, text=True, check=True).stdout
    parts = re.split(r"^\*\* deck (.+)\n", text, flags=re.M)
    return dict(zip(parts[1::2], parts[2::2]))


class Result:
    """One run. times: parts of the load in balance, with displacements at the nodes."""

    def __init__(self, folder, deck):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "case.inp").write_text(deck)
        (folder / "case.dat").unlink(missing_ok=True)
        threads = {"OMP_NUM_THREADS": "1", "CCX_NPROC_EQUATION_SOLVER": "1"}
        try:
            said = subprocess.run(["ccx", "case"], cwd=folder, env={**os.environ, **threads}, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, errors="replace", timeout=SECONDS,
                                  check=False).stdout
        except subprocess.TimeoutExpired:
            said = "*ERROR: out of time"
        if "reading the\n        input deck" in said:
            raise RuntimeError(f"CalculiX cannot read {folder / 'case.inp'}; run ccx there to see why")
        self.iterations = len(re.findall(r"^\s*iteration \d+\s*$", said, re.M))
        self.finished = "Job finished" in said and "*ERROR" not in said
        self.nodes, self.tets = mesh_of(deck)
        data = folder / "case.dat"
        self.times, self.u = tables(data.read_text() if data.is_file() else "")

    def smallest_jacobian(self, u):
        """Least det F, at the corners of the tets; it is the same all over a linear one."""
        x = self.nodes + u
        return min(float(j) for at in gradients(self.tets.shape[1])
                   for j in np.linalg.det(jacobian(x, self.tets, at)) / np.linalg.det(jacobian(self.nodes, self.tets, at)))

    def at(self, point, u):
        """Displacement at a point that is a node, or lies halfway between two corners of one tet."""
        apart = np.abs(self.nodes - point).max(axis=1)
        if apart.min() < 1e-9:
            return u[apart.argmin()]
        for i in range(4):
            for j in range(i):
                middle = 0.5 * (self.nodes[self.tets[:, i]] + self.nodes[self.tets[:, j]])
                near = np.abs(middle - point).max(axis=1)
                if near.min() < 1e-9:
                    tet = self.tets[near.argmin()]
                    return 0.5 * (u[tet[i]] + u[tet[j]])
        raise ValueError(f"no node and no edge at {point}")


def block(deck, keyword):
    """Rows of numbers that follow the lines with a keyword."""
    rows = []
    for match in re.finditer(rf"^\*{keyword}(?:,.*)?\n((?:[^*].*\n)*)", deck, re.M):
        rows += [line.split(",") for line in match[1].splitlines()]
    return rows


def mesh_of(deck):
    """Nodes, and tets from 0 in the order of their numbers."""
    elements = sorted(([int(n) for n in row] for row in block(deck, "ELEMENT")), key=lambda row: row[0])
    return (np.array([[float(v) for v in row[1:]] for row in block(deck, "NODE")]),
            np.array([row[1:] for row in elements]) - 1)


def tables(text):
    """Times and displacements in a .dat file."""
    times, u = [], []
    for part in text.split("displacements (vx,vy,vz)")[1:]:
        head, *lines = part.splitlines()
        rows = [line.split()[1:] for line in lines if len(line.split()) == 4]
        times.append(float(head.split()[-1]))
        u.append(np.array(rows, dtype=float))
    return times, u


EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]


def gradients(count):
    """Derivatives of the shape functions of a tet with so many nodes by its last three barycentric weights, at
    each of the points looked at: count x 3."""
    corner = np.array([[-1.0, -1.0, -1.0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    if count == 4:
        return [corner]
    points = []
    for weight in np.eye(4):
        rows = [(4.0 * weight[i] - 1.0) * corner[i] for i in range(4)]
        rows += [4.0 * (weight[i] * corner[j] + weight[j] * corner[i]) for i, j in EDGES]
        points.append(np.array(rows))
    return points


def jacobian(x, tets, at):
    return np.einsum("tnk,nl->tkl", x[tets], at)


def compression(parts, run):
    """Increments are cut to a thousandth of the load; beyond one with a tet inside out nothing counts."""
    top = np.abs(run.nodes[:, 2] - HEAD) < 1e-9
    reached = {"stretch": 1.0, "load": 0.0, "jacobian": 1.0}
    inverted = ""
    for time, u in zip(run.times, run.u):
        stretch = 1.0 + u[top, 2].mean() / HEAD
        smallest = run.smallest_jacobian(u)
        if smallest <= 0.0:
            inverted = f"{stretch:.4f}"
            break
        reached = {"stretch": stretch, "load": LOAD * time, "jacobian": smallest}
    status = "called balance inside out" if inverted else "end of the axis" if run.finished else "no convergence"
    return {"bar": parts[2], "element": parts[1], **{k: f"{v:.4f}" for k, v in reached.items()},
            "inverted_at": inverted, "iterations": run.iterations, "status": status}


def status_of(run):
    if not (run.finished and run.u):
        return "no convergence"
    return "converged" if run.smallest_jacobian(run.u[-1]) > 0.0 else "called balance inside out"


def poisson(parts, run, rows):
    ours = next(r for r in rows if r["law"] == LAW and r["element"] == parts[1] and
                float(r["below_half"]) == float(parts[2]))
    reference = np.array([float(ours[f"reference_{k}"]) for k in "xyz"])
    error = ""
    if status_of(run) == "converged":
        found = run.at((10.0, 10.0, 20.0), run.u[-1])
        error = f"{np.linalg.norm(found - reference) / np.linalg.norm(reference):.3e}"
    return {"element": parts[1], "below_half": ours["below_half"], "error": error, "iterations": run.iterations,
            "status": status_of(run)}


def load_steps(parts, run, rows):
    ours = [r for r in rows if r["law"] == LAW and r["element"] == parts[1] and r["load"] == parts[2] and
            r["calls"] == parts[3] and r["status"] == "converged"]
    off = ""
    if status_of(run) == "converged" and ours:
        tip = run.at((10.0, 10.0, 60.0), run.u[-1])
        off = f"{max(abs(tip[0] - float(ours[0]['tip_x'])), abs(tip[2] - float(ours[0]['tip_z']))):.1e}"
    return {"element": parts[1], "load": parts[2], "calls": parts[3], "iterations": run.iterations, "off_mm": off,
            "status": status_of(run)}


def run_all(program, rows, out):
    """Tables of the three axes, as CSV beside the others."""
    found = {axis: [] for axis in COLUMNS}
    for number, (name, deck) in enumerate(decks(program).items()):
        parts = name.split("/")
        run = Result(out / "calculix" / str(number), deck)
        found[parts[0]].append(compression(parts, run) if parts[0] == "compression" else
                               {"poisson": poisson, "load_steps": load_steps}[parts[0]](parts, run, rows[parts[0]]))
    for axis, table in found.items():
        with (out / f"{axis}_by_calculix.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS[axis])
            writer.writeheader()
            writer.writerows(table)
    return Counter(row["status"] for table in found.values() for row in table)
