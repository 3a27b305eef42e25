"""The decks of bench/stability by CalculiX, where theory or the library knows the answer."""
import pathlib
import re
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/stability"))
import calculix  # noqa: E402


class Bars(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.decks = calculix.decks(PROGRAM)

    def run_deck(self, name):
        return calculix.Result(OUT / name.replace("/", "_").replace(" ", "_"), self.decks[name])

    def test_confined_reaches_the_limit_point_of_the_law(self):
        """P(l) = (lambda + 2 mu) (l^3 - l)/2 is least at 1/sqrt(3): 0.19245 of Young's modulus where nu is 0."""
        for element in ("linear", "quadratic"):
            name = f"compression/{element}/confined, nu 0"
            row = calculix.compression(name.split("/"), self.run_deck(name))
            # Increments are a fiftieth of 0.8 at most, and cut to a thousandth of it.
            self.assertLessEqual(float(row["load"]), 0.19245 + 1e-3)
            self.assertGreater(float(row["load"]), 0.19245 - 2e-3)
            self.assertLess(abs(float(row["stretch"]) - 3 ** -0.5), 0.05)
            self.assertNotEqual(row["status"], "end of the axis")

    def test_jacobians_are_those_of_a_known_motion(self):
        for element in ("linear", "quadratic"):
            run = self.run_deck(f"poisson/{element}/0.2")
            self.assertAlmostEqual(run.smallest_jacobian(np.zeros_like(run.nodes)), 1.0, 12)
            stretch = np.array([0.5, 0.8, 1.5])
            self.assertAlmostEqual(run.smallest_jacobian(run.nodes * (stretch - 1.0)), 0.6, 12)
            self.assertLess(run.smallest_jacobian(run.nodes * np.array([-2.0, 0.0, 0.0])), 0.0)
            shear = run.nodes @ np.array([[0.0, 0.2, 0.0], [0.0, 0.0, 0.1], [0.3, 0.0, 0.0]])
            np.testing.assert_allclose(run.at((10.0, 10.0, 20.0), shear), [6.0, 2.0, 1.0], atol=1e-12)

    def test_a_run_without_balance_is_no_convergence(self):
        deck = self.decks["load_steps/linear/0.3/1"]
        run = calculix.Result(OUT / "heavy", re.sub("GRAV,[^,]+", "GRAV,3e7", deck))
        self.assertNotEqual(calculix.status_of(run), "converged")
        self.assertGreater(run.iterations, 0)


if __name__ == "__main__":
    if not calculix.there():
        print("skipped: no CalculiX (cmake/install-deps.sh peers)")
        sys.exit(77)
    PROGRAM, OUT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
