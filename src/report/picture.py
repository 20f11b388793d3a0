"""One picture of a run, for a README or a slide: motions, rotor and tensions on white, as PNG.
Called by spindrift_report.py --png; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import numpy as np

import figures
import quantities
from figures import plt

INK = "#30353b"


def _panels(run):
    """Up to six: (title, [(legend, column)]); surge, heave and pitch first, what is zero throughout left out."""
    bodies = quantities.bodies_of(run.columns)
    body = bodies[0] if bodies else None
    wanted = [(q, [("", f"{body}.{q_name}")]) for q, q_name in (("surge", "x_m"), ("heave", "z_m"), ("pitch", "pitch_deg"))]
    wanted += [("rotor thrust", [("", n)]) for n in run.columns if n.endswith(".thrust_N")]
    for group in quantities.groups(run.columns):
        if group.key == "moorings":
            wanted.append(("mooring tension", group.panels[0][1]))
    for group in quantities.groups(run.columns):
        if group.key == "forces" and group.panels:
            wanted.append(("downwind force by source", group.panels[0][1]))
    kept = []
    for title, lines in wanted:
        lines = [(legend, c) for legend, c in lines if c in run.columns and not figures.is_nothing(run, c)]
        if lines and (len(lines) > 1 or figures.constant([run], lines[0][1]) is None):
            kept.append((title, lines))
    return kept[:6]


def draw(run, path):
    panels = _panels(run)
    if not panels or not len(run.time):
        raise ValueError(f"{run.folder}: history.csv has nothing to draw")
    rows = -(-len(panels) // 2)
    colours = {"axes.edgecolor": "#9aa0a6", "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "text.color": INK,
               "lines.linewidth": 1.3, "font.size": 9.5}
    with plt.rc_context(colours):
        figure, axes = plt.subplots(rows, 2 if len(panels) > 1 else 1, figsize=(9.6, 1.9 * rows + 0.6), squeeze=False, sharex=True,
                                    layout="constrained", facecolor="white")
        for axis, (title, lines) in zip(axes.flat, panels):
            largest = max(np.abs(run.column(c)[np.isfinite(run.column(c))]).max() for _, c in lines)
            unit, factor = quantities.scaled(quantities.unit_of(lines[0][1], run.described), largest)
            for i, (legend, column) in enumerate(lines):
                axis.plot(*figures.envelope(run.time, factor * run.column(column)), color=figures.PALETTE[i % 8], label=legend)
            axis.set_title(f"{title} [{unit}]", loc="left")
            axis.margins(x=0)
            if len(lines) > 1:
                axis.legend(loc="best", fontsize=8, handlelength=1.2, borderpad=0.2, labelspacing=0.2)
        for axis in axes.flat[len(panels):]:
            axis.set_visible(False)
        for axis in axes[-1]:
            axis.set_xlabel("time [s]")
        figure.suptitle(run.title, x=0.005, ha="left", fontweight="semibold")
        figure.savefig(path, dpi=125)
        plt.close(figure)
