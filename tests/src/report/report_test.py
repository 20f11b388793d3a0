"""The report's page on synthetic run directories: sections that the data have and no others, nothing from a network, nothing that breaks it.
Run by ctest with the distribution's Python. SPDX-License-Identifier: Apache-2.0"""
import html.parser
import json
import pathlib
import re
import sys
import tempfile
import time
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[2] / "src/report")]
sys.dont_write_bytecode = True

import cut
import figures
import html_page
import page
import picture
import quantities
import study_histories
import study_page
import synthetic_run
import verdict
from run_data import RunData

VOID = {"meta", "br", "img", "link", "hr", "input"}
ALL = ["key-figures", "motion", "forces", "moments", "rotor", "moorings", "spectra", "model", "rates", "other", "time-spent", "efficiency",
       "scene", "log"]


class Parsed(html.parser.HTMLParser):
    """Checks that every element is closed in order; keeps sections, attributes and text."""

    def __init__(self, text):
        super().__init__()
        self.open, self.sections, self.attributes, self.tags, self.text = [], [], [], [], ""
        self.feed(text)
        self.close()
        assert not self.open, f"not closed: {self.open}"

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, *a) for a in attrs]
        if tag == "section":
            self.sections.append(dict(attrs)["id"])
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, *a) for a in attrs]

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()

    def handle_data(self, data):
        if "style" not in self.open:
            self.text += data


class ReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def page(self, *names, **settings):
        """The page of one synthetic run (or of those named), parsed and checked for what holds for every page."""
        if not names:
            names = ["run"]
            synthetic_run.write(self.folder / "run", **settings)
        text = page.build([RunData(self.folder / name) for name in names])
        parsed = Parsed(text)
        self.assertNotRegex(text, r"https?:|@import|url\(\s*['\"]?(?!#)[a-z]")  # nothing from a network
        for tag, key, value in parsed.attributes:
            if key in ("src", "href", "xlink:href"):
                self.assertRegex(value, r"^(#|data:)", f"{tag} {key}")
            self.assertFalse(key.startswith("on"), key)
        self.assertNotIn("script", parsed.tags)
        ids = [value for _, key, value in parsed.attributes if key == "id"]
        self.assertEqual(len(ids), len(set(ids)), "ids are unique")
        for _, key, value in parsed.attributes:
            if key in ("href", "clip-path"):
                target = re.fullmatch(r"(?:url\()?#(.*?)\)?", value)
                if target:
                    self.assertIn(target[1], ids)
        return text, parsed

    def test_a_full_run_has_every_section_in_order(self):
        text, parsed = self.page(trace=synthetic_run.TRACE)
        self.assertEqual(parsed.sections, ALL)
        self.assertIn("reached the end at 150 s", text)
        self.assertIn("sea/force", text)
        self.assertIn("load balance", text)
        self.assertIn('<span class="warning">2026-11-21 02:50:00.010 warning', text)
        self.assertIn("torque 10 MN m, power 9.2 MW, rpm 8.8", parsed.text)  # constant: said, not drawn
        self.assertIn("Zero throughout: sway", parsed.text)
        self.assertLess(len(text), 600_000)

    def test_keys_that_the_command_line_changed_stand_beside_the_scene(self):
        _, parsed = self.page(set=["wind.speed_m_s=18", "time.end_s=60"])
        self.assertIn("with wind.speed_m_s=18, time.end_s=60", parsed.text)

    def test_references_of_the_scene_stand_beside_what_was_found(self):
        expected = '''
[[output.expected]]
column = "platform.z_m"
mean = -0.6
within = 0.01
source = "hydrostatics"

[[output.expected]]
column = "rotor.power_W"
mean = 9.7e6
within = 0.1e6
from_s = 100.0
source = "Bak et al. 2013"
'''
        synthetic_run.write(self.folder / "run", scene=synthetic_run.SCENE + expected)
        _, parsed = self.page("run")
        self.assertIn("expected", parsed.sections)
        text = parsed.text.replace("\n", "")
        self.assertRegex(text, r"platform heave platform\.z_m\s*met\s*m\s*−0\.6000 ± 0\.010\s*−0\.6000")
        self.assertIn("platform heave: hydrostatics; mean 122 to 150 srotor power: Bak et al. 2013; mean 100 to 150 s", text)
        self.assertRegex(text, r"rotor power rotor\.power_W\s*not met\s*MW\s*9\.700 ± 0\.10\s*9\.200\s*−0\.50 \(−5\.2 %\)")
        self.assertIn("1 of 2 references met; not met: rotor power", text)
        synthetic_run.write(self.folder / "changed", scene=synthetic_run.SCENE + expected, set=["aero.thrust_N=1e6", "time.end_s=150"])
        _, parsed = self.page("changed")
        self.assertIn("not judged, as the command line changed aero.thrust_N; of the unchanged scene's references 1 of 2 are met", parsed.text)
        self.assertIn("rotor.power_Wnot judgedMW9.700", parsed.text.replace("\n", ""))
        # A run that did not come to the scene's end does not tell.
        synthetic_run.write(self.folder / "short", scene=synthetic_run.SCENE + expected, rows=900)
        _, parsed = self.page("short")
        self.assertIn("not compared: the run ended at 89.9 s of 150 s", parsed.text)
        self.assertNotIn("references met", parsed.text)

    def test_modes_campbell_and_timeline(self):
        modes = [{"name": "surge of platform", "frequency_Hz": 0.123, "damping": 0.05}, {"name": "pitch of platform", "frequency_Hz": 0.0443, "damping": 0.06},
                 {"name": "yaw of rotor", "frequency_Hz": 0.0, "damping": -0.2}]
        trace = {"traceEvents": [{"ph": "X", "name": ("sea/force/1", "aero/step/2")[n % 2], "ts": 100 * n, "dur": 90, "pid": 0, "tid": n % 2} for n in range(50)]}
        _, parsed = self.page(modes=modes + [{"name": "pitch of platform", "frequency_Hz": 0.0, "damping": -0.5}], trace=trace)
        for words in ("pitch of platform (1)22.57", "pitch of platform (2)––rate -0.5 1/s"):
            self.assertIn(words, parsed.text.replace("\n", ""))
        _, parsed = self.page(modes=modes, trace=trace)
        self.assertNotIn("(1)", parsed.text)
        self.assertIn("modes", parsed.sections)
        text = parsed.text.replace("\n", "")
        self.assertIn("surge of platform8.1300.12305.00 %", text)
        self.assertIn("yaw of rotor––rate -0.2 1/s", text)
        for words in ("Campbell diagram", "1P", "3P", "Tasks of each thread", "rank 0, thread 1", "the motion's own mode, surge 0.123 Hz"):
            self.assertIn(words, parsed.text)

    def test_what_a_run_lacks_has_no_section(self):
        t = 0.1 * np.arange(200)
        table = {"time_s": t, "ball.z_m": np.sin(t)}
        _, parsed = self.page(table=table, scene="", log="", parts=[], efficiency=[], counts={})
        self.assertEqual(parsed.sections, ["decay", "key-figures", "motion"])
        _, parsed = self.page(table={"time_s": t, "line.tension_N": 5 + t}, scene="", log="", parts=[], efficiency=[], counts={})
        self.assertEqual(parsed.sections, ["key-figures", "moorings"])

    def test_key_figures_are_right(self):
        t = np.linspace(0, 10, 101)
        _, parsed = self.page(table={"time_s": t, "a.x_m": t ** 2, "rotor.thrust_N": 1e6 + 0 * t}, ranges={"r": {"from_s": 8, "to_s": 10}})
        row = re.search(r"a surge a\.x_m\s*m(.*?)rotor", parsed.text.replace("\n", ""))[1]
        exact = (1000 - 512) / 3 / 2
        last = t[80:] ** 2
        spread = (np.trapz((last - np.trapz(last, t[80:]) / 2) ** 2, t[80:]) / 2) ** 0.5
        self.assertIn(f"100.0{exact:.2f}{spread:.2f}0100.0", row)  # final, mean and standard deviation over 8 ... 10 s, least, greatest
        self.assertIn("rotor thrust rotor.thrust_NMN1.0001.00001.0001.000", parsed.text)

    def test_numerical_trouble_comes_first(self):
        table = synthetic_run.columns(0.1 * np.arange(300))
        table["platform.z_m"][100:103] = [np.nan, np.inf, np.nan]
        text, parsed = self.page(table=table, exit_code=3, exit_reason="pitch beyond 85 deg", numerical_trouble=["aero block 12: pressure < 0"])
        for words in ("Numerical failure", "pitch beyond 85 deg", "aero block 12: pressure < 0",
                      "platform.z_m: 3 of 300 values are not finite, the first at t = 10.00 s"):
            self.assertIn(words, parsed.text)
            self.assertLess(text.index(page.escape(words)), text.index("<section"))
        self.assertIn('class="status bad"', text)

    def test_incomplete_runs(self):
        rows = {"header only": 0, "one row": 1, "two rows": 2}
        for name, count in rows.items():
            with self.subTest(name):
                _, parsed = self.page(rows=count)
                self.assertEqual("motion" in parsed.sections, count > 0)
        with self.subTest("no summary"):
            _, parsed = self.page(with_summary=False) if not (self.folder / "run/summary.json").unlink() else None
            self.assertIn("still running", parsed.text)
        with self.subTest("nothing at all"):
            (self.folder / "none").mkdir()
            _, parsed = self.page("none")
            self.assertEqual(parsed.sections, [])
        with self.subTest("empty files"):
            for name in ("history.csv", "summary.json", "scene.toml", "log.txt", "trace.json.gz"):
                (self.folder / "none" / name).write_text("")
            self.page("none")
        with self.subTest("broken files"):
            for name in ("summary.json", "scene.toml", "trace.json.gz"):
                (self.folder / "none" / name).write_bytes(b"{\xff <b>[")
            (self.folder / "none/history.csv").write_text("time_s,a.x_m\n0,1\n1,oops\n2,3,4\n3,5\n4,")
            _, parsed = self.page("none")
            self.assertIn("2 of its lines are damaged", parsed.text)
            self.assertEqual(RunData(self.folder / "none").values.tolist(), [[0, 3], [1, 5]])
        with self.subTest("summary of another shape"):
            (self.folder / "none/summary.json").write_text('{"parts": [1], "efficiency": ["x"], "columns": [3], "ranges": {"a": 1}}')
            self.page("none")

    def test_a_history_and_a_scene_that_a_spreadsheet_or_an_editor_saved(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            synthetic_run.write(folder, table={"time_s": np.arange(3.0), "float.x_m": np.arange(3.0)}, log="", scene="[wind]\nspeed_m_s = 10.0\n")
            for name in ("history.csv", "scene.toml"):
                (folder / name).write_text((folder / name).read_text(), encoding="utf-8-sig", newline="\r\n")
            run, history = RunData(folder), study_histories.History(folder / "history.csv")
            self.assertEqual((run.notes, run.columns, run.scene), ([], ["time_s", "float.x_m"], {"wind": {"speed_m_s": 10.0}}))
            self.assertEqual(list(run.time), [0.0, 1.0, 2.0])
            self.assertEqual(list(history("time_s")), [0.0, 1.0, 2.0])

    def test_columns_of_nan_only(self):
        t = 0.1 * np.arange(100)
        text, parsed = self.page(table={"time_s": t, "a.x_m": np.nan * t, "a.z_m": t}, scene="", log="")
        self.assertIn("no value at any time: a.x_m", parsed.text)

    def test_text_is_escaped_and_unicode_kept(self):
        evil = "</title><script>alert('x')</script>\" onload=\"x & Wellengang fünf 海"
        t = 0.1 * np.arange(100)
        table = {"time_s": t, "<script>b.x_m": np.sin(t), "$a$.tension_N": t, "a'\"&.tension_N": t, "<i>.strange_N": t}
        text, parsed = self.page(table=table, title=evil, exit_reason=evil, log=f"1 2 warning {evil}\n{evil}",
                                 scene=f'[time]  # {evil}\nend_s = 1.0  # {evil}\n[bodies."<script>"]\nmass_kg = 1.0', scene_path=evil,
                                 numerical_trouble=[evil], parts=[{"name": evil, "core_seconds": 1.0}],
                                 efficiency=[{"name": evil, "value": 0.5, "meaning": evil}], counts={evil: 3},
                                 build={"version": evil}, machine={"host": evil}, trace={"traceEvents": [{"ph": "X", "name": evil, "dur": 1}]})
        self.assertNotIn("<script", text)
        self.assertIn("Wellengang fünf 海", text)
        self.assertIn("alert('x')", parsed.text)  # there, as text

    def test_what_has_no_unit_counts_by_itself_and_coefficients_by_the_largest_of_them(self):
        t = np.arange(50.0)
        table = {"time_s": t, "flow.cfl": 1e6 + 0 * t, "flow.scaled_residual": 1e-9 + 0 * t, "flow.lift_coefficient": 1e-16 * np.sin(t),
                 "flow.drag_coefficient": 0.008 + 0 * t}
        synthetic_run.write(self.folder / "run", table=table, log="")
        run = RunData(self.folder / "run")
        self.assertLess(run.round_off("flow.scaled_residual"), 1e-9)
        self.assertLess(run.round_off("flow.drag_coefficient"), 1e-9)
        self.assertGreater(run.round_off("flow.lift_coefficient"), 1e-16)

    def test_a_run_that_did_not_end_has_means_over_what_its_scene_asks_for(self):
        table = {"time_s": np.arange(0.0, 91.0), "platform.x_m": np.arange(0.0, 91.0)}
        for asked, first in (("", 60.0), ("\n[output]\nmeans_over_s = 20.0\n", 70.0), ("\n[output]\nmeans_over_s = 200.0\n", 0.0)):
            synthetic_run.write(self.folder / "run", table=table, log="", scene=synthetic_run.SCENE + asked, with_summary=False)
            run = RunData(self.folder / "run")
            self.assertEqual(run.time[run.mean_range()[0]][0], first)

    def test_a_million_rows_in_seconds(self):
        t = 0.01 * np.arange(1_000_000)
        folder = self.folder / "run"
        synthetic_run.write(folder, rows=2)
        spike = np.sin(t)
        spike[777_777] = 9.0
        names = ["time_s", "a.x_m", "a.pitch_deg", "rotor.azimuth_deg", "l.tension_N"]
        block = np.column_stack([t, spike, np.cos(3 * t), (50 * t) % 360, 1e5 + 1e3 * np.random.default_rng(1).normal(size=len(t))])
        with open(folder / "history.csv", "wb") as file:
            file.write((",".join(names) + "\n").encode())
            file.write("\n".join(map(",".join, block.round(4).astype("U12"))).encode() + b"\n")
        start = time.process_time()
        text, parsed = self.page("run")
        self.assertLess(time.process_time() - start, 20.0)
        self.assertLess(len(text), 3_000_000)
        self.assertRegex(parsed.text, r"a surge a.x_mm[^a]*−1.0009.000\s*a pitch")  # the peak of one row

    def test_comparison_lays_runs_over_each_other(self):
        synthetic_run.write(self.folder / "a")
        table = synthetic_run.columns(0.2 * np.arange(600))
        table["platform.pitch_deg"] *= 1.1
        synthetic_run.write(self.folder / "b", table=table, scene=synthetic_run.SCENE.replace("1.5e6", "1.65e6"))
        text, parsed = self.page("a", "b")
        self.assertEqual(parsed.sections, ["differences", "key-figures"] + [key for key in ALL[1:10] if key != "model"])
        self.assertRegex(parsed.text, r"aero\.thrust_N\s*1500000\s*1650000")
        self.assertIn("5.720 (+0.521 deg)", parsed.text)   # a share of an angle says nothing
        self.assertIn("1.499 (−0.08 %)", parsed.text)
        synthetic_run.write(self.folder / "deep/a", rows=0)
        self.page("a", "deep/a")  # equal names, and one without rows

    def test_runs_of_other_bodies_are_drawn_under_their_own_names(self):
        t = 0.1 * np.arange(200)
        for name, body in (("a", "platform"), ("b", "spar")):
            table = {"time_s": t, f"{body}.x_m": np.sin(t), f"{body}.sea.fy_N": np.sin(t), "bearing.fy_N": 2.0 * np.sin(t)}
            synthetic_run.write(self.folder / name, table=table, log="", scene=f"[bodies.{body}]\nmass_kg = 1.0\n[joints.bearing]\nbodies = ['{body}', 'rotor']\n")
        runs = [RunData(self.folder / name) for name in ("a", "b")]
        figures_of = page.time_figures(runs)
        self.assertNotIn("bearing, on rotor", figures_of["forces"])
        place = figures_of["motion"].split("platform: position", 1)[1].split("spar: position")[0]
        self.assertIn(">a<", place)
        self.assertNotIn(">b<", place)

    def test_a_section_that_one_run_lacks_is_one_difference(self):
        one = synthetic_run.SCENE + "[control]\nmodel = 'dtu'\nstart = true\n[[output.expected]]\ncolumn = 'a'\n"
        synthetic_run.write(self.folder / "a", scene=one)
        synthetic_run.write(self.folder / "b", scene=synthetic_run.SCENE.replace("[joints.bearing]", "[joints.hinge]"))
        _, parsed = self.page("a", "b")
        said = parsed.text[parsed.text.rindex("Differences of the scenes"):parsed.text.rindex("Key figures")]
        self.assertEqual(said.split("ab", 1)[1].split(), ["joints.bearinggiven–", "controlgiven–", "joints.hinge–given"])

    def test_tick_labels_tell_values_apart(self):
        text, _ = self.page(table={"time_s": np.linspace(0, 1, 300), "a.x_m": 1.5 + 0.04 * np.sin(np.linspace(0, 9, 300))}, scene="", log="")
        labels = re.findall(r"<text[^>]*>(1\.\d+)</text>", text)
        self.assertGreaterEqual(len(labels), 3)
        self.assertEqual(len(labels), len(set(labels)))

    def test_large_drawings_become_pictures(self):
        figures.SVG_LIMIT_BYTES, kept = 2000, figures.SVG_LIMIT_BYTES
        try:
            text, parsed = self.page(table={"time_s": np.arange(99.0), "a.x_m": np.sin(np.arange(99.0))}, scene="", log="")
        finally:
            figures.SVG_LIMIT_BYTES = kept
        self.assertIn("data:image/png;base64,", text)

    def test_picture(self):
        synthetic_run.write(self.folder / "run")
        picture.draw(RunData(self.folder / "run"), self.folder / "p.png")
        self.assertEqual((self.folder / "p.png").read_bytes()[:4], b"\x89PNG")
        synthetic_run.write(self.folder / "empty", rows=0)
        with self.assertRaisesRegex(ValueError, "nothing to draw"):
            picture.draw(RunData(self.folder / "empty"), self.folder / "q.png")


class PartsTest(unittest.TestCase):
    def test_every_column_is_in_exactly_one_figure(self):
        names = list(synthetic_run.columns(np.arange(3.0))) + ["odd", "a.b.c_kg", "platform.sea.fx_N_m", "x_m"]
        used = [c for group in quantities.groups(names) for c in group.columns()]
        self.assertEqual(sorted(used), sorted(names[1:]))

    def test_the_force_of_a_joint_stands_with_the_loads_of_the_first_body_it_holds(self):
        names = list(synthetic_run.columns(np.arange(3.0))) + ["bearing.fx_N", "bearing.mx_N_m", "post.fx_N"]
        found = {g.title: g for g in quantities.groups(names, {"bearing": ["platform", "rotor"], "post": ["earth", "rotor"]})}
        self.assertIn(("bearing, on rotor", "bearing.fx_N"), dict(found["platform: forces by source"].panels)["fx"])
        self.assertIn("the opposite one acts on the other", found["platform: forces by source"].caption)
        used = [c for g in found.values() for c in g.columns()]
        self.assertEqual(sorted(used), sorted(names[1:]))

    def test_units(self):
        for name, unit in {"a.x_m": "m", "a.vx_m_s": "m/s", "a.ax_m_s2": "m/s²", "a.sea.mx_N_m": "N m", "rotor.rpm": "rpm", "odd": "",
                           "a.fx_N": "N", "rotor.power_W": "W"}.items():
            self.assertEqual(quantities.unit_of(name), unit, name)
        self.assertEqual(quantities.scaled("N", 1.5e6), ("MN", 1e-6))
        self.assertEqual(quantities.scaled("m", 1.5e6), ("m", 1.0))

    def test_the_envelope_keeps_every_extreme_and_the_order(self):
        values = np.random.default_rng(3).normal(size=100_003)
        values[[5, 99_999]] = [50.0, -50.0]
        x, y = figures.envelope(np.arange(100_003.0), values)
        self.assertLess(len(x), 1500)
        self.assertEqual((y.max(), y.min()), (50.0, -50.0))
        self.assertTrue((np.diff(x) > 0).all())
        self.assertEqual((x[0], x[-1]), (0, 100_002))
        figures.envelope(np.arange(100_003.0), np.nan * values)

    def test_the_drawn_curve_is_that_of_the_rows_within_a_pixel(self):
        """Of the SVG, at the width of a screen's column: each row lies within a pixel of the curve, each corner of the curve on the rows."""
        for rows in (700, 2801, 6001, 60_001):
            with self.subTest(rows=rows):
                t = np.linspace(0.0, 600.0, rows)
                values = np.sin(0.05 * t) + 0.4 * np.sin(1.7 * t) + 0.002 * t
                x, y = figures.envelope(t, values)
                pixel_x, pixel_y = 600.0 / 540.0, np.ptp(values) / 120.0
                for at, value in zip(t, values):
                    low, high = np.searchsorted(x, at - pixel_x), np.searchsorted(x, at + pixel_x, side="right")
                    near = y[max(0, low - 1): high + 1]
                    self.assertTrue(near.min() - pixel_y <= value <= near.max() + pixel_y, f"row at {at:.3f} s")
                np.testing.assert_array_equal(np.interp(x, t, values), y)

    def test_health_says_what_stands_against_a_run(self):
        cylinder = {"start_m": [0, 0, -14.0], "end_m": [0, 0, 12.0], "diameter_m": 11.25}
        weight = 1025.0 * 9.81 * 14.0 * np.pi / 4 * 11.25**2
        t = 0.1 * np.arange(400)
        table = {"time_s": t, "float.x_m": 0 * t, "float.z_m": 2.0 + 0 * t, "float.pitch_deg": 0 * t, "float.sea.fz_N": weight + 0 * t,
                 "line.tension_N": 1e5 + 0 * t, "sea.lost_particles": 0 * t, "coupling.mismatch": 0.01 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder) / "run"
            synthetic_run.write(folder, table=table)
            run = RunData(folder)
            run.scene = {"sea": {"model": "sph"}, "bodies": {"float": {"cylinders": [cylinder]}}}
            found = {c.title: c for c in verdict.health(run)}
            self.assertEqual(found["Draft"].level, "warn")
            self.assertIn("2.00 m too high", found["Draft"].text)
            self.assertIn("Look before you trust it: draft", verdict.headline(verdict.health(run))[1])
            self.assertEqual(found["Lines"].level, "good")
            run.values[run.columns.index("float.z_m")] = 0.01
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Draft"], "good")
            run.values[run.columns.index("line.tension_N")][7] = -1.0
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Lines"], "good")   # a hundred-thousandth of it: a line that is just taut
            run.values[run.columns.index("line.tension_N")][7] = -100.0
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Lines"], "bad")
            run.values[run.columns.index("line.tension_N")][:] = np.where(t < 10.0, 500.0, 1e5)
            for line, said in (({"model": "lumped_mass", "mass_kg_m": 20.0, "rest_length_m": 100.0, "segments": 20}, "slack: line 25 %"),
                               ({"model": "catenary"}, "none pushes"), ({"model": "spring_damper"}, "none goes slack")):
                run.scene["moorings"] = {"line": line}
                self.assertTrue({c.title: c for c in verdict.health(run)}["Lines"].text.split(" of the time")[0].endswith(said))
            run.values[run.columns.index("float.z_m")] = 0.05 * t
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Settled"], "warn")
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Coupling"], "good")
            run.values[run.columns.index("coupling.mismatch")][:20] = 1.0   # of the first windows, which begin without loads
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Coupling"], "good")
            run.values[run.columns.index("coupling.mismatch")] = 0.8
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Coupling"], "warn")

    def test_the_draft_is_that_of_all_volume_under_water_or_not_judged(self):
        column = {"start_m": [0, 0, -14.0], "end_m": [0, 0, 12.0], "diameter_m": 10.0}
        cone = {"start_m": [0, 0, -20.0], "end_m": [0, 0, -14.0], "diameter_m": 16.0, "end_diameter_m": 10.0}
        tower = {"start_m": [0, 0, 12.0], "end_m": [0, 0, 90.0], "diameter_m": 8.0, "end_diameter_m": 4.0}
        volume = 14.0 * np.pi / 4 * 100.0 + 6.0 * np.pi / 12 * (16.0**2 + 16.0 * 10.0 + 10.0**2)
        t = 0.1 * np.arange(100)
        table = {"time_s": t, "float.z_m": 0 * t, "float.sea.fz_N": 1025.0 * 9.81 * (volume - 0.5 * np.pi / 4 * 100.0) + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, log="")
            run = RunData(pathlib.Path(folder))

            def draft(**shapes):
                run.scene = {"sea": {"model": "sph"}, "bodies": {"float": shapes}}
                return verdict._draft(run)

            self.assertIn("asks for 0.500 m", draft(cylinders=[column, cone, tower]).text)
            self.assertIsNone(draft(cylinders=[column, cone], boxes=[{"size_m": [50.0, 8.0, 6.0], "centre_m": [0.0, 0.0, -17.0]}]))
            self.assertIsNone(draft(cylinders=[column | {"end_diameter_m": 6.0}]))
            self.assertIsNone(draft(cylinders=[cone]))
            # In waves over whole ones: 1.4 of them have a mean of their own.
            swing = 0.3 * np.sin(2 * np.pi * (t - t[-1]) / 7.0)
            synthetic_run.write(pathlib.Path(folder), log="", table=table | {"float.z_m": 0.5 + swing}, ranges={"end": {"from_s": 0.0, "to_s": 9.9}})
            run = RunData(pathlib.Path(folder))
            run.scene = {"sea": {"model": "sph"}, "bodies": {"float": {"cylinders": [column, cone]}}, "waves": {"model": "airy", "height_m": 1.0, "period_s": 7.0}}
            self.assertIn("floats at 0.500 m; the vertical load on it asks for 0.500 m", verdict._draft(run).text)

    def test_a_sea_state_of_few_waves_is_chance_and_is_told_with_its_spectrum(self):
        def settings(model="jonswap", more=""):
            return f"[waves]\nmodel = '{model}'\nheight_m = 3.0\nperiod_s = 8.0\n{more}[bodies.float]\nmass_kg = 1.0\n"
        with tempfile.TemporaryDirectory() as folder:
            def made(end, scene):
                t = 0.25 * np.arange(int(4 * end) + 1)
                water = 0.75 * np.sqrt(2.0) * np.sin(2 * np.pi * t / 8.0)
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "float.z_m": 0.5 * water, "waves.elevation_m": water}, log="", scene=scene, ranges={"end": {"from_s": 40.0, "to_s": end}})
                run = RunData(pathlib.Path(folder))
                return run, {text: f"{value} {unit}" for text, value, unit in verdict.answers(run)}, {c.title: c for c in verdict.health(run)}.get("Means")

            run, said, means = made(440.0, settings())
            self.assertIsNone(means)
            self.assertRegex(said["significant height of the waves, 4 sigma"], r"^(2\.99|3\.00)\d* m")
            self.assertIn("Surface of the water: spectra", str(page.spectra([run])))
            few = made(150.0, settings())[2]
            self.assertEqual(few.level, "warn")
            self.assertIn("over 14 waves of the sea state's peak", few.text)
            run, said, means = made(150.0, settings(more="crest_height_m = 3.0\n"))
            self.assertIsNone(means)
            self.assertNotIn("significant height of the waves, 4 sigma", said)
            self.assertNotIn("Surface of the water", str(page.spectra([made(440.0, settings("airy"))[0]])))

    def test_a_floater_that_still_drifts_in_a_sea_state_has_not_settled(self):
        t = 0.1 * np.arange(401)
        wave = np.sin(2 * np.pi * t / 8.0)
        table = {"time_s": t, "float.x_m": 0.35 * t + 0.2 * wave, "float.z_m": 0.1 * wave, "rotor.thrust_N": 3e5 + 1e4 * wave}
        scene = "[sea]\nmodel = 'morison'\n[waves]\nmodel = 'jonswap'\nheight_m = 2.0\nperiod_s = 8.0\n[bodies.float]\nmass_kg = 1.0\n[moorings.line]\nbody = 'float'\n"
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, scene=scene, log="", ranges={"end": {"from_s": 27.0, "to_s": 40.0}})
            found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}
            self.assertEqual(found["Settled"].level, "warn")
            self.assertRegex(found["Settled"].text, r"surge by 2\.\d m changed")
            self.assertEqual(found["Means"].level, "warn")

    def test_the_headline_says_what_the_log_warns_of(self):
        words = lambda text: verdict.headline([verdict.Check("good", "Numbers", "all finite"), verdict.Check("warn", "Power", "mean 16 MW"), verdict.Check("warn", "Log", text)])[1]
        self.assertEqual(words("1 warning: bodies.float: hits the bed"), "Look before you trust it: power, log (1 warning: bodies.float: hits the bed)")
        self.assertRegex(words("2 warnings: " + 60 * "long "), r"log \(2 warnings: long .*long\.\.\.\)$")
        self.assertLess(len(words("2 warnings: " + 60 * "long ")), 160)

    def test_what_is_held_in_waves_answers_with_what_holds_it(self):
        t = 0.1 * np.arange(401)
        wave = np.sin(2 * np.pi * t / 8.0)
        table = {"time_s": t, "column.x_m": 0 * t, "foot.fx_N": 3e5 * wave, "foot.fy_N": 4e5 * wave, "foot.fz_N": 0 * t, "foot.mx_N_m": 5e6 * wave, "foot.my_N_m": 12e6 * wave}
        scene = "[sea]\nmodel = 'morison'\n[bodies.column]\nmass_kg = 1.0\n[joints.foot]\ntype = '{}'\nbodies = ['earth', 'column']\n"
        with tempfile.TemporaryDirectory() as folder:
            for kind, held in (("fixed", True), ("spherical", False)):
                synthetic_run.write(pathlib.Path(folder), table=table, scene=scene.format(kind), log="", ranges={"end": {"from_s": 20.0, "to_s": 40.0}})
                run = RunData(pathlib.Path(folder))
                said = {text: f"{value} {unit}" for text, value, unit in verdict.answers(run)}
                self.assertEqual(said, {"horizontal force on foot, greatest": "500.0 kN", "overturning moment on foot, greatest": "13.00 MN m"} if held else {})
                self.assertIn("foot: moments", [g.title for g in quantities.groups(run.columns, {"foot": ["earth", "column"]})])

    def test_an_impact_answers_with_its_way_and_its_load(self):
        t = 0.001 * np.arange(161)
        table = {"time_s": t, "cylinder.x_m": 0 * t, "cylinder.z_m": -0.17 * np.sqrt(t / 0.16), "cylinder.pitch_deg": 0 * t, "cylinder.sea.fz_N": 1300.0 * np.exp(-t / 0.01)}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, log="", scene="[sea]\nmodel = 'sph'\n[bodies.cylinder]\nmass_kg = 1.0\nvelocity_m_s = [0, 0, -2.96]\n")
            run = RunData(pathlib.Path(folder))
            self.assertEqual(verdict.answers(run), [("heave, at the end", "−0.1700", "m"), ("largest load of the water, up, of one row", "1.300", "kN")])
            self.assertEqual({c.title: c.level for c in verdict.health(run)}["Settled"], "good")
            self.assertEqual(page._span(run), "Of the whole run.")
            self.assertEqual(str(page.spectra([run])), "")

    def test_the_load_of_an_impact_is_a_mean_over_the_sound_in_it(self):
        t = 0.0005 * np.arange(61)
        load = 27e3 * np.sin(np.pi * t / 0.05) + 40e3 * np.sin(2 * np.pi * t / 0.0023)   # a similarity solution's and the ringing of the water
        table = {"time_s": t, "wedge.x_m": 0 * t, "wedge.z_m": -5.0 * t, "wedge.vx_m_s": 0 * t, "wedge.vy_m_s": 0 * t, "wedge.vz_m_s": -5.0 + 0 * t, "wedge.sea.fz_N": load}
        scene = ("[environment]\nwater_depth_m = 1.0\n[sea]\nmodel = 'sph'\n[sea.particles]\ndimensions = '{}'\n[bodies.wedge]\nmass_kg = 1.0\nvelocity_m_s = [0, 0, -5.0]\n"
                 "[[bodies.wedge.boxes]]\ncentre_m = [0.0, 0.0, 0.0]\nsize_m = [0.5, 0.75, 0.2]\n")
        with tempfile.TemporaryDirectory() as folder:
            for dimensions, sound, over, said in (("2", 100.0, 0.01, "10 ms"), ("2", 200.0, 0.005, "5.0 ms"), ("3", 100.0, 0.015, "15 ms"),
                                                  ("2", 40.0 * 9.81 ** 0.5, 1.0 / (40.0 * 9.81 ** 0.5), "8.0 ms"), ("2", 1500.0, None, "")):
                synthetic_run.write(pathlib.Path(folder), table=table, log="", scene=scene.format(dimensions), sound_speed_m_s=sound, ranges={"end": {"from_s": 0.02, "to_s": 0.03}})
                run = RunData(pathlib.Path(folder))
                (text, value, unit), = [answer for answer in verdict.answers(run) if answer[0].startswith("largest load")]
                if over is None:   # less than a few rows
                    self.assertEqual(text, "largest load of the water, up, of one row")
                    continue
                self.assertEqual((text, unit), (f"largest load of the water, up, mean over {said}", "kN"))
                whole = round(over / 0.0023)
                self.assertAlmostEqual(float(value), 26.0, delta=1.0 + 40.0 / (np.pi * whole))
            synthetic_run.write(pathlib.Path(folder), table=table, log="", scene=scene.format("2"), sound_speed_m_s=100.0, ranges={"end": {"from_s": 0.02, "to_s": 0.03}})
            run = RunData(pathlib.Path(folder))
            largest = next(value for text, value, _ in verdict.answers(run) if text.startswith("largest load"))
            self.assertRegex(str(page.key_figures(run)), rf"wedge load up, mean of 10 ms.*{largest}</td>")
            self.assertIn(f"its largest mean over 10 ms, in which sound goes through the body and back, is {largest} kN", page.time_figures([run])["forces"])

    def test_a_gust_answers_with_its_least_and_greatest_loads(self):
        t = 0.1 * np.arange(600)
        gust = np.exp(-((t - 30.0) / 2.0) ** 2)
        table = {"time_s": t, "rotor.thrust_N": 1e6 * (1 + 0.8 * gust), "rotor.rpm": 9.6 - 0.6 * gust, "rotor.power_W": 1e7 + 0 * t, "rotor.electrical_power_W": 9.4e6 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, log="", ranges={"end": {"from_s": 45.0, "to_s": 59.9}}, scene="[wind]\nspeed_m_s = 14.0\n[wind.event]\nwhat = 'eog'\n")
            run = RunData(pathlib.Path(folder))
            found = {text: (value, unit) for text, value, unit in verdict.answers(run)}
            self.assertEqual(found["thrust"], ("1.000", "MN"))
            self.assertEqual(found["thrust, greatest"], ("1.800", "MN"))
            self.assertEqual(found["rotor speed, least"], ("9.000", "rpm"))
            self.assertEqual(found["electrical power"], ("9.400", "MW"))
            self.assertEqual(page._span(run), "Means over 45 to 59.9 s; least and greatest of the whole run.")

    def test_a_tank_answers_with_wave_heights_over_its_last_waves(self):
        t = 0.01 * np.arange(1001)
        table = {"time_s": t, "g1.elevation_m": (0.03 - 0.001 * np.minimum(t, 5.0)) * np.cos(2 * np.pi * t / 1.5), "sea.particles": 0 * t + 9e3}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, log="", scene="[sea]\nmodel = 'sph'\n[waves]\nheight_m = 0.05\nperiod_s = 1.5\n")
            run = RunData(pathlib.Path(folder))
            self.assertEqual(verdict.answers(run), [("wave height at g1", "0.05000", "m")])
            self.assertEqual(page._span(run), "Over the last two waves.")

    def test_a_sea_state_answers_with_its_significant_height_and_has_no_whole_waves(self):
        t = 0.1 * np.arange(6001)
        eta = 0.5 * np.sin(2 * np.pi * t / 10.0) + 0.4 * np.sin(2 * np.pi * t / 7.3)
        scene = "[sea]\nmodel = 'sph'\n[waves]\nmodel = 'jonswap'\nheight_m = 2.0\nperiod_s = 10.0\n"
        ranges = {"end": {"from_s": 85.0, "to_s": 600.0}}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "g1.elevation_m": eta, "sea.particles": 0 * t + 9e3}, log="", scene=scene, ranges=ranges)
            run = RunData(pathlib.Path(folder))
            (text, value, unit), = verdict.answers(run)
            self.assertEqual((text, unit), ("significant height at g1, 4 sigma", "m"))
            self.assertAlmostEqual(float(value) / (4.0 * np.sqrt(0.5 * (0.5**2 + 0.4**2))), 1.0, delta=0.01)
            self.assertEqual(page._span(run), "Over 85 to 600 s.")
            self.assertIn("waves of Hs 2 m and Tp 10 s", verdict.what_ran(run))
            table = {"time_s": t, "float.x_m": 0 * t, "float.z_m": 3.0 * eta}
            synthetic_run.write(pathlib.Path(folder), table=table, log="", scene=scene + "[bodies.float]\nmass_kg = 1.0\n", ranges=ranges)
            run = RunData(pathlib.Path(folder))
            self.assertEqual(page._span(run), "Means ± standard deviation over 85 to 600 s.")
            self.assertNotIn("Means", [c.title for c in verdict.health(run)])

    def test_health_names_floats_that_lean(self):
        t = 0.1 * np.arange(400)
        for lean, level in ((20.0, None), (50.0, "warn"), (120.0, "warn")):
            with self.subTest(lean), tempfile.TemporaryDirectory() as folder:
                table = {"time_s": t, "box.x_m": 0 * t, "box.z_m": 0 * t, "box.pitch_deg": lean * (1 - np.exp(-t))}
                synthetic_run.write(pathlib.Path(folder), table=table, log="", scene="[sea]\nmodel = 'sph'\n[bodies.box]\nmass_kg = 80.0\n"
                                    "[[bodies.box.boxes]]\nsize_m = [0.4, 0.4, 0.4]\ncentre_m = [0.0, 0.0, 0.0]\n")
                found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}.get("Upright")
                self.assertEqual(found and found.level, level)
                if lean == 50.0:
                    self.assertEqual(found.text, "box leans by up to 50 degrees, past 30 first at t = 1.000 s")
                if lean == 120.0:
                    self.assertIn("has turned over", found.text)

    def test_health_names_means_over_parts_of_waves(self):
        t = 0.1 * np.arange(401)
        table = {"time_s": t, "float.x_m": 0 * t, "float.z_m": -0.5 + np.sin(2 * np.pi * t / 10.0), "float.pitch_deg": 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder) / "run"

            def means(over):
                synthetic_run.write(folder, table=table, log="", scene="[waves]\nmodel = 'airy'\nheight_m = 2.0\nperiod_s = 10.0\n[bodies.float]\nmass_kg = 1.0\n",
                                    ranges={"end": {"from_s": 40.0 - over, "to_s": 40.0}})
                run = RunData(folder)
                found = [c for c in verdict.health(run) if c.title == "Means"]
                return (found[0].level, found[0].text) if found else None, page._span(run)

            self.assertEqual(means(20.0), (None, "Means ± standard deviation over 20 to 40 s, 2.00 waves."))
            (level, text), span = means(15.0)
            self.assertEqual((level, text), ("warn", "over 1.50 waves; over the last whole one: heave −0.500 for −0.712 m"))
            self.assertEqual(means(5.0)[0], ("warn", "over 0.50 of a wave, which say little: output.means_over_s = 10.00 is one wave"))

    def test_the_way_of_a_towed_body_need_not_settle(self):
        t = 0.1 * np.arange(400)
        for joint, level in (("", "warn"), ("[joints.tow]\nbodies = ['earth', 'float']\n[joints.tow.translation]\nspeed_m_s = 1.0\n", "good"),
                             ("[joints.yaw]\nbodies = ['float', 'nacelle']\n[joints.yaw.rotation]\nspeed_rad_s = 1.0\n", "warn")):
            with self.subTest(joint), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "float.x_m": t, "float.z_m": 0 * t}, log="",
                                    scene="[sea]\nmodel = 'morison'\n[bodies.float]\nmass_kg = 1.0\n" + joint)
                self.assertEqual({c.title: c.level for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"], level)

    def test_a_march_whose_loads_still_change_has_not_settled(self):
        n = np.arange(1.0, 101.0)
        for change, level in ((0.0, "good"), (0.05, "warn")):
            with self.subTest(change), tempfile.TemporaryDirectory() as folder:
                table = {"time_s": n, "flow.density_residual": 10.0 ** (-n / 20), "flow.lift_coefficient": 0.8 * (1 + change * (n > 90)), "flow.drag_coefficient": 0.01 + 0 * n}
                synthetic_run.write(pathlib.Path(folder), table=table, scene="[aero]\nmodel = 'blade_resolved'\n[aero.flow]\ntime = 'steady'\n", log="")
                found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"]
                self.assertEqual(found.level, level)
                if change:
                    self.assertIn("over the last 20 pseudo-steps lift coefficient by 4.8 % changed", found.text)

    def test_a_section_without_lift_has_settled_when_its_drag_has(self):
        n = np.arange(1.0, 101.0)
        for lift, level in ((1e-7 * np.cos(n), "good"), (1e-3 * np.cos(n), "warn")):
            with tempfile.TemporaryDirectory() as folder:
                table = {"time_s": n, "flow.density_residual": 10.0 ** (-n / 20), "flow.lift_coefficient": lift, "flow.drag_coefficient": 0.008 + 0 * n}
                synthetic_run.write(pathlib.Path(folder), table=table, scene="[aero]\nmodel = 'blade_resolved'\n[aero.flow]\ntime = 'steady'\n", log="")
                self.assertEqual({c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"].level, level)

    def test_a_march_that_ends_above_its_first_flux_balance_is_not_green(self):
        n = np.arange(1.0, 101.0)
        for last, level in ((80.0, "bad"), (0.5, "warn"), (1e-4, "good")):
            with self.subTest(last), tempfile.TemporaryDirectory() as folder:
                # The density residual falls and the loads stand still in all three.
                table = {"time_s": n, "flow.density_residual": 10.0 ** (-n / 20), "flow.balance_drop": last ** (n / 100.0), "flow.lift_coefficient": 0.8 + 0 * n}
                synthetic_run.write(pathlib.Path(folder), table=table, scene="[aero]\nmodel = 'blade_resolved'\n[aero.flow]\ntime = 'steady'\ndrop = 0.0\n", log="")
                checks = verdict.health(RunData(pathlib.Path(folder)))
                found = {c.title: c for c in checks}["Residual"]
                self.assertEqual(found.level, level)
                if last > 1.0:
                    self.assertEqual(verdict.headline(checks)[0], "bad")
                    self.assertIn("did not converge: its flux balance ends at 80 times that of the start", found.text)
                # A march that the program ended as its loads had settled is not to be thrown away for it.
                synthetic_run.write(pathlib.Path(folder), table=table, scene="[aero]\nmodel = 'blade_resolved'\n[aero.flow]\ntime = 'steady'\ndrop = 0.0\n", log="",
                                    exit_reason="done: the loads have settled; flux balance at 80")
                self.assertEqual({c.title: c.level for c in verdict.health(RunData(pathlib.Path(folder)))}["Residual"], "good" if last < 0.1 else "warn")

    def test_what_the_end_tells_is_told_once(self):
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), exit_code=3, exit_reason="aero: no residual", numerical_trouble=["aero: no residual"])
            said = " ".join(c.text for c in verdict.health(RunData(pathlib.Path(folder))))
            self.assertEqual(said.count("no residual"), 1)

    def test_many_lines_of_one_quantity_have_a_panel_each_with_the_same_axes(self):
        t = 0.1 * np.arange(100)
        for count, panels in ((figures.MOST_LINES, 1), (9, 9)):
            with self.subTest(count), tempfile.TemporaryDirectory() as folder:
                table = {"time_s": t} | {f"g{n}.elevation_m": (n + 1) * np.sin(t) for n in range(count)}
                synthetic_run.write(pathlib.Path(folder), table=table, scene="", log="")
                run = RunData(pathlib.Path(folder))
                drawing = figures.series([run], next(g for g in quantities.groups(run.columns) if g.title == "Wave gauges"))
                axes = [axis for axis in drawing.figure.axes if axis.get_visible()]
                self.assertEqual(len(axes), panels)
                self.assertEqual(len({axis.get_ylim() for axis in axes}), 1)
                self.assertEqual(sum(len(axis.lines) for axis in axes), count)
                self.assertEqual([axis.get_title(loc="left") for axis in axes], [f"g{n}" for n in range(count)] if panels > 1 else [""])
                figures.plt.close(drawing.figure)

    def test_labels_of_panels_fit_beside_each_other(self):
        t = 0.1 * np.arange(100)
        with tempfile.TemporaryDirectory() as folder:
            table = {"time_s": t, "rotor.thrust_N": 1e6 + t, "rotor.generator_torque_N_m": 1e7 + 1e6 * t, "rotor.electrical_power_W": 1e7 + 1e6 * t}
            synthetic_run.write(pathlib.Path(folder), table=table, scene="", log="")
            run = RunData(pathlib.Path(folder))
            figure = figures.series([run], next(g for g in quantities.groups(run.columns) if g.title == "rotor: control")).figure
            figure.canvas.draw()
            boxes = [axis.yaxis.label.get_window_extent() for axis in figure.axes]
            self.assertEqual([axis.get_ylabel() for axis in figure.axes], ["generator torque\n[MN m]", "electrical power\n[MW]"])
            self.assertFalse(boxes[0].overlaps(boxes[1]))
            figures.plt.close(figure)

    def test_a_thrust_that_still_changes_has_not_settled(self):
        t = 0.1 * np.arange(400)
        for change, level in ((0.0, "good"), (0.1, "warn")):
            with self.subTest(change), tempfile.TemporaryDirectory() as folder:
                table = {"time_s": t, "float.x_m": 0 * t, "rotor.thrust_N": 1e6 * (1 + change * (t > 35)) + 2e4 * np.sin(t), "rotor.power_W": 5e6 + 0 * t}
                synthetic_run.write(pathlib.Path(folder), table=table, scene="[bodies.float]\nmass_kg = 1.0\n", log="", ranges={"end": {"from_s": 30.0, "to_s": 40.0}})
                found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"]
                self.assertEqual(found.level, level)
                self.assertEqual("thrust by" in found.text, change > 0.0)

    def test_a_surge_that_swings_slowly_has_not_settled_wherever_its_origin_is(self):
        t = 0.1 * np.arange(1201)
        for far in (0.0, 20.0):
            for swing, level in ((0.1, "good"), (1.5, "warn")):
                with self.subTest(far=far, swing=swing), tempfile.TemporaryDirectory() as folder:
                    table = {"time_s": t, "float.x_m": far + swing * np.cos(2 * np.pi * t / 119.0)}
                    synthetic_run.write(pathlib.Path(folder), table=table, scene="[bodies.float]\nmass_kg = 1.0\n", log="", ranges={"end": {"from_s": 60.0, "to_s": 120.0}})
                    found = {c.title: c.level for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"]
                    self.assertEqual(found, level if far else "warn")

    def test_all_six_motions_are_told_and_judged(self):
        t = 0.1 * np.arange(1201)
        wave, drift = np.sin(2 * np.pi * t / 10.0), np.tanh((t - 90.0) / 5.0)
        scene = "[waves]\nmodel = 'airy'\nheight_m = 4.0\nperiod_s = 10.0\n[bodies.spar]\nmass_kg = 1.0\n"
        along = {"spar.x_m": 0.2 * wave, "spar.y_m": 0 * t, "spar.z_m": 0.1 * wave, "spar.roll_deg": 0 * t, "spar.pitch_deg": 0.4 * wave, "spar.yaw_deg": 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            def told(**columns):
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t} | along | {f"spar.{name}": values for name, values in columns.items()}, scene=scene, log="",
                                    ranges={"end": {"from_s": 60.0, "to_s": 120.0}})
                run = RunData(pathlib.Path(folder))
                return [text for text, _, _ in verdict.answers(run)], {c.title: c for c in verdict.health(run)}["Settled"]

            self.assertEqual(told()[0], ["surge", "heave", "pitch"])
            self.assertEqual(told()[1].level, "good")
            # Along y: what nothing drives is left out.
            across = {"x_m": -7e-4 + 4e-4 * wave, "y_m": 0.2 * wave + 0.08 * drift, "roll_deg": 0.4 * wave, "pitch_deg": -8e-6 + 4e-6 * wave}
            said, settled = told(**across)
            self.assertEqual(said, ["sway", "heave", "roll"])
            self.assertEqual((settled.level, "sway by 0.14 m changed" in settled.text), ("warn", True))
            for name, size, change in (("roll_deg", 0.02, False), ("roll_deg", 0.05, True), ("yaw_deg", 0.05, True), ("y_m", 0.008, False), ("y_m", 0.02, True)):
                with self.subTest(name, size=size):
                    self.assertEqual(told(**{name: size * drift})[1].level, "warn" if change else "good")
            # A yaw that passes half a turn has a mean all the same.
            said, settled = told(yaw_deg=(180.0 + 5.0 * wave + 180.0) % 360.0 - 180.0)
            self.assertEqual(settled.level, "good")

    def test_a_body_adrift_is_told_by_its_drift_and_does_not_settle_in_place(self):
        t = 0.05 * np.arange(1201)
        wave = np.sin(2 * np.pi * t / 6.0)
        table = {"time_s": t, "raft.x_m": 0.3 * t + 0.5 * wave, "raft.y_m": 0 * t, "raft.z_m": 0.5 * wave, "raft.vx_m_s": 0.3 + 0.5 * np.pi / 3 * np.cos(np.pi * t / 3), "raft.vy_m_s": 0 * t}
        scene = "[sea]\nmodel = '{}'\n{}[waves]\nmodel = 'airy'\nheight_m = 1.0\nperiod_s = 6.0\n[bodies.raft]\nmass_kg = 1.0\n"
        line, post = "[moorings.line]\nbody = 'raft'\n", "[joints.post]\nbodies = ['earth', 'raft']\ntype = 'translational'\n"
        springs = "matrices = [{ body = 'raft', stiffness = [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]] }]\n"
        with tempfile.TemporaryDirectory() as folder:
            for more, sea, adrift in (("", "sph", True), ("", "none", False), (line, "sph", False), (post, "sph", False), (springs, "morison", False)):
                with self.subTest(more=more, sea=sea):
                    synthetic_run.write(pathlib.Path(folder), table=table, scene=scene.format(sea, more), log="", ranges={"end": {"from_s": 30.0, "to_s": 60.0}})
                    run = RunData(pathlib.Path(folder))
                    said = [text for text, _, _ in verdict.answers(run)]
                    self.assertEqual(("drift in surge" in said, "surge" in said), (adrift, not adrift))
                    self.assertEqual({c.title: c for c in verdict.health(run)}["Settled"].level, "good" if adrift else "warn")
                    if adrift:
                        self.assertRegex(dict((text, value + " " + unit) for text, value, unit in verdict.answers(run))["drift in surge"], r"^0\.30 ± 0\.37 m/s")

    def test_a_free_body_with_too_few_swings_still_swings(self):
        t = 0.01 * np.arange(191)
        ripple = 1e-4 * np.sin(40.0 * t)
        scene = "[sea]\nmodel = 'sph'\n[bodies.ship]\nmass_kg = 1.0\n"
        with tempfile.TemporaryDirectory() as folder:
            def settled(roll, more="", **columns):
                table = {"time_s": t, "ship.z_m": ripple, "ship.roll_deg": roll + ripple, "ship.pitch_deg": 0.005 + 0 * t}
                synthetic_run.write(pathlib.Path(folder), table=table | {f"ship.{name}": values for name, values in columns.items()}, scene=scene + more, log="",
                                    ranges={"end": {"from_s": 1.26, "to_s": 1.9}})
                return {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"]

            short = 8.0 * np.exp(-0.1 * t) * np.cos(2 * np.pi * (t - 0.05) / 0.65)
            for values in (8.0 * np.cos(2 * np.pi * t / 1.3), 8.0 * np.exp(-0.3 * t) * np.cos(2 * np.pi * t / 0.9)):
                found = settled(values)
                self.assertEqual((found.level, found.text), ("warn", "still swinging in roll, too few times for a period and a damping: run on (time.end_s)"))
            self.assertIn("a free motion", settled(short).text)
            found = settled(8.0 * np.cos(2 * np.pi * t / 1.3), z_m=0.3 * np.exp(-0.1 * t) * np.cos(2 * np.pi * t / 0.4))
            self.assertEqual(found.level, "good")
            self.assertIn("; still swinging in roll", found.text)
            self.assertNotIn("swing", settled(8.0 * np.exp(-6.0 * t) * np.cos(2 * np.pi * t / 1.3)).text)   # it has come to rest
            self.assertNotIn("swing", settled(8.0 * np.cos(2 * np.pi * t / 1.3), "[waves]\nmodel = 'airy'\nheight_m = 0.1\nperiod_s = 0.2\n").text)

    def test_joints_that_come_apart_are_told(self):
        t = 0.1 * np.arange(100)
        for apart, level in ((1e-14, "good"), (1e-4, "warn"), (1.0, "bad")):
            with self.subTest(apart), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "float.x_m": 0 * t, "joints.constraint_residual": apart + 0 * t}, log="")
                self.assertEqual({c.title: c.level for c in verdict.health(RunData(pathlib.Path(folder)))}["Joints"], level)

    def test_a_body_that_turns_with_a_rotor_answers_with_no_attitude(self):
        t = 0.1 * np.arange(100)
        table = {"time_s": t, "hub.x_m": 0 * t, "hub.pitch_deg": 5.0 * np.sin(t), "rotor.thrust_N": 1e6 + 0 * t}
        bearing = "[joints.bearing]\nbodies = ['earth', 'hub']\n"
        for rotor, said in (("[rotor]\njoint = 'bearing'\n", ["thrust"]), ("[rotor]\nbody = 'hub'\n", ["pitch of hub", "thrust"])):
            with self.subTest(rotor), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, scene="[bodies.hub]\nmass_kg = 1.0\n" + bearing + rotor, log="")
                self.assertEqual([words for words, _, _ in verdict.answers(RunData(pathlib.Path(folder)))], said)

    def test_a_force_in_the_plane_of_a_rotor_that_is_larger_than_the_thrust_is_told(self):
        t = 0.1 * np.arange(100)
        force = {"hub.x_m": 0 * t, "hub.rotor.fx_N": -12e3 + 0 * t, "hub.rotor.fy_N": 235e3 + 0 * t, "hub.rotor.fz_N": 0 * t}
        turned = {"hub.rotor.fx_N": 300e3 * np.cos(0.5) + 0 * t, "hub.rotor.fy_N": 300e3 * np.sin(0.5) + 0 * t}   # a thrust along a shaft that is yawed
        tower = "[aero.tower]\nstations = [[0.0, 6.0, 1.0]]\nhas_drag = {}\n"
        alone, both = [("thrust", "−12.00", "kN")], [("thrust", "−12.00", "kN"), ("force in the rotor's plane", "235.0", "kN")]
        for more, scene, said in ((force, "[rotor]\nbody = 'hub'\n", both), (force, "[rotor]\n", both), ({}, "[rotor]\nbody = 'hub'\n", alone),
                                  (force | turned | {"rotor.thrust_N": 300e3 + 0 * t}, "[rotor]\nbody = 'hub'\n", [("thrust", "300.0", "kN")]),
                                  (force, "[rotor]\nbody = 'hub'\n" + tower.format("true"), alone), (force, "[rotor]\nbody = 'hub'\n" + tower.format("false"), both)):
            with self.subTest(scene, columns=list(more)), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "rotor.thrust_N": -12e3 + 0 * t} | more, scene=scene, log="")
                self.assertEqual(verdict.answers(RunData(pathlib.Path(folder))), said)

    def test_tensions_of_all_lines_have_one_unit(self):
        t = 0.1 * np.arange(100)
        table = {"time_s": t, "float.x_m": np.sin(t), "line_1.tension_N": 1.05e6 + 0 * t, "line_2.tension_N": 8.7e5 + 0 * t, "leg.tension_N": 4e4 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            runs = [RunData(synthetic_run.write(folder / name, table=table, scene="", log="")) for name in "ab"]
            for shown in (page.key_figures(runs[0]), page.compared_figures(runs)):
                text = re.sub(r"<[^>]+>", " ", str(shown))
                self.assertEqual([re.search(rf"{name}\.tension_N +(\S+) +(\S+)", text).groups() for name in ("line_1", "line_2", "leg")],
                                 [("MN", "1.050"), ("MN", "0.8700"), ("MN", "0.04000")])

    def test_the_unit_of_a_figure_suits_its_swing(self):
        t = 0.1 * np.arange(401)
        with tempfile.TemporaryDirectory() as folder:
            table = {"time_s": t, "rotor.thrust_N": 1e5 + 0 * t, "rotor.power_W": -750.0 + 2e5 * np.sin(2 * np.pi * t / 10.0)}
            synthetic_run.write(pathlib.Path(folder), table=table, scene="", log="", ranges={"end": {"from_s": 20.0, "to_s": 40.0}})
            self.assertIn(("power", "−0.7 ± 141", "kW"), verdict.answers(RunData(pathlib.Path(folder))))

    def test_a_turbine_floats_where_water_or_lines_carry_it(self):
        t = 0.1 * np.arange(40)
        table = {"time_s": t, "hub.x_m": 0 * t, "tower.x_m": 0 * t, "rotor.thrust_N": 1e6 + 0 * t}
        bearing = "[joints.bearing]\ntype = 'revolute'\nbodies = ['{}', 'hub']\n[rotor]\njoint = 'bearing'\n"
        sea, flap = "[sea]\nmodel = 'morison'\n", "[joints.flap]\ntype = 'revolute'\nbodies = ['earth', 'tower']\n"
        for scene, floats in ((bearing.format("earth"), False), (bearing.format("earth") + sea, False), (bearing.format("tower"), False), (bearing.format("tower") + sea, True),
                              (bearing.format("tower") + sea + flap, True), (bearing.format("tower") + "[moorings.line]\nbody = 'tower'\n", True),
                              (bearing.format("tower") + sea + "[joints.foot]\ntype = 'fixed'\nbodies = ['earth', 'tower']\n", False)):
            with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, scene=scene, log="")
                self.assertTrue(verdict.what_ran(RunData(pathlib.Path(folder))).startswith("A floating turbine" if floats else "A turbine on its foundation"))

    def test_motions_of_a_turbine_that_stands_are_those_of_a_named_body_and_one_that_is_led_is_told_as_such(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t, "nacelle.x_m": 0.2 + 0.1 * np.sin(t), "rotor.thrust_N": 1e6 + 0 * t}
        led = "[joints.shaker]\ntype = 'prismatic'\nbodies = ['earth', 'nacelle']\n[joints.shaker.translation]\namplitude_m = 2.0\nperiod_s = 10.0\n"
        beam = "[beams.tower]\nbodies = ['earth', 'nacelle']\n"
        for scene, what, motion in ((beam, "A turbine on its foundation", "surge of nacelle"), (led, "A turbine in prescribed motion", "surge of nacelle"),
                                    ("[sea]\nmodel = 'morison'\n", "A floating turbine", "surge")):
            with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, scene=scene + "[rotor]\nbody = 'nacelle'\n", log="")
                run = RunData(pathlib.Path(folder))
                self.assertTrue(verdict.what_ran(run).startswith(what), verdict.what_ran(run))
                self.assertEqual(verdict.answers(run)[0][0], motion)

    def test_what_a_scene_lacks_stands_beside_the_verdict_and_what_else_it_notes_under_what_was_modelled(self):
        remarks = "[output]\ncaveats = ['SubDyn: what stands on it is < fixed']\nnotes = ['the seed is another']\n"
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), rows=200, scene=synthetic_run.SCENE + remarks)
            run = RunData(pathlib.Path(folder))
            text = str(page.build([run]))
            status = text.partition('<div class="status')[2].partition('<ul class="health">')[0]
            self.assertIn("Not modelled: SubDyn: what stands on it is &lt; fixed.", status)
            self.assertNotIn("the seed is another", status)
            for said in ("SubDyn: what stands on it is &lt; fixed", "the seed is another"):
                self.assertIn(said, page.model(run))

    def test_a_body_that_turns_with_a_rotor_has_no_key_figures(self):
        t = 0.1 * np.arange(400)
        spin = (60.0 * t + 180.0) % 360.0 - 180.0
        table = {"time_s": t, "hub.x_m": 0.1 * np.sin(t), "hub.roll_deg": spin, "tower.x_m": np.sin(t), "tower.roll_deg": np.sin(t), "rotor.thrust_N": 1e6 + 0 * t}
        for carrier, said in (("tower", ["tower.x_m", "tower.roll_deg", "rotor.thrust_N"]), ("earth", ["tower.x_m", "tower.roll_deg", "rotor.thrust_N"])):
            with tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, log="", scene=f"[joints.bearing]\ntype = 'revolute'\nbodies = ['{carrier}', 'hub']\n[rotor]\njoint = 'bearing'\n")
                shown = str(page.key_figures(RunData(pathlib.Path(folder)))).partition("<details>")[0]
                self.assertEqual(re.findall(r'<small class="code">([^<]*)</small>', shown), said)

    def test_of_several_bodies_each_is_named_and_judged(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t} | {f"{body}.x_m": 0 * t for body in ("heavy", "neutral", "light")}
        table |= {"heavy.z_m": -0.4 + 0 * t, "neutral.z_m": 0.002 * t, "light.z_m": 0.45 + 0 * t, "light.pitch_deg": -0.1 * t}
        box = "[bodies.{0}]\nmass_kg = 1.0\n[[bodies.{0}.boxes]]\nsize_m = [0.3, 1.0, 0.2]\ncentre_m = [0.0, 0.0, 0.0]\n"
        scene = "[sea]\nmodel = 'sph'\n" + "".join(box.format(name) for name in ("heavy", "neutral", "light"))
        with tempfile.TemporaryDirectory() as folder:
            def made(more="", **columns):
                synthetic_run.write(pathlib.Path(folder), table=table | columns, scene=scene + more, log="", ranges={"end": {"from_s": 20.0, "to_s": 40.0}})
                run = RunData(pathlib.Path(folder))
                return run, [text for text, _, _ in verdict.answers(run)], {c.title: c for c in verdict.health(run)}["Settled"]

            run, said, settled = made()
            self.assertEqual(said, ["heave of heavy", "heave of neutral", "heave of light", "pitch of light"])
            self.assertEqual(settled.level, "warn")
            self.assertIn("heave of neutral by 0.020 m, pitch of light by −1.0 deg changed", settled.text)
            self.assertEqual(made(**{"neutral.z_m": 0.1 + 0 * t, "light.pitch_deg": 0 * t})[2].level, "good")
            self.assertIn("light.z_m", quantities.key_columns(run.columns))
            # What stands for others: of bodies fixed to each other the first, of bodies that a driver moves none.
            _, said, settled = made("[joints.weld]\ntype = 'fixed'\nbodies = ['heavy', 'neutral']\n")
            self.assertEqual(said, ["heave of heavy", "heave of light", "pitch of light"])
            self.assertNotIn("neutral", settled.text)
            _, _, settled = made("[joints.arm]\nbodies = ['earth', 'light']\n[joints.arm.rotation]\nspeed_rad_s = 1.0\n")
            self.assertIn("heave of neutral by 0.020 m changed", settled.text)
            # Where a rotor is carried its carrier stands in the headline; the others are judged.
            turbine = "[rotor]\njoint = 'bearing'\n[joints.bearing]\nbodies = ['heavy', 'light']\n"
            _, said, settled = made(turbine, **{"rotor.thrust_N": 1e6 + 0 * t})
            self.assertEqual(said, ["heave of heavy", "thrust"])
            self.assertIn("heave of neutral by 0.020 m changed", settled.text)
            _, said, settled = made(turbine + "[joints.hinge]\nbodies = ['heavy', 'neutral']\n", **{"rotor.thrust_N": 1e6 + 0 * t})
            self.assertEqual((said, settled.level), (["heave", "thrust"], "good"))

    def test_a_body_that_contact_carries_on_the_bed_is_told(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t, "stone.x_m": 0 * t, "stone.z_m": -0.4 * (t > 10.0), "stone.sea.fz_N": 0 * t, "stone.contact.fz_N": 1100.0 * (t > 10.0)}
        scene = ("[environment]\nwater_depth_m = {}\n[sea]\nmodel = 'sph'\n[sea.particles]\nspacing_m = 0.02\n[sea.tank]\nbed_m = {}\n[bodies.stone]\nmass_kg = 120.0\n"
                 "[[bodies.stone.boxes]]\nsize_m = [0.3, 1.0, 0.2]\ncentre_m = [0.0, 0.0, -0.5]\n")
        for depth, bed, force, lies in ((1.0, [], 1.0, True), (1.0, [], 0.0, False), (2.0, [], 1.0, False), (2.0, [[-1.0, -1.5], [1.0, -0.5]], 1.0, True)):
            with self.subTest(depth=depth, bed=bed, force=force), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table | {"stone.contact.fz_N": force * table["stone.contact.fz_N"]}, scene=scene.format(depth, bed), log="")
                found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}.get("Bed")
                self.assertEqual(found is not None, lies)
                if lies:
                    self.assertEqual((found.level, found.text[:48]), ("warn", "stone lies on the bed, first at t = 10.10 s: con"))
                    self.assertIn("its water load holds no buoyancy", found.text)

    def test_halves_of_a_random_motion_differ_by_chance(self):
        t = 0.1 * np.arange(6001)
        table = {"time_s": t, "float.x_m": 2.0 * np.sin(2 * np.pi * t / 11.0) + 0.1 * np.sign(t - 350.0)}
        for scene, level in (("", "warn"), ("[waves]\nmodel = 'jonswap'\nheight_m = 6.0\nperiod_s = 10.0\n", "good"), ("[wind]\nspeed_m_s = 9.0\n[wind.turbulence]\nseed = 1\n", "good")):
            with self.subTest(scene), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, scene=scene + "[bodies.float]\nmass_kg = 1.0\n", log="", ranges={"end": {"from_s": 100.0, "to_s": 600.0}})
                self.assertEqual({c.title: c.level for c in verdict.health(RunData(pathlib.Path(folder)))}["Settled"], level)

    def test_a_figure_that_swings_is_told_with_its_standard_deviation(self):
        t = 0.1 * np.arange(401)
        table = {"time_s": t, "float.x_m": 0.2 + 0 * t, "float.z_m": np.sin(2 * np.pi * t / 10.0), "rotor.thrust_N": 1.2e6 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, scene="[sea]\nmodel = 'hydrostatic'\n[bodies.float]\nmass_kg = 1.0\n", log="", ranges={"end": {"from_s": 20.0, "to_s": 40.0}})
            said = {text: value for text, value, _ in verdict.answers(RunData(pathlib.Path(folder)))}
            self.assertTrue(said["heave"].endswith(" ± 0.71"), said)
            self.assertEqual(said["surge"], "0.2000")
            self.assertEqual(said["thrust"], "1.200")

    def test_power_is_held_against_the_table_that_the_turbine_file_names(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t, "float.x_m": 0 * t, "rotor.thrust_N": 1e6 + 0 * t, "rotor.power_W": 4e6 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "turbines").mkdir()
            (folder / "turbines/own.toml").write_text('[turbine]\nblades = 3\noperation = "own.csv"\n')
            (folder / "turbines/own.csv").write_text("# mine\nwind_m_s,speed_rpm,power_W\n8,6,2e6\n12,9,8e6\n")
            synthetic_run.write(folder / "run", table=table, log="", scene="[wind]\nspeed_m_s = 10.0\n[rotor]\nturbine = '../turbines/own.toml'\noperation = ''\n"
                                "[bodies.float]\nmass_kg = 1.0\n")
            found = {c.title: c for c in verdict.health(RunData(folder / "run"))}["Power"]
            self.assertEqual(found.level, "warn")
            self.assertIn("the turbine's table has 5.00 MW at 10 m/s, rated 8.00 MW", found.text)
            (folder / "turbines/own.toml").rename(folder / "turbines/base.toml")
            (folder / "mine.toml").write_text('base = "turbines/base.toml"\n[turbine]\nblades = 2\nplanform = "mine.csv"\n', encoding="utf-8-sig")
            (folder / "turbines/own.toml").write_text('base = "../mine.toml"\nwithout = "turbine.planform"\n')
            run = RunData(folder / "run")
            self.assertEqual(run.turbine(), {"blades": 2, "operation": str(folder / "run/../turbines/../turbines/own.csv")})
            self.assertEqual(run.blades(), 2)
            self.assertEqual({c.title: c for c in verdict.health(run)}["Power"].text, found.text)

            def power(more, wind=10.0):
                hub = {"rotor.wind_x_m_s": np.where(t < 20.0, 10.0, wind * 0.8), "rotor.wind_y_m_s": np.where(t < 20.0, 0.0, wind * 0.6)}
                synthetic_run.write(folder / "run", table=table | hub, log="", ranges={"end": {"from_s": 25.0, "to_s": 40.0}},
                                    scene="[wind]\nspeed_m_s = 10.0\n" + more + "[rotor]\nturbine = '../turbines/own.toml'\noperation = ''\n[bodies.float]\nmass_kg = 1.0\n")
                return {c.title: c.text for c in verdict.health(RunData(folder / "run"))}.get("Power")

            self.assertIn("has 5.00 MW at 10 m/s", power("", 9.0))
            self.assertIn("has 3.50 MW at 9 m/s", power("[wind.event]\nwhat = 'step'\nstart_s = 20.0\n", 9.0))
            events = "[control]\nevents = [{ what = '%s', time_s = 10.0, rotor = '' }]\n"
            self.assertIsNone(power(events % "grid_loss"))
            self.assertIsNone(power("[control]\nstart = 'parked'\n"))
            self.assertIsNotNone(power(events % "start_up"))

    def test_what_happens_to_a_turbine_is_told_by_its_greatest_loads(self):
        t = 0.1 * np.arange(1001)
        passing = np.where(t > 70.0, np.exp(-(t - 70.0) / 8.0), 1.0)
        table = {"time_s": t, "float.x_m": 0 * t, "rotor.thrust_N": 1e6 * passing, "rotor.rpm": 9.0 * passing, "rotor.blade_1.root_flap_N_m": -2e7 * passing,
                 "tower.start_mx_N_m": 3e7 * passing, "tower.start_my_N_m": 4e7 * passing, "tower.end_mx_N_m": 1e6 * passing, "tower.end_my_N_m": 0 * t}
        scene = "[wind]\nspeed_m_s = 11.0\n[bodies.float]\nmass_kg = 1.0\n[control]\nevents = [%s]\n"
        with tempfile.TemporaryDirectory() as folder:
            def told(*events, from_s=60.0):
                listed = ", ".join(f"{{ what = '{what}', time_s = {when} }}" for what, when in events)
                synthetic_run.write(pathlib.Path(folder), table=table, scene=scene % listed, log="", ranges={"end": {"from_s": from_s, "to_s": 100.0}})
                run = RunData(pathlib.Path(folder))
                return verdict.what_ran(run), {text: f"{value} {unit}" for text, value, unit in verdict.answers(run)}, {c.title: c for c in verdict.health(run)}["Settled"]

            ran, said, settled = told(("emergency_stop", 70.0))
            self.assertIn("wind of 11 m/s, an emergency stop at 70.00 s: 100 s", ran)
            self.assertEqual((settled.level, settled.text), ("good", "what the run shows is an emergency stop at 70.00 s: its least and greatest values count, no mean does"))
            self.assertEqual({text: said[text] for text in said if text.endswith("greatest")},
                             {"thrust, greatest": "1.000 MN", "rotor speed, greatest": "9.000 rpm", "bending moment of tower, greatest": "50.00 MN m",
                              "flapwise moment at a root, greatest": "20.00 MN m"})
            # A stop that has passed leaves a turbine that stands; a start, or a blade that sticks, one that has to settle.
            self.assertEqual(told(("grid_loss", 40.0), from_s=75.0)[2].level, "good")
            self.assertEqual(told(("blade_stuck", 40.0), from_s=75.0)[2].level, "warn")
            self.assertEqual(told(("blade_stuck", 80.0), from_s=75.0)[2].level, "good")
            _, said, settled = told(("grid_loss", 100.0))
            self.assertEqual((settled.level, [text for text in said if text.endswith("greatest")]), ("warn", []))

    def test_a_rotor_that_drives_the_air_is_named(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t, "float.x_m": 0 * t, "rotor.thrust_N": 1e4 + 0 * t, "rotor.power_W": -6e5 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, scene="[wind]\nspeed_m_s = 0.0\n[bodies.float]\nmass_kg = 1.0\n", log="")
            found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Power"]
            self.assertEqual(found.level, "warn")
            self.assertIn("mean −0.600 MW: the rotor drives the air", found.text)

    def test_the_title_says_what_the_command_line_changed(self):
        t = 0.1 * np.arange(20)
        for given, title in (([], "A spar"), (["output.means_over_s=3", "time.end_s=4"], "A spar"), (["waves.period_s=30"], "A spar, with waves.period_s = 30"),
                             (['without=["wind.event"]', "wind.turbulence.seed=1"], "A spar, without wind.event, with wind.turbulence.seed = 1"),
                             (["output.title=Mine", "waves.period_s=30"], "A spar"), ([f"bodies.spar.mass_kg={n}" for n in range(9)], "A spar, with 9 keys changed"),
                             (["moorings.line.anchor_m=[" + "1.0, " * 30 + "]"], "A spar, with moorings.line.anchor_m changed")):
            with self.subTest(given), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "a.x_m": t}, scene="", log="", title="A spar", set=given)
                self.assertEqual(RunData(pathlib.Path(folder)).title, title)

    def test_wind_that_changes_is_named_and_stands_over_the_thrust(self):
        t = 0.1 * np.arange(400)
        scene = "[bodies.float]\nmass_kg = 1.0\n[wind]\nspeed_m_s = 14.0\n[wind.event]\nwhat = 'eog'\nstart_s = 20.0\n"
        table = {"time_s": t, "float.x_m": 0 * t, "rotor.thrust_N": 1e6 + np.sin(t), "rotor.wind_x_m_s": 14.0 + np.cos(t), "rotor.wind_y_m_s": 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, scene=scene, log="")
            run = RunData(pathlib.Path(folder))
            self.assertIn("wind of 14 m/s with an extreme operating gust at 20 s", verdict.what_ran(run))
            text = page.time_figures([run])["rotor"]
            self.assertLess(text.index("wind x [m/s]"), text.index("thrust [MN]"))
            self.assertIn("Zero throughout: wind y.", text)

    def test_blades_are_named_with_what_takes_the_place_of_momentum_theory(self):
        t = 0.1 * np.arange(40)
        for inflow, words in (("none", "with blade element momentum"), ("oye", "with blade element momentum"),
                              ("free_vortex", "with blade elements and a wake of vortex filaments")):
            scene = f"[bodies.float]\nmass_kg = 1.0\n[aero]\nmodel = 'bem'\ndynamic_inflow = '{inflow}'\n"
            with self.subTest(inflow), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table={"time_s": t, "float.x_m": 0 * t, "rotor.thrust_N": 1e6 + 0 * t}, scene=scene, log="")
                self.assertIn(words, verdict.what_ran(RunData(pathlib.Path(folder))))

    def test_a_motion_that_nothing_drives_is_none(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t, "float.x_m": 3e-7 * np.sin(t), "float.z_m": 2.0 * np.cos(t), "float.pitch_deg": 1e-9 * t,
                 "float.sea.fx_N": 0.01 * np.sin(t), "float.sea.fz_N": 8e7 + t, "float.sea.my_N_m": 0.1 * np.sin(t)}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, scene="[bodies.float]\nmass_kg = 1.0\n", log="")
            run = RunData(pathlib.Path(folder))
            self.assertEqual([n for n in table if figures.is_nothing(run, n)], ["float.x_m", "float.pitch_deg", "float.sea.fx_N", "float.sea.my_N_m"])

    def test_energy_that_steps_make_is_held_against_what_moves_not_against_weight_and_buoyancy(self):
        t = np.linspace(0.0, 20.0, 201)
        swing, left = np.sin(t) ** 2, 1.0 - 0.3 * t / 20.0   # a free heave that loses 30 % of its energy to the steps
        heave = {"time_s": t, "energy.kinetic_J": 1e6 * left * swing, "energy.steps_J": 1e6 * (left - 1.0), "energy.gravity.work_J": 4e7 * np.cos(t),
                 "energy.sea.work_J": 1e6 * (swing * left - left + 1.0) - 4e7 * np.cos(t)}
        zero = 0.0 * t
        tumbling = {"time_s": t, "energy.kinetic_J": 4.0 + zero, "energy.steps_J": 4e-7 + zero, "energy.gravity.work_J": zero}
        resting = {"time_s": t, "energy.kinetic_J": 1e-20 + zero, "energy.steps_J": -1e-9 + zero, "energy.gravity.work_J": 1e4 * t, "energy.sea.work_J": -1e4 * t}
        for table, level, text in ((heave, "warn", "try a smaller"), (heave | {"energy.steps_J": 1e-3 * heave["energy.steps_J"]}, "good", "0.03"),
                                   (tumbling, "good", "% of the largest kinetic energy"), (resting, "good", "round-off")):
            with self.subTest(text), tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(pathlib.Path(folder), table=table, scene="", log="")
                found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Energy"]
                self.assertEqual(found.level, level, found.text)
                self.assertIn(text, found.text)
                self.assertNotIn("an hour", found.text)   # of seconds
                synthetic_run.write(pathlib.Path(folder), table=table | {"time_s": 90.0 * t}, scene="", log="")
                self.assertIn("J an hour", {c.title: c for c in verdict.health(RunData(pathlib.Path(folder)))}["Energy"].text)

    def test_what_was_modelled_leaves_out_what_the_scene_has_not(self):
        scene = "[time]\nend_s = 600.0\nintegrator = 'rk4'\n[environment]\nwater_depth_m = 100.0\n[sea]\nmodel = 'none'\n[waves]\nmodel = 'none'\n[aero]\nmodel = 'blade_resolved'\n{}"
        for more, said, left_out in (("[aero.flow]\ntime = 'steady'\n", "to 600 pseudo-steps", ("Water", "none", "rk4", "600 s")), ("[bodies.a]\nmass_kg = 1.0\n", "to 600 s; rk4", ("Water", "none"))):
            with self.subTest(more), tempfile.TemporaryDirectory() as folder:
                t = np.arange(10.0)
                table = {"time_s": t, "flow.lift_coefficient": 1.0 + t} if "steady" in more else {"time_s": t, "a.z_m": t}
                synthetic_run.write(pathlib.Path(folder), table=table, scene=scene.format(more), log="")
                found = page.model(RunData(pathlib.Path(folder)))
                self.assertIn(said, found)
                for words in left_out:
                    self.assertNotIn(words, found)

    def test_sensors_are_among_the_key_figures_and_have_a_figure(self):
        t = 0.1 * np.arange(100)
        table = {"time_s": t, "wall.mean_pressure_Pa": 5e3 * np.sin(t) ** 2, "wall.fx_N": 2e3 * np.sin(t) ** 2, "wall.fy_N": 0 * t, "wall.fz_N": 0 * t, "sea.x_max_m": 1.0 + t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, scene="[sea]\nmodel = 'sph'\n", log="")
            run = RunData(pathlib.Path(folder))
            shown = str(page.key_figures(run)).partition("<details>")[0]
            self.assertIn("wall.mean_pressure_Pa", shown)
            self.assertRegex(shown, r"wall\.fx_N.*2\.000</td>")
            self.assertNotIn("wall.fy_N", shown)
            self.assertIn("wall: sensor", [group.title for group in quantities.groups(run.columns) if not group.fold])

    def test_health_closes_the_balance_of_the_water(self):
        t = np.linspace(0.0, 10.0, 101)
        zero = 0.0 * t
        table = {"time_s": t, "sea.mass_kg": 1e3 + zero, "sea.kinetic_energy_J": 5.0 * t, "sea.potential_energy_J": 100.0 + t, "sea.compression_energy_J": zero,
                 "sea.work_of_solids_J": 10.0 * t, "sea.dissipated_J": 3.0 * t, "sea.absorbed_J": t}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder) / "closed", table=table, scene="", log="")
            found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder) / "closed"))}["Water"]
            self.assertEqual(found.level, "good")
            self.assertIn("work of bodies and paddle 100 J, dissipated 30.0, absorbed in zones 10.0; unexplained 0", found.text)
            table["sea.dissipated_J"] = zero
            synthetic_run.write(pathlib.Path(folder) / "open", table=table, scene="", log="")
            found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder) / "open"))}["Water"]
            self.assertEqual(found.level, "warn")
            self.assertIn("unexplained −30", found.text)
            self.assertNotIn("an hour", found.text)   # of seconds
            synthetic_run.write(pathlib.Path(folder) / "long", table=table | {"time_s": 72.0 * t}, scene="", log="")
            self.assertIn("−150 J an hour", {c.title: c for c in verdict.health(RunData(pathlib.Path(folder) / "long"))}["Water"].text)
            table["sea.left_J"] = 3.0 * t
            synthetic_run.write(pathlib.Path(folder) / "left", table=table, scene="", log="")
            found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder) / "left"))}["Water"]
            self.assertEqual(found.level, "good")
            self.assertIn("taken along by water that left 30.0", found.text)
            gains = {"sea.kinetic_energy_J": 15.0 * t, "sea.dissipated_J": -6.0 * t, "sea.left_J": zero, "sea.absorbed_J": zero, "sea.mass_kg": 1e3 - t}
            synthetic_run.write(pathlib.Path(folder) / "gains", table=table | gains, scene="", log="")
            found = {c.title: c for c in verdict.health(RunData(pathlib.Path(folder) / "gains"))}["Water"]
            self.assertEqual(found.level, "warn")
            self.assertIn("unexplained 0", found.text)
            self.assertIn("forces at walls make energy; 1.0 % of the water left the tank", found.text)

    def test_health_closes_the_balance_of_the_mass_of_the_air(self):
        t = np.linspace(0.0, 10.0, 101)
        table = {"time_s": t, "air.mass_inflow_kg_s": 200.0 + t, "air.mass_outflow_kg_s": 195.0 + t, "air.mass_growth_kg_s": 5.5 + 0 * t, "air.mass_residual_kg_s": 0.5 + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            def told(**changed):
                synthetic_run.write(pathlib.Path(folder) / "run", table=table | changed, scene="", log="")
                return {c.title: c for c in verdict.health(RunData(pathlib.Path(folder) / "run"))}["Air mass"]
            found = told()
            self.assertEqual(found.level, "good")
            self.assertIn("210 kg/s flow through the grid; the pseudo-steps leave at most 0.24 % of it", found.text)
            self.assertEqual(told(**{"air.mass_growth_kg_s": 10.0 + 0 * t, "air.mass_residual_kg_s": 5.0 + 0 * t}).level, "warn")
            found = told(**{"air.mass_growth_kg_s": 6.5 + 0 * t})
            self.assertEqual(found.level, "bad")
            self.assertIn("does not close", found.text)

    def test_health_tells_of_floats_that_turn_over_go_under_or_pass_through_the_bed(self):
        t = 0.1 * np.arange(400)
        table = {"time_s": t, **{f"float.{c}": 0 * t for c in ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")}, "rotor.thrust_N": 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder) / "run"
            synthetic_run.write(folder, table=table)
            run = RunData(folder)
            cylinder = {"start_m": [0, 0, -14.0], "end_m": [0, 0, 12.0], "diameter_m": 8.0}
            run.scene = {"sea": {"model": "morison"}, "environment": {"water_depth_m": 20.0}, "bodies": {"float": {"cylinders": [cylinder]}}}

            def titles(**columns):
                for name, values in columns.items():
                    run.values[run.columns.index(f"float.{name}")] = values
                found = {c.title: c for c in verdict.health(run) if c.title in ("Upright", "Afloat", "Bed")}
                for name in columns:
                    run.values[run.columns.index(f"float.{name}")] = 0.0
                return {title: (c.level, c.text) for title, c in found.items()}

            self.assertEqual(titles(), {})
            self.assertEqual(titles(z_m=-5.7 + 0 * t, pitch_deg=3.0 + 0 * t), {})
            level, text = titles(z_m=-8.0 * (t > 20.0))["Bed"]
            self.assertEqual(level, "bad")
            self.assertIn("float reaches 2.00 m under the bed, first at t = 20.1", text)
            run.scene["sea"]["model"] = "sph"
            self.assertIn("float lies on the bed, first at t = 20.1", titles(z_m=-8.0 * (t > 20.0))["Bed"][1])
            run.scene["sea"]["model"] = "morison"
            run.scene["environment"]["water_depth_m"] = 300.0
            self.assertEqual(titles(roll_deg=4.5 * t)["Upright"][0], "bad")
            self.assertIn("after t = 20", titles(z_m=-20.0 * (t > 20.05))["Afloat"][1])
            gone = run.columns.index("rotor.thrust_N")   # a body that is dropped may sink
            del run.columns[gone]
            run.values = np.delete(run.values, gone, axis=0)
            self.assertEqual(titles(z_m=-20.0 * (t > 20.0)), {})

    def test_a_scene_that_takes_all_pseudo_steps_is_judged_by_what_they_reach(self):
        t = np.linspace(0, 10, 101)
        for reached, level in ((0.012, "good"), (0.4, "warn")):
            with tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(folder, table={"time_s": t, "air.residual_drop": reached + 0 * t}, scene="[aero.flow]\ndrop = 0.0\n", log="")
                found = {c.title: c for c in verdict.health(RunData(folder))}["Air"]
                self.assertEqual(found.level, level)
                self.assertIn(f"{reached}", found.text)

    def test_windows_are_judged_by_what_their_drop_counts_and_not_by_the_row_of_the_start(self):
        t = np.linspace(0, 1, 11)
        table = {"time_s": t, "air.pseudo_steps": np.where(t > 0, 7.0, -1.0), "air.residual_drop": np.where(t > 0, 0.01, 1e-6), "air.balance_drop": np.where(t > 0, 1e-4, 1.0)}
        for counted, level in (("balance", "good"), ("density", "warn")):
            with tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(folder, table=table, scene=f"[aero.flow]\ndrop = 1e-3\ndrop_of = \"{counted}\"\n", log="")
                found = {c.title: c for c in verdict.health(RunData(folder))}["Air"]
                self.assertEqual(found.level, level)
                self.assertIn(counted, found.text)
                self.assertIn("100 %" if level == "good" else " 0 %", found.text)

    def test_a_section_of_one_figure_takes_half_of_the_page_unless_it_is_wide(self):
        one = "<figure>a</figure>"
        self.assertTrue(html_page.section("k", "t", one + "<details>" + one + "</details>")["half"])
        self.assertFalse(html_page.section("k", "t", one + one)["half"])
        self.assertFalse(html_page.section("k", "t", one.replace("<figure", '<figure class="wide"'))["half"])

    def test_a_borrowed_bar_is_dotted_and_names_its_lender_and_the_reference_stands_at_its_cost(self):
        def rung(name, cost, error, high, lender=None):
            e = {"error": error, "signed": error, "low": 0.0, "high": high, "replicas": 1, "scatter_of": lender, "value": None}
            return {"name": name, "cost": {"core_s": cost, "low": cost, "high": cost}, "on_front": True, "is_reference": error == 0.0, "errors": {"surge": e}}
        metric = {"name": "surge", "column": "a.x_m", "measure": "rms", "relative": False, "divide_by": 1.0, "target": 0.1}
        study = {"answer": "rich", "confidence": 0.95, "replicas": 4, "metrics": [metric],
                 "rungs": [rung("rich", 1.0, 0.2, 0.3), rung("dear", 1e3, 0.02, 0.12, "rich"), rung("fine", 1e5, 0.0, 0.1, "rich")]}
        figure, axis = figures.plt.subplots()
        self.assertTrue(study_page.draw(study, metric, axis))
        bars = {line.get_xdata()[0]: line for line in axis.lines if len(line.get_xdata()) == 2 and len(set(line.get_xdata())) == 1 and line.get_ydata()[0] < line.get_ydata()[1]}
        self.assertEqual({cost: bar.get_linestyle() for cost, bar in bars.items()}, {1.0: "-", 1e3: ":", 1e5: ":"})
        self.assertEqual([max(bars[cost].get_ydata()) for cost in (1e3, 1e5)], [0.12, 0.1])
        self.assertEqual([text.get_text() for text in axis.get_legend().get_texts()], ["95 % interval, own scatter", "scatter of rich"])
        self.assertIn("fine: reference, 0", [text.get_text() for text in axis.texts])
        figures.plt.close(figure)
        self.assertIn("scatter of rich", study_page._error_text(study["rungs"][1]["errors"]["surge"], metric))

    def test_in_a_crowd_the_answer_and_the_reference_have_their_names(self):
        def rung(name, cost, error, front):
            e = {"error": error, "signed": error, "low": error, "high": error, "replicas": 1, "scatter_of": None, "value": None}
            return {"name": name, "cost": {"core_s": cost, "low": cost, "high": cost}, "on_front": front, "is_reference": error == 0.0, "errors": {"surge": e}}
        metric = {"name": "surge", "column": "a.x_m", "measure": "rms", "relative": False, "divide_by": 1.0, "target": 0.1}
        crowd = [rung(f"symplectic-step_0.{n}", 1.02 + 0.07 * n, 0.09 - 0.008 * n, n > 4) for n in range(9)]
        study = {"answer": "answer-step_0.5", "confidence": 0.95, "replicas": 0, "metrics": [metric],
                 "rungs": [rung("answer-step_0.5", 1.0, 0.05, True), *crowd, rung("fine", 30.0, 0.0, True)]}
        figure, axis = figures.plt.subplots(figsize=(5.4, 3.8))
        self.assertTrue(study_page.draw(study, metric, axis))
        self.assertLessEqual({"answer-step_0.5", "fine: reference, 0"}, {text.get_text() for text in axis.texts})
        figures.plt.close(figure)

    def test_a_study_without_reference_draws_what_each_rung_found(self):
        metric = {"name": "surge", "column": "a.x_m", "measure": "mean"}
        study = {"rungs": [{"name": name, "errors": {"surge": {"value": value}}} for name, value in (("a", 1.0), ("b", None), ("c", 3.0))]}
        figure, axis = figures.plt.subplots()
        self.assertTrue(study_page.draw_values(study, metric, axis))
        self.assertEqual([list(axis.lines[0].get_xdata()), [text.get_text() for text in axis.get_yticklabels()]], [[1.0, 3.0], ["a", "c"]])
        self.assertFalse(study_page.draw_values({"rungs": study["rungs"][:2]}, metric, axis))
        figures.plt.close(figure)

    def test_names_of_a_crowd_of_rungs_do_not_lie_on_each_other(self):
        figure, axis = figures.plt.subplots(figsize=(6.4, 3.9))
        axis.set_xscale("log"), axis.set_yscale("log"), axis.set_xlim(0.4, 4.0), axis.set_ylim(1e-3, 1.0)
        labels = [(0.5 * 1.09 ** n, 0.2 * 0.8 ** (n * n % 7), f"window_{n}") for n in range(20)]
        study_page._name(axis, labels)
        figure.canvas.draw()
        boxes = [text.get_window_extent() for text in axis.texts]
        self.assertGreater(len(boxes), 6)
        at = axis.transData.transform([label[:2] for label in labels])
        for text, box in zip(axis.texts, boxes):   # nearest to the point it names
            nearest = min(range(len(at)), key=lambda n: study_page._apart((box.x0, box.y0, box.x1, box.y1), *at[n]))
            self.assertEqual(labels[nearest][2], text.get_text())
        for n, a in enumerate(boxes):
            for b in boxes[n + 1:]:
                self.assertFalse(min(a.x1, b.x1) - max(a.x0, b.x0) > 1.0 and min(a.y1, b.y1) - max(a.y0, b.y0) > 1.0)
        figures.plt.close(figure)

    def test_an_angle_that_begins_anew_leaves_no_line_across_the_figure(self):
        t = np.linspace(0.0, 20.0, 401)
        for name in ("a.roll_deg", "rotor.azimuth_deg"):
            with tempfile.TemporaryDirectory() as folder:
                synthetic_run.write(folder, table={"time_s": t, name: (52.8 * t + 180.0) % 360.0 - 180.0}, scene="", log="")
                drawing = figures.series([RunData(folder)], next(g for g in quantities.groups([name]) if g.panels))
                line = drawing.figure.axes[0].lines[0]
                self.assertEqual(np.isnan(line.get_ydata()).sum(), 3)

    def test_a_spectrum_has_its_peak_at_the_frequency_and_the_variance_as_area(self):
        t = 0.05 * np.arange(6000)
        frequency, power = figures.density(t, 3.0 + 2.0 * np.sin(2 * np.pi * 0.31 * t))
        self.assertAlmostEqual(frequency[power.argmax()], 0.31, delta=0.01)
        self.assertAlmostEqual(power.sum() * frequency[0], 2.0, delta=0.02)
        self.assertAlmostEqual(frequency[0], 1.0 / 150.0)   # segments of half the length
        self.assertIsNone(figures.density(t[:50], t[:50]))

    def test_of_several_rotors_each_has_its_loads_its_answer_and_its_table(self):
        t = np.linspace(0.0, 60.0, 601)
        table = {"time_s": t, "float.x_m": 0 * t, "float.rotor.a.fx_N": 1e6 + 0 * t, "float.rotor.b.fx_N": 2e6 + 0 * t, "float.sea.fx_N": 0 * t}
        for name, size in (("a", 1.0), ("b", 2.0)):
            table |= {f"rotor.{name}.thrust_N": size * 1e6 + 0 * t, f"rotor.{name}.power_W": size * 4e6 + 0 * t, f"rotor.{name}.rpm": 8.0 * size + 0 * t,
                      f"rotor.{name}.blade_1.pitch_deg": size + 0 * t}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "table.csv").write_text("wind_m_s, speed_rpm, power_W\n5, 6, 2e6\n15, 9, 6e6\n")
            synthetic_run.write(folder / "run", table=table, log="", scene="[wind]\nspeed_m_s = 10.0\n[aero]\nmodel = 'bem'\n[rotors.a]\noperation = '../table.csv'\n"
                                "[rotors.b]\noperation = '../table.csv'\n")
            run = RunData(folder / "run")
            self.assertEqual(quantities.rotors_of(run.columns), ["rotor.a", "rotor.b"])
            self.assertEqual(verdict.kind(run), "floating turbine")
            found = {group.title: group for group in quantities.groups(run.columns)}
            self.assertEqual([line for line, _ in dict(found["float: forces by source"].panels)["fx"]], ["rotor.a", "rotor.b", "sea"])
            self.assertIn("rotor.b: loads and speed", found)
            self.assertEqual(page.marks(run), {"1P": 8.0 / 60.0, "3P": 0.4, "1P of b": 16.0 / 60.0, "3P of b": 0.8})
            with (folder / "run" / "scene.toml").open("a") as scene:   # the last of it is [rotors.b]
                scene.write("turbine = '../two.toml'\n")
            (folder / "two.toml").write_text("[turbine]\nblades = 2\n")
            two = page.marks(RunData(folder / "run"))
            self.assertEqual(two, {"1P": 8.0 / 60.0, "3P": 0.4, "1P of b": 16.0 / 60.0, "2P of b": 2 * 16.0 / 60.0})
            power = verdict._power(run)
            self.assertEqual(power.level, "warn")
            self.assertTrue(power.text.startswith("rotor b: mean 8.00 MW"), power.text)
            self.assertIn("rotor a: mean 4.00 MW", power.text)
            self.assertIn("thrust of b", [name for name, *_ in verdict.answers(run)])

    def test_pitch_of_the_blades_belongs_to_the_rotor_and_not_to_bodies(self):
        names = ["turbine.x_m", "rotor.thrust_N", "rotor.asked_pitch_deg", *(f"rotor.blade_{b}.pitch_deg" for b in (1, 2, 3))]
        self.assertEqual(quantities.bodies_of(names), ["turbine"])
        control = next(g for g in quantities.groups(names) if g.title == "rotor: control")
        self.assertEqual([legend for legend, _ in control.panels[0][1]], ["blade 1", "blade 2", "blade 3", "asked"])

    def test_the_rotors_frequencies_are_those_of_the_stretch_of_the_means(self):
        t = 0.1 * np.arange(6001)
        table = {"time_s": t, "rotor.thrust_N": 1e5 + 0 * t, "rotor.rpm": np.where(t < 300.0, 0.0, 12.0)}
        with tempfile.TemporaryDirectory() as folder:
            synthetic_run.write(pathlib.Path(folder), table=table, log="", ranges={"end": {"from_s": 400.0, "to_s": 600.0}})
            self.assertAlmostEqual(page.marks(RunData(pathlib.Path(folder)))["1P"], 0.2, places=9)

    def test_a_spectrum_takes_every_segment(self):
        t = 0.05 * np.arange(6000)
        for begin, share in ((0, 1 / 6), (1500, 1 / 3)):   # half of one segment of three, or of two
            burst = np.where((t >= 0.05 * begin) & (t < 0.05 * (begin + 1500)), 2.0 * np.sin(2 * np.pi * 0.4 * t), 0.0)
            frequency, power = figures.density(t, burst)
            self.assertAlmostEqual(power.sum() * frequency[0] / 2.0, share, delta=0.01)

    def test_gradients_of_linear_fields_are_exact_on_skewed_blocks(self):
        k, j, i = np.meshgrid(np.arange(5.0), np.arange(6.0), np.arange(7.0), indexing="ij")
        points = np.stack([i + 0.3 * j, 1.2 * j - 0.2 * k, 0.7 * k + 0.1 * i], axis=-1)
        centres = 0.125 * sum(points[a:4 + a, b:5 + b, c:6 + c] for a in (0, 1) for b in (0, 1) for c in (0, 1))
        slopes = np.array([[1.0, -2.0, 0.5], [0.3, 4.0, -1.0]])
        found = cut.gradient(points, centres @ slopes.T)
        np.testing.assert_allclose(found, np.broadcast_to(slopes, found.shape), atol=1e-12)

    def test_a_surface_through_a_block_has_the_area_of_its_sphere_and_carries_values(self):
        error = []
        for n in (10, 20):
            line = np.linspace(-1.0, 1.0, n + 1)
            z, y, x = np.meshgrid(line, line, line, indexing="ij")
            points = np.stack([x, y, z], axis=-1)
            triangles, values = cut.surface(points, np.linalg.norm(points, axis=-1), 0.7, 3.0 * x)
            np.testing.assert_allclose(values, 3.0 * triangles[..., 0], atol=1e-12)
            sides = triangles[:, 1:] - triangles[:, :1]
            area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=-1).sum()
            error.append(abs(area / (4.0 * np.pi * 0.7**2) - 1.0))
        self.assertLess(error[1], 0.02)
        self.assertGreater(error[0] / error[1], 3.0)   # second order

    def test_values_at_nodes_keep_a_constant_and_the_middle_of_a_slope(self):
        cells = np.broadcast_to(np.arange(4.0), (3, 2, 4))
        nodes = cut.at_nodes(cells)
        self.assertEqual(nodes.shape, (4, 3, 5))
        np.testing.assert_allclose(nodes[1, 1], [0.0, 0.5, 1.5, 2.5, 3.0])

    def test_azimuth_breaks_where_it_wraps(self):
        t, a = figures.unwrapped_breaks(np.arange(4.0), np.array([350.0, 359, 5, 10]))
        self.assertEqual(len(t), 5)
        self.assertTrue(np.isnan(a[2]))


if __name__ == "__main__":
    unittest.main()
