"""The page of a study, from its study.json: the answer, error against cost with intervals, the error budget, what was not tested.
Called by spindrift_report.py; tested in tests/src/report/report_test.py. SPDX-License-Identifier: Apache-2.0"""
import json
import math
import pathlib

import matplotlib.pyplot as plt
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

import figures
import html_page
import page
import quantities
from html_page import section
from study_judge import WORDS

LABELLED = 14  # rungs named beside their points; more are numbered


def _in_percent(metric):
    return metric["relative"] or metric["divide_by"] != 1.0


def _unit(metric):
    return 100.0 if _in_percent(metric) else 1.0


def _unit_of(metric):
    """Of an absolute error: the measure's own, or the column's."""
    return {"phase": "deg", "period": "s", "damping": "-"}.get(metric["measure"]) or quantities.unit_of(metric["column"]) or "-"


def _plain(value, _=None):
    """1e-05, 0.01, 20, 1500: no powers where a number will do."""
    return f"{value:g}" if 1e-3 <= abs(value) < 1e5 else f"{value:.0e}"


def _decades(axis, low, high):
    """A logarithmic axis whose ticks a reader can read: every decade, and within fewer than two decades 1, 2, 5."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    steps = (1, 2, 5) if math.log10(high / low) < 2.5 else (1,)
    every = max(1, (last - first) // 8)
    axis.set_major_locator(FixedLocator([s * 10.0**d for d in range(first, last + 1, every) for s in steps]))
    axis.set_major_formatter(FuncFormatter(_plain))
    axis.set_minor_formatter(NullFormatter())


def _points(study, metric):
    """Drawn points: an error of zero cannot stand on a logarithmic axis."""
    return [(rung, rung["errors"][metric["name"]]) for rung in study["rungs"]
            if (rung["errors"][metric["name"]]["error"] or 0.0) > 0.0 and not rung["is_reference"] and rung["cost"]["core_s"]]


def _reference(study, metric):
    """The reference with its error, which is zero: [] where it is no rung or has no cost."""
    return [(r, r["errors"][metric["name"]]) for r in study["rungs"] if r["is_reference"] and (r["cost"]["core_s"] or 0.0) > 0.0]


def _lenders(study, metric):
    return list(dict.fromkeys(e["scatter_of"] for r in study["rungs"] if (e := r["errors"][metric["name"]])["scatter_of"]))


def _apart(box, x, y):
    """From a rectangle to a point."""
    return math.hypot(max(box[0] - x, 0.0, x - box[2]), max(box[1] - y, 0.0, y - box[3]))


NAME_SIZE = 8.0   # points


def _wide(text, size):
    """Width of a name in points."""
    return 0.62 * size * len(text)


def _name(axis, labels, size=NAME_SIZE):
    """Writes names beside their points, the first first, where none lies on another, on a point, nearer to another point or across the edge; what
    finds no place has its row in the table."""
    dots = axis.figure.dpi / 72.0
    width, height = axis.get_position().size * axis.figure.get_size_inches() * axis.figure.dpi
    (x0, y0), at = axis.transAxes.transform((0.0, 0.0)), axis.transData.transform([label[:2] for label in labels])
    taken = [(x - 4 * dots, y - 4 * dots, x + 4 * dots, y + 4 * dots) for x, y in at]
    for (cost, error, text), (x, y) in zip(labels, at):
        wide, high = _wide(text, size) * dots, 1.15 * size * dots
        for right, up in ((6, 5), (-6, 5), (6, -11), (-6, -11), (8, -3), (-8, -3), (6, 14), (-6, 14), (6, 24), (-6, 24)):
            left, low = x + right * dots - (wide if right < 0 else 0.0), y + up * dots
            box = (left, low, left + wide, low + high)
            inside = x0 <= left and left + wide <= x0 + width and y0 <= low and low + high <= y0 + height
            its_own = all(_apart(box, x, y) < _apart(box, *other) for other in at if tuple(other) != (x, y))
            if inside and its_own and all(box[2] <= t[0] or t[2] <= box[0] or box[3] <= t[1] or t[3] <= box[1] for t in taken):
                taken.append(box)
                axis.annotate(text, (cost, error), textcoords="offset points", xytext=(right, up), fontsize=size, ha="right" if right < 0 else "left")
                break


def draw(study, metric, axis, numbered=True):
    """Error against cost: points with their intervals, the front joined, the target as a line. False where there is nothing to draw."""
    points, unit = _points(study, metric), _unit(metric)
    if not points:
        return False
    floor = 0.3 * min(e["error"] for _, e in points) * unit
    lows, highs, labels = [], [], []
    for rung, e in points:
        cost, error = rung["cost"]["core_s"], e["error"] * unit
        low, high = max(e["low"] * unit, floor), e["high"] * unit
        lows.append(low), highs.append(high)
        colour = figures.PALETTE[1] if rung["name"] == study["answer"] else figures.PALETTE[0 if rung["on_front"] else 7]
        axis.plot([cost, cost], [low, high], ":" if e["scatter_of"] else "-", color=colour, linewidth=1.2 if e["scatter_of"] else 1.0, alpha=0.8)
        axis.plot([rung["cost"]["low"], rung["cost"]["high"]], [error, error], "-", color=colour, linewidth=1.0, alpha=0.7)
        axis.plot(cost, error, "o", color=colour, markersize=6 if rung["on_front"] else 4.5)
        name = rung["name"] if len(points) <= LABELLED or not numbered else str(1 + [r["name"] for r in study["rungs"]].index(rung["name"]))
        labels.append((rung["name"] != study["answer"], not rung["on_front"], cost, error, name))
    front = sorted((r["cost"]["core_s"], e["error"] * unit) for r, e in points if r["on_front"])
    axis.plot([c for c, _ in front], [e for _, e in front], "-", color=figures.PALETTE[0], linewidth=0.8, alpha=0.6, zorder=0)
    if metric["target"]:
        axis.axhline(metric["target"] * unit, color=figures.PALETTE[6], linestyle="--", linewidth=0.9)
        lows.append(metric["target"] * unit), highs.append(metric["target"] * unit)
    bottom = min(lows) / 1.5
    for rung, e in _reference(study, metric):
        cost, high = rung["cost"]["core_s"], e["high"] * unit
        highs.append(max(high, bottom))
        axis.plot([cost, cost], [bottom, max(high, bottom)], ":" if e["scatter_of"] else "-", color=figures.PALETTE[2], linewidth=1.2, alpha=0.8)
        axis.plot(cost, bottom, "D", color=figures.PALETTE[2], markersize=7, clip_on=False, zorder=3)
        labels.append((False, False, cost, bottom, f"{rung['name']}: reference, 0"))
    axis.set_xscale("log"), axis.set_yscale("log")
    costs = [r["cost"]["core_s"] for r, _ in points + _reference(study, metric)]
    # The name of the answer, often the cheapest, may have no place but on its left.
    answer = next((rung for rung, _ in points if rung["name"] == study["answer"]), min(points, key=lambda point: point[0]["cost"]["core_s"])[0])
    share = min(0.4, (_wide(answer["name"], NAME_SIZE) + 12.0) / (72.0 * axis.get_position().width * axis.figure.get_figwidth()))
    at, highest = answer["cost"]["core_s"], 1.8 * max(costs)
    axis.set_xlim(min(min(costs) / 1.8, at / (highest / at) ** (share / (1.0 - share))), highest)
    axis.set_ylim(bottom, max(highs) * 1.6)
    _decades(axis.xaxis, min(costs), max(costs)), _decades(axis.yaxis, min(lows), max(highs))
    _name(axis, [label[2:] for label in sorted(labels)])
    if lenders := _lenders(study, metric):
        axis.plot([], [], "-", color=figures.PALETTE[7], linewidth=1.0, label=f"{100 * study['confidence']:g} % interval, own scatter")
        axis.plot([], [], ":", color=figures.PALETTE[7], linewidth=1.2, label="scatter of " + ", ".join(lenders))
        axis.legend(loc="lower left", fontsize=8.0, frameon=False)
    axis.set_xlabel("processor time of one run [core-s]")
    axis.set_ylabel(f"error of the {WORDS[metric['measure']].removesuffix(' of')} [{'%' if _in_percent(metric) else _unit_of(metric)}]")
    return True


def _figure(study, metric):
    figure, axis = plt.subplots(figsize=(5.4, 3.8), layout="constrained")
    if not draw(study, metric, axis):
        plt.close(figure)
        return ""
    what = f"{WORDS[metric['measure']]} {metric['column']}"
    target = f"; the dashed line is the target, {_plain(metric['target'] * _unit(metric))}{' %' if _in_percent(metric) else ''}" if metric["target"] else ""
    borrowed = f"Dotted bars: scatter of {', '.join(_lenders(study, metric))}. " if _lenders(study, metric) else ""
    bars = f"Bars are {100 * study['confidence']:g} % intervals from {study['replicas']} replicas, paired with the reference. " if study["replicas"] else ""
    marked = "; orange: the result" * bool(study["answer"]) + "; diamond: the reference, at its cost" * bool(_reference(study, metric))
    return (f"<figure><h3>{page.escape(metric['name'])}: {page.escape(what)}</h3>{figures.as_html(figure, 'Error against cost: ' + what)}"
            f"<figcaption>{bars}{page.escape(borrowed)}The line joins what nothing beats in both error and cost, over all targets{page.escape(target)}{marked}.</figcaption></figure>")


def draw_values(study, metric, axis):
    """What each rung found, one row each, where nothing is there to judge it by. False where fewer than two have a value."""
    found = [(number, rung["name"], value) for number, rung in enumerate(study["rungs"], 1)
             if (value := rung["errors"][metric["name"]]["value"]) is not None and math.isfinite(value)]
    if len(found) < 2:
        return False
    values = [value for _, _, value in found]
    axis.plot(values, range(len(found)), "o", color=figures.PALETTE[0], markersize=5)
    axis.set_yticks(range(len(found)), [name if len(found) <= LABELLED else str(number) for number, name, _ in found])
    axis.invert_yaxis()
    axis.margins(x=0.08)
    axis.grid(axis="y", alpha=0.3)
    axis.set_xlabel(f"{WORDS[metric['measure']]} {metric['column']}")
    return True


def _values_figure(study, metric):
    rows = min(len(study["rungs"]), 40)
    figure, axis = plt.subplots(figsize=(5.4, 1.1 + 0.24 * rows), layout="constrained")
    if not draw_values(study, metric, axis):
        plt.close(figure)
        return ""
    numbered = " Numbers are those of the table." if len(study["rungs"]) > LABELLED else ""
    return (f"<figure><h3>{page.escape(metric['name'])}</h3>{figures.as_html(figure, 'Values of ' + metric['name'])}"
            f"<figcaption>What each configuration found. The study names no reference, so none has an error.{numbered}</figcaption></figure>")


def borrowed_words(e):
    """", scatter of other" where the interval rests on another rung's scatter."""
    return f", scatter of {e['scatter_of']}" if e["scatter_of"] else ""


