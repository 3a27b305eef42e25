"""Writes what mesher/mesh_head.cpp reads: a distance field, the mid-surface and protected curves.

The curves where left, right and outside meet (and the rim of the brainstem's cut) are creases of
the meshed body. Mesh_3 rounds them off unless they are given to it as polylines."""
import numpy as np
from skimage.measure import find_contours

from . import midsurface

STEP = 0.5  # mm, sampling of the sections in which the curves are found


def section_contours(grid, distance, point, first, second):
    """Closed zero contours, as (n, 2) parameters, of a distance field on the surface point(a, b)."""
    a, b = np.arange(*first, STEP), np.arange(*second, STEP)
    points = point(*np.meshgrid(a, b, indexing="ij"))
    values = grid.sample(distance, points.reshape(-1, 3)).reshape(points.shape[:2])
    loops = [np.array([first[0], second[0]]) + STEP * loop for loop in find_contours(values, 0.0)]
    return [loop for loop in loops if np.allclose(loop[0], loop[-1]) and len(loop) > 3]


def length(curve):
    return np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()


def midline_loop(anatomy, distance, lowest):
    """(y, z) of the outer contour of a body on the mid-surface; small holes are not protected."""
    def point(y, z):
        return np.stack([midsurface.evaluate(anatomy.mid, y, z), y, z], axis=-1)

    y_range, highest = anatomy.midline
    loops = section_contours(anatomy.grid, distance, point, y_range, (lowest, highest))
    loops.sort(key=length, reverse=True)
    for other in loops[1:]:
        print(f"  note: second contour on the mid-surface, {length(other):.0f} mm long, at",
              other.mean(axis=0).round(1))
    return loops[0]


def lift(mid, curve):
    """(y, z) on the mid-surface -> points."""
    curve = np.asarray(curve, float)
    return np.column_stack([midsurface.evaluate(mid, curve[:, 0], curve[:, 1]), curve])


def cut_loop(loop, z_cut):
    """The part of a closed (y, z) curve above z_cut; its ends lie exactly on z_cut."""
    above = loop[:-1, 1] > z_cut
    start = int(np.flatnonzero(above & ~np.roll(above, 1))[0])
    ring = np.roll(loop[:-1], -start, axis=0)
    count = int(np.argmin(ring[:, 1] > z_cut))  # first point below again

    def crossing(p, q):
        return p + (q - p) * (z_cut - p[1]) / (q[1] - p[1])

    return np.vstack([crossing(ring[-1], ring[0]), ring[:count],
                      crossing(ring[count - 1], ring[count])])


def stem_rim(anatomy, ends):
    """The rim of the cut face in its left and right part, between the two given points."""
    z_cut = anatomy.z_cut

    def point(x, y):
        return np.stack([x, y, np.full(x.shape, z_cut)], axis=-1)

    loops = section_contours(anatomy.grid, anatomy.brain, point, *anatomy.stem)
    ring = max(loops, key=length)[:-1]
    right = ring[:, 0] > midsurface.evaluate(anatomy.mid, ring[:, 1], z_cut)
    parts = []
    for side in (~right, right):
        start = int(np.flatnonzero(side & ~np.roll(side, 1))[0])
        part = np.roll(ring, -start, axis=0)[:side.sum()]
        part = part if np.linalg.norm(part[0] - ends[0, :2]) < np.linalg.norm(
            part[-1] - ends[0, :2]) else part[::-1]
        part = np.column_stack([part, np.full(len(part), z_cut)])
        inner = (np.linalg.norm(part - ends[0], axis=1) > STEP) & (
            np.linalg.norm(part - ends[1], axis=1) > STEP)
        parts.append(np.vstack([ends[:1], part[inner], ends[1:]]))
    return parts


def brain_curves(anatomy):
    mid, z_cut = anatomy.mid, anatomy.z_cut
    loop = lift(mid, cut_loop(midline_loop(anatomy, anatomy.brain, z_cut - 12), z_cut))
    ends = loop[[0, -1]]
    y = np.linspace(ends[0, 1], ends[1, 1], 2 + int(abs(ends[0, 1] - ends[1, 1]) / STEP))
    across = np.column_stack([midsurface.evaluate(mid, y, z_cut), y, np.full(len(y), z_cut)])
    across[[0, -1]] = ends
    return [loop, across, *stem_rim(anatomy, ends)]


def cavity_curves(anatomy):
    """The wall's midline, in two halves: a closed polyline without corner can start Mesh_3 with the
    same point twice."""
    loop = lift(anatomy.mid, midline_loop(anatomy, anatomy.cavity, anatomy.cavity_z))
    loop[-1] = loop[0]
    half = len(loop) // 2
    return [loop[:half + 1], loop[half:]]


def write(path, anatomy, distance, floor, curves):
    """path.txt and path.raw; floor: the plane z = floor that cuts the body (or far below it)."""
    distance.astype("<f4").tofile(f"{path}.raw")
    with open(f"{path}.txt", "w", encoding="ascii") as out:
        centre, radius = anatomy.body
        for row in (distance.shape, anatomy.grid.origin, (anatomy.grid.spacing, floor),
                    (*centre, radius), anatomy.mid):
            print(*(repr(float(v)) if not isinstance(v, (int, np.integer)) else v for v in row),
                  file=out)
        print(f"{path}.raw", len(curves), file=out)
        for curve in curves:
            print(len(curve), file=out)
            for p in curve:
                print(*(f"{v:.7f}" for v in p), file=out)
