"""Pages of panels: what is written and drawn over what head_scene draws."""
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import Normal, Stroke
from PIL import Image

from head_scene import AIR, BONE, BONE_THICKNESS, BURR_HOLE, FALX, FLUID, LEVEL, REST, unit
from vtk_parts import COLOURS, CONTACT, LEAD

LETTERS = (("L", "R"), ("P", "A"), ("I", "S"))   # RAS
WORDS = (("left", "right"), ("backwards", "forwards"), ("downwards", "upwards"))
DEFLECTION, TIMES = "#d0008f", 10.0   # its colour, and how many times it is drawn
PLANNED = {"color": "white", "linewidth": 0.9, "dashes": (4.0, 4.0), "dash_capstyle": "butt",
           "path_effects": [Stroke(linewidth=1.5, foreground="#555555"), Normal()]}   # legible on anything
HALO = [Stroke(linewidth=3.0, foreground="white"), Normal()]
PLATE = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 1}   # under words
plt.rcParams.update({"font.family": "DejaVu Sans", "font.size": 9, "savefig.dpi": "figure"})


def letter(direction, words=LETTERS):
    axis = int(np.argmax(np.abs(direction)))
    return words[axis][int(direction[axis] > 0.0)]


def stage_title(stage):
    return f"Stage {stage['stage']}: {stage['title']}"


def fluid_words(scene, stage, between="   |   "):
    """Air and level of each side; levels count from the full fluid of stage 0."""
    words = []
    for side in ("right", "left"):
        s = stage["sides"][side]
        fallen = scene.stages[0]["sides"][side]["level_mm"] - s["level_mm"]
        words.append(f"{side}: {s['air_mL']:.1f} mL of air, level {fallen:.1f} mm lower" if s["open"]
                     else f"{side}: closed, full")
    return between.join(words)


def lead_words(stage, side):
    lead = stage["electrodes"].get(side)
    if lead is None:
        return "no electrode yet"
    if lead["device"] == "cannula":
        return "cannula in, on the planned line"
    tip = np.linalg.norm(np.subtract(lead["tip_mm"], lead["target_mm"]))
    held = " in its cannula" if lead["in_cannula"] else ""
    bow = f"bow {lead['bow_mm']:.2f} mm"
    if lead["bow_mm"] > 0.005:
        bow += f" {letter(lead['bow_direction'], WORDS)}"
    return f"{lead['device']}{held}: tip {tip:.2f} mm from target, {bow}"


def deflected(lead, times):
    """Nodes of a lead, what they are off the planned line drawn `times` as large."""
    target, outward = np.array(lead["target_mm"]), np.array(lead["outward"])
    off = np.array(lead["nodes_mm"]) - target
    along = np.outer(off @ outward, outward)
    return target + along + times * (off - along)


# One panel.

def draw_lines(axis, panel, scene, stage, side):
    """The planned line, the burr hole, and the lead's deflection enlarged."""
    if side not in scene.plans:
        return
    target, hole = scene.plans[side]
    outward = unit(hole - target)
    axis.plot(*panel.project(np.array([hole + (0.5 + t) * outward for t in (0.0, BONE_THICKNESS)])),
              color="white", linewidth=2 * BURR_HOLE * axis_points_per_mm(axis, panel),
              solid_capstyle="butt")
    axis.plot(*panel.project([target, hole + 14.0 * outward]), **PLANNED)
    lead = stage["electrodes"].get(side)
    if lead is not None and not lead["in_cannula"] and lead["device"] != "cannula":
        x, y = panel.project(deflected(lead, TIMES))
        axis.plot(x, y, color="white", linewidth=3.2)
        axis.plot(x, y, color=DEFLECTION, linewidth=1.8)
        axis.plot(x[:1], y[:1], "o", color=DEFLECTION, markeredgecolor="white", markersize=5)


def axis_points_per_mm(axis, panel):
    box = axis.get_window_extent()
    return 72.0 / axis.figure.dpi * min(box.width, box.height) / panel.height


