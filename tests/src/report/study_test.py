"""Laws of src/report/study_judge.py on studies whose truth is known, without a run. SPDX-License-Identifier: Apache-2.0"""
import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "src/report"))
import spindrift_study  # noqa: E402
import study_judge  # noqa: E402

MEAN = {"name": "mean", "column": "pitch", "measure": "mean", "from_s": 0.0, "until_s": None, "frequency_Hz": None, "wohler_exponent": 4.0,
        "relative": True, "divide_by": 1.0, "target": 0.02}


class Synthetic:
    """Rungs whose mean is off by a known part; each replica shifts all rungs alike, and each by a little of its own."""

    def __init__(self, offs, costs, replicas=6, shared=0.2, own=0.002, seed=1, axes=(), at=None, reference="fine", design="product",
                 metric=None, dear=None):
        self.random = np.random.default_rng(seed)
        t = np.linspace(0.0, 10.0, 101)
        names = [f"replica_{n}" for n in range(replicas)]
        shift = self.random.normal(0.0, shared, replicas)
        self.histories, self.results, rungs = {}, {}, []
        for name, off in offs.items():
            count = dear.get(name, replicas) if dear else replicas
            runs = [{"name": f"{name}/{r}", "set": [], "identity": "", "forecast_core_s": costs[name], "forecast_bytes": 1e8} for r in names[:count]]
            for n, run in enumerate(runs):
                value = 5.0 * (1.0 + off + self.random.normal(0.0, own)) + shift[n]
                self.histories[run["name"]] = (t, lambda column, v=value: np.full_like(t, v))
                self.results[run["name"]] = {"exit_code": 0, "core_s": [costs[name]], "memory": 1e8, "reason": "done"}
            where = (at or {}).get(name, [])
            later = design == "pairs" and sum(p > 0 for p in where) > 1
            rungs.append({"name": name, "variant": "base" if where else name, "scene": "", "at": where, "later": later, "runs": runs})
        self.plan = {"study": "s.toml", "commit": "", "axes": list(axes), "rungs": rungs, "metrics": [metric or MEAN],
                     "replicas": {"points": names} if replicas > 1 else None,
                     "reference": reference if isinstance(reference, dict) else {"variant": reference, "history": "", "limit": ""},
                     "options": {"design": design, "crossed": 2, "confidence": 0.95, "repeats": 3, "budget_core_h": None}}

    def judge(self):
        return study_judge.Judge(self.plan, self.results, lambda name: self.histories[name])


LADDER = {"curve": 0.2, "coarse": 0.013, "good": 0.004, "fine": 0.0}
COSTS = {"curve": 1.0, "coarse": 3.0, "good": 10.0, "fine": 100.0}


