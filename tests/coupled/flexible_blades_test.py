"""Case 3 with blades that bend: the same bits after a restart, loads near the rigid rotor's, and blades that cannot be followed refused.
Usage: flexible_blades_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import csv
import unittest

from running import Folder, ROOT, spindrift

SCENE = ROOT / "inputs/leble_barakos/flexible_blades.toml"
RIGID = ROOT / "inputs/leble_barakos/case3_engineering.toml"


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

    def test_steps_too_long_for_the_blades_are_refused(self):
        done = spindrift("check", SCENE, "--set", "time.step_s=0.1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("time.step_s", done.stderr)
        self.assertIn("too long for blades whose fastest mode has", done.stderr)


if __name__ == "__main__":
    unittest.main()
