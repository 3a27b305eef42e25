"""Coordinates of the generic head and everything that was placed by hand.

Two frames, both RAS in mm (x right, y anterior, z superior):
  MNI   the space of Colin27. The MINC release of Colin27 starts at (-90, -126, -72); the header of
        MRIcron's copy (ch2) says (-90, -125, -71). With the MINC origin the commissures of ch2 fall
        within about 2 mm of those published for MNI152 (below), with the header's they are 1 mm
        further off along y. The MINC origin is used.
  head  MNI scaled about the anterior commissure: MNI space is larger than life, and a brain of
        1.4 kg in it would be lighter than cerebrospinal fluid.
"""
import numpy as np

ORIGIN = np.array([-90.0, -126.0, -72.0])  # MNI position of voxel (0, 0, 0), voxels of 1 mm

# Mask volume x SCALE^3 x DENSITY = 1.40 kg; segment.py prints the product, check_head.py checks it.
SCALE = 0.947
DENSITY = 1.04e-6  # kg/mm^3
WHOLE_BRAIN_MASS = 1.40  # kg

# Centres of the commissures on the midsagittal section of the T1 image (read off by eye, +-0.5 mm).
# For comparison, MNI152: AC (0.25, 1.30, -5.00), PC (-0.19, -24.76, -2.38), the facing edges
# (Horn et al. 2017, NeuroImage 150:395, as used in Lead-DBS).
AC = np.array([0.0, 3.5, -5.0])
PC = np.array([0.0, -24.3, -3.0])

# MNI positions of the landmarks (mm) and where they come from.
LANDMARKS_MNI = {
    "STN_left": (-11.15, -12.78, -7.66),  # CIT168 centroid (Pauli 2018, Sci Data 5:180063)
    "STN_right": (10.81, -11.95, -7.75),
}
# Posteroventral pallidal target relative to MCP, life size: 20 mm lateral, 2 mm anterior and 4.5 mm
# below the AC-PC line (Laitinen 1992, J Neurosurg 76:53: 18-21, 2-3, 3-6 mm).
GPI_FROM_MCP = np.array([20.0, 2.0, -4.5])
TARGET_MNI = {"left": (-12.0, -13.0, -8.0), "right": (12.0, -13.0, -8.0)}
SAGITTAL_DEG, LATERAL_DEG = 60.0, 20.0

# The brainstem is cut by a horizontal plane at the foramen magnum; the cavity goes on below it.
STEM_CUT_MNI = -60.0
CAVITY_FLOOR_MNI = -66.0

# Optic chiasm and the nerves' ends at it: centre and radius (MNI) on the midsagittal section.
OPTIC_MNI, OPTIC_RADIUS_MNI = np.array([0.0, 8.0, -20.0]), 9.0

# Posterior face of the brainstem on the midsagittal section, (z, y): tectum, floor of the fourth
# ventricle, medulla. Tissue of the lower posterior fossa in front of it and less than
# STEM_HALF_WIDTH from the midline is brainstem; the cut goes through the cerebellar peduncles.
STEM_BACK_MNI = np.array([[-72, -51], [-60, -49], [-50, -44], [-40, -39.5], [-30, -35.5],
                          [-20, -34.5], [-8, -37]], float)
STEM_HALF_WIDTH_MNI = np.array([[-72, 11], [-50, 11], [-44, 17], [-8, 18]], float)

# Outline (y, z) around what is one piece of tissue on the midline, wider than it where fluid is:
# corpus callosum, septum and fornix, diencephalon with the (filled) third ventricle, midbrain, pons,
# medulla. Drawn on x = 0 of ch2.
BRIDGE_MNI = np.array([
    [-38, 9], [-38, 28], [-31, 31], [-22, 31], [-8, 31], [4, 29.5], [14, 25], [22, 20], [30, 14],
    [34.5, 5], [35, -1], [27, -4], [16, -3], [9, -6], [6, -11], [8, -17], [12, -20], [8, -24],
    [0, -20], [-6, -17], [-8, -21], [-7, -27], [-8, -37], [-13, -47], [-22, -54],
    [-25, -60], [-26, -75], [-56, -75], [-52, -60], [-47, -50], [-43, -40], [-39, -30], [-39, -20],
    [-42, -10], [-41, -3], [-37, 3], [-34, 8]], float)

# Free edge of the falx (y, z) from the crista galli over the corpus callosum to its splenium, where
# it meets the tentorium: low behind (a few mm from the splenium), high in front.
FALX_EDGE_MNI = np.array([
    [62, -16], [58, -4], [54, 8], [47, 20], [38, 30], [27, 37], [14, 41], [0, 42], [-14, 41],
    [-26, 37.5], [-36, 31], [-42, 24.5]], float)
# Below the falx behind its free edge: straight sinus from the splenium to the torcula (y, z).
STRAIGHT_SINUS_MNI = np.array([[-42, 24.5], [-52, 13], [-62, 2], [-72, -8], [-84, -17],
                               [-100, -24]], float)

# Seeds of the watershed that parts cerebellum from cerebrum (MNI centre, radius), mirrored in x.
CEREBRUM_SEEDS = [((50, -25, -22), 10), ((40, -90, 0), 8), ((25, -92, 0), 8), ((15, -88, 0), 6),
                  ((58, -40, -5), 8), ((52, -55, -10), 5), ((30, -35, -12), 3)]
CEREBELLUM_SEEDS = [((25, -65, -40), 12), ((12, -55, -25), 8), ((40, -65, -38), 8),
                    ((15, -75, -35), 6), ((0, -60, -20), 6)]
# Points inside the lateral ventricles, mirrored in x.
VENTRICLE_SEEDS = [(8, 15, 12), (10, -10, 22), (24, -42, 10), (8, 5, 16), (30, -50, 8)]


def to_head(points):
    """MNI -> head, both mm; points (..., 3)."""
    return AC + SCALE * (np.asarray(points, float) - AC)


def to_head_yz(points):
    """The same for (y, z) pairs on the midsagittal section."""
    return AC[1:] + SCALE * (np.asarray(points, float) - AC[1:])


def landmarks():
    """Name -> position, head frame."""
    points = {"AC": AC, "PC": to_head(PC), "MCP": (AC + to_head(PC)) / 2}
    points.update({name: to_head(p) for name, p in LANDMARKS_MNI.items()})
    for side, sign in (("left", -1), ("right", 1)):
        points[f"GPi_{side}"] = points["MCP"] + GPI_FROM_MCP * (sign, 1, 1)
    return points


def trajectory_direction(side):
    """Unit vector from the target outwards: t = (+-sin b, cos b cos a, cos b sin a)."""
    a, b = np.radians(SAGITTAL_DEG), np.radians(LATERAL_DEG)
    sign = 1.0 if side == "right" else -1.0
    return np.array([sign * np.sin(b), np.cos(b) * np.cos(a), np.cos(b) * np.sin(a)])
