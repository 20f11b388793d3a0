"""Bodies and walls from STL files: inputs/validation/stl_buoy as a user checks, spoils and runs it. Usage: stl_test.py SPINDRIFT Fast|Nightly.
SPDX-License-Identifier: Apache-2.0"""
import csv
import math
import os
import re
import shutil
import struct
import time
import unittest

from running import Folder, REPLICA, ROOT, spindrift

SCENE = ROOT / "inputs/validation/stl_buoy"

BOX_2D = """
[time]
end_s = 1.2
window_s = 0.02
[environment]
gravity_m_s2 = 9.81
water_density_kg_m3 = 1000.0
water_depth_m = 0.6
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 0.025
[sea.tank]
x_m = [-0.9, 0.9]
top_m = 0.3
[sea.initial]
settle_s = 0.3
settle_damping_1_s = 5.0
[bodies.box]
mass_kg = 100.0
inertia_kg_m2 = [3.0, 3.0, 3.0]
centre_m = [0.0, 0.0, -0.1]
[[bodies.box.meshes]]
name = "hull"
file = "box.stl"
scale = 0.001
"""


def box_stl(low, high):
    """An ASCII file of a box, in millimetres."""
    at = lambda n: [1e3 * (high if n >> k & 1 else low)[k] for k in range(3)]
    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    facets = [(q[0], q[a], q[a + 1]) for q in quads for a in (1, 2)]
    lines = [" outer loop\n" + "".join("  vertex {} {} {}\n".format(*at(n)) for n in facet) + " endloop\nendfacet\n" for facet in facets]
    return "solid box\n" + "".join("facet normal 0 0 0\n" + text for text in lines) + "endsolid box\n"


class Buoy(Folder):
    def run_scene(self, name, *arguments, scene=SCENE / "stl_buoy.toml", settings=(), threads=1):
        done = spindrift("run", scene, "--out", self.path / name, "--no-report", "--quiet", *arguments, settings=[*settings, *REPLICA], timeout=1800,
                         env={**os.environ, "OMP_NUM_THREADS": str(threads)})
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.path / name / "history.csv").read_text()


