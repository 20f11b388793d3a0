"""NACA 0012 with default settings, as a user runs it: every incidence converges in the balance of all equations, or says that it did not.
Usage: aerofoil_test.py SPINDRIFT [Fast|Nightly]"""
import csv
import itertools
import json
import unittest

from running import Folder, spindrift

SCENE = """
[time]
end_s = %d
window_s = 1.0
[environment]
air_density_kg_m3 = 1.225
[wind]
speed_m_s = 51.04            # Mach 0.15
[aero]
model = "blade_resolved"
[aero.flow]
incidence_deg = %g
viscosity_Pa_s = 1.04207e-5  # Re = 6e6
turbulence = "%s"
flux = "%s"
boundaries = [
  {patch = "wall", condition = "no_slip"},
  {patch = "farfield", condition = "far_field"},
  {patch = "outflow", condition = "far_field"},
]
[aero.flow.generate]
kind = "naca0012"
refinement = %d
far_m = 500.0
"""


class Runs(Folder):
    def aerofoil(self, incidence, turbulence="sa", flux="roe_low_mach", refinement=1, steps=600, settings=()):
        """Exit code, summary and last row of the history."""
        scene = self.path / "aerofoil.toml"
        scene.write_text(SCENE % (steps, incidence, turbulence, flux, refinement))
        done = spindrift("run", scene, "--out", self.out, "--overwrite", "--no-report", timeout=1500, settings=settings)
        self.words = done.stdout + done.stderr
        self.assertTrue((self.out / "summary.json").exists(), self.words)
        with open(self.out / "history.csv") as file:
            last = {key: float(value) for key, value in list(csv.DictReader(file))[-1].items()}
        return done.returncode, json.loads((self.out / "summary.json").read_text()), last


class Fast(Runs):
    def test_no_incidence_and_a_large_one_settle_with_default_settings(self):
        code, summary, last = self.aerofoil(0)
        self.assertEqual(code, 0, self.words)
        self.assertIn("flux balance fell by the drop asked for", summary["exit_reason"])
        self.assertLessEqual(last["flow.balance_drop"], 1e-6)
        self.assertLess(abs(last["flow.lift_coefficient"]), 1e-4)
        code, summary, last = self.aerofoil(15)
        self.assertEqual(code, 0, self.words)
        self.assertAlmostEqual(last["flow.lift_coefficient"], 1.456, delta=0.003)  # our own converged value

    def test_sections_without_friction_settle_with_default_settings(self):
        slip = ["aero.flow.viscous=none", "without=['aero.flow.turbulence','aero.flow.viscosity_Pa_s']", "aero.flow.boundaries[0].condition=slip",
                "aero.flow.generate.kind=aerofoil", "aero.flow.generate.naca='2412'"]
        for refinement in (1, 2):
            code, _, last = self.aerofoil(3, refinement=refinement, steps=100, settings=slip)
            self.assertEqual(code, 0, self.words)
            self.assertAlmostEqual(last["flow.lift_coefficient"], 0.628, delta=0.004)  # a thin one has 0.61

    def test_a_march_that_takes_all_its_steps_ends_with_3_names_the_place_and_goes_on(self):
        code, summary, last = self.aerofoil(10, steps=20)
        self.assertEqual(code, 3, self.words)
        self.assertEqual(summary["exit_code"], 3)
        for words in ("not converged in the", "the flux balance is at", "1e-06 is asked for", "aero.flow.drop", "worst are the balance of",
                      "in block", "cell (", ") m"):
            self.assertIn(words, summary["exit_reason"])
            self.assertIn(words, self.words)
        self.assertTrue(list((self.out / "checkpoints").iterdir()))
        again = spindrift("run", self.path / "aerofoil.toml", "--out", self.out, "--restart", "--no-report")
        self.assertEqual(again.returncode, 3, again.stdout + again.stderr)  # it has not converged by being looked at
        self.assertEqual(json.loads((self.out / "summary.json").read_text())["exit_reason"], summary["exit_reason"])

    def test_unsteady_windows_of_half_a_chord_converge_with_default_settings(self):
        code, summary, last = self.aerofoil(6, settings=('aero.flow.time="bdf2"', "aero.flow.drop=1e-3", "time.window_s=0.01", "time.end_s=0.06", "aero.flow.max_pseudo_steps=50"))
        self.assertEqual(code, 0, self.words)
        self.assertEqual(last["flow.unconverged_windows"], 0.0)
        self.assertLess(last["flow.pseudo_steps"], 15)  # with the stored matrix alone it has 6e-3 after 100

    def test_wilcox_1988_keeps_the_omega_of_its_stream_up_to_the_aerofoil(self):
        code, _, last = self.aerofoil(10, "k_omega_1988")
        self.assertEqual(code, 0, self.words)
        self.assertAlmostEqual(last["flow.lift_coefficient"], 1.069, delta=0.02)
        self.assertAlmostEqual(last["flow.drag_coefficient"], 0.0113, delta=0.001)  # with the omega that is left after 500 chords several times that

    def test_a_march_that_comes_to_nothing_begins_again_in_the_ways_there_are(self):
        steps_of_no_length = ("aero.flow.cfl=0.002", "aero.flow.cfl_max=0.002")
        ways = ("begins again from aero.flow.start = \"wind\" on the grid itself, without coarser grids",
                "begins again from aero.flow.start = \"wind\" on the grid itself, of first order until its balance has come to 0.01 or for 300 pseudo-steps",
                "begins again from aero.flow.start = \"wind\" on the grid itself, with the pseudo-time of low_mach = false")
        def marched(out, *more, steps=80, ranks=0):
            scene = self.path / "aerofoil.toml"
            scene.write_text(SCENE % (steps, 10, "sa", "roe_low_mach", 1))
            done = spindrift("run", scene, "--out", out, "--no-report", *more, settings=(*steps_of_no_length, "aero.flow.coarse_drop=1.0"), ranks=ranks)
            return done.returncode, done.stdout + done.stderr
        code, words = marched(self.out)
        self.assertEqual(code, 3, words)
        self.assertIn("not converged in the 80 pseudo-steps", words)
        for way in ways:
            self.assertEqual(words.count(way), 1, words)
        history = (self.out / "history.csv").read_bytes()
        self.assertEqual([float(row["flow.pseudo_steps"]) for row in csv.DictReader(history.decode().splitlines())], list(range(1, 81)))
        other = self.out.parent / "other"
        code, words = marched(other, "--until", "40", ranks=2)
        self.assertEqual(code, 0, words)
        code, words = marched(other, "--restart")
        self.assertEqual(code, 3, words)
        self.assertEqual((other / "history.csv").read_bytes(), history)


