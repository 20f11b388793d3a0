"""What `check` predicts of a run, against the run: memory within 15 %; steps, evaluations and pseudo-steps, which the processor time goes with, within
1.5 times; cells and particles exactly. Scenes of each kind: bodies, flow in the plane (steady, in physical steps) and in space, particles in the plane and in
space. No clock is asked.
SPDX-License-Identifier: Apache-2.0"""
import csv
import json
import re
import unittest

from running import ROOT, Folder, sanitized, spindrift

# Scene, overrides, end of the run [s].
SCENES = {
    "bodies": ("inputs/leble_barakos/case3_engineering.toml", [], 10.0),
    "a steady flow that is tried until it has settled": ("inputs/validation/cylinder_low_mach/cylinder.toml", [], 200.0),
    "a steady flow of which the first steps are tried": ("inputs/tutorials/wing_section.toml", [], 400.0),
    "physical steps of a flow in the plane": ("inputs/validation/cylinder_re100/cylinder.toml", [], 0.06),
    "physical steps of a flow in space": ("inputs/validation/taylor_green/taylor_green.toml", [], 0.0088),
    "a disc of a controlled turbine": ("inputs/control/dtu_10mw_disc.toml", ["start.air_steps=2", "output.means_over_s=1.0"], 2.0),
    "particles in the plane": ("inputs/validation/wave_tank/small_tank.toml", [], 0.25),
    "particles in space, most walls dry": ("inputs/validation/dam_break/obstacle.toml", [], 0.04),
}

LED = """
[time]
end_s = 1.0
window_s = 0.01
[environment]
water_depth_m = 0.5
[waves]
model = "jonswap"
height_m = 0.01
period_s = 1.0
components = 20000
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 0.02
[sea.tank]
x_m = [0.0, 1.0]
top_m = 0.1
sides_x = "periodic"
[sea.initial]
state = "waves"
[[sea.damping_zones]]
from_m = 0.0
to_m = 0.5
rate_1_s = 2.0
towards = "{}"
"""


