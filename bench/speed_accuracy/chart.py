"""docs/charts/speed_accuracy.svg and .png."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from cases import HEADS, SCENES
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
    figure = plt.figure(figsize=(12 if len(scenes) > 1 else 7, 9.5 if factors else 6))
    grid = figure.add_gridspec(2 if factors else 1, 12, height_ratios=(2.1, 1) if factors else None, hspace=0.4, wspace=7)
    for i, (scene, title) in enumerate(scenes.items()):
        width = 12 // len(scenes)
        axis = figure.add_subplot(grid[0, i * width:(i + 1) * width])
        ladder(axis, [p for p in points if p["case"]["scene"] == scene], title)
    legend(figure, points, 0.93 if factors else 0.97)
    for place, (name, rows) in zip(range(0, 12, 3), shown(factors).items()):
        factor(figure.add_subplot(grid[1, place:place + 3]), name, rows)
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


def label(axis, rows):
    """Names beside their points; each where the fewest others stand, the crowded ones last."""
    figure = axis.figure
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    at = {id(r): axis.transData.transform((r["yardsticks"], r["error"])) for r in rows}
    size = figure.dpi / 72.0
    taken = [matplotlib.transforms.Bbox.from_bounds(x - 4 * size, y - 4 * size, 8 * size, 8 * size)
             for x, y in at.values()]
    frame = axis.get_window_extent(renderer)
    offsets = [(dx * reach, dy * reach) for reach in (1, 1.7, 2.6, 3.6, 4.8)
               for dx, dy in ((0, 8), (0, -8), (6, 6), (6, -6), (-6, 6), (-6, -6), (7, 0), (-7, 0))]
    for row in sorted(rows, key=lambda r: -r["error"]):
        best = None
        for dx, dy in offsets:
            text = axis.annotate(row["rung"], (row["yardsticks"], row["error"]), xytext=(dx, dy),
                                 textcoords="offset points", fontsize=8, color="0.15",
                                 ha="left" if dx > 0 else "right" if dx < 0 else "center",
                                 va="bottom" if dy > 0 else "top" if dy < 0 else "center", zorder=4)
            box = text.get_window_extent(renderer)
            clashes = sum(box.overlaps(t) for t in taken) + 5 * (not frame.contains(*box.min)) \
                + 5 * (not frame.contains(*box.max))
            text.remove()
            if best is None or clashes < best[0]:
                best = (clashes, dx, dy, box)
            if clashes == 0:
                break
        _, dx, dy, box = best
        far = abs(dx) + abs(dy) > 14
        axis.annotate(row["rung"], (row["yardsticks"], row["error"]), xytext=(dx, dy), textcoords="offset points",
                      fontsize=8, color="0.15", ha="left" if dx > 0 else "right" if dx < 0 else "center",
                      va="bottom" if dy > 0 else "top" if dy < 0 else "center", zorder=4,
                      bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.7},
                      arrowprops={"arrowstyle": "-", "color": "0.6", "linewidth": 0.6} if far else None)
        taken.append(box)


def legend(figure, points, height):
    heads = [Line2D([], [], marker=MARKERS[h], color="0.5", linestyle="none", markersize=7, label=f"{h} head")
             for h in HEADS if any(p["case"]["head"] == h for p in points)]
    families = [Line2D([], [], marker="D", color=COLOURS[f], linestyle="none", markersize=6, label=f"{f}: {what}")
                for f, what in FAMILIES.items() if any(p["family"] == f for p in points)]
    front = [Line2D([], [], color="0.55", linewidth=1.4, marker="o", markerfacecolor="white", markeredgecolor="black",
                    label="Pareto front")]
    figure.legend(handles=[*heads, *front, *families], fontsize=8, loc="lower center", ncol=5,
                  bbox_to_anchor=(0.5, height), frameon=False)


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
    axis.set_ylim(bottom=0)
    axis.set_ylabel("error, mm", color=COLOURS["M1"], fontsize=8)
    other = axis.twinx()
    other.plot(values, [r[time] / scale for r in rows], "s--", color=COLOURS["M2"], markersize=5)
    other.set_ylim(bottom=0)
    other.tick_params(labelsize=7)
    other.set_ylabel("wall time, yardsticks" if time == "wall" else "CPU, yardsticks", color=COLOURS["M2"], fontsize=8)
