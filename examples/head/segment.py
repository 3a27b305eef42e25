#!/usr/bin/env python3
"""Colin27 T1 image -> smooth signed distances of brain and cavity, and the mid-surface.

Usage: segment.py WORK_DIR. Writes WORK_DIR/segmentation.npz (head frame, see frame.py):
  t1                T1 intensity, padded voxels (for pictures)
  brain             signed distance (mm) of cerebrum + brainstem, sulci and ventricles filled
  cavity            signed distance (mm) of the intracranial space outside the cerebellum
  obstacle          signed distance (mm), negative on the cerebellum's side of the tentorium
  mid               coefficients of the mid-surface, mid_rms its residual
  mask_volume_mni   tissue of the whole brain, MNI mm^3
"""
import pathlib
import sys

import numpy as np
import scipy.ndimage as ndimage
from skimage.segmentation import watershed

import frame
import valley
from chain import envelope
from chain.volume import closing, dilate, erode, largest, opening, smooth_distance
from template import load, mni_axes, voxel

TISSUE = 62  # T1 value between cerebrospinal fluid (about 35) and grey matter (about 85)


def tissue_mask(t1, extracted):
    """Whole brain. The extracted volume (ch2bet) has streaks, and steps where it lost some cortex."""
    rough = largest(opening(extracted > TISSUE, 1.5))
    # Win back the lost cortex from the whole head, not further out than the closed brain, and not
    # fat, which is brighter than white matter.
    return largest(opening((t1 > TISSUE) & (t1 < 135) & closing(rough, 8), 1.5)), rough


def infratentorial_labels(t1, tissue):
    """Watershed on the T1 image from seeds: 1 cerebrum, 2 cerebellum, 3 brainstem.

    The tentorium is a dark sheet of one or two voxels, which the watershed follows."""
    x, y, z = mni_axes(t1.shape)

    def ball(centre, radius):
        return (x - centre[0])**2 + (y - centre[1])**2 + (z - centre[2])**2 < radius**2

    seeds = np.zeros(t1.shape, np.int32)
    seeds[(z > 12) & tissue] = 1
    seeds[(y > -6) & tissue] = 1
    for label, balls in ((1, frame.CEREBRUM_SEEDS), (2, frame.CEREBELLUM_SEEDS)):
        for (bx, by, bz), radius in balls:
            for side in (-1, 1):
                seeds[ball((side * bx, by, bz), radius) & tissue] = label
    seeds[(np.abs(x) < 8) & (y > -31) & (y < -9) & (z < -11) & tissue] = 3
    labels = watershed(-ndimage.gaussian_filter(t1, 0.7), seeds, mask=tissue)

    back = np.interp(z, *frame.STEM_BACK_MNI.T)  # y of the brainstem's posterior face
    half_width = np.interp(z, *frame.STEM_HALF_WIDTH_MNI.T)
    stem = (y > back) & (np.abs(x) < half_width)
    labels[(labels >= 2) & stem] = 3
    labels[(labels >= 2) & ~stem] = 2
    return labels


def ventricles(t1):
    """Lateral and third ventricles: dark, opened by 1 mm so that they part from the cisterns."""
    x, y, z = mni_axes(t1.shape)
    dark = (t1 < 66) & (np.abs(x) < 42) & (np.abs(x) > 1) & (y > -76) & (y < 41) & (z < 33) & (z > -23)
    cores, _ = ndimage.label(erode(dark, 1.0))
    seeds = [cores[voxel((s * a, b, c))] for s in (-1, 1) for a, b, c in frame.VENTRICLE_SEEDS]
    lateral = dark & dilate(np.isin(cores, [s for s in seeds if s]), 1.5)
    third = (np.abs(x) < 7) & (y > -29) & (y < 8) & (z > -16) & (z < 22) & (t1 < 75)
    return lateral | third


def brain_distance(labels, t1):
    """Cerebrum + brainstem without sulci and ventricles; voxels. The brainstem goes on downwards
    below the cut so that the cut face is a clean section."""
    z = mni_axes(t1.shape)[2]
    solid = (labels == 1) | (labels == 3) | ventricles(t1)
    solid = envelope.smooth_solid(solid)
    floor = voxel((0, 0, frame.STEM_CUT_MNI - 1))[2]
    solid[:, :, :floor] = solid[:, :, floor:floor + 1]
    return np.maximum(smooth_distance(solid, 1.6), frame.STEM_CUT_MNI - 10 - z)


def in_mm(distance):
    """Voxels -> mm of the head frame, rounded to 2^-12 mm: the mesh shall not hang on the last bits
    of another version's Gaussian filter."""
    return (np.round(distance * frame.SCALE * 4096) / 4096).astype(np.float32)


def main(work):
    t1, extracted = load("ch2"), load("ch2bet")
    tissue, rough = tissue_mask(t1, extracted)
    mass = tissue.sum() * frame.SCALE**3 * frame.DENSITY
    print(f"tissue {tissue.sum() / 1e3:.0f} cm3 in MNI size, {mass:.3f} kg after scaling", flush=True)
    labels = infratentorial_labels(t1, tissue)
    print("cerebrum, cerebellum, brainstem (cm3, MNI):",
          *(f"{np.sum(labels == k) / 1e3:.0f}" for k in (1, 2, 3)), flush=True)
    brain = brain_distance(labels, t1)
    obstacle = envelope.tentorium_distance(labels == 2, brain)
    z = mni_axes(t1.shape)[2]
    skull = envelope.hull_distance(tissue | (brain < 0), z - frame.AC[2])
    cavity = envelope.cavity_distance(skull, brain, obstacle, frame.CAVITY_FLOOR_MNI - z)
    mid, rms = valley.fit(t1, cavity < -2)
    print(f"mid-surface: residual {rms:.2f} mm rms", flush=True)
    pathlib.Path(work).mkdir(parents=True, exist_ok=True)
    np.savez_compressed(pathlib.Path(work) / "segmentation.npz", t1=t1.astype(np.uint8),
                        brain=in_mm(brain), cavity=in_mm(cavity), obstacle=in_mm(obstacle),
                        mid=mid, mid_rms=rms, mask_volume_mni=float(tissue.sum()))


if __name__ == "__main__":
    main(sys.argv[1])
