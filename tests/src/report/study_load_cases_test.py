"""The table of design load cases, on histories whose answers are known. SPDX-License-Identifier: Apache-2.0"""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "src" / "report"))
import study_load_cases  # noqa: E402
import study_page  # noqa: E402

TIME = np.linspace(0.0, 600.0, 12001)


def plan(winds=(6, 10, 14), seeds=2, **options):
    rungs = [{"name": f"normal-wind_{w}", "variant": "normal", "at": [p], "safety_factor": 1.35, "fatigue": True,
              "runs": [{"name": f"normal-wind_{w}/seed_{s}"} for s in range(seeds)]} for p, w in enumerate(winds)]
    rungs.append({"name": "gust", "variant": "gust", "at": [], "safety_factor": 1.1, "fatigue": False, "runs": [{"name": "gust"}]})
    return {"rungs": rungs, "axes": [{"name": "wind", "values": [str(w) for w in winds]}],
            "load_cases": {"columns": ["load"], "from_s": 0.0, "wind_axis": "wind", "mean_wind_m_s": 10.0, "weibull_shape": 2.0, "years": 20.0,
                           "equivalent_cycles": 1e7, "wohler_exponents": [4.0, 10.0], **options}}


def cases(plan, load):
    """load(run name) -> values at TIME."""
    names = [run["name"] for r in plan["rungs"] for run in r["runs"]]
    return study_load_cases.LoadCases(plan, {n: {"exit_code": 0} for n in names}, lambda name: (TIME, lambda column: load(name)))


def sine(amplitude, frequency=0.1, mean=0.0):
    return mean + amplitude * np.sin(2.0 * math.pi * frequency * TIME)


class Table(unittest.TestCase):
    def test_shares_of_bins_are_those_of_rayleigh(self):
        shares = study_load_cases.bin_shares([4.0, 6.0, 8.0], 10.0, 2.0)
        below = lambda v: 1.0 - math.exp(-math.pi / 4.0 * (v / 10.0) ** 2)
        for share, (a, b) in zip(shares, ((3, 5), (5, 7), (7, 9))):
            self.assertAlmostEqual(share, below(b) - below(a), places=12)

    def test_a_life_of_sines_has_the_range_of_the_textbook(self):
        found = cases(plan(), lambda name: sine({"6": 1.0, "10": 2.0, "14": 3.0}.get(name.split("_")[1].split("/")[0] if "_" in name else "", 9.0)))
        shares = study_load_cases.bin_shares([6.0, 10.0, 14.0], 10.0, 2.0)
        for row in found.lifetime():
            m = row["exponent"]
            cycles = 0.1 * 3600.0 * 8766.0 * 20.0
            expected = (sum(p * cycles * (2.0 * a) ** m for p, a in zip(shares, (1.0, 2.0, 3.0))) / 1e7) ** (1.0 / m)
            self.assertAlmostEqual(row["range"] / expected, 1.0, delta=5e-3)  # half cycles at the ends
            self.assertEqual(row["worst"], "normal-wind_14")

    def test_the_page_says_first_what_of_the_life_is_covered(self):
        few = study_page._design_status(cases(plan(), lambda name: sine(1.0)).result())
        self.assertIn("Design loads of 1 column by 4 cases; these cover", few)
        self.assertIn('class="status warn"', few)
        all_winds = study_page._design_status(cases(plan(winds=range(2, 31, 2), seeds=1), lambda name: sine(1.0)).result())
        self.assertIn("Design loads of 1 column by 16 cases.", all_winds)
        self.assertIn('class="status"', all_winds)

    def test_a_design_extreme_is_the_mean_of_the_seeds_times_its_factor(self):
        def load(name):
            return sine(19.0) if name == "gust" else sine(15.0 if name.endswith("seed_1") else 13.0, mean=2.0)

        low, high = cases(plan(), load).extremes()
        self.assertEqual(high["rung"][:6], "normal")  # 16 of mean 1.35: 21.6; the gust's 19 have 1.1
        self.assertAlmostEqual(high["design"], 1.35 * 16.0, places=3)
        self.assertEqual(low["rung"], "gust")
        self.assertAlmostEqual(low["design"], -20.9, places=3)

    def test_an_extreme_on_the_relieving_side_has_no_factor(self):
        low, high = cases(plan(), lambda name: sine(1.0, mean=5.0)).extremes()
        self.assertAlmostEqual(low["design"], 4.0, places=3)
        self.assertAlmostEqual(high["design"], 1.35 * 6.0, places=3)

    def test_two_cases_of_one_wind_share_its_time(self):
        p = plan()
        p["rungs"].append({**p["rungs"][1], "name": "other-wind_10", "runs": [{"name": "other-wind_10"}]})
        shares = cases(p, lambda name: sine(1.0)).shares("load")
        self.assertAlmostEqual(shares["normal-wind_10"], shares["other-wind_10"])
        self.assertAlmostEqual(sum(shares.values()), sum(study_load_cases.bin_shares([6.0, 10.0, 14.0], 10.0, 2.0)))
        self.assertNotIn("gust", shares)

    def test_without_a_wind_axis_there_are_extremes_alone_and_failed_runs_are_named(self):
        p = plan(wind_axis="")
        names = [run["name"] for r in p["rungs"] for run in r["runs"]]
        results = {n: {"exit_code": 0} for n in names if n != "gust"}
        found = study_load_cases.LoadCases(p, results, lambda name: (TIME, lambda column: sine(1.0))).result()
        self.assertEqual(found["lifetime"], [])
        self.assertEqual(len(found["extremes"]), 2)
        self.assertIn("without: gust", found["notes"])
        self.assertEqual(len(study_load_cases.as_csv(found).splitlines()), 1 + 3)
        self.assertIn("design extremes", study_load_cases.as_text(found))

    def test_a_finished_run_without_numbers_is_named_and_its_wind_is_not_covered(self):
        broken = sine(1.0)
        broken[5000] = math.nan
        p = plan(columns=["load", "other"])
        names = [run["name"] for r in p["rungs"] for run in r["runs"]]
        read = lambda name: lambda column: broken if column == "load" and name.startswith("normal-wind_14") else sine(1.0)
        found = study_load_cases.LoadCases(p, {n: {"exit_code": 0} for n in names}, lambda name: (TIME, read(name))).result()
        self.assertEqual([n for n in found["notes"] if n.startswith("without")],
                         ["without load of normal-wind_14/seed_0, normal-wind_14/seed_1: no numbers from from_s on"])
        bins = study_load_cases.bin_shares([6.0, 10.0, 14.0], 10.0, 2.0)
        self.assertAlmostEqual(sum(found["shares"]["load"].values()), sum(bins[:2]))
        self.assertAlmostEqual(sum(found["shares"]["other"].values()), sum(bins))
        self.assertIn(f"the cases cover {100.0 * sum(bins[:2]):.3g} % of the life of load; the rest does no damage here", found["notes"])
        self.assertEqual(len(study_load_cases.as_csv(found).splitlines()), 1 + 4 + 3)

    def test_a_case_beside_the_axes_that_would_fatigue_is_named(self):
        p = plan()
        for fatigue, notes in ((False, []), (True, ["no share of life: gust"])):
            p["rungs"][-1]["fatigue"] = fatigue
            self.assertEqual([n for n in cases(p, lambda name: sine(1.0)).result()["notes"] if n.startswith("no share")], notes)


if __name__ == "__main__":
    unittest.main()
