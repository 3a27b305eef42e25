"""docs/scaling.md, all of it from the runs."""

MB = 1e6
LARGE = 100_000   # unknowns from which memory is held to a bound

INTRO = """# Scaling

Written by `bench/scaling/run --write-docs`: what a solve takes of time and memory against its size. Each row is a
process of its own. Time: CPU seconds of all solves of the row, and yardsticks; a yardstick is one numeric factor and
one solve of the stiffness of both halves of the medium head, one thread (median of those before the series:
{yardstick:.3f} s; {processor}, {cores} cores; the machine had up to {load:.0f} processes at work besides, which wall
time shows). Memory: how far resident memory rises from before the first solve to its peak, beside
what `Stepper::memory_estimate()` says before it; of a few MB the half is code and buffers of the process.

![chart](charts/scaling.svg)

**Block**: tissue, 60 mm, held at its base, leaning under gravity between walls 2 mm off, with floppy leads in it held
above it; to the default tolerances. **Procedure**: all stages of both sides on a head, to 0.1 mm."""

NOTES = {
    "tets of a block": "2000 nodes are contact candidates, and one lead is in it.",
    "tets of a head": "The procedure.",
    "contact candidates": "Block of 17 cells a side, no lead. More candidates than nodes: several walls.",
    "coupling rows": "Block of 17 cells a side, no walls, one to twenty leads, a twentieth of gravity.",
    "threads": "The procedure on the medium head.",
    "branches": "Stages 2 to 5 of one side of the coarse head from one snapshot, with other trajectories; all are kept.",
}


def text(result):
    lines = [INTRO.format(**result)]
    for name, rows in result["series"].items():
        lines += ["", f"## {name[0].upper()}{name[1:]}", "", NOTES[name], "", *table(name, rows)]
    lines += ["", "## Memory of a large solve", "", *bound(result["series"])]
    return "\n".join(lines) + "\n"


def table(name, rows):
    columns = {**LEADING[name], **WORK}
    if name != "branches":
        columns = {**columns, **ESTIMATE}
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return lines + ["| " + " | ".join(value(row) for value in columns.values()) + " |" for row in rows]


def per_iteration(row):
    return f"{row['cpu_seconds'] / max(row['iterations'], 1):.3g}"


def megabytes(size):
    return f"{size / MB:.0f}" if size >= 10 * MB else f"{size / MB:.1f}"


LEADING = {
    "tets of a block": {"tets": lambda r: str(r["tets"]), "unknowns": lambda r: str(r["unknowns"])},
    "tets of a head": {"head": lambda r: r["case"]["head"], "tets": lambda r: str(r["tets"]), "unknowns": lambda r: str(r["unknowns"])},
    "contact candidates": {"candidates": lambda r: str(r["candidates"]), "in contact": lambda r: str(r["active_contacts"])},
    "coupling rows": {"rows": lambda r: str(r["coupling_rows"]), "leads": lambda r: str(r["case"]["leads"])},
    "threads": {"threads": lambda r: str(r["case"]["threads"]), "wall s": lambda r: f"{r['wall_seconds']:.3g}"},
    "branches": {"branches": lambda r: str(r["case"]["count"]),
                 "CPU s of each": lambda r: f"{r['cpu_seconds'] / r['case']['count']:.3g}"},
}
WORK = {
    "CPU s": lambda r: f"{r['cpu_seconds']:.3g}",
    "yardsticks": lambda r: f"{r['yardsticks']:.3g}",
    "iterations": lambda r: str(r["iterations"]),
    "factors": lambda r: str(r["factorisations"]),
    "CPU s per iteration": per_iteration,
    "memory, MB": lambda r: megabytes(r["resident_rise"]),
}
ESTIMATE = {
    "estimate, MB": lambda r: megabytes(r["estimate"]["total"]),
    "measured / estimate": lambda r: f"{r['resident_rise'] / r['estimate']['total']:.2f}",
}


def bound(series):
    """Peak against what cannot be done without, on every case that is large enough."""
    lines = ["From 100 000 unknowns on memory is to be at most 1.5 times factor, columns beside it (Z) and compliance of",
             "the rows (W), as the estimate has them.", "",
             "| scene | unknowns | in contact | rows | factor, MB | Z, MB | W, MB | measured, MB | / (factor + Z + W) | / factor alone |",
             "|" + "---|" * 10]
    large = [r for rows in series.values() for r in rows if r.get("unknowns", 0) >= LARGE]
    for r in large:
        e = r["estimate"]
        needed = e["factor"] + e["border"] + e["compliance"]
        scene = f"{r['case']['scene']}, {r['tets']} tets"
        lines.append(f"| {scene} | {r['unknowns']} | {r['active_contacts']} | {r['coupling_rows']} | "
                     f"{megabytes(e['factor'])} | {megabytes(e['border'])} | {megabytes(e['compliance'])} | "
                     f"{megabytes(r['resident_rise'])} | {r['resident_rise'] / needed:.2f} | "
                     f"{r['resident_rise'] / e['factor']:.2f} |")
    return lines if large else ["None of the solves has 100 000 unknowns."]