def _error_text(e, metric):
    if e["error"] is None:
        return "-"
    unit, sign = _unit(metric), " %" if _in_percent(metric) else ""
    text = f"{page.number(e['error'] * unit, 3)}{sign}"
    if e["high"] > e["low"]:
        text += f" <small>{page.number(e['low'] * unit, 2)} to {page.number(e['high'] * unit, 2)}{page.escape(borrowed_words(e))}</small>"
    return text


def has_values(study, metric):
    """Measures of one history have values; differences of two have none."""
    return any(rung["errors"][metric["name"]]["value"] is not None for rung in study["rungs"])


def _cost_text(cost):
    """Processor time, and below it what it goes into, from a twentieth of it on."""
    large = sorted(((core_s / cost["core_s"], name) for name, core_s in cost.get("parts", {}).items()), reverse=True)
    return page.number(cost["core_s"], 3) + "".join(f"<br><small>{page.escape(name)} {100.0 * share:.0f} %</small>" for share, name in large if share >= 0.05)


def _table(study):
    judged = bool(study["reference"])
    valued = {m["name"]: has_values(study, m) for m in study["metrics"]}
    head = "".join(f"<th>error of {page.escape(m['name'])}</th>" * judged + f"<th>{page.escape(m['name'])}</th>" * valued[m["name"]] for m in study["metrics"])
    sure = any(r["confidence"] is not None for r in study["rungs"])
    rows = ""
    for number, rung in enumerate(study["rungs"], 1):
        errors = "".join(f"<td>{_error_text(rung['errors'][m['name']], m)}</td>" * judged +
                         f"<td>{page.number(value, 4) if (value := rung['errors'][m['name']]['value']) is not None else '-'}</td>" * valued[m["name"]]
                         for m in study["metrics"])
        cost, notes = rung["cost"], []
        notes += ["<strong>the result</strong>"] if rung["name"] == study["answer"] else []
        notes += ["reference"] if rung["is_reference"] else ["Pareto front"] if rung["on_front"] else []
        notes += [f"failed: {page.escape(rung['failed'])}"] if rung["failed"] else []
        confidence = (f"<td>{'-' if rung['confidence'] is None or rung['is_reference'] else page.number(100 * rung['confidence'], 3) + ' %'}</td>"
                      if sure else "")
        memory = page.number(cost["memory"] / 1e6, 3) if cost["memory"] == cost["memory"] else "-"
        rows += (f"<tr><td>{number}</td><td class=text>{page.escape(rung['name'])}</td><td>{_cost_text(cost)}</td><td>{memory}</td>"
                 f"{errors}{confidence}<td class=text>{', '.join(notes)}</td></tr>")
    return (f'<div class="scroll"><table><thead><tr><th></th><th class=text>configuration</th><th>core-s</th><th>MB</th>{head}'
            f"{'<th>confidence</th>' if sure else ''}<th></th></tr></thead><tbody>{rows}</tbody></table></div>")


