#!/usr/bin/env python3
"""Pictures of a rotor grid written by `spindrift grid SCENE -o GRID.p3d`: the blades' surface, a coaxial surface, the trailing edge.
Usage: picture.py GRID.p3d OUT.png   (Debian: /usr/bin/python3 with numpy and matplotlib)"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def records(path):
    """Fortran records of a binary multi-block Plot3D file in double precision."""
    with open(path, "rb") as f:
        while head := f.read(4):
            n = int.from_bytes(head, sys.byteorder)
            yield f.read(n)
            f.read(4)


def blocks(path):
    read = records(path)
    count = int(np.frombuffer(next(read), "i4")[0])
    sizes = np.frombuffer(next(read), "i4").reshape(count, 3)
    for ni, nj, nk in sizes:
        yield np.frombuffer(next(read), "f8").reshape(3, nk, nj, ni)


def unrolled(block, k):
    x, y, z = block[:, k]
    r = np.hypot(y, z)
    return r * np.arctan2(-y, z), x


def lines(ax, s, x, **style):
    ax.plot(s, x, **style)
    ax.plot(s.T, x.T, **style)


def plane(ax, sector, k, span, half, centre, title):
    for n, block in enumerate(sector):
        kk = k - span if n == 1 else k
        if kk < 0:
            continue
        s, x = unrolled(block, kk)
        lines(ax, s, x, color="tab:blue" if n < 2 else "0.45", lw=0.35)
    ax.set_xlim(centre[0] - half, centre[0] + half)
    ax.set_ylim(centre[1] - half, centre[1] + half)
    ax.set_aspect("equal")
    ax.set_title(title, fontsize=9)
    ax.set_xlabel("along the turning direction [m]", fontsize=8)
    ax.set_ylabel("downwind [m]", fontsize=8)


def main(path, out):
    grid = list(blocks(path))
    sector = grid[:10]
    ring, plug = sector[0], sector[1]
    span = ring.shape[1] - plug.shape[1]
    figure = plt.figure(figsize=(13, 9))
    ax = figure.add_subplot(2, 2, 1, projection="3d")
    for n in range(0, len(grid), 10):
        x, y, z = grid[n][:, : span + 1, :, 0]
        ax.plot_surface(y, x, z, color="0.85", edgecolor="tab:blue", linewidth=0.15, shade=True, rcount=200, ccount=200)
    ax.set_box_aspect((np.ptp(grid[0][1]) or 1, 40, np.ptp(grid[0][2]) or 1) if len(grid) == 10 else (1, 0.25, 1), zoom=1.6)
    ax.set_xlim(-90, 90), ax.set_ylim(-30, 30), ax.set_zlim(-90, 90)
    ax.view_init(12, -70)
    ax.set_axis_off()
    ax.set_title("blades", fontsize=9)
    k = min(int(0.75 * span), span)
    s, x = unrolled(ring, k)
    radius = np.hypot(ring[1, k, 0, 0], ring[2, k, 0, 0])
    nose = s.shape[0] // 2
    chord = np.hypot(s[0, 0] - s[nose, 0], x[0, 0] - x[nose, 0])
    middle = 0.5 * (s[0, 0] + s[nose, 0]), 0.5 * (x[0, 0] + x[nose, 0])
    plane(figure.add_subplot(2, 2, 2), sector, k, span, 2.2 * chord, middle, f"coaxial surface r = {radius:.1f} m")
    plane(figure.add_subplot(2, 2, 3), sector, k, span, 0.06 * chord, (s[0, 0], x[0, 0]), "its trailing edge")
    s, x = unrolled(ring, 0)
    plane(figure.add_subplot(2, 2, 4), sector, 0, span, 6.5, (0.0, float(x[:, 0].mean())), "hub cylinder")
    figure.tight_layout()
    figure.savefig(out, dpi=80)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
