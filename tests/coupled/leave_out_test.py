"""What `spindrift check --columns` says could be left out, against runs of the whole scene with and without it: effect and saving within a factor of two where
they are large enough to be measured. Usage: leave_out_test.py SPINDRIFT [TEST...] [--table [SCENE...]] (--table: docs/verification/leave_out.md is written; of
scenes named by a part of their names, others keep their section). SPDX-License-Identifier: Apache-2.0"""
import csv
import json
import os
import pathlib
import re
import shlex
import sys
import tempfile
import unittest

import numpy as np

from running import ROOT, spindrift

PAGE = ROOT / "docs/verification/leave_out.md"
SEA_STATE = ["waves.model=jonswap", "waves.height_m=6.0", "waves.period_s=10.0", "bodies.spar.displacement_m=[0.0,0.0,0.0]", "start.equilibrium=true"]
# Scene (a comma and what else tells it apart), two columns, overrides of the scene.
SCENES = {
    "tutorials/pendulum": (["weight.x_m", "line.tension_N"], []),
    "tutorials/spar_in_waves": (["spar.z_m", "line_1.tension_N"], []),
    "tutorials/own_turbine": (["spar.pitch_deg", "rotor.thrust_N"], []),
    "tutorials/gust": (["rotor.rpm", "rotor.thrust_N"], []),
    "leble_barakos/case1_engineering": (["platform.pitch_deg", "line_downwind.tension_N"], []),
    "leble_barakos/case2_engineering": (["platform.pitch_deg", "line_downwind.tension_N"], []),
    "leble_barakos/case3_engineering": (["platform.pitch_deg", "rotor.thrust_N"], []),
    "leble_barakos/case3_controlled": (["platform.pitch_deg", "rotor.power_W"], []),
    "leble_barakos/flexible_blades": (["platform.pitch_deg", "rotor.thrust_N"], ["time.end_s=60.0"]),
    "leble_barakos/flexible_tower": (["platform.pitch_deg", "rotor.thrust_N"], ["time.end_s=60.0"]),
    "validation/oc3_heave_decay/oc3_heave_decay": (["spar.pitch_deg", "line_1.tension_N"], SEA_STATE),
    "control/dtu_10mw_fixed": (["rotor.power_W", "rotor.thrust_N"], []),
    # Particles: alone, with bodies, in 3-D that could be 2-D.
    "leble_barakos/case1_demo": (["platform.pitch_deg", "line_downwind.tension_N"], ["time.end_s=1.0", "sea.initial.settle_s=0.5"]),
    "validation/free_sphere/free_sphere": (["sphere.z_m", "sphere.sea.fz_N"], [
        "time.end_s=0.8", "sea.particles.spacing_m=0.25", "sea.tank.x_m=[-3.0, 3.0]", "sea.tank.y_m=[-3.0, 3.0]", "sea.damping_zones=[]",
        "sea.initial.settle_s=0.4"]),
    "validation/dam_break/koshizuka_oka": (["at_1_5.elevation_m", "corner.pressure_Pa"], []),
    "validation/dam_break/koshizuka_oka, 3-D": (["at_1_5.elevation_m", "corner.pressure_Pa"], [
        'sea.particles.dimensions="3"', "sea.tank.y_m=[0.0, 0.3]", "time.end_s=0.2"]),
    "validation/floating_box/floating_box": (["box.z_m", "box.pitch_deg"], []),
    "validation/standing_wave/standing_wave": (["antinode.elevation_m"], ["time.end_s=2.0"]),
    # Air, steady.
    "validation/cylinder_low_mach/cylinder": (["flow.fx_N", "flow.fz_N"], []),
    # Longer than the budget of a trial.
    "validation/oc3_heave_decay/oc3_heave_decay, 4000 s": (["spar.pitch_deg", "line_1.tension_N"], SEA_STATE + ["time.end_s=4000.0"]),
}
# Less than this share of a column's scatter, or of a hundredth of its mean, is nothing: where the window of the means ends does as much.
NOTHING = 0.01
# A smaller saving is nothing: a run's processor time is known to a few per cent.
NO_SAVING = 0.15
# Nor is one of less than this [s]: starts of the program differ by as much.
NO_SECONDS = 0.01


def scene_file(scene):
    return ROOT / f"inputs/{scene.split(',')[0]}.toml"


