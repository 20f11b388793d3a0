"""Every scene and study of inputs/ runs (shortened as inputs/expected.toml says) and gives what is expected; every command in the docs has options that
exist, and those of the first run and the tutorials run. Usage: scenes_test.py PROGRAM [--all] [unittest's arguments]; without --all the fast ones.
SPDX-License-Identifier: Apache-2.0"""
import json
import os
import pathlib
import re
import shlex
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
VALUES = {"run", "check", "grid", "study", "reference", "report", "picture", "film", "help"}


def start(*words, folder=None):
    environment = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=folder or ROOT, env=environment, check=False)


def overrides(entry):
    return [word for text in entry.get("set", []) for word in ("--set", text)]


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
            window = tomllib.loads(scene.read_text())["time"]["window_s"]
            words += ["--until", entry["windows"] * window]
        if "until" in entry:
            words += ["--until", entry["until"]]
        done = start(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        run = spindrift.open(out)
        for column in run.columns:
            self.assertTrue(np.isfinite(run[column]).all(), column)
        for wanted in entry.get("expect", []):
            mean = run.mean(wanted["column"], after=wanted["after"])
            self.assertAlmostEqual(mean, wanted["mean"], delta=wanted["within"], msg=wanted["column"])

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

    def test_commands_of_the_tutorials_run(self):
        """In a folder of their own, runs shortened; pictures and films in ci/verify only."""
        shorten = {"inputs/" + e["file"]: e for e in EXPECTED["scene"] + EXPECTED["study"]}
        for page in TUTORIALS:
            with self.subTest(page.name), tempfile.TemporaryDirectory(prefix="spindrift_tutorial_") as folder:
                (pathlib.Path(folder) / "inputs").symlink_to(ROOT / "inputs")
                for line, command, rest in self.commands(page):
                    words = shlex.split(rest)
                    files = [w for w in words if w.startswith("inputs/")]
                    entry = shorten.get(files[0], {}) if files else {}
                    if files and not (ROOT / files[0]).exists():
                        self.fail(f"{line}: no such file")
                    if (words and words[0] == "scene.toml") or (not ALL and (command in ("picture", "film") or (files and not entry.get("fast")))):
                        continue
                    if not ALL and command in ("report",) and not (pathlib.Path(folder) / words[0]).exists():
                        continue
                    if entry.get("check") and command != "check":
                        continue
                    words += overrides(entry) if command in ("run", "check") else []
                    if command == "run" and "until" in entry and "--until" not in words:
                        words += ["--until", str(entry["until"])]
                    if command == "picture" and "--time" in words:
                        at = words.index("--time")
                        del words[at:at + 2]
                    if command == "film":
                        words += ["--seconds", "1", "--rate", "4"]
                    if command == "run" and not ALL:
                        words.append("--no-report")
                    done = start(command, *words, folder=folder)
                    self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


if __name__ == "__main__":
    unittest.main()
