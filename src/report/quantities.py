"""What the columns of history.csv mean: units from names, groups for figures, words for captions (docs/user/outputs.md lists the names).
Called by figures.py, page.py and picture.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import re

UNITS = {"m_s2": "m/s²", "kg_s": "kg/s", "rad_s2": "rad/s²", "deg_s2": "deg/s²", "m_s": "m/s", "rad_s": "rad/s", "deg_s": "deg/s", "N_m": "N m", "N": "N",
         "W": "W", "deg": "deg", "rad": "rad", "rpm": "rpm", "m": "m", "s": "s", "Pa": "Pa", "kg": "kg", "J": "J"}
AXES = {"x": "surge", "y": "sway", "z": "heave", "roll": "roll", "pitch": "pitch", "yaw": "yaw"}
SPOKEN = {"x_max": "farthest water along x", "rpm": "speed"}


def unit_of(name, described=None):
    """Of a column: as declared in summary.json, else from the end of its name."""
    declared = (described or {}).get(name, {}).get("unit")
    if declared and declared != "-":
        return declared.replace("m/s2", "m/s²").replace("s2", "s²")
    last = name.rsplit(".", 1)[-1]
    for suffix, unit in UNITS.items():
        if last == suffix or last.endswith("_" + suffix):
            return unit
    return ""


def quantity_of(name):
    """The column's last part without its unit: 'x' of platform.x_m."""
    last = name.rsplit(".", 1)[-1]
    for suffix in UNITS:
        if last.endswith("_" + suffix):
            return last[: -len(suffix) - 1]
    return last


def spoken(name):
    """'platform surge' for platform.x_m."""
    prefix, quantity = name.rpartition(".")[0], quantity_of(name)
    return f"{prefix} {(AXES | SPOKEN).get(quantity, quantity).replace('_', ' ')}".strip()


def scaled(unit, largest):
    """Unit with a prefix, and the factor, so that figures read without powers of ten: (kN, 1e-3)."""
    if unit not in ("N", "N m", "W", "Pa", "J"):
        return unit, 1.0
    for prefix, factor in (("G", 1e-9), ("M", 1e-6), ("k", 1e-3)):
        if largest * factor >= 1.0:
            return prefix + unit, factor
    return unit, 1.0


class Group:
    """One figure: panels, each a label and the columns drawn in it (legend entry, column). `multiples`: of one quantity at several places, which have
    a panel each where they are many."""

    def __init__(self, key, title, caption, panels, fold=False, multiples=False):
        self.key, self.title, self.caption, self.panels, self.fold, self.multiples = key, title, caption, panels, fold, multiples

    def columns(self):
        return [column for _, lines in self.panels for _, column in lines]


def _triple(names, prefix, quantities, labels=None):
    """Panels of those of prefix.quantity_unit that there are, one line each."""
    panels = []
    for quantity in quantities:
        for name in names:
            if name.rpartition(".")[0] == prefix and quantity_of(name) == quantity:
                panels.append(((labels or {}).get(quantity, quantity), [("", name)]))
    return panels


def bodies_of(names):
    return list(dict.fromkeys(n.rpartition(".")[0] for n in names if re.search(r"(?<!\.blade_.)\.((x|y|z)_m|(roll|pitch|yaw)_deg)$", n)))


def rotors_of(names):
    """What the columns of each rotor begin with: "rotor", or "rotor.NAME" of several."""
    found = (re.fullmatch(r"(rotor(?:\.(?!blade_\d+\.)[^.]+)?)\.thrust_N", n) for n in names)
    return [match[1] for match in found if match]


def of_rotors(names, text, quantity):
    """[("thrust", "rotor.thrust_N")], of several rotors [("thrust of a", "rotor.a.thrust_N"), ...]."""
    return [(f"{text} of {name}" if (name := rotor.partition(".")[2]) else text, f"{rotor}.{quantity}") for rotor in rotors_of(names)]


def kind_of_body(name):
    """'displacement', 'angle', 'force' or 'moment' of a column of a body, its sources and joints; "" of others."""
    for kind, pattern in (("displacement", r"\.[xyz]_m"), ("angle", r"(?<!blade_.)\.(roll|pitch|yaw)_deg"), ("force", r"\.f[xyz]_N"), ("moment", r"\.m[xyz]_N_m")):
        if re.search(pattern + "$", name) and not name.startswith("flow."):
            return kind
    return ""


