"""The page of a report: sections as HTML text, each only where the data have it. Nothing on it needs a network.
Called by spindrift_report.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import html
import itertools
import math
import pathlib

import numpy as np

import figures
import flow_pictures
import quantities
import rotor_pictures
import sea_pictures

EXITS = {0: "Done", 2: "Bad input", 3: "Numerical failure", 4: "Machine failure", 5: "Stopped on request"}
GROUPS = {"motion": "Motions", "rates": "Velocities and accelerations", "forces": "Forces by source", "moments": "Moments by source",
          "rotor": "Rotor", "moorings": "Moorings", "sea": "Gauges, probes, paddle", "other": "Other columns"}
LOG_LINES = 80


def escape(text):
    return html.escape(str(text), quote=True)


def number(value, digits=4):
    if not isinstance(value, (int, float, np.floating)) or not math.isfinite(value):
        return "–"
    rounded = f"{value:.{digits - 1}e}"
    exponent = int(rounded.partition("e")[2])
    if value == 0 or -3 <= exponent < 6:
        rounded = f"{value:.{max(0, digits - 1 - exponent)}f}" if value else "0"
    else:
        rounded = f"{rounded.partition('e')[0]}e{exponent}"
    return rounded.replace("-", "−")


def section(key, title, body):
    half = ' class="half"' if body.count("<figure>") == 1 else ""  # two such sections share a row where there is width
    return (key, title, f'<section id="{key}"{half}><h2>{escape(title)}</h2>\n{body}\n</section>') if body else None


# ---- what happened -------------------------------------------------------------------------------------------------------------------


def trouble(run):
    """Sentences about what went wrong numerically, from the summary and from the numbers themselves."""
    said = [str(s) for s in run.summary.get("numerical_trouble", [])]
    for name, values in zip(run.columns, run.values):
        bad = ~np.isfinite(values)
        if bad.any() and not np.isnan(values).all():
            said.append(f"{name}: {bad.sum()} of {len(values)} values are not finite, the first at t = {number(run.time[bad.argmax()])} s")
    empty = [name for name, values in zip(run.columns, run.values) if len(values) and np.isnan(values).all()]
    if empty:
        said.append("no value at any time: " + ", ".join(empty))
    return said


def status(run, log_link="log"):
    code = run.summary.get("exit_code")
    said = trouble(run)
    kind = "bad" if said or code in (2, 3, 4) else "warn" if code != 0 or run.notes else ""
    word = EXITS.get(code, "No summary: interrupted, or still running" if code is None else f"Exit code {code}")
    reason = str(run.summary.get("exit_reason") or "")
    out = f"<p><strong>{escape(word)}</strong>{': ' + escape(reason) if reason else ''}</p>"
    if said:
        out += "<p>Numerical trouble:</p><ul>" + "".join(f"<li>{escape(s)}</li>" for s in said) + "</ul>"
    if warnings := run.summary.get("warnings"):
        out += f'<p class="warning">{escape(warnings)} warning{"s" if warnings != 1 else ""} in the {log_link}.</p>'
    out += "".join(f"<p>{escape(note)}.</p>" for note in run.notes)
    return f'<div class="status {kind}">{out}</div>'


def facts(run):
    s, said = run.summary, []
    if len(run.time):
        said.append(f"{run.time[-1]:.6g} s simulated")
    if s.get("wall_seconds"):
        said.append(f"{number(s['wall_seconds'], 3)} s of wall time")
    if s.get("real_time_factor"):
        said.append(f"{number(s['real_time_factor'], 3)} × real time")
    machine = s.get("machine", {})
    if machine:
        said.append(f"ranks × threads: {machine.get('ranks', 1)} × {machine.get('threads_per_rank', 1)}")
    if s.get("restarts"):
        said.append(f"restarted {s['restarts']} time(s)")
    return " · ".join(said)


# ---- what was modelled ---------------------------------------------------------------------------------------------------------------


def _tables(scene, key):
    found = scene.get(key, {})
    return {k: v for k, v in found.items() if isinstance(v, dict)} if isinstance(found, dict) else {}


def _value(scene, section_name, key):
    found = scene.get(section_name, {})
    return found.get(key) if isinstance(found, dict) else None


def model(run):
    scene, items = run.scene, []

    def say(term, *parts):
        text = "; ".join(str(p) for p in parts if p)
        if text:
            items.append((term, text))

    def unit(section_name, key, before, after):
        value = _value(scene, section_name, key)
        if not isinstance(value, (int, float)) or isinstance(value, bool):
            return ""
        prefixed, factor = quantities.scaled(after, abs(value))
        return f"{before}{factor * value:.6g} {prefixed}"

    bodies = _tables(scene, "bodies")
    say("Bodies", *(f"{name} ({b['mass_kg'] / 1e3:,.0f} t)" if isinstance(b.get("mass_kg"), (int, float)) else name
                    for name, b in bodies.items()))
    say("Joints", *(f"{name}: {j.get('type', '')} between {' and '.join(map(str, j.get('bodies', [])))}"
                    for name, j in _tables(scene, "joints").items()))
    lines = {}
    for line in _tables(scene, "moorings").values():
        lines.setdefault(str(line.get("model", "line")).replace("_", " "), []).append(line)
    say("Moorings", *(f"{len(found)} × {kind}" for kind, found in lines.items()))
    say("Water", _value(scene, "sea", "model"), unit("environment", "water_depth_m", "depth ", "m"))
    say("Waves", _value(scene, "waves", "model"), unit("waves", "height_m", "height ", "m"), unit("waves", "period_s", "period ", "s"))
    say("Rotor and air", str(_value(scene, "aero", "model") or "").replace("_", " "), unit("aero", "thrust_N", "thrust ", "N"),
        unit("wind", "speed_m_s", "wind ", "m/s"))
    say("Time", unit("time", "end_s", "to ", "s"), unit("time", "window_s", "windows of ", "s"), _value(scene, "time", "integrator"))
    say("Coupling", _value(scene, "coupling", "scheme"))
    return "<dl class=\"model\">" + "".join(f"<div><dt>{escape(t)}</dt><dd>{escape(d)}</dd></div>" for t, d in items) + "</dl>" if items else ""


def flattened(table, prefix=""):
    """{dotted key: value} of a scene."""
    out = {}
    for key, value in table.items():
        name = f"{prefix}.{key}" if prefix else str(key)
        if isinstance(value, dict):
            out |= flattened(value, name)
        elif isinstance(value, list) and value and all(isinstance(v, dict) for v in value):
            for i, entry in enumerate(value):
                out |= flattened(entry, f"{name}[{i}]")
        else:
            out[name] = value
    return out


def differences(runs):
    """Keys of the scenes that are not the same in all runs."""
    scenes = [flattened(run.scene) for run in runs]
    keys = [k for k in dict.fromkeys(k for s in scenes for k in s) if any(s.get(k) != scenes[0].get(k) for s in scenes)]
    if not keys:
        return '<p class="facts">None: the scenes are the same.</p>' if all(scenes) else ""
    head = "<tr><th>Key</th>" + "".join(f"<th>{escape(r.name)}</th>" for r in runs) + "</tr>"
    rows = "".join(f"<tr><td>{escape(k)}</td>" + "".join(f"<td>{escape(s.get(k, '–'))}</td>" for s in scenes) + "</tr>" for k in keys)
    return f'<div class="scroll"><table>{head}{rows}</table></div>'


# ---- figures and tables --------------------------------------------------------------------------------------------------------------


def _range(run):
    """Rows and words of the range that means are taken over: the summary's last that holds rows, else the last quarter."""
    def rows(start, end):
        margin = 1e-9 * max(1.0, abs(end))
        return (run.time >= start - margin) & (run.time <= end + margin), f"{start:.6g} to {end:.6g} s"

    for found in list((run.summary.get("ranges") or {}).values())[::-1]:
        if isinstance(found, dict) and isinstance(found.get("from_s"), (int, float)) and isinstance(found.get("to_s"), (int, float)):
            chosen = rows(found["from_s"], found["to_s"])
            if chosen[0].any():
                return chosen
    return rows(run.time[-1] - 0.25 * (run.time[-1] - run.time[0]), run.time[-1])


