"""`spindrift check` knows: each slip of tests/extremes/blunders.toml is named, and the scenes of inputs raise no doubt.
Usage: blunders_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import pathlib
import subprocess
import sys
import tomllib
import unittest

ROOT = pathlib.Path(__file__).parents[2]
PROGRAM = sys.argv.pop(1)
SCENES = {"case1": "leble_barakos/case1_engineering.toml", "case2": "leble_barakos/case2_engineering.toml",
          "case3": "leble_barakos/case3_engineering.toml", "oc3": "validation/oc3_heave_decay/oc3_heave_decay.toml"}
BLUNDERS = tomllib.loads((ROOT / "tests/extremes/blunders.toml").read_text(encoding="utf-8"))["blunder"]


def check(scene, overrides=()):
    words = [PROGRAM, "check", str(scene)]
    for text in overrides:
        words += ["--set", text]
    return subprocess.run(words, capture_output=True, text=True, check=False, timeout=300)


def named(said, what):
    """By a warning about the key, or by an error."""
    warnings = [line for line in said.stdout.splitlines() if line.strip().startswith("warning: ")]
    return any(what in line for line in warnings) or (said.returncode == 2 and what in said.stderr + said.stdout)


class Blunders(unittest.TestCase):
    def test_there_are_forty(self):
        self.assertGreaterEqual(len(BLUNDERS), 40)

    def test_each_is_named(self):
        for blunder in BLUNDERS:
            with self.subTest(blunder["what"]):
                said = check(ROOT / "inputs" / SCENES[blunder["scene"]], blunder["set"])
                self.assertIn(said.returncode, (0, 2), said.stderr)
                self.assertTrue(named(said, blunder["named"]), f"\n{said.stdout[:3000]}\n{said.stderr}")


class Inputs(unittest.TestCase):
    def test_the_scenes_of_inputs_raise_no_doubt(self):
        for scene in sorted((ROOT / "inputs").rglob("*.toml")):
            text = scene.read_text(encoding="utf-8")
            if "studies" in scene.parts or "turbines" in scene.parts or "grids" in scene.parts or ("[time]" not in text and "base" not in text):
                continue
            if "paper" in scene.name or "fine" in scene.name:  # too large to be counted in a moment
                continue
            with self.subTest(scene.name):
                said = check(scene)
                if said.returncode == 0:
                    self.assertNotIn("warning: ", said.stdout)


if __name__ == "__main__":
    unittest.main()
