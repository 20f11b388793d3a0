"""import spindrift: a run from a scene, its columns, units, means and fields, a study, and what is said where something is missing.
Usage: spindrift_test.py PROGRAM. SPDX-License-Identifier: Apache-2.0"""
import os
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
os.environ["SPINDRIFT"] = str(pathlib.Path(sys.argv.pop(1)).resolve())
sys.path.insert(0, str(ROOT / "src/python"))
sys.dont_write_bytecode = True

import numpy as np

import spindrift


class Python(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="spindrift_python_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_a_scene_gives_its_result(self):
        run = spindrift.run(ROOT / "inputs/tutorials/pendulum.toml", self.folder / "run", set={"time.end_s": 2.0, "output.title": "a \"text\""}, report=False)
        self.assertEqual(run.exit_code, 0)
        self.assertEqual(run.scene["output"]["title"], 'a "text"')
        self.assertEqual(run.time[-1], 2.0)
        self.assertEqual(run.units["weight.x_m"], "m")
        self.assertIn("surge", run.meanings["weight.x_m"])
        self.assertIn("line.tension_N", run)
        self.assertAlmostEqual(run.mean("time_s", after=1.0), 1.5, delta=0.03)
        self.assertEqual(len(run["weight.x_m"]), len(run))
        again = spindrift.open(self.folder / "run")
        np.testing.assert_array_equal(again["weight.z_m"], run["weight.z_m"])
        with self.assertRaisesRegex(KeyError, "near: weight.x_m"):
            run["wieght.x_m"]
        with self.assertRaisesRegex(FileNotFoundError, "no fields 'air'"):
            run.fields("air")

    def test_what_fails_says_why(self):
        with self.assertRaises(spindrift.RunFailed) as failed:
            spindrift.run(ROOT / "inputs/tutorials/pendulum.toml", self.folder / "run", set={"time.end_s": -1.0})
        self.assertEqual(failed.exception.code, 2)
        self.assertIn("time.end_s", str(failed.exception))
        with self.assertRaisesRegex(FileNotFoundError, "no history.csv"):
            spindrift.open(self.folder)
        with self.assertRaisesRegex(FileNotFoundError, "no study.json"):
            spindrift.open_study(self.folder)

    def test_fields_have_times_names_and_units(self):
        scene = ROOT / "inputs/validation/floating_box/floating_box.toml"
        run = spindrift.run(scene, self.folder / "run", report=False, set={"sea.particles.spacing_m": 0.08, "time.window_s": 0.04, "time.end_s": 0.2,
                                                                           "sea.initial.settle_s": 0.08, "sea.fields.interval_s": 0.08})
        fields = run.fields("particles")
        self.assertGreaterEqual(len(fields), 2)
        self.assertEqual(sorted(f.time for f in fields), [f.time for f in fields])
        self.assertIn("position", fields[0].names())
        self.assertEqual(fields[0]["position"].shape[1], 3)
        self.assertEqual(fields[0].unit("velocity"), "m/s")


if __name__ == "__main__":
    unittest.main()
