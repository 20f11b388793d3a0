"""An installation into an empty prefix: the program with its report, pictures, completion, man page and Python module; the pages in a browser without a
window: no error of a script, no empty and no clipped figure, curves as in the CSV file. Screenshots stay in BUILD/pages to be looked at.
Usage: installed_test.py BUILD. Needs cmake, chromium, python3-vtk9, xvfb, ffmpeg (ci/setup --verify). SPDX-License-Identifier: Apache-2.0"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(ROOT / "tests/src/report"))
sys.dont_write_bytecode = True

import synthetic_run

ENVIRONMENT = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}


def start(*words, **settings):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, env=ENVIRONMENT, check=False, **settings)


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="spindrift_installed_")
        cls.prefix, cls.runs = pathlib.Path(cls.folder.name) / "prefix", pathlib.Path(cls.folder.name) / "runs"
        cls.pages = BUILD / "pages"
        cls.pages.mkdir(exist_ok=True)
        done = start("cmake", "--install", BUILD, "--prefix", cls.prefix)
        assert done.returncode == 0, done.stderr
        cls.program, cls.inputs = cls.prefix / "bin/spindrift", cls.prefix / "share/spindrift/inputs"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_scene(self, name, *more):
        out = self.runs / pathlib.Path(name).stem
        if not out.exists():
            done = start(self.program, "run", self.inputs / name, "--out", out, *more)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("report: ", done.stdout)
        return out

    def test_everything_is_there(self):
        for name in ("bin/spindrift", "share/spindrift/report/spindrift_report.py", "share/spindrift/report/templates/page.html",
                     "share/man/man1/spindrift.1", "share/bash-completion/completions/spindrift"):
            self.assertTrue((self.prefix / name).exists(), name)
        sources = {p.name for p in (ROOT / "src/report").glob("*.py")}
        self.assertEqual(sources, {p.name for p in (self.prefix / "share/spindrift/report").glob("*.py")})
        self.assertTrue(list(self.prefix.glob("lib*/cmake/spindrift/spindriftConfig.cmake")) + list(self.prefix.glob("lib/*/cmake/spindrift/spindriftConfig.cmake")))

    def test_other_projects_find_the_program(self):
        project = pathlib.Path(self.folder.name) / "project"
        project.mkdir()
        (project / "CMakeLists.txt").write_text('cmake_minimum_required(VERSION 3.21)\nproject(p NONE)\nfind_package(spindrift 0.1 REQUIRED)\n'
                                                'get_target_property(where spindrift::spindrift IMPORTED_LOCATION_RELEASE)\nmessage(STATUS "at ${where}")\n')
        done = start("cmake", "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_LIBRARY_ARCHITECTURE=x86_64-linux-gnu")
        self.assertIn(str(self.program), done.stdout, done.stderr)

    def test_completion_and_man_page_know_every_command(self):
        helped = start(self.program, "--help").stdout
        commands = re.findall(r"^  ([a-z]+)  ", helped, re.M)
        self.assertGreaterEqual(len(commands), 9)
        completion, page = ((self.prefix / name).read_text() for name in ("share/bash-completion/completions/spindrift", "share/man/man1/spindrift.1"))
        for command in commands:
            self.assertRegex(completion, rf"\b{command}\b")
            self.assertIn(rf"\fB{command}\fR", page)
            for option in re.findall(r"--[a-z][a-z-]+", start(self.program, command, "--help").stdout.split("Examples:")[0]):
                if option not in ("--help", "--pictures"):
                    self.assertIn(option.replace("-", r"\-"), page, command)
        done = start("bash", "-c", f'source {self.prefix}/share/bash-completion/completions/spindrift; COMP_WORDS=({self.program} ru); COMP_CWORD=1; _spindrift; '
                                   f'echo "${{COMPREPLY[@]}}"; COMP_WORDS=({self.program} run --unt); COMP_CWORD=2; _spindrift; echo "${{COMPREPLY[@]}}"')
        self.assertEqual(done.stdout.split(), ["run", "--until"])

    def test_python_module(self):
        run = self.run_scene("tutorials/pendulum.toml")
        module = next(self.prefix.glob("**/spindrift.py"))
        done = start("/usr/bin/python3", "-B", "-c", f"import sys; sys.path.insert(0, {str(module.parent)!r}); import spindrift; "
                     f"print(spindrift.program(), spindrift.open({str(run)!r}).exit_code)")
        self.assertEqual(done.stdout.split(), [str(self.program), "0"], done.stderr)

    # ---- pages in a browser -------------------------------------------------------------------------------------------------------------

    def browse(self, page, width=1280, dark=False):
        """Screenshot as an array, and what the browser complained about."""
        import matplotlib.image
        picture = self.pages / f"{page.parent.name}_{page.stem}{'_dark' if dark else ''}_{width}.png"
        picture.unlink(missing_ok=True)
        done = start("chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr", "--log-level=0",
                     f"--window-size={width},5200", *(["--blink-settings=preferredColorScheme=0"] if dark else []), f"--screenshot={picture}", f"file://{page}", timeout=240)
        self.assertTrue(picture.exists(), done.stderr[-2000:])
        self.assertNotRegex(done.stderr, r"CONSOLE.*(rror|Refused)")
        return matplotlib.image.imread(picture)[..., :3]

    def look_at(self, page):
        text = page.read_text()
        self.assertNotRegex(text, r"\$\\?math|\ufffd")
        self.assertNotRegex(text, r"https?://(?!www\.w3\.org)")
        self.assertLess(len(text), 10 << 20)
        self.assertIn('class="headline"', text)
        for svg in re.findall(r"<svg.*?</svg>", text, re.S):
            self.assertGreater(svg.count("<path"), 3, "an empty figure")
            width, height = map(float, re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', svg).groups())
            for x, y in re.findall(r"<text[^>]*translate\(([-\d.]+)[ ,]+([-\d.]+)\)", svg):
                self.assertTrue(-1 <= float(x) <= width + 1 and -1 <= float(y) <= height + 1, "a label outside its figure")
        for width in (1280, 420):
            pixels = self.browse(page, width)
            inked = (np.abs(pixels - pixels[0, 0]).max(axis=2) > 0.1)
            self.assertGreater(inked.mean(), 0.01, "an empty page")
            self.assertFalse(inked[:, -3:].any(), f"cut off at a width of {width}")
        light, dark = self.browse(page)[0, 0], self.browse(page, dark=True)[0, 0]
        self.assertGreater(light.mean() - dark.mean(), 0.5, "no dark form")

    def test_reports(self):
        for name, more in (("leble_barakos/case1_engineering.toml", ()), ("tutorials/own_turbine.toml", ("--until", 20)),
                           ("validation/floating_box/floating_box.toml", ("--set", "sea.fields.interval_s=1.0")),
                           ("tutorials/wing_section.toml", ("--set", "aero.flow.generate.refinement=1", "--set", "time.end_s=60.0")),
                           ("leble_barakos/rotor_demo.toml", ("--set", "time.end_s=20.0")),
                           ("leble_barakos/case3_demo.toml", ("--until", 1, "--set", "start.air_steps=30", "--set", "sea.fields.interval_s=0.5"))):
            with self.subTest(name):
                self.look_at(self.run_scene(name, *more) / "report.html")

    def test_comparison_and_study(self):
        first = self.run_scene("leble_barakos/case1_engineering.toml")
        done = start(self.program, "report", first, self.run_scene("leble_barakos/case2_engineering.toml"))
        self.assertIn("comparison.html", done.stdout)
        self.look_at(first / "comparison.html")
        done = start(self.program, "study", self.inputs / "tutorials/steps.toml", "--out", self.runs / "steps")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.look_at(self.runs / "steps/study.html")

    def test_the_curve_on_the_screen_is_that_of_the_file(self):
        """Of the drawn path: at each column of pixels its least and greatest height are those of the rows there, within a pixel."""
        for rows in (700, 2801, 6001, 60_001):
            with self.subTest(rows=rows):
                t = np.linspace(0.0, 600.0, rows)
                values = np.sin(0.05 * t) + 0.4 * np.sin(1.7 * t) + 0.002 * t
                folder = self.runs / f"rows_{rows}"
                synthetic_run.write(folder, table={"time_s": t, "a.x_m": values}, scene="", log="")
                self.assertEqual(start(self.program, "report", folder).returncode, 0)
                svg = re.search(r'<svg.*?</svg>', (folder / "report.html").read_text(), re.S)[0]
                path = max(re.findall(r'<path d="([^"]*)"', svg), key=len)
                corners = np.array(re.findall(r"[ML] ?([-\d.]+) ([-\d.]+)", path), float)
                # From the file's values to the figure's: the curve spans the same box.
                x = corners[0, 0] + (t - t[0]) / (t[-1] - t[0]) * (corners[-1, 0] - corners[0, 0])
                low, high = values.min(), values.max()
                y = corners[:, 1].max() + (values - low) / (high - low) * (corners[:, 1].min() - corners[:, 1].max())
                pixel = 0.72   # points, at the width of a column of the page
                drawn_x, drawn_y = corners.T
                for left in np.arange(x[0], x[-1], pixel):
                    here, there = (x >= left) & (x < left + pixel), (drawn_x >= left - pixel) & (drawn_x < left + 2 * pixel)
                    if here.any():
                        ends = np.interp([left, left + pixel], drawn_x, drawn_y)
                        seen = np.concatenate([drawn_y[there], ends])
                        self.assertLessEqual(seen.min() - pixel, y[here].min(), f"at {left:.1f}")
                        self.assertGreaterEqual(seen.max() + pixel, y[here].max(), f"at {left:.1f}")

    # ---- picture and film ---------------------------------------------------------------------------------------------------------------

    def test_picture_and_film_show_floats_tower_rotor_lines_sea_and_wake(self):
        import matplotlib.image
        run = self.run_scene("leble_barakos/case3_demo.toml", "--until", 1, "--set", "start.air_steps=30", "--set", "sea.fields.interval_s=0.5")
        done = start(self.program, "picture", run)
        self.assertEqual(done.returncode, 0, done.stderr)
        pixels = matplotlib.image.imread(run / "picture.png")[..., :3]
        r, g, b = pixels[..., 0], pixels[..., 1], pixels[..., 2]
        for what, seen, least in (("floats", (r > 0.7) & (g > 0.5) & (b < 0.3), 2000), ("tower and blades", (r > 0.85) & (g > 0.85) & (b > 0.85) & (abs(r - b) < 0.04), 2000),
                                  ("lines", (r > 0.6) & (g < 0.4) & (b < 0.35), 150), ("sea", (b > r + 0.15) & (b < 0.65), 20_000),
                                  ("wake", (g > r + 0.1) & (g > b), 2000)):
            self.assertGreater(seen.sum(), least, what)
        shutil.copy(run / "picture.png", self.pages / "picture.png")
        for ending in ("mp4", "webm"):
            out = self.pages / f"film.{ending}"
            done = start(self.program, "film", run, "-o", out, "--seconds", 2)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(out.stat().st_size, 10_000)
            self.assertLess(out.stat().st_size, 5 << 20)


if __name__ == "__main__":
    unittest.main()
