"""The blade-resolved rotor as a user runs it: history, loads along the span, what `check` says, a restart, what is refused.
Usage: rotor_run_test.py SPINDRIFT"""
import json
import re
import unittest

from running import Folder, ROOT, rows, spindrift

SCENE = ROOT / "inputs/leble_barakos/rotor_demo.toml"
# 6 400 cells a sector.
TINY = [f"aero.grid.{key}" for key in ("cells_round=28", "cells_layers=6", "first_cell_chords=4e-3")]
TINY += ["aero.flow.viscous=none", "aero.flow.blades=no_slip", "aero.flow.krylov_steps=8"]
TURNING = ["aero.flow.time=bdf2", "aero.flow.max_pseudo_steps=3", "aero.flow.drop=0", "time.window_s=0.05", "time.end_s=0.2"]


class RotorRun(Folder):
    def table(self, name):
        return rows(self.out / name)

    def test_a_steady_run_leaves_thrust_torque_power_and_loads_along_the_span(self):
        done = spindrift("run", SCENE, "--out", self.out, settings=[*TINY, "time.end_s=40", "aero.flow.drop=0"])
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        last = self.table("history.csv")[-1]
        self.assertGreater(last["rotor.thrust_N"], 3e5)
        self.assertAlmostEqual(last["rotor.power_W"] / (last["rotor.torque_N_m"] * 0.92530), 1.0, places=4)
        self.assertAlmostEqual(last["rotor.rpm"], 8.836, places=9)
        report = (self.out / "report.html").read_text()
        for picture in ("Pressure on a blade", "Wind in the plane of the axis"):  # vortices from 100,000 cells up
            self.assertIn(picture, report)
        rows = self.table("spanwise.csv")
        self.assertGreater(len(rows), 8)
        thrusts = [row["rotor.thrust_N"] for row in self.table("history.csv")][-13:]  # the last third, as the summary's means
        self.assertAlmostEqual(3.0 * sum(r["normal_N_m"] * r["length_m"] for r in rows) / (sum(thrusts) / len(thrusts)), 1.0, places=5)  # lengths have six digits

    def test_thrust_is_that_of_the_blades_also_where_the_hub_has_loads(self):
        hub = 'aero.flow.boundaries=[{patch="hub", condition="slip"}]'
        done = spindrift("run", SCENE, "--out", self.out, settings=[*TINY, *TURNING, "aero.grid.sectors=all", hub, "time.end_s=0.05", "aero.flow.max_pseudo_steps=2"])
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        last = self.table("history.csv")[-1]
        self.assertAlmostEqual(last["rotor.thrust_N"] / sum(last[f"rotor.blade_{b}.thrust_N"] for b in (1, 2, 3)), 1.0, delta=1e-9)

    def test_a_turning_rotor_has_columns_by_blade_and_restarts_with_the_same_digits(self):
        whole = [*TINY, *TURNING, "aero.grid.sectors=all"]
        done = spindrift("run", SCENE, "--out", self.out, settings=whole)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        expected = self.table("history.csv")
        self.assertEqual(len(expected), 4)
        self.assertAlmostEqual(expected[-1]["rotor.azimuth_deg"], 8.836 * 6.0 * 0.2, places=6)
        blades = sum(expected[-1][f"rotor.blade_{b}.thrust_N"] for b in (1, 2, 3))
        self.assertAlmostEqual(blades / expected[-1]["rotor.thrust_N"], 1.0, places=10)
        self.out = self.out.with_name("again")
        self.assertEqual(spindrift("run", SCENE, "--out", self.out, "--until", 0.1, settings=whole).returncode, 0)
        again = spindrift("run", SCENE, "--out", self.out, "--restart", settings=whole)
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
        self.assertEqual(self.table("history.csv"), expected)

    def test_check_tells_size_and_cost(self):
        done = spindrift("check", SCENE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for words in ("blade_resolved", "1 sector, periodic", "cells", "MB", "core-hours", "y+ as on a flat plate of the blade's chord", "by the law of the wall"):
            self.assertIn(words, done.stdout)
        self.assertNotIn("y+ of first cells is", done.stdout)

    def test_check_doubts_walls_that_their_cells_do_not_suit(self):
        for settings, words in ((["aero.flow.blades=no_slip"], "resolved walls want 0 to 5"), (["aero.flow.blades=wall_function", "aero.grid.y_plus=2"], "wall-function walls want 15 to 1000"),
                                (["aero.grid.y_plus=1"], ""), (["aero.grid.y_plus=60"], "")):
            with self.subTest(settings=settings):
                done = spindrift("check", SCENE, settings=settings)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertIn("First cells at walls", done.stdout)
                self.assertIn(words, done.stdout) if words else self.assertNotIn("y+ of first cells is", done.stdout)

    def growth(self, text):
        """In the middle and at most, as a doubt has them."""
        return [float(v) for v in re.search(r"cells grow from layer to layer off resolved walls by ([\d.]+) in the middle, ([\d.]+) at most", text).groups()]

    def test_check_foretells_the_growth_that_the_run_doubts(self):
        resolved = ["aero.flow.blades=no_slip", "aero.grid.y_plus=1"]
        done = spindrift("check", SCENE, settings=resolved)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"growth off resolved +\d\S* in the middle, \d\S* at most, up to y\+ 300")
        self.assertRegex(done.stdout, r"warning: cells grow from .*; raise aero.grid.cells_layers\n")
        foretold = self.growth(done.stdout)
        done = spindrift("run", SCENE, "--out", self.out, "--no-report", settings=[*resolved, "time.end_s=4", "aero.flow.drop=0", "output.expected=[]"])
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        [said] = [text for text in json.loads((self.out / "summary.json").read_text())["numerical_trouble"] if "cells grow" in text]
        self.assertTrue(said.endswith("raise aero.grid.cells_layers"), said)
        for ours, theirs in zip(foretold, self.growth(said)):
            self.assertAlmostEqual(ours / theirs, 1.0, delta=0.1)
        done = spindrift("check", SCENE, settings=[*resolved, "aero.grid.cells_layers=40"])
        self.assertIn("growth off resolved", done.stdout)
        self.assertNotIn("warning: cells grow", done.stdout)
        self.assertNotIn("growth off", spindrift("check", SCENE).stdout)  # by the law of the wall

    def test_wind_across_the_axis_is_refused_where_flow_is_to_be_steady(self):
        done = spindrift("check", SCENE, settings=["wind.direction_deg=20"])
        self.assertEqual(done.returncode, 2)
        self.assertIn("needs the wind along the rotor axis; it is 20 degrees off", done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