def _mean(time, values):
    """Trapezoidal mean over time, as in summary.json."""
    if len(values) == 0:
        return math.nan
    return float(np.trapz(values, time) / (time[-1] - time[0])) if len(values) > 1 and time[-1] > time[0] else float(values[-1])


def _key_rows(run, names):
    rows, where = [], _range(run)
    for name in names:
        values = run.column(name)
        finite = values[np.isfinite(values)]
        unit, factor = quantities.scaled(quantities.unit_of(name, run.described), np.abs(finite).max(initial=0.0))
        low, high = (finite.min(), finite.max()) if len(finite) else (math.nan, math.nan)
        figures_of = [values[-1], _mean(run.time[where[0]], values[where[0]]), low, high]
        rows.append((name, unit, [factor * float(v) for v in figures_of]))
    return rows, where[1]


def _meaning(run, name):
    return (run.described.get(name) or {}).get("meaning", "")


def _spoken(name):
    return f"{escape(quantities.spoken(name))} <small class=\"code\">{escape(name)}</small>"


def key_figures(run):
    names = [n for n in quantities.key_columns(run.columns) if n in run.columns]
    if not len(run.time) or not names:
        return ""

    def table(chosen):
        rows, span = _key_rows(run, chosen)
        head = f'<tr><th>Quantity</th><th>Unit</th><th>Final</th><th>Mean, {escape(span)}</th><th>Least</th><th>Greatest</th></tr>'
        body = "".join(f'<tr><td title="{escape(_meaning(run, n))}">{_spoken(n)}</td><td>{escape(u)}</td>'
                       + "".join(f"<td>{number(v)}</td>" for v in values) + "</tr>" for n, u, values in rows)
        return f'<div class="scroll"><table>{head}{body}</table></div>'

    rest = [n for n in run.columns[1:] if n not in names]
    return table(names) + (f"<details><summary>All {len(run.columns) - 1} columns</summary>{table(rest)}</details>" if rest else "")


