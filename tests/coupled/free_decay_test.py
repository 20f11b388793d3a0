"""Heave decay of bodies afloat in 3-D beside linear theory: inputs/validation/free_sphere and free_cylinder as a user runs them.
Usage: free_decay_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import csv
import os
import unittest

from running import Folder, REPLICA, ROOT, spindrift

# Times [s] and heights (over the start's) of the first turns: Fourier integral of the transfer function of a body let go from rest.
# Sphere: added mass and damping of Hulme (1982), J. Fluid Mech. 121, table 2, deep water. Cylinder: those of Yeung (1981), Appl. Ocean
# Res. 3, by matched eigenfunctions for a draft of one radius in a depth of three.
SPHERE = [(0.989, -0.867), (1.976, 0.635), (2.950, -0.465)]
CYLINDER = [(1.257, -0.924), (2.502, 0.809)]


def turns(t, z):
    """Where z turns after t = 0, by parabolas through three rows."""
    found = []
    for k in range(1, len(t) - 1):
        before, after = z[k] - z[k - 1], z[k + 1] - z[k]
        if t[k] > 0.1 and before * after <= 0.0 and before != after:
            s = 0.5 * (before + after) / (before - after)
            found.append((t[k] + s * (t[k + 1] - t[k]), z[k] + 0.25 * s * (before + after)))
    return found


def times_and_ways(start, found):
    heights = [start] + [z for _, z in found]
    ways = [abs(b - a) for a, b in zip(heights, heights[1:])]
    return [t for t, _ in found], [way / ways[0] for way in ways]


class FreeDecay(Folder):
    def decay(self, name, body):
        """Times of the turns, and the ways between them over the first fall. What is displaced too much at the waterline, and the level of
        the tank, move the rest and not these."""
        done = spindrift("run", ROOT / f"inputs/validation/{name}/{name}.toml", "--out", self.out, "--no-report", "--quiet", settings=REPLICA, timeout=3600,
                         env={**os.environ, "OMP_NUM_THREADS": "1"})
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.out / "history.csv") as file:
            rows = [(float(row["time_s"]), float(row[f"{body}.z_m"])) for row in csv.DictReader(file)]
        rows = [row for row in rows if row[0] >= 0.0]
        times, ways = times_and_ways(rows[0][1], turns(*zip(*rows)))
        print(f"{name}: turns at", " ".join(f"{t:.4f}" for t in times), "s, ways", " ".join(f"{way:.4f}" for way in ways), flush=True)
        return times, ways

    def test_a_sphere_swings_with_the_period_and_damping_of_linear_theory(self):
        times, ways = self.decay("free_sphere", "sphere")
        theory_times, theory_ways = times_and_ways(1.0, SPHERE)
        self.assertEqual(len(times), 3)
        for n in range(3):
            self.assertAlmostEqual(times[n] / theory_times[n], 1.0, delta=0.03)
            self.assertAlmostEqual(ways[n] / theory_ways[n], 1.0, delta=0.08)

    def test_an_upright_cylinder_swings_with_the_period_of_linear_theory(self):
        times, ways = self.decay("free_cylinder", "cylinder")
        theory_times, theory_ways = times_and_ways(1.0, CYLINDER)
        self.assertAlmostEqual(ways[1] / theory_ways[1], 1.0, delta=0.12)  # a tenth short, of the tank's own theory an eighth: docs/developer/notes/sea_scenes.md
        for n in range(2):
            self.assertAlmostEqual(times[n] / theory_times[n], 1.0, delta=0.03)


if __name__ == "__main__":
    unittest.main()
