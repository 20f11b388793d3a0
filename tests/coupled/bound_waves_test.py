"""Random seas of second order, by the program: their surface is that of Sharma & Dean's kernels, loads follow it, runs go on from a checkpoint with the same
bits, and what a scene may not ask of them is refused by name. SPDX-License-Identifier: Apache-2.0"""
import math
import unittest

import numpy

from running import columns, Folder, spindrift

HEIGHT, PERIOD, DEPTH, GRAVITY, COMPONENTS = 3.0, 9.0, 30.0, 9.80665, 40
SCENE = f"""
[time]
end_s = 160.0
window_s = 0.2
step_s = 0.2
[environment]
water_depth_m = {DEPTH}
[sea]
model = "morison"
drag_coefficient = 0.0
axial_drag_coefficient = 0.0
axial_added_mass_coefficient = 0.0
strip_length_m = 1.0
[bodies.pile]
mass_kg = 1e5
inertia_kg_m2 = [1e6, 1e6, 1e6]
centre_m = [0.0, 0.0, -5.0]
[[bodies.pile.cylinders]]
name = "shaft"
start_m = [0.0, 0.0, -20.0]
end_m = [0.0, 0.0, 8.0]
diameter_m = 2.0
[joints.held]
type = "fixed"
bodies = ["earth", "pile"]
point_m = [0.0, 0.0, -5.0]
[waves]
model = "jonswap"
height_m = {HEIGHT}
period_s = {PERIOD}
components = {COMPONENTS}
spacing = "equal_frequency"
seed = 7
ramp_s = 0.0
"""


def wave_number(omega):
    k = omega**2 / GRAVITY
    for _ in range(200):
        k = 0.5 * (k + omega**2 / (GRAVITY * math.tanh(k * DEPTH)))
    return k


class Pairs:
    """Sharma & Dean (1981): the waves that each two of a cos(phase - omega t) carry at the origin."""

    def __init__(self, a, omega, phase):
        self.pairs = []  # amplitude of the elevation, of the acceleration along x at z = 0, wave number, frequency, phase
        k, r = numpy.array([wave_number(w) for w in omega]), omega**2 / GRAVITY
        for i in range(len(a)):
            for j in range(len(a)):
                si, sj, product = math.sqrt(r[i]), math.sqrt(r[j]), r[i] * r[j]
                for sign in (-1.0, 1.0):
                    s, kk, d = si + sign * sj, k[i] + sign * k[j], 0.0
                    if kk != 0.0:
                        d = s * (sj * (k[i]**2 - r[i]**2) + sign * si * (k[j]**2 - r[j]**2)) + 2.0 * s**2 * (k[i] * k[j] - sign * product)
                        d /= s**2 - abs(kk) * math.tanh(abs(kk) * DEPTH)
                    rise = 0.25 * a[i] * a[j] * ((d - (k[i] * k[j] - sign * product)) / (si * sj) + r[i] + r[j])
                    pull = 0.25 * a[i] * a[j] * GRAVITY**2 / (omega[i] * omega[j]) * d * kk
                    self.pairs.append((rise, pull, abs(kk), omega[i] + sign * omega[j], phase[i] + sign * phase[j]))

    def elevation(self, t):
        return sum(rise * numpy.cos(phase - omega * t) for rise, _, _, omega, phase in self.pairs)

    def acceleration(self, t, z):
        return sum(pull * math.cosh(k * (z + DEPTH)) / math.cosh(k * DEPTH) * numpy.sin(phase - omega * t) for _, pull, k, omega, phase in self.pairs)


