"""Waves in a periodic box of particles, with zones at its ends that lead the water to them (sea.damping_zones.towards = "waves"): they keep the height
that viscosity takes from waves left alone, come up in water at rest, and need not fit between the sides. Usage: led_waves_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import unittest

import numpy as np

from running import Folder, rows, spindrift

HEIGHT, PERIOD = 1.88, 8.8
SCENE = f"""
[time]
end_s = 44.0
window_s = 0.1
[environment]
water_depth_m = 30.6
[waves]
model = "stokes2"
height_m = {HEIGHT}
period_s = {PERIOD}
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 2.5
[sea.tank]
x_m = [-113.0, 113.0]
top_m = 9.4
sides_x = "periodic"
[[sea.gauges]]
name = "middle"
point_m = [0.0, 0.0]
"""
ZONES = """
[[sea.damping_zones]]
from_m = 60.0
to_m = 113.0
rate_1_s = 10.0
towards = "waves"
[[sea.damping_zones]]
from_m = -40.0
to_m = -113.0
rate_1_s = 10.0
towards = "waves"
"""
WAVES = '[sea.initial]\nstate = "waves"\n'


class LedWaves(Folder):
    def run_scene(self, name, text, *arguments, ranks=0):
        scene = self.path / f"{name}.toml"
        scene.write_text(text)
        done = spindrift("run", scene, "--out", self.path / name, "--no-report", "--quiet", *arguments, ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return self.path / name / "history.csv"

    def wave(self, history, period=PERIOD):
        """Height over that of [waves], and phase [rad], by a harmonic of its period fitted to the last two."""
        t, eta = np.array([(row["time_s"], row["middle.elevation_m"]) for row in rows(history) if row["time_s"] > 44.0 - 2 * period - 1e-6]).T
        omega = 2.0 * np.pi / period
        (a, b, _), *_ = np.linalg.lstsq(np.stack([np.cos(omega * t), np.sin(omega * t), np.ones_like(t)], axis=1), eta, rcond=None)
        return 2.0 * np.hypot(a, b) / HEIGHT, np.arctan2(b, a)

    def test_zones_keep_the_waves_height_and_phase_and_raise_them_from_rest(self):
        alone, _ = self.wave(self.run_scene("alone", SCENE + WAVES))
        led, late = self.wave(self.run_scene("led", SCENE + WAVES + ZONES))
        raised, later = self.wave(self.run_scene("raised", SCENE + "[sea.initial]\nsettle_s = 0.5\n" + ZONES))   # the sea's clock is not the scene's
        print(f"height of the last two periods: {alone:.3f} of the waves' left alone, {led:.3f} led, {raised:.3f} raised from rest; phases {late:+.3f}, {later:+.3f}", flush=True)
        self.assertLess(alone, 0.8)
        self.assertGreater(led, 0.9)
        self.assertLess(led, 1.03)
        self.assertLess(max(abs(late), abs(later)), 0.15)
        self.assertAlmostEqual(raised, led, delta=0.05)

    def test_waves_that_fit_no_whole_number_of_times_between_the_sides_keep_theirs_too(self):
        tank = SCENE.replace("period_s = 8.8", "period_s = 10.0")   # 226 m are 1.64 waves
        for sides in ("periodic", "wall"):
            history = self.run_scene(sides, tank.replace('"periodic"', f'"{sides}"') + WAVES + ZONES)
            energy = [row["sea.kinetic_energy_J"] for row in rows(history)]
            self.assertLess(max(energy), 1.3 * energy[0])   # water left alone at the sides sways: three times
            height, late = self.wave(history, 10.0)
            print(f"{sides}: height of the last two periods {height:.3f} of the waves', phase {late:+.3f}", flush=True)
            self.assertGreater(height, 0.85)
            self.assertLess(height, 1.03)
            self.assertLess(abs(late), 0.15)

    def test_restarts_and_ranks_leave_every_bit(self):
        text = SCENE.replace("44.0", "3.0") + WAVES + "settle_s = 0.5\n" + ZONES
        whole = self.run_scene("whole", text).read_text()
        self.assertEqual(self.run_scene("ranks", text, ranks=2).read_text(), whole)
        self.run_scene("parts", text, "--until", "1.2")
        self.assertEqual(self.run_scene("parts", text, "--restart").read_text(), whole)

    def test_zones_without_waves_are_refused(self):
        for change, words in ((SCENE.split("[waves]")[0] + "[sea]" + SCENE.split("[sea]")[1], "has no waves to bring the water to"),
                              (SCENE + '[sea.initial]\nstate = "standing"\n', "[waves] travels")):
            scene = self.path / "scene.toml"
            scene.write_text(change + ZONES)
            done = spindrift("check", scene)
            self.assertEqual(done.returncode, 2)
            self.assertIn("sea.damping_zones[1].towards", done.stdout + done.stderr)
            self.assertIn(words, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
