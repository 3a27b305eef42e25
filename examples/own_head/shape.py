"""Labels -> the anatomy that the meshes are made of (chain/anatomy.py), in the head frame.

What the labels lack is derived: the inner skull from a closed hull of the brain (or from labelled fluid),
the falx from the generic head's, the bridge between the halves from labels that go on across the
midline."""
from dataclasses import dataclass

import numpy as np
import scipy.ndimage as ndimage
from skimage.measure import approximate_polygon, find_contours

import generic
from chain import envelope, midsurface, trimesh
from chain.anatomy import Anatomy
from chain.volume import Grid, closing, largest, opening, smooth_distance
from labels import BRAINSTEM, CEREBELLUM, CEREBRUM, CISTERN, CSF, VENTRICLE
from problem import Problem

PAD = 26.0            # mm around the labels: room for a closing of 15 mm and for the distance fields
FISSURE_HALF = 6.0    # mm to either side of the mid-surface within which the fissure is closed
STEM_SECTION = 80.0   # mm^2: the lowest section of the brainstem that counts
BELOW_CUT = 5.7       # mm the cavity goes on below the brainstem's cut


@dataclass
class Volumes:
    """The labels on the head's grid."""
    grid: Grid
    kind: np.ndarray
    bridge: np.ndarray
    value: np.ndarray    # label, int32

    def height(self):
        return self.grid.axes(self.kind.shape)[2]


def resample(image, parts, frame, spacing):
    """Nearest label at each voxel of an upright grid that holds all labels."""
    labelled = np.argwhere(parts.kind > 0)
    corners = np.array(np.meshgrid(*zip(labelled.min(axis=0), labelled.max(axis=0)))).reshape(3, -1).T
    # The box of the box: a turned image needs a little more than its labels.
    corners = frame.to_head(image.world(corners))
    low, high = corners.min(axis=0) - PAD, corners.max(axis=0) + PAD
    shape = np.ceil((high - low) / spacing).astype(int) + 1
    grid = Grid(low, spacing)
    to_voxel = np.linalg.inv(image.affine[:3, :3])
    matrix = to_voxel @ frame.turn_to_world(np.eye(3)).T * spacing
    offset = to_voxel @ (frame.to_world(low) - image.affine[:3, 3])

    def pull(array):
        return ndimage.affine_transform(array, matrix, offset, tuple(shape), order=0, mode="constant")

    return Volumes(grid, pull(parts.kind), pull(parts.bridge.astype(np.uint8)) > 0, pull(image.values))


def solid_of(volumes, mid, radius):
    """Cerebrum, brainstem and ventricles as one body without sulci, its fissure closed."""
    unit = volumes.grid.spacing
    tissue = np.isin(volumes.kind, (CEREBRUM, BRAINSTEM, VENTRICLE))
    x, y, z = volumes.grid.axes(tissue.shape)
    near = np.abs(x - midsurface.evaluate(mid, y[0], z[0])[None]) < FISSURE_HALF
    tissue |= closing(tissue, 6.0 / unit) & near & ~np.isin(volumes.kind, (CEREBELLUM, CISTERN))
    return envelope.smooth_solid(tissue, unit, radius)


def stem_end(path, volumes):
    """Index of the brainstem's lowest full section and the height of the cut; the stem is continued
    straight down where the cerebrum reaches lower."""
    unit, height = volumes.grid.spacing, volumes.height().ravel()
    stem = volumes.kind == BRAINSTEM
    area = stem.sum(axis=(0, 1)) * unit**2
    full = np.flatnonzero(area > STEM_SECTION)
    if not len(full) or height[full[0]] > -15:
        raise Problem(f"{path}: the brainstem does not reach 15 mm below the commissures: label it down to the "
                      "foramen magnum")
    end = int(full[0] + np.ceil(4.0 / unit))  # its very end is round
    lowest = height[np.flatnonzero((volumes.kind == CEREBRUM).any(axis=(0, 1)))[0]]
    return end, float(min(height[end], lowest - 4.0))


def continue_stem(volumes, end):
    """The section at `end` continued to the bottom of the grid, so that the cut is clean."""
    stem = volumes.kind == BRAINSTEM
    section = largest(stem[:, :, end])
    volumes.kind[:, :, :end][section] = BRAINSTEM
    volumes.bridge[:, :, :end][section] = True
    return section


def brain_distance(volumes, mid, z_cut, radius):
    """Signed distance in voxels."""
    unit, z = volumes.grid.spacing, volumes.height()
    solid = solid_of(volumes, mid, radius)
    floor = int(np.searchsorted(z.ravel(), z_cut - 1))
    solid[:, :, :floor] = solid[:, :, floor:floor + 1]
    return np.maximum(smooth_distance(solid, 1.6 / unit), (z_cut - 10 - z) / unit)


def skull_distance(volumes, brain):
    """Inner skull: around labelled fluid, or a hull. Signed distance in voxels, and a note."""
    unit = volumes.grid.spacing
    whole = (volumes.kind > 0) & (volumes.kind != CSF) | (brain < 0)
    fluid = volumes.kind == CSF
    if fluid.sum() * unit**3 > 20e3:
        hull = closing(whole | fluid, 6.0 / unit)
        return smooth_distance(hull, 2.5 / unit), "the inner skull is the border of the labelled fluid"
    return (envelope.hull_distance(whole, volumes.height(), unit),
            "the inner skull is derived: the closed hull of brain and cerebellum, and 2.5 mm of fluid on the "
            "vault, 0.5 mm at the base")


