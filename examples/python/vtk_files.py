"""Reads VTK XML files of tets (.vtu) and triangles (.vtp)."""
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader


def read(path):
    """Points (N x 3, mm), nodes of the cells, and dictionaries of cell and point arrays."""
    tets = path.endswith('.vtu')
    reader = vtkXMLUnstructuredGridReader() if tets else vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    if data.GetNumberOfPoints() == 0:
        raise OSError(f'{path}: cannot be read, or holds no point')
    cells = data.GetCells() if tets else data.GetPolys()
    nodes = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 4 if tets else 3)

    def arrays(of):
        return {of.GetArrayName(i): vtk_to_numpy(of.GetArray(i)) for i in range(of.GetNumberOfArrays())}

    return (vtk_to_numpy(data.GetPoints().GetData()).astype(np.float64), nodes.astype(np.int32),
            arrays(data.GetCellData()), arrays(data.GetPointData()))
