"""Actuator lines in a turbulent wind that enters on a plane upwind of them, beside blade elements with dynamic inflow in the same box: thrust and torque
follow the same gusts. Usage: actuator_turbulence_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import unittest

import numpy

from running import AIR_OF_LINES, ROOT, Runs, columns

# Six cells to the radius from a diameter upwind of the hub on.
SCENE = f"""
[time]
end_s = 60.0
window_s = 0.3
step_s = 0.1
[start]
air_steps = 60
[wind]
speed_m_s = 11.0
[rotor]
turbine = "{ROOT}/inputs/turbines/dtu_10mw.toml"
body = "rotor"
joint = "bearing"
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
"""
TURBULENCE = """
[wind.turbulence]
model = "kaimal"
seed = 2
points_across = 9
points_up = 9
duration_s = 120.0
step_s = 0.5
"""
LINES = SCENE + AIR_OF_LINES + """
drop = 1e-2
max_pseudo_steps = 10
"""
GRID = [f"aero.flow.generate.{key}" for key in ("cell_m=14.9", "growth=1.35", "low_m=[-1070.0,-890.0,0.0]", "high_m=[890.0,890.0,1010.0]",
                                                "core_low_m=[-200.0,-119.0,0.0]", "core_high_m=[75.0,119.0,238.0]")]
ELEMENTS = SCENE.replace("[start]\nair_steps = 60\n", "") + '[aero]\nmodel = "bem"\ndynamic_inflow = "oye"\n'
SETTLED_S = 18.0  # when the turbulence has come from its plane to the rotor
MEAN_OVER = 7     # rows, 2.1 s: what is shorter is lost on the way to the lines


class Turbulence(Runs):
    def test_lines_and_blade_elements_meet_the_same_gusts(self):
        runs = {}
        for model, text, grid in (("lines", LINES, GRID), ("elements", ELEMENTS, [])):
            for wind, box in (("steady", ""), ("turbulent", TURBULENCE)):
                self.run_scene(text + box, f"{model}_{wind}", settings=grid)
                runs[model, wind] = columns(self.path / f"{model}_{wind}" / "history.csv")
        time = runs["lines", "turbulent"]["time_s"]
        for column in ("rotor.thrust_N", "rotor.torque_N_m"):
            def changes(model):
                """By turbulence, over the steady load."""
                load = {w: numpy.interp(time, runs[model, w]["time_s"], runs[model, w][column]) for w in ("steady", "turbulent")}
                mean = numpy.convolve(load["turbulent"] / load["steady"][-1], numpy.ones(MEAN_OVER) / MEAN_OVER, "same")
                return mean[time > SETTLED_S][:-MEAN_OVER]
            lines, blades = changes("lines"), changes("elements")
            found = {"mean": lines.mean() - blades.mean(), "deviation": lines.std() / blades.std(), "correlation": numpy.corrcoef(lines, blades)[0, 1]}
            print(column, found)
            with self.subTest(column, **found):
                self.assertAlmostEqual(found["mean"], 0.0, delta=0.02)
                # A box by Kaimal's spectra is not free of divergence: air cannot carry all of it.
                self.assertTrue(0.7 < found["deviation"] < 1.0)
                self.assertGreater(found["correlation"], 0.93)


if __name__ == "__main__":
    unittest.main()
