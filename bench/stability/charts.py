"""The charts of docs/stability.md."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

matplotlib.rcParams["svg.hashsalt"] = "stability"   # the same names in the file again

LAWS = {"linear": "tab:gray", "corotational": "tab:blue", "st_venant_kirchhoff": "tab:red",
        "stable_neo_hookean": "tab:green", "log_neo_hookean": "tab:purple"}
CALCULIX = "black"
ELEMENTS = {"linear": ("o", "-"), "nodal": ("s", "--"), "quadratic": ("^", ":")}


def save(figure, path, **layout):
    figure.tight_layout(**layout)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def number(text):
    return float(text) if text else float("nan")


def plot(axis, rows, x, y, label=None, **style):
    """A line through the rows that converged, a cross at the foot for each that did not."""
    good = [r for r in rows if r["status"] in ("converged", "solved")]
    axis.plot([number(r[x]) for r in good], [number(r[y]) for r in good], markersize=4, linewidth=1,
              label=label, **style)
    bad = [number(r[x]) for r in rows if r not in good]
    if bad:
        axis.plot(bad, [0.03] * len(bad), "x", color=style.get("color"), markersize=7,
                  transform=axis.get_xaxis_transform())


def select(table, **wanted):
    return [r for r in table if all(r[k] == v for k, v in wanted.items())]


def reach_of_calculix(axis, row, theirs):
    """A line per element; a cross where it called balance what has a tet inside out."""
    for shift, element in ((-1, "linear"), (1, "quadratic")):
        for r in select(theirs, element=element):
            y = row + 0.25 * shift
            axis.plot([1, number(r["stretch"])], [y, y], color=CALCULIX, linewidth=1.2)
            axis.plot(number(r["stretch"]), y, ELEMENTS[element][0], color=CALCULIX, markersize=6)
            if r["inverted_at"]:
                axis.plot(number(r["inverted_at"]), y, "x", color="tab:red", markersize=8, markeredgewidth=2)


def compression(rows, theirs, path):
    bars = list(dict.fromkeys(r["bar"] for r in rows))
    figure, axes = plt.subplots(1, len(bars), figsize=(11, 4.2), sharey=True, sharex=True)
    labels = [*LAWS, *(["st_venant_kirchhoff,\nCalculiX"] if theirs else [])]
    for axis, bar in zip(axes, bars):
        reach_of_calculix(axis, len(LAWS), select(theirs, bar=bar))
        for row, (law, colour) in enumerate(LAWS.items()):
            for shift, (element, (marker, _)) in enumerate(ELEMENTS.items()):
                (r,) = select(rows, bar=bar, law=law, element=element)
                y = row + 0.25 * (shift - 1)
                stopped = r["status"] != "end of the axis"
                axis.plot([1, number(r["stretch"])], [y, y], color=colour, linewidth=1.2)
                axis.plot(number(r["stretch"]), y, marker, color=colour, markersize=6,
                          markerfacecolor=colour if stopped else "white")
            for r in select(rows, bar=bar, law=law, element="material"):
                if number(r["stretch"]) > 0:
                    axis.plot([number(r["stretch"])] * 2, [row - 0.42, row + 0.42], "k", linewidth=2)
        axis.axvline(3 ** -0.5, color="tab:red", linestyle=":", linewidth=1)
        axis.set_title(bar, fontsize=10)
        axis.set_xlabel("stretch reached")
        axis.set_yticks(range(len(labels)), labels)
    axes[0].set_xlim(1.02, 0)
    axes[0].invert_yaxis()
    for element, (marker, _) in ELEMENTS.items():
        axes[1].plot([], [], "k" + marker, label=element, markersize=6, linestyle="none")
    axes[1].plot([], [], "ko", markerfacecolor="white", linestyle="none", label="not stopped")
    axes[1].plot([], [], "k", linewidth=2, label="ellipticity is lost")
    axes[1].plot([], [], color="tab:red", linestyle=":", label="1/√3")
    if any(r["inverted_at"] for r in theirs):
        axes[1].plot([], [], "x", color="tab:red", markeredgewidth=2, label="called balance inside out")
    # Of the figure, so that it does not push the panels apart.
    figure.legend(*axes[1].get_legend_handles_labels(), fontsize=8, loc="lower center", ncol=7)
    save(figure, path, rect=(0, 0.06, 1, 1))


def poisson(rows, theirs, path):
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), sharey=True)
    for axis, element in zip(axes, ELEMENTS):
        for law, colour in LAWS.items():
            plot(axis, select(rows, element=element, law=law), "below_half", "error", color=colour,
                 marker="o", label=law)
        some = select(theirs, element=element)
        if some:
            plot(axis, some, "below_half", "error", color=CALCULIX, marker="d", linestyle="--",
                 label="st_venant_kirchhoff, CalculiX")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.invert_xaxis()
        axis.set_title(f"{element} tets", fontsize=10)
        axis.set_xlabel("0.5 - Poisson's ratio")
    axes[0].set_ylabel("error of the displacement")
    axes[0].legend(fontsize=7, loc="center right")
    save(figure, path)


def load_steps(rows, theirs, path):
    loads = list(dict.fromkeys(r["load"] for r in rows))
    figure, axes = plt.subplots(1, len(loads), figsize=(9, 3.8))
    for axis, load in zip(axes, loads):
        for law, colour in LAWS.items():
            for element, (marker, line) in ELEMENTS.items():
                plot(axis, select(rows, load=load, law=law, element=element), "calls", "iterations",
                     color=colour, marker=marker, linestyle=line,
                     label=law if element == "linear" else None)
        for element, (marker, line) in ELEMENTS.items():
            some = select(theirs, load=load, element=element)
            if some:
                plot(axis, some, "calls", "iterations", color=CALCULIX, marker=marker, linestyle=line,
                     label="st_venant_kirchhoff, CalculiX" if element == "linear" else None)
        axis.set_xscale("log", base=2)
        axis.set_yscale("log")
        axis.set_title(f"{load} g across the bar", fontsize=10)
        axis.set_xlabel("calls that share the load")
    axes[0].set_ylabel("Newton iterations in all")
    axes[0].legend(fontsize=7)
    save(figure, path)


def time_steps(rows, path):
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    colours = dict(zip(scenes, [*LAWS.values(), "tab:orange", "tab:cyan"]))
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    for axis, y in zip(axes, ("iterations", "off_static")):
        for scene, colour in colours.items():
            for element, (marker, line) in ELEMENTS.items():
                plot(axis, select(rows, scene=scene, element=element), "dt", y, color=colour,
                     marker=marker, linestyle=line, label=scene if element == "linear" else None)
        axis.set_xscale("log")
        axis.set_xlabel("dt, s")
    axes[0].set_ylabel("most Newton iterations of a step")
    axes[0].legend(fontsize=7)
    axes[1].set_yscale("log")
    axes[1].set_ylabel("off the static answer after 5 steps")
    save(figure, path)


def stiffness(rows, path):
    figure, axes = plt.subplots(2, 2, figsize=(9, 6), sharex=True, sharey="row")
    for column, what in enumerate(("device", "inclusion")):
        for axis, y in zip(axes[:, column], ("iterations", "residual")):
            for law, colour in LAWS.items():
                for element, (marker, line) in ELEMENTS.items():
                    plot(axis, select(rows, what=what, law=law, element=element), "ratio", y,
                         color=colour, marker=marker, linestyle=line,
                         label=law if element == "linear" else None)
            axis.set_xscale("log")
        for r in select(rows, what=what, status="converged"):
            if number(r["motion"]) == 0.0:
                axes[1, column].plot(number(r["ratio"]), number(r["residual"]), "o", color="k",
                                     markersize=11, markerfacecolor="none")
        axes[0, column].set_yscale("symlog", linthresh=10)
        axes[1, column].set_yscale("log")
        axes[0, column].set_title(what, fontsize=10)
        axes[1, column].set_xlabel("Young's modulus over that of tissue")
    axes[0, 0].set_ylabel("Newton iterations")
    axes[1, 0].set_ylabel("residual")
    axes[0, 0].legend(fontsize=7)
    save(figure, path)


SOLVERS = {"Newton": ("tab:blue", "o"), "pivoting": ("tab:green", "s"),
           "Gauss-Seidel": ("tab:orange", "^")}
ROWS = {"free": ":", "one-sided": "-", "boxes": "--"}


def repeated(devices, rows, siconos, path):
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.4))
    for way, colour in zip(dict.fromkeys(r["way"] for r in devices), LAWS.values()):
        some = select(devices, way=way, element="linear")
        plot(axes[0], some, "copies", "rows", color=colour, linestyle=":", marker=".")
        plot(axes[0], some, "copies", "rank", color=colour, marker="o", label=f"{way}: rank")
    axes[0].set_ylabel("rows of the coupling (dotted), rank")
    axes[0].set_xlabel("leads on one track")
    for solver, (colour, marker) in SOLVERS.items():
        for kind, line in ROWS.items():
            some = select(rows, solver=solver, rows=kind)
            plot(axes[1], some, "copies", "iterations", color=colour, marker=marker, linestyle=line,
                 label=f"{solver}, {kind}")
            sums = [{**r, "off": str(max(number(r["off_single"]), 1e-17))} for r in some]
            plot(axes[2], sums, "copies", "off", color=colour, marker=marker, linestyle=line)
    axes[1].set_ylabel("iterations, pivots, sweeps")
    for name, colour in zip(dict.fromkeys(r["solver"] for r in siconos), plt.cm.tab20.colors[1::2]):
        some = [{**r, "status": "solved"} for r in siconos if r["solver"] == name]
        plot(axes[2], some, "copies", "off_single", color=colour, marker="*", label=f"Siconos {name}")
    axes[2].set_ylabel("sum of the forces, off that of one")
    for axis in axes:
        axis.set_xscale("log", base=2)
        axis.set_yscale("log")
        axis.legend(fontsize=6, loc="upper left", bbox_to_anchor=(0.0, -0.18), ncol=2)
    for axis in axes[1:]:
        axis.set_xlabel("times each of 20 rows is there")
    save(figure, path)
