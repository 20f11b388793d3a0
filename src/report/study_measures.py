"""What a study computes, as plain functions of numbers: quantities of a history, the difference of two histories, intervals of
paired differences, Richardson's limit, the front of error against cost.

Rainflow counting after ASTM E1049-85 (the three-point rule), damage-equivalent range at 1 Hz; limits after Roache (1994), with
the order that three levels show; intervals after Student (1908). Called by study_judge.py; tested in
tests/src/report/study_measures_test.py. SPDX-License-Identifier: Apache-2.0"""
import math

import numpy as np

import decay
from words import deviation, mean

OF_TWO_HISTORIES = ("rms", "max")


def cut(time, value, from_s, until_s):
    """The part within [from_s, until_s]; both ends kept."""
    low = np.searchsorted(time, from_s - 1e-9 * max(1.0, abs(from_s)))
    high = len(time) if until_s is None else np.searchsorted(time, until_s + 1e-9 * max(1.0, abs(until_s)), side="right")
    return time[low:high], value[low:high]


def harmonic(t, x, frequency_Hz):
    """Amplitude and phase [deg] of a cos(w t - phase) in mean + a cos + b sin, fitted by least squares."""
    w = 2.0 * math.pi * frequency_Hz
    (_, c, s), *_ = np.linalg.lstsq(np.column_stack([np.ones_like(t), np.cos(w * t), np.sin(w * t)]), x, rcond=None)
    return math.hypot(c, s), math.degrees(math.atan2(s, c))


def upward_crossings(t, x):
    """Times at which x rises through zero, by straight lines."""
    up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    return t[up] - x[up] * (t[up + 1] - t[up]) / (x[up + 1] - x[up])


def period(t, x):
    """Of a decay as in the report, else the mean time between upward crossings of the mean; nan where there are fewer than two. A decay's
    mean is crossed no more where it has died out, but by any ripple."""
    if found := decay.decay_of(t, x):
        return found.period
    times = upward_crossings(t, x - mean(t, x))
    return float((times[-1] - times[0]) / (len(times) - 1)) if len(times) > 1 else math.nan


def extremes(x):
    """Values where x turns, ends included."""
    steps = np.diff(x)
    keep = np.concatenate([[True], steps != 0.0])
    x = x[keep]
    if len(x) < 3:
        return x
    turns = np.flatnonzero(np.diff(np.sign(np.diff(x))) != 0) + 1
    return x[np.concatenate([[0], turns, [len(x) - 1]])]


def damping(t, x):
    """Damping ratio from the slope of the logarithm of successive half-swings of a decay, those of the report; nan where there are fewer
    than three."""
    _, swings = decay.swings(t, x)
    if len(swings) < 3:
        return math.nan
    slope = np.polyfit(np.arange(len(swings)), np.log(swings), 1)[0]
    return float(-slope / math.hypot(math.pi, slope))


def rainflow(x):
    """(range, count) of every cycle; what is left counts as halves."""
    stack, cycles = [], []
    for value in extremes(np.asarray(x, float)):
        stack.append(value)
        while len(stack) >= 3:
            latest, before = abs(stack[-1] - stack[-2]), abs(stack[-2] - stack[-3])
            if latest < before:
                break
            if len(stack) == 3:
                cycles.append((before, 0.5))
                stack.pop(0)
            else:
                cycles.append((before, 1.0))
                del stack[-3:-1]
    cycles += [(abs(b - a), 0.5) for a, b in zip(stack, stack[1:])]
    return cycles


def damage_equivalent(t, x, exponent):
    """The range that, once a second, does the damage of the history: (sum n r^m / T)^(1/m)."""
    total = sum(count * size**exponent for size, count in rainflow(x))
    return float((total / (t[-1] - t[0])) ** (1.0 / exponent))


def quantity(metric, t, x):
    """The number that `metric` takes from one history; nan where it has none."""
    t, x = cut(t, x, metric["from_s"], metric["until_s"])
    if len(t) < 2 or not np.all(np.isfinite(x)):
        return math.nan
    measures = {"mean": lambda: mean(t, x), "last": lambda: float(x[-1]), "deviation": lambda: deviation(t, x),
                "peak": lambda: float(np.max(np.abs(x))), "period": lambda: period(t, x), "damping": lambda: damping(t, x),
                "amplitude": lambda: harmonic(t, x, metric["frequency_Hz"])[0],
                "phase": lambda: harmonic(t, x, metric["frequency_Hz"])[1],
                "damage": lambda: damage_equivalent(t, x, metric["wohler_exponent"])}
    return measures[metric["measure"]]()


def difference(metric, t, x, t_ref, x_ref):
    """Of two histories (rms, max), over the time both cover, the reference interpolated; nan where they do not meet."""
    until = min(t[-1], t_ref[-1]) if metric["until_s"] is None else metric["until_s"]
    t, x = cut(t, x, max(metric["from_s"], t_ref[0]), min(until, t_ref[-1]))
    if len(t) < 2 or not np.all(np.isfinite(x)):
        return math.nan
    gap = x - np.interp(t, t_ref, x_ref)
    return math.sqrt(mean(t, gap**2)) if metric["measure"] == "rms" else float(np.max(np.abs(gap)))


def wrapped(degrees):
    return (degrees + 180.0) % 360.0 - 180.0


def gap(metric, a, b):
    """Of two quantities; of two phases the shorter way round."""
    return wrapped(a - b) if metric["measure"] == "phase" else a - b


def unwrapped(metric, values):
    """Quantities that can be averaged: phases within half a turn of the first that is known."""
    first = next((v for v in values if math.isfinite(v)), 0.0)
    return [first + gap(metric, v, first) for v in values]


