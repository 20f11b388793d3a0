"""What the tests of the program share: the program under test (the first argument), the sources, a run of it, a folder of its own for each test.
SPDX-License-Identifier: Apache-2.0"""
import concurrent.futures
import csv
import functools
import gzip
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy

PROGRAM = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/spindrift").resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
# Texts that scenes of several tests end with; C++ tests read them too.
SCENES = ROOT / "tests/coupled/scenes"
AIR_OF_LINES = (SCENES / "air_of_lines.toml").read_text()
AIR_OF_BLADES = (SCENES / "air_of_blades.toml").read_text()
# Keys of [rotor] may follow it.
DTU_IN_WIND = """
[wind]
speed_m_s = 11.0
[rotor]
turbine = "%s/inputs/turbines/dtu_10mw.toml"
""" % ROOT


def starts(count=1):
    """Settings of a sea of particles for so many starts that differ by chance alone, the first the scene's own; others by SPINDRIFT_REPLICA (tests/replica.hpp)."""
    first = int(os.environ.get("SPINDRIFT_REPLICA", 0)) * count
    return [["sea.particles.jitter=0.01", f"sea.particles.jitter_seed={seed}"] if seed else [] for seed in range(first, first + count)]


REPLICA = starts()[0]


def spindrift(*arguments, settings=(), ranks=0, timeout=600, env=None, cwd=None):
    """The finished program: exit code and what it said. `settings` become --set options; without ranks there is no mpirun."""
    launcher = [ROOT / "ci/mpirun", ranks] if ranks else []
    words = [*launcher, PROGRAM, *arguments, *(word for text in settings for word in ("--set", text))]
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, errors="replace", check=False, timeout=timeout, env=env, cwd=cwd)


def held_up(words, text=True, env=None):
    """A command of one process that is stopped for half of the time, as where other programs have its core; what it said."""
    with subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=text, env=env) as process:
        said = concurrent.futures.ThreadPoolExecutor(1).submit(process.stdout.read)
        while process.poll() is None:
            for what, seconds in ((signal.SIGSTOP, 0.02), (signal.SIGCONT, 0.02)):
                process.send_signal(what)
                time.sleep(seconds)
        return subprocess.CompletedProcess(words, process.returncode, said.result(), "")


@functools.cache
def sanitized():
    """Whether the program was built with sanitizers, whose memory is not the program's own."""
    return "-fsanitize=" in spindrift("--version", "--verbose").stdout


def rows(path):
    """Of a table that a run left, history.csv or spanwise.csv: numbers by column."""
    with open(path, encoding="utf-8") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def trace_events(folder):
    """What a run's trace has in it."""
    return json.loads(gzip.decompress((folder / "trace.json.gz").read_bytes()))["traceEvents"]


def columns(path):
    """The same the other way round: arrays by column."""
    found = rows(path)
    return {name: numpy.array([row[name] for row in found]) for name in found[0]}


class Folder(unittest.TestCase):
    """`path` is an empty folder that goes away with the test, `out` the run in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="spindrift_test_")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.out = self.path / "run"


class Runs(Folder):
    """Runs of scenes, each by a name of its own below `path`."""

    def run_scene(self, scene, name, *arguments, settings=(), ranks=0, threads=1, code=0):
        """Of a file, or of a text; what was said."""
        if isinstance(scene, str):
            text, scene = scene, self.path / "scene.toml"
            scene.write_text(text)
        done = spindrift("run", scene, "--quiet", "--no-report", "--out", self.path / name, *arguments, settings=settings, ranks=ranks,
                         env={**os.environ, "OMP_NUM_THREADS": str(threads)})
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def rows(self, name):
        return rows(self.path / name / "history.csv")

    def text(self, name):
        return (self.path / name / "history.csv").read_text()
