"""What encloses the tissue: a smooth brain without sulci, and the inner skull around it.

Masks and distances on one grid, in voxels; `unit` is the voxel's edge in the units (about mm) in
which the radii below are given."""
import numpy as np
import scipy.ndimage as ndimage

from .volume import closing, largest, opening, smooth_distance

BRAIN_MARGIN = 1.0  # fluid kept between brain and wall everywhere
VAULT_OFFSET, BASE_OFFSET = 2.5, 0.5  # between the closed hull and the skull


def smooth_solid(solid, unit=1.0, radius=3.0):
    """Tissue closed over sulci by a ball of `radius`, holes filled, without what sticks out or lies
    apart."""
    closed = ndimage.binary_fill_holes(closing(solid, radius / unit))
    return largest(opening(closed, 1.5 / unit))


def tentorium_distance(cerebellum, brain, unit=1.0):
    """Signed distance of the sheet half way between cerebellum and brain, negative behind it."""
    behind = smooth_distance(closing(cerebellum, 3.0 / unit), 1.6 / unit)
    return ndimage.gaussian_filter((behind - brain) / 2, 1.0 / unit)


def hull_distance(whole, height, unit=1.0):
    """Signed distance of the inner skull: closed hull of the whole brain plus the fluid on it.

    height: of the voxels above the commissures. A ball of 15 mm suits the convexity; at the base it
    would swallow the sphenoid wings and the petrous bones, so a smaller one is used there. How far
    the skull is cannot be seen on T1 (fluid and inner table are both dark over 3-5 mm outside the
    cortex). VAULT_OFFSET is chosen for a mean gap of the convexity near the 2.9 mm of the literature;
    at the base the brain lies on the bone."""
    hull = (closing(whole, 15.0 / unit) & (height > 0)) | closing(whole, 6.0 / unit)
    t = np.clip((height + 15) / 25, 0, 1)
    offset = BASE_OFFSET + (VAULT_OFFSET - BASE_OFFSET) * t**2 * (3 - 2 * t)
    return smooth_distance(hull, 2.5 / unit) - offset / unit


def cavity_distance(skull, brain, obstacle, below_floor, unit=1.0):
    """Signed distance of the space inside the skull, before the tentorium and above the floor.
    below_floor: depth of the voxels below the floor."""
    margin = BRAIN_MARGIN / unit
    # Thin fingers without brain in them (between petrous bone and cerebellum) are cut off.
    cavity = opening((skull < 0) & (obstacle > 0), 4.0 / unit) | (brain < margin)
    cavity &= below_floor < 0
    # Smoothing a mask loses some of the margin; where it does, the brain's own distance decides.
    return np.minimum(smooth_distance(cavity, 2.0 / unit), np.maximum(brain - margin, below_floor))
