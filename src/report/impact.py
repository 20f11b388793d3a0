"""Loads of an impact on particles: their means over the time that sound takes through the body, as rows hold the load of one substep and sound waves in it.
Called by verdict.py and page.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import math

import numpy as np

import quantities
from geometry import Scene3d

TRANSITS = 2.0   # there and back
LEAST_ROWS, LARGEST_SHARE = 3.0, 0.5   # of the time of a mean: rows in it; of the run


def launched(run):
    """Bodies that begin with a speed."""
    given = run.scene.get("bodies") or {}
    return [body for body in quantities.bodies_of(run.columns) if any((given.get(body) or {}).get("velocity_m_s") or [])]


def mean_over_s(run, body):
    """Time of the means: sound there and back through the largest extent of the body, of one without shape through the depth. None where rows are too few."""
    scene = Scene3d(run)
    points = scene.corners(body) if body in scene.bodies else []
    sizes = np.ptp(points, axis=0) if len(points) else []
    if str(((run.scene.get("sea") or {}).get("particles") or {}).get("dimensions")) == "2":
        sizes = sizes[::2]   # the width of a plane sea is no way of sound
    way = max(sizes, default=(run.scene.get("environment") or {}).get("water_depth_m", math.nan))
    over, whole = TRANSITS * way / (run.summary.get("sound_speed_m_s") or math.nan), run.time[-1] - run.time[0] if len(run.time) else 0.0
    enough = len(run.time) > 1 and over >= LEAST_ROWS * whole / (len(run.time) - 1) and over <= LARGEST_SHARE * whole
    return float(over) if enough else None


def means(time, values, over):
    """(times, means over so long before each), from the first time that has so much before it; trapezoidal."""
    area = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(time))])
    at = time[time >= time[0] + over * (1.0 - 1e-9)]
    return at, (np.interp(at, time, area) - np.interp(at - over, time, area)) / over


def of_body(run, body):
    """(vertical load's column, time of the means or None, times, means); without a time for means the rows themselves. None without such a load."""
    name = f"{body}.sea.fz_N"
    if name not in run.columns or not len(run.time):
        return None
    over = mean_over_s(run, body) if np.isfinite(run.column(name)).all() else None
    return (name, over, *(means(run.time, run.column(name), over) if over else (run.time, run.column(name))))
