"""Frames: RAS and LPS markups, other headers and formats of the same head give the same head."""
import filecmp
import json
import unittest

import nibabel
import numpy as np

from support import QUICK, WORK, Case, phantom, run  # first: it says where the example's modules are
import make_phantom
import markups

FILES = ("brain.vtu", "cavity.vtp", "falx.vtp", "head.json")
LABELS = WORK / "out/phantom/labels.nii.gz"


class Frames(Case):
    def make(self, labels, *plan, name="head"):
        out = self.folder / name
        result = run(labels, *(["--plan", *plan] if plan else []), "--out", out, *QUICK, "--head-only")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return out / "head", result.stdout

    def test_ras_and_lps_markups_give_the_same_head_bit_by_bit(self):
        # The results of the chain were made with the plan in LPS.
        ras, _ = self.make(LABELS, WORK / "out/phantom/plan_ras")
        self.assertEqual(filecmp.cmpfiles(ras, WORK / "out/my_head/head", FILES, shallow=False)[0],
                         list(FILES))

    def test_the_same_voxels_stored_in_another_order_as_mgz(self):
        values, affine = phantom()
        flipped = affine.copy()
        flipped[:, 3] = affine @ [values.shape[0] - 1, 0, 0, 1]
        flipped[:3, 0] *= -1
        path = self.folder / "labels.mgz"
        nibabel.save(nibabel.MGHImage(values[::-1].astype(np.int32), flipped), path)
        head, _ = self.make(path, WORK / "out/phantom/plan_lps")
        one, other = (json.loads((folder / "head.json").read_text())
                      for folder in (head, WORK / "out/my_head/head"))
        # The format keeps its affine in single precision: 1e-5 mm at 100 mm, and a voxel on the border
        # between two labels may fall to the other one.
        for name, position in other["landmarks"].items():
            tolerance = 2.0 if name.startswith(("entry", "frontal")) else 1e-3
            np.testing.assert_allclose(one["landmarks"][name], position, atol=tolerance, err_msg=name)
        for side in ("brain_left", "brain_right"):
            self.assertAlmostEqual(one["segmentation"][side] / other["segmentation"][side], 1, delta=1e-3)

    def test_commissures_derived_from_the_thalami_are_where_they_were_painted(self):
        head, said = self.make(LABELS)
        self.assertIn("are derived from the thalami", said)
        self.assertIn("no trajectory is given", said)
        matrix = np.array(json.loads((head.parent / "own_head.json").read_text())["world_to_head"])
        for point, expected in ((make_phantom.AC, (0, 0, 0)), (make_phantom.PC, (0, -26, 0))):
            found = matrix[:3, :3] @ make_phantom.to_world(point) + matrix[:3, 3]
            self.assertLess(np.linalg.norm(found - expected), 5.0)

    def test_only_one_side_planned_is_only_one_side_done(self):
        out = self.folder / "head"
        result = run(LABELS, "--plan", WORK / "out/phantom/plan_lps/trajectory_right.mrk.json",
                     WORK / "out/phantom/plan_lps/landmarks.mrk.json", "--out", out, *QUICK,
                     "--fields", "all")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        stages = json.loads((out / "procedure/stages.json").read_text())["stages"]
        self.assertEqual({side for stage in stages for side in stage["electrodes"]}, {"right"})
        fields = list((out / "image").glob("*.displacement.nii.gz"))
        self.assertEqual(len(fields), len(stages))


class Markups(Case):
    def read(self, **changes):
        entry = {"type": "Line", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": [
            {"label": "a", "position": [1.0, 2.0, 3.0], "positionStatus": "defined"},
            {"label": "b", "position": [0, 0, 0], "positionStatus": "undefined"},
            {"label": "c", "position": [4.0, 5.0, 60.0]}]} | changes
        path = self.folder / "m.mrk.json"
        path.write_text(json.dumps({"markups": [{k: v for k, v in entry.items() if v is not None}]}))
        return markups.read(path)[0]

    def test_systems(self):
        for system, sign in (("LPS", -1), ("RAS", 1), ("1", -1), ("0", 1), (None, -1)):
            markup = self.read(coordinateSystem=system)
            np.testing.assert_array_equal(markup.points, [[sign, 2 * sign, 3], [4 * sign, 5 * sign, 60]])
            self.assertEqual(markup.labels, ["a", "c"])

    def test_units(self):
        self.assertEqual(len(self.read(coordinateUnits=["mm", "UCUM", "millimeter"]).points), 2)
        with self.assertRaisesRegex(Exception, "in um, not mm"):
            self.read(coordinateUnits="um")

    def test_names_of_points_and_sides(self):
        import plan as plans
        self.assertEqual([plans.canonical(name) for name in ("ac", "left STN", "STN-R", "gpi_left", "F-1")],
                         ["AC", "STN_left", "STN_right", "GPi_left", "F_1"])
        self.assertEqual([plans.side_in(name) for name in ("Lead L", "trajectory_right", "plan", "left right")],
                         ["left", "right", "", ""])

    def test_labels_of_points_tell_entry_from_target(self):
        import plan as plans
        for names, target in ((["entry", "target"], 60), (["Target", "Entry"], 3), (["a", "b"], 60)):
            line = plans.read_line(markups.Markup("Line", "x", names, np.array([[1, 2, 3], [4, 5, 60.0]])))
            self.assertEqual(line.target[2], target)


if __name__ == "__main__":
    unittest.main(verbosity=2)
