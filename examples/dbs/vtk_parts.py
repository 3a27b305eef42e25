"""Parts of the pictures that know VTK and the files, but nothing of what a picture shows."""
import os
import shutil
import sys

import numpy as np
import vtk
from matplotlib import colormaps
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SIDES = {"left": 1, "right": 2}   # labels of the walls in cavity.vtp; 3 is the sheet between them
SHEET = 3
COLOURS = "viridis"   # matplotlib's; perceptually even, and read by the colour-blind
LEAD, CONTACT = (1.0, 0.45, 0.0), (0.12, 0.12, 0.16)


def read(path):
    if not path.is_file():
        sys.exit(f"{path}: no such file")
    poly = path.suffix == ".vtp"
    reader = vtk.vtkXMLPolyDataReader() if poly else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def pipe(source, algorithm):
    """Output of a VTK filter for a data set."""
    algorithm.SetInputData(source)
    algorithm.Update()
    return algorithm.GetOutput()


def plane(point, normal):
    result = vtk.vtkPlane()
    result.SetOrigin(point)
    result.SetNormal(normal)
    return result


def distance_to(surface):
    """As an implicit function: negative inside a closed surface."""
    result = vtk.vtkImplicitPolyDataDistance()
    result.SetInput(surface)
    return result


def cut(data, where):
    cutter = vtk.vtkCutter()
    cutter.SetCutFunction(where)
    return pipe(data, cutter)


def clip(data, where, above):
    clipper = vtk.vtkClipPolyData()
    clipper.SetClipFunction(where)
    clipper.SetInsideOut(not above)
    return pipe(data, clipper)


def filled(contour):
    """The area inside closed lines."""
    return pipe(contour, vtk.vtkContourTriangulator())


def band(outside, inside):
    """The area between two sets of closed lines in one plane."""
    both = vtk.vtkAppendPolyData()
    both.AddInputData(outside)
    both.AddInputData(inside)
    both.Update()
    return filled(both.GetOutput())


def surface_of(grid):
    return pipe(grid, vtk.vtkDataSetSurfaceFilter())


def moved(grid, positions):
    """The grid with its nodes elsewhere."""
    result = vtk.vtkUnstructuredGrid()
    result.DeepCopy(grid)
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions), deep=True))
    result.SetPoints(points)
    return result


def compartment(cavity, side):
    """The closed wall of one side: its part of the skull and the sheet between the sides."""
    parts = vtk_to_numpy(cavity.GetCellData().GetArray("part"))
    ids = vtk.vtkIdList()
    for cell in np.flatnonzero((parts == SIDES[side]) | (parts == SHEET)):
        ids.InsertNextId(int(cell))
    extract = vtk.vtkExtractCells()
    extract.SetCellList(ids)
    return surface_of(pipe(cavity, extract))


def skull_of(cavity):
    """The cavity without the sheet between the sides."""
    threshold = vtk.vtkThreshold()
    threshold.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "part")
    threshold.SetLowerThreshold(0.5)
    threshold.SetUpperThreshold(SHEET - 0.5)
    return surface_of(pipe(cavity, threshold))


def region_of(grid, number):
    """The tets of one region."""
    threshold = vtk.vtkThreshold()
    threshold.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "region")
    threshold.SetLowerThreshold(number - 0.5)
    threshold.SetUpperThreshold(number + 0.5)
    return pipe(grid, threshold)


def smooth(surface):
    """With normals at its points, so that it is shaded without facets."""
    normals = vtk.vtkPolyDataNormals()
    normals.SetFeatureAngle(80.0)
    normals.SplittingOff()
    return pipe(surface, normals)


def border(surface):
    """Its free edges, as lines."""
    edges = vtk.vtkFeatureEdges()
    edges.BoundaryEdgesOn()
    for other in (edges.FeatureEdgesOff, edges.ManifoldEdgesOff, edges.NonManifoldEdgesOff, edges.ColoringOff):
        other()
    return pipe(surface, edges)


