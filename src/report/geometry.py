"""The scene as surfaces and lines in the earth frame at any time of a run, from scene.toml and history.csv alone: shapes of the bodies, tower,
nacelle, blades, lines, the undisturbed waves. Tower, nacelle and braces are drawn for the eye: a scene has their mass, not their shape.
Called by scene_picture.py and geometry_fields.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import functools
import math
import pathlib

import numpy as np

from run_data import columns

ROUND = 36  # corners of a circle
# The kinds of pieces and the colour of each.
COLOURS = {"float": (0.95, 0.72, 0.10), "brace": (0.93, 0.75, 0.25), "tower": (0.90, 0.92, 0.94), "nacelle": (0.80, 0.83, 0.87),
           "hub": (0.80, 0.83, 0.87), "blade": (0.97, 0.97, 0.98), "line": (1.0, 0.30, 0.16)}


def upright(along):
    """Frame of an axis. Rows: the axis, sideways, up."""
    up = np.array([0.0, 0.0, 1.0]) - along[2] * along
    up /= np.linalg.norm(up)
    return np.stack([along, np.cross(up, along), up])


def round_edge(x, y, near, far):
    """A square sheet about its middle, drawn in beyond `near` so that its edge is a circle: corners would bend the horizon."""
    square, away = np.maximum(abs(x), abs(y)), np.hypot(x, y)
    part = np.clip(np.log(np.maximum(square, near) / near) / math.log(far / near), 0.0, 1.0)
    drawn = 1.0 - part * (1.0 - square / np.maximum(away, 1e-300))
    return x * drawn, y * drawn


class Piece:
    """A surface of quadrilaterals and triangles, or polylines: `kind` says what it shows (float, tower, nacelle, blade, line, brace); `sketched`
    where the scene does not describe its shape."""

    def __init__(self, kind, name, points, polygons=(), lines=(), bends=False, sketched=False):
        self.sketched = sketched
        self.kind, self.name, self.points, self.bends = kind, name, np.asarray(points, float), bends   # bends: no rigid motion takes it from one time to another
        self.polygons, self.lines = list(polygons), list(lines)


def about(axis, angle):
    """Rotation matrix about an axis."""
    x, y, z = axis / np.linalg.norm(axis)
    c, s = math.cos(angle), math.sin(angle)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + s * cross + (1 - c) * cross @ cross


def attitude(roll, pitch, yaw):
    """Z-Y'-X'' from degrees: how an initial direction lies now."""
    x, y, z = np.eye(3)
    return about(z, math.radians(yaw)) @ about(y, math.radians(pitch)) @ about(x, math.radians(roll))


