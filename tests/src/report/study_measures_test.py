"""Laws of src/report/study_measures.py: quantities with known answers, intervals that hold what they promise on a model whose truth is known.
SPDX-License-Identifier: Apache-2.0"""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "src/report"))
import study_measures as measures  # noqa: E402


def metric(measure, **more):
    return {"measure": measure, "from_s": 0.0, "until_s": None, "frequency_Hz": None, "wohler_exponent": 4.0, **more}


class Quantities(unittest.TestCase):
    def test_a_harmonic_has_its_mean_deviation_peak_amplitude_phase_and_period(self):
        t = np.linspace(0.0, 100.0, 10001)
        x = 3.0 + 2.0 * np.cos(2.0 * math.pi * 0.1 * t - 0.5)
        for name, value in (("mean", 3.0), ("deviation", math.sqrt(2.0)), ("peak", 5.0), ("amplitude", 2.0),
                            ("phase", math.degrees(0.5)), ("period", 10.0), ("last", x[-1])):
            self.assertAlmostEqual(measures.quantity(metric(name, frequency_Hz=0.1), t, x), value, delta=1e-4)

    def test_a_decay_has_its_damping_ratio(self):
        t, zeta = np.linspace(0.0, 100.0, 20001), 0.05
        x = 7.0 + np.exp(-zeta * t) * np.cos(math.sqrt(1.0 - zeta**2) * t)
        self.assertAlmostEqual(measures.quantity(metric("damping"), t, x), zeta, delta=2e-5)

    def test_a_ripple_that_is_left_of_a_decay_is_no_swing(self):
        t, zeta = np.arange(0.0, 400.0, 0.1), 0.05
        w = 2.0 * math.pi / 20.0
        x = np.exp(-zeta * w * t) * np.cos(math.sqrt(1.0 - zeta**2) * w * t) + 2e-3 * np.sin(2.0 * math.pi / 3.0 * t)
        self.assertAlmostEqual(measures.quantity(metric("damping"), t, x) / zeta, 1.0, delta=0.02)
        self.assertAlmostEqual(measures.quantity(metric("period"), t, x) / (20.0 / math.sqrt(1.0 - zeta**2)), 1.0, delta=0.01)

    def test_the_period_of_what_is_no_decay_is_that_of_crossings(self):
        t = np.linspace(0.0, 200.0, 4001)
        x = np.sin(2.0 * math.pi * 0.1 * t) + 0.3 * np.sin(2.0 * math.pi * 0.307 * t)   # more peaks than crossings
        self.assertAlmostEqual(measures.quantity(metric("period"), t, x), 10.0, delta=0.1)

    def test_rainflow_counts_the_example_of_the_standard(self):
        counts = {}
        for size, count in measures.rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2]):  # ASTM E1049-85, figure 6
            counts[size] = counts.get(size, 0.0) + count
        self.assertEqual(counts, {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5})

    def test_one_cycle_a_second_is_its_own_damage_equivalent(self):
        t = np.linspace(0.0, 200.0, 40001)
        self.assertAlmostEqual(measures.damage_equivalent(t, 1.5 * np.sin(2 * math.pi * t), 10.0), 3.0, delta=0.01)

    def test_uneven_steps_weigh_by_their_length(self):
        t, x = np.array([0.0, 1.0, 1.0 + 1e-9, 1.5, 2.0]), np.array([0.0, 0.0, 1.0, 1.0, 1.0])
        self.assertAlmostEqual(measures.quantity(metric("mean"), t, x), 0.5, delta=1e-6)

    def test_the_difference_of_shifted_sines_is_the_shift(self):
        t, t_ref = np.linspace(0.0, 2 * math.pi, 1001), np.linspace(0.0, 2 * math.pi, 1701)
        for name in ("rms", "max"):
            self.assertAlmostEqual(measures.difference(metric(name), t, np.sin(t) + 0.1, t_ref, np.sin(t_ref)), 0.1, delta=2e-6)

    def test_what_cannot_be_said_is_not_a_number(self):
        t = np.array([0.0, 1.0])
        self.assertTrue(math.isnan(measures.quantity(metric("mean"), t, np.array([0.0, math.nan]))))
        self.assertTrue(math.isnan(measures.quantity(metric("mean", from_s=5.0), t, t)))
        self.assertTrue(math.isnan(measures.difference(metric("rms"), t, t, t + 5.0, t)))