def _held_by(names, joints, body):
    """{quantity: lines} of the forces of the joints that hold a body; a joint's columns are what it does to its second body. Each is drawn once."""
    found = {}
    for joint, pair in joints.items():
        if len(pair) != 2 or body != next((b for b in pair if b != "earth"), None):
            continue
        for axis in "xyz":
            if (name := f"{joint}.f{axis}_N") in names:
                found.setdefault("f" + axis, []).append((f"{joint}, on {pair[1]}", name))
    return found


def groups(names, joints=None):
    """All figures that the columns give, in the order of the page. Every column but the time is in exactly one. `joints`: {joint: its two bodies}."""
    found = []
    bodies = bodies_of(names)

    def add(key, title, caption, panels, fold=False, multiples=False):
        if panels:
            found.append(Group(key, title, caption, panels, fold, multiples))

    for body in bodies:
        fold = body != bodies[0]
        add("motion", f"{body}: position", "Displacement from the scene's initial reference, earth frame (x downwind, z up).",
            _triple(names, body, ("x", "y", "z"), AXES), fold)
        add("motion", f"{body}: attitude", "Yaw-pitch-roll angles from the scene's initial reference; positive pitch lowers the downwind side.",
            _triple(names, body, ("roll", "pitch", "yaw"), AXES), fold)
    for body in bodies:
        fold = body != bodies[0]
        add("rates", f"{body}: velocity", "Velocity of the reference point, earth frame.", _triple(names, body, ("vx", "vy", "vz")), fold)
        add("rates", f"{body}: acceleration", "Acceleration of the reference point, earth frame.", _triple(names, body, ("ax", "ay", "az")), fold)

    sources = {}
    for name in names:
        match = re.fullmatch(r"(.+?)\.(rotor\.[^.]+|[^.]+)\.([fm])([xyz])_(N|N_m)", name)
        if match and (match[3] == "f") == (match[5] == "N"):
            sources.setdefault((match[1], match[3]), {}).setdefault(match[3] + match[4], []).append((match[2], name))
    for letter, key, title, caption in (("f", "forces", "forces by source", "Force on the body from each source of load, earth frame."),
                                        ("m", "moments", "moments by source", "Moment about the body's centre of mass from each source of load, earth frame.")):
        for (body, kind), panels in sources.items():
            if kind == letter:
                held = _held_by(names, joints or {}, body) if kind == "f" else {}
                more = " Of a joint: the force on the body that is named; the opposite one acts on the other." if held else ""
                add(key, f"{body}: {title}", caption + more, [(q, panels[q] + held.get(q, [])) for q in sorted(panels)], bool(bodies) and body != bodies[0])

    for joint, pair in (joints or {}).items():
        if "earth" in pair:
            add("moments", f"{joint}: moments", f"Moment of the joint on {pair[-1]} about its point, earth frame.", _triple(names, joint, ("mx", "my", "mz")), True)

    rotors = list(dict.fromkeys(n.rpartition(".")[0] for n in names if n.endswith(".thrust_N")))
    for rotor in rotors:
        panels = _triple(names, rotor, ("wind_x", "wind_y", "wind_z", "thrust", "torque", "power", "azimuth", "rpm"),
                         {"wind_x": "wind x", "wind_y": "wind y", "wind_z": "wind z"})
        words = "Thrust along the shaft, torque and power of the rotor, its azimuth and speed." if len(panels) > 2 else "Thrust along the shaft and torque about it."
        if any(label.startswith("wind") for label, _ in panels):
            words = "Undisturbed wind at the hub. " + words
        add("rotor", f"{rotor}: loads and speed" if len(panels) > 2 else f"{rotor.rpartition('.')[2].replace('_', ' ')}: loads", words, panels)
        pitches = [(n.split(".")[-2].replace("_", " "), n) for n in names if re.fullmatch(re.escape(rotor) + r"\.blade_\d+\.pitch_deg", n)]
        pitches += [("asked", n) for n in names if n == f"{rotor}.asked_pitch_deg"]
        add("rotor", f"{rotor}: control", "Pitch of the blades and what the controller asks for; the generator.", ([("pitch", pitches)] if pitches else []) +
            _triple(names, rotor, ("generator_torque", "electrical_power"), {"generator_torque": "generator torque", "electrical_power": "electrical power"}))

    tensions = [(n.rpartition(".")[0], n) for n in names if n.endswith(".tension_N")]
    add("moorings", "Mooring tensions", "Tension of each line at its fairlead.", [("tension", tensions)] if tensions else [], multiples=True)
    for junction in dict.fromkeys(n.rpartition(".")[0] for n in names if n.endswith(".at_x_m")):
        add("moorings", f"{junction}: place", "Where the junction of lines is, earth frame.", _triple(names, junction, ("at_x", "at_y", "at_z"),
                                                                                                      {"at_x": "x", "at_y": "y", "at_z": "z"}), True)

    gauges = [(n.rpartition(".")[0], n) for n in names if n.endswith(".elevation_m")]
    add("sea", "Wave gauges", "Height of the water's surface.", [("elevation", gauges)] if gauges else [], multiples=True)
    probes = list(dict.fromkeys(n.rpartition(".")[0] for n in names if n.endswith(".pressure_Pa")))
    for probe in probes:
        add("sea", f"{probe}: probe", "Pressure and velocity of the water at a point.", _triple(names, probe, ("pressure", "vx", "vy", "vz")))
    for sensor in sensors_of(names):
        add("sea", f"{sensor}: sensor", "Pressure and force of the water on a patch, means over its own time.", _triple(names, sensor, ("mean_pressure", "fx", "fy", "fz"), {"mean_pressure": "pressure"}))
    add("sea", "wavemaker", "Displacement and velocity of the paddle at still water.", _triple(names, "wavemaker", ("displacement", "velocity")))

    used = {"time_s"} | {column for group in found for column in group.columns()}
    rest = {}
    for name in names:
        if name not in used:
            rest.setdefault((name.rpartition(".")[0], unit_of(name)), []).append((quantity_of(name), name))
    for (prefix, unit), lines in rest.items():
        add("other", f"{prefix or 'run'}: " + ", ".join(q for q, _ in lines), "", [(unit or "value", lines)], True)
    return found