class Nightly(Runs):
    def test_forty_cases_converge_or_say_that_they_did_not(self):
        converged = 0
        for refinement, turbulence, flux, incidence in itertools.product((1, 2), ("sa", "sst"), ("roe_low_mach", "osher"), (0, 4, 10, 15, 17)):
            with self.subTest(refinement=refinement, turbulence=turbulence, flux=flux, incidence=incidence):
                code, summary, last = self.aerofoil(incidence, turbulence, flux, refinement)
                print(112 * refinement, turbulence, flux, incidence, code, last["flow.pseudo_steps"], "%.1e" % last["flow.balance_drop"],
                      "%.5f %.5f" % (last["flow.lift_coefficient"], last["flow.drag_coefficient"]), flush=True)
                self.assertIn(code, (0, 3), self.words)
                if code == 0:
                    converged += 1
                    self.assertLessEqual(last["flow.balance_drop"], 1e-6)
                    if incidence == 0:
                        self.assertLess(abs(last["flow.lift_coefficient"]), 1e-4)
                    if (refinement, turbulence, flux, incidence) == (2, "sa", "roe_low_mach", 15):
                        self.assertTrue(1.49 < last["flow.lift_coefficient"] < 1.57)
        self.assertGreaterEqual(converged, 36)

    def test_low_mach_numbers_converge_with_the_same_settings_to_the_lift_of_air_without_compression(self):
        _, _, plain = self.aerofoil(10)
        for mach in (0.05, 0.01, 0.003):
            speed = 51.04 * mach / 0.15
            code, _, last = self.aerofoil(10, settings=(f"wind.speed_m_s={speed}", f"aero.flow.viscosity_Pa_s={1.225 * speed / 6e6}"))
            print(mach, code, last["flow.pseudo_steps"], "%.5f %.5f" % (last["flow.lift_coefficient"], last["flow.drag_coefficient"]), flush=True)
            self.assertEqual(code, 0, self.words)
            prandtl_glauert = ((1.0 - mach**2) / (1.0 - 0.15**2)) ** 0.5
            self.assertAlmostEqual(last["flow.lift_coefficient"] * prandtl_glauert / plain["flow.lift_coefficient"], 1.0, delta=0.01)
            self.assertAlmostEqual(last["flow.drag_coefficient"] / plain["flow.drag_coefficient"], 1.0, delta=0.05)


if __name__ == "__main__":
    unittest.main()
