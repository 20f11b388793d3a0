"""The battery of tests/extremes: every scene at or beyond a limit ends bounded, or is refused or stopped by name. Nothing hangs, nothing
runs away with exit code 0. Usage: extremes_test.py SPINDRIFT [--table] (--table: docs/verification/extremes.md on standard output).
SPDX-License-Identifier: Apache-2.0"""
import csv
import json
import math
import os
import pathlib
import sys
import tempfile
import tomllib
import unittest

from running import ROOT, spindrift

BATTERY = tomllib.loads((ROOT / "tests/extremes/battery.toml").read_text(encoding="utf-8"))
SCENES = BATTERY.pop("scene")
ENDS = {0: "bounded", 2: "refused", 3: "stopped"}


def largest_place(history):
    """Of all x_m, y_m, z_m columns; nan where any value is none."""
    with open(history, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if any(not math.isfinite(float(v)) for row in rows for v in row.values()):
        return math.nan
    return max((abs(float(v)) for row in rows for k, v in row.items() if k.split(".")[-1] in ("x_m", "y_m", "z_m")), default=0.0)


def end_of(case):
    """(exit code, what was said, largest place)."""
    scene = SCENES[case["scene"]]
    with tempfile.TemporaryDirectory() as scratch:
        done = spindrift("run", ROOT / scene["file"], "--out", scratch + "/out", "--no-report", "--quiet", settings=scene.get("set", []) + case["set"], timeout=240)
        said = (done.stderr + done.stdout).strip()
        if done.returncode == 3 and (summary := pathlib.Path(scratch, "out/summary.json")).exists():
            said = json.loads(summary.read_text())["exit_reason"]
        place = largest_place(scratch + "/out/history.csv") if done.returncode == 0 else 0.0
        return done.returncode, said, place


def verdict(case):
    """How it ended, and what is wrong with that ('' where nothing is)."""
    code, said, place = end_of(case)
    if code not in ENDS:
        return f"code {code}", said
    if "unknown key" in said or "has no effect" in said:
        return "not run", f"a slip of the table: {said}"
    if code == 0 and not place < case.get("bound", SCENES[case["scene"]]["bound"]):
        return "ran away", f"a place of {place} m with exit code 0"
    if code != 0 and case.get("named", None) is None:
        return ENDS[code], f"should be bounded: {said}"
    if code != 0 and (case["named"] not in said or not said):
        return ENDS[code], f"does not name {case['named']}: {said}"
    if code == 0 and case.get("named"):
        return ENDS[code], f"should be refused for {case['named']}"
    return ENDS[code] + ("" if code == 0 else ": " + said.splitlines()[-1].split(": ", 1)[-1].replace(f"{ROOT}/", "")[:160]), ""


class Extremes(unittest.TestCase):
    """One test for each module."""


for module, content in BATTERY.items():
    def test(self, cases=content["cases"]):
        self.assertGreaterEqual(len(cases), 8)
        for case in cases:
            with self.subTest(case["what"]):
                self.assertEqual(verdict(case)[1], "", case["what"])
    setattr(Extremes, f"test_{module}", test)


def table():
    print("# Extremes\n\nEvery scene ends bounded, or is refused or stopped by name. Written by `tests/coupled/extremes_test.py SPINDRIFT --table`.\n")
    for module, content in BATTERY.items():
        print(f"\n## {module}\n\n| scene | ends |\n|---|---|")
        for case in content["cases"]:
            how, wrong = verdict(case)
            print(f"| {case['what']} | {how.replace('|', '/')}{' **' + wrong.splitlines()[-1][:150] + '**' if wrong else ''} |", flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    table() if "--table" in sys.argv else unittest.main(verbosity=2)
