#!/usr/bin/python3
"""Makes a synthetic head for tests and for trying: a label map with FreeSurfer's values, and a plan.

Usage: make_phantom.py FOLDER [--voxel MM]

Writes FOLDER/labels.nii.gz, and the same trajectories and landmarks as 3D Slicer markups twice:
FOLDER/plan_ras/*.mrk.json in RAS, FOLDER/plan_lps/*.mrk.json in LPS. The head is made of ellipsoids in
the sizes of a real one, with furrows in its cortex. It is turned and shifted against the axes of the
world, its voxels are anisotropic, their first axis runs from right to left, as scanners store them."""
import argparse
import pathlib

import nibabel
import numpy as np

import markups

# Head in the world: turned by these angles (degrees: nodding, tilting, turning) and shifted (mm).
ANGLES, SHIFT = (6.0, 3.0, -4.0), np.array([7.0, -12.0, 21.0])
VOXEL = np.array([1.9, 2.1, 2.4])  # mm
REACH = np.array([86.0, 118.0, 92.0])  # half the width of the image, mm

AC, PC = np.array([0.0, 0.0, 0.0]), np.array([0.0, -26.0, 0.0])  # frame of the commissures, RAS, mm
TARGETS = {"left": (-11.5, -16.0, -4.5), "right": (11.5, -16.0, -4.5)}
ENTRIES = {"left": (-39.0, 22.0, 62.0), "right": (38.0, 24.0, 61.0)}
STN = {"left": (-11.8, -15.5, -4.2), "right": (11.8, -15.5, -4.2)}


def turn(part=1.0):
    """Rotation from the frame of the commissures to the world, or a part of it."""
    a, b, c = part * np.radians(ANGLES)
    about_x = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    about_y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    about_z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return about_z @ about_x @ about_y


def to_world(points):
    return np.asarray(points, float) @ turn().T + SHIFT


def ellipsoid(x, y, z, centre, axes):
    """Below 1 inside."""
    return sum(((v - c) / a)**2 for v, c, a in zip((x, y, z), centre, axes))


def midline(y, z):
    """The fissure is a little curved, as real ones are."""
    return 1.2 * np.sin(y / 40) * np.clip(z / 60, -0.5, 1)


def cerebrum(x, y, z):
    """Depth (mm, about) below the cortex: an ellipsoid, furrowed, less what lies under it."""
    r = np.sqrt(ellipsoid(x, y, z, (0, -16, 14), (66, 83, 58)))
    furrows = 2.0 * (np.cos(x / 5.5) * np.cos(y / 6.5) + np.cos(z / 6.0 + y / 9.0))
    depth = 66 * (1 - r) - np.clip(furrows - 1.2, 0, None) * 3.0
    behind = np.sqrt(ellipsoid(x, y, z, (0, -62, -42), (54, 42, 30)))
    below = np.sqrt(ellipsoid(x, y, z, (0, -22, -48), (25, 42, 33)))
    return np.minimum(depth, np.minimum(30 * (behind - 1), 25 * (below - 1)))


def paint(x, y, z):
    """FreeSurfer labels at points of the frame of the commissures."""
    x = x - midline(y, z)
    left = x < 0
    labels = np.zeros(x.shape, np.int16)

    def put(mask, value, right_value=None):
        labels[mask] = value if right_value is None else np.where(left, value, right_value)[mask]

    def both(centre, axes):
        mirrored = (np.abs(x), y, z)
        return ellipsoid(*mirrored, centre, axes) < 1

    depth = cerebrum(x, y, z)
    fissure = np.abs(x) < 1.1
    put((depth > 0) & ~fissure, 3, 42)
    put((depth > 4) & (np.abs(x) > 4), 2, 41)
    put(ellipsoid(x, y, z, (0, -62, -42), (48, 34, 25)) < 1, 8, 47)
    put(ellipsoid(x, y, z, (0, -62, -42), (34, 22, 15)) < 1, 7, 46)
    # Deep nuclei.
    put(both((25, 2, 2), (5, 16, 9)), 12, 51)
    put(both((19, -3, -1), (4.5, 9, 6)), 13, 52)
    put(both((13, 12, 13), (4.5, 12, 7)), 11, 50)
    put(both((29, -20, -13), (5, 17, 5)), 17, 53)
    put(both((24, 0, -15), (6, 6, 6)), 18, 54)
    # What is one piece on the midline, then the fluid in it.
    core = ellipsoid(x, y, z, (0, -13, 2), (20, 24, 20)) < 1
    put(core & (labels != 12) & (labels != 51) & (labels != 13) & (labels != 52), 2, 41)
    put(both((11, -19.8, 9.5), (8, 14, 8)), 10, 49)
    put(both((10, -14, -7), (8.5, 11, 6)), 28, 60)
    arch = (ellipsoid(0 * x, y, z, (0, -8, 4), (1, 41, 26)) < 1) & (
        ellipsoid(0 * x, y, z, (0, -8, 2), (1, 35, 21)) > 1) & (z > 3) & (np.abs(x) < 9)
    put(arch, 253)
    put(arch & (y < -32), 251)
    put(arch & (y > 18), 255)
    put(both((9, -2, 17), (6, 25, 6)), 4, 43)
    put(ellipsoid(x, y, z, (0, -13, 2), (2.5, 12, 8)) < 1, 14)
    # Brainstem, from the midbrain down and back to the foramen magnum.
    t = np.clip((-8 - z) / 60, 0, 1)
    width = 15 - 5 * t
    stem = (np.hypot(x / 1.1, y + 22 + 16 * t) < width) & (z < -6) & (z > -60)
    put(stem, 16)
    put(ellipsoid(x, y, z, (0, -47, -32), (4, 5, 9)) < 1, 15)
    return labels


def image(voxel):
    """The label map; its first voxel axis runs to the left."""
    shape = np.ceil(2 * REACH / voxel).astype(int)
    affine = np.eye(4)
    # Turned against the world, and by two thirds as much against the head.
    affine[:3, :3] = turn(1 / 3) @ np.diag(voxel * (-1, 1, 1))
    centre = to_world((0, -16, 4))
    affine[:3, 3] = centre - affine[:3, :3] @ ((shape - 1) / 2)
    index = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    world = index @ affine[:3, :3].T + affine[:3, 3]
    points = (world - SHIFT) @ turn()  # the inverse of to_world
    result = nibabel.Nifti1Image(paint(*np.moveaxis(points, -1, 0)), affine)
    result.header.set_xyzt_units("mm")
    return result


def write_plan(folder, frame):
    folder.mkdir(parents=True, exist_ok=True)
    for side in ("left", "right"):
        markups.write(folder / f"trajectory_{side}.mrk.json", [
            markups.Markup("Line", f"trajectory_{side}", ["entry", "target"],
                           to_world([ENTRIES[side], TARGETS[side]]))], frame)
    names = ["AC", "PC", "STN_left", "STN_right"]
    markups.write(folder / "landmarks.mrk.json", [
        markups.Markup("Fiducial", "landmarks", names,
                       to_world([AC, PC, STN["left"], STN["right"]]))], frame)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--voxel", type=float, help="edge of cubic voxels, mm (default: 1.9 x 2.1 x 2.4)")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    voxel = VOXEL if options.voxel is None else np.full(3, options.voxel)
    nibabel.save(image(voxel), options.folder / "labels.nii.gz")
    write_plan(options.folder / "plan_ras", "RAS")
    write_plan(options.folder / "plan_lps", "LPS")
    print(f"written to {options.folder}: labels.nii.gz, plan_ras, plan_lps")


if __name__ == "__main__":
    main()
