"""docs/charts/scaling.svg and .png."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

matplotlib.rcParams["svg.hashsalt"] = "scaling"   # the same names in the file again
matplotlib.rcParams["svg.fonttype"] = "none"      # text that can be searched

TIME, MEMORY = "#0072B2", "#D55E00"               # Okabe and Ito's colours
BLOCK, HEAD = "o-", "s--"


def draw(series, paths):
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.2), gridspec_kw={"wspace": 0.35, "hspace": 0.4})
    blocks, heads = series["tets of a block"], series["tets of a head"]
    tets = lambda rows: [r["tets"] for r in rows]
    axis = panel(axes[0][0], "time against tets", "tets", "CPU, yardsticks")
    axis.plot(tets(blocks), [r["yardsticks"] / r["factorisations"] for r in blocks], BLOCK, color=TIME,
              label="block, per factor")
    axis.plot(tets(heads), [r["yardsticks"] / r["factorisations"] for r in heads], HEAD, color="black",
              label="procedure, per factor")
    axis = panel(axes[0][1], "memory against tets", "tets", "MB")
    for rows, style, name, colour in ((blocks, BLOCK, "block", MEMORY), (heads, HEAD, "procedure", "black")):
        axis.plot(tets(rows), [r["resident_rise"] / 1e6 for r in rows], style, color=colour, label=f"{name}, measured")
    axis.plot(tets(blocks), [r["estimate"]["total"] / 1e6 for r in blocks], "+", color="0.4", markersize=11,
              label="block, estimate")
    against(axes[0][2], series["contact candidates"], "contact candidates", lambda r: r["candidates"], logarithmic=False)
    against(axes[1][0], series["coupling rows"], "coupling rows", lambda r: r["coupling_rows"])
    against(axes[1][1], series["branches"], "branches from one snapshot", lambda r: r["case"]["count"], logarithmic=False)
    threads(axes[1][2], series["threads"])
    for axis in (axes[0][0], axes[0][1]):
        axis.legend(fontsize=8, frameon=False)
    for path in paths:
        metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
        figure.savefig(path, dpi=110, metadata=metadata, bbox_inches="tight")
    plt.close(figure)


def panel(axis, title, along, up, logarithmic=True):
    axis.set_title(title, fontsize=10)
    axis.set_xlabel(along, fontsize=9)
    axis.set_ylabel(up, fontsize=9)
    axis.grid(True, which="major", color="0.9")
    axis.set_axisbelow(True)
    axis.tick_params(labelsize=8)
    if logarithmic:
        axis.set_xscale("log")
        axis.set_yscale("log")
        for scale in (axis.xaxis, axis.yaxis):
            scale.set_major_locator(LogLocator(subs=(1,) if scale is axis.xaxis else (1, 2, 5)))
            scale.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            scale.set_minor_formatter(NullFormatter())
    return axis


def against(axis, rows, title, at, logarithmic=True):
    """Time on the left, memory on the right."""
    panel(axis, title, title, "CPU, yardsticks", logarithmic)
    x = [at(r) for r in rows]
    axis.plot(x, [r["yardsticks"] for r in rows], "o-", color=TIME)
    axis.yaxis.label.set_color(TIME)
    other = axis.twinx()
    other.plot(x, [r["resident_rise"] / 1e6 for r in rows], "s--", color=MEMORY)
    other.set_ylabel("MB", color=MEMORY, fontsize=9)
    other.tick_params(labelsize=8)
    for scale in (axis, other):
        if scale.get_yscale() == "linear":
            scale.set_ylim(0, 1.15 * scale.get_ylim()[1])


def threads(axis, rows):
    panel(axis, "threads: the procedure", "threads", "seconds", logarithmic=False)
    x = [r["case"]["threads"] for r in rows]
    for key, name, style in (("wall_seconds", "wall", "o-"), ("cpu_seconds", "CPU", "s--")):
        axis.plot(x, [r[key] for r in rows], style, label=name, color=TIME if key[0] == "w" else MEMORY)
    axis.set_xticks(x)
    axis.set_ylim(0, 1.15 * axis.get_ylim()[1])
    axis.legend(fontsize=8, frameon=False)