class Limits(unittest.TestCase):
    def test_the_limit_and_the_order_of_a_pure_power_are_found(self):
        for order in (1.0, 2.0, 4.0):
            h = [0.1, 0.25, 0.4]
            limit, p, allowance, why = measures.richardson(h, [7.0 - 0.3 * s**order for s in h])
            self.assertAlmostEqual(limit, 7.0, delta=1e-9)
            self.assertAlmostEqual(p, order, delta=1e-6)
            self.assertEqual(why, "")
            self.assertGreater(allowance, 0.0)

    def test_levels_without_order_are_said_to_have_none_and_allow_for_more(self):
        limit, _, allowance, why = measures.richardson([1.0, 2.0, 4.0], [5.0, 5.1, 5.0])
        self.assertEqual(limit, 5.0)
        self.assertAlmostEqual(allowance, 0.3)
        self.assertIn("one side", why)

    def test_the_front_is_what_nothing_beats(self):
        errors, costs = [0.10, 0.01, 0.05, 0.001, 0.2, math.nan], [1.0, 10.0, 20.0, 100.0, 2.0, 0.1]
        self.assertEqual(measures.front(errors, costs), [0, 1, 3])


class Intervals(unittest.TestCase):
    def test_students_distribution_has_its_tabulated_quantiles(self):  # Abramowitz & Stegun, table 26.10
        for freedom, value in ((1, 12.706), (2, 4.303), (4, 2.776), (7, 2.365), (20, 2.086), (120, 1.980)):
            self.assertAlmostEqual(measures.student_quantile(0.975, freedom), value, delta=6e-4)
            self.assertAlmostEqual(measures.student_cdf(-value, freedom), 0.025, delta=1e-4)

    def test_confidence_in_a_target_is_that_of_the_interval_that_just_fits(self):
        e = measures.Estimate(0.0, 1.0, 5)
        self.assertAlmostEqual(e.within(e.half(0.95)), 0.95, delta=1e-9)

    def test_the_stated_interval_holds_the_truth_as_often_as_it_says(self):
        """A response in random waves, sum of 60 components with phases by seed; the cheap rung's transfer function is off by some per cent,
        more at high frequencies. Truth: the mean paired difference over 3000 seeds. 100 studies of 6 seeds each state a 95 % interval."""
        w = np.linspace(0.03, 0.25, 60) * 2 * math.pi + 1e-3 * np.arange(60) ** 0.5
        amplitude = np.exp(-(((w / 2 / math.pi) - 0.09) / 0.03) ** 2)
        cheap = amplitude * (1.02 + 0.1 * w) * np.exp(0.05j * w)
        t = np.arange(0.0, 300.0, 0.5)
        waves = np.exp(1j * np.outer(w, t))

        def differences(seed, count):
            phases = np.exp(2j * math.pi * np.random.default_rng(seed).random((count, len(w))))
            fine, rough = (phases * amplitude) @ waves, (phases * cheap) @ waves
            return {"mean": [measures.mean(t, b.real) - measures.mean(t, a.real) for a, b in zip(fine, rough)],
                    "deviation": [np.std(b.real) - np.std(a.real) for a, b in zip(fine, rough)],
                    "peak": [np.max(np.abs(b.real)) - np.max(np.abs(a.real)) for a, b in zip(fine, rough)]}

        truth = {name: np.mean(d) for name, d in differences(1, 3000).items()}
        held = dict.fromkeys(truth, 0)
        for study in range(100):
            for name, d in differences(1000 + study, 6).items():
                low, high = measures.estimate(d).interval(0.95)
                held[name] += low <= truth[name] <= high
        for name, count in held.items():
            self.assertTrue(90 <= count <= 99, f"{name}: {count} of 100")


if __name__ == "__main__":
    unittest.main()
