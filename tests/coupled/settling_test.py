"""Air that settles before the run: killed there, it goes on from where it was kept, with the same bits. What failed: settling_file_test.cpp.
Usage: settling_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import subprocess
import time
import unittest

from actuator_air_test import FLOATING
from running import Folder, PROGRAM, spindrift

# Cells enough that the march goes in pieces; a state is kept after each as soon as the clock allows.
SCENE = FLOATING.replace("air_steps = 10", "air_steps = 60").replace("cell_m = 22.0", "cell_m = 8.0").replace("end_s = 2.4", "end_s = 0.6") + """
[checkpoint]
wall_interval_s = 0.001
"""


class Settling(Folder):
    def setUp(self):
        super().setUp()
        self.scene = self.path / "scene.toml"
        self.scene.write_text(SCENE)

    def words(self, name, *more):
        return ["run", self.scene, "--quiet", "--no-report", "--out", self.path / name, *more]

    def test_killed_while_it_settles_a_run_goes_on_with_the_same_bits(self):
        whole = spindrift(*self.words("whole"))
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertFalse((self.path / "whole/settling").exists())
        running = subprocess.Popen([PROGRAM, *map(str, self.words("parts"))], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until = time.monotonic() + 300
        while not list((self.path / "parts/settling").glob("checkpoint_*.h5")):
            self.assertIsNone(running.poll(), "the run ended before anything was kept")
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)
        running.kill()
        running.wait()
        self.assertFalse((self.path / "parts/checkpoints").exists() and list((self.path / "parts/checkpoints").glob("*.h5")))
        again = spindrift(*self.words("parts", "--restart"))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("the air goes on settling after", (self.path / "parts/log.txt").read_text())
        self.assertFalse((self.path / "parts/settling").exists())
        self.assertEqual((self.path / "whole/history.csv").read_text(), (self.path / "parts/history.csv").read_text())

    def test_air_of_another_scene_is_not_gone_on_with(self):
        running = subprocess.Popen([PROGRAM, *map(str, self.words("parts"))], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not list((self.path / "parts/settling").glob("checkpoint_*.h5")):
            self.assertIsNone(running.poll(), "the run ended before anything was kept")
            time.sleep(0.01)
        running.kill()
        running.wait()
        self.scene.write_text(SCENE.replace("speed_m_s = 11.0", "speed_m_s = 10.0").replace("air_steps = 60", "air_steps = 2"))
        again = spindrift(*self.words("parts", "--restart", "--set", "aero.flow.unconverged_share=1"))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("settled for another scene: it begins anew", again.stderr + again.stdout + (self.path / "parts/log.txt").read_text())


if __name__ == "__main__":
    unittest.main()
