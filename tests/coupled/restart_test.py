"""Restarts as a user meets them: what may differ from the run before and what is refused by name, a history that lost rows, folders where no run
came as far as a checkpoint, two runs in one folder. Usage: restart_test.py SPINDRIFT [CLASS...]"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

from running import Folder, PROGRAM, ROOT, rows, spindrift

CASE3 = ROOT / "inputs/leble_barakos/case3_engineering.toml"


class Runs(Folder):
    def run_case(self, *more, scene=CASE3, code=0, out=None):
        done = spindrift("run", scene, "--out", out or self.out, "--no-report", "--quiet", *more)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def files(self):
        return {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}

    def history(self, out=None):
        return ((out or self.out) / "history.csv").read_text()


class Identity(Runs):
    # Of every kind of section; the key that must be named where it is not the one that is set.
    CHANGES = ["wind.speed_m_s=20.0", "wind.direction_deg=5.0", "environment.water_density_kg_m3=1000.0", "environment.water_depth_m=30.0",
               "environment.gravity_m_s2=9.8", "environment.air_density_kg_m3=1.2", "bodies.platform.mass_kg=4.3e6", "bodies.rotor.inertia_kg_m2=[1.6e8, 8e7, 8e7]",
               "joints.bearing.rotation.speed_rpm=9.0", "moorings.line_downwind.axial_stiffness_N=5e8", "moorings.line_upwind_left.anchor_m=[-81.0, 140.0, -20.6]",
               "sea.drag_coefficient=0.9", "sea.added_mass_coefficient=0.9", "waves.height_m=2.0", "waves.model='airy'", "waves.ramp_s=5.0",
               "time.integrator='symplectic'", "rotor.blade_pitch_deg=1.0", "start.ramp_s=1.0"]

    def test_every_changed_key_is_refused_by_name_with_both_values_and_nothing_is_written(self):
        self.run_case("--until", 1.0)
        before = self.files()
        for change in self.CHANGES:
            key = change.split("=", 1)[0]
            with self.subTest(key=key):
                said = self.run_case("--restart", "--until", 1.1, "--set", change, code=2)
                line = [line for line in said.splitlines() if line.strip().startswith(key)]
                self.assertEqual(len(line), 1, said)
                self.assertIn("was ", line[0])
                self.assertIn(", is ", line[0])
                self.assertIn("--allow-change", said)
                self.assertEqual(self.files(), before)

    def test_windows_of_another_length_are_no_restart_even_where_allowed(self):
        self.run_case("--until", 1.0)
        before = self.history()
        said = self.run_case("--restart", "--until", 2.0, "--set", "time.window_s=0.2", "--allow-change", "time.window_s", code=2)
        self.assertIn("its windows are 0.1 s long, this scene's 0.2 s: a restart keeps time.window_s", said)
        self.assertEqual(self.history(), before)

    def test_a_changed_file_and_another_scene_are_refused_and_what_is_allowed_goes_on(self):
        for name in ("leble_barakos", "turbines"):
            shutil.copytree(ROOT / "inputs" / name, self.path / name)
        scene, table = self.path / "leble_barakos/case3_engineering.toml", self.path / "turbines/dtu_10mw_operation.csv"
        self.run_case("--until", 1.0, scene=scene)
        self.run_case("--restart", "--until", 1.1, scene=CASE3)  # the same scene and the same files elsewhere
        self.run_case("--restart", "--until", 1.2, scene=scene)  # and back
        text = table.read_text()
        table.write_text(text + "# a remark\n")
        said = self.run_case("--restart", "--until", 1.3, scene=scene, code=2)
        self.assertIn(f"{table}: was {len(text)} bytes", said)
        self.run_case("--restart", "--until", 1.3, "--allow-change", table, scene=scene)
        said = self.run_case("--restart", "--until", 1.4, scene=ROOT / "inputs/leble_barakos/case1_engineering.toml", code=2)
        self.assertIn("aero.model", said)
        self.assertIn("waves", said)
        said = self.run_case("--restart", "--until", 1.4, "--set", "wind.speed_m_s=12.0", "--set", "waves.height_m=1.9", "--allow-change", "wind", scene=scene, code=2)
        self.assertIn("waves.height_m", said)
        self.assertNotIn("wind.speed_m_s", said)
        self.run_case("--restart", "--until", 1.4, "--set", "wind.speed_m_s=12.0", "--allow-change", "wind.speed_m_s", scene=scene)
        self.run_case("--restart", "--until", 1.5, "--set", "wind.speed_m_s=12.0", scene=scene)  # it is that run now

    def test_a_changed_base_of_a_file_is_refused_by_name(self):
        for name in ("leble_barakos", "turbines"):
            shutil.copytree(ROOT / "inputs" / name, self.path / name)
        scene, base = self.path / "leble_barakos/case3_engineering.toml", self.path / "turbines/dtu_10mw.toml"
        (self.path / "turbines/mine.toml").write_text('base = "dtu_10mw.toml"\n')
        mine = ("--set", f'rotor.turbine="{self.path}/turbines/mine.toml"')
        self.run_case("--until", 1.0, *mine, scene=scene)
        base.write_text(base.read_text() + "# a remark\n")
        self.assertIn(f"{base}: was", self.run_case("--restart", "--until", 1.1, *mine, scene=scene, code=2))
        self.run_case("--restart", "--until", 1.1, "--allow-change", base, *mine, scene=scene)

    def test_end_output_and_checkpoints_may_change(self):
        self.run_case("--until", 1.0)
        self.run_case("--restart", "--set", "time.end_s=2.0", "--set", "output.means_over_s=1.0", "--set", "checkpoint.keep=5", "--set", "runtime.wall_limit_s=100.0")
        self.assertEqual(json.loads((self.out / "summary.json").read_text())["exit_code"], 0)


class History(Runs):
    def test_rows_that_are_missing_are_refused_by_name_and_accepted_when_told(self):
        self.run_case("--until", 2.0)
        whole = self.history()
        lines = whole.splitlines(keepends=True)
        changed = lines[6][:-2] + ("1" if lines[6][-2] != "1" else "2") + "\n"
        for text in ("".join(lines[:-3]), "".join(lines[:5] + lines[7:]), "".join(lines[:6] + [changed] + lines[7:])):
            (self.out / "history.csv").write_text(text)
            said = self.run_case("--restart", "--until", 2.5, code=2)
            self.assertIn("history.csv", said)
            self.assertIn("--allow-change history.csv", said)
            self.assertEqual(self.history(), text)
        (self.out / "history.csv").write_text("".join(lines[:5] + lines[7:]))
        self.run_case("--restart", "--until", 2.5, "--allow-change", "history.csv")
        self.run_case("--restart", "--until", 3.0)  # the gap is known now
        self.assertEqual(len(self.history().splitlines()), 1 + 31 - 2)


    def test_a_stop_between_two_rows_leaves_no_trace_in_the_run_that_goes_on(self):
        every = ["--set", "output.history_every=10", "--set", "output.openfast=binary"]
        once = self.path / "once"
        self.run_case("--until", 3.0, *every, out=once)
        self.run_case("--until", 1.5, *every)
        stopped = self.history()
        self.assertEqual([float(line.split(",")[0]) for line in stopped.splitlines()[1:]], [0.0, 1.0, 1.5])
        self.run_case("--restart", "--until", 1.5, *every)  # nothing is left to do
        self.assertEqual(self.history(), stopped)
        self.run_case("--restart", "--until", 1.7, *every)
        self.run_case("--restart", "--until", 3.0, *every)
        for name in ("history.csv", "history.outb"):
            self.assertEqual((self.out / name).read_bytes(), (once / name).read_bytes())
        mine, theirs = (json.loads((folder / "summary.json").read_text()) for folder in (self.out, once))
        self.assertEqual(mine["statistics"], theirs["statistics"])

    def test_the_file_for_openfast_that_cannot_be_written_is_in_the_summary(self):
        self.run_case("--until", 0.1)
        (self.out / "history.outb/in_the_way").mkdir(parents=True)
        self.run_case("--restart", "--until", 0.2, "--set", "output.openfast=binary", code=4)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(summary["exit_code"], 4)
        self.assertIn("history.outb", summary["exit_reason"])
        self.assertIn("statistics", summary)


class Folders(Runs):
    def test_one_command_for_the_first_and_for_every_further_job(self):
        other = self.path / "once"
        self.run_case("--until", 1.0, out=other)
        said = self.run_case("--restart", "--until", 0.5)
        self.assertIn("BEGINS ANEW", said)
        self.run_case("--restart", "--until", 1.0)
        self.assertEqual(self.history(), self.history(other))

    def test_the_second_run_in_a_folder_ends_with_2_whatever_it_asks_for(self):
        long_run = ["--set", "time.end_s=200000.0", "--set", "output.history_every=1000"]
        first = subprocess.Popen([PROGRAM, "run", CASE3, "--out", self.out, "--no-report", "--quiet", *long_run], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        try:
            deadline = time.time() + 60
            while not (self.out / "history.csv").exists() and time.time() < deadline:
                time.sleep(0.02)
            for word in ("--restart", "--overwrite", "--quiet"):
                said = self.run_case(*[word] if word != "--quiet" else [], *long_run, code=2)
                self.assertIn(f"process {first.pid} on" if word != "--quiet" else "not empty", said)
            self.assertTrue((self.out / "history.csv").exists())
        finally:
            first.send_signal(signal.SIGTERM)
            self.assertEqual(first.wait(60), 5)
        self.run_case("--restart", "--until", json.loads((self.out / "summary.json").read_text())["time"]["end_s"] + 100.0, *long_run)

    def test_a_signal_before_the_run_has_begun_ends_it_with_5_and_says_so(self):
        started = subprocess.Popen([PROGRAM, "run", CASE3, "--out", self.out, "--no-report"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        term = 1 << (signal.SIGTERM - 1)
        status = lambda: dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{started.pid}/status").read_text().splitlines())
        deadline = time.time() + 60
        while not int((now := status())["SigCgt"], 16) & term and time.time() < deadline:
            pass
        self.assertEqual(now["Threads"].strip(), "1")  # MPI, which has threads of its own, was not there yet
        started.send_signal(signal.SIGTERM)
        said = started.communicate(timeout=60)[0]
        self.assertEqual(started.returncode, 5, said)
        self.assertIn("stopped on request (SIGTERM), before the ", said)

    def test_a_checkpoint_that_may_not_be_read_or_is_of_another_version_stays_where_it_is(self):
        self.run_case("--until", 1.0)
        newest = max((self.out / "checkpoints").glob("*.h5"))
        if os.geteuid() != 0:  # root may read everything
            newest.chmod(0)
            self.assertIn("right to read", self.run_case("--restart", "--until", 1.1, code=2))
            newest.chmod(0o644)
        self.run_case("--restart", "--until", 1.1)
        newest = max((self.out / "checkpoints").glob("*.h5"))
        newest.write_bytes(newest.read_bytes()[:5000])
        self.run_case("--restart", "--until", 1.2)
        self.assertTrue(newest.with_name(newest.name + ".damaged").exists())

    def test_checkpoints_that_cannot_be_listed_are_not_none(self):
        self.run_case("--until", 1.0)
        (self.out / "checkpoints").rename(self.path / "elsewhere")
        (self.out / "checkpoints").write_text("")  # no folder, so that root meets an error too
        before = self.files()
        self.assertIn("checkpoints", self.run_case("--restart", "--until", 1.1, code=4))
        self.assertEqual(self.files(), before)
        (self.out / "checkpoints").unlink()
        (self.path / "elsewhere").rename(self.out / "checkpoints")
        self.run_case("--restart", "--until", 1.1)

    def test_where_no_checkpoint_is_whole_nothing_is_written(self):
        self.run_case("--until", 1.0)
        for checkpoint in (self.out / "checkpoints").glob("*.h5"):
            checkpoint.write_bytes(checkpoint.read_bytes()[:3000])
        scene, rows = (self.out / "scene.toml").read_text(), self.history()
        said = self.run_case("--restart", "--until", 1.1, "--set", "wind.speed_m_s=20.0", code=2)
        self.assertIn("damaged checkpoints only", said)
        self.assertEqual([(self.out / "scene.toml").read_text(), self.history()], [scene, rows])


class Summaries(Runs):
    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def killed(self, *more):
        run = subprocess.Popen([PROGRAM, "run", CASE3, "--out", self.out, "--no-report", "--quiet", "--set", "time.end_s=200000.0", "--set", "output.history_every=10", *more],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        rows = (self.out / "history.csv").stat().st_size if (self.out / "history.csv").exists() else 0
        deadline = time.time() + 60
        while (not (self.out / "history.csv").exists() or (self.out / "history.csv").stat().st_size <= rows) and time.time() < deadline:
            time.sleep(0.02)
        run.kill()
        run.wait()

    def test_a_run_that_was_killed_has_no_exit_code_and_not_that_of_the_run_before(self):
        self.killed()
        self.assertIsNone(self.summary()["exit_code"])
        self.assertIn("killed", self.summary()["exit_reason"])
        self.assertEqual(self.summary()["scene"], str(CASE3))
        end = ["--set", "time.end_s=200000.0", "--set", "output.history_every=10"]
        self.run_case("--overwrite", "--until", 1.0, *end)
        self.assertEqual(self.summary()["exit_code"], 0)
        self.killed("--restart")
        self.assertIsNone(self.summary()["exit_code"])
        report = subprocess.run([PROGRAM, "report", self.out], capture_output=True, text=True)
        self.assertEqual(report.returncode, 0, report.stderr)

    def test_a_restart_that_is_refused_keeps_the_summary_and_one_without_work_says_so(self):
        self.run_case("--until", 1.0)
        before = self.summary()
        self.run_case("--restart", "--until", 1.1, "--set", "wind.speed_m_s=20.0", code=2)
        self.assertEqual(self.summary(), before)
        self.run_case("--restart", "--until", 0.5)
        self.assertIn("nothing was left to do", self.summary()["exit_reason"])

    def test_a_state_of_other_models_is_refused_though_the_change_is_allowed(self):
        for n, (before, after) in enumerate((("oye", "none"), ("none", "oye"))):
            out = self.path / f"inflow_{n}"
            self.run_case("--until", 0.5, "--set", f"aero.dynamic_inflow={before}", out=out)
            said = self.run_case("--restart", "--set", f"aero.dynamic_inflow={after}", "--allow-change", "aero.dynamic_inflow", out=out, code=2)
            self.assertIn("its bodies, joints, loads and their memories are not those of this scene", said)

    def test_a_scheme_with_other_options_begins_anew(self):
        strong = ["--set", "coupling.scheme=iqn_ils", "--set", "time.end_s=1.0", "--set", "start.equilibrium=false"]
        self.run_case("--until", 0.5, *strong)
        for n, option in enumerate(("reuse_windows=2", "samples=2", "composition=parallel", "predictor_order=0")):
            key = "coupling." + option.split("=")[0]
            on = self.path / f"on_{n}"
            shutil.copytree(self.out, on)
            said = self.run_case("--restart", *strong, "--set", "coupling." + option, "--allow-change", key, out=on)
            self.assertIn("the coupling scheme begins anew", said)
            self.run_case(*strong, "--set", "coupling." + option, "--set", f"start.file={self.out}/scene.toml", out=self.path / f"from_{n}")
            self.assertEqual([row["rotor.thrust_N"] for row in rows(on / "history.csv")][6:], [row["rotor.thrust_N"] for row in rows(self.path / f"from_{n}/history.csv")][1:], option)

    def test_loads_that_begin_from_nothing_are_agreed_on(self):
        for scheme in ("relaxation", "iqn_ils"):
            out = self.path / scheme
            self.run_case("--until", 0.2, "--set", f"coupling.scheme={scheme}", "--set", "start.ramp_s=10.0", out=out)
            self.assertLessEqual(rows(out / "history.csv")[1]["coupling.evaluations"], 25)

    def test_a_recording_is_not_emptied_by_a_run_that_is_refused(self):
        self.run_case("--until", 0.2)
        recording = self.path / "windows.jsonl"
        recording.write_text("of another run\n")
        self.run_case("--record-graph", recording, code=2)
        self.assertEqual(recording.read_text(), "of another run\n")

    def test_a_change_that_is_allowed_is_one_of_the_scene(self):
        self.run_case("--until", 1.0)
        said = self.run_case("--restart", "--until", 1.1, "--set", "wind.speed_m_s=12.0", "--allow-change", "wind.sped_m_s", code=2)
        self.assertIn("wind.sped_m_s", said)
        self.run_case("--restart", "--until", 1.1, "--set", "wind.speed_m_s=12.0", "--allow-change", "wind.speed_m_s")
        self.run_case("--restart", "--until", 1.2, "--set", "wind.speed_m_s=12.0", "--allow-change", "wind")


class Memory(Runs):
    """Lines, wake and blades that carry a state of their own."""
    SCENE = ROOT / "inputs/validation/oc3_heave_decay/oc3_heave_decay.toml"
    MORE = f"""
