"""The page of a study, from its study.json: error against cost of every run, the front, the cheapest run within the targets.
Called by spindrift_report.py; tested in tests/src/report/report_test.py. SPDX-License-Identifier: Apache-2.0"""
import json
import math
import pathlib

import matplotlib.pyplot as plt

import figures
import page


def _drawing(study, metric):
    """Runs with a positive error, which is what a logarithmic axis can show; the front joined."""
    drawn = [(run["core_seconds"], run["errors"][metric["name"]], run) for run in study["runs"]
             if (run.get("errors", {}).get(metric["name"]) or 0.0) > 0.0]
    if not drawn:
        return ""
    figure, axis = plt.subplots(figsize=(7.0, 3.6))
    for cost, error, run in drawn:
        axis.loglog(cost, error, "o", color=figures.PALETTE[0 if run["on_front"] else 7], markersize=6 if run["on_front"] else 4)
        axis.annotate(run["name"], (cost, error), textcoords="offset points", xytext=(5, 4), fontsize=7.5)
    front = sorted((cost, error) for cost, error, run in drawn if run["on_front"])
    axis.loglog([c for c, _ in front], [e for _, e in front], "-", color=figures.PALETTE[0], linewidth=0.9)
    if metric.get("target"):
        axis.axhline(metric["target"], color=figures.PALETTE[6], linestyle="--", linewidth=0.9)
    axis.set_xlabel("cost [core-seconds]")
    axis.set_ylabel(f"{metric['name']}: error of {metric['column']}")
    return figures.as_html(figure, f"Error of {metric['column']} against cost")


def _table(study):
    metrics = study.get("metrics", [])
    head = "".join(f"<th>{page.escape(m['name'])}</th>" for m in metrics)
    rows = ""
    for run in study["runs"]:
        errors = "".join(f"<td>{page.number(run.get('errors', {}).get(m['name'], math.nan))}</td>" for m in metrics)
        verdict = "on the front" if run["on_front"] else "" if run["exit_code"] == 0 else page.escape(run["exit_reason"])
        rows += f"<tr><td>{page.escape(run['name'])}</td><td>{page.number(run['core_seconds'])}</td>{errors}<td>{verdict}</td></tr>"
    return f"<table><thead><tr><th>run</th><th>core-seconds</th>{head}<th></th></tr></thead><tbody>{rows}</tbody></table>"


def build(folder):
    study = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    title = f"Study {pathlib.Path(study['study']).stem}"
    style = (pathlib.Path(__file__).parent / "style.css").read_text(encoding="utf-8")
    best = study.get("cheapest_within_targets")
    verdict = f"<p>Cheapest run within every target: <strong>{page.escape(best)}</strong>.</p>" if best else ""
    reference = f"<p>Errors are against {page.escape(study['reference'])}.</p>" if study.get("reference") else ""
    pictures = "".join(f"<figure>{_drawing(study, m)}</figure>" for m in study.get("metrics", []) if _drawing(study, m))
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{page.escape(title)}</title><style>{style}</style></head><body><main><h1>{page.escape(title)}</h1>"
            f"{reference}{verdict}{pictures}<section>{_table(study)}</section></main></body></html>")
