"""What a run came to, in words: one sentence of what ran, the figures it answers with, and checks of its health.
Called by page.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import math

import numpy as np

import decay
import impact
import motions
import quantities
import told_bodies
import words
from geometry import Scene3d

EXITS = {0: "Done", 2: "Bad input", 3: "Numerical failure", 4: "System failure", 5: "Stopped on request"}
LEANS = 0.866   # cosine of 30 degrees, which nothing that is to float upright leans by
SWINGS = 0.02   # of its mean: a standard deviation that is told with it
ORDER = {"bad": 0, "warn": 1, "good": 2}


class Check:
    """One line of the panel: level 'good', 'warn' or 'bad', what was looked at, what was found."""

    def __init__(self, level, title, text):
        self.level, self.title, self.text = level, title, text


def kind(run):
    """What sort of scene: 'floating turbine', 'rotor', 'flow', 'bodies', 'tank' or 'run'."""
    bodies, thrust = quantities.bodies_of(run.columns), quantities.rotors_of(run.columns)
    if thrust:
        return "floating turbine" if bodies else "rotor"
    if any(n.startswith("flow.") for n in run.columns):
        return "flow"
    if bodies:
        return "bodies"
    return "tank" if any(n.startswith("sea.") for n in run.columns) else "run"


def _of_rotors(run, *quantities_of_one):
    """(words, column) of these (words, quantity) of every rotor of the run."""
    return [pair for text, quantity in quantities_of_one for pair in quantities.of_rotors(run.columns, text, quantity)]


def is_steady(run):
    """A march to a steady state, whose time counts pseudo-steps."""
    return _value(run.scene, "aero", "flow", "time") == "steady" and kind(run) in ("flow", "rotor")


def is_plane(run):
    """Sections and tanks have no depth worth a view."""
    if kind(run) in ("flow", "tank"):
        return True
    planar = str((run.scene.get("sea", {}).get("particles") or {}).get("dimensions")) == "2"
    return planar and any((run.folder / "fields").glob("particles_*.h5"))


def _value(table, *keys):
    for key in keys:
        table = table.get(key) if isinstance(table, dict) else None
    return table


def _stands(run):
    """Do turbines stand on the ground? Held by a joint that moves nothing or by a rotor's own bearing, or where there is neither water nor mooring to hold them."""
    joints = run.scene.get("joints") or {}
    bearings = [rotor.get("joint") for _, rotor in run.rotors() if isinstance(rotor, dict)]
    held = bool(told_bodies.foundations(run)) or any("earth" in joint.get("bodies", []) and joint.get("type") == "revolute" and name in bearings for name, joint in joints.items())
    return held or (_value(run.scene, "sea", "model") in (None, "none") and not run.scene.get("moorings"))


def what_ran(run):
    """One sentence: the kind of scene, its models, how long."""
    scene = run.scene
    sea = {"sph": "a sea of particles", "morison": "Morison strips", "hydrostatic": "hydrostatics"}.get(_value(scene, "sea", "model"))
    air = {"blade_resolved": "a blade-resolved rotor", "actuator_disc": "an actuator disc", "actuator_line": "actuator lines", "bem": "blade element momentum", "prescribed": "prescribed rotor loads",
           "thrust_curve": "a thrust curve"}.get(_value(scene, "aero", "model"))
    if _value(scene, "aero", "dynamic_inflow") == "free_vortex":
        air = "blade elements and a wake of vortex filaments"
    wave = _value(scene, "waves", "height_m")
    rotors = len(quantities.rotors_of(run.columns))
    driven = set(told_bodies.told(run)[1]) & told_bodies.towed(run)
    many = f"{rotors} turbines in prescribed motion" if driven else f"{rotors} turbines on their foundation" if _stands(run) else f"A floater with {rotors} rotors"
    one = "A turbine in prescribed motion" if driven else "A turbine on its foundation" if _stands(run) else "A floating turbine"
    named = {"floating turbine": many if rotors > 1 else one, "rotor": "A rotor", "flow": "A flow round walls" if _walls(run) else "A flow",
             "bodies": "Bodies", "tank": "A tank of water", "run": "A run"}[kind(run)]
    parts = [p for p in ((air if kind(run) == "floating turbine" else None), sea) if p]
    text = named + (f" with {' and '.join(parts)}" if parts else "")
    if isinstance(wave, (int, float)) and wave > 0:
        height, period = ("Hs ", "Tp ") if is_irregular(run) else ("", "")
        text += f", waves of {height}{wave:.3g} m" + (f" and {period}{run.scene['waves']['period_s']:.3g} s" if _value(scene, "waves", "period_s") else "")
    wind = _value(scene, "wind", "speed_m_s")
    if isinstance(wind, (int, float)) and wind > 0:
        text += f", wind of {wind:.4g} m/s" + _changes_of_wind(scene)
    turbine = [f"{said} at {words.number(when)} s" for what, said, when in happenings(run) if what in OF_TURBINES]
    text += f", {' and '.join(turbine)}" if turbine else ""
    if len(run.time):
        text += f": {run.time[-1]:.6g} pseudo-steps to a steady state" if is_steady(run) else f": {run.time[-1]:.6g} s"
    wall = run.summary.get("wall_seconds")
    return text + (f", computed in {words.duration(wall)}." if isinstance(wall, (int, float)) else ".")


EVENTS = {"step": "a step", "ramp": "a ramp", "eog": "an extreme operating gust", "edc": "an extreme change of direction",
          "ecd": "an extreme coherent gust with change of direction", "ews_vertical": "an extreme vertical shear", "ews_horizontal": "an extreme horizontal shear"}


def is_irregular(run):
    """Waves of many heights: none of them is the wave."""
    return _value(run.scene, "waves", "model") in ("jonswap", "pierson_moskowitz", "elevation")


def _gust(scene):
    """[(what, in words, when [s])] of the wind's event, if any."""
    event = _value(scene, "wind", "event")
    return [(event["what"], EVENTS.get(event["what"], event["what"]), event.get("start_s", 0.0))] if isinstance(event, dict) and event.get("what") else []


def _changes_of_wind(scene):
    """In words: what makes the wind change in time."""
    said = [f"{text} at {when:g} s" for _, text, when in _gust(scene)]
    if _value(scene, "wind", "turbulence"):
        said.append("turbulence")
    if _value(scene, "wind", "table"):
        said.append("changes by a table")
    return f" with {' and '.join(said)}" if said else ""


OF_TURBINES = {"start_up": "a start-up", "shut_down": "a shut-down", "emergency_stop": "an emergency stop", "grid_loss": "a loss of the grid", "blade_stuck": "a stuck blade"}
STOPS = ("shut_down", "emergency_stop", "grid_loss")
PASSING = ("eog", *STOPS)   # after which no wind blows on, and no turbine runs, as before


