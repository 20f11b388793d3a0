"""Actuator lines of the NREL 5 MW rotor against the mean wake that AMR-Wind published: slowing within the wake over that of the thrust (Froude), and
the wake's width, one and two diameters behind. Usage: actuator_wake_test.py SPINDRIFT. SPDX-License-Identifier: Apache-2.0"""
import csv
import math
import sys
import unittest

import numpy

from running import Folder, ROOT, columns, spindrift

sys.path.insert(0, str(ROOT / "src/python"))
from spindrift import open as open_run  # noqa: E402

SCENE = ROOT / "inputs/validation/actuator/nrel_5mw_line.toml"
RADIUS_M, HUB_M, WIND_M_S, TURN_S, END_S = 63.0, 90.0, 11.7, 4.96, 44.64
AREA_M2 = math.pi * RADIUS_M ** 2
PUBLISHED_THRUST_N = 569.9e3   # three times the integral of the section loads; the shaft's 663.1 kN have the weight along the tilted axis too
BLADE_ELEMENTS_N = 621.2e3     # of the scene with aero.model = "bem", mean over a turn
LINES = ("sides", "vertical")


def of_thrust(thrust):
    """Slowing far behind a disc of that thrust over the wind."""
    return 1.0 - math.sqrt(1.0 - thrust / (0.5 * AREA_M2 * WIND_M_S ** 2))


def published():
    """Offsets over the radius, wind by line and diameters."""
    with open(SCENE.parent / "nrel_5mw_wake.csv", encoding="utf-8") as file:
        table = list(csv.DictReader(row for row in file if not row.startswith("#")))
    return (numpy.array([float(row["offset_R"]) for row in table]),
            {(line, x): numpy.array([float(row[f"{line}_{x}D_m_s"]) for row in table]) for line in LINES for x in (1, 2)})


class Air:
    """Mean axial wind of a run's fields of one box after a time, at the middles of its cells: wind[z, y, x]."""

    def __init__(self, run, after):
        fields = open_run(run).fields("air")
        first = fields[0]  # the others have no nodes: the grid stands
        fields = [field for field in fields if field.time > after]
        tiles = [name.split("/")[0] for name in first.names() if name.endswith("/points")]
        middles = {}
        for tile in tiles:
            nodes = first[f"{tile}/points"]
            middles[tile] = [0.5 * (n[1:] + n[:-1]) for n in (nodes[:, 0, 0, 2], nodes[0, :, 0, 1], nodes[0, 0, :, 0])]
        axes = [numpy.unique(numpy.concatenate([middles[tile][axis] for tile in tiles])) for axis in range(3)]
        self.z, self.y, self.x = axes
        self.wind = numpy.full([len(axis) for axis in axes], numpy.nan)
        for tile in tiles:
            place = numpy.ix_(*(numpy.searchsorted(axis, middle) for axis, middle in zip(axes, middles[tile])))
            self.wind[place] = numpy.mean([field[f"{tile}/velocity"][..., 0] for field in fields], axis=0)

    def along(self, line, x, offset):
        """As the table has it, x and offset [m]."""
        if line == "sides":
            return 0.5 * (self._at(x, offset, HUB_M) + self._at(x, -offset, HUB_M))
        return self._at(x, 0.0, HUB_M + offset)

    def _at(self, x, y, z):
        def between(values, nodes, at):
            n = numpy.clip(numpy.searchsorted(nodes, at) - 1, 0, len(nodes) - 2)
            share = numpy.clip((at - nodes[n]) / (nodes[n + 1] - nodes[n]), 0.0, 1.0)
            return (1.0 - share) * values[..., n] + share * values[..., n + 1]
        plane = between(self.wind, self.x, x)          # [z, y]
        if numpy.ndim(y):
            return between(between(plane.T, self.z, z), self.y, y)
        return between(between(plane, self.y, y), self.z, z)


def within(offset, wind):
    """Mean slowing from .2 to .8 of the radius, on both sides of the hub, over the wind."""
    loaded = (abs(offset) > 0.15) & (abs(offset) < 0.85)
    return 1.0 - wind[loaded].mean() / WIND_M_S


def width(offset, wind):
    """Radius, over the rotor's, at which the wind has come half way from what it is within to the free one."""
    half = WIND_M_S * (1.0 - 0.5 * within(offset, wind))
    n = numpy.argmax((offset > 0.75) & (wind > half))
    return offset[n] - (offset[n] - offset[n - 1]) * (wind[n] - half) / (wind[n] - wind[n - 1])


class Wake(Folder):
    def test_the_wake_of_lines_is_the_published_one(self):
        for last, more in ((END_S - TURN_S, ()), (END_S, ("--restart", "--set", "output.air_interval_s=0.31"))):
            done = spindrift("run", SCENE, "--quiet", "--no-report", "--out", self.out, "--until", round(last, 3), *more, timeout=3000)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        history = columns(self.out / "history.csv")
        thrust = history["rotor.thrust_N"][history["time_s"] > END_S - TURN_S].mean()
        air = Air(self.out, END_S - TURN_S + 0.01)
        offset, reference = published()
        found = {"thrust_kN": thrust / 1e3}
        with self.subTest("thrust"):
            self.assertAlmostEqual(thrust / BLADE_ELEMENTS_N, 1.0, delta=0.03)
        for line in LINES:
            for x in (1, 2):
                ours, theirs = air.along(line, 2.0 * RADIUS_M * x, offset * RADIUS_M), reference[line, x]
                slow = [within(offset, wind) for wind in (ours, theirs)]
                parts = [slow[0] / of_thrust(thrust), slow[1] / of_thrust(PUBLISHED_THRUST_N)]
                wide = [width(offset, wind) for wind in (ours, theirs)]
                found[line, x] = [round(value, 3) for value in (*slow, *parts, *wide)]
                with self.subTest(line, diameters=x, slowing=slow, over_that_of_the_thrust=parts, width=wide):
                    self.assertAlmostEqual(parts[0] / parts[1], 1.0, delta=0.08)
                    self.assertAlmostEqual(wide[0], wide[1], delta=0.1)
        print(found)


if __name__ == "__main__":
    unittest.main()
