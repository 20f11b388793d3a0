"""Pictures of a resolved rotor: pressure on a blade, the wind through and behind the rotor.
From the newest fields/air_*.h5 and walls_*.h5; h5py is needed. Called by page.py; tested in tests/src/report.
SPDX-License-Identifier: Apache-2.0"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize

import cut
import flow_pictures

WIND = {"cmap": "viridis", "vmin": 0.0, "vmax": 1.2}   # colours of the axial velocity over the wind's


class Rotor:
    """What the scene says of the rotor, and its frame: x downwind along the axis, z up, origin at the hub."""

    def __init__(self, run, walls):
        self.walls = walls
        scene = run.scene.get("rotor", {})
        carried = "rotor.hub_x_m" in run.columns
        self.hub, along = carried_by_bodies(run, scene) if carried else at_rest(scene)
        up = np.array([0.0, 0.0, 1.0]) - along[2] * along
        up /= np.linalg.norm(up)
        self.frame = np.stack([along, np.cross(up, along), up])
        self.speed = (run.column("rotor.rpm")[-1] if carried else scene.get("speed_rpm", 0.0)) * np.pi / 30.0
        self.wind = run.scene.get("wind", {}).get("speed_m_s", 0.0)
        self.density = run.scene.get("environment", {}).get("air_density_kg_m3", 1.225)
        self.temperature = run.scene.get("aero", {}).get("flow", {}).get("temperature_K", 288.15)
        self.tip = max(np.linalg.norm(self.local(wall["points"])[..., 1:], axis=-1).max() for wall in walls)
        # Without a turbine file one sector is drawn alone.
        self.copies = run.turbine(scene).get("blades", 1) if run.scene["aero"]["grid"].get("sectors") == "one" else 1

    def local(self, points):
        return (points - self.hub) @ self.frame.T

    def turned(self, points, copy):
        """Points of the rotor's frame, turned by whole sectors about the axis."""
        a = 2.0 * np.pi * copy / self.copies
        y, z = points[..., 1], points[..., 2]
        return np.stack([points[..., 0], np.cos(a) * y - np.sin(a) * z, np.sin(a) * y + np.cos(a) * z], axis=-1)


def at_rest(scene):
    """Hub and axis of a rotor without bodies."""
    axis = np.array(scene.get("axis", [1.0, 0.0, 0.0]), dtype=float)
    return np.array(scene.get("hub_m", [0.0, 0.0, 0.0]), dtype=float), axis / np.linalg.norm(axis)


def carried_by_bodies(run, scene):
    """Hub and axis at the end of a coupled run. The grid of one sector stays on the axis it has at the start."""
    joint = run.scene.get("joints", {}).get(scene.get("joint"), {})
    axis = np.array(joint.get("axis", scene.get("axis", [1.0, 0.0, 0.0])), dtype=float)
    axis /= np.linalg.norm(axis)
    hub = np.stack([run.column(f"rotor.hub_{c}_m") for c in "xyz"], axis=-1)
    if run.scene["aero"]["grid"].get("sectors") == "one":
        return hub[0] + (hub[-1] - hub[0]) @ axis * axis, axis
    carrier = next((body for body in joint.get("bodies", []) if body != scene.get("body") and f"{body}.pitch_deg" in run.columns), None)
    if carrier is None:
        return hub[-1], axis
    roll, pitch, yaw = (np.radians(run.column(f"{carrier}.{angle}_deg")[-1]) for angle in ("roll", "pitch", "yaw"))
    about = lambda a, i, j: np.eye(3) + (np.cos(a) - 1.0) * (np.outer(i, i) + np.outer(j, j)) + np.sin(a) * (np.outer(j, i) - np.outer(i, j))
    x, y, z = np.eye(3)
    return hub[-1], about(yaw, x, y) @ about(pitch, z, x) @ about(roll, y, z) @ axis


def blade(rotor):
    """Pressure coefficient (on wind and turning at the radius) of the first blade, seen from upwind and from downwind."""
    walls = [wall for wall in rotor.walls if wall["block"].startswith("blade_1")] or rotor.walls
    turned = turning(np.concatenate([rotor.local(wall["points"]).reshape(-1, 3) for wall in walls]))
    ambient = rotor.density * flow_pictures.GAS_CONSTANT * rotor.temperature
    quads = np.concatenate([faces(rotor.local(wall["points"]) @ turned) for wall in walls])
    pressure = np.concatenate([wall["pressure"].ravel() for wall in walls]) - ambient
    block = np.concatenate([np.full(wall["pressure"].size, n) for n, wall in enumerate(walls)])
    centre = quads.mean(axis=1)
    radius = np.hypot(centre[:, 1], centre[:, 2])
    upright = (centre[:, 2] > 0.0) & (np.abs(centre[:, 1]) < 0.5 * radius)
    quads, pressure, radius, block = quads[upright], pressure[upright], radius[upright], block[upright]
    if not len(quads):
        return None
    normal = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    outward = np.einsum("ij,ij->i", normal, quads.mean(axis=1) - spine(quads))
    normal *= np.sign(np.bincount(block, outward))[block][:, None]   # all faces of a block alike
    cp = pressure / (0.5 * rotor.density * (rotor.wind**2 + (rotor.speed * radius) ** 2))
    figure, axes = plt.subplots(2, 1, figsize=(5.4, 3.4), layout="constrained", sharex=True)
    least, most = np.percentile(cp, [1, 99])
    for axis, side, words in ((axes[0], normal[:, 0] < 0.0, "from upwind"), (axes[1], normal[:, 0] > 0.0, "from downwind")):
        drawn = PolyCollection(quads[side][:, :, [2, 1]], array=cp[side], cmap="RdYlBu_r", edgecolors="face", linewidths=0.2, rasterized=True)
        drawn.set_clim(least, most)
        axis.add_collection(drawn)
        axis.autoscale_view()
        axis.set_title(words, loc="left")
        axis.set_ylabel("y [m]")
        axis.grid(False)
    axes[1].set_xlabel("radius [m]")
    figure.colorbar(drawn, ax=axes, label="pressure coefficient")
    return figure


