"""A spar on catenary lines in an irregular sea starts from the equilibrium under its mean loads, whatever the seed: the lines' tensions and the heave of the
first row are those that `check` states, and its mean tension over the run stays there. Under the thrust of a turbine the equilibrium is found however far away:
there all loads of the run's first row balance. Scene: the OC3 spar of inputs/tutorials.
SPDX-License-Identifier: Apache-2.0"""
import re
import unittest

from running import Folder, ROOT, rows, spindrift

SCENE = ROOT / "inputs/tutorials/spar_in_waves.toml"
SEA = ["start.equilibrium=true", "waves.model=jonswap", "waves.height_m=6.0", "waves.period_s=10.0"]
LINES = ("line_1", "line_2", "line_3")
WITHIN = 0.01


class Equilibrium(Folder):
    def rows(self, seed, until):
        return self.rows_of([*SEA, f"waves.seed={seed}"], until)

    def rows_of(self, settings, until):
        done = spindrift("run", SCENE, "--out", self.out, "--overwrite", "--no-report", "--quiet", "--until", until, settings=settings)
        self.assertEqual(done.returncode, 0, done.stderr)
        return rows(self.out / "history.csv")

    def test_twenty_seeds_start_from_the_equilibrium_under_the_mean_loads(self):
        said = spindrift("check", SCENE, settings=SEA).stdout
        heave = float(re.search(r"^  spar .* z (\S+) m", said, re.M).group(1))
        tension = {line: 1e3 * float(re.search(rf"^  {line} +tension (\S+) kN", said, re.M).group(1)) for line in LINES}
        draft = 120.0
        for seed in range(1, 21):
            with self.subTest(seed=seed):
                first = self.rows(seed, 0.25)[0]
                self.assertLess(abs(first["spar.z_m"] - heave), 1e-4 * draft)
                for line in LINES:
                    self.assertLess(abs(first[f"{line}.tension_N"] / tension[line] - 1.0), WITHIN)

    def test_twenty_metres_and_more_away_the_lines_take_the_thrust(self):
        for thrust, least in ((800e3, 20.0), (1.2e6, 25.0)):
            with self.subTest(thrust=thrust):
                settings = ['without=["waves"]', "start.equilibrium=true", f"bodies.spar.forces=[{{point_m=[0.0, 0.0, 90.0], force_N=[{thrust}, 0.0, 0.0]}}]"]
                first = self.rows_of(settings, 0.25)[0]
                self.assertGreater(first["spar.x_m"], least)
                self.assertLess(abs(first["spar.moorings.fx_N"] / -thrust - 1.0), 1e-6)
                gravity = 9.80665
                for acceleration in ("ax_m_s2", "ay_m_s2", "az_m_s2"):
                    self.assertLess(abs(first[f"spar.{acceleration}"]), 1e-7 * gravity)
                self.assertLess(abs(first["spar.awy_rad_s2"]), 1e-7 * gravity / 120.0)

    def test_the_mean_tension_stays_at_that_of_the_start(self):
        rows = self.rows(1, 200.0)
        for line in LINES:
            tensions = [row[f"{line}.tension_N"] for row in rows]
            self.assertLess(abs(sum(tensions) / len(tensions) / tensions[0] - 1.0), WITHIN)
            self.assertGreater(max(tensions) / tensions[0] - 1.0, WITHIN)  # waves do move it


if __name__ == "__main__":
    unittest.main()
