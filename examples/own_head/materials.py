"""Materials of parts of the brain: read before anything is made, handed to dbs with the head."""
import json
import math

import numpy as np

from labels import BRAINSTEM, CEREBRUM, KINDS, VENTRICLE
from problem import Problem

KEYS = ("name", "labels", "young_kPa", "poisson", "density_kg_m3", "law")
LAWS = ("linear", "corotational", "st_venant_kirchhoff", "stable_neo_hookean", "log_neo_hookean")
# Key -> whether a number is one of it, and what is.
RANGES = {"young_kPa": (lambda v: v > 0, "positive"), "poisson": (lambda v: -1 < v < 0.5, "inside (-1, 0.5)"),
          "density_kg_m3": (lambda v: v >= 0, "zero or more")}


def read(path, dictionary, present):
    """Materials for dbs, labels as [first, last]. dictionary: its labels; present: values of the map."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))["materials"]
    except OSError as error:
        raise Problem(f"--materials {path}: cannot be read ({error.strerror})") from error
    except (ValueError, KeyError, TypeError) as error:
        raise Problem(f"{path}: is not JSON with a list 'materials': see examples/own_head/README.md") from error
    if not isinstance(entries, list):
        raise Problem(f"{path}: 'materials' is not a list: see examples/own_head/README.md")
    materials = [read_one(path, entry, number, dictionary, present)
                 for number, entry in enumerate(entries, start=1)]
    check_overlap(path, materials)
    return materials


def read_one(path, entry, number, dictionary, present):
    if not isinstance(entry, dict):
        raise Problem(f"{path}: material {number}: write an object with name and labels")
    name = str(entry.get("name", f"material {number}"))

    def refuse(what):
        raise Problem(f"{path}: '{name}': {what}")

    if unknown := set(entry) - set(KEYS):
        refuse(f"unknown key '{sorted(unknown)[0]}'; known: {', '.join(KEYS)}")
    for key, (holds, wanted) in RANGES.items():
        value = entry.get(key, 0.0 if key != "young_kPa" else 1.0)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not (
                math.isfinite(value) and holds(value)):
            refuse(f"{key} = {json.dumps(value)} is not {wanted}")
    if entry.get("law", LAWS[0]) not in LAWS:
        refuse(f"unknown law '{entry['law']}'; known: {', '.join(LAWS)}")
    labels = entry.get("labels")
    if not isinstance(labels, list) or not labels:
        refuse("needs 'labels', a list of values or names of the dictionary")
    ranges = [r for label in labels for r in ranges_of(label, dictionary, refuse)]
    check_present(ranges, dictionary, present, refuse)
    return {**entry, "name": name, "labels": ranges}


def ranges_of(label, dictionary, refuse):
    """[[first, last], ...] of a value, a pair of them, or a name."""
    if isinstance(label, str):
        found = [[one.first, one.last] for one in dictionary if one.name == label]
        return found or refuse(f"the dictionary has no label '{label}'")
    pair = label if isinstance(label, list) else [label, label]
    if len(pair) != 2 or not all(type(value) is int for value in pair) or pair[0] > pair[1]:
        refuse(f"'labels' holds {json.dumps(label)}: write a value, [first, last] or a name")
    return [pair]


def check_present(ranges, dictionary, present, refuse):
    """What is asked for is in the map, and is tissue that is meshed."""
    inside = [int(value) for value in present if any(a <= value <= b for a, b in ranges)]
    if not inside:
        refuse("the map has none of its labels: correct them")
    for value in inside:
        kind = next((one.kind for one in dictionary if one.first <= value <= one.last), 0)
        if kind not in (CEREBRUM, BRAINSTEM, VENTRICLE):
            refuse(f"label {value} is {KINDS[kind]}, which is not meshed and has no material: leave it out")


def check_overlap(path, materials):
    for i, one in enumerate(materials):
        for other in materials[:i]:
            for (first, last), (a, b) in ((r, s) for r in one["labels"] for s in other["labels"]):
                if first <= b and a <= last:
                    raise Problem(f"{path}: label {max(first, a)} stands in '{one['name']}' and in "
                                  f"'{other['name']}': keep one of them")


def check_meshed(path, materials, values):
    """Each has a tet. values: the labels of the tets."""
    for material in materials:
        if not any(np.any((values >= a) & (values <= b)) for a, b in material["labels"]):
            raise Problem(f"{path}: '{material['name']}': no tet has its centre in one of its labels: give a "
                          "smaller --edge, or leave it out")


def write(path, materials):
    rows = ",\n ".join(json.dumps(material, ensure_ascii=False) for material in materials)
    path.write_text(f'{{"materials": [\n {rows}\n]}}\n', encoding="utf-8")
