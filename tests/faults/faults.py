"""What machines do to runs: kills, full disks, flipped and missing bytes, second jobs, signals. Nothing may be lost, nothing wrong accepted, and no
hand be needed. Usage: faults.py SPINDRIFT FAULT [COUNT [SEED]], where FAULT is one of the functions below. A failure prints the seed."""
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
INPUTS = ROOT / "inputs"
# A floating turbine of engineering models, long enough to be met anywhere: start, windows, checkpoints, end.
SCENE = [INPUTS / "leble_barakos/case3_engineering.toml", "--set", "time.end_s=60.0", "--set", "checkpoint.interval_s=5.0"]
# Seconds of work each: particles that settle and break loose, a steady march of a resolved rotor, and both round a platform.
TANK = [INPUTS / "validation/dam_break/koshizuka_oka.toml", "--set", "sea.particles.spacing_m=0.02", "--set", "time.end_s=0.5"]
AIR = [INPUTS / "leble_barakos/case3_rotor.toml", "--set", "time.end_s=50.0"]
COUPLED = [INPUTS / "leble_barakos/case3_demo.toml", "--set", "sea.particles.spacing_m=5.0", "--set", "start.air_steps=30", "--set", "time.end_s=0.4"]
# The same three parts as small as they come, as a file of a job's folder: air that settles, then both fluids, saved at every window or by the default alone.
JOB = '''base = "%s"
without = ["sea.fields", "aero.flow.blades"]
start.air_steps = 30
time.end_s = 0.6
time.window_s = 0.1
sea.particles.spacing_m = 5.0
aero.grid = {cells_round = 28, cells_layers = 4, cells_span = 8, first_cell_chords = 8e-3}
aero.flow = {viscous = "none", cfl_max = 100.0, max_pseudo_steps = 3}
output.expected = []
''' % (INPUTS / "leble_barakos/case3_demo.toml")
# Ten seconds of making a grid, half a minute of placing particles, and a window of many steps of bodies.
GRID = [INPUTS / "leble_barakos/rotor_demo.toml", "--set", "aero.grid.resolution=3.5"]
SEA = [INPUTS / "leble_barakos/case1_paper.toml"]
WINDOW = [INPUTS / "leble_barakos/case1_engineering.toml", "--set", "time.end_s=40.0", "--set", "time.window_s=40.0", "--set", "time.step_s=0.0005"]
QUIET = ["--no-report", "--quiet"]


def start(scene, out, *more, **options):
    return subprocess.Popen([PROGRAM, "run", *map(str, scene), "--out", str(out), *QUIET, *map(str, more)], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, errors="replace", **options)


def job(scene, out, *more, code=0, **options):
    """One job of the README's script."""
    process = start(scene, out, "--restart", *more, **options)
    said = process.communicate(timeout=600)[0]
    if code is not None:
        assert process.returncode == code, f"exit code {process.returncode} for {code}\n{said[-2000:]}"
    return process.returncode, said


def whole(folder, scene=SCENE):
    """The unbroken run."""
    begin = time.time()
    job(scene, folder / "whole")
    return (folder / "whole/history.csv").read_bytes(), time.time() - begin


def history(out):
    return (out / "history.csv").read_bytes()


def kill(folder, count, pick):
    """kill -9 at any time, also before the first checkpoint; the same command again until the run is done."""
    expected, seconds = whole(folder)
    kills = rounds = 0
    while kills < count:
        out, rounds = folder / f"killed_{rounds}", rounds + 1
        for attempt in range(1000):
            process = start(SCENE, out, "--restart")
            try:
                process.wait(pick.uniform(0.0, 1.2 * seconds if attempt % 3 else 0.3) if kills < count else 600)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                kills += 1
                if pick.random() < 0.5:
                    process.wait()  # else the next job meets a process of which only the exit code is left
                continue
            assert process.returncode == 0, process.communicate()[0]
            break
        assert history(out) == expected, f"{out}: another history after {kills} kills"
    return f"{kills} kills in {rounds} runs"


