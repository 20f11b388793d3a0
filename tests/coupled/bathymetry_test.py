"""A chain on a bed given as a table, by the program: it rests as exact statics say, and tables and scenes that are wrong are refused by name.
SPDX-License-Identifier: Apache-2.0"""
import math
import unittest

from running import Folder, spindrift

SLOPE = 0.2  # rise per way along x
LENGTH, MASS, DIAMETER, STIFFNESS = 500.0, 200.0, 0.15, 1e9
WEIGHT = (MASS - 1025.0 * 0.25 * math.pi * DIAMETER**2) * 9.80665
FAIRLEAD, ANCHOR = (0.0, -10.0), (400.0, -60.0)  # x, z; the anchor lies above the ground below the fairlead
BED = "x_m,y_m,depth_m\n" + "".join(f"{x},{y},{60.0 - SLOPE * (x - 400.0)}\n" for x in (-100.0, 200.0, 600.0) for y in (-50.0, 50.0))
SCENE = f"""
[time]
end_s = 2.0
window_s = 0.1
step_s = 0.02
[environment]
water_depth_m = 160.0
bathymetry = "bed.csv"
[sea]
model = "morison"
[bodies.barge]
mass_kg = 1e6
inertia_kg_m2 = [1e8, 1e8, 1e8]
centre_m = [0.0, 0.0, -5.0]
[[bodies.barge.cylinders]]
name = "hull"
start_m = [0.0, 0.0, -10.0]
end_m = [0.0, 0.0, 2.0]
diameter_m = 10.0
[joints.held]
type = "fixed"
bodies = ["earth", "barge"]
point_m = [0.0, 0.0, -5.0]
[moorings.chain]
model = "lumped_mass"
body = "barge"
fairlead_m = [{FAIRLEAD[0]}, 0.0, {FAIRLEAD[1]}]
anchor_m = [{ANCHOR[0]}, 0.0, {ANCHOR[1]}]
rest_length_m = {LENGTH}
axial_stiffness_N = {STIFFNESS}
mass_kg_m = {MASS}
diameter_m = {DIAMETER}
segments = 100
"""


def laid_down_the_slope():
    """Exact statics without friction: from the anchor down the slope over a length that is found, then a catenary that leaves along the slope.
    Tension at the fairlead and at the anchor."""
    cosine, sine = 1.0 / math.hypot(1.0, SLOPE), SLOPE / math.hypot(1.0, SLOPE)

    def end(tension, laid):  # x towards the fairlead and z from the anchor to the fairlead, of the tension where the chain leaves the bed
        on_bed = laid + (tension * laid + 0.5 * WEIGHT * sine * laid**2) / STIFFNESS
        h, v0 = tension * cosine, -tension * sine
        v1, free = v0 + WEIGHT * (LENGTH - laid), LENGTH - laid
        x = h / WEIGHT * (math.asinh(v1 / h) - math.asinh(v0 / h)) + h * free / STIFFNESS
        z = (math.hypot(h, v1) - math.hypot(h, v0)) / WEIGHT + (v1**2 - v0**2) / (2.0 * WEIGHT * STIFFNESS)
        return x + on_bed * cosine, z - on_bed * sine

    want = (ANCHOR[0] - FAIRLEAD[0], FAIRLEAD[1] - ANCHOR[1])
    tension, laid = 2e5, 0.5 * LENGTH
    for _ in range(50):  # Newton, Jacobian by differences
        x, z = end(tension, laid)
        a, b = end(tension + 1.0, laid), end(tension, laid + 1e-3)
        xt, zt, xl, zl = a[0] - x, a[1] - z, (b[0] - x) / 1e-3, (b[1] - z) / 1e-3
        dx, dz, det = want[0] - x, want[1] - z, xt * zl - xl * zt
        tension += max(-0.5 * tension, min(0.5 * tension, (dx * zl - dz * xl) / det))
        laid += max(-50.0, min(50.0, (xt * dz - zt * dx) / det))
    assert math.hypot(end(tension, laid)[0] - want[0], end(tension, laid)[1] - want[1]) < 1e-9 and 0.0 < laid < LENGTH
    v1 = WEIGHT * (LENGTH - laid) - tension * sine
    return math.hypot(tension * cosine, v1), tension + WEIGHT * sine * laid