def bridge_outline(volumes, mid, z_cut):
    """(y, z) outline of where tissue goes on across the midline."""
    step = 0.5
    grid, shape = volumes.grid, volumes.kind.shape
    axes = [np.arange(o, o + grid.spacing * (n - 1), step) for o, n in zip(grid.origin[1:], shape[1:])]
    y, z = np.meshgrid(*axes, indexing="ij")
    x = midsurface.evaluate(mid, y, z)

    def at(off):
        points = np.stack([x + off, y, z], axis=-1).reshape(-1, 3)
        return grid.sample(volumes.bridge.astype(np.float32), points).reshape(y.shape) > 0.5

    joined = at(0.0) | (at(-2.0) & at(2.0))
    joined = largest(ndimage.binary_fill_holes(opening(closing(joined, 4.0 / step), 1.5 / step)))
    if not joined.any() or not joined[:, z[0] > z_cut + 10].any():
        raise Problem("the labels that may go on across the midline (\"bridge\": true in the dictionary) do "
                      "not meet there: mark the callosum, the thalami and the brainstem")
    # Below the cut there is nothing; the outline must not end on it.
    loop = max(find_contours(np.pad(joined, 1).astype(float), 0.5), key=len) - 1
    return approximate_polygon(np.array([axes[0][0], axes[1][0]]) + step * loop, 0.3)[:-1]


def carried_falx(shape, box, bridge):
    """Free edge and straight sinus of the generic head in this one, the edge above the bridge."""
    edge, sinus = shape.box.map_to(box, shape.falx_edge), shape.box.map_to(box, shape.sinus)
    for point in edge[:-1]:
        while trimesh.in_polygon([point, point - (0, 2.0)], bridge).any():
            point[1] += 0.5
    sinus[0] = edge[-1]
    return edge, sinus


def derive(image, volumes, frame, mid, mid_rms, pc, shape, optic, radius):
    """The anatomy, and notes on what was derived."""
    unit, notes = volumes.grid.spacing, []
    z = volumes.height()
    end, z_cut = stem_end(image.path, volumes)
    lower = z.ravel()[end] - z_cut
    if lower > unit:
        notes.append(f"the brainstem is continued by {lower:.0f} mm, to below the cerebrum")
    section = continue_stem(volumes, end)
    z_floor = z_cut - BELOW_CUT
    brain = brain_distance(volumes, mid, z_cut, radius)
    obstacle = envelope.tentorium_distance(volumes.kind == CEREBELLUM, brain, unit)
    skull, note = skull_distance(volumes, brain)
    cavity = envelope.cavity_distance(skull, brain, obstacle, (z_floor - z) / unit, unit)
    bridge = bridge_outline(volumes, mid, z_cut)
    points = np.argwhere(volumes.kind == CEREBRUM) * unit + volumes.grid.origin
    box = generic.box_of(points, float(pc[1]))
    edge, sinus = carried_falx(shape, box, bridge)
    notes += [note, "the falx is derived: on the sheet between the halves, its free edge that of the generic "
                    "head by Talairach's proportions"]
    if optic is not None:
        optic = frame.to_head(optic)
    else:
        optic = shape.box.map_to(box, shape.optic)
        notes.append("the optic chiasm is the generic head's by Talairach's proportions")
    low = volumes.grid.origin
    high = low + unit * (np.array(volumes.kind.shape) - 1)
    middle = points.mean(axis=0)
    stem_middle = np.argwhere(section).mean(axis=0) * unit + low[:2]
    window = tuple((float(c - 40), float(c + 40)) for c in stem_middle)
    return Anatomy(
        grid=volumes.grid, brain=in_mm(brain, unit), cavity=in_mm(cavity, unit),
        obstacle=in_mm(obstacle, unit), mid=mid, mid_rms=mid_rms, z_cut=z_cut, z_floor=z_floor,
        bridge=bridge, falx_edge=edge, sinus=sinus, optic=optic, optic_radius=shape.optic_radius,
        midline=((float(low[1]), float(high[1])), float(high[2])), cavity_z=float(z_floor - 10),
        stem=window, falx=((float(low[1]), float(high[1])), (float(low[2]), float(high[2]))),
        body=(tuple(middle), float(np.linalg.norm(high - low)) / 2)), notes


def in_mm(distance, unit):
    """Voxels -> mm, rounded to 2^-12 mm: the mesh shall not hang on the last bits of another version's
    Gaussian filter."""
    return (np.round(distance * unit * 4096) / 4096).astype(np.float32)


def label_at(volumes):
    """Function: the nearest label at points (n, 3)."""
    def label(points):
        index = np.rint((points - volumes.grid.origin) / volumes.grid.spacing).astype(int)
        return volumes.value[tuple(np.clip(index, 0, np.array(volumes.value.shape) - 1).T)]

    return label
