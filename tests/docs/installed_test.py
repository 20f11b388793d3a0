"""An installation into an empty prefix: the program with its report, pictures, completion, man page and Python module. The pages in a browser:
pages_test.py. Usage: installed_test.py BUILD. Needs cmake, python3-vtk9, xvfb, ffmpeg (ci/setup --pictures). SPDX-License-Identifier: Apache-2.0"""
import ast
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
        for name in ("bin/spindrift", "share/spindrift/report/spindrift_report.py", "share/spindrift/report/templates/page.html", "share/spindrift/report/templates/parts.html", "share/spindrift/report/style.css",
                     "share/man/man1/spindrift.1", "share/bash-completion/completions/spindrift"):
            self.assertTrue((self.prefix / name).exists(), name)
        sources = {p.name for p in (ROOT / "src/report").glob("*.py")}
        self.assertEqual(sources, {p.name for p in (self.prefix / "share/spindrift/report").glob("*.py")})
        self.assertTrue(list(self.prefix.glob("lib*/cmake/spindrift/spindriftConfig.cmake")) + list(self.prefix.glob("lib/*/cmake/spindrift/spindriftConfig.cmake")))

    def test_scenes_are_found_by_their_names_in_the_docs(self):
        done = start(self.prefix / "bin/spindrift", "check", "inputs/tutorials/gust.toml", cwd=self.folder.name)
        self.assertEqual(done.returncode, 2)
        self.assertIn(str((self.prefix / "share/spindrift/inputs/tutorials/gust.toml").resolve()), done.stdout + done.stderr)

    def test_other_projects_find_the_program(self):
        project = pathlib.Path(self.folder.name) / "project"
        project.mkdir()
        (project / "CMakeLists.txt").write_text('cmake_minimum_required(VERSION 3.21)\nproject(p NONE)\nfind_package(spindrift 0.1 REQUIRED)\n'
                                                'get_target_property(where spindrift::spindrift IMPORTED_LOCATION_RELEASE)\nmessage(STATUS "at ${where}")\n')
        done = start("cmake", "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_LIBRARY_ARCHITECTURE=x86_64-linux-gnu")
        self.assertIn(str(self.program), done.stdout, done.stderr)

    def test_the_container_has_what_the_program_links(self):
        """By the packages that its libraries belong to on this Debian; those of the compiler are in every image."""
        if not shutil.which("dpkg-query"):
            self.skipTest("no Debian packages here")
        stage = (ROOT / "ci/packaging/Containerfile").read_text(encoding="utf-8").rpartition("FROM ")[2]
        needed = re.findall(r"NEEDED.*\[(.+)\]", start("readelf", "-d", self.program).stdout)
        where = dict(re.findall(r"^\s*(\S+) => (\S+)", start("ldd", self.program).stdout, re.M))
        self.assertGreater(len(needed), 8)
        for library in needed:
            owner = start("dpkg-query", "-S", pathlib.Path(where[library]).resolve()).stdout.partition(":")[0]
            if owner not in ("", "libc6", "libgcc-s1", "libstdc++6"):
                self.assertRegex(stage, rf"[ ]{re.escape(owner)}[ \n]", library)
        for module in ("numpy", "matplotlib", "h5py", "jinja2"):
            self.assertIn(f"python3-{module}", stage)

    def test_the_module_file_names_folders_that_there_are(self):
        text = (ROOT / "ci/packaging/spindrift.lua").read_text(encoding="utf-8")
        named = re.findall(r'prepend_path\("(\w+)", pathJoin\(prefix, "([^"]+)"\)\)', text)
        self.assertEqual([name for name, _ in named], ["PATH", "MANPATH", "PYTHONPATH"])
        for _, folder in named:
            self.assertTrue((self.prefix / folder).is_dir(), folder)

    def test_the_completion_knows_every_command(self):
        self.assertTrue((self.prefix / "share/man/man1/spindrift.1").is_file())
        commands = re.findall(r"^  ([a-z]+)  ", start(self.program, "--help").stdout, re.M)
        self.assertGreaterEqual(len(commands), 9)
        completion = (self.prefix / "share/bash-completion/completions/spindrift").read_text()
        for command in commands:
            self.assertRegex(completion, rf"\b{command}\b")
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
        run = self.run_scene("leble_barakos/case3_demo.toml", "--until", 1, "--set", "start.air_steps=30")
        done = start(self.program, "picture", run)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.find_parts(matplotlib.image.imread(run / "picture.png")[..., :3], 1.0)
        shutil.copy(run / "picture.png", self.pages / "picture.png")
        for ending in ("mp4", "webm"):   # of 12 s, as by default
            out = self.pages / f"film.{ending}"
            done = start(self.program, "film", run, "-o", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(out.stat().st_size, 10_000)
            self.assertLess(out.stat().st_size, 5 << 20)
            probe = start("ffprobe", "-v", "error", "-show_entries", "format=duration", "-of", "csv=p=0", out)
            self.assertAlmostEqual(float(probe.stdout), 12.0, delta=0.2)
            frames = []
            for second in (0.5, 6.0, 11.5):
                still = self.pages / "frame.png"
                done = start("ffmpeg", "-y", "-loglevel", "error", "-ss", second, "-i", out, "-frames:v", 1, still)
                self.assertEqual(done.returncode, 0, done.stderr)
                frames.append(matplotlib.image.imread(still)[..., :3])
                self.find_parts(frames[-1], frames[-1].shape[0] * frames[-1].shape[1] / (1600 * 900))
            self.assertGreater((abs(frames[2] - frames[0]).max(axis=2) > 0.1).sum(), 1000)   # it moves

    def find_parts(self, pixels, scale):
        """Floats, tower and blades, lines, sea and wake by their colours; `scale`: pixels of this picture over those of 1600 x 900."""
        r, g, b = pixels[..., 0], pixels[..., 1], pixels[..., 2]
        for what, seen, least in (("floats", (r > 0.7) & (g > 0.5) & (b < 0.3), 2000), ("tower and blades", (r > 0.85) & (g > 0.85) & (b > 0.85) & (abs(r - b) < 0.04), 2000),
                                  ("lines", (r > 0.6) & (g < 0.4) & (b < 0.35), 150), ("sea", (b > r + 0.15) & (b < 0.65), 20_000),
                                  ("wake", (g > r + 0.1) & (g > b), 2000)):
            self.assertGreater(seen.sum(), least * scale, what)

    def test_a_picture_holds_every_part(self):
        """Three floats, tower and three blades, three lines, sea and wake, as actors."""
        run = self.run_scene("leble_barakos/case3_demo.toml", "--until", 1, "--set", "start.air_steps=30")
        done = start("/usr/bin/python3", "-B", "-c", f"""
import pathlib, sys
sys.path.insert(0, {str(self.prefix / "share/spindrift/report")!r})
import spindrift_picture
from run_data import RunData
with spindrift_picture.Display():
    import scene_picture
    drawing = scene_picture.Drawing(RunData(pathlib.Path({str(run)!r})), (320, 180))
    drawing.draw(1.0)
    print(drawing.seen)
    del drawing   # before the display goes
""")
        self.assertEqual(done.returncode, 0, done.stderr)
        seen = ast.literal_eval(done.stdout)
        for kind, least in (("float", 3), ("tower", 1), ("nacelle", 1), ("blade", 3), ("line", 3), ("sea", 1), ("wake", 1)):
            self.assertGreaterEqual(seen.get(kind, 0), least, f"{kind}: {seen}")


if __name__ == "__main__":
    unittest.main()
