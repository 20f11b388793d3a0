"""Bars and timelines of replays, from figures that are given. SPDX-License-Identifier: Apache-2.0"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

REPORT = pathlib.Path(__file__).resolve().parents[3] / "src/report"
sys.path.insert(0, str(REPORT))
import spindrift_timeline as timeline  # noqa: E402
import figures  # noqa: E402
import page  # noqa: E402

ENTRY = {"placement": "in turns", "ranks": 1, "threads": 2, "air_ranks": None, "wall_s": 0.05, "efficiency": 0.9,
         "parts_core_s": {"aero": 0.03, "waiting": 0.018, "sea": 0.05, "between graphs": 0.0, "runtime": 0.002},
         "timeline": {"bin_s": 0.025, "busy": {"sea": [2.0, 0.0], "aero": [0.0, 1.2]}}}
SPLIT = {"placement": "split", "ranks": 4, "threads": 1, "air_ranks": 1, "wall_s": 0.03, "efficiency": 0.7,
         "parts_core_s": {"aero": 0.03, "sea": 0.05, "waiting": 0.04}}
FIGURES = {"kind": "replay", "title": "inputs/<demo>.toml", "predictions": [ENTRY, SPLIT]}


class Timeline(unittest.TestCase):
    def test_modules_come_first_and_waiting_last(self):
        self.assertEqual(timeline.parts_of([ENTRY, SPLIT]), ["sea", "aero", "runtime", "waiting"])

    def test_bars_end_at_the_core_seconds_of_a_window(self):
        drawn = timeline.draw(FIGURES, figures)
        ends = sorted(round(patch.get_x() + patch.get_width(), 6) for patch in drawn.axes[0].patches)
        self.assertEqual(ends[-2:], [100.0, 120.0])
        self.assertEqual(len(drawn.axes), 2)   # the second entry has no timeline

    def test_a_split_says_who_has_how_many_ranks(self):
        self.assertEqual(timeline.name_of(SPLIT), "split, 4 x 1 (3 sea, 1 air)")

    def test_the_page_has_a_row_for_each_and_escapes_text(self):
        html = timeline.build_page(FIGURES, figures, page)
        self.assertEqual(html.count("<tr>"), 3)
        self.assertIn("<td>90.0</td>", html)
        self.assertIn("Replay of &lt;demo&gt;", html)
        self.assertNotIn("<demo>", html)

    def test_the_program_writes_what_the_ending_says_and_refuses_what_has_no_figures(self):
        with tempfile.TemporaryDirectory(prefix="spindrift_timeline_") as folder:
            given = pathlib.Path(folder) / "figures.json"
            given.write_text(json.dumps(FIGURES))
            start = lambda *words: subprocess.run([sys.executable, "-B", REPORT / "spindrift_timeline.py", *words], capture_output=True, text=True)
            for ending, magic in ((".png", b"\x89PNG"), (".html", b"<!doctype html>")):
                out = given.with_suffix(ending)
                done = start(given, "--out", out)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(out.read_bytes().startswith(magic))
            given.write_text('{"kind": "replay", "title": ""}')
            done = start(given, "--out", given.with_suffix(".png"))
            self.assertEqual(done.returncode, 2)
            self.assertIn("neither predictions nor modes", done.stderr)


if __name__ == "__main__":
    unittest.main()
