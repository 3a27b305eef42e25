"""Parts of the brain with materials of their own: read, refused, and felt."""
import json
import os
import re
import subprocess
import unittest

import numpy as np

from support import EXAMPLE, SOURCE, WORK, Case, run, stages_of  # first: it says where the example's modules are
import labels
import materials
import results
from chain import trimesh
from problem import Problem
from vtk.util.numpy_support import vtk_to_numpy

LABELS = WORK / "out/phantom/labels.nii.gz"
HEAD = WORK / "out/my_head/head"
WHITE, CORTEX = [2, 41], [3, 42]
DENSITY = 1040.0  # kg/m^3, of dbs where no material has its own

# Entries that neither program takes, and what both say of them.
BAD = [({"labels": [2], "young": 3}, "unknown key 'young'"),
       ({"labels": [2], "young_kPa": 0}, "is not positive"),
       ({"labels": [2], "young_kPa": -1.5}, "is not positive"),
       ({"labels": [2], "poisson": 0.5}, "is not inside (-1, 0.5)"),
       ({"labels": [2], "density_kg_m3": -1}, "is not zero or more"),
       ({"labels": [2], "law": "rubber"}, "rubber"),
       ({"labels": []}, "needs 'labels'"),
       ({"young_kPa": 3}, "needs 'labels'"),
       ({"labels": [2.5]}, "'labels' holds 2.5"),
       ({"labels": [[5, 2]]}, "'labels' holds [5"),
       ("soft", "write an object")]


def dbs(path, *options, head=HEAD):
    """dbs on the synthetic head, with a file of materials."""
    return subprocess.run([os.environ["DBS"], "--head", head, "--no-files", "--no-devices", "--materials", path,
                           *options], capture_output=True, text=True)


class Files(Case):
    def file(self, *entries):
        path = self.folder / "materials.json"
        path.write_text(json.dumps({"materials": entries}))
        return path

    def test_both_programs_refuse_what_is_no_material(self):
        dictionary = labels.read_dictionary("freesurfer")
        for entry, says in BAD:
            path = self.file(entry)
            with self.assertRaises(Problem) as caught:
                materials.read(path, dictionary, np.arange(60))
            result = dbs(path)
            self.assertEqual(result.returncode, 1, entry)
            for sentence in (str(caught.exception), result.stderr):
                self.assertIn(says, sentence)
                self.assertIn("materials.json", sentence)
                self.assertEqual(len(sentence.strip().splitlines()), 1)

    def test_both_know_the_same_laws(self):
        dictionary = labels.read_dictionary("freesurfer")
        for law in materials.LAWS:
            path = self.file({"labels": WHITE, "law": law, "young_kPa": 6})
            self.assertEqual(materials.read(path, dictionary, [2])[0]["law"], law)
            result = dbs(path, "--right", "0mL", "--left", "0mL")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f": {law}, E 6 kPa", result.stdout)

    def test_a_label_in_two_materials(self):
        path = self.file({"name": "a", "labels": [2]}, {"name": "b", "labels": [[1, 4]]})
        self.assertIn("label 2 stands in", dbs(path).stderr)
        with self.assertRaisesRegex(Problem, "label 2 stands in 'b' and in 'a': keep one of them"):
            materials.read(path, labels.read_dictionary("freesurfer"), [2, 3, 4])

    def test_what_the_map_does_not_have_or_is_not_meshed(self):
        for entry, says in (({"name": "x", "labels": [99]}, "'x': the map has none of its labels"),
                            ({"name": "x", "labels": ["Thalamus"]}, "the dictionary has no label 'Thalamus'"),
                            ({"name": "x", "labels": [8]}, "label 8 is cerebellum, which is not meshed")):
            self.assert_refused(LABELS, "--materials", self.file(entry), says=["materials.json", says])

    def test_names_of_the_dictionary_stand_for_their_values(self):
        path = self.file({"labels": ["Left-Cerebral-White-Matter", 41, "ctx-lh (aparc)"]})
        found, = materials.read(path, labels.read_dictionary("freesurfer"), [2])
        self.assertEqual(found["labels"][:2], [[2, 2], [41, 41]])
        self.assertIn([1000, 1035], found["labels"])

    def test_the_example_of_the_readme_is_read(self):
        text = (EXAMPLE / "README.md").read_text(encoding="utf-8")
        block, = re.findall(r"```json\n(.*?\"materials\".*?)```", text.split("**Materials**")[1], re.DOTALL)
        path = self.folder / "materials.json"
        path.write_text(block)
        found = materials.read(path, labels.read_dictionary("freesurfer"), np.arange(60))
        self.assertEqual([len(one["labels"]) for one in found], [3, 2])

    def test_no_file_and_no_json(self):
        self.assert_refused(LABELS, "--materials", self.folder / "none.json", says=["none.json", "cannot be read"])
        path = self.folder / "materials.json"
        path.write_text("{")
        self.assert_refused(LABELS, "--materials", path, says=["is not JSON with a list 'materials'"])
        self.assertIn("is not JSON with a list 'materials'", dbs(path).stderr)

    def test_a_head_without_labels_cannot_have_them(self):
        generic = SOURCE / "examples/head/data/coarse"
        self.assertIn("has no array 'label'", dbs(self.file({"labels": [2]}), head=generic).stderr)

    def test_a_mass_for_all_contradicts_a_density_for_some(self):
        path = self.file({"name": "white", "labels": WHITE, "density_kg_m3": 1041})
        self.assertIn("'white': has a density, and --mass sets one for all", dbs(path, "--mass", "1.2").stderr)


