"""docs/charts/speed_accuracy.svg and .png."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from cases import HEADS, LADDER, SCENES
from front import pareto

matplotlib.rcParams["svg.hashsalt"] = "speed_accuracy"   # the same names in the file again
matplotlib.rcParams["svg.fonttype"] = "none"             # text that can be searched

# Okabe and Ito's colours, told apart by the colour-blind.
COLOURS = {"M0": "#999999", "M1": "#0072B2", "M2": "#D55E00", "M3": "#000000", "M4": "#CC79A7", "M5": "#009E73",
           "M6": "#E69F00"}
FAMILIES = {"M0": "linear law", "M2": "one linearisation", "M1": "to an accuracy (mm)", "M3": "co-rotational, exact",
            "M4": "other laws", "M5": "volume at nodes", "M6": "quadratic tets"}
MARKERS = {"coarse": "o", "medium": "s"}


def draw(points, factors, paths):
    scenes = {s: t for s, t in SCENES.items() if any(p["case"]["scene"] == s for p in points)}
    figure = plt.figure(figsize=(13 if factors or len(scenes) > 1 else 7, 10 if factors else 6))
    rows = figure.add_gridspec(2 if factors else 1, 1, height_ratios=(2.4, 1) if factors else None, hspace=0.3)
    ladders = rows[0].subgridspec(1, len(scenes), wspace=0.2)
    for i, (scene, title) in enumerate(scenes.items()):
        ladder(figure.add_subplot(ladders[i]), [p for p in points if p["case"]["scene"] == scene], title)
    legend(figure, points)
    for i, (name, some) in enumerate(shown(factors).items()):
        if i == 0:
            panels = rows[1].subgridspec(1, len(shown(factors)), wspace=0.75)
        factor(figure.add_subplot(panels[i]), name, some)
    for path in paths:
        metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
        figure.savefig(path, dpi=110, metadata=metadata, bbox_inches="tight")
    plt.close(figure)


def shown(factors):
    """Without the second curve of Poisson's ratio, which goes with the first."""
    return {name: rows for name, rows in factors.items() if "," not in name or name.startswith("tolerance")}


