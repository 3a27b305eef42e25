"""The generic head (examples/head) in the frame of its commissures: what is carried over from it to a
head whose labels do not show it.

Points are carried over by Talairach's proportional grid (Talairach and Tournoux 1988): lengths before
AC, between AC and PC and behind PC, above and below the commissures are stretched to the new brain's."""
from dataclasses import dataclass

import numpy as np

import frame
from chain import vtkxml

# Midpoint between the thalami in the frame of the commissures (AC is the origin), mm: centroids of the
# Harvard-Oxford thalami in MNI space, (+-11, -18.5, 7), in life size.
THALAMI = np.array([0.0, -19.8, 9.5])
AC_TO_PC = 26.0  # mm, of a mean adult


@dataclass
class Box:
    """Talairach's reference lengths, mm: y of the frontal pole, of PC and of the occipital pole, z of the
    vertex and of the lowest cortex; AC is the origin."""
    front: float
    pc: float
    back: float
    top: float
    bottom: float

    def map_to(self, other, points):
        """Carries points (..., 2 or 3 with y, z last) from this brain to another."""
        points = np.array(points, float)
        knots = (self.back, self.pc, 0.0, self.front), (other.back, other.pc, 0.0, other.front)
        points[..., -2] = stretch(points[..., -2], *knots)
        knots = (self.bottom, 0.0, self.top), (other.bottom, 0.0, other.top)
        points[..., -1] = stretch(points[..., -1], *knots)
        return points


def stretch(values, here, there):
    """Linear between the knots and beyond them with the slope of the last piece."""
    k = np.clip(np.searchsorted(here, values) - 1, 0, len(here) - 2)
    here, there = np.asarray(here), np.asarray(there)
    slope = (there[k + 1] - there[k]) / (here[k + 1] - here[k])
    return there[k] + slope * (values - here[k])


def box_of(points, pc):
    """From the cerebrum's points, frame of the commissures. The lowest cortex is that of the temporal
    lobes: the brainstem, near the midline, does not count."""
    temporal = np.abs(points[:, 0]) > 20
    return Box(points[:, 1].max(), pc, points[:, 1].min(), points[:, 2].max(),
               points[temporal, 2].min())


def commissural(points):
    """Points (..., 3) of the generic head in the frame of its commissures."""
    along = frame.AC - frame.to_head(frame.PC)
    along[0] = 0  # both lie on the midline
    y = along / np.linalg.norm(along)
    turn = np.array([[1.0, 0, 0], y, np.cross([1.0, 0, 0], y)])
    return (np.asarray(points, float) - frame.AC) @ turn.T


def commissural_yz(points):
    """The same for MNI (y, z) on the midsagittal section."""
    flat = frame.to_head_yz(points)
    return commissural(np.column_stack([np.zeros(len(flat)), flat]))[:, 1:]


def pole_line(points):
    """Occipital to frontal pole: the farthest apart of the cerebrum's points along y, iterated."""
    along = np.array([0.0, 1.0, 0.0])
    for _ in range(10):
        ends = points[[np.argmin(points @ along), np.argmax(points @ along)]]
        along = ends[1] - ends[0]
        along[0] = 0
        along /= np.linalg.norm(along)
    return along


class Generic:
    def __init__(self, folder):
        nodes, tets, cells, tags = vtkxml.read(folder / "brain.vtu")
        points = commissural(nodes)
        self.box = box_of(points, -np.linalg.norm(frame.AC - frame.to_head(frame.PC)))
        self.poles = pole_line(points[tags["stem"] == 0])
        self.falx_edge = commissural_yz(frame.FALX_EDGE_MNI)
        self.sinus = commissural_yz(frame.STRAIGHT_SINUS_MNI)
        self.optic = commissural(frame.to_head(frame.OPTIC_MNI))
        self.optic_radius = frame.OPTIC_RADIUS_MNI * frame.SCALE
