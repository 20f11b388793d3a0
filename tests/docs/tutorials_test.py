"""The numbers of the tutorials' tables: each is read off the page and compared with what the tutorial's run gives, untouched, to the digits that are
printed. Usage: tutorials_test.py PROGRAM [--all] [unittest's arguments]; without --all those of a few seconds.
SPDX-License-Identifier: Apache-2.0"""
import importlib.machinery
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
ALL = "--all" in sys.argv
if ALL:
    sys.argv.remove("--all")
sys.path.insert(0, str(ROOT / "src/python"))
sys.dont_write_bytecode = True

import numpy as np

import spindrift


def after(run, column, begin, end=np.inf):
    return run[column][(run.time >= begin - 1e-9) & (run.time <= end + 1e-9)]


def mean(column, begin, scale=1.0):
    return lambda run: scale * run.mean(column, after=begin)


def half_range(column, begin):
    return lambda run: 0.5 * np.ptp(after(run, column, begin))


def period(column):
    """From the crossings of the middle, linear between rows."""
    def of(run):
        t, x = run.time, run[column] - 0.5 * (run[column].max() + run[column].min())
        n = np.flatnonzero(x[:-1] * x[1:] < 0.0)
        zeros = t[n] - x[n] * (t[n + 1] - t[n]) / (x[n + 1] - x[n])
        return 2.0 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
    return of


def first_period(column):
    """Of a decay about zero: from its first crossing to its third."""
    def of(run):
        t, x = run.time, run[column]
        n = np.flatnonzero(x[:-1] * x[1:] < 0.0)[[0, 2]]
        return np.ptp(t[n] - x[n] * (t[n + 1] - t[n]) / (x[n + 1] - x[n]))
    return of


def extreme(column, function, scale=1.0, begin=0.0):
    return lambda run: scale * function(after(run, column, begin))


def at(column, t):
    return lambda run: run[column][np.argmin(abs(run.time - t))]


