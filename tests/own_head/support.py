"""What the tests of examples/own_head share: programs, the synthetic head, runs and their refusals."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import nibabel
import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = SOURCE / "examples/own_head"
sys.path[:0] = [str(EXAMPLE), str(SOURCE / "examples/head"), str(SOURCE / "tests/support")]

# Folder in which the fixtures put the synthetic head and its results (CMakeLists.txt).
WORK = pathlib.Path(os.environ.get("OWN_HEAD_WORK", "."))
QUICK = ["--edge", "10", "--spacing", "2"]  # mm: seconds instead of minutes


def run(*arguments, folder=None):
    """examples/own_head/run with the programs of this build (MESHER and DBS in the environment)."""
    return subprocess.run([EXAMPLE / "run", *map(str, arguments)], capture_output=True, text=True,
                          cwd=folder or WORK)


def stages_of(out):
    """What dbs left of each stage, without times."""
    stages = json.loads((out / "procedure/stages.json").read_text(encoding="utf-8"))["stages"]
    for stage in stages:
        del stage["solve"]["seconds"]
    return stages


def phantom():
    """The synthetic label map: values, affine."""
    image = nibabel.load(WORK / "out/phantom/labels.nii.gz")
    return np.asanyarray(image.dataobj).copy(), image.affine.copy()


def save(path, values, affine):
    nibabel.save(nibabel.Nifti1Image(values, affine), path)
    return path


def ball(values, affine, centre, radius):
    """Voxels within a radius (mm) of a world point."""
    index = np.stack(np.meshgrid(*map(np.arange, values.shape), indexing="ij"), axis=-1)
    world = index @ affine[:3, :3].T + affine[:3, 3]
    return np.linalg.norm(world - centre, axis=-1) < radius


class Case(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=WORK))
        self.addCleanup(shutil.rmtree, self.folder)

    def assert_refused(self, *arguments, says, sizes=QUICK):
        """The run ends with 1 and one sentence that holds all of `says`; nothing is left of it."""
        before = sorted(self.folder.iterdir())
        result = run(*arguments, "--out", self.folder / "out", *sizes, "--head-only")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        lines = result.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertTrue(lines[0].startswith("own_head: "), lines[0])
        for word in says:
            self.assertIn(word, lines[0])
        self.assertEqual(sorted(self.folder.iterdir()), before, "something was left behind")
