"""Linear theory of an upright cylinder that heaves free in a round tank with a zone that damps: how much walls and zone change a decay from that in
open water. Usage: decay_theory.py prints the turns in open water and in the tank of inputs/validation/free_cylinder; decay_theory.py test tests
them. SPDX-License-Identifier: Apache-2.0"""
import sys
import unittest

import numpy as np

GRAVITY, RADIUS, DRAFT, DEPTH = 9.81, 1.0, 1.0, 3.0
CELL = 0.1
OPEN = 24.0, (6.0, 24.0, 4.0)                              # tank's radius; zone from, to [m], rate [1/s]
TANKS = (7.0, (3.5, 7.0, 10.0)), (7.9, (3.95, 7.9, 10.0))  # round, as wide as the square one of 14 m and as large


def resistance(s, tank, zone):
    """Force over density and velocity on the heaving cylinder at each s of a Laplace transform. Finite volumes of the pressure in water with
    dv/dt = -grad p/rho - rate v, column by column from the tank's wall inwards."""
    columns, rows, under, solid = (round(x / CELL) for x in (tank, DEPTH, RADIUS, DRAFT))
    r = (np.arange(columns) + 0.5) * CELL
    mobility = 1.0 / (s[:, None] + zone[2] * np.clip((r - zone[0]) / (zone[1] - zone[0]), 0.0, 1.0) ** 2)
    lines = np.arange(rows)

    def face(i):
        """Between columns i and i + 1, by row."""
        wet = lines >= (solid if i < under else 0)
        return 2.0 / (1.0 / mobility[:, i] + 1.0 / mobility[:, i + 1])[:, None] * (i + 1) * CELL * wet

    outer, of_column = None, []  # p of a column: outer[0] + outer[1] p of the next one inwards
    for i in reversed(range(columns)):
        top = solid if i < under else 0
        matrix, right = np.zeros((len(s), rows, rows), complex), np.zeros((len(s), rows), complex)
        matrix[:, lines[:top], lines[:top]] = 1.0
        up, down = lines[top:-1], lines[top + 1:]
        along = (mobility[:, i] * r[i])[:, None]
        for a, b in ((up, down), (down, up)):
            matrix[:, a, a] += along
            matrix[:, a, b] -= along
        if top:
            right[:, top] -= r[i] * CELL
        else:    # through half a cell to the surface, whose velocity is s p/(rho g)
            half, surface = mobility[:, i] / (0.5 * CELL), s / GRAVITY
            matrix[:, 0, 0] += r[i] * CELL * half * surface / (half + surface)
        if outer is not None:
            c = face(i)
            matrix[:, lines, lines] += c
            matrix -= c[:, :, None] * outer[1]
            right += c * outer[0]
        inwards = face(i - 1) if i else np.zeros((len(s), rows))
        matrix[:, lines, lines] += inwards
        both = np.linalg.solve(matrix, np.concatenate([right[:, :, None], inwards[:, :, None] * np.eye(rows)], axis=2))
        outer = both[:, :, 0], both[:, :, 1:]
        if i < under:
            of_column.append(outer)
    p, force = 0.0, 0.0
    for i, (alone, by_inner) in enumerate(reversed(of_column)):
        p = alone + (np.einsum("sab,sb->sa", by_inner, p) if i else 0.0)
        force = force - 2.0 * np.pi * r[i] * CELL * (p[:, solid] - 0.5 * CELL / mobility[:, i])
    return force


def turns(tank, zone, until=2.8, width=0.2, highest=30.0, shift=0.35):
    """Times [s] of the first turns after a start from rest, and their heights over the start's."""
    omega, mass, stiffness = np.arange(width / 2, highest, width), np.pi * RADIUS**2 * DRAFT, GRAVITY * np.pi * RADIUS**2
    s = shift + 1j * omega
    load = resistance(s, tank, zone)
    heavy = mass + (load[-1] / s[-1]).real  # at once: its velocity -stiffness t/heavy is taken out of the integral
    velocity = -stiffness / (s * (mass * s + load) + stiffness) + stiffness / (heavy * (s + 1.0) ** 2)
    t = np.arange(0.0, until, 0.005)
    v = np.exp(shift * t) / np.pi * width * (velocity * np.exp(1j * np.outer(t, omega))).real.sum(axis=1) - stiffness / heavy * t * np.exp(-t)
    z = 1.0 + np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1])) * 0.005])
    return [(t[k] + 0.005 * v[k] / (v[k] - v[k + 1]), z[k]) for k in range(20, len(t) - 1) if v[k] * v[k + 1] <= 0.0]


def rise_over_fall(found):
    (_, lowest), (_, highest) = found[:2]
    return (highest - lowest) / (1.0 - lowest)


class Theory(unittest.TestCase):
    def test_open_water_is_that_of_matched_eigenfunctions_and_a_tank_returns_a_thirtieth(self):
        found = turns(*OPEN)
        for (t, z), (time, height) in zip(found, [(1.257, -0.924), (2.502, 0.809)]):  # Yeung (1981): free_decay_test.py
            self.assertAlmostEqual(t / time, 1.0, delta=0.01)
            self.assertAlmostEqual(z, height, delta=0.01)
        for tank in TANKS:
            self.assertAlmostEqual(rise_over_fall(turns(*tank)) / rise_over_fall(found), 1.03, delta=0.01)


if __name__ == "__main__":
    if sys.argv[1:] == ["test"]:
        unittest.main(argv=sys.argv[:1])
    for name, tank in (("open water", OPEN), *((f"tank of radius {tank[0]} m", tank) for tank in TANKS)):
        found = turns(*tank)
        print(f"{name}: turns at {found[0][0]:.3f}, {found[1][0]:.3f} s, heights {found[0][1]:.3f}, {found[1][1]:.3f}, rise over fall {rise_over_fall(found):.3f}")
