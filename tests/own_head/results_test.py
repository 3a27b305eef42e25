"""Results in the frame of the map agree with the meshes, and can be read again."""
import json
import subprocess
import types
import unittest

import nibabel
import numpy as np
from scipy.ndimage import map_coordinates

from support import WORK, Case  # first: it says where the example's modules are
import make_phantom
import markups
import own_head
import placement
import plan as plans
import results
from chain import trimesh
from vtk.util.numpy_support import vtk_to_numpy

OUT = WORK / "out/my_head"
STAGE = "8"  # the end of surgery


def read_field():
    """Displacement (RAS) and affine as a user would read them."""
    image = nibabel.load(OUT / f"image/stage_{STAGE}.displacement.nii.gz")
    return image, np.asarray(image.dataobj)[:, :, :, 0, :] * (-1.0, -1.0, 1.0)


def sample(values, affine, points):
    """Trilinear values at world points, and the spread of the eight voxels around each."""
    index = np.linalg.solve(affine[:3, :3], (points - affine[:3, 3]).T)
    return np.column_stack([map_coordinates(values[..., c], index, order=1) for c in range(3)]), index


def mesh(folder):
    """Rest positions, displacements, tets of a stage."""
    grid = results.read_vtk(OUT / folder / f"stage_{STAGE}.vtu")
    shift = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    tets = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return vtk_to_numpy(grid.GetPoints().GetData()) - shift, shift, tets, grid


def stage():
    table = json.loads((OUT / "procedure/stages.json").read_text())
    return next(entry for entry in table["stages"] if entry["stage"] == STAGE)


def frame():
    return placement.Frame(np.array(json.loads((OUT / "own_head.json").read_text())["world_to_head"]))


class Field(unittest.TestCase):
    def test_header_says_vectors_in_mm_on_the_map(self):
        image, _ = read_field()
        labels = nibabel.load(WORK / "out/phantom/labels.nii.gz")
        self.assertEqual(image.shape, (*labels.shape, 1, 3))
        np.testing.assert_allclose(image.affine, labels.affine, atol=1e-5)  # float32 of the header
        self.assertEqual(int(image.header["intent_code"]), 1007)
        self.assertEqual(image.header.get_xyzt_units()[0], "mm")
        self.assertIn(b"LPS", bytes(image.header["descrip"]))

    def test_agrees_with_the_mesh_at_its_nodes(self):
        rest, shift, tets, _ = mesh("image")
        image, values = read_field()
        found, index = sample(values, image.affine, rest)
        # Inside: all eight voxels around the node lie in the brain.
        mask = (np.abs(values).max(axis=-1) > 0).astype(float)
        inside = map_coordinates(mask, index, order=1) > 1 - 1e-9
        self.assertGreater(inside.sum(), 500)
        # The field is linear in each tet. A voxel's value differs from the node's by at most the
        # largest gradient of the tets in reach times its distance, so does their mean.
        reach = np.linalg.norm(image.affine[:3, :3], axis=0).sum()
        gradient = np.linalg.norm(gradients(rest, shift, tets), axis=(1, 2))
        bound = gradient.max() * reach
        error = np.linalg.norm(found - shift, axis=1)[inside]
        self.assertLess(error.max(), bound)
        # On average the errors are of second order: far below the displacements themselves.
        self.assertLess(np.median(error), 0.02 * np.linalg.norm(shift[inside], axis=1).mean())

    def test_a_frame_confused_would_be_noticed(self):
        rest, shift, _, _ = mesh("image")
        image, values = read_field()
        found, _ = sample(values * (-1, -1, 1), image.affine, rest)
        self.assertGreater(np.median(np.linalg.norm(found - shift, axis=1)), 1.0)

    def test_agrees_with_the_shifts_of_landmarks(self):
        image, values = read_field()
        head = json.loads((OUT / "head/head.json").read_text())
        shifts = stage()["shift_mm"]
        names = [name for name in shifts if name.startswith(("STN", "GPi", "target", "AC", "PC", "MCP"))]
        points = frame().to_world([head["landmarks"][name] for name in names])
        found, _ = sample(values, image.affine, points)
        expected = frame().turn_to_world([shifts[name] for name in names])
        # Nuclei lie deep, where a voxel's diagonal (3.7 mm) makes little: gradients there are below 5 %.
        np.testing.assert_allclose(found, expected, atol=0.05)
        self.assertGreater(np.linalg.norm(expected, axis=1).min(), 1.0)

    def test_outside_the_brain_it_is_zero(self):
        _, values = read_field()
        labels = np.asanyarray(nibabel.load(WORK / "out/phantom/labels.nii.gz").dataobj)
        moved = np.abs(values).max(axis=-1) > 0
        # A small part of the mesh lies in furrows and of the labels outside the smooth mesh.
        cerebrum = (labels > 0) & ~np.isin(labels, [7, 8, 15, 46, 47])
        overlap = 2 * (moved & cerebrum).sum() / (moved.sum() + cerebrum.sum())
        self.assertGreater(overlap, 0.93)


