"""The Colin27 volumes of Debian's mricron-data, padded, and where their voxels lie."""
import nibabel
import numpy as np

from frame import AC, ORIGIN, SCALE

TEMPLATES = "/usr/share/mricron/templates/"
PAD = 24  # voxels added on every side: room for a closing of 15 mm and for the distance fields


def load(name):
    """A volume as float32, padded by PAD voxels of zeros."""
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