def happenings(run):
    """[(what, in words, when [s])] of the gust and of what happens to turbines, within the run."""
    found = _gust(run.scene) + [(event["what"], OF_TURBINES.get(event["what"], event["what"]), event["time_s"]) for event in _value(run.scene, "control", "events") or []]
    return [event for event in found if len(run.time) and event[2] < run.time[-1]]


def _passing(run):
    """In words: what this run is made for, where its means cannot settle; None where they can."""
    begin = run.time[run.mean_range()[0]][0]
    shown = [f"{text} at {words.number(when)} s" for what, text, when in happenings(run) if what in PASSING or when >= begin]
    return " and ".join(shown) or None


def is_impact(run):
    """Bodies that go into water with a speed: their way and loads count, no mean does."""
    moves = any(any(body.get("velocity_m_s") or []) for body in (run.scene.get("bodies") or {}).values() if isinstance(body, dict))
    return moves and _value(run.scene, "sea", "model") == "sph" and decay.is_free(run) and not decay.decays(run)


def _walls(run):
    return "flow.lift_coefficient" in run.columns or "flow.drag_coefficient" in run.columns


MOST_BODIES = 3   # of the headline's figures


def _of(body, several):
    """' of heavy', where there are others that it could be taken for."""
    return f" of {body}" if several else ""


def _need_names(run, bodies):
    """Do motions need the name of their body? Where there are several, and of a turbine that stands: not the whole of it moves."""
    return len(bodies) > 1 or (kind(run) == "floating turbine" and _stands(run))


def _across(run, rotor):
    """The force of a rotor in its plane: what its load on its body has besides the thrust. None where no column tells, or where the tower's drag is in it."""
    given = dict(run.rotors()).get(rotor) or {}
    bodies = [body for body in quantities.bodies_of(run.columns)
              if given.get("body") in (body, None, "") and {f"{body}.{rotor}.f{axis}_N" for axis in "xyz"} <= set(run.columns)]
    tower = _value(run.scene, "aero", "tower")
    if len(bodies) != 1 or (tower and tower.get("has_drag", True) and bodies[0] not in told_bodies.spinning(run)):
        return None
    squares = sum(run.column(f"{bodies[0]}.{rotor}.f{axis}_N") ** 2 for axis in "xyz")
    return np.sqrt(np.maximum(squares - run.column(f"{rotor}.thrust_N") ** 2, 0.0))


def answers(run):
    """[(words, value, unit)]: the few figures that this kind of scene is run for; means over the summary's range, of a steady state those of its end.
    Where a figure swings its standard deviation stands behind it."""
    if not len(run.time):
        return []
    chosen, said = run.mean_range()[0], []
    values_of = lambda name: motions.values_of(run, name)
    mean = lambda name: words.mean(run.time[chosen], values_of(name)[chosen])
    if is_steady(run):   # what a march has come to is at its end
        mean = lambda name: float(run.column(name)[-1])

    def add(text, name, function=mean):
        if name in run.columns:
            value = function(name)
            if not (np.abs(run.column(name)) > run.round_off(name)).any():   # what a scene leaves out
                return
            say(text, name, value, words.deviation(run.time[chosen], values_of(name)[chosen]) if function is mean and not is_steady(run) else 0.0)

    def say(text, name, value, swing):
        value = 0.0 if abs(value) <= run.round_off(name) else value
        swings = math.isfinite(swing) and swing > max(SWINGS * abs(value), run.round_off(name))
        unit, factor = quantities.scaled(quantities.unit_of(name, run.described), max(abs(value) if math.isfinite(value) else 0.0, swing if swings else 0.0))
        # As far as its swing leaves it digits.
        digits = min(4, max(1, 2 + math.floor(math.log10(abs(value))) - math.floor(math.log10(swing)))) if swings and value else 4
        said.append((text, words.number(factor * value, digits) + (f" ± {words.number(factor * swing, 2)}" if swings else ""), unit))

    sort, least, greatest = kind(run), lambda name: float(np.nanmin(run.column(name))), lambda name: float(np.nanmax(run.column(name)))
    bodies, of_headline = told_bodies.told(run)
    several, drifts = _need_names(run, bodies), motions.drifting(run)
    if sort == "bodies" and is_impact(run):
        for body in impact.launched(run)[:MOST_BODIES]:
            add(f"heave{_of(body, several)}, at the end", f"{body}.z_m", lambda name: float(run.column(name)[-1]))
            if load := impact.of_body(run, body):
                name, over, _, means = load
                span = f"mean over {words.short(over)}" if over else "of one row"
                add(f"largest load of the water{_of(body, several)}, up, {span}", name, lambda name, means=means: float(np.nanmax(means)))
    elif sort in ("floating turbine", "bodies"):
        swings = motions.decays(run)
        for d in swings[:2]:   # what a decay test is made for
            motion = quantities.AXES[quantities.quantity_of(d.column)] + _of(d.column.rpartition(".")[0], several)
            said.append((f"{motion}, {'mean period of several motions' if d.several else 'period'}", words.number(d.period), "s"))
            if d.damping > 0.0 and not d.several:
                of = f"{words.number(100.0 * d.first, 3)} to {words.number(100.0 * d.last, 3)}" if d.falling else words.number(100.0 * d.damping, 3)
                said.append((f"{motion}, damping of critical" + (", first to last swings" if d.falling else ""), of, "%"))
        for body in of_headline[:MOST_BODIES] if not swings else ():
            for name in motions.moved(run, body):
                if name in drifts:
                    add(f"drift in {motions.spoken(name)}{_of(body, several)}", motions.rate_of(name))
                else:
                    add(motions.spoken(name) + _of(body, several), name)
    for text, name in (*_of_rotors(run, ("thrust", "thrust_N"), ("power", "power_W")), ("lift coefficient", "flow.lift_coefficient"),
                       ("drag coefficient", "flow.drag_coefficient"), *_of_rotors(run, ("electrical power", "electrical_power_W"))):
        add(text, name)
        across = _across(run, name.rpartition(".")[0]) if name.endswith(".thrust_N") else None
        if across is not None and (force := words.mean(run.time[chosen], across[chosen])) > max(abs(mean(name)), run.round_off(name)):   # parked, or far out of the wind
            say(text.replace("thrust", "force in the rotor's plane"), name, force, words.deviation(run.time[chosen], across[chosen]))
    if happenings(run):   # what it is simulated for
        for text, name in _of_rotors(run, ("thrust", "thrust_N"), ("rotor speed", "rpm")):
            add(f"{text}, least", name, least), add(f"{text}, greatest", name, greatest)
        for beam in dict.fromkeys(name.rpartition(".")[0] for name in run.columns if name.endswith(".start_mx_N_m")):
            greatest_of = lambda end, beam=beam: float(np.nanmax(np.hypot(run.column(f"{beam}.{end}_mx_N_m"), run.column(f"{beam}.{end}_my_N_m"))))
            say(f"bending moment of {beam}, greatest", f"{beam}.start_mx_N_m", max(greatest_of("start"), greatest_of("end")), 0.0)
        for rotor in quantities.rotors_of(run.columns):
            if flap := [name for name in run.columns if name.startswith(f"{rotor}.blade_") and name.endswith(".root_flap_N_m")]:
                hardest = max(flap, key=lambda name: np.nanmax(np.abs(run.column(name)), initial=0.0))
                add(f"flapwise moment at a root{_of(rotor.partition('.')[2], '.' in rotor)}, greatest", hardest, lambda name: float(np.nanmax(np.abs(run.column(name)))))
    if is_irregular(run) and "waves.elevation_m" in run.columns and not _crest(run.scene["waves"]):
        add("significant height of the waves, 4 sigma", "waves.elevation_m", lambda n: 4.0 * words.deviation(run.time[chosen], run.column(n)[chosen]))
    for joint in told_bodies.foundations(run) if sort == "bodies" else ():
        for text, part, unit in (("horizontal force", "f", "N"), ("overturning moment", "m", "N_m")):
            if {x := f"{joint}.{part}x_{unit}", y := f"{joint}.{part}y_{unit}"} <= set(run.columns):
                say(f"{text} on {joint}, greatest", x, float(np.nanmax(np.hypot(run.column(x), run.column(y)))), 0.0)
    tensions = [n for n in run.columns if n.endswith(".tension_N")]
    if tensions:
        largest = max(tensions, key=lambda n: np.nanmax(run.column(n), initial=0.0))
        add("largest tension", largest, lambda n: float(np.nanmax(run.column(n))))
    period = _value(run.scene, "waves", "period_s")

    def add_gauges(text, function):
        for name in run.columns:
            if name.endswith(".elevation_m") and not name.startswith("waves.") and len(said) < 4:
                add(text.format(name.rpartition(".")[0]), name, function)

    if sort == "tank" and is_irregular(run) and not _value(run.scene, "waves", "crest_alone"):
        add_gauges("significant height at {}, 4 sigma", lambda n: 4.0 * words.deviation(run.time[chosen], run.column(n)[chosen]))
    elif sort == "tank" and not is_irregular(run) and isinstance(period, (int, float)) and run.time[-1] - run.time[0] > 4.0 * period:
        last = run.time >= run.time[-1] - 2.0 * period
        add_gauges("wave height at {}", lambda n: float(np.ptp(run.column(n)[last])))
    elif sort == "tank":
        add_gauges("{}, highest", lambda n: float(np.nanmax(run.column(n))))
        if "sea.x_max_m" in quantities.key_columns(run.columns):
            add("farthest water, x", "sea.x_max_m", lambda n: float(run.column(n)[-1]))
    return said