class Answer(unittest.TestCase):
    def test_pairing_finds_the_cheapest_where_seeds_scatter_more_than_rungs_differ(self):
        # Seeds scatter 4 %, rungs differ by 0.4 to 1.3 %; what replicas leave unpaired is 0.2 %.
        answers = [Synthetic(LADDER, COSTS, seed=seed).judge().result()["answer"] for seed in range(20)]
        self.assertGreaterEqual(answers.count("coarse"), 19, answers)

    def test_on_a_busy_computer_the_answer_is_the_same_in_nineteen_of_twenty_studies(self):
        """Timings are stretched by 0 to 60 %, more often by little, in spells that several of them share. Two rungs cost the same within 1 %, the others more."""
        answers = []
        for seed in range(40):
            random = np.random.default_rng(seed)
            costs = {"equal": 1.0, "better": 1.01, "dearer": 1.3, "fine": 20.0}
            study = Synthetic({"equal": 0.008, "better": 0.004, "dearer": 0.002, "fine": 0.0}, costs, replicas=1)
            spell = [1.0]

            def timed(name):
                if random.random() < 0.3:
                    spell[0] = 1.0 + 0.5 * random.random() ** 2
                return costs[name] * spell[0] * (1.0 + 0.1 * random.random() ** 2)
            for rung in study.plan["rungs"]:
                study.results[rung["runs"][0]["name"]]["core_s"] = [timed(rung["name"])]
            for _ in range(100):
                rivals = study.judge().to_time(3)
                for rung in rivals:
                    study.results[rung["runs"][0]["name"]]["core_s"].append(timed(rung["name"]))
                if not rivals:
                    break
            self.assertEqual(rivals, [])
            answers.append(study.judge().result()["answer"])
        self.assertGreaterEqual(answers.count("better"), 39, answers)

    def test_repeats_of_one_time_nothing_again(self):
        self.assertEqual(Synthetic(LADDER, COSTS).judge().to_time(1), [])

    def test_the_sentence_names_target_cost_and_confidence(self):
        result = Synthetic(LADDER, COSTS).judge().result()
        self.assertRegex(result["sentence"], r"cheapest within 2 % of the mean of pitch: 'coarse'; costs 3 core-s and 100 MB a run; confidence 9\d")
        self.assertEqual(result["scene"], "coarse/replica_0/scene.toml")
        self.assertEqual(result["front"], ["curve", "coarse", "good"])

    def test_costs_that_differ_by_noise_alone_do_not_decide(self):
        for seed in range(20):
            noise = np.random.default_rng(seed).normal(1.0, 0.01, 2)
            costs = {"rough": 3.0 * noise[0], "good": 3.0 * noise[1], "fine": 100.0}
            self.assertEqual(Synthetic({"rough": 0.01, "good": 0.002, "fine": 0.0}, costs, seed=seed).judge().result()["answer"], "good")

    def test_a_target_out_of_reach_is_said_and_the_nearest_named(self):
        result = Synthetic({"curve": 0.2, "other": 0.1, "fine": 0.0}, {"curve": 1, "other": 2, "fine": 9}).judge().result()
        self.assertIsNone(result["answer"])
        self.assertIn("nothing is known to be within 2 %", result["sentence"])
        self.assertIn("'other'", result["sentence"])

    def test_a_mean_inside_the_target_is_no_answer_while_chance_may_be_the_reason(self):
        result = Synthetic({"noisy": 0.0, "fine": 0.0}, {"noisy": 1, "fine": 9}, replicas=3, own=0.03).judge().result()
        self.assertIsNone(result["answer"])
        self.assertIn("more of it and of the reference", result["next"])

    def test_without_replicas_no_confidence_is_claimed(self):
        result = Synthetic(LADDER, COSTS, replicas=1, own=0.0).judge().result()
        self.assertEqual(result["answer"], "coarse")
        self.assertIn("confidence not known", result["sentence"])

    def test_a_reference_too_dear_for_replicas_borrows_the_scatter_of_the_next_rung(self):
        result = Synthetic(LADDER, COSTS, dear={"fine": 1}).judge().result()
        errors = next(r for r in result["rungs"] if r["name"] == "coarse")["errors"]["mean"]
        self.assertEqual((errors["scatter_of"], errors["scatter_against"]), (None, "good"))
        self.assertGreater(errors["high"], errors["low"])
        self.assertTrue(any("against 'good' stands in" in text for text in result["not_tested"]))
        self.assertRegex(result["sentence"], "confidence .* by scatter against '(good|coarse)', as the reference has too few replicas")

    def test_one_replica_each_claims_no_confidence_although_the_study_has_replicas(self):
        result = Synthetic(LADDER, COSTS, own=0.0, dear={name: 1 for name in LADDER}).judge().result()
        self.assertEqual(result["answer"], "coarse")
        self.assertIn("confidence not known: too few replicas", result["sentence"])
        self.assertTrue(all(rung["confidence"] is None for rung in result["rungs"]))

    def test_a_run_that_failed_is_kept_with_its_reason(self):
        study = Synthetic(LADDER, COSTS)
        study.results["curve/replica_2"].update(exit_code=3, reason="blew up at t = 3 s")
        result = study.judge().result()
        self.assertEqual(result["answer"], "coarse")
        self.assertTrue(any("blew up" in text for text in result["not_tested"]))


