"""How far the nodes on the edges of a file of straight quadratic tets lie from the middles, as VTK sees it."""
import sys

import vtk

reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
count, largest = 0, 0.0
for c in range(grid.GetNumberOfCells()):
    cell = grid.GetCell(c)
    for e in range(cell.GetNumberOfEdges()):
        edge = cell.GetEdge(e)   # its ends, then the node between them
        a, b, m = (grid.GetPoint(edge.GetPointId(k)) for k in range(3))
        largest = max(largest, *(abs(m[i] - 0.5 * (a[i] + b[i])) for i in range(3)))
        count += 1
print(f"{count} edges, largest distance of a node from the middle {largest:.15g}")
