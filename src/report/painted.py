"""Water of particles as a picture without gaps: each pixel has the value of the nearest particle that is within reach.
Called by plane_picture.py and sea_pictures.py; tested in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import numpy as np

REACH = 0.78   # spacings: what closes the gaps between four particles that stand at the corners of a square
MOST_PIXELS = 1400


def raster(x, z, values, spacing, limits):
    """Values (nz, nx), masked where there is no water; `limits` is ((x low, x high), (z low, z high)). Twelve pixels to a spacing, or MOST_PIXELS
    along the longer side."""
    wide, high = np.ptp(limits[0]), np.ptp(limits[1])
    pixel = max(max(wide, high) / MOST_PIXELS, spacing / 12.0)
    nx, nz = max(1, round(wide / pixel)), max(1, round(high / pixel))
    at = np.column_stack([(x - limits[0][0]) / wide * nx, (z - limits[1][0]) / high * nz])
    reach = max(REACH * spacing / pixel, 0.75)
    nearest, found, steps = np.full(nx * nz, np.inf), np.full(nx * nz, np.nan), range(-int(np.ceil(reach)), int(np.ceil(reach)) + 1)
    base = np.floor(at).astype(int)
    for i in steps:
        for j in steps:
            cell = base + (i, j)
            away = np.hypot(*(cell + 0.5 - at).T)
            near = (away <= reach) & (cell >= 0).all(axis=1) & (cell < (nx, nz)).all(axis=1)
            index, away, own = (cell[near, 1] * nx + cell[near, 0]), away[near], values[near]
            nearer = away < nearest[index]
            order = np.flatnonzero(nearer)[np.argsort(-away[nearer], kind="stable")]   # the nearest is written last
            nearest[index[order]], found[index[order]] = away[order], own[order]
    found = found.reshape(nz, nx)
    return np.ma.masked_invalid(closed(found, int(np.ceil(spacing / pixel))))


def closed(found, steps):
    """Gaps of up to so many pixels, along a row or a column, take the value of their nearer end: particles that a flow has drawn apart leave no holes in
    the water."""
    away, value = np.full((4, *found.shape), np.inf), np.full((4, *found.shape), np.nan)
    for side, (axis, way) in enumerate(((0, 1), (0, -1), (1, 1), (1, -1))):
        for step in range(min(steps, found.shape[axis] - 1), 0, -1):   # the nearest is written last
            to, from_ = [slice(None)] * 2, [slice(None)] * 2
            to[axis], from_[axis] = (slice(step, None), slice(None, -step))[::way]
            there = np.isfinite(found[tuple(from_)])
            away[side][tuple(to)][there], value[side][tuple(to)][there] = step, found[tuple(from_)][there]
    gap = (np.minimum(away[0] + away[1], away[2] + away[3]) <= steps + 1) & ~np.isfinite(found)
    return np.where(gap, np.take_along_axis(value, away.argmin(axis=0)[None], axis=0)[0], found)


def paint(axis, x, z, values, spacing, limits, **look):
    """On an axis, as imshow does; those of no spacing as dots."""
    if not np.isfinite(spacing) or not len(x):
        return axis.scatter(x, z, c=values, s=2.0, linewidths=0, rasterized=True, **look)
    return axis.imshow(raster(x, z, values, spacing, limits), extent=(*limits[0], *limits[1]), origin="lower", interpolation="nearest", aspect="auto", **look)
