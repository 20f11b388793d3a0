"""Half a sea of particles beside a plane of symmetry against the whole one: what lifts a held float, a float let go in waves, the bits of a restart and of
ranks, energies, columns of what holds the bodies, and the choice that `check --columns` offers. Usage: symmetric_half_test.py SPINDRIFT [TEST...]
SPDX-License-Identifier: Apache-2.0"""
import re
import unittest

import numpy as np

from running import Runs, columns, spindrift

HALF = ["sea.tank.y_m=[0.0, 1.2]", "sea.tank.sides_y=symmetric"]
# A box and a sphere in one body, 0.8 m long, that floats 0.2 m deep; waves of linear theory as long as the tank, which repeats.
SCENE = """
[time]
end_s = 1.0
window_s = 0.02
[environment]
gravity_m_s2 = 9.81
water_density_kg_m3 = 1000.0
water_depth_m = 0.8
[sea]
model = "sph"
[sea.particles]
spacing_m = 0.1
[sea.tank]
x_m = [-2.0, 2.0]
y_m = [-1.2, 1.2]
top_m = 0.6
sides_x = "periodic"
[[sea.gauges]]
name = "beside"
point_m = [1.0, 0.05]
[bodies.float]
mass_kg = 96.0
inertia_kg_m2 = [4.0, 6.0, 8.0]
centre_m = [0.0, 0.0, 0.05]
displacement_m = [0.0, 0.0, 0.06]
[[bodies.float.boxes]]
name = "hull"
centre_m = [0.0, 0.0, 0.0]
size_m = [0.8, 0.6, 0.4]
"""
WAVES = ["waves.model=airy", "waves.height_m=0.08", "waves.period_s=1.8116", "sea.initial.state=waves"]
HELD = ["joints.clamp={type='fixed', bodies=['float', 'earth'], point_m=[0.0, 0.0, 0.0]}", "bodies.float.displacement_m=[0.0, 0.0, 0.0]",
        "sea.initial.settle_s=1.0", "sea.initial.settle_damping_1_s=5.0", "time.end_s=0.5"]
LINES = [f"moorings.{name}={{body='float', fairlead_m=[{x}, {y}, 0.0], anchor_m=[{2 * x}, {3 * y}, -0.8], rest_length_m=1.0, stiffness_N_m=100.0}}"
         for name, x, y in (("bow", 0.4, 0.3), ("bow_other", 0.4, -0.3), ("stern", -0.4, 0.3), ("stern_other", -0.4, -0.3))]