def gradients(rest, shift, tets):
    """Displacement gradient of each tet."""
    edges = rest[tets[:, 1:]] - rest[tets[:, :1]]
    return np.linalg.solve(edges, shift[tets[:, 1:]] - shift[tets[:, :1]])


class Page(Case):
    def test_it_tells_of_this_head(self):
        if subprocess.run([*own_head.REPORT, "--check"], capture_output=True).returncode:
            self.skipTest("no page can be drawn here (cmake/install-deps.sh docs)")
        path = self.folder / "page.html"
        own_head.write_report(types.SimpleNamespace(out=OUT, report=path))
        text = path.read_text(encoding="utf-8")
        self.assertIn("The head was made from labels", text)
        self.assertNotIn("The head is generic", text)
        for entry in json.loads((OUT / "procedure/stages.json").read_text())["stages"]:
            self.assertIn(f'id="stage_{entry["stage"]}"', text)

    def test_without_a_procedure_there_is_none(self):
        self.assert_refused(WORK / "out/phantom/labels.nii.gz", "--report", self.folder / "page.html",
                            says=["--report", "leave it or --head-only out"])


class Meshes(unittest.TestCase):
    def test_in_the_image_they_are_those_of_the_procedure_moved(self):
        rest, shift, tets, grid = mesh("image")
        head_rest, head_shift, head_tets, _ = mesh("procedure")
        np.testing.assert_allclose(rest, frame().to_world(head_rest), atol=1e-9)
        np.testing.assert_allclose(shift, frame().turn_to_world(head_shift), atol=1e-9)
        np.testing.assert_array_equal(tets, head_tets)
        self.assertGreater(trimesh.tet_volumes(rest, tets).min(), 0)  # not mirrored
        self.assertEqual(grid.GetFieldData().GetAbstractArray("SPACE").GetValue(0), "RAS")

    def test_tets_know_their_labels(self):
        grid = results.read_vtk(OUT / "head/brain.vtu")
        values = vtk_to_numpy(grid.GetCellData().GetArray("label"))
        points = frame().to_world(vtk_to_numpy(grid.GetPoints().GetData()))
        centres = points[vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)].mean(axis=1)
        local = (centres - make_phantom.SHIFT) @ make_phantom.turn()
        expected = make_phantom.paint(*local.T)
        self.assertGreater(np.mean(values == expected), 0.75)  # voxels of 2 mm, sampled twice


class Markups(unittest.TestCase):
    def test_what_is_written_is_read_again(self):
        for path in sorted((OUT / "image").glob("*.mrk.json")):
            for markup in markups.read(path):
                self.assertEqual(markup.system, "LPS")
                again = path.with_suffix(".again")
                self.addCleanup(again.unlink)
                markups.write(again, [markup])
                self.assertEqual(again.read_text(), path.read_text(), path)

    def test_targets_are_where_the_field_carries_them(self):
        planned = plans.read([OUT / "image/planned.landmarks.mrk.json"]).landmarks
        moved = plans.read([OUT / f"image/stage_{STAGE}.targets.mrk.json"]).landmarks
        image, values = read_field()
        for name in ("target_left", "target_right", "STN_left", "STN_right"):
            found, _ = sample(values, image.affine, planned[name][None])
            np.testing.assert_allclose(moved[name], planned[name] + found[0], atol=0.05)

    def test_the_lead_starts_at_its_tip_and_ends_at_the_burr_hole(self):
        for side in ("left", "right"):
            curve, = markups.read(OUT / f"image/stage_{STAGE}.lead_{side}.mrk.json")
            lead = stage()["electrodes"][side]
            self.assertEqual(curve.kind, "Curve")
            np.testing.assert_allclose(curve.points[0], frame().to_world(lead["tip_mm"]), atol=1e-9)
            hole = frame().to_world(lead["burr_hole_mm"])
            off = np.linalg.norm(curve.points - hole, axis=1).min()
            self.assertLess(off, 2.0)  # the wire slides through it and has nodes every few mm

    def test_the_plan_written_is_the_plan_read(self):
        given = plans.read([WORK / "out/phantom/plan_ras"])
        written = plans.read(sorted((OUT / "image").glob("planned.*.mrk.json")))
        for name, position in given.landmarks.items():
            np.testing.assert_allclose(written.landmarks[name], position, atol=1e-5)  # head.json: 1e-6
        for one in given.lines:
            other = next(line for line in written.lines if line.side == one.side)
            np.testing.assert_allclose(other.target, one.target, atol=1e-5)
            way = (one.entry - one.target) / np.linalg.norm(one.entry - one.target)
            found = (other.entry - other.target) / np.linalg.norm(other.entry - other.target)
            np.testing.assert_allclose(found, way, atol=1e-6)


if __name__ == "__main__":
    unittest.main(verbosity=2)
