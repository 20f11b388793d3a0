"""Bodies in a sea of two dimensions stay in its plane whatever pulls them out of it: what holds them has columns, bits are those of a restart and of ranks,
and their work on the water is the water's on them.
Usage: planar_sea_test.py SPINDRIFT [TEST...] SPDX-License-Identifier: Apache-2.0"""
import json
import unittest

import h5py

from running import ROOT, Folder, columns, spindrift

SCENE = ROOT / "inputs/validation/floating_box/floating_box.toml"
SHORT = ["time.end_s=0.4", "sea.initial.settle_s=0.1", "sea.particles.spacing_m=0.05"]
BEACH = ["time.end_s=3.0", "time.window_s=0.01", "sea.particles.spacing_m=0.015", "sea.tank.x_m=[0.0, 6.0]", "sea.tank.bed_m=[[0.0, -0.3], [6.0, 0.0]]",
         "sea.water=[{low_m=[4.5, -1.0, -0.3], high_m=[4.53, 1.0, -0.045]}]"]   # four particles on a dry slope of 1:20
ACROSS = ["bodies.box.forces=[{point_m=[0.1, 0.2, 0.1], force_N=[0.0, 50.0, 20.0], moment_N_m=[3.0, 0.0, 4.0]}]"]


BODY = """
[bodies.{name}]
mass_kg = {mass}
inertia_kg_m2 = [1.0, 1.0, 1.0]
centre_m = [{x}, 0.0, -0.5]
[[bodies.{name}.boxes]]
name = "hull"
centre_m = [{x}, 0.0, -0.5]
size_m = [0.3, 1.0, 0.2]
"""
TANK = """
[time]
end_s = 2.5
window_s = 0.02
[environment]
gravity_m_s2 = 9.81
water_density_kg_m3 = 1000.0
water_depth_m = {depth}
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 0.05
[sea.tank]
x_m = [-2.0, 2.0]
top_m = 0.3
"""
DRIVEN = """
[joints.rail]
type = "translational"
bodies = ["earth", "paddle"]
point_m = [0.0, 0.0, 0.0]
axis = [1.0, 0.0, 0.0]
{driver}
"""