class Effects(Case):
    def shifts(self, *entries, options=()):
        """Motion of the right STN in the whole procedure, by dbs alone."""
        if entries:
            path = self.folder / "materials.json"
            path.write_text(json.dumps({"materials": entries}))
            options = [*options, "--materials", path]
        out = self.folder / "procedure"
        subprocess.run([os.environ["DBS"], "--head", HEAD, "--out", out, *options], check=True,
                       capture_output=True)
        table = json.loads((out / "stages.json").read_text())
        return np.array([stage["shift_mm"]["STN_right"] for stage in table["stages"]]), table

    def test_parts_of_the_default_material_change_nothing(self):
        # Only the order in which tets are summed differs: rounding, against shifts of a millimetre.
        found, table = self.shifts({"name": "white", "labels": WHITE}, {"name": "cortex", "labels": CORTEX})
        expected = [stage["shift_mm"]["STN_right"] for stage in stages_of(WORK / "out/my_head")]
        np.testing.assert_allclose(found, expected, atol=1e-6)
        self.assertGreater(np.abs(expected).max(), 0.5)
        grid = results.read_vtk(HEAD / "brain.vtu")
        value = vtk_to_numpy(grid.GetCellData().GetArray("label"))
        nodes = vtk_to_numpy(grid.GetPoints().GetData())
        tets = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
        for part, own in zip(table["materials"], (WHITE, CORTEX)):
            volume = trimesh.tet_volumes(nodes, tets)[np.isin(value, own)].sum() / 1e3
            self.assertAlmostEqual(part["volume_mL"], volume, places=6)
            self.assertEqual((part["young_kPa"], part["poisson"]), (6.0, 0.45))

    def test_a_material_of_all_labels_is_that_of_the_brain(self):
        # The cord's column below the brainstem among it, which is as stiff as the tissue above.
        part = {"labels": [[-2**31 + 1, 2**31 - 1]], "young_kPa": 3, "poisson": 0.4, "density_kg_m3": 1050,
                "law": "stable_neo_hookean"}
        found, _ = self.shifts(part)
        expected, _ = self.shifts(options=["--young", "3", "--poisson", "0.4", "--density", "1050", "--law",
                                           "stable_neo_hookean"])
        np.testing.assert_allclose(found, expected, atol=1e-6)
        usual = [stage["shift_mm"]["STN_right"] for stage in stages_of(WORK / "out/my_head")]
        self.assertGreater(np.abs(expected - usual).max(), 0.05)

    def test_softer_white_matter_swells_more_when_less_fluid_presses_on_it(self):
        swelling = []
        for young in (24, 6, 3):
            _, table = self.shifts({"labels": WHITE, "young_kPa": young})
            swelling.append(max(-stage["brain_volume_lost_mL"] for stage in table["stages"]))
        self.assertEqual(swelling, sorted(swelling))
        self.assertGreater(swelling[-1], 1.5 * swelling[0])

    def test_the_command_of_the_readme_takes_them_with_the_head(self):
        path = self.folder / "materials.json"
        path.write_text(json.dumps({"materials": [{"name": "white", "labels": WHITE, "density_kg_m3": 1100}]}))
        out = self.folder / "out"
        result = run(LABELS, "--materials", path, "--out", out, "--edge", "10", "--spacing", "2")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = json.loads((out / "procedure/stages.json").read_text())
        part, = table["materials"]
        self.assertAlmostEqual(part["density_kg_m3"], 1100, places=6)
        mass = (part["volume_mL"] * 1100 + (table["head"]["volume_mL"] - part["volume_mL"]) * DENSITY) * 1e-6
        self.assertIn(f"{mass:.3f} kg at ", result.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
