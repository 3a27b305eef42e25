#!/usr/bin/python3
"""Pictures of a run of dbs: for each stage a coronal cut, a cut along an electrode and a view in space.

The brain is coloured by the size of its displacement, by one scale for all stages. Light blue is
fluid, white is air; black is the skull, red the falx, the grey line the brain before surgery. An
electrode is orange, its contacts dark; the thin black line is its planned trajectory. The second cut
holds the right trajectory (the left one if only that side was operated on) and the line from front to
back; without electrodes it is sagittal. There and in space, up is against gravity.

    examples/dbs/render.py --head examples/head/data/medium out/dbs

Writes stage_N.png into the results folder. Needs python3-vtk9, and where there is no display xvfb
(cmake/install-deps.sh docs)."""
import argparse
import json
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from vtk_parts import (SIDES, actor, clip, colours, compartment, contact_colours, cut, filled, flat,
                       label, moved, plane, read, scale_bar, segment, skull_of, surface_of)

FLUID, AIR = (0.80, 0.89, 0.98), (1.0, 1.0, 1.0)


class Scene:
    """What stays the same from stage to stage."""

    def __init__(self, head, stages, largest, options):
        cavity = read(head / "cavity.vtp")
        self.walls = {side: compartment(cavity, side) for side in SIDES}
        self.skull, self.falx = skull_of(cavity), read(head / "falx.vtp")
        self.centre = np.array(cavity.GetCenter())
        self.reach = 0.5 * cavity.GetLength()
        gravity = np.array(stages["gravity_mm_s2"], float)
        self.up = -gravity / np.linalg.norm(gravity)
        self.lookup, self.options = colours(largest), options
        self.results = options.results
        self.plans = {}   # side: (target, burr hole); those of the last stage are final
        for stage in stages["stages"]:
            for side, lead in stage["electrodes"].items():
                self.plans[side] = np.array(lead["target_mm"]), np.array(lead["burr_hole_mm"])

    def second_cut(self):
        """Normal, offset and name of the second cut."""
        if not self.plans:
            x = self.options.sagittal
            return np.array([1.0, 0, 0]), x, f"sagittal, x = {x:g} mm; up is against gravity"
        side = "right" if "right" in self.plans else "left"
        target, hole = self.plans[side]
        normal = np.cross(np.array([0, 1.0, 0]), hole - target)
        normal *= np.sign(normal[0]) / np.linalg.norm(normal)
        return normal, normal @ target, f"along the {side} electrode; up is against gravity"

    def lead_actors(self, stage, shift=np.zeros(3)):
        for side in stage["electrodes"]:
            tube = read(self.results / f"stage_{stage['stage']}_{side}.vtp")
            body = actor(tube, lookup=contact_colours(), cells="contact")
            body.SetPosition(*shift)
            yield body
            line = actor(segment(*self.plans[side]), (0, 0, 0), width=1)
            line.SetPosition(*shift)
            yield line

    def level(self, height):
        return plane(self.up * height, self.up)

    def fluid_actors(self, stage, section):
        """Fluid and air of both sides in a plane cut through the cavity."""
        for side in SIDES:
            area = filled(cut(self.walls[side], section))
            if area.GetNumberOfCells() == 0:
                continue
            state = stage["sides"][side]
            if not state["open"]:   # no air on this side, whatever the head
                yield flat(actor(area, FLUID))
                continue
            level = self.level(state["level_mm"])
            for above, colour in ((False, FLUID), (True, AIR)):
                yield flat(actor(clip(area, level, above), colour))

    def arrows(self, data):
        mask = vtk.vtkMaskPoints()
        mask.SetInputData(data)
        mask.SetOnRatio(max(1, data.GetNumberOfPoints() // 400))
        glyph = vtk.vtkGlyph3D()
        glyph.SetInputConnection(mask.GetOutputPort())
        arrow = vtk.vtkArrowSource()
        glyph.SetSourceConnection(arrow.GetOutputPort())
        glyph.SetInputArrayToProcess(1, 0, 0, 0, "displacement")
        glyph.SetVectorModeToUseVector()
        glyph.SetScaleFactor(self.options.arrows)
        glyph.Update()
        return actor(glyph.GetOutput(), (0.1, 0.1, 0.1))

    def draw_cut(self, renderer, stage, brain, rest, normal, at, camera_up, leads=False):
        where = plane(normal * at, normal)
        towards_eye = 0.2 * normal   # later layers lie over earlier ones
        layers = [*self.fluid_actors(stage, where)]
        section = cut(brain, where)
        layers.append(flat(actor(section, lookup=self.lookup, edges=self.options.edges)))
        layers.append(flat(actor(cut(surface_of(rest), where), (0.55, 0.55, 0.55), width=1.5)))
        outline = cut(self.skull, where)
        layers.append(flat(actor(outline, (0, 0, 0), width=3)))
        layers.append(flat(actor(cut(self.falx, where), (0.75, 0.1, 0.1), width=3)))
        if self.options.arrows:
            layers.append(self.arrows(section))
        for i, layer in enumerate(layers):
            layer.SetPosition(*(i * towards_eye))
            renderer.AddActor(layer)
        for lead in self.lead_actors(stage, len(layers) * towards_eye) if leads else ():
            renderer.AddActor(lead)   # over the tissue it is cut with
        self.look(renderer, normal, camera_up, outline)

    def draw_space(self, renderer, stage, brain):
        shell = surface_of(brain)
        opacity = 0.45 if stage["electrodes"] else 1.0
        renderer.AddActor(actor(shell, lookup=self.lookup, opacity=opacity))
        for lead in self.lead_actors(stage):
            renderer.AddActor(lead)
        renderer.AddActor(actor(self.skull, (0.85, 0.80, 0.70), opacity=0.15))
        renderer.AddActor(actor(self.falx, (0.75, 0.1, 0.1), opacity=0.5))
        for side in SIDES:
            state = stage["sides"][side]
            if state["open"]:
                surface = filled(cut(self.walls[side], self.level(state["level_mm"])))
                renderer.AddActor(flat(actor(surface, (0.2, 0.5, 0.9), opacity=0.45)))
        if self.options.arrows:
            renderer.AddActor(self.arrows(shell))
        # From the front right, somewhat from above.
        self.look(renderer, np.array([0.75, 0.45, 0.0]) + 0.6 * self.up, self.up)

    def look(self, renderer, direction, up, outline=None):
        """Camera at `direction`; outline: what fills the panel of a cut, drawn without perspective."""
        direction = direction / np.linalg.norm(direction)
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(self.centre)
        camera.SetPosition(self.centre + direction)
        camera.SetViewUp(up)
        renderer.ResetCamera()
        camera.Zoom(1.3)
        if outline is not None and outline.GetNumberOfPoints() > 0:
            points = vtk_to_numpy(outline.GetPoints().GetData())
            low, high = points.min(axis=0), points.max(axis=0)
            middle = 0.5 * (low + high)
            upright = up - up.dot(direction) * direction
            upright /= np.linalg.norm(upright)
            sideways = np.cross(upright, direction)
            offsets = points - middle
            camera.SetFocalPoint(middle)
            camera.SetPosition(middle + 4.0 * self.reach * direction)
            camera.ParallelProjectionOn()
            camera.SetParallelScale(1.15 * max(np.abs(offsets @ upright).max(),
                                               np.abs(offsets @ sideways).max()))
        renderer.ResetCameraClippingRange()


def caption(stage):
    sides = [f"{side}: level {s['level_mm']:.1f} mm, air {s['air_mL']:.1f} mL" if s["open"]
             else f"{side}: closed" for side, s in stage["sides"].items()]
    return f"{stage['stage']}  {stage['title']}\n" + "\n".join(sides)


def electrode_caption(stage):
    lines = []
    for side, lead in stage["electrodes"].items():
        off = np.subtract(lead["tip_mm"], lead["target_mm"])
        lines.append(f"{side} {lead['device']}{' in cannula' if lead['in_cannula'] else ''}: tip "
                     f"{np.linalg.norm(off):.2f} mm off its target, bow {lead['bow_mm']:.2f} mm")
    return "\n".join(lines)


def render(scene, stage, grid, rest, path):
    options = scene.options
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(4)
    window.SetSize(3 * options.size, options.size)
    _, y, z = np.eye(3)
    for i in range(3):
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(i / 3, 0, (i + 1) / 3, 1)
        renderer.SetBackground(0.94, 0.94, 0.94)
        window.AddRenderer(renderer)
        if i == 0:
            scene.draw_cut(renderer, stage, grid, rest, y, options.coronal, z)
            renderer.AddActor2D(label(f"coronal, y = {options.coronal:g} mm; right side on the left",
                                      0.02, 0.02, 13))
            renderer.AddActor2D(label(caption(stage), 0.02, 0.90, 15))
        elif i == 1:
            normal, at, name = scene.second_cut()
            scene.draw_cut(renderer, stage, grid, rest, normal, at, scene.up, True)
            renderer.AddActor2D(label(name, 0.02, 0.02, 13))
            renderer.AddActor2D(label(electrode_caption(stage), 0.02, 0.92, 13))
        else:
            scene.draw_space(renderer, stage, grid)
            renderer.AddActor2D(scale_bar(scene.lookup))
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def load_stage(path, magnify):
    """The grid of a stage, its motion magnified, and the same before surgery."""
    grid = read(path)
    array = grid.GetPointData().GetArray("displacement")
    if array is None:
        sys.exit(f"render.py: {path}: has no node array 'displacement'")
    displacement = vtk_to_numpy(array)
    positions = vtk_to_numpy(grid.GetPoints().GetData())
    size = numpy_to_vtk(np.linalg.norm(displacement, axis=1), deep=True)
    size.SetName("size")
    grid.GetPointData().AddArray(size)
    return (moved(grid, positions + (magnify - 1.0) * displacement),
            moved(grid, positions - displacement), size.GetRange()[1])


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("results", type=Path, help="folder written by dbs")
    parser.add_argument("--head", type=Path, required=True, help="folder of the head")
    parser.add_argument("--stage", action="append", help="only this one (6b); may be repeated")
    parser.add_argument("--coronal", type=float, default=40.0, help="y of the cut, mm (default 40)")
    parser.add_argument("--sagittal", type=float, default=15.0, help="x of the cut where there is no electrode, mm (default 15)")
    parser.add_argument("--magnify", type=float, default=1.0, help="the motion (default 1)")
    parser.add_argument("--arrows", type=float, default=0.0, metavar="FACTOR",
                        help="draw displacements as arrows, this many times their length")
    parser.add_argument("--edges", action="store_true", help="cuts with the edges of the tets")
    parser.add_argument("--size", type=int, default=640, help="height in pixels (default 640)")
    parser.add_argument("--out", type=Path, help="folder for the pictures (default: the results)")
    return parser.parse_args()


def main():
    options = parse()
    if not os.environ.get("DISPLAY"):
        # Debian's VTK draws through an X server only, off screen too.
        if not shutil.which("xvfb-run"):
            sys.exit("render.py: no display, and no xvfb-run (cmake/install-deps.sh docs)")
        os.execvp("xvfb-run", ["xvfb-run", "-a", sys.executable, *sys.argv])
    table = options.results / "stages.json"
    if not table.is_file():
        sys.exit(f"render.py: {table}: no such file")
    stages = json.loads(table.read_text())
    loaded = {s["stage"]: load_stage(options.results / f"stage_{s['stage']}.vtu", options.magnify)
              for s in stages["stages"]}
    largest = max(largest for *_, largest in loaded.values()) or 1.0
    scene = Scene(options.head, stages, largest, options)
    folder = options.out or options.results
    folder.mkdir(parents=True, exist_ok=True)
    for stage in stages["stages"]:
        number = stage["stage"]
        if options.stage and number not in options.stage:
            continue
        grid, rest, _ = loaded[number]
        path = folder / f"stage_{number}.png"
        render(scene, stage, grid, rest, path)
        print(path)


if __name__ == "__main__":
    main()
