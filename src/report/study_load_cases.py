"""A table of design load cases from the runs of a study: statistics of each case, design extremes with their factors, damage-equivalent
ranges of a life. Plain functions of the plan and of histories. IEC 61400-1:2019, 7.6.2 (the characteristic extreme of a case is the mean
over its seeds of their largest values) and annex G (damage by wind bins); rainflow counting after ASTM E1049-85. Called by
spindrift_study.py; tested in tests/src/report/study_load_cases_test.py. SPDX-License-Identifier: Apache-2.0"""
import csv
import io
import math

import numpy as np

import study_measures as measures

HOURS_A_YEAR = 8766.0


def bin_shares(speeds, mean_wind, shape):
    """Share of the time of each wind speed's bin, which reaches half way to its neighbours, by Weibull's distribution with that mean."""
    scale = mean_wind / math.gamma(1.0 + 1.0 / shape)
    edges = [0.5 * (a + b) for a, b in zip(speeds, speeds[1:])]
    edges = [speeds[0] - (edges[0] - speeds[0]), *edges, speeds[-1] + (speeds[-1] - edges[-1])]
    below = [1.0 - math.exp(-((max(0.0, e) / scale) ** shape)) for e in edges]
    return [b - a for a, b in zip(below, below[1:])]


def damage_rate(t, x, exponent):
    """Sum of n r^m a second."""
    return sum(count * size**exponent for size, count in measures.rainflow(x)) / (t[-1] - t[0])


class LoadCases:
    def __init__(self, plan, results, history):
        """`results`, `history`: as study_judge.Judge has them."""
        self.plan, self.options = plan, plan["load_cases"]
        self.exponents = self.options["wohler_exponents"]
        self.rungs = [r for r in plan["rungs"] if any(results.get(run["name"], {}).get("exit_code") == 0 for run in r["runs"])]
        self.missing = [run["name"] for r in plan["rungs"] for run in r["runs"] if results.get(run["name"], {}).get("exit_code") != 0]
        self.without = {}  # by column: finished runs that give no numbers of it
        self.cases = {(r["name"], c): self._case(r, c, results, history) for r in self.rungs for c in self.options["columns"]}

    def _case(self, rung, column, results, history):
        rows = []
        for run in rung["runs"]:
            if results.get(run["name"], {}).get("exit_code") != 0:
                continue
            time, read = history(run["name"])
            t, x = measures.cut(time, read(column), self.options["from_s"], None)
            if len(t) < 2 or not np.all(np.isfinite(x)):
                self.without.setdefault(column, []).append(run["name"])
                continue
            rows.append({"mean": measures.mean(t, x), "deviation": measures.deviation(t, x), "min": float(np.min(x)), "max": float(np.max(x)),
                         "damage": [damage_rate(t, x, m) for m in self.exponents]})
        if not rows:
            return None

        def average(key):
            return sum(r[key] for r in rows) / len(rows)

        rates = [sum(r["damage"][k] for r in rows) / len(rows) for k in range(len(self.exponents))]
        return {"rung": rung["name"], "column": column, "seeds": len(rows), "mean": average("mean"), "deviation": average("deviation"),
                "min": average("min"), "max": average("max"), "least": min(r["min"] for r in rows), "largest": max(r["max"] for r in rows),
                "damage_rate": rates, "equivalent": [rate ** (1.0 / m) for rate, m in zip(rates, self.exponents)]}

    def _of(self, rung, column):
        return self.cases.get((rung["name"], column))

    def extremes(self):
        """Of each column: the design value at both ends and the case that it comes from."""
        found = []
        for column in self.options["columns"]:
            known = [(r, c) for r in self.rungs if (c := self._of(r, column))]
            if not known:
                continue
            for end, pick in (("min", min), ("max", max)):
                # A factor above 1 on a load that relieves would be unsafe.
                ranked = [(r["safety_factor"] if (c[end] > 0.0) == (end == "max") else 1.0, r, c) for r, c in known]
                factor, rung, case = pick(ranked, key=lambda row: row[0] * row[2][end])
                found.append({"column": column, "end": end, "design": factor * case[end], "characteristic": case[end], "factor": factor,
                              "rung": rung["name"], "seeds": case["seeds"]})
        return found

    def shares(self, column):
        """Share of the life of each case that fatigues and has that column, by name of its rung: its wind bin's, in equal parts where
        several stand in it."""
        name = self.options["wind_axis"]
        if not name:
            return {}
        axis = [a["name"] for a in self.plan["axes"]].index(name)
        speeds = [float(v) for v in self.plan["axes"][axis]["values"]]
        of_bin = bin_shares(speeds, self.options["mean_wind_m_s"], self.options["weibull_shape"])
        tired = [r for r in self.rungs if r["fatigue"] and r["at"] and self._of(r, column)]
        beside = [sum(r["at"][axis] == p for r in tired) for p in range(len(speeds))]
        return {r["name"]: of_bin[r["at"][axis]] / beside[r["at"][axis]] for r in tired}

    def lifetime(self):
        """Of each column and exponent: the range whose equivalent_cycles do the damage of the life."""
        seconds = 3600.0 * HOURS_A_YEAR * self.options["years"]
        found = []
        for column in self.options["columns"]:
            shares = self.shares(column)
            for k, m in enumerate(self.exponents if shares else []):
                parts = {name: share * seconds * self.cases[name, column]["damage_rate"][k] for name, share in shares.items()}
                total = math.fsum(parts.values())
                worst = max(parts, key=parts.get, default=None)
                found.append({"column": column, "exponent": m, "range": (total / self.options["equivalent_cycles"]) ** (1.0 / m),
                              "worst": worst, "worst_share": parts[worst] / total if worst and total > 0.0 else math.nan})
        return found

    def result(self):
        shares = {column: self.shares(column) for column in self.options["columns"]}
        notes = []
        if any(shares.values()):
            covered = {column: f"{100.0 * math.fsum(parts.values()):.3g} %" for column, parts in shares.items()}
            for share in dict.fromkeys(covered.values()):
                of = [column for column in covered if covered[column] == share]
                whose = "" if len(of) == len(covered) else " of " + ", ".join(of)
                notes.append(f"the cases cover {share} of the life{whose}; the rest does no damage here")
            if beside_the_axes := [r["name"] for r in self.rungs if r["fatigue"] and not r["at"]]:
                notes.append("no share of life: " + ", ".join(beside_the_axes))
        if self.missing:
            notes.append("without: " + ", ".join(self.missing))
        notes += [f"without {column} of {', '.join(names)}: no numbers from from_s on" for column, names in self.without.items()]
        return {"options": self.options, "cases": [c for c in self.cases.values() if c], "extremes": self.extremes(),
                "lifetime": self.lifetime(), "shares": shares, "notes": notes}


