"""The plan: trajectories and landmarks, read from 3D Slicer's markups, completed, and checked."""
import re
from dataclasses import dataclass, field

import numpy as np

import frame as drawn
import markups
from problem import Problem, point

# What the procedure needs besides AC and PC, and where it lies by default relative to the middle of the
# commissures (MCP), on the right: the subthalamic target of stereotactic surgery (12 mm lateral, 3 mm
# behind, 4 mm below) and the pallidal one of the generic head.
FROM_MCP = {"STN": np.array([12.0, -3.0, -4.0]), "GPi": drawn.GPI_FROM_MCP}
SIDES = ("left", "right")


@dataclass
class Line:
    target: np.ndarray   # world
    entry: np.ndarray
    side: str            # named by the markup; empty: to be told from where it lies
    source: str
    system: str          # of the file


@dataclass
class Plan:
    lines: list = field(default_factory=list)
    landmarks: dict = field(default_factory=dict)   # name -> world
    sources: dict = field(default_factory=dict)     # name -> file
    systems: dict = field(default_factory=dict)     # name -> the file's coordinate system
    notes: list = field(default_factory=list)


def files_of(paths):
    """The .mrk.json files named, and those in the folders named."""
    files = []
    for path in paths:
        if path.is_dir():
            found = sorted(path.glob("*.mrk.json"))
            if not found:
                raise Problem(f"{path}: holds no .mrk.json: save trajectories and landmarks there as markups "
                              "of 3D Slicer")
            files += found
        else:
            files.append(path)
    return files


def read(paths):
    plan = Plan()
    for path in files_of(paths):
        for markup in markups.read(path):
            if markup.kind == "Line":
                plan.lines.append(read_line(markup))
            elif markup.kind == "Fiducial":
                read_landmarks(markup, plan)
            else:
                plan.notes.append(f"{path}: a markup of type {markup.kind} is not used")
    return plan


def read_line(markup):
    """Entry and target by the labels of the points; where these say nothing the entry comes first."""
    if len(markup.points) != 2:
        raise Problem(f"{markup.source}: the line '{markup.name}' has {len(markup.points)} points placed: a "
                      "trajectory has two, entry and target")
    names = [label.lower() for label in markup.labels]
    first_is_target = "target" in names[0] or "entry" in names[1]
    if first_is_target and ("entry" in names[0] or "target" in names[1]):
        raise Problem(f"{markup.source}: the points of '{markup.name}' are both entry or both target: name "
                      "one 'entry', the other 'target'")
    entry, target = markup.points[::-1] if first_is_target else markup.points
    if np.linalg.norm(entry - target) < 10:
        raise Problem(f"{markup.source}: entry and target of '{markup.name}' lie "
                      f"{np.linalg.norm(entry - target):.1f} mm apart: place the entry on the skull")
    return Line(target, entry, side_in(markup.name), markup.source, markup.system)


def side_in(name):
    """left or right where a name says so (left, L, lh ... as a word of its own)."""
    words = set(re.split(r"[^a-z]+", name.lower()))
    found = {side for side, marks in (("left", {"left", "l", "lh", "lt"}),
                                      ("right", {"right", "r", "rh", "rt"})) if words & marks}
    return found.pop() if len(found) == 1 else ""


def read_landmarks(markup, plan):
    for label, position in zip(markup.labels, markup.points):
        name = canonical(label)
        if name in plan.landmarks:
            raise Problem(f"{markup.source}: landmark '{name}' stands twice, also in {plan.sources[name]}: "
                          "keep one")
        plan.landmarks[name] = position
        plan.sources[name], plan.systems[name] = markup.source, markup.system


def canonical(label):
    """'ac' -> AC, 'left STN' -> STN_left; other names as they are, with _ for what is no letter."""
    words = [word for word in re.split(r"[^A-Za-z0-9]+", label) if word]
    side = side_in(label)
    rest = [word for word in words if not side_in(word)] if side else words
    name = "_".join(rest)
    for known in ("AC", "PC", "MCP", "STN", "GPi"):
        name = known if name.lower() == known.lower() else name
    return (f"{name}_{side}" if side else name) or "point"


def assign(plan, frame, mid_of):
    """Side -> line. mid_of: x of the mid-surface at head points."""
    lines = {}
    for line in plan.lines:
        target = frame.to_head(line.target)
        lies = "right" if target[0] > mid_of(target) else "left"
        if line.side and line.side != lies:
            raise Problem(f"{line.source}: the trajectory is named {line.side}, but its target "
                          f"{point(line.target)} RAS lies on the {lies}: check its name, and its "
                          f"coordinate system ({line.system})")
        if lies in lines:
            raise Problem(f"{line.source}: is a second trajectory on the {lies} beside "
                          f"{lines[lies].source}: give one per side")
        lines[lies] = line
    return lines


def complete(plan, frame, from_labels):
    """Landmarks in the head frame: those given, then centroids of labels, then by distance from MCP."""
    points = {name: frame.to_head(position) for name, position in plan.landmarks.items()}
    points["MCP"] = (points["AC"] + points["PC"]) / 2
    for name, rule in FROM_MCP.items():
        for side, sign in zip(SIDES, (-1, 1)):
            key = f"{name}_{side}"
            if key in points:
                continue
            if key in from_labels:
                points[key] = frame.to_head(from_labels[key])
                plan.notes.append(f"{key} is the centre of its label")
            else:
                points[key] = points["MCP"] + rule * (sign, 1, 1)
                plan.notes.append(f"{key} is derived: {rule[0]:g} mm lateral, {rule[1]:+g} mm along and "
                                  f"{rule[2]:+g} mm above the commissures from their middle")
    return points


def check_inside(name, position, source, system, frame, depth_of):
    """A target lies in tissue; where it would after exchanging the frames the sentence says so."""
    if depth_of(position) > 0:
        return
    world = frame.to_world(position)
    turned = frame.to_head(world * (-1, -1, 1))
    hint = "check that it was planned on this image"
    if depth_of(turned) > 0:
        other = "RAS" if system == "LPS" else "LPS"
        hint = f"with {other} instead of {system} it would lie inside, so check its coordinate system"
    raise Problem(f"{source}: {name} {point(world)} RAS lies outside the brain: {hint}")