class BoundWaves(Folder):
    def run_scene(self, name, *settings, more=(), code=0):
        scene = self.path / "scene.toml"
        scene.write_text(SCENE)
        out = self.path / name
        done = spindrift("run", scene, "--out", out, "--no-report", "--quiet", *more, settings=settings)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return out / "history.csv" if code == 0 else done.stdout + done.stderr

    def test_the_surface_is_that_of_sharma_and_dean_and_loads_follow_it(self):
        linear, full = columns(self.run_scene("linear")), columns(self.run_scene("full", "waves.second_order=true"))
        t = linear["time_s"]
        peak = 2.0 * math.pi / PERIOD
        omega = peak * (0.5 + (numpy.arange(COMPONENTS) + 0.5) * 4.5 / COMPONENTS)  # equal steps from half the peak to five of it
        harmonics = numpy.hstack([numpy.cos(numpy.outer(t, omega)), numpy.sin(numpy.outer(t, omega))])
        fitted, *_ = numpy.linalg.lstsq(harmonics, linear["waves.elevation_m"], rcond=None)
        cosine, sine = fitted[:COMPONENTS], fitted[COMPONENTS:]
        carries = omega <= math.sqrt(2.0 * GRAVITY / HEIGHT)
        self.assertLess(carries.sum(), COMPONENTS)
        amplitude, phase = numpy.hypot(cosine, sine), numpy.arctan2(sine, cosine)
        pairs = Pairs(amplitude[carries], omega[carries], phase[carries])
        bound, expected = full["waves.elevation_m"] - linear["waves.elevation_m"], pairs.elevation(t)
        self.assertGreater(numpy.std(expected), 0.02)
        self.assertLess(numpy.abs(bound - expected).max(), 1e-6)
        self.assertGreater(full["waves.elevation_m"].max() + full["waves.elevation_m"].min(), 0.1)  # crests are higher, troughs flatter

        # The pile has no drag here: its load is (1 + C_a) rho A times the acceleration, up to the surface.
        def acceleration(z):
            k = numpy.array([wave_number(w) for w in omega])
            profile = numpy.where(z > 0.0, 1.0 / numpy.tanh(k * DEPTH) + k * z, numpy.cosh(k * (min(z, 0.0) + DEPTH)) / numpy.sinh(k * DEPTH))
            first = numpy.sin(phase - numpy.outer(t, omega)) @ (amplitude * omega**2 * profile)
            return first + pairs.acceleration(t, min(z, 0.0))

        heights, eta = numpy.linspace(-20.0, 4.0, 97), full["waves.elevation_m"]
        load, below = numpy.zeros_like(t), acceleration(heights[0])
        for low, high in zip(heights, heights[1:]):
            above = acceleration(high)
            share = numpy.clip((eta - low) / (high - low), 0.0, 1.0)
            load += share * (high - low) * (below + 0.5 * share * (above - below))
            below = above
        load *= 2.0 * 1025.0 * math.pi
        self.assertLess(numpy.std(full["pile.sea.fx_N"] - load), 0.01 * numpy.std(load))
        self.assertGreater(numpy.std(full["pile.sea.fx_N"] - linear["pile.sea.fx_N"]), 0.03 * numpy.std(load))

    def test_a_run_goes_on_with_the_same_bits(self):
        settings = ("waves.second_order=true", "time.end_s=20.0", "waves.ramp_s=15.0")
        whole = self.run_scene("whole", *settings)
        self.run_scene("parts", *settings, more=("--until", 8.0))
        parts = self.run_scene("parts", *settings, more=("--restart",))
        self.assertEqual(whole.read_bytes(), parts.read_bytes())
        self.assertIn("waves.second_order", self.run_scene("parts", *settings[1:], more=("--restart",), code=2))

    def test_what_a_scene_may_not_ask_of_it_is_refused_by_name(self):
        for change, key in [("waves.spreading_exponent=4.0", "waves.spreading_exponent"), ("waves.components=2000", "waves.components"),
                            ("waves.stretching='wheeler'", "waves.stretching"), ("waves.model='airy'", "waves.second_order"),
                            ("sea.coefficients=[{cylinder='shaft', diffraction='maccamy_fuchs'}]", "sea.coefficients[0].diffraction"),
                            ("waves.second_order='yes'", "waves.second_order")]:
            with self.subTest(change):
                self.assertIn(key, self.run_scene("refused", "waves.second_order=true", change, code=2))
        scene = self.path / "scene.toml"
        for change in ("sea.model='potential'", "sea.model='hydrostatic'"):
            done = spindrift("check", scene, settings=("waves.second_order=true", change))
            self.assertEqual(done.returncode, 2)

    def test_check_says_so_and_warns_of_shallow_water(self):
        scene = self.path / "scene.toml"
        scene.write_text(SCENE)
        said = spindrift("check", scene, settings=("waves.second_order=true",)).stdout
        self.assertIn("waves jonswap (H 3 m, T 9 s) to second order", said)
        said = spindrift("check", scene, settings=("waves.second_order=true", "waves.height_m=2.5", "waves.period_s=30.0", "environment.water_depth_m=20.5"))
        self.assertIn("Ursell number", said.stdout + said.stderr)


