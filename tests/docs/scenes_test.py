"""Every scene and study of inputs/ runs (shortened as inputs/expected.toml says) and gives what is expected; every command in the docs has options that
exist, and those of the first run and the tutorials run. Usage: scenes_test.py PROGRAM [--all] [unittest's arguments]; without --all the fast ones.
SPDX-License-Identifier: Apache-2.0"""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
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

EXPECTED = tomllib.loads((ROOT / "inputs/expected.toml").read_text())
TUTORIALS = sorted((ROOT / "docs/tutorials").glob("*.md")) + [ROOT / "docs/user/first_run.md"]
PAGES = sorted((ROOT / "docs").rglob("*.md")) + [ROOT / "README.md"] + sorted((ROOT / "inputs").rglob("README.md"))
SHORTEN = {"inputs/" + e["file"]: e for e in EXPECTED["scene"] + EXPECTED["study"]}
VALUES = {"run", "check", "grid", "study", "reference", "report", "picture", "film", "help"}


def start(*words, folder=None):
    environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=folder or ROOT, env=environment, check=False)


def overrides(entry):
    return [word for text in entry.get("set", []) for word in ("--set", text)]


def window_of(scene):
    """time.window_s of a scene, its own or that of the last of its bases that has one."""
    table = tomllib.loads(scene.read_text())
    if "window_s" in table.get("time", {}):
        return table["time"]["window_s"]
    bases = table.get("base", [])
    found = [window_of(scene.parent / base) for base in ([bases] if isinstance(bases, str) else bases)]
    return next((window for window in reversed(found) if window is not None), None)


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="spindrift_scenes_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_every_scene_and_study_is_listed(self):
        listed = [e["file"] for kind in ("scene", "study") for e in EXPECTED[kind]] + EXPECTED["parts"]["files"]
        self.assertEqual(len(listed), len(set(listed)))
        there = {str(p.relative_to(ROOT / "inputs")) for p in (ROOT / "inputs").rglob("*.toml")}
        self.assertEqual(there, set(listed))

    def test_every_scene_that_runs_has_an_expected_number(self):
        self.assertEqual([e["file"] for e in EXPECTED["scene"] if not (e.get("check") or e.get("expect"))], [])

    def test_scenes(self):
        for entry in EXPECTED["scene"]:
            if not ALL and not entry.get("fast"):
                continue
            with self.subTest(entry["file"]):
                self.one(ROOT / "inputs" / entry["file"], entry)

    def one(self, scene, entry):
        if entry.get("check"):
            done = start("check", scene, *overrides(entry))
            self.assertEqual(done.returncode, 0, done.stderr)
            return
        out = self.folder / scene.stem
        words = ["run", scene, "--out", out, "--overwrite", "--no-report", "--quiet", *overrides(entry)]
        if "windows" in entry:
            echo = start("check", scene, *overrides(entry))
            self.assertEqual(echo.returncode, 0, echo.stderr)
            words += ["--until", entry["windows"] * window_of(scene)]
        if "until" in entry:
            words += ["--until", entry["until"]]
        done = start(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        run = spindrift.open(out)
        for column in run.columns:
            self.assertTrue(np.isfinite(run[column]).all(), column)
        for wanted in entry.get("expect", []):
            if "last" in wanted:
                self.assertAlmostEqual(run[wanted["column"]][-1], wanted["last"], delta=wanted["within"], msg=wanted["column"])
            else:
                self.assertAlmostEqual(run.mean(wanted["column"], after=wanted["after"]), wanted["mean"], delta=wanted["within"], msg=wanted["column"])

    def test_studies(self):
        for entry in EXPECTED["study"]:
            file = ROOT / "inputs" / entry["file"]
            with self.subTest(entry["file"]):
                scene = tomllib.loads(file.read_text())["study"]["scene"]
                self.assertTrue((file.parent / scene).exists(), scene)
                if not ALL and not entry.get("fast"):
                    continue
                if entry.get("check"):
                    self.forecast(file, entry)
                    continue
                done = start("study", file, "--out", self.folder / file.stem, *overrides(entry))
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                found = json.loads((self.folder / file.stem / "study.json").read_text())
                if "runs" in entry:
                    self.assertEqual(len(found["rungs"]), entry["runs"])
                page = (self.folder / file.stem / "study.html").read_text(encoding="utf-8")
                for rung in found["rungs"]:
                    self.assertIn(rung["name"], page)
                self.assertNotIn("$\\mathdefault", page)  # ticks are numbers


    def forecast(self, file, entry):
        """A study too dear to be run: every rung of it is checked and its cost foretold, as --dry-run does."""
        done = start("study", file, "--dry-run", "--out", self.folder / file.stem, *overrides(entry))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"core-(s|h)", done.stdout)


