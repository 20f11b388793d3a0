"""The page of a report: sections as HTML text, each only where the data have it. Nothing on it needs a network.
Called by spindrift_report.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import base64
import itertools
import math

import numpy as np

import decay
import figures
import flow_pictures
import html_page
import impact
import motions
import quantities
import rotor_pictures
import sea_pictures
import told_bodies
import verdict
from html_page import escape, parts, safe, section
from words import LEVEL, deviation, duration, mean, number, short

# {key: (heading, folded)}
GROUPS = {"motion": ("Motions", False), "forces": ("Forces by source", False), "moments": ("Moments by source", False),
          "rotor": ("Rotor", False), "moorings": ("Lines", False), "sea": ("Gauges, probes, paddle", False),
          "rates": ("Velocities and accelerations", True), "other": ("Other columns", True)}
LOG_LINES = 80
MOST_SPECTRA = 4   # bodies


# ---- what happened -------------------------------------------------------------------------------------------------------------------


def verdict_of(run, name=""):
    checks = verdict.health(run)
    level, headline = verdict.headline(checks)
    return {"name": name, "level": level, "headline": headline, "checks": checks, "what": verdict.what_ran(run),
            "answers": verdict.answers(run), "span": _span(run), "caveats": _remarks(run, "caveats")}


def _remarks(run, key):
    """What the scene says it lacks: output.caveats or output.notes."""
    said = _value(run.scene, "output", key)
    return [str(text) for text in said] if isinstance(said, list) else []


def _span(run):
    """What the figures of the verdict are taken over."""
    if not len(run.time):
        return ""
    if verdict.is_steady(run):
        return "At the end of the march."
    if verdict.kind(run) == "tank" or verdict.is_impact(run):
        said = [text for text, _, _ in verdict.answers(run)]
        if any(text.startswith("significant height") for text in said):
            return f"Over {run.mean_range()[1]}."
        return "Over the last two waves." if any(text.startswith("wave height") for text in said) else "Of the whole run."
    if free := motions.decays(run):
        return f"{'Mean period' if all(d.several for d in free) else 'Period and damping'} from the peaks of the whole run."
    count = verdict.waves_in_means(run)
    swings = " ± standard deviation" if any("±" in value for _, value, _ in verdict.answers(run)) else ""
    return f"Means{swings} over {run.mean_range()[1]}" + (f", {number(count, 3)} waves" if math.isfinite(count) else "") + (
        "; least and greatest of the whole run." if any(text.endswith(("least", "greatest")) for text, _, _ in verdict.answers(run)) else ".")


def scene_as_given(run):
    """The file, and the keys that the command line changed: a title stays that of the file."""
    changed = run.summary.get("set") or []
    return (run.summary.get("scene") or run.name) + (" with " + ", ".join(changed) if changed else "")


def facts(run):
    s, said = run.summary, []
    steady = verdict.is_steady(run)
    if len(run.time):
        said.append(f"{run.time[-1]:.6g} pseudo-steps" if steady else f"{run.time[-1]:.6g} s simulated")
    if isinstance(s.get("wall_seconds"), (int, float)):
        said.append(f"{duration(s['wall_seconds'])} of wall time")
    if s.get("real_time_factor") and not steady:
        said.append(f"{number(s['real_time_factor'], 3)} × real time")
    machine = s.get("machine", {})
    if machine:
        said.append(f"ranks × threads: {machine.get('ranks', 1)} × {machine.get('threads_per_rank', 1)}")
    if s.get("restarts"):
        said.append(f"restarted {s['restarts']} time(s)")
    return " · ".join(said)


def drawn(run):
    """The picture that `spindrift picture` left in the run directory."""
    path = run.folder / "picture.png"
    if verdict.kind(run) == "flow":   # it is the slice that the page has anyway
        return ""
    if not path.exists() or path.stat().st_size > 4 << 20:
        return ""
    data = base64.b64encode(path.read_bytes()).decode()
    return safe(f'<figure class="wide"><img alt="The run as a picture" src="data:image/png;base64,{data}"></figure>')


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
    if wet := _value(scene, "sea", "model") not in (None, "none"):
        say("Water", _value(scene, "sea", "model"), unit("environment", "water_depth_m", "depth ", "m"))
    if wet or _value(scene, "waves", "model") not in (None, "none"):
        say("Waves", _value(scene, "waves", "model"), unit("waves", "height_m", "height ", "m"), unit("waves", "period_s", "period ", "s"))
    say("Rotor and air", str(_value(scene, "aero", "model") or "").replace("_", " "), unit("aero", "thrust_N", "thrust ", "N"),
        unit("wind", "speed_m_s", "wind ", "m/s"))
    if verdict.is_steady(run):
        say("Time", unit("time", "end_s", "to ", "pseudo-steps"))
    else:
        say("Time", unit("time", "end_s", "to ", "s"), unit("time", "window_s", "windows of ", "s"), _value(scene, "time", "integrator") if bodies else "")
    say("Coupling", _value(scene, "coupling", "scheme"))
    say("Not modelled", *_remarks(run, "caveats"))
    say("Notes", *_remarks(run, "notes"))
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


def as_written(value):
    """A value as a scene has it, numbers short."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.10g}"
    return "[" + ", ".join(map(as_written, value)) + "]" if isinstance(value, list) else str(value)