def is_displacement(name):
    """Of a column that swings round a zero of no meaning: a share of its mean says nothing."""
    return name.endswith((".x_m", ".y_m", ".z_m", ".elevation_m", ".roll_deg", ".pitch_deg", ".yaw_deg"))


def sensors_of(names):
    return [n.rpartition(".")[0] for n in names if n.endswith(".mean_pressure_Pa")]


MOST_KEY_BODIES = 4


def key_columns(names, spinning=()):
    """Columns of the key figures: motions of the first body (where no rotor makes it the one that counts, of the first few), coefficients of a flow, rotor loads,
    tensions, gauges, probes, sensors. Bodies that turn with a rotor do not count: their motions are those of its hub and its azimuth."""
    bodies = [body for body in bodies_of(names) if body not in spinning]
    chosen = [c for b in bodies[:1 if rotors_of(names) else MOST_KEY_BODIES] for c in (p[1][0][1] for p in _triple(names, b, ("x", "y", "z", "roll", "pitch", "yaw")))]
    wanted = (".thrust_N", ".torque_N_m", ".power_W", ".rpm", ".electrical_power_W", ".asked_pitch_deg", ".tension_N", ".lift_coefficient", ".drag_coefficient", "flow.fx_N", "flow.fz_N",
              ".elevation_m", ".pressure_Pa", "sea.lost_particles")
    sector = {"flow.fx_N", "flow.fz_N"} if "rotor.thrust_N" in names else set()   # of a rotor: loads of the sector that is solved
    farthest = set() if bodies_of(names) or "wavemaker.displacement_m" in names else {"sea.x_max_m"}   # of water that runs: a broken dam
    wanted += tuple(farthest)
    wanted += tuple(f"{sensor}.{quantity}" for sensor in sensors_of(names) for quantity in ("mean_pressure_Pa", "fx_N", "fy_N", "fz_N"))
    return chosen + [n for n in names if n.endswith(wanted) and not re.search(r"\.blade_\d+\.", n) and n not in sector]