def draw_letters(axis, panel):
    left, right, bottom, top = panel.extent()
    inset = 0.03 * panel.height
    for direction, x, y in ((panel.view.right, right - inset, 0.0), (-panel.view.right, left + inset, 0.0),
                            (panel.view.up, 0.0, top - inset), (-panel.view.up, 0.0, bottom + inset)):
        axis.text(x, y, letter(direction), ha="center", va="center", fontsize=10, fontweight="bold",
                  bbox=PLATE)


def draw_triad(axis, panel):
    """Arrows to the front, the top and a side of the head, as they look from here."""
    left, _, bottom, _ = panel.extent()
    length = 0.085 * panel.height
    start = np.array([left + 0.13 * panel.height, bottom + 0.13 * panel.height])
    side = np.eye(3)[0] * (1.0 if panel.view.towards_eye[0] >= 0.0 else -1.0)
    for direction in (np.eye(3)[1], np.eye(3)[2], side):
        way = np.array([direction @ panel.view.right, direction @ panel.view.up]) * length
        if np.linalg.norm(way) < 0.25 * length:
            continue   # it points at the reader
        axis.annotate("", start + way, start, arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1})
        axis.text(*(start + way + 0.035 * panel.height * unit(way)), letter(direction), ha="center",
                  va="center", fontsize=9, fontweight="bold")


def draw_gravity(axis, panel, scene):
    """Where gravity lies in the plane of the picture."""
    if panel.view.up @ scene.up < 0.9:
        return
    _, right, bottom, _ = panel.extent()
    x, y = right - 0.05 * panel.height, bottom + 0.04 * panel.height
    axis.annotate("", (x, y), (x, y + 0.10 * panel.height),
                  arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1.2, "path_effects": HALO})
    axis.text(x - 0.02 * panel.height, y + 0.05 * panel.height, "gravity", ha="right", va="center",
              fontsize=7.5, bbox=PLATE)


def draw_ruler(axis, panel, length):
    left, _, bottom, _ = panel.extent()
    x, y = left + 0.04 * panel.height, bottom + 0.04 * panel.height
    axis.plot([x, x + length], [y, y], color="black", linewidth=2.5, solid_capstyle="butt",
              path_effects=[Stroke(linewidth=4.5, foreground="white"), Normal()])
    axis.text(x, y + 0.015 * panel.height, f"{length:g} mm", va="bottom", fontsize=7.5, bbox=PLATE)


def draw_panel(axis, scene, view, stage, title=None):
    box = axis.get_window_extent()
    panel = scene.draw(view, stage, round(1.2 * min(box.width, box.height)))
    extent = panel.extent()
    axis.imshow(panel.image, extent=extent, interpolation="antialiased")
    axis.set_xlim(extent[:2])
    axis.set_ylim(extent[2:])
    axis.set_axis_off()
    if title is not None:
        axis.set_title(title, fontsize=9, pad=4)
    if view.at is None:
        draw_triad(axis, panel)
    else:
        draw_lines(axis, panel, scene, stage, view.side)
        draw_letters(axis, panel)
        draw_ruler(axis, panel, 20.0 if panel.height > 100.0 else 10.0)
    draw_gravity(axis, panel, scene)


# What explains them.

def legend(figure, where, leads, columns, space=True):
    entries = [Patch(facecolor=AIR, label="air"), Patch(facecolor=FLUID, label="cerebrospinal fluid"),
               Patch(facecolor=BONE, label="skull (drawn 6 mm thick)"),
               Line2D([], [], color=FALX, linewidth=2, label="falx, tentorium"),
               Line2D([], [], color=REST, label="brain before surgery")]
    if space:
        entries.append(Patch(facecolor=LEVEL, alpha=0.4, label="fluid level (in space)"))
    if leads:
        entries += [Line2D([], [], color=LEAD, linewidth=3, label="cannula, lead"),
                    Line2D([], [], color=CONTACT, linewidth=3, label="its contacts"),
                    Line2D([], [], label="planned line", **PLANNED),
                    Line2D([], [], color=DEFLECTION, linewidth=1.8, marker="o", markersize=4,
                           label=f"lead, off that line ×{TIMES:g}")]
    figure.legend(handles=entries, loc="center", bbox_to_anchor=where, ncol=columns, frameon=False,
                  fontsize=8.5)


