"""An aerofoil that pitches, with default settings, against Theodorsen's flat plate (NACA Report 496, 1935): the thinner the section the nearer.
Usage: pitching_test.py SPINDRIFT"""
import cmath
import math
import unittest

from running import Folder, ROOT, rows, spindrift

SCENE = ROOT / "inputs/validation/pitching_naca0012/pitching.toml"
PERIOD_S, AMPLITUDE, REDUCED = 0.307716, math.radians(2.5), 0.2
C = 0.7276 - 0.1886j  # Theodorsen's function at 0.2


def plate():
    """Lift over the pitch about the quarter chord, complex: amplitude and lead."""
    k, a = REDUCED, -0.5
    return math.pi * (1j * k + a * k * k) + 2.0 * math.pi * C * (1.0 + 1j * k * (0.5 - a))


class Pitching(Folder):
    def swing(self, digits):
        """The same of the last period of a run."""
        done = spindrift("run", SCENE, "--out", self.out, "--overwrite", "--no-report", "--set", "aero.flow.generate.kind='aerofoil'",
                         "--set", f"aero.flow.generate.naca='{digits}'", timeout=1200)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        last = rows(self.out / "history.csv")[-40:]
        turn = sum(row["flow.lift_coefficient"] * cmath.exp(-2j * math.pi * row["time_s"] / PERIOD_S) for row in last)
        return 2j * turn / len(last) / AMPLITUDE

    def test_thin_sections_have_the_lift_of_a_plate(self):
        exact, found = plate(), {thickness: self.swing(f"00{thickness:02d}") for thickness in (3, 6, 12)}
        lead = {thickness: math.degrees(cmath.phase(lift)) for thickness, lift in found.items()}
        self.assertAlmostEqual(abs(found[3]) / abs(exact), 1.0, delta=0.02)
        self.assertAlmostEqual(lead[3], math.degrees(cmath.phase(exact)), delta=1.2)
        self.assertLess(lead[12], lead[6])
        self.assertLess(lead[6], lead[3])
        # The lead without thickness, of a parabola through the three.
        plain = (lead[3] * 6 * 12 / (3 * 9) - lead[6] * 3 * 12 / (3 * 6) + lead[12] * 3 * 6 / (9 * 6))
        self.assertAlmostEqual(plain, math.degrees(cmath.phase(exact)), delta=1.0)


if __name__ == "__main__":
    unittest.main()
