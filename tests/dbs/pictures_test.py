"""Pictures of a run of dbs: what is in them is where it is in the results.

    pictures_test.py HEAD RESULTS"""
import copy
import dataclasses
import importlib.util
import io
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RENDER = ROOT / "examples" / "dbs" / "render.py"
HEAD, RESULTS = map(Path, sys.argv[1:3])
sys.path.insert(0, str(RENDER.parent))

for module in ("numpy", "vtk", "matplotlib", "PIL"):
    if importlib.util.find_spec(module) is None:
        print(f"skipped: no {module} in {sys.executable} (cmake/install-deps.sh docs)")
        sys.exit(77)
from vtk_parts import COLOURS, LEAD, need_display   # noqa: E402

try:
    need_display()
except SystemExit as reason:
    print(f"skipped: {reason}")
    sys.exit(77)

import numpy as np   # noqa: E402
from matplotlib import colormaps   # noqa: E402
from PIL import Image   # noqa: E402

from head_scene import AIR, FALX, HeadScene   # noqa: E402
from layout import deflected   # noqa: E402


def where(image, colour):
    """Rows and columns of the pixels of a colour; 8 of 255 for what halving the picture mixes in."""
    return np.nonzero((np.abs(image.astype(int) - np.round(255 * np.array(colour))) <= 8).all(axis=2))


class Panels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = HeadScene(HEAD, RESULTS)
        cls.stage = {s["stage"]: s for s in cls.scene.stages}

    def draw(self, view, stage):
        return self.scene.draw(view, self.stage[stage], pixels=400)

    def test_air_lies_on_top_and_on_the_side_that_is_open(self):
        self.assertEqual(len(where(self.draw(self.scene.axial(25.0), "0").image, AIR)[0]), 0)
        one = where(self.draw(self.scene.axial(25.0), "1").image, AIR)
        self.assertGreater(len(one[0]), 50)
        self.assertLess(one[0].max(), 200)     # the upper half: to the front, against gravity
        self.assertLess(one[1].mean(), 195)    # the left half: the right of the head
        both = where(self.draw(self.scene.axial(25.0), "8").image, AIR)
        self.assertGreater(len(both[0]), 2 * len(one[0]))
        self.assertAlmostEqual(both[1].mean(), 200, delta=20)

    def test_without_an_electrode_each_side_has_a_sagittal_cut_of_its_own(self):
        scene = copy.copy(self.scene)
        scene.plans = {}
        air = {side: len(where(scene.draw(dataclasses.replace(scene.along(side), side=""), self.stage["1"],
                                          400).image, AIR)[0]) for side in ("right", "left")}
        self.assertGreater(air["right"], 50)   # opened first
        self.assertEqual(air["left"], 0)

    def test_the_waterline_of_a_cut_is_at_the_level_of_the_results(self):
        panel = self.draw(dataclasses.replace(self.scene.along("right"), side=""), "8")   # no dark contacts
        lowest = where(panel.image, AIR)[0].max()
        _, _, bottom, top = panel.extent()
        height = top - (lowest + 0.5) / panel.image.shape[0] * (top - bottom)
        level = self.stage["8"]["sides"]["right"]["level_mm"] * self.scene.up
        # In the plane of the cut, which leans: heights there are measured along the plane.
        slope = panel.view.up @ self.scene.up
        self.assertAlmostEqual((panel.centre @ self.scene.up + height * slope), level @ self.scene.up,
                               delta=1.5 * panel.height / 400)

    def test_the_brain_has_the_colour_of_its_displacement(self):
        for stage in ("1", "5", "8"):
            # Beside the electrode: 8 mm in front of the target.
            target = self.scene.plans["right"][0] + np.array([0.0, 8.0, 0.0])
            panel = self.draw(self.scene.along("right"), stage)
            (x,), (y,) = panel.project(target)
            left, right, bottom, top = panel.extent()
            pixel = panel.image[int((top - y) / (top - bottom) * 400), int((x - left) / (right - left) * 400)]
            colour = colormaps[COLOURS](self.displacement_at(stage, target) / self.scene.largest)[:3]
            self.assertLess(np.abs(pixel / 255.0 - colour).max(), 0.03, stage)

    def displacement_at(self, stage, point):
        from vtk.util.numpy_support import vtk_to_numpy
        grid = self.scene.loaded[stage][0]
        size = vtk_to_numpy(grid.GetPointData().GetArray("size"))
        weights, local, sub = [0.0] * 4, [0.0] * 3, __import__("vtk").reference(0)
        cell = grid.FindCell(point, None, -1, 1e-9, sub, local, weights)
        nodes = grid.GetCell(cell).GetPointIds()
        return sum(w * size[nodes.GetId(k)] for k, w in enumerate(weights))

    def test_the_lead_is_there_from_the_stage_it_goes_in(self):
        for side, before, after in (("right", "2", "3"), ("left", "6b", "6c")):
            self.assertGreater(len(where(self.draw(self.scene.along(side), after).image, LEAD)[0]), 30)
            self.assertEqual(len(where(self.draw(self.scene.along(side), "1").image, LEAD)[0]), 0)

    def test_its_deflection_is_enlarged_across_its_line_only(self):
        lead = self.stage["9"]["electrodes"]["left"]
        nodes, target, outward = (np.array(lead[k]) for k in ("nodes_mm", "target_mm", "outward"))
        self.assertLess(np.abs(deflected(lead, 1.0) - nodes).max(), 1e-12)
        moved = deflected(lead, 10.0)
        self.assertLess(np.abs((moved - nodes) @ outward).max(), 1e-12)
        across = np.linalg.norm(nodes - target - np.outer((nodes - target) @ outward, outward), axis=1)
        self.assertLess(np.abs(np.linalg.norm(moved - nodes, axis=1) - 9.0 * across).max(), 1e-12)

    def test_views_in_space_show_falx_and_bone(self):
        image = self.draw(self.scene.front(), "8").image
        warm = (image[..., 0].astype(int) - image[..., 2] > 15).sum()   # bone, and the yellow of the poles
        self.assertGreater(warm, 3000)
        self.assertGreater(len(where(self.draw(self.scene.axial(25.0), "8").image, FALX)[0]), 20)
        # Its border, which tells it from what shines through it.
        red, green, blue = np.moveaxis(self.draw(self.scene.space("left"), "8").image[..., :3].astype(int), -1, 0)
        reddish = (red - green > 60) & (red - blue > 60) & (np.abs(green - blue) < 40)   # seen through the glass
        self.assertGreater(reddish.sum(), 300)


