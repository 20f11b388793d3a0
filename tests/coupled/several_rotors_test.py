"""Two rotors on one floater, by the program: what check says of them, their columns, a restart and other threads with the same bits, a symmetric run that
keeps its heading. SPDX-License-Identifier: Apache-2.0"""
import unittest

import numpy

from running import columns, ROOT, Runs, spindrift

SCENE = ROOT / "inputs/control/twin_rotor_floater.toml"
CALM = ('without=["wind.turbulence", "waves"]', "time.end_s=20.0", "output.means_over_s=10.0")


class Twin(Runs):
    def test_check_tells_of_both_rotors(self):
        done = spindrift("check", SCENE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for words in ("rotor port", "rotor starboard", "turning counter-clockwise", "Rotor port at the start", "Rotor starboard at the start",
                      "Frequencies [Hz]: rotor port", "Static equilibrium"):
            self.assertIn(words, done.stdout)
        self.assertNotIn("warning:", done.stdout)
        behind = spindrift("check", SCENE, settings=("rotors.starboard.hub_m=[600.0,60.0,119.0]", *CALM)).stdout
        self.assertRegex(behind, r"rotors.starboard: 60\d.* m behind rotors.port in the wind")
        self.assertIn("wake, which is not modelled", behind)

    def test_against_each_other_the_heading_is_kept_and_alike_it_is_not(self):
        self.run_scene(SCENE, "against", settings=(*CALM, "start.equilibrium=false"))
        h = columns(self.path / "against/history.csv")
        numpy.testing.assert_allclose(h["rotor.port.thrust_N"], h["rotor.starboard.thrust_N"], rtol=1e-7)
        numpy.testing.assert_allclose(h["rotor.port.rpm"], h["rotor.starboard.rpm"], rtol=1e-9)
        self.assertGreater(h["rotor.port.torque_N_m"].min(), 5e6)
        self.assertLess(numpy.abs(h["platform.yaw_deg"]).max(), 1e-6)
        self.assertLess(numpy.abs(h["platform.roll_deg"]).max(), 1e-6)
        self.assertGreater(numpy.ptp(h["platform.x_m"]), 0.01)
        for name, unit in (("fx_N", 1.0), ("my_N_m", 1.0), ("fy_N", -1.0), ("mx_N_m", -1.0), ("mz_N_m", -1.0)):
            port, starboard = h[f"platform.rotor.port.{name}"], h[f"platform.rotor.starboard.{name}"]
            numpy.testing.assert_allclose(port, unit * starboard, rtol=1e-5, atol=1e-6 * max(abs(port).max(), 1.0))
        self.run_scene(SCENE, "alike", settings=(*CALM, 'rotors.starboard.turns="clockwise"'))
        self.assertGreater(numpy.abs(columns(self.path / "alike/history.csv")["platform.roll_deg"]).max(), 0.01)

    def test_each_follows_its_own_wind_and_restart_and_threads_have_the_same_bits(self):
        settings = ("time.end_s=20.0", "output.means_over_s=10.0")
        self.run_scene(SCENE, "whole", settings=settings)
        h = columns(self.path / "whole/history.csv")
        self.assertGreater(numpy.abs(h["rotor.port.wind_x_m_s"] - h["rotor.starboard.wind_x_m_s"]).max(), 0.5)
        self.assertGreater(numpy.abs(h["rotor.port.rpm"] - h["rotor.starboard.rpm"]).max(), 0.01)
        self.run_scene(SCENE, "parts", "--until", 9.3, settings=settings)
        self.run_scene(SCENE, "parts", "--restart", settings=settings)
        self.assertEqual(self.text("parts"), self.text("whole"))
        self.run_scene(SCENE, "threads", settings=settings, threads=2)
        self.assertEqual(self.text("threads"), self.text("whole"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