class Reference:
    """What [[output.expected]] says of a column's mean, and what the run gave. `found` is nan, and `why_not` says why, where the run cannot tell."""

    def __init__(self, run, entry):
        self.column, self.wanted, self.within, self.source = entry["column"], float(entry["mean"]), float(entry["within"]), str(entry.get("source", ""))
        self.found, self.span, self.why_not = math.nan, "", ""
        end, asked = (float(run.time[-1]) if len(run.time) else math.nan), _value(run.scene, "time", "end_s")
        if self.column not in run.columns or not len(run.time):
            self.why_not = "the run has no such column"
        elif is_steady(run):
            self.found, self.span = float(run.column(self.column)[-1]), "at the end"
        elif isinstance(asked, (int, float)) and end < asked * (1.0 - 1e-6):
            self.why_not = f"the run ended at {end:.6g} s of {asked:.6g} s"
        else:
            begin = entry.get("from_s")
            chosen, self.span = run.mean_range() if begin is None else (run.time >= begin - 1e-9, f"{begin:.4g} to {end:.4g} s")
            if chosen.any():
                self.found = words.mean(run.time[chosen], run.column(self.column)[chosen])
            else:
                self.why_not = f"the run has no rows after {begin:.6g} s"

    def agrees(self):
        """None where the run cannot tell."""
        return None if self.why_not else bool(abs(self.found - self.wanted) <= self.within)


def references(run):
    found = _value(run.scene, "output", "expected")
    return [Reference(run, entry) for entry in found if isinstance(entry, dict) and {"column", "mean", "within"} <= set(entry)] if isinstance(found, list) else []


def _references(run):
    told = [r for r in references(run) if r.agrees() is not None]
    if not told:
        return None
    off = [quantities.spoken(r.column) for r in told if not r.agrees()]
    if off and (changed := run.changed_keys()):   # references are of the scene as its file has it
        return Check("good", "Expected", f"not judged, as the command line changed {', '.join(k.partition('=')[0] for k in changed)}; "
                     f"of the unchanged scene's references {len(told) - len(off)} of {len(told)} are met")
    return Check("warn" if off else "good", "Expected", f"{len(told) - len(off)} of {len(told)} references met" + (f"; not met: {', '.join(off)}" if off else ""))


# ---- health -----------------------------------------------------------------------------------------------------------------------------


def _end(run):
    code = run.summary.get("exit_code")
    reason = str(run.summary.get("exit_reason") or "")
    if code is None:
        return Check("warn", "End", reason or "no summary: interrupted, or still running")
    level = "good" if code == 0 else "warn" if code == 5 else "bad"
    word = EXITS.get(code, f"exit code {code}")
    told = reason and (level == "good" or reason.lower().startswith(word.lower()))
    return Check(level, "End", reason if told else f"{word}: {reason}" if reason else word)


def trouble(run):
    """Sentences about what went wrong numerically, from the summary and from the numbers themselves."""
    reason = str(run.summary.get("exit_reason") or "")
    said = [str(s) for s in run.summary.get("numerical_trouble", []) if str(s) not in reason]   # the end has been told
    for name, values in zip(run.columns, run.values):
        bad = ~np.isfinite(values)
        if bad.any() and not np.isnan(values).all():
            said.append(f"{name}: {bad.sum()} of {len(values)} values are not finite, the first at t = {words.number(run.time[bad.argmax()])} s")
    empty = [name for name, values in zip(run.columns, run.values) if len(values) and np.isnan(values).all()]
    if empty:
        said.append("no value at any time: " + ", ".join(empty))
    return said


