"""The bar by the library and by CalculiX: they agree, and what does not is refused."""
import pathlib
import shutil
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench/peers"))
import peers  # noqa: E402


class Bars(unittest.TestCase):
    def setUp(self):
        self.case = peers.Case(PROGRAM, OUT, 4)

    def test_agree(self):
        pair = peers.Pair(self.case, [1, 2], ["automatic", "2"], 1)
        self.assertLessEqual(pair.apart, peers.APART)
        self.assertGreater(pair.sag, 50.0)   # mm: far from linear
        for run in (*pair.all_ours, *pair.all_theirs):
            self.assertGreater(run["seconds"], 0.0)
            self.assertGreaterEqual(run["iterations"], 3)
        self.assertAlmostEqual(pair.ours["smallest_jacobian"], pair.theirs["smallest_jacobian"], 5)
        self.assertEqual(sorted(run["increments"] for run in pair.all_theirs), [1, 2])

    def test_that_differ_are_refused(self):
        self.case.bar["poisson"] += 1e-5
        with self.assertRaisesRegex(SystemExit, "of the largest displacement apart"):
            peers.Pair(self.case, [1], ["1"], 1)

    def test_that_are_inside_out_are_refused(self):
        x, y, z = 0, 1, 2
        mirrored = [tuple(-2.0 * float(p[k]) if k == x else 0.0 for k in (x, y, z)) for p in self.case.mesh.nodes]
        self.assertLess(min(self.case.jacobians(mirrored)), 0.0)
        with self.assertRaisesRegex(SystemExit, "all tets upright"):
            peers.tried(lambda step: {"seconds": 1.0, "smallest_jacobian": min(self.case.jacobians(mirrored))}, ["1"], 1)

    def test_that_find_no_balance_are_left_out(self):
        """Twenty times its weight in one increment is beyond both; the deck is read all the same."""
        self.case.bar["gravity"] *= 400.0
        self.assertIsNone(self.case.theirs("1"))


if __name__ == "__main__":
    if not shutil.which("ccx"):
        print("skipped: no CalculiX (cmake/install-deps.sh peers)")
        sys.exit(77)
    PROGRAM, OUT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
