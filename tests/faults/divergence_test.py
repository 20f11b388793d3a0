"""The table of tests/faults/divergence.toml: numerical trouble in every module ends with exit code 3, a summary with time, module, place, value and
limit, and a checkpoint that loads; or the run is done after retries that its log names. Usage: divergence_test.py SPINDRIFT [--table] [PART...]
SPDX-License-Identifier: Apache-2.0"""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).parents[2]
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
TABLE = tomllib.loads((ROOT / "tests/faults/divergence.toml").read_text(encoding="utf-8"))
SCENES = TABLE.pop("scene")
# What every reason of a part says, besides the time.
NAMED = {"air": "aero: ", "bodies": "limit", "lines": "steps of", "coupling": "window", "sea": "sea: "}


def run(case, out, *more):
    scene = SCENES[case["scene"]]
    words = [PROGRAM, "run", str(ROOT / scene["file"]), "--out", str(out), "--no-report", "--quiet", *more]
    for text in scene.get("set", []) + case["set"]:
        words += ["--set", text]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=300)
    return done.returncode, done.stderr + done.stdout


def energy_made(out):
    """By the steps of the bodies, over what was put in: the largest ratio of all rows. 0 where the scene has no bodies."""
    with open(out / "history.csv", encoding="utf-8") as file:
        rows = [{key: float(value) for key, value in row.items() if key.startswith("energy.")} for row in csv.DictReader(file)]
    if not rows or "energy.steps_J" not in rows[0]:
        return 0.0
    put_in = max(row["energy.kinetic_J"] for row in rows[:1])
    worst = 0.0
    for row in rows:
        put_in = max(put_in, sum(abs(value) for key, value in row.items() if key.endswith("work_J")))
        worst = max(worst, row["energy.steps_J"] / max(put_in, 1.0))
    return worst


def ended(case):
    """(How, what was said, what is wrong with it: '' where nothing is)."""
    with tempfile.TemporaryDirectory(prefix="spindrift_diverged_") as scratch:
        out = pathlib.Path(scratch, "out")
        code, said = run(case, out)
        if not (out / "summary.json").exists():
            return f"code {code}", said.strip()[-300:], "no summary"
        summary = json.loads((out / "summary.json").read_text())
        if summary["exit_code"] != code:
            return f"code {code}", said.strip()[-300:], "another code in the summary"
        if (made := energy_made(out)) > 0.01:
            return f"code {code}", summary["exit_reason"], f"the steps made {made:.3g} of the energy put in"
        retries = re.findall(r"warning *:? *(.*\(retry \d of \d\).*)", (out / "log.txt").read_text())
        if code == 0:
            return "retried" if retries else "done", retries[0][:200] if retries else "", "" if retries else "neither stopped nor retried"
        why = summary["exit_reason"]
        if code != 3:
            return f"code {code}", why, "not 3"
        if not re.search(r"t = [-\d.e+]+ s|in the \d+ pseudo-steps", why):  # of a steady run the step is the time
            return "stopped", why, "no time"
        if not list((out / "checkpoints").glob("*.h5")):
            return "stopped", why, "no checkpoint"
        code, said = run(case, out, "--restart")
        again = json.loads((out / "summary.json").read_text())["exit_reason"]
        # A flow that did not converge in its steps goes on to others: the same end, not the same numbers.
        return "stopped", why, "" if code == 3 and (again == why or "pseudo-steps" in why) else f"after a restart: code {code}, {again}\n{said[-300:]}"


def main():
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    parts = [a for a in sys.argv[2:] if not a.startswith("--")] or list(TABLE)
    faults = 0
    for part in parts:
        if "--table" in sys.argv:
            print(f"\n## {part}\n\n| what | ends |\n|---|---|")
        for case in TABLE[part]["cases"]:
            how, said, wrong = ended(case)
            wrong = wrong or ("" if how == case["ends"] else f"ends {how}, should be {case['ends']}")
            named = case.get("named", NAMED[part])
            wrong = wrong or ("" if named in said else f"does not say {named}")
            faults += bool(wrong)
            if "--table" in sys.argv or wrong:
                print(f"| {case['what']} | {how}: {said}{' **' + wrong + '**' if wrong else ''} |", flush=True)
    count = sum(len(TABLE[p]["cases"]) for p in parts)
    print(f"{count - faults} of {count} ended as expected")
    sys.exit(1 if faults else 0)


main()
