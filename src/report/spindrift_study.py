#!/usr/bin/python3
"""Runs the plan of a study and judges it: `spindrift study` becomes this program once every scene is checked (src/app/study.cpp).

    spindrift_study.py FOLDER/plan.json
    spindrift_study.py PLAN --dry-run FOLDER      says what would run in FOLDER, leaves nothing, removes PLAN

Each run is a `spindrift run` of its own in FOLDER/RUN, with what it came to in FOLDER/RUN/study_run.json; runs that are there already are
kept as long as their scene, its files and the program are the same. SIGTERM or SIGINT ends the runs with a checkpoint and the study with exit
code 5; the same command goes on. Exit codes: 0 done, 3 the reference or all runs failed, 5 stopped, 6 no run meets the targets.
Tested in tests/coupled/study_test.py. SPDX-License-Identifier: Apache-2.0"""
import argparse
import ctypes
import fcntl
import hashlib
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

DONE, BAD_INPUT, FAILED, MACHINE_FAILURE, STOPPED, OUT_OF_REACH = 0, 2, 3, 4, 5, 6


def say(text=""):
    print(text, flush=True)


def write_whole(path, text):
    """Whole or not at all, whenever the machine goes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".tmp")
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)


def read_json(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def ended(folder):
    """The summary of a run that came to an end of any kind; None where it was killed, or is at work."""
    summary = read_json(folder / "summary.json")
    return summary if summary and summary["exit_code"] is not None else None


def with_parent():
    """In a child: it ends with a checkpoint when this program goes, however that goes."""
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG


def fingerprint(plan, run):
    """Of the scene, the files that it names and the program."""
    return hashlib.sha256((run["identity"] + plan["commit"]).encode()).hexdigest()


def first_forecasts(folder, plan):
    """By run, what it was forecast to take when this study was first called. A forecast measures the computer of the moment: with another one the
    budget of a study that was cut off would leave out other runs."""
    old, kept = read_json(folder / "forecasts.json") or {}, {}
    for run in (run for rung in plan["rungs"] for run in rung["runs"]):
        now = {"fingerprint": fingerprint(plan, run), "core_s": run["forecast_core_s"]}
        before = old.get(run["name"], now)
        kept[run["name"]] = before if before["fingerprint"] == now["fingerprint"] else now
        run["forecast_core_s"] = kept[run["name"]]["core_s"]
    return kept


class Runs:
    """Runs of a plan on disk and under way."""

    def __init__(self, folder, plan):
        self.folder, self.plan = folder, plan
        self.stopping = 0
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            signal.signal(number, self._stop)
        self.children = []
        self.killed = set()  # runs that were begun once more
        options = plan["options"]
        cores = len(os.sched_getaffinity(0))
        free = max(1, math.floor(cores - os.getloadavg()[0] + 0.5))
        self.at_once = options["at_once"] or max(1, free // options["threads"])
        self.results = {}

    def _stop(self, *_):
        self.stopping += 1

    # The ledger ------------------------------------------------------------------------------------------------------------------
    def fingerprint(self, run):
        return fingerprint(self.plan, run)

    def ledger(self, run):
        return self.folder / run["name"] / "study_run.json"

    def known(self, run):
        """What a finished run came to, from its ledger or, where this program was killed before writing that, from its summary."""
        entry = read_json(self.ledger(run))
        if not entry or entry["fingerprint"] != self.fingerprint(run):
            return None
        if entry["state"] == "under_way":
            summary = ended(self.folder / run["name"])
            if not summary or summary["exit_code"] not in (0, 2, 3):
                return None
            entry = self._enter(run, entry, summary["exit_code"], summary)
        return entry if entry["state"] == "finished" else None

    def _enter(self, run, entry, code, summary):
        """Writes down the end of a run."""
        spent = entry["spent"] + (summary["processor_seconds"] if summary else 0.0)
        entry = dict(entry, spent=spent, exit_code=code, state="stopped" if code == STOPPED and self.stopping else "finished",
                     reason=summary["exit_reason"] if summary else entry.get("reason", f"ended with code {code} and no summary"))
        if entry["state"] == "finished":
            entry["core_s"] = [spent]
            entry["memory"] = summary["peak_memory_bytes"] if summary else math.nan
            entry["shares"] = shares_of_parts(summary["parts"]) if summary else {}
        write_whole(self.ledger(run), json.dumps(entry))
        return entry

    def take_known(self):
        for rung in self.plan["rungs"]:
            for run in rung["runs"]:
                if (entry := self.known(run)) is not None:
                    self.results[run["name"]] = entry

    # Running ---------------------------------------------------------------------------------------------------------------------
    def _start(self, rung, run, out, resume):
        words = [self.plan["program"], "run", rung["scene"], "--out", str(out), "--no-report", "--quiet",
                 "--restart" if resume else "--overwrite"]
        for text in run["set"]:
            words += ["--set", text]
        environment = dict(os.environ, OMP_NUM_THREADS=str(self.plan["options"]["threads"]))
        environment.setdefault("OMP_WAIT_POLICY", "passive")
        out.mkdir(parents=True, exist_ok=True)
        with open(out / "study_said.txt", "a" if resume else "w", encoding="utf-8") as said:
            return subprocess.Popen(words, cwd=self.plan["directory"], env=environment, stdout=said, stderr=said,
                                    preexec_fn=with_parent)

    def _let_end(self, run, pid):
        """The last attempt may still be writing its checkpoint, its study having been killed."""
        try:
            while str(self.folder / run["name"]) in pathlib.Path(f"/proc/{pid}/cmdline").read_text().split("\0"):
                time.sleep(0.05)
        except OSError:
            return

    def begin(self, rung, run):
        out, mark = self.folder / run["name"], self.fingerprint(run)
        old = read_json(self.ledger(run)) or {}
        self._let_end(run, old.get("pid", 0))
        same = old.get("fingerprint") == mark and old.get("state") in ("stopped", "under_way")
        resume = same and any((out / "checkpoints").glob("*.h5")) and (out / "history.csv").exists()
        spent = old.get("spent", 0.0) if resume else 0.0
        if resume and old["state"] == "under_way":  # the last attempt was cut off together with this program
            spent += (read_json(out / "summary.json") or {}).get("processor_seconds", 0.0)
        entry = {"fingerprint": mark, "state": "under_way", "spent": spent}
        (out / "summary.json").unlink(missing_ok=True)
        write_whole(self.ledger(run), json.dumps(entry))
        process = self._start(rung, run, out, resume)
        entry["pid"] = process.pid
        write_whole(self.ledger(run), json.dumps(entry))
        self.children.append((process, rung, run, entry, resume))

    def collect(self):
        """Ends what has ended."""
        for child in list(self.children):
            process, rung, run, entry, resumed = child
            if process.poll() is None:
                continue
            self.children.remove(child)
            out = self.folder / run["name"]
            summary = ended(out)
            code = summary["exit_code"] if summary else process.returncode
            if resumed and code == 2:  # its checkpoint is no good
                shutil.rmtree(out / "checkpoints", ignore_errors=True)
                self.begin(rung, run)
                continue
            if not summary and (out / "study_said.txt").exists():
                lines = (out / "study_said.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
                entry["reason"] = lines[-1] if lines else f"ended with code {code}"
            if not summary and self.stopping:
                continue  # cut off: not finished
            if not summary and code < 0:  # by the kernel for want of memory, say
                entry["reason"] = f"killed by signal {-code}, twice"
                if run["name"] not in self.killed:
                    self.killed.add(run["name"])
                    say(f"        {run['name']:<44} killed by signal {-code}: once more")
                    self.begin(rung, run)
                    continue
            done = self._enter(run, entry, code, summary)
            if done["state"] == "finished":
                self.results[run["name"]] = done
                say(f"  {len(self.results):4d}  {run['name']:<44} {done['core_s'][0]:10.4g} core-s"
                    + ("" if code == 0 else f"   {done['reason']}"))

    def run(self, wanted):
        """Runs (rung, run) pairs that are not known yet, cheapest first; False where stopped."""
        queue = sorted((pair for pair in wanted if pair[1]["name"] not in self.results), key=lambda pair: pair[1]["forecast_core_s"])
        told = 0
        while (queue and not self.stopping) or self.children:
            while queue and not self.stopping and len(self.children) < self.at_once:
                self.begin(*queue.pop(0))
            if self.stopping > told:
                told = self.stopping
                for process, *_ in self.children:
                    process.send_signal(signal.SIGTERM if told == 1 else signal.SIGKILL)
            self.collect()
            time.sleep(0.02)
        return not self.stopping

    def time_again(self, rung):
        """Times the first run of a rung once more, by itself. False where that came to nothing."""
        run = rung["runs"][0]
        entry = self.results[run["name"]]
        out = self.folder / "timing"
        process = self._start(rung, run, out, False)
        while process.poll() is None:
            if self.stopping:
                process.send_signal(signal.SIGTERM)
            time.sleep(0.02)
        summary = ended(out)
        if self.stopping or not summary or summary["exit_code"] != 0:
            return False
        entry["core_s"].append(summary["processor_seconds"])
        write_whole(self.ledger(run), json.dumps(entry))
        shutil.rmtree(out, ignore_errors=True)
        return True


def shares_of_parts(parts):
    """Of the processor time, by what its threads were busy with: they are timed by the clock, which others on the computer stretch alike."""
    busy = {part["name"]: part["core_seconds"] for part in parts if part["name"] != "waiting" and part["core_seconds"] > 0.0}
    return {name: seconds / sum(busy.values()) for name, seconds in busy.items()}


def duration(seconds):
    return f"{seconds:.3g} s" if seconds < 120 else f"{seconds / 60:.3g} min" if seconds < 7200 else f"{seconds / 3600:.3g} h"


def forecast_of(wanted):
    """Core-seconds of these runs."""
    return sum(run["forecast_core_s"] for _, run in wanted)


def within_budget(plan, wanted, known, before=0.0):
    """Leaves out the dearest runs until the forecast fits beside what is taken `before` [core-s]; names of runs left out. Runs that are there already
    count as the others do, and stay: a study that was cut off leaves out what the whole one leaves out."""
    budget = plan["options"]["budget_core_h"]
    if budget is None:
        return wanted, []
    left, cost = list(wanted), before + forecast_of(wanted)
    reference = (plan["reference"] or {}).get("variant")
    for pair in sorted(wanted, key=lambda p: -p[1]["forecast_core_s"]):
        if cost <= 3600.0 * budget:
            break
        if pair[1]["name"] in known or pair[0]["name"] == reference:
            continue
        left.remove(pair)
        cost -= pair[1]["forecast_core_s"]
    kept = {run["name"] for _, run in left}
    return left, [f"{run['name']} ({duration(run['forecast_core_s'])})" for _, run in wanted if run["name"] not in kept]


def nothing_within(plan):
    """Of a budget that leaves no run: what would do."""
    each = [(run["forecast_core_s"], run["name"]) for rung in plan["rungs"] if not rung["later"] for run in rung["runs"]]
    least, cheapest = min(each)

    def up(core_s):  # to three digits
        hours = core_s / 3600.0
        last = 10.0 ** (math.floor(math.log10(hours)) - 2)
        return f"{math.ceil(hours / last) * last:.3g}"

    return (f"{plan['study']}: study.budget_core_h = {plan['options']['budget_core_h']:g}: is less than the forecast of any run, nothing ran; "
            f"the cheapest, '{cheapest}', needs {up(least)}, all {len(each)} need {up(sum(cost for cost, _ in each))}")


def forecast_table(plan, wanted, runs):
    cost = sum(r["forecast_core_s"] for _, r in wanted if r["name"] not in runs.results)
    say(f"{len(wanted)} runs, {sum(r['name'] in runs.results for _, r in wanted)} of them there already; forecast of the rest: "
        f"{cost / 3600.0:.3g} core-hours ({duration(cost)} of one core), {runs.at_once} at once")
    say(f"\n  {'configuration':<44}{'runs':>6}{'core-s each':>14}{'memory':>10}")
    for rung in plan["rungs"]:
        mine = [r for g, r in wanted if g is rung]
        if mine:
            say(f"  {rung['name']:<44}{len(mine):>6}{mine[0]['forecast_core_s']:>14.3g}{mine[0]['forecast_bytes'] / 1e6:>7.0f} MB")
    say()


def print_result(result, folder):
    metrics = result["metrics"]
    width = max([len(r["name"]) for r in result["rungs"]] + [len("configuration")]) + 2
    judged = bool(result["reference"])
    valued = {m["name"]: any(rung["errors"][m["name"]]["value"] is not None for rung in result["rungs"]) for m in metrics}
    say(f"\n{'configuration':<{width}}{'core-s':>10}{'MB':>7}" + "".join(f"{m['name']:>16}" * valued[m["name"]] +
                                                           (f"{'its error' if valued[m['name']] else 'error of ' + m['name']:>26}" * judged) for m in metrics))
    for rung in result["rungs"]:
        memory = rung["cost"]["memory"]
        line = f"{rung['name']:<{width}}{rung['cost']['core_s']:>10.4g}{memory / 1e6 if memory == memory else 0:>7.0f}"
        for metric in metrics:
            e = rung["errors"][metric["name"]]
            text = "-" if e["error"] is None else f"{e['error']:.3g}"
            if e["error"] is not None and e["high"] > e["low"]:
                text += f" ({e['low']:.1e}...{e['high']:.1e})" if len(f"{text} ({e['low']:.2g} ... {e['high']:.2g})") > 25 else f" ({e['low']:.2g} ... {e['high']:.2g})"
            line += f"{'-' if e['value'] is None else format(e['value'], '.5g'):>16}" * valued[metric["name"]] + f" {text:>25}" * judged
        notes = ["reference"] if rung["is_reference"] else ["Pareto front"] if rung["on_front"] else []
        notes += [f"scatter of {n}" for n in dict.fromkeys(e["scatter_of"] for e in rung["errors"].values() if e["scatter_of"])]
        say(line + "  " + ", ".join(notes + ([rung["failed"]] if rung["failed"] else [])))
    say(f"\nanswer: {result['sentence']}")
    if result["scene"]:
        say(f"the scene to run: {folder / result['scene']}")
    for row in result["budget"]:
        if row["sources"]:
            parts = "; ".join(f"{s['source']} {s['size']:.2g}" for s in row["sources"])
            say(f"error of {row['metric']} at '{result['budget_of']}': {parts}")
    say(f"next best spend: {result['next']}")
    for text in result["not_tested"]:
        say(f"not tested: {text}")
    say(f"spent: {result['core_s_spent']:.4g} core-s")


def print_plan(plan, runs, dry=False):
    """Says what is to be run, and what the budget leaves out; returns both."""
    forecasts = first_forecasts(runs.folder, plan)
    if not dry:
        write_whole(runs.folder / "forecasts.json", json.dumps(forecasts))
    runs.take_known()
    wanted, left_out = within_budget(plan, [(g, r) for g in plan["rungs"] if not g["later"] for r in g["runs"]], runs.results)
    forecast_table(plan, wanted, runs)
    for name in left_out:
        say(f"  beyond the budget, left out: {name}")
    budget = plan["options"]["budget_core_h"]
    if budget is not None and forecast_of(wanted) > 3600.0 * budget:
        say(f"  warning: {'what is there already and the reference take' if runs.results else 'the reference alone takes'} "
            f"{forecast_of(wanted) / 3600.0:.3g} core-hours, the budget is {budget:g}")
    return wanted, left_out


def ended_by_budget(plan, wanted):
    if wanted:
        return DONE
    print(f"error: {nothing_within(plan)}", file=sys.stderr)
    return BAD_INPUT


def main():
    parser = argparse.ArgumentParser(prog="spindrift study")
    parser.add_argument("plan", type=pathlib.Path)
    parser.add_argument("--dry-run", type=pathlib.Path, metavar="FOLDER")
    given = parser.parse_args()
    try:
        import study_judge
        import study_load_cases
        import study_histories
    except ModuleNotFoundError as missing:
        say(f"Python at {sys.executable} has no module '{missing.name}': install the package python3-{missing.name} (ci/setup does)")
        return MACHINE_FAILURE
    plan = json.loads(given.plan.read_text(encoding="utf-8"))
    if given.dry_run:
        given.plan.unlink()
        wanted, _ = print_plan(plan, Runs(given.dry_run.resolve(), plan), dry=True)
        return ended_by_budget(plan, wanted)
    folder = given.plan.parent.resolve()
    lock = open(folder / "lock", "w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        say(f"another study is at work in {folder}")
        return MACHINE_FAILURE
    runs = Runs(folder, plan)
    wanted, left_out = print_plan(plan, runs)
    if code := ended_by_budget(plan, wanted):
        return code

    history = study_histories.reader(folder)

    def judge():
        return study_judge.Judge(plan, {k: v for k, v in runs.results.items() if k in names}, history)

    names = {r["name"] for _, r in wanted}
    finished = runs.run(wanted)
    if finished and plan["options"]["design"] == "pairs":
        axes = set(judge().crossed())
        more = [(g, r) for g in plan["rungs"] if g["later"] and {a for a, p in enumerate(g["at"]) if p} <= axes for r in g["runs"]]
        more, beyond = within_budget(plan, more, runs.results, forecast_of(wanted))
        left_out += beyond
        names |= {r["name"] for _, r in more}
        finished = runs.run(more)
    if finished:
        so_far = judge()
        while (rivals := so_far.to_time(plan["options"]["repeats"])) and all(runs.time_again(rung) for rung in rivals):
            pass
    if runs.stopping:
        say(f"stopped on request: {len(runs.results)} runs are done; the same command goes on")
        return STOPPED
    result = judge().result(left_out)
    if plan.get("load_cases"):
        result["load_cases"] = study_load_cases.LoadCases(plan, {k: v for k, v in runs.results.items() if k in names}, history).result()
        write_whole(folder / "load_cases.csv", study_load_cases.as_csv(result["load_cases"]))
    write_whole(folder / "study.json", json.dumps(result, indent=1))
    print_result(result, folder)
    if plan.get("load_cases"):
        say(study_load_cases.as_text(result["load_cases"]))
        say(f"load cases: {folder / 'load_cases.csv'}")
    page = subprocess.run([sys.executable, "-B", "-E", "-s", pathlib.Path(__file__).parent / "spindrift_report.py", folder],
                          capture_output=True, text=True, check=False)
    say(f"report: {folder / 'study.html'}" if page.returncode == 0 else f"no report: {page.stderr.strip()[-200:]}")
    if all(r["failed"] for r in result["rungs"]) or any(r["is_reference"] and r["failed"] for r in result["rungs"]):
        return FAILED
    if any(m["target"] is not None for m in plan["metrics"]):
        return DONE if result["answer"] else OUT_OF_REACH
    return FAILED if any(r["failed"] for r in result["rungs"]) else DONE


if __name__ == "__main__":
    sys.exit(main())
