"""Markups of 3D Slicer (.mrk.json, schema 1.0.3) in and out. Positions in memory are RAS, mm; files are
read in the coordinate system they name (LPS where they name none, as Slicer does), and written in LPS."""
import json
from dataclasses import dataclass, field

import numpy as np

from problem import Problem

SCHEMA = ("https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
          "Schema/markups-schema-v1.0.3.json#")
# Older files give the coordinate system as a number.
TO_RAS = {"LPS": (-1.0, -1.0, 1.0), "RAS": (1.0, 1.0, 1.0), "1": (-1.0, -1.0, 1.0), "0": (1.0, 1.0, 1.0)}


@dataclass
class Markup:
    kind: str                # Fiducial, Line, Curve, ...
    name: str
    labels: list             # of the points
    points: np.ndarray       # (n, 3)
    descriptions: list = field(default_factory=list)
    source: str = ""         # file
    system: str = ""         # the file's coordinate system


def read(path):
    """The markups of a file; points that were never placed are left out."""
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
        found = table["markups"]
    except OSError as error:
        raise Problem(f"{path}: cannot be read ({error.strerror}): give a .mrk.json file of 3D Slicer, or "
                      "a folder of them") from error
    except (ValueError, KeyError, TypeError) as error:
        raise Problem(f"{path}: is not JSON with a list 'markups': save it as .mrk.json in 3D Slicer"
                      ) from error
    if not isinstance(found, list):
        raise Problem(f"{path}: 'markups' is not a list: save it as .mrk.json in 3D Slicer")
    return [read_markup(path, markup, k) for k, markup in enumerate(found)]


def read_markup(path, markup, number):
    if not isinstance(markup, dict):
        raise Problem(f"{path}: markup {number + 1} is not an object: save it as .mrk.json in 3D Slicer")
    system = str(markup.get("coordinateSystem", "LPS"))
    if system not in TO_RAS:
        raise Problem(f"{path}: the coordinate system '{system}' is neither LPS nor RAS: save it in one of "
                      "them")
    units = markup.get("coordinateUnits", "mm")
    if (units[0] if isinstance(units, list) and units else units) != "mm":
        raise Problem(f"{path}: its coordinates are in {units}, not mm: save it in mm")
    labels, points, descriptions = [], [], []
    for k, entry in enumerate(markup.get("controlPoints") or []):
        if entry.get("positionStatus", "defined") != "defined":
            continue
        position = entry.get("position")
        try:
            position = np.array(position, float)
        except (TypeError, ValueError):
            position = np.empty(0)
        if position.shape != (3,) or not np.isfinite(position).all():
            raise Problem(f"{path}: the position of point {k + 1} is not three numbers: place it again")
        labels.append(str(entry.get("label", "")))
        points.append(position * TO_RAS[system])
        descriptions.append(str(entry.get("description", "")))
    stem = path.name.removesuffix(".json").removesuffix(".mrk")
    return Markup(str(markup.get("type", "")), str(markup.get("name") or stem), labels,
                  np.array(points).reshape(-1, 3), descriptions, str(path), system)


def write(path, markups, system="LPS"):
    """Writes markups into one file."""
    text = json.dumps({"@schema": SCHEMA, "markups": [plain(markup, system) for markup in markups]},
                      indent=1)
    path.write_text(text + "\n", encoding="utf-8")


def plain(markup, system):
    descriptions = markup.descriptions or [""] * len(markup.labels)
    points = np.asarray(markup.points, float) * TO_RAS[system]
    points = points + 0.0  # no minus zero
    return {"type": markup.kind, "name": markup.name, "coordinateSystem": system,
            "coordinateUnits": "mm", "locked": True, "fixedNumberOfControlPoints": True,
            "controlPoints": [
                {"id": str(k + 1), "label": label, "description": description,
                 "position": [float(v) for v in point], "positionStatus": "defined", "visibility": True}
                for k, (label, description, point) in enumerate(zip(markup.labels, descriptions, points))]}
