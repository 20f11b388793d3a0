"""The blocks of the newest output in a run's fields/, by h5py as a user reads them, and whether values lie where the points say.
SPDX-License-Identifier: Apache-2.0"""
import os

import h5py
import numpy as np


def blocks(run, name):
    """{block: {"points": ..., field: ...}}."""
    path = max((run / "fields").glob(f"{name}_*.h5"))
    with h5py.File(path) as file, h5py.File(path.parent / os.fsdecode(file.attrs["points_file"])) as there:
        return {block: {field: group[field][...] for field in group} | {"points": there[block]["points"][...]} for block, group in file.items()}


def middles(points):
    """Of faces, from their corners (n + 1, m + 1, 3)."""
    return 0.25 * (points[1:, 1:] + points[:-1, 1:] + points[1:, :-1] + points[:-1, :-1])


def at_walls(run, field="pressure"):
    """Values on all faces of the walls, and those of the cells that have these faces, found by their places."""
    def places(points):
        return [tuple(place) for place in np.round(middles(points).reshape(-1, 3), 6)]

    cells = {}
    for block in blocks(run, "air").values():
        for axis in range(3):
            for end in (0, -1):
                values = block[field].take(end, axis)
                cells.update(zip(places(block["points"].take(end, axis)), values.ravel()))
    walls = blocks(run, "walls").values()
    pairs = [(value, cells[place]) for wall in walls for place, value in zip(places(wall["points"]), wall[field].ravel())]
    return np.array(pairs, float).T