def frustum(start, end, d0, d1=None, rings=1):
    """Points and polygons of a closed cone between two centres."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    d1 = d0 if d1 is None else d1
    along = (end - start) / np.linalg.norm(end - start)
    first = np.cross(along, [0.0, 1.0, 0.0] if abs(along[1]) < 0.9 else [1.0, 0.0, 0.0])
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    angle = 2 * np.pi * np.arange(ROUND) / ROUND
    circle = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
    points = np.concatenate([start + s * (end - start) + 0.5 * (d0 + s * (d1 - d0)) * circle for s in np.linspace(0, 1, rings + 1)])
    n = np.arange(ROUND)
    polygons = [[r * ROUND + i, r * ROUND + (i + 1) % ROUND, (r + 1) * ROUND + (i + 1) % ROUND, (r + 1) * ROUND + i] for r in range(rings) for i in n]
    return points, polygons + [list(n[::-1]), list(rings * ROUND + n)]


def box(centre, size):
    corners = np.array([[i, j, k] for k in (-0.5, 0.5) for j in (-0.5, 0.5) for i in (-0.5, 0.5)])
    sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return np.asarray(centre, float) + corners * np.asarray(size, float), sides


@functools.cache
def stl(path):
    """Points and triangles of an STL file; none where it is gone or broken."""
    try:
        data = pathlib.Path(path).read_bytes()
        count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
        if len(data) == 84 + 50 * count:
            facets = np.frombuffer(data, np.dtype([("corners", "<f4", 12), ("rest", "<u2")]), count, 84)["corners"][:, 3:]
        else:
            facets = np.array([line.split()[1:4] for line in data.decode().lower().splitlines() if line.split()[:1] == ["vertex"]], float)
        points, triangles = np.unique(np.asarray(facets, float).reshape(-1, 3), axis=0, return_inverse=True)
        return points, triangles.reshape(-1, 3).tolist()
    except (OSError, ValueError):
        return np.empty((0, 3)), []


def mesh(given):
    """The same where the scene puts it."""
    points, triangles = stl(given.get("file", ""))
    points = given.get("scale", 1.0) * points @ attitude(*given.get("rotation_deg", [0, 0, 0])).T + np.asarray(given.get("position_m", [0, 0, 0]), float)
    return points, triangles


def sphere(centre, diameter):
    height = np.linspace(-np.pi / 2, np.pi / 2, 19)[1:-1]
    angle = 2 * np.pi * np.arange(ROUND) / ROUND
    points = np.array([[math.cos(h) * math.cos(a), math.cos(h) * math.sin(a), math.sin(h)] for h in height for a in angle])
    rings = len(height)
    polygons = [[r * ROUND + i, r * ROUND + (i + 1) % ROUND, (r + 1) * ROUND + (i + 1) % ROUND, (r + 1) * ROUND + i]
                for r in range(rings - 1) for i in range(ROUND)]
    polygons += [list(range(ROUND))[::-1], list(range((rings - 1) * ROUND, rings * ROUND))]
    return np.asarray(centre, float) + 0.5 * diameter * points, polygons


def hanging(fairlead, anchor, length, count=40):
    """Points of an inextensible line of this length between two points, on a bed at the anchor's level where it is long enough; straight where taut."""
    fairlead, anchor = np.asarray(fairlead, float), np.asarray(anchor, float)
    span = fairlead - anchor
    across, rise = math.hypot(span[0], span[1]), span[2]
    straight = anchor + np.linspace(0, 1, count)[:, None] * span
    if not length or length <= 1.0001 * np.linalg.norm(span) or rise <= 0.0 or across <= 1e-9:
        return straight

    def resting(a):
        """Length of the part in the water and its horizontal reach, for a line that lies tangent on the bed."""
        return math.sqrt(rise * rise + 2 * rise * a), a * math.acosh(rise / a + 1)

    horizontal = span / across * [1, 1, 0]
    if length >= across + rise:   # hangs down and lies on the bed
        return evenly(np.array([anchor, fairlead - [0, 0, rise], fairlead]), count)
    a = resting_parameter(resting, across, length)
    if a is None:
        return straight
    far = resting(a)[1]
    ground = across - far
    x = np.concatenate([np.linspace(0, ground, max(2, count // 4), endpoint=False), ground + far * np.linspace(0, 1, count)])
    z = np.where(x < ground, 0.0, a * (np.cosh(np.maximum(x - ground, 0.0) / a) - 1))
    return evenly(anchor + x[:, None] * horizontal + z[:, None] * [0, 0, 1], count)


def evenly(points, count):
    """So many points at equal lengths along a polyline."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], count)
    return np.stack([np.interp(at, length, points[:, d]) for d in range(3)], axis=-1)


def resting_parameter(resting, across, length):
    """Of the catenary whose reach is `across`; None where no part of the line would lie on the bed."""
    reach = lambda a: length - resting(a)[0] + resting(a)[1]
    low, high = 1e-6 * length, 1e6 * length
    while high / low > 1 + 1e-10:
        middle = math.sqrt(low * high)
        if resting(middle)[0] > length or reach(middle) > across:
            high = middle
        else:
            low = middle
    return low if abs(reach(low) - across) < 1e-3 * across else None


class Blades:
    """Surface of one upright blade in the rotor's frame (x downwind along the axis, z up), from the turbine's tables."""

    def __init__(self, turbine, pitch_deg):
        table = columns(pathlib.Path(turbine["planform"]))
        outlines = sorted(((a["thickness_pct"], outline(columns(pathlib.Path(a["file"])))) for a in turbine.get("aerofoils", [])), key=lambda entry: entry[0])
        self.count, self.tip = turbine.get("blades", 3), table["span_m"][-1]
        cone, pitch, sections = math.radians(turbine.get("precone_deg", 0.0)), math.radians(pitch_deg), []
        prebend, sweep = (table.get(name, [0.0] * len(table["span_m"])) for name in ("prebend_m", "sweep_m"))
        s = np.linspace(0, 2 * np.pi, 41)[:-1]
        for m in range(len(table["span_m"])):
            chord, twist = table["chord_m"][m], math.radians(table["twist_deg"][m])
            thickness = table["thickness_pct"][m] if "thickness_pct" in table else 20.0  # of polars by number a planform may have none
            if outlines:
                x, y = between(outlines, thickness)
            else:
                x, y = 0.5 + 0.5 * np.cos(s), 0.005 * thickness * np.sin(s)
            # As src/aero/rotor_grid/blade_surface.cpp: t towards -y, the way the rotor turns; n downwind; then pitch and precone.
            ahead, suction = (0.5 - x) * chord, y * chord
            t = sweep[m] + ahead * math.cos(twist) + suction * math.sin(twist)
            n = prebend[m] - ahead * math.sin(twist) + suction * math.cos(twist)
            t, n = t * math.cos(pitch) + n * math.sin(pitch), n * math.cos(pitch) - t * math.sin(pitch)
            span = table["span_m"][m]
            sections.append(np.stack([n * math.cos(cone) - span * math.sin(cone), -t, span * math.cos(cone) + n * math.sin(cone)], axis=-1))
        self.points, n = np.concatenate(sections), len(sections[0])
        self.polygons = [[m * n + i, m * n + (i + 1) % n, (m + 1) * n + (i + 1) % n, (m + 1) * n + i] for m in range(len(sections) - 1) for i in range(n)]
        self.polygons.append(list(range((len(sections) - 1) * n, len(sections) * n)))


PLACES = 0.5 + 0.5 * np.cos(np.linspace(0.0, np.pi, 21))   # along the chord, trailing edge to nose


def outline(table):
    """y/c of an outline at PLACES along one side, then back along the other: outlines of different files point by point."""
    x, y = np.array(table["x_c"]), np.array(table["y_c"])
    nose = int(x.argmin())
    first, second = (x[: nose + 1][::-1], y[: nose + 1][::-1]), (x[nose:], y[nose:])
    return np.concatenate([np.interp(PLACES, *first), np.interp(PLACES[::-1], *second)[1:-1]])


def between(outlines, thickness):
    """An outline of this thickness [% of the chord], from those to either side in thickness; beyond the thickest one towards a circle."""
    x = np.concatenate([PLACES, PLACES[::-1][1:-1]])
    circle = np.concatenate([np.sqrt(PLACES * (1.0 - PLACES)), -np.sqrt(PLACES * (1.0 - PLACES))[::-1][1:-1]])
    if outline_up(outlines[-1][1]) < 0.0:
        circle = -circle
    every = outlines + ([(100.0, circle)] if outlines[-1][0] < 99.0 else [])
    thick = [entry[0] for entry in every]
    return x, np.array([np.interp(thickness, thick, side) for side in np.stack([entry[1] for entry in every], axis=1)])


def outline_up(y):
    """Positive where an outline begins with its upper side."""
    half = len(PLACES)
    return float(y[:half].mean() - y[half:].mean())


class Rotor:
    """One of the rotors of a scene: `name` is what its columns begin with, `given` its section."""

    def __init__(self, scene, name, given):
        self.scene, self.name, self.given = scene, name, given
        self.joint = (scene.scene.get("joints") or {}).get(given.get("joint", ""), {})
        self.sense = -1.0 if given.get("turns") == "counter_clockwise" else 1.0
        self.blades = self._blades()
        self.hub0 = self._hub_at_start()

    def carrier(self):
        """The body that carries the rotor: the other one of its joint."""
        others = [b for b in self.joint.get("bodies", []) if b != self.given.get("body")]
        return others[0] if others else self.given.get("body", "")

    def _hub_at_start(self):
        if "point_m" in self.joint:
            return np.asarray(self.joint["point_m"], float)
        if f"{self.name}.thrust_N" in self.scene.run.columns and ("hub_m" in self.given or not self.scene.bodies):
            return np.asarray(self.given.get("hub_m", [0, 0, 0]), float)
        return None

    def described_axis(self):
        along = np.asarray(self.joint.get("axis", self.given.get("axis", [1.0, 0.0, 0.0])), float)
        return along / np.linalg.norm(along)

    def axis(self, t):
        along, body, scene = self.described_axis(), self.carrier(), self.scene
        if body in scene.bodies:
            along = attitude(*(scene.at(f"{body}.{q}_deg", t) for q in ("roll", "pitch", "yaw"))) @ along
        return along

    def hub(self, t):
        return self.scene.moved(self.carrier(), self.hub0[None], t)[0]

    def azimuth(self, t):
        """[rad], between the rows by the rate, since the column drops at a whole turn."""
        run, column = self.scene.run, f"{self.name}.azimuth_deg"
        if column not in run.columns:
            return 0.0
        return float(np.interp(t, run.time, np.unwrap(np.radians(run.column(column)))))

    def frame(self, t):
        """Rows: axis, sideways, up."""
        return upright(self.axis(t))

    def sector(self, t):
        """Hub and frame of a grid of one sector, which stays on the axis that the scene describes and follows the hub along it."""
        along, begin = self.described_axis(), self.hub(self.scene.run.time[0])
        return begin + (self.hub(t) - begin) @ along * along, upright(along)

    def _blades(self):
        turbine = self.scene.run.turbine(self.given)
        try:
            return Blades(turbine, self.given.get("blade_pitch_deg", 0.0)) if turbine else None
        except (OSError, KeyError, ValueError, IndexError):
            return None

    @property
    def tip(self):
        """Radius [m]."""
        return self.blades.tip if self.blades else 0.75 * abs(self.hub0[2])

    def pieces(self, t):
        frame, hub, found = self.frame(t), self.hub(t), []
        size = 0.035 * (self.blades.tip if self.blades else 0.7 * max(abs(self.hub0[2]), 1.0))
        points, polygons = sphere([0.0, 0.0, 0.0], 2.0 * size)
        found.append(Piece("hub", "hub", hub + points @ frame, polygons))
        if self.blades:
            points, polygons, count = self.blades.points, self.blades.polygons, self.blades.count
        else:   # loads without a turbine file: three plates of a size that suits the height
            tip, count = 0.75 * abs(self.hub0[2]), 3
            points = np.array([[0, -0.02 * tip, 0.05 * tip], [0, 0.02 * tip, 0.05 * tip], [0, 0.045 * tip, 0.25 * tip], [0, 0.01 * tip, tip],
                               [0, -0.01 * tip, tip], [0, -0.02 * tip, 0.25 * tip]])
            polygons = [[0, 1, 2, 3, 4, 5]]
        if self.sense < 0.0:   # seen in a mirror, with faces that still look outwards
            points, polygons = points * [1.0, -1.0, 1.0], [polygon[::-1] for polygon in polygons]
        for b in range(count):
            turn = about(np.array([1.0, 0.0, 0.0]), self.sense * (self.azimuth(t) + 2 * np.pi * b / count))
            found.append(Piece("blade", f"blade {b + 1}", hub + points @ turn.T @ frame, polygons))
        return found


class Scene3d:
    def __init__(self, run):
        self.run, self.scene = run, run.scene
        self.bodies = {name: b for name, b in (run.scene.get("bodies") or {}).items() if f"{name}.x_m" in run.columns}
        self.rotors = [rotor for rotor in (Rotor(self, *given) for given in run.rotors()) if rotor.hub0 is not None]

    @property
    def rotor(self):
        """The first, which is the only one in resolved air; None where there is none."""
        return self.rotors[0] if self.rotors else None

    # ---- motion -------------------------------------------------------------------------------------------------------------------------

    def at(self, name, t):
        return float(np.interp(t, self.run.time, self.run.column(name))) if name in self.run.columns else 0.0

    def moved(self, body, points, t):
        """Points given at the start, carried by a body to time t."""
        if body not in self.bodies:
            return np.asarray(points, float)
        given = self.bodies[body]
        reference = np.asarray(given.get("reference_m", given.get("centre_m", [0, 0, 0])), float)
        turn = attitude(*(self.at(f"{body}.{q}_deg", t) for q in ("roll", "pitch", "yaw")))
        return (np.asarray(points, float) - reference) @ turn.T + reference + [self.at(f"{body}.{q}_m", t) for q in "xyz"]

    def corners(self, body):
        """Points on the shapes of a body as the scene describes it, (n, 3); none where it has none."""
        given, points = self.bodies[body], []
        points += [frustum(c["start_m"], c["end_m"], c["diameter_m"], c.get("end_diameter_m"))[0] for c in given.get("cylinders", []) if "start_m" in c]
        points += [box(b["centre_m"], b["size_m"])[0] for b in given.get("boxes", [])]
        points += [sphere(b["centre_m"], b["diameter_m"])[0] for b in given.get("spheres", [])]
        points += [mesh(m)[0] for m in given.get("meshes", [])]
        return np.concatenate(points) if points else np.empty((0, 3))

    # ---- pieces -------------------------------------------------------------------------------------------------------------------------

    def pieces(self, t):
        found = []
        for body, given in self.bodies.items():
            for c in given.get("cylinders", []):
                points, polygons = frustum(c["start_m"], c["end_m"], c["diameter_m"], c.get("end_diameter_m"))
                found.append(Piece("float", f"{body} {c.get('name', '')}".strip(), self.moved(body, points, t), polygons))
            for b in given.get("boxes", []):
                points, polygons = box(b["centre_m"], b["size_m"])
                found.append(Piece("float", f"{body} {b.get('name', '')}".strip(), self.moved(body, points, t), polygons))
            for b in given.get("spheres", []):
                points, polygons = sphere(b["centre_m"], b["diameter_m"])
                found.append(Piece("float", f"{body} {b.get('name', '')}".strip(), self.moved(body, points, t), polygons))
            for m in given.get("meshes", []):
                points, polygons = mesh(m)
                if polygons:
                    found.append(Piece("float", f"{body} {m.get('name', '')}".strip(), self.moved(body, points, t), polygons))
            if not any(given.get(shape) for shape in ("cylinders", "boxes", "spheres", "meshes")) and not self.rotors:
                points, polygons = sphere(given.get("centre_m", [0, 0, 0]), 0.06 * self._reach())
                found.append(Piece("float", body, self.moved(body, points, t), polygons))
        for rotor in self.rotors:
            found += self._support(rotor, t) + rotor.pieces(t)
        for name, line in (self.scene.get("moorings") or {}).items():
            found.append(self._line(name, line, t))
        return found

    @functools.cached_property
    def sketched(self):
        """Names of the kinds of pieces that no line of the scene describes."""
        kinds = dict.fromkeys(p.kind for p in self.pieces(self.run.time[0]) if p.sketched)
        return ["braces" if kind == "brace" else kind for kind in kinds]

    def _reach(self):
        """Length of the longest line [m]: what the size of a body without a shape is taken from."""
        lines = (self.scene.get("moorings") or {}).values()
        return max((float(np.linalg.norm(self._end(line, "body", "fairlead_m", None) - self._end(line, "anchor_body", "anchor_m", None))) for line in lines),
                   default=10.0)

    def _end(self, line, holder, place, t):
        """An end of a line at time t, at the start without one: of a body, the earth or a junction."""
        holder = line.get(holder, "earth")
        junction = (self.scene.get("junctions") or {}).get(holder)
        if junction is None:
            return self.moved(holder, [line[place]], t)[0] if t is not None else np.asarray(line[place], float)
        if t is not None and f"{holder}.at_x_m" in self.run.columns:
            return np.array([self.at(f"{holder}.at_{q}_m", t) for q in "xyz"])
        return np.asarray(junction["position_m"], float)

    def _line(self, name, line, t):
        fairlead, anchor = self._end(line, "body", "fairlead_m", t), self._end(line, "anchor_body", "anchor_m", t)
        stiff = line.get("tension_only") is False   # a spring both ways stays straight
        length = line.get("rest_length_m") or sum(part["rest_length_m"] for part in line.get("sections", []))
        points = hanging(fairlead, anchor, None if stiff else length)
        return Piece("line", name, points, lines=[list(range(len(points)))])

    def _support(self, rotor, t):
        """Tower from the deck or the foundation to the nacelle, and braces from its foot to floats that stand apart. A tower that the scene
        describes (a beam, or the tower in the wind) stands as described."""
        body, hub, found = rotor.carrier(), rotor.hub0, []
        add = lambda kind, name, made, sketched=False: found.append(Piece(kind, name, self.moved(body, made[0], t), made[1], sketched=sketched))
        chosen = self._beams_below(rotor)
        beams = [self._beam(name, beam, t) for name, beam in chosen.items()]
        below = beams[0][1] if beams else body
        cylinders = self.bodies.get(below, {}).get("cylinders", [])
        stands = [j["point_m"][2] for j in (self.scene.get("joints") or {}).values() if set(j.get("bodies", [])) == {"earth", body} and "point_m" in j]
        stations = ((self.scene.get("aero") or {}).get("tower") or {}).get("stations")
        tops = [max(c["start_m"][2], c["end_m"][2]) for c in cylinders] or stands or [row[0] for row in (stations or [])[:1]]
        if not beams and (not tops or max(tops) >= hub[2]):
            return found
        deck = max(tops, default=0.0)
        height = hub[2] - deck
        size = max(min(3.0, 0.1 * height), 0.065 * height)
        foot, top = self._axis_of_tower(cylinders, deck, hub, size)
        if beams:   # braces and nacelle are drawn to the tower that there is
            first = next(iter(chosen.values()))
            foot[:2], top[:2] = first["start_m"][:2], first["end_m"][:2]
        elif stations:
            foot[:2] = top[:2] = rotor.given.get("tower_foot_m") or self.scene["aero"]["tower"].get("foot_m", [0.0, 0.0])
        if beams:
            found += [piece for piece, _ in beams]
        elif stations:
            x, y = foot[:2]
            for (z0, d0, *_), (z1, d1, *_) in zip(stations, stations[1:]):
                add("tower", "tower", frustum([x, y, z0], [x, y, z1], d0, d1))
        else:
            add("tower", "tower", frustum(foot, top, size, 0.62 * size, rings=8), sketched=True)
        side = 1.0 if top[0] >= hub[0] else -1.0   # of the rotor on which the tower stands
        front = hub[0] + side * 0.02 * hub[2]
        back = front + side * max(0.08 * hub[2], abs(top[0] - front) + 0.07 * hub[2])
        add("nacelle", "nacelle", box([0.5 * (front + back), hub[1], hub[2]], [abs(back - front), 0.05 * hub[2], 0.05 * hub[2]]), sketched=True)
        for c in cylinders:
            end = np.asarray(c["end_m"] if c["end_m"][2] > c["start_m"][2] else c["start_m"], float)
            nearest = min(self.rotors, key=lambda other: np.hypot(*(end - other.hub0)[:2]))
            if nearest is rotor and np.hypot(*(end - foot)[:2]) > 0.5 * c["diameter_m"] + size:
                for rise, thick in ((-0.1, 0.5), (2.2, 0.3)):
                    points, polygons = frustum(foot + [0, 0, rise * size], end - [0, 0, 0.1 * size], thick * size)
                    found.append(Piece("brace", "brace", self.moved(below, points, t), polygons, sketched=True))
        return found

    def _beams_below(self, rotor):
        """The beams of the scene that stand under this rotor: all of them where it is the only one."""
        beams = self.scene.get("beams") or {}
        if len(self.rotors) < 2:
            return beams
        nearest = lambda beam: min(self.rotors, key=lambda other: float(np.linalg.norm(np.asarray(beam["end_m"], float) - other.hub0)))
        return {name: beam for name, beam in beams.items() if "end_m" in beam and nearest(beam) is rotor}

    @staticmethod
    def _axis_of_tower(cylinders, deck, hub, size):
        """Foot and top of a tower that no one described: on the column that reaches the deck near the hub, else downwind of an upwind rotor."""
        behind = np.array([hub[0] + 0.06 * (hub[2] - deck), hub[1], deck])
        for c in cylinders:
            end = np.asarray(c["end_m"] if c["end_m"][2] > c["start_m"][2] else c["start_m"], float)
            if abs(end[2] - deck) < 1e-6 * max(1.0, abs(deck)) and np.hypot(*(end - hub)[:2]) < 0.2 * (hub[2] - deck):
                behind = np.array([end[0], end[1], deck])
                break
        return behind, np.array([behind[0], behind[1], hub[2] - 0.3 * size])

    def _beam(self, name, beam, t):
        """A beam of the scene as it is bent: between what its two bodies make of its points. With the body that it stands on."""
        start, end = np.asarray(beam["start_m"], float), np.asarray(beam["end_m"], float)
        below, above = (beam.get("bodies") or ["earth", ""])[:2]
        d0, d1 = self._diameters(beam, 0.065 * np.linalg.norm(end - start))
        points, polygons = frustum(start, end, d0, d1, rings=16)
        s = ((points - start) @ (end - start) / np.dot(end - start, end - start))[:, None]
        share = s * s * (3.0 - 2.0 * s)
        return Piece("tower", name, (1.0 - share) * self.moved(below, points, t) + share * self.moved(above, points, t), polygons, bends=True), below

    def _diameters(self, beam, usual):
        try:
            found = columns(self.run.folder / beam["properties"])["diameter_m"]
            return found[0], found[-1]
        except (OSError, KeyError, ValueError, IndexError):
            return usual, 0.62 * usual

    # ---- water --------------------------------------------------------------------------------------------------------------------------

    def elevation(self, x, t):
        """Undisturbed surface at x: what passes the origin, shifted by the speed of the waves' crests (of regular waves exact)."""
        waves = self.scene.get("waves", {})
        period = waves.get("period_s", waves.get("peak_period_s"))
        if "waves.elevation_m" not in self.run.columns or not isinstance(period, (int, float)):
            return np.zeros_like(x)
        depth = self.scene.get("environment", {}).get("water_depth_m", 1e3)
        g, omega = 9.81, 2 * np.pi / period
        k = omega**2 / g
        for _ in range(60):
            k = 0.5 * (k + omega**2 / (g * math.tanh(k * depth)))
        when = t - x * k / omega * math.copysign(1.0, math.cos(math.radians(waves.get("direction_deg", 0.0))))
        time, series = self.run.time, self.run.column("waves.elevation_m")
        whole = math.floor((time[-1] - time[0]) / period) * period
        if whole > 0:   # what lies outside of the run repeats its last whole periods
            when = np.where(when > time[-1], when - np.ceil((when - time[-1]) / whole) * whole, when)
            when = np.where(when < time[0], when + np.ceil((time[0] - when) / whole) * whole, when)
        return np.interp(when, time, series)
