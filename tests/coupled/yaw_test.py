"""A nacelle that a yaw drive turns into the wind, by the program: it starts, stops and holds as asked, on land and afloat, goes on from a checkpoint with the
same bits, and what a scene may not ask of it is refused by name. SPDX-License-Identifier: Apache-2.0"""
import unittest

import numpy

from running import columns, Folder, ROOT, spindrift

TURBINE = ROOT / "inputs/turbines/dtu_10mw.toml"
SCENE = f"""
[time]
end_s = 120.0
window_s = 0.1
step_s = 0.05
[wind]
table = "wind.csv"
[aero]
model = "bem"
[rotor]
turbine = "{TURBINE}"
body = "nacelle"
hub_m = [-7.1, 0.0, 119.0]
speed_rpm = 8.0
[bodies.tower]
mass_kg = 6e5
inertia_kg_m2 = [6e8, 6e8, 1e7]
centre_m = [0.0, 0.0, 60.0]
[bodies.nacelle]
mass_kg = 674000.0
inertia_kg_m2 = [1.7e8, 1.1e8, 1.1e8]
centre_m = [-0.6, 0.0, 118.4]
[joints.foot]
type = "fixed"
bodies = ["earth", "tower"]
point_m = [0.0, 0.0, 0.0]
[joints.yaw_bearing]
type = "revolute"
bodies = ["tower", "nacelle"]
point_m = [0.0, 0.0, 115.6]
axis = [0.0, 0.0, 1.0]
[control.yaw]
joint = "yaw_bearing"
start_error_deg = 8.0
stop_error_deg = 0.5
delay_s = 10.0
filter_time_s = 5.0
rate_deg_s = 0.5
stiffness_N_m_rad = 2e10
damping_N_m_s_rad = 2e9
"""
SPRING, DAMPER, INERTIA = 1e8, 1e7, 2.4e8   # that hold the spar in yaw, and its own
AFLOAT = SCENE[:SCENE.index("[bodies.tower]")] + SCENE[SCENE.index("[bodies.nacelle]"):SCENE.index("[joints.foot]")] + f"""
[start]
equilibrium = true
[environment]
water_depth_m = 300.0
[sea]
model = "hydrostatic"
[[sea.matrices]]
body = "spar"
point_m = [0.0, 0.0, -20.0]
stiffness = [[2e5, 0, 0, 0, 0, 0], [0, 2e5, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, {SPRING}]]
damping = [[5e5, 0, 0, 0, 0, 0], [0, 5e5, 0, 0, 0, 0], [0, 0, 5e5, 0, 0, 0], [0, 0, 0, 5e8, 0, 0], [0, 0, 0, 0, 5e8, 0], [0, 0, 0, 0, 0, {DAMPER}]]
[bodies.spar]
mass_kg = {1025.0 * numpy.pi * 36.0 * 120.0 - 674000.0}
inertia_kg_m2 = [2e10, 2e10, {INERTIA}]
centre_m = [0.0, 0.0, -85.0]
[[bodies.spar.cylinders]]
name = "hull"
start_m = [0.0, 0.0, -120.0]
end_m = [0.0, 0.0, 12.0]
diameter_m = 12.0
""" + SCENE[SCENE.index("[joints.yaw_bearing]"):].replace('["tower", "nacelle"]', '["spar", "nacelle"]')
TURNING = "time_s,speed_m_s,direction_deg\n0,9,0\n20,9,0\n60,9,30\n1000,9,30\n"
STEP = "time_s,speed_m_s,direction_deg\n0,9,0\n20,9,0\n20.5,9,{0}\n1000,9,{0}\n"