def _draft(run):
    """Where the mean height of the first body is, and where the mean vertical load of the sea has it by the volume of its cylinders. None where
    that takes more than upright ones, of one width where they pass through the waterline."""
    bodies = quantities.bodies_of(run.columns)
    if not bodies or _value(run.scene, "sea", "model") != "sph":
        return None
    body = bodies[0]
    shapes = _value(run.scene, "bodies", body) or {}
    if any(shapes.get(kind) for kind in ("boxes", "spheres", "meshes")) or f"{body}.sea.fz_N" not in run.columns:
        return None
    rho, g = _value(run.scene, "environment", "water_density_kg_m3") or 1025.0, _value(run.scene, "environment", "gravity_m_s2") or 9.81
    area = volume = draft = 0.0
    for c in shapes.get("cylinders") or []:
        (x0, y0, z0), (x1, y1, z1) = c["start_m"], c["end_m"]
        low, high, d0, d1 = min(z0, z1), max(z0, z1), c["diameter_m"], c.get("end_diameter_m", c["diameter_m"])
        if math.hypot(x1 - x0, y1 - y0) > 1e-6 * (high - low) or (low < 0.0 < high and d0 != d1):
            return None
        if low < 0.0:   # the others are dry
            volume, draft = volume + math.pi / 12.0 * (d0 * d0 + d0 * d1 + d1 * d1) * (min(high, 0.0) - low), max(draft, -low)
        if low < 0.0 < high:
            area += math.pi / 4.0 * d0 * d0
    if not area > 0.0:
        return None
    chosen = _last_whole_waves(run)
    mean = lambda name: words.mean(run.time[chosen], run.column(name)[chosen])
    heave, expected = mean(f"{body}.z_m"), (volume - mean(f"{body}.sea.fz_N") / (rho * g)) / area
    off = heave - expected
    text = (f"{body} floats at {words.number(heave, 3)} m; the vertical load on it asks for {words.number(expected, 3)} m by the volume of its cylinders")
    if abs(off) <= 0.03 * draft:
        return Check("good", "Draft", text)
    return Check("warn", "Draft", f"{text}. It is {words.number(abs(off), 3)} m too {'high' if off > 0 else 'low'}, "
                 f"{100 * abs(off) / draft:.0f} % of the draft: finer particles bring it nearer")


RESTS = 0.05   # of a body's weight: contact that is more than a touch


def _places(run):
    """Bodies that turn over, go under, or pass through a bed that nothing in the sea holds up (particles have one)."""
    sea, found = _value(run.scene, "sea", "model"), []
    if not sea or sea == "none" or len(run.time) < 2:
        return found
    scene, depth = Scene3d(run), _value(run.scene, "environment", "water_depth_m") or math.inf
    rows = np.unique(np.linspace(0, len(run.time) - 1, 400).astype(int))
    serious = "bad" if kind(run) == "floating turbine" else "warn"
    moored = serious == "bad" or bool(run.scene.get("moorings"))
    for body in scene.bodies:
        points = scene.corners(body)
        if not len(points):
            continue
        centre, top = points.mean(axis=0), np.array([0.0, 0.0, 1.0])
        low, high, upright = [], [], []
        for t in run.time[rows]:
            z = scene.moved(body, np.vstack([points, centre, centre + top]), t)[:, 2]
            low.append(z[:-2].min()), high.append(z[:-2].max()), upright.append(z[-1] - z[-2])
        size = points[:, 2].max() - points[:, 2].min()
        low, high, upright, at = np.array(low), np.array(high), np.array(upright), run.time[rows]
        if upright.min() < 0.0 and _has_a_top(scene.bodies[body], points):
            found.append(Check(serious, "Upright", f"{body} has turned over at t = {words.number(at[int((upright < 0.0).argmax())])} s"))
        elif upright.min() < LEANS * max(upright[0], 0.0) and _has_a_top(scene.bodies[body], points):
            found.append(Check("warn", "Upright", f"{body} leans by up to {math.degrees(math.acos(max(-1.0, upright.min()))):.0f} degrees, past 30 first at t = {words.number(at[int((upright < LEANS).argmax())])} s"))
        afloat = high >= -0.05 * size
        if moored and points[:, 2].max() > 0.0 and not afloat[-1]:
            last = np.flatnonzero(afloat)[-1] if afloat.any() else 0
            found.append(Check(serious, "Afloat", f"{body} is wholly under water after t = {words.number(at[last])} s"))
        passed = low < min(-depth, points[:, 2].min()) - 0.002 * min(depth, 1e3)
        if sea == "sph" and serious == "bad" and passed.any():
            settled = passed & (at >= run.time[run.mean_range()[0]][0])
            found.append(Check("bad" if settled.any() else "warn", "Bed", f"{body} lies on the bed, first at t = {words.number(at[int(passed.argmax())])} s: where no "
                               "particle fits nothing carries it" + ("" if settled.any() else "; not within the stretch of the means")))
        elif sea == "sph" and (rests := _rests_on_bed(run, body, low, rows)) is not None:
            found.append(Check("warn", "Bed", f"{body} lies on the bed, first at t = {words.number(at[rests])} s: contact carries it, and its water load holds no buoyancy, as no water is under it"))
        if sea != "sph" and passed.any():
            settled = passed & (at >= run.time[run.mean_range()[0]][0])
            found.append(Check("bad" if settled.any() else "warn", "Bed", f"{body} reaches {words.number(float(-depth - low.min()), 3)} m under the bed, first at t = "
                               f"{words.number(at[int(passed.argmax())])} s: nothing in this sea holds it up there"
                               + ("" if settled.any() else "; not within the stretch of the means")))
    return found


def _rests_on_bed(run, body, low, rows):
    """Index in `rows` where a body of a sea of particles first rests on the bed, None where contact does not carry it there for most of the stretch of the means."""
    contact, mass = f"{body}.contact.fz_N", _value(run.scene, "bodies", body, "mass_kg")
    if contact not in run.columns or not isinstance(mass, (int, float)):
        return None
    depth, spacing = _value(run.scene, "environment", "water_depth_m") or math.inf, _value(run.scene, "sea", "particles", "spacing_m") or 0.0
    slope = _value(run.scene, "sea", "tank", "bed_m") or []
    x = (_value(run.scene, "bodies", body, "centre_m") or [0.0])[0] + (run.column(f"{body}.x_m")[rows] if f"{body}.x_m" in run.columns else 0.0)
    bed = np.interp(x, *zip(*slope)) if slope else -depth
    rests = (run.column(contact)[rows] > RESTS * mass * (_value(run.scene, "environment", "gravity_m_s2") or 9.81)) & (low < bed + spacing)
    judged = run.mean_range()[0][rows]
    return int(rests.argmax()) if judged.any() and rests[judged].mean() > 0.5 else None


def _has_a_top(body, points):
    """Is there a right way up? Not of balls and of flat or lying bodies."""
    size = np.ptp(points, axis=0)
    return bool(body.get("cylinders") or body.get("boxes")) and size[2] > 0.2 * size[:2].max()


def _power(run):
    """Mean power of each rotor against that of its turbine's operation table at this wind; the worst of several first."""
    found = [(name, check) for name, given in run.rotors() if (check := _power_of(run, name, given)) is not None]
    found.sort(key=lambda pair: pair[1].level == "good")
    if len(found) < 2:
        return found[0][1] if found else None
    return Check(found[0][1].level, "Power", "; ".join(f"{name.replace('.', ' ')}: {check.text}" for name, check in found))


