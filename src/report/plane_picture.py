"""Pictures of sections and tanks in their plane, with axes, units and a scale of colours: the flow round walls, the water of a tank.
Called by spindrift_picture.py; tested in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import textwrap

import matplotlib
import numpy as np

import flow_pictures
import geometry
import painted
import run_fields
from figures import plt

INK = "#22262b"
SPEED = matplotlib.colormaps["viridis"].with_extremes(under="#9aa0a6")
MOST_DRAWN = 400_000
STRETCHED = 14.0


class NoFields(ValueError):
    """The run left nothing to draw."""


class Drawing:
    def __init__(self, run):
        self.run, self.fields, self.scene = run, run_fields.Fields(run), geometry.Scene3d(run)
        self.water = bool(self.fields.files["particles"])
        if not self.water and not self.fields.files["air"]:
            sea = (self.run.scene.get("sea") or {}).get("model") == "sph"
            raise NoFields(f"{run.folder} has no fields: " + ("give the scene [sea.fields] and run it again" if sea else "run the flow to its end"))
        self.most = self.top = None

    def times(self):
        return self.fields.times("particles" if self.water else "air")

    def draw(self, t):
        with plt.rc_context({"axes.edgecolor": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "text.color": INK,
                             "figure.facecolor": "white", "font.size": 11, "axes.labelsize": 11, "xtick.labelsize": 10, "ytick.labelsize": 10}):
            figure = self.tank(t) if self.water else self.flow()
            figure.canvas.draw()
            image = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
            plt.close(figure)
        return image

    def flow(self):
        plane = flow_pictures.middle_plane(self.run)
        if plane is None:
            raise ValueError("the flow has no cells in its middle plane")
        figure = flow_pictures.flow_slice(plane, wide=8.0)
        figure.set_dpi(130)
        figure.suptitle(self.run.title, x=0.01, ha="left", fontweight="semibold")
        return figure

    def tank(self, t):
        import h5py
        time, path = self.fields.nearest("particles", t)
        spacing = (self.run.scene["sea"].get("particles") or {}).get("spacing_m", np.inf)
        with h5py.File(path) as file:
            position, owner = file["position"][...], file["owner"][...] if "owner" in file else None
            speed = np.linalg.norm(file["velocity"][...], axis=1) if "velocity" in file else np.zeros(len(position))
        if self.most is None:
            self.most, self.top = self._greatest_speed_and_height()
        keep = np.abs(position[:, 1]) <= spacing if np.ptp(position[:, 1]) > 0 else np.ones(len(position), bool)
        tank = self.run.scene["sea"].get("tank") or {}
        x = tank.get("x_m", [position[:, 0].min(), position[:, 0].max()])
        if owner is None:   # walls are what stands outside of the tank
            bed = -(self.run.scene.get("environment") or {}).get("water_depth_m", np.inf)
            keep &= (position[:, 0] >= x[0]) & (position[:, 0] <= x[1]) & (position[:, 2] >= bed)
        water = keep & (owner == 0) if owner is not None else keep
        solids = keep & (owner != 0) if owner is not None else np.zeros(len(position), bool)
        low = position[keep, 2].min()
        z = [low, min(tank.get("top_m", np.inf), self.top + 0.12 * (self.top - low))]   # no more air than the water of any time leaves
        if solids.any():
            x = [x[0] - 3 * spacing, x[1] + 3 * spacing]
        limits = tuple(x), (z[0] - 0.02 * (z[1] - z[0]), z[1])
        figure, axis, scale = frame(self.run.title, *(np.ptp(limit) for limit in limits))
        shown = np.flatnonzero(keep & ~self._drawn(position, owner, time, spacing))
        shown = shown[:: max(1, len(shown) // MOST_DRAWN)]
        value = np.where(water, speed, -1.0)   # walls are below the scale
        drawn = painted.paint(axis, position[shown, 0], position[shown, 2], value[shown], spacing, limits, cmap=SPEED, vmin=0.0, vmax=self.most or 1.0)
        solids_at(axis, self.scene, time)
        axis.set(xlim=limits[0], ylim=limits[1], xlabel="x [m]", ylabel="z [m]")
        axis.grid(False)
        axis.set_title(f"t = {time:.3g} s", loc="left", fontsize=12)
        figure.colorbar(drawn, cax=scale, label="speed of the water [m/s]", orientation="horizontal" if scale.get_position().width > scale.get_position().height else "vertical")
        return figure

    def _drawn(self, position, owner, time, spacing):
        """Particles of bodies that are drawn themselves."""
        hidden = np.zeros(len(position), bool)
        for piece in self.scene.pieces(time) if owner is not None else ():
            if piece.kind == "float":
                low, high = piece.points.min(axis=0) - spacing, piece.points.max(axis=0) + spacing
                hidden |= (owner > 1) & ((position >= low) & (position <= high)).all(axis=1)
        return hidden

    def _greatest_speed_and_height(self):
        """Of the water and the floats of all outputs, so that the colours and the frame of a film mean the same throughout."""
        import h5py
        most, top = 0.0, -np.inf
        for time, path in self.fields.files["particles"][:: max(1, len(self.fields.files["particles"]) // 12)]:
            with h5py.File(path) as file:
                water = file["owner"][...] == 0 if "owner" in file else slice(None)
                height = file["position"][...][water, 2]
                if "velocity" in file and len(height):
                    most = max(most, float(np.percentile(np.linalg.norm(file["velocity"][...][water], axis=1), 99.5)))
                floats = [piece.points[:, 2].max() for piece in self.scene.pieces(time) if piece.kind == "float"]
                top = max([top, float(np.max(height, initial=-np.inf)), *floats])
        return most, top


def frame(title, wide_m, high_m):
    """Figure, axes and place of the colours' scale for a stretch of water, in inches, so that every frame of a film has the same: beside low water the
    scale would be too short, so it lies below it. One metre is as long upwards as sideways, but in tanks longer than STRETCHED of their height."""
    span = wide_m / max(high_m, 1e-9)
    below = span > 5.0
    high = float(np.clip(9.4 / min(span, STRETCHED), 0.5, 5.6))
    wide = 9.4 if span > STRETCHED else high * span
    left, right, bottom = 0.85, 0.25 if below else 1.25, 1.4 if below else 0.65
    all_wide = max(6.5, left + wide + right)
    lines = textwrap.wrap(title, int(8.8 * all_wide)) or [""]
    top = 0.45 + 0.26 * len(lines)
    all_high = bottom + high + top
    figure = plt.figure(figsize=(all_wide, all_high), dpi=130, facecolor="white")
    left += 0.5 * (all_wide - left - wide - right)
    axis = figure.add_axes((left / all_wide, bottom / all_high, wide / all_wide, high / all_high))
    box = (left + 0.3 * wide, 0.62, 0.4 * wide, 0.14) if below else (left + wide + 0.12, bottom, 0.2, high)
    scale = figure.add_axes((box[0] / all_wide, box[1] / all_high, box[2] / all_wide, box[3] / all_high))
    figure.text(0.1 / all_wide, 1.0 - 0.08 / all_high, "\n".join(lines), ha="left", va="top", fontweight="semibold", fontsize=13)
    return figure, axis, scale


def solids_at(axis, scene, time):
    """Bodies and lines that meet the plane y = 0, over its water, as they lie at this time."""
    for piece in scene.pieces(time):
        if piece.points[:, 1].min() > 1e-9 or piece.points[:, 1].max() < -1e-9:
            continue
        if piece.kind == "float":
            outline(axis, piece)
        for line in piece.lines:
            axis.plot(piece.points[line, 0], piece.points[line, 2], color="#d9480f", linewidth=1.4)


def outline(axis, piece, plane=(0, 2)):
    """The silhouette of a convex body in a plane of two axes."""
    points = piece.points[:, list(plane)]
    order = _hull(points)
    axis.fill(points[order, 0], points[order, 1], facecolor="#f2b81a", edgecolor=INK, linewidth=0.8)


def _hull(points):
    """Indices round the convex hull (Andrew's monotone chain)."""
    order = np.lexsort((points[:, 1], points[:, 0]))

    def half(indices):
        out = []
        for i in indices:
            while len(out) > 1 and np.cross(points[out[-1]] - points[out[-2]], points[i] - points[out[-2]]) <= 0:
                out.pop()
            out.append(i)
        return out[:-1]

    return half(order) + half(order[::-1])
