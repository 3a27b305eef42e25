"""Where the head lies in the image: the fissure, the commissures, and the frame they span.

Head frame: RAS, mm, AC is the origin, PC lies behind it on the y axis, x is at right angles to the
fissure. It is that of stereotactic planning; angles of trajectories are meant in it."""
from dataclasses import dataclass

import numpy as np

import generic
from chain import midsurface
from labels import BRAINSTEM, CEREBELLUM, CEREBRUM
from problem import Problem, point

WIDEST_FISSURE = 15.0  # mm between left and right labels that face each other across it
NARROWEST_STEM = 8.0   # mm: columns at the brainstem's front and back say little about its middle


@dataclass
class Frame:
    matrix: np.ndarray  # 4 x 4, world -> head

    def to_head(self, points):
        return np.asarray(points, float) @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    def to_world(self, points):
        return (np.asarray(points, float) - self.matrix[:3, 3]) @ self.matrix[:3, :3]

    def turn_to_world(self, vectors):
        return np.asarray(vectors, float) @ self.matrix[:3, :3]


def across(image):
    """The voxel axis next to x, and the voxels' width along it (mm)."""
    axis = int(np.argmax(np.abs(image.affine[0, :3])))
    return axis, float(np.linalg.norm(image.affine[:3, axis]))


def fissure_points(image, parts):
    """World points half way between left and right labels that face each other along the voxel axis
    next to x."""
    axis, width = across(image)
    side = np.where(parts.kind == CEREBRUM, parts.side, 0)
    side = np.moveaxis(side if image.affine[0, axis] > 0 else -side, axis, 0)
    # In each column: the last voxel of the side that comes first, the first of the other one.
    index = np.arange(len(side))[:, None, None]
    last = np.where(side < 0, index, -1).max(axis=0)
    first = np.where(side > 0, index, len(side)).min(axis=0)
    facing = (last >= 0) & (first < len(side)) & (last < first) & (
        (first - last - 1) * width < WIDEST_FISSURE)
    return middles(image, axis, (last + first) / 2, facing)


def stem_points(image, parts):
    """World points half way between left and right border of the brainstem, along the same axis: the
    fissure does not reach down there, and a polynomial goes astray where no points hold it."""
    axis, width = across(image)
    stem = np.moveaxis(parts.kind == BRAINSTEM, axis, 0)
    first = np.argmax(stem, axis=0)
    last = len(stem) - 1 - np.argmax(stem[::-1], axis=0)
    wide = stem.any(axis=0) & ((last - first + 1) * width > NARROWEST_STEM)
    return middles(image, axis, (first + last) / 2, wide)


def middles(image, axis, middle, chosen):
    """World points at `middle` along the axis, in the chosen columns of voxels."""
    return image.world(np.insert(np.argwhere(chosen).astype(float), axis, middle[chosen], axis=1))


def fissure_plane(path, points):
    """Unit normal to the right and offset of the plane through the fissure, robust."""
    if len(points) < 200:
        raise Problem(f"{path}: left and right labels face each other in {len(points)} places only, so the "
                      "fissure cannot be found: check the sides of the labels, or the header's axes")
    weight = np.ones(len(points))
    matrix = np.column_stack([np.ones(len(points)), points[:, 1:]])
    for _ in range(20):
        root = np.sqrt(weight)
        a, b, c = np.linalg.lstsq(matrix * root[:, None], points[:, 0] * root, rcond=None)[0]
        weight = 1 / (1 + (points[:, 0] - matrix @ (a, b, c))**2)
    length = np.sqrt(1 + b * b + c * c)
    tilt = np.degrees(np.arccos(1 / length))
    if tilt > 35:
        raise Problem(f"{path}: the fissure is turned by {tilt:.0f} degrees against the image's x axis: check "
                      "the header's axes, or turn the image upright")
    return np.array([1.0, -b, -c]) / length, a / length


def frame_of(right, ac, pc):
    """The frame that AC, PC and the direction to the right span."""
    y = ac - pc
    y = y - (y @ right) * right
    y /= np.linalg.norm(y)
    turn = np.array([right, y, np.cross(right, y)])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, -turn @ ac
    return Frame(matrix)


def derive_commissures(image, parts, plane, shape):
    """AC and PC (world) from the thalami: the line of the poles gives the direction, as it lies in the
    generic head."""
    missing = [f"thalamus_{side}" for side in ("left", "right")
               if f"thalamus_{side}" not in parts.landmarks]
    if missing:
        raise Problem(f"landmark 'AC' is missing and cannot be derived without a label for {missing[0]}: "
                      "give AC and PC as points of a .mrk.json with --plan")
    right, offset = plane
    cerebrum = image.world(np.argwhere((parts.kind == CEREBRUM)))
    upright = frame_of(right, np.zeros(3), np.array([0.0, -1.0, 0.0]))
    poles = generic.pole_line(upright.to_head(cerebrum))
    # Nodding angle between the line of the poles here and there.
    angle = np.arctan2(poles[2], poles[1]) - np.arctan2(shape.poles[2], shape.poles[1])
    y = upright.turn_to_world([0.0, np.cos(angle), np.sin(angle)])
    up = np.cross(right, y)
    middle = (parts.landmarks["thalamus_left"] + parts.landmarks["thalamus_right"]) / 2
    middle = middle - (middle @ right - offset) * right
    ac = middle - generic.THALAMI[1] * y - generic.THALAMI[2] * up
    return ac, ac - generic.AC_TO_PC * y


def check_commissures(ac, pc, plane, sources):
    """Given commissures lie on the midline and a commissures' distance apart."""
    right, offset = plane
    for name, position in (("AC", ac), ("PC", pc)):
        off = float(position @ right - offset)
        if abs(off) > 6:
            raise Problem(f"{sources[name]}: {name} {point(position)} RAS lies {abs(off):.0f} mm "
                          f"{'right' if off > 0 else 'left'} of the fissure: check its coordinate system "
                          "(RAS or LPS) and that it was placed on this image")
    apart = float(np.linalg.norm(ac - pc))
    if not 15 <= apart <= 40:
        raise Problem(f"{sources['PC']}: AC and PC lie {apart:.0f} mm apart, but commissures 20 to 32 mm: "
                      "place them again")


def middle_at(sheet, position):
    """x of the mid-surface beside a point that may lie anywhere: outside a head the polynomial runs wild."""
    y, z = np.clip(position[1], -120, 90), np.clip(position[2], -80, 100)
    return float(midsurface.evaluate(sheet, y, z))


def midline_sheet(points, frame):
    """The curved mid-surface in the head frame: coefficients, rms."""
    return midsurface.rounded(*midsurface.robust(frame.to_head(points)))


def upright(image, parts, frame):
    """The vertex lies above and the cerebellum behind: otherwise the frame is wrong."""
    tissue = frame.to_head(image.world(np.argwhere(parts.kind == CEREBRUM)[::97]))
    below = frame.to_head(image.world(np.argwhere(parts.kind == CEREBELLUM)[::97])).mean(axis=0)
    middle = tissue.mean(axis=0)
    if below[2] > middle[2] or below[1] > middle[1]:
        raise Problem(f"{image.path}: the cerebellum does not lie below and behind the cerebrum in the frame "
                      "of AC and PC: check that AC and PC are not exchanged and that the header is right")
