#!/usr/bin/env python3
"""Writes buoy.stl and beach.stl beside itself: an octagonal buoy of two frusta, and a beach across the tank. SPDX-License-Identifier: Apache-2.0"""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
SIDES, RINGS = 8, [(0.5, -0.6), (0.7, 0.1), (0.4, 0.5)]   # radius, height [m]
BEACH = [(0.8, -1.6), (2.6, -1.6), (2.6, 0.56)]           # x, z; a slope of 1 in 0.83 from the bed on


def buoy():
    rings = [[(r * math.cos(2 * math.pi * k / SIDES), r * math.sin(2 * math.pi * k / SIDES), z) for k in range(SIDES)] for r, z in RINGS]
    for low, high in zip(rings, rings[1:]):
        for k in range(SIDES):
            after = (k + 1) % SIDES
            yield low[k], low[after], high[after]
            yield low[k], high[after], high[k]
    for k in range(1, SIDES - 1):
        yield rings[0][0], rings[0][k + 1], rings[0][k]
        yield rings[-1][0], rings[-1][k], rings[-1][k + 1]


def beach():
    near, far = ([(x, y, z) for x, z in BEACH] for y in (-2.0, 2.0))
    yield tuple(near)
    yield tuple(reversed(far))
    for k in range(3):
        after = (k + 1) % 3
        yield near[k], far[k], far[after]
        yield near[k], far[after], near[after]


def write(name, facets):
    with open(HERE / f"{name}.stl", "w") as file:
        print("solid", name, file=file)
        for facet in facets:
            print("facet normal 0 0 0\n outer loop", file=file)
            for corner in facet:
                print("  vertex", *(f"{c:.6g}" for c in corner), file=file)
            print(" endloop\nendfacet", file=file)
        print("endsolid", name, file=file)


write("buoy", buoy())
write("beach", beach())
