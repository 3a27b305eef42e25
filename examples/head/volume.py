"""Voxel images: loading, morphology with Euclidean balls, smooth signed distances."""
import nibabel
import numpy as np
import scipy.ndimage as ndimage

from frame import AC, ORIGIN, SCALE

TEMPLATES = "/usr/share/mricron/templates/"
PAD = 24  # voxels added on every side: room for a closing of 15 mm and for the distance fields


def load(name):
    """A volume of Debian's mricron-data as float32, padded by PAD voxels of zeros."""
    image = nibabel.load(TEMPLATES + name + ".nii.gz")
    return np.pad(np.asarray(image.dataobj).astype(np.float32), PAD)


def mni_axes(shape):
    """MNI coordinates of the voxels, as three broadcastable arrays."""
    axes = [np.arange(n) - PAD + o for n, o in zip(shape, ORIGIN)]
    return np.meshgrid(*axes, indexing="ij", sparse=True)


def voxel(point_mni):
    """Index of the voxel nearest to an MNI position."""
    return tuple(np.rint(np.asarray(point_mni) - ORIGIN).astype(int) + PAD)


def grid_origin():
    """Head coordinates of voxel (0, 0, 0) of a padded volume; the spacing is SCALE."""
    return AC + SCALE * (ORIGIN - PAD - AC)


def sample(volume, points):
    """Trilinear value of a padded volume at head coordinates (n, 3)."""
    index = (np.asarray(points, float) - grid_origin()) / SCALE
    return ndimage.map_coordinates(volume, index.T, order=1, mode="nearest")


def dilate(mask, radius):
    return ndimage.distance_transform_edt(~mask) <= radius


def erode(mask, radius):
    return ndimage.distance_transform_edt(mask) > radius


def opening(mask, radius):
    return dilate(erode(mask, radius), radius)


def closing(mask, radius):
    return erode(dilate(mask, radius), radius)


def largest(mask):
    labels, count = ndimage.label(mask)
    return labels == 1 + np.argmax(np.bincount(labels.ravel())[1:]) if count else mask


def signed_distance(mask):
    """Distance to the boundary in voxels, negative inside; zero half way between voxel centres."""
    outside = ndimage.distance_transform_edt(~mask)
    inside = ndimage.distance_transform_edt(mask)
    return np.where(mask, 0.5 - inside, outside - 0.5).astype(np.float32)


def smooth_distance(mask, sigma):
    """Signed distance in voxels, smoothed: its zero surface is the smoothed boundary."""
    return ndimage.gaussian_filter(signed_distance(mask), sigma)
