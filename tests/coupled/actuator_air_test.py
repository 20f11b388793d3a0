"""Actuator disc and lines in resolved air whose turbine stands on bodies: the flow of the same rotor without bodies where they do not move, same bits
however it is run, what is refused. Usage: actuator_air_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import math
import os
import re
import signal
import subprocess
import time
import unittest

import h5py

from running import AIR_OF_LINES, DTU_IN_WIND, PROGRAM, ROOT, Runs, rows

FLOW = DTU_IN_WIND + "%s\n" + AIR_OF_LINES + """
drop = 1e-2
max_pseudo_steps = 10
"""
FLOATING = """
base = "%s/inputs/leble_barakos/platform.toml"
[time]
end_s = 2.4
window_s = 0.3
step_s = 0.05
[sea]
model = "hydrostatic"
[start]
air_steps = 10
""" % ROOT + FLOW % ""
HELD = """
[time]
end_s = 1.5
window_s = 0.3
step_s = 0.05
[bodies.rotor]
mass_kg = 227962.0
inertia_kg_m2 = [1.56e8, 7.84e7, 7.84e7]
centre_m = [0.0, 0.0, 119.0]
[joints.bearing]
type = "revolute"
bodies = ["earth", "rotor"]
point_m = [0.0, 0.0, 119.0]
axis = [1.0, 0.0, 0.0]
[joints.bearing.rotation]
speed_rpm = 8.8
""" + FLOW % 'body = "rotor"\njoint = "bearing"'
ALONE = """
[time]
end_s = 1.5
window_s = 0.3
""" + FLOW % "hub_m = [0.0, 0.0, 119.0]\naxis = [1.0, 0.0, 0.0]\nspeed_rpm = 8.8"

OPEN_BELOW = "aero.flow.boundaries[4].condition=far_field"   # wind does not rise out of the ground


class ActuatorAir(Runs):
    def test_a_rotor_whose_body_is_held_has_the_flow_of_the_rotor_alone(self):
        for model in ("actuator_line", "actuator_disc"):
            with self.subTest(model):
                self.run_scene(HELD, model, settings=[f"aero.model={model}"])
                self.run_scene(ALONE, model + "_alone", settings=[f"aero.model={model}"])
                held, alone = self.rows(model)[1:], self.rows(model + "_alone")
                # The air by itself writes a row for each of its pseudo-steps or for each window; the last is the same instant.
                for column in ("rotor.thrust_N", "rotor.torque_N_m"):
                    self.assertAlmostEqual(held[-1][column] / alone[-1][column], 1.0, delta=1e-9)
                self.assertGreater(held[-1]["rotor.thrust_N"], 1e6)

    def test_a_scheme_that_begins_anew_at_a_restart_has_the_air_of_the_checkpoint(self):
        strong = ["coupling.scheme=iqn_ils", "time.end_s=1.8"]
        self.run_scene(FLOATING, "run", "--until", 1.2, settings=strong)
        scene = self.path / "run/scene.toml"
        self.run_scene(FLOATING.replace("[start]\nair_steps = 10\n", ""), "from", settings=[*strong, "coupling.samples=2", f"start.file={scene}"])
        self.run_scene(FLOATING, "run", "--restart", "--allow-change", "coupling.samples", settings=[*strong, "coupling.samples=2"])
        on, begun = self.rows("run"), self.rows("from")
        self.assertEqual([row["rotor.thrust_N"] for row in on[-2:]], [row["rotor.thrust_N"] for row in begun[-2:]])

    def test_power_is_that_of_the_rotors_own_turning(self):
        self.run_scene(FLOATING, "rolling", settings=["bodies.platform.omega_rad_s=[0.01, 0.0, 0.0]", "time.end_s=0.6"])
        last = self.rows("rolling")[-1]
        self.assertGreater(last["platform.wx_rad_s"], 0.005)
        self.assertAlmostEqual(last["rotor.power_W"] / (last["rotor.torque_N_m"] * last["rotor.rpm"] * math.pi / 30.0), 1.0, delta=1e-9)

    def test_the_same_bits_however_it_is_run(self):
        for model, more in (("actuator_line", []), ("actuator_disc", ["wind.event={what='ecd', start_s=0.3}"]),
                            ("actuator_line", ["coupling.scheme=iqn_ils"]), ("actuator_line", ["wind.turbulence={model='kaimal', duration_s=60}", "aero.flow.max_pseudo_steps=20"])):
            with self.subTest(model=model, more=more):
                settings = [f"aero.model={model}", *more]
                name = model + str(len("".join(more)))
                self.run_scene(FLOATING, name, settings=settings)
                self.run_scene(FLOATING, name + "t", settings=settings, threads=2)
                self.assertEqual(self.text(name), self.text(name + "t"))
                self.run_scene(FLOATING, name + "r", settings=settings, ranks=2)
                self.assertEqual(self.text(name), self.text(name + "r"))
                self.run_scene(FLOATING, name + "p", "--until", 1.2, settings=settings, threads=2)
                self.run_scene(FLOATING, name + "p", "--restart", settings=settings)
                self.assertEqual(self.text(name), self.text(name + "p"))

    def test_each_field_of_a_standing_grid_is_there_once_with_its_points_however_the_run_was_stopped(self):
        settings = ["output.air_interval_s=0.3", "time.end_s=300"]
        folder = self.path / "run/fields"

        def times():
            found = [float(t) for t in re.findall(r'<Time Value="([^"]*)"', (folder / "air.xdmf").read_text())]
            for path in folder.glob("air_*.h5"):
                with h5py.File(path) as file, h5py.File(folder / os.fsdecode(file.attrs["points_file"])) as there:
                    self.assertTrue(all("points" in block for block in there.values()))
            return found

        self.run_scene(HELD, "run", "--until", 0.3, settings=settings)
        self.run_scene(HELD, "run", "--restart", "--until", 0.3, settings=settings)  # nothing is left to do
        self.assertEqual(times(), [0.3])
        words = [str(word) for word in (PROGRAM, "run", self.path / "scene.toml", "--quiet", "--no-report", "--out", self.path / "run", "--restart")]
        process = subprocess.Popen(words + [word for text in settings for word in ("--set", text)], env={**os.environ, "OMP_NUM_THREADS": "1"})
        while len(list(folder.glob("air_*.h5"))) < 2 and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=300), 5)
        found = times()
        self.assertGreater(len(found), 1)
        self.assertEqual(found, sorted(set(found)))

    def test_windows_that_did_not_converge_fail_a_restart_that_has_nothing_left_to_do_too(self):
        settings = ["aero.flow.drop=1e-12", "aero.flow.max_pseudo_steps=1", "aero.flow.unconverged_share=0.99"]
        self.run_scene(ALONE, "run", settings=settings, code=3)
        self.assertEqual(self.rows("run")[-1]["time_s"], 1.5)  # the last window was one too many
        self.assertIn("windows spent their", self.run_scene(ALONE, "run", "--restart", settings=settings, code=3))

    def test_a_gust_is_at_the_blades_at_once(self):
        gust = "wind.event={what='step', start_s=0.6, speed_change_m_s=1.0}"
        for text, name in ((HELD, "held"), (ALONE, "alone")):
            self.run_scene(text, name)
            self.run_scene(text, name + "_gust", settings=[gust])
        for name in ("held", "alone"):
            calm, gusty = self.rows(name), self.rows(name + "_gust")
            rise = {round(a["time_s"], 3): b["rotor.thrust_N"] / a["rotor.thrust_N"] for a, b in zip(calm, gusty) if a["time_s"] > 0.0}
            self.assertAlmostEqual(rise[0.3], 1.0, delta=1e-12)
            # The wake has not changed yet: a tenth more wind is a tenth more thrust at the least.
            self.assertGreater(rise[0.9], 1.08)
            self.assertLess(rise[1.5], 1.25)
        self.assertAlmostEqual(self.rows("held_gust")[-1]["rotor.thrust_N"] / self.rows("alone_gust")[-1]["rotor.thrust_N"], 1.0, delta=1e-9)

    def test_a_wind_that_changes_begins_as_that_of_the_first_instant(self):
        whole = ["aero.flow.drop=1e-6", "aero.flow.max_pseudo_steps=25", "time.end_s=0.6"]
        table = self.path / "table.csv"
        for rows_of, settings in (("speed_m_s,direction_deg\n0,%s,20\n100,%s,20" % (11.0, 11.0), ["wind.speed_m_s=11.0", "wind.direction_deg=20.0"]),
                                  ("speed_m_s,vertical_m_s\n0,%s,2\n100,%s,2" % (11.0, 11.0), ["wind.speed_m_s=%.17g" % math.hypot(11.0, 2.0), "aero.flow.incidence_deg=%.17g" % math.degrees(math.atan2(2.0, 11.0))])):
            table.write_text("time_s," + rows_of + "\n")
            for text, name in ((HELD + "[start]\nair_steps = 10\n", "settled"), (ALONE, "alone")):
                with self.subTest(name=name, table=rows_of):
                    ground = [OPEN_BELOW] if "vertical" in rows_of else []
                    self.run_scene(text, name + "_table", "--overwrite", settings=[*whole, *ground, f"wind.table={table}"])
                    self.run_scene(text, name, "--overwrite", settings=[*whole, *ground, *settings])
                    for a, b in zip(self.rows(name + "_table"), self.rows(name), strict=True):
                        self.assertAlmostEqual(a["rotor.thrust_N"] / b["rotor.thrust_N"], 1.0, delta=1e-4)  # the march's scale is the horizontal speed
                        self.assertAlmostEqual(a["rotor.torque_N_m"] / b["rotor.torque_N_m"], 1.0, delta=1e-3)

    def test_a_step_at_the_start_is_the_higher_wind(self):
        for text, name in ((HELD, "held"), (HELD + "[start]\nair_steps = 10\n", "settled"), (ALONE, "alone")):
            with self.subTest(name):
                self.run_scene(text, name + "_step", settings=["wind.event={what='step', start_s=0.0, speed_change_m_s=2.0}", "wind.speed_m_s=9.0"])
                self.run_scene(text, name, settings=["wind.speed_m_s=11.0"])
                first = [next(r for r in self.rows(run) if r["time_s"] > 0.0)["rotor.thrust_N"] for run in (name + "_step", name)]
                self.assertAlmostEqual(first[0] / first[1], 1.0, delta=1e-2)

    def test_an_incidence_is_in_winds_that_change_and_in_their_columns(self):
        inclined = ["aero.flow.incidence_deg=8.0", "aero.flow.max_pseudo_steps=20", OPEN_BELOW]
        late = "wind.event={what='step', start_s=100.0, speed_change_m_s=2.0}"
        for text, name in ((HELD, "held"), (ALONE, "alone")):
            self.run_scene(text, name, settings=inclined)
            self.run_scene(text, name + "_late", settings=[*inclined, late])
            a, b = self.rows(name)[-1], self.rows(name + "_late")[-1]
            self.assertAlmostEqual(b["rotor.thrust_N"] / a["rotor.thrust_N"], 1.0, delta=1e-9)
        self.assertAlmostEqual(self.rows("held")[-1]["rotor.wind_z_m_s"] / self.rows("held")[-1]["rotor.wind_x_m_s"], math.tan(math.radians(8.0)), delta=1e-5)
        said = self.run_scene(ALONE, "box", settings=["aero.flow.incidence_deg=8.0", OPEN_BELOW, "wind.turbulence={model='kaimal', duration_s=60}"], code=2)
        self.assertIn("aero.flow.incidence_deg", said)

    def test_pseudo_steps_that_are_too_few_end_the_run_at_once(self):
        said = self.run_scene(HELD, "run", settings=["aero.flow.max_pseudo_steps=1", "aero.flow.drop=1e-6", "aero.flow.unconverged_share=0.0"], code=3)
        self.assertIn("1 of 1 steps spent their 1 pseudo-steps", said)
        self.assertNotIn("is made again", said)

    def test_air_and_sea_on_ranks_of_their_own(self):
        self.run_scene(FLOATING, "shared")
        self.run_scene(FLOATING, "split", settings=["coupling.placement=split", "coupling.air_ranks=1"], ranks=2)
        self.assertEqual(self.text("shared"), self.text("split"))

    def test_lines_tell_each_blade_and_leave_loads_along_the_span(self):
        self.run_scene(FLOATING, "run")
        last = self.rows("run")[-1]
        self.assertAlmostEqual(sum(last[f"rotor.blade_{b}.thrust_N"] for b in (1, 2, 3)) / last["rotor.thrust_N"], 1.0, delta=1e-12)
        thrust = sum(s["length_m"] * s["normal_N_m"] for s in rows(self.path / "run/spanwise.csv"))
        self.assertAlmostEqual(thrust / last["rotor.thrust_N"], 1.0, delta=1e-6)
        before = (self.path / "run/spanwise.csv").read_bytes()
        self.run_scene(FLOATING, "run", "--restart")  # nothing is left to do
        self.assertEqual((self.path / "run/spanwise.csv").read_bytes(), before)

    def test_blades_that_leave_the_grid_end_the_run_by_name(self):
        said = self.run_scene(FLOATING, "run", settings=["aero.flow.generate.high_m=[450.0, 450.0, 208.5]", "aero.flow.generate.core_high_m=[50.0, 110.0, 208.5]"],
                              code=3)
        self.assertIn("blades have left the grid of the air, hub at", said)

    def test_what_cannot_be_is_refused(self):
        for settings, key, why in (
            (["aero.flow.time=steady"], "aero.flow.time", 'must be "bdf1", "bdf2" or "bdf3"'),
            (["coupling.scheme=monolithic"], "coupling.scheme", 'must not be "monolithic"'),
            ([f"start.air={ROOT}/README.md"], "start.air", "takes the air of a blade-resolved rotor"),
            (["wind.turbulence={model='kaimal', inflow_plane_m=500}"], "wind.turbulence.inflow_plane_m", "out of the grid"),
            (["aero.flow.start=rest"], "aero.flow.start", 'must be "wind"'),
            (["aero.flow.generate.high_m=[450.0, 450.0, 180.0]", "aero.flow.generate.core_high_m=[50.0, 110.0, 180.0]"], "joints.bearing.point_m",
             "puts the rotor out of the grid"),
        ):
            with self.subTest(key):
                said = self.run_scene(FLOATING, "run", settings=settings, code=2)
                self.assertIn(key, said)
                self.assertIn(why, said)
                self.assertFalse((self.path / "run").exists())

    def test_wind_does_not_rise_out_of_the_ground(self):
        table = self.path / "wind.csv"
        table.write_text("time_s,speed_m_s,vertical_m_s\n0,11,0\n10,11,0.3\n")
        for settings, key in (([f"wind.table={table}"], "wind.table"), (["aero.flow.incidence_deg=3"], "aero.flow.incidence_deg")):
            with self.subTest(key):
                said = self.run_scene(FLOATING, "run", settings=settings, code=2)
                self.assertIn(key, said)
                self.assertIn('no air goes through patch "z_min" (symmetry)', said)


if __name__ == "__main__":
    unittest.main()