def fluids(scene):
    """Whether it has particles or resolved air: their trials are whole or none, and the start counts."""
    said = spindrift("check", scene_file(scene), settings=SCENES[scene][1]).stdout
    return "core-s each" in said


def check(scene, columns, overrides, *more):
    return spindrift("check", scene_file(scene), "--columns", ",".join(columns), *more, settings=overrides)


def stated(text):
    """(how long it was tried, [(name, saving, overrides, [(mean, deviation)])]); those that cannot be have no overrides and a reason for a saving, what is
    unknown is None."""
    tried = re.search(r"tried (over [^,;]*, \S+ s|over \S+ of \S+ s|until the march ends)", text).group(1)
    found = []
    for line in text[text.index("the scene itself"):].splitlines()[1:]:
        if m := re.match(r"  (\S.{29})saves (?:(-?\d+) % \(\+- \S+\)|nothing that shows \(\+- \S+ %\)), by (.*)", line):
            found.append((m.group(1).strip(), int(m.group(2) or 0) / 100.0, [w for w in shlex.split(m.group(3)) if w != "--set"], []))
        elif m := re.match(r"  (\S.{29})cannot be: (.*)", line):
            found.append((m.group(1).strip(), m.group(2), [], []))
        elif found and (m := re.search(r"mean (\S+), deviation (\S+)$", line)):   # the first are those of the scene itself
            found[-1][3].append(tuple(None if word == "unknown" else float(word) for word in m.groups()))
    return tried, found


def run(scene, overrides, folder, *more):
    spindrift("run", scene_file(scene), "--out", folder, "--overwrite", "--no-report", "--quiet", *more, settings=overrides).check_returncode()
    return json.loads(pathlib.Path(folder, "summary.json").read_text())["processor_seconds"]


def saving_with_start(scene, overrides, more, scratch):
    """The same of fluids, whose start may take as long as the rest; few and long runs."""
    times = {"own": [], "less": []}
    while len(times["own"]) < 2 or (len(times["own"]) < 5 and sum(times["own"]) < 3.0):
        for kind, settings in (("own", overrides), ("less", overrides + more)):
            times[kind].append(run(scene, settings, f"{scratch}/{kind}"))
    own, less = min(times["own"]), min(times["less"])
    return 1.0 - less / own, max(NO_SAVING, NO_SECONDS / own)


def saving_of(scene, overrides, more, scratch):
    """Of the processor time of windows and rows, without that of the start: runs with and without it in turns, as what others on the machine do goes on for a
    while; the least of each counts, as it only adds. Until the two least of each are within a twentieth. The saving, and what is none here."""
    with open(scratch + "/own/history.csv", encoding="utf-8") as file:
        first_row = list(csv.DictReader(file))[1]["time_s"]
    kinds = {"own": overrides, "less": overrides + more}
    times = {(kind, part): [] for kind in kinds for part in ("whole", "start")}

    def settled(least):
        return all(len(t) > least and sorted(t)[1] < 1.05 * sorted(t)[0] for t in times.values())

    while not settled(2 if sum(times["own", "whole"]) > 4.0 else 12) and len(times["own", "whole"]) < 24 and sum(times["own", "whole"]) < 30.0:
        for kind, settings in kinds.items():
            times[kind, "start"].append(run(scene, settings, f"{scratch}/{kind}_start", "--until", first_row))
            times[kind, "whole"].append(run(scene, settings, f"{scratch}/{kind}"))
    own, less = (min(times[kind, "whole"]) - min(times[kind, "start"]) for kind in kinds)
    return 1.0 - less / own, max(NO_SAVING, NO_SECONDS / own)


