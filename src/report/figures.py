"""Figures of a report: matplotlib drawings as inline SVG whose colours follow the page, or as PNG where the SVG would be large.
Called by page.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import base64
import io
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullLocator

import quantities
import verdict

SVG_LIMIT_BYTES = 300_000
MOST_LINES = 4     # of one quantity in a panel; more have a panel each
LONG_LABEL = 14    # letters, beyond which the unit of a panel has a line of its own
BINS = 700  # of the min-max envelope that stands for a long series
# Mid-tones that read on white and on near-black; the page's style sheet refines them for each.
PALETTE = ["#2f7fc1", "#d9772b", "#2f9e6e", "#b5569e", "#8a7a2c", "#4aa5b8", "#c2504d", "#7a7f87"]
INK, GRID = "#808386", "#9a9da1"
DASHES = ["-", (0, (4, 1.6)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5))]
LEGEND_DASHES = ["solid", "dashed", "dotted", "dashed"]   # the same in a legend, which is HTML
TURNING = ("azimuth", "roll", "pitch", "yaw")   # angles that begin anew after a turn

plt.rcParams.update({
    "svg.fonttype": "none", "text.parse_math": False, "font.family": "sans-serif", "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9,
    "xtick.labelsize": 8.5, "ytick.labelsize": 8.5, "legend.fontsize": 8.5, "axes.spines.top": False, "axes.spines.right": False,
    "axes.edgecolor": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "text.color": INK, "grid.color": GRID,
    "grid.linewidth": 0.4, "grid.alpha": 0.35, "axes.grid": True, "axes.linewidth": 0.6, "lines.linewidth": 1.1, "axes.axisbelow": True,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "xtick.major.size": 3, "ytick.major.size": 3, "path.simplify": True,
    "path.simplify_threshold": 0.12, "figure.facecolor": "none", "axes.facecolor": "none", "legend.frameon": False,
    "axes.formatter.useoffset": False, "axes.formatter.limits": (-4, 6),
})


def envelope(time, values):
    """A long series as the least and greatest of each of BINS stretches, in their order in time: no peak is lost."""
    n = len(values)
    if n <= 4 * BINS:
        return time, values
    edges = np.linspace(0, n, BINS + 1).astype(int)   # stretches of equal length, but for one row
    rows = np.minimum(edges[:-1, None] + np.arange(-(-n // BINS)), edges[1:, None] - 1)
    body = values[rows]
    take = lambda which: np.take_along_axis(rows, which[:, None], axis=1)[:, 0]
    low = take(np.argmin(np.where(np.isfinite(body), body, np.inf), axis=1))
    high = take(np.argmax(np.where(np.isfinite(body), body, -np.inf), axis=1))
    kept = np.unique(np.concatenate([low, high, [0, n - 1]]))
    return time[kept], values[kept]


def unwrapped_breaks(time, values):
    """An angle that begins anew after a turn does so without a line across the figure."""
    jumps = np.flatnonzero(np.abs(np.diff(values)) > 180.0) + 1
    return np.insert(time, jumps, time[jumps]), np.insert(values, jumps, np.nan)


def is_nothing(run, column):
    """Zero throughout but for round-off, or not a number at all."""
    values = run.column(column)
    return not np.any(np.abs(values[np.isfinite(values)]) > run.round_off(column))


def constant(runs, column):
    """The one value that the column has at all times in all runs, else None."""
    found = [run.column(column) for run in runs if column in run.columns]
    values = np.concatenate(found)
    if any(len(v) < 2 for v in found) or not np.isfinite(values).all() or np.ptp(values) > 1e-9 * np.abs(values).max():
        return None
    return float(values[0])


def as_html(figure, label):
    """The figure as inline SVG in the page's colours and type, or as PNG where that is too large."""
    out = io.StringIO()
    plt.rcParams["svg.hashsalt"] = label  # ids differ between the figures of a page, and not between runs of this program
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    svg = out.getvalue()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>", "", svg, flags=re.S)
    svg = re.sub(r">\s+<", "><", svg)
    svg = re.sub(r"\s*xmlns(:xlink)?=\"[^\"]*\"", "", svg)
    svg = svg.replace("xlink:href", "href")
    used = set(re.findall(r"#([\w-]+)", svg))
    svg = re.sub(r'\s+id="([^"]*)"', lambda found: found[0] if found[1] in used else "", svg)  # the others repeat from figure to figure
    svg = re.sub(r"(<svg[^>]*?) height=\"[^\"]*\"", r"\1", svg, count=1)
    svg = re.sub(r"(<svg[^>]*?) width=\"[^\"]*\"", r"\1", svg, count=1)
    # A tenth of a point is less than a pixel. In attributes only: text holds the numbers of the axes.
    svg = re.sub(r'="[^"]*\d\.\d\d[^"]*"', lambda found: re.sub(r"(\d\.\d)\d+", r"\1", found[0]), svg)
    svg = re.sub(r"font: (?:bold )?([\d.]+)px [^;\"]*", r"font-size: \1px", svg)
    svg = svg.replace(INK, "currentColor").replace(GRID, "var(--grid)")
    for i, colour in enumerate(PALETTE):
        svg = svg.replace(colour, f"var(--c{i})")
    if len(svg.encode()) <= SVG_LIMIT_BYTES:
        plt.close(figure)
        return svg.replace("<svg", f'<svg role="img" aria-label="{label}"', 1)
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=170)
    plt.close(figure)
    return f'<img alt="{label}" src="data:image/png;base64,{base64.b64encode(picture.getvalue()).decode()}">'