def colour_bar(figure, scene, box, horizontal=True):
    axis = figure.add_axes(box)
    bar = figure.colorbar(ScalarMappable(Normalize(0.0, scene.largest), COLOURS), cax=axis,
                          orientation="horizontal" if horizontal else "vertical")
    bar.set_label("displacement of the brain since stage 0, mm")
    bar.ax.tick_params(labelsize=8)


def remarks(scene):
    words = "Right of the head on the left in axial and coronal cuts"
    return words + (f"; motion drawn ×{scene.magnify:g}" if scene.magnify != 1.0 else "") + "."


# Pages.

def stage_page(scene, stage, options):
    """All views of one stage."""
    figure = plt.figure(figsize=(15.0, 9.4))
    side = stage["title"].split(",")[0]
    if side not in ("right", "left"):
        side = next(iter(scene.plans), "right")
    figure.suptitle(stage_title(stage), x=0.015, y=0.985, ha="left", fontsize=16, fontweight="bold")
    figure.text(0.015, 0.928, fluid_words(scene, stage), fontsize=10.5)
    big = figure.add_axes([0.0, 0.16, 0.46, 0.735])
    draw_panel(big, scene, scene.space(side), stage, scene.space(side).title)
    cuts = [(scene.axial(options.axial), None), (scene.coronal(options.coronal), None),
            (scene.along("right", options.sagittal), "right"), (scene.along("left", options.sagittal), "left")]
    for i, (view, lead) in enumerate(cuts):
        axis = figure.add_axes([0.465 + 0.268 * (i % 2), 0.535 - 0.412 * (i // 2), 0.265, 0.365])
        words = f"{view.title}\n{lead_words(stage, lead)}" if lead in scene.plans else view.title
        draw_panel(axis, scene, view, stage, words)
    colour_bar(figure, scene, [0.04, 0.085, 0.36, 0.02])
    legend(figure, (0.71, 0.055), bool(scene.plans), 5)
    figure.text(0.985, 0.012, remarks(scene), ha="right", fontsize=8.5)
    return figure


def side_page(scene, side, _):
    """Contact sheet: every stage from one side, in space and along its electrode."""
    columns = 3
    rows = -(-len(scene.stages) // columns)
    width, height = 18.0, 3.35 * rows + 1.5
    figure = plt.figure(figsize=(width, height))
    figure.suptitle(f"All stages, {side} side", x=0.012, y=1.0 - 0.2 / height, va="top", ha="left",
                    fontsize=16, fontweight="bold")
    for i, stage in enumerate(scene.stages):
        left, top = (i % columns) / columns, 1.0 - (0.65 + 3.35 * (i // columns)) / height
        figure.text(left + 0.012, top - 0.03 / height, stage_title(stage), fontsize=11, fontweight="bold",
                    va="top")
        state = stage["sides"][side]
        air = f"{state['air_mL']:.1f} mL of air on the {side}; " if state["open"] else f"{side} closed; "
        figure.text(left + 0.012, top - 0.25 / height, air + lead_words(stage, side), fontsize=8.5, va="top")
        for j, view in enumerate((scene.space(side), scene.along(side))):
            axis = figure.add_axes([left + (0.1 + 2.95 * j) / width, top - 3.28 / height, 2.85 / width,
                                    2.85 / height])
            draw_panel(axis, scene, view, stage)
    colour_bar(figure, scene, [0.03, 0.52 / height, 0.28, 0.14 / height])
    legend(figure, (0.66, 0.42 / height), bool(scene.plans), 5)
    return figure


def first_and_both(scene):
    """Stages before any loss, after that of the first side, and after that of both."""
    opened = [sum(s["sides"][side]["open"] for side in ("right", "left")) for s in scene.stages]
    wanted = [(0, "before surgery"), (1, "after the first craniotomy"), (2, "after both")]
    return [(scene.stages[max(i for i, n in enumerate(opened[:last_open(opened) + 1]) if n == number)], words)
            for number, words in wanted if number in opened]


def last_open(opened):
    return max((i for i, n in enumerate(opened) if n), default=0)


def shift_page(scene, options):
    """The asymmetry of the shift: figure 3 of Bilger et al., MICCAI 2011."""
    chosen = first_and_both(scene)
    figure = plt.figure(figsize=(5.0 * len(chosen), 11.3))
    for i, (stage, words) in enumerate(chosen):
        left, wide = i / len(chosen), 1.0 / len(chosen)
        figure.text(left + 0.5 * wide, 0.980, f"({'abc'[i]}) {words}", ha="center", fontsize=14,
                    fontweight="bold")
        figure.text(left + 0.5 * wide, 0.966, "\n".join((stage_title(stage), fluid_words(scene, stage, "\n"))),
                    ha="center", va="top", fontsize=9)
        for j, view in enumerate((scene.front(), scene.axial(options.axial))):
            axis = figure.add_axes([left + 0.01, 0.505 - 0.40 * j, wide - 0.02, 0.40])
            draw_panel(axis, scene, view, stage, view.title)
    colour_bar(figure, scene, [0.06, 0.058, 0.30, 0.016])
    legend(figure, (0.70, 0.042), False, 3)
    figure.text(0.985, 0.006, remarks(scene), ha="right", fontsize=8.5)
    return figure


def lead_page(scene, side, _):
    """How a lead bends: figure 4 of Bilger et al., MICCAI 2011."""
    free = [s for s in scene.stages if side in s["electrodes"] and not s["electrodes"][side]["in_cannula"]]
    chosen = [free[0], free[-1]]
    target, hole = scene.plans[side]
    figure = plt.figure(figsize=(13.0, 8.0))
    for i, (stage, words) in enumerate(zip(chosen, ("after the cannula's removal", "at the end"))):
        view = scene.along(side)
        view.centre, view.height = 0.5 * (target + hole), 1.5 * np.linalg.norm(hole - target)
        axis = figure.add_axes([0.01 + 0.495 * i, 0.15, 0.485, 0.73])
        draw_panel(axis, scene, view, stage, lead_words(stage, side))
        figure.text(0.25 + 0.495 * i, 0.945, f"({'ab'[i]}) {words}: stage {stage['stage']}, {stage['title']}",
                    ha="center", fontsize=12, fontweight="bold")
    colour_bar(figure, scene, [0.05, 0.085, 0.34, 0.02])
    legend(figure, (0.70, 0.065), True, 3, space=False)
    return figure


def panel_page(scene, view, stage):
    """One panel alone, for pages that say the rest themselves."""
    figure = plt.figure(figsize=(3.3, 3.3), dpi=160)   # small: its words are to be read at the width of a phone
    draw_panel(figure.add_axes([0, 0, 1, 1]), scene, view, stage)
    return figure


# Files.

def png(figure, small=False):
    """A page as a PNG; small: with 64 levels per colour, which nobody sees and which packs better."""
    buffer = io.BytesIO()
    figure.savefig(buffer, metadata={"Software": None})
    plt.close(figure)
    if not small:
        return buffer.getvalue()
    levels = np.asarray(Image.open(buffer).convert("RGB"), dtype=float) / 255.0
    image = Image.fromarray((np.round(levels * 63.0) * (255.0 / 63.0)).round().astype(np.uint8))
    packed = io.BytesIO()
    image.save(packed, "PNG", optimize=True)
    return packed.getvalue()
