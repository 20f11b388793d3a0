"""The coupled system as a user runs it: a blade-resolved rotor on a floating platform, with an engineering sea and with one of particles.
Same bits by threads, ranks, placements and restarts; starts from saved fluids; what is refused. Usage: coupled_system_test.py SPINDRIFT [CLASS...]"""
import functools
import json
import os
import subprocess
import time
import unittest

import numpy as np

import field_files
from running import AIR_OF_BLADES, DTU_IN_WIND, PROGRAM, ROOT, Runs, held_up, rows, trace_events

CASES = ROOT / "inputs/leble_barakos"

# Three pseudo-steps per window: what is tested is the exchange, not the flow.
AIR = DTU_IN_WIND + AIR_OF_BLADES.replace('"all"', '"one"').replace('limiter = "none"\n', "") + """
krylov_steps = 6
cfl_max = 20.0
max_pseudo_steps = 3
drop = 0.0
[start]
air_steps = 10
"""
ENGINEERING = """
base = "%s/platform.toml"
[time]
end_s = 0.6
window_s = 0.1
step_s = 0.05
[sea]
model = "hydrostatic"
""" % CASES + AIR
# The same rotor without bodies, in the same air.
ALONE = """
[time]
end_s = 20.0
window_s = 1.0
""" + AIR.replace("[rotor]", "[rotor]\nhub_m = [0.0, 0.0, 119.0]\naxis = [1.0, 0.0, 0.0]\nspeed_rpm = 8.8").replace('time = "bdf2"', 'time = "steady"').replace(
    "max_pseudo_steps = 3\n", "load_change = 0.0\n").replace("[start]\nair_steps = 10\n", "")
PARTICLES = """
base = "%s/platform.toml"
[time]
end_s = 0.4
window_s = 0.1
integrator = "symplectic"
[sea]
model = "sph"
[sea.particles]
spacing_m = 4.0
[sea.tank]
x_m = [-60.0, 80.0]
y_m = [-70.0, 70.0]
top_m = 9.4
[sea.initial]
settle_s = 0.1
""" % CASES + AIR


class System(Runs):
    SPLIT = ["coupling.placement='split'"]

    def spindrift(self, text, name, *arguments, settings=(), threads=1, ranks=1, code=0):
        scene = self.path / "scene.toml"
        scene.write_text(text)
        given = [word for s in settings for word in ("--set", s)]
        start = [ROOT / "ci/mpirun", str(ranks)] if ranks > 1 else []
        return self.ended([*start, PROGRAM, "run", scene, "--quiet", "--no-report", "--out", self.path / name, *map(str, arguments), *given], threads,
                          code)

    def ended(self, command, threads, code, run=functools.partial(subprocess.run, capture_output=True, timeout=900)):
        done = run(command, text=True, env={**os.environ, "OMP_NUM_THREADS": str(threads)})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def in_sections(self, name, *sections, code=0):
        """Program sections of one mpirun: (ranks, arguments) each, of the scene in the folder."""
        words = [ROOT / "ci/mpirun"]
        for ranks, arguments in sections:
            words += [*([":", "-n"] if len(words) > 1 else []), str(ranks), PROGRAM, "run", self.path / "scene.toml", "--quiet", "--no-report",
                      "--out", self.path / name, *map(str, arguments)]
        return self.ended(words, 1, code)

    def check_bits(self, text, settings, until):
        self.spindrift(text, "whole", settings=settings, threads=1)
        self.spindrift(text, "threads", settings=settings, threads=3)
        self.assertEqual(self.text("whole"), self.text("threads"))
        self.spindrift(text, "ranks", settings=settings, ranks=2)
        self.assertEqual(self.text("whole"), self.text("ranks"))
        self.spindrift(text, "parts", "--until", until, settings=settings, threads=2)
        self.spindrift(text, "parts", "--restart", settings=settings, threads=1)
        self.assertEqual(self.text("whole"), self.text("parts"))


