"""The scene as surfaces: bodies carried by their motion, blades as the resolved grid has them, lines of their length; surfaces for ParaView.
Run by ctest with the distribution's Python. SPDX-License-Identifier: Apache-2.0"""
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(HERE), str(ROOT / "src/report")]
sys.dont_write_bytecode = True

import cut
import geometry
import geometry_fields
import painted
import run_fields
import synthetic_run
import wake
from run_data import RunData

SCENE = f"""
[rotor]
body = "rotor"
joint = "bearing"
turbine = "{ROOT}/inputs/turbines/dtu_10mw.toml"
[bodies.platform]
mass_kg = 1.0
centre_m = [0.0, 0.0, 16.0]
reference_m = [0.0, 0.0, -4.0]
[[bodies.platform.cylinders]]
name = "float"
start_m = [40.0, 0.0, -14.0]
end_m = [40.0, 0.0, 12.0]
diameter_m = 11.0
[bodies.rotor]
mass_kg = 1.0
[joints.bearing]
bodies = ["platform", "rotor"]
point_m = [0.0, 0.0, 119.0]
axis = [1.0, 0.0, 0.0]
[moorings.line]
body = "platform"
fairlead_m = [40.0, 0.0, -7.0]
anchor_m = [150.0, 0.0, -20.0]
rest_length_m = 113.0
[waves]
model = "airy"
height_m = 2.0
period_s = 8.0
[environment]
water_depth_m = 20.0
"""


class Surfaces(unittest.TestCase):
    def test_an_stl_file_is_drawn_where_the_scene_puts_it_whichever_kind_it_is(self):
        source = ROOT / "inputs/validation/stl_buoy/buoy.stl"
        points, triangles = geometry.mesh({"file": str(source), "scale": 2.0, "position_m": [1.0, 0.0, 0.0]})
        self.assertEqual((len(points), len(triangles)), (24, 44))
        np.testing.assert_allclose([points.min(axis=0), points.max(axis=0)], [[-0.4, -1.4, -1.2], [2.4, 1.4, 1.0]])
        corners = geometry.mesh({"file": str(source)})
        with tempfile.TemporaryDirectory() as folder:
            binary = np.zeros(44, np.dtype([("corners", "<f4", 12), ("rest", "<u2")]))
            binary["corners"][:, 3:] = corners[0][np.array(corners[1])].reshape(44, 9)
            path = pathlib.Path(folder) / "buoy.stl"
            path.write_bytes(bytes(80) + (44).to_bytes(4, "little") + binary.tobytes())
            again = geometry.mesh({"file": str(path)})
        np.testing.assert_allclose(again[0][np.array(again[1])], corners[0][np.array(corners[1])], atol=1e-6)
        self.assertEqual(geometry.mesh({"file": "/nowhere.stl"})[1], [])


