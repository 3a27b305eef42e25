#!/usr/bin/env python3
"""bench/scaling: its small sizes, from the program to the page. Arguments: program, folder to write to."""
import json
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

SCALING = Path(__file__).resolve().parents[2] / "bench/scaling"
try:
    import matplotlib  # noqa: F401
except ImportError:
    print("skipped: matplotlib is not installed (cmake/install-deps.sh docs)")
    sys.exit(77)
PROGRAM, OUT = Path(sys.argv[1]), Path(sys.argv[2])


def run(*options):
    return subprocess.run(["/usr/bin/python3", "-B", SCALING / "scaling.py", "--program", PROGRAM, *options],
                          capture_output=True, text=True, check=False)


class Scaling(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(OUT, ignore_errors=True)
        done = run("--short", "--out", OUT)
        if done.returncode != 0:
            raise RuntimeError(done.stderr)
        cls.result = json.loads((OUT / "scaling.json").read_text())

    def test_every_series_has_its_points_and_a_table(self):
        page = (OUT / "scaling.md").read_text()
        for name, rows in self.result["series"].items():
            self.assertGreater(len(rows), 0, name)
            section = page.split(f"## {name[0].upper()}{name[1:]}\n")[1].split("\n## ")[0]
            self.assertEqual(section.count("\n|"), 2 + len(rows), name)
        for name in ("scaling.svg", "scaling.png"):
            self.assertGreater((OUT / "charts" / name).stat().st_size, 10000)

    def test_rows_are_what_they_say(self):
        for rows in self.result["series"].values():
            for row in rows:
                self.assertGreater(row["iterations"], 0, row["case"])
                self.assertAlmostEqual(row["yardsticks"] * self.result["yardstick"], row["cpu_seconds"])
                if row["case"]["scene"] == "block":
                    self.assertEqual(row["tets"], 6 * row["case"]["cells"] ** 3)
                    self.assertEqual(row["coupling_rows"] > 0, row["case"].get("leads", 0) > 0)

    def test_memory_grows_with_tets_and_is_that_of_the_estimate(self):
        rows = self.result["series"]["tets of a block"]
        peaks = [row["resident_rise"] for row in rows]
        self.assertEqual(peaks, sorted(peaks))
        for row in rows:   # code and buffers of the process: some 5 MB
            self.assertLess(row["resident_rise"], 1.1 * row["estimate"]["total"] + 8e6, row["case"])
            self.assertGreater(row["resident_rise"], 0.7 * row["estimate"]["total"], row["case"])

    def test_runs_that_are_there_are_not_repeated(self):
        kept = {p: p.stat().st_mtime_ns for p in (OUT / "runs").iterdir()}
        self.assertEqual(run("--short", "--out", OUT).returncode, 0)
        self.assertEqual({p: p.stat().st_mtime_ns for p in (OUT / "runs").iterdir()}, kept)

    def test_the_page_is_not_written_from_small_sizes(self):
        done = run("--short", "--write-docs", "--out", OUT)
        self.assertEqual(done.returncode, 2)
        self.assertIn("leave out --short or --write-docs", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