def yaw_before_tilt(history, body):
    """Yaw of an attitude that is a yaw about the vertical and then a tilt about a level axis [rad]: what stiffness counts."""
    roll, pitch, yaw = (0.5 * numpy.radians(history[f"{body}.{name}_deg"]) for name in ("roll", "pitch", "yaw"))
    (cr, sr), (cp, sp), (cy, sy) = ((numpy.cos(half), numpy.sin(half)) for half in (roll, pitch, yaw))
    return 2.0 * numpy.arctan2(cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


class Yaw(Folder):
    def run_scene(self, name, *settings, direction=25.0, wind=STEP, text=SCENE, more=(), code=0):
        scene = self.path / "scene.toml"
        scene.write_text(text)
        (self.path / "wind.csv").write_text(wind.format(direction))
        done = spindrift("run", scene, "--out", self.path / name, "--no-report", "--quiet", *more, settings=settings)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return self.path / name / "history.csv" if code == 0 else done.stdout + done.stderr

    def check_turn(self, h, direction):
        t, angle, way = h["time_s"], h["rotor.yaw_angle_deg"], numpy.sign(direction)
        # The filtered wind passes 8 of 25 degrees after 2 s; ten later the drive starts: 21.9 degrees at half a degree a second.
        turning = h["rotor.yaw_rate_deg_s"] != 0.0
        self.assertAlmostEqual(t[turning][0], 32.0, delta=1.0)
        self.assertAlmostEqual(turning.sum() * 0.1, (abs(direction) - 0.5) / 0.5, delta=1.5)
        self.assertEqual(turning.sum(), len(t[(t >= t[turning][0]) & (t <= t[turning][-1])]))  # in one go
        self.assertLess(numpy.abs(angle[t < 30.0]).max(), 0.3)
        self.assertTrue(0.0 < way * direction - way * angle[-1] < 0.8, angle[-1])
        self.assertLess(numpy.abs(h["rotor.yaw_error_deg"][-1]), 0.8)
        self.assertAlmostEqual(angle[-1], h["nacelle.yaw_deg"][-1] - h.get("tower.yaw_deg", h["nacelle.yaw_deg"] * 0.0)[-1], delta=1e-6)

    def test_a_step_of_the_winds_direction_turns_the_nacelle_and_it_stops_within_the_threshold(self):
        for direction in (25.0, -25.0):
            with self.subTest(direction):
                self.check_turn(columns(self.run_scene(f"turn{direction:g}", direction=direction)), direction)
        down = SCENE.replace("axis = [0.0, 0.0, 1.0]", "axis = [0.0, 0.0, -1.0]")  # an axis that points down changes nothing
        self.check_turn(columns(self.run_scene("down", text=down)), 25.0)

    def test_small_errors_leave_it_where_it_is_and_a_drive_that_holds_is_a_spring(self):
        h = columns(self.run_scene("small", "time.end_s=60.0", direction=7.0))
        self.assertEqual(numpy.abs(h["rotor.yaw_rate_deg_s"]).max(), 0.0)
        self.assertAlmostEqual(h["rotor.yaw_error_deg"][-1], 7.0, delta=0.1)
        settled = h["time_s"] > 40.0
        spring = -numpy.radians(h["rotor.yaw_angle_deg"]) * 2e10
        self.assertLess(numpy.abs(h["rotor.yaw_moment_N_m"] - spring)[settled].max(), 0.05 * numpy.abs(spring[settled]).max())

    def test_a_gust_with_change_of_direction_is_followed_and_a_restart_has_the_same_bits(self):
        event = SCENE.replace('table = "wind.csv"', 'speed_m_s = 10.0\n[wind.event]\nwhat = "ecd"\nstart_s = 20.0')
        settings = ("time.end_s=80.0", "control.yaw.delay_s=2.0", "control.yaw.filter_time_s=1.0", "control.yaw.rate_deg_s=2.0")
        whole = self.run_scene("whole", *settings, text=event)
        h = columns(whole)
        self.assertGreater(numpy.abs(h["rotor.yaw_error_deg"]).max(), 20.0)
        self.assertLess(numpy.abs(h["rotor.yaw_error_deg"][-1]), 1.0)
        self.assertEqual(h["rotor.yaw_rate_deg_s"][-1], 0.0)
        for until in (22.7, 31.3):  # while it waits, while it turns
            name = f"parts{until:g}"
            self.run_scene(name, *settings, text=event, more=("--until", until))
            self.assertEqual(self.run_scene(name, *settings, text=event, more=("--restart",)).read_bytes(), whole.read_bytes())

    def test_a_floater_turns_against_the_drive_that_follows_the_wind(self):
        settings = ("time.end_s=160.0",)
        whole = self.run_scene("afloat", *settings, text=AFLOAT, wind=TURNING)
        h = columns(whole)
        t, turning, spar = h["time_s"], h["rotor.yaw_rate_deg_s"] != 0.0, h["spar.yaw_deg"]
        self.assertGreater(h["rotor.yaw_rate_deg_s"].max(), 0.0)
        self.assertFalse(turning[-1])
        self.assertLess(numpy.abs(h["rotor.yaw_error_deg"][t > 140.0]).max(), 1.5)   # stopped at half a degree, then the spar swung back
        self.assertAlmostEqual(h["nacelle.yaw_deg"][-1], 30.0, delta=1.5)
        # It starts by pushing the spar the other way.
        first = int(numpy.argmax(turning))
        self.assertLess((spar[first:first + 15] - spar[first]).min(), -0.01)
        for axis in ("mx_N_m", "my_N_m", "mz_N_m"):
            self.assertEqual(numpy.abs(h[f"spar.yaw_drive.{axis}"] + h[f"nacelle.yaw_drive.{axis}"]).max(), 0.0)
        # The spar's own equation of motion, with the drive's moment the other way round; it leans by some degrees, which is left out.
        on_spar = INERTIA * h["spar.awz_rad_s2"] + DAMPER * h["spar.wz_rad_s"] + SPRING * yaw_before_tilt(h, "spar")
        moment = h["rotor.yaw_moment_N_m"]
        self.assertGreater(numpy.abs(moment).max(), 1.5e6)
        self.assertLess(numpy.sqrt(numpy.mean((on_spar + moment)**2)), 0.02 * numpy.sqrt(numpy.mean(moment**2)))
        for until in (41.3, 63.7):
            name = f"afloat{until:g}"
            self.run_scene(name, *settings, text=AFLOAT, wind=TURNING, more=("--until", until))
            self.assertEqual(self.run_scene(name, *settings, text=AFLOAT, wind=TURNING, more=("--restart",)).read_bytes(), whole.read_bytes())

    def test_a_controlled_turbine_with_a_bending_tower_turns(self):
        beam = SCENE[:SCENE.index("[bodies.tower]")] + SCENE[SCENE.index("[bodies.nacelle]"):]
        beam = beam.replace("""[joints.foot]
type = "fixed"
bodies = ["earth", "tower"]
point_m = [0.0, 0.0, 0.0]
""", f"""[bodies.tower_top]
mass_kg = 2e4
inertia_kg_m2 = [1e7, 1e7, 1e7]
centre_m = [0.0, 0.0, 115.63]
[beams.tower]
bodies = ["earth", "tower_top"]
start_m = [0.0, 0.0, 0.0]
end_m = [0.0, 0.0, 115.63]
properties = "{TURBINE.parent}/dtu_10mw/tower.csv"
""").replace('bodies = ["tower", "nacelle"]', 'bodies = ["tower_top", "nacelle"]').replace("[control.yaw]", '[control]\nmodel = "dtu"\n[control.yaw]').replace("speed_rpm = 8.0\n", 'operating_point = "table"\n')
        h = columns(self.run_scene("beam", "time.step_s=0.01", "time.end_s=90.0", "control.yaw.stiffness_N_m_rad=2e9", "control.yaw.damping_N_m_s_rad=5e7", text=beam))
        self.assertTrue(20.0 < h["rotor.yaw_angle_deg"][-1] < 25.5, h["rotor.yaw_angle_deg"][-1])
        self.assertEqual(h["rotor.yaw_rate_deg_s"][-1], 0.0)

    def test_what_a_scene_may_not_ask_of_it_is_refused_by_name(self):
        for change, key in [("control.yaw.joint='nothing'", "control.yaw.joint"), ("control.yaw.joint='foot'", "control.yaw.joint"),
                            ("joints.yaw_bearing.axis=[1.0, 0.0, 0.0]", "control.yaw.joint"), ("control.yaw.stop_error_deg=9.0", "control.yaw.stop_error_deg"),
                            ("joints.yaw_bearing.rotation={speed_rpm=1.0}", "control.yaw.joint"), ("joints.yaw_bearing.bodies=['nacelle', 'tower']", "control.yaw.joint"),
                            ("coupling.scheme='cps'", "coupling.scheme"), ("control.yaw.rate_deg_s=-1.0", "control.yaw.rate_deg_s")]:
            with self.subTest(change):
                self.assertIn(key, self.run_scene("refused", change, code=2))
        without_wind = SCENE.replace('[wind]\ntable = "wind.csv"\n', "").replace('model = "bem"', 'model = "prescribed"\nthrust_N = 1e6')
        self.assertIn("control.yaw", self.run_scene("refused", text=without_wind, code=2))
        said = spindrift("check", ROOT / "inputs/leble_barakos/case3_demo.toml", settings=("control.yaw={joint='bearing', stiffness_N_m_rad=1e9, damping_N_m_s_rad=1e7}",))
        self.assertEqual(said.returncode, 2)
        self.assertIn('control.yaw: does not go with aero.model "blade_resolved"', said.stdout + said.stderr)


if __name__ == "__main__":
    unittest.main()
