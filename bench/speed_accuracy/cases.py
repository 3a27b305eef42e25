"""The points of the chart: rungs of the ladder on each mesh, and one factor at a time about the default."""
from dataclasses import dataclass

DEFAULT = {"head": "coarse", "scene": "csf_loss", "law": "corotational", "element": "linear", "poisson": 0.45,
           "accuracy": 0.0, "one_linearisation": False, "load_steps": 1, "threads": 1, "refinements": 0}
SCENES = {"csf_loss": "CSF loss (stages 0 and 1)", "procedure": "whole procedure, both sides"}
HEADS = ("coarse", "medium")


@dataclass(frozen=True)
class Rung:
    name: str       # stands at its points
    family: str     # shares a colour
    meaning: str
    options: tuple  # of pairs

    def case(self, head, scene):
        return {**DEFAULT, "head": head, "scene": scene, **dict(self.options)}


def rung(name, family, meaning, **options):
    return Rung(name, family, meaning, tuple(options.items()))


LADDER = [
    rung("M0", "M0", "linear law, linear tets", law="linear"),
    rung("M2", "M2", "co-rotational, one linearisation for each solve, as in 2011", one_linearisation=True),
    *(rung(f"M1 {a:g}", "M1", f"co-rotational, solved to {a:g} mm", accuracy=a) for a in (1.0, 0.5, 0.1, 0.02)),
    rung("M3", "M3", "co-rotational, default tolerances"),
    rung("M4 StVK", "M4", "Saint-Venant-Kirchhoff", law="st_venant_kirchhoff"),
    rung("M4 NH", "M4", "stable neo-Hookean", law="stable_neo_hookean"),
    rung("M5", "M5", "co-rotational, volume at nodes", element="nodal"),
    rung("M5 0.1", "M5", "the same as M5, solved to 0.1 mm", element="nodal", accuracy=0.1),
    rung("M6", "M6", "co-rotational, quadratic tets", element="quadratic"),
    rung("M6 0.1", "M6", "the same as M6, solved to 0.1 mm", element="quadratic", accuracy=0.1),
]
SHORT = ("M0", "M2", "M1 1", "M1 0.1", "M3", "M5 0.1")

# Quadratic tets on the medium head are its reference: nothing finer is there to judge them by.
LEFT_OUT = {("medium", "M6"), ("medium", "M6 0.1")}


def ladder(heads, scenes, names=None):
    """(rung, case) of each point."""
    return [(r, r.case(head, scene)) for scene in scenes for head in heads for r in LADDER
            if (names is None or r.name in names) and (head, r.name) not in LEFT_OUT]


# name -> (value, case) about the default on the coarse head; what solves it exactly is shared with the ladder
FACTORS = {
    "Poisson's ratio": [(v, {**DEFAULT, "poisson": v}) for v in (0.40, 0.45, 0.49)],
    "Poisson's ratio, volume at nodes": [(v, {**DEFAULT, "poisson": v, "element": "nodal"}) for v in (0.40, 0.45, 0.49)],
    "load steps": [(v, {**DEFAULT, "load_steps": v}) for v in (1, 2, 4, 8)],
    "tolerance, mm (0: default)": [(v, {**DEFAULT, "accuracy": v}) for v in (1.0, 0.5, 0.1, 0.02, 0.0)],
    "threads": [(v, {**DEFAULT, "threads": v}) for v in (1, 2)],
}


def references_of(case):
    """Cases that may serve as the reference of `case`, the finest first. Laws that are models of their own
    count against themselves; the linear law and one linearisation stand for the co-rotational one."""
    law = "corotational" if case["law"] == "linear" else case["law"]
    own = {**DEFAULT, "head": case["head"], "scene": case["scene"], "law": law, "poisson": case["poisson"],
           "element": "quadratic"}
    refined = [{**own, "refinements": 1}] if case["scene"] == "csf_loss" and case["head"] == "coarse" else []
    return [*refined, own]


def exact_of(case):
    """The same mesh and elements, solved to the default tolerances: what differs is not the mesh."""
    law = "corotational" if case["law"] == "linear" else case["law"]
    return {**case, "law": law, "accuracy": 0.0, "one_linearisation": False, "load_steps": 1, "threads": 1}


def all_references():
    """Cheap ones first."""
    wanted = []
    for level in (-1, 0):   # on the head's own mesh, then refined
        for _, case in [*ladder(HEADS, SCENES), *(pair for pairs in FACTORS.values() for pair in pairs)]:
            reference = references_of(case)[level]
            if reference not in wanted:
                wanted.append(reference)
    cost = lambda c: (c["refinements"], c["head"] == "medium", c["scene"] == "procedure", c["law"] != "corotational")
    return sorted(wanted, key=cost)


def name_of(case):
    mesh = "refined" if case["refinements"] else "own"
    return f"{case['head']}-{case['scene']}-{case['law']}-{case['poisson']:g}-{mesh}"
