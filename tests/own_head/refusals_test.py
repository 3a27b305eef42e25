"""What cannot make a head is refused in one sentence, and nothing half-written stays."""
import json
import signal
import subprocess
import unittest

import nibabel
import numpy as np

from support import EXAMPLE, QUICK, WORK, Case, ball, phantom, run, save  # first: it says where the example's modules are
import make_phantom
import markups

LABELS = WORK / "out/phantom/labels.nii.gz"
PLAN = WORK / "out/phantom/plan_lps"
LEFT, BACKGROUND = 2, 0


class Images(Case):
    def refused(self, values, affine, says):
        path = save(self.folder / "map.nii.gz", values, affine)
        # Before anything is meshed, so at the default sizes: they cost nothing.
        self.assert_refused(path, "--plan", PLAN, says=["map.nii.gz", *says], sizes=())

    def test_a_missing_label(self):
        values, affine = phantom()
        values[(values == 7) | (values == 8) | (values == 46) | (values == 47)] = BACKGROUND
        self.refused(values, affine, ["no cerebellum", "the values 7, 8, 46, 47", "label it"])

    def test_a_half_without_labels(self):
        values, affine = phantom()
        values[np.isin(values, [41, 42, 49, 50, 51, 52, 53, 54, 60])] = BACKGROUND
        self.refused(values, affine, ["no right cerebrum", "label it"])

    def test_a_value_that_is_not_in_the_dictionary(self):
        values, affine = phantom()
        values[values == 12] = 777
        self.refused(values, affine, ["777 (", "dictionary freesurfer does not know", "add them"])

    def test_a_hole_in_a_half(self):
        values, affine = phantom()
        centre = make_phantom.to_world([-38, -30, 25])
        values[ball(values, affine, centre, 9.0)] = BACKGROUND
        self.refused(values, affine, ["a hole of 3.", "left half", "tissue or ventricle"])

    def test_a_disconnected_part(self):
        values, affine = phantom()
        centre = make_phantom.to_world([-45, 5, 30])
        values[ball(values, affine, centre, 16.0) & ~ball(values, affine, centre, 11.0)] = BACKGROUND
        self.refused(values, affine, ["left half is in pieces", "5.", "join them"])

    def test_sides_exchanged_by_the_header(self):
        values, affine = phantom()
        affine[0] *= -1
        self.refused(values, affine, ["left half lies to the right", "header mirrors"])

    def test_an_affine_that_cannot_be_inverted(self):
        values, affine = phantom()
        affine[:, 1] = affine[:, 0]
        image = nibabel.Nifti1Image(values, np.eye(4))
        image.header.set_sform(affine, 1)
        image.header["qform_code"] = 0
        path = self.folder / "map.nii"
        nibabel.save(image, path)
        # nibabel writes the affine it was made with; the header is what counts here.
        raw = bytearray(path.read_bytes())
        raw[280:328] = affine[:3].astype("<f4").tobytes()
        path.write_bytes(raw)
        self.assert_refused(path, says=["map.nii", "affine cannot be inverted", "restore the header"])

    def test_no_frame(self):
        values, affine = phantom()
        image = nibabel.Nifti1Image(values, affine)
        image.header["qform_code"] = image.header["sform_code"] = 0
        path = self.folder / "map.nii"
        nibabel.save(image, path)
        raw = bytearray(path.read_bytes())
        raw[252:256] = bytes(4)  # qform_code and sform_code
        path.write_bytes(raw)
        self.assert_refused(path, says=["map.nii", "neither qform nor sform", "copy the header"])

    def test_a_4_d_image(self):
        values, affine = phantom()
        self.refused(np.stack([values, values], axis=-1), affine, ["is 4-D", "save the one volume"])

    def test_an_image_that_is_no_label_map(self):
        values, affine = phantom()
        self.refused(values.astype(np.float32) + 0.25, affine, ["no whole numbers", "nearest neighbour"])

    def test_a_head_that_is_cut_off(self):
        values, affine = phantom()
        cut = values.shape[2] // 2 + 18
        self.refused(values[:, :, :cut], affine, ["cuts the cerebrum off", "axis k", "whole head"])

    def test_a_file_that_is_no_image(self):
        path = self.folder / "map.nii.gz"
        path.write_text("not an image")
        self.assert_refused(path, says=["map.nii.gz", "cannot be read as an image", "NIfTI"])

    def test_a_file_that_is_not_there(self):
        self.assert_refused(self.folder / "none.nii.gz", says=["none.nii.gz", "cannot be read"])


class Dictionaries(Case):
    def refused(self, table, says):
        path = self.folder / "dictionary.json"
        path.write_text(table if isinstance(table, str) else json.dumps(table))
        self.assert_refused(LABELS, "--labels", path, says=["dictionary.json", *says])

    def test_an_unknown_kind(self):
        self.refused({"labels": [{"value": 2, "kind": "brain"}]}, ["'kind' must be one of background"])

    def test_an_unknown_key(self):
        self.refused({"labels": [{"value": 2, "kind": "cerebrum", "sid": "left"}]}, ["unknown key 'sid'"])

    def test_a_value_twice(self):
        label = {"from": 1, "to": 5, "kind": "cerebrum"}
        self.refused({"labels": [label, {"value": 3, "kind": "csf"}]}, ["value 3 stands twice"])

    def test_no_json(self):
        self.refused("{", ["is not JSON with a list 'labels'"])

    def test_a_name_that_is_not_built_in(self):
        self.assert_refused(LABELS, "--labels", "aal", says=["--labels aal", "one of freesurfer"])