class OwnGrids(unittest.TestCase):
    """A grid of one's own, in each format: `check` lists its patches and gives the block to paste, with which the scene is valid and runs."""

    def test_patches_are_listed_with_a_block_to_paste(self):
        with tempfile.TemporaryDirectory(prefix="spindrift_grids_") as name:
            folder, wing = pathlib.Path(name), ROOT / "inputs/validation/naca0012/family.toml"
            for ending in ("cgns", "p3d", "p3dfmt"):
                with self.subTest(ending):
                    grid, scene = folder / f"wing.{ending}", folder / f"wing_{ending}.toml"
                    done = start("grid", wing, "-o", grid, "--set", "aero.flow.generate.refinement=1")
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    head = f'base = "{wing}"\nwithout = ["aero.flow.generate", "aero.flow.boundaries"]\n[time]\nend_s = 80.0\n[aero.flow]\ngrid = "{grid.name}"\n'
                    if ending != "cgns":
                        head += 'map = "wing.nmf"\n'
                    scene.write_text(head)
                    done = start("check", scene)
                    self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                    self.assertRegex(done.stdout, r"wall +\d+ faces, no condition yet")
                    block = re.search(r"^boundaries = \[\n(?:  \{.*\},\n)+\]", done.stdout, re.M)
                    self.assertIsNotNone(block, done.stdout)
                    scene.write_text(head + block[0] + "\n")
                    done = start("check", scene)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    done = start("run", scene, "--out", folder / f"run_{ending}", "--no-report", "--quiet")
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    self.assertAlmostEqual(spindrift.open(folder / f"run_{ending}")["flow.lift_coefficient"][-1], 1.07, delta=0.03)


class Output(unittest.TestCase):
    def test_a_file_gets_whole_lines(self):
        """Under mpirun, and not: progress is lines, not a line that is drawn over."""
        scene = ROOT / "inputs/tutorials/pendulum.toml"
        for words in ([], ["mpirun", "--oversubscribe", "-n", "2"]):
            with self.subTest(" ".join(words)), tempfile.TemporaryDirectory(prefix="spindrift_output_") as folder, open(f"{folder}/said", "w+b") as said:
                environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}
                done = subprocess.run([*words, PROGRAM, "run", scene, "--out", f"{folder}/run", "--no-report"], stdout=said, stderr=subprocess.STDOUT, env=environment, check=False)
                said.seek(0)
                text = said.read()
                self.assertEqual(done.returncode, 0, text)
                self.assertNotIn(b"\r", text)
                self.assertNotIn(b"\033", text)
                self.assertEqual(text.count(b"results in "), 1, text)


