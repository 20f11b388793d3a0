"""What the runs of a study say: errors with intervals, front, answer, error budget, next best spend, what was not tested. Plain functions of
the plan and of what each run came to; no files but histories. Called by spindrift_study.py; tested in
tests/src/report/study_test.py. SPDX-License-Identifier: Apache-2.0"""
import math
import statistics

import study_measures as measures

WORDS = {"rms": "rms difference of", "max": "largest difference of", "mean": "mean of", "last": "end of", "deviation": "deviation of",
         "peak": "peak of", "amplitude": "amplitude of", "phase": "phase of", "period": "period of", "damping": "damping of",
         "damage": "damage-equivalent range of"}
SAME_COST = 0.05  # relative: costs nearer than that are called equal, the more accurate rung is taken
SURE_COST = 0.015  # a ratio of costs is known when the standard error of its median is below that
LEAST_PAIRS, MOST_TIMINGS, LEAST_AGAIN_S = 4, 12, 60.0  # turns of two rungs; timings of a run; processor time that timing again may take in any case


def number(value, digits=3):
    return "-" if value is None or not math.isfinite(value) else f"{value:.{digits}g}"


def percent(value):
    return f"{100.0 * value:.3g} %"


def over(gaps, scale):
    """Differences in units of a scale. Over one of zero those that are all zero stay so, and others have no meaning."""
    if not scale:
        return [] if any(gaps) else gaps
    return [g / scale for g in gaps]


def target_words(metric):
    """'2 % of the mean of platform.pitch_deg'."""
    what = f"{WORDS[metric['measure']]} {metric['column']}"
    if metric["relative"]:
        return f"{percent(metric['target'])} of the {what}"
    if metric["divide_by"] != 1.0:
        return f"{percent(metric['target'])} of {metric['divide_by']:g} in the {what}"
    return f"{metric['target']:g} in the {what}"


