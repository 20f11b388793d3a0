"""The wake of a resolved rotor as surfaces: slow air in the upright plane through the axis, and the tip vortices.
Drawn by scene_picture.py, written for ParaView by geometry_fields.py; tested in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import numpy as np

import cut
import geometry

VORTEX = 0.02    # Q in units of (wind / 10 m)^2: low enough for the vortices of coarse grids
FEWEST_FOR_VORTICES = 100_000   # cells round the rotor, below which surfaces of Q are shapes of cells
SLOW = 0.9       # of the wind: what is faster is not wake


def tip(scene):
    """Radius of the rotor [m]."""
    return scene.rotor.tip


def wind(scene):
    """Free wind at the hub [m/s]."""
    return (scene.scene.get("wind") or {}).get("speed_m_s", 0.0)


def surfaces(scene, blocks, time):
    """The plane and the vortices, each as triangles in the earth's frame (n, 3, 3) with the axial over the free wind at their corners (n, 3), or None.
    Triangles are whole: those at the edge of the slow air are in part faster than `SLOW`."""
    hub, frame, radius, free = scene.rotor.hub(time), scene.rotor.frame(time), tip(scene), wind(scene)
    count = scene.rotor.blades.count if scene.rotor.blades else 3   # as geometry.py draws them without a turbine file
    copies = count if (scene.scene["aero"].get("grid") or {}).get("sectors") == "one" else 1
    # One sector is drawn turned to the axis as it is now, as its loads are.
    at, own = scene.rotor.sector(time) if copies > 1 else (hub, frame)
    cells = sum(block["velocity"][..., 0].size for block in blocks)
    slow, axial_at, cores, axial_of = [], [], [], []
    for block in blocks:
        nodes = (block["points"] - at) @ own.T
        if np.hypot(nodes[..., 1], nodes[..., 2]).min() > 1.6 * radius or nodes[..., 0].min() > 3.2 * radius or nodes[..., 0].max() < -0.3 * radius:
            continue
        velocity = block["velocity"] @ own.T
        axial = cut.at_nodes(velocity[..., 0]) / free
        q = None
        if min(velocity.shape[:3]) > 1 and cells * copies >= FEWEST_FOR_VORTICES:
            g = cut.gradient(nodes, velocity)
            q = cut.at_nodes(-0.5 * np.einsum("...ij,...ji->...", g, g)) * (10.0 / free) ** 2
        for copy in range(copies):
            turn = geometry.about(np.array([1.0, 0.0, 0.0]), 2 * np.pi * copy / copies)
            places = nodes @ turn.T
            beside = 0.013 * radius   # not in a plane that blocks share
            if places[..., 1].min() <= beside <= places[..., 1].max():
                points, values = cut.surface(places, places[..., 1], beside, axial)
                slow.append(points), axial_at.append(values)
            if q is not None:
                points, values = cut.surface(places, q, VORTEX, axial)
                cores.append(points), axial_of.append(values)

    def kept(points, values, condition):
        points, values = np.concatenate(points or [np.empty((0, 3, 3))]), np.concatenate(values or [np.empty((0, 3))])
        # By corners: cells far downstream are longer than what is shown of them.
        near = (points[..., 0].max(axis=1) > -0.3 * radius) & (points[..., 0].min(axis=1) < 3.0 * radius)
        near &= np.hypot(points[..., 1], points[..., 2]).min(axis=1) < 1.5 * radius
        chosen = near & condition(points.mean(axis=1), values)
        return (hub + points[chosen] @ frame, values[chosen]) if chosen.any() else None

    plane = kept(slow, axial_at, lambda middle, values: values.min(axis=1) < SLOW)
    # What is bound to the blades hides them.
    vortices = kept(cores, axial_of, lambda middle, values: (middle[:, 0] > 0.03 * radius) & (np.hypot(middle[:, 1], middle[:, 2]) < 1.3 * radius))
    return plane, vortices
