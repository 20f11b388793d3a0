"""Numbers and stretches of time in words. Called by page.py, verdict.py and study_page.py. SPDX-License-Identifier: Apache-2.0"""
import math
import re

import numpy as np

LEVEL = re.compile(r"\d{4}-\d\d-\d\d [\d:.]+ (\w+) +(.*)")   # of a line of log.txt that begins a message: its level, its words


def number(value, digits=4):
    if isinstance(value, bool) or not isinstance(value, (int, float, np.floating, np.integer)) or not math.isfinite(value):
        return "–"
    rounded = f"{value:.{digits - 1}e}"
    exponent = int(rounded.partition("e")[2])
    if value == 0 or -3 <= exponent < 6:
        rounded = f"{value:.{max(0, digits - 1 - exponent)}f}" if value else "0"
    else:
        rounded = f"{rounded.partition('e')[0]}e{exponent}"
    return rounded.replace("-", "−")


def short(seconds):
    """'8.1 ms', '1.2 s': of a physical time."""
    return f"{number(1e3 * seconds, 2)} ms" if seconds < 0.1 else f"{number(seconds, 2)} s"


def duration(seconds):
    """'0.62 s', '2 min 5 s', '3 h 10 min'."""
    if seconds < 100:
        return f"{number(seconds, 3)}\u00a0s"
    if seconds < 7200:
        return f"{int(seconds) // 60} min {int(seconds) % 60} s"
    return f"{int(seconds) // 3600} h {int(seconds) % 3600 // 60} min"


def mean(time, values):
    """Trapezoidal mean over time, as in summary.json."""
    if len(values) == 0:
        return math.nan
    return float(np.trapz(values, time) / (time[-1] - time[0])) if len(values) > 1 and time[-1] > time[0] else float(values[-1])


def deviation(time, values):
    """Standard deviation about that mean, weighted alike."""
    if len(values) == 0:
        return math.nan
    return math.sqrt(max(0.0, mean(time, (values - mean(time, values)) ** 2)))
