"""A wedge driven into water beside the self-similar solution: inputs/validation/wedge_entry as a user runs it, with no setting of the sea but the spacing.
Usage: wedge_test.py SPINDRIFT Fast|Nightly. SPDX-License-Identifier: Apache-2.0"""
import csv
import math
import os
import unittest

from running import Folder, ROOT, spindrift, starts

DENSITY, GRAVITY, HALF_WIDTH, APEX = 1000.0, 9.81, 0.5, 0.01
# Zhao & Faltinsen (1993), J. Fluid Mech. 246, 593, table 2: force per width over rho V^3 t, by deadrise in degrees.
FORCE = {20: 42.485, 30: 14.139, 40: 5.477}


class Wedge(Folder):
    def force_over_theory(self, deadrise, speed, spacing, start):
        """Mean force, less buoyancy, while the wetted half width of Wagner's theory is between a quarter of the wedge's and the whole of it: sound that
        runs between wedge and bed makes a single value swing by a third at the scene's spacing."""
        slope = math.tan(math.radians(deadrise))
        end = 2.0 / math.pi * HALF_WIDTH * slope / speed
        done = spindrift("run", ROOT / "inputs/validation/wedge_entry/wedge_entry.toml", "--out", self.out, "--overwrite", "--no-report", "--quiet",
                         settings=[f"bodies.wedge.cylinders[0].start_m=[0.0, 0.0, {APEX + HALF_WIDTH * slope}]", f"sea.particles.spacing_m={spacing}",
                                   f"bodies.wedge.velocity_m_s=[0.0, 0.0, {-speed}]", f"joints.rail.translation.speed_m_s={-speed}",
                                   f"time.window_s={end / 80}", f"time.end_s={end / 80 * 88}", *start],
                         timeout=3600, env={**os.environ, "OMP_NUM_THREADS": "1"})
        self.assertEqual(done.returncode, 0, done.stderr)
        force = theory = 0.0
        with open(self.out / "history.csv") as file:
            for row in csv.DictReader(file):
                depth = -float(row["wedge.z_m"]) - APEX
                if 0.25 * HALF_WIDTH < 0.5 * math.pi * depth / slope < HALF_WIDTH:
                    force += float(row["wedge.sea.fz_N"]) - DENSITY * GRAVITY * depth**2 / slope
                    theory += FORCE[deadrise] * DENSITY * speed**2 * depth
        print(f"{deadrise} degrees, {speed} m/s, {spacing} m: {force / theory:.3f} of the theory's force", flush=True)
        return force / theory


class Fast(Wedge):
    def test_a_wedge_that_enters_water_meets_the_force_of_the_similarity_solution(self):
        for start in starts():   # six jittered starts: 0.973 to 1.017
            self.assertAlmostEqual(self.force_over_theory(30, 4.0, 0.02, start), 1.0, delta=0.10)


class Nightly(Wedge):
    def test_so_do_blunter_sharper_and_faster_ones_and_finer_particles(self):
        # Four jittered starts: 0.931 to 0.982, 0.928 to 0.998, 0.941 to 1.026; of fine particles 0.973 to 0.985. So coarse ones are judged by the mean of three.
        for deadrise, speed, spacing, count in ((20, 4.0, 0.02, 3), (40, 4.0, 0.02, 3), (30, 10.0, 0.02, 3), (30, 4.0, 0.01, 1)):
            with self.subTest(deadrise=deadrise, speed=speed, spacing=spacing):
                found = [self.force_over_theory(deadrise, speed, spacing, start) for start in starts(count)]
                self.assertAlmostEqual(sum(found) / count, 1.0, delta=0.10)


if __name__ == "__main__":
    unittest.main()
