"""Period and damping of free decays, on motions whose answers are known. SPDX-License-Identifier: Apache-2.0"""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[2] / "src/report")]
sys.dont_write_bytecode = True

import decay
import page
import synthetic_run
import verdict
from run_data import RunData


def swing(t, period, zeta, size=1.0, rest=0.0):
    omega = 2.0 * np.pi / period   # of the damped motion
    return rest + size * np.exp(-zeta / np.sqrt(1.0 - zeta**2) * omega * t) * np.cos(omega * t)


def through(ranges, period=10.0):
    """(time, values) of a motion with these ranges from peak to trough, half a cosine between turns."""
    turns = np.cumsum([0.0] + [(-1.0) ** n * size for n, size in enumerate(ranges)])
    turns = np.concatenate([[turns[0] + ranges[0]], turns, [turns[-1] + (turns[-2] - turns[-1])]])
    at = np.linspace(0.0, len(turns) - 1.0, 200 * len(turns))
    n = np.minimum(at.astype(int), len(turns) - 2)
    return 0.5 * period * at, turns[n] + (turns[n + 1] - turns[n]) * 0.5 * (1.0 - np.cos(np.pi * (at - n)))


class DecayTest(unittest.TestCase):
    def test_a_damped_oscillator_gives_its_period_and_damping(self):
        for rows in (600, 6000):
            t = np.linspace(0.0, 120.0, rows)
            for period, zeta in ((10.0, 0.05), (7.3, 0.01), (23.0, 0.08)):
                with self.subTest(period=period, zeta=zeta, rows=rows):
                    found = decay.decay_of(t, swing(t, period, zeta, 2.0, -3.0))
                    self.assertAlmostEqual(found.period / period, 1.0, delta=2e-3)
                    self.assertAlmostEqual(found.damping / zeta, 1.0, delta=0.02)
                    self.assertAlmostEqual(found.first / found.last, 1.0, delta=0.1)

    def test_quadratic_damping_falls_with_the_swing(self):
        dt, x, v, rows = 0.01, 1.0, 0.0, []
        for _ in range(12000):
            v += dt * (-x - 0.2 * abs(v) * v)
            x += dt * v
            rows.append(x)
        found = decay.decay_of(dt * np.arange(1, 12001), np.array(rows))
        self.assertGreater(found.first, 2.0 * found.last)

    def test_swings_that_do_not_fall_as_those_of_one_motion_are_told_to_be_of_several(self):
        even = 3.0 * 0.8 ** np.arange(10)
        drag = 3.0 / (1.0 + 0.25 * np.arange(10))   # of quadratic drag: 1 / range grows by as much each time
        beats = np.array([3.0, 1.61, 0.93, 0.60, 0.36, 0.28, 0.27, 0.26, 0.24, 0.18])   # a spar on bridles in yaw
        ripple = even * (1.0 + 0.02 * (-1.0) ** np.arange(10))   # of particles
        stiffens = np.concatenate([3.0 * 0.95 ** np.arange(5), 3.0 * 0.95 ** 4 * 0.7 ** np.arange(1, 6)])
        for ranges, several, falling, said in ((even, False, False, ["heave, period", "heave, damping of critical"]), (ripple, False, False, ["heave, period", "heave, damping of critical"]),
                                               (drag, False, True, ["heave, period", "heave, damping of critical, first to last swings"]),
                                               (beats, True, False, ["heave, mean period of several motions"]),
                                               (stiffens, True, False, ["heave, mean period of several motions"])):
            with self.subTest(ranges), tempfile.TemporaryDirectory() as folder:
                t, values = through(ranges)
                found = decay.decay_of(t, values)
                self.assertEqual((found.several, found.falling), (several, falling))
                self.assertAlmostEqual(found.period, 10.0, delta=0.01)
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "float.z_m": values}, log="", scene="[bodies.float]\nmass_kg = 1.0\n")
                run = RunData(pathlib.Path(folder))
                self.assertEqual([text for text, *_ in verdict.answers(run)], said)
                settled = next(c for c in verdict.health(run) if c.title == "Settled").text
                self.assertEqual("several motions are in heave, whose swings do not fall as those of one: no single damping holds" in settled, several)
                self.assertEqual("of several motions" in page.decays(run), several)
                self.assertEqual(page._span(run), "Mean period from the peaks of the whole run." if several else "Period and damping from the peaks of the whole run.")

    def test_what_is_no_decay_is_left_out(self):
        t = np.linspace(0.0, 100.0, 2001)
        for values in (0 * t, np.exp(0.01 * t) * np.sin(t), np.exp(-t), swing(t, 50.0, 0.05), np.random.default_rng(1).normal(size=t.size), swing(t, 10.0, 0.02) + swing(t, 3.1, 0.01)):
            self.assertIsNone(decay.decay_of(t, values))

    def test_a_motion_without_damping_has_its_period(self):
        t = np.linspace(0.0, 100.0, 2001)
        found = decay.decay_of(t, 3.0 * np.sin(t))
        self.assertAlmostEqual(found.period, 2.0 * np.pi, delta=1e-3)
        self.assertEqual(found.damping, 0.0)

    def test_the_verdict_of_a_decay_is_its_period_and_damping(self):
        t = 0.1 * np.arange(1500)
        table = {"time_s": t, "float.x_m": 1e-7 * np.sin(t), "float.z_m": swing(t, 30.0, 0.04, 2.0)}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            synthetic_run.write(folder, table=table, log="", scene="[bodies.float]\nmass_kg = 1.0\n", ranges={"all": {"from_s": 100.0, "to_s": 149.9}})
            run = RunData(folder)
            self.assertEqual([(text, unit) for text, _, unit in verdict.answers(run)], [("heave, period", "s"), ("heave, damping of critical", "%")])
            settled = next(c for c in verdict.health(run) if c.title == "Settled")
            self.assertEqual((settled.level, "free" in settled.text), ("good", True))

    def test_a_free_body_that_beats_is_told_to_swing_in_several_motions(self):
        t = 0.1 * np.arange(1500)
        table = {"time_s": t, "float.x_m": 0 * t, "float.z_m": swing(t, 10.0, 0.01) + swing(t, 11.5, 0.01)}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, log="", scene="[bodies.float]\nmass_kg = 1.0\n")
            run = RunData(pathlib.Path(folder))
            self.assertEqual(decay.decays(run), [])
            self.assertIn("several motions are in heave, whose swings do not fall as those of one", next(c.text for c in verdict.health(run) if c.title == "Settled"))

    def test_a_page_tells_of_a_decay_and_of_none_in_waves(self):
        t = 0.1 * np.arange(1500)
        table = {"time_s": t, "float.x_m": 0 * t, "float.z_m": swing(t, 10.0, 0.05)}
        scene = "[bodies.float]\nmass_kg = 1.0\n"
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            synthetic_run.write(folder, table=table, log="", scene=scene, modes=[{"name": "heave of float", "frequency_Hz": 0.099, "damping": 0.04}])
            text = str(page.decays(RunData(folder)))
            for words in ("float heave", "10.00", "10.10", "5.00 %"):
                self.assertIn(words, text)
            synthetic_run.write(folder, table=table, log="", scene=scene + "[waves]\nmodel = 'airy'\nheight_m = 2.0\nperiod_s = 10.0\n")
            self.assertEqual(str(page.decays(RunData(folder))), "")

    def test_what_a_joint_or_waves_of_a_file_drive_is_no_free_decay(self):
        t = 0.1 * np.arange(1500)
        table = {"time_s": t, "float.x_m": 0 * t, "float.pitch_deg": swing(t, 10.0, 0.0)}
        joint = "[joints.shaker]\nbodies = ['earth', 'float']\n[joints.shaker.rotation]\nspeed_rpm = 0.0\nphase_deg = 90.0\namplitude_deg = "
        for more, count in (("", 1), (joint + "0.0\n", 1), (joint + "2.0\nperiod_s = 10.0\n", 0), ("[waves]\nmodel = 'none'\n", 1),
                            ("[waves]\nmodel = 'airy'\nheight_m = 0.0\n", 1), ("[waves]\nmodel = 'elevation'\nfile = 'eta.csv'\n", 0)):
            with self.subTest(more), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, log="", scene="[bodies.float]\nmass_kg = 1.0\n" + more)
                self.assertEqual(len(decay.decays(RunData(folder))), count)

    def test_a_turbine_that_stands_in_still_air_swings_freely(self):
        t = 0.1 * np.arange(1500)
        still, bodies = "[wind]\nspeed_m_s = 0.0\n", "[sea]\nmodel = 'hydrostatic'\n[bodies.float]\nmass_kg = 5e6\n[waves]\nmodel = 'none'\n"
        for wind, rpm, thrust, count in ((still, 0.0, -65.0, 1), ("", 0.0, -65.0, 1), ("[wind]\nspeed_m_s = 8.0\n", 0.0, -65.0, 0), (still + "table = 'wind.csv'\n", 0.0, -65.0, 0),
                                         (still, 5.0, -65.0, 0), (still, 0.0, 1e5, 0)):
            with self.subTest(wind=wind, rpm=rpm, thrust=thrust), tempfile.TemporaryDirectory() as folder:
                table = {"time_s": t, "float.x_m": 0 * t, "float.pitch_deg": swing(t, 10.0, 0.03), "rotor.rpm": rpm + 0 * t, "rotor.thrust_N": thrust + 0 * t}
                synthetic_run.write(pathlib.Path(folder), table=table, log="", scene=bodies + wind)
                run = RunData(pathlib.Path(folder))
                self.assertEqual(len(decay.decays(run)), count)
                self.assertEqual(verdict.answers(run)[0][0], "pitch, period" if count else "pitch")

    def test_a_thrust_that_is_nothing_beside_the_weight_need_not_settle(self):
        t = 0.1 * np.arange(1500)
        for size, level in ((65.0, "good"), (65e3, "warn")):
            with self.subTest(size), tempfile.TemporaryDirectory() as folder:
                table = {"time_s": t, "float.x_m": 0 * t, "rotor.rpm": 0.01 * t, "rotor.thrust_N": -size * t / t[-1], "rotor.power_W": -size * t / t[-1]}
                synthetic_run.write(pathlib.Path(folder), table=table, log="", scene="[bodies.float]\nmass_kg = 5e6\n[wind]\nspeed_m_s = 0.0\n")
                self.assertEqual(next(c for c in verdict.health(RunData(pathlib.Path(folder))) if c.title == "Settled").level, level)


if __name__ == "__main__":
    unittest.main()