def student_cdf(t, freedom):
    """Probability below t of Student's distribution with an integer number of degrees of freedom (closed form, Abramowitz & Stegun
    26.7.3 and 26.7.4); above 200 the normal one."""
    if math.isinf(t):
        return 1.0 if t > 0 else 0.0
    if freedom > 200:
        return 0.5 * math.erfc(-t / math.sqrt(2.0))
    angle = math.atan2(t, math.sqrt(freedom))
    cosine, term, total = math.cos(angle), 1.0, 0.0
    if freedom % 2:
        if freedom > 1:
            term = cosine
            for k in range(1, (freedom - 1) // 2 + 1):
                total += term
                term *= cosine**2 * 2 * k / (2 * k + 1)
        area = 2.0 / math.pi * (angle + math.sin(angle) * total)
    else:
        for k in range(1, freedom // 2 + 1):
            total += term
            term *= cosine**2 * (2 * k - 1) / (2 * k)
        area = math.sin(angle) * total
    return 0.5 * (1.0 + area)


def student_quantile(probability, freedom):
    low, high = -1e6, 1e6
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if student_cdf(middle, freedom) < probability else (low, middle)
    return 0.5 * (low + high)


class Estimate:
    """A mean of paired differences: `value`, its standard error (None: no replicas, none known), degrees of freedom, and what else it
    may be off by for sure (`allowance`, of a limit). `lender`: the rung whose scatter stands in for its own; `against`: the rung against
    which that scatter was found, where it is not the reference."""

    def __init__(self, value, error=None, freedom=0, allowance=0.0, count=1):
        self.value, self.error, self.freedom = value, error, freedom
        self.allowance, self.count = allowance, count
        self.lender = self.against = None

    def take(self, scatter, lender):
        """The standard error of a mean of `count` differences with that scatter."""
        self.error, self.freedom = scatter.deviation / math.sqrt(max(1, self.count)), scatter.freedom
        self.lender, self.against = lender, scatter.against

    def half(self, confidence):
        """Half the width of the interval."""
        if self.error is None:
            return self.allowance
        if self.error == 0.0:
            return self.allowance
        return self.allowance + self.error * student_quantile(0.5 + 0.5 * confidence, self.freedom)

    def interval(self, confidence):
        return self.value - self.half(confidence), self.value + self.half(confidence)

    def size_interval(self, confidence):
        """Of its absolute value."""
        low, high = self.interval(confidence)
        return (0.0 if low <= 0.0 <= high else min(abs(low), abs(high))), max(abs(low), abs(high))

    def within(self, target):
        """Confidence that the true absolute value is at most `target`; 0 or 1 where nothing is known of the scatter."""
        room_above, room_below = target - self.allowance - self.value, target - self.allowance + self.value
        if not self.error:
            return 1.0 if room_above >= 0.0 and room_below >= 0.0 else 0.0
        inside = student_cdf(room_above / self.error, self.freedom) - student_cdf(-room_below / self.error, self.freedom)
        return max(0.0, inside)


class Scatter:
    """Standard deviation of single paired differences and its degrees of freedom; `against`: as of an Estimate."""

    def __init__(self, deviation, freedom, against=None):
        self.deviation, self.freedom, self.against = deviation, freedom, against

    @classmethod
    def of(cls, estimate, against=None):
        return cls(estimate.error * math.sqrt(estimate.count), estimate.freedom, against)


def estimate(differences):
    """Of paired differences, one per replica."""
    d = np.asarray(differences, float)
    if len(d) < 2:
        return Estimate(float(d[0]) if len(d) else math.nan, count=len(d))
    return Estimate(float(np.mean(d)), float(np.std(d, ddof=1) / math.sqrt(len(d))), len(d) - 1, count=len(d))


def all_within(confidences):
    """Confidence that all hold, whatever their dependence (Bonferroni)."""
    return max(0.0, 1.0 - sum(1.0 - c for c in confidences))


def richardson(h, q):
    """Limit of q(h) = q0 + c h^p from the three finest levels: (q0, p, allowance, why). `h` ascending: finest first. Where the three do not
    converge in order (p outside 0.5 ... 8, or no sign kept), the finest is taken with three times their range as allowance."""
    (h1, h2, h3), (q1, q2, q3) = h[:3], q[:3]
    d21, d32 = q2 - q1, q3 - q2
    spread = max(q[:3]) - min(q[:3])
    if spread <= 1e-13 * max(abs(v) for v in q[:3]):
        return q1, math.nan, 0.0, "the three finest agree to round-off"
    if d21 == 0.0 or d32 / d21 <= 0.0:
        return q1, math.nan, 3.0 * spread, "the three finest do not approach a limit from one side"

    def mismatch(p):
        return (h3**p - h2**p) / (h2**p - h1**p) - d32 / d21

    low, high = 0.05, 12.0
    if mismatch(low) * mismatch(high) > 0.0:
        return q1, math.nan, 3.0 * spread, "the three finest show no order"
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if mismatch(low) * mismatch(middle) > 0.0 else (low, middle)
    p = 0.5 * (low + high)
    if not 0.5 <= p <= 8.0:
        return q1, p, 3.0 * spread, f"the three finest show order {p:.2g}, which is no order of a scheme"
    correction = -d21 / ((h2 / h1) ** p - 1.0)
    return q1 + correction, p, 0.25 * abs(correction), ""


def front(errors, costs):
    """Indices that no other one beats in both, cheapest first."""
    best = [i for i in range(len(errors)) if math.isfinite(errors[i]) and not any(
        errors[j] <= errors[i] and costs[j] <= costs[i] and (errors[j] < errors[i] or costs[j] < costs[i]) for j in range(len(errors)))]
    return sorted(best, key=lambda i: costs[i])
