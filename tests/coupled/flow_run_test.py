"""The air alone as a user runs it: scenes with grids made by the program, fields and walls for ParaView, the report's pictures.
Usage: flow_run_test.py SPINDRIFT"""
import json
import re
import tomllib
import unittest
import xml.etree.ElementTree

import numpy

import field_files
from running import Folder, ROOT, rows, spindrift

CASES = ROOT / "inputs/validation"


class FlowRun(Folder):
    def history(self, out=None):
        return rows((out or self.out) / "history.csv")

    def test_a_plate_leaves_history_fields_walls_and_pictures(self):
        done = spindrift("run", CASES / "flat_plate/flat_plate.toml", "--out", self.out, "--set", "aero.flow.generate.refinement=1",
                         "--set", "aero.flow.drop=1e-4")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertAlmostEqual(self.history()[-1]["flow.drag_coefficient"], 0.00291, delta=0.00001)
        for name in ("air", "walls"):
            tree = xml.etree.ElementTree.parse(self.out / f"fields/{name}.xdmf")
            names = {a.get("Name") for a in tree.iter("Attribute")}
            self.assertIn("pressure", names)
            if name == "walls":
                self.assertEqual(names, {"pressure", "pressure_coefficient", "friction_coefficient", "y_plus"})
                self.assertEqual({t.get("TopologyType") for t in tree.iter("Topology")}, {"2DSMesh"})
        page = (self.out / "report.html").read_text()
        for words in ("Residuals", "Along the walls", "Slice of the flow", "Mach number"):
            self.assertIn(words, page)
        try:
            import h5py
        except ImportError:
            return
        with h5py.File(sorted((self.out / "fields").glob("walls_*.h5"))[-1]) as file:
            faces, drag = 0, 0.0
            for block in file.values():
                points, cf = block["points"][...], block["friction_coefficient"][..., 0]
                self.assertEqual(points.shape[:2], (cf.shape[0] + 1, cf.shape[1] + 1))
                length = abs(points[1:, 1:, 0] - points[:-1, :-1, 0])
                faces += cf.size
                drag += float((cf * length).sum()) / 2.0
            self.assertEqual(faces, 28)
            self.assertAlmostEqual(drag, self.history()[-1]["flow.drag_coefficient"], delta=1e-6)

    def test_the_pressure_of_slow_air_is_that_of_its_coefficient(self):
        """A dynamic pressure of 6 mPa upon one bar."""
        done = spindrift("run", CASES / "naca0012/family.toml", "--out", self.out, "--set", "aero.flow.generate.refinement=1",
                         "--set", "aero.flow.incidence_deg=5.0", "--set", "wind.speed_m_s=0.1", "--set", "time.end_s=10.0", "--no-report")
        self.assertIn(done.returncode, (0, 3), done.stdout + done.stderr)
        scene = tomllib.loads((self.out / "scene.toml").read_text())
        density = scene["environment"]["air_density_kg_m3"]
        ambient, q = density * 287.05 * scene["aero"]["flow"]["temperature_K"], 0.5 * density * 0.1**2
        for wall in field_files.blocks(self.out, "walls").values():
            expected = wall["pressure_coefficient"]
            self.assertGreater(numpy.ptp(expected), 0.5)
            numpy.testing.assert_allclose((wall["pressure"] - ambient) / q, expected, atol=1e-5)

    def test_a_march_that_misses_its_drop_with_loads_at_rest_says_so_and_what_would_have_taken_it(self):
        for steps, settled in ((70, True), (10, False)):
            with self.subTest(steps):
                done = spindrift("run", CASES / "naca0012/family.toml", "--out", self.out, "--overwrite", "--no-report", "--set", "aero.flow.generate.refinement=1",
                                 "--set", "aero.flow.drop=1e-14", "--set", f"time.end_s={steps}.0")
                self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
                reason = json.loads((self.out / "summary.json").read_text())["exit_reason"]
                self.assertEqual("the loads have settled all the same: they changed by" in reason, settled, reason)
                if settled:
                    drop = float(re.search(r"aero\.flow\.drop = (\S+) would have taken it", reason)[1])
                    reached = self.history()[-1]["flow.balance_drop"]
                    self.assertTrue(reached <= drop <= 2.01 * reached, (drop, reached))

    def test_fields_have_the_blocks_of_the_grid_and_values_where_their_points_are(self):
        """Several tiles a block, whose own directions are turned against the block's."""
        done = spindrift("run", CASES / "naca0012/family.toml", "--out", self.out, "--set", "aero.flow.generate.refinement=1",
                         "--set", "aero.flow.tile_cells=512", "--set", "time.end_s=60.0", "--no-report")
        self.assertIn(done.returncode, (0, 3), done.stdout + done.stderr)
        grids = {step.get("Name") for step in xml.etree.ElementTree.parse(self.out / "fields/air.xdmf").iter("Grid") if step.get("GridType") == "Uniform"}
        self.assertEqual(grids, set(field_files.blocks(self.out, "air")))
        for block in field_files.blocks(self.out, "air").values():   # of tiles the wrong way round cells would lie across each other
            x, z = block["points"][0, ..., 0], block["points"][0, ..., 2]
            along, across = (numpy.stack([numpy.diff(c, axis=1)[:-1], numpy.diff(c, axis=0)[:, :-1]]) for c in (x, z))
            areas = along[0] * across[1] - along[1] * across[0]
            self.assertTrue((areas > 0).all() or (areas < 0).all())
        walls, cells = field_files.at_walls(self.out)
        self.assertGreater(numpy.corrcoef(walls, cells)[0, 1], 0.9)   # next to 0 where values lie elsewhere than their points

    def test_first_cells_a_hundred_times_too_coarse_are_said_before_and_after_the_run(self):
        scene = CASES / "naca0012/family.toml"
        coarse = ["--set", "aero.flow.generate.refinement=1", "--set", "aero.flow.generate.first_cell_m=3.6e-4"]
        fine = ["--set", "aero.flow.generate.refinement=2"]
        words = "friction is not to be trusted"
        done = spindrift("check", scene, *coarse)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for text in ("First cells at walls", "warning: y+ of first cells is", words):
            self.assertIn(text, done.stdout)
        done = spindrift("check", scene, *fine)
        self.assertIn("First cells at walls", done.stdout)
        self.assertNotIn(words, done.stdout)
        for more, bad in ((coarse, True), (fine, False)):
            done = spindrift("run", scene, "--out", self.out, "--overwrite", *more)
            self.assertEqual(done.returncode, 3 if bad else 0, done.stdout + done.stderr)
            summary = json.loads((self.out / "summary.json").read_text())
            trouble = summary["numerical_trouble"]
            self.assertEqual("the loads are no answer" in summary["exit_reason"], bad, summary["exit_reason"])
            self.assertEqual(any(words in text for text in trouble), bad, trouble)
            self.assertEqual(bool(trouble), bad, trouble)
            for file in ("log.txt", "report.html"):
                self.assertEqual(words in (self.out / file).read_text(), bad, file)

    def test_cells_that_grow_fast_off_the_wall_are_said_with_what_mends_it(self):
        naca, stretched = CASES / "naca0012", f"{ROOT}/tests/extremes/files/aerofoil_stretched"
        for scene, grid, growth, remedy in ((naca / "family.toml", ["aero.flow.generate.refinement=1"], "1.7", "raise aero.flow.generate.refinement"),
                                            (naca / "naca0012.toml", [f'aero.flow.grid="{stretched}.p3d"', f'aero.flow.map="{stretched}.nmf"'], "2 in the middle", "take a grid with more layers")):
            doubt = f"cells grow from layer to layer off resolved walls by {growth}"
            done = spindrift("check", scene, settings=grid)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            for text in ("growth off resolved", "warning: " + doubt, "drag is not to be trusted; " + remedy):
                self.assertIn(text, done.stdout)
            done = spindrift("run", scene, "--out", self.out, "--overwrite", "--no-report", settings=[*grid, "time.end_s=40.0", "aero.flow.drop=0.0", "output.expected=[]"])
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            trouble = json.loads((self.out / "summary.json").read_text())["numerical_trouble"]
            self.assertTrue(any(doubt in text and remedy in text for text in trouble), trouble)
        done = spindrift("check", naca / "naca0012.toml")
        self.assertIn("growth off resolved", done.stdout)
        self.assertNotIn("warning: cells grow", done.stdout)

    def section_of_file(self, growth, first_cell):
        """Settings for the C grid of the TMR with layers in one geometric row off the section, by file: Plot3D with its map, and CGNS."""
        source, plot3d = CASES / "naca0012/tmr_224x64", self.path / f"growth_{growth}.p3d"
        numbers = source.with_suffix(".p3d").read_text().split()
        around, off = int(numbers[1]), int(numbers[2])
        x, z = numpy.array(numbers[3:], dtype=float).reshape(2, off, around)
        gaps = numpy.hypot(numpy.diff(x, axis=0), numpy.diff(z, axis=0))
        heights = first_cell * growth ** numpy.arange(int(numpy.log(gaps.sum(axis=0).max() / first_cell * (growth - 1.0) + 1.0) / numpy.log(growth)))
        share = numpy.concatenate(([0.0], heights.cumsum())) / heights.sum()
        made = numpy.empty((2, len(share), around))
        for i in range(around):
            along = numpy.concatenate(([0.0], gaps[:, i].cumsum()))
            made[:, :, i] = [numpy.interp(share * along[-1], along, of[:, i]) for of in (x, z)]
        plot3d.write_text(f"1\n{around} {len(share)}\n" + "\n".join(f"{v:.16g}" for v in made.ravel()))
        plot3d.with_suffix(".nmf").write_text(source.with_suffix(".nmf").read_text().replace(str(off), str(len(share))))
        files = {plot3d: [f'aero.flow.grid="{plot3d}"', f'aero.flow.map="{plot3d.with_suffix(".nmf")}"']}
        cgns = plot3d.with_suffix(".cgns")
        done = spindrift("grid", CASES / "naca0012/naca0012.toml", "-o", cgns, settings=files[plot3d])
        if "built without CGNS" not in done.stdout + done.stderr:
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            files[cgns] = [f'aero.flow.grid="{cgns}"', 'without="aero.flow.map"']
        return files

    def test_a_file_whose_cells_grow_fast_or_begin_too_thick_is_doubted_by_its_name(self):
        scene, steps = CASES / "naca0012/naca0012.toml", ["time.end_s=30.0", "aero.flow.drop=0.0", "output.expected=[]"]
        grows, thick = "cells grow from layer to layer off", "y+ of first cells is"
        for growth, first_cell, doubt, other, ends in ((1.8, 3.5e-6, grows, thick, 0), (3.5, 3.5e-6, grows, thick, 3), (1.2, 1e-3, thick, grows, 3)):
            for file, grid in self.section_of_file(growth, first_cell).items():
                with self.subTest(file=file.name):
                    remedy = f'take a grid with more layers than aero.flow.grid = "{file}"'
                    done = spindrift("check", scene, settings=grid)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    warnings = [line for line in done.stdout.splitlines() if doubt in line]
                    self.assertEqual(len(warnings), 1, done.stdout)
                    self.assertNotIn(other, done.stdout)
                    done = spindrift("run", scene, "--out", self.out, "--overwrite", "--no-report", settings=[*grid, *steps])
                    self.assertEqual(done.returncode, ends, done.stdout + done.stderr)
                    summary = json.loads((self.out / "summary.json").read_text())
                    said = [*warnings, *summary["numerical_trouble"]]
                    self.assertEqual(len(said), 2 if ends == 0 else 3, said)
                    for text in said:
                        self.assertIn(doubt, text)
                        self.assertNotIn("cells_layers", text)
                        if doubt == grows:
                            self.assertIn(f"{growth:g} in the middle", text)
                            self.assertTrue(text.endswith(remedy), text)
                    self.assertEqual("the loads are no answer" in summary["exit_reason"], ends == 3)

    def test_ranks_do_not_change_a_bit(self):
        scene, more = CASES / "cylinder_low_mach/cylinder.toml", ("--until", 12, "--no-report")
        self.assertEqual(spindrift("run", scene, "--out", self.out, *more).returncode, 0)
        two = self.out.parent / "two"
        done = spindrift("run", scene, "--out", two, *more, ranks=2)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual((self.out / "history.csv").read_bytes(), (two / "history.csv").read_bytes())

    def test_a_coarser_start_is_logged_and_a_restarted_march_has_the_same_digits(self):
        scene = CASES / "cylinder_low_mach/cylinder.toml"
        options = ["--no-report", "--set", "aero.flow.coarse_steps=40", "--set", "checkpoint.interval_s=20.0"]
        done = spindrift("run", scene, "--out", self.out, *options, "--until", 60)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("pseudo-steps on a coarser grid of", (self.out / "log.txt").read_text())
        parts = self.out.parent / "parts"
        spindrift("run", scene, "--out", parts, *options, "--until", 20)
        done = spindrift("run", scene, "--out", parts, *options, "--until", 60, "--restart")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual((self.out / "history.csv").read_bytes(), (parts / "history.csv").read_bytes())
        self.assertGreater(len(self.history()), 21)

    def test_a_steady_march_that_is_stopped_at_any_pseudo_step_goes_on_with_the_same_digits(self):
        scene = CASES / "cylinder_low_mach/cylinder.toml"
        for more in ((), ("--set", "aero.flow.refresh_every=3")):
            with self.subTest(more=more):
                options = ["--no-report", "--quiet", "--set", "time.end_s=43", "--set", "aero.flow.drop=0", *more]
                whole, parts = (self.path / f"{name}{len(more)}" for name in ("whole", "parts"))
                self.assertEqual(spindrift("run", scene, "--out", whole, *options).returncode, 0)
                for until in (7, 8, 27, 43):
                    done = spindrift("run", scene, "--out", parts, *options, "--until", until, *(["--restart"] if parts.exists() else []))
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    last = rows(parts / "history.csv")[-1]
                    self.assertEqual(last["flow.pseudo_steps"], last["time_s"])  # the state that is saved is that of the last row
                    self.assertGreaterEqual(last["time_s"], until)
                    if not more:
                        self.assertEqual(last["time_s"], until)
                self.assertEqual((whole / "history.csv").read_text(), (parts / "history.csv").read_text())

    def test_a_steady_flow_that_has_settled_has_nothing_left_to_do(self):
        scene, options = ROOT / "inputs/tutorials/wing_section.toml", ["--no-report", "--quiet"]
        self.assertEqual(spindrift("run", scene, "--out", self.out, *options).returncode, 0)
        before = (self.out / "history.csv").read_bytes()
        means = json.loads((self.out / "summary.json").read_text())["statistics"]
        for more in ((), ("--set", "time.end_s=500")):
            self.assertEqual(spindrift("run", scene, "--out", self.out, *options, "--restart", *more).returncode, 0)
            summary = json.loads((self.out / "summary.json").read_text())
            self.assertIn("nothing was left to do", summary["exit_reason"])
            self.assertEqual(summary["statistics"], means)
            self.assertEqual((self.out / "history.csv").read_bytes(), before)
        change = ("--set", "aero.flow.drop=1e-8", "--allow-change", "aero.flow.drop")
        self.assertEqual(spindrift("run", scene, "--out", self.out, *options, "--restart", *change).returncode, 0)
        self.assertGreater(len((self.out / "history.csv").read_bytes()), len(before))

    def test_an_unsteady_flow_with_nothing_left_to_do_has_the_friction_that_it_had(self):
        options = ["--no-report", "--quiet", "--until", "0.002", "--set", "aero.flow.generate.around=32", "--set", "aero.flow.generate.outward=16"]
        found = []
        for more in ((), ("--restart",)):
            self.assertEqual(spindrift("run", CASES / "cylinder_re100/cylinder.toml", "--out", self.out, *options, *more).returncode, 0)
            found.append(field_files.blocks(self.out, "walls"))
        for name, wall in found[0].items():
            self.assertGreater(numpy.abs(wall["friction_coefficient"]).max(), 0.0)
            for field, values in wall.items():
                numpy.testing.assert_array_equal(found[1][name][field], values, field)

    def test_no_restart_changes_the_scheme_in_time(self):
        scene, options = CASES / "cylinder_re100/cylinder.toml", ["--no-report", "--quiet", "--set", "aero.flow.generate.around=32", "--set", "aero.flow.generate.outward=16"]
        self.assertEqual(spindrift("run", scene, "--out", self.out, *options, "--until", "0.002").returncode, 0)
        for key, value in (("time", "bdf3"), ("time_tolerance", "1e-2")):
            change = ("--set", f"aero.flow.{key}={value}", "--allow-change", f"aero.flow.{key}")
            done = spindrift("run", scene, "--out", self.out, *options, "--until", "0.004", "--restart", *change)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"aero.flow.{key}: was", done.stderr)
            self.assertIn("cannot let this pass", done.stderr)

    def test_the_automatic_preconditioner_is_written_down_and_kept(self):
        case = CASES / "cylinder_low_mach/cylinder.toml"
        options = ["--no-report", "--set", "aero.flow.preconditioner='auto'"]
        done = spindrift("run", case, "--out", self.out, *options, "--until", "20")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        chosen = [line for line in (self.out / "log.txt").read_text().splitlines() if "air: preconditioner" in line]
        self.assertEqual(len(chosen), 1)
        self.assertIn("us per cell by the model", chosen[0])
        name = chosen[0].split('"')[1]
        scene = (self.out / "scene.toml").read_text()
        self.assertIn(f'preconditioner = "{name}"', scene)
        self.assertNotIn('"auto"', scene.split("preconditioner = ")[1].splitlines()[0])
        done = spindrift("run", case, "--out", self.out, *options, "--until", "40", "--restart")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn(f'air: preconditioner "{name}" (as before the restart)', (self.out / "log.txt").read_text())
        self.assertIn(f'preconditioner = "{name}"', (self.out / "scene.toml").read_text())

    def test_a_grid_that_follows_a_pitching_aerofoil_gives_the_lift_of_one_that_pitches_as_a_whole(self):
        case, quick = CASES / "pitching_naca0012/pitching.toml", ["--no-report", "--until", "0.0923148"]
        lifts = {}
        for grid in ("elliptic", "rigid"):
            out = self.out.parent / grid
            done = spindrift("run", case, "--out", out, *quick, "--set", f"aero.flow.motion.grid='{grid}'")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            rows = self.history(out)
            self.assertEqual(len(rows), 12)
            self.assertAlmostEqual(rows[9]["flow.pitch_deg"], 2.5, delta=1e-3)
            lifts[grid] = [row["flow.lift_coefficient"] for row in rows]
        largest = max(map(abs, lifts["rigid"][2:]))
        self.assertGreater(largest, 0.1)
        for one, other in zip(lifts["rigid"][2:], lifts["elliptic"][2:]):
            self.assertAlmostEqual(one, other, delta=0.02 * largest)
        # In parts and on two ranks: the same bits.
        parts = self.out.parent / "parts"
        done = spindrift("run", case, "--out", parts, "--no-report", "--until", "0.0461574")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = spindrift("run", case, "--out", parts, *quick, "--restart", ranks=2)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual((parts / "history.csv").read_bytes(), (self.out.parent / "elliptic/history.csv").read_bytes())

    def test_windows_are_divided_until_the_error_in_time_is_below_its_tolerance(self):
        # Windows four times as long as the scene's: a tenth of a period. The first has the start at once.
        case, tolerance = CASES / "pitching_naca0012/pitching.toml", 2.5e-3
        settings = ["--no-report", "--set", "time.window_s=0.0307716", "--set", "time.end_s=0.3692592", "--set", "aero.flow.time='bdf3'",
                    "--set", f"aero.flow.time_tolerance={tolerance}"]
        done = spindrift("run", case, "--out", self.out, *settings)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        found = self.history()
        self.assertEqual(len(found), 12)
        steps, errors = ([row[f"flow.time_{column}"] for row in found] for column in ("steps", "error"))
        self.assertEqual(steps[0], 16)
        said = (self.out / "log.txt").read_text()
        self.assertRegex(said, r"the window to t = 0.0307716 s has an error in time of \S+ in 16 steps, 0.0025 is asked for")
        above = sum(error > tolerance for error in errors)
        self.assertLess(above, 3)
        self.assertLess(max(errors[above:]), tolerance)
        self.assertLessEqual(set(steps), {1, 2, 4, 8, 16})
        self.assertLess(min(steps), 8)
        self.assertTrue(any(one < other for one, other in zip(steps, steps[1:])), steps)  # made again with more
        summary = json.loads((self.out / "summary.json").read_text())["counts"]
        self.assertEqual((summary["time_steps"], summary["windows_above_time_tolerance"]), (sum(steps), above))
        # In parts and on two ranks: the same bits.
        parts = self.out.parent / "parts"
        done = spindrift("run", case, "--out", parts, *settings, "--until", "0.1538")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = spindrift("run", case, "--out", parts, *settings, "--restart", ranks=2)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual((parts / "history.csv").read_bytes(), (self.out / "history.csv").read_bytes())

    def test_a_motion_that_cannot_be_is_refused(self):
        case = CASES / "pitching_naca0012/pitching.toml"
        for setting, words in (("aero.flow.motion.patches=['blade']", 'no patch "blade"'),
                               ("aero.flow.motion.heave_amplitude_m=[0.0, 0.0, 40.0]", "cells fold")):
            done = spindrift("run", case, "--out", self.out, "--overwrite", "--set", setting)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(words, done.stdout + done.stderr)

    def test_distances_by_poisson_leave_the_drag_of_a_plate(self):
        done = spindrift("run", CASES / "flat_plate/flat_plate.toml", "--out", self.out, "--set", "aero.flow.generate.refinement=1",
                         "--set", "aero.flow.drop=1e-4", "--set", "aero.flow.wall_distance='poisson'")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertAlmostEqual(self.history()[-1]["flow.drag_coefficient"], 0.00291, delta=0.00003)

    def test_a_vortex_between_mirrors_decays(self):
        done = spindrift("run", CASES / "taylor_green/taylor_green.toml", "--out", self.out, "--no-report", "--until", 0.01,
                         "--set", "aero.flow.generate.cells=[8, 8, 8]")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_wrong_grids_end_with_2_and_the_remedy(self):
        done = spindrift("check", CASES / "cylinder_low_mach/cylinder.toml", "--set", "aero.flow.generate.kind='sphere'")
        self.assertEqual(done.returncode, 2)
        self.assertIn("flat_plate", done.stdout + done.stderr)
        done = spindrift("run", CASES / "cylinder_low_mach/cylinder.toml", "--out", self.out, "--set", "aero.flow.generate.kind='bump'")
        self.assertEqual(done.returncode, 2)
        done = spindrift("run", CASES / "cylinder_low_mach/cylinder.toml", "--out", self.out, "--set", "aero.flow.coarse_steps=9",
                         "--set", "aero.flow.generate.outward=33")
        self.assertEqual(done.returncode, 2)
        for words in ("aero.flow.coarse_steps", "every second node", "33 cells"):
            self.assertIn(words, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
