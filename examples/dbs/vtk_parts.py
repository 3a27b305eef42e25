"""Parts of render.py that know VTK and the files, but nothing of what a picture shows."""
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SIDES = {"left": 1, "right": 2}   # labels of the walls in cavity.vtp; 3 is the sheet between them
SHEET = 3
VIRIDIS = [(0.267, 0.005, 0.329), (0.229, 0.322, 0.546), (0.128, 0.567, 0.551),
           (0.369, 0.789, 0.383), (0.993, 0.906, 0.144)]


def read(path):
    if not path.is_file():
        sys.exit(f"render.py: {path}: no such file")
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


def segment(a, b):
    source = vtk.vtkLineSource()
    source.SetPoint1(a)
    source.SetPoint2(b)
    source.Update()
    return source.GetOutput()


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
    look.SetLineWidth(width)
    if edges:
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.25, 0.25, 0.25)
        look.SetLineWidth(0.5)
    return result


def flat(result):
    """Without shading: for cuts, whose colour alone has a meaning."""
    result.GetProperty().LightingOff()
    return result


def colours(largest):
    table = vtk.vtkColorTransferFunction()
    for i, rgb in enumerate(VIRIDIS):
        table.AddRGBPoint(largest * i / (len(VIRIDIS) - 1), *rgb)
    return table


def contact_colours():
    """Orange where the contact number is 0, dark on contacts."""
    table = vtk.vtkColorTransferFunction()
    for value, rgb in ((0.0, (0.95, 0.55, 0.1)), (0.5, (0.95, 0.55, 0.1)), (0.51, (0.15, 0.15, 0.2)),
                       (99.0, (0.15, 0.15, 0.2))):
        table.AddRGBPoint(value, *rgb)
    return table


def label(text, x, y, size):
    result = vtk.vtkTextActor()
    result.SetInput(text)
    result.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    result.SetPosition(x, y)
    result.GetTextProperty().SetFontSize(size)
    result.GetTextProperty().SetColor(0, 0, 0)
    return result


def scale_bar(lookup):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(lookup)
    bar.SetTitle("displacement, mm\n")
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.2g")
    bar.SetPosition(0.78, 0.04)
    bar.SetWidth(0.2)
    bar.SetHeight(0.4)
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0, 0, 0)
        text.SetFontSize(13)
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    return bar