class Zero(unittest.TestCase):
    """Rungs whose mean is a given number, most of them zero, with a relative target."""

    def result(self, values, replicas=1, **more):
        study = Synthetic(dict.fromkeys(values, 0.0), COSTS, replicas=replicas, metric=dict(MEAN, column="spar.roll_deg") | more)
        for rung in study.plan["rungs"]:
            for run in rung["runs"]:
                study.histories[run["name"]] = (np.linspace(0.0, 10.0, 11), lambda column, v=values[rung["name"]]: np.full(11, v))
        return study.judge().result()

    def test_an_error_relative_to_zero_is_named(self):
        said = "the mean of spar.roll_deg is 0 in the reference: a relative error has no meaning, use divide_by"
        for replicas in (1, 4):
            result = self.result({"coarse": 0.3, "good": 0.1, "fine": 0.0}, replicas)
            self.assertEqual((result["answer"], result["sentence"]), (None, f"nothing is known to be within 2 % of the mean of spar.roll_deg: {said}"))
            self.assertEqual(result["next"], f"another scale, no run: {said}")
            self.assertIn(f"errors without meaning: {said}", result["not_tested"])
            self.assertIsNone(result["rungs"][0]["errors"]["mean"]["error"])
        self.assertIn(f"errors without meaning: {said}", self.result({"coarse": 0.3, "fine": 0.0}, target=None)["not_tested"])

    def test_zero_against_zero_is_no_error(self):
        for replicas in (1, 4):
            result = self.result({"coarse": 0.0, "good": 0.0, "fine": 0.0}, replicas)
            self.assertEqual(result["answer"], "coarse")
            self.assertEqual([rung["errors"]["mean"]["error"] for rung in result["rungs"]], [0.0, 0.0, 0.0])
            self.assertFalse(any("no meaning" in text for text in result["not_tested"]))
        # A rung that is zero too is the answer, whatever the others are.
        self.assertEqual(self.result({"coarse": 0.3, "good": 0.0, "fine": 0.0})["answer"], "good")


RMS = dict(MEAN, name="rms", measure="rms", relative=False, target=4.0)