def without(scenes, key):
    """The section around a key that some scenes lack as a whole, the largest; the key itself where all have its section."""
    steps = key.split(".")
    for n in range(1, len(steps)):
        section_name = ".".join(steps[:n])
        if not all(any(k.startswith((section_name + ".", section_name + "[")) for k in scene) for scene in scenes):
            return section_name
    return key


def differences(runs):
    """Keys of the scenes that are not the same in all runs, references aside; one line for a section that some of them lack."""
    scenes = [{k: v for k, v in flattened(run.scene).items() if not k.startswith("output.expected")} for run in runs]
    keys = [k for k in dict.fromkeys(k for s in scenes for k in s) if any(s.get(k) != scenes[0].get(k) for s in scenes)]
    if not keys:
        return safe('<p class="facts">None: the scenes are the same.</p>') if all(scenes) else ""
    rows = {}
    for key in keys:
        name = without(scenes, key)
        if name == key:
            rows[name] = [as_written(s[key]) if key in s else "–" for s in scenes]
        else:
            rows[name] = ["given" if any(k.startswith((name + ".", name + "[")) for k in s) else "–" for s in scenes]
    return parts.table(["Key"] + [r.name for r in runs], [[name, *cells] for name, cells in rows.items()], range(1, len(runs) + 1))


# ---- figures and tables --------------------------------------------------------------------------------------------------------------


def _largest(names, size):
    """{name: what its unit is chosen by}: of a column its own size, of the tension of a line that of all lines, which are read beside each other."""
    sizes = {name: size(name) for name in names}
    of_lines = max((s for name, s in sizes.items() if name.endswith("tension_N")), default=0.0)
    return {name: of_lines if name.endswith("tension_N") else s for name, s in sizes.items()}


def _key_rows(run, names):
    rows, where = [], run.mean_range()
    largest = _largest(names, lambda name: np.abs(run.column(name)[np.isfinite(run.column(name))]).max(initial=0.0))
    for name in names:
        values = run.column(name)
        finite = values[np.isfinite(values)]
        unit, factor = quantities.scaled(quantities.unit_of(name, run.described), largest[name])
        low, high = (finite.min(), finite.max()) if len(finite) else (math.nan, math.nan)
        figures_of = [values[-1], mean(run.time[where[0]], values[where[0]]), deviation(run.time[where[0]], values[where[0]]), low, high]
        noise = run.round_off(name)
        rows.append((name, unit, [factor * float(v) if not abs(v) <= noise else 0.0 for v in figures_of]))
    return rows, where[1]


def _meaning(run, name):
    return (run.described.get(name) or {}).get("meaning", "")


def _spoken(run, name):
    return safe(f'<span title="{escape(_meaning(run, name))}">{escape(quantities.spoken(name))} <small class="code">{escape(name)}</small></span>')


_LEFT_OUT = (".x_m", ".y_m", ".z_m", ".roll_deg", ".pitch_deg", ".yaw_deg", ".torque_N_m", ".power_W", ".lost_particles")


