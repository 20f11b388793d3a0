"""`spindrift study` as a user calls it: the answer, what is found before anything runs, stop, kill and resume.
Usage: study_test.py SPINDRIFT [TEST...]. SPDX-License-Identifier: Apache-2.0"""
import json
import os
import random
import re
import signal
import subprocess
import sys
import time
import unittest

from running import Folder, PROGRAM, ROOT

STUDY = f"""
[study]
scene = "{ROOT}/tests/extremes/buoy.toml"
set = ["waves.model=jonswap", "waves.height_m=0.3", "waves.period_s=4.0", "waves.components=40"]
at_once = 1
repeats = 1

[axes.step]
key = "time.step_s"
values = [0.1, 0.05, 0.025]

[replicas]
key = "waves.seed"
values = [1, 2, 3, 4]

[reference]
variant = "base-step_0.025"

[metrics.heave]
column = "buoy.z_m"
measure = "deviation"
relative = true
target = 0.05

[metrics.pitch]
column = "buoy.pitch_deg"
measure = "damage"
relative = true
"""


class Study(Folder):
    def words(self, text, *more):
        file = self.path / "study.toml"
        file.write_text(text)
        return [str(PROGRAM), "study", str(file), "--out", str(self.out), *more]

    def study(self, text=STUDY, *more):
        return subprocess.run(self.words(text, *more), capture_output=True, text=True, check=False, timeout=600)

    def ledgers(self):
        """By run: what it came to and when that was written."""
        return {str(p.parent.relative_to(self.out)): (json.loads(p.read_text()), p.stat().st_mtime_ns) for p in self.out.rglob("study_run.json")}

    def values(self, text, metric):
        done = self.study(text)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return [rung["errors"][metric]["value"] for rung in self.result()["rungs"]]

    def result(self):
        return json.loads((self.out / "study.json").read_text())

    def test_the_rotor_load_names_rung_cost_and_confidence_and_a_second_call_runs_nothing(self):
        done = self.study()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"answer: cheapest within 5 % of the deviation of buoy.z_m: 'base-step_0\.\d+'; costs .* confidence")
        result, first = self.result(), self.ledgers()
        self.assertEqual(len(first), 12)
        self.assertTrue((self.out / result["scene"]).exists())
        self.assertTrue((self.out / "study.html").exists())
        for rung in result["rungs"]:
            self.assertGreater(rung["cost"]["core_s"], 0.0)
            self.assertGreater(rung["cost"]["memory"], 1e7)
            self.assertIn("bodies", rung["cost"]["parts"])
            self.assertAlmostEqual(sum(rung["cost"]["parts"].values()) / rung["cost"]["core_s"], 1.0, delta=1e-9)
            self.assertEqual(rung["errors"]["pitch"]["replicas"], 4)
        again = self.study()
        self.assertEqual(again.returncode, 0)
        self.assertEqual(self.ledgers(), first)
        self.assertEqual(self.result(), result)
        changed = self.study(STUDY.replace("values = [0.1, 0.05, 0.025]", "values = [0.1, 0.05, 0.025, 0.0125]"))
        self.assertEqual(changed.returncode, 0)
        self.assertEqual({k: v for k, v in self.ledgers().items() if k in first}, first)

    def test_a_run_is_repeated_where_a_file_of_its_scene_changed(self):
        (self.path / "thrust.csv").write_text("time_s,thrust_N\n0,100\n10,100\n")
        text = f"""
[study]
scene = "{ROOT}/tests/extremes/buoy.toml"
set = ["aero.model=prescribed", 'aero.table="thrust.csv"', "rotor.body=buoy", "rotor.hub_m=[0,0,1]"]
[axes.step]
key = "time.step_s"
values = [0.02]
[metrics.surge]
column = "buoy.x_m"
measure = "last"
"""
        before = self.values(text, "surge")
        (self.path / "thrust.csv").write_text("time_s,thrust_N\n0,200\n10,200\n")
        for one, other in zip(before, self.values(text, "surge")):
            self.assertAlmostEqual(other / one, 2.0, delta=0.05)

    def test_a_run_is_repeated_where_the_state_that_it_starts_from_changed(self):
        scene, other = ROOT / "tests/extremes/buoy.toml", self.path / "other"
        text = f"""
[study]
scene = "{scene}"
set = ['start.file="start.h5"', "time.end_s=3.0"]
[axes.step]
key = "time.step_s"
values = [0.02]
[metrics.heave]
column = "buoy.z_m"
measure = "last"
"""
        for start in ("start.h5", "other/mark"):   # the file, or another one beside the checkpoints
            found = []
            for high in (0.1, 0.3):
                done = subprocess.run([str(PROGRAM), "run", str(scene), "--out", str(other), "--overwrite", "--quiet", "--no-report", "--set", "time.end_s=1.0", "--set",
                                       f"bodies.buoy.displacement_m=[0.0,0.0,{high}]"], capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                (self.path / "start.h5").write_bytes(max((other / "checkpoints").glob("*.h5")).read_bytes())
                (other / "mark").write_text("the same for both\n")
                found.append(self.values(text.replace("start.h5", start), "heave"))
            self.assertNotEqual(*found, start)

    def test_a_dry_run_runs_nothing(self):
        done = self.study(STUDY, "--dry-run")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("12 runs, 0 of them there already", done.stdout)
        self.assertIn("core-hours", done.stdout)
        self.assertFalse(self.out.exists())

    def test_what_is_wrong_is_found_before_anything_runs(self):
        for old, new, said in (('"buoy.z_m"', '"buoy.z_mm"', 'did you mean "buoy.z_m"'),
                               ("waves.components=40", "waves.component=40", "waves.component"),
                               ("values = [0.1, 0.05, 0.025]", "values = [0.1, 0.05, 0.025, -0.01]", "(in configuration base-step_-0.01/replica_1)"),
                               ('key = "time.step_s"', 'key = "time.steps_s"', "(in configuration base-step_0.1/replica_1)"),
                               ('variant = "base-step_0.025"', 'variant = "base-step_0.25"', "is no run of this study"),
                               ("[replicas]", '[axes.again]\nkey = "time.\\"step_s\\""\nvalues = [0.1, 0.05]\n[replicas]', 'sets time.step_s, as axes.step does: a key is on one axis alone'),
                               ('key = "waves.seed"\nvalues = [1, 2, 3, 4]', 'points = [{name = "a", set = ["time.step_s=0.2"]}]', "replicas.points: sets time.step_s, as axes.step does"),
                               ('column = "buoy.z_m"', 'from_s = 40.0\ncolumn = "buoy.z_m"', "metrics.heave.from_s = 40: must be before the end of base-step_0.1, 10 s"),
                               ("[metrics.pitch]", '[load_cases]\nfrom_s = 40.0\ncolumns = ["buoy.z_m"]\n[metrics.pitch]', "load_cases.from_s = 40: must be before the end")):
            done = self.study(STUDY.replace(old, new))
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(said, done.stdout + done.stderr)
            self.assertFalse(self.ledgers())

    def test_a_budget_that_no_run_is_within_is_refused_with_one_that_would_do(self):
        sweep = "".join(line + "\n" for line in STUDY.splitlines() if line not in ("[reference]", 'variant = "base-step_0.025"', "relative = true", "target = 0.05"))
        for more in ((), ("--dry-run",)):
            done = self.study(sweep.replace("repeats = 1", "repeats = 1\nbudget_core_h = 1e-9"), *more)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            needs = re.search(r"study.budget_core_h = 1e-09: is less than .* the cheapest, 'base-step_\S+', needs (\S+), all 12 need (\S+)", done.stderr)
            self.assertTrue(needs, done.stderr)
            self.assertLessEqual(float(needs[1]), 1.01 * float(needs[2]) / 12)
            self.assertFalse(self.ledgers())
        done = self.study(sweep.replace("repeats = 1", f"repeats = 1\nbudget_core_h = {2 * float(needs[1])}"), "--dry-run")  # forecasts scatter
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_a_reference_from_elsewhere_covers_the_time_that_is_compared(self):
        file = self.path / "elsewhere.csv"
        text = STUDY.replace('variant = "base-step_0.025"', f'history = "{file}"').replace(
            '"waves.components=40"]', '"waves.components=40", "time.end_s=60.0"]')

        def said(end_s, *replacements):
            file.write_text("time_s,buoy.z_m,buoy.pitch_deg\n" + "".join(f"{end_s * n / 100},{n % 3},{n % 2}\n" for n in range(101)))
            changed = text
            for old, new in replacements:
                changed = changed.replace(old, new)
            done = self.study(changed, "--dry-run")
            return done.returncode, done.stdout + done.stderr

        code, words = said(0.6)
        self.assertEqual(code, 2, words)
        self.assertIn(f"metrics.heave: the reference {file} covers 0 to 0.6 s, which is 1 % of the 0 to 60 s taken of base-step_0.1", words)
        self.assertEqual(words.count("metrics.pitch"), 1, words)
        self.assertEqual(said(56.0)[0], 2)
        self.assertEqual(said(57.5)[0], 0)
        self.assertEqual(said(30.0, ('column = "buoy.', 'until_s = 30.0\ncolumn = "buoy.'))[0], 0)
        code, words = said(60.0, ('column = "buoy.z_m"', 'from_s = 50.0\nuntil_s = 200.0\ncolumn = "buoy.z_m"'))
        self.assertEqual(code, 0, words)

    def test_a_target_out_of_reach_is_a_sentence_and_exit_code_6(self):
        done = self.study(STUDY.replace("target = 0.05", "target = 1e-9"))
        self.assertEqual(done.returncode, 6, done.stdout + done.stderr)
        self.assertIn("answer: nothing is known to be within", done.stdout)

    def test_a_run_that_fails_is_kept_with_its_reason(self):
        """Here: stopped by its own limit on wall time."""
        text = STUDY.replace("[replicas]", '[variants.base]\n[variants.stopped]\nalone = true\nset = ["runtime.wall_limit_s=1e-6"]\n\n[replicas]')
        done = self.study(text)
        self.assertIn(done.returncode, (0, 6), done.stdout + done.stderr)
        self.assertIn("wall", " ".join(self.result()["not_tested"] + [done.stdout]))

    def test_a_run_that_is_killed_is_begun_once_more_and_then_told_as_failed(self):
        text = STUDY.replace("[replicas]", '[variants.base]\n[variants.killed]\nalone = true\nset = ["time.end_s=100000.0"]\n\n[replicas]')
        process = subprocess.Popen(self.words(text), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        killed = set()
        while process.poll() is None and all(entry.get("exit_code") != -signal.SIGKILL for entry, _ in self.ledgers().values()):
            for name, (entry, _) in self.ledgers().items():
                if name.startswith("killed") and entry["state"] == "under_way" and entry.get("pid", 0) not in killed | {0}:
                    os.kill(entry["pid"], signal.SIGKILL)
                    killed.add(entry["pid"])
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)  # the other long runs need not end
        said, _ = process.communicate(timeout=120)
        self.assertIn("killed by signal 9: once more", said)
        self.assertIn("killed by signal 9, twice", [entry.get("reason") for entry, _ in self.ledgers().values()])

    def test_a_signal_stops_the_study_and_the_same_command_goes_on(self):
        process = subprocess.Popen(self.words(STUDY), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        while len([1 for entry, _ in self.ledgers().values() if entry["state"] == "finished"]) < 3 and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        said, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 5, said)
        self.assertIn("the same command goes on", said)
        before = {k: v for k, v in self.ledgers().items() if v[0]["state"] == "finished"}
        self.assertLess(len(before), 12)
        self.assertEqual(self.study().returncode, 0)
        self.assertEqual({k: v for k, v in self.ledgers().items() if k in before}, before)

    def test_killed_at_ten_random_moments_no_run_is_done_twice_and_the_answer_is_the_same(self):
        text = STUDY.replace('"waves.components=40"]', '"waves.components=40", "time.end_s=2000.0"]')  # runs long enough to be met
        whole = self.study(text)
        self.assertEqual(whole.returncode, 0, whole.stdout)
        values = {r["name"]: {m: e["value"] for m, e in r["errors"].items()} for r in self.result()["rungs"]}
        answer, self.out = self.result()["answer"], self.path / "killed"
        dice = random.Random(7)
        kept, met = {}, 0
        for _ in range(10):
            process = subprocess.Popen(self.words(text), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            begun = len(list(self.out.rglob("history.csv")))
            while process.poll() is None and len(list(self.out.rglob("history.csv"))) <= begun:
                time.sleep(0.01)  # until the next run is under way, whatever the clock
            time.sleep(dice.uniform(0.0, 0.3))
            met += process.poll() is None
            process.kill()
            process.wait()
            time.sleep(0.5)  # the run under way ends by itself once its study is gone
            now = {k: v for k, v in self.ledgers().items() if v[0]["state"] == "finished"}
            self.assertEqual({k: v for k, v in now.items() if k in kept}, kept)
            kept = now
        self.assertGreaterEqual(met, 8)
        self.assertEqual(self.study(text).returncode, 0)
        self.assertEqual({k: v for k, v in self.ledgers().items() if k in kept}, kept)
        # What is cheapest among rungs that cost nearly the same is the clock's; what each of them is off by is not.
        self.assertIsNotNone(answer)
        self.assertIsNotNone(self.result()["answer"])
        self.assertEqual({r["name"]: {m: e["value"] for m, e in r["errors"].items()} for r in self.result()["rungs"]}, values)

    def test_columns_of_the_air_are_known_before_it_runs(self):
        text = f"""
[study]
scene = "{ROOT}/inputs/tutorials/wing_section.toml"
[axes.drop]
key = "aero.flow.drop"
values = [1e-2, 1e-3]
[metrics.lift]
column = "flow.lift_coefficientt"
measure = "last"
"""
        done = self.study(text, "--dry-run")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn('did you mean "flow.lift_coefficient"', done.stdout + done.stderr)
        self.assertEqual(self.study(text.replace("coefficientt", "coefficient"), "--dry-run").returncode, 0)



class Nightly(Study):
    """Others keep the computer busy."""

    def test_on_a_busy_computer_nineteen_of_twenty_repeats_name_the_same_rung(self):
        busy = "import random, time\nwhile True:\n    t = time.time() + 2 * random.random()\n    while time.time() < t: sum(range(10000))\n    time.sleep(2 * random.random())"
        others = [subprocess.Popen([sys.executable, "-c", busy]) for _ in range(os.cpu_count())]
        try:
            answers = []
            for n in range(20):
                done = subprocess.run([str(PROGRAM), "study", ROOT / "inputs/studies/case2_time_step.toml", "--out", self.path / f"out_{n}"], capture_output=True, text=True,
                                      check=False, timeout=600)
                self.assertEqual(done.returncode, 0, done.stderr[-2000:])
                answers.append(json.loads((self.path / f"out_{n}/study.json").read_text())["answer"])
        finally:
            for other in others:
                other.kill()
                other.wait()
        self.assertGreaterEqual(max(answers.count(a) for a in answers), 19, answers)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    unittest.main(verbosity=2)