class Borrowed(unittest.TestCase):
    """Rungs of constant histories at two replicas or one, so that the rms difference of two is that of two numbers."""

    VALUES = {"first": [2.0], "still": [5.0], "cheap": [1.0, 4.0], "rich": [0.0, 1.0], "dear": [0.5], "fine": [0.0]}
    COSTS = {"first": 0.5, "still": 1.0, "cheap": 2.0, "rich": 10.0, "dear": 50.0, "fine": 100.0}

    def study(self, values, metric=RMS):
        study = Synthetic(dict.fromkeys(values, 0.0), self.COSTS, replicas=2, dear={n: len(v) for n, v in values.items()}, metric=metric)
        for rung in study.plan["rungs"]:
            rung["fixed"] = rung["name"] == "still"
            for run, value in zip(rung["runs"], values[rung["name"]]):
                study.histories[run["name"]] = (np.linspace(0.0, 10.0, 11), lambda column, v=value: np.full(11, v))
        return study

    def errors(self, values, metric=RMS):
        result = self.study(values, metric).judge().result()
        return result, {r["name"]: r["errors"][metric["name"]] for r in result["rungs"]}

    def half(self, error):
        return error["high"] - error["error"]

    def test_the_scatter_of_an_rms_is_that_against_the_dearest_rung_with_replicas(self):
        _, errors = self.errors(self.VALUES)  # 'cheap' differs from 'rich' by 1 and 3: mean 2, deviation sqrt(2)
        self.assertEqual((errors["cheap"]["scatter_of"], errors["cheap"]["scatter_against"]), (None, "rich"))
        self.assertEqual((errors["rich"]["scatter_of"], errors["rich"]["scatter_against"]), (None, "cheap"))
        self.assertEqual(errors["cheap"]["error"], 1.0)
        self.assertAlmostEqual(self.half(errors["cheap"]), 12.706 * math.sqrt(2.0), delta=1e-3)  # Student, one degree of freedom

    def test_one_replica_takes_the_scatter_of_the_next_cheaper_rung(self):
        result, errors = self.errors(self.VALUES)
        self.assertEqual((errors["dear"]["scatter_of"], errors["dear"]["error"]), ("rich", 0.5))
        self.assertAlmostEqual(self.half(errors["dear"]), 12.706 * math.sqrt(2.0), delta=1e-3)
        self.assertTrue(any("'dear'" in text and "the scatter of 'rich' stands in" in text for text in result["not_tested"]))

    def test_the_reference_has_no_error_and_the_bar_of_its_scatter(self):
        _, errors = self.errors(self.VALUES)
        self.assertEqual((errors["fine"]["scatter_of"], errors["fine"]["error"], errors["fine"]["low"]), ("rich", 0.0, 0.0))
        self.assertAlmostEqual(errors["fine"]["high"], 12.706 * math.sqrt(2.0), delta=1e-3)

    def test_still_water_scatters_by_what_it_is_compared_with(self):
        _, errors = self.errors(self.VALUES)  # 5 and 4 from 'rich'
        self.assertEqual((errors["still"]["scatter_of"], errors["still"]["scatter_against"]), (None, "rich"))
        self.assertAlmostEqual(self.half(errors["still"]), 12.706 * math.sqrt(0.5), delta=1e-3)

    def test_against_a_reference_that_replicas_do_not_touch_each_replica_counts(self):
        values = {"cheap": [1.0, 4.0], "rich": [0.0, 2.0], "still": [5.0]}  # 'still' is the reference
        study = self.study(values)
        study.plan["reference"]["variant"] = "still"
        errors = {r["name"]: r["errors"]["rms"] for r in study.judge().result()["rungs"]}
        self.assertEqual([(errors[n]["error"], errors[n]["replicas"]) for n in ("cheap", "rich")], [(2.5, 2), (4.0, 2)])

    def test_where_none_is_cheaper_the_cheapest_lends(self):
        values = {n: v for n, v in self.VALUES.items() if n != "still"}
        self.assertEqual(self.errors(values)[1]["first"]["scatter_of"], "cheap")

    def test_a_reference_with_replicas_leaves_to_each_rung_its_own_scatter(self):
        result, errors = self.errors(dict(self.VALUES, fine=[0.0, 0.0]))
        self.assertEqual([errors[n]["scatter_of"] for n in ("first", "still", "cheap", "rich", "dear", "fine")],
                         ["still", None, None, None, "rich", None])
        self.assertTrue(all(e["scatter_against"] is None for e in errors.values()))
        self.assertFalse(any("against '" in text for text in result["not_tested"]))

    def test_the_answer_says_that_its_confidence_is_borrowed(self):
        values = {"cheap": [9.0, 9.1], "rich": [9.0, 9.3], "dear": [0.5], "fine": [0.0]}
        result, errors = self.errors(values)
        self.assertEqual(result["answer"], "dear")
        self.assertRegex(result["sentence"], r"confidence 9\d(\.\d)? % by the borrowed scatter of 'rich'$")

    def test_one_rung_with_replicas_has_nothing_to_scatter_against(self):
        result, errors = self.errors({"cheap": [1.0, 4.0], "dear": [0.5], "fine": [0.0]})
        self.assertTrue(all(e["high"] == e["low"] for e in errors.values()))
        self.assertIn("confidence not known: too few replicas", result["sentence"])


