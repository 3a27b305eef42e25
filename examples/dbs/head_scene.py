"""A head and the results of dbs on it, drawn by VTK: one panel at a time, without any text.

A panel comes with its camera, so that what is written and drawn over it can be put at places in mm."""
import json
import sys
from dataclasses import dataclass

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from vtk_parts import (SIDES, actor, band, border, clip, colours, compartment, contact_colours, cut,
                       distance_to, filled, flat, moved, plane, read, region_of, ring, skull_of, smooth,
                       surface_of, thickened, where_tentorium)

RIM = (0.95, 0.91, 0.83)   # of sawn bone
BONE, FALX, FLUID, AIR = (0.87, 0.82, 0.72), (0.80, 0.12, 0.12), (0.74, 0.86, 0.98), (0.13, 0.14, 0.18)
EDGE = (0.35, 0.31, 0.26)   # of bone
LEVEL, REST = (0.25, 0.55, 0.95), (0.45, 0.45, 0.45)
X, Y, Z = np.eye(3)
OUTWARDS = {"right": X, "left": -X}   # RAS
BURR_HOLE = 7.0   # mm, radius of the usual one; the model knows its centre only
BONE_THICKNESS = 6.0   # mm, drawn; the model knows the inner table only


@dataclass
class View:
    """Where a panel looks from. A cut shows the plane through `at` only; others the head in space."""
    title: str
    towards_eye: np.ndarray
    up: np.ndarray
    side: str = ""          # whose electrode the view is for
    at: float = None        # of the cut, along towards_eye, mm
    centre: np.ndarray = None   # of the picture; None: all of the head
    height: float = None        # of the picture, mm

    def __post_init__(self):
        self.towards_eye = self.towards_eye / np.linalg.norm(self.towards_eye)
        self.up = self.up - self.up.dot(self.towards_eye) * self.towards_eye
        self.up /= np.linalg.norm(self.up)
        self.right = np.cross(self.up, self.towards_eye)   # of the picture


@dataclass
class Panel:
    image: np.ndarray
    view: View
    centre: np.ndarray
    height: float   # mm

    def extent(self):
        """Of the image, mm from its centre: left, right, bottom, top."""
        half = 0.5 * self.height
        wide = half * self.image.shape[1] / self.image.shape[0]
        return -wide, wide, -half, half

    def project(self, points):
        offsets = np.atleast_2d(points) - self.centre
        return offsets @ self.view.right, offsets @ self.view.up


def unit(vector):
    return vector / np.linalg.norm(vector)


