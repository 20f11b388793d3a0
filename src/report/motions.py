"""The six motions of a body: which of them there are, whether their means stand still, and those that still swing at the end of a free run.
Called by verdict.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import math

import numpy as np

import decay
import quantities
import told_bodies
import words
from geometry import Scene3d

# (column's last part: change between means that counts as none [m, deg], share of the mean that does). How far a body is from where it is described says
# little of how far it still goes to and fro.
BARS = {"x_m": (0.02, 0.02), "y_m": (0.02, 0.02), "z_m": (0.02, 0.1), "roll_deg": (0.05, 0.1), "pitch_deg": (0.05, 0.1), "yaw_deg": (0.05, 0.1)}
KINDS = (("x_m", "y_m", "z_m"), ("roll_deg", "pitch_deg", "yaw_deg"))
OF_HEIGHT = 0.05   # of a small body: what a change of its heave may be
SLIGHT = 0.01      # of the largest motion of its kind: what nothing drives
HALF_SWING, AT_REST = 0.1, 0.1   # of a motion's range: turns nearer to each other are ripple; a range at the end that is smaller is rest


def spoken(name):
    """'sway' of spar.y_m."""
    return quantities.AXES[quantities.quantity_of(name)]


def values_of(run, name):
    """A motion; of an angle that passes half a turn without the step back by a turn."""
    values = run.column(name)
    return np.unwrap(values, period=360.0) if name.endswith("_deg") and np.isfinite(values).all() else values


def rate_of(name):
    """spar.vx_m_s of spar.x_m."""
    body, _, quantity = name.rpartition(".")
    return f"{body}.v{quantity}_s"


def drifting(run):
    """Columns of motions that nothing brings back, of bodies adrift: no mean of theirs says anything, that of their rate does."""
    return {name for body in told_bodies.adrift(run) for name in (f"{body}.x_m", f"{body}.y_m") if name in run.columns and rate_of(name) in run.columns}


def columns_of(run, body):
    return [name for quantity in BARS if (name := f"{body}.{quantity}") in run.columns]


def _largest(run, name):
    return float(np.nanmax(np.abs(values_of(run, name)), initial=0.0))


def moved(run, body):
    """Columns of the motions that a body has: not those that are small in themselves and beside the largest of their kind."""
    found = []
    for kind in KINDS:
        sizes = {name: _largest(run, name) for name in columns_of(run, body) if name.endswith(kind)}
        found += [name for name, size in sizes.items() if size > run.round_off(name) and size >= min(bar(name), SLIGHT * max(sizes.values()))]
    return found


def bar(name):
    """A change of its mean that counts as none."""
    return BARS[name.rpartition(".")[2]][0]


def _allowed(run, scene, body, name, chosen):
    """The change of a motion that counts as none."""
    least, share = BARS[name.rpartition(".")[2]]
    allowed = max(least, share * abs(words.mean(run.time[chosen], values_of(run, name)[chosen])))
    shaped = scene.corners(body) if name.endswith(".z_m") and body in scene.bodies else []
    return min(allowed, OF_HEIGHT * float(np.ptp(shaped[:, 2]))) if len(shaped) else allowed   # of a small body a small heave is much


def changing(run, bodies, between, chosen, random):
    """[(column, change)] of motions whose means differ by it between the halves of their stretch, `between`. `random`: of those halves differ by chance, as those of a load."""
    scene, found = Scene3d(run), []
    for body in bodies:
        for name in columns_of(run, body):
            values, allowed = values_of(run, name), _allowed(run, scene, body, name, chosen)
            if random:
                allowed = max(allowed, 0.2 * words.deviation(run.time[chosen], values[chosen]))
            if abs(change := between(values)) > allowed:
                found.append((name, change))
    return found


def _half_swings(values, least):
    """How many half periods lie between the turns of a motion, where it comes back by more than `least`; -1 where it does not turn."""
    way = np.diff(values)
    way = np.concatenate([[True], way[:-1] * way[1:] <= 0.0, [True]])   # rows where it may turn
    turns, up, low, high = 0, None, math.inf, -math.inf
    for value in values[way]:
        if up is None:
            low, high = min(low, value), max(high, value)
            up = True if value - low > least else False if high - value > least else None
            farthest = value
        elif (value > farthest) == up:
            farthest = value
        elif abs(value - farthest) > least:
            turns, up, farthest = turns + 1, not up, value
    return turns - 1


def still_swinging(run):
    """(columns of the largest motion of each kind, of bodies that nothing drives, that swings on at the end, and too few times for a period and a damping;
    those that swing often enough, but not as one motion)."""
    if not decay.is_free(run) or len(run.time) < 20:
        return [], []
    scene, few, mixed, chosen = Scene3d(run), [], [], run.mean_range()[0]
    told = {d.column: d for d in decay.decays(run)}
    for body in told_bodies.told(run)[0]:
        for kind in KINDS:
            name = max((n for n in columns_of(run, body) if n.endswith(kind)), key=lambda n: np.ptp(values_of(run, n)), default=None)
            if name is None or not np.isfinite(values := values_of(run, name)).all():
                continue
            whole = float(np.ptp(values))
            if not float(np.ptp(values[chosen])) > max(_allowed(run, scene, body, name, chosen), AT_REST * whole):
                continue
            count = _half_swings(values, HALF_SWING * whole)
            if 0 <= count < decay.LEAST_SWINGS:
                few.append(name)
            elif count > 0 and name not in told:
                mixed.append(name)
    return few, mixed


def decays(run):
    """Free decays that say something: not those of slight motions while a larger one still swings."""
    found = decay.decays(run)
    if not found or not any(still_swinging(run)):
        return found
    scene, chosen = Scene3d(run), run.mean_range()[0]
    return [d for d in found if np.ptp(values_of(run, d.column)) > _allowed(run, scene, d.column.rpartition(".")[0], d.column, chosen)]