def _budget(study):
    """Sources of error of the answer, as bars per metric."""
    parts = ""
    for row, metric in zip(study["budget"], study["metrics"]):
        sources = [s for s in row["sources"] if math.isfinite(s["size"])]
        if not sources:
            continue
        largest, unit, sign = max(s["size"] for s in sources) or 1.0, _unit(metric), " %" if _in_percent(metric) else ""
        bars = "".join(f"<span>{page.escape(s['source'])}</span><b style=\"width:{100 * s['size'] / largest:.1f}%\"></b>"
                       f"<span>{page.number(s['size'] * unit, 2)}{sign}</span>" for s in sources)
        parts += f"<h3>{page.escape(metric['name'])}</h3><div class=bars>{bars}</div>"
    return parts


def _notes(found):
    return "".join(f"<p>{page.escape(note[0].upper() + note[1:])}.</p>" for note in found["notes"])


def _load_cases(study):
    """Design extremes and ranges of a life, then every case."""
    found = study.get("load_cases")
    if not found:
        return ""

    def table(heads, rows):
        head = "".join(f"<th{' class=text' if text else ''}>{page.escape(h)}</th>" for h, text in heads)
        body = "".join("<tr>" + "".join(f"<td{' class=text' if text else ''}>{page.escape(v) if text else v if isinstance(v, int) else page.number(v, 4)}</td>"
                                        for v, (_, text) in zip(row, heads)) + "</tr>" for row in rows)
        return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'

    exponents = found["options"]["wohler_exponents"]
    parts = table([("column", True), ("end", True), ("design", False), ("characteristic", False), ("factor", False), ("case", True)],
                  [(e["column"], e["end"], e["design"], e["characteristic"], e["factor"], e["rung"]) for e in found["extremes"]])
    if found["lifetime"]:
        o = found["options"]
        parts += f"<h3>Ranges that {o['equivalent_cycles']:g} cycles make in {o['years']:g} years</h3>" + table(
            [("column", True), ("m", False), ("range", False), ("most damage", True)],
            [(r["column"], r["exponent"], r["range"], r["worst"]) for r in found["lifetime"]])
    parts += "<h3>Cases: means over their seeds, and equivalent ranges of 1 Hz</h3>" + table(
        [("case", True), ("column", True), ("seeds", False), ("share of life", False), ("mean", False), ("deviation", False), ("minima", False),
         ("maxima", False), *[(f"range, m = {m:g}", False) for m in exponents]],
        [(c["rung"], c["column"], c["seeds"], found["shares"][c["column"]].get(c["rung"], 0.0), c["mean"], c["deviation"], c["min"], c["max"], *c["equivalent"])
         for c in found["cases"]])
    return parts + (_notes(found) if study["reference"] else "")   # else they stand above


