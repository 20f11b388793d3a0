"""`spindrift check` knows: each slip of tests/extremes/blunders.toml is named. That the scenes of inputs raise no
doubt is held by program_test.py. Usage: blunders_test.py SPINDRIFT [CLASS...]. SPDX-License-Identifier: Apache-2.0"""
import csv
import pathlib
import re
import tempfile
import tomllib
import unittest

from running import ROOT, spindrift

SCENES = {"case1": "leble_barakos/case1_engineering.toml", "case2": "leble_barakos/case2_engineering.toml",
          "case3": "leble_barakos/case3_engineering.toml", "case1_demo": "leble_barakos/case1_demo.toml",
          "oc3": "validation/oc3_heave_decay/oc3_heave_decay.toml", "own": "tutorials/own_turbine.toml", "gust": "tutorials/gust.toml",
          "floatbox": "validation/floating_box/floating_box.toml", "tank": "validation/wave_tank/small_tank.toml", "sphere": "validation/free_sphere/free_sphere.toml",
          "controlled": "leble_barakos/case3_controlled.toml", "case3_demo": "leble_barakos/case3_demo.toml", "ftower": "leble_barakos/flexible_tower.toml", "pendulum": "tutorials/pendulum.toml",
          "naca": "validation/naca0012/family.toml", "re100": "validation/cylinder_re100/cylinder.toml", "section": "tutorials/wing_section.toml",
          "pitching": "validation/pitching_naca0012/pitching.toml", "rotor_demo": "leble_barakos/rotor_demo.toml", "disc": "validation/actuator/disc.toml",
          "linescene": "validation/actuator/line.toml", "tower": "validation/dtu_tower/dtu_tower.toml", "bridles": "tutorials/spar_on_bridles.toml",
          "standing": "validation/standing_wave/standing_wave.toml", "sections": "../tests/extremes/sections.toml", "potential": "../tests/extremes/potential.toml"}
BLUNDERS = tomllib.loads((ROOT / "tests/extremes/blunders.toml").read_text(encoding="utf-8"))["blunder"]


def named(said, what):
    """By a warning about the key, or by an error."""
    warnings = [line for line in said.stdout.splitlines() if line.strip().startswith("warning: ")]
    return any(what in line for line in warnings) or (said.returncode == 2 and what in said.stderr + said.stdout)


TURBINES = ROOT / "inputs/turbines"


def turbine_copy(folder, blunder):
    """The DTU turbine with the slips that the table names; its path."""
    rows = [line for line in (TURBINES / "dtu_10mw/planform.csv").read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    table = list(csv.reader(rows))
    if slip := blunder.get("planform"):
        column = table[0].index(slip["column"])
        for row in table[1:]:
            row[column] = repr(slip["times"] * float(row[column]))
    (folder / "planform.csv").write_text("\n".join(map(",".join, table)) + "\n")
    text = (TURBINES / "dtu_10mw.toml").read_text(encoding="utf-8")
    for old, new in blunder.get("turbine", {}).items():
        assert old in text, old
        text = text.replace(old, new)
    if blunder["scene"] != "rotor_demo":   # outlines are for resolved blades, and have rules of their own for thickness
        text = re.sub(r"aerofoils = \[.*?\n\]\n", "", text, flags=re.DOTALL)
    text = text.replace('"dtu_10mw/planform.csv"', '"planform.csv"').replace('"dtu_10mw', f'"{TURBINES}/dtu_10mw')
    (folder / "turbine.toml").write_text(text)
    return folder / "turbine.toml"


class Blunders(unittest.TestCase):
    nightly = False

    def test_there_are_a_hundred(self):
        self.assertGreaterEqual(len(BLUNDERS), 100)

    def test_each_is_named(self):
        for blunder in (b for b in BLUNDERS if b.get("nightly", False) == self.nightly):
            with self.subTest(blunder["what"]), tempfile.TemporaryDirectory() as folder:
                settings = list(blunder.get("set", []))
                if "planform" in blunder or "turbine" in blunder:
                    settings.append(f'rotor.turbine="{turbine_copy(pathlib.Path(folder), blunder)}"')
                said = spindrift("check", ROOT / "inputs" / SCENES[blunder["scene"]], settings=settings)
                self.assertIn(said.returncode, (0, 2), said.stderr)
                self.assertNotIn("unknown key", said.stderr, "a slip of the table")
                self.assertTrue(named(said, blunder["named"]), f"\n{said.stdout[:3000]}\n{said.stderr}")


    def test_a_run_says_what_looks_like_the_slip_before_it_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            said = spindrift("run", ROOT / "inputs" / SCENES["oc3"], "--out", pathlib.Path(folder) / "out", "--no-report",
                             settings=["bodies.spar.mass_kg=8.0654378e9", "start.equilibrium=true"])
        self.assertEqual(said.returncode, 2, said.stderr)
        both = said.stdout + said.stderr
        self.assertIn("in g? give kg", both)
        self.assertLess(both.index("in g? give kg"), both.index("start.equilibrium"))


class Nightly(Blunders):
    nightly = True


if __name__ == "__main__":
    unittest.main()
