"""A turbine under control in resolved air, as actuators and as blades: it settles where blade elements do, a pitch of the blades does to the thrust what blade
elements say, events, same bits however it is run, what is refused. Usage: air_control_test.py SPINDRIFT [Actuators | Blades].
SPDX-License-Identifier: Apache-2.0"""
import json
import unittest

from running import AIR_OF_BLADES, ROOT, Runs

FIXED = ROOT / "inputs/control/dtu_10mw_fixed.toml"
DISC = ROOT / "inputs/control/dtu_10mw_disc.toml"
# Four cells to the radius and sides at five radii: what is tested is the exchange, not the flow.
COARSE = ["aero.flow.generate.cell_m=22.0", "aero.flow.generate.low_m=[-450.0, -450.0, 0.0]", "aero.flow.generate.high_m=[450.0, 450.0, 550.0]",
          "aero.flow.generate.core_low_m=[-50.0, -110.0, 0.0]", "aero.flow.generate.core_high_m=[50.0, 110.0, 220.0]", "start.air_steps=10", "time.window_s=0.3"]
LINES = ["aero.model=actuator_line", *COARSE]
# The same on a floater whose platform and rotor are one body.
FLOATING = """
base = "%s/inputs/leble_barakos/case3_controlled.toml"
[time]
end_s = 2.4
window_s = 0.3
step_s = 0.05
[start]
air_steps = 10
ramp_s = 1.0
""" % ROOT + "[aero]" + DISC.read_text().split("[aero]")[1].split("[output]")[0]
BLADES = """
base = "%s"
[time]
end_s = 1.2
window_s = 0.1
step_s = 0.05
[start]
air_steps = 30
""" % FIXED + AIR_OF_BLADES + """
cfl_max = 20.0
krylov_steps = 6
max_pseudo_steps = 10
drop = 1e-2
"""


def mean(history, column, after):
    values = [r[column] for r in history if r["time_s"] > after]
    return sum(values) / len(values)


class Controlled(Runs):
    def same_bits(self, scene, name, settings, until, on_ranks=None):
        self.run_scene(scene, name, settings=settings)
        if on_ranks is not None:
            self.run_scene(scene, name + "r", settings=[*settings, *on_ranks], ranks=2)
            self.assertEqual(self.text(name), self.text(name + "r"))
        self.run_scene(scene, name + "p", "--until", until, settings=settings, threads=2)
        self.run_scene(scene, name + "p", "--restart", settings=settings)
        self.assertEqual(self.text(name), self.text(name + "p"))

    def refused(self, scene, cases):
        for settings, key, why in cases:
            with self.subTest(key=key, why=why):
                said = self.run_scene(scene, "run", settings=settings, code=2)
                self.assertIn(key, said)
                self.assertIn(why, said)
                self.assertFalse((self.path / "run").exists())