class Gauges(Folder):
    SETTINGS = ("waves.model=airy", "without=['waves.components', 'waves.spacing', 'waves.seed']", "time.end_s=20.0")

    def run_scene(self, name, more, settings=(), code=0):
        scene = self.path / f"{name}.toml"
        scene.write_text(SCENE + more)
        done = spindrift("run", scene, "--out", self.path / name, "--no-report", "--quiet", settings=(*self.SETTINGS, *settings))
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr if code else columns(self.path / name / "history.csv")

    def test_gauges_read_the_undisturbed_waves_where_they_are(self):
        k = wave_number(2 * math.pi / PERIOD)
        found = self.run_scene("still", f"""
[[sea.gauges]]
name = "half"
point_m = [{math.pi / k}, 5.0]
[[sea.gauges]]
name = "origin"
point_m = [0.0, 0.0]
[[sea.gauges]]
name = "quarter"
point_m = [{0.5 * math.pi / k}, 0.0]
""")
        t = found["time_s"]
        for name, phase in (("origin", 0.0), ("quarter", 0.5 * math.pi), ("half", math.pi)):
            numpy.testing.assert_allclose(found[f"{name}.elevation_m"], 0.5 * HEIGHT * numpy.cos(2 * math.pi * t / PERIOD - phase), atol=2e-3 * HEIGHT)
        numpy.testing.assert_array_equal(found["origin.elevation_m"], found["waves.elevation_m"])

    def test_a_gauge_goes_with_its_body_and_reads_the_water_over_its_mark(self):
        free = """
[joints.held.translation]
amplitude_m = 1.0
period_s = 5.0
[[sea.gauges]]
name = "gap"
point_m = [3.0, 0.0]
body = "pile"
"""
        found = self.run_scene("moved", free, ("joints.held.type=translational", "joints.held.axis=[0.0, 0.0, 1.0]"))
        self.assertGreater(numpy.ptp(found["pile.z_m"]), 1.9)
        numpy.testing.assert_allclose(found["gap.run_up_m"], found["gap.elevation_m"] - found["pile.z_m"], atol=1e-9)

    def test_what_a_gauge_may_not_ask_is_refused_by_name(self):
        gauge = lambda name, body="": f"[[sea.gauges]]\nname = '{name}'\npoint_m = [0.0, 0.0]\n" + (f"body = '{body}'\n" if body else "")
        for name, text, settings, words in (("twice", gauge("a") + gauge("a"), (), 'sea.gauges[1].name = "a": is the name of another gauge'),
                                            ("body", gauge("pile"), (), "bodies.pile: is the name of a gauge, probe or sensor too"),
                                            ("nobody", gauge("a", "pole"), (), "names 'pole', which is not in [bodies]"),
                                            ("dotted", gauge("a.b"), (), "must be a name without spaces, commas, dots and quotes")):
            with self.subTest(name):
                self.assertIn(words, self.run_scene(name, text, settings, 2))
        calm = self.path / "calm.toml"
        calm.write_text(SCENE.partition("[waves]")[0] + gauge("a"))
        self.assertIn("sea.gauges[0]: has no effect: there are no waves", spindrift("check", calm).stderr)


if __name__ == "__main__":
    unittest.main()
