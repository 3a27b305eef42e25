#!/usr/bin/python3
"""A label map -> head, procedure on it, and results in the label map's frame. Started by
examples/own_head/run, which gives --mesher and --dbs; README.md says what goes in and comes out."""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples/head"))  # frame.py and the package chain

import check_head  # noqa: E402
import frame as drawn  # noqa: E402
import generic  # noqa: E402
import interrupts  # noqa: E402
import labels  # noqa: E402
import materials  # noqa: E402
import placement  # noqa: E402
import plan as plans  # noqa: E402
import results  # noqa: E402
import shape  # noqa: E402
from chain import build, midsurface, vtkxml  # noqa: E402
from problem import Problem, point  # noqa: E402
from procedure import operate  # noqa: E402
from progress import Progress  # noqa: E402

ATTEMPTS = 4  # at a sound mesh, with sulci filled by 1 mm more each time
REPORT = ["/usr/bin/python3", "-B", ROOT / "examples/dbs/report.py"]
MARK = "own_head.json"  # in every folder of results: what may be replaced


def read_options(arguments):
    parser = argparse.ArgumentParser(
        prog="own_head", description="A label map -> head, procedure, results in its frame.",
        epilog="What follows -- goes to dbs: examples/own_head/run LABELS --out DIR -- --right 35mm")
    parser.add_argument("image", metavar="LABELS", help="label map: .nii, .nii.gz or FreeSurfer's .mgz")
    parser.add_argument("--labels", default="freesurfer", metavar="DICTIONARY",
                        help="freesurfer (default), or a JSON file: what the values are")
    parser.add_argument("--plan", nargs="+", default=[], type=pathlib.Path, metavar="FILE",
                        help=".mrk.json files of 3D Slicer, or folders of them: lines are trajectories, "
                             "points are landmarks")
    parser.add_argument("--materials", type=pathlib.Path, metavar="FILE",
                        help="JSON: parts of the brain by their labels, with materials of their own")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder for head and results")
    parser.add_argument("--edge", type=float, default=6.6, help="mean edge of the tets, mm (default 6.6)")
    parser.add_argument("--spacing", type=float, default=1.0,
                        help="voxels of the segmentation that is meshed, mm (default 1)")
    parser.add_argument("--closing", type=float, default=3.0,
                        help="sulci are filled by a ball of this radius, mm (default 3)")
    parser.add_argument("--fields", default="", metavar="STAGES",
                        help="stages, by their labels and commas, or all, whose displacement is written as "
                             "NIfTI (default: the end of surgery and the last)")
    parser.add_argument("--head-only", action="store_true", help="make the head, without a procedure")
    parser.add_argument("--report", type=pathlib.Path, metavar="FILE",
                        help="write a page about the procedure too: tables, charts, pictures, without a network")
    parser.add_argument("--progress", choices=("auto", "line", "json", "none"), default="auto",
                        help="on stderr. auto (default): a line where that is a terminal, else nothing; json: an "
                             "object per line")
    parser.add_argument("--quiet", action="store_true", help="no progress, whatever --progress says")
    parser.add_argument("--mesher", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--dbs", help=argparse.SUPPRESS)
    own, _, rest = split(arguments)
    options = parser.parse_args(own)
    options.dbs_options = rest
    for name, low, high in (("edge", 2, 20), ("spacing", 0.5, 3), ("closing", 0.5, 8)):
        if not low <= getattr(options, name) <= high:
            raise Problem(f"--{name} {getattr(options, name):g}: give {low:g} to {high:g} mm")
    return options


def split(arguments):
    """What stands before and after --."""
    cut = arguments.index("--") if "--" in arguments else len(arguments)
    return arguments[:cut], "--", arguments[cut + 1:]


def say(notes):
    for note in notes:
        print(f"  note: {note}", flush=True)


def sorted_labels(options):
    """Image, parts and materials, checked; notes."""
    image = labels.read_map(options.image)
    dictionary = labels.read_dictionary(options.labels)
    parts = labels.sort(image, dictionary, options.labels)
    labels.check_parts(image, parts, dictionary, options.labels)
    notes = labels.check_holes(image, parts)
    apart, more = labels.check_connected(image, parts)
    parts.kind[apart] = labels.BACKGROUND
    stuff = []
    if options.materials:
        stuff = materials.read(options.materials, dictionary, np.unique(image.values))
    return image, parts, stuff, notes + more


def place(image, parts, plan, generic_head):
    """The head frame, and the mid-surface in it."""
    points = placement.fissure_points(image, parts)
    plane = placement.fissure_plane(image.path, points)
    given = [name for name in ("AC", "PC") if name in plan.landmarks]
    if len(given) == 1:
        other = "PC" if given == ["AC"] else "AC"
        raise Problem(f"{plan.sources[given[0]]}: has {given[0]} but not {other}: give both, or none and let "
                      "them be derived from the thalami")
    if given:
        ac, pc = plan.landmarks["AC"], plan.landmarks["PC"]
        placement.check_commissures(ac, pc, plane, plan.sources)
    else:
        ac, pc = placement.derive_commissures(image, parts, plane, generic_head)
        plan.landmarks.update(AC=ac, PC=pc)
        plan.notes.append(f"AC {point(ac)} and PC {point(pc)} RAS are derived from the thalami and the poles, "
                          "give or take 4 mm: give them as landmarks if you have them")
    frame = placement.frame_of(plane[0], ac, pc)
    placement.upright(image, parts, frame)
    points = np.vstack([points, placement.stem_points(image, parts)])
    return frame, *placement.midline_sheet(points, frame)


def goals_of(plan, lines, frame, landmarks, sheet, anatomy):
    """Side -> (target, direction outwards), head frame; targets become landmarks."""
    def depth_of(position):
        return -float(anatomy.grid.sample(anatomy.brain, [position])[0])

    for name, position in sorted(landmarks.items()):
        if name in plan.landmarks and name.startswith(("STN_", "GPi_")):
            plans.check_inside(name, position, plan.sources[name], plan.systems[name], frame, depth_of)
    goals = {}
    for side, line in lines.items():
        target, entry = frame.to_head(line.target), frame.to_head(line.entry)
        name = f"the target of the {side} trajectory"
        plans.check_inside(name, target, line.source, line.system, frame, depth_of)
        direction = (entry - target) / np.linalg.norm(entry - target)
        check_way(line, side, target, direction, sheet, anatomy)
        goals[side] = (target, direction)
        off = target - landmarks["MCP"]
        plan.notes.append(f"the {side} target lies {abs(off[0]):.1f} mm lateral, {off[1]:+.1f} mm along and "
                          f"{off[2]:+.1f} mm above the commissures from their middle")
    if not goals:
        plan.notes.append("no trajectory is given: the tips go to the STN, 60 degrees above the commissures, "
                          "20 degrees to the side")
        goals = {side: (landmarks[f"STN_{side}"], drawn.trajectory_direction(side)) for side in plans.SIDES}
    landmarks.update({f"target_{side}": target for side, (target, _) in goals.items()})
    return goals


def check_way(line, side, target, direction, sheet, anatomy):
    """From the target outwards the way leads up and stays on its side."""
    if direction[2] <= 0:
        raise Problem(f"{line.source}: the {side} trajectory leads downwards from its target: entry and target "
                      "are exchanged, so name the points 'entry' and 'target'")
    way = target + np.arange(0, 140, 1.0)[:, None] * direction
    way = way[anatomy.grid.sample(anatomy.cavity, way) < 0]
    off = way[:, 0] - midsurface.evaluate(sheet, way[:, 1], way[:, 2])
    if (off * (1 if side == "right" else -1)).min() < 1:
        raise Problem(f"{line.source}: the {side} trajectory crosses the midline: move its entry to the side")


def make_head(options, work, out, progress):
    """The head folder; returns what the results need: image, frame and sides."""
    generic_head = generic.Generic(ROOT / "examples/head/data/coarse")
    progress.begin("labels")
    image, parts, stuff, notes = sorted_labels(options)
    plan = plans.read(options.plan)
    frame, sheet, rms = place(image, parts, plan, generic_head)
    landmarks = plans.complete(plan, frame, parts.landmarks)
    lines = plans.assign(plan, frame, lambda p: placement.middle_at(sheet, p))
    notes += plan.notes
    plan.notes = []
    say(notes)
    for radius in options.closing + np.arange(ATTEMPTS):
        progress.begin("skull, falx, mid-surface")
        volumes = shape.resample(image, parts, frame, options.spacing)
        anatomy, derived = shape.derive(image, volumes, frame, sheet, rms, landmarks["PC"], generic_head,
                                        parts.landmarks.get("optic_chiasm"), radius)
        goals = goals_of(plan, lines, frame, landmarks, sheet, anatomy)
        say(derived + plan.notes)
        tissue = np.isin(parts.kind, (labels.CEREBRUM, labels.BRAINSTEM, labels.CEREBELLUM))
        head = describe(options, notes + derived + plan.notes, landmarks) | build.description(anatomy)
        wrong = mesh(options, work, out, anatomy, head, goals, shape.label_at(volumes),
                     float(tissue.sum() * image.voxel_volume), progress)
        plan.notes = []
        if not wrong:
            add_materials(options, out, stuff)
            return image, frame, sorted(goals, reverse=True)
        # A loop of tissue around a furrow, mostly: it closes when furrows are filled a little further.
        notes.append(f"sulci filled by a ball of {radius:g} mm gave no sound mesh ({sentence(wrong)})")
        say(notes[-1:])
    raise Problem(f"{image.path}: the meshed head is not sound: {sentence(wrong)}; look for loops, tunnels and "
                  "gaps in the labels there, or try another --closing or a smaller --edge")


def describe(options, notes, landmarks):
    """What head.json says of where the head comes from."""
    name = pathlib.Path(options.image).name
    return {"name": name, "requested_edge": options.edge, "source": f"made by examples/own_head from {name}",
            "frame": "RAS", "units": "mm", "density_kg_per_mm3": drawn.DENSITY,
            "landmarks": dict(landmarks), "notes": notes}


def mesh(options, work, out, anatomy, head, goals, label_of, tissue, progress):
    """Writes the head folder. Returns the row of the head table that is out of range, if any."""
    progress.begin("meshes")
    try:
        build.build(anatomy, options.mesher, work, options.edge, out, head, goals,
                    {"whole_brain_mask": tissue}, label_of)
    except (subprocess.CalledProcessError, IndexError, ValueError) as error:
        raise Problem(f"{options.image}: could not be meshed ({' '.join(str(error).split())}): try another "
                      "--closing or --edge") from error
    progress.begin("check")
    wrong = check_head.check(out, record=True, quiet=True)
    return wrong[0] if wrong else None


def add_materials(options, out, stuff):
    """Those of parts of the brain, beside the meshes."""
    if not stuff:
        return
    cells = vtkxml.read(out / "brain.vtu")[2]
    materials.check_meshed(options.materials, stuff, cells["label"])
    materials.write(out / "materials.json", stuff)


def sentence(row):
    return f"{row['name']} is {row['value']:g}, but {range_of(row)} is needed"


def range_of(row):
    low, high = row["low"], row["high"]
    if low == high:
        return f"{low:g}"
    return f"at least {low:g}" if high is None else f"{low:g} to {high:g}"


def refuse_foreign(out):
    """Only an empty folder, or one of earlier results, is replaced."""
    if out.exists() and (not out.is_dir() or (any(out.iterdir()) and not (out / MARK).exists())):
        raise Problem(f"--out {out}: is not a folder of earlier results, so it is left as it is: name another "
                      "one")


def check_fields(fields):
    """Labels of stages, before minutes have passed."""
    for name in fields.split(",") if fields not in ("", "all") else ():
        if name.strip() not in results.STAGES:
            raise Problem(f"--fields {fields}: there is no stage '{name.strip()}': choose of "
                          f"{', '.join(results.STAGES)}, or all")


def check_report(options):
    if options.report and options.head_only:
        raise Problem("--report: is about a procedure: leave it or --head-only out")
    if options.report and subprocess.run([*REPORT, "--check"]).returncode:
        raise Problem("--report: no page can be drawn here: install what it needs (cmake/install-deps.sh docs)")


def write_report(options):
    """A page about the results in --out, as examples/run --report makes it."""
    command = [*REPORT, "--head", options.out / "head", options.out / "procedure", "--out", options.report]
    if subprocess.run(command).returncode:
        raise Problem(f"--report {options.report}: was not written, for the reason above; the results are in "
                      f"{options.out}")


def work_out(options, folder, work, progress):
    """All that is written, into `folder`; returns the exit code of dbs."""
    image, frame, sides = make_head(options, work, folder / "head", progress)
    code = 0
    if not options.head_only:
        progress.begin("procedure")
        code = operate(options, folder, sides, progress)
        progress.begin("results in the frame of the label map")
    # What is there by now is kept: a first signal is noted and told in the end.
    with interrupts.handled_by(lambda number: None):
        if not options.head_only:
            say(results.write(folder, image, frame, options.fields))
        results.write_mark(folder / MARK, options, frame)
        if options.out.exists():
            shutil.rmtree(options.out)
        folder.rename(options.out)
    return code


def run(options, progress):
    refuse_foreign(options.out)
    check_fields(options.fields)
    check_report(options)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    # All is made beside --out and takes its place at the end: nothing half-written stays.
    with tempfile.TemporaryDirectory(prefix=f".{options.out.name}.", dir=options.out.parent) as beside:
        folder, work = pathlib.Path(beside) / "results", pathlib.Path(beside) / "work"
        work.mkdir()
        code = work_out(options, folder, work, progress)
    print(f"written to {options.out}", flush=True)
    if interrupts.number:
        progress.end("interrupted", f"interrupted; {options.out} has what was finished")
        return interrupts.exit_status()
    if options.report:
        write_report(options)
    if code:
        progress.end("failed", "a stage of the procedure found no balance of forces (the table says which); "
                     f"the stages before it are in {options.out}: lose less fluid, or try a smaller --edge")
        return 1
    progress.end("done")
    return 0


def main():
    interrupts.catch()
    progress = Progress("none")  # until the options are read
    try:
        options = read_options(sys.argv[1:])
        progress = Progress("none" if options.quiet else options.progress, options.head_only)
        return run(options, progress)
    except KeyboardInterrupt:
        progress.end("interrupted", "interrupted; nothing was written")
        return interrupts.exit_status()
    except Problem as problem:
        progress.end("error", str(problem))
        return 1


if __name__ == "__main__":
    sys.exit(main())
