"""Where the time of a window goes, placement by placement: core-seconds by part as bars, busy cores over the window as areas.
Usage: spindrift_timeline.py FIGURES.json --out FILE.png|FILE.html, with the figures of `spindrift replay --json` or of a profile.
Started by report.cpp; tested in tests/src/report/timeline_test.py. SPDX-License-Identifier: Apache-2.0"""
import argparse
import json
import pathlib
import sys

import numpy as np

WAITING, OTHER = "waiting", ("between graphs", "runtime", "messages", "start-up", "output")
DRAWN = 8  # timelines at most


def entries_of(figures):
    found = figures.get("predictions") or figures.get("modes")
    if not found:
        raise ValueError("holds neither predictions nor modes with figures")
    return found


def name_of(entry):
    split = f" ({entry['ranks'] - entry['air_ranks']} sea, {entry['air_ranks']} air)" if entry.get("air_ranks") else ""
    return f"{entry['placement']}, {entry['ranks']} x {entry['threads']}{split}"


def parts_of(entries):
    """Names of the parts: modules in the order of their time, then what is no module, waiting last."""
    total = {}
    for entry in entries:
        for part, seconds in entry["parts_core_s"].items():
            total[part] = total.get(part, 0.0) + seconds
    modules = sorted((p for p in total if p != WAITING and p not in OTHER), key=lambda p: -total[p])
    return modules + [p for p in OTHER if total.get(p, 0.0) > 0.0] + [WAITING]


def colours_of(parts, figures):
    palette = figures.PALETTE[:7]
    return {part: "#c9ccd1" if part == WAITING else palette[n % len(palette)] for n, part in enumerate(parts)}


def draw_bars(axis, entries, parts, colours):
    rows = np.arange(len(entries))[::-1]
    left = np.zeros(len(entries))
    for part in parts:
        width = np.array([1e3 * entry["parts_core_s"].get(part, 0.0) for entry in entries])
        axis.barh(rows, width, left=left, color=colours[part], height=0.66, label=part)
        left += width
    for row, entry, end in zip(rows, entries, left):
        axis.annotate(f"{1e3 * entry['wall_s']:.4g} ms, {100 * entry['efficiency']:.3g} %", (end, row), xytext=(4, 0),
                      textcoords="offset points", va="center", fontsize=8)
    axis.set_yticks(rows, [name_of(entry) for entry in entries])
    axis.set_xlim(0.0, 1.28 * left.max())
    axis.set_xlabel("core-ms of a window; beside the bars its time and efficiency")
    axis.grid(axis="y", visible=False)


def draw_timeline(axis, entry, parts, colours):
    line = entry["timeline"]
    modules = [part for part in parts if part in line["busy"]]
    count = len(next(iter(line["busy"].values())))
    time = 1e3 * line["bin_s"] * np.arange(count + 1)
    axis.stackplot(time, [line["busy"][m] + [0.0] for m in modules], colors=[colours[m] for m in modules], linewidth=0, step="post")
    cores = entry["ranks"] * entry["threads"]
    axis.axhline(cores, color="#808386", linewidth=0.7)
    axis.set_ylim(0.0, 1.08 * cores)
    axis.set_xlim(0.0, 1e3 * line["bin_s"] * count)
    axis.set_title(name_of(entry), loc="left")
    axis.set_ylabel("busy cores")


def draw(figures_of_run, figures):
    """The bars, and below them the timelines on one scale of time."""
    entries = entries_of(figures_of_run)
    parts = parts_of(entries)
    colours = colours_of(parts, figures)
    lines = [entry for entry in entries if entry.get("timeline", {}).get("busy")][:DRAWN]
    heights = [0.32 * len(entries) + 0.9] + [1.15] * len(lines)
    figure, axes = figures.plt.subplots(len(heights), 1, squeeze=False, figsize=(8.2, sum(heights) + 0.5), layout="constrained",
                                        gridspec_kw={"height_ratios": heights})
    draw_bars(axes[0, 0], entries, parts, colours)
    longest = max((1e3 * e["timeline"]["bin_s"] * len(next(iter(e["timeline"]["busy"].values()))) for e in lines), default=0.0)
    for axis, entry in zip(axes[1:, 0], lines):
        draw_timeline(axis, entry, parts, colours)
        axis.set_xlim(0.0, longest)
    axes[-1, 0].set_xlabel("time in the window's graphs [ms]" if lines else axes[-1, 0].get_xlabel())
    handles, labels = axes[0, 0].get_legend_handles_labels()
    axes[0, 0].legend(handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=min(7, len(labels)), borderaxespad=0.2)
    return figure


def table(entries, parts, page):
    head = "".join(f"<th>{page.escape(part)} [%]</th>" for part in parts)
    rows = ""
    for entry in entries:
        cores = entry["ranks"] * entry["threads"] * entry["wall_s"]
        shares = "".join(f"<td>{100 * entry['parts_core_s'].get(part, 0.0) / cores:.1f}</td>" for part in parts)
        rows += (f"<tr><td class=text>{page.escape(name_of(entry))}</td><td>{1e3 * entry['wall_s']:.4g}</td>"
                 f"<td>{100 * entry['efficiency']:.1f}</td>{shares}</tr>")
    return (f'<div class="scroll"><table><thead><tr><th class=text>placement, ranks x threads</th><th>window [ms]</th><th>efficiency [%]</th>'
            f"{head}</tr></thead><tbody>{rows}</tbody></table></div>")


def build_page(figures_of_run, figures, page):
    entries = entries_of(figures_of_run)
    kind = "Replay of" if figures_of_run["kind"] == "replay" else "Profile of"
    title = f"{kind} {pathlib.Path(figures_of_run['title']).stem}"
    style = (pathlib.Path(__file__).parent / "style.css").read_text(encoding="utf-8")
    sentences = "".join(f"<li>{page.escape(text)}</li>" for text in figures_of_run.get("sentences", []))
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{page.escape(title)}</title><style>{style}</style></head><body><main><header><h1>{page.escape(title)}</h1>"
            f"<p class=facts>Parts are core-seconds of a window; waiting is time of a core without work. Efficiency is work done over all core-seconds.</p>"
            + (f"<ul>{sentences}</ul>" if sentences else "") + "</header>"
            f"<section>{table(entries, parts_of(entries), page)}</section>"
            f'<section class="figures"><figure class="wide"><div class="scroll">{figures.as_html(draw(figures_of_run, figures), "Where the time of a window goes")}'
            f"</div></figure></section></main></body></html>")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figures", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    try:
        import figures
        import page
    except ModuleNotFoundError as missing:
        sys.exit(f"{missing.name} is missing; ci/setup installs it (python3-{missing.name})")
    try:
        read = json.loads(arguments.figures.read_text(encoding="utf-8"))
        if arguments.out.suffix == ".html":
            arguments.out.write_text(build_page(read, figures, page), encoding="utf-8")
        else:
            with figures.plt.rc_context({"text.color": "#30353b", "axes.labelcolor": "#30353b", "xtick.color": "#30353b", "ytick.color": "#30353b"}):
                draw(read, figures).savefig(arguments.out, dpi=150, facecolor="white")
    except (ValueError, KeyError) as wrong:
        print(f"{arguments.figures}: {wrong}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
