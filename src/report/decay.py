"""Free decays: period and damping of a motion that swings by itself, from its peaks. Called by page.py and study_measures.py; tested in tests/src/report.
SPDX-License-Identifier: Apache-2.0"""
import functools
import math

import numpy as np

import quantities

LEAST_SWINGS = 4   # half periods whose ranges are compared
SMALLEST = 0.02    # of the first range: what is smaller is noise or another motion
GROWTH = 1.002     # of the ranges of a motion without damping: peaks between rows are known so well
DIFFER = 1.5       # times: damping of the first and of the last swings that is not one
SLIGHT_LOAD = 1e-5  # of the bodies' weight: a rotor's thrust that is nothing
STANDS = 1e-3      # rpm: a rotor that turns no faster stands
SCATTER = 0.3      # of the mean decrement: what the decrements of one motion may be off a line over the swing by


class Decay:
    """Of one motion: `period` [s], `damping` (of critical) with its value over the first and the last swings, `swings` (half periods) it is taken from.
    `falling`: damping falls with the swing, as drag has it; `several`: the swings do not fall as those of one motion. No single damping holds then."""

    def __init__(self, column, period, damping, first, last, swings):
        self.column, self.period, self.damping, self.first, self.last, self.swings = column, period, damping, first, last, swings
        self.falling = self.several = False


def extremes(time, values):
    """(times, values) of the peaks and troughs, alternating, each by a parabola through three rows."""
    rate = np.diff(values)
    kept = np.flatnonzero(np.concatenate([[True], rate != 0.0]))   # rows that stand still tell nothing
    time, values = time[kept], values[kept]
    turn = np.flatnonzero(np.diff(values)[:-1] * np.diff(values)[1:] < 0.0) + 1
    at, height = [], []
    for i in turn:
        t, v = time[i - 1: i + 2], values[i - 1: i + 2]
        a, b, c = np.polyfit(t - t[1], v, 2)
        at.append(t[1] - b / (2.0 * a)), height.append(c - b * b / (4.0 * a))
    return np.array(at), np.array(height)


def swings(time, values):
    """Times of the peaks and troughs and the ranges between them, up to the first range that is too small."""
    at, height = extremes(time, values)
    ranges = np.abs(np.diff(height))
    small = np.flatnonzero(ranges < SMALLEST * ranges[:1])
    count = small[0] if len(small) else len(ranges)
    return at[: count + 1], ranges[:count]


def decay_of(time, values, column=""):
    """None where the values are not one motion that swings out, or goes on without damping. Ranges from peak to trough need no rest position; their logarithm falls by
    pi zeta / sqrt(1 - zeta^2) a half period (the logarithmic decrement)."""
    if len(time) < 20 or not np.isfinite(values).all():
        return None
    at, ranges = swings(time, values)
    count = len(ranges)
    if count < LEAST_SWINGS:
        return None
    halves = np.diff(at)
    if ranges[-1] > GROWTH * ranges[0] or (ranges[1:] > 1.05 * ranges[:-1]).any() or np.ptp(halves) > 0.5 * np.median(halves):
        return None
    if ranges[-1] > ranges[0] / GROWTH:   # neither grows nor falls by more than the rows can tell
        ranges = np.full(count, ranges[0])
    falls = -np.diff(np.log(ranges))
    zeta = lambda fall: fall / math.hypot(math.pi, fall)
    part = max(1, len(falls) // 3)
    found = Decay(column, 2.0 * float((at[-1] - at[0]) / (len(at) - 1)), zeta(float(np.log(ranges[0] / ranges[-1]) / len(falls))), zeta(float(falls[:part].mean())),
                  zeta(float(falls[-part:].mean())), len(ranges))
    unlike = max(found.first, found.last) > DIFFER * min(found.first, found.last) + zeta(math.log(GROWTH))
    found.several = _off_line(falls, np.sqrt(ranges[1:] * ranges[:-1])) > SCATTER * falls.mean() + math.log(GROWTH) or (unlike and found.last > found.first)
    found.falling = unlike and not found.several
    return found


def _off_line(falls, sizes):
    """Root mean square of what decrements are off a line over the swing, a + b size: a of linear damping, b of quadratic drag, neither below zero."""
    (a, b), *_ = np.linalg.lstsq(np.column_stack([np.ones_like(sizes), sizes]), falls, rcond=None)
    if b < 0.0:
        a, b = falls.mean(), 0.0
    elif a < 0.0:
        a, b = 0.0, float(falls @ sizes / (sizes @ sizes))
    return float(np.sqrt(np.mean((falls - a - b * sizes) ** 2)))


def is_driven(joint):
    """Does a driver move it?"""
    drivers = [joint[kind] for kind in ("rotation", "translation") if isinstance(joint.get(kind), dict)]
    return any(value for driver in drivers for key, value in driver.items() if key not in ("period_s", "phase_deg"))


def slight_thrust(run):
    """What a thrust must exceed to count [N]: a share of the weight of the scene's bodies; 0 where none has a mass."""
    masses = [body.get("mass_kg") for body in (run.scene.get("bodies") or {}).values() if isinstance(body, dict)]
    gravity = (run.scene.get("environment") or {}).get("gravity_m_s2", 9.80665)
    return SLIGHT_LOAD * gravity * sum(mass for mass in masses if isinstance(mass, (int, float)))


def _rotors_rest(run):
    """Do all rotors stand in air that stands, without a thrust? What the motion itself makes of drag has no mean, and damps as water does."""
    wind = run.scene.get("wind") or {}
    if wind.get("speed_m_s", 0.0) != 0.0 or any(wind.get(key) for key in ("table", "turbulence", "event")):
        return not quantities.rotors_of(run.columns)
    for rotor in quantities.rotors_of(run.columns):
        speed, thrust = run.column(f"{rotor}.rpm") if f"{rotor}.rpm" in run.columns else np.array([math.inf]), run.column(f"{rotor}.thrust_N")
        if not np.abs(speed).max(initial=0.0) <= STANDS or not abs(thrust.sum()) <= slight_thrust(run) * len(thrust):
            return False
    return True


def is_free(run):
    """Nothing drives the bodies of the scene for good: no waves, no wind on a rotor and none that turns, no paddle, no joint's driver."""
    scene, waves = run.scene, run.scene.get("waves") or {}
    wavy = waves.get("model") not in (None, "none") and waves.get("height_m", math.inf) > 0.0   # those of a file have no height
    paddle = isinstance(scene.get("sea"), dict) and bool(scene["sea"].get("wavemaker"))
    driven = any(is_driven(joint) for joint in (scene.get("joints") or {}).values() if isinstance(joint, dict))
    return not wavy and not paddle and not driven and _rotors_rest(run)


@functools.lru_cache(maxsize=8)
def decays(run):
    """Of each motion of the run's bodies that swings out freely; small motions beside a large one are left out."""
    if not is_free(run) or len(run.time) < 20:
        return []
    found = []
    for body in quantities.bodies_of(run.columns):
        for kind in (("x_m", "y_m", "z_m"), ("roll_deg", "pitch_deg", "yaw_deg")):
            names = [f"{body}.{quantity}" for quantity in kind if f"{body}.{quantity}" in run.columns]
            largest = max((float(np.ptp(run.column(n))) for n in names), default=0.0)
            for name in names:
                if np.ptp(run.column(name)) >= 0.05 * largest > run.round_off(name) and (swung := decay_of(run.time, run.column(name), name)):
                    found.append(swung)
    return found
