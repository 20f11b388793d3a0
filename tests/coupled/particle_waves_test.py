"""Wavemakers in a tank of particles beside the piston of wave_tank_test.cpp: a flap makes Biesel's height, a sea state has its significant
height at the gauges, and its seed decides it. Runs the program on inputs/validation/wave_tank/small_tank.toml, three particles per height.
Usage: particle_waves_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import csv
import importlib.machinery
import importlib.util
import os
import statistics
import sys
import unittest

from running import Folder, REPLICA, ROOT, spindrift

SCENE = ROOT / "inputs/validation/wave_tank/small_tank.toml"
HEIGHT, PERIOD = 0.12, 1.5
COARSE = [f"waves.height_m={HEIGHT}", "sea.particles.spacing_m=0.04"]

sys.dont_write_bytecode = True  # none beside the script
loader = importlib.machinery.SourceFileLoader("wave_analysis", str(ROOT / "ci/wave_analysis"))
wave_analysis = importlib.util.module_from_spec(importlib.util.spec_from_loader("wave_analysis", loader))
loader.exec_module(wave_analysis)


class ParticleWaves(Folder):
    def run_scene(self, name, *changes):
        out = self.path / name
        done = spindrift("run", SCENE, "--out", out, "--no-report", "--quiet", settings=[*COARSE, *changes, *REPLICA], env={**os.environ, "OMP_NUM_THREADS": "1"})
        self.assertEqual(done.returncode, 0, done.stderr)
        return out

    def series(self, out, column):
        with open(out / "history.csv") as file:
            return [(float(row["time_s"]), float(row[column])) for row in csv.DictReader(file)]

    def test_a_flap_makes_biesels_height_and_the_speed_of_linear_theory(self):
        out = self.run_scene("flap", "waves.model=airy", "sea.wavemaker.type=flap", "time.end_s=7.5")
        found = wave_analysis.analyse(out, 6.0, 7.5)
        print("flap:", {key: round(found[key], 4) for key in ("height_ratio", "phase_speed_ratio", "reflection")}, flush=True)
        self.assertAlmostEqual(found["height_ratio"], 1.0, delta=0.03)       # four jittered starts: 1.010 to 1.020
        self.assertAlmostEqual(found["phase_speed_ratio"], 1.0, delta=0.02)  # 1.006 to 1.010
        self.assertLess(found["reflection"], 0.03)                           # 0.008 to 0.011

    def test_the_analysis_says_what_a_run_lacks(self):
        scene = "[environment]\nwater_depth_m = 1.0\ngravity_m_s2 = 9.81\n[waves]\nheight_m = 0.1\nperiod_s = 1.5\n"
        gauge = '[[sea.gauges]]\nname = "g{0}"\npoint_m = [{0}.0, 0.0]\n'
        for text, words in ((scene.replace("period_s = 1.5", "period_s = 0.0"), "no waves of one height"), (scene + "".join(map(gauge.format, range(3))), "3 wave gauges"),
                            (scene + "".join(map(gauge.format, range(4))), "shorter than one period of 1.5 s")):
            (self.path / "scene.toml").write_text(text)
            (self.path / "history.csv").write_text("time_s\n0.0\n0.1\n")
            with self.assertRaisesRegex(wave_analysis.Refused, words):
                wave_analysis.analyse(self.path)
        with self.assertRaisesRegex(wave_analysis.Refused, "cannot be read"):
            wave_analysis.analyse(self.path / "nowhere")

    def test_a_sea_state_has_its_significant_height_and_its_seed_decides_it(self):
        long = self.run_scene("seven", "waves.model=jonswap", "waves.seed=7", "time.end_s=15.0")
        for gauge in ("g1", "g3", "g5"):  # seven peak periods: the sample itself scatters by more than the gauges do; four jittered starts: 0.91 to 0.96
            eta = [e for t, e in self.series(long, f"{gauge}.elevation_m") if t > 4.0]
            print(f"{gauge}: significant height {4.0 * statistics.pstdev(eta) / HEIGHT:.4f} of the target", flush=True)
            self.assertAlmostEqual(4.0 * statistics.pstdev(eta) / HEIGHT, 1.0, delta=0.2)
        paddle = {}
        for name, seed, model in (("again", 7, "jonswap"), ("eight", 8, "jonswap"), ("full", 7, "pierson_moskowitz")):
            out = self.run_scene(name, f"waves.model={model}", f"waves.seed={seed}", "time.end_s=1.5")
            paddle[name] = self.series(out, "wavemaker.displacement_m")
        first = [row for row in self.series(long, "wavemaker.displacement_m") if row[0] <= 1.5 + 1e-9]
        self.assertEqual(paddle["again"], first)
        for other in ("eight", "full"):
            self.assertGreater(max(abs(a[1] - b[1]) for a, b in zip(paddle[other], first)), 0.001)


if __name__ == "__main__":
    unittest.main()