def thickened(skull, thickness):
    """The outside of a skull whose inner table is given; the tentorium has no bone behind it."""
    result = vtk.vtkPolyData()
    result.DeepCopy(smooth(skull))
    soft = pipe(skull, vtk.vtkCellDataToPointData()).GetPointData().GetArray("tentorium")
    points = vtk_to_numpy(result.GetPoints().GetData())
    normals = vtk_to_numpy(result.GetPointData().GetNormals())
    bony = 1.0 - vtk_to_numpy(soft) if soft else np.ones(len(points))
    shifted = vtk.vtkPoints()
    shifted.SetData(numpy_to_vtk(points + thickness * bony[:, None] * normals, deep=True))
    result.SetPoints(shifted)
    return result


def where_tentorium(skull, is_it):
    """The triangles of the wall that are the tentorium, or those that are not."""
    if not skull.GetCellData().GetArray("tentorium"):
        return vtk.vtkPolyData() if is_it else skull
    threshold = vtk.vtkThreshold()
    threshold.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "tentorium")
    threshold.SetLowerThreshold(0.5 if is_it else -0.5)
    threshold.SetUpperThreshold(1.5 if is_it else 0.5)
    return surface_of(pipe(skull, threshold))


def ring(centre, axis, radius):
    circle = vtk.vtkRegularPolygonSource()
    circle.SetNumberOfSides(48)
    circle.SetCenter(centre)
    circle.SetNormal(axis)
    circle.SetRadius(radius)
    circle.GeneratePolygonOff()
    tube = vtk.vtkTubeFilter()
    tube.SetInputConnection(circle.GetOutputPort())
    tube.SetRadius(0.12 * radius)
    tube.SetNumberOfSides(12)
    tube.Update()
    return tube.GetOutput()


def actor(data, colour=None, lookup=None, opacity=1.0, width=1.0, edges=False, cells=None):
    """Coloured by the node array "size", or by the cell array `cells`, where there is a lookup."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    if lookup:
        if cells:
            mapper.SetScalarModeToUseCellFieldData()
        else:
            mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(cells or "size")
        mapper.SetLookupTable(lookup)
        mapper.UseLookupTableScalarRangeOn()
    else:
        mapper.ScalarVisibilityOff()
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    look = result.GetProperty()
    if colour:
        look.SetColor(colour)
    look.SetOpacity(opacity)
    look.SetAmbient(0.32)
    look.SetDiffuse(0.8)
    look.SetLineWidth(width)
    if edges:
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.25, 0.25, 0.25)
        look.SetLineWidth(0.5)
    return result


def flat(result):
    """Without shading: for cuts, whose colour alone has a meaning."""
    result.GetProperty().LightingOff()
    result.GetProperty().SetAmbient(1.0)
    result.GetProperty().SetDiffuse(0.0)
    return result


def colours(largest):
    """From 0 to `largest`, as matplotlib's bar beside the pictures shows it."""
    table = vtk.vtkColorTransferFunction()
    for part in np.linspace(0.0, 1.0, 33):
        table.AddRGBPoint(largest * part, *colormaps[COLOURS](part)[:3])
    return table


def contact_colours():
    """Dark on contacts; orange elsewhere, where the contact number is 0."""
    table = vtk.vtkColorTransferFunction()
    for value, rgb in ((0.0, LEAD), (0.5, LEAD), (0.51, CONTACT), (99.0, CONTACT)):
        table.AddRGBPoint(value, *rgb)
    return table


def need_display():
    """Debian's VTK draws through an X server only, off screen too: starts again in a virtual one."""
    if os.environ.get("DISPLAY"):
        return
    if not shutil.which("xvfb-run"):
        sys.exit("no display, and no xvfb-run to make one (cmake/install-deps.sh docs)")
    os.execvp("xvfb-run", ["xvfb-run", "-a", sys.executable, *sys.argv])
