"""Pictures of a resolved flow: its residuals, a slice of pressure and Mach number near the walls, pressure and friction along them.
From history.csv and the newest fields/air_*.h5 and walls_*.h5; h5py is needed for the latter. Called by page.py; tested in tests/src/report.
SPDX-License-Identifier: Apache-2.0"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize, TwoSlopeNorm

import figures
import run_fields

GAMMA, GAS_CONSTANT = 1.4, 287.05  # of kernels/gas/state.hpp


def residuals(run):
    """Density, scaled and turbulence residual over their largest value, and the CFL number; None where the run has no flow."""
    lines = [("density", "flow.density_residual"), ("flow", "flow.scaled_residual"), ("turbulence", "flow.turbulence_residual")]
    if "flow.density_residual" not in run.columns or len(run.time) < 2:
        return None
    figure, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(5.4, 3.2), layout="constrained", height_ratios=[2, 1])
    legend = {}
    for colour, (label, column) in enumerate(lines):
        values = run.column(column)
        largest = np.nanmax(values, initial=0.0)
        if largest > 0.0:
            upper.semilogy(run.time, np.where(values > 0.0, values, np.nan) / largest, color=figures.PALETTE[colour])
            legend[label] = figures.legend_mark(colour, 0)
    lower.semilogy(run.time, run.column("flow.cfl"), color=figures.PALETTE[3])
    upper.set_ylabel("residual / largest")
    lower.set_ylabel("CFL")
    steady = (run.scene.get("aero", {}).get("flow") or {}).get("time") == "steady"
    lower.set_xlabel("pseudo-step" if steady else "time [s]")
    for axis in (upper, lower):
        axis.margins(x=0.0)
        axis.yaxis.set_major_formatter(lambda value, _: figures.power_of_ten(value))
        axis.yaxis.set_minor_locator(plt.NullLocator())
    figure.align_ylabels()
    return figure, legend


def newest(run, name):
    """The newest fields/NAME_*.h5 as a list of {array: values}, pieces of its blocks; None where there are none, h5py is missing or they cannot be read."""
    files = sorted((run.folder / "fields").glob(f"{name}_*.h5"))
    if not files:
        return None
    try:
        blocks = run_fields.grid(files[-1])
    except ImportError:
        return None
    except (OSError, ValueError) as error:
        words = f"fields/ cannot be read: {error}"
        run.notes += [words] if words not in run.notes else []
        return None
    return [piece for label, block in blocks.items() for piece in run_fields.pieces(block | {"block": label}, 16)]


def layer(block, y0):
    """Corners (x, z) and the index of the one layer of cells nearest to the plane y = y0; None where the block is elsewhere."""
    points = block["points"]
    steps = [np.abs(np.diff(points[..., 1], axis=d)).mean() for d in range(3)]
    across = int(np.argmax(steps))
    y = np.moveaxis(points[..., 1], across, 0)
    y = y.reshape(len(y), -1).mean(axis=1)
    if y0 < y.min() - 1e-9 or y0 > y.max() + 1e-9:
        return None
    cell = int(np.argmin(np.abs(0.5 * (y[1:] + y[:-1]) - y0)))
    corners = np.take(points, cell, axis=across)
    return corners[..., 0], corners[..., 2], across, cell


def middle_plane(run):
    """(pieces (x, z, pressure coefficient, Mach number), lowest and highest corner of what is shown); None where the run left no fields."""
    blocks = newest(run, "air")
    walls = newest(run, "walls") or []
    if not blocks:
        return None
    wind = run.scene.get("wind", {}).get("speed_m_s", 0.0)
    density = run.scene.get("environment", {}).get("air_density_kg_m3", 0.0)
    temperature = run.scene.get("aero", {}).get("flow", {}).get("temperature_K", 288.15)
    if not wind or not density:
        return None
    ambient, q = density * GAS_CONSTANT * temperature, 0.5 * density * wind * wind
    every = np.concatenate([b["points"].reshape(-1, 3) for b in blocks])
    y0 = 0.5 * (every[:, 1].min() + every[:, 1].max())
    around = np.concatenate([w["points"].reshape(-1, 3) for w in walls])[:, [0, 2]] if walls else every[:, [0, 2]]
    low, high = around.min(axis=0), around.max(axis=0)
    margin = 0.6 * (high - low).max() if walls else 0.0
    low, high = np.maximum(low - margin, every[:, [0, 2]].min(axis=0)), np.minimum(high + margin, every[:, [0, 2]].max(axis=0))
    pieces = []
    for block in blocks:
        found = layer(block, y0)
        if found is None:
            continue
        x, z, across, cell = found
        if x.max() < low[0] or x.min() > high[0] or z.max() < low[1] or z.min() > high[1]:
            continue
        pressure = np.take(block["pressure"], cell, axis=across)
        speed = np.linalg.norm(np.take(block["velocity"], cell, axis=across), axis=-1)
        mach = speed / np.sqrt(GAMMA * GAS_CONSTANT * np.take(block["temperature"], cell, axis=across))
        pieces.append((x, z, (pressure - ambient) / q, mach))
    return (pieces, low, high) if pieces else None


QUANTITIES = {"pressure coefficient": (2, "RdYlBu_r"), "Mach number": (3, "viridis")}


def round_steps(least, most, count=5):
    """Multiples of 1, 2 or 5 times a power of ten between two values, some `count` of them."""
    power = 10.0 ** np.floor(np.log10((most - least) / count))
    step = next(s * power for s in (1.0, 2.0, 5.0, 10.0) if (most - least) / (s * power) <= 1.2 * count)
    return step * np.arange(np.ceil(least / step - 1e-9), np.floor(most / step + 1e-9) + 1)


def flow_slice(plane, quantities=tuple(QUANTITIES), wide=5.4):
    """Quantities of the flow in a run's middle plane, one above the other; `wide` [inches]."""
    pieces, low, high = plane
    aspect = (high[1] - low[1]) / max(high[0] - low[0], 1e-12)
    tall = float(np.clip(0.74 * wide * aspect, 0.26 * wide, 0.93 * wide)) + 0.5
    figure, axes = plt.subplots(len(quantities), 1, squeeze=False, figsize=(wide, tall * len(quantities)), layout="constrained")
    for axis, label in zip(axes[:, 0], quantities):
        n, colours = QUANTITIES[label]
        seen = np.concatenate([p[n][inside(p, low, high)] for p in pieces])
        least, most = np.percentile(seen, [0.5, 99.5]) if len(seen) else (0.0, 1.0)
        most = max(most, least + 1e-12)
        # The middle of the colours is the undisturbed pressure.
        scale = TwoSlopeNorm(0.0, least, most) if n == 2 and least < 0.0 < most else Normalize(least, most)
        for piece in pieces:
            drawn = axis.pcolormesh(piece[0], piece[1], piece[n], cmap=colours, norm=scale, rasterized=True)
        bar = figure.colorbar(drawn, ax=axis, label=label)
        if isinstance(scale, TwoSlopeNorm):
            bar.set_ticks(round_steps(least, most))
            bar.ax.set_ylim(least, most)
        axis.set_xlim(low[0], high[0])
        axis.set_ylim(low[1], high[1])
        axis.set_aspect("equal" if 0.05 < aspect < 20.0 else "auto")
        axis.set_xlabel("x [m]")
        axis.set_ylabel("z [m]")
        axis.grid(False)
    return figure


