"""The battery of tests/extremes: every scene at or beyond a limit ends as its row says: bounded by two values, or refused or stopped by name. Nothing
hangs, nothing runs away with exit code 0. Usage: extremes_test.py SPINDRIFT [CLASS...] [--table] (--table: docs/verification/extremes.md on standard output).
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
PLACES = ("x_m", "y_m", "z_m")


def largest(history, column, last):
    """Magnitude of what a run reaches in this column (at its end where `last`), of positions where there is none; nan where any value of any column is none."""
    with open(history, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if any(not math.isfinite(float(v)) for row in rows for v in row.values()):
        return math.nan
    wanted = [column] if column else [k for k in (rows[0] if rows else {}) if k.split(".")[-1] in PLACES]
    return max((abs(float(row[k])) for row in (rows[-1:] if last else rows) for k in wanted), default=0.0)


def end_of(case):
    """(exit code, what was said, by column what was reached)."""
    scene = SCENES[case["scene"]]
    columns = list(case["reaches"]) if isinstance(case.get("reaches"), dict) else [case.get("column", scene.get("column"))]
    with tempfile.TemporaryDirectory() as scratch:
        done = spindrift("run", ROOT / scene["file"], "--out", scratch + "/out", "--no-report", "--quiet", settings=scene.get("set", []) + case["set"], timeout=240)
        said = (done.stderr + done.stdout).strip()
        if done.returncode == 3 and (summary := pathlib.Path(scratch, "out/summary.json")).exists():
            said = json.loads(summary.read_text())["exit_reason"]
        if done.returncode == 0:
            said = "\n".join(json.loads(pathlib.Path(scratch, "out/summary.json").read_text())["numerical_trouble"])
        return done.returncode, said, {c: largest(scratch + "/out/history.csv", c, scene.get("last", False)) for c in columns} if done.returncode == 0 else {}


def verdict(case):
    """How it ended, and what is wrong with that ('' where nothing is)."""
    code, said, reached = end_of(case)
    if code not in ENDS:
        return f"code {code}", said
    if "unknown key" in said or "has no effect" in said:
        return "not run", f"a slip of the table: {said}"
    if code == 0:
        how = "bounded, reaches " + ", ".join(f"{value:.4g}" for value in reached.values())
        if "reaches" not in case:
            return how, f"should be {case.get('ends', 'refused')} for {case['named']}"
        ranges = case["reaches"] if isinstance(case["reaches"], dict) else dict.fromkeys(reached, case["reaches"])
        if case.get("doubted", "") not in said:
            return how, f"does not warn of {case['doubted']}: {said}"
        how += f", with a warning: {case['doubted']}" if "doubted" in case else ""
        return how, "; ".join(f"should reach {low} to {high}" for c, (low, high) in ranges.items() if not low <= reached[c] <= high)
    how = f"{ENDS[code]}: " + said.splitlines()[-1].split(": ", 1)[-1].replace(f"{ROOT}/", "")[:160]
    if "reaches" in case:
        return how, f"should be bounded: {said}"
    if ENDS[code] != case.get("ends", "refused"):
        return how, f"should be {case.get('ends', 'refused')}"
    return how, "" if case["named"] in said else f"does not name {case['named']}: {said}"


class Extremes(unittest.TestCase):
    """One test for each module."""


class Nightly(unittest.TestCase):
    """Those whose runs take longer."""


for module, content in BATTERY.items():
    def test(self, cases=content["cases"]):
        self.assertGreaterEqual(len(cases), 8)
        for case in cases:
            with self.subTest(case["what"]):
                self.assertTrue(("reaches" in case) != bool(case.get("named")), "each row says how it ends")
                self.assertEqual(verdict(case)[1], "", case["what"])
    setattr(Nightly if module in ("beams", "control", "wake", "turbulence", "rotors", "resolved", "blades", "tank") else Extremes, f"test_{module}", test)


def table():
    print("# Extremes\n\nEvery scene ends as its row of `tests/extremes/battery.toml` says: bounded, with a largest position or value (of a march to a steady state: the last) in a given range, or refused or stopped "
          "by name. Written by `tests/coupled/extremes_test.py SPINDRIFT --table`.\n")
    for module, content in BATTERY.items():
        print(f"\n## {module}\n\n| scene | ends |\n|---|---|")
        for case in content["cases"]:
            how, wrong = verdict(case)
            print(f"| {case['what']} | {how.replace('|', '/')}{' **' + wrong.splitlines()[-1][:150] + '**' if wrong else ''} |", flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    table() if "--table" in sys.argv else unittest.main(verbosity=2)
