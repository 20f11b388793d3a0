"""Pictures of a sea of particles from fields/: a slice of particles coloured by speed and pressure, the height of the surface, at the first,
middle and last output. Called by page.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import pathlib

import numpy as np

import figures
import geometry
import painted
import plane_picture
from figures import plt

HOLE = 2.0           # times the scale of the colours: what is lower is no wave but the place of a body
MOST_DRAWN = 400_000  # particles in one picture; thinned evenly beyond


def _outputs(run, name):
    return sorted(pathlib.Path(run.folder, "fields").glob(f"{name}_*.h5"))


def _chosen(files):
    """First, middle, last: no more than three, each once."""
    return [files[i] for i in sorted({0, len(files) // 2, len(files) - 1})] if files else []


def _slice(file, spacing):
    """x, z, speed, pressure of the water within a spacing of y = 0 (all of it in 2-D), time; thinned."""
    position = file["position"][...]
    keep = np.ones(len(position), bool)
    if len(position) and np.ptp(position[:, 1]) > 0.0:
        keep = np.abs(position[:, 1]) <= spacing
    if "owner" in file:
        keep &= file["owner"][...] == 0
    chosen = np.flatnonzero(keep)
    chosen = chosen[:: max(1, len(chosen) // MOST_DRAWN)]
    speed = np.linalg.norm(file["velocity"][...][chosen], axis=1) if "velocity" in file else None
    pressure = file["pressure"][...][chosen] if "pressure" in file else None
    return position[chosen, 0], position[chosen, 2], speed, pressure, float(file.attrs["time_s"])


def particles(run, h5py):
    """(title, figure, caption) of slices, one figure per quantity."""
    scene = geometry.Scene3d(run)
    slices, spacing = [], run.scene.get("sea", {}).get("particles", {}).get("spacing_m", np.inf)
    for path in _chosen(_outputs(run, "particles")):
        with h5py.File(path) as file:
            slices.append(_slice(file, spacing))
    for index, name, unit, factor in ((2, "speed", "m/s", 1.0), (3, "pressure", "kPa", 1e-3)):
        shown = [s for s in slices if s[index] is not None and len(s[0])]
        if not shown:
            continue
        span = max(np.ptp(s[0]) for s in shown) / max(1e-9, max(np.ptp(s[1]) for s in shown))
        figure, axes = plt.subplots(len(shown), 1, squeeze=False, sharex=True, layout="constrained",
                                    figsize=(5.4, min(2.4, max(0.9, 5.0 / span)) * len(shown) + 0.5))
        top = max(np.percentile(factor * s[index], 99.5) for s in shown)
        limits = [(min(np.min(s[n]) for s in shown), max(np.max(s[n]) for s in shown)) for n in (0, 1)]
        floats = [piece.points[:, 2].max() for _, _, _, _, time in shown for piece in scene.pieces(time) if piece.kind == "float"]
        height = np.ptp(limits[1])
        upper = float(np.clip(max(floats, default=-np.inf), limits[1][1] + 0.25 * height, limits[1][1] + 0.7 * height))   # whole floats where they are low
        for axis, s in zip(axes[:, 0], shown):
            drawn = painted.paint(axis, s[0], s[1], factor * s[index], spacing, (limits[0], (limits[1][0], upper)),
                                  cmap="viridis", vmin=0.0, vmax=top or 1.0)
            axis.set_ylabel("z [m]")
            axis.set_title(f"t = {s[4]:g} s", loc="left")
            plane_picture.solids_at(axis, scene, s[4])
            axis.set_xlim(*limits[0])   # lines and towers reach far beyond the water
            axis.set_ylim(limits[1][0], upper)
            if span < 12.0:
                axis.set_aspect("equal")
        axes[-1, 0].set_xlabel("x [m]")
        figure.colorbar(drawn, ax=list(axes[:, 0]), label=f"{name} [{unit}]", fraction=0.04)
        yield f"Water particles: {name}", figure, "Water within a spacing of y = 0, with bodies and lines, at the first, middle and last output of fields/particles."


def _scale(run, maps):
    """Greatest elevation of the colours [m]: that of the waves, not of the holes that bodies make."""
    height = run.scene.get("waves", {}).get("height_m")
    if isinstance(height, (int, float)) and height > 0.0:
        return 0.75 * height
    return max(1.5 * np.percentile(np.abs(m[1]), 90) for m in maps) or 1.0


def beside_floats(corners, scene, time):
    """Cells (nj, ni) of the mesh of the surface that a float stands in, in part or whole: their height is not that of the water."""
    x, y = (corners[0, :, :, n] for n in (0, 1))
    inside, centre = np.zeros(np.subtract(x.shape, 1), bool), [0.25 * (a[1:, 1:] + a[:-1, 1:] + a[1:, :-1] + a[:-1, :-1]) for a in (x, y)]
    half = [0.5 * np.ptp(a) / max(n - 1, 1) for a, n in ((x, x.shape[1]), (y, y.shape[0]))]
    for piece in scene.pieces(time):
        if piece.kind == "float" and piece.points[:, 2].min() < 0.0 < piece.points[:, 2].max():
            low, high = piece.points[:, :2].min(axis=0), piece.points[:, :2].max(axis=0)
            inside |= np.all([(c > a - h) & (c < b + h) for c, a, b, h in zip(centre, low, high, half)], axis=0)
    return inside


def surface(run, h5py):
    """(title, figure, caption) of the height of the surface: a map, or lines where the scene is a plane."""
    maps, scene = [], geometry.Scene3d(run)
    for path in _chosen(_outputs(run, "surface")):
        with h5py.File(path) as file:
            points = file["water/points"]
            corners = points[...] if points is not None else None
            maps.append((corners, file["water/elevation"][0], float(file.attrs["time_s"])))
    if not maps:
        return
    if maps[0][1].shape[0] == 1:
        figure, axis = plt.subplots(figsize=(5.4, 2.1), layout="constrained")
        bed = -(run.scene.get("environment") or {}).get("water_depth_m", np.inf)
        for i, (corners, elevation, time) in enumerate(maps):
            x = corners[0, 0, :, 0]
            dry = elevation[0] <= 0.98 * bed   # no water over this place, or a body in it
            axis.plot(0.5 * (x[1:] + x[:-1]), np.where(dry, np.nan, elevation[0]), color=figures.PALETTE[i], label=f"t = {time:g} s")
        axis.set_xlabel("x [m]")
        axis.set_ylabel("elevation [m]")
        axis.legend(ncols=len(maps), loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2)
        yield "Height of the water's surface", figure, "Read on the mesh of fields/surface, at the first, middle and last output; no line where there is no water, or a body."
    else:
        corners = maps[0][0]
        shape = np.ptp(corners[..., 1]) / max(np.ptp(corners[..., 0]), 1e-9)
        most = _scale(run, maps)
        for corners, elevation, time in maps:
            figure, axis = plt.subplots(figsize=(5.4, float(np.clip(4.5 * shape, 0.8, 4.5)) + 0.6), layout="constrained")
            seen = np.where((np.abs(elevation) <= HOLE * most) & ~beside_floats(corners, scene, time), elevation, np.nan)
            drawn = axis.pcolormesh(corners[0, :, :, 0], corners[0, :, :, 1], seen, cmap="RdBu_r", vmin=-most, vmax=most, rasterized=True)
            limits = axis.get_xlim(), axis.get_ylim()
            for piece in scene.pieces(time):
                if piece.kind == "float" and piece.points[:, 2].min() < 0.0 < piece.points[:, 2].max():
                    plane_picture.outline(axis, piece, (0, 1))
            axis.set(xlim=limits[0], ylim=limits[1], xlabel="x [m]", ylabel="y [m]")
            axis.set_aspect("equal")
            figure.colorbar(drawn, ax=axis, label="elevation [m]", fraction=0.04, extend="both")
            yield f"Height of the water's surface at {time:g} s", figure, "Read on the mesh of fields/surface; blank where a float leaves no surface."


def pictures(run):
    """[(title, figure, caption)]; a note in the run where fields are there and cannot be read."""
    if not (_outputs(run, "particles") or _outputs(run, "surface")):
        return []
    try:
        import h5py
    except ImportError:
        run.notes.append("pictures of the sea need h5py (python3-h5py)")
        return []
    try:
        return list(surface(run, h5py)) + list(particles(run, h5py))
    except (OSError, KeyError, ValueError) as error:
        run.notes.append(f"fields/ cannot be read: {error}")
        return []