def compared_figures(runs):
    """Means of each run, and how far each is from the first."""
    names = [n for n in quantities.key_columns(runs[0].columns) if all(n in r.columns for r in runs)]
    runs = [r for r in runs if len(r.time)]
    if not names or len(runs) < 2:
        return ""
    head = "<tr><th>Mean of</th><th>Unit</th>" + "".join(f"<th>{escape(r.name)}</th>" for r in runs) + "</tr>"
    body, spans = "", [_range(r) for r in runs]
    for name in names:
        means = [_mean(r.time[s[0]], r.column(name)[s[0]]) for r, s in zip(runs, spans)]
        unit, factor = quantities.scaled(quantities.unit_of(name, runs[0].described), max((abs(m) for m in means if math.isfinite(m)), default=0))
        cells = ""
        for i, mean in enumerate(means):
            change = (mean - means[0]) / abs(means[0]) * 100.0 if i and means[0] else math.nan
            cells += f"<td>{number(factor * mean)}" + (f" <small>({change:+.2f} %)</small>" if math.isfinite(change) else "") + "</td>"
        body += f"<tr><td>{_spoken(name)}</td><td>{escape(unit)}</td>{cells}</tr>"
    spans = "; ".join(f"{escape(r.name)}: {escape(s[1])}" for r, s in zip(runs, spans))
    return f'<div class="scroll"><table>{head}{body}</table></div><p class="facts">Means over {spans}. In brackets: difference from the first.</p>'