def _still(run, name):
    """A motion or load that there is none of: of a turbine on land, of a prescribed thrust."""
    of_sensor = name.rpartition(".")[0] in quantities.sensors_of(run.columns)
    return (of_sensor or name.endswith(_LEFT_OUT)) and not (abs(run.column(name)) > run.round_off(name)).any()


def _impact_rows(run):
    """Loads of bodies that meet the water with a speed, without the sound in them."""
    rows = []
    for body in impact.launched(run) if verdict.is_impact(run) else ():
        load = impact.of_body(run, body)
        if not load or not load[1]:
            continue
        name, over, at, values = load
        chosen = at >= run.time[run.mean_range()[0]][0]
        unit, factor = quantities.scaled("N", np.abs(values).max(initial=0.0))
        said = [values[-1], mean(at[chosen], values[chosen]), deviation(at[chosen], values[chosen]), values.min(), values.max()]
        rows.append([safe(f'<span title="{escape(name)}, means over {short(over)}">{escape(body)} load up, mean of {short(over)}</span>'), unit] + [number(factor * float(v)) for v in said])
    return rows


def key_figures(run):
    names = [n for n in quantities.key_columns(run.columns, told_bodies.spinning(run)) if n in run.columns and not _still(run, n)]
    if not len(run.time) or not names:
        return ""

    def table(chosen, more=()):
        rows, span = _key_rows(run, chosen)
        return parts.table(["Quantity", "Unit", "Final", f"Mean, {span}", "Standard deviation", "Least", "Greatest"],
                           [[_spoken(run, n), u] + [number(v) for v in values] for n, u, values in rows] + list(more))

    rest = [n for n in run.columns[1:] if n not in names]
    return table(names, _impact_rows(run)) + (safe(f"<details><summary>All {len(run.columns) - 1} columns</summary>{table(rest)}</details>") if rest else "")


def expected(run):
    """The scene's references beside what the run gave."""
    rows, by, changed = [], {}, run.changed_keys()   # references are of the scene as its file has it
    for r in verdict.references(run):
        unit, factor = quantities.scaled(quantities.unit_of(r.column, run.described), abs(r.wanted))
        off = r.found - r.wanted
        share = f" ({100.0 * off / abs(r.wanted):+.1f} %)".replace("-", "−") if r.wanted and not r.why_not else ""
        outcome = {True: "met", False: "not judged" if changed else "not met", None: f"not compared: {r.why_not}"}[r.agrees()]
        rows.append([_spoken(run, r.column), outcome, unit, f"{number(factor * r.wanted)} ± {number(factor * r.within, 2)}", "–" if r.why_not else number(factor * r.found),
                     "–" if r.why_not else number(factor * off, 2) + share])
        by.setdefault(f"{r.source}{f'; mean {r.span}' if r.span else ''}", []).append(quantities.spoken(r.column))
    said = "".join(f"<li>{escape(', '.join(names))}: {escape(source)}</li>" for source, names in by.items() if source)
    return parts.table(["Quantity", "Outcome", "Unit", "Expected", "Found", "Difference"], rows, (1,)) + safe(f'<ul class="facts">{said}</ul>' * bool(said)) if rows else ""


def compared_figures(runs):
    """Means of each run, and how far each is from the first; folded: least and greatest values."""
    runs = [r for r in runs if len(r.time)]
    if len(runs) < 2:
        return ""
    spans = [r.mean_range() for r in runs]
    of_rows = {r.name: s[0] for r, s in zip(runs, spans)}
    table = _compared(runs, "Mean of", lambda r, name: mean(r.time[of_rows[r.name]], r.column(name)[of_rows[r.name]]))
    if not table:
        return ""
    said = "; ".join(f"{r.name}: {s[1]}" for r, s in zip(runs, spans))
    extremes = "".join(_compared(runs, title, lambda r, name, function=function: float(function(r.column(name)))) for title, function in (("Greatest", np.nanmax), ("Least", np.nanmin)))
    return (table + safe(f'<p class="facts">Means over {escape(said)}. In brackets: difference from the first, of displacements and angles, which go round zero, in their own unit.</p>')
            + safe(f"<details><summary>Greatest and least values of the whole runs</summary>{extremes}</details>"))