[waves]
model = "airy"
height_m = 3.0
period_s = 9.0

[wind]
speed_m_s = 14.0

[aero]
model = "bem"
dynamic_inflow = "oye"
dynamic_stall = "oye"

[rotor]
body = "spar"
turbine = "{ROOT}/inputs/turbines/dtu_10mw.toml"
hub_m = [-7.0, 0.0, 119.0]
speed_rpm = 9.0
"""

    def test_a_run_goes_on_with_the_same_bits_and_runs_of_any_threads_have_them(self):
        self.goes_on_with_the_same_bits(self.MORE)

    def test_a_wake_of_filaments_goes_on_with_the_same_bits(self):
        self.goes_on_with_the_same_bits(self.MORE.replace('dynamic_inflow = "oye"', 'dynamic_inflow = "free_vortex"\nwake_turns = 3.0\nwake_step_deg = 20.0'))

    def goes_on_with_the_same_bits(self, more):
        text = self.SCENE.read_text().replace('model = "catenary"', 'model = "lumped_mass"\nmass_kg_m = 77.7066\ndiameter_m = 0.09')
        text = "\n".join(line for line in text.splitlines() if not line.startswith("weight_N_m"))
        scene = self.path / "scene.toml"
        scene.write_text(text + more)
        whole = self.path / "whole"
        self.run_case("--until", 6.0, scene=scene, out=whole)
        with unittest.mock.patch.dict(os.environ, {"OMP_NUM_THREADS": "3"}):
            self.run_case("--until", 2.5, scene=scene)
            self.run_case("--restart", "--until", 6.0, scene=scene)
        self.assertEqual(self.history(), self.history(whole))
        names = self.history().splitlines()[0].split(",")
        self.assertIn("line_1.anchor_tension_N", names)
        self.assertNotIn("nan", self.history())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
