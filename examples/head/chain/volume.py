"""Voxel images: where a grid lies, morphology with Euclidean balls, smooth signed distances.

Radii and distances are in voxels."""
from dataclasses import dataclass

import numpy as np
import scipy.ndimage as ndimage


@dataclass
class Grid:
    """Cubic voxels along the axes of the head frame: centre of voxel (0, 0, 0) and edge, mm."""
    origin: np.ndarray
    spacing: float

    def sample(self, volume, points):
        """Trilinear value at points (n, 3) of the head frame; beyond the volume its border's."""
        index = (np.asarray(points, float) - self.origin) / self.spacing
        return ndimage.map_coordinates(volume, index.T, order=1, mode="nearest")

    def axes(self, shape):
        """Coordinates of the voxels as three broadcastable arrays."""
        axes = [o + self.spacing * np.arange(n) for n, o in zip(shape, self.origin)]
        return np.meshgrid(*axes, indexing="ij", sparse=True)


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
