"""The surfaces of the head: the cavity's walls with its mid-sheet, and the falx."""
import numpy as np
from scipy.spatial import Delaunay
from skimage.measure import find_contours

from . import brain, domain, midsurface, trimesh

LEFT_WALL, RIGHT_WALL, MID_SHEET = 1, 2, 3


def cavity(path, anatomy):
    """Points, triangles, part and tentorium flag of the cavity from its mesh.

    Walls have outward normals, the mid-sheet's point right."""
    nodes, tets, labels = brain.drop_islands(*brain.read_mesh(path))
    nodes = brain.snap_to_midsurface(nodes, tets, labels, anatomy.mid)
    outer, owner = trimesh.boundary_faces(tets)
    sheet = trimesh.shared_faces(tets, labels, 1, 2)
    triangles = np.vstack([outer[labels[owner] == 1], outer[labels[owner] == 2], sheet])
    part = np.repeat([LEFT_WALL, RIGHT_WALL, MID_SHEET],
                     [np.sum(labels[owner] == 1), np.sum(labels[owner] == 2), len(sheet)])
    used, triangles = np.unique(triangles, return_inverse=True)
    triangles, points = triangles.reshape(-1, 3), nodes[used]
    # Half way between brain and cerebellum the obstacle's distance is zero.
    centre = points[triangles].mean(axis=1)
    tentorium = (anatomy.grid.sample(anatomy.obstacle, centre) < 1.5) & (part != MID_SHEET)
    tentorium &= centre[:, 2] > anatomy.z_floor + 1.5 * anatomy.grid.spacing
    return points, triangles, part, tentorium


def resample(curve, step):
    """Points at equal spacing near `step` along a curve, its ends kept."""
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    count = max(2, int(round(along[-1] / step)) + 1)
    at = np.linspace(0, along[-1], count)
    return np.column_stack([np.interp(at, along, curve[:, k]) for k in range(2)])


def falx_outline(anatomy):
    """(y, z) of the falx: its free edge, and the rest of its border (closed with the edge's ends)
    3 mm beyond the wall of the cavity and below the straight sinus."""
    y, z = (np.arange(*window, 0.5) for window in anatomy.falx)
    grid = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1)
    points = np.concatenate([midsurface.evaluate(anatomy.mid, grid[..., 0], grid[..., 1])[..., None],
                             grid], axis=-1)
    distance = anatomy.grid.sample(anatomy.cavity, points.reshape(-1, 3)).reshape(grid.shape[:2])
    inside = (distance < 3.0) & brain.falx_zone(grid.reshape(-1, 2), anatomy).reshape(
        distance.shape)
    loop = max(find_contours(inside.astype(float), 0.5), key=len)
    loop = np.array([y[0], z[0]]) + 0.5 * loop
    return loop


def triangles_within(yz, loop):
    """Delaunay triangles of points (n, 2) that lie inside a loop of some of them. Three points of the loop
    in a line, or two that are one, make no triangle: lifted to the sheet it would have an area, from the
    sheet's bend alone, and a normal that lies in the sheet."""
    triangles = Delaunay(yz).simplices
    triangles = triangles[trimesh.in_polygon(yz[triangles].mean(axis=1), loop)]
    return triangles[trimesh.areas(np.insert(yz, 0, 0.0, axis=1), triangles) > 1e-2]


def falx(anatomy, size=5.0):
    """Points, triangles (normals to the right) and free-edge flag of the falx sheet."""
    edge = anatomy.falx_edge
    loop = resample(falx_outline(anatomy), size)[:-1]
    dense = resample(edge, 0.25)
    gap = np.linalg.norm(loop[:, None] - dense, axis=2)
    free = gap.min(axis=1) < 1.0
    loop[free] = dense[gap.argmin(axis=1)[free]]  # the contour of the grid is ragged by 0.5 mm
    # Hexagonal grid inside, clear of the border.
    y, z = np.meshgrid(np.arange(*anatomy.falx[0], size),
                       np.arange(*anatomy.falx[1], size * np.sqrt(0.75)))
    y[1::2] += size / 2
    inner = np.column_stack([y.ravel(), z.ravel()])
    inner = inner[trimesh.in_polygon(inner, loop)]
    inner = inner[np.linalg.norm(inner[:, None] - loop, axis=2).min(axis=1) > 0.6 * size]
    yz = np.vstack([loop, inner])
    triangles = triangles_within(yz, loop)
    used, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    yz, free = yz[used], np.concatenate([free, np.zeros(len(inner), bool)])[used]
    points = domain.lift(anatomy.mid, yz)
    left = trimesh.normals_areas(points, triangles)[0][:, 0] < 0
    triangles[left] = triangles[left][:, ::-1]
    return points, triangles, free
