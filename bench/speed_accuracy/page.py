"""docs/charts/speed_accuracy.md, all of it from the runs."""
from cases import LADDER, SCENES
from front import cheapest, pareto

BOUNDS = (1.0, 0.5, 0.1)

INTRO = """# Speed against accuracy

Written by `bench/speed_accuracy/run{options}`. How long a solve takes, and how far the answer is off: rungs of the
ladder on each mesh, co-rotational tissue, Poisson's ratio 0.45, {air:g} mL of air on each side.

![chart](speed_accuracy.svg)

- **Cost**: CPU time of the stages on one thread, in yardsticks; what it takes to make the scene and the stepper, once
  for each head, stands beside it (set-up). A yardstick is one numeric factor and one solve of the stiffness of both
  halves of the medium head, in the same process, before and after (median {yardstick:.3f} s here; {processor}).
- **Error**: the largest over {points} points (subthalamic nuclei, the planned tracks every 10 mm, midline, cortex), the
  tips of the leads, and all stages, from the reference of the same head: quadratic tets on that head's
  geometry, default tolerances, the same law, the same volume of air. *M0* and *M2* count from the co-rotational
  reference: what they leave out is in their error.
- **Off the exact solve**: the same largest difference, from the same mesh and elements solved to the default
  tolerances with the co-rotational law (of M4: its own): what the rung itself costs, without the mesh.
- *M2* does one linearisation in each solve: relative tolerances of 10 and a correction of any length end it after the
  first. A stage in which nothing changes needs none.
- Ringed in black: on the Pareto front; errors that differ by less than 1 % count as equal there. Dotted: the bounds
  of the first table."""


def text(points, factors, context, options=""):
    judged = [p for p in points if "error" in p]
    lines = [INTRO.format(options=options, **context), "", "## What to use", "", *advice(judged), ""]
    lines += ["## The ladder", ""]
    lines += [f"- **{r.name}**: {r.meaning}" for r in LADDER if any(p["rung"] == r.name for p in points)]
    for scene, title in SCENES.items():
        rows = [p for p in points if p["case"]["scene"] == scene]
        if rows:
            lines += ["", f"### {title[0].upper()}{title[1:]}", "", *ladder_table(rows)]
    if factors:
        lines += ["", "## One factor at a time", "", "About the default (M3) on the coarse head, CSF loss.", ""]
        lines += factor_table(factors)
    lines += ["", "## References", "", *reference_table(points, context)]
    if context["missing"]:
        lines += ["", "## Not measured", "", *(f"- {name}" for name in context["missing"])]
    return "\n".join(lines) + "\n"


def header(*columns):
    return ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]


def advice(rows):
    lines = ["The cheapest rung whose largest error is below the bound, on either head. How far the heads themselves are",
             "apart is not in it: see the references.", ""]
    lines += header("", "points", *(f"for {b:g} mm" for b in BOUNDS), "default (M3)")
    for scene, title in SCENES.items():
        some = [r for r in rows if r["case"]["scene"] == scene]
        if not some:
            continue
        lines += [recommended(title, "all", some), recommended(title, "without the cortex", deep(some))]
    return lines


def deep(rows):
    """The same rows, judged where electrodes are: not at the cortex."""
    return [{**r, "error": max(off[0] for kind, off in r["kinds"].items() if kind != "cortex")} for r in rows]


def recommended(title, points, rows):
    cells = []
    for bound in BOUNDS:
        row = cheapest(rows, bound)
        cells.append(f"{row['rung']}, {row['case']['head']} head: {cost(row)}, {row['error']:.3f} mm" if row
                     else f"none; closest {min(r['error'] for r in rows):.3f} mm")
    default = [f"{r['case']['head']}: {cost(r)}, {r['error']:.3f} mm" for r in rows if r["rung"] == "M3"]
    return f"| {title} | {points} | " + " | ".join(cells) + " | " + "; ".join(default) + " |"


def cost(row):
    return f"{row['yardsticks']:.3g} yardsticks ({row['cpu']:.2g} s)"


def brief(row):
    if not row["converged"]:
        return row["message"]
    return f"{row['yardsticks']:.3g} yardsticks, " + (f"{row['error']:.4f} mm" if "error" in row else row["why"])


def ladder_table(rows):
    front = pareto([r for r in rows if "error" in r])
    lines = header("rung", "head", "yardsticks", "CPU s", "wall s", "set-up, CPU s", "iterations", "factors",
                   "largest error, mm", "where", "reference", "off the exact solve, mm", "on the front")
    for r in rows:
        work = [f"{r['yardsticks']:.3g}", f"{r['cpu']:.3g}", f"{r['wall']:.3g}", f"{r['setup']:.2g}", str(r["iterations"]),
                str(r["factors"])] if "cpu" in r else [""] * 6
        lines.append("| " + " | ".join([r["rung"], r["case"]["head"], *work, *verdict(r), "yes" if r in front else ""]) + " |")
    return lines


def verdict(row):
    """Error, where, its reference, and off the exact solve; or why there is none."""
    if not row["converged"]:
        return ["no balance", row["message"], "", ""]
    off = f"{row['off_exact']:.3g}" if "off_exact" in row else ""
    if "error" not in row:
        return ["", row["why"], "", off]
    law, mesh = row["reference"].split("-")[2], row["reference"].rsplit("-", 1)[1]
    own = "" if law == "corotational" else f", {law}"
    return [f"{row['error']:.4f}", f"{row['probe']}, stage {row['stage']}", mesh + own, off]


def factor_table(factors):
    lines = header("factor", "value", "yardsticks", "wall s", "iterations", "largest error, mm", "where", "reference",
                   "off the exact solve, mm")
    for name, rows in factors.items():
        for r in rows:
            work = [f"{r['yardsticks']:.3g}", f"{r['wall']:.3g}", str(r["iterations"])] if "cpu" in r else [""] * 3
            lines.append("| " + " | ".join([name, f"{r['value']:g}", *work, *verdict(r)]) + " |")
    return lines


def reference_table(points, context):
    lines = ["*own*: quadratic tets on the head's own mesh; *refined*: on its refinement, each tet cut into eight.", ""]
    lines += header("reference", "nodes", "CPU s", "library")
    for name, r in context["references"].items():
        lines.append(f"| {name} | {r['nodes']} | {r['cpu_seconds']:.0f} | {r['library']} |")
    lines += ["", *context["remarks"]]
    return lines