def _panel_lines(runs, lines):
    """(legend, run index, line index, time, values) of what there is to draw."""
    for r, run in enumerate(runs):
        for i, (legend, column) in enumerate(lines):
            if column in run.columns and not is_nothing(run, column):
                yield legend, r, i, run.time, run.column(column)


def _style(lines, run, line):
    """A colour per run where a panel has one line, else per line; a dash per run, so that what lies below is seen, and per round of the colours."""
    coloured = run if len(lines) == 1 else line
    return {"color": PALETTE[coloured % len(PALETTE)], "linestyle": DASHES[(run + (line // len(PALETTE) if len(lines) > 1 else 0)) % len(DASHES)]}


def legend_mark(coloured, dashed):
    """(number of a colour, dash of an HTML border)."""
    return coloured % len(PALETTE), LEGEND_DASHES[dashed % len(LEGEND_DASHES)]


def _limits(axis, drawn):
    """Not to blow up round-off: a series that hardly moves is shown flat."""
    finite = np.concatenate([v[np.isfinite(v)] for v in drawn]) if drawn else np.empty(0)
    if len(finite) == 0:
        return
    low, high = finite.min(), finite.max()
    if high - low < 1e-6 * max(abs(low), abs(high)):
        middle, half = 0.5 * (low + high), 0.5 * max(abs(low), abs(high), 1e-12) * 0.1
        axis.set_ylim(middle - half, middle + half)


class Drawing:
    """A figure (None where nothing is left to draw), its legend {text: legend_mark}, what is zero and what is constant throughout."""

    def __init__(self):
        self.figure, self.legend, self.zero, self.constant = None, {}, [], []


def series(runs, group):
    """A group over time."""
    drawing, panels = Drawing(), []
    for label, lines in group.panels:
        if not any(column in run.columns for run in runs for _, column in lines):
            continue
        if not any(True for _ in _panel_lines(runs, lines)):
            drawing.zero.append(label)
        elif len(lines) == 1 and (value := constant(runs, lines[0][1])) is not None:
            unit, factor = quantities.scaled(quantities.unit_of(lines[0][1], runs[0].described), abs(value))
            drawing.constant.append(f"{label} {factor * value:.6g}" + (f" {unit}" if unit != label else ""))
        else:
            panels.append((label, lines))
    if len(panels) == 1 and group.multiples and len(lines := _moving(runs, panels[0][1])) > MOST_LINES:
        drawing.figure = _multiples(runs, panels[0][0], lines)
    elif panels:
        drawing.figure, drawing.legend = _draw(runs, panels)
    return drawing


def _moving(runs, lines):
    """Those lines that have something to draw in a run."""
    drawn = {i for _, _, i, _, _ in _panel_lines(runs, lines)}
    return [line for i, line in enumerate(lines) if i in drawn]


def _multiples(runs, label, lines):
    """A small panel for each line, all with the same axes."""
    columns = 3
    rows = -(-len(lines) // columns)
    figure, axes = plt.subplots(rows, columns, sharex=True, sharey=True, squeeze=False, figsize=(5.4, 1.15 * rows + 0.4), layout="constrained")
    drawn = [[(r, time, values) for _, r, _, time, values in _panel_lines(runs, [line])] for line in lines]
    unit, factor = quantities.scaled(quantities.unit_of(lines[0][1], runs[0].described), max(np.abs(v[np.isfinite(v)]).max(initial=0.0) for d in drawn for *_, v in d))
    for axis, (legend, column), found in zip(axes.flat, lines, drawn):
        for r, time, values in found:
            axis.plot(*envelope(time, values * factor), **_style([column], r, 0))
        axis.set_title(legend.replace("_", " "), loc="left", fontsize=8.5)
    _limits(axes[0, 0], [v * factor for d in drawn for *_, v in d])
    for axis in axes.flat[len(lines):]:
        axis.set_visible(False)
    for n, axis in enumerate(axes.flat):
        axis.margins(x=0.0)
        axis.xaxis.set_major_locator(MaxNLocator(3))
        axis.yaxis.set_major_locator(MaxNLocator(4))
        axis.tick_params(labelbottom=n + columns >= len(lines))
    figure.supylabel(f"{label} [{unit}]" if unit else label, fontsize=9, color=INK)
    figure.supxlabel(_time_label(runs), fontsize=9, color=INK)
    return figure


def _time_label(runs):
    return "pseudo-step" if verdict.is_steady(runs[0]) else "time [s]"


def _draw(runs, panels):
    several = max(len(lines) for _, lines in panels) > 1
    height = 1.2 * len(panels) + (1.0 if len(panels) == 1 else 0.4)
    figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(5.4, height), layout="constrained")
    legend_entries = {}
    for axis, (label, lines) in zip(axes[:, 0], panels):
        drawn = list(_panel_lines(runs, lines))
        finite = [np.abs(v[np.isfinite(v)]).max(initial=0.0) for *_, v in drawn]
        unit, factor = quantities.scaled(quantities.unit_of(lines[0][1], runs[0].described), max(finite))
        for legend, r, i, time, values in drawn:
            if quantities.quantity_of(lines[i][1]) in TURNING:
                time, values = unwrapped_breaks(time, values)
            x, y = envelope(time, values * factor)
            marker = {"marker": "o", "markersize": 3} if len(x) == 1 else {}
            axis.plot(x, y, **_style(lines, r, i), **marker)
            if several and legend:
                legend_entries[legend] = i
        _limits(axis, [v * factor for *_, v in drawn])
        between = "\n" if len(label) > LONG_LABEL else " "
        axis.set_ylabel(f"{label}{between}[{unit}]" if unit and label != unit else label)
        axis.yaxis.set_major_locator(MaxNLocator(4))
        axis.margins(x=0.0)
    axes[-1, 0].set_xlabel(_time_label(runs))
    figure.align_ylabels()
    return figure, {legend: legend_mark(i, i // len(PALETTE)) for legend, i in sorted(legend_entries.items(), key=lambda entry: entry[1])}


def density(time, values):
    """One-sided power spectral density after Welch (1967, IEEE Trans. Audio Electroacoust. 15, 70-73): three segments of half the length, each overlapping
    the next by half; Hann window, mean removed. (Hz, unit²/Hz), or None if too short."""
    keep = np.isfinite(time) & np.isfinite(values)
    time, values = time[keep], values[keep]
    if len(values) < 64 or time[-1] <= time[0]:
        return None
    step = (time[-1] - time[0]) / (len(time) - 1)
    if np.ptp(np.diff(time)) > 1e-6 * step:
        even = time[0] + step * np.arange(len(time))
        time, values = even, np.interp(even, time, values)
    hop = len(values) // 4
    length, starts = 2 * hop, (0, hop, 2 * hop)
    window = np.hanning(length + 1)[:-1]
    total = np.zeros(hop + 1)
    for start in starts:
        piece = values[start: start + length]
        total += np.abs(np.fft.rfft((piece - piece.mean()) * window)) ** 2
    frequency = np.fft.rfftfreq(length, step)
    return frequency[1:], (2.0 * step / (window ** 2).sum() / len(starts) * total)[1:]


def segment_s(time):
    """Length of the segments that a spectrum of a run is taken over: half of what is left without the first quarter."""
    return 0.375 * (time[-1] - time[0])


def _name_marks(axis, marks, top):
    """Names at the tops of their lines, one below the other where lines stand close."""
    last, down = -np.inf, 0
    for name, mark in sorted(marks.items(), key=lambda entry: entry[1]):
        down = down + 1 if mark - last < 0.12 * top else 0
        last = mark
        axis.annotate(name, (mark, 1.0), xycoords=("data", "axes fraction"), xytext=(2, -1 - 9 * down), textcoords="offset points", fontsize=7.5, va="top")


def spectra(runs, panels, marks):
    """Spectra of motions with lines at `marks` {name: Hz}; None where there is nothing that moves for long enough."""
    ready = []
    for label, column in panels:
        lines = []
        for r, run in enumerate(runs):
            if column not in run.columns or is_nothing(run, column):
                continue
            tail = slice(len(run.time) // 4, None)  # without the start's transient
            found = density(run.time[tail], run.column(column)[tail])
            if found is not None and found[1].max() > 1e-20:
                lines.append((r, *found))
        if lines:
            ready.append((label, column, lines))
    if not ready:
        return None
    figure, axes = plt.subplots(len(ready), 1, squeeze=False, sharex=True, figsize=(5.4, 1.3 * len(ready) + (0.9 if len(ready) == 1 else 0.4)),
                                layout="constrained")
    top = max(_band(f, s) for *_, lines in ready for _, f, s in lines)
    top = max([top] + [1.15 * mark for mark in marks.values() if mark < 3.0 * top])
    for axis, (label, column, lines) in zip(axes.flat, ready):
        for r, frequency, power in lines:
            axis.semilogy(*envelope(frequency, power), color=PALETTE[r % len(PALETTE)], linestyle=DASHES[r % len(DASHES)])
        peak = max(power[frequency <= top].max(initial=1e-300) for _, frequency, power in lines)
        for name, mark in marks.items():
            # A mode is marked where its motion is drawn.
            if mark <= top and (name == label or name not in quantities.AXES.values()):
                axis.axvline(mark, color=INK, linewidth=0.7, linestyle=DASHES[2 if name == label else 1])
        if axis is axes.flat[0]:
            _name_marks(axis, {name: mark for name, mark in marks.items() if mark <= top and name not in quantities.AXES.values()}, top)
        axis.set_xlim(0.0, top)
        axis.set_ylim(peak * 1e-6, peak * 5.0)
        axis.set_ylabel(f"{label} [{quantities.unit_of(column)}²/Hz]")
        axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: power_of_ten(value)))
        axis.yaxis.set_minor_locator(NullLocator())
    axes[-1, 0].set_xlabel("frequency [Hz]")
    figure.align_ylabels()
    return figure


def campbell(rows, wave_Hz, rpm, blades):
    """Frequencies over the rotor's speed, logarithmic: modes [(name, Hz)] and waves lie flat, the rotor's turning and its blades' passing rise; marked is the speed
    of the run."""
    figure, axis = plt.subplots(figsize=(5.4, 3.4), layout="constrained")
    fastest, flat = 1.3 * rpm, [f for _, f in rows] + ([wave_Hz] if wave_Hz else [])
    low, top = 0.6 * min(flat + [0.1 * rpm / 60.0]), 2.0 * max(blades * fastest / 60.0, 0.0)
    speeds = np.linspace(0.01, 1.0, 200) * fastest
    for n, (name, times) in enumerate((("1P", 1), (f"{blades}P", blades))):
        axis.semilogy(speeds, times * speeds / 60.0, color=PALETTE[n])
        axis.annotate(name, (0.97 * fastest, times * 0.97 * fastest / 60.0), xytext=(0, 3), textcoords="offset points", ha="right", fontsize=7.5)
    if wave_Hz:
        axis.axhline(wave_Hz, color=PALETTE[4], linestyle=DASHES[1])
    together = []   # modes that lie too near to be named one by one: [(frequency of the first, names)]
    for name, frequency in sorted(rows + ([("waves", wave_Hz)] if wave_Hz else []), key=lambda row: row[1]):
        if frequency >= top:
            continue
        if name != "waves":
            axis.axhline(frequency, color=INK, linewidth=0.7)
        if together and np.log(frequency / together[-1][0]) < 0.07 * np.log(top / low):
            together[-1][1].append(name)
        else:
            together.append((frequency, [name]))
    for frequency, names in together:
        highest = max(f for name, f in rows + [("waves", wave_Hz or 0.0)] if name in names)
        axis.annotate(", ".join(names), (0.97 * fastest, highest), xytext=(0, 1.5), textcoords="offset points", fontsize=7.5, ha="right")
    axis.axvline(rpm, color=INK, linewidth=0.7, linestyle=DASHES[2])
    axis.set_xlim(0.0, fastest)
    axis.set_ylim(low, top)
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: power_of_ten(value)))
    axis.yaxis.set_minor_locator(NullLocator())
    axis.set_xlabel("rotor speed [rpm]")
    axis.set_ylabel("frequency [Hz]")
    return figure


def timeline(tasks, count=400):
    """What each thread did, task by task, in a stretch of about `count` tasks from the middle of a trace: (figure, {module: legend_mark})."""
    starts, ends = np.array([t[0] for t in tasks]), np.array([t[1] for t in tasks])
    order = np.argsort(starts)
    middle = order[max(0, len(order) // 2 - count // 2): len(order) // 2 + (count + 1) // 2]
    begin, end = starts[middle].min(), starts[middle].max()
    shown = [tasks[n] for n in np.flatnonzero((ends > begin) & (starts < end))]
    total = {}
    for start, stop, module, _ in shown:
        total[module] = total.get(module, 0.0) + min(stop, end) - max(start, begin)
    modules = sorted(total, key=lambda m: -total[m])[:len(PALETTE)]
    threads = sorted({t[3] for t in shown}, key=str)[:16]
    figure, axis = plt.subplots(figsize=(5.4, 0.42 * len(threads) + 0.9), layout="constrained")
    for row, thread in enumerate(threads):
        for m, module in enumerate(modules):
            bars = [(1e3 * (max(s, begin) - begin), 1e3 * (min(e, end) - max(s, begin))) for s, e, what, where in shown if where == thread and what == module]
            axis.broken_barh(bars, (row - 0.36, 0.72), color=PALETTE[m], linewidth=0)
    axis.set_yticks(range(len(threads)), [f"rank {rank}, thread {thread}" for rank, thread in threads])
    axis.set_xlim(0.0, 1e3 * (end - begin))
    axis.set_xlabel("time [ms]")
    axis.grid(axis="y", visible=False)
    axis.invert_yaxis()
    return figure, {module: legend_mark(m, 0) for m, module in enumerate(modules)}


def power_of_ten(value):
    """'10⁻³' as plain text: names with dollar signs rule out matplotlib's own mathematics."""
    return "10" + str(round(np.log10(value))).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def _band(frequency, power):
    """Frequency up to which a figure is worth drawing: thrice that below which 99 % of the variance lies."""
    below = np.cumsum(power)
    return min(frequency[-1], max(3.0 * frequency[np.searchsorted(below, 0.99 * below[-1])], 20.0 * frequency[0]))