def _legend(entries):
    if not entries:
        return ""
    items = "".join(f'<li><i style="border-color:var(--c{colour})"></i>{escape(text)}</li>' for text, colour in entries.items())
    return f'<ul class="legend">{items}</ul>'


def _figure(title, legend, picture, caption):
    return f"<figure><h3>{escape(title)}</h3>{legend}{picture}<figcaption>{escape(caption)}</figcaption></figure>"


def _caption(group, drawing, runs):
    said = [group.caption]
    if drawing.legend and len(runs) > 1:
        said.append("Lines: " + ", ".join(f"{words} {r.name}" for words, r in zip(itertools.cycle(("solid", "dashed", "dotted", "dash-dotted")), runs)) + ".")
    if drawing.constant:
        said.append(f"Constant: {', '.join(drawing.constant)}.")
    if drawing.zero:
        said.append(f"Zero throughout: {', '.join(drawing.zero)}.")
    return " ".join(said).strip()


def _run_legend(runs):
    return {r.name: i % len(figures.PALETTE) for i, r in enumerate(runs)} if len(runs) > 1 else {}


def time_figures(runs):
    """{group key: HTML} of all figures over time."""
    names = list(dict.fromkeys(n for run in runs for n in run.columns))
    shown, folded, still = {}, {}, {}
    for group in quantities.groups(names):
        drawing = figures.series(runs, group)
        caption = _caption(group, drawing, runs)
        if drawing.figure is None:
            still.setdefault(group.key, []).append(f"{group.title}. {caption}")
            continue
        legend, picture = _legend(drawing.legend or _run_legend(runs)), figures.as_html(drawing.figure, escape(group.title))
        (folded if group.fold else shown).setdefault(group.key, []).append(_figure(group.title, legend, picture, caption))
    out = {}
    for key in GROUPS:
        body = f'<div class="figures">{"".join(shown[key])}</div>' if key in shown else ""
        body += "".join(f'<p class="facts">{escape(words)}</p>' for words in still.get(key, []) if len(names) > 1 and runs[0].time.size)
        if key in folded:
            count = len(folded[key])
            words = f"{count} more figure{'s' if count > 1 else ''}"
            body += f'<details><summary>{words}</summary><div class="figures">{"".join(folded[key])}</div></details>'
        out[key] = body
    return out


def spectra(runs):
    names = runs[0].columns
    out, words = "", "Power spectral density (Welch, Hann window), without the first quarter of the run."
    for body in quantities.bodies_of(names)[:1]:
        for title, wanted in (("displacement", ("x", "y", "z")), ("attitude", ("roll", "pitch", "yaw"))):
            panels = [(quantities.AXES[quantities.quantity_of(n)], n) for n in names
                      if n.rpartition(".")[0] == body and quantities.quantity_of(n) in wanted]
            figure = figures.spectra(runs, panels)
            if figure is not None:
                title = f"{body}: spectra of {title}"
                out += _figure(title, _legend(_run_legend(runs)), figures.as_html(figure, escape(title)), words)
    return f'<div class="figures">{out}</div>' if out else ""


def sea(run):
    out = "".join(_figure(title, "", figures.as_html(figure, escape(title)), words) for title, figure, words in sea_pictures.pictures(run))
    return f'<div class="figures">{out}</div>' if out else ""


