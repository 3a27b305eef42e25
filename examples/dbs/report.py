#!/usr/bin/python3
"""One page about a run of dbs: tables, charts and pictures of every stage.

    examples/dbs/report.py --head examples/head/data/medium out/dbs --out report.html

The page holds all it shows and fetches nothing. Needs python3-vtk9 and python3-matplotlib, and where there
is no display xvfb (cmake/install-deps.sh docs)."""
import argparse
import base64
import hashlib
import importlib.util
import json
import math
import os
import platform
import sys
from html import escape
from pathlib import Path

SIDES = ("right", "left")
# Nothing but what is in the page: the browser is told to refuse the rest.
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
LIMITS = (
    "Ventricles and sulci are filled with tissue; skull, falx and tentorium are rigid.",
    "What holds the brain in full fluid beside its stem is a spring per area set by one observation.",
    "A lead in elements wider than itself is felt at their size unless --local-give is set; its bending "
    "stiffness is not published.",
    "Fluid is lost as asked for: whether gravity would drain it through the burr hole is only remarked on.",
)


def parse():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path, nargs="?", help="folder written by dbs")
    parser.add_argument("--head", type=Path, help="folder of the head")
    parser.add_argument("--out", type=Path, help="the page")
    parser.add_argument("--check", action="store_true", help="only whether all is there that a page needs")
    options = parser.parse_args()
    if not options.check and not (options.results and options.head and options.out):
        parser.error("needs the results' folder, --head and --out")
    return options


def check_packages():
    """Ends with a sentence where something is not installed."""
    missing = [name for name in ("vtk", "matplotlib") if importlib.util.find_spec(name) is None]
    if missing:
        sys.exit(f"no Python module {missing[0]} in {sys.executable} (cmake/install-deps.sh docs)")


# Tables. A cell says in `data-key` which column of the result files it holds.

def size(vector):
    return math.sqrt(sum(x * x for x in vector))


def fixed(value, digits):
    text = f"{value:.{digits}f}"
    return text.lstrip("-") if float(text) == 0.0 else text   # no -0.000


def stage_cells(stage):
    """Key and text of the numbers in a row of the stage table."""
    sides = stage["sides"]
    for side in SIDES:
        yield f"air_{side}_mL", fixed(sides[side]['air_mL'], 2)
    for side in SIDES:
        yield f"level_{side}_mm", fixed(sides[side]['level_mm'], 2)
    for side in SIDES:
        yield f"surface_{side}_mm", fixed(sides[side]['largest_surface_motion_mm'], 3)
    yield "midline_shift_mm", fixed(stage['midline_shift_mm'], 3)
    for side in SIDES:
        for k, axis in enumerate("xyz"):
            yield f"STN_{side}_{axis}_mm", fixed(stage['shift_mm'][f'STN_{side}'][k], 3)
    yield "residual", f"{stage['solve']['residual']:.1e}"


def electrode_cells(lead):
    from charts import strongest_tie, tip_off_target
    for k, axis in enumerate("xyz"):
        yield f"tip_{axis}_mm", fixed(lead['tip_mm'][k], 3)
    yield "tip_off_target_mm", fixed(tip_off_target(lead), 3)
    yield "bow_mm", fixed(lead['bow_mm'], 3)
    for name, key in (("cannula", "D_since_cannula_left"), ("surgery", "D_since_end_of_surgery")):
        for frame in ("skull", "tissue"):
            value = lead[key] and lead[key][f"{frame}_mm"]
            yield f"D_{frame}_since_{name}_mm", "–" if value is None else fixed(value, 3)
    yield "skull_force_mN", fixed(size(lead['force_of_skull_or_frame_mN']), 1)
    yield "strongest_tie_mN", fixed(strongest_tie(lead), 1)


def row(words, cells):
    return ("<tr>" + "".join(f'<td class="word">{escape(w)}</td>' for w in words) +
            "".join(f'<td data-key="{key}">{escape(text)}</td>' for key, text in cells) + "</tr>")


def table(name, head, rows):
    return (f'<div class="wide" tabindex="0"><table id="{name}"><thead>{head}</thead><tbody>' +
            "\n".join(rows) + "</tbody></table></div>")


