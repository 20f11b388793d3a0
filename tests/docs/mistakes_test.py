"""Fifty mistakes of users: commands, paths, formats, keys, physics. Each ends with the right code and says what, where, the value and what to do.
Usage: mistakes_test.py PROGRAM. SPDX-License-Identifier: Apache-2.0"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
CASE1 = ROOT / "inputs/leble_barakos/case1_engineering.toml"
CASE3 = ROOT / "inputs/leble_barakos/case3_engineering.toml"
ROTOR = ROOT / "inputs/leble_barakos/rotor_demo.toml"
WING = ROOT / "inputs/tutorials/wing_section.toml"
TURBINE = ROOT / "inputs/turbines/dtu_10mw.toml"
STUDY = ROOT / "inputs/tutorials/steps.toml"
BOX = ROOT / "inputs/validation/floating_box/floating_box.toml"


def check(*overrides, scene=CASE1):
    return ("check", scene, *(word for text in overrides for word in ("--set", text)))


# (command line, exit code, what the message must hold)
MISTAKES = [
    # commands
    (("rnu", CASE1), 2, ["rnu", "did you mean 'run'"]),
    ((str(CASE1),), 2, ["spindrift run"]),
    (("simulate", CASE1), 2, ["simulate", "run, check"]),
    (("run",), 2, ["scene"]),
    (("run", CASE1, "--untill", "3"), 2, ["untill"]),
    (("run", CASE1, "--until", "-3"), 2, ["-3 s", "before the start"]),
    (("run", CASE1, "--until", "soon"), 2, ["soon", "seconds"]),
    (("run", CASE1, "--restart"), 2, ["--out"]),
    (("run", CASE1, "--fluid", "water"), 2, ["water", "air"]),
    (("help", "rnu"), 2, ["rnu"]),
    # paths
    (("run", "nowhere.toml"), 2, ["nowhere.toml"]),
    (("run", STUDY), 2, ["steps.toml", "study", "spindrift study"]),
    (("check", STUDY), 2, ["spindrift study"]),
    (("study", CASE1), 2, ["spindrift run"]),
    (("run", TURBINE), 2, ["turbine file", "rotor.turbine"]),
    (("run", ROOT / "README.md"), 2, ["README.md"]),
    (("report", "nowhere"), 2, ["nowhere is not a run directory"]),
    (("report", "EMPTY"), 2, ["not a run directory", "history.csv"]),
    (("picture", "EMPTY"), 2, ["not a run directory"]),
    (("film", "nowhere"), 2, ["nowhere"]),
    (check('rotor.turbine="none.toml"', scene=CASE3), 2, ["none.toml"]),
    # formats
    (("grid", ROTOR, "-o", "x.vtk"), 2, ["x.vtk", ".cgns"]),
    (("picture", "EMPTY", "-o", "x.tiff"), 2, ["x.tiff", ".png"]),
    (("film", "EMPTY", "-o", "x.avi"), 2, ["x.avi", ".mp4"]),
    (("report", "EMPTY", "-o", "x.pdf"), 2, ["x.pdf", ".html"]),
    (check('aero.flow.generate.coordinates="nowhere.dat"', scene=WING), 2, ["nowhere.dat"]),
    (check(f'aero.flow.generate.coordinates="{TURBINE}"', scene=WING), 2, ["dtu_10mw.toml"]),
    # keys
    (check("time.end=60"), 2, ["time.end", "end_s"]),
    (check("time.window_s=-0.1"), 2, ["time.window_s", "-0.1", "> 0"]),
    (check("time.window_s=fast"), 2, ["time.window_s", "fast"]),
    (check("tiem.window_s=0.1"), 2, ["tiem", "time"]),
    (check("sea.model=morisson"), 2, ["morisson", "morison"]),
    (check("aero.thurst_N=1"), 2, ["thurst_N", "thrust_N"]),
    (check("bodies.platform.mass_kg=0"), 2, ["mass_kg", "0", "> 0"]),
    (check("bodies.platform.centre_m=[0.0, 1.0]"), 2, ["centre_m", "3"]),
    (check("moorings.line_downwind.body=barge"), 2, ["barge", "platform"]),
    (check("joints.bearing.type=hinge"), 2, ["hinge", "revolute"]),
    (check("time"), 2, ["time", "="]),
    (check("sea.particles.spacing_m=1.0"), 2, ["sea.particles", "sph"]),
    (check("checkpoint.keep=2.5"), 2, ["keep", "2.5"]),
    (("reference", "windw"), 2, ["windw", "did you mean"]),
    # physics
    (check("time.integrator=explicit_euler"), 2, ["explicit_euler", "platform"]),
    (check("time.step_s=0.03"), 2, ["step_s", "window"]),
    (check("waves.height_m=20.0", scene=CASE3), 2, ["waves.height_m", "20", "break"]),
    (check("waves.model=airy", "waves.period_s=0.0", scene=CASE3), 2, ["period_s", "0"]),
    (check("environment.water_depth_m=-20.0"), 2, ["water_depth_m", "-20"]),
    (check("sea.particles.spacing_m=0.7", scene=BOX), 2, ["spacing_m", "0.7"]),
    (check("sea.tank.x_m=[1.0, -1.0]", scene=BOX), 2, ["sea.tank.x_m"]),
    (check("wind.speed_m_s=0.0", scene=WING), 2, ["wind.speed_m_s"]),
    (check("aero.flow.generate.far_m=2.0", scene=WING), 2, ["far_m", "5 chords"]),
    (check('aero.flow.boundaries=[{patch="wall", condition="no_slip"}]', scene=WING), 2, ["farfield", "no condition yet", "boundaries = ["]),
    (check('aero.flow.boundaries=[{patch="wall", condition="sticky"}]', scene=WING), 2, ["sticky", "no_slip"]),
]


class Mistakes(unittest.TestCase):
    def test_there_are_fifty(self):
        self.assertGreaterEqual(len(MISTAKES), 50)

    def test_each_is_answered(self):
        with tempfile.TemporaryDirectory(prefix="spindrift_mistakes_") as folder:
            (pathlib.Path(folder) / "EMPTY").mkdir()
            environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
            for words, code, wanted in MISTAKES:
                with self.subTest(" ".join(map(str, words))):
                    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=folder, env=environment, timeout=120, check=False)
                    said = done.stdout + done.stderr
                    self.assertEqual(done.returncode, code, said)
                    for part in wanted:
                        self.assertIn(part, said)
                    self.assertLess(len(said.splitlines()), 40, "an answer that floods hides itself:\n" + said)
                    self.assertNotIn("terminate called", said)
                    self.assertNotRegex(said, r"\d{60}")


if __name__ == "__main__":
    unittest.main()