def inside(piece, low, high):
    x, z = (0.25 * (a[1:, 1:] + a[:-1, 1:] + a[1:, :-1] + a[:-1, :-1]) for a in piece[:2])
    return (x >= low[0]) & (x <= high[0]) & (z >= low[1]) & (z <= high[1])


def wall_curves(run):
    """Pressure coefficient (negative upwards) and friction along the walls in the middle plane; None without walls."""
    walls = newest(run, "walls")
    if not walls:
        return None
    every = np.concatenate([w["points"].reshape(-1, 3) for w in walls])
    y0, depth = 0.5 * (every[:, 1].min() + every[:, 1].max()), np.ptp(every[:, 1])
    x, cp, cf = [], [], []
    for wall in walls:
        p = wall["points"]
        centre = 0.25 * (p[1:, 1:] + p[:-1, 1:] + p[1:, :-1] + p[:-1, :-1])
        rows = np.abs(p[1:, 1:, 1] - p[:-1, :-1, 1]).max() if depth > 0 else 0.0
        chosen = np.abs(centre[..., 1] - y0) <= 0.51 * max(rows, 1e-12)
        x.append(centre[..., 0][chosen]), cp.append(wall["pressure_coefficient"][chosen])
        cf.append(np.linalg.norm(wall["friction_coefficient"], axis=-1)[chosen])
    x, cp, cf = map(np.concatenate, (x, cp, cf))
    if not len(x):
        return None
    rubs = np.nanmax(cf, initial=0.0) > 0.0
    figure, axes = plt.subplots(2 if rubs else 1, 1, sharex=True, squeeze=False, figsize=(5.4, 4.2 if rubs else 2.4), layout="constrained")
    axes[0, 0].plot(x, cp, ".", markersize=2.5, color=figures.PALETTE[0])
    axes[0, 0].invert_yaxis()
    axes[0, 0].set_ylabel("pressure coefficient")
    if rubs:
        axes[1, 0].plot(x, cf, ".", markersize=2.5, color=figures.PALETTE[1])
        axes[1, 0].set_ylabel("friction coefficient")
    axes[-1, 0].set_xlabel("x [m]")
    figure.align_ylabels()
    return figure


def y_plus_words(run):
    walls = newest(run, "walls")
    values = np.concatenate([w["y_plus"].ravel() for w in walls]) if walls else np.empty(0)
    if not len(values) or not values.max() > 0.0:
        return ""
    return f"First centres lie at y+ {np.median(values):.2g} (half of the faces below), at most {values.max():.2g}."

