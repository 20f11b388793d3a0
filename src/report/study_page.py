"""The page of a study, from its study.json: error against cost of every run, the front, the cheapest run within the targets.
Called by spindrift_report.py; tested in tests/src/report/report_test.py. SPDX-License-Identifier: Apache-2.0"""
import json
import math
import pathlib

import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

import figures
import html_page
from html_page import parts, safe, section
from words import number


def plain(value):
    """0.02, 5, 300 or 10⁻⁵ on a logarithmic axis."""
    if 1e-3 <= value < 1e4:
        return f"{value:g}"
    mantissa, exponent = f"{value:e}".split("e")
    return ("" if float(mantissa) == 1.0 else f"{float(mantissa):g}·") + figures.power_of_ten(10.0 ** int(exponent))


def _logarithmic(axis, values):
    """Ticks in plain numbers, finer where the values span little; room at both ends for the marks."""
    low, high = min(values), max(values)
    decades = math.log10(high / low) if high > low else 0.0
    axis.set_major_locator(LogLocator(subs=(1.0,) if decades > 3.0 else (1.0, 2.0, 5.0) if decades > 0.7 else tuple(range(1, 10))))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    room = 10.0 ** max(0.06, 0.08 * decades)
    return low / room, high * room


def _drawing(study, metric):
    """Runs with a positive error, which is what a logarithmic axis can show, by their number in the table; the front joined."""
    drawn = [(run["core_seconds"], run["errors"][metric["name"]], number, run) for number, run in enumerate(study["runs"], 1)
             if (run.get("errors", {}).get(metric["name"]) or 0.0) > 0.0 and run["core_seconds"] > 0.0]
    if not drawn:
        return None
    figure, axis = plt.subplots(figsize=(7.0, 3.6), layout="constrained")
    front = sorted((cost, error) for cost, error, _, run in drawn if run["on_front"])
    axis.loglog([c for c, _ in front], [e for _, e in front], "-", color=figures.PALETTE[0], linewidth=0.9)
    for cost, error, place, run in drawn:
        on = run["on_front"]
        axis.loglog(cost, error, "o", color=figures.PALETTE[0 if on else 7], markersize=6 if on else 4)
        axis.annotate(str(place), (cost, error), textcoords="offset points", xytext=(5, 4), fontsize=8)
    heights = [error for _, error, *_ in drawn]
    if metric.get("target"):
        axis.axhline(metric["target"], color=figures.PALETTE[6], linestyle="--", linewidth=0.9)
        heights.append(metric["target"])
    axis.set_xlim(_logarithmic(axis.xaxis, [cost for cost, *_ in drawn]))
    axis.set_ylim(_logarithmic(axis.yaxis, heights))
    axis.set_xlabel("cost [core-seconds]")
    axis.set_ylabel(f"{metric['name']}: error")
    caption = f"Error of {metric['column']} against cost; numbers are those of the table. The front is joined: nothing is both cheaper and nearer."
    caption += " Dashed: the target." if metric.get("target") else ""
    return parts.figure(metric["name"], None, safe(figures.as_html(figure, f"Error of {metric['name']} against cost")), caption)


def _table(study):
    metrics = study.get("metrics", [])
    rows = [[f"{place} {run['name']}", number(run["core_seconds"])]
            + [number(run.get("errors", {}).get(m["name"]) if run.get("errors") else math.nan) for m in metrics]
            + ["on the front" if run["on_front"] else "" if run["exit_code"] == 0 else run["exit_reason"]]
            for place, run in enumerate(study["runs"], 1)]
    return parts.table(["Run", "Core-seconds"] + [m["name"] for m in metrics] + [""], rows)


def verdict(study):
    best, failed = study.get("cheapest_within_targets"), [r["name"] for r in study["runs"] if r["exit_code"] != 0]
    targets = any(m.get("target") for m in study.get("metrics", []))
    text = (f"Cheapest run within every target: {best}" if best else "No run meets every target" if targets
            else "No targets were set: the front is below")
    level = "bad" if failed and len(failed) == len(study["runs"]) else "warn" if failed or (targets and not best) else "good"
    what = f"{len(study['runs'])} runs of {study['study']}" + (f", errors against {study['reference']}." if study.get("reference") else ".")
    checks = [{"level": "bad", "title": "Failed", "text": name} for name in failed]
    return {"name": "", "level": level, "headline": text, "what": what, "answers": [], "span": "", "checks": checks}


def build(folder):
    study = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    title = f"Study {pathlib.Path(study['study']).stem}"
    drawings = [d for d in (_drawing(study, m) for m in study.get("metrics", [])) if d]
    found = [section("fronts", "Error against cost", safe('<div class="figures">' + "".join(drawings) + "</div>") if drawings else ""),
             section("runs", "Runs", _table(study))]
    return html_page.render(title=title, eyebrow="Spindrift study", verdicts=[verdict(study)], sections=[s for s in found if s])