def flow(run):
    """Pictures of a resolved flow, those that the run's files give."""
    out = ""
    if found := flow_pictures.residuals(run):
        figure, legend = found
        out += _figure("Residuals", _legend(legend), figures.as_html(figure, "Residuals"),
                       "Root mean square of the density rate, scaled residual of the mean flow, that of turbulence; CFL number of the pseudo-step.")
    pictures = list(rotor_pictures.pictures(run))
    out += "".join(_figure(title, "", figures.as_html(figure, title), words) for title, figure, words in pictures)
    if pictures:   # the middle plane of a rotor says nothing
        return f'<div class="figures">{out}</div>'
    if figure := flow_pictures.wall_curves(run):
        out += _figure("Along the walls", "", figures.as_html(figure, "Along the walls"),
                       f"In the middle plane of the walls; pressure with its sign turned. {flow_pictures.y_plus_words(run)}".strip())
    if figure := flow_pictures.flow_slice(run):
        out += _figure("Slice of the flow", "", figures.as_html(figure, "Slice of the flow"),
                       "Cells in the middle plane, at the end of the run: pressure above the undisturbed one on dynamic pressure; Mach number.")
    return f'<div class="figures">{out}</div>' if out else ""


def _bars(entries, words):
    """entries: (name, share 0..1, text)."""
    rows = "".join(f'<span>{escape(name)}</span><span><b style="width:{100 * min(max(share, 0.0), 1.0):.1f}%"></b></span><span>{escape(text)}</span>'
                   for name, share, text in entries)
    return f'<div class="bars">{rows}</div><p class="facts">{escape(words)}</p>'


def where_time(run):
    parts = [p for p in run.summary.get("parts", []) if isinstance(p, dict) and isinstance(p.get("core_seconds"), (int, float))]
    out, total = "", sum(p["core_seconds"] for p in parts)
    if total > 0:
        parts.sort(key=lambda p: -p["core_seconds"])
        out += _bars([(p.get("name", ""), p["core_seconds"] / total, f"{number(p['core_seconds'], 3)} core-s · {100 * p['core_seconds'] / total:.1f} %")
                      for p in parts], f"Core-seconds by part, of {number(total, 3)} measured.")
    if run.trace:
        most = sorted(run.trace.items(), key=lambda kv: -kv[1])[:12]
        whole = sum(run.trace.values()) or 1.0
        out += "<h3>Tasks that took most</h3>" + _bars([(label, s / whole, f"{number(s, 3)} s · {100 * s / whole:.1f} %") for label, s in most],
                                                        "From trace.json, labels summed by their first two parts.")
    return out


def efficiency(run):
    rows = [e for e in run.summary.get("efficiency", []) if isinstance(e, dict)]
    if not rows:
        return ""
    body = "".join(f"<tr><td>{escape(e.get('name', ''))}</td><td>{number(e.get('value'), 3)}</td>"
                   f"<td class=\"text\">{escape(e.get('meaning', ''))}</td></tr>" for e in rows)
    return f'<div class="scroll"><table><tr><th>Efficiency</th><th>0 to 1</th><th class="text">Meaning</th></tr>{body}</table></div>'


def counts(run):
    found = run.summary.get("counts") or {}
    return '<p class="facts">' + " · ".join(f"{escape(k).replace('_', ' ')}: {v}" for k, v in found.items()) + "</p>" if found else ""


# ---- scene and log -------------------------------------------------------------------------------------------------------------------


def scene(run):
    """Section by section, folded; what the file says of each key stays as a soft comment."""
    if not run.scene_text:
        return ""
    blocks, name, lines = [], None, []
    for line in run.scene_text.splitlines() + ["[]"]:
        if line.startswith("["):
            if name is not None or any(x.strip() for x in lines):
                blocks.append((name or "before the first section", lines))
            name, lines = line.split("#")[0].strip(), []
        else:
            lines.append(line)
    out = ""
    for name, lines in blocks:
        text = "\n".join(_scene_line(line) for line in "\n".join(lines).strip("\n").split("\n"))
        keys = sum("=" in line.split("#")[0] for line in lines)
        if keys or name.startswith("["):
            out += f"<details><summary>{escape(name)} <small>{keys} key{'s' if keys != 1 else ''}</small></summary><pre>{text}</pre></details>"
    return f'<p class="facts">As run, every default spelled out (scene.toml).</p><div class="scene">{out}</div>'