def _stands_still(run, name):
    """Is the rotor parked, or stopped by an event?"""
    control = _value(run.scene, "control") or {}
    still = control.get("start") == "parked"
    for event in sorted(control.get("events") or [], key=lambda e: e["time_s"]):
        if event.get("rotor") in (None, "", name.partition(".")[2]) and event["time_s"] < run.time[-1]:
            still = event["what"] in STOPS or (still and event["what"] != "start_up")
    return still


def _wind_at(run, name):
    """Its speed: of wind that changes the mean at the hub, None where no column has it."""
    if not _changes_of_wind(run.scene):
        return _value(run.scene, "wind", "speed_m_s")
    if not {f"{name}.wind_x_m_s", f"{name}.wind_y_m_s"} <= set(run.columns):
        return None
    chosen = run.mean_range()[0]
    return words.mean(run.time[chosen], np.hypot(run.column(f"{name}.wind_x_m_s"), run.column(f"{name}.wind_y_m_s"))[chosen])


def _power_of(run, name, rotor):
    column, table = f"{name}.power_W", run.operation(rotor)
    if not len(run.time) or column not in run.columns or _stands_still(run, name):
        return None
    chosen = run.mean_range()[0]
    power, largest = words.mean(run.time[chosen], run.column(column)[chosen]), float(np.nanmax(np.abs(run.column(column))))
    if power < -0.01 * largest and not is_steady(run):
        return Check("warn", "Power", f"mean {words.number(1e-6 * power, 3)} MW: the rotor drives the air, as it turns faster than this wind would turn it; "
                     "blade elements are not made for that, and its loads scatter")
    wind = _wind_at(run, name)
    if table is None or not wind or not {"wind_m_s", "power_W"} <= set(table):
        return None
    stated, rated = float(np.interp(wind, table["wind_m_s"], table["power_W"])), max(table["power_W"])
    text = f"mean {words.number(1e-6 * power, 3)} MW; the turbine's table has {words.number(1e-6 * stated, 3)} MW at {wind:.4g} m/s, rated {words.number(1e-6 * rated, 3)} MW"
    level = "good" if abs(power - stated) <= 0.15 * max(stated, 1.0) else "warn"
    return Check(level, "Power", text)


def _lines(run):
    tensions = [n for n in run.columns if n.endswith(".tension_N")]
    if not tensions or not len(run.time):
        return None
    least = {n: -1e-4 * np.nanmax(np.abs(run.column(n)), initial=0.0) for n in tensions}   # the ring of a line that is just taut is no push
    pushed = [n for n in tensions if np.nanmin(run.column(n)) < least[n]]
    if pushed:
        names = [n.rpartition(".")[0] for n in pushed]
        lines = run.scene.get("moorings") or {}
        if all((lines.get(name) or {}).get("tension_only") is False for name in names):
            share = max(float(np.mean(run.column(n) < least[n])) for n in pushed)
            return Check("warn", "Lines", f"push up to {words.number(100 * share, 2)} % of the time, which no rope does: {', '.join(names)} (tension_only = false makes "
                         "them springs both ways)")
        return Check("bad", "Lines", "push, which no line can: " + ", ".join(names))
    slack = {n.rpartition(".")[0]: _slack(run, n) for n in tensions}
    said = [f"{name} {100 * share:.0f} % of the time" for name, share in slack.items() if share]
    none = "; none goes slack" if None not in slack.values() else ""
    return Check("good", "Lines", "none pushes" + (f"; slack: {', '.join(said)}" if said else none))


def _slack(run, column):
    """Share of the time in which a line hangs loose; None for catenaries, which always carry what hangs of them. A dynamic line that is loose carries its last half
    segment, and what waves do to that."""
    line = (run.scene.get("moorings") or {}).get(column.rpartition(".")[0]) or {}
    model = line.get("model")
    if model in ("catenary", "composite_catenary"):
        return None
    segment = line.get("mass_kg_m", 0.0) * line.get("rest_length_m", 0.0) / line.get("segments", 20) if model == "lumped_mass" else 0.0
    return float(np.mean(run.column(column) <= 9.81 * segment))


HOURLY = 1.0 / 6.0   # h: of a shorter run a rate per hour says nothing


def _energy(run):
    """Energy that the time steps made or lost, against the most that was in motion: the work of single loads, weight and buoyancy, may be far larger."""
    works = [run.column(n) for n in run.columns if n.startswith("energy.") and n.endswith("work_J")]
    if "energy.steps_J" not in run.columns or len(run.time) < 2:
        return None
    made, net = float(run.column("energy.steps_J")[-1]), sum(works)
    moved = max(float(run.column("energy.kinetic_J").max()), float(np.abs(net - net[0]).max()) if works else 0.0)
    if not moved > 0.0:
        return None
    hours = (run.time[-1] - run.time[0]) / 3600.0
    share, round_off = abs(made) / moved, 1e-12 * sum(float(np.abs(np.diff(w)).sum()) for w in works)
    good = share < 0.02 or abs(made) <= round_off
    text = (f"the bodies' steps {'made' if made > 0 else 'lost'} {words.number(abs(made), 2)} J, {words.number(100 * share, 2)} % of the largest kinetic energy or net work"
            + (f"; {words.number(abs(made) / hours, 2)} J an hour" if hours >= HOURLY else ""))
    return Check("good" if good else "warn", "Energy", text + ("" if share < 0.02 else ": round-off of the loads' work" if good else ": try a smaller time.step_s"))


def _water(run):
    """The balance of the water's energy: what comes from solids and goes to viscosity and damping zones, against what the water has."""
    stored = ["sea.kinetic_energy_J", "sea.potential_energy_J", "sea.compression_energy_J"]
    flows = ["sea.work_of_solids_J", "sea.dissipated_J", "sea.absorbed_J"]
    if not set(stored + flows) <= set(run.columns) or len(run.time) < 2:
        return None
    gained = sum(float(run.column(n)[-1] - run.column(n)[0]) for n in stored)
    work, dissipated, absorbed = (float(run.column(n)[-1] - run.column(n)[0]) for n in flows)
    left = float(run.column("sea.left_J")[-1] - run.column("sea.left_J")[0]) if "sea.left_J" in run.columns else 0.0
    made = gained - work + dissipated + absorbed + left
    turned = max(abs(work) + abs(dissipated) + abs(absorbed), float(np.ptp(run.column(stored[0]))))   # over; of a sea at rest next to nothing
    if not turned > 1e-9 * float(np.abs(run.column(stored[1])).max()):
        return None
    hours, share = (run.time[-1] - run.time[0]) / 3600.0, abs(made) / turned
    unit, factor = quantities.scaled("J", max(abs(work), abs(dissipated), abs(absorbed), abs(left)))
    said = f"work of bodies and paddle {words.number(factor * work, 3)} {unit}, dissipated {words.number(factor * dissipated, 3)}, absorbed in zones {words.number(factor * absorbed, 3)}" + (
        f", taken along by water that left {words.number(factor * left, 3)}" if left else "")
    rate = f", {words.number(factor * made / hours, 2)} {unit} an hour" if hours >= HOURLY else ""
    good, gains = share < 0.05, dissipated < -0.05 * turned   # friction and diffusion only take
    text = (f"{said}; unexplained {words.number(factor * made, 2)} {unit} ({words.number(100 * share, 2)} % of what was turned over{rate})"
            + ("" if good else ": by time steps, shifting or density filters")
            + ("; the water gains where friction and diffusion only take: forces at walls make energy" if gains else ""))
    mass = run.column("sea.mass_kg") if "sea.mass_kg" in run.columns else None
    if mass is not None and mass[-1] != mass[0]:
        text += f"; {words.number(100 * (1 - mass[-1] / mass[0]), 2)} % of the water left the tank"
    return Check("good" if good and not gains else "warn", "Water", text)