class Sources(unittest.TestCase):
    def test_errors_against_richardsons_limit_are_those_of_the_exact_solution(self):
        steps = {"base-h_0.1": 0.1, "base-h_0.2": 0.2, "base-h_0.4": 0.4, "base-h_0.8": 0.8}
        study = Synthetic({n: 0.3 * h**2 for n, h in steps.items()}, {n: 1 / h for n, h in steps.items()}, replicas=1, own=0.0, shared=0.0,
                          axes=[{"name": "h", "values": ["0.1", "0.2", "0.4", "0.8"]}], at={n: [i] for i, n in enumerate(steps)},
                          reference={"variant": "", "history": "", "limit": "h"})
        result = study.judge().result()
        self.assertAlmostEqual(result["limits"][0]["order"], 2.0, delta=1e-3)
        for rung, h in zip(result["rungs"], steps.values()):
            self.assertAlmostEqual(rung["errors"]["mean"]["error"], 0.3 * h**2, delta=1e-9)
        self.assertEqual(result["answer"], "base-h_0.2")

    def test_of_a_count_the_largest_value_is_the_finest(self):
        counts = {"base-n_10": 10, "base-n_20": 20, "base-n_40": 40}
        study = Synthetic({n: 0.3 / c**2 for n, c in counts.items()}, {n: float(c) for n, c in counts.items()}, replicas=1, own=0.0, shared=0.0,
                          axes=[{"name": "n", "values": ["10", "20", "40"]}], at={n: [i] for i, n in enumerate(counts)},
                          reference={"variant": "", "history": "", "limit": "n"})
        result = study.judge().result()
        self.assertAlmostEqual(result["limits"][0]["order"], 2.0, delta=1e-3)
        self.assertAlmostEqual(result["rungs"][0]["errors"]["mean"]["error"], 0.3 / 10**2, delta=1e-9)

    def test_a_rung_that_replicas_do_not_touch_stands_beside_each_of_them(self):
        study = Synthetic({"still": 0.05, "fine": 0.0}, {"still": 1.0, "fine": 9.0}, shared=0.01, own=0.0, dear={"still": 1})
        study.plan["rungs"][0]["fixed"] = True
        error = study.judge().result()["rungs"][0]["errors"]["mean"]
        self.assertEqual(error["replicas"], 6)
        self.assertAlmostEqual(error["error"], 0.05, delta=0.01)

    def test_a_reference_from_elsewhere_counts_up_to_the_end_of_the_runs(self):
        study = Synthetic({"base": 0.0}, {"base": 1.0}, shared=0.0, own=0.0, reference={"variant": "", "history": "/long.csv", "limit": ""})
        t = np.linspace(0.0, 100.0, 1001)  # the runs end at 10
        study.histories["/long.csv"] = (t, lambda column: np.where(t <= 10.0, 5.0, 50.0))
        self.assertAlmostEqual(study.judge().result()["rungs"][0]["errors"]["mean"]["error"], 0.0, places=9)

    def test_phases_either_side_of_half_a_turn_are_near_each_other(self):
        metric = dict(MEAN, name="phase", measure="phase", frequency_Hz=0.5, relative=False, target=5.0)
        axes = [{"name": n, "values": ["a", "b"]} for n in ("turns", "moves")]
        degrees = {"base": [179.0, -177.0], "base-turns_b": [-179.0, -175.0], "base-moves_b": [169.0, 173.0]}
        study = Synthetic(dict.fromkeys(degrees, 0.0), {"base": 1.0, "base-turns_b": 2.0, "base-moves_b": 2.0}, replicas=2, axes=axes,
                          at={"base": [0, 0], "base-turns_b": [1, 0], "base-moves_b": [0, 1]}, reference="base-turns_b", metric=metric)
        t = np.linspace(0.0, 10.0, 101)
        for rung, phases in zip(study.plan["rungs"], degrees.values()):
            for run, phase in zip(rung["runs"], phases):
                study.histories[run["name"]] = (t, lambda column, p=phase: np.cos(np.pi * t - math.radians(p)))
        judge = study.judge()
        self.assertEqual(judge.crossed(), [1, 0])
        for effect, size in zip(judge.axis_effects(study.plan["rungs"][0]), (-2.0, 10.0)):
            self.assertAlmostEqual(effect["effects"][0].value, size, places=6)
        base = judge.result()["rungs"][0]["errors"]["phase"]
        self.assertAlmostEqual(base["value"], -179.0, places=6)
        self.assertAlmostEqual(base["scatter"], math.sqrt(8.0), places=6)

    def test_the_axes_that_matter_most_are_crossed(self):
        axes = [{"name": n, "values": ["a", "b"]} for n in ("small", "large", "middle")]
        offs, at = {"base": 0.0}, {"base": [0, 0, 0]}
        for i, (name, off) in enumerate((("small", 0.001), ("large", 0.2), ("middle", 0.05))):
            offs[f"base-{name}_b"], at[f"base-{name}_b"] = off, [int(i == a) for a in range(3)]
        study = Synthetic(offs, dict.fromkeys(offs, 1.0), axes=axes, at=at, reference="base", design="pairs")
        self.assertEqual(study.judge().crossed(), [1, 2])


