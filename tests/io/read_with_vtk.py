#!/usr/bin/python3
"""Reads a file with VTK and prints it, one line per item, for the test in vtk_exchange.cpp.
Usage: read_with_vtk.py FILE"""
import sys

import vtk


def show(array):
    values = [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]
    return " ".join(float(v).hex() for row in values for v in row)


def main(path):
    reader = vtk.vtkXMLPolyDataReader() if path.endswith(".vtp") else vtk.vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("error"))
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    print("errors", len(errors))
    print("points", show(data.GetPoints().GetData()))
    for cell in range(data.GetNumberOfCells()):
        ids = data.GetCell(cell).GetPointIds()
        print("cell", data.GetCellType(cell), *(ids.GetId(i) for i in range(ids.GetNumberOfIds())))
    for place, arrays in (("node", data.GetPointData()), ("face", data.GetCellData())):
        for i in range(arrays.GetNumberOfArrays()):
            array = arrays.GetArray(i)
            print(place, array.GetName(), array.GetDataTypeAsString(), show(array))


main(sys.argv[1])
