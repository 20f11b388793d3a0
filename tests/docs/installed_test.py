"""An installation into an empty prefix: the program with its report, pictures, completion, man page and Python module. The pages in a browser:
pages_test.py. Usage: installed_test.py BUILD. Needs cmake, python3-vtk9, xvfb, ffmpeg (ci/setup --pictures). SPDX-License-Identifier: Apache-2.0"""
import pathlib
import re
import shutil
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(ROOT / "tests/docs"))
sys.dont_write_bytecode = True

import installed
from installed import start


class Installed(installed.Prefix):
    build = BUILD

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