def job_script(folder, count, pick):
    """The script of docs/tutorials/cluster.md as it stands there, killed with all its processes at any time, while the air settles and before the first checkpoint too, and
    submitted again blindly until it ends with 0: the history is that of the unbroken run."""
    page = (ROOT / "docs/tutorials/cluster.md").read_text(encoding="utf-8")
    script = page.partition("```bash\n")[2].partition("```")[0]
    assert "srun spindrift run" in script and "--restart" in script, "the page has no job script"
    shims = folder / "bin"   # what a cluster has: ranks by srun, the program on the path
    shims.mkdir()
    (shims / "srun").write_text('#!/bin/bash\nif [ "$RANKS" = 1 ]; then exec "$@"; fi\nexec mpirun --oversubscribe -n "$RANKS" "$@"\n')
    (shims / "spindrift").write_text(f'#!/bin/bash\nexec {PROGRAM} "$@" $MORE\n')
    for shim in shims.iterdir():
        shim.chmod(0o755)
    saved = {False: JOB, True: JOB + "checkpoint.interval_s = 0.1\n"}
    kills = runs = before_first = 0

    def submit(place, ranks, mark, report):
        """A job: the scheduler's end of it is the script's."""
        environment = dict(os.environ) | {"PATH": f"{shims}:{os.environ['PATH']}", "SLURM_CPUS_PER_TASK": "1", "RANKS": str(ranks), "MORE": "--quiet" if report else "--quiet --no-report",
                                          "SPINDRIFT_FAULT": mark, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        return subprocess.Popen(["bash", "job.sh"], cwd=place, env=environment, stdout=open(place / "said", "w", encoding="utf-8"), stderr=subprocess.STDOUT)

    def placed(name, often):
        place = folder / name
        place.mkdir()
        (place / "job.sh").write_text(script), (place / "scene.toml").write_text(saved[often])
        return place

    whole_place, begin = placed("unbroken", False), time.time()
    assert submit(whole_place, 1, "unbroken", False).wait(600) == 0, (whole_place / "said").read_text()[-2000:]
    expected, seconds = history(whole_place / "run1"), time.time() - begin
    while kills < count:
        place, ranks, report, runs = placed(f"job_{runs}", pick.random() < 0.5), 2 if runs % 4 == 3 else 1, runs % 10 == 9, runs + 1
        most = kills + pick.randint(1, 8)   # of this run: some meet few, some many
        for attempt in range(1000):
            mark = f"{os.getpid()}_{runs}_{attempt}"
            job = submit(place, ranks, mark, report)
            try:
                job.wait(pick.uniform(0.0, 0.6 if attempt % 3 == 0 else 1.2 * seconds * ranks) if kills < min(most, count) else 600)
            except subprocess.TimeoutExpired:
                for one in everything_of(mark):
                    try:
                        os.kill(one, signal.SIGKILL)
                    except ProcessLookupError:
                        pass
                job.wait()
                while everything_of(mark):   # a scheduler gives the nodes to no other job before
                    time.sleep(0.01)
                kills += 1
                before_first += not list((place / "run1/checkpoints").glob("*.h5"))
                continue
            assert job.returncode == 0, f"{place.name}: exit code {job.returncode}\n{(place / 'said').read_text()[-2000:]}"
            break
        assert history(place / "run1") == expected, f"{place.name}: another history after {kills} kills"
        assert json.loads((place / "run1/summary.json").read_text())["exit_code"] == 0
        shutil.rmtree(place)
    return f"{kills} kills in {runs} runs, {before_first} of them before the first checkpoint"


def everything_of(mark):
    """Processes of a job, whatever program they run."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and f"SPINDRIFT_FAULT={mark}".encode() in (entry / "environ").read_bytes().split(b"\0") and "State:\tZ" not in (entry / "status").read_text():
                found.append(int(entry.name))
        except OSError:
            continue
    return found


def broken_off(folder, scene, until):
    """A run that ended half way, to be damaged; and the unbroken one's history."""
    folder.mkdir()
    expected, _ = whole(folder, scene)
    job(scene, folder / "half", "--until", until)
    return expected


def damaged(folder, count, pick, damage):
    """Checkpoints of engineering models, and of both fluids, in turns."""
    both = folder / "both.toml"
    both.write_text(JOB + "checkpoint.interval_s = 0.1\n")
    scenes = [(folder / "engineering", SCENE, 30), (folder / "fluids", [both], 0.3)]
    expected, aside = [broken_off(*one) for one in scenes], 0
    for n in range(count):
        place, scene, _ = scenes[n % 2]
        out = place / "damaged"
        shutil.copytree(place / "half", out)
        newest = max((out / "checkpoints").glob("*.h5"))
        newest.write_bytes(damage(newest.read_bytes()))
        job(scene, out)
        assert history(out) == expected[n % 2], f"another history after damage {n}"
        aside += len(list((out / "checkpoints").glob("*.damaged")))
        shutil.rmtree(out)
    return f"{count} times, {aside} checkpoints set aside"


def flip(folder, count, pick):
    """One bit of the newest checkpoint."""
    def damage(data):
        at = pick.randrange(8 * len(data))
        return data[:at // 8] + bytes([data[at // 8] ^ 1 << at % 8]) + data[at // 8 + 1:]
    return damaged(folder, count, pick, damage)


def truncate(folder, count, pick):
    """The newest checkpoint cut short."""
    return damaged(folder, count, pick, lambda data: data[:pick.randrange(len(data))])


def full_disk(folder, count, pick):
    """A disk that is full, and files that may grow no more: the job fails in words, and the next one, with room, goes on to the same end."""
    expected, _ = whole(folder)
    failed, real = 0, may_mount()
    for n in range(count):
        out, most = folder / f"full_{n}", int(2 ** pick.uniform(10.0, 20.0))
        if real and n % 2 == 0:
            code, said, found = on_small_disk(out, most)
        else:
            def limit():
                resource.setrlimit(resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

            code, said = job(SCENE, out, code=None, preexec_fn=limit, env={**os.environ, "OMPI_MCA_btl": "self"})  # MPI itself writes no large file
            job(SCENE, out)
            found = history(out)
        assert code in (0, 4), f"{most} bytes: exit code {code}\n{said[-2000:]}"
        assert code == 0 or "File too large" in said or "files may have" in said or any(word in said for word in ("room", "space left", "MB left")), said[-2000:]
        failed += code == 4
        assert found == expected, f"another history after a disk of {most} bytes"
    return f"{count} sizes{', every other a disk of its own' if real else ''}, {failed} runs stopped by them"


NAMESPACE = ["unshare", "--map-root-user", "--mount", "--propagation", "private", "sh", "-c"]


def may_mount():
    """Whether this machine lets a test mount a disk in memory."""
    with tempfile.TemporaryDirectory() as place:
        try:
            return subprocess.run([*NAMESPACE, f"mount -t tmpfs -o size=64k none '{place}'"], capture_output=True, check=False).returncode == 0
        except OSError:
            return False


def on_small_disk(out, size):
    """(exit code, what was said) of a job on a disk of this size, and the history after the disk has grown and the job ran again."""
    out.mkdir()
    kept = out.with_suffix(".kept")
    kept.mkdir()
    words = " ".join(f"'{word}'" for word in [PROGRAM, "run", *map(str, SCENE), "--out", f"{out}/run", *QUIET, "--restart"])
    script = (f"mount -t tmpfs -o size={max(size // 4096, 2) * 4}k none '{out}' || exit 9\n{words} > '{kept}/said' 2>&1\necho $? > '{kept}/code'\n"
              f"mount -o remount,size=64m '{out}'\n{words} > '{kept}/said_again' 2>&1 || {{ cat '{kept}/said_again'; exit 1; }}\ncp '{out}/run/history.csv' '{kept}'")
    done = subprocess.run([*NAMESPACE, script], capture_output=True, text=True, errors="replace", timeout=600, check=False)
    assert done.returncode == 0, f"{size} bytes: {done.stdout[-2000:]}{done.stderr[-2000:]}"
    return int((kept / "code").read_text()), (kept / "said").read_text(errors="replace"), (kept / "history.csv").read_bytes()


def two_jobs(folder, count, pick):
    """Of jobs started together in one folder one runs, the others end with 2, and the history is that of one."""
    expected, seconds = whole(folder)
    refused, pairs = 0, 0
    while refused < count:
        out, pairs = folder / f"two_{pairs}", pairs + 1
        assert pairs <= 10 * count, "no pair meets"
        first = start(SCENE, out, "--restart")
        time.sleep(pick.uniform(0.0, 0.8 * seconds))
        second = start(SCENE, out, pick.choice(["--restart", "--overwrite", "--restart"]))
        said = [p.communicate(timeout=600)[0] for p in (first, second)]
        codes = sorted([first.returncode, second.returncode])
        if codes == [0, 0]:  # the first was done
            assert history(out) == expected
            continue
        assert codes == [0, 2], f"exit codes {codes}\n{said}"
        assert "a run is at work in it" in said[0] + said[1], said
        assert history(out) == expected, "two jobs wrote one history"
        refused += 1
    return f"{count} refused of {pairs} pairs, the others were done before"


def signals(folder, count, pick):
    """Requests to stop at any time, settling included: each ends the job within ten seconds with exit code 5 and a summary, and jobs with
    --restart come to the history of the unbroken run."""
    requests, slowest, runs = 0, 0.0, 0
    unbroken = {}
    while requests < count:
        name, scene = [("tank", TANK), ("air", AIR), ("coupled", COUPLED)][runs % 3]
        if name not in unbroken:
            (folder / name).mkdir()
            unbroken[name] = whole(folder / name, scene)
        expected, seconds = unbroken[name]
        out, runs = folder / f"signal_{runs}", runs + 1
        for attempt in range(100):
            said_before = said_by(out)
            process = start(scene, out, "--restart")
            if attempt < 3 and requests < count:
                asked = ask(process, out, said_before, pick, seconds)
                if asked is not None:
                    said = process.communicate(timeout=120)[0]
                    took = time.time() - asked
                    if process.returncode != 0:  # else it was done
                        assert process.returncode == 5, f"{name}: exit code {process.returncode}\n{said[-2000:]}"
                        assert took < 10.0, f"{name}: {took:.1f} s to the end"
                        assert json.loads((out / "summary.json").read_text())["exit_code"] == 5
                        requests, slowest = requests + 1, max(slowest, took)
                        continue
            said = process.communicate(timeout=600)[0]
            assert process.returncode == 0, said[-2000:]
            break
        assert history(out) == expected, f"{out}: another history after {requests} requests"
        shutil.rmtree(out)
    return f"{count} requests in {runs} runs, the slowest took {slowest:.1f} s"


def said_by(out):
    """Bytes of its log."""
    log = out / "log.txt"
    return log.stat().st_size if log.exists() else 0


def ask(process, out, said_before, pick, seconds):
    """Asks it to stop in one of all ways once it is at work, and says when; nothing where it was done before."""
    while said_by(out) == said_before and process.poll() is None:
        time.sleep(0.01)
    try:
        process.wait(0.1 + pick.uniform(0.0, 0.9 * seconds))
        return None
    except subprocess.TimeoutExpired:
        pass
    number = pick.choice([signal.SIGTERM, signal.SIGINT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGHUP, signal.SIGXCPU, None])
    begin = time.time()
    if number is None:
        (out / "stop").write_text("")
    else:
        process.send_signal(number)
    return begin


def processes_of(launcher):
    """{rank: process} of the program under mpirun."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and os.path.realpath(entry / "exe") == PROGRAM:
                environment = dict(word.partition(b"=")[::2] for word in (entry / "environ").read_bytes().split(b"\0"))
                if environment.get(b"SPINDRIFT_FAULT", b"").decode() == launcher:
                    found[int(environment[b"OMPI_COMM_WORLD_RANK"])] = int(entry.name)
        except (OSError, KeyError):
            continue
    return found


def started_on(ranks, mark, scene, out, said, *more):
    """The program on so many ranks, found again by its mark."""
    environment = dict(os.environ) | {"SPINDRIFT_FAULT": mark}
    return subprocess.Popen([ROOT / "ci/mpirun", str(ranks), PROGRAM, "run", *map(str, scene), "--out", str(out), "--quiet", *map(str, more)], stdout=said, stderr=subprocess.STDOUT,
                            env=environment)


def wait_for(what, process, seconds=300):
    """Until it is so, of a process that is to be at work meanwhile."""
    end = time.time() + seconds
    while not what():
        assert process.poll() is None, "the run ended before it was met"
        assert time.time() < end, "what was waited for did not come"
        time.sleep(0.01)


def text_of(path):
    return path.read_text(errors="replace") if path.exists() else ""


def require_named(process, mark, stopped, limit, said):
    """That a rank which stands still from now on is named within the watchdog's time, and that the run ends by itself, not with 0. Returns how long both took."""
    os.kill(processes_of(mark)[stopped], signal.SIGSTOP)
    begin, named = time.time(), None
    while process.poll() is None and time.time() < begin + 120:
        if named is None and f"rank {stopped} does not answer" in said.read_text(errors="replace"):
            named = time.time() - begin
        time.sleep(0.05)
    took, text = time.time() - begin, said.read_text(errors="replace")
    if process.poll() is None:
        left = {rank: (pathlib.Path("/proc") / str(one) / "status").read_text().split("State:")[1].split("\n")[0].strip() for rank, one in processes_of(mark).items()}
        for one in processes_of(mark).values():
            os.kill(one, signal.SIGKILL)
        process.wait()
        raise AssertionError(f"rank {stopped} stopped, and the run did not end; ranks left: {left}\n{text[-6000:]}")
    assert process.returncode != 0, f"exit code 0 with a stopped rank\n{text[-2000:]}"
    assert f"rank {stopped} does not answer" in text, f"rank {stopped} is not named\n{text[-3000:]}"
    slack = 2.0   # of a busy computer; the last words of a run may be read when it has ended
    assert named is None or named < limit + slack, f"rank {stopped} was named after {named:.1f} s, the watchdog's time is {limit:g} s"
    return named or took, took


def require_told(out, stopped):
    """That the summary has the end of a run that lost this rank."""
    summary = json.loads((out / "summary.json").read_text())
    assert summary["exit_code"] == 4, f"exit code {summary['exit_code']} in the summary: {summary['exit_reason']}"
    assert f"rank {stopped} does not answer" in summary["exit_reason"], summary["exit_reason"]


def stopped_rank(folder, count, pick):
    """A rank of three that stands still (SIGSTOP) is named within the watchdog's time, and the run ends by itself with 4."""
    longest = slowest = 0.0
    scene, limit = folder / "scene.toml", 6.0
    scene.write_text(JOB)
    for n in range(count):
        out, mark = folder / f"stopped_{n}", f"{os.getpid()}_{n}"
        with open(folder / f"said_{n}", "w", encoding="utf-8") as said:
            process = started_on(3, mark, [scene, "--set", "time.end_s=600.0", "--set", f"runtime.watchdog_s={limit}"], out, said, "--no-report")
        wait_for(lambda: (out / "history.csv").exists() and (out / "history.csv").read_bytes().count(b"\n") >= 3, process)
        time.sleep(pick.uniform(0.0, 1.0))
        named, took = require_named(process, mark, n % 3, limit, folder / f"said_{n}")
        require_told(out, n % 3)
        longest, slowest = max(longest, took), max(slowest, named)
    return f"{count} stopped ranks named within {slowest:.1f} s, runs ended within {longest:.1f} s of a watchdog of {limit:g} s"


def stopped_at_start(folder, count, pick):
    """The same of a rank that stands still where no graph runs: while a grid and its wall distances are made, and while rank 0 makes the report."""
    longest = slowest = 0.0
    limit = 6.0
    for n in range(count):
        out, mark, at_start = folder / f"stopped_{n}", f"{os.getpid()}_{n}", n % 2 == 0
        scene = [*(GRID if at_start else SCENE), "--set", f"runtime.watchdog_s={limit}"]
        with open(folder / f"said_{n}", "w", encoding="utf-8") as said:
            process = started_on(2, mark, scene, out, said, *(["--no-report"] if at_start else []))
        if at_start:
            wait_for(lambda: "ranks" in text_of(out / "log.txt"), process)
            time.sleep(pick.uniform(0.0, 0.5))
        else:
            wait_for(lambda: "making the report" in text_of(out / "log.txt"), process)
        named, took = require_named(process, mark, n // 2 % 2 if at_start else 1, limit, folder / f"said_{n}")
        if at_start:
            require_told(out, n // 2 % 2)
        else:
            assert json.loads((out / "summary.json").read_text())["exit_code"] == 0, "the summary says another end"
        longest, slowest = max(longest, took), max(slowest, named)
    return f"{count} stopped ranks named within {slowest:.1f} s, runs ended within {longest:.1f} s of a watchdog of {limit:g} s"


def failed_rank(folder, count, pick):
    """A rank that runs out of memory while it makes its particles ends the run. Its message has its number, and the summary, which the first rank cannot write, the code and the reason."""
    for n in range(count):
        out, mark, words = folder / f"failed_{n}", f"{os.getpid()}_{n}", folder / f"said_{n}"
        with open(words, "w", encoding="utf-8") as said:
            process = started_on(2, mark, [*TANK, "--set", "sea.particles.spacing_m=0.001"], out, said, "--no-report")
        wait_for(lambda: "rank" in text_of(out / "log.txt"), process)
        one = processes_of(mark)[1]
        bytes_now = resource.getpagesize() * int((pathlib.Path("/proc") / str(one) / "statm").read_text().split()[0])
        resource.prlimit(one, resource.RLIMIT_AS, (bytes_now + 2**25, resource.RLIM_INFINITY))
        try:
            process.wait(120)
        finally:
            process.kill()
        said, summary = words.read_text(), json.loads((out / "summary.json").read_text())
        assert process.returncode == 4, f"exit code {process.returncode}\n{said[-2000:]}"
        assert "rank 1: error: " in said, said[-2000:]
        assert summary["exit_code"] == 4 and summary["exit_reason"].startswith("rank 1: "), (summary["exit_code"], summary["exit_reason"])
    return f"{count} ranks without memory"


def require_stopped(process, begin, out, said):
    """That a request of `begin` ends the run within ten seconds, with its exit code and a summary of it. Returns the summary and how long it took."""
    try:
        process.wait(120)
    except subprocess.TimeoutExpired:
        process.kill()
        raise AssertionError(f"two minutes after the request the run goes on\n{said.read_text()[-2000:]}") from None
    took = time.time() - begin
    assert process.returncode == 5, f"exit code {process.returncode}\n{said.read_text()[-2000:]}"
    assert took < 10.0, f"{took:.1f} s to the end"
    summary = json.loads((out / "summary.json").read_text())
    assert summary["exit_code"] == 5, summary
    return summary, took


def signals_at_start(folder, count, pick):
    """A large grid that is being made, and a large sea, are given up: with a summary, and before they are done. A signal to one rank is enough."""
    slowest = 0.0
    for n in range(count):
        out, mark, ranks, words = folder / f"signal_{n}", f"{os.getpid()}_{n}", 2 if n % 4 < 2 else 1, folder / f"said_{n}"
        with open(words, "w", encoding="utf-8") as said:
            process = started_on(ranks, mark, SEA if n % 2 else GRID, out, said, "--no-report")
        wait_for(lambda: "rank" in text_of(out / "log.txt"), process)
        time.sleep(pick.uniform(0.0, 1.0))
        begin = time.time()
        if n // 4 % 2:
            (out / "stop").write_text("")
        else:
            os.kill(processes_of(mark)[ranks - 1], pick.choice([signal.SIGTERM, signal.SIGINT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGHUP]))
        summary, took = require_stopped(process, begin, out, words)
        assert "before the first window" in summary["exit_reason"], summary["exit_reason"]
        assert " cells in " not in text_of(out / "log.txt"), "the grid was made all the same"
        slowest = max(slowest, took)
    return f"{count} requests, the slowest took {slowest:.1f} s"


def signals_in_window(folder, count, pick):
    """A long window of the bodies alone is given up, and made again by the next job: the history is that of the unbroken run. A signal to one rank is enough."""
    expected, seconds = whole(folder, WINDOW)
    slowest = 0.0
    for n in range(count):
        out, mark, ranks, words = folder / f"signal_{n}", f"{os.getpid()}_{n}", 1 + n % 2, folder / f"said_{n}"
        with open(words, "w", encoding="utf-8") as said:
            process = started_on(ranks, mark, WINDOW, out, said, "--no-report")
        wait_for(lambda: (out / "history.csv").exists() and (out / "history.csv").read_bytes().count(b"\n") >= 2, process)
        time.sleep(pick.uniform(0.0, 0.1 * seconds))
        begin = time.time()
        os.kill(processes_of(mark)[ranks - 1], pick.choice([signal.SIGTERM, signal.SIGINT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGHUP]))
        summary, took = require_stopped(process, begin, out, words)
        assert summary["time"]["end_s"] == 0.0, "the window was made to its end all the same"
        job(WINDOW, out)
        assert history(out) == expected, f"{out}: another history after a window that was given up"
        slowest = max(slowest, took)
    return f"{count} windows of {seconds:.1f} s given up, the slowest took {slowest:.1f} s"


def signals_at_lock(folder, count, pick):
    """A job that waits for the heartbeat of another computer's is asked to stop: it ends with 5 and leaves the folder to that one."""
    slowest = 0.0
    for n in range(count):
        out, mark, ranks, words = folder / f"lock_{n}", f"{os.getpid()}_{n}", 1 + n % 2, folder / f"said_{n}"
        out.mkdir()
        lock = "host = elsewhere\nprocess = 7\nstarted = 1\nprocesses = another\nheartbeat = 000000000001\n"
        (out / "run.lock").write_text(lock)
        with open(words, "w", encoding="utf-8") as said:
            process = started_on(ranks, mark, SCENE, out, said, "--no-report", "--restart")
        wait_for(lambda: "looking for its heartbeat" in text_of(words), process)
        time.sleep(pick.uniform(0.0, 1.0))
        begin = time.time()
        os.kill(processes_of(mark)[ranks - 1], pick.choice([signal.SIGTERM, signal.SIGINT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGHUP]))
        try:
            process.wait(120)
        finally:
            process.kill()
        took = time.time() - begin
        assert process.returncode == 5, f"exit code {process.returncode}\n{words.read_text()[-2000:]}"
        assert took < 10.0, f"{took:.1f} s to the end"
        assert "stopped on request" in words.read_text(), words.read_text()
        assert [(f.name, f.read_text()) for f in out.iterdir()] == [("run.lock", lock)], "the other job's folder is not as it was"
        slowest = max(slowest, took)
    return f"{count} requests, the slowest took {slowest:.1f} s"


def main():
    fault = {f.__name__: f for f in (kill, job_script, flip, truncate, full_disk, two_jobs, signals, signals_at_start, signals_in_window, signals_at_lock, stopped_rank, stopped_at_start, failed_rank)}[sys.argv[2]]
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else random.randrange(10**6)
    os.environ["OMP_NUM_THREADS"] = "1"
    with tempfile.TemporaryDirectory(prefix="spindrift_faults_") as folder:
        begin = time.time()
        try:
            said = fault(pathlib.Path(folder), count, random.Random(seed))
        except BaseException:
            print(f"{fault.__name__} failed; again with seed {seed}")
            raise
    print(f"{fault.__name__}: {said}, in {time.time() - begin:.0f} s")


main()
