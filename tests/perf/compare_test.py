#!/usr/bin/python3
"""perf/compare: what is better and worse, times and rates for the same core, files that are no results."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "perf" / "compare"


def figure(name, value, sense="at most", ceiling="none"):
    return {"group": "g", "name": name, "value": value, "unit": "s", "sense": sense, "bar": None, "ceiling": ceiling, "note": ""}


def result(stream, *figures):
    return {"date": "today", "commit": "0123456789abcdef", "uncommitted_changes": False, "processor": "p", "cores": 2,
            "machine": {"stream/one_core": {"value": stream, "unit": "GB/s"}}, "figures": list(figures)}


class Compare(unittest.TestCase):
    def compared(self, before, after):
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder) / name for name in ("a.json", "b.json")]
            for file, content in zip(files, (before, after)):
                file.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
            return subprocess.run([sys.executable, PROGRAM, *files], capture_output=True, text=True, check=False)

    def line(self, said, name):
        return next(line for line in said.stdout.splitlines() if line.startswith(f"g/{name} "))

    def test_senses_and_tolerance(self):
        before = result(10, figure("time", 1.0), figure("rate", 1.0, "at least"), figure("noise", 1.0), figure("count", 1.0, "none"))
        after = result(10, figure("time", 1.3), figure("rate", 1.3, "at least"), figure("noise", 1.05), figure("count", 2.0, "none"))
        said = self.compared(before, after)
        self.assertEqual(said.returncode, 1)
        self.assertTrue(self.line(said, "time").endswith("worse"))
        self.assertTrue(self.line(said, "rate").endswith("better"))
        self.assertTrue(self.line(said, "noise").endswith("same"))
        self.assertFalse(self.line(said, "count").rstrip().endswith(("worse", "better", "same")))
        self.assertEqual(self.compared(after, before).returncode, 1)  # the rate is worse now
        self.assertEqual(self.compared(before, before).returncode, 0)

    def test_times_and_rates_are_for_the_core_of_the_second(self):
        slow = result(10, figure("time", 2.0, "at most", "stream"), figure("rate", 1.0, "at least", "stream"))
        fast = result(20, figure("time", 1.0, "at most", "stream"), figure("rate", 2.0, "at least", "stream"))
        said = self.compared(slow, fast)
        self.assertEqual(said.returncode, 0, said.stdout)
        self.assertTrue(self.line(said, "time").endswith("same"))
        self.assertTrue(self.line(said, "rate").endswith("same"))

    def test_a_figure_that_has_gone_or_lost_its_value(self):
        said = self.compared(result(10, figure("old", 1.0), figure("lost", 1.0)), result(10, figure("new", 1.0), figure("lost", None)))
        self.assertIn("only before", self.line(said, "old"))
        self.assertIn("only after", self.line(said, "new"))
        self.assertTrue(self.line(said, "lost").endswith("worse"))

    def test_what_is_no_result_is_refused(self):
        for wrong in ("not JSON", "{}", "[]"):
            said = self.compared(wrong, result(10))
            self.assertEqual(said.returncode, 2)
            self.assertIn("a.json", said.stderr)


unittest.main()
