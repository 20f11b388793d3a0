#!/usr/bin/python3
"""Judgement of perf/run: bars scaled by the ceilings of the run, senses, figures that are not finite."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
PATH = pathlib.Path(__file__).resolve().parents[2] / "perf" / "run"
LOADER = importlib.machinery.SourceFileLoader("perf_run", str(PATH))
run = importlib.util.module_from_spec(importlib.util.spec_from_loader("perf_run", LOADER))
LOADER.exec_module(run)

HALF = {"fma_float": {"value": 142.5}, "fma_double": {"value": 71.5}, "stream": {"value": 20.0}}


def figure(value, bar, sense, ceiling="none"):
    return {"name": "f", "value": value, "unit": "-", "bar": bar, "sense": sense, "ceiling": ceiling, "note": ""}


class Judgement(unittest.TestCase):
    def holds(self, *args):
        return run.judge(figure(*args), HALF)["holds"]

    def test_plain_bars(self):
        self.assertTrue(self.holds(1.0, 1.0, "at most"))
        self.assertFalse(self.holds(1.01, 1.0, "at most"))
        self.assertTrue(self.holds(1.0, 1.0, "at least"))
        self.assertFalse(self.holds(0.99, 1.0, "at least"))

    def test_a_rate_is_asked_half_of_on_a_core_half_as_fast(self):
        self.assertTrue(self.holds(2.01, 4.0, "at least", "fma_float"))
        self.assertFalse(self.holds(1.99, 4.0, "at least", "fma_float"))

    def test_a_time_may_take_twice_on_a_core_half_as_fast(self):
        judged = run.judge(figure(7.9, 4.0, "at most", "stream"), HALF)
        self.assertTrue(judged["holds"])
        self.assertEqual((judged["bar"], judged["reference_bar"]), (8.0, 4.0))
        self.assertIn("scaled by stream from 4", run.shown(judged))

    def test_no_bar_no_verdict_and_not_finite_never_holds(self):
        self.assertIsNone(self.holds(3.0, None, "none"))
        self.assertFalse(self.holds(None, 1.0, "at most"))

    def test_machine_comes_first(self):
        self.assertEqual(run.groups()[0], "machine")


unittest.main()
