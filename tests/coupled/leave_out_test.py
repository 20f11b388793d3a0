"""What `spindrift check --columns` says could be left out, against runs of the whole scene with and without it: effect and saving within a
factor two where they are large enough to be measured. Usage: leave_out_test.py SPINDRIFT [TEST...]. SPDX-License-Identifier: Apache-2.0"""
import csv
import json
import os
import pathlib
import re
import tempfile
import unittest

import numpy as np

from running import ROOT, spindrift

CASE3, OC3 = "inputs/leble_barakos/case3_engineering.toml", "inputs/validation/oc3_heave_decay/oc3_heave_decay.toml"
PITCH = "platform.pitch_deg"
SEA_STATE = ["waves.model=jonswap", "waves.height_m=6.0", "waves.period_s=10.0", "bodies.spar.displacement_m=[0.0,0.0,0.0]", "start.equilibrium=true"]
# Scene, column, overrides of the scene, what is left out and the overrides that leave it out.
CASES = [
    (CASE3, PITCH, [], "longer step", ["time.step_s=0.1"]),
    (CASE3, PITCH, [], "rows half as often", ["output.history_every=2"]),
    (CASE3, PITCH, [], "first-order waves", ["waves.model=airy"]),
    (CASE3, PITCH, [], "strips twice as long", ["sea.strip_length_m=10.0"]),
    (CASE3, "rotor.thrust_N", [], "no gyroscopic moments", ["bodies.platform.gyroscopic=false", "bodies.rotor.gyroscopic=false"]),
    (OC3, "spar.pitch_deg", SEA_STATE, "longer step", ["time.step_s=0.083333333333"]),
    (OC3, "spar.pitch_deg", SEA_STATE, "half the wave components", ["waves.components=100"]),
    (OC3, "spar.z_m", SEA_STATE, "strips twice as long", ["sea.strip_length_m=10.0"]),
    (OC3, "line_1.tension_N", SEA_STATE, "rows half as often", ["output.history_every=2"]),
    (OC3, "spar.z_m", SEA_STATE, "still water", None),
]


def said(scene, column, overrides):
    done = spindrift("check", ROOT / scene, "--columns", column, settings=overrides)
    return done.returncode, done.stdout + done.stderr


def run(scene, overrides, until, folder):
    """Processor seconds of a run, least of three: what others on the machine do only adds."""
    times = []
    for _ in range(3):
        spindrift("run", ROOT / scene, "--out", folder, "--overwrite", "--no-report", "--quiet", "--until", until, settings=overrides).check_returncode()
        times.append(json.loads(pathlib.Path(folder, "summary.json").read_text())["processor_seconds"])
    return min(times)


def measured(scene, column, overrides, until):
    """(mean, deviation, processor seconds without those of the start) over the last two thirds of the trial's time."""
    with tempfile.TemporaryDirectory() as scratch:
        seconds = run(scene, overrides, until, scratch + "/out")
        with open(scratch + "/out/history.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        seconds -= run(scene, overrides, rows[1]["time_s"], scratch + "/start")
    t, x = (np.array([float(r[k]) for r in rows]) for k in ("time_s", column))
    late = t >= t[0] + (t[-1] - t[0]) / 3.0
    t, x = t[late], x[late]
    mean = np.trapz(x, t) / (t[-1] - t[0])
    return mean, np.sqrt(np.trapz((x - mean) ** 2, t) / (t[-1] - t[0])), seconds


class LeaveOut(unittest.TestCase):
    def test_a_misspelt_column_is_named(self):
        code, text = said(CASE3, "platform.pitch_degg", [])
        self.assertEqual(code, 2)
        self.assertIn('did you mean "platform.pitch_deg"', text)

    def test_effect_and_saving_are_those_of_the_runs(self):
        for scene, column, overrides, name, leave in CASES:
            with self.subTest(f"{name} of {pathlib.Path(scene).stem}"):
                code, text = said(scene, column, overrides)
                self.assertEqual(code, 0, text)
                until = float(re.search(r"tried over (\S+) s", text).group(1))
                found = re.search(re.escape(name) + r"\s+saves (-?\d+) %.*\n\s+\S+: mean (\S+), deviation (\S+)\n", text)
                self.assertIsNotNone(found, text)
                if leave is None:
                    self.assertGreater(int(found.group(1)), 0)
                    continue
                saving, effects = int(found.group(1)) / 100.0, (float(found.group(2)), float(found.group(3)))
                own, other = measured(scene, column, overrides, until), measured(scene, column, overrides + leave, until)
                floor = 5e-3 * own[1]  # less is a matter of where the window of the means ends
                for stated, a, b in zip(effects, own, other):
                    if abs(b - a) > floor and abs(stated) > floor:
                        self.assertTrue(0.5 < stated / (b - a) < 2.0, f"stated {stated}, measured {b - a}")
                true = 1.0 - other[2] / own[2]
                if max(true, saving) > 0.2:
                    self.assertTrue(0.5 < saving / true < 2.0, f"stated {saving}, measured {true}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    unittest.main(verbosity=2)
