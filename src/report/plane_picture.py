"""Pictures of sections and tanks in their plane, with axes, units and a scale of colours: the flow round walls, the water of a tank.
Called by spindrift_picture.py; tested in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import textwrap

import numpy as np

import flow_pictures
import geometry
import run_fields
from figures import plt

INK = "#22262b"
MOST_DRAWN = 60_000


class Drawing:
    def __init__(self, run):
        self.run, self.fields, self.scene = run, run_fields.Fields(run), geometry.Scene3d(run)
        self.water = bool(self.fields.files["particles"])
        if not self.water and not self.fields.files["air"]:
            raise ValueError(f"{run.folder} has no fields: give the scene [sea.fields] or run the flow to its end")
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
        figure = flow_pictures.flow_slice(plane)
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
        chosen = np.flatnonzero(water)
        chosen = chosen[:: max(1, len(chosen) // MOST_DRAWN)]
        low = position[keep, 2].min()
        z = [low, min(tank.get("top_m", np.inf), self.top + 0.12 * (self.top - low))]   # no more air than the water of any time leaves
        if solids.any():
            x = [x[0] - 3 * spacing, x[1] + 3 * spacing]
        span = (x[1] - x[0]) / max(z[1] - z[0], 1e-9)
        high = float(np.clip(9.4 / span, 1.0, 6.0))
        wide = 9.4 if span > 5.0 else max(6.0, min(9.4, high * span))   # of the water, beside its scales
        figure, axis = plt.subplots(figsize=(wide + 1.6, high + (1.9 if span > 5.0 else 1.6)), dpi=130, layout="constrained", facecolor="white")
        size = max(0.2, min(600.0, (1.15 * spacing * 72 * min(high / max(z[1] - z[0], 1e-9), wide / (x[1] - x[0]))) ** 2)) if np.isfinite(spacing) else 2.0
        if solids.any():
            axis.scatter(position[solids, 0], position[solids, 2], c="#9aa0a6", s=size, linewidths=0)
        drawn = axis.scatter(position[chosen, 0], position[chosen, 2], c=speed[chosen], s=size, linewidths=0, cmap="viridis", vmin=0.0, vmax=self.most or 1.0)
        solids_at(axis, self.scene, time)
        axis.set_xlim(*x)
        axis.set_ylim(z[0] - 0.02 * (z[1] - z[0]), z[1])
        if span < 14.0:
            axis.set_aspect("equal")
        axis.grid(False)
        axis.set_xlabel("x [m]")
        axis.set_ylabel("z [m]")
        figure.suptitle(textwrap.fill(self.run.title, int(9.5 * figure.get_figwidth())), x=0.01, ha="left", fontweight="semibold", fontsize=12)
        axis.set_title(f"t = {time:.3g} s", loc="left", fontsize=11)
        if span > 5.0:
            figure.colorbar(drawn, ax=axis, label="speed of the water [m/s]", orientation="horizontal", shrink=0.4, aspect=40, pad=0.02)
        else:
            figure.colorbar(drawn, ax=axis, label="speed of the water [m/s]", fraction=0.03, pad=0.01)
        return figure

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
