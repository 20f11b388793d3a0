"""A hundred mistakes of users: commands, paths, formats, keys, physics. Each ends with code 2 and says what, where, the value and what to do.
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
WING = ROOT / "inputs/validation/naca0012/family.toml"
TURBINE = ROOT / "inputs/turbines/dtu_10mw.toml"
STUDY = ROOT / "inputs/tutorials/steps.toml"
BOX = ROOT / "inputs/validation/floating_box/floating_box.toml"
PENDULUM = ROOT / "inputs/tutorials/pendulum.toml"


def check(*overrides, scene=CASE1):
    return ("check", scene, *(word for text in overrides for word in ("--set", text)))


# What was typed | what the answer says is wrong | where (command, option, file or key) | the value | what to do
MISTAKES = [
    # commands
    (("rnu", CASE1), "there is no command", "", "'rnu'", "did you mean 'run'"),
    ((str(CASE1),), "is a file", "", str(CASE1), "spindrift run"),
    (("simulate", CASE1), "there is no command", "", "'simulate'", "known: run, check"),
    (("run",), "scene is required", "", "", "--help"),
    (("run", CASE1, "--untill", "3"), "there is no option", "run:", "'--untill'", "did you mean '--until'"),
    (("check", CASE1, "--colour"), "there is no option", "check:", "'--colour'", "spindrift check --help"),
    (("run", CASE1, "--until", "-3"), "before the start", "--until", "-3 s", "give a time >= 0"),
    (("run", CASE1, "--until", "soon"), "is no number", "--until", "'soon'", "seconds"),
    (("run", CASE1, "--restart"), "requires", "--restart", "", "--out"),
    (("run", CASE1, "--fluid", "water"), "not in", "--fluid", "water", "{air,sea}"),
    (("help", "rnu"), "there is no command", "help", "'rnu'", "--help"),
    ((), "Usage: spindrift", "run", "", "spindrift help run"),
    (("run", PENDULUM, CASE1), "one word too many", "run:", str(CASE1), "--help"),
    (("help", "run", "check"), "one word too many", "help:", "'check'", "--help"),
    (("run", CASE1, "--set", "time.end_s", "60"), "--set time.end_s 60", "run:", "60", "write --set time.end_s=60"),
    (("run", CASE1, "-trace"), "there is no option", "run:", "'-trace'", "'--trace'"),
    (("run", CASE1, "--out", ""), "is empty", "--out", "", "name a folder"),
    (("run", CASE1, "--out", "q", "--restart", "--overwrite"), "excludes", "--overwrite", "", "--restart"),
    (("run", CASE1, "--trace", "--windows", "3:1"), "end before they begin", "--windows", "3:1", ""),
    (("run", CASE1, "--windows", "3:12"), "says which windows", "--windows", "3:12", "give one of these"),
    (("film", "EMPTY", "--camera", "back"), "not in", "--camera", "back", "{scene,side,front,top,rotor}"),
    (("film", "EMPTY", "--seconds", "0"), "not in range", "--seconds", "0", "0.5"),
    (("replay", "EMPTY/none.jsonl"), "No such file", "none.jsonl", "", ""),
    (("replay", CASE1), "is no recording", "case1_engineering.toml", "", "--record-graph FILE"),
    (("profile", PENDULUM), "lacks one of them", "pendulum.toml", "", "spindrift run ends with a table"),
    (("grid", PENDULUM), "must name a turbine file", "rotor.turbine", "", "aero.flow.generate"),
    (("import", "none.fst", "-o", "x"), "no such file", "none.fst", "", ""),
    (("import", CASE1, "-o", "x"), "this is not an OpenFAST main file", "case1_engineering.toml", "EDFile", "version 3 to 5"),
    (("import", "deck.fst"), "is required", "--out", "", "--help"),
    (("reference", "time.end"), "no such section or key", "time.end", "", "did you mean 'time.end_s'"),
    # paths
    (("run", "nowhere.toml"), "no such file", "nowhere.toml", "", "in FOLDER"),
    (("run", ROOT / "inputs/tutorials/pendulun.toml"), "no such file", "pendulun.toml", "", "did you mean '" + str(ROOT / "inputs/tutorials/pendulum.toml")),
    (("run", ROOT / "input/tutorials/pendulum.toml"), "no such file", "pendulum.toml", "", f"there is no folder {ROOT}/input/tutorials"),
    (("run", STUDY), "a study, not a scene", "steps.toml", "", "spindrift study"),
    (("check", STUDY), "a study, not a scene", "steps.toml", "", "spindrift study"),
    (("study", CASE1), "a scene, not a study", "case1_engineering.toml", "", "spindrift run"),
    (("run", TURBINE), "a turbine file, not a scene", "dtu_10mw.toml", "", "rotor.turbine"),
    (("run", ROOT / "README.md"), "is not TOML", "README.md:3", "saw 's'", "expected '='"),
    (("check", str(PENDULUM)[:-5]), "no such file", "pendulum", "", "pendulum.toml"),
    (("check", "EMPTY"), "is a directory", "EMPTY", "", "not a scene file"),
    (("run", CASE1, "--out", CASE1), "a file of that name exists", "run directory", str(CASE1), "choose another with --out"),
    (("report", CASE1), "not a run directory", str(CASE1), "it is a file", "run SCENE --out FOLDER"),
    (("report", "nowhere"), "not a run directory", "nowhere", "there is nothing of that name", "run SCENE --out FOLDER"),
    (("report", "EMPTY"), "not a run directory", "EMPTY", "neither history.csv nor summary.json", "run SCENE --out FOLDER"),
    (("picture", "EMPTY"), "not a run directory", "EMPTY", "no history.csv", "run SCENE --out FOLDER"),
    (("film", "nowhere"), "not a run directory", "nowhere", "there is nothing of that name", "run SCENE --out FOLDER"),
    (check('rotor.turbine="none.toml"', scene=CASE3), "no such file", "rotor.turbine", "none.toml", "inputs/turbines"),
    # formats
    (("grid", ROTOR, "-o", "x.vtk"), "an ending that is not known", "--out", "'x.vtk'", "write one of .cgns, .p3d"),
    (("picture", "EMPTY", "-o", "x.tiff"), "an ending that is not known", "--out", "'x.tiff'", "write one of .png"),
    (("film", "EMPTY", "-o", "x.avi"), "an ending that is not known", "--out", "'x.avi'", "write one of .mp4, .webm"),
    (("report", "EMPTY", "-o", "x.pdf"), "an ending that is not known", "--out", "'x.pdf'", "write one of .html"),
    (check('aero.flow.grid="nowhere.cgns"', 'without=["aero.flow.generate"]', scene=WING), "no such file", "aero.flow.grid", "nowhere.cgns", "CGNS (.cgns), or Plot3D"),
    # keys
    (check("time.end=60"), "unknown key", "time.end", "60", "did you mean 'end_s'"),
    (check("time.window_s=-0.1"), "must be", "time.window_s", "-0.1", "> 0 and <= 1000 s"),
    (check("time.window_s=fast"), "not a text", "time.window_s", '"fast"', "must be a number in s"),
    (check("tiem.window_s=0.1"), "unknown section", "tiem", "", "did you mean [time]"),
    (check("sea.model=morisson"), "must be one of", "sea.model", '"morisson"', 'did you mean "morison"'),
    (check("aero.thurst_N=1"), "unknown key", "aero.thurst_N", "1", "did you mean 'thrust_N'"),
    (check("bodies.platform.mass_kg=0"), "must be", "bodies.platform.mass_kg", "= 0", "> 0 kg"),
    (check("bodies.platform.centre_m=[0.0, 1.0]"), "not a list of 2", "bodies.platform.centre_m", "[0.0, 1.0]", "a list of 3 numbers in m"),
    (check("moorings.line_downwind.body=barge"), "not in [bodies]", "moorings.line_downwind.body", '"barge"', "known: platform, rotor"),
    (check("joints.bearing.type=hinge"), "must be one of", "joints.bearing.type", '"hinge"', '"revolute"'),
    (check("time"), "is no override", "time", "", "SECTION.KEY=VALUE"),
    (check("sea.particles.spacing_m=1.0"), "has no effect here", "sea.particles", "model is morison", "only where model is sph"),
    (check("checkpoint.keep=2.5"), "not a number with a decimal point", "checkpoint.keep", "2.5", "must be an integer"),
    (check("time.end_s="), "has no value", "time.end_s", "", "write KEY=VALUE"),
    (check("=60"), "is no override", "=60", "", "write SECTION.KEY=VALUE"),
    (check("time.end_s=60s"), "is not TOML", "time.end_s", "60s", "expected digit"),
    (check("time.end_s=60,5"), "is not TOML", "time.end_s", "60,5", "decimals have a point"),
    (check('wind.speed_m_s="11 m/s"', scene=CASE3), "not a text", "wind.speed_m_s", '"11 m/s"', "a number in m/s"),
    (check("time.integrator=RK4"), "must be one of", "time.integrator", '"RK4"', 'did you mean "rk4"'),
    (check('without=["sea.modle"]'), "names a key that the base does not have", "without", '"sea.modle"', ""),
    (check('without=["bodies.platform.mass_kg"]'), "is missing and has no default", "bodies.platform.mass_kg", "", "mass"),
    (check("bodies.platform.cylinders[9].diameter_m=5.0"), "has 3 entries", "bodies.platform.cylinders[9].diameter_m", "5", "numbered from 0"),
    (check("rotor.joint=bear", scene=CASE3), "not in [joints]", "rotor.joint", '"bear"', "known: bearing"),
    (check('joints.bearing.bodies=["platform", "rotr"]', scene=CASE3), "not in [bodies]", "joints.bearing.bodies", '"rotr"', "known: platform, rotor, earth"),
    (check('wind.field="wind.bts"', scene=CASE3), "unknown key", "wind.field", '"wind.bts"', "turbulence"),
    (check("aero.flow.turbulence=k-epsilon", scene=WING), "must be one of", "aero.flow.turbulence", '"k-epsilon"', '"k_omega"'),
    (check('output.expected=[{column="platform.pitch_deg", mean=5.0, within=1.0}]', scene=CASE3), "is missing", "output.expected[0].source", "", "who says so"),
    (("reference", "windw"), "no such section or key", "", "windw", "did you mean 'wind'"),
    # physics
    (check("time.integrator=explicit_euler"), "is unstable at any step", "time.integrator", "explicit_euler", "use rk4 or symplectic"),
    (check("time.step_s=0.03"), "must divide the window of 0.1 s", "time.step_s", "0.03", "nearest: 0.0333"),
    (check("waves.height_m=20.0", scene=CASE3), "breaks above", "waves.height_m", "20 m", "12.42 m"),
    (check("waves.model=airy", "waves.period_s=0.0", scene=CASE3), "must be", "waves.period_s", "0.0", "> 0 s"),
    (check("environment.water_depth_m=-20.0"), "must be", "environment.water_depth_m", "-20.0", "> 0 and <= 12000 m"),
    (check("sea.particles.spacing_m=0.7", scene=BOX), "fewer than 4 particles", "sea.particles.spacing_m", "0.7", "over the depth of 0.6 m"),
    (check("sea.tank.x_m=[1.0, -1.0]", scene=BOX), "from the lower to the higher end", "sea.tank.x_m", "[1.0, -1.0]", "must go"),
    (check("bodies.platform.inertia_kg_m2=[1e9, 1e9, 1e12]"), "no mass can have it", "bodies.platform.inertia_kg_m2", "1e12", "exceeds the sum of the other two"),
    (check("bodies.platform.cylinders[0].end_m=[46.7, 0.0, -14.0]"), "the cylinder has no length", "bodies.platform.cylinders[0].end_m", "46.7", "is where start_m is"),
    (check("bodies.platform.cylinders[0].diameter_m=-5.0"), "must be", "bodies.platform.cylinders[0].diameter_m", "-5", "> 0 m"),
    (check("waves.direction_deg=400.0", scene=CASE3), "must be", "waves.direction_deg", "400", ">= -360 and <= 360 deg"),
    (check("time.window_s=500.0"), "a whole number of windows", "time.end_s", "150", "500 s"),
    (check("environment.water_depth_m=5.0"), "below the sea bed", "bodies.platform.cylinders[0]", "", "z = -5 m"),
    (check("sea.particles.spacing_m=20.0", scene=BOX), "too coarse", "bodies.box", "1 particle", "spacing of 20 m"),
    (check("aero.flow.incidence_deg=95.0", scene=WING), "must be", "aero.flow.incidence_deg", "95", ">= -90 and <= 90 deg"),
    (check("wind.speed_m_s=0.0", scene=WING), "the resolved air flows", "wind.speed_m_s", "0.0", "must be > 0"),
    (check("aero.flow.generate.far_m=2.0", scene=WING), "found 2", "aero.flow.generate.far_m", "2.0", "at least 5 chords"),
    (check('aero.flow.boundaries=[{patch="wall", condition="no_slip"}]', scene=WING), "no condition yet", "farfield", "448 faces", "boundaries = ["),
    (check('aero.flow.boundaries=[{patch="wall", condition="sticky"}]', scene=WING), "must be one of", "aero.flow.boundaries[0].condition", '"sticky"', '"no_slip"'),
]

# The same in a file of one's own: (its lines after `base`, the line at fault, what, key, value, what to do).
WRITTEN = [
    (CASE1, ["[time]", "end_s = 10", "windw_s = 0.1"], 4, "unknown key", "time.windw_s", "0.1", "did you mean 'window_s'"),
    (CASE1, ["[time]", "end_s = \"ten\""], 3, "not a text", "time.end_s", '"ten"', "must be a number in s"),
    (CASE1, ["[time", "end_s = 10"], 2, "is not TOML", "", "", ""),
    (CASE1, ["[time]", "end_s = 10", "end_s = 20"], 4, "is not TOML", "", "end_s", ""),
    (CASE1, ["[sea]", "model = morison"], 3, "is not TOML", "", "", "a text stands in quotes"),
    (CASE1, ["[moorings.line_downwind]", "tension_only = True"], 3, "is not TOML", "", "", "write true or false, in small letters"),
    (CASE1, ["[moorings.line_downwind]", 'tension_only = "true"'], 3, "must be true or false", "moorings.line_downwind.tension_only", '"true"', "not a text"),
    (CASE1, ["[time]", "end_s = 10,5"], 3, "is not TOML", "", "", "decimals have a point"),
    (CASE1, ["[time]", "end_s: 10"], 3, "is not TOML", "", "", "write KEY = VALUE"),
    (CASE1, ['[bodies."my platform"]', "mass_kg = 1.0"], 2, "letters, digits", 'bodies."my platform"', "", "'_' and '-' only"),
    (CASE1, ["[sae]", 'model = "none"'], 2, "unknown section", "sae", "", "did you mean [sea]"),
    (CASE1, ["[bodies.platform]", "", "mass_kg = -5.0"], 4, "must be", "bodies.platform.mass_kg", "-5.0", "> 0 kg"),
    (CASE1, ["[moorings.line_downwind]", 'model = "chain"'], 3, "must be one of", "moorings.line_downwind.model", '"chain"', '"catenary"'),
    (CASE3, ["[waves]", "period_s = 8.8", "height_m = 20.0"], 4, "breaks above", "waves.height_m", "20 m", "12.42 m"),
    (CASE3, ["[rotor]", 'turbine = "nowhere.toml"'], 3, "no such file", "rotor.turbine", "nowhere.toml", "inputs/turbines"),
    (BOX, ["[sea.tank]", "# too shallow", "x_m = [1.0, -1.0]"], 4, "from the lower to the higher end", "sea.tank.x_m", "[1.0, -1.0]", "must go"),
]


class Mistakes(unittest.TestCase):
    def test_there_are_fifty(self):
        self.assertGreaterEqual(len(MISTAKES) + len(WRITTEN), 110)

    def answer(self, words, folder):
        environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=folder, env=environment, timeout=120, check=False)
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode, 2, said)
        self.assertLess(len(said.splitlines()), 40, "an answer that floods hides itself:\n" + said)
        self.assertNotIn("terminate called", said)
        self.assertNotRegex(said, r"\d{60}")
        return said

    def test_each_is_answered(self):
        with tempfile.TemporaryDirectory(prefix="spindrift_mistakes_") as folder:
            folder = os.path.realpath(folder)
            (pathlib.Path(folder) / "EMPTY").mkdir()
            for words, what, where, value, remedy in MISTAKES:
                with self.subTest(" ".join(map(str, words))):
                    said = self.answer(words, folder)
                    for part in (what, where, value, remedy.replace("in FOLDER", f"in {folder}")):
                        self.assertIn(part, said)

    def test_file_and_line_are_named(self):
        with tempfile.TemporaryDirectory(prefix="spindrift_mistakes_") as folder:
            scene = pathlib.Path(folder) / "own.toml"
            for base, lines, line, what, key, value, remedy in WRITTEN:
                with self.subTest(" / ".join(lines)):
                    scene.write_text(f'base = "{base}"\n' + "\n".join(lines) + "\n", encoding="utf-8")
                    said = self.answer(("check", scene), folder)
                    wrong = next((one for one in said.splitlines() if f"{scene}:{line}: " in one), "")
                    for part in (what, key, value, remedy):
                        self.assertIn(part, wrong, said)


if __name__ == "__main__":
    unittest.main()