class Profile(System):
    SETTINGS = ["time.end_s=0.25", "time.window_s=0.05"]

    def profiled(self, ranks, threads=1, **more):
        (self.path / "scene.toml").write_text(PARTICLES)
        given = [word for s in self.SETTINGS for word in ("--set", s)]
        start = [ROOT / "ci/mpirun", str(ranks)] if ranks > 1 else []
        begin = time.monotonic()
        said = self.ended([*start, PROGRAM, "profile", self.path / "scene.toml", "--windows", "3", "--out", self.path / "out", *given], threads, 0, **more)
        profile = json.loads((self.path / "out/profile.json").read_text())
        self.check_command(profile, time.monotonic() - begin)
        return said, profile

    def check_figures(self, modes, threads):
        for mode in modes:
            self.assertEqual(mode["windows"], 3)
            # Modules by the records of their tasks, the rest by the sums of threads: nothing is counted twice or forgotten.
            self.assertAlmostEqual(mode["accounted"], 1.0, delta=0.01, msg=mode["placement"])
            self.assertAlmostEqual(mode["efficiency"], mode["load_balance"] * mode["communication_efficiency"], delta=1e-9)
            busy = sum(s for part, s in mode["parts_core_s"].items() if part not in ("waiting", "messages", "runtime", "exchange"))
            # Of the exchange, what is tasks counts as busy, what lies between the graphs does not.
            cores_s = mode["ranks"] * threads * mode["wall_s"]
            self.assertGreaterEqual(mode["efficiency"], busy / cores_s - 1e-6)
            self.assertLessEqual(mode["efficiency"], (busy + mode["parts_core_s"]["exchange"]) / cores_s + 1e-6)
            for part, seconds in mode["parts_core_s"].items():
                self.assertGreaterEqual(seconds, 0.0, part)
            # Of the whole run, from reading the scene to its last record: phases by one clock, the whole by another.
            parts = mode["run_parts_core_s"]
            self.assertEqual(list(parts), sorted(["start-up", "settling", "first windows", "windows", "output", "sums and records"]))
            cores = mode["ranks"] * threads
            self.assertAlmostEqual(sum(parts.values()) / mode["run_core_s"], 1.0, delta=0.01, msg=parts)
            self.assertAlmostEqual(mode["run_core_s"] / (mode["run_s"] * cores), 1.0, delta=0.1)  # of all ranks; run_s is that of the first
            self.assertAlmostEqual(parts["windows"], 3 * cores_s, delta=0.05 * parts["windows"])
            for part in ("start-up", "first windows", "windows", "output", "sums and records"):
                self.assertGreater(parts[part], 0.0, part)
            if mode["placement"] != "sea alone":
                self.assertGreater(parts["settling"], 1e-3 * mode["run_core_s"])

    def check_command(self, profile, took_s):
        """The table's runs and what is about them are all of the command but the start of the program itself."""
        command = profile["command"]
        self.assertAlmostEqual(sum(mode["run_s"] for mode in profile["modes"]), command["runs_s"], delta=1e-9)
        self.assertAlmostEqual((command["scene_s"] + command["runs_s"] + command["pictures_s"]) / command["wall_s"], 1.0, delta=0.01)
        self.assertLess(command["wall_s"], took_s)
        self.assertGreater(command["wall_s"], 0.6 * took_s)

    def test_air_sea_and_both_are_set_side_by_side(self):
        said, profile = self.profiled(1, threads=2)
        modes = {mode["placement"]: mode for mode in profile["modes"]}
        self.assertEqual(list(modes), ["air alone", "sea alone", "in turns", "shared"])
        self.check_figures(modes.values(), 2)
        self.assertNotIn("sea", modes["air alone"]["parts_core_s"])
        self.assertNotIn("aero", modes["sea alone"]["parts_core_s"])
        for name in ("in turns", "shared"):
            self.assertGreater(modes[name]["parts_core_s"]["sea"], 0.0)
            self.assertGreater(modes[name]["parts_core_s"]["aero"], 0.0)
        self.assertIn("waiting [core-ms]", said)
        self.assertNotIn("idle", said)
        self.assertIn("Overlap: ", said)
        self.assertIn("Split needs two ranks", said)
        self.assertTrue((self.path / "out/profile.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn("Profile of scene", (self.path / "out/profile.html").read_text())

    def test_on_one_core_there_is_no_gain_by_overlap_and_a_busy_computer_is_told(self):
        said, profile = self.profiled(1, run=held_up)
        self.assertIn("others used the computer: this run had ", said)
        self.assertIn("One core: air and sea alone take", said)
        self.assertNotIn("a gain of", said)
        self.assertLess(min(mode["processor_share"] for mode in profile["modes"]), 0.9)

    def test_parts_of_a_run_sum_to_wall_times_cores(self):
        for ranks, threads in ((1, 2), (2, 1)):
            begin = time.monotonic()
            self.spindrift(PARTICLES, f"on_{ranks}", settings=self.SETTINGS, ranks=ranks, threads=threads)
            took_s = time.monotonic() - begin
            summary = json.loads((self.path / f"on_{ranks}/summary.json").read_text())
            parts = {part["name"]: part["core_seconds"] for part in summary["parts"]}
            self.assertAlmostEqual(sum(parts.values()) / summary["core_seconds"], 1.0, delta=0.01, msg=parts)
            self.assertAlmostEqual(summary["core_seconds"], 2 * summary["wall_seconds"], delta=1e-9)
            self.assertLess(summary["wall_seconds"], took_s)
            for part in ("aero", "sea", "bodies", "output", "waiting", "runtime"):
                self.assertGreater(parts[part], 0.0, part)
            self.assertLess(parts["runtime"], 0.3 * summary["core_seconds"])  # the remainder: nothing large hides in it

    def test_with_two_ranks_there_is_a_split(self):
        _, profile = self.profiled(2)
        modes = {mode["placement"]: mode for mode in profile["modes"]}
        self.assertEqual(list(modes)[-1], "split")
        self.assertEqual(modes["split"]["air_ranks"], 1)
        self.check_figures(modes.values(), 1)

    def test_a_scene_without_a_sea_of_particles_is_refused(self):
        (self.path / "scene.toml").write_text(ENGINEERING)
        said = self.ended([PROGRAM, "profile", self.path / "scene.toml", "--out", self.path / "out"], 1, 2)
        self.assertIn("sea of particles", said)
        (self.path / "scene.toml").write_text(PARTICLES)
        said = self.ended([PROGRAM, "profile", self.path / "scene.toml", "--windows", "3", "--out", self.path / "out"], 1, 2)
        self.assertIn("beyond time.end_s", said)
        self.assertFalse((self.path / "out").exists())


class Junctions(System):
    BRIDLES = f"""
base = "{ROOT}/inputs/tutorials/spar_on_bridles.toml"
[time]
end_s = 4.0
[sea]
current_m_s = [0.5, 0.0, 0.0]
[junctions.crow_1]
mass_kg = 3000.0
volume_m3 = 0.4
drag_area_m2 = 2.0
"""

    def test_lines_that_meet_have_the_same_bits_on_threads_and_ranks_and_after_a_restart(self):
        self.check_bits(self.BRIDLES, [], 2.0)
        rows = self.rows("whole")
        self.assertNotEqual(rows[0]["crow_1.at_x_m"], rows[-1]["crow_1.at_x_m"])

    def test_check_says_where_junctions_rest_and_refuses_malformed_ones(self):
        (self.path / "scene.toml").write_text(self.BRIDLES)
        said = self.ended([PROGRAM, "check", self.path / "scene.toml"], 1, 0)
        self.assertIn("9 lines (lumped_mass), 3 junctions (crow_1, crow_2, crow_3)", said)
        self.assertRegex(said, r"crow_1 +x [+]\d+\.\d+  y")
        for setting, word in (("junctions.crow_1.mass_kg=-1.0", "junctions.crow_1.mass_kg"),
                              ("junctions.crow_4.position_m=[0.0, 0.0, -50.0]", "junctions.crow_4: is named by no end of a line"),
                              ("moorings.line_1.body='crow_9'", 'names body "crow_9"'),
                              ("junctions.spar.position_m=[0.0, 0.0, -50.0]", '"spar" is the name of another'),
                              ("moorings.leg_1a.anchor_m=[0.0, 0.0, 0.0]", "must be left out")):
            with self.subTest(setting):
                self.assertIn(word, self.ended([PROGRAM, "check", self.path / "scene.toml", "--set", setting], 1, 2))


class SystemRun(System):
    def test_an_engineering_sea_gives_the_same_bits_however_it_is_run_and_loads_meet_the_bodies(self):
        self.check_bits(ENGINEERING, [], 0.3)
        rows = self.rows("whole")
        self.assertEqual(len(rows), 7)
        self.assertGreater(rows[0]["rotor.thrust_N"], 3e5)
        self.assertGreater(rows[-1]["rotor.hub_vx_m_s"], 0.0)
        for row in rows:  # the force on the body that turns is the rotor's load, along an axis that has turned by less than a degree
            force = sum(row[f"rotor.rotor.f{axis}_N"] ** 2 for axis in "xyz") ** 0.5
            self.assertAlmostEqual(force / row["rotor.thrust_N"], 1.0, delta=1e-9)
            self.assertGreater(row["rotor.rotor.fx_N"], 0.999 * force)

    def test_with_multigrid_the_same_bits_over_threads_and_reruns(self):
        settings = ["time.end_s=0.3", "aero.flow.preconditioner='coarse'", "aero.flow.direct_groups=0"]
        self.spindrift(ENGINEERING, "once", settings=settings)
        self.spindrift(ENGINEERING, "plain", settings=settings[:1])
        self.assertNotEqual(self.text("once"), self.text("plain"))
        for name, threads in (("again", 1), ("threads", 3)):
            self.spindrift(ENGINEERING, name, settings=settings, threads=threads)
            self.assertEqual(self.text("once"), self.text(name))

    def test_restarts_in_the_middle_of_a_cfl_ramp_change_no_bit(self):
        settings = ["aero.flow.cfl=0.5", "aero.flow.cfl_max=1e4", "aero.flow.max_pseudo_steps=2", "start.air_steps=5", "time.end_s=1.2"]
        self.spindrift(ENGINEERING, "whole", settings=settings, threads=1)
        cfl = [row["air.cfl"] for row in self.rows("whole")]
        self.assertTrue(all(after > before for before, after in zip(cfl[1:-1], cfl[2:-1])), cfl)  # it moves in every window but the last
        for n in range(13):  # one process per window
            self.spindrift(ENGINEERING, "parts", *(["--restart"] if n > 0 else []), "--until", 0.1 * n, settings=settings,
                           ranks=1 + n % 2, threads=1 + n // 2 % 2)
            rows = self.text("parts").splitlines()
            self.assertEqual(self.text("whole").splitlines()[:len(rows)], rows, f"first after the restart before window {n}")

    def limits_told(self, name):
        """Windows whose last update went beyond bounds, of the mean flow and of turbulence, as history.csv has them; checked against what else says so."""
        rows = [row for row in self.rows(name) if row["time_s"] > 0]
        limited, clipped = (sum(row[f"air.{kind}_cells"] > 0 for row in rows) for kind in ("limited", "clipped"))
        summary = json.loads((self.path / name / "summary.json").read_text())
        self.assertEqual((summary["counts"]["shortened_windows"], summary["counts"]["clipped_windows"]), (limited, clipped))
        log = (self.path / name / "log.txt").read_text().splitlines()
        warned = [line for line in log if "went beyond the bounds of" in line]
        self.assertEqual(len(warned), 1 if limited + clipped else 0, warned)
        ends = [line for line in log if f"of the last pseudo-steps of {len(rows)} windows" in line]
        self.assertEqual(len(ends), len(warned), ends)
        if limited:
            first = next(row for row in rows if row["air.limited_cells"] > 0)
            self.assertRegex(warned[0], rf" warning +air: the last update of the window to t = {first['time_s']:g} s .*{first['air.limited_cells']:.0f} cells? \(.* %\) of the mean flow.*; most was the change of \w+ in block \d+ cell")
            most = max(row["air.limited_cells"] for row in rows)
            self.assertRegex(ends[0], rf"in {limited} of the last .* as up to {most:.0f} cells? \(.* %\) would have changed too much.*; most was .* m, to .* of itself, t = [\d.]+ s")
        return limited, clipped, summary["warnings"]

    def test_updates_beyond_bounds_at_the_ends_of_windows_are_warned_of_once_and_counted(self):
        hard = ["aero.flow.cfl=1e4", "aero.flow.cfl_max=1e5", "aero.flow.max_pseudo_steps=1", "start.air_steps=0", "time.end_s=0.4"]
        self.spindrift(ENGINEERING, "hard", settings=hard)
        limited, _, warnings = self.limits_told("hard")
        self.assertGreater(limited, 1)
        self.assertGreater(warnings, 0)
        self.spindrift(ENGINEERING, "ranks", settings=hard, ranks=2)
        self.assertEqual(self.limits_told("ranks")[0], limited)
        self.spindrift(PARTICLES, "split", settings=[*hard, *self.SPLIT, "time.end_s=0.2"], ranks=2)
        self.assertGreater(self.limits_told("split")[0], 0)
        self.spindrift(ENGINEERING, "calm", settings=["start.air_steps=40", "time.end_s=0.2"])
        self.assertEqual(self.limits_told("calm")[:2], (0, 0))
        self.ended([PROGRAM, "report", self.path / "hard"], 1, 0)
        page = (self.path / "hard/report.html").read_text()
        self.assertIn("went beyond the bounds of", page)
        self.assertIn(f"shortened windows: {limited}", page)

    def test_first_cells_that_are_too_coarse_end_the_run_as_no_answer(self):
        sticks = ["aero.flow.viscous='thin_layer'", "aero.flow.turbulence='sa'", "aero.flow.blades='no_slip'", "time.end_s=0.1"]
        for text, name, settings, ranks in ((ENGINEERING, "shared", sticks, 1), (PARTICLES, "split", [*sticks, *self.SPLIT], 2)):
            self.spindrift(text, name, settings=settings, ranks=ranks, code=3)
            summary = json.loads((self.path / name / "summary.json").read_text())
            told = [words for words in summary["numerical_trouble"] if words.startswith("air: y+ of first cells is ")]
            self.assertEqual(told[0], summary["exit_reason"])
            self.assertIn("the loads are no answer", told[0])
            self.assertIn("friction is not to be trusted", told[1])
            self.assertIn(f"warning  {told[1]}", (self.path / name / "log.txt").read_text())
        self.spindrift(ENGINEERING, "slides", settings=["time.end_s=0.1"])
        self.assertEqual(json.loads((self.path / "slides/summary.json").read_text())["numerical_trouble"], [])

    def columns(self, name):
        return set(self.text(name).split("\n", 1)[0].split(","))

    def test_without_a_sea_or_without_a_rotor_the_same_window_runs_with_nothing_missing(self):
        end = ["time.end_s=0.3"]
        self.spindrift(PARTICLES, "both", settings=end)
        dry = PARTICLES.split("[sea]")[0].replace('integrator = "symplectic"', "step_s = 0.05") + AIR
        calm = 'without = "rotor"' + PARTICLES.split("[wind]")[0]
        for text, name, gone in ((dry, "dry", (".sea.", ".contact.")), (calm, "calm", ("rotor.", "bearing.", "air.", "coupling."))):
            self.spindrift(text, name, settings=end)
            missing = self.columns("both") - self.columns(name)
            self.assertEqual(self.columns(name) - self.columns("both"), set())
            self.assertEqual({column for column in missing if not any(part in column for part in gone) and not column.startswith("sea.")}, set())
            self.spindrift(text, name + "_threads", settings=end, threads=3)
            self.spindrift(text, name + "_ranks", settings=end, ranks=2)
            self.spindrift(text, name + "_parts", "--until", 0.1, settings=end)
            self.spindrift(text, name + "_parts", "--restart", settings=end)
            for other in ("_threads", "_ranks", "_parts"):
                self.assertEqual(self.text(name), self.text(name + other))
        # Without water the platform falls, but for its lines; the air does its work on it all the same.
        last = self.rows("dry")[-1]
        self.assertAlmostEqual(last["platform.z_m"], -0.5 * 9.81 * 0.09, delta=0.01)
        self.assertGreater(last["rotor.thrust_N"], 1e6)

    def test_all_sectors_move_in_six_freedoms(self):
        self.spindrift(ENGINEERING, "all", settings=["time.end_s=0.3", 'aero.grid.sectors="all"'])
        rows = self.rows("all")
        self.assertGreater(rows[-1]["rotor.thrust_N"], 3e5)
        self.assertGreater(rows[-1]["air.pseudo_steps"], 0)

    def test_strong_schemes_restart_bit_for_bit(self):
        for scheme in ("aitken", "iqn_ils"):
            settings = [f"coupling.scheme='{scheme}'", "coupling.tolerance=1e-4", "time.end_s=0.4"]
            self.spindrift(ENGINEERING, scheme, settings=settings, threads=2)
            self.assertGreater(max(row["coupling.evaluations"] for row in self.rows(scheme)), 1)
            self.spindrift(ENGINEERING, scheme + "_parts", "--until", 0.2, settings=settings)
            self.spindrift(ENGINEERING, scheme + "_parts", "--restart", settings=settings, threads=3)
            self.assertEqual(self.text(scheme), self.text(scheme + "_parts"))

    # A set-up of the preconditioner's coarse level serves two windows of three pseudo-steps; stopped in the middle of its life.
    KEPT = ["aero.flow.common_every=3", "aero.flow.common_steps=2", "time.end_s=0.5"]

    def test_a_coarse_correction_kept_over_windows_gives_the_same_bits_however_it_is_run(self):
        self.check_bits(ENGINEERING, ["aero.flow.preconditioner='coarse'", "aero.flow.group_cells=4", *self.KEPT], 0.3)

    def test_multigrid_kept_over_windows_gives_the_same_bits_on_threads_and_after_restarts(self):
        multigrid = ["aero.flow.preconditioner='coarse'", "aero.flow.group_cells=4", "aero.flow.direct_groups=0", *self.KEPT]
        for scheme in ("cps2", "aitken"):  # which repeats windows
            settings = [*multigrid, f"coupling.scheme='{scheme}'"]
            self.spindrift(ENGINEERING, scheme, settings=settings, threads=3)
            self.spindrift(ENGINEERING, scheme + "_parts", "--until", 0.3, settings=settings)
            self.spindrift(ENGINEERING, scheme + "_parts", "--restart", settings=settings, threads=2)
            self.assertEqual(self.text(scheme), self.text(scheme + "_parts"))

    def test_the_automatic_preconditioner_is_chosen_once_and_kept(self):
        auto = ["aero.flow.preconditioner='auto'"]
        self.spindrift(ENGINEERING, "auto", "--until", 0.3, settings=auto, threads=2)
        chosen = [line for line in (self.path / "auto/log.txt").read_text().splitlines() if "air: preconditioner" in line]
        self.assertEqual(len(chosen), 1)
        self.assertIn("us per cell by the model", chosen[0])
        name = chosen[0].split('"')[1]
        named = f'preconditioner = "{name}"'
        self.assertIn(named, (self.path / "auto/scene.toml").read_text())
        self.spindrift(ENGINEERING, "auto", "--restart", settings=auto)
        self.assertIn(f'air: preconditioner "{name}" (as before the restart)', (self.path / "auto/log.txt").read_text())
        self.assertIn(named, (self.path / "auto/scene.toml").read_text())
        self.spindrift((self.path / "auto/scene.toml").read_text(), "again", threads=3)  # what the run wrote down runs alike
        self.assertEqual(self.text("auto"), self.text("again"))

    def test_a_sea_of_particles_gives_the_same_bits_however_it_is_run(self):
        self.check_bits(PARTICLES, [], 0.2)

    def test_particles_repeat_their_windows_for_strong_schemes(self):
        settings = ["coupling.scheme='iqn_ils'", "coupling.composition='parallel'", "coupling.tolerance=1e-3", "time.end_s=0.3"]
        self.spindrift(PARTICLES, "strong", settings=settings, threads=2)
        self.assertGreater(max(row["coupling.evaluations"] for row in self.rows("strong")), 1)
        self.spindrift(PARTICLES, "strong_parts", "--until", 0.2, settings=settings)
        self.spindrift(PARTICLES, "strong_parts", "--restart", settings=settings)
        self.assertEqual(self.text("strong"), self.text("strong_parts"))

    def test_every_strong_scheme_finds_the_same_windows_of_resolved_air(self):
        settings = ["coupling.tolerance=1e-6", "time.end_s=0.2"]
        self.spindrift(ENGINEERING, "reference", settings=[*settings, "coupling.scheme='newton'", "coupling.tolerance=1e-8"])
        reference = self.rows("reference")
        self.assertEqual(reference[-1]["coupling.columns"], 6)  # full rank
        both = [(scheme, "parallel") for scheme in ("aitken", "iqn_ils", "interface_gmres", "newton")]
        for scheme, composition in [(s, "serial") for s in ("relaxation", "aitken", "steepest_descent", "iqn_ils", "ibqn_ls", "interface_gmres")] + both:
            how = [*settings, f"coupling.scheme='{scheme}'"] + ([] if scheme == "ibqn_ls" else [f"coupling.composition='{composition}'"])
            self.spindrift(ENGINEERING, "strong", "--overwrite", settings=how)
            for row, other in zip(self.rows("strong")[1:], reference[1:]):
                with self.subTest(scheme=scheme, composition=composition, t=row["time_s"]):
                    self.assertAlmostEqual(row["rotor.thrust_N"] / other["rotor.thrust_N"], 1.0, delta=5e-6)
                    self.assertAlmostEqual(row["platform.pitch_deg"] / other["platform.pitch_deg"], 1.0, delta=5e-6)
                    self.assertEqual(row["coupling.retries"], 0)

    def test_waveforms_of_several_samples_iterate_over_resolved_air(self):
        # 40 steps of the air, exchanged one by one, against windows of four of them: the same steps, and what the bodies see between them.
        whole = ["coupling.scheme='iqn_ils'", "coupling.tolerance=1e-6", "time.end_s=0.8", "time.window_s=0.4", "time.step_s=0.05"]
        self.spindrift(ENGINEERING, "single", settings=[*whole, "time.window_s=0.1"])
        single = self.rows("single")[-1]
        for interpolation, near in (("linear", 1e-6), ("cubic", 1e-3)):
            self.spindrift(ENGINEERING, interpolation, settings=[*whole, "coupling.samples=4", f"coupling.interpolation='{interpolation}'"])
            last = self.rows(interpolation)[-1]
            self.assertAlmostEqual(last["platform.pitch_deg"] / single["platform.pitch_deg"], 1.0, delta=10 * near)
            self.assertAlmostEqual(last["rotor.thrust_N"] / single["rotor.thrust_N"], 1.0, delta=near)
            self.assertEqual(last["coupling.retries"], 0)
            self.spindrift(ENGINEERING, interpolation + "_parts", "--until", 0.4,
                           settings=[*whole, "coupling.samples=4", f"coupling.interpolation='{interpolation}'"])
            self.spindrift(ENGINEERING, interpolation + "_parts", "--restart",
                           settings=[*whole, "coupling.samples=4", f"coupling.interpolation='{interpolation}'"], threads=2)
            self.assertEqual(self.text(interpolation), self.text(interpolation + "_parts"))

    def test_a_window_of_resolved_air_that_stalls_is_cleared_relaxed_and_tried_again_or_cut(self):
        long = ["time.end_s=0.8", "time.window_s=0.8", "coupling.scheme='relaxation'"]
        # The plain fixed point of one evaluation too few: five relaxed ones first are enough.
        retried = [*long, "coupling.relaxation=0.5", "coupling.max_evaluations=6", "coupling.tolerance=1.8e-3"]
        self.spindrift(ENGINEERING, "retried", settings=retried)
        row = self.rows("retried")[-1]
        self.assertEqual((row["coupling.retries"], row["coupling.cuts"], row["coupling.evaluations"]), (1, 0, 17))
        # Two evaluations do not do for 1.6 s; each half they solve, as windows of that length are.
        cut = [*long, "time.end_s=1.6", "time.window_s=1.6", "coupling.relaxation=1.0", "coupling.max_evaluations=2", "coupling.tolerance=1e-3"]
        self.spindrift(ENGINEERING, "cut", settings=cut)
        self.spindrift(ENGINEERING, "halves", settings=["time.end_s=1.6", "time.window_s=0.8", "coupling.scheme='aitken'", "coupling.tolerance=1e-8"])
        row, halves = self.rows("cut")[-1], self.rows("halves")[-1]
        self.assertEqual(row["coupling.cuts"], 1)
        self.assertAlmostEqual(row["rotor.thrust_N"] / halves["rotor.thrust_N"], 1.0, delta=2e-4)
        self.assertAlmostEqual(row["platform.pitch_deg"] / halves["platform.pitch_deg"], 1.0, delta=2e-3)

    def test_a_rotor_that_an_equilibrium_leans_starts_too(self):
        for sectors in ("one", "all"):
            self.spindrift(ENGINEERING, sectors, settings=["start.equilibrium=true", "time.end_s=0.2", f"aero.grid.sectors='{sectors}'"])
            first, last = self.rows(sectors)[0], self.rows(sectors)[-1]
            self.assertGreater(abs(first["platform.pitch_deg"]), 0.1)
            self.assertGreater(last["rotor.thrust_N"], 1e6)

    def test_the_air_leaves_fields_at_chosen_times_and_loads_by_blade_and_along_the_span(self):
        settings = ["time.end_s=0.4", "output.air_interval_s=0.2"]
        self.spindrift(ENGINEERING, "out", settings=settings)
        self.spindrift(ENGINEERING, "split", settings=[*settings, *self.SPLIT], ranks=2)
        for name in ("out", "split"):
            for kind in ("air", "walls"):
                self.assertEqual(len(list((self.path / name / "fields").glob(f"{kind}_*.h5"))), 2)
                self.assertTrue((self.path / name / f"fields/{kind}.xdmf").exists())
        self.assertEqual((self.path / "out/spanwise.csv").read_text(), (self.path / "split/spanwise.csv").read_text())
        for kind in ("air", "walls"):
            of_one, of_split = (field_files.blocks(self.path / name, kind) for name in ("out", "split"))
            self.assertEqual(of_one.keys(), of_split.keys())
            for name, block in of_one.items():
                for field, values in block.items():
                    np.testing.assert_array_equal(values, of_split[name][field], f"{name}/{field}")
        walls, cells = field_files.at_walls(self.path / "out")
        self.assertGreater(np.corrcoef(walls, cells)[0, 1], 0.9)   # next to 0 where values lie elsewhere than their points
        last = self.rows("out")[-1]
        self.assertAlmostEqual(3.0 * last["rotor.blade_1.thrust_N"] / last["rotor.thrust_N"], 1.0, delta=1e-9)
        span = rows(self.path / "out/spanwise.csv")
        self.assertAlmostEqual(3.0 * sum(r["normal_N_m"] * r["length_m"] for r in span) / last["rotor.thrust_N"], 1.0, delta=0.02)
        self.ended([PROGRAM, "report", self.path / "out"], 1, 0)
        report = (self.path / "out/report.html").read_text()
        for picture in ("Pressure on a blade", "Wind in the plane of the axis"):
            self.assertIn(picture, report)

    def test_the_trace_shows_output_beside_the_next_window_and_data_between_air_bodies_and_sea(self):
        self.run_scene(PARTICLES + "[checkpoint]\ninterval_s = 0.1\n", "traced", "--trace", threads=2)
        events = trace_events(self.path / "traced")
        rows_of, ends = {}, {}
        for event in events:
            row = event["pid"], event.get("tid")
            if event["ph"] == "X" and event["name"] != "waiting":
                rows_of.setdefault(row, []).append((event["ts"], event["ts"] + event["dur"], event["name"]))
            elif event["ph"] in "sf":
                ends.setdefault(event["id"], {})[event["ph"]] = (row, event["ts"])
        rounding = 2e-3  # times are written in thousandths of a microsecond

        def module(row, time):
            """Of the innermost slice there."""
            inside = [(begin - end, name) for begin, end, name in rows_of[row] if begin - rounding <= time <= end + rounding]
            return max(inside)[1].split("/")[0]
        arrows = {(module(*of["s"]), module(*of["f"])) for of in ends.values()}
        self.assertLessEqual({("aero", "exchange"), ("exchange", "aero"), ("sea", "exchange"), ("exchange", "sea"), ("sea", "bodies"), ("bodies", "sea")}, arrows)
        slices = [(row, *of) for row, all_of in rows_of.items() for of in all_of]
        writes = [(row, begin, end) for row, begin, end, name in slices if name == "output/write"]
        beside = {name.split("/")[0] for row, begin, end in writes for other, first, last, name in slices if other != row and first < end and last > begin}
        self.assertTrue(beside & {"aero", "sea"}, beside)

    def test_each_window_logs_how_it_went(self):
        settings = ["coupling.scheme='relaxation'", "coupling.relaxation=0.9", "coupling.tolerance=1e-9", "coupling.max_evaluations=3", "coupling.max_cuts=1",
                    "time.end_s=0.1"]
        self.spindrift(ENGINEERING, "stalls", settings=settings, code=3)
        log = (self.path / "stalls/log.txt").read_text()
        for word in ("evaluations", "residual", "columns", "1 cuts", "2 retries", "ended by evaluation limit", "core-s: air"):
            self.assertIn(word, log)

    def test_a_wall_limit_ends_the_run_with_5_and_it_goes_on_from_there(self):
        for limit in (1.0, 4.0, 16.0):   # a busy computer may need the first of them to start
            self.spindrift(ENGINEERING, "limited", "--overwrite", settings=["time.end_s=600.0", f"runtime.wall_limit_s={limit}"], code=5)
            summary = json.loads((self.path / "limited/summary.json").read_text())
            self.assertIn("wall", summary["exit_reason"])
            if (self.path / "limited/history.csv").exists() and len(self.rows("limited")) > 1:
                break
        done = len(self.rows("limited"))
        self.assertGreater(done, 1)
        self.spindrift(ENGINEERING, "limited", "--restart", "--until", 0.1 * (done + 1), settings=["time.end_s=600.0"])
        self.assertEqual(len(self.rows("limited")), done + 2)

    def test_a_saved_state_starts_another_run(self):
        for text, name in ((ENGINEERING, "engineering"), (PARTICLES, "particles")):
            until, settings = 0.2, ["time.end_s=0.4"]
            self.spindrift(text, name, settings=settings)
            self.spindrift(text, name + "_first", "--until", until, settings=settings)
            saved = max((self.path / (name + "_first") / "checkpoints").glob("*.h5"))
            start = [*settings, f"start.file='{saved}'", "start.air_steps=0", *(["sea.initial.settle_s=0"] if text is PARTICLES else [])]
            self.spindrift(text, name + "_second", settings=start, threads=2)
            after = [row for row in self.rows(name) if row["time_s"] > until + 1e-9]
            second = self.rows(name + "_second")
            self.assertAlmostEqual(second[0]["time_s"], until, delta=1e-12)  # the row of the start itself
            self.assertGreater(second[0]["rotor.thrust_N"], 3e5)
            # The same windows: the same bits, but for work, which counts from the start of each run.
            bits = lambda rows: [{name: value for name, value in row.items() if not name.startswith("energy.") or name == "energy.kinetic_J"} for row in rows]
            self.assertEqual(bits(second[1:]), bits(after))
            # Another window, scheme and march from the same state: close, and not the same.
            self.spindrift(text, name + "_third", settings=[*start, "time.window_s=0.05", "coupling.scheme='cps'", "aero.flow.cfl_max=10"])
            third = self.rows(name + "_third")
            self.assertEqual(len(third), 5)
            # Close by what the thrust alone would do to the platform in this time, some 2 cm.
            self.assertAlmostEqual(third[-1]["platform.x_m"], after[-1]["platform.x_m"], delta=0.02 * 0.02)
            self.assertNotEqual(third[-1]["platform.x_m"], after[-1]["platform.x_m"])
            # Much shorter ones: the air is where the rotor is, not where cps2 had foretold it for 0.1 s; no jolt.
            short = ["time.window_s=0.001", "time.end_s=0.203"] + (["time.step_s=0.001"] if text is ENGINEERING else [])
            self.spindrift(text, name + "_short", settings=[*start, *short])
            for row in self.rows(name + "_short"):
                self.assertAlmostEqual(row["rotor.thrust_N"] / second[0]["rotor.thrust_N"], 1.0, delta=0.15)
            for settings_, words in ((["time.window_s=0.03", "time.end_s=0.6"], "no whole number of windows"), (["time.end_s=0.2"], "the run ends at 0.2 s"),
                                     (["start.equilibrium=true"], "start.file is the start"), (["start.file='nowhere.h5'"], "no such file"),
                                     (["aero.grid.cells_downstream=7"], "its air has")):
                settings_ = [s for s in settings_] + (["time.step_s=0.03"] if "0.03" in settings_[0] and text is ENGINEERING else [])
                output = self.spindrift(text, "refused", "--overwrite", settings=[*start, *settings_], code=2)
                self.assertIn(words, output)

    def test_what_cannot_be_is_refused(self):
        for setting, words in (("aero.flow.time='steady'", "where bodies carry the rotor"), ("coupling.scheme='monolithic'", "answers once per window"),
                               ("wind.direction_deg=10", "needs the wind along the rotor axis")):
            self.assertIn(words, self.spindrift(ENGINEERING, "refused", settings=[setting], code=2))


class Ramp(System):
    """A process for every window while the CFL number climbs, on one to four ranks of one and two threads in turn."""
    WINDOWS = 20
    SETTINGS = ["aero.flow.cfl=0.005", "aero.flow.cfl_max=1e7", "aero.flow.max_pseudo_steps=2", "start.air_steps=5"]

    def check_restarts(self, text, until_s, first_s):
        settings = [*self.SETTINGS, f"time.end_s={until_s:g}"]
        self.spindrift(text, "whole", settings=settings, threads=1)
        cfl = [row["air.cfl"] for row in self.rows("whole") if row["time_s"] > 0.0]
        self.assertEqual(len(cfl), self.WINDOWS)
        self.assertTrue(all(after > before for before, after in zip(cfl[:-1], cfl[1:])), cfl)
        for n in range(self.WINDOWS):
            self.spindrift(text, "parts", *(["--restart"] if n > 0 else []), "--until", first_s + 0.1 * n, settings=settings, ranks=1 + n % 4, threads=1 + n // 4 % 2)
            rows = self.text("parts").splitlines()
            self.assertEqual(self.text("whole").splitlines()[:len(rows)], rows, f"first after the restart before window {n}")
        self.assertEqual(self.text("whole"), self.text("parts"))

    def test_twenty_restarts_over_an_engineering_sea_change_no_bit(self):
        self.check_restarts(ENGINEERING, 2.0, 0.1)

    def test_twenty_restarts_over_a_sea_of_particles_change_no_bit(self):
        self.check_restarts(PARTICLES, 2.0, 0.1)


class ManyRanks(System):
    """More ranks than cores, of tiles small enough that each has some."""

    def test_three_eight_and_64_ranks_have_the_bits_of_one(self):
        settings = ["aero.flow.tile_cells=256", "aero.grid.sectors='all'", "aero.flow.preconditioner='coarse'", "time.end_s=0.2"]
        self.spindrift(PARTICLES, "one", settings=settings)
        for ranks in (3, 8, 64):
            with self.subTest(ranks=ranks):
                self.spindrift(PARTICLES, "many", "--overwrite", settings=settings, ranks=ranks)
                self.assertEqual(self.text("one"), self.text("many"))

    def test_more_ranks_than_a_coarser_start_has_tiles_have_the_bits_of_one(self):
        settings = ["aero.grid.resolution=2.0", "aero.flow.coarse_steps=2", "aero.flow.drop=0", "time.end_s=2.0"]
        for name, ranks in (("one", 1), ("many", 40)):
            self.spindrift(ALONE, name, settings=settings, ranks=ranks)
        self.assertEqual(self.text("one"), self.text("many"))


class Messages(System):
    """What two ranks say to each other in a window, from recordings of their graphs."""
    FIRST_WINDOW = ["time.end_s=0.1", "sea.initial.settle_s=0", "aero.flow.preconditioner='coarse'"]

    def recorded(self, name, *settings):
        """The nodes of rank 0, by number."""
        path = self.path / f"{name}.jsonl"
        self.spindrift(PARTICLES, name, "--record-graph", path, "--windows", "1:1", settings=[*self.FIRST_WINDOW, *settings], ranks=2)
        nodes = [line for line in map(json.loads, path.read_text().splitlines()) if "node" in line and line["rank"] == 0]
        self.assertTrue(nodes)
        return {node["node"]: node for node in nodes}

    @staticmethod
    def sent(nodes, label):
        """Bytes of all messages of a label, for one execution."""
        return sum(node["bytes"] for node in nodes.values() if node["kind"] == "send" and node["label"].startswith(label + "/send/"))

    def test_ranks_send_what_is_read_and_send_it_once(self):
        nodes, dynamic = self.recorded("extrapolated"), self.recorded("dynamic", "sea.particles.walls='dynamic'")
        water, walls, all_planes = self.sent(nodes, "sea/halo"), self.sent(nodes, "sea/walls/halo"), self.sent(dynamic, "sea/halo")
        self.assertGreater(min(water, walls), 0)
        self.assertEqual(water + walls, all_planes, "walls that follow the water are sent with it as well")
        self.assertGreater(self.sent(nodes, "aero/ghosts"), 0)
        for unread in ("aero/gradient_ghosts", "aero/krylov/trial_ghosts", "aero/krylov/gradient_ghosts"):
            self.assertTrue(any(node["label"].startswith(unread) for node in nodes.values()), unread)
            self.assertEqual(self.sent(nodes, unread), 0, unread)

    def test_no_loop_of_the_air_waits_for_one_of_the_sea(self):
        nodes = self.recorded("coarse")
        modules = {frozenset((node["module"], nodes[before]["module"])) for node in nodes.values() for before, *_ in node["after"]}
        self.assertIn(frozenset({"sea"}), modules)
        self.assertIn(frozenset({"aero"}), modules)
        self.assertNotIn(frozenset({"aero", "sea"}), modules)


class Placement(System):
    def check_split(self, text, settings, until):
        self.spindrift(text, "shared", settings=settings)
        self.spindrift(text, "split", settings=[*settings, *self.SPLIT], ranks=2, threads=2)
        self.assertEqual(self.text("shared"), self.text("split"))
        summary = json.loads((self.path / "split/summary.json").read_text())
        self.assertEqual({"air waiting", "sea waiting", "air busy", "sea busy"} - {e["name"] for e in summary["efficiency"]}, set())
        # Two ranks of the air, then on from their checkpoint with everything shared, and the other way round.
        two = [*settings, *self.SPLIT, "coupling.air_ranks=2"]
        self.spindrift(text, "on", "--until", until, settings=two, ranks=3)
        self.spindrift(text, "on", "--restart", settings=settings, threads=2)
        self.assertEqual(self.text("shared"), self.text("on"))
        self.spindrift(text, "back", "--until", until, settings=settings)
        self.spindrift(text, "back", "--restart", settings=[*settings, *self.SPLIT], ranks=3)
        self.assertEqual(self.text("shared"), self.text("back"))

    def test_split_ranks_give_the_same_bits_as_shared_ones(self):
        self.check_split(PARTICLES, [], 0.2)

    def test_split_ranks_give_the_same_bits_with_an_engineering_sea_and_a_strong_scheme(self):
        self.check_split(ENGINEERING, ["coupling.scheme='aitken'", "coupling.tolerance=1e-4", "time.end_s=0.4"], 0.2)

    def test_split_ranks_give_the_same_bits_by_quasi_newton_in_turn_and_at_once(self):
        quasi_newton = ["coupling.scheme='iqn_ils'", "coupling.tolerance=1e-4", "time.end_s=0.4"]
        self.check_split(ENGINEERING, quasi_newton, 0.2)
        self.assertGreater(max(row["coupling.columns"] for row in self.rows("split")), 0)
        at_once = [*quasi_newton, "coupling.composition='parallel'"]
        self.spindrift(ENGINEERING, "at_once", settings=at_once)
        self.spindrift(ENGINEERING, "at_once_split", settings=[*at_once, *self.SPLIT], ranks=2)
        self.assertEqual(self.text("at_once"), self.text("at_once_split"))

    def test_program_sections_give_the_same_bits_and_must_agree(self):
        end = ["--set", "time.end_s=0.2"]
        self.spindrift(PARTICLES, "shared", *end)
        self.in_sections("sections", (1, ["--fluid", "air", *end]), (2, ["--fluid", "sea", *end]))
        self.assertEqual(self.text("shared"), self.text("sections"))
        for sections, words in (
            (((1, ["--fluid", "air", *end]), (2, ["--fluid", "sea"])), ("rank 0 and ranks 1 to 2", "different scenes", "end_s")),
            (((1, ["--fluid", "air", *end]), (1, ["--fluid", "sea", "--until", 0.1, *end])), ("rank 0 and rank 1", "different options", "--until")),
            (((1, ["--fluid", "air", *end]), (1, end)), ("rank 0", "rank 1", "--fluid")),
            (((1, ["--fluid", "air", *end]), (1, ["--fluid", "air", *end])), ("the other fluid needs a program section",)),
            (((1, ["--fluid", "air", *end]), (1, ["--fluid", "sea", "--set", "sea.tank=3"])), ("cannot read", "sea.tank")),
            (((2, ["--fluid", "air", *end, "--set", "coupling.placement='split'"]), (1, ["--fluid", "sea", *end, "--set", "coupling.placement='split'"])),
             ("coupling.air_ranks", "2 ranks with --fluid air"))):
            said = self.in_sections("refused", *sections, code=2)
            for word in words:
                self.assertIn(word, said)

    def test_a_failure_of_one_fluid_stops_both_with_the_reason_and_the_last_good_state(self):
        # The largest step of the particles at rest, which they outgrow round a platform too heavy to float. (The air's:
        # tests/src/coupling/sides_test.cpp.)
        heavy = ["time.step_s=0.008333333333333333", "bodies.platform.mass_kg=5e8", "time.end_s=1.5", *self.SPLIT]
        said = self.spindrift(PARTICLES, "failed", settings=heavy, ranks=2, code=3)
        self.assertIn("sea: the step of", said)
        self.assertTrue(list((self.path / "failed/checkpoints").iterdir()))
        summary = json.loads((self.path / "failed/summary.json").read_text())
        self.assertEqual(summary["exit_code"], 3)
        self.assertIn("sea: the step of", summary["exit_reason"])
        said = self.spindrift(PARTICLES, "failed", "--restart", settings=heavy[1:], ranks=2, code=2)  # with another step
        self.assertIn("time.step_s: was 0.00833", said)
        said = self.spindrift(PARTICLES, "failed", "--restart", "--allow-change", "time.step_s", settings=heavy[1:], ranks=2, code=2)
        self.assertIn("a restart keeps time.window_s and time.step_s", said)

    def test_too_few_ranks_are_refused(self):
        for setting, ranks in (("coupling.air_ranks=1", 1), ("coupling.air_ranks=2", 2)):
            self.assertIn("leaves no rank for the sea", self.spindrift(ENGINEERING, "refused", settings=[*self.SPLIT, setting], ranks=ranks, code=2))


class Saved(System):
    def from_air(self, name):
        return ENGINEERING.replace("air_steps = 10", f'air = "{self.path / name}"')

    def test_air_in_other_tiles_is_refused(self):
        self.spindrift(ENGINEERING, "saved", "--until", 0.2)
        other = ["aero.flow.tile_cells=256"]
        said = self.spindrift(ENGINEERING, "saved", "--restart", "--allow-change", "aero.flow.tile_cells", settings=other, code=2)
        self.assertIn("was cut into other tiles", said)

    def test_air_of_a_rotor_alone_starts_a_coupled_run_as_if_it_had_settled_there(self):
        settled = ["start.air_steps=20", "time.end_s=0.3"]
        self.spindrift(ENGINEERING, "settled", settings=settled)
        self.spindrift(ALONE, "alone")
        self.assertGreater(self.rows("alone")[-1]["rotor.thrust_N"], 3e5)
        for threads, ranks, more in ((1, 1, []), (2, 2, ["coupling.placement='split'"])):
            self.spindrift(self.from_air("alone/scene.toml"), "started", "--overwrite", settings=["time.end_s=0.3", *more], threads=threads, ranks=ranks)
            self.assertEqual(self.text("settled"), self.text("started"))
        # Blades that stood elsewhere: the flow is turned with them.
        self.spindrift(ALONE, "turned", settings=["rotor.azimuth_deg=37.0"])
        self.spindrift(self.from_air("turned/scene.toml"), "turned_on", settings=["time.end_s=0.1"])
        for name in ("rotor.thrust_N", "rotor.torque_N_m"):
            for n in (0, 1):  # on the way: the air's matrix, of 16 bits, is not rounded alike in turned axes
                self.assertAlmostEqual(self.rows("turned_on")[n][name] / self.rows("settled")[n][name], 1.0, delta=3e-4)
        # What a coupled run left starts another one.
        self.spindrift(self.from_air("settled/scene.toml"), "again", settings=["time.end_s=0.1"])
        self.assertAlmostEqual(self.rows("again")[0]["rotor.thrust_N"] / self.rows("settled")[-1]["rotor.thrust_N"], 1.0, delta=1e-3)

    def test_a_profile_is_added_to_air_that_was_saved_without_one(self):
        sheared = ["aero.grid.sectors='all'", "wind.profile='power_law'", "wind.reference_height_m=119.0", "time.end_s=0.1"]
        self.spindrift(ENGINEERING, "settled", settings=["start.air_steps=20", *sheared])
        self.spindrift(ALONE, "alone", settings=["aero.grid.sectors='all'"])
        self.spindrift(self.from_air("alone/scene.toml"), "started", settings=sheared)
        for settled, started in zip(self.rows("settled"), self.rows("started")):
            for name in ("rotor.thrust_N", "rotor.rotor.my_N_m"):
                self.assertAlmostEqual(started[name] / settled[name], 1.0, delta=1e-3)
        # What one sheared run left is not air for another shear.
        said = self.spindrift(self.from_air("settled/scene.toml"), "refused", settings=[*sheared, "wind.shear_exponent=0.3"], code=2)
        self.assertIn("wind.shear_exponent = 0.3", said)
        said = self.spindrift(self.from_air("alone/scene.toml"), "refused", "--overwrite", settings=["aero.grid.sectors='all'", "wind.direction_deg=20"], code=2)
        self.assertIn("wind.direction_deg = 20", said)

    def test_a_coupled_run_starts_from_both_fluids_saved_alone(self):
        # The paper's section 4.6: the rotor alone, the sea alone round a platform that is held.
        self.spindrift(ALONE, "rotor")
        held = 'without = "rotor"' + PARTICLES.split("[wind]")[0] + '[joints.hold]\ntype = "fixed"\nbodies = ["earth", "platform"]\npoint_m = [0.0, 0.0, 0.0]\n'
        self.spindrift(held, "sea", settings=["time.end_s=0.3"])
        self.assertEqual(self.rows("sea")[-1]["platform.x_m"], 0.0)
        both = PARTICLES.replace("air_steps = 10", f'air = "{self.path / "rotor/scene.toml"}"').replace(
            "settle_s = 0.1", f'state = "file"\nfile = "{self.path / "sea/scene.toml"}"')
        self.spindrift(both, "coupled", settings=["time.end_s=0.2"])
        first, sea, rotor = self.rows("coupled")[0], self.rows("sea")[-1], self.rows("rotor")[-1]
        self.assertEqual(first["time_s"], 0.0)
        self.assertAlmostEqual(first["rotor.thrust_N"] / rotor["rotor.thrust_N"], 1.0, delta=0.01)  # its last row is a pseudo-step before its end
        for axis in "xyz":
            self.assertAlmostEqual(first[f"platform.sea.f{axis}_N"], sea[f"platform.sea.f{axis}_N"], delta=1e-2 * abs(sea["platform.sea.fz_N"]))  # of half a substep before
        self.assertEqual(first["sea.kinetic_energy_J"], sea["sea.kinetic_energy_J"])
        self.spindrift(both, "split", settings=["time.end_s=0.2", *self.SPLIT], ranks=2)
        self.assertEqual(self.text("coupled"), self.text("split"))

    def test_air_of_another_rotor_is_refused_by_name(self):
        self.spindrift(ALONE, "alone", settings=["time.end_s=1.0"])
        for text, setting, words in ((self.from_air("alone/scene.toml"), "aero.grid.cells_round=32", ("aero.grid.cells_round = 28", "aero.grid.cells_round = 32")),
                                     (self.from_air("alone/scene.toml"), "wind.speed_m_s=10", ("wind.speed_m_s = 11", "wind.speed_m_s = 10")),
                                     (self.from_air("alone/scene.toml"), "aero.flow.flux='rusanov'", ("aero.flow.flux",)),
                                     (self.from_air("scene.toml"), "time.end_s=0.1", ("no checkpoint of a run",))):
            said = self.spindrift(text, "refused", "--overwrite", settings=[setting], code=2)
            for word in words:
                self.assertIn(word, said)
        said = self.spindrift(ENGINEERING, "refused", "--overwrite", settings=[f"start.air='{self.path / 'alone/scene.toml'}'"], code=2)
        self.assertIn("start.air", said)


if __name__ == "__main__":
    unittest.main()