def analysed(figure, scale=1.0):
    """By ci/wave_analysis."""
    loader = importlib.machinery.SourceFileLoader("wave_analysis", str(ROOT / "ci/wave_analysis"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("wave_analysis", loader))
    loader.exec_module(module)
    return lambda run: scale * module.analyse(run.directory)[figure]


# page, or page:run where a page has several: (scene, its overrides, fast, [(row of the table, which of its numbers, what it is)]); numbers are counted from the second cell on.
PAGES = {
    "pendulum": ("tutorials/pendulum.toml", [], True, [("period of the swing", 0, period("weight.x_m")), ("greatest tension", 0, extreme("line.tension_N", np.max))]),
    "spar_in_waves": ("tutorials/spar_in_waves.toml", [], True,
                      [(f"{name}, half of its range", 0, half_range(f"spar.{column}", 100.0)) for name, column in (("surge", "x_m"), ("heave", "z_m"), ("pitch", "pitch_deg"))]
                      + [("tension of `line_1`", 0, mean("line_1.tension_N", 100.0, 1e-3))]),
    "spar_in_waves:bridles": ("tutorials/spar_on_bridles.toml", [], True,
                              [("first period in yaw", 0, first_period("spar.yaw_deg")), ("tension of `line_1`, mean from 20 s on", 0, mean("line_1.tension_N", 20.0, 1e-3))]),
    "spar_in_waves:plain": ("tutorials/spar_in_waves.toml", ['without=["waves"]', "bodies.spar.rotation_deg=[0,0,3]"], True, [("first period in yaw", 1, first_period("spar.yaw_deg")), ("tension of `line_1`, mean from 20 s on", 1, mean("line_1.tension_N", 20.0, 1e-3))]),
    "own_turbine": ("tutorials/own_turbine.toml", [], True,
                    [("thrust", 0, mean("rotor.thrust_N", 80.0, 1e-3)), ("power", 0, mean("rotor.power_W", 80.0, 1e-6)), ("pitch of the spar", 0, mean("spar.pitch_deg", 80.0)),
                     ("surge", 0, mean("spar.x_m", 80.0))]),
    "gust": ("tutorials/gust.toml", [], True,
             [("thrust", 0, lambda run: 1e-3 * at("rotor.thrust_N", 59.0)(run)), ("thrust", 1, extreme("rotor.thrust_N", np.min, 1e-3, 20.0)), ("thrust", 3, extreme("rotor.thrust_N", np.max, 1e-3, 20.0)),
              ("rotor speed", 1, extreme("rotor.rpm", np.min, begin=20.0)), ("rotor speed", 2, extreme("rotor.rpm", np.max, begin=20.0)),
              ("pitch of the blades", 1, extreme("rotor.blade_1.pitch_deg", np.min, begin=20.0)), ("pitch of the blades", 2, extreme("rotor.blade_1.pitch_deg", np.max, begin=20.0))]),
    "floating_box": ("validation/floating_box/floating_box.toml", [], False,
                     [("`box.sea.fz_N` while held", 0, at("box.sea.fz_N", 0.0)), ("`box.pitch_deg`", 0, extreme("box.pitch_deg", np.min, begin=2.5)), ("`box.pitch_deg`", 1, extreme("box.pitch_deg", np.max, begin=2.5)),
                      ("the same, mean after 1.6 s", 0, mean("box.sea.fz_N", 1.6)), ("`box.z_m`", 0, mean("box.z_m", 1.6))]),
    "wave_tank": ("validation/wave_tank/small_tank.toml", [], False, [("height at the first gauge", 0, analysed("height_ratio")), ("phase speed", 0, analysed("phase_speed_ratio")),
                                                                      ("reflected", 0, analysed("reflection", 100.0))]),
    "dropped_cylinder": ("validation/cylinder_drop/cylinder_drop.toml", ["sea.particles.spacing_m=0.006", "sea.fields.surface_spacing_m=0.012"], False,
                         [("depth after 0.16 s", 0, lambda run: -at("cylinder.z_m", 0.16)(run))]),
    "wing_section": ("tutorials/wing_section.toml", [], False, [("lift coefficient", 0, extreme("flow.lift_coefficient", lambda x: x[-1])),
                                                                ("drag coefficient", 0, extreme("flow.drag_coefficient", lambda x: x[-1]))]),
    "rotor": ("leble_barakos/rotor_demo.toml", [], False, [("thrust", 0, extreme("rotor.thrust_N", lambda x: x[-1], 1e-6)), ("power", 0, extreme("rotor.power_W", lambda x: x[-1], 1e-6))]),
    "coupled": ("leble_barakos/case3_demo.toml", [], False,
                [("thrust, mean", 0, mean("rotor.thrust_N", 3.0, 1e-6)), ("power, mean", 0, mean("rotor.power_W", 3.0, 1e-6)),
                 ("pitch, mean and largest", 0, mean("platform.pitch_deg", 3.0)), ("pitch, mean and largest", 1, extreme("platform.pitch_deg", np.max, begin=3.0)),
                 ("heave, lowest", 0, extreme("platform.z_m", np.min, begin=3.0)), ("heave, lowest", 1, extreme("platform.z_m", np.max, begin=3.0)),
                 ("surge, least", 0, extreme("platform.x_m", np.min, begin=3.0)), ("surge, least", 1, extreme("platform.x_m", np.max, begin=3.0))]),
}


def cells(page, row):
    """The cells of a row after its name."""
    for line in (ROOT / "docs/tutorials" / f"{page.partition(':')[0]}.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("| " + row):
            return [cell.strip() for cell in line.strip("|").split("|")][1:]
    raise AssertionError(f"{page}.md has no row '{row}'")


def numbers(page, row):
    """(value, worth of its last digit) of each number of the row."""
    found = []
    for text in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?", " | ".join(cells(page, row))):
        digits, _, power = text.partition("e")
        worth = 10.0 ** (-len(digits.partition(".")[2]) + int(power or 0))
        found.append((float(text), worth))
    return found


class Tutorials(unittest.TestCase):
    def run_of(self, page, folder):
        scene, overrides, _, _ = PAGES[page]
        out = pathlib.Path(folder) / page.replace(":", "_")
        environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}
        words = [PROGRAM, "run", ROOT / "inputs" / scene, "--out", out, "--no-report", "--quiet", *(w for o in overrides for w in ("--set", o))]
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True, env=environment, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return spindrift.open(out)

    def test_tables(self):
        with tempfile.TemporaryDirectory(prefix="spindrift_tutorials_") as folder:
            for page, (_, _, fast, rows) in PAGES.items():
                if not (ALL or fast):
                    continue
                run = self.run_of(page, folder)
                for row, which, what in rows:
                    with self.subTest(f"{page}: {row}, number {which}"):
                        said, worth = numbers(page, row)[which]
                        self.assertAlmostEqual(what(run), said, delta=1.01 * worth)

    def test_study(self):
        """Errors of the pendulum's steps, to a tenth."""
        with tempfile.TemporaryDirectory(prefix="spindrift_tutorials_") as folder:
            done = subprocess.run([PROGRAM, "study", str(ROOT / "inputs/tutorials/steps.toml"), "--out", folder + "/study"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            study = spindrift.open_study(folder + "/study")
            self.assertEqual(len(study.rungs), 4)
            self.assertIn(study.answer, ("rk4-step_0.01", "rk4-step_0.005", "rk4-step_0.0025"))   # all are good enough; which is cheapest the clock says
            self.assertIn(study.answer, study.front)
            for step in ("0.01", "0.005", "0.0025"):
                said, worth = numbers("study", step + " ")[0]
                error, (low, high) = study.error(f"rk4-step_{step}", "swing")
                self.assertAlmostEqual(error, said, delta=1.01 * worth)
                self.assertTrue(low <= error <= high)
                self.assertGreater(study.core_seconds(f"rk4-step_{step}"), 0.0)
            self.assertEqual(study.open(study.answer).exit_code, 0)
            with self.assertRaisesRegex(KeyError, "there are: fine"):
                study.rung("fien")


if __name__ == "__main__":
    unittest.main()