def ladder(axis, rows, title):
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_title(title, fontsize=11, pad=12)
    axis.set_xlabel("CPU time, yardsticks")
    axis.set_ylabel("largest error over all points and stages, mm")
    axis.grid(True, which="major", color="0.9")
    axis.set_axisbelow(True)
    front = pareto(rows)
    axis.step([r["yardsticks"] for r in front], [r["error"] for r in front], where="post", color="0.55",
              linewidth=1.4, zorder=1)
    for row in rows:
        axis.plot(row["yardsticks"], row["error"], MARKERS[row["case"]["head"]], color=COLOURS[row["family"]],
                  markersize=8, markeredgecolor="black" if row in front else "white",
                  markeredgewidth=1.1 if row in front else 0.6, zorder=3)
    axis.margins(0.14, 0.12)
    for bound in (1.0, 0.5, 0.1):
        if axis.get_ylim()[0] < bound < axis.get_ylim()[1]:
            axis.axhline(bound, color="0.75", linestyle=":", linewidth=1, zorder=0)
    for scale in (axis.xaxis, axis.yaxis):
        plain(scale)
    label(axis, rows)
    seconds = sorted(r["yardstick"] for r in rows)[len(rows) // 2]
    upper = axis.secondary_xaxis("top", functions=(lambda x: x * seconds, lambda s: s / seconds))
    plain(upper.xaxis)
    upper.set_xlabel("seconds of CPU, one thread", fontsize=8)
    upper.tick_params(labelsize=7)


def plain(scale):
    """Numbers as they are said, at 1, 2 and 5 of each decade."""
    scale.set_major_locator(LogLocator(subs=(1, 2, 5)))
    scale.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    scale.set_minor_formatter(NullFormatter())


def groups(rows, at, near):
    """Rows of one family on one head whose points nearly coincide share a label."""
    found = []
    for row in sorted(rows, key=lambda r: r["yardsticks"]):
        for group in found:
            if (group[0]["family"], group[0]["case"]["head"]) == (row["family"], row["case"]["head"]) and \
                    max(abs(at[id(group[-1])] - at[id(row)])) < near:
                group.append(row)
                break
        else:
            found.append([row])
    return found


def words(group):
    """M1 1, 0.5 for M1 0.5 and M1 1."""
    family = group[0]["family"]
    there = {r["rung"] for r in group}
    kinds = [r.name[len(family):].strip() for r in LADDER if r.name in there]
    return f"{family} {', '.join(k or 'exact' for k in kinds)}" if len(group) > 1 else group[0]["rung"]


def label(axis, rows):
    """Names beside their points: each where it covers no other name or point."""
    axis.figure.canvas.draw()
    renderer = axis.figure.canvas.get_renderer()
    at = {id(r): axis.transData.transform((r["yardsticks"], r["error"])) for r in rows}
    size = axis.figure.dpi / 72.0
    taken = [matplotlib.transforms.Bbox.from_bounds(x - 5 * size, y - 5 * size, 10 * size, 10 * size)
             for x, y in at.values()]
    frame = axis.get_window_extent(renderer)
    offsets = [(dx * reach, dy * reach) for reach in (1, 2, 3.2, 4.6, 6)
               for dx, dy in ((0, 8), (0, -8), (6, 6), (6, -6), (-6, 6), (-6, -6), (7, 0), (-7, 0))]
    for group in groups(rows, at, 40 * size):
        middle = group[len(group) // 2]

        def note(offset, arrow=None):
            dx, dy = offset
            return axis.annotate(words(group), (middle["yardsticks"], middle["error"]), xytext=offset,
                                 textcoords="offset points", fontsize=8, color="0.15", zorder=4,
                                 ha="left" if dx > 0 else "right" if dx < 0 else "center",
                                 va="bottom" if dy > 0 else "top" if dy < 0 else "center", arrowprops=arrow,
                                 bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.7})

        def clashes(offset):
            text = note(offset)
            box = text.get_window_extent(renderer)
            text.remove()
            outside = not (frame.contains(*box.min) and frame.contains(*box.max))
            return sum(box.overlaps(t) for t in taken) + 5 * outside

        best = min(offsets, key=clashes)   # the nearest of equals
        far = max(map(abs, best)) > 14
        text = note(best, {"arrowstyle": "-", "color": "0.6", "linewidth": 0.6} if far else None)
        taken.append(text.get_window_extent(renderer))


def legend(figure, points):
    heads = [Line2D([], [], marker=MARKERS[h], color="0.5", linestyle="none", markersize=7, label=f"{h} head")
             for h in HEADS if any(p["case"]["head"] == h for p in points)]
    families = [Line2D([], [], marker="D", color=COLOURS[f], linestyle="none", markersize=6, label=f"{f}: {what}")
                for f, what in FAMILIES.items() if any(p["family"] == f for p in points)]
    front = [Line2D([], [], color="0.55", linewidth=1.4, marker="o", markerfacecolor="white", markeredgecolor="black",
                    label="Pareto front")]
    figure.legend(handles=[*heads, *front, *families], fontsize=8, loc="lower center", ncol=5,
                  bbox_to_anchor=(0.5, 0.97), frameon=False)


def factor(axis, name, rows):
    """Error and cost over one factor; each factor on the coarse head, CSF loss."""
    rows = [r for r in rows if r["converged"]]
    values = range(len(rows))
    axis.set_title(name, fontsize=9)
    axis.set_xticks(list(values), [f"{r['value']:g}" for r in rows], fontsize=8)
    axis.tick_params(labelsize=7)
    time = "wall" if name == "threads" else "yardsticks"
    scale = rows[0]["yardstick"] if time == "wall" and rows else 1.0
    axis.plot(values, [r.get("error", float("nan")) for r in rows], "o-", color=COLOURS["M1"], markersize=5)
    axis.set_ylim(0, 1.12 * axis.get_ylim()[1])
    axis.set_ylabel("error, mm", color=COLOURS["M1"], fontsize=8)
    other = axis.twinx()
    other.plot(values, [r[time] / scale for r in rows], "s--", color=COLOURS["M2"], markersize=5)
    other.set_ylim(0, 1.3 * other.get_ylim()[1])
    for y in (axis.yaxis, other.yaxis):
        y.set_major_locator(MaxNLocator(4))
    other.tick_params(labelsize=7)
    other.set_ylabel("wall time, yardsticks" if time == "wall" else "CPU, yardsticks", color=COLOURS["M2"], fontsize=8)