class Half(Runs):
    def columns(self, name, settings, **more):
        self.run_scene(SCENE, name, settings=settings, **more)
        return columns(self.path / name / "history.csv")

    def test_a_held_float_is_lifted_as_by_archimedes(self):
        for shape in ([], ["bodies.float.boxes=[]", "bodies.float.spheres=[{name='hull', centre_m=[0.0, 0.0, 0.0], diameter_m=0.8}]"]):
            own, half = (self.columns(f"{name}_{len(shape)}", HELD + shape + more) for name, more in (("own", []), ("half", HALF)))
            late = own["time_s"] > 0.0
            lift = 9810.0 * (0.8 * 0.6 * 0.2 if not shape else 2.0 / 3.0 * np.pi * 0.4**3)
            found = half["float.sea.fz_N"][late].mean()
            print(f"lift over Archimedes': half {found / lift:.4f}, whole {own['float.sea.fz_N'][late].mean() / lift:.4f}", flush=True)
            self.assertAlmostEqual(found, lift, delta=0.01 * lift)
            # Boxes have their particles at the same places: 1e-8. Balls of four to the radius have not: 0.6 % below the formula, the whole 0.5 % above.
            self.assertAlmostEqual(found, own["float.sea.fz_N"][late].mean(), delta=0.015 * lift if shape else 1e-5 * lift)
            self.assertLess(abs(half["float.sea.fx_N"][late].mean()), 0.01 * lift)
            for lost in ("fy_N", "mx_N_m", "mz_N_m"):
                self.assertEqual(np.abs(half[f"float.sea.{lost}"]).max(), 0.0)

    def test_a_float_in_waves_moves_as_in_the_whole_sea(self):
        own, half = (self.columns(name, WAVES + LINES + more) for name, more in (("own", []), ("half", HALF)))
        for column in ("float.z_m", "float.x_m", "float.pitch_deg", "beside.elevation_m"):
            span = np.ptp(own[column])
            difference = np.std(half[column] - own[column]) / span
            print(f"{column}: half and whole differ by {difference:.4f} of the span", flush=True)
            # Over starts jittered by a hundredth of the spacing 0.015 to 0.030 of the pitch, 0.0012 to 0.005 of the others: the water that the
            # float puts aside is laid out beside each half by itself.
            self.assertLess(difference, 0.045 if column == "float.pitch_deg" else 0.01, column)
        for column in ("sea.mass_kg", "sea.kinetic_energy_J", "sea.potential_energy_J"):   # of both halves
            self.assertAlmostEqual(half[column][-1] / own[column][-1], 1.0, delta=0.01)
        for lost in ("y_m", "roll_deg", "yaw_deg"):
            self.assertLess(np.abs(half[f"float.{lost}"]).max(), 1e-12)

    def test_threads_ranks_and_restarts_leave_every_bit_as_it_is(self):
        settings = WAVES + LINES + HALF + ["time.end_s=0.1"]
        self.run_scene(SCENE, "one", settings=settings)
        for name, more in (("threads", {"threads": 2}), ("ranks", {"ranks": 2})):
            self.run_scene(SCENE, name, settings=settings, **more)
            self.assertEqual(self.text(name), self.text("one"), name)
        self.run_scene(SCENE, "parts", "--until", "0.04", settings=settings)
        self.run_scene(SCENE, "parts", "--restart", settings=settings)
        self.assertEqual(self.text("parts"), self.text("one"))
        said = self.run_scene(SCENE, "parts", "--restart", settings=[s for s in settings if s not in HALF], code=2)
        self.assertIn("sea.tank.sides_y", said)

    def test_the_joint_of_the_plane_bears_what_would_push_the_float_out(self):
        """A force along y and a moment about x, which the whole float would give way to."""
        push = ["bodies.float.forces=[{point_m=[0.0, 0.0, 0.05], force_N=[0.0, 7.0, 0.0], moment_N_m=[2.0, 0.0, 0.0]}]", "time.end_s=0.1"]
        half = self.columns("half", HALF + push)
        self.assertLess(np.abs(half["symmetry_float.fy_N"] + 7.0).max(), 1e-9)
        self.assertLess(np.abs(half["symmetry_float.mx_N_m"] + 2.0).max(), 1e-9)
        self.assertLess(np.abs(half["symmetry_float.fz_N"]).max(), 1e-9)
        self.assertLess(np.abs(half["float.y_m"]).max(), 1e-12)

    def test_check_offers_the_half_with_its_saving_and_effect(self):
        scene = self.path / "scene.toml"
        scene.write_text(SCENE)
        settings = WAVES + LINES + ["time.end_s=0.2"]
        said = spindrift("check", scene, "--columns", "float.z_m,float.roll_deg", "--trial-s", "600", settings=settings)
        self.assertEqual(said.returncode, 0, said.stderr)
        found = re.search(r"  symmetric half +saves (\d+) % .*--set 'sea.tank.y_m=\[0,1.2\]' --set sea.tank.sides_y=symmetric\n"
                          r" +bodies stay in the plane: sway, roll and yaw are lost\n +float.z_m: mean (\S+), deviation (\S+)\n", said.stdout)
        self.assertIsNotNone(found, said.stdout)
        self.assertGreater(int(found.group(1)), 30)
        for name, more in (("own", []), ("half", HALF)):
            self.run_scene(SCENE, name, settings=settings + more)
        own, half = (columns(self.path / name / "history.csv") for name in ("own", "half"))
        late = own["time_s"] >= 0.2 / 3.0
        change = np.trapz((half["float.z_m"] - own["float.z_m"])[late], own["time_s"][late]) / np.ptp(own["time_s"][late])
        self.assertAlmostEqual(float(found.group(2)), change, delta=0.05 * abs(change) + 1e-9)

    def test_what_is_not_symmetrical_is_not_offered(self):
        scene = self.path / "scene.toml"
        scene.write_text(SCENE)
        for change in ("sea.gauges[0].point_m=[1.0, -0.2]", "bodies.float.boxes[0].centre_m=[0.0, 0.1, 0.0]", "sea.tank.y_m=[-1.2, 1.3]",
                       "sea.tank.sides_y=periodic", LINES[0], "bodies.float.velocity_m_s=[0.0, 0.1, 0.0]"):
            said = spindrift("check", scene, "--columns", "float.z_m", "--trial-s", "1", settings=[change, "time.end_s=60.0"])
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertIn("not tried", said.stdout)
            self.assertNotIn("symmetric", said.stdout, change)
        said = spindrift("check", scene, "--columns", "float.z_m", "--trial-s", "1", settings=["time.end_s=60.0"])
        self.assertIn("[variants.symmetric_half]", said.stdout)


if __name__ == "__main__":
    unittest.main()