class Judge:
    def __init__(self, plan, results, history):
        """`results`: by run name what the ledger holds; `history(run name)`: (time, column reader) of a finished run."""
        self.plan, self.results, self.history = plan, results, history
        self.metrics, self.confidence = plan["metrics"], plan["options"]["confidence"]
        self.rungs = [r for r in plan["rungs"] if any(run["name"] in results for run in r["runs"])]
        self.by_name = {r["name"]: r for r in self.rungs}
        self.limits = {}  # (metric, group) -> Richardson's words
        self.references = {}
        self.of_zero = {}  # metrics whose relative error has no meaning
        self.quantities = {r["name"]: self._quantities(r) for r in self.rungs}
        self.costs = {r["name"]: self._cost(r) for r in self.rungs}
        self.estimates = {r["name"]: [self._estimate(r, m) for m in range(len(self.metrics))] for r in self.rungs}
        self._borrow()

    # What runs came to ---------------------------------------------------------------------------------------------------------
    def _done(self, run):
        return self.results.get(run["name"], {}).get("exit_code") == 0

    def failed(self, rung):
        for run in rung["runs"]:
            if run["name"] in self.results and not self._done(run):
                return self.results[run["name"]]["reason"]
        return None

    def _quantities(self, rung):
        """[metric][replica]; nan of a run that is not there."""
        rows = [[math.nan] * len(rung["runs"]) for _ in self.metrics]
        for n, run in enumerate(rung["runs"]):
            if not self._done(run):
                continue
            time, column = self.history(run["name"])
            for m, metric in enumerate(self.metrics):
                if metric["measure"] not in measures.OF_TWO_HISTORIES:
                    rows[m][n] = measures.quantity(metric, time, column(metric["column"]))
        if rung.get("fixed"):
            rows = [row * len(self.plan["replicas"]["points"]) for row in rows]
        return rows

    def _cost(self, rung):
        """Least processor time of a run, its mean over the replicas; that of its parts; the spread of repeated timings; memory."""
        runs = [self.results[run["name"]] for run in rung["runs"] if run["name"] in self.results]
        least = [min(r["core_s"]) for r in runs if r["core_s"]]
        if not least:
            return {"core_s": math.nan, "low": math.nan, "high": math.nan, "memory": math.nan, "timings": 0, "parts": {}}
        value = sum(least) / len(least)
        repeated = [r["core_s"] for r in runs if len(r["core_s"]) > 1]
        spread = max((max(c) / min(c) for c in repeated), default=1.0)
        shares = [r["shares"] for r in runs if r.get("shares")]
        parts = {name: value * sum(s.get(name, 0.0) for s in shares) / len(shares) for name in sorted(set().union(*shares))}
        return {"core_s": value, "low": min(least), "high": max(max(least), value * spread), "parts": parts,
                "memory": max(r["memory"] for r in runs), "timings": max(len(r["core_s"]) for r in runs)}

    # Errors --------------------------------------------------------------------------------------------------------------------
    def is_reference(self, rung):
        return bool(self.plan["reference"]) and self.plan["reference"]["variant"] == rung["name"]

    def _limit(self, rung, m):
        """Richardson's limit along the axis of the reference, all else as in `rung`: (value by replica, allowance). Of a count (cells, components), whose larger values cost more, the step is 1 over it."""
        axis = [a["name"] for a in self.plan["axes"]].index(self.plan["reference"]["limit"])
        group = (m, rung["variant"], tuple(p for a, p in enumerate(rung["at"]) if a != axis))
        if group in self.limits:
            return self.limits[group]
        steps = [float(v) for v in self.plan["axes"][axis]["values"]]
        levels = sorted(((steps[r["at"][axis]], r) for r in self.rungs if r["variant"] == rung["variant"] and r["at"]
                         and tuple(p for a, p in enumerate(r["at"]) if a != axis) == group[2]), key=lambda level: level[0])
        if len(levels) > 1 and self.costs[levels[-1][1]["name"]]["core_s"] > self.costs[levels[0][1]["name"]]["core_s"]:
            levels = [(1.0 / v, r) for v, r in reversed(levels)]
        values, allowances, orders, why = [], [], [], ""
        for n in range(len(self.quantities[rung["name"]][m])):
            q = [(h, self.quantities[r["name"]][m][n]) for h, r in levels if n < len(self.quantities[r["name"]][m])]
            q = [(h, v) for h, v in q if math.isfinite(v)]
            if len(q) < 3:
                values.append(math.nan)
                continue
            value, order, allowance, said = measures.richardson([h for h, _ in q], measures.unwrapped(self.metrics[m], [v for _, v in q]))
            values.append(value), allowances.append(allowance), orders.append(order)
            why = why or said
        orders = [p for p in orders if math.isfinite(p)]
        self.limits[group] = {"values": values, "allowance": max(allowances, default=math.nan), "why": why,
                              "order": sum(orders) / len(orders) if orders else None}
        return self.limits[group]

    def _differences(self, rung, m):
        """Paired by replica; the reference's own mean value; an allowance."""
        metric, reference = self.metrics[m], self.plan["reference"]
        mine = self.quantities[rung["name"]][m]
        if not reference:
            return [], math.nan, 0.0
        if metric["measure"] in measures.OF_TWO_HISTORIES:
            return self._history_differences(rung, metric), math.nan, 0.0
        allowance = 0.0
        if reference["variant"]:
            theirs = self.quantities.get(reference["variant"], [[]] * len(self.metrics))[m]
        elif reference["history"]:
            theirs = [self._of_file(rung, metric)] * len(mine)
        else:
            limit = self._limit(rung, m)
            theirs, allowance = limit["values"], limit["allowance"]
        pairs = [(a, b) for a, b in zip(mine, theirs) if math.isfinite(a) and math.isfinite(b)]
        gaps = [measures.gap(metric, a, b) for a, b in pairs]
        known = [b for b in theirs if math.isfinite(b)]
        return gaps, sum(known) / len(known) if known else math.nan, allowance

    def _of_file(self, rung, metric):
        """What the metric takes from the reference's file, up to where the runs of the rung end."""
        ends = [self.history(run["name"])[0][-1] for run in rung["runs"] if self._done(run)]
        if not ends:
            return math.nan
        time, column = self.history(self.plan["reference"]["history"])
        until = min(max(ends), math.inf if metric["until_s"] is None else metric["until_s"])
        return measures.quantity({**metric, "until_s": until}, time, column(metric["column"]))

    def _history_differences(self, rung, metric):
        reference = self.plan["reference"]
        if reference["variant"]:
            other = self.by_name.get(reference["variant"])
            return self._gaps_of_histories(rung, other, metric) if other else []
        done = [run["name"] for run in rung["runs"] if self._done(run)]
        return self._gaps(metric, [(name, reference["history"]) for name in done if reference["history"]])

    def _gaps_of_histories(self, rung, other, metric):
        """Of two rungs, paired by replica; a rung that replicas do not touch stands beside each of the other's."""
        mine, theirs = (r["runs"] * len(self.plan["replicas"]["points"]) if r.get("fixed") else r["runs"] for r in (rung, other))
        return self._gaps(metric, [(a["name"], b["name"]) for a, b in zip(mine, theirs) if self._done(a) and self._done(b)])

    def _gaps(self, metric, pairs):
        gaps = []
        for mine, other in pairs:
            (t, x), (t_ref, x_ref) = self.history(mine), self.history(other)
            gaps.append(measures.difference(metric, t, x(metric["column"]), t_ref, x_ref(metric["column"])))
        return [g for g in gaps if math.isfinite(g)]

    def _estimate(self, rung, m):
        """Of the error in units of the target's: relative, or divided."""
        metric = self.metrics[m]
        gaps, own, allowance = self._differences(rung, m)
        scale = abs(own) if metric["relative"] else metric["divide_by"]
        if gaps and not scale and (any(gaps) or allowance):
            self.of_zero[m] = None
            gaps = []
        if not gaps:
            return measures.Estimate(math.nan)
        result = measures.estimate(over(gaps, scale))
        result.allowance = allowance / scale if scale else 0.0
        return result

    def _borrow(self):
        """A rung with too few replicas of its difference takes the scatter of the next cheaper one that has its own, or else of the cheapest
        that has. Where the reference has too few, a rung's own scatter is that of its difference from the dearest other rung that has replicas."""
        if not self.plan["replicas"]:
            return
        for m in range(len(self.metrics)):
            rows = {r["name"]: self.estimates[r["name"]][m] for r in self.rungs}
            lenders = {r["name"]: measures.Scatter.of(e) for r in self.rungs
                       if (e := rows[r["name"]]).error is not None and not self.is_reference(r)} or self._scatter_among(m)
            for name, own in rows.items():
                if own.error is None and math.isfinite(own.value) and lenders:
                    lender = name if name in lenders else self._next_cheaper(name, lenders)
                    own.take(lenders[lender], None if lender == name else lender)

    def _next_cheaper(self, name, names):
        cost = {n: self.costs[n]["core_s"] for n in (name, *names)}
        return max((n for n in names if cost[n] <= cost[name]), key=cost.get, default=min(names, key=cost.get))

    def _scatter_among(self, m):
        """By rung with replicas, or that they do not touch: the scatter of its paired difference from the dearest other rung with replicas."""
        rich = sorted((r for r in self.rungs if self._finished(r) > 1), key=lambda r: self.costs[r["name"]]["core_s"])
        found = {}
        for rung in rich + [r for r in self.rungs if r.get("fixed") and self._finished(r)]:
            other = next((r for r in reversed(rich) if r is not rung), None)
            gaps = self._scaled_gaps(rung, other, m) if other else []
            if len(gaps) > 1:
                found[rung["name"]] = measures.Scatter.of(measures.estimate(gaps), against=other["name"])
        return found

    def _finished(self, rung):
        return sum(self._done(run) for run in rung["runs"])

    def _scaled_gaps(self, rung, other, m):
        """Of two rungs, paired by replica, in units of the target's."""
        metric = self.metrics[m]
        if metric["measure"] in measures.OF_TWO_HISTORIES:
            return [g / metric["divide_by"] for g in self._gaps_of_histories(rung, other, metric)]
        pairs = [(a, b) for a, b in zip(self.quantities[rung["name"]][m], self.quantities[other["name"]][m])
                 if math.isfinite(a) and math.isfinite(b)]
        scale = (sum(abs(b) for _, b in pairs) / len(pairs) if pairs else 0.0) if metric["relative"] else metric["divide_by"]
        return over([measures.gap(metric, a, b) for a, b in pairs], scale)

    # Verdict -------------------------------------------------------------------------------------------------------------------
    def targets(self):
        return [m for m, metric in enumerate(self.metrics) if metric["target"] is not None]

    def confidence_of(self, rung):
        estimates = self.estimates[rung["name"]]
        if any(not math.isfinite(estimates[m].value) for m in self.targets()):
            return 0.0
        return measures.all_within([estimates[m].within(self.metrics[m]["target"]) for m in self.targets()])

    def why_unsure(self, rung):
        """Why no confidence can be stated for the rung; empty where one can."""
        if not self.plan["replicas"]:
            return "the study has no replicas"
        unknown = [self.metrics[m]["column"] for m in self.targets() if self.estimates[rung["name"]][m].error is None]
        return f"too few replicas show the scatter of {' and '.join(dict.fromkeys(unknown))}" if unknown else ""

    def shortfall(self, rung):
        """Largest error over its target; without targets the first metric's error."""
        estimates = self.estimates[rung["name"]]
        if not self.metrics:
            return math.nan
        if not self.targets():
            return abs(estimates[0].value)
        return max(abs(estimates[m].value) / self.metrics[m]["target"] for m in self.targets())

    def candidates(self):
        """Rungs that may be the answer: all runs done, not the reference."""
        return [r for r in self.rungs if not self.is_reference(r) and self.failed(r) is None and math.isfinite(self.shortfall(r))]

    def good(self):
        return sorted((r for r in self.candidates() if self.targets() and self.confidence_of(r) >= (1.0 if self.why_unsure(r) else self.confidence)),
                      key=lambda r: self.costs[r["name"]]["core_s"])

    def choose(self):
        """The cheapest good one; of those that cost the same the more accurate."""
        good = self.good()
        return min((r for r in good if self._dearer(r, good[0])[0] <= 1.0 + SAME_COST), key=self.shortfall) if good else None

    def _timings(self, rung):
        return self.results[rung["runs"][0]["name"]]["core_s"]

    def _dearer(self, rung, cheapest):
        """How many times as dear a rung is, by the least timings or by the median over turns in which both were timed, after the first, whichever is less: others on the computer
        slow down what runs at a time alike. And the standard error of that median, infinite without enough turns."""
        turns = [a / b for a, b in zip(self._timings(rung)[1:], self._timings(cheapest)[1:])]
        least = self.costs[rung["name"]]["core_s"] / self.costs[cheapest["name"]]["core_s"]
        if rung is cheapest or len(turns) < LEAST_PAIRS:
            return least, 0.0 if rung is cheapest else math.inf
        middle = statistics.median(turns)
        return min(least, middle), 1.86 * statistics.median(abs(t - middle) for t in turns) / math.sqrt(len(turns))  # of normal errors

    def to_time(self, repeats):
        """Rungs that are to be timed once more, in turns. Those whose cost decides the answer, the good ones that cost less than twice the cheapest, are timed `repeats` times;
        then those not much dearer than the cheapest until it is known which are."""
        self.costs = {r["name"]: self._cost(r) for r in self.rungs}  # of all timings by now
        good = self.good()
        if len(good) < 2:
            return []
        cost = {r["name"]: self.costs[r["name"]]["core_s"] for r in good}
        least = cost[good[0]["name"]]
        few = [r for r in good if cost[r["name"]] < 2.0 * least and len(self._timings(r)) < repeats]
        if few or repeats == 1:
            fewest = min((len(self._timings(r)) for r in few), default=0)
            return [r for r in few if len(self._timings(r)) == fewest]
        again = math.fsum(s for r in self.results.values() for s in r["core_s"][1:])
        if again > max(LEAST_AGAIN_S, math.fsum(s for r in self.results.values() for s in r["core_s"][:1])):
            return []
        near = [r for r in good if cost[r["name"]] < 1.25 * least]
        unsure = [r for r in near if self._dearer(r, good[0])[1] > SURE_COST and len(self._timings(r)) < MOST_TIMINGS]
        return near if unsure else []

    # Sources -------------------------------------------------------------------------------------------------------------------
    def _pivot(self):
        return next((r for r in self.rungs if r["at"] and not any(r["at"])), None)

    def axis_effects(self, base):
        """By axis and metric: what going to the dearest point of that axis alone changes, paired; None where it was not run."""
        effects = []
        for a, axis in enumerate(self.plan["axes"]):
            others = [r for r in self.rungs if r["variant"] == base["variant"] and r["at"] and self.failed(r) is None
                      and all(p == q for i, (p, q) in enumerate(zip(r["at"], base["at"])) if i != a) and r is not base]
            if not others or not base["at"]:
                effects.append({"axis": axis["name"], "to": None, "effects": []})
                continue
            best = max(others + [base], key=lambda r: self.costs[r["name"]]["core_s"])
            if best is base:
                best = max(others, key=lambda r: self.costs[r["name"]]["core_s"])
            found = []
            for m, metric in enumerate(self.metrics):
                if metric["measure"] in measures.OF_TWO_HISTORIES:
                    mine, theirs = self.estimates[base["name"]][m].value, self.estimates[best["name"]][m].value
                    found.append(measures.Estimate(mine - theirs))
                    continue
                pairs = [measures.gap(metric, x, y) for x, y in zip(self.quantities[base["name"]][m], self.quantities[best["name"]][m])
                         if math.isfinite(x) and math.isfinite(y)]
                known = [abs(v) for v in self.quantities[best["name"]][m] if math.isfinite(v)]
                scale = (sum(known) / len(known) if known else math.nan) if metric["relative"] else metric["divide_by"]
                found.append(measures.estimate(over(pairs, scale)))
            effects.append({"axis": axis["name"], "to": best["name"], "effects": found})
        return effects

    def weight(self, effects):
        """Of an axis: its largest effect, over the target where there is one."""
        sizes = [abs(e.value) / (self.metrics[m]["target"] or 1.0) for m, e in enumerate(effects["effects"]) if math.isfinite(e.value)]
        return max(sizes, default=0.0)

    def crossed(self):
        """Indices of the axes whose pairs are run: those that matter most at the pivot."""
        pivot = self._pivot()
        if pivot is None:
            return []
        effects = self.axis_effects(pivot)
        ranked = sorted(range(len(effects)), key=lambda a: -self.weight(effects[a]))
        return [a for a in ranked[:self.plan["options"]["crossed"]] if self.weight(effects[a]) > 0.0]

    def budget(self, base):
        """Sources of error at `base`, by metric, largest first."""
        rows = []
        effects = self.axis_effects(base) if base["at"] else []
        for m, metric in enumerate(self.metrics):
            own, sources = self.estimates[base["name"]][m], []
            for effect in effects:
                if effect["to"] and math.isfinite(effect["effects"][m].value):
                    e = effect["effects"][m]
                    sources.append({"source": f"axis {effect['axis']} (against {effect['to']})", "size": abs(e.value), "half": e.half(self.confidence)})
            if self.plan["replicas"] and own.error is not None:
                noise = own.error * measures.student_quantile(0.5 + 0.5 * self.confidence, own.freedom) if own.error else 0.0
                sources.append({"source": f"chance, {own.count} replica{'s' if own.count > 1 else ''}", "size": noise, "half": None})
            if own.allowance:
                sources.append({"source": "the limit itself", "size": own.allowance, "half": None})
            if not effects and math.isfinite(own.value):
                sources.append({"source": "what this configuration leaves out against the reference", "size": abs(own.value), "half": own.half(self.confidence)})
            rows.append({"metric": metric["name"], "sources": sorted(sources, key=lambda s: -s["size"])})
        return rows

    def next_spend(self, answer):
        """One sentence: where the next core-second tells most."""
        if not self.plan["reference"]:
            return "a [reference], to know errors"
        if why := self.without_meaning(self.targets() or [0] * bool(self.metrics)):
            return f"another scale, no run: {why}"
        if not self.metrics or not self.candidates():
            return "nothing can be said: no run can be compared"
        if self.targets() and answer is None:
            near = [r for r in self.candidates() if self.shortfall(r) <= 1.0]
            if near and self.plan["replicas"]:
                rung = min(near, key=lambda r: self.costs[r["name"]]["core_s"])
                count = max(self.replicas_needed(rung, m) for m in self.targets())
                more = count - min(self.estimates[rung["name"]][m].count for m in self.targets())
                return (f"replicas: '{rung['name']}' is inside every target by its mean alone; about {more} more of it and of the reference "
                        f"({number(more * self.costs[rung['name']]['core_s'])} core-s and the reference's) would tell")
            best = min(self.candidates(), key=self.shortfall)
            return f"finer: the nearest, '{best['name']}', misses its worst target by a factor {number(self.shortfall(best))}"
        base = answer or min(self.candidates(), key=self.shortfall)
        rows = [(s["size"] / (self.metrics[m]["target"] or 1.0), s["source"], self.metrics[m])
                for m, row in enumerate(self.budget(base)) for s in row["sources"][:1]]
        if not rows:
            return "none: no source of error was found"
        size, source, metric = max(rows, key=lambda r: r[0])
        share = f", {percent(size)} of its target" if metric["target"] else ""
        return f"{source}: the largest source of error of '{base['name']}' in the {WORDS[metric['measure']]} {metric['column']}{share}"

    def replicas_needed(self, rung, m):
        """So many that the interval fits the target, by the scatter so far."""
        e, target = self.estimates[rung["name"]][m], self.metrics[m]["target"]
        room = target - e.allowance - abs(e.value)
        if not e.error or room <= 0.0:
            return e.count
        scatter = e.error * math.sqrt(e.count)
        for count in range(e.count, 10000):
            if scatter / math.sqrt(count) * measures.student_quantile(0.5 + 0.5 * self.confidence, max(1, count - 1)) <= room:
                return count
        return 10000

    def not_tested(self, left_out):
        said = []
        if not self.plan["replicas"] and self.metrics:
            said.append("chance: the study has no [replicas], so no noise floor and no confidence")
        reference = self.plan["reference"]
        if reference and reference["variant"]:
            said.append(f"the reference: what '{reference['variant']}' itself misses")
        if reference and reference["history"]:
            said.append("the reference's own error and scatter: it is one history from elsewhere")
        if reference and reference["limit"]:
            said.append(f"anything but axis '{reference['limit']}': errors are against its limit with all else as in the run")
        for (m, *_), limit in self.limits.items():
            if limit["why"]:
                said.append(f"a limit of {self.metrics[m]['name']}: {limit['why']}")
        if why := self.without_meaning(range(len(self.metrics))):
            said.append(f"errors without meaning: {why}")
        ran = {r["name"] for r in self.rungs}
        skipped = [r["name"] for r in self.plan["rungs"] if r["name"] not in ran and not r["later"] and r["name"] not in left_out]
        unpaired = sum(1 for r in self.plan["rungs"] if r["later"] and r["name"] not in ran)
        if self.plan["options"]["design"] == "one_at_a_time" and len(self.plan["axes"]) > 1:
            said.append("axes together: each was moved by itself")
        if unpaired:
            said.append(f"{unpaired} pairs of points on axes that matter less")
        if left_out:
            said.append("beyond the budget: " + ", ".join(left_out))
        if skipped:
            said.append("not run: " + ", ".join(skipped))
        for rung in self.rungs:
            if (why := self.failed(rung)) is not None:
                said.append(f"'{rung['name']}', which failed: {why}")
        return said + self._stand_ins()

    def _stand_ins(self):
        """Sentences: which scatter stands in for one that was not measured."""
        borrowers, against = {}, set()
        for name, row in self.estimates.items():
            for e in row:
                if e.lender:
                    borrowers.setdefault(e.lender, {})[f"'{name}'"] = None
                elif e.against:
                    against.add(e.against)
        return [f"scatter of {', '.join(names)}, too few replicas: the scatter of '{lender}' stands in for it" for lender, names in sorted(borrowers.items())] + [
            f"scatter against the reference, which has too few replicas: that against '{name}' stands in for it" for name in sorted(against)]

    # Result --------------------------------------------------------------------------------------------------------------------
    def without_meaning(self, metrics):
        """Of those that are divided by a reference of zero: what is wrong, and what to do. Empty where none is."""
        named = [f"{WORDS[self.metrics[m]['measure']]} {self.metrics[m]['column']} is 0" for m in metrics if m in self.of_zero]
        return f"the {' and the '.join(named)} in the reference: a relative error has no meaning, use divide_by" if named else ""

    def sentence(self, answer):
        if not self.plan["reference"]:
            return "no reference: the table has each configuration's own values"
        if not self.targets():
            return "no metric has a target: the Pareto front shows what each error costs"
        wanted = " and ".join(target_words(self.metrics[m]) for m in self.targets())
        if answer is None and (why := self.without_meaning(self.targets())):
            return f"nothing is known to be within {wanted}: {why}"
        if answer is None:
            near = min(self.candidates(), key=self.shortfall, default=None)
            if near is None:
                return f"nothing is known to be within {wanted}: no run can be compared"
            tail = (f"the nearest, '{near['name']}', is at {number(self.shortfall(near))} of its worst target"
                    + ("" if self.why_unsure(near) else f", {self._confidence_words(near)}"))
            return f"nothing is known to be within {wanted}; {tail}"
        cost = self.costs[answer["name"]]
        why = self.why_unsure(answer)
        sure = f"confidence not known: {why}" if why else self._confidence_words(answer)
        return (f"cheapest within {wanted}: '{answer['name']}'; costs {number(cost['core_s'])} core-s and "
                f"{cost['memory'] / 1e6:.0f} MB a run; {sure}")

    def _confidence_words(self, rung):
        """The confidence, and whose scatter it rests on where that is borrowed."""
        rests_on = dict.fromkeys(f"the borrowed scatter of '{e.lender}'" if e.lender else f"scatter against '{e.against}', as the reference has too few replicas"
                                 for m in self.targets() if (e := self.estimates[rung["name"]][m]).lender or e.against)
        return f"confidence {percent(self.confidence_of(rung))}" + (f" by {' and '.join(rests_on)}" if rests_on else "")

    def result(self, left_out=()):
        answer = self.choose()
        ranked = [r for r in self.rungs if not self.is_reference(r) and self.failed(r) is None]
        overall = measures.front([self.shortfall(r) for r in ranked], [self.costs[r["name"]]["core_s"] for r in ranked])
        on_front = [ranked[i]["name"] for i in overall]
        rungs = []
        for rung in self.rungs:
            row = {"name": rung["name"], "variant": rung["variant"], "at": rung["at"], "cost": self.costs[rung["name"]],
                   "failed": self.failed(rung), "on_front": rung["name"] in on_front, "is_reference": self.is_reference(rung),
                   "confidence": self.confidence_of(rung) if self.targets() and not self.why_unsure(rung) else None, "errors": {}}
            for m, metric in enumerate(self.metrics):
                e = self.estimates[rung["name"]][m]
                known = math.isfinite(e.value)
                low, high = e.size_interval(self.confidence) if known else (None, None)
                values = measures.unwrapped(metric, [v for v in self.quantities[rung["name"]][m] if math.isfinite(v)])
                scatter = measures.estimate(values) if values else None
                row["errors"][metric["name"]] = {
                    "error": abs(e.value) if known else None, "signed": e.value if known else None, "low": low, "high": high,
                    "replicas": e.count, "scatter_of": e.lender, "scatter_against": e.against,
                    "value": measures.gap(metric, sum(values) / len(values), 0.0) if values else None,
                    "scatter": scatter.error * math.sqrt(len(values)) if scatter and scatter.error is not None else None}
            rungs.append(row)
        base = answer or (min(self.candidates(), key=self.shortfall) if self.candidates() else None)
        chosen = next((run for run in answer["runs"] if self._done(run)), None) if answer else None
        return {"format": "spindrift-study-2", "study": self.plan["study"], "reference": self.plan["reference"], "metrics": self.metrics,
                "replicas": len(self.plan["replicas"]["points"]) if self.plan["replicas"] else 0, "confidence": self.confidence,
                "axes": self.plan["axes"], "answer": answer["name"] if answer else None, "sentence": self.sentence(answer),
                "scene": f"{chosen['name']}/scene.toml" if chosen else None, "front": on_front, "rungs": rungs,
                "budget_of": base["name"] if base else None, "budget": self.budget(base) if base else [],
                "next": self.next_spend(answer), "not_tested": self.not_tested(left_out),
                "limits": [{"metric": self.metrics[m]["name"], "of": variant, "order": l["order"], "allowance": l["allowance"], "why": l["why"]}
                           for (m, variant, _), l in self.limits.items()],
                "core_s_spent": math.fsum(s for r in self.results.values() for s in r["core_s"])}
