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
          "standing": "validation/standing_wave/standing_wave.toml", "sections": "../tests/extremes/sections.toml", "potential": "../tests/extremes/potential.toml", "line": "../tests/extremes/line.toml",
          "twin": "control/twin_rotor_floater.toml", "paper": "leble_barakos/case1_paper.toml", "blades": "leble_barakos/flexible_blades.toml",
          "nrel": "validation/actuator/nrel_5mw_line.toml"}
BLUNDERS = tomllib.loads((ROOT / "tests/extremes/blunders.toml").read_text(encoding="utf-8"))["blunder"]


def named(said, what):
    """By a warning about the key, or by an error."""
    warnings = [line for line in said.stdout.splitlines() if line.strip().startswith("warning: ")]
    return any(what in line for line in warnings) or (said.returncode == 2 and what in said.stderr + said.stdout)


TURBINES = ROOT / "inputs/turbines"


FILES = {"planform": "dtu_10mw/planform.csv", "operation": "dtu_10mw_operation.csv", "turbine": "dtu_10mw.toml", "controller": "dtu_10mw_controller.toml"}


def table_copy(path, copy, slip):
    """A table with what the slip says: a column by a factor, or cut after so many rows."""
    rows = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    table = list(csv.reader(rows))
    if "times" in slip:
        column = table[0].index(slip["column"])
        for row in table[1:]:
            row[column] = repr(slip["times"] * float(row[column]))
    copy.write_text("\n".join(map(",".join, table[:slip.get("rows", len(table)) + 1])) + "\n")


def text_copy(path, slip):
    """A text with other lines."""
    text = path.read_text(encoding="utf-8")
    for old, new in slip.items():
        assert old in text, old
        text = text.replace(old, new)
    return text


def turbine_copy(folder, blunder):
    """The DTU turbine with the slips that the table names; its path."""
    for name in ("planform", "operation"):
        table_copy(TURBINES / FILES[name], folder / f"{name}.csv", blunder.get(name, {}))
    (folder / "controller.toml").write_text(text_copy(TURBINES / FILES["controller"], blunder.get("controller", {})))
    text = text_copy(TURBINES / FILES["turbine"], blunder.get("turbine", {}))
    if blunder["scene"] != "rotor_demo":   # outlines are for resolved blades, and have rules of their own for thickness
        text = re.sub(r"aerofoils = \[.*?\n\]\n", "", text, flags=re.DOTALL)
    for name, copy in (("planform", "planform.csv"), ("operation", "operation.csv"), ("controller", "controller.toml")):
        text = text.replace(f'"{FILES[name]}"', f'"{copy}"')
    (folder / "turbine.toml").write_text(text.replace('"dtu_10mw', f'"{TURBINES}/dtu_10mw'))
    return folder / "turbine.toml"


class Blunders(unittest.TestCase):
    nightly = False

    def test_there_are_a_hundred(self):
        self.assertGreaterEqual(len(BLUNDERS), 100)

    def test_each_is_named(self):
        for blunder in (b for b in BLUNDERS if b.get("nightly", False) == self.nightly):
            with self.subTest(blunder["what"]), tempfile.TemporaryDirectory() as folder:
                settings = [text.replace("@files", str(ROOT / "tests/extremes/files")) for text in blunder.get("set", [])]
                if FILES.keys() & blunder.keys():
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