def _compared(runs, title, figure_of):
    """A row a quantity, a column a run."""
    names = [n for n in quantities.key_columns(runs[0].columns, told_bodies.spinning(runs[0])) if all(n in r.columns for r in runs)]
    rows, found = [], {name: [figure_of(r, name) for r in runs] for name in names}
    largest = _largest(names, lambda name: max((abs(m) for m in found[name] if math.isfinite(m)), default=0.0))
    for name, means in found.items():
        means = [0.0 if abs(m) <= r.round_off(name) else m for m, r in zip(means, runs)]
        if not any(means) and all(name in r.columns and not (abs(r.column(name)) > r.round_off(name)).any() for r in runs):   # zero throughout, in all
            continue
        unit, factor = quantities.scaled(quantities.unit_of(name, runs[0].described), largest[name])
        cells, share = [], not quantities.is_displacement(name)
        for i, value in enumerate(means):
            change = (value - means[0]) / abs(means[0]) * 100.0 if i and means[0] and share else factor * (value - means[0]) if i and not share else math.nan
            if not share and abs(change) < 1e-4 * factor * np.ptp(runs[0].column(name)):   # of what it moves by: nothing
                change = 0.0
            off = f"{change:+.2f} %".replace("-", "−") if share else f"{'+' if change > 0.0 else ''}{number(change, 3)} {unit}".strip()
            cells.append(number(factor * value) + (safe(f" <small>({escape(off)})</small>") if math.isfinite(change) else ""))
        rows.append([_spoken(runs[0], name), unit] + cells)
    return parts.table([title, "Unit"] + [r.name for r in runs], rows) if rows else ""


def _figure(title, legend, figure, caption):
    return str(parts.figure(title, legend, safe(figures.as_html(figure, escape(title))), caption))


def _about_sound(run, group):
    """Of loads of an impact: what their swing is, and what is left of it in means."""
    for body in impact.launched(run) if group.key == "forces" and verdict.is_impact(run) else ():
        load = impact.of_body(run, body)
        if load and load[0] in group.columns() and load[1]:
            unit, factor = quantities.scaled("N", float(load[3].max()))
            return (f"A row of {load[0]} is the load of one substep, with the sound waves in the water; its largest mean over {short(load[1])}, in which sound goes through the "
                    f"body and back, is {number(factor * float(load[3].max()))} {unit}.")
    return ""


def _caption(group, drawing, runs):
    said = [group.caption]
    if drawing.legend and len(runs) > 1:
        said.append("Lines: " + ", ".join(f"{words} {r.name}" for words, r in zip(itertools.cycle(("solid", "dashed", "dotted", "dash-dotted")), runs)) + ".")
    if drawing.constant:
        said.append(f"Constant: {', '.join(drawing.constant)}.")
    if drawing.zero:
        said.append(f"Zero throughout: {', '.join(drawing.zero)}.")
    said += [_about_sound(run, group) for run in runs]
    return " ".join(filter(None, said)).strip()


def _run_legend(runs, group=None):
    """Of runs that have columns of the group; without one, of all."""
    shown = {r.name: figures.legend_mark(i, i) for i, r in enumerate(runs) if group is None or set(group.columns()) & set(r.columns)}
    return shown if len(runs) > 1 else {}


def time_figures(runs):
    """{group key: HTML} of all figures over time."""
    names = list(dict.fromkeys(n for run in runs for n in run.columns))
    shown, folded, still = {}, {}, {}
    joints = {}
    for run in runs:
        for name, joint in _tables(run.scene, "joints").items():
            pair = joint.get("bodies") or []
            joints[name] = pair if joints.get(name, pair) == pair else []   # one that holds other bodies in another run has figures of its own
    for group in quantities.groups(names, joints):
        drawing = figures.series(runs, group)
        caption = _caption(group, drawing, runs)
        if drawing.figure is None:
            still.setdefault(group.key, []).append(f"{group.title}. {caption}")
            continue
        (folded if group.fold else shown).setdefault(group.key, []).append(_figure(group.title, drawing.legend or _run_legend(runs, group), drawing.figure, caption))
    out = {}
    for key in GROUPS:
        body = f'<div class="figures">{"".join(shown[key])}</div>' if key in shown else ""
        if key != "motion" or body or key in folded or runs[0].time.size < 2:   # of bodies that all stand there is nothing to tell
            body += "".join(f'<p class="facts">{escape(words)}</p>' for words in still.get(key, []) if len(names) > 1 and runs[0].time.size)
        if key in folded:
            count = len(folded[key])
            words = f"{count} more figure{'s' if count > 1 else ''}"
            body += f'<details><summary>{words}</summary><div class="figures">{"".join(folded[key])}</div></details>'
        out[key] = body
    return out


