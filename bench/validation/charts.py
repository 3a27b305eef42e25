"""The figures of docs/validation.md."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from studies import BAND, PAPER, SENSITIVITY, STUDIED, law

COLOURS = {"default": "tab:blue", "paper-2011": "tab:red", "paper-2011, MNI size": "tab:orange"}


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)


def retraction(runs, path):
    """D against the volume of air, with the law's band, the paper's points and a later series."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), sharey=True)
    volume = np.linspace(0, 76, 50)
    for axis, way in zip(axes, ("both", "right")):
        spread = np.interp(volume, list(BAND), list(BAND.values()))
        axis.fill_between(volume, law(volume) - spread, law(volume) + spread, color="0.9",
                          label="law 2 + 0.08 V, its band")
        axis.plot(list(PAPER), list(PAPER.values()), "k*", markersize=11, label="paper, simulated")
        axis.errorbar([38], [1.0], xerr=[[38], [38]], yerr=0.8, color="tab:green", capsize=3,
                      label="later series: 1.0 ± 0.8 mm, 0–76 mL")
        for preset, colour in COLOURS.items():
            some = [r for (p, w, _), r in runs.items() if p == preset and w == way and r.converged]
            air = [r.air() for r in some]
            axis.plot(air, [np.linalg.norm(r.shift("STN_right")) for r in some], "-o", color=colour,
                      markersize=3, label=f"{preset}: |shift of STN|")
            axis.plot(air, [r.mean_retraction("skull") for r in some], "--", color=colour,
                      label="D against skull")
            axis.plot(air, [r.mean_retraction("tissue") for r in some], ":", color=colour,
                      label="D against tissue")
        axis.axhline(0, color="0.6", linewidth=0.8)
        axis.set_xlabel("air at the end of surgery, mL")
        axis.set_title("both sides" if way == "both" else "right side only")
    axes[0].set_ylabel("mm")
    axes[1].legend(fontsize=7, ncol=1, loc="upper left", bbox_to_anchor=(1.01, 1.0))
    save(figure, path)


def stages(run, path):
    """Motion of the two sides through the stages (the paper's figure 3)."""
    labels = list(run.stages)
    figure, axis = plt.subplots(figsize=(7.5, 3.6))
    for i, side in enumerate(("right", "left")):
        values = [run.stages[s]["sides"][side]["largest_surface_motion_mm"] for s in labels]
        axis.bar(np.arange(len(labels)) + 0.38 * i - 0.19, values, 0.36, label=f"{side}: surface")
    stn = {side: [np.linalg.norm(run.shift(f"STN_{side}", s)) for s in labels]
           for side in ("right", "left")}
    for side, marker in (("right", "v"), ("left", "^")):
        axis.plot(stn[side], marker=marker, linewidth=1, color="k", label=f"{side}: STN")
    axis.set_xticks(range(len(labels)), labels)
    axis.set_xlabel("stage")
    axis.set_ylabel("motion since stage 0, mm")
    axis.legend(fontsize=8)
    save(figure, path)


def lead(runs, path):
    """Deflection of the right lead from its planned line, forwards (the paper's figure 4)."""
    figure, axes = plt.subplots(1, len(runs), figsize=(4 * len(runs), 3.4), sharey=True, squeeze=False)
    for axis, (name, run) in zip(axes[0], runs.items()):
        for label, text in (("5", "cannula out"), ("8", "end of surgery"), ("9", "CSF restored")):
            e = run.electrode("right", label)
            t = np.array(e["outward"])
            off = np.array(e["nodes_mm"]) - np.array(e["target_mm"])
            along = off @ t
            forwards = np.array([0, 1.0, 0]) - t[1] * t
            forwards /= np.linalg.norm(forwards)
            axis.plot(along, off @ forwards, label=f"{label}: {text}")
        axis.axhline(0, color="0.6", linewidth=0.8)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("from the target to the burr hole, mm")
    axes[0][0].set_ylabel("forwards of the planned line, mm")
    axes[0][0].legend(fontsize=8)
    save(figure, path)


def tornado(runs, measure, title, path):
    figure, axes = plt.subplots(1, len(STUDIED), figsize=(4.6 * len(STUDIED), 4.6), squeeze=False,
                                sharey=True)
    names = list(SENSITIVITY)
    for axis, scene in zip(axes[0], STUDIED):
        base = runs[scene, "base", 0]
        axis.set_title(f"{scene[0]}, {scene[1]}, {scene[2]} mL", fontsize=9)
        if not base.converged:
            continue
        middle = measure(base)
        for y, name in enumerate(names):
            for i, colour in ((0, "tab:cyan"), (1, "tab:purple")):
                run = runs.get((scene, name, i))
                if run is None or not run.converged:
                    continue
                axis.barh(y, measure(run) - middle, left=middle, color=colour, alpha=0.75)
        axis.axvline(middle, color="k", linewidth=0.8)
        axis.set_yticks(range(len(names)), names, fontsize=7)
    axes[0][0].invert_yaxis()   # of all: they share it
    for axis in axes[0]:
        axis.set_xlabel(title + ", mm (blue: first named end, purple: second)", fontsize=8)
    save(figure, path)