class Plans(Case):
    def line(self, entry, target, name="trajectory_left", system="RAS", told="RAS"):
        path = self.folder / f"{name}.mrk.json"
        markup = markups.Markup("Line", name, ["entry", "target"], make_phantom.to_world([entry, target]))
        markups.write(path, [markup], system)
        path.write_text(path.read_text().replace(f'"{system}"', f'"{told}"'))
        return path

    def refused(self, path, says, sizes=QUICK):
        self.assert_refused(LABELS, "--plan", path, PLAN / "landmarks.mrk.json", says=[path.name, *says],
                            sizes=sizes)

    def test_a_wrong_frame_puts_the_target_outside_the_brain(self):
        # Far from the axis a head that is shifted in the world leaves the brain when mirrored.
        path = self.line((-39, 22, 62), (-20, -75, 20), name="plan", system="LPS", told="RAS")
        self.refused(path, ["outside the brain", "with LPS instead of RAS it would lie inside"], sizes=())

    def test_a_target_outside_the_brain(self):
        self.refused(self.line((-39, 22, 62), (-11, -16, -300), name="left"),
                     ["target of the left trajectory", "outside the brain", "planned on this image"])

    def test_a_target_on_the_other_side_than_its_name(self):
        self.refused(self.line((39, 22, 62), (11.5, -16, -4.5)),
                     ["is named left", "lies on the right", "coordinate system (RAS)"])

    def test_a_trajectory_across_the_midline(self):
        self.refused(self.line((30, 22, 62), (-11.5, -16, -4.5)), ["crosses the midline", "move its entry"])

    def test_entry_and_target_exchanged(self):
        self.refused(self.line((-11.5, -16, -4.5), (-39, 22, 42)), ["leads downwards", "exchanged"])

    def test_commissures_in_the_wrong_frame(self):
        path = self.folder / "points.mrk.json"
        points = make_phantom.to_world([make_phantom.AC, make_phantom.PC])
        markups.write(path, [markups.Markup("Fiducial", "points", ["AC", "PC"], points)], "LPS")
        path.write_text(path.read_text().replace('"LPS"', '"RAS"'))
        self.assert_refused(LABELS, "--plan", path, says=["points.mrk.json", "AC", "of the fissure", "LPS"])

    def test_one_commissure_alone(self):
        path = self.folder / "points.mrk.json"
        points = make_phantom.to_world([make_phantom.AC])
        markups.write(path, [markups.Markup("Fiducial", "points", ["AC"], points)])
        self.assert_refused(LABELS, "--plan", path, says=["points.mrk.json", "has AC but not PC"])

    def test_a_missing_landmark_that_cannot_be_derived(self):
        values, affine = phantom()
        values[(values == 10)], values[(values == 49)] = 2, 41
        path = save(self.folder / "map.nii.gz", values, affine)
        self.assert_refused(path, says=["landmark 'AC' is missing", "thalamus_left", "--plan"])

    def test_a_folder_without_markups(self):
        empty = self.folder / "empty"
        empty.mkdir()
        self.assert_refused(LABELS, "--plan", empty, says=["empty", "holds no .mrk.json"])

    def test_a_coordinate_system_that_is_unknown(self):
        path = self.line((-39, 22, 62), (-11.5, -16, -4.5), told="XYZ")
        self.refused(path, ["'XYZ' is neither LPS nor RAS"])


class Folders(Case):
    def test_a_foreign_folder_is_left_as_it_is(self):
        out = self.folder / "out"
        out.mkdir()
        (out / "thesis.txt").write_text("mine")
        result = run(LABELS, "--out", out)
        self.assertEqual(result.returncode, 1)
        self.assertIn("is not a folder of earlier results", result.stderr)
        self.assertEqual((out / "thesis.txt").read_text(), "mine")

    def test_an_interrupted_run_leaves_nothing(self):
        before = sorted(self.folder.iterdir())
        with subprocess.Popen([EXAMPLE / "run", LABELS, "--out", self.folder / "out", *QUICK],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            for line in process.stdout:
                if line.startswith("== skull"):  # something is there by now
                    self.assertNotEqual(sorted(self.folder.iterdir()), before)
                    process.terminate()
                    break
            _, said = process.communicate()
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)
        self.assertEqual(said, "own_head: interrupted; nothing was written\n")
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_a_procedure_that_cannot_be_done_leaves_nothing(self):
        before = sorted(self.folder.iterdir())
        result = run(LABELS, "--plan", PLAN, "--out", self.folder / "out", "--edge", "10", "--spacing", "2",
                     "--", "--right", "20L")
        self.assertEqual(result.returncode, 1)
        self.assertIn("own_head: the procedure cannot be done: '20L' is no loss of fluid", result.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)


if __name__ == "__main__":
    unittest.main(verbosity=2)
