"""Two hundred and twenty mistakes of users: commands, paths, formats, keys, physics. Each ends with code 2 and says what, where, the value and what to do.
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
TANK = ROOT / "inputs/validation/wave_tank/small_tank.toml"
BOX = ROOT / "inputs/validation/floating_box/floating_box.toml"
PENDULUM = ROOT / "inputs/tutorials/pendulum.toml"
SPAR = ROOT / "inputs/tutorials/spar_in_waves.toml"
OWN = ROOT / "inputs/tutorials/own_turbine.toml"
SECTION = ROOT / "inputs/tutorials/wing_section.toml"
GUST = ROOT / "inputs/tutorials/gust.toml"


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
    (("help", "rnu"), "there is no command", "help", "'rnu'", "did you mean 'run'?"),
    (("help", "piture"), "there is no command", "help", "'piture'", "did you mean 'picture'?"),
    (("version",), "there is no command", "", "'version'", "spindrift --version"),
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
    (("replay", CASE1, "--exact"), "all is simulated", "--exact", "", "give --copies or --weak"),
    (("replay", CASE1, "--ranks", "64", "--weak", "2048"), "131072 ranks", "--weak 2048", "131072", "at most 65536"),
    (("replay", CASE1, "--nodes", "8"), "more nodes than", "--nodes 8", "1 rank", ""),
    (("replay", CASE1), "is no recording", "case1_engineering.toml", "", "--record-graph FILE"),
    (("profile", PENDULUM), "lacks one of them", "pendulum.toml", "", "spindrift run ends with a table"),
    (("grid", PENDULUM), "must name a turbine file", "rotor.turbine", "", "aero.flow.generate"),
    (("import", "none.fst", "-o", "x"), "no such file", "none.fst", "", ""),
    (("import", CASE1, "-o", "x"), "this is not an OpenFAST main file", "case1_engineering.toml", "EDFile", "version 3 to 5"),
    (("import", "deck.fst"), "is required", "--out", "", "--help"),
    (("reference", "time.end"), "no such section or key", "time.end", "", "did you mean 'time.end_s'"),
    (("check",), "scene is required", "check:", "", "spindrift check --help"),
    (("profile",), "scene is required", "profile:", "", "spindrift profile --help"),
    (("RUN", CASE1), "there is no command", "", "'RUN'", "did you mean 'run'"),
    (("run", "check", CASE1), "one word too many", "run:", str(CASE1), "--help"),
    (("run", CASE1, "--threads", "4"), "there is no option", "run:", "'--threads'", "OMP_NUM_THREADS=4"),
    (("run", CASE1, "-n", "4"), "there is no option", "run:", "'-n'", "spindrift run --help"),
    (("run", CASE1, "--until", "1e99"), "longer than any run", "--until", "1e99 s", "at most 1000000 s"),
    (("run", CASE1, "--until", "nan"), "is no number of seconds", "--until", "'nan'", "spindrift run --help"),
    (("run", CASE1, "--windows", "x", "--trace"), "is no range of windows", "--windows", "'x'", "as 3:12"),
    (("run", CASE1, "--set"), "1 required TEXT missing", "--set", "", "spindrift run --help"),
    (("film", "EMPTY", "--rate", "0"), "not in range", "film: --rate", "0", "1 to 60"),
    (("reference", "platform"), "no such section or key", "", "platform", "did you mean"),
    (("reference", "a", "b"), "one word too many", "reference:", "'b'", "--help"),
    # paths
    (("study", STUDY, "--out", CASE1), "is a file", "--out", str(CASE1), "name a folder"),
    (("import", "deck.fst", "--out", CASE1), "is a file", "--out", str(CASE1), "name a folder"),
    (("study", ROOT / "inputs/tutorials/step.toml"), "no such file", "step.toml", "", "did you mean '" + str(ROOT / "inputs/tutorials/steps.toml")),
    (("picture", "EMPTY", "-o", "nowhere/x.png"), "there is no folder", "--out", "'nowhere/x.png'", "/nowhere"),
    (("report", "EMPTY", "-o", "nowhere/x.html"), "there is no folder", "--out", "'nowhere/x.html'", "/nowhere"),
    (("grid", ROTOR, "-o", "nowhere/x.cgns"), "there is no folder", "--out", "'nowhere/x.cgns'", "/nowhere"),
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
    (("study", STUDY, "--out", "RUN"), "is the folder of a run", "--out", "RUN", "name another with --out"),
    (("report", "RUN", "STUDY"), "is the folder of a study", "STUDY", "", "spindrift report STUDY"),
    (("report", "RUN", "RUN"), "is given twice", "RUN", "", "name another run"),
    (("picture", "RUN", "--time", "500"), "the run goes from 0 to 20 s", "--time", "500", ""),
    (("picture", "RUN", "--time", "noon"), "give seconds, or last", "--time", "noon", ""),
    (("picture", "RUN", "--camera", "rotor"), "the run has no rotor", "--camera", "rotor", "scene, side, front, top"),
    (("picture", "RUN", "RUN2"), "one word too many", "picture:", "'RUN2'", "--help"),
    (("film", "STUDY"), "is not a run directory", "STUDY", "no history.csv", "run SCENE --out FOLDER"),
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
    (check("bodies.plattform.mass_kg=1e6"), "is missing", "bodies.plattform.centre_m", "no file has bodies.plattform", "did you mean bodies.platform?"),
    (check("rotor.speed_rpm=9.6", scene=CASE3), "has no effect here", "rotor.speed_rpm", "joint is bearing", "only where joint is left out"),
    (check("waves.significant_height_m=3", scene=CASE3), "unknown key", "waves.significant_height_m", "3", "did you mean 'height_m'?"),
    (check("waves.peak_period_s=9", scene=CASE3), "unknown key", "waves.peak_period_s", "9", "did you mean 'period_s'?"),
    (check("moorings.line_1.length_m=900", scene=SPAR), "unknown key", "moorings.line_1.length_m", "900", "did you mean 'rest_length_m'?"),
    (check("moorings.line_1.anchor_body=seabed", scene=SPAR), "is not in [bodies]", "moorings.line_1.anchor_body", '"seabed"', "known: spar"),
    (check('without=["moorings.line_1.anchor_m"]', scene=SPAR), "is required", "moorings.line_1.anchor_m", "end on the earth", "[x, y, z] in m"),
    (check("moorings.line_downwind.stiffness_N_m=1e6"), "cannot stand beside axial_stiffness_N", "moorings.line_downwind.stiffness_N_m", "1e6", "give one of"),
    (check("joints.bearing.axis=[0,0,0]", scene=CASE3), "and not zero", "joints.bearing.axis", "[0, 0, 0]", "is needed by a revolute joint"),
    (check('joints.bearing.bodies=["platform"]', scene=CASE3), "must have 2 entries", "joints.bearing.bodies", '["platform"]', "first and second body"),
    (check("coupling.scheme=iqn", scene=CASE3), "must be one of", "coupling.scheme", '"iqn"', 'did you mean "iqn_ils"?'),
    (check("aero.flow.generate.kind=airfoil", scene=SECTION), "must be one of", "aero.flow.generate.kind", '"airfoil"', 'did you mean "aerofoil"?'),
    (check("aero.flow.generate.naca=4412", scene=SECTION), "must be a text in quotes", "aero.flow.generate.naca", "4412", '"4412"'),
    (check('control.events=[{what="stop", time_s=65.0}]', scene=GUST), "must be one of", "control.events[0].what", '"stop"', '"shut_down"'),
    (check('control.library="x.so"', scene=CASE3), "no such file", "control.library", '"x.so"', "a shared object of this computer"),
    (check("sea.gauges=[{point_m=[50.0, 0.0]}]", scene=BOX), "is outside the tank", "sea.gauges[0].point_m", "[50.0, 0.0]", ""),
    (check("environment.gravity_m_s2=-9.81"), "must be", "environment.gravity_m_s2", "-9.81", ">= 0 and <= 100 m/s2"),
    (check("environment.gravity_m_s2=981"), "must be", "environment.gravity_m_s2", "981", ">= 0 and <= 100 m/s2"),
    (check("bodies.platform.mass_kg=nan"), "must be", "bodies.platform.mass_kg", "nan", "> 0 kg"),
    (check("base=x.toml"), "named in scene files only", "base", '"x.toml"', ""),
    (check("bodies.weight.rotation_deg=30", scene=PENDULUM), "must be a list of 3 numbers", "bodies.weight.rotation_deg", "30", "roll, pitch, yaw"),
    (check("moorings.line.anchor_body=weight", scene=PENDULUM), "is the body that carries the fairlead", "moorings.line.anchor_body", '"weight"', "two different things"),
    (("reference", "windw"), "no such section or key", "", "windw", "did you mean 'wind'"),
    (check("output.format=csv", scene=CASE3), "unknown key", "output.format", '"csv"', "[output] has: title"),
    (check("wind.turbulence.intensity=14", scene=GUST), "unknown key", "wind.turbulence.intensity", "14", "did you mean 'reference_intensity'?"),
    (check("wind.event.what=EOG", scene=GUST), "must be one of", "wind.event.what", '"EOG"', 'did you mean "eog"?'),
    (check('control.events=[{what="shut_down"}]', scene=GUST), "is missing", "control.events[0].time_s", "", "when"),
    (check("start.equilibrium=yes", scene=OWN), "must be true or false", "start.equilibrium", '"yes"', "not a text"),
    (check("moorings.line_1.model=lumped", scene=SPAR), "must be one of", "moorings.line_1.model", '"lumped"', 'did you mean "lumped_mass"?'),
    (check("moorings.line.anchor_m=0,0,10", scene=PENDULUM), "is not TOML", "moorings.line.anchor_m", "0,0,10", "lists have brackets"),
    (check("moorings.line.body=Weight", scene=PENDULUM), "is not in [bodies]", "moorings.line.body", '"Weight"', "known: weight"),
    (check('sea.gauges=[{name="g1",point_m=[1.0,0.0]},{name="g1",point_m=[2.0,0.0]}]', scene=TANK), "is the name of another", "sea.gauges[1].name", '"g1"', ""),
    (check("sea.wavemaker.type=pistn", scene=TANK), "must be one of", "sea.wavemaker.type", '"pistn"', 'did you mean "piston"?'),
    # physics
    (check("time.integrator=explicit_euler"), "is unstable at any step", "time.integrator", "explicit_euler", "use rk4 or symplectic"),
    (check("time.step_s=0.03"), "must divide the window of 0.1 s", "time.step_s", "0.03", "nearest: 0.0333"),
    (check("waves.height_m=20.0", scene=CASE3), "breaks above", "waves.height_m", "20 m", "12.42 m"),
    (check("wind.speed_m_s=-10", scene=OWN), "must be", "wind.speed_m_s", "-10", ">= 0 and <= 300 m/s"),
    (check("environment.water_depth_m=70", scene=OWN), "below the sea bed", "bodies.spar.cylinders[0]", "z = -75 m", "z = -70 m"),
    (check("bodies.spar.mass_kg=3.3e3", scene=OWN), "look at the mass in kg", "bodies.spar.mass_kg", "3.33e+04 kg", "no equilibrium"),
    (check("bodies.box.boxes[0].centre_m=[0,0,-0.55]", scene=BOX), "below the bed at -0.6 m", "bodies.box", "-0.73 m", ""),
    (check("sea.initial.settle_s=-1", scene=BOX), "must be >= 0 s", "sea.initial.settle_s", "-1", ""),
    (check("waves.height_m=0.6", scene=TANK), "breaks above", "waves.height_m", "0.6 m", "0.3615 m"),
    (check("rotor.axis=[0,0,0]", scene=ROTOR), "must not be zero", "rotor.axis", "[0, 0, 0]", ""),
    (check("aero.flow.viscosity_Pa_s=-1", scene=SECTION), "must be", "aero.flow.viscosity_Pa_s", "-1", "> 0 and <= 1000 Pa s"),
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
    (check("checkpoint.interval_s=-1"), "must be", "checkpoint.interval_s", "-1", ">= 0 and <= 1e6 s"),
    (check("output.history_every=0"), "must be", "output.history_every", "= 0", ">= 1"),
    (check("wind.speed_m_s=1e3", scene=CASE3), "must be", "wind.speed_m_s", "1000", ">= 0 and <= 300 m/s"),
    (check("waves.model=stokes", scene=SPAR), "must be one of", "waves.model", '"stokes"', 'did you mean "stokes2"?'),
    (check("sea.particles.cfl=2", scene=BOX), "must be", "sea.particles.cfl", "2", "> 0 and <= 0.6"),
    (check("sea.fields.interval_s=-1", scene=BOX), "must be", "sea.fields.interval_s", "-1", "> 0 s"),
    (check("bodies.box.boxes[0].size_m=[0.4, 0.4]", scene=BOX), "must be a list of 3 numbers", "bodies.box.boxes[0].size_m", "[0.4, 0.4]", "not a list of 2"),
    (check("aero.flow.flux=roe2", scene=ROTOR), "must be one of", "aero.flow.flux", '"roe2"', 'did you mean "roe"?'),
    (check("aero.flow.cfl=0", scene=ROTOR), "must be", "aero.flow.cfl", "0", "> 0"),
    (check("control.model=dtu10", scene=GUST), "must be one of", "control.model", '"dtu10"', '"library"'),
    (check('output.expected=[{column="platform.pich_deg", mean=5.0, within=1.0, source="x"}]', scene=CASE3), "is no column", "output.expected[0].column", '"platform.pich_deg"', 'did you mean "platform.pitch_deg"?'),
    (check("waves.height_m=40.0", scene=SPAR), "breaks above", "waves.height_m", "40 m", "22.16 m"),
    (check("time.step_s=0.05", "time.window_s=0.05", scene=PENDULUM), "is above the limit", "time.step_s", "0.05", "heave of weight"),
    (check("aero.grid.resolution=100.0", scene=ROTOR), "must be", "aero.grid.resolution", "100", ">= 0.8 and <= 10"),
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

# In other files: (what is copied beside the scene, changed by (old, new); the scene's lines; words; the file at fault; what, value, what to do).
TURBINES = ROOT / "inputs/turbines/dtu_10mw"
BLADE, POLAR = ROOT / "inputs/tutorials/half_size_planform.csv", TURBINES / "polar_24.1.csv"
OF_TURBINE = f'base = "{OWN}"\n[rotor]\nturbine = "half_size_turbine.toml"\n'
OF_SECTION = f'base = "{SECTION}"\n[aero.flow.generate]\ncoordinates = "naca4412.dat"\n'
NEARBY = [ROOT / "inputs/tutorials/half_size_turbine.toml", BLADE, *sorted(TURBINES.glob("polar_*.csv"))]
OUTLINE, FILE_OF_TURBINE = ROOT / "inputs/tutorials/naca4412.dat", "half_size_turbine.toml"
IN_FILES = [
    (OF_TURBINE, FILE_OF_TURBINE, ("blades = 3", "blades = 0"), "turbine.blades", "0", ">= 1 and <= 12"),
    (OF_TURBINE, FILE_OF_TURBINE, ("hub_radius_m = 1.4", "hub_radius_m = 60.0"), "the first section is the root", "1.4", "turbine.hub_radius_m = 60"),
    (OF_TURBINE, FILE_OF_TURBINE, ("precone_deg = 2.5", "precone_deg = 95"), "turbine.precone_deg", "95", ">= -45 and <= 45 deg"),
    (OF_TURBINE, FILE_OF_TURBINE, ("half_size_planform.csv", "half_size_planfrom.csv"), "no such file", "half_size_planfrom.csv", "did you mean '"),
    (OF_TURBINE, FILE_OF_TURBINE, ("thickness_pct = 24.1", "number = 1"), "names a section otherwise", "36.0", "all by number or all by thickness_pct"),
    (OF_TURBINE, FILE_OF_TURBINE, ("[turbine]", "[rotor]"), "is missing", "turbine.planform", "CSV file from root to tip"),
    (OF_TURBINE, BLADE.name, ("twist_deg", "twist"), "means nothing here", '"twist"', "known: span_m, chord_m, twist_deg"),
    (OF_TURBINE, BLADE.name, ("3.75955,", "0.5,"), "must be above 1.4 of the row before", "span_m = 0.5", ""),
    (OF_TURBINE, BLADE.name, ("96.915", "thick"), "must be a finite number", '"thick"', "column thickness_pct"),
    (OF_TURBINE, BLADE.name, (",", ";"), "has semicolons", "", "write commas between columns"),
    (OF_TURBINE, BLADE.name, (None, "span_m,chord_m,twist_deg,thickness_pct\n"), "needs at least 2 rows", "has 0", ""),
    (OF_TURBINE, BLADE.name, (None, ""), "holds no table", "", "a header line of column names"),
    (OF_TURBINE, BLADE.name, (None, "PK\x03\x04\x00\x00table"), "is no text", "", "save the table as text"),
    (OF_TURBINE, POLAR.name, ("alpha_deg,", "alpha,"), "means nothing here", '"alpha"', "known: alpha_deg, cl, cd"),
    (OF_TURBINE, POLAR.name, ("alpha_deg,cl,", "alpha_deg,CL,"), "means nothing here", '"CL"', "known: alpha_deg, cl, cd"),
    (OF_TURBINE, POLAR.name, (None, "alpha_deg,cl,cd,cm\n-10,0,0,0\n10,1,0,0\n"), "must go from -180 to 180", "alpha_deg", ""),
    (OF_SECTION, OUTLINE.name, (None, "hello\n"), "needs at least 9 rows", "has 0", ""),
    (OF_SECTION, OUTLINE.name, (None, "mine\n" + "1000.0 0.0\n" * 9), "is off the chord", "x_c = 1000", "from 0 to 1"),
    (OF_SECTION, OUTLINE.name, (None, "mine\n" + "1.0,0.0\n" * 9), "has 1 values where there are 2", "x_c, y_c", "write blanks between numbers"),
    (OF_SECTION, OUTLINE.name, (None, "mine\n" + "1.0\n" * 9), "has 1 values where there are 2", "x_c, y_c", ""),
]

# In a study: what is changed in STUDY, line at fault, what, key, value, what to do.
IN_STUDIES = [
    (('"rms"', '"mse"'), 21, "must be one of", "metrics.swing.measure", '"mse"', '"rms"'),
    (('variant = "fine"', 'variant = "fin"'), 17, "is no run of this study", "reference.variant", '"fin"', "did you mean 'fine'?"),
    (("values = [0.01, 0.005, 0.0025]", "values = []"), 14, "must have at least 1 entries", "axes.step.values", "[]", ""),
    (('["time.end_s=5.0"]', '"time.end_s=5.0"'), 4, "must be a list of texts", "study.set", '"time.end_s=5.0"', "KEY=VALUE"),
    (("[axes.step]", "[axis.step]"), 12, "unknown section", "axis", "", "did you mean [axes]?"),
    (("target = 1.0e-4", "target = -1"), 23, "must be > 0", "metrics.swing.target", "-1", ""),
    (("divide_by = 1.7364818", "divide_by = 0.0"), 22, "must be > 0", "metrics.swing.divide_by", "0.0", ""),
    (('"pendulum.toml"', '"pendulun.toml"'), 3, "no such file", "study.scene", '"pendulun.toml"', "did you mean '"),
    (('"time.step_s"', '"time.steps"'), 0, "unknown key", "time.steps", "0.01", "did you mean 'step_s'?"),
    (('"weight.x_m"', '"weight.xm"'), 0, "is no column of", "metrics.swing.column", '"weight.xm"', 'did you mean "weight.x_m"?'),
    (("time.end_s=5.0", "time.end_s=-5.0"), 0, "must be", "time.end_s", "-5.0", "> 0 and <= 1e6 s"),
]


class Mistakes(unittest.TestCase):
    def test_there_are_two_hundred_and_twenty(self):
        self.assertGreaterEqual(len(MISTAKES) + len(WRITTEN) + len(IN_FILES) + len(IN_STUDIES), 220)

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
            for kind, made in (("run", "RUN"), ("study", "STUDY")):
                more = ("--no-report", "--quiet") if kind == "run" else ("--set", "study.at_once=1")
                done = subprocess.run([PROGRAM, kind, str(PENDULUM if kind == "run" else STUDY), "--out", made, *more], cwd=folder, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
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

    def test_other_files_are_named(self):
        for lines, file, (old, new), *wanted in IN_FILES:
            with self.subTest(f"{file}: {old} -> {new}"), tempfile.TemporaryDirectory(prefix="spindrift_mistakes_") as folder:
                folder = pathlib.Path(os.path.realpath(folder))
                for near in [*NEARBY, OUTLINE]:
                    text = near.read_text(encoding="utf-8").replace("../turbines/dtu_10mw/", "")
                    if near.name == file:
                        self.assertTrue(old is None or old in text)
                        text = new if old is None else text.replace(old, new)
                    (folder / near.name).write_text(text, encoding="utf-8")
                (folder / "own.toml").write_text(lines, encoding="utf-8")
                said = self.answer(("check", folder / "own.toml"), folder)
                for part in (file if file != FILE_OF_TURBINE else "", *wanted):
                    self.assertIn(part, said)

    def test_studies_are_named(self):
        for (old, new), line, what, key, value, remedy in IN_STUDIES:
            with self.subTest(f"{old} -> {new}"), tempfile.TemporaryDirectory(prefix="spindrift_mistakes_") as folder:
                folder = pathlib.Path(os.path.realpath(folder))
                text = STUDY.read_text(encoding="utf-8")
                self.assertIn(old, text)
                (folder / "study.toml").write_text(text.replace(old, new), encoding="utf-8")
                (folder / "pendulum.toml").write_text(PENDULUM.read_text(encoding="utf-8"), encoding="utf-8")
                said = self.answer(("study", "study.toml", "--dry-run"), folder)
                wrong = next((one for one in said.splitlines() if (f"study.toml:{line}: " if line else "study.toml: ") in one), "")
                for part in (what, key, value, remedy):
                    self.assertIn(part, wrong, said)
                self.assertEqual(said.count(what), 1, "told once:\n" + said)


if __name__ == "__main__":
    unittest.main()
