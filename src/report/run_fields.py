"""The fields that a run left, by time: the water's surface between two outputs, the air of the nearest one.
Called by scene_picture.py and plane_picture.py; needs h5py. SPDX-License-Identifier: Apache-2.0"""
import itertools

import numpy as np


class Fields:
    def __init__(self, run):
        self.run, self.kept = run, {}
        self.files = {name: self._outputs(name) for name in ("surface", "air", "particles", "walls")}

    def _outputs(self, name):
        """[(time, file)] in the order of time."""
        paths = sorted((self.run.folder / "fields").glob(f"{name}_*.h5"))
        if not paths:
            return []
        import h5py
        found = []
        for path in paths:
            with h5py.File(path) as file:
                found.append((float(file.attrs["time_s"]), path))
        return sorted(found)

    def times(self, name):
        return [time for time, _ in self.files[name]]

    def nearest(self, name, t):
        """(time, file) of the output nearest to t, or None."""
        return min(self.files[name], key=lambda entry: abs(entry[0] - t), default=None)

    def surface(self, t, floats=()):
        """x, y, z (nj, ni) of the water's surface at t between two outputs, and the height of the bed; None without outputs. Where a float, given as its
        points, stands in the water, the heights around go through it."""
        if not self.files["surface"]:
            return None
        times = np.array(self.times("surface"))
        after = int(np.clip(np.searchsorted(times, t), 0, len(times) - 1))
        before = max(0, after - 1)
        (x, y, z0, bed), (_, _, z1, _) = self._surface(before), self._surface(after)
        share = 0.0 if after == before else float(np.clip((t - times[before]) / (times[after] - times[before]), 0.0, 1.0))
        z, reach = (1 - share) * z0 + share * z1, [np.ptp(a) / max(n - 1, 1) for a, n in ((x, x.shape[1]), (y, y.shape[0]))]
        beside = np.zeros(z.shape, bool)
        for points in floats:
            low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
            beside |= np.all([(c > a - h) & (c < b + h) for c, a, b, h in zip((x, y), low, high, reach)], axis=0)
        return x, y, filled(np.where(beside, np.nan, z)), bed

    def _surface(self, index):
        key = ("surface", index)
        if key not in self.kept:
            import h5py
            with h5py.File(self.files["surface"][index][1]) as file:
                points = file["water/points"][...]
            top, bed = points[1], float(points[0, ..., 2].min())
            self.kept[key] = (top[..., 0], top[..., 1], without_holes(top[..., 2], bed), bed)
        return self.kept[key]

    def air(self, t):
        """The air nearest to t in pieces of its blocks, and its time."""
        found = self.nearest("air", t)
        if found is None:
            return [], t
        if ("air", found[0]) not in self.kept:
            blocks = [piece for block in grid(found[1], ["velocity"]).values() for piece in pieces(block, 32)]
            self.kept = {key: value for key, value in self.kept.items() if key[0] != "air"} | {("air", found[0]): blocks}
        return self.kept[("air", found[0])], found[0]


def grid(path, names=None):
    """{block: {"points": ..., field: ...}} of a file fields/air_*.h5 or walls_*.h5, all fields or those named. Points of a grid that stands are in another
    file of the run, which the attribute points_file names."""
    import h5py
    with h5py.File(path) as file:
        blocks = {name: {field: group[field][...] for field in (names or group) if field != "points"} for name, group in file.items()}
        there = file.attrs.get("points_file", path.name)
        there = path.parent / (there.decode() if isinstance(there, bytes) else there)
    if not there.exists():
        raise ValueError(f"{path}: the points of its grid are in {there.name}, which is not there")
    with h5py.File(there) as file:
        for name, block in blocks.items():
            if name not in file or "points" not in file[name]:
                raise ValueError(f"{path}: {there.name} has no points of its block '{name}': fields of an earlier version, run the scene again for pictures")
            block["points"] = file[name]["points"][...]
    return blocks


def pieces(block, most):
    """A block in boxes of at most so many cells each way: what bends round a rotor is nearly straight in each. Sections and surfaces of one row stay whole."""
    cells = [n - 1 for n in block["points"].shape[:-1]]
    if min(cells) <= 1:
        return [block]
    ends = [np.linspace(0, n, -(-n // most) + 1).astype(int) for n in cells]
    return [{name: values[tuple(slice(low, high + (name == "points")) for low, high in box)] if isinstance(values, np.ndarray) else values
             for name, values in block.items()} for box in itertools.product(*(zip(e[:-1], e[1:]) for e in ends))]


def without_holes(z, bed):
    """Where a body stands in the water there is no surface: the heights around close the hole."""
    dry = z < bed + 0.5 * (np.median(z) - bed)
    wide = dry.copy()
    for axis in (0, 1):
        for step in (-1, 1):
            wide |= np.roll(dry, step, axis)
    return filled(np.where(wide, np.nan, z))


def filled(z):
    """Holes (nan) closed from their edges."""
    for _ in range(200):
        if not np.isnan(z).any() or np.isnan(z).all():
            break
        padded = np.pad(z, 1, mode="edge")
        around = np.stack([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]])
        known = ~np.isnan(around)
        mean = np.where(known.any(axis=0), np.nansum(around, axis=0) / np.maximum(known.sum(axis=0), 1), np.nan)
        z = np.where(np.isnan(z), mean, z)
    return z
