"""The chart of speed against accuracy, its short tier: what is drawn, and what is refused.

    chart_test.py PROGRAM HEADS OUT"""
import importlib.util
import json
import math
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "bench/speed_accuracy"
PROGRAM, HEADS, OUT = map(Path, sys.argv[1:4])

for module in ("numpy", "matplotlib"):
    if importlib.util.find_spec(module) is None:
        print(f"skipped: no {module} in {sys.executable} (cmake/install-deps.sh docs)")
        sys.exit(77)

sys.path.insert(0, str(BENCH))
sys.dont_write_bytecode = True
import cases   # noqa: E402
import front   # noqa: E402
import measure   # noqa: E402


def draw(*options, heads=HEADS, out=OUT, references=BENCH / "references"):
    return subprocess.run([sys.executable, "-B", BENCH / "speed_accuracy.py", "--coarse", "--program", PROGRAM,
                           "--heads", heads, "--out", out, "--references", references, *options],
                          capture_output=True, text=True, check=False)


def solve(**changes):
    done = subprocess.run([PROGRAM, HEADS, json.dumps({**cases.DEFAULT, **changes})], capture_output=True, text=True,
                          check=True)
    return json.loads(done.stdout)


class TheChart(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(OUT, ignore_errors=True)   # measured anew, by this program
        cls.done = draw()
        if cls.done.returncode == 0:
            cls.points = json.loads((OUT / "points.json").read_text())["points"]

    def setUp(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)

    def test_every_rung_of_the_short_tier_is_judged(self):
        self.assertEqual([p["rung"] for p in self.points], [r.name for r in cases.LADDER if r.name in cases.SHORT])
        for p in self.points:
            self.assertTrue(p["converged"], p["rung"])
            self.assertGreater(p["error"], 0.0)
            self.assertGreater(p["cpu"], 0.0)
            self.assertGreater(p["yardstick"], 0.0)
            self.assertAlmostEqual(p["yardsticks"], p["cpu"] / p["yardstick"])

    def test_the_front_falls_and_nothing_lies_below_it(self):
        found = front.pareto(self.points)
        for before, after in zip(found, found[1:]):
            self.assertGreater(after["yardsticks"], before["yardsticks"])
            self.assertLess(after["error"], before["error"])
        for p in self.points:
            self.assertTrue(any(f["yardsticks"] <= p["yardsticks"] and front.NOTICEABLE * f["error"] <= p["error"]
                                for f in found), p["rung"])

    def test_a_solve_to_an_accuracy_is_off_the_exact_one_by_less(self):
        for p in self.points:
            if p["case"]["accuracy"] > 0.0:
                self.assertLess(p["off_exact"], p["case"]["accuracy"], p["rung"])

    def test_one_linearisation_is_one(self):
        (point,) = [p for p in self.points if p["rung"] == "M2"]
        self.assertEqual(point["iterations"], 1)   # stage 0 changes nothing, and needs none
        exact = next(p for p in self.points if p["rung"] == "M3")
        self.assertGreater(exact["iterations"], 1)
        self.assertGreater(point["error"], exact["error"])

    def test_the_files_hold_the_chart(self):
        tree = ElementTree.parse(OUT / "speed_accuracy.svg")
        words = {"".join(e.itertext()).strip() for e in tree.iter("{http://www.w3.org/2000/svg}text")}
        for p in self.points:   # those that nearly coincide share a label: M1 1, 0.1
            kind = p["rung"][len(p["family"]):].strip()
            self.assertTrue(any(w.startswith(p["family"]) and kind in w[len(p["family"]):].strip().split(", ")
                                for w in words), p["rung"])
        import matplotlib.image
        pixels = matplotlib.image.imread(OUT / "speed_accuracy.png")
        self.assertGreater(pixels.shape[0], 400)
        self.assertGreater(pixels.shape[1], 400)
        self.assertGreater(float(pixels[..., :3].std()), 0.02)

    def test_drawn_again_it_is_the_same(self):
        names = ("speed_accuracy.svg", "speed_accuracy.png", "speed_accuracy.md")
        before = [(OUT / name).read_bytes() for name in names]
        self.assertEqual(draw("--draw-only").returncode, 0)
        for name, bytes_before in zip(names, before):
            self.assertEqual((OUT / name).read_bytes(), bytes_before, name)

    def test_what_was_not_measured_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(OUT, folder, dirs_exist_ok=True)
            for path in Path(folder, "runs").glob("*.json"):
                if self.is_of(path, "M2"):
                    path.unlink()
            done = draw("--draw-only", out=Path(folder))
            self.assertEqual(done.returncode, 0, done.stderr)
            page = Path(folder, "speed_accuracy.md").read_text()
        self.assertIn("- coarse head, CSF loss (stages 0 and 1): M2", page)
        self.assertNotIn("| M2 | coarse |", page)

    def is_of(self, path, rung):
        (point,) = [p for p in self.points if p["rung"] == rung]
        return json.loads(path.read_text())["cpu_seconds"] == point["cpu"]

    def test_the_page_recommends_what_the_table_holds(self):
        page = (OUT / "speed_accuracy.md").read_text()
        for p in self.points:
            self.assertIn(f"| {p['rung']} | coarse | {p['yardsticks']:.3g} |", page)
        best = front.cheapest(self.points, 0.5)
        self.assertIn(f"{best['rung']}, coarse head: {best['yardsticks']:.3g} yardsticks", page)
        deep = [{**p, "error": max(off[0] for kind, off in p["kinds"].items() if kind != "cortex")} for p in self.points]
        best = front.cheapest(deep, 0.1)
        self.assertIn(f"{best['rung']}, coarse head: {best['yardsticks']:.3g} yardsticks" if best else "none; closest", page)
        tight = min(p["error"] for p in self.points)
        self.assertIsNone(front.cheapest(self.points, tight))


class TheProgram(unittest.TestCase):
    def test_the_loss_of_fluid_is_that_of_the_procedure(self):
        loss, whole = solve(), solve(scene="procedure")
        for stage in ("0", "1"):
            mine, theirs = (next(s for s in r["stages"] if s["stage"] == stage)["shift_mm"] for r in (loss, whole))
            for name, shift in mine.items():
                self.assertLess(math.dist(shift, theirs[name]), 1e-6, f"{name}, stage {stage}")
        self.assertEqual(whole["stages"][-1]["stage"], "9")
        self.assertEqual(set(whole["stages"][-1]["tip_from_target_mm"]), {"tip_left", "tip_right"})

    def test_what_a_case_does_not_have_is_refused_by_name(self):
        for case, word in (({"acuracy": 1}, '"acuracy"'), ({"poisson": "soft"}, '"poisson"'),
                           ({"scene": "surgery"}, "'surgery'"), ({"scene": "procedure", "refinements": 1}, "refinements")):
            done = subprocess.run([PROGRAM, HEADS, json.dumps(case)], capture_output=True, text=True, check=False)
            self.assertNotEqual(done.returncode, 0, word)
            self.assertIn(word, done.stderr)


class References(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_all_that_are_there_fit(self):
        references = measure.References(BENCH / "references", HEADS)
        there = [c for c in cases.all_references() if references.path(c).is_file()]
        self.assertEqual(len(list((BENCH / "references").glob("*.json"))), len(there))   # and no other file
        self.assertIn("coarse-csf_loss-corotational-0.45-own", [cases.name_of(c) for c in there])
        for case in there:
            references.read(case)

    def test_they_are_listed(self):
        done = subprocess.run([sys.executable, "-B", BENCH / "make_references.py", "--program", PROGRAM, "--heads", HEADS,
                               "--list"], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.split(), [cases.name_of(c) for c in cases.all_references()])

    def test_one_of_another_head_is_refused(self):
        heads = self.folder / "heads"
        shutil.copytree(HEADS, heads)
        text = (heads / "coarse/head.json").read_text()
        changed = text.replace("generic head", "changed head", 1)
        self.assertNotEqual(changed, text)
        (heads / "coarse/head.json").write_text(changed)
        done = draw(heads=heads, out=self.folder / "out")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("head.json of the coarse head", done.stderr)
        self.assertIn("make_references", done.stderr)
        self.assertFalse((self.folder / "out/speed_accuracy.svg").exists())

    def test_one_of_other_options_or_points_is_refused(self):
        references = self.folder / "references"
        shutil.copytree(BENCH / "references", references)
        for path in references.glob("coarse-csf_loss-corotational-0.45-*.json"):
            kept = json.loads(path.read_text())
            kept["inputs"]["case"]["poisson"] = 0.44
            path.write_text(json.dumps(kept))
        done = draw(out=OUT, references=references)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("options of its case", done.stderr)
        shutil.rmtree(references)
        shutil.copytree(BENCH / "references", references)
        for path in references.glob("coarse-csf_loss-corotational-0.45-*.json"):
            kept = json.loads(path.read_text())
            kept["probes"][0]["point"][0] += 0.1
            path.write_text(json.dumps(kept))
        done = draw(out=OUT, references=references)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("other probes", done.stderr)

    def test_the_short_tier_does_not_write_the_documents(self):
        done = draw("--write-docs")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("without --coarse", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
