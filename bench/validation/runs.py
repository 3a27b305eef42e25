"""Runs of dbs: each set of options once, side by side, kept by a key of its options and its program."""
import hashlib
import json
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np


class Run:
    """What one run of dbs left behind; `stages` is empty where it ended without a balance."""

    def __init__(self, folder):
        code, *message = (folder / "message").read_text().strip().split("\n")
        self.message = " ".join(message)
        self.refused = code not in ("0", "2")   # 2: a stage without a balance
        table = folder / "stages.json"
        self.data = json.loads(table.read_text()) if table.is_file() else {"stages": []}
        stages = self.data["stages"]
        self.converged = bool(stages) and all(s["solve"]["status"] == "converged" for s in stages)
        self.stages = {s["stage"]: s for s in stages} if self.converged else {}
        self.seconds = sum(s["solve"]["seconds"] for s in stages)

    def end_of_surgery(self):
        """Label of the stage before the fluid is restored."""
        return list(self.stages)[-2]

    def air(self, label=None):
        sides = self.stages[label or self.end_of_surgery()]["sides"]
        return sum(s["air_mL"] for s in sides.values())

    def brain_volume_lost(self, label=None):
        return self.stages[label or self.end_of_surgery()]["brain_volume_lost_mL"]

    def shift(self, landmark, label=None):
        return np.array(self.stages[label or self.end_of_surgery()]["shift_mm"][landmark])

    def sides(self):
        return list(self.stages["9"]["electrodes"])

    def electrode(self, side, label="9"):
        return self.stages[label]["electrodes"][side]

    def retraction(self, side, frame, since="D_since_cannula_left"):
        """frame: skull or tissue; positive towards the burr hole."""
        return self.electrode(side)[since][f"{frame}_mm"]

    def mean_retraction(self, frame, since="D_since_cannula_left"):
        values = [self.retraction(side, frame, since) for side in self.sides()]
        return float(np.mean([v for v in values if v is not None]))


class Runner:
    def __init__(self, program, head, folder, jobs):
        self.head, self.folder, self.jobs = head, folder, jobs
        self.build = hashlib.sha256(Path(program).read_bytes()).hexdigest()[:12]
        folder.mkdir(parents=True, exist_ok=True)
        self.program = str(folder / f"dbs-{self.build}")   # a build in the meantime does not matter
        if not Path(self.program).is_file():
            shutil.copy2(program, self.program)
        self.done = 0

    def folder_of(self, options):
        text = " ".join([self.build, *([] if "--head" in options else [str(self.head)]), *options])
        return self.folder / hashlib.sha256(text.encode()).hexdigest()[:16]

    def run(self, options):
        folder = self.folder_of(options)
        if not (folder / "message").is_file():
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "options").write_text(" ".join(options) + "\n")
            head = [] if "--head" in options else ["--head", str(self.head)]
            result = subprocess.run([self.program, "--quiet", "--no-vtk", *head,
                                     "--out", str(folder), *options],
                                    capture_output=True, text=True, check=False)
            (folder / "message").write_text(f"{result.returncode}\n{result.stderr.strip()}\n")
        self.done += 1
        print(f"\r  {self.done} runs ", end="", file=sys.stderr, flush=True)
        return Run(folder)

    def all(self, cases, jobs=None):
        """cases: name -> options. The runs, by name, in the same order."""
        with ThreadPoolExecutor(jobs or self.jobs) as pool:
            runs = pool.map(self.run, cases.values())
            return dict(zip(cases, runs))
