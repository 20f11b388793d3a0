"""The coupled machine as a user runs it: a blade-resolved rotor on a floating platform, with an engineering sea and with one of particles.
Same bits by threads, ranks and restarts; what is refused. Usage: machine_test.py SPINDRIFT"""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/spindrift").resolve()
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CASES = ROOT / "inputs/leble_barakos"

# 3 000 cells a sector, three pseudo-steps per window: what is tested is the exchange, not the flow.
AIR = """
[wind]
speed_m_s = 11.0
[rotor]
turbine = "%s/inputs/turbines/dtu_10mw.toml"
[aero]
model = "blade_resolved"
[aero.grid]
resolution = 1.0
sectors = "one"
cells_round = 28
cells_layers = 4
cells_span = 8
first_cell_chords = 8e-3
[aero.flow]
time = "bdf2"
viscous = "none"
krylov_steps = 6
matrix_free_below = 0.0
cfl = 2.0
cfl_max = 20.0
max_pseudo_steps = 3
[start]
air_steps = 10
""" % ROOT
ENGINEERING = """
base = "%s/platform.toml"
[time]
end_s = 0.6
window_s = 0.1
step_s = 0.05
[sea]
model = "hydrostatic"
""" % CASES + AIR
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


class MachineRun(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="spindrift_machine_")
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def spindrift(self, text, name, *arguments, settings=(), threads=1, ranks=1, code=0):
        scene = self.path / "scene.toml"
        scene.write_text(text)
        given = [word for s in settings for word in ("--set", s)]
        start = ["mpirun", "-n", str(ranks), "--bind-to", "none"] if ranks > 1 else []
        done = subprocess.run([*start, PROGRAM, "run", scene, "--quiet", "--no-report", "--out", self.path / name, *map(str, arguments), *given],
                              capture_output=True, text=True, timeout=900, env={**os.environ, "OMP_NUM_THREADS": str(threads)})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def text(self, name):
        return (self.path / name / "history.csv").read_text()

    def rows(self, name):
        with open(self.path / name / "history.csv") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def check_bits(self, text, settings, until):
        self.spindrift(text, "whole", settings=settings, threads=1)
        self.spindrift(text, "threads", settings=settings, threads=3)
        self.assertEqual(self.text("whole"), self.text("threads"))
        self.spindrift(text, "ranks", settings=settings, ranks=2)
        self.assertEqual(self.text("whole"), self.text("ranks"))
        self.spindrift(text, "parts", "--until", until, settings=settings, threads=2)
        self.spindrift(text, "parts", "--restart", settings=settings, threads=1)
        self.assertEqual(self.text("whole"), self.text("parts"))

    def test_an_engineering_sea_gives_the_same_bits_however_it_is_run_and_loads_meet_the_bodies(self):
        self.check_bits(ENGINEERING, [], 0.3)
        rows = self.rows("whole")
        self.assertEqual(len(rows), 7)
        self.assertGreater(rows[0]["rotor.thrust_N"], 3e5)
        self.assertGreater(rows[-1]["rotor.hub_vx_m_s"], 0.0)
        for row in rows:  # the force on the body that turns is the rotor's load, along an axis that has leant by less than a degree
            force = sum(row[f"rotor.rotor.f{axis}_N"] ** 2 for axis in "xyz") ** 0.5
            self.assertAlmostEqual(force / row["rotor.thrust_N"], 1.0, delta=1e-9)
            self.assertGreater(row["rotor.rotor.fx_N"], 0.999 * force)

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

    def test_a_sea_of_particles_gives_the_same_bits_however_it_is_run(self):
        self.check_bits(PARTICLES, [], 0.2)

    def test_particles_repeat_their_windows_for_strong_schemes(self):
        settings = ["coupling.scheme='iqn_ils'", "coupling.composition='parallel'", "coupling.tolerance=1e-3", "time.end_s=0.3"]
        self.spindrift(PARTICLES, "strong", settings=settings, threads=2)
        self.assertGreater(max(row["coupling.evaluations"] for row in self.rows("strong")), 1)
        self.spindrift(PARTICLES, "strong_parts", "--until", 0.2, settings=settings)
        self.spindrift(PARTICLES, "strong_parts", "--restart", settings=settings)
        self.assertEqual(self.text("strong"), self.text("strong_parts"))

    def test_a_rotor_that_an_equilibrium_leans_starts_too(self):
        for sectors in ("one", "all"):
            self.spindrift(ENGINEERING, sectors, settings=["start.equilibrium=true", "time.end_s=0.2", f"aero.grid.sectors='{sectors}'"])
            first, last = self.rows(sectors)[0], self.rows(sectors)[-1]
            self.assertGreater(abs(first["platform.pitch_deg"]), 0.1)
            self.assertGreater(last["rotor.thrust_N"], 1e6)

    def test_a_saved_state_starts_another_run(self):
        for text, name in ((ENGINEERING, "engineering"), (PARTICLES, "particles")):
            until, settings = 0.2, ["time.end_s=0.4"]
            self.spindrift(text, name, settings=settings)
            self.spindrift(text, name + "_first", "--until", until, settings=settings)
            (saved,) = (self.path / (name + "_first") / "checkpoints").glob("*.h5")
            start = [*settings, f"start.file='{saved}'", "start.air_steps=0", *(["sea.initial.settle_s=0"] if text is PARTICLES else [])]
            self.spindrift(text, name + "_second", settings=start, threads=2)
            after = [row for row in self.rows(name) if row["time_s"] > until + 1e-9]
            second = self.rows(name + "_second")
            self.assertAlmostEqual(second[0]["time_s"], until, delta=1e-12)  # the row of the start itself
            self.assertGreater(second[0]["rotor.thrust_N"], 3e5)
            self.assertEqual(second[1:], after)  # the same windows: the same bits
            # Another window, scheme and march from the same state: close, and not the same.
            self.spindrift(text, name + "_third", settings=[*start, "time.window_s=0.05", "coupling.scheme='cps'", "aero.flow.cfl_max=10"])
            third = self.rows(name + "_third")
            self.assertEqual(len(third), 5)
            self.assertAlmostEqual(third[-1]["platform.x_m"], after[-1]["platform.x_m"], delta=0.02 * abs(after[-1]["platform.x_m"]))
            self.assertNotEqual(third[-1]["platform.x_m"], after[-1]["platform.x_m"])
            # Much shorter ones: the air is where the rotor is, not where cps2 had foretold it for 0.1 s; no jolt.
            short = ["time.window_s=0.001", "time.end_s=0.203"] + (["time.step_s=0.001"] if text is ENGINEERING else [])
            self.spindrift(text, name + "_short", settings=[*start, *short])
            for row in self.rows(name + "_short"):
                self.assertAlmostEqual(row["rotor.thrust_N"] / second[0]["rotor.thrust_N"], 1.0, delta=0.1)
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


if __name__ == "__main__":
    unittest.main()