def _air_mass(run):
    """The balance of the air's mass: does it close, and is what the pseudo-steps left of it small beside what flows through the grid?"""
    side = next((s for s in ("air.", "flow.") if f"{s}mass_residual_kg_s" in run.columns), None)
    if side is None or len(run.time) < 2:
        return None
    inflow, outflow, growth, residual = (run.column(f"{side}mass_{n}_kg_s")[1:] for n in ("inflow", "outflow", "growth", "residual"))
    if is_steady(run):   # on the way there is no balance to keep
        inflow, outflow, growth, residual = (values[-1:] for values in (inflow, outflow, growth, residual))
    through = float(np.abs(inflow).max())
    if not through > 0.0:
        return None
    turned = np.abs(growth) + inflow + outflow
    open_by = float(np.max(np.abs(growth + outflow - inflow - residual) / np.where(turned > 0.0, turned, 1.0)))
    left = float(np.abs(residual).max()) / through
    text = (f"{words.number(through, 3)} kg/s flow through the grid; the pseudo-steps leave at most {words.number(100 * left, 2)} % of it; "
            f"the balance closes to {words.number(open_by, 1)}")
    if open_by > 1e-9:
        return Check("bad", "Air mass", f"the balance of mass does not close: {words.number(100 * open_by, 2)} % of what flows is unexplained")
    return Check("good" if left < 0.01 else "warn", "Air mass", text + ("" if left < 0.01 else ": a smaller aero.flow.drop, or more max_pseudo_steps"))


def _drop_of_windows(run):
    """Do the pseudo-steps of the air's windows come to the drop that the scene asks for, of what it is counted by?"""
    drop = _value(run.scene, "aero", "flow", "drop")
    by_balance = _value(run.scene, "aero", "flow", "drop_of") == "balance"
    name, what = ("air.balance_drop", "flux balance") if by_balance else ("air.residual_drop", "density residual")
    if name not in run.columns or not isinstance(drop, (int, float)):
        return None
    made = np.isfinite(run.column(name))
    if "air.pseudo_steps" in run.columns:   # the row of the start has none
        made &= run.column("air.pseudo_steps") > 0
    values = run.column(name)[made]
    if not len(values):
        return None
    if drop == 0.0:   # the scene asks for all its pseudo-steps, whatever they reach
        middle = float(np.median(values))
        return Check("good" if middle <= 0.1 else "warn", "Air", f"the {what} falls to {words.number(middle, 2)} of its start in the median window, "
                     f"to {words.number(float(values.max()), 2)} in the worst")
    share = float(np.mean(values <= drop))
    return Check("good" if share >= 0.9 else "warn", "Air", f"the {what} falls to {drop:g} of its start in {100 * share:.0f} % of the windows"
                 + ("" if share >= 0.9 else "; the others end at max_pseudo_steps"))