class Bathymetry(Folder):
    def write(self, scene=SCENE, bed=BED):
        (self.path / "scene.toml").write_text(scene)
        (self.path / "bed.csv").write_text(bed)

    def refused(self, *settings):
        done = spindrift("check", self.path / "scene.toml", settings=settings)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_a_chain_rests_on_a_slope_as_exact_statics_say(self):
        self.write()
        done = spindrift("run", self.path / "scene.toml", "--out", self.out, "--no-report", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        names, *rows = [line.split(",") for line in (self.out / "history.csv").read_text().splitlines()]
        fairlead, anchor = laid_down_the_slope()
        for row in (rows[0], rows[-1]):  # at rest from the start, and it stays
            self.assertLess(abs(float(row[names.index("chain.tension_N")]) / fairlead - 1.0), 0.01)
            self.assertLess(abs(float(row[names.index("chain.anchor_tension_N")]) / anchor - 1.0), 0.01)

    def test_a_flat_bed_gives_another_tension(self):  # else the test above would hold without the table
        self.write(SCENE.replace('bathymetry = "bed.csv"\n', ""))
        done = spindrift("run", self.path / "scene.toml", "--out", self.out, "--no-report", "--quiet", "--until", 0.1)
        self.assertEqual(done.returncode, 0, done.stderr)
        names, first, *_ = [line.split(",") for line in (self.out / "history.csv").read_text().splitlines()]
        self.assertGreater(abs(float(first[names.index("chain.anchor_tension_N")]) / laid_down_the_slope()[1] - 1.0), 0.05)

    def test_wrong_tables_are_refused_by_file_line_and_value(self):
        for bed, words in ((BED.replace("200.0,50.0,100.0\n", ""), ("bed.csv", "no row for x_m = 200, y_m = 50")),
                           (BED.replace("200.0,50.0,100.0", "200.0,-50.0,100.0"), ("bed.csv:5", "x_m = 200, y_m = -50 is in a row before")),
                           (BED.replace("200.0,50.0,100.0", "200.0,50.0,-100.0"), ("bed.csv:5", "depth_m = -100 must be above zero")),
                           (BED.replace("depth_m", "z_m"), ("bed.csv", "z_m")), ("", ("bed.csv",))):
            with self.subTest(words):
                self.write(bed=bed)
                said = self.refused()
                for word in ("environment.bathymetry", *words):
                    self.assertIn(word, said)

    def test_a_table_without_effect_and_lines_that_know_flat_ground_alone_are_refused(self):
        self.write()
        self.assertIn("has no effect: no line of the model lumped_mass meets the bed", self.refused("moorings.chain.bed_contact=false"))
        catenary = SCENE + SCENE.split("[moorings.chain]")[1].join(["[moorings.static]", ""]).replace(
            'model = "lumped_mass"', 'model = "catenary"').replace(f"mass_kg_m = {MASS}", f"weight_N_m = {WEIGHT}").replace(
            f"diameter_m = {DIAMETER}\n", "").replace("segments = 100\n", "")
        self.write(catenary)
        said = self.refused()
        self.assertIn("is catenary, which lies on flat ground", said)
        self.assertIn("60 to 140 m deep", said)
        self.write()
        self.assertIn("environment.bathymetry", self.refused("environment.bathymetry='nowhere.csv'"))

    def test_check_doubts_an_anchor_off_the_bed(self):
        self.write()
        good = spindrift("check", self.path / "scene.toml")
        self.assertEqual(good.returncode, 0, good.stderr)
        self.assertNotIn("chain.anchor_m", good.stdout + good.stderr)
        high = spindrift("check", self.path / "scene.toml", settings=["moorings.chain.anchor_m=[400.0, 0.0, -40.0]"])
        self.assertIn("moorings.chain.anchor_m", high.stdout + high.stderr)


if __name__ == "__main__":
    unittest.main()