class Actuators(Controlled):
    def test_a_disc_settles_where_blade_elements_do(self):
        # Below rated wind a disc of five cells to the radius has 7 % more torque than blade elements; above it the controller holds power and speed.
        for wind, speed, power, pitch in ((8.0, 0.04, 0.1, 0.2), (13.0, 0.002, 0.002, 0.4)):
            with self.subTest(wind):
                settings = [f"wind.speed_m_s={wind}", "time.end_s=45.0"]
                self.run_scene(FIXED, f"elements{wind}", settings=settings)
                self.run_scene(DISC, f"disc{wind}", settings=settings)
                elements, disc = self.rows(f"elements{wind}"), self.rows(f"disc{wind}")
                self.assertEqual(set(elements[0]) - set(disc[0]), set())
                for column, within in (("rotor.rpm", speed), ("rotor.electrical_power_W", power)):
                    self.assertAlmostEqual(mean(disc, column, 30.0) / mean(elements, column, 30.0), 1.0, delta=within)
                self.assertAlmostEqual(mean(disc, "rotor.blade_1.pitch_deg", 30.0), mean(elements, "rotor.blade_1.pitch_deg", 30.0), delta=pitch)

    def test_lines_without_a_grid_feather_and_slow_down(self):
        self.run_scene(DISC, "run", settings=[*LINES, "control.events=[{what='grid_loss', time_s=1.5}]", "time.end_s=9.0"])
        history = {round(r["time_s"], 1): r for r in self.rows("run")}
        self.assertGreater(history[1.2]["rotor.generator_torque_N_m"], 5e6)
        self.assertEqual(history[1.8]["rotor.generator_torque_N_m"], 0.0)
        self.assertGreater(history[9.0]["rotor.blade_2.pitch_deg"], 60.0)
        self.assertLess(history[9.0]["rotor.thrust_N"], 0.1 * history[1.2]["rotor.thrust_N"])
        fastest = max(r["rotor.rpm"] for r in history.values())
        self.assertGreater(fastest, 1.01 * history[1.2]["rotor.rpm"])  # before the blades have turned
        self.assertLess(history[9.0]["rotor.rpm"], 0.9 * fastest)

    def test_a_blade_that_sticks_keeps_its_pitch_and_its_load(self):
        events = "{what='blade_stuck', blade=2, time_s=0.6}, {what='grid_loss', time_s=0.9}"
        self.run_scene(DISC, "run", settings=[*LINES, f"control.events=[{events}]", "time.end_s=3.0"])
        start, end = self.rows("run")[1], self.rows("run")[-1]
        self.assertAlmostEqual(end["rotor.blade_2.pitch_deg"], start["rotor.blade_2.pitch_deg"], delta=0.5)
        self.assertGreater(end["rotor.blade_1.pitch_deg"], 15.0)
        self.assertGreater(end["rotor.blade_2.thrust_N"], 0.8 * start["rotor.blade_2.thrust_N"])
        for blade in (1, 3):  # so fast a rotor drives the air with blades this far out
            self.assertLess(end[f"rotor.blade_{blade}.thrust_N"], 0.0)

    def test_a_ramp_of_the_loads_is_for_the_bodies_and_does_not_slow_the_rotor(self):
        settings = [*COARSE, "time.end_s=1.5"]
        self.run_scene(DISC, "whole", settings=settings)
        self.run_scene(DISC, "ramped", settings=[*settings, "start.ramp_s=2.0"])
        for whole, ramped in zip(self.rows("whole"), self.rows("ramped")):
            self.assertEqual(whole["rotor.rpm"], ramped["rotor.rpm"])
            x = whole["time_s"] / 2.0
            self.assertAlmostEqual(ramped["rotor.thrust_N"], x * x * (3.0 - 2.0 * x) * whole["rotor.thrust_N"], delta=1.0)

    def test_the_same_bits_however_it_is_run(self):
        event = "control.events=[{what='grid_loss', time_s=0.9}]"
        split = ["coupling.placement=split", "coupling.air_ranks=1"]
        for name, on_ranks, settings in (("cps2", split, COARSE), ("css", None, [*LINES, "coupling.scheme=css"]), ("iqn", [], [*LINES, "coupling.scheme=iqn_ils"]),
                                         ("parallel", None, [*COARSE, "coupling.scheme=iqn_ils", "coupling.composition=parallel"])):
            with self.subTest(name):
                self.same_bits(FLOATING, name, [*settings, event], 1.2, on_ranks)

    def test_what_cannot_be_is_refused(self):
        stuck = "control.events=[{what='blade_stuck', time_s=1.0}]"
        self.refused(DISC, (
            ([stuck], "control.events[0].what", 'take aero.model "actuator_line"'),
            (["coupling.scheme=monolithic"], "coupling.scheme", 'must not be "monolithic"'),
            (["control.peak_shaving=0.8"], "control.peak_shaving", 'needs aero.model = "bem"'),
            (["control.model=library", "control.library=/dev/null", "control.drive_train={rotor_inertia_kg_m2=1e8}", "coupling.scheme=iqn_ils"], "coupling.scheme",
             "must be a loose one with a controller library"),
            (["control.yaw={joint='foundation', stiffness_N_m_rad=1e9, damping_N_m_s_rad=1e8}"], "control.yaw", "does not go with aero.model"),
        ))
        alone = (ROOT / "inputs/validation/actuator/disc.toml").read_text().replace("../../turbines", f"{ROOT}/inputs/turbines") + "[control]\nmodel = 'dtu'\n"
        self.refused(alone, (([], "control", "a drive train steps with them"),))