def _windows(run):
    found = []
    if "coupling.mismatch" in run.columns:
        values = run.column("coupling.mismatch")
        finite = values[np.isfinite(values)]
        asked = _value(run.scene, "coupling", "tolerance")
        if len(finite):
            worst = float(finite.max())
            strong = "coupling.columns" in run.columns
            missed = strong and isinstance(asked, (int, float)) and worst > asked
            # One exchange to a window: past the first ones, loads that differ by half are no longer those of the motion.
            apart = not strong and float(np.quantile(finite[len(finite) // 2:], 0.95)) > 0.5
            found.append(Check("warn" if missed or apart else "good", "Coupling",
                               f"loads in and out of a window differ by at most {words.number(100 * worst, 2)} %"
                               + (f"; asked: {words.number(100 * asked, 2)} %" if strong and isinstance(asked, (int, float)) else "")
                               + (": windows are too long for a scheme that does not iterate" if apart else "")))
    if check := _drop_of_windows(run):
        found.append(check)
    if is_steady(run) and (check := _residual(run)):
        found.append(check)
    return found


def _residual(run):
    """How far a march to a steady state has come, by the density's residual and by the balance of all fluxes."""
    values, drop = (run.column("flow.density_residual") if "flow.density_residual" in run.columns else np.empty(0)), _value(run.scene, "aero", "flow", "drop")
    balance = float(run.column("flow.balance_drop")[-1]) if "flow.balance_drop" in run.columns and len(run.time) else math.nan
    if balance > 1.0 and "the loads have settled" in str(run.summary.get("exit_reason") or "") and len(values) and values[-1] < 0.01 * np.nanmax(values):
        return Check("warn", "Residual", f"the loads have settled and the density residual fell to {words.number(values[-1] / np.nanmax(values), 2)} of its largest; the flux balance, "
                     f"that of turbulence in it, ends at {words.number(balance, 2)} times that of the start: the loads may be trusted, the wake less")
    if balance > 1.0:
        return Check("bad", "Residual", f"the march did not converge: its flux balance ends at {words.number(balance, 2)} times that of the start. Give it more pseudo-steps (time.end_s), or "
                     "smaller ones (aero.flow.cfl_max) where it rises on")
    if not len(values) or not np.nanmax(values) > 0.0:
        return None
    fell = values[-1] / np.nanmax(values)
    text = f"fell to {words.number(fell, 2)} of its largest" + (f", the flux balance to {words.number(balance, 2)} of that of the start" if math.isfinite(balance) else "")
    enough = fell <= 1.01 * max(drop or 0.0, 1e-3) and not balance > NOT_YET
    return Check("good" if enough else "warn", "Residual", text + ("" if enough else ": give it more pseudo-steps (time.end_s)"))


def _particles(run):
    if "sea.lost_particles" not in run.columns or not len(run.time):
        return None
    lost = run.column("sea.lost_particles")[-1]
    left = run.column("sea.left_particles")[-1] if "sea.left_particles" in run.columns else 0
    said = [f"{lost:.0f} slipped through walls"] * bool(lost > 0) + [f"{left:.0f} left over the edge or through open sides"] * bool(left > 0)
    return Check("good" if lost == 0 else "warn", "Particles", "; ".join(said) or "none left the tank")


CLOSED, OPEN = 1e-6, 1e-3   # what joints may be apart, over the largest arm of one: by round-off; a wrong mechanism


def _budgets(run):
    """Columns that say how well something is conserved, whatever part of the program writes them."""
    found = []
    for name in run.columns:
        quantity = name.rpartition(".")[2]
        if not any(word in quantity for word in ("budget", "constraint", "imbalance", "conservation")):
            continue
        values = run.column(name)
        values = values[np.isfinite(values)]
        if len(values):
            unit, most = quantities.unit_of(name, run.described), float(np.abs(values).max())
            part, closes = name.rpartition(".")[0], quantity == "constraint_residual"
            found.append(Check("good" if not closes or most < CLOSED else "warn" if most < OPEN else "bad", (part or "Budget").capitalize(),
                               f"{quantities.quantity_of(name).replace('_', ' ')} at most {words.number(most, 2)} {'of the largest arm of a joint' if closes else unit}".strip()))
    return found


NOT_YET = 0.1   # of a march's first flux balance: what is above has hardly begun to converge
STILL, LOOKED_BACK = 0.01, 20   # change of a load that counts as none; over so many pseudo-steps (a quarter of a shorter march)


def _marched(run):
    """Has a march to a steady state come to steady loads? A residual may have fallen while they still change."""
    back = min(LOOKED_BACK, len(run.time) // 4)
    if not is_steady(run) or back < 2:
        return None
    moving = []
    for text, name in (*_of_rotors(run, ("thrust", "thrust_N"), ("power", "power_W")), ("lift coefficient", "flow.lift_coefficient"), ("drag coefficient", "flow.drag_coefficient")):
        if name in run.columns:
            last = run.column(name)[-back:]
            change, size = float(np.ptp(last)), abs(float(last[-1]))
            other = {"drag coefficient": "flow.lift_coefficient", "lift coefficient": "flow.drag_coefficient"}.get(text)
            floor = 0.02 * abs(float(run.column(other)[-1])) if other in run.columns else 0.0   # a section at no incidence has no lift
            if change > STILL * max(size, floor):
                moving.append(f"{text} by {words.number(100 * change / max(size, 1e-300), 2)} %")
    if moving:
        return Check("warn", "Settled", f"not yet: over the last {back} pseudo-steps " + ", ".join(moving) + " changed; give it more (time.end_s)")
    return Check("good", "Settled", f"loads changed by less than {100 * STILL:g} % over the last {back} pseudo-steps")


def _moving_bodies(run, between, chosen):
    """In words: motions of bodies whose means differ between the halves of their stretch."""
    bodies, towed = told_bodies.told(run)[0], told_bodies.towed(run)
    random = is_irregular(run) or bool(_value(run.scene, "wind", "turbulence"))
    return [f"{_motion(run, name, bodies)} by {words.number(change, 2)} {quantities.unit_of(name, run.described)}"
            for name, change in motions.changing(run, [b for b in bodies if b not in towed], between, chosen, random) if name not in motions.drifting(run)]


def _motion(run, name, bodies):
    """'sway', of several bodies 'sway of heavy'."""
    return motions.spoken(name) + _of(name.rpartition(".")[0], _need_names(run, bodies))


def _swings(run):
    """(the check of bodies that swing freely, None where their means count; in words: which of their swings are of several motions)."""
    (few, mixed), free = motions.still_swinging(run), motions.decays(run)
    named = lambda columns: " and ".join(_motion(run, name, quantities.bodies_of(run.columns)) for name in columns)
    mixed = [*mixed, *(d.column for d in free if d.several)]
    mixed = f"; several motions are in {named(mixed)}, whose swings do not fall as those of one: no single damping holds" if mixed else ""
    still = f"still swinging in {named(few)}, too few times for a period and a damping: run on (time.end_s)" if few else ""
    if free:
        told = "its swings do" if all(d.several for d in free) else "its period and damping do"
        return Check("good", "Settled", f"a free motion, which nothing drives: its means say nothing, {told}{mixed}" + (f"; {still}" if still else "")), mixed
    return Check("warn", "Settled", still + mixed) if still else None, mixed


def _slight(run, name):
    """What a rotor's thrust or power must change by to count: the thrust that is nothing, and its power in the wind or at 1 m/s."""
    quantity, wind = name.rpartition(".")[2], _value(run.scene, "wind", "speed_m_s")
    if quantity not in ("thrust_N", "power_W"):
        return 0.0
    return decay.slight_thrust(run) * (max(1.0, wind if isinstance(wind, (int, float)) else 0.0) if quantity == "power_W" else 1.0)


def _settled(run):
    """Do the means stand for more than their stretch? Halves of the range compared, for all figures that the run answers with."""
    if len(run.time) < 20 or is_steady(run) or kind(run) in ("tank", "run"):
        return None
    chosen = np.flatnonzero(run.mean_range()[0])
    if len(chosen) < 10:
        return None
    moving = []
    first, second = np.array_split(chosen, 2)
    if is_impact(run):
        return Check("good", "Settled", "an impact: its way and its loads count, no mean does")
    free, mixed = _swings(run)
    if free:
        return free
    period = _value(run.scene, "waves", "period_s") or _value(run.scene, "waves", "peak_period_s")
    if isinstance(period, (int, float)) and period > 0 and not is_irregular(run):   # whole waves alone have a mean
        begin, end = run.time[chosen[0]], run.time[chosen[-1]]
        waves = int((end - begin) / period + 1e-6) // 2
        if waves == 0:
            return None
        first, second = chosen[run.time[chosen] <= begin + waves * period + 1e-9], chosen[run.time[chosen] >= end - waves * period - 1e-9]
    between = lambda values: words.mean(run.time[second], values[second]) - words.mean(run.time[first], values[first])
    for text, name in (*_of_rotors(run, ("thrust", "thrust_N"), ("power", "power_W")), ("lift coefficient", "flow.lift_coefficient"), ("drag coefficient", "flow.drag_coefficient"),
                       *((f"tension of {n.rpartition('.')[0]}", n) for n in run.columns if n.endswith(".tension_N"))):
        if name in run.columns:
            values = run.column(name)
            size = abs(words.mean(run.time[chosen], values[chosen]))
            # A swinging load has halves whose means differ by chance: a fifth of its swing is none.
            if abs(change := between(values)) > max(0.05 * size, 0.2 * words.deviation(run.time[chosen], values[chosen]), run.round_off(name), _slight(run, name)):
                moving.append(f"{text} by {words.number(100.0 * change / max(size, 1e-300), 2)} %")
    moving += _moving_bodies(run, between, chosen)
    asked = _value(run.scene, "output", "means_over_s")
    if isinstance(asked, (int, float)) and run.time[-1] - run.time[0] < 1.2 * asked and not moving and kind(run) == "floating turbine":
        return Check("warn", "Settled", f"not known: the run is hardly longer than the stretch of its means (output.means_over_s = {words.number(asked)}), which begins with the start")
    if moving and (shown := _passing(run)):
        return Check("good", "Settled", f"what the run shows is {shown}: its least and greatest values count, no mean does" + mixed)
    if moving:
        return Check("warn", "Settled", "not yet: between the halves of the stretch of the means, " + ", ".join(moving) + " changed"
                     + (": turbulence takes a longer stretch, 600 s as a rule (time.end_s, output.means_over_s)" if _value(run.scene, "wind", "turbulence") else
                        ": run on (time.end_s), or leave more of the start out (output.means_over_s)") + mixed)
    return Check("good", "Settled", "means of both halves of their stretch agree" + mixed)


def waves_in_means(run):
    """How many regular waves the stretch of the means holds; nan where there are none."""
    waves = run.scene.get("waves") or {}
    period, height = waves.get("period_s"), waves.get("height_m")
    if not (isinstance(period, (int, float)) and period > 0 and isinstance(height, (int, float)) and height > 0) or is_irregular(run) or is_steady(run) or len(run.time) < 2:
        return math.nan
    chosen = np.flatnonzero(run.mean_range()[0])
    return float(run.time[chosen[-1]] - run.time[chosen[0]]) / period


def _last_whole_waves(run):
    """Rows of the means' stretch, of regular waves those of its last whole ones."""
    chosen, count = run.mean_range()[0], waves_in_means(run)
    if not count >= 1.0:   # none, or no waves
        return chosen
    return chosen & (run.time >= run.time[chosen][-1] - int(count + 1e-6) * run.scene["waves"]["period_s"] - 1e-9)


SEA_STATE = 20   # waves of the peak's period below which heights and means of a sea state are chance


def _few_waves(run):
    """A sea state of a few waves is none: its height scatters by a part over the root of twice their number."""
    waves = run.scene.get("waves") or {}
    period = waves.get("peak_period_s") or waves.get("period_s")
    if not is_irregular(run) or _crest(waves) or not isinstance(period, (int, float)) or not period > 0.0 or len(run.time) < 2 or is_steady(run):
        return None
    chosen = np.flatnonzero(run.mean_range()[0])
    count = float(run.time[chosen[-1]] - run.time[chosen[0]]) / period
    return Check("warn", "Means", f"over {words.number(count, 2)} waves of the sea state's peak: its height, and all that it moves, scatters by chance; take {SEA_STATE} or more, "
                 "1 h as a rule (time.end_s, output.means_over_s)") if count < SEA_STATE else None


def _crest(waves):
    """Is the sea state there for one crest?"""
    return bool(waves.get("crest_alone") or waves.get("crest_height_m"))


def _whole_waves(run):
    """A mean over a part of a wave holds a part of its swing."""
    count, bodies = waves_in_means(run), told_bodies.told(run)[0]
    if not math.isfinite(count) or not bodies:
        return None
    period, whole, drifts = run.scene["waves"]["period_s"], int(count + 1e-6), motions.drifting(run)
    if whole == 0:
        return Check("warn", "Means", f"over {words.number(count, 2)} of a wave, which say little: output.means_over_s = {words.number(period)} is one wave")
    chosen, off, tail = run.mean_range()[0], [], _last_whole_waves(run)
    for text, name, least in (*((_motion(run, name, bodies), name, motions.bar(name)) for body in bodies for name in motions.columns_of(run, body) if name not in drifts),
                              *((text, name, 1.0) for text, name in _of_rotors(run, ("thrust", "thrust_N")))):
        if name in run.columns:
            values = motions.values_of(run, name)
            all_of_it, waves = words.mean(run.time[chosen], values[chosen]), words.mean(run.time[tail], values[tail])
            if abs(all_of_it - waves) > max(least, 0.1 * abs(waves)):
                unit, factor = quantities.scaled(quantities.unit_of(name, run.described), abs(waves))
                off.append(f"{text} {words.number(factor * waves, 3)} for {words.number(factor * all_of_it, 3)} {unit}".strip())
    return Check("warn", "Means", f"over {words.number(count, 3)} waves; over the last {f'{whole} whole ones' if whole > 1 else 'whole one'}: {', '.join(off)}") if off else None


MOST_WARNINGS, LONGEST_WARNING = 3, 240


def _warned(run, count):
    """What the log warns of: the first of its warnings."""
    said = list(dict.fromkeys(found[2].strip() for line in run.log if (found := words.LEVEL.match(line)) and found[1] == "warning"))
    shown = [text if len(text) <= LONGEST_WARNING else text[: LONGEST_WARNING - 3] + "..." for text in said[:MOST_WARNINGS]]
    more = "; the others are in the log" if len(said) > MOST_WARNINGS or count > len(said) > 0 else ""
    return f": {' | '.join(shown)}{more}" if shown else ""


def health(run):
    """All checks that the run's data allow, the worst first."""
    found = [_end(run)]
    said = trouble(run)
    found += [Check("bad", "Numbers", s) for s in said]
    if not said and len(run.time):
        found.append(Check("good", "Numbers", f"all {run.values.size:,} of history.csv are finite"))
    found += _places(run)
    found += [c for c in (_draft(run), _power(run), _lines(run), _energy(run), _water(run), _air_mass(run), _particles(run), _settled(run), _marched(run), _whole_waves(run), _few_waves(run), _references(run)) if c]
    found += _windows(run) + _budgets(run)
    if warnings := run.summary.get("warnings"):
        found.append(Check("warn", "Log", f"{warnings} warning{'s' if warnings != 1 else ''}" + _warned(run, warnings)))
    found += [Check("warn", "Files", note) for note in run.notes]
    return sorted(found, key=lambda c: ORDER[c.level])


def _named(check, most=110):
    """A check by its title, the log by how its first warning begins."""
    if check.title != "Log":
        return check.title.lower()
    return f"log ({check.text if len(check.text) <= most else check.text[: most - 3].rstrip() + '...'})"


def headline(checks):
    """(level, words) of all checks together: nobody reads 'done' over a result that is wrong."""
    worst = min((c.level for c in checks), key=ORDER.get)
    if worst == "bad":
        return worst, "Do not trust this run: " + "; ".join(c.title.lower() for c in checks if c.level == "bad")
    if worst == "warn":
        return worst, "Look before you trust it: " + ", ".join(dict.fromkeys(_named(c) for c in checks if c.level == "warn"))
    return worst, "Nothing stands against these results"
