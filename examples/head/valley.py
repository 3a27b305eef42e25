"""The mid-surface of Colin27: the polynomial through the dark valley between the hemispheres on T1."""
import numpy as np
import scipy.ndimage as ndimage

import frame
from chain import midsurface
from template import mni_axes


def valley(t1, region, centre, half_width):
    """For each (y, z): x (MNI) of the darkest point within half_width of centre, with its weight."""
    x = mni_axes(t1.shape)[0].ravel()
    near = np.abs(x[:, None, None] - centre[None]) <= half_width
    value = np.where(near & region, t1, 1e3)
    best = np.argmin(value, axis=0)
    j, k = np.indices(best.shape)
    low = value[best, j, k]
    # Sub-voxel position from the parabola through the three lowest values.
    left, right = t1[best - 1, j, k], t1[np.minimum(best + 1, len(x) - 1), j, k]
    bend = np.maximum(left - 2 * low + right, 1e-3)
    shift = np.clip(0.5 * (left - right) / bend, -0.5, 0.5)
    inner = np.abs(x[best] - centre) < half_width - 0.5  # a minimum, not the end of the window
    rise = np.minimum(left, right) - low
    return x[best] + shift, inner & (low < 70) & (rise > 0.5)


def fit(t1, region):
    """Robust least squares: the window around the last sheet narrows, Cauchy weights at 1 mm.

    region: voxels that may hold the fissure. Returns coefficients (head frame) and rms (mm)."""
    smooth = ndimage.gaussian_filter(t1, 1.0)
    _, y, z = mni_axes(t1.shape)
    y, z = np.broadcast_arrays(y[0], z[0])
    centre = np.zeros(y.shape)
    for half_width in (8, 6, 5, 4, 4, 4):
        x, good = valley(smooth, region, centre, half_width)
        points = frame.to_head(np.stack([x[good], y[good], z[good]], axis=-1))
        coefficients, residual = midsurface.robust(points)
        head = frame.to_head(np.stack([0 * y, y, z], axis=-1))
        centre = midsurface.evaluate(coefficients, head[..., 1], head[..., 2]) / frame.SCALE
        centre = np.clip(centre, -15, 15)
    return midsurface.rounded(coefficients, residual)
