"""`spindrift check` knows: each slip of tests/extremes/blunders.toml is named. That the scenes of inputs raise no
doubt is held by program_test.py. Usage: blunders_test.py SPINDRIFT [CLASS...]. SPDX-License-Identifier: Apache-2.0"""
import tomllib
import unittest

from running import ROOT, spindrift

SCENES = {"case1": "leble_barakos/case1_engineering.toml", "case2": "leble_barakos/case2_engineering.toml",
          "case3": "leble_barakos/case3_engineering.toml", "case1_demo": "leble_barakos/case1_demo.toml",
          "oc3": "validation/oc3_heave_decay/oc3_heave_decay.toml", "own": "tutorials/own_turbine.toml", "gust": "tutorials/gust.toml",
          "floatbox": "validation/floating_box/floating_box.toml", "tank": "validation/wave_tank/small_tank.toml", "sphere": "validation/free_sphere/free_sphere.toml",
          "case3_demo": "leble_barakos/case3_demo.toml", "ftower": "leble_barakos/flexible_tower.toml", "pendulum": "tutorials/pendulum.toml",
          "naca": "validation/naca0012/family.toml", "re100": "validation/cylinder_re100/cylinder.toml", "section": "tutorials/wing_section.toml",
          "pitching": "validation/pitching_naca0012/pitching.toml", "rotor_demo": "leble_barakos/rotor_demo.toml", "disc": "validation/actuator/disc.toml",
          "linescene": "validation/actuator/line.toml"}
BLUNDERS = tomllib.loads((ROOT / "tests/extremes/blunders.toml").read_text(encoding="utf-8"))["blunder"]


def named(said, what):
    """By a warning about the key, or by an error."""
    warnings = [line for line in said.stdout.splitlines() if line.strip().startswith("warning: ")]
    return any(what in line for line in warnings) or (said.returncode == 2 and what in said.stderr + said.stdout)


class Blunders(unittest.TestCase):
    nightly = False

    def test_there_are_a_hundred(self):
        self.assertGreaterEqual(len(BLUNDERS), 100)

    def test_each_is_named(self):
        for blunder in (b for b in BLUNDERS if b.get("nightly", False) == self.nightly):
            with self.subTest(blunder["what"]):
                said = spindrift("check", ROOT / "inputs" / SCENES[blunder["scene"]], settings=blunder["set"])
                self.assertIn(said.returncode, (0, 2), said.stderr)
                self.assertNotIn("unknown key", said.stderr, "a slip of the table")
                self.assertTrue(named(said, blunder["named"]), f"\n{said.stdout[:3000]}\n{said.stderr}")


class Nightly(Blunders):
    nightly = True


if __name__ == "__main__":
    unittest.main()
