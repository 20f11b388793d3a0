"""Case 3 with blades that bend: the same bits after a restart, loads near the rigid rotor's, and blades that cannot be followed refused.
Usage: flexible_blades_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import csv
import unittest

from running import Folder, ROOT, spindrift

SCENE = ROOT / "inputs/leble_barakos/flexible_blades.toml"
RIGID = ROOT / "inputs/leble_barakos/case3_engineering.toml"


# Tower and blades that bend, under the controller, on land; the nacelle has all of the rotor but its inertia about the shaft.
ON_LAND = """
[time]
end_s = 2.0
window_s = 0.1
step_s = 0.01

[bodies.nacelle]                        # with the rotor, but for its inertia about the shaft
mass_kg = 673998.0
inertia_kg_m2 = [4.4e6, 9.0e7, 9.0e7]
centre_m = [-2.4, 0.0, 118.4]

[beams.tower]
bodies = ["earth", "nacelle"]
start_m = [0.0, 0.0, 0.0]
end_m = [0.0, 0.0, 115.63]
properties = "TURBINES/dtu_10mw/tower.csv"
damping = [0.005, 0.02]

[wind]
speed_m_s = 11.0

[aero]
model = "bem"

[rotor]
body = "nacelle"
hub_m = [-7.1, 0.0, 119.0]
turbine = "TURBINES/dtu_10mw.toml"
operating_point = "table"
blade_structure = "TURBINES/dtu_10mw/blade_structure.csv"

[control]
model = "dtu"
"""


def column(folder, name):
    with open(folder / "history.csv") as f:
        rows = list(csv.DictReader(line for line in f if not line.startswith("#")))
    return [float(r[name]) for r in rows]


def mean(values):
    return sum(values) / len(values)


class FlexibleBlades(Folder):
    def run_scene(self, scene, name, *more):
        done = spindrift("run", scene, "--quiet", "--no-report", "--set", "time.end_s=20.0", "--out", self.path / name, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.path / name

    def test_a_restart_goes_on_with_the_same_bits(self):
        whole = self.run_scene(SCENE, "whole")
        parts = self.run_scene(SCENE, "parts", "--until", "7.3")
        self.run_scene(SCENE, "parts", "--restart")
        self.assertEqual((whole / "history.csv").read_text(), (parts / "history.csv").read_text())

    def test_bent_blades_take_a_little_off_the_rigid_rotors_load(self):
        bending, rigid = self.run_scene(SCENE, "bending"), self.run_scene(RIGID, "rigid")
        for name, low, high in (("rotor.thrust_N", .95, 1.01), ("rotor.power_W", .95, 1.01), ("platform.pitch_deg", .93, 1.03)):
            share = mean(column(bending, name)[100:]) / mean(column(rigid, name)[100:])
            self.assertTrue(low < share < high, f"{name}: {share} of the rigid rotor's")
        for blade in (1, 2, 3):
            tip = column(bending, f"rotor.blade_{blade}.tip_downwind_m")
            self.assertTrue(5.0 < mean(tip) < 10.0, f"blade {blade} bends by {mean(tip)} m")
            ahead = column(bending, f"rotor.blade_{blade}.tip_ahead_m")
            self.assertTrue(.1 < max(ahead) - min(ahead) < 2.0, f"edgewise by {max(ahead) - min(ahead)} m")
        # The roots carry the rotor's thrust and torque.
        n = -1
        torque = sum(column(bending, f"rotor.blade_{b}.root_edge_N_m")[n] for b in (1, 2, 3))
        self.assertGreater(torque, 0.5 * column(bending, "rotor.torque_N_m")[n])

    def test_a_controlled_rotor_is_carried_by_a_nacelle_without_its_inertia_about_the_shaft(self):
        scene = self.path / "on_land.toml"
        scene.write_text(ON_LAND.replace("TURBINES", str(ROOT / "inputs/turbines")))
        done = spindrift("check", scene)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        out = self.run_scene(scene, "on_land", "--set", "time.end_s=2.0")
        # A tower of 0.25 Hz under 825 t bends by its thrust over 2 MN/m, which is 0.7 m, and from rest by nearly twice as much.
        still = max(column(out, "rotor.thrust_N")) / 2.04e6
        self.assertTrue(1.2 < max(column(out, "nacelle.x_m")) / still < 2.0)

    def test_steps_too_long_for_the_blades_are_refused(self):
        done = spindrift("check", SCENE, "--set", "time.step_s=0.1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("time.step_s", done.stderr)
        self.assertIn("too long for blades whose fastest mode has", done.stderr)


if __name__ == "__main__":
    unittest.main()