def turning(points):
    """Matrix that turns a blade's points (n, 3) about the axis until the blade stands upright."""
    far = points[np.hypot(points[:, 1], points[:, 2]) > 0.5 * np.hypot(points[:, 1], points[:, 2]).max()]
    y, z = far[:, 1:].mean(axis=0) / np.hypot(*far[:, 1:].mean(axis=0))
    return np.array([[1.0, 0.0, 0.0], [0.0, z, y], [0.0, -y, z]])


def faces(p):
    """The quadrilaterals of a surface's nodes, four corners each."""
    return np.stack([p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]], axis=-2).reshape(-1, 4, 3)


def spine(quads):
    """For each face the middle of the section at its radius: what lies inside of the blade."""
    z = quads[..., 2].mean(axis=1)
    bins = np.linspace(z.min(), z.max() + 1e-9, 25)
    place = np.digitize(z, bins)
    centre = quads.mean(axis=1)
    out = centre.copy()
    for b in np.unique(place):
        mask = place == b
        out[mask, :2] = centre[mask, :2].mean(axis=0)
    return out


def volume(run, rotor):
    """The blocks in the rotor's frame: nodes, and at the nodes the axial velocity over the wind."""
    blocks = flow_pictures.newest(run, "air")
    if not blocks or not rotor.wind:
        return None
    return [(rotor.local(block["points"]), cut.at_nodes(block["velocity"] @ rotor.frame[0]) / rotor.wind)
            for block in blocks if min(block["velocity"].shape[:3]) >= 2] or None


def wake(blocks, rotor):
    """(words, figure): the axial wind in the plane of the axis and the first blade, and in a plane across the wake a quarter of a diameter behind the rotor."""
    tip = rotor.tip
    behind = 0.5 * tip
    for words, normal, level, shown, span in (("in the plane of the axis", 1, 0.0, (0, 2), ((-2.0, 4.0), (-2.0, 2.0))),
                                              (f"{behind:.0f} m behind the rotor", 0, behind, (1, 2), ((-1.6, 1.6),) * 2)):
        figure, axis = plt.subplots(figsize=(5.4, 4.0 * np.ptp(span[1]) / np.ptp(span[0]) + 0.6), layout="constrained")
        for copy in range(rotor.copies):
            for nodes, axial in blocks:
                places = rotor.turned(nodes, copy)
                if places[..., normal].min() > level or places[..., normal].max() < level:
                    continue
                triangles, values = cut.surface(places, places[..., normal], level, axial)
                if len(triangles):
                    flat = triangles[:, :, shown].reshape(-1, 2)
                    axis.tripcolor(flat[:, 0], flat[:, 1], np.arange(len(flat)).reshape(-1, 3), values.ravel(), shading="gouraud", rasterized=True, **WIND)
        axis.set_xlim(*(tip * s for s in span[0]))
        axis.set_ylim(*(tip * s for s in span[1]))
        axis.set_aspect("equal")
        axis.grid(False)
        axis.set_xlabel(f"{'xyz'[shown[0]]} from the hub [m]")
        axis.set_ylabel(f"{'xyz'[shown[1]]} from the hub [m]")
        figure.colorbar(ScalarMappable(Normalize(WIND["vmin"], WIND["vmax"]), WIND["cmap"]), ax=axis, label="axial velocity / wind")
        yield words, figure


def pictures(run):
    """(title, figure, caption) of each picture that the run's files give."""
    if "grid" not in run.scene.get("aero", {}):   # what stands still in the wind has a grid of its own, [aero.flow]
        return
    walls = flow_pictures.newest(run, "walls")
    if not walls:
        return
    rotor = Rotor(run, walls)
    if figure := blade(rotor):
        yield ("Pressure on a blade", figure,
               "Pressure above the undisturbed one on the dynamic pressure of wind and turning at the radius; leading edge and suction side are blue. Across "
               "the blade drawn larger than along it.")
    if blocks := volume(run, rotor):
        for words, figure in wake(blocks, rotor):
            yield f"Wind {words}", figure, "Velocity along the axis over the wind's, at the end of the run."