class HeadScene:
    """What stays the same from stage to stage, and the stages."""

    def __init__(self, head, results, magnify=1.0, edges=False, arrows=0.0):
        table = results / "stages.json"
        if not table.is_file():
            sys.exit(f"{table}: no such file; run dbs with --out {results}")
        self.table = json.loads(table.read_text())
        self.stages = [s for s in self.table["stages"] if s["solve"]["status"] == "converged"]
        self.results, self.magnify, self.edges, self.arrows = results, magnify, edges, arrows
        cavity = read(head / "cavity.vtp")
        self.walls = {side: compartment(cavity, side) for side in SIDES}
        self.skull = skull_of(cavity)
        self.falx = clip(read(head / "falx.vtp"), distance_to(self.skull), False)   # it reaches into bone
        self.bone = where_tentorium(self.skull, False)
        self.tentorium = where_tentorium(self.skull, True)
        self.outside = thickened(self.skull, BONE_THICKNESS)
        self.skull_points = vtk_to_numpy(self.outside.GetPoints().GetData())
        self.up = -unit(np.array(self.table["gravity_mm_s2"], float))
        self.plans = {}   # side: (target, burr hole); those of the last stage are final
        for stage in self.stages:
            for side, lead in stage["electrodes"].items():
                self.plans[side] = np.array(lead["target_mm"]), np.array(lead["burr_hole_mm"])
        self.loaded = {s["stage"]: self.load(s["stage"]) for s in self.stages}
        self.largest = max(largest for *_, largest in self.loaded.values()) or 1.0
        self.lookup = colours(self.largest)

    def load(self, label):
        """The grid of a stage, its motion magnified; the same before surgery; the largest motion."""
        path = self.results / f"stage_{label}.vtu"
        grid = read(path)
        array = grid.GetPointData().GetArray("displacement")
        if array is None:
            sys.exit(f"{path}: has no node array 'displacement'; it was not written by dbs")
        displacement = vtk_to_numpy(array)
        positions = vtk_to_numpy(grid.GetPoints().GetData())
        size = numpy_to_vtk(np.linalg.norm(displacement, axis=1), deep=True)
        size.SetName("size")
        grid.GetPointData().AddArray(size)
        return (moved(grid, positions + (self.magnify - 1.0) * displacement),
                moved(grid, positions - displacement), size.GetRange()[1])

    # Views.

    def axial(self, z):
        return View(f"axial, z = {z:g} mm", -Z, Y, at=-z)   # seen from the feet, as radiologists do

    def coronal(self, y):
        return View(f"coronal, y = {y:g} mm", Y, Z, at=y)   # seen from the front

    def along(self, side, sagittal=15.0):
        """The plane of a side's trajectory and the line from front to back, seen from that side; without a
        trajectory, a sagittal plane so far (mm) from x = 0."""
        outwards = OUTWARDS[side]
        if side not in self.plans:
            return View(f"sagittal, x = {sagittal * outwards[0]:g} mm", outwards, self.up, side, at=sagittal)
        target, hole = self.plans[side]
        normal = unit(np.cross(Y, hole - target))
        normal *= np.sign(normal.dot(outwards))
        return View(f"along the {side} electrode", normal, self.up, side, at=normal.dot(target))

    def space(self, side):
        return View(f"from the {side}, skull cut open", OUTWARDS[side] + 0.42 * self.up + 0.30 * Z, self.up,
                    side)

    def front(self):
        return View("from the front, skull cut open", 0.85 * Y + 0.45 * Z, Z)

    # What is in them.

    def brain(self, stage):
        return self.loaded[stage["stage"]][0]

    def lead_actors(self, stage):
        for side in stage["electrodes"]:
            tube = read(self.results / f"stage_{stage['stage']}_{side}.vtp")
            yield flat(actor(tube, lookup=contact_colours(), cells="contact"))

    def level(self, height):
        return plane(self.up * height, self.up)

    def fluid_layers(self, stage, section):
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

    def arrow_actor(self, data):
        mask = vtk.vtkMaskPoints()
        mask.SetInputData(data)
        mask.SetOnRatio(max(1, data.GetNumberOfPoints() // 400))
        glyph = vtk.vtkGlyph3D()
        glyph.SetInputConnection(mask.GetOutputPort())
        glyph.SetSourceConnection(vtk.vtkArrowSource().GetOutputPort())
        glyph.SetInputArrayToProcess(1, 0, 0, 0, "displacement")
        glyph.SetVectorModeToUseVector()
        glyph.SetScaleFactor(self.arrows)
        glyph.Update()
        return actor(glyph.GetOutput(), (0.1, 0.1, 0.1))

    def draw_cut(self, renderer, view, stage):
        where = plane(view.towards_eye * view.at, view.towards_eye)
        grid, rest, _ = self.loaded[stage["stage"]]
        section = cut(grid, where)
        layers = [*self.fluid_layers(stage, where),
                  flat(actor(band(cut(self.outside, where), cut(self.skull, where)), BONE)),
                  flat(actor(section, lookup=self.lookup, edges=self.edges)),
                  flat(actor(cut(surface_of(rest), where), REST, width=1.5)),
                  flat(actor(cut(self.falx, where), FALX, width=4)),
                  flat(actor(cut(self.tentorium, where), FALX, width=4)),
                  flat(actor(cut(self.bone, where), EDGE, width=3)),
                  flat(actor(cut(self.outside, where), EDGE, width=2))]
        if self.arrows:
            layers.append(self.arrow_actor(section))
        for i, layer in enumerate(layers):
            layer.SetPosition(*(0.2 * i * view.towards_eye))   # later layers lie over earlier ones
            renderer.AddActor(layer)
        for lead in self.lead_actors(stage) if view.side else ():
            lead.SetPosition(*(20.0 * view.towards_eye))   # over the tissue, bent out of the plane or not
            renderer.AddActor(lead)

    def draw_skull(self, renderer, view):
        """The half away from the eye, and a hint of the other."""
        middle = 0.5 * (self.skull_points.min(axis=0) + self.skull_points.max(axis=0))
        where = plane(middle, view.towards_eye)
        for surface in (self.outside, smooth(self.skull)):
            renderer.AddActor(actor(clip(surface, where, False), BONE))
            renderer.AddActor(flat(actor(cut(surface, where), EDGE, width=2)))
        rim = flat(actor(band(cut(self.outside, where), cut(self.skull, where)), RIM))
        renderer.AddActor(rim)
        renderer.AddActor(actor(clip(self.outside, where, True), BONE, opacity=0.10))

    def draw_space(self, renderer, view, stage):
        self.draw_skull(renderer, view)
        for side in SIDES:
            shell = smooth(surface_of(region_of(self.brain(stage), SIDES[side])))
            near = side == view.side
            renderer.AddActor(actor(shell, lookup=self.lookup, opacity=0.16 if near else 1.0,
                                    edges=self.edges))
            state = stage["sides"][side]
            if state["open"]:
                edge = cut(self.walls[side], self.level(state["level_mm"]))
                renderer.AddActor(flat(actor(filled(edge), LEVEL, opacity=0.35)))
                renderer.AddActor(flat(actor(edge, LEVEL, width=2)))
        # Thin, so that the colours behind it are not mixed into others; its border tells where it is.
        for falx in (actor(smooth(self.falx), FALX, opacity=0.22), flat(actor(border(self.falx), FALX, width=4))):
            falx.SetPosition(*(1.5 * view.towards_eye))   # the far half touches it
            renderer.AddActor(falx)
        for target, hole in self.plans.values():
            renderer.AddActor(actor(ring(hole, unit(hole - target), BURR_HOLE), (0.1, 0.1, 0.1)))
        for lead in self.lead_actors(stage):
            renderer.AddActor(lead)
        if self.arrows:
            renderer.AddActor(self.arrow_actor(surface_of(self.brain(stage))))

    def picture(self, view):
        """Centre and height that hold all of the skull in the view."""
        points = self.skull_points
        if view.at is not None:
            outline = cut(self.outside, plane(view.towards_eye * view.at, view.towards_eye))
            if outline.GetNumberOfPoints() == 0:
                sys.exit(f"{view.title}: does not meet the head; ask for another cut")
            points = vtk_to_numpy(outline.GetPoints().GetData())
        across, along = points @ view.right, points @ view.up
        centre = (0.5 * (across.min() + across.max()) * view.right +
                  0.5 * (along.min() + along.max()) * view.up)
        centre = centre + (view.at or 0.0) * view.towards_eye
        return centre, 1.17 * max(np.ptp(along), np.ptp(across))

    def draw(self, view, stage, pixels=700):
        """A square panel of one stage."""
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1.0, 1.0, 1.0)
        (self.draw_space if view.at is None else self.draw_cut)(renderer, view, stage)
        centre, height = self.picture(view)
        if view.centre is not None:
            centre, height = view.centre, view.height
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(centre)
        camera.SetPosition(centre + 500.0 * view.towards_eye)
        camera.SetViewUp(view.up)
        camera.SetParallelScale(0.5 * height)
        renderer.ResetCameraClippingRange()
        return Panel(snapshot(renderer, pixels), view, centre, height)


def snapshot(renderer, pixels):
    renderer.SetUseDepthPeeling(1)   # what lies behind translucent surfaces, in its order
    renderer.SetMaximumNumberOfPeels(20)
    renderer.SetOcclusionRatio(0.0)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetAlphaBitPlanes(1)
    window.SetMultiSamples(0)
    window.SetSize(2 * pixels, 2 * pixels)   # halved below: smooth edges with depth peeling too
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    data = image.GetOutput()
    wide, high, _ = data.GetDimensions()
    rgb = vtk_to_numpy(data.GetPointData().GetScalars()).reshape(high, wide, -1)[::-1, :, :3]
    window.Finalize()
    return rgb.reshape(pixels, 2, pixels, 2, 3).mean(axis=(1, 3)).round().astype(np.uint8)