def marks(run):
    """{name: frequency in Hz} of what drives a run: waves, the rotor's turning and its blades' passing over the range of the means."""
    found = {}
    waves = run.scene.get("waves", {})
    for key in ("period_s", "peak_period_s"):
        if isinstance(waves.get(key), (int, float)) and waves[key] > 0:
            found["wave"] = 1.0 / waves[key]
    for text, column in quantities.of_rotors(run.columns, "", "rpm") if len(run.time) else ():
        if column not in run.columns:
            continue
        chosen = run.mean_range()[0]
        once = mean(run.time[chosen], run.column(column)[chosen]) / 60.0
        blades = run.blades(dict(run.rotors()).get(column.rpartition(".")[0]))
        # Turbines side by side turn alike: marked once.
        alike = "1P" in found and abs(once - found["1P"]) < 0.01 * found["1P"] and blades == run.blades()
        if once > 1e-6 and not alike:
            of = text if "1P" in found else ""
            found[f"1P{of}"] = once
            found[f"{blades}P{of}"] = blades * once
    return found


def modes_of(run, body):
    """{motion: frequency in Hz} of the modes that are named after a body."""
    found = {}
    for mode in run.summary.get("modes") or []:
        motion, _, owner = str(mode.get("name", "")).partition(" of ")
        if owner == body and motion in quantities.AXES.values() and (mode.get("frequency_Hz") or 0.0) > 0.0:
            found.setdefault(motion, mode["frequency_Hz"])
    return found


def modes(run):
    """Modes of the bodies, and where the rotor's frequencies and the waves meet them."""
    found = [m for m in run.summary.get("modes") or [] if isinstance(m, dict) and isinstance(m.get("frequency_Hz"), (int, float))]
    if not found:
        return ""
    names, so_far = [m["name"] for m in found], {}
    for n, name in enumerate(names):   # those of equal name get numbers, as `check` has them
        so_far[name] = so_far.get(name, 0) + 1
        if names.count(name) > 1:
            found[n] = {**found[n], "name": f"{name} ({so_far[name]})"}
    swing = [m for m in found if m["frequency_Hz"] > 0.0]
    rows = [[m["name"], number(1.0 / m["frequency_Hz"]), number(m["frequency_Hz"]), f"{100.0 * m['damping']:.2f} %"] for m in swing]
    rows += [[m["name"], "–", "–", f"rate {m['damping']:+.3g} 1/s"] for m in found if m["frequency_Hz"] <= 0.0]
    out = parts.table(["Mode", "Period [s]", "Frequency [Hz]", "Damping, of critical"], rows)
    at = marks(run)
    if swing and "1P" in at:
        named = [(m["name"], m["frequency_Hz"]) for m in swing]
        figure = figures.campbell(named, at.get("wave"), 60.0 * at["1P"], run.blades())
        out += safe('<div class="figures">') + safe(_figure("Campbell diagram", None, figure, "The modes do not know the rotor's speed; dotted: that of the run.")) + safe("</div>")
    return out


def decays(run):
    """Periods and damping of free decays from their peaks, beside the mode."""
    rows = []
    for d in decay.decays(run):
        body, _, quantity = d.column.rpartition(".")
        own = modes_of(run, body).get(quantities.AXES[quantities.quantity_of(d.column)])
        change = f"{100.0 * d.first:.2f} to {100.0 * d.last:.2f} %" if abs(d.first - d.last) > 0.1 * abs(d.damping) else "–"
        single = "of several motions" if d.several else "falls" if d.falling else f"{100.0 * d.damping:.2f} %"
        rows.append([_spoken(run, d.column), f"{d.swings / 2:g}", number(d.period), number(1.0 / own) if own else "–", single, change])
    if not rows:
        return ""
    return parts.table(["Motion", "Swings", "Period [s]", "Of the mode [s]", "Damping, of critical", "First to last third"], rows) + safe(
        '<p class="facts">From peaks and troughs: the mean time from each to the next, the logarithmic decrement of the ranges between them.</p>')


