"""What a resolved rotor has by default: a scene with nothing but the turbine, the wind and the operating point is the scene whose figures are in
docs/verification/rotor.md, alone and on a platform. Usage: rotor_defaults_test.py SPINDRIFT"""
import json
import re
import tomllib
import unittest

from running import DTU_IN_WIND, Folder, ROOT, spindrift

ROTOR = """
[time]
end_s = %s
window_s = %s
""" + DTU_IN_WIND + """%s
[aero]
model = "blade_resolved"
[aero.grid]
[aero.flow]
"""
ALONE = ROTOR % (2.0, 1.0, "hub_m = [0.0, 0.0, 119.0]\nspeed_rpm = 8.836")
CARRIED = 'base = "%s/inputs/leble_barakos/platform.toml"\n' % ROOT + ROTOR % (0.04, 0.02, "") + '[sea]\nmodel = "hydrostatic"\n'


class Defaults(Folder):
    def run_text(self, text, *settings, code=0):
        scene = self.path / "scene.toml"
        scene.write_text(text)
        done = spindrift("run", scene, "--out", self.out, "--overwrite", "--no-report", settings=settings)
        self.said = done.stdout + done.stderr
        self.assertEqual(done.returncode, code, self.said)
        return tomllib.loads((self.out / "scene.toml").read_text()), json.loads((self.out / "summary.json").read_text())

    def as_run(self, text, *settings):
        """[aero.grid] and [aero.flow] of a short run."""
        scene = self.run_text(text, *settings, "aero.flow.drop=0.0")[0]
        return scene["aero"]["grid"], scene["aero"]["flow"]

    def test_a_rotor_alone_has_the_grid_and_the_march_of_the_verified_one(self):
        scene, summary = self.run_text(ALONE, "aero.flow.drop=0.0")   # takes its two pseudo-steps
        self.assertEqual(summary["counts"]["cells"], 18168)
        self.assertNotIn("y+", self.said)
        self.assertEqual(summary["numerical_trouble"], [])
        (self.path / "demo.toml").write_text('base = "%s/inputs/leble_barakos/rotor_demo.toml"\n[time]\nend_s = 2.0\n[output]\nexpected = []\n' % ROOT)
        demo = tomllib.loads(self.demo_echo())
        self.assertEqual(scene["aero"], demo["aero"])

    def demo_echo(self):
        out = self.path / "demo"
        done = spindrift("run", self.path / "demo.toml", "--out", out, "--no-report", "--quiet", settings=["aero.flow.drop=0.0"])
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return (out / "scene.toml").read_text()

    def test_walls_are_treated_as_their_cells_want(self):
        for settings, blades in (([], "wall_function"), (["aero.grid.y_plus=100.0"], "wall_function"), (["aero.grid.y_plus=1.0"], "no_slip"),
                                 (["aero.grid.first_cell_m=1e-5"], "no_slip"), (["aero.flow.turbulence=none"], "no_slip"), (["aero.flow.viscous=none"], "no_slip"),
                                 (["aero.flow.blades=no_slip", "aero.grid.y_plus=4.0"], "no_slip")):
            with self.subTest(settings=settings):
                self.assertEqual(self.as_run(ALONE, "time.end_s=1.0", *settings)[1]["blades"], blades)

    def test_first_cells_by_y_plus_are_those_of_the_air_of_the_scene(self):
        thick = ["time.end_s=1.0", "aero.grid.y_plus=50.0", "aero.flow.viscosity_Pa_s=1.8e-4"]
        self.assertAlmostEqual(self.as_run(ALONE, *thick)[0]["kinematic_viscosity_m2_s"], 1.8e-4 / 1.225, delta=1e-16)
        self.assertEqual(self.as_run(ALONE, *thick, "aero.grid.kinematic_viscosity_m2_s=2e-5")[0]["kinematic_viscosity_m2_s"], 2e-5)
        (self.path / "scene.toml").write_text(ALONE)
        for viscosity in ("1.8e-5", "1.8e-4"):
            done = spindrift("check", self.path / "scene.toml", settings=["aero.grid.y_plus=50.0", f"aero.flow.viscosity_Pa_s={viscosity}"])
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            found = re.search(r"by the law of the wall +([0-9.]+) in the middle", done.stdout)
            self.assertAlmostEqual(float(found[1]), 51.0, delta=2.0, msg=done.stdout)

    def test_keys_that_are_given_stay_and_what_depends_on_a_default_goes_with_it(self):
        grid, flow = self.as_run(ALONE, "time.end_s=1.0", "aero.flow.group_cells=4", "aero.flow.cfl=3.0", "aero.grid.cells_layers=9")
        self.assertEqual((flow["preconditioner"], flow["group_cells"], flow["cfl"], flow["cfl_max"], grid["cells_layers"], grid["sectors"]), ("coarse", 4, 3.0, 1000.0, 9, "one"))
        self.assertEqual(self.as_run(ALONE, "time.end_s=1.0", "aero.flow.preconditioner=block_ilu")[1]["preconditioner"], "block_ilu")

    def test_a_rotor_on_bodies_has_the_same_grid_and_steps_in_time(self):
        scene = self.run_text(CARRIED, "aero.flow.max_pseudo_steps=2", "aero.flow.unconverged_share=1.0")[0]
        flow = scene["aero"]["flow"]
        self.assertEqual((flow["time"], flow["drop"], scene["aero"]["grid"]["sectors"], flow["blades"]), ("bdf2", 1e-3, "one", "wall_function"))
        self.assertIn("18168 cells", self.said)
        self.assertNotIn("y+", self.said)

    def test_wind_of_a_table_counts_as_that_of_the_scene(self):
        (self.path / "wind.csv").write_text("time_s,speed_m_s,direction_deg\n0,11,10\n10,12,10\n")
        (self.path / "scene.toml").write_text(CARRIED.replace("speed_m_s = 11.0", 'table = "wind.csv"'))
        done = spindrift("check", self.path / "scene.toml")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("in 3 sectors", done.stdout)

    def test_all_blades_are_in_the_grid_where_they_differ(self):
        scene = self.path / "scene.toml"
        scene.write_text(CARRIED)
        for settings, sectors in (([], "1 sector"), (["wind.direction_deg=10.0"], "3 sectors"), (["wind.profile=power_law", "wind.reference_height_m=119.0"], "3 sectors"),
                                  (["wind.event={what='ews_vertical'}"], "3 sectors"), (["wind.event={what='eog'}"], "1 sector"), (["wind.direction_deg=10.0", "aero.grid.sectors=all"], "3 sectors")):
            with self.subTest(settings=settings):
                done = spindrift("check", scene, settings=settings)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertIn(f"in {sectors}", done.stdout)
        refused = spindrift("check", scene, settings=["wind.direction_deg=10.0", "aero.grid.sectors=one"])
        self.assertEqual(refused.returncode, 2)
        self.assertIn('take "all"', refused.stdout + refused.stderr)

    def test_a_mistake_is_told_where_it_is_and_no_default_beside_it(self):
        scene = self.path / "scene.toml"
        for settings, words in ((["aero.flow.turbulence=magic"], "aero.flow.turbulence"), (["rotor.turbine=nothing.toml"], "rotor.turbine"), (["aero.flow=3"], "aero.flow")):
            with self.subTest(settings=settings):
                scene.write_text(ALONE)
                done = spindrift("check", scene, settings=settings)
                self.assertEqual(done.returncode, 2)
                self.assertIn(words, done.stdout + done.stderr)
                self.assertNotIn("defaults of the program", done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
