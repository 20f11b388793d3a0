#!/usr/bin/python3
"""What a run says of its processors: where its ranks and threads may run, and a warning where they must take turns. Argument: the program."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = sys.argv.pop(1)
SCENE = ROOT / "inputs/validation/standing_wave/standing_wave.toml"
ONE = min(os.sched_getaffinity(0))


def said(threads, ranks=1):
    """What a short run prints whose processes may use one processor only."""
    with tempfile.TemporaryDirectory() as folder:
        command = [PROGRAM, "run", SCENE, "--until", "0.001", "--no-report", "--out", pathlib.Path(folder) / "run"]
        if ranks > 1:
            command = [ROOT / "ci/mpirun", str(ranks), *command]
        done = subprocess.run([str(word) for word in command], env=dict(os.environ, OMP_NUM_THREADS=str(threads)), text=True, check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=lambda: os.sched_setaffinity(0, {ONE}))
        return done.stdout


class Affinity(unittest.TestCase):
    def test_a_thread_with_a_processor_is_said_and_not_warned_of(self):
        text = said(1)
        self.assertIn(f"rank 0: 1 thread on processor {ONE}\n", text)
        self.assertNotIn("take turns", text)

    def test_more_threads_than_processors_are_warned_of(self):
        text = said(2)
        self.assertIn(f"rank 0: 2 threads on processor {ONE}\n", text)
        self.assertIn("warning: rank 0 has 2 threads on 1 processor: they take turns", text)
        self.assertIn("OMP_NUM_THREADS=1", text)

    def test_ranks_on_one_processor_are_warned_of(self):
        text = said(1, ranks=2)
        self.assertIn(f"ranks 0-1: 1 thread each on processor {ONE}\n", text)
        self.assertIn(f"warning: ranks 0-1 share processor {ONE}, 2 threads in all: they take turns", text)


unittest.main()