def heading(words, groups):
    """Two rows: words that span both, and titles over columns."""
    first = "".join(f'<th class="word" rowspan="2">{w}</th>' for w in words)
    first += "".join(f'<th colspan="{len(columns)}">{title}</th>' for title, columns in groups)
    second = "".join(f"<th>{c}</th>" for _, columns in groups for c in columns)
    return f"<tr>{first}</tr><tr>{second}</tr>"


def stage_table(stages):
    head = heading(("stage", ""), (
        ("air, mL", ("right", "left")), ("fluid level, mm", ("right", "left")),
        ("surface, mm", ("right", "left")), ("midline, mm", ("",)),
        ("shift of the right STN, mm", "xyz"), ("of the left STN, mm", "xyz"), ("residual", ("",))))
    return table("stages", head, [row((s["stage"], s["title"]), stage_cells(s)) for s in stages])


def electrode_table(stages):
    head = heading(("stage", "side", "device"), (
        ("tip, mm", "xyz"), ("off target", ("mm",)), ("bow", ("mm",)),
        ("D since cannula out, mm", ("skull", "tissue")), ("D since surgery, mm", ("skull", "tissue")),
        ("force, mN", ("skull", "tie"))))
    rows = [row((s["stage"], side, lead["device"] + (", in cannula" if lead["in_cannula"] and
                                                     lead["device"] != "cannula" else "")),
                electrode_cells(lead))
            for s in stages for side, lead in sorted(s["electrodes"].items(), reverse=True)]
    return table("electrodes", head, rows)


def material_words(material):
    return (f"{material['law']}, E {material['young_kPa']:g} kPa, nu {material['poisson']:g}, "
            f"{material['density_kg_m3']:g} kg/m³; {material['volume_mL']:.1f} mL")


def parameters(table):
    """Options, and materials of parts of the brain."""
    parts = {f"material of {m['name']}": material_words(m) for m in table.get("materials", [])}
    return table["options"] | parts


def parameter_list(options):
    def show(value):
        if value is None or value == "" or value == []:
            return "–"
        return ("yes" if value else "no") if isinstance(value, bool) else str(value)
    rows = [f"<div><dt>{escape(k)}</dt><dd>{escape(show(v))}</dd></div>" for k, v in sorted(options.items())]
    return '<dl id="parameters">' + "\n".join(rows) + "</dl>"


# Pictures.

def image(kind, data, words):
    text = base64.b64encode(data).decode()
    return f'<img src="data:image/{kind};base64,{text}" alt="{escape(words, quote=True)}">'


def figure(picture, caption):
    return f"<figure>{picture}<figcaption>{escape(caption)}</figcaption></figure>"


def views_of(scene, stage):
    from layout import lead_words
    side = stage["title"].split(",")[0]
    side = side if side in SIDES else next(iter(scene.plans), "right")
    yield scene.space(side), f"From the {side}, skull cut open"
    yield scene.axial(25.0), "Axial, z = 25 mm; right of the head on the left"
    for other in SIDES:
        view = scene.along(other)
        if other in scene.plans:
            yield view, f"Along the {other} electrode: {lead_words(stage, other)}"
        else:
            yield view, view.title[0].upper() + view.title[1:] + ", where no electrode is"


def stage_views(scene, stage):
    from layout import fluid_words, panel_page, png, stage_title
    title = stage_title(stage)
    pictures = [figure(image("png", png(panel_page(scene, view, stage), True), f"{title}. {words}"), words)
                for view, words in views_of(scene, stage)]
    remark = f'<p class="note">{escape(stage["remark"])}</p>' if stage["remark"] else ""
    return (f'<section id="stage_{stage["stage"]}"><h3>{escape(title)}</h3>'
            f'<p class="small">{escape(fluid_words(scene, stage))}</p>{remark}'
            f'<div class="grid">{"".join(pictures)}</div></section>')


def key_figure(scene):
    """Colours of the pictures."""
    from charts import svg
    from layout import colour_bar, legend, plt
    page = plt.figure(figsize=(4.6, 2.6))
    colour_bar(page, scene, [0.05, 0.84, 0.90, 0.07])
    legend(page, (0.5, 0.28), bool(scene.plans), 2)
    return figure(image("svg+xml", svg(page).encode(), "Key to the pictures"), "").replace(
        "<figure>", '<figure class="key">')


# The page.