def timeline(run):
    """Tasks of each thread, where --trace kept them."""
    if len(run.tasks) < 10:
        return ""
    figure, legend = figures.timeline(run.tasks)
    return safe(f'<div class="figures">{_figure("Tasks of each thread", legend, figure, "A stretch from the middle of trace.json.gz, which Perfetto shows whole.")}</div>')


def spectra(runs):
    names, lowest = runs[0].columns, min(marks(runs[0]).values(), default=None)
    water = [(n.rpartition(".")[0], n) for n in names if n.endswith(".elevation_m")][:MOST_SPECTRA] if verdict.is_irregular(runs[0]) else []
    if not len(runs[0].time) or verdict.is_steady(runs[0]) or not (quantities.bodies_of(names) or water):
        return ""
    if decay.decays(runs[0]) or verdict.is_impact(runs[0]):   # some swings have a period, and no spectrum worth looking at
        return ""
    length = figures.segment_s(runs[0].time)
    if lowest is not None and length * lowest < 3.0:
        return safe(f'<p class="facts">None: a spectrum that shows {1.0 / lowest:.3g} s needs a run of {8.0 / lowest:.0f} s.</p>')
    out, words = "", "Power spectral density (Welch, Hann window), without the first quarter of the run."
    if found := marks(runs[0]):
        words += " Marked: " + ", ".join(f"{name} {frequency:.3g} Hz" for name, frequency in found.items()) + "."
    drawn = {}
    for body in quantities.bodies_of(names)[:MOST_SPECTRA]:
        for title, wanted in (("displacement", ("x", "y", "z")), ("attitude", ("roll", "pitch", "yaw"))):
            panels = [(quantities.AXES[quantities.quantity_of(n)], n) for n in names
                      if n.rpartition(".")[0] == body and quantities.quantity_of(n) in wanted]
            own = {motion: f for motion, f in modes_of(runs[0], body).items() if motion in [label for label, _ in panels] and f * length >= 2.0}
            own = {motion: f for motion, f in own.items() if any(label == motion and not figures.is_nothing(runs[0], n) for label, n in panels)}
            figure = figures.spectra(runs, panels, found | own)
            if figure is not None:
                dotted = " Dotted: the motion's own mode, " + ", ".join(f"{m} {f:.3g} Hz" for m, f in own.items()) + "." if own else ""
                drawn.setdefault(body, []).append(_figure(f"{body}: spectra of {title}", _run_legend(runs), figure, words + dotted))
    first, *others = drawn.values() or [[]]
    if water and (figure := figures.spectra(runs, water, found)) is not None:   # the sea comes before what it moves
        first = [_figure("Surface of the water: spectra", _run_legend(runs), figure, words), *first]
    out = f'<div class="figures">{"".join(first)}</div>' if first else ""
    if others:
        out += f'<details><summary>Other bodies</summary><div class="figures">{"".join("".join(o) for o in others)}</div></details>'
    return safe(out)


def sea(run):
    out = "".join(_figure(title, None, figure, words) for title, figure, words in sea_pictures.pictures(run))
    return f'<div class="figures">{out}</div>' if out else ""


def flow(run):
    """Pictures of a resolved flow, those that the run's files give."""
    out = ""
    if found := flow_pictures.residuals(run):
        figure, legend = found
        out += _figure("Residuals", legend, figure,
                       "Root mean square of the density rate, scaled residual of the mean flow, that of turbulence; CFL number of the pseudo-step.")
    pictures = list(rotor_pictures.pictures(run))
    out += "".join(_figure(title, None, figure, words) for title, figure, words in pictures)
    if pictures:   # the middle plane of a rotor says nothing
        return f'<div class="figures">{out}</div>'
    if figure := flow_pictures.wall_curves(run):
        out += _figure("Along the walls", None, figure,
                       f"In the middle plane of the walls; pressure with its sign turned. {flow_pictures.y_plus_words(run)}".strip())
    if plane := flow_pictures.middle_plane(run):
        for quantity, words in (("pressure coefficient", "Pressure above the undisturbed one on dynamic pressure"), ("Mach number", "Speed over that of sound")):
            out += _figure(f"Slice of the flow: {quantity}", None, flow_pictures.flow_slice(plane, (quantity,)), f"{words}, of the cells in the middle plane at the end of the run.")
    return f'<div class="figures">{out}</div>' if out else ""