class Geometry(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "run"
        t = 0.1 * np.arange(401)
        zero = 0 * t
        table = {"time_s": t} | {f"platform.{name}": zero for name in ("y_m", "z_m", "roll_deg", "yaw_deg")}
        table |= {"platform.x_m": 0.1 * t, "platform.pitch_deg": 0.25 * t, "rotor.thrust_N": zero, "rotor.azimuth_deg": (60.0 * t) % 360.0,
                  "waves.elevation_m": np.cos(2 * np.pi * t / 8.0)}
        synthetic_run.write(self.folder, table=table, scene=SCENE)
        self.scene = geometry.Scene3d(RunData(self.folder))

    def kinds(self, t):
        found = {}
        for piece in self.scene.pieces(t):
            found.setdefault(piece.kind, []).append(piece)
        return found

    def test_what_the_scene_does_not_describe_is_said_to_be_sketched(self):
        self.assertEqual(self.scene.sketched, ["tower", "nacelle", "braces"])

    def test_everything_is_there(self):
        self.assertEqual({kind: len(pieces) for kind, pieces in self.kinds(0.0).items()},
                         {"float": 1, "tower": 1, "nacelle": 1, "brace": 2, "hub": 1, "blade": 3, "line": 1})

    def test_a_turbine_on_the_ground_has_a_tower_from_its_foundation_to_its_hub(self):
        t = 0.1 * np.arange(11)
        table = {"time_s": t} | {f"turbine.{name}": 0 * t for name in ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")} | {"rotor.thrust_N": 0 * t}
        synthetic_run.write(self.folder.with_name("fixed"), table=table, scene="[bodies.turbine]\nmass_kg = 1e6\ncentre_m = [0.0, 0.0, 80.0]\n[joints.foundation]\n"
                            "type = 'fixed'\nbodies = ['earth', 'turbine']\npoint_m = [0.0, 0.0, 12.0]\n[rotor]\nbody = 'turbine'\nhub_m = [0.0, 0.0, 119.0]\n")
        self.scene = geometry.Scene3d(RunData(self.folder.with_name("fixed")))
        found = self.kinds(1.0)
        self.assertEqual({kind: len(pieces) for kind, pieces in found.items()}, {"tower": 1, "nacelle": 1, "hub": 1, "blade": 3})
        self.assertAlmostEqual(found["tower"][0].points[:, 2].min(), 12.0)
        self.assertAlmostEqual(found["hub"][0].points[:, 2].mean(), 119.0)

    def drawn(self, name, scene, **angles):
        """Pieces at the start of a run of this scene, by kind."""
        t = 0.1 * np.arange(11)
        bodies = {name for name in ("spar", "nacelle") if f"[bodies.{name}]" in scene}
        table = {"time_s": t} | {f"{body}.{q}": angles.get(f"{body}_{q}", 0.0) + 0 * t for body in bodies for q in ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")}
        synthetic_run.write(self.folder.with_name(name), table=table | {"rotor.thrust_N": 0 * t}, scene=scene)
        self.scene = geometry.Scene3d(RunData(self.folder.with_name(name)))
        return self.kinds(1.0)

    SPAR = ("[bodies.spar]\nmass_kg = 1e6\ncentre_m = [0.0, 0.0, -80.0]\n[[bodies.spar.cylinders]]\nstart_m = [0.0, 0.0, -120.0]\nend_m = [0.0, 0.0, 10.0]\ndiameter_m = 6.5\n"
            "[rotor]\nbody = 'spar'\nhub_m = [-5.0, 0.0, 90.0]\n")

    def test_lines_at_a_junction_end_where_it_is(self):
        scene = ("[bodies.spar]\nmass_kg = 1e6\n[junctions.crow]\nposition_m = [40.0, 0.0, -30.0]\n[moorings.main]\nbody = 'crow'\nanchor_m = [90.0, 0.0, -60.0]\n"
                 "[moorings.leg]\nbody = 'spar'\nfairlead_m = [4.0, 0.0, -10.0]\nanchor_body = 'crow'\n")
        ends = lambda found: [tuple(p) for piece in found["line"] for p in (piece.points[0], piece.points[-1])]
        self.assertEqual(ends(self.drawn("crow", scene)), [(90.0, 0.0, -60.0), (40.0, 0.0, -30.0), (40.0, 0.0, -30.0), (4.0, 0.0, -10.0)])
        t = 0.1 * np.arange(11)
        table = {"time_s": t} | {f"spar.{q}": 0 * t for q in ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")}
        table |= {"crow.at_x_m": 41.0 + 0 * t, "crow.at_y_m": 2.0 + 0 * t, "crow.at_z_m": -29.0 + 0 * t}
        synthetic_run.write(self.folder.with_name("moved"), table=table, scene=scene)
        self.scene = geometry.Scene3d(RunData(self.folder.with_name("moved")))
        self.assertEqual(ends(self.kinds(1.0))[1:3], [(41.0, 2.0, -29.0)] * 2)

    def test_the_tower_of_a_spar_stands_on_its_axis(self):
        tower = self.drawn("on_spar", self.SPAR)["tower"][0].points
        foot = tower[tower[:, 2] < tower[:, 2].min() + 1e-9]
        np.testing.assert_allclose(foot.mean(axis=0), [0.0, 0.0, 10.0], atol=1e-9)
        self.assertLessEqual(np.hypot(*foot[:, :2].T).max(), 0.5 * 6.5)   # on the hull, not over its edge

    def test_a_tower_that_the_scene_describes_is_drawn_as_described(self):
        stations = "[aero.tower]\nfoot_m = [1.0, 2.0]\nstations = [[12.0, 6.0, 0.5], [50.0, 5.0, 0.5], [88.0, 4.0, 0.5]]\n"
        pieces = self.drawn("stations", self.SPAR + stations)["tower"]
        self.assertEqual(len(pieces), 2)
        every = np.concatenate([p.points for p in pieces])
        np.testing.assert_allclose([every[:, 2].min(), every[:, 2].max(), every[:, 0].max()], [12.0, 88.0, 4.0], atol=1e-2)

    def test_a_beam_is_drawn_bent_between_its_bodies(self):
        beam = ("[bodies.nacelle]\nmass_kg = 1e5\ncentre_m = [0.0, 0.0, 90.0]\n[beams.tower]\nbodies = ['spar', 'nacelle']\nstart_m = [0.0, 0.0, 10.0]\n"
                "end_m = [0.0, 0.0, 88.0]\nproperties = 'none.csv'\n")
        found = self.drawn("bent", self.SPAR.replace("body = 'spar'\nhub_m", "body = 'nacelle'\nhub_m") + beam, nacelle_x_m=2.0)
        self.assertEqual({kind: len(pieces) for kind, pieces in found.items()}, {"float": 1, "tower": 1, "nacelle": 1, "hub": 1, "blade": 3})
        tower = found["tower"][0].points
        self.assertTrue(found["tower"][0].bends)
        rows = [tower[abs(tower[:, 2] - z) < 2.5][:, 0].mean() for z in (10.0, 49.0, 88.0)]
        np.testing.assert_allclose(rows, [0.0, 1.0, 2.0], atol=0.05)

    def test_bodies_are_carried_about_their_reference_point(self):
        start, end = (self.kinds(t)["float"][0].points for t in (0.0, 40.0))
        np.testing.assert_allclose(start.mean(axis=0), [40.0, 0.0, -1.0], atol=1e-9)
        turn = geometry.about(np.array([0.0, 1.0, 0.0]), np.radians(10.0))
        np.testing.assert_allclose(end.mean(axis=0), turn @ [40.0, 0.0, 3.0] + [4.0, 0.0, -4.0], atol=1e-9)

    def test_a_grid_of_one_sector_stays_upright_and_follows_the_hub_along_its_axis(self):
        """The platform leans by 10 degrees and moves by 4 m: the hub, 123 m above its reference, goes downwind by some 25 m and sinks."""
        hub, frame = self.scene.rotor.sector(40.0)
        np.testing.assert_allclose(frame, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(hub, [4.0 + 123.0 * np.sin(np.radians(10.0)), 0.0, 119.0], atol=1e-9)
        np.testing.assert_allclose(self.scene.rotor.frame(40.0)[0], [np.cos(np.radians(10.0)), 0.0, -np.sin(np.radians(10.0))], atol=1e-12)

    def test_blades_are_a_third_of_a_turn_apart_lean_upwind_and_turn_towards_minus_y(self):
        blades = [piece.points for piece in self.kinds(0.0)["blade"]]
        tips = [b[np.argmax(np.linalg.norm(b - self.scene.rotor.hub(0.0), axis=1))] - self.scene.rotor.hub(0.0) for b in blades]
        self.assertGreater(tips[0][2], 85.0)
        self.assertLess(tips[0][0], -3.0)   # precone of 2.5 degrees, and prebend upwind
        self.assertLess(tips[1][1], -70.0)  # what comes next in the sense of turning
        later = self.kinds(1.0)["blade"][0].points
        self.assertLess((later - self.scene.rotor.hub(1.0))[:, 1].min(), -70.0)

    def test_of_two_rotors_each_has_its_tower_and_its_blades_and_one_is_the_others_mirror_image(self):
        t = 0.1 * np.arange(11)
        names = ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")
        table = {"time_s": t} | {f"platform.{name}": 0 * t for name in names}
        for rotor in ("port", "starboard"):
            table |= {f"rotor.{rotor}.thrust_N": 0 * t, f"rotor.{rotor}.azimuth_deg": 20.0 + 50.0 * t}
        sides = {"port": (105.0, ""), "starboard": (-105.0, "turns = 'counter_clockwise'\n")}
        scene = "[bodies.platform]\nmass_kg = 1e7\ncentre_m = [0.0, 0.0, -5.0]\n[aero.tower]\nstations = [[12.0, 8.0, 1.0], [115.0, 5.0, 1.0]]\n"
        for rotor, (y, more) in sides.items():
            scene += (f"[rotors.{rotor}]\nbody = 'platform'\nhub_m = [-7.0, {y}, 119.0]\nturbine = '{ROOT}/inputs/turbines/dtu_10mw.toml'\n"
                      f"tower_foot_m = [0.0, {y}]\n{more}")
            scene += f"[[bodies.platform.cylinders]]\nstart_m = [0.0, {y}, -20.0]\nend_m = [0.0, {y}, 12.0]\ndiameter_m = 12.0\n"
        synthetic_run.write(self.folder.with_name("twin"), table=table, scene=scene)
        self.scene = geometry.Scene3d(RunData(self.folder.with_name("twin")))
        found = self.kinds(1.0)
        self.assertEqual({kind: len(pieces) for kind, pieces in found.items() if kind != "brace"}, {"float": 2, "tower": 2, "nacelle": 2, "hub": 2, "blade": 6})
        for n, (y, _) in enumerate(sides.values()):
            self.assertAlmostEqual(found["tower"][n].points[:, 1].mean(), y)
            self.assertAlmostEqual(found["hub"][n].points[:, 1].mean(), y)
        for port, starboard in zip(found["blade"][:3], found["blade"][3:]):
            np.testing.assert_allclose(starboard.points, port.points * [1.0, -1.0, 1.0], atol=1e-9)
            self.assertEqual(starboard.polygons[0], port.polygons[0][::-1])
        self.assertLess((found["blade"][0].points[:, 1] - 105.0).min(), -70.0)   # at 70 degrees, towards -y

    def test_lines_have_their_length_and_end_where_they_should(self):
        for length, rise in ((113.0, 13.0), (140.0, 13.0), (1000.0, 300.0), (902.2, 250.0)):
            fairlead, anchor = np.array([5.2, 0.0, -70.0]), np.array([5.2 + np.sqrt(max(length**2 * 0.86, 110.0**2)) * 0.97, 0.0, -70.0 - rise])
            points = geometry.hanging(fairlead, anchor, length)
            self.assertEqual(len(points), 40)
            np.testing.assert_allclose([points[0], points[-1]], [anchor, fairlead], atol=1e-6)
            drawn = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
            straight = np.linalg.norm(fairlead - anchor)
            self.assertLess(abs(drawn - max(length, straight)), 0.02 * length, (length, rise, straight))
            self.assertGreaterEqual(points[:, 2].min(), anchor[2] - 1e-6)

    def test_waves_travel_downwind_and_repeat_beyond_the_run(self):
        x = np.array([0.0, 5.0, -500.0, 500.0])
        now = self.scene.elevation(x, 16.0)
        self.assertAlmostEqual(now[0], 1.0, delta=1e-3)
        self.assertLess(now[1], 1.0)
        self.assertTrue((np.abs(now) <= 1.0).all())
        self.assertGreater(self.scene.elevation(x, 16.5)[1], now[1])   # the crest comes to where x is larger

    def test_surfaces_for_paraview_read_back(self):
        import h5py
        (self.folder / "fields").mkdir()
        written = geometry_fields.write(RunData(self.folder))
        self.assertEqual([path.name for path in written], ["paraview.py", "geometry.xdmf"])
        compile(written[0].read_text(), "paraview.py", "exec")
        steps = xml.etree.ElementTree.parse(written[1]).getroot().findall(".//Grid/Grid")
        self.assertEqual(len(steps), 50)
        with h5py.File(self.folder / "fields/geometry.h5") as file:
            flat, kinds, at, count = file["cells"][...], file["kind"][...], 0, 0
            while at < len(flat):
                self.assertIn(flat[at], (2, 3))
                self.assertLess(flat[at + 2: at + 2 + flat[at + 1]].max(), len(file["points_0"]))
                at, count = at + 2 + flat[at + 1], count + 1
            self.assertEqual(count, len(kinds))
            self.assertEqual(set(kinds), set(range(len(geometry_fields.KINDS))))
            self.assertTrue(all(file[f"points_{n}"].shape == file["points_0"].shape for n in range(50)))

    def test_the_wake_for_paraview_is_the_slow_air_in_the_upright_plane_through_the_axis(self):
        """Air that is at half the wind in a tube behind the disc: there is 0.5 in the wake's surface, which lies in the plane of the axis as it leans then."""
        import h5py
        (self.folder / "fields").mkdir()
        nodes = np.stack(np.meshgrid(np.linspace(-50.0, 250.0, 31), np.linspace(-130.0, 130.0, 27), np.linspace(-10.0, 250.0, 27), indexing="ij"), axis=-1).transpose(2, 1, 0, 3)
        for n, t in enumerate((0.0, 20.0)):
            hub, frame = self.scene.rotor.hub(t), self.scene.rotor.frame(t)
            middle = nodes
            for axis in range(3):
                middle = cut.between(middle, axis)
            along = (middle - hub) @ frame.T
            slow = (along[..., 0] > 0.0) & (np.hypot(along[..., 1], along[..., 2]) < 70.0)
            with h5py.File(self.folder / f"fields/air_{n}.h5", "w") as file:
                file.attrs["time_s"] = t
                file["box/points"] = nodes
                file["box/velocity"] = np.where(slow, 0.5, 1.0)[..., None] * 11.4 * frame[0]
        with open(self.folder / "scene.toml", "a", encoding="utf-8") as scene:
            scene.write("\n[wind]\nspeed_m_s = 11.4\n[aero]\nmodel = 'actuator_disc'\n")
        written = geometry_fields.write(RunData(self.folder))
        self.assertEqual([path.name for path in written], ["paraview.py", "geometry.xdmf", "wake.xdmf"])
        compile(written[0].read_text(), "paraview.py", "exec")
        times = [float(time.get("Value")) for time in xml.etree.ElementTree.parse(written[2]).getroot().iter("Time")]
        self.assertEqual(times, [0.0, 20.0])
        with h5py.File(self.folder / "fields/wake.h5") as file:
            for n, t in enumerate(times):
                points, wind = file[f"points_{n}"][...], file[f"axial_wind_{n}"][...]
                local = (points - self.scene.rotor.hub(t)) @ self.scene.rotor.frame(t).T
                np.testing.assert_allclose(local[:, 1], 0.013 * wake.tip(self.scene), atol=1e-3)
                inside = (local[:, 0] > 20.0) & (abs(local[:, 2]) < 50.0)
                self.assertGreater(inside.sum(), 100)
                np.testing.assert_allclose(wind[inside], 0.5, atol=1e-5)
                self.assertLess(abs(local[:, 2]).max(), 95.0)   # free air is left out
                self.assertEqual(file[f"cells_{n}"][...].max() + 1, len(points))

    def test_points_of_a_grid_that_stands_are_where_the_file_says_and_blocks_come_in_pieces_without_gaps(self):
        import h5py
        folder = self.folder / "fields"
        folder.mkdir()
        nodes = np.stack(np.meshgrid(np.arange(6.0), np.arange(36.0), np.arange(41.0), indexing="ij"), axis=-1)
        pressure = np.arange(5.0 * 35 * 40).reshape(5, 35, 40)
        for n in (1, 2):
            with h5py.File(folder / f"air_{n}.h5", "w") as file:
                file.attrs["time_s"], file.attrs["points_file"] = float(n), "air_1.h5"
                file["box/pressure"] = n * pressure
                if n == 1:
                    file["box/points"] = nodes
        block = run_fields.grid(folder / "air_2.h5")["box"]
        np.testing.assert_array_equal(block["points"], nodes)
        pieces, seen = run_fields.pieces(block, 16), np.zeros(pressure.shape, int)
        self.assertEqual(len(pieces), 9)
        for piece in pieces:
            low = piece["points"][0, 0, 0].astype(int)
            here = tuple(slice(a, a + n) for a, n in zip(low, piece["pressure"].shape))
            seen[here] += 1
            self.assertLessEqual(max(piece["pressure"].shape), 16)
            np.testing.assert_array_equal(piece["pressure"], 2 * pressure[here])
            np.testing.assert_array_equal(piece["points"][-1, -1, -1], low + piece["pressure"].shape)
        self.assertTrue((seen == 1).all())
        section = {"points": nodes[:2], "pressure": pressure[:1]}
        self.assertEqual(run_fields.pieces(section, 16), [section])
        (folder / "air_1.h5").unlink()
        with self.assertRaisesRegex(ValueError, "points of its grid are in air_1.h5, which is not there"):
            run_fields.grid(folder / "air_2.h5")
        with h5py.File(folder / "air_2.h5", "a") as file:
            del file.attrs["points_file"]   # as earlier versions wrote
        with self.assertRaisesRegex(ValueError, "no points of its block 'box': fields of an earlier version"):
            run_fields.grid(folder / "air_2.h5")

    def test_holes_in_the_surface_are_closed(self):
        z = np.zeros((9, 9))
        z[4, 4] = -20.0
        np.testing.assert_array_equal(run_fields.without_holes(z, -20.0), np.zeros((9, 9)))

    def test_a_far_sea_ends_in_a_circle_and_is_not_folded(self):
        along = np.concatenate([-np.geomspace(8.0, 400.0, 25)[::-1], np.geomspace(8.0, 400.0, 25)])
        x, y = geometry.round_edge(*np.meshgrid(along, along), 8.0, 400.0)
        np.testing.assert_allclose(np.hypot(x, y)[[0, -1]], 400.0)
        self.assertTrue((np.diff(x, axis=1) > 0.0).all() and (np.diff(y, axis=0) > 0.0).all())
        np.testing.assert_allclose(geometry.round_edge(np.array([3.0]), np.array([-8.0]), 8.0, 400.0), [[3.0], [-8.0]])

    def test_water_beside_a_float_has_the_height_of_the_water_around(self):
        """A mesh of 20 m: cells that a float of 12 m stands in are not let down by it."""
        import h5py
        with tempfile.TemporaryDirectory() as folder:
            run = synthetic_run.write(pathlib.Path(folder) / "run")
            (run / "fields").mkdir()
            x, y = np.meshgrid(np.arange(-60.0, 61.0, 5.0), np.arange(-40.0, 41.0, 5.0))
            with h5py.File(run / "fields/surface_000000.h5", "w") as file:
                file.attrs["time_s"] = 0.0
                z = np.where((abs(x) < 8.0) & (abs(y) < 8.0), -2.5, 0.3)
                file["water/points"] = np.stack([np.stack([x, y, h], axis=-1) for h in (np.full(x.shape, -30.0), z)])
            fields, float_ = run_fields.Fields(RunData(run)), np.array([[-6.0, -6.0, -12.0], [6.0, 6.0, 4.0]])
            self.assertEqual(fields.surface(0.0)[2].min(), -2.5)
            np.testing.assert_allclose(fields.surface(0.0, [float_])[2], 0.3)


class Painted(unittest.TestCase):
    LIMITS = (0.0, 1.0), (0.0, 1.0)

    def at(self, x, z, values, spacing):
        return painted.raster(np.asarray(x), np.asarray(z), np.asarray(values, float), spacing, self.LIMITS)

    def test_water_of_particles_has_no_gaps_and_each_pixel_the_value_of_the_nearest(self):
        x, z = (a.ravel() for a in np.meshgrid(np.arange(0.05, 1.0, 0.1), np.arange(0.05, 0.6, 0.1)))
        picture = self.at(x, z, 10.0 * z + x, 0.1)
        rows, columns = picture.shape
        self.assertFalse(np.ma.getmaskarray(picture)[: int(0.58 * rows)].any())
        self.assertTrue(np.ma.getmaskarray(picture)[int(0.65 * rows):].all())
        self.assertAlmostEqual(picture[int(0.26 * rows), int(0.37 * columns)], 10.0 * 0.25 + 0.35)

    def test_particles_drawn_apart_leave_no_hole_and_spray_is_not_joined(self):
        x, z = (a.ravel() for a in np.meshgrid(np.arange(0.1, 0.8, 0.17), np.arange(0.1, 0.8, 0.1)))
        picture = self.at([*x, 0.5], [*z, 0.97], np.ones(len(x) + 1), 0.1)
        rows, columns = picture.shape
        self.assertFalse(np.ma.getmaskarray(picture)[int(0.2 * rows): int(0.6 * rows), int(0.2 * columns): int(0.7 * columns)].any())
        self.assertTrue(np.ma.getmaskarray(picture)[int(0.87 * rows), int(0.5 * columns)])
        self.assertFalse(np.ma.getmaskarray(picture)[int(0.97 * rows), int(0.5 * columns)])


if __name__ == "__main__":
    unittest.main()