class Fast(Buoy):
    def test_check_prints_the_statics_that_formulas_give(self):
        said = spindrift("check", SCENE / "stl_buoy.toml").stdout
        for figure in ("44 triangles, 1.4 x 1.4 x 1.1 m", "1.07009 m3 about", "0.58635 m3 (586.35 kg) under water", "0, -0.270939) m", "1.2751 m2",
                       "+0.1502 m in roll, +0.1502 m in pitch"):
            self.assertIn(figure, said.replace("(-0, ", "(0, "))
        self.assertNotIn("Doubts", said)

    def test_threads_and_restarts_leave_every_bit_as_it_is(self):
        coarse = ["sea.particles.spacing_m=0.2", "sea.initial.settle_s=0.0", "sea.initial.settle_damping_1_s=0.0", "time.end_s=0.12"]
        whole = self.run_scene("whole", settings=coarse)
        self.assertEqual(self.run_scene("threads", settings=coarse, threads=2), whole)
        self.run_scene("parts", "--until", 0.06, settings=coarse)
        self.assertEqual(self.run_scene("parts", "--restart", settings=coarse, threads=2), whole)

    def test_a_box_of_triangles_floats_at_its_draft_in_the_plane(self):
        scene = self.path / "box.toml"
        scene.write_text(BOX_2D)
        (self.path / "box.stl").write_text(box_stl((-0.25, -0.1, -0.2), (0.25, 0.1, 0.15)))
        said = spindrift("check", scene).stdout
        for figure in ("12 triangles, 0.5 x 0.2 x 0.35 m; of its outline in the plane y = 0 m, 1 m wide", "0.175 m3 about", "0.1 m3 (100 kg) under water",
                       "0.5 m2; metacentre over the centre of mass: +0.1042 m in pitch", "the mass times 0.0310417 m2 in pitch"):
            self.assertIn(figure, said)
        refused = spindrift("check", scene, settings=["bodies.box.meshes[0].scale=1.0"])
        self.assertEqual(refused.returncode, 2, refused.stdout)
        self.assertIn("its mesh is 500 x 350 m in the plane: look at its scale", refused.stderr)   # no width: that of the prism is nobody's
        rows = [row for row in csv.DictReader(self.run_scene("whole", scene=scene).splitlines()) if float(row["time_s"]) > 0.2]
        heave = sum(float(row["box.z_m"]) for row in rows) / len(rows)
        print(f"box in the plane: mean heave {1e3 * heave:.2f} mm of 200 mm draft", flush=True)
        self.assertLess(abs(heave), 0.02 * 0.2)  # six jittered starts: 0.77 to 0.88 mm
        self.assertAlmostEqual(float(re.search(r"it floats (\S+) m from there", said)[1]), heave, delta=0.02 * 0.2)

    def test_a_changed_file_refuses_the_restart_by_its_name(self):
        shutil.copytree(SCENE, self.path / "scene")
        scene, hull = self.path / "scene/stl_buoy.toml", self.path / "scene/buoy.stl"
        coarse = ["sea.particles.spacing_m=0.2", "sea.initial.settle_s=0.0", "sea.initial.settle_damping_1_s=0.0", "time.end_s=0.08"]
        self.run_scene("parts", "--until", 0.04, scene=scene, settings=coarse)
        text = hull.read_text()
        hull.write_text(text.replace("solid buoy", "solid another"))
        done = spindrift("run", scene, "--out", self.path / "parts", "--restart", "--no-report", "--quiet", settings=coarse)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("buoy.stl", done.stderr)
        hull.write_text(text)
        self.run_scene("parts", "--restart", scene=scene, settings=coarse)

    def test_what_is_wrong_with_a_file_is_said_with_its_place(self):
        shutil.copytree(SCENE, self.path / "scene")
        scene, hull = self.path / "scene/stl_buoy.toml", self.path / "scene/buoy.stl"
        text = hull.read_text()
        facets = text.split("facet normal")
        one_facet_less = "facet normal".join(facets[:-1]) + "endsolid buoy\n"
        corners = [[float(x) for x in line.split()[1:]] for line in text.splitlines() if "vertex" in line]
        binary = bytes(80) + struct.pack("<I", 44)
        for n in range(0, len(corners), 3):
            binary += struct.pack("<12fH", 0, 0, 0, *corners[n], *corners[n + 1], *corners[n + 2], 0)
        many, one_more = (binary[:80] + struct.pack("<I", count) + binary[84:] for count in (2**32 - 1, 45))
        not_a_number = binary[:96] + struct.pack("<f", math.nan) + binary[100:]
        for spoilt, *words in ((text.replace("vertex", "vertax", 1), "buoy.stl:4", "'vertax'"), (text[:800], "buoy.stl:", "ends where"),
                               (one_facet_less, "3 open edges", "0.5)"), ("solid\nendsolid\n", "no facets"), (text[6:200], "no STL file"),
                               (binary[:1000], "44 facets (byte 80)", "2284 bytes", "cut off"), (many, "4294967295 facets (byte 80)"),
                               (one_more, "45 facets (byte 80)"), (bytes(84), "no facets"), (not_a_number, "byte 96", "facet 1", "nan")):
            hull.write_bytes(spoilt if isinstance(spoilt, bytes) else spoilt.encode())
            for command in (["check", scene], ["run", scene, "--out", self.path / "none", "--no-report"]):
                begin = time.monotonic()
                done = spindrift(*command)
                self.assertLess(time.monotonic() - begin, 20.0)  # no long work before; starting the program is most of it
                self.assertEqual(done.returncode, 2, done.stderr)
                for word in ("bodies.buoy.meshes[0].file", "buoy.stl", *words):
                    self.assertIn(word, done.stderr)
        self.assertFalse((self.path / "none").exists())
        hull.write_bytes(binary)
        self.assertIn("1.07009 m3 about", spindrift("check", scene).stdout)
        hull.write_text(text)
        said = spindrift("check", scene, settings=["bodies.buoy.meshes[0].scale=1000.0"])
        self.assertEqual(said.returncode, 2)
        self.assertIn("look at its scale", said.stderr)
        mesh = f'bodies.spar.meshes=[{{name="hull", file="{hull}"}}]'
        said = spindrift("check", ROOT / "inputs/validation/oc3_heave_decay/oc3_heave_decay.toml", settings=[mesh])
        self.assertEqual(said.returncode, 2)
        self.assertIn('bodies.spar.meshes: has no effect: only sea.model = "sph"', said.stderr)

    def test_a_unit_that_does_not_fit_the_mass_and_parts_that_overlap_are_doubted(self):
        shutil.copytree(SCENE, self.path / "scene")
        scene, hull = self.path / "scene/stl_buoy.toml", self.path / "scene/buoy.stl"
        said = spindrift("check", scene, settings=["bodies.buoy.mass_kg=0.5", "bodies.buoy.inertia_kg_m2=[0.1, 0.1, 0.1]"])
        self.assertIn("0.001 for one in millimetres", said.stdout)
        hull.write_text(box_stl((-0.25, -0.1, -0.2), (0.25, 0.1, 0.15)) + box_stl((0.1, -0.05, -0.1), (0.4, 0.05, 0.1)))
        said = spindrift("check", scene, settings=["bodies.buoy.meshes[0].scale=0.001"])
        self.assertRegex(said.stdout, r"facets \d+ and \d+ cut through each other at \(0\.25, ")


class Nightly(Buoy):
    def test_the_buoy_stays_at_its_draft(self):
        self.run_scene("whole", threads=os.cpu_count())
        with open(self.path / "whole/history.csv") as file:
            rows = [row for row in csv.DictReader(file) if float(row["time_s"]) > 0.5]
        heave = sum(float(row["buoy.z_m"]) for row in rows) / len(rows)
        print(f"mean heave {1e3 * heave:.2f} mm", flush=True)
        self.assertLess(abs(heave), 0.01)


if __name__ == "__main__":
    unittest.main()