def statistics(folder, columns, steady=False):
    """(mean, deviation) of each over the last two thirds of the run; of a march to a steady state its end, and no deviation."""
    with open(folder + "/history.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    t = np.array([float(r["time_s"]) for r in rows])
    begin = max(t[0], 0.0)   # bodies are held before
    late = t >= begin + (t[-1] - begin) / 3.0
    found = []
    for column in columns:
        if steady:
            found.append((float(rows[-1][column]), 0.0))
            continue
        x = np.array([float(r[column]) for r in rows])[late]
        mean = np.trapz(x, t[late]) / np.ptp(t[late])
        found.append((mean, np.sqrt(np.trapz((x - mean) ** 2, t[late]) / np.ptp(t[late]))))
    return found


def agree(a, b, nothing):
    """Within a factor of two; nothing is told from nothing. What is unknown (a is None) claims nothing."""
    return a is None or max(abs(a), abs(b)) <= nothing or (a * b > 0.0 and 0.5 <= a / b <= 2.0)


def measured(scene):
    """(how long it was tried, rows): name, (stated, measured) saving, [(column, (mean, deviation) of the scene, stated, measured change)], what is wrong."""
    columns, overrides = SCENES[scene]
    said = check(scene, columns, overrides)
    assert said.returncode == 0, said.stderr
    tried, omissions = stated(said.stdout)
    whole_runs = fluids(scene)
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        for name, saving, more, effects in omissions:
            if not more:
                rows.append((name, saving, [], ""))
                continue
            run(scene, overrides, scratch + "/own"), run(scene, overrides + more, scratch + "/less")
            own, less = (statistics(f"{scratch}/{kind}", columns, tried == "until the march ends") for kind in ("own", "less"))
            true, none = (saving_with_start if whole_runs else saving_of)(scene, overrides, more, scratch)
            changes = [(c, o, e, (b[0] - o[0], b[1] - o[1])) for c, o, e, b in zip(columns, own, effects, less)]
            wrong = [] if agree(saving, true, none) else [f"saves {saving:.0%}, measured {true:.0%}"]
            for column, o, e, m in changes:
                nothing = NOTHING * max(o[1], 0.01 * abs(o[0]))
                wrong += [f"{what} of {column} {x:+.2g}, measured {y:+.2g}" for what, x, y in zip(("mean", "deviation"), e, m) if not agree(x, y, nothing)]
            rows.append((name, (saving, true), changes, "; ".join(wrong)))
    return tried, rows


class LeaveOut(unittest.TestCase):
    def test_a_misspelt_column_is_named(self):
        said = check("leble_barakos/case3_engineering", ["platform.pitch_degg"], [])
        self.assertEqual(said.returncode, 2)
        self.assertIn('did you mean "platform.pitch_deg"', said.stderr + said.stdout)

    def test_what_comes_after_the_trial_is_unknown(self):
        said = check("tutorials/gust", ["rotor.rpm"], ["wind.event.start_s=5000.0", "time.end_s=6000.0"])
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("the trial is not like the run: wind at the hub", said.stdout)
        for _, _, more, effects in stated(said.stdout)[1]:
            self.assertEqual(effects, [(None, None)] if more else [])
        self.assertIn("trying what could be left out", said.stderr)

    def test_the_memory_of_waves_made_is_one_of_the_choices(self):
        """Of a buoy in heave; the memory has a closed form, as in tests/src/sea/potential_test.cpp. Without it a decay has no damping."""
        k, a, b, infinite, density = 1.0e4, 0.8, 1.5, 3.0e3, 1000.0
        with tempfile.TemporaryDirectory() as folder:
            with open(folder + "/buoy.1", "w", encoding="utf-8") as file:
                file.write(f"0.0 3 3 {infinite / density}\n")
                for w in 0.05 * np.arange(1, 601):
                    r = 1j * w * k / ((1j * w + a) ** 2 + b**2)
                    file.write(f"{2.0 * np.pi / w} 3 3 {(infinite + r.imag / w) / density} {r.real / (density * w)}\n")
            scene = ["sea.model=potential", 'sea.potential.body="buoy"', f'sea.potential.radiation_file="{folder}/buoy.1"', "sea.potential.memory_s=20.0",
                     "bodies.buoy.displacement_m=[0.0, 0.0, 0.3]", "time.end_s=30.0"]
            said = spindrift("check", ROOT / "tests/extremes/buoy.toml", "--columns", "buoy.z_m", settings=scene)
            self.assertEqual(said.returncode, 0, said.stderr)
            found = {name: (more, effects) for name, _, more, effects in stated(said.stdout)[1]}
            more, effects = found["no memory of waves made"]
            deviation = {}
            for name, settings in (("own", scene), ("less", scene + more)):
                done = spindrift("run", ROOT / "tests/extremes/buoy.toml", "--out", f"{folder}/{name}", "--no-report", "--quiet", settings=settings)
                self.assertEqual(done.returncode, 0, done.stderr)
                deviation[name] = statistics(f"{folder}/{name}", ["buoy.z_m"])[0][1]
        self.assertLess(deviation["own"], 0.1 * deviation["less"])
        self.assertAlmostEqual(effects[0][1], deviation["less"] - deviation["own"], delta=0.01 * deviation["less"])

    def test_a_trial_of_fluids_is_whole_or_none(self):
        """What is too dear is said, with a study that `spindrift study` takes; --trial-s decides."""
        scene, columns = "validation/dam_break/koshizuka_oka", ["corner.pressure_Pa"]
        said = check(scene, columns, ["time.end_s=0.1"], "--trial-s", "1")
        self.assertEqual(said.returncode, 0, said.stderr)
        if "not tried" not in said.stdout:   # a fast computer
            self.assertTrue(stated(said.stdout)[1])
            said = check(scene, columns, ["time.end_s=0.1", "sea.particles.spacing_m=0.02"], "--trial-s", "1")
        self.assertIn("not tried, it would take up to", said.stdout)
        needed = re.search(r"--trial-s (\d+) gives it as many", said.stdout).group(1)
        self.assertGreater(int(needed), 1)
        with tempfile.TemporaryDirectory() as folder:
            study = pathlib.Path(folder, "study.toml")
            study.write_text(said.stdout[said.stdout.index("[study]"):], encoding="utf-8")
            planned = spindrift("study", study, "--dry-run")
        self.assertEqual(planned.returncode, 0, planned.stderr + planned.stdout)
        self.assertIn("slower_sound", planned.stdout)

    def test_a_misspelt_column_of_air_alone_is_named(self):
        said = check("validation/cylinder_low_mach/cylinder", ["flow.fx_M"], [])
        self.assertEqual(said.returncode, 2)
        self.assertIn('did you mean "flow.fx_N"', said.stderr + said.stdout)

    def test_effect_and_saving_are_those_of_the_runs(self):
        for scene in SCENES:
            for name, _, _, wrong in measured(scene)[1]:
                with self.subTest(f"{name} of {scene}"):
                    self.assertEqual(wrong, "")


def said_of(change):
    return "unknown" if change is None else f"{change:+.2g}"


def section(scene):
    columns, overrides = SCENES[scene]
    tried, rows = measured(scene)
    with_ = f", with {' '.join(f'`{o}`' for o in overrides)}" if overrides else ""
    text = f"## {scene}\n\nTried {tried}{with_}; each pair is stated / measured.\n\n| left out | saving |"
    text += "".join(f" {c}: mean | deviation |" for c in columns) + "\n|---|---|" + "---|---|" * len(columns) + "\n"
    own = next(changes for _, _, changes, _ in rows if changes)
    text += "| (the scene itself) | |" + "".join(f" {o[0]:.4g} | {o[1]:.3g} |" for _, o, _, _ in own) + "\n"
    for name, saving, changes, wrong in rows:
        if not changes:
            text += f"| {name} | cannot be: {saving.replace(f'{ROOT}/', '')} |" + " | |" * len(columns) + "\n"
            continue
        text += f"| {name} | {saving[0]:.0%} / {saving[1]:.0%} |" + "".join(f" {said_of(e[k])} / {m[k]:+.2g} |" for _, _, e, m in changes for k in (0, 1))
        text += (f" **{wrong}**" if wrong else "") + "\n"
    return text


def table(names):
    text = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
    sections = {s.split("\n", 1)[0]: "## " + s.rstrip() + "\n" for s in text.split("\n## ")[1:]}
    for scene in SCENES:
        if not names or any(name in scene for name in names):
            sections[scene] = section(scene)
            print(sections[scene], flush=True)
        PAGE.write_text("# What could be left out\n\n"
                        "`spindrift check --columns` states for each smaller choice what it would save and change, from whole runs where all of them together keep to a budget\n"
                        "of processor time (120 s), else from as much of them as that carries. Here this is compared with runs of their own, with and without the choice.\n"
                        "The saving is that of processor time after the start (of particles and resolved air with it). The change is that of mean and deviation over the last two\n"
                        "thirds, of a march to a steady state that of the value at its end. What the trial cannot tell is unknown. Bold where\n"
                        f"they differ by more than a factor of two and either is more than {NO_SAVING:.0%} of the time (and {NO_SECONDS:g} s), or {NOTHING:.0%} of the deviation. Written by\n"
                        "`tests/coupled/leave_out_test.py build/release/spindrift --table`.\n\n" + "\n".join(sections[s] for s in SCENES if s in sections), encoding="utf-8")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    if "--table" in sys.argv:
        table(sys.argv[sys.argv.index("--table") + 1:])
    else:
        unittest.main(verbosity=2)
