"""Charts of a report: how tissue, electrodes and fluid fare from stage to stage, as SVG."""
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLOURS = {"right": "#c44e00", "left": "#00679e"}   # told apart by the colour-blind, and by markers
MARKERS = {"right": "o", "left": "s"}


def svg(figure):
    """With text as outlines: it looks the same everywhere."""
    buffer = io.StringIO()
    with plt.rc_context({"svg.hashsalt": "dbs", "svg.fonttype": "path"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    text = buffer.getvalue()
    return text[text.index("<svg"):]


def chart(stages, ylabel, values):
    """Lines over the stages; values: name, side and one number (or NaN) per stage each."""
    figure, axis = plt.subplots(figsize=(5.4, 3.3), layout="constrained")
    places = np.arange(len(stages))
    for name, side, numbers in values:
        dashed = not name.startswith(side)   # a second quantity of the same side
        axis.plot(places, numbers, color=COLOURS[side], marker=MARKERS[side], markersize=5,
                  linewidth=1.6, linestyle="--" if dashed else "-", label=name)
    axis.set_xticks(places, [s["stage"] for s in stages])
    axis.set_xlabel("stage")
    axis.set_ylabel(ylabel)
    axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]))
    axis.grid(axis="y", color="0.88")
    axis.spines[["top", "right"]].set_visible(False)
    axis.legend(frameon=False, fontsize=9.5)
    return svg(figure)


def of_leads(stages, side, measure):
    return [measure(s["electrodes"][side]) if side in s["electrodes"] else np.nan for s in stages]


def tip_off_target(lead):
    return float(np.linalg.norm(np.subtract(lead["tip_mm"], lead["target_mm"])))


def strongest_tie(lead):
    return float(np.linalg.norm(lead["track_force_on_tissue_mN"], axis=1).max())


def all_charts(stages, sides):
    """Title and SVG of each."""
    both = ("right", "left")
    plt.rcParams.update({"font.size": 10.5})
    yield "Shift of the subthalamic nuclei since stage 0", chart(stages, "mm", [
        (f"{side} STN", side, [np.linalg.norm(s["shift_mm"][f"STN_{side}"]) for s in stages])
        for side in both])
    yield "Air in the skull", chart(stages, "mL", [
        (f"{side} side", side, [s["sides"][side]["air_mL"] for s in stages]) for side in both])
    if not sides:
        return
    yield "Tip of each electrode from its planned target", chart(stages, "mm", [
        (f"{side} tip", side, of_leads(stages, side, tip_off_target)) for side in sides])
    yield "Strongest tie between electrode and tissue", chart(stages, "mN", [
        (f"{side} electrode", side, of_leads(stages, side, strongest_tie)) for side in sides])
