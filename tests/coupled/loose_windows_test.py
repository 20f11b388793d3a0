"""The longest window that `check` states for a loose scheme, against runs in waves of 5 cm: at 0.9 of it the floating system swings with them, at 1.1 ever more, until
its loads bound the swing or the run ends with exit code 3 and names the scheme. Two of them, the masses at their hubs 1,690 t and 460 t. Of the second cps makes
the roll grow, by hundredths of itself in a swing: there a run at half the limit, which `check` calls stable, stands beside one at twice as much.
SPDX-License-Identifier: Apache-2.0"""
import csv
import json
import re
import unittest

from running import ROOT, Folder, spindrift

SYSTEMS = {"the paper's": "inputs/leble_barakos/case3_engineering.toml", "a spar with a rotor half as large": "inputs/tutorials/own_turbine.toml"}
SCHEMES = {"cps": "cps", "cps2": "cps2", "css1": "css"}
SMALL = ["waves.height_m=0.05", "coupling.accept_unstable=true"]


def stated(scene):
    """Limit [s] by scheme, as `check` has it."""
    said = spindrift("check", ROOT / scene, settings=["coupling.scheme=cps2", *SMALL])
    found = re.findall(r"^  (\w+) +stable for windows up to (\S+) s", said.stdout, re.M)
    return {name: float(limit) for name, limit in found}


class Limits(Folder):
    def run_at(self, scene, scheme, window, windows=300, column="rotor.hub_vx_m_s"):
        """(Exit code, reason, swing of the column in the first third of the run, in the last)."""
        window, steps = float(f"{window:.5g}"), max(1, round(window / 0.05))
        done = spindrift("run", ROOT / scene, "--out", self.out, "--overwrite", "--no-report", "--quiet",
                         settings=[f"coupling.scheme={SCHEMES[scheme]}", *SMALL, f"time.window_s={window:.12g}", f"time.step_s={window / steps:.15g}",
                                   f"time.end_s={windows * window:.12g}"])
        with open(self.out / "history.csv", encoding="utf-8") as file:
            values = [float(row[column]) for row in csv.DictReader(file)]
        third = len(values) // 3
        swings = [0.5 * (max(part) - min(part)) for part in (values[third // 10:third], values[-third:])]
        return done.returncode, json.loads((self.out / "summary.json").read_text())["exit_reason"], *swings

    def test_a_window_beyond_the_limit_that_is_accepted_is_told_in_log_and_check(self):
        settings = ["coupling.scheme=cps2", "coupling.accept_unstable=true"]
        for window, told in ((5.0, True), (0.1, False)):
            with self.subTest(window=window):
                asked = [*settings, f"time.window_s={window}", f"time.end_s={4 * window}"]
                done = spindrift("run", ROOT / SYSTEMS["the paper's"], "--out", self.out, "--overwrite", "--no-report", "--quiet", settings=asked)
                self.assertEqual(done.returncode, 0, done.stderr)
                said = spindrift("check", ROOT / SYSTEMS["the paper's"], settings=asked).stdout
                for text in ((self.out / "log.txt").read_text(), said):
                    self.assertEqual("is above the limit of" in text and "accepted" in text, told, text)

    def test_runs_grow_from_the_window_that_check_states(self):
        for system, scene in SYSTEMS.items():
            limits = stated(scene)
            for scheme in SCHEMES:
                slow = (scene, scheme) == (SYSTEMS["a spar with a rotor half as large"], "cps")
                low, high, how = (0.5, 2.0, {"windows": 1500, "column": "spar.roll_deg"}) if slow else (0.9, 1.1, {})
                with self.subTest(system, scheme=scheme):
                    code, reason, early, below = self.run_at(scene, scheme, low * limits[scheme], **how)
                    self.assertEqual(code, 0, reason)
                    self.assertLess(below, 1.5 * early)
                    code, reason, early, above = self.run_at(scene, scheme, high * limits[scheme], **how)
                    if code != 0:
                        self.assertEqual(code, 3, reason)
                        self.assertIn("the loose scheme is unstable at a window of", reason)
                    else:
                        self.assertGreater(above, 3.0 * below)   # of the second cps2 grows to four times as much, where the loads bound it


if __name__ == "__main__":
    unittest.main()