def as_csv(result):
    """One row a case and column."""
    exponents = result["options"]["wohler_exponents"]
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["case", "column", "seeds", "share_of_life", "mean", "deviation", "mean_of_minima", "mean_of_maxima", "least", "largest",
                   *[f"equivalent_1Hz_m{m:g}" for m in exponents]])
    for c in result["cases"]:
        rows.writerow([c["rung"], c["column"], c["seeds"], f"{result['shares'][c['column']].get(c['rung'], 0.0):.6g}",
                       *[f"{c[k]:.6g}" for k in ("mean", "deviation", "min", "max", "least", "largest")], *[f"{e:.6g}" for e in c["equivalent"]]])
    return out.getvalue()


def as_text(result):
    lines = [f"\n{'design extremes':<40}{'end':>5}{'design':>13}{'characteristic':>16}{'factor':>8}  case"]
    for e in result["extremes"]:
        lines.append(f"{e['column']:<40}{e['end']:>5}{e['design']:>13.5g}{e['characteristic']:>16.5g}{e['factor']:>8.3g}  {e['rung']} "
                     f"({e['seeds']} seed{'s' if e['seeds'] > 1 else ''})")
    if result["lifetime"]:
        o = result["options"]
        title = f"{o['years']:g} years as {o['equivalent_cycles']:.3g} cycles"
        lines.append(f"\n{title:<40}{'m':>5}{'range':>13}  most damage")
        for r in result["lifetime"]:
            lines.append(f"{r['column']:<40}{r['exponent']:>5g}{r['range']:>13.5g}  {r['worst']} ({100.0 * r['worst_share']:.3g} %)")
    return "\n".join(lines + result["notes"])