class Program(unittest.TestCase):
    def run_it(self, *options, results=RESULTS):
        return subprocess.run([sys.executable, "-B", str(RENDER), "--head", str(HEAD), str(results),
                               *options], capture_output=True, text=True)

    def test_every_picture_is_written_and_shows_something(self):
        with tempfile.TemporaryDirectory() as folder:
            run = self.run_it("--out", folder, "--dots", "40", "--small")
            self.assertEqual(run.returncode, 0, run.stderr)
            written = {p.stem for p in Path(folder).iterdir()}
            expected = {f"stage_{s}" for s in "0 1 2 3 4 5 6a 6b 6c 7 8 9".split()}
            expected |= {"sheet_right", "sheet_left", "figure_shift", "figure_lead_right",
                         "figure_lead_left"}
            self.assertEqual(written, expected)
            for path in Path(folder).iterdir():
                pixels = np.asarray(Image.open(io.BytesIO(path.read_bytes())))
                if path.stem.startswith("stage"):
                    self.assertEqual(pixels.shape[:2], (376, 600))   # 9.4 x 15 inches
                self.assertGreater(pixels.std(axis=(0, 1)).min(), 10.0, path.name)

    def test_what_cannot_be_ends_in_one_sentence(self):
        for options, words in ((("--only", "stage_77"), ("stage_77", "stage_6b")),
                               (("--axial", "500", "--only", "stage_0"), ("axial, z = 500 mm", "another cut"))):
            run = self.run_it(*options)
            self.assertEqual((run.returncode, run.stderr.count("\n")), (1, 1), run.stderr)
            for word in words:
                self.assertIn(word, run.stderr)
        run = self.run_it(results=RESULTS / "nowhere")
        self.assertEqual((run.returncode, run.stderr.count("\n")), (1, 1), run.stderr)
        self.assertIn("stages.json: no such file", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