def limits(scene, head):
    """Of this run, and of all."""
    if "scale" in json.loads((head / "head.json").read_text(encoding="utf-8")):   # a generic one is scaled
        yield "The head is generic, nobody's own."
    else:
        yield ("The head was made from labels; what they do not show (skull, falx, their distance from the brain) "
               "was derived, and is told in its head.json.")
    parts = "but in the parts that stand under the parameters" if scene.table.get("materials") else "everywhere"
    yield (f"Its tissue has one stiffness {parts}, and that of the living brain is known within a factor of "
           "several.")
    yield from LIMITS


def unfinished(scene):
    plan, done = scene.table.get("plan", []), [s["stage"] for s in scene.stages]
    left = [label for label in plan if label not in done]
    if not left:
        return ""
    return (f'<p class="note">This run ended early: of the stages {escape(" ".join(plan))}, those not finished '
            f'are {escape(" ".join(left))}.</p>')


def introduction(scene):
    head, stages = scene.table["head"], scene.stages
    last = stages[-1]
    return (f'<p>Head: {escape(head["name"])}, {head["nodes"]} nodes, {head["tets"]} tetrahedra, '
            f'{head["volume_mL"]:.1f} mL meshed. {len(stages)} stages, the last one stage '
            f'{escape(last["stage"])}: {escape(last["title"])}. Lengths in mm; frame RAS (x to the right, y to '
            "the front, z upwards in the head). Shifts count from stage 0; levels are heights against gravity "
            "from the frame's origin.</p>")


def versions(scene, results):
    import matplotlib
    import vtk
    digest = hashlib.sha256((results / "stages.json").read_bytes()).hexdigest()
    rows = {"library": scene.table.get("library", "not told"), "results": f"stages.json, SHA-256 {digest}",
            "pictures": f"VTK {vtk.vtkVersion.GetVTKVersion()}, matplotlib {matplotlib.__version__}, "
                        f"Python {platform.python_version()}"}
    return "<ul>" + "".join(f"<li>{escape(k)}: {escape(v)}</li>" for k, v in rows.items()) + "</ul>"


def body(scene, head, results):
    from charts import all_charts
    charts = "".join(figure(image("svg+xml", drawing.encode(), title), title)
                     for title, drawing in all_charts(scene.stages, list(scene.plans)))
    yield "<h1>Brain shift and electrode motion, stage by stage</h1>"
    yield ('<p class="warning">Research software, not a medical device. Nothing on this page may guide the '
           "treatment of a patient.</p>")
    yield unfinished(scene) + introduction(scene)
    yield "<h2>Stages</h2>" + stage_table(scene.stages)
    if scene.plans:
        yield "<h2>Electrodes</h2>" + electrode_table(scene.stages)
        yield ('<p class="small">D: motion of the tip along its trajectory, positive towards the burr hole, '
               "against the skull and against the tissue that was at the tip. Forces: of skull or frame on the "
               "device, and of the strongest tie to tissue.</p>")
    yield f'<h2>Charts</h2><div class="charts">{charts}</div>'
    yield "<h2>Pictures</h2>" + key_figure(scene)
    yield '<p class="small">Skull drawn 6 mm thick; only its inner table is in the model.</p>'
    for stage in scene.stages:
        yield stage_views(scene, stage)
    yield "<h2>Parameters</h2>" + parameter_list(parameters(scene.table))
    yield "<h2>Versions</h2>" + versions(scene, results)
    yield ("<h2>Limits</h2><ul>" + "".join(f"<li>{escape(text)}</li>" for text in limits(scene, head)) +
           "</ul>")


def main():
    options = parse()
    check_packages()
    from vtk_parts import need_display
    need_display()
    if options.check:
        return
    from head_scene import HeadScene
    scene = HeadScene(options.head, options.results)
    style = (Path(__file__).parent / "report.css").read_text()
    page = ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>Brain shift and electrode motion</title><style>{style}</style></head><body>\n" +
            "\n".join(body(scene, options.head, options.results)) + "\n</body></html>\n")
    part = options.out.with_name(options.out.name + ".part")
    try:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        part.write_text(page, encoding="utf-8")
        os.replace(part, options.out)
    except OSError as error:
        sys.exit(f"{options.out}: cannot be written ({error.strerror})")
    print(options.out)


if __name__ == "__main__":
    main()
