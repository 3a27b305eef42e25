"""A conformed image as FreeSurfer leaves it (256 voxels of 1 mm along each axis, .mgz, aseg's values), without
a plan and at the default sizes: one command ends in a finished stage table. Prints what it took."""
import json
import resource
import unittest

import nibabel
import numpy as np

from support import Case, run  # first: it says where the example's modules are
import make_phantom

STAGES = ["0", "1", "2", "3", "4", "5", "6a", "6b", "6c", "7", "8", "9"]
MEMORY = 2.0e9  # bytes: half of what a small laptop has


def conformed(path):
    """FreeSurfer's axes: leftwards, downwards, forwards."""
    affine = np.array([[-1.0, 0, 0, 128], [0, 0, 1, -128], [0, -1, 0, 128], [0, 0, 0, 1]])
    affine[:3, 3] += np.round(make_phantom.to_world((0, -16, 4)))
    values = np.zeros((256, 256, 256), np.int32)
    plane = np.stack(np.meshgrid(np.arange(256), np.arange(256), indexing="ij"), axis=-1)
    for i in range(256):
        world = affine[:3, 0] * i + plane @ affine[:3, 1:3].T + affine[:3, 3]
        values[i] = make_phantom.paint(*np.moveaxis((world - make_phantom.SHIFT) @ make_phantom.turn(), -1, 0))
    nibabel.save(nibabel.MGHImage(values, affine), path)


class DefaultSizes(Case):
    def test_one_command_from_aseg_to_a_finished_stage_table(self):
        conformed(self.folder / "aseg.mgz")
        out = self.folder / "out"
        result = run(self.folder / "aseg.mgz", "--out", out)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertNotIn("gave no sound mesh", result.stdout)  # at the first attempt
        stages = json.loads((out / "procedure/stages.json").read_text())["stages"]
        self.assertEqual([stage["stage"] for stage in stages], STAGES)
        self.assertEqual({stage["solve"]["status"] for stage in stages}, {"converged"})
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        memory = 1024 * used.ru_maxrss  # of the largest process
        print(f"{used.ru_utime + used.ru_stime:.0f} s of CPU, {memory / 1e9:.2f} GB")
        self.assertLess(memory, MEMORY)


if __name__ == "__main__":
    unittest.main(verbosity=2)