class Commands(unittest.TestCase):
    @staticmethod
    def commands(page):
        """Lines of blocks that start the program, with continued lines joined."""
        text = page.read_text(encoding="utf-8").replace("\\\n", " ")
        for line in text.splitlines():
            found = re.match(r"(?:    |\s*)(?:\[.*\] )?(?:mpirun [^#]*?)?(?:srun )?(?:build/release/)?spindrift (\w+)( [^|;]*)?$", line)
            if found and found[1] in VALUES and (line.startswith("    ") or not line.startswith("`")):
                yield line.strip(), found[1], (found[2] or "").split("   ")[0]

    def test_options_in_the_docs_exist(self):
        helps, count = {}, 0
        for page in PAGES:
            for line, command, rest in self.commands(page):
                if command not in helps:
                    done = start(command, "--help")
                    self.assertEqual(done.returncode, 0)
                    helps[command] = done.stdout
                for option in re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", rest.split(" : ")[0]):
                    self.assertRegex(helps[command], re.escape(option) + r"\b", f"{page.relative_to(ROOT)}: {line}")
                count += 1
        self.assertGreater(count, 40)

    def shortened(self, command, words):
        """A line's words with what shortens its scene; what the line itself sets stays."""
        files = [w for w in words if w.startswith("inputs/")]
        entry = SHORTEN.get(files[0], {}) if files else {}
        if files and not (ROOT / files[0]).exists():
            self.fail(f"{' '.join(words)}: no such file")
        if entry.get("check") and command == "run":
            entry = {"until": 0.0} | entry   # its start alone
        if command in ("run", "check", "study"):
            own = {w.partition("=")[0] for w in words}
            words = words + [w for text in entry.get("set", []) if text.partition("=")[0] not in own for w in ("--set", text)]
        if command == "run" and "until" in entry and "--until" not in words:
            words += ["--until", str(entry["until"])]
        if command == "study" and entry.get("check"):
            words += ["--dry-run"]
        if command == "picture" and "--time" in words:
            at = words.index("--time")
            del words[at:at + 2]
        if command == "film":
            words += ["--seconds", "1", "--rate", "4"]
        return words, files, entry

    def python_blocks(self, page, folder):
        environment = dict(os.environ) | {"PYTHONPATH": str(ROOT / "src/python"), "SPINDRIFT": PROGRAM}
        blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
        for block in blocks:
            done = subprocess.run(["/usr/bin/python3", "-B", "-c", block], capture_output=True, text=True, cwd=folder, env=environment, check=False)
            self.assertEqual(done.returncode, 0, f"{page.name}:\n{block}{done.stderr}")
        return len(blocks)

    def test_commands_of_the_tutorials_run(self):
        """In a folder of their own, runs shortened; pictures and films in ci/verify only. Blocks of the shell and scenes to be saved come first, blocks of Python last."""
        blocks = 0
        for page in TUTORIALS:
            with self.subTest(page.name), tempfile.TemporaryDirectory(prefix="spindrift_tutorial_") as folder:
                (pathlib.Path(folder) / "inputs").symlink_to(ROOT / "inputs")
                for block in re.findall(r"^```bash\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S):
                    if "#SBATCH" not in block:
                        done = subprocess.run(["bash", "-e", "-c", block], capture_output=True, text=True, cwd=folder, check=False)
                        self.assertEqual(done.returncode, 0, f"{page.name}:\n{block}{done.stderr}")
                for name, scene in re.findall(r"Save this as `(runs/[\w./]+)`:\n\n```toml\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S):
                    (pathlib.Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                    (pathlib.Path(folder) / name).write_text(scene)
                for line, command, rest in self.commands(page):
                    words, files, entry = self.shortened(command, shlex.split(rest))
                    if (words and words[0] == "scene.toml") or (not ALL and (command in ("picture", "film") or (files and not entry.get("fast")))):
                        continue
                    if not ALL and command in ("report",) and not (pathlib.Path(folder) / words[0]).exists():
                        continue
                    if entry.get("check") and command != "check":
                        continue
                    if command == "run" and not ALL:
                        words.append("--no-report")
                    done = start(command, *words, folder=folder)
                    self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
                blocks += self.python_blocks(page, folder)
        self.assertGreaterEqual(blocks, 1)

    @unittest.skipUnless(ALL, "in ci/verify")
    def test_commands_of_all_other_pages_run(self):
        """As they stand, through a shell that knows `spindrift`, `mpirun` and `srun`; runs shortened, in a folder that has what the lines take for granted."""
        count = 0
        for page in PAGES:
            if page in TUTORIALS or not list(self.commands(page)):
                continue
            with self.subTest(str(page.relative_to(ROOT))), tempfile.TemporaryDirectory(prefix="spindrift_page_") as name:
                folder = pathlib.Path(name)
                environment = self.furnished(folder)
                for line, command, rest in self.commands(page):
                    if "--out " in line and "--restart" not in line:
                        shutil.rmtree(folder / shlex.split(line.partition("--out ")[2])[0], ignore_errors=True)
                    line = line.partition("   #")[0].replace("build/release/spindrift", "spindrift")
                    if " : " not in line:
                        words, _, _ = self.shortened(command, shlex.split(rest.partition("   #")[0]))
                        line = line[:line.index(f"spindrift {command}")] + shlex.join(["spindrift", command, *words])
                    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, cwd=folder, env=environment, check=False)
                    self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
                    count += 1
        self.assertGreater(count, 35)

    def furnished(self, folder):
        """Scenes of one's own, earlier runs, and the commands on the path."""
        (folder / "inputs").symlink_to(ROOT / "inputs")
        (folder / "scene.toml").write_text('base = "inputs/leble_barakos/case3_engineering.toml"\n')
        (folder / "case1.toml").write_text('base = "inputs/leble_barakos/case1_engineering.toml"\nwithout = ["output.expected"]\n')
        (folder / "case3.toml").write_text('base = "inputs/leble_barakos/case3_demo.toml"\n[time]\nend_s = 0.2\n[start]\nair_steps = 5\n[sea.particles]\nspacing_m = 5.0\n')
        programs = folder / "bin"
        programs.mkdir()
        for name, command in (("spindrift", f'exec {PROGRAM} "$@"'), ("srun", 'exec "$@"'), ("mpirun", 'exec /usr/bin/mpirun --oversubscribe "$@"')):
            (programs / name).write_text(f"#!/bin/bash\n{command}\n")
            (programs / name).chmod(0o755)
        for words in (("scene.toml", "--out", "run1", "--until", "5"), ("scene.toml", "--out", "run2", "--until", "5"),
                      ("case3.toml", "--out", "runs/demo/coupled", "--set", "sea.fields.interval_s=0.1")):
            done = start("run", *words, "--no-report", "--quiet", folder=folder)
            self.assertEqual(done.returncode, 0, done.stderr)
        done = start("study", "inputs/tutorials/steps.toml", "--out", "runs/steps", folder=folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return dict(os.environ) | {"PATH": f"{programs}:{os.environ['PATH']}", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                                   "OMP_WAIT_POLICY": "passive"}


if __name__ == "__main__":
    unittest.main()
