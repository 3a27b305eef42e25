"""VTK XML files: inline binary, zlib-compressed."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_INT, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import (vtkXMLPolyDataReader, vtkXMLPolyDataWriter,
                                 vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter)


def _cells(connectivity):
    connectivity = np.ascontiguousarray(connectivity, np.int64)
    count, size = connectivity.shape
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, (count + 1) * size, size, dtype=np.int64), 1),
                  numpy_to_vtkIdTypeArray(connectivity.ravel(), 1))
    return cells


def write(path, points, connectivity, cell_data, point_data):
    """Tets (n, 4) to .vtu or triangles (n, 3) to .vtp; the data dictionaries become Int32 arrays."""
    holder = vtkPoints()
    holder.SetData(numpy_to_vtk(np.ascontiguousarray(points, np.float64), 1))
    tets = connectivity.shape[1] == 4
    data = vtkUnstructuredGrid() if tets else vtkPolyData()
    data.SetPoints(holder)
    if tets:
        data.SetCells(VTK_TETRA, _cells(connectivity))
    else:
        data.SetPolys(_cells(connectivity))
    for target, arrays in ((data.GetCellData(), cell_data), (data.GetPointData(), point_data)):
        for name, values in arrays.items():
            array = numpy_to_vtk(np.ascontiguousarray(values, np.int32), 1, VTK_INT)
            array.SetName(name)
            target.AddArray(array)
    writer = vtkXMLUnstructuredGridWriter() if tets else vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToZLib()
    if not writer.Write():
        raise OSError(f"cannot write {path}")


def read(path):
    """Points, connectivity, cell data, point data of a file written by write()."""
    tets = str(path).endswith(".vtu")
    reader = vtkXMLUnstructuredGridReader() if tets else vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    cells = data.GetCells() if tets else data.GetPolys()
    connectivity = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 4 if tets else 3)

    def arrays(attributes):
        return {attributes.GetArrayName(i): vtk_to_numpy(attributes.GetArray(i)).astype(int)
                for i in range(attributes.GetNumberOfArrays())}

    return (vtk_to_numpy(data.GetPoints().GetData()).astype(float), connectivity.astype(int),
            arrays(data.GetCellData()), arrays(data.GetPointData()))
