"""Runs of bench_speed_accuracy, each once and kept by its program and inputs; references and their hashes."""
import hashlib
import json
import math
import subprocess
from pathlib import Path

from cases import exact_of, name_of, references_of

HEAD_FILES = ("brain.vtu", "cavity.vtp", "falx.vtp", "head.json")


class Refused(Exception):
    """A sentence for the user."""


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def inputs_of(case, heads):
    """All that decides what a case gives, but for the library."""
    folder = Path(heads) / case["head"]
    return {"files": {name: sha256((folder / name).read_bytes()) for name in HEAD_FILES}, "case": case}


def hash_of(inputs):
    return sha256(json.dumps(inputs, sort_keys=True).encode())


class Runner:
    def __init__(self, program, heads, folder, limit=None):
        """limit: s of wall after which a case is given up."""
        self.limit = limit
        self.program, self.heads, self.folder = Path(program), Path(heads), Path(folder)
        if not self.program.is_file():
            raise Refused(f"{self.program} is not there: build the target bench_speed_accuracy")
        self.build = sha256(self.program.read_bytes())
        self.folder.mkdir(parents=True, exist_ok=True)

    def path(self, case):
        return self.folder / f"{hash_of([self.build, inputs_of(case, self.heads)])[:16]}.json"

    def has(self, case):
        return self.path(case).is_file()

    def run(self, case):
        kept = self.path(case)
        if not kept.is_file():
            part = kept.with_suffix(".part")
            part.write_text(self.solve(case))
            part.rename(kept)
        return json.loads(kept.read_text())

    def solve(self, case):
        try:
            done = subprocess.run([self.program, self.heads, json.dumps(case)], capture_output=True, text=True,
                                  check=False, timeout=self.limit)
        except subprocess.TimeoutExpired:
            return json.dumps({"given_up_after": self.limit})
        if done.returncode != 0:
            raise Refused(f"{name_of(case)}: {done.stderr.strip()}")
        return done.stdout


def converged(run):
    return "given_up_after" not in run and all(s["status"] == "converged" for s in run["stages"])


def motions(run):
    """(stage, point) -> mm. Parts of a stage's load are no stages."""
    found = {}
    for stage in run["stages"]:
        if "part" in stage["stage"]:
            continue
        for points in (stage["shift_mm"], stage["tip_from_target_mm"]):
            found.update({(stage["stage"], name): value for name, value in points.items()})
    return found


def differences(run, other):
    """kind of point -> (mm, stage, point): where the two differ most. Kind lead: the tips."""
    kinds = {p["name"]: p["kind"] for p in run["probes"]}
    mine, others = motions(run), motions(other)
    if mine.keys() != others.keys():
        raise Refused("two runs have other stages or points: make the references anew")
    worst = {}
    for (stage, name), value in mine.items():
        kind = kinds.get(name, "lead")
        off = math.dist(value, others[stage, name])
        if off >= worst.get(kind, (-1.0,))[0]:
            worst[kind] = (off, stage, name)
    return worst


def largest(worst):
    return max(worst.values())


class References:
    def __init__(self, folder, heads):
        self.folder, self.heads = Path(folder), heads

    def path(self, case):
        return self.folder / f"{name_of(case)}.json"

    def write(self, case, run):
        if not converged(run):
            bad = next(s for s in run["stages"] if s["status"] != "converged")
            raise Refused(f"{name_of(case)}: stage {bad['stage']} found no balance: {bad['message']}")
        inputs = inputs_of(case, self.heads)
        keep = {key: run[key] for key in ("library", "air_mL", "nodes", "tets", "cpu_seconds", "probes")}
        stages = [{key: s[key] for key in ("stage", "shift_mm", "tip_from_target_mm")} for s in run["stages"]]
        text = json.dumps({"sha256": hash_of(inputs), "inputs": inputs, **keep, "stages": stages})
        self.folder.mkdir(parents=True, exist_ok=True)
        self.path(case).write_text(json.dumps(rounded(json.loads(text)), indent=1) + "\n")

    def of(self, case):
        """The finest there is, and its case; (None, None) without one; throws Refused where it is of other inputs."""
        for wanted in references_of(case):
            if self.path(wanted).is_file():
                return wanted, self.read(wanted)
        return None, None

    def read(self, case):
        path = self.path(case)
        kept = json.loads(path.read_text())
        now = inputs_of(case, self.heads)
        if kept["sha256"] != hash_of(now) or kept["inputs"] != now:
            files = [f for f in HEAD_FILES if kept["inputs"]["files"].get(f) != now["files"][f]]
            what = f"{', '.join(files)} of the {case['head']} head" if files else "the options of its case"
            raise Refused(f"{path.name} is the reference of other inputs: {what} changed since; "
                          "run bench/speed_accuracy/make_references")
        return kept


def rounded(value):
    """To 1e-9 mm, so that files are short."""
    if isinstance(value, dict):
        return {k: v if k == "inputs" else rounded(v) for k, v in value.items()}
    if isinstance(value, list):
        return [rounded(v) for v in value]
    return round(value, 9) if isinstance(value, float) else value


def same_probes(run, reference, name):
    near = lambda a, b: math.dist(a["point"], b["point"]) < 1e-6 and (a["name"], a["kind"]) == (b["name"], b["kind"])
    if run["air_mL"] != reference["air_mL"] or len(run["probes"]) != len(reference["probes"]) or \
            not all(near(*pair) for pair in zip(run["probes"], reference["probes"])):
        raise Refused(f"the reference {name} has other probes or another loss of fluid than the program: "
                      "run bench/speed_accuracy/make_references")


def is_own_reference(case, reference):
    return all(case[k] == reference[k] for k in ("head", "scene", "law", "element", "poisson", "refinements"))


def judge(case, runner, references, may_run=True):
    """One row of the table: what a case costs and how far it is off."""
    run = runner.run(case)
    if "given_up_after" in run:
        return {"case": case, "converged": False, "message": f"given up after {run['given_up_after']:g} s of wall"}
    row = {"case": case, "nodes": run["nodes"], "setup": run["setup_cpu_seconds"], "cpu": run["cpu_seconds"], "wall": run["wall_seconds"],
           "yardsticks": run["cpu_seconds"] / run["yardstick_cpu_seconds"],
           "yardstick": run["yardstick_cpu_seconds"], "converged": converged(run),
           "iterations": sum(s["iterations"] for s in run["stages"]),
           "factors": sum(s["factorisations"] for s in run["stages"])}
    if not row["converged"]:
        row["message"] = next(f"stage {s['stage']}: {s['message']}" for s in run["stages"] if s["status"] != "converged")
        return row
    wanted, reference = references.of(case)
    if wanted is None:
        row["why"] = f"no reference {name_of(references_of(case)[-1])}"
    elif is_own_reference(case, wanted):
        row["why"] = "as its reference"   # a mesh cannot be judged by itself
    else:
        row["reference"] = name_of(wanted)
        same_probes(run, reference, row["reference"])
        row["kinds"] = differences(run, reference)
        row["error"], row["stage"], row["probe"] = largest(row["kinds"])
    exact = exact_of(case)
    if exact != case and (may_run or runner.has(exact)):
        other = runner.run(exact)
        if converged(other):
            row["off_exact"] = largest(differences(run, other))[0]
    return row