class Budget(unittest.TestCase):
    def test_the_dearest_runs_are_left_out_first_and_never_the_reference(self):
        plan = Synthetic(LADDER, COSTS, replicas=1).plan
        plan["options"]["budget_core_h"] = 105.0 / 3600.0
        wanted = [(g, r) for g in plan["rungs"] for r in g["runs"]]
        kept, left_out = spindrift_study.within_budget(plan, wanted, {})
        self.assertEqual([g["name"] for g, _ in kept], ["curve", "coarse", "fine"])
        self.assertEqual(left_out, ["good/replica_0 (10 s)"])

    def test_a_study_that_was_cut_off_leaves_out_what_the_whole_one_does(self):
        plan = Synthetic(LADDER, COSTS, replicas=2).plan
        plan["options"]["budget_core_h"] = 220.0 / 3600.0
        wanted = [(g, r) for g in plan["rungs"] for r in g["runs"]]
        kept, left_out = spindrift_study.within_budget(plan, wanted, {})
        self.assertEqual(left_out, ["good/replica_0 (10 s)"])
        for done in range(len(kept) + 1):
            known = {run["name"]: {} for _, run in kept[:done]}
            self.assertEqual(spindrift_study.within_budget(plan, wanted, known), (kept, left_out))

    def test_forecasts_are_those_of_the_first_call(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            plan = Synthetic(LADDER, COSTS, replicas=1).plan
            spindrift_study.write_whole(folder / "forecasts.json", json.dumps(spindrift_study.first_forecasts(folder, plan)))
            again = Synthetic(LADDER, {name: 2.0 * cost for name, cost in COSTS.items()}, replicas=1).plan
            again["rungs"][0]["runs"][0]["identity"] = "another scene"
            spindrift_study.first_forecasts(folder, again)
        self.assertEqual([rung["runs"][0]["forecast_core_s"] for rung in again["rungs"]], [2.0, 3.0, 10.0, 100.0])

    def test_pairs_have_what_the_axes_left_of_the_budget(self):
        plan = Synthetic(LADDER, COSTS, replicas=1).plan
        plan["options"]["budget_core_h"] = 20.0 / 3600.0
        more = [(g, r) for g in plan["rungs"] for r in g["runs"] if g["name"] in ("coarse", "good")]
        self.assertEqual(spindrift_study.within_budget(plan, more, {}, before=7.0)[1], [])
        self.assertEqual(spindrift_study.within_budget(plan, more, {}, before=10.0)[1], ["good/replica_0 (10 s)"])


if __name__ == "__main__":
    unittest.main()
