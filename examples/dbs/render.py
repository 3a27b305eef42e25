#!/usr/bin/python3
"""Pictures of a run of dbs.

The brain is coloured by the size of its displacement, by one scale for all stages: in space with the skull
cut open and the near half of the brain as glass, in an axial and a coronal cut, and in a cut along each
electrode. Cuts along electrodes and views in space have gravity downwards, as on the operating table.

    examples/dbs/render.py --head examples/head/data/medium out/dbs

writes into the results folder
    stage_N.png       all views of one stage
    sheet_right.png, sheet_left.png    all stages from one side
    figure_shift.png  before surgery, after the first craniotomy, after both (figure 3 of Bilger 2011)
    figure_lead_right.png, ..._left.png   a lead after the cannula's removal and in the end (figure 4)

Needs python3-vtk9 and python3-matplotlib, and where there is no display xvfb
(cmake/install-deps.sh docs)."""
import argparse
import sys
from pathlib import Path

from vtk_parts import need_display


def parse():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=Path, help="folder written by dbs")
    parser.add_argument("--head", type=Path, required=True, help="folder of the head")
    parser.add_argument("--only", action="append", metavar="NAME",
                        help="this picture (stage_6b, sheet_left, ...); may be repeated")
    parser.add_argument("--axial", type=float, default=25.0, help="z of that cut, mm (default 25)")
    parser.add_argument("--coronal", type=float, default=40.0, help="y of that cut, mm (default 40)")
    parser.add_argument("--sagittal", type=float, default=15.0,
                        help="distance from x = 0 of cuts where there is no electrode, mm (default 15)")
    parser.add_argument("--magnify", type=float, default=1.0, help="the motion (default 1)")
    parser.add_argument("--arrows", type=float, default=0.0, metavar="FACTOR",
                        help="draw displacements as arrows, this many times their length")
    parser.add_argument("--edges", action="store_true", help="with the edges of the tets")
    parser.add_argument("--dots", type=int, default=110, help="per inch; a stage is 15 inches wide")
    parser.add_argument("--small", action="store_true", help="small files: 64 levels per colour")
    parser.add_argument("--out", type=Path, help="folder for the pictures (default: the results)")
    return parser.parse_args()


def pages(scene, options):
    """Name and maker of each picture."""
    from layout import lead_page, shift_page, side_page, stage_page
    for stage in scene.stages:
        yield f"stage_{stage['stage']}", lambda stage=stage: stage_page(scene, stage, options)
    yield "figure_shift", lambda: shift_page(scene, options)
    for side in scene.plans:
        yield f"sheet_{side}", lambda side=side: side_page(scene, side, options)
        if any(side in s["electrodes"] and not s["electrodes"][side]["in_cannula"] for s in scene.stages):
            yield f"figure_lead_{side}", lambda side=side: lead_page(scene, side, options)


def main():
    options = parse()
    need_display()
    from head_scene import HeadScene
    from layout import plt, png
    plt.rcParams["figure.dpi"] = options.dots
    scene = HeadScene(options.head, options.results, options.magnify, options.edges, options.arrows)
    makers = dict(pages(scene, options))
    for name in options.only or []:
        if name not in makers:
            sys.exit(f"render.py: --only {name}: no such picture of {options.results}; there are "
                     f"{', '.join(makers)}")
    folder = options.out or options.results
    folder.mkdir(parents=True, exist_ok=True)
    for name in options.only or makers:
        page = makers[name]
        path = folder / f"{name}.png"
        path.write_bytes(png(page(), options.small))
        print(path)


if __name__ == "__main__":
    main()