def where_time(run):
    found = [p for p in run.summary.get("parts", []) if isinstance(p, dict) and isinstance(p.get("core_seconds"), (int, float))]
    out, total = "", sum(p["core_seconds"] for p in found)
    if total > 0:
        found.sort(key=lambda p: -p["core_seconds"])
        out += parts.bars([(p.get("name", ""), _share(p["core_seconds"], total),
                            f"{number(p['core_seconds'], 3)} core-s · {100 * p['core_seconds'] / total:.1f} %") for p in found],
                          f"Core-seconds by part, of {number(total, 3)} measured.")
    if run.trace:
        most = sorted(run.trace.items(), key=lambda kv: -kv[1])[:12]
        whole = sum(run.trace.values()) or 1.0
        out += safe("<h3>Tasks that took most</h3>") + parts.bars([(label, _share(s, whole), f"{number(s, 3)} s · {100 * s / whole:.1f} %") for label, s in most],
                                                                  "From trace.json.gz, labels summed by their first two parts.")
    return out


def _share(part, whole):
    return min(max(part / whole, 0.0), 1.0)


def efficiency(run):
    rows = [e for e in run.summary.get("efficiency", []) if isinstance(e, dict)]
    return parts.table(["Efficiency", "0 to 1", "Meaning"], [[e.get("name", ""), number(e.get("value"), 3), e.get("meaning", "")] for e in rows], (2,)) if rows else ""


def counts(run):
    found = run.summary.get("counts") or {}
    return safe('<p class="facts">' + escape(" · ".join(f"{k.replace('_', ' ')}: {v}" for k, v in found.items())) + "</p>") if found else ""


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
        level = LEVEL.match(line)
        kind = {"warning": "warning", "error": "error", "critical": "error"}.get(level[1] if level else "")
        return f'<span class="{kind}">{escape(line)}</span>' if kind else str(escape(line))

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
    return list(dict.fromkeys(said))


# ---- the page ------------------------------------------------------------------------------------------------------------------------


def build(runs, progress=lambda words: None):
    """`progress` is told what comes next: pictures of large fields take seconds."""
    if len({r.name for r in runs}) < len(runs):
        for r in runs:
            r.name = str(r.folder)
    one = runs[0] if len(runs) == 1 else None
    progress("figures over time")
    over_time = time_figures(runs)
    shown = [section(key, title, over_time[key], fold) for key, (title, fold) in GROUPS.items()]
    if one:
        found = [section("picture", "Picture", drawn(one)), section("expected", "Expected and found", expected(one)), section("decay", "Free decay", decays(one)), section("key-figures", "Key figures", key_figures(one)), *shown[:-2]]
        progress("pictures of the sea")
        found.append(section("sea-pictures", "The sea", sea(one)))
        progress("pictures of the air")
        found.append(section("flow", "The flow", flow(one)))
        progress("spectra")
        found += [section("modes", "Modes", modes(one), True), section("spectra", "Spectra of motions", spectra(runs)), section("model", "What was modelled", model(one), True), *shown[-2:],
                  section("time-spent", "Where the time was spent", where_time(one) + timeline(one) + counts(one), True),
                  section("efficiency", "Parallel efficiency", efficiency(one), True), section("scene", "Scene", scene(one), True),
                  section("log", "Log", log(one), True)]
        return html_page.render(title=one.title, eyebrow=f"Spindrift run · {scene_as_given(one)}", facts=facts(one),
                                verdicts=[verdict_of(one)], sections=[s for s in found if s], footer=footer(runs))
    found = [section("differences", "Differences of the scenes", differences(runs)), section("key-figures", "Key figures", compared_figures(runs)),
             *shown[:-2], section("spectra", "Spectra of motions", spectra(runs)), *shown[-2:]]
    return html_page.render(title="Comparison: " + ", ".join(r.name for r in runs), eyebrow="Spindrift runs", sections=[s for s in found if s],
                            verdicts=[verdict_of(r, f"{r.name}: {r.title}") for r in runs], footer=footer(runs))