class Blades(Controlled):
    def test_blades_that_pitch_change_the_thrust_as_blade_elements_say(self):
        # Out at up to 10 degrees per second from 0.3 s on. The wake follows within seconds: blade elements have it at once, or not at all yet (dynamic inflow).
        # 0.39 here; blade elements 0.40 and 0.61. A lift that builds up over chords (Wagner) and coarse blades take a share of it.
        event = ["control.events=[{what='grid_loss', time_s=0.3}]"]
        fine = ["aero.flow.max_pseudo_steps=40", "aero.flow.drop=1e-3", "start.air_steps=100"]
        elements = ["time.end_s=1.2", "time.window_s=0.1"]
        fall, pitch = {}, {}
        for name, scene, settings in (("blades", BLADES, fine), ("steady", FIXED, elements), ("frozen", FIXED, [*elements, "aero.dynamic_inflow=oye"])):
            self.run_scene(scene, name, settings=["wind.speed_m_s=11.0", *settings])
            self.run_scene(scene, name + "_pitched", settings=["wind.speed_m_s=11.0", *settings, *event])
            before, after = self.rows(name)[-1], self.rows(name + "_pitched")[-1]
            fall[name], pitch[name] = 1.0 - after["rotor.thrust_N"] / before["rotor.thrust_N"], after["rotor.blade_1.pitch_deg"]
        self.assertAlmostEqual(pitch["blades"], pitch["steady"], delta=1e-6)
        self.assertGreater(pitch["blades"], 6.0)
        self.assertGreater(fall["blades"], 0.85 * fall["steady"])
        self.assertLess(fall["blades"], fall["frozen"])

    def test_the_same_bits_however_it_is_run(self):
        for name, on_ranks, settings in (("one", [], ["aero.grid.sectors=one", "start.air_steps=30"]), ("css", None, ["coupling.scheme=css", "start.air_steps=30"]),
                                         ("iqn", None, ["coupling.scheme=iqn_ils", "start.air_steps=3"])):
            with self.subTest(name):
                short = ["aero.flow.max_pseudo_steps=3", "aero.flow.drop=0.0", "time.end_s=0.6", "control.events=[{what='grid_loss', time_s=0.1}]"]
                self.same_bits(BLADES, name, [*settings, *short], 0.4, on_ranks)

    def test_third_order_in_time_has_the_same_bits_however_it_is_run_and_says_where_its_error_is_above_the_tolerance(self):
        short = ["aero.flow.max_pseudo_steps=3", "aero.flow.drop=0.0", "time.end_s=0.8", "start.air_steps=5", "control.events=[{what='grid_loss', time_s=0.1}]"]
        self.same_bits(BLADES, "third", [*short, "coupling.scheme=css", "aero.flow.time=bdf3", "aero.flow.time_tolerance=1e-9"], 0.5)
        errors = [row["air.time_error"] for row in self.rows("third")]
        self.assertEqual(errors[:4], [0.0] * 4)  # the start, and steps of lower order or without a level more
        self.assertGreater(min(errors[4:]), 0.0)
        said = (self.path / "third/log.txt").read_text()
        self.assertRegex(said, r"the step to t = 0.4 s has an error in time of \S+, 1e-09 is asked for \(aero.flow.time_tolerance\)")
        self.assertEqual(json.loads((self.path / "third/summary.json").read_text())["counts"]["windows_above_time_tolerance"], 5)

    def test_a_pitch_that_the_grid_cannot_follow_ends_the_run_by_name(self):
        # A controller that finds the blades far too flat turns them out at once: the grid is made at zero, the table has 17 degrees at 18 m/s.
        said = self.run_scene(BLADES, "run", settings=["wind.speed_m_s=18.0", "rotor.operating_point=given", "rotor.speed_rpm=12.0", "rotor.blade_pitch_deg=0.0",
                                                       "aero.flow.max_pseudo_steps=3", "aero.flow.drop=0.0", "start.air_steps=5", "time.end_s=4.0"], code=3)
        self.assertRegex(said, r"blade 1 is pitched to 1\d\.\d* degrees, .* it follows within 15 degrees")

    def test_what_cannot_be_is_refused(self):
        self.refused(BLADES, (
            (["control.events=[{what='shut_down', time_s=1.0}]", "time.end_s=20.0"], "control.events[0].what", "End the run 7.5 s after the event at most"),
            (["control.events=[{what='emergency_stop', time_s=1.0}]", "time.end_s=4.0"], "control.events[0].what", "End the run 1.5 s after the event at most"),
            (["control.start=parked"], "control.start", "their grid is made at rotor.blade_pitch_deg, 0"),
            (["control.start=parked", "rotor.operating_point=given", "rotor.blade_pitch_deg=90.0", "control.events=[{what='start_up', time_s=1.0}]", "time.end_s=20.0"],
             "control.events[0].what", "pitches the blades from feather, 90 degrees"),
            (["aero.grid.sectors=one", "control.events=[{what='blade_stuck', time_s=1.0}]"], "control.events[0].what", 'take aero.grid.sectors = "all"'),
        ))


if __name__ == "__main__":
    unittest.main()