LIFE_COVERED = 0.9   # of a life: what the cases leave out does no damage in the ranges


def _design_status(found):
    """Of load cases without a reference: how many loads there are of how many cases, and what of a life they cover."""
    least = min((math.fsum(parts.values()) for parts in found["shares"].values() if parts), default=1.0)
    columns, cases = dict.fromkeys(e["column"] for e in found["extremes"]), dict.fromkeys(c["rung"] for c in found["cases"])
    headline = f"Design loads of {len(columns)} column{'s' if len(columns) > 1 else ''} by {len(cases)} case{'s' if len(cases) > 1 else ''}"
    if least < LIFE_COVERED:
        headline += f"; these cover {100.0 * least:.3g} % of the life, so its ranges are too small"
    doubtful = least < LIFE_COVERED or any(note.startswith("without") for note in found["notes"])
    return f'<div class="status{" warn" if doubtful else ""}"><p><strong class="headline">{page.escape(headline)}.</strong></p>{_notes(found)}</div>'


def _title(study):
    """By the file's name, or by its folder's where it is called study.toml."""
    file = pathlib.Path(study["study"])
    name = file.resolve().parent.name if file.stem == "study" else file.stem
    return f"Study {name}" if name else "Study"


def build(folder):
    study = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    found = study["answer"] or not any(m["target"] for m in study["metrics"])
    sentence = study["sentence"][0].upper() + study["sentence"][1:]
    reference = study["reference"] or {}
    against = (f"the configuration '{reference['variant']}'" if reference.get("variant") else pathlib.Path(reference["history"]).name
               if reference.get("history") else f"Richardson's limit along {reference['limit']}" if reference.get("limit") else "")
    scene = f"<p>The scene to run: <code>{page.escape(folder / study['scene'])}</code></p>" if study["scene"] else ""
    if (cases := study.get("load_cases")) and not reference:
        status = _design_status(cases)
    else:
        status = (f'<div class="status{"" if found else " warn"}"><p><strong class="headline">{page.escape(sentence)}.</strong></p>{scene}'
                  f"<p>Next best spend: {page.escape(study['next'])}.</p></div>")
    limits = "".join(f"<li>{page.escape(l['metric'])} of {page.escape(l['of'])}: " + (page.escape(l["why"]) if l["why"] else
                     f"order {page.number(l['order'], 3) if l['order'] else 'not needed'}") + "</li>" for l in study["limits"])
    left = "".join(f"<li>{page.escape(text)}</li>" for text in study["not_tested"])
    drawn = "".join((_figure if reference else _values_figure)(study, m) for m in study["metrics"])
    sections = [section("figures", "Error against cost" if reference else "What was found", f'<div class="figures">{drawn}</div>' if drawn else ""), section("load-cases", "Load cases", _load_cases(study)),
                section("rungs", "Configurations", _table(study)),
                section("budget", f"Where the error of {study['budget_of']} comes from", _budget(study)),
                section("limits", "Limits", f"<ul>{limits}</ul>" if limits else ""), section("not-tested", "What was not tested", f"<ul>{left}</ul>" if left else "")]
    return html_page.render(title=_title(study), eyebrow=f"Spindrift study · {study['study']}",
                            facts=f"{len(study['rungs'])} configurations · {page.number(study['core_s_spent'], 3)} core-s spent" + (f" · errors are against {against}" if against else ""),
                            verdicts=[], before=html_page.safe(status), sections=[s for s in sections if s])