def _scene_line(line):
    value, mark, comment = line.partition("  # ")
    return escape(value) + (f'<span class="note">{escape(mark + comment)}</span>' if mark else "")


def log(run):
    if not run.log:
        return ""

    def marked(line):
        level = line.split(" ", 3)[2] if line.count(" ") >= 3 else ""
        kind = {"warning": "warning", "error": "error", "critical": "error"}.get(level)
        return f'<span class="{kind}">{escape(line)}</span>' if kind else escape(line)

    tail = run.log[-LOG_LINES:]
    earlier = [line for line in map(marked, run.log[:-LOG_LINES]) if line.startswith("<span")][:200]
    out = f"<p>Warnings and errors before the last {LOG_LINES} lines:</p><pre>" + "\n".join(earlier) + "</pre>" if earlier else ""
    return out + "<pre>" + "\n".join(map(marked, tail)) + "</pre>"


def footer(runs):
    said = []
    for run in runs:
        build, machine = run.summary.get("build", {}), run.summary.get("machine", {})
        if build:
            said.append(f"Spindrift {build.get('version', '')}, commit {build.get('commit', '')}, {build.get('compiler', '')} {build.get('flags', '')}; "
                        f"{machine.get('processor', '')} ({machine.get('host', '')})")
    return "".join(f"<p>{escape(s)}</p>" for s in dict.fromkeys(said))


# ---- the page ------------------------------------------------------------------------------------------------------------------------


def build(runs):
    if len({r.name for r in runs}) < len(runs):
        for r in runs:
            r.name = str(r.folder)
    one = runs[0] if len(runs) == 1 else None
    over_time = time_figures(runs)
    parts = [section("model", "What was modelled", model(one)) if one else section("differences", "Differences of the scenes", differences(runs)),
             section("key-figures", "Key figures", key_figures(one) if one else compared_figures(runs))]
    parts += [section(key, title, over_time[key]) for key, title in list(GROUPS.items())[:2]]
    if one:
        parts.append(section("sea-pictures", "The sea", sea(one)))
    parts.append(section("spectra", "Spectra of motions", spectra(runs)))
    if one:
        parts.append(section("flow", "The flow", flow(one)))
    parts += [section(key, title, over_time[key]) for key, title in list(GROUPS.items())[2:]]
    if one:
        parts += [section("time-spent", "Where the time was spent", where_time(one) + counts(one)),
                  section("efficiency", "Parallel efficiency", efficiency(one)), section("scene", "Scene", scene(one)),
                  section("log", "Log", log(one))]
    parts = [p for p in parts if p]
    title = one.title if one else "Comparison: " + ", ".join(r.name for r in runs)
    head = "".join(f"<h3>{escape(r.name)}: {escape(r.title)}</h3><p class=\"facts\">{escape(facts(r))}</p>{status(r)}" for r in runs) if not one else ""
    links = "".join(f'<a href="#{key}">{escape(name)}</a>' for key, name, _ in parts)
    style = (pathlib.Path(__file__).parent / "style.css").read_text(encoding="utf-8")
    log_link = '<a href="#log">log</a>' if any(key == "log" for key, *_ in parts) else "log"
    eyebrow = f'Spindrift run · {escape(one.summary.get("scene") or one.name)}' if one else "Spindrift runs"
    top = f'<p class="facts">{escape(facts(one))}</p><nav>{links}</nav></header>{status(one, log_link)}' if one else f"<nav>{links}</nav></header>{head}"
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{escape(title)}</title><style>\n{style}</style></head>\n<body><main><header><p class=\"eyebrow\">{eyebrow}</p>"
            f"<h1>{escape(title)}</h1>{top}\n" + "<div class=\"page\">" + "\n".join(body for *_, body in parts) + f"</div>\n<footer>{footer(runs)}</footer></main></body></html>\n")