class Planar(Folder):
    def check(self, text):
        scene = self.path / "scene.toml"
        scene.write_text(text)
        said = spindrift("check", scene)
        self.assertEqual(said.returncode, 0, said.stderr)
        return said.stdout

    def test_modes_of_round_off_are_none_and_no_step_follows_from_them(self):
        said = self.check(TANK.format(depth=1.0) + "".join(BODY.format(name=name, mass=mass, x=x) for name, mass, x in (("heavy", 120.0, -1.2), ("neutral", 60.0, 0.0), ("light", 30.0, 1.2))))
        modes = said.partition("Modes about the start\n")[2].partition("\n\n")[0]
        self.assertIn("9 of 9 freedoms without stiffness", modes)
        self.assertNotIn("period ", modes)
        self.assertNotIn("rate ", modes)
        self.assertRegex(said, r"rk4 +any\n")

    def test_a_paddle_on_a_driven_joint_has_no_modes_and_need_not_be_carried(self):
        paddle = TANK.format(depth=0.61) + BODY.format(name="paddle", mass=100.0, x=0.0)
        said = self.check(paddle + DRIVEN.format(driver="[joints.rail.translation]\namplitude_m = 0.1\nperiod_s = 1.0"))
        self.assertNotIn("Modes about", said)
        self.assertNotIn("nothing carries it", said)
        self.assertIn("nothing carries it", self.check(paddle))

    def run_scene(self, name, *more, settings, ranks=0):
        done = spindrift("run", SCENE, "--out", self.path / name, "--quiet", "--no-report", *more, settings=[*SHORT, *settings], ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stderr)
        return columns(self.path / name / "history.csv")

    def test_loads_out_of_the_plane_move_nothing_and_are_the_reaction(self):
        found = self.run_scene("across", settings=ACROSS)
        for lost in ("y_m", "roll_deg", "yaw_deg"):
            self.assertLess(abs(found[f"box.{lost}"]).max(), 1e-12, lost)
        self.assertGreater(abs(found["box.z_m"] - found["box.z_m"][0]).max(), 0.005)
        self.assertAlmostEqual(abs(found["plane_box.fy_N"][-1]), 50.0, delta=0.5)
        sound = json.loads((self.path / "across/summary.json").read_text())["sound_speed_m_s"]  # by which the report takes means of impacts
        self.assertAlmostEqual(sound, 10.0 * (9.81 * 0.6) ** 0.5, delta=1e-9)
        for part in ("one", "two"):
            self.assertEqual((self.path / "across/history.csv").read_bytes(), self.again(part), part)
        made = {part: self.made_J(part) for part in ("across", "one", "two")}  # what a later window is judged by
        self.assertNotEqual(made["across"], 0.0)
        self.assertEqual(set(made.values()), {made["across"]}, made)

    def made_J(self, name):
        with h5py.File(max((self.path / name / "checkpoints").glob("*.h5"))) as file:
            return file["sea/made_J"][0]

    def test_a_field_that_could_not_be_written_beside_its_checkpoint_is_there_after_a_restart(self):
        settings = ["checkpoint.interval_s=0.1", "sea.fields={interval_s=0.1, surface_spacing_m=0.1}"]
        self.run_scene("whole", settings=settings)
        names = sorted(path.name for path in (self.path / "whole/fields").glob("surface_*.h5"))
        self.assertEqual(len(names), 5)
        self.run_scene("run", "--until", 0.1, settings=settings)
        in_the_way = self.path / "run/fields" / names[2]
        in_the_way.mkdir()
        stopped = spindrift("run", SCENE, "--out", self.path / "run", "--quiet", "--no-report", "--restart", settings=[*SHORT, *settings])
        self.assertEqual(stopped.returncode, 4, stopped.stderr)
        in_the_way.rmdir()
        self.run_scene("run", "--restart", settings=settings)
        self.assertEqual(*((self.path / name / "fields/surface.xdmf").read_text() for name in ("whole", "run")))

    def again(self, part):
        if part == "one":
            self.run_scene(part, "--until", 0.2, settings=ACROSS)
            self.run_scene(part, "--restart", settings=ACROSS)
        else:
            self.run_scene(part, settings=ACROSS, ranks=2)
        return (self.path / part / "history.csv").read_bytes()

    def test_a_body_that_a_joint_keeps_in_the_plane_needs_no_other(self):
        rail = "joints.rail={type='translational', bodies=['earth', 'box'], point_m=[0.0, 0.0, 0.0], axis=[0.0, 0.0, 1.0]}"
        found = self.run_scene("rail", settings=[*ACROSS, rail])
        self.assertNotIn("plane_box.fy_N", found)

    def test_what_a_dropped_body_works_on_the_water_is_what_the_water_works_on_it(self):
        for step in ("symplectic", "verlet"):
            with self.subTest(step):
                found = self.run_scene(step, "--overwrite", settings=["sea.initial.settle_s=0.0", "sea.initial.settle_damping_1_s=0.0", "bodies.box.mass_kg=30.0",
                                                                      "bodies.box.displacement_m=[0.0, 0.0, 0.3]", "bodies.box.velocity_m_s=[0.0, 0.0, -3.0]",
                                                                      f"sea.particles.step={step}"])
                self.assertAlmostEqual(found["sea.work_of_solids_J"][-1] / -found["energy.sea.work_J"][-1], 1.0, delta=2e-3)   # by the end's velocity: 0.98

    def test_a_sensor_on_the_paddle_has_the_force_of_one_on_a_wall(self):
        patches = ", ".join(f"{{name='{name}', low_m=[{x}, 0.0, -0.5], high_m=[{x}, 0.0, -0.1]}}" for name, x in (("paddle", -1.0), ("wall", 1.0)))
        found = self.run_scene("paddle", settings=["waves.model=airy", "waves.height_m=0.02", "waves.period_s=1.0", "sea.wavemaker.type=piston",
                                                   f"sea.sensors=[{patches}]", "time.end_s=0.1"])
        self.assertGreater(found["wall.fx_N"][-1], 100.0)
        self.assertAlmostEqual(found["paddle.fx_N"][-1] / -found["wall.fx_N"][-1], 1.0, delta=0.1)

    def test_lone_water_on_a_wall_makes_no_energy(self):
        """Particles that slide down a beach, with no water about them whose viscosity would calm them: they bounced ever higher."""
        scene = self.path / "lone.toml"
        scene.write_text(TANK.format(depth=0.3))
        done = spindrift("run", scene, "--out", self.path / "lone", "--quiet", "--no-report", settings=BEACH)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = columns(self.path / "lone/history.csv")
        energy = sum(found[f"sea.{kind}_energy_J"] for kind in ("kinetic", "potential", "compression"))
        self.assertLess((energy - energy[0]).max(), 0.02 * abs(energy[0]))
        self.assertGreater(found["sea.dissipated_J"][-1], -0.02 * abs(energy[0]))

    def test_drops_that_lie_still_are_not_stopped_for_microjoules(self):
        scene = self.path / "lone.toml"
        scene.write_text(TANK.format(depth=0.3))
        for walls in ("dynamic", "extrapolated_no_slip"):
            with self.subTest(walls):
                done = spindrift("run", scene, "--out", self.path / walls, "--quiet", "--no-report", settings=[*BEACH, f"sea.particles.walls={walls}"])
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_sound_is_twenty_times_the_speed_of_a_fall_on_a_rail_to_low_water(self):
        said = spindrift("check", SCENE.parents[1] / "cylinder_drop/cylinder_drop.toml",
                         settings=["sea.water=[{low_m=[-0.6, -1.0, -0.3], high_m=[0.6, 1.0, -0.1]}]",
                                   "joints.rail={type='translational', bodies=['earth', 'cylinder'], point_m=[0.0, 0.0, 0.055], axis=[0.0, 0.0, 1.0]}",
                                   "sea.particles.spacing_m=0.01", "bodies.cylinder.displacement_m=[0.0, 0.0, 0.2]"]).stdout
        self.assertIn(f"20 times the {(2.955 ** 2 + 2.0 * 9.81 * (0.2 + 0.1)) ** 0.5:.3g} m/s", said)

    def test_check_prints_the_modes_of_the_plane_alone(self):
        said = spindrift("check", SCENE).stdout
        self.assertIn("of 3 freedoms without stiffness", said)
        for lost in ("roll of", "yaw of", "sway of"):
            self.assertNotIn(lost, said)


if __name__ == "__main__":
    unittest.main()