class Forecasts(Folder):
    def test_memory_and_counts_are_those_of_the_run(self):
        for name, (scene, more, end) in SCENES.items():
            with self.subTest(name):
                said = spindrift("check", ROOT / scene, settings=more)
                self.assertEqual(said.returncode, 0, said.stderr)
                done = spindrift("run", ROOT / scene, "--out", self.out, "--overwrite", "--no-report", "--quiet", "--until", end, settings=more)
                self.assertEqual(done.returncode, 0, done.stderr)
                summary = json.loads((self.out / "summary.json").read_text())
                self.memory(said.stdout, summary["peak_memory_bytes"])
                counts = summary["counts"]
                if "cells" in counts:
                    self.pseudo_steps(said.stdout, counts, end)
                elif "particles" in counts:
                    self.particles(said.stdout, counts, end)
                else:
                    each = int(re.search(r"windows of \S+ s, (\d+) steps? each", said.stdout).group(1))
                    self.assertEqual(counts["steps"], each * counts["windows"])

    def test_a_sea_that_takes_minutes_to_lay_out_is_counted(self):
        for scene, spacing, volume in (("free_sphere/free_sphere", 0.025, 4.18879), ("stl_buoy/stl_buoy", 0.0125, 1.07)):
            with self.subTest(scene):
                said = spindrift("check", ROOT / f"inputs/validation/{scene}.toml", settings=[f"sea.particles.spacing_m={spacing}"], timeout=60)
                self.assertEqual(said.returncode, 0, said.stderr)
                every, water, walls, bodies = (float(n) for n in re.search(r"^  particles +about (\S+) \((\S+) water, (\S+) walls, (\S+) bodies\)", said.stdout, re.M).groups())
                self.assertLess(abs(bodies * spacing**3 / volume - 1.0), 0.01)
                self.assertLess(abs((water + walls + bodies) / every - 1.0), 0.01)

    def test_a_spacing_that_would_fit_is_one_whose_forecast_fits(self):
        tank = ROOT / "inputs/validation/dam_break/koshizuka_oka.toml"
        refused = spindrift("check", tank, settings=["sea.particles.spacing_m=1e-6"])
        self.assertEqual(refused.returncode, 2, refused.stdout)
        there, fits = re.search(r"there are (\S+) GB; at least (\S+) would fit", refused.stdout + refused.stderr).groups()
        said = spindrift("check", tank, settings=[f"sea.particles.spacing_m={fits}"])
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertLess(float(re.search(r"^  memory +(\S+) GB", said.stdout, re.M).group(1)), float(there))

    def test_zones_that_lead_to_many_waves_are_in_the_cost(self):
        cost = {}
        for towards in ("rest", "waves"):
            scene = self.path / f"{towards}.toml"
            scene.write_text(LED.format(towards))
            said = spindrift("check", scene)
            self.assertEqual(said.returncode, 0, said.stderr)
            cost[towards] = float(re.search(r"^  predicted core-hours +(\S+)", said.stdout, re.M).group(1))
        self.assertGreater(cost["waves"], 5.0 * cost["rest"])  # 20,000 waves for each particle of half the water: fifty times its pairs

    def memory(self, said, measured):
        if sanitized():
            return
        number, unit = re.search(r"^  memory +(\S+) (MB|GB)", said, re.M).groups()
        self.assertLess(abs(float(number) * {"MB": 1e6, "GB": 1e9}[unit] / measured - 1.0), 0.15, f"{number} {unit}, measured {measured:.4g}")

    def within(self, predicted, measured, factor=1.5):
        self.assertLess(predicted, factor * measured)
        self.assertGreater(predicted, measured / factor)

    def pseudo_steps(self, said, counts, end):
        self.assertEqual(int(re.search(r"^  air +(\d+) cells", said, re.M).group(1)), counts["cells"])
        number, each_second = re.search(r"(\S+) pseudo-steps.*?( per simulated second)? of \S+ core-s each", said).groups()
        with open(self.out / "history.csv", encoding="utf-8") as file:
            steps = [float(row.get("flow.pseudo_steps") or row["air.pseudo_steps"]) for row in csv.DictReader(file)]
        if each_second:   # by as many of the first windows as half a second allows: on a slow processor two, which take fewer pseudo-steps than later ones
            self.within(float(number) * end, sum(steps[1:]) / len(steps[1:]) * counts["windows"], 2.0)
        else:
            self.within(float(number), len(steps))
            if "until it has settled at its rate" in said:
                slow = float(re.search(r"at its rate, up to (\S+) where that slows down", said).group(1))
                self.assertGreater(slow, float(number))   # by how much follows from how far the trial came in its time
                self.assertLessEqual(len(steps), slow)

    def particles(self, said, counts, end):
        self.assertEqual(int(re.search(r"^  particles +(\d+) \(", said, re.M).group(1)), counts["particles"])
        self.within(float(re.search(r"(\S+) evaluations of all per simulated second", said).group(1)) * end, counts["particle_evaluations"])


class Ranks(Folder):
    """Memory of a rank, beside its share: the program, messages, what all ranks have."""

    def test_memory_of_a_rank_is_that_of_the_run(self):
        if sanitized():
            return
        case = ROOT / "inputs/leble_barakos/case3_demo.toml"
        shorter = ["start.air_steps=4", "time.end_s=0.1"]
        said = spindrift("check", case, settings=shorter)
        self.assertEqual(said.returncode, 0, said.stderr)
        each = re.search(r"^  memory of a rank each +(.*)$", said.stdout, re.M).group(1).split(" MB")
        checkpoint = float(re.search(r"\((\S+) MB more while a checkpoint is written\)", said.stdout).group(1))
        for ranks, number in zip((1, 2, 8, 16), each):
            with self.subTest(ranks):
                done = spindrift("run", case, "--out", self.out, "--overwrite", "--no-report", "--quiet", settings=shorter, ranks=ranks, timeout=1200)
                self.assertEqual(done.returncode, 0, done.stderr)
                measured = json.loads((self.out / "summary.json").read_text())["peak_memory_bytes"] / ranks
                self.assertLess(abs((float(number) + checkpoint / ranks) * 1e6 / measured - 1.0), 0.15, f"{number} MB, measured {measured:.4g}")


if __name__ == "__main__":
    unittest.main()
