"""What the tests of the program share: the program under test (the first argument), the sources, a run of it, a folder of its own for each test.
SPDX-License-Identifier: Apache-2.0"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/spindrift").resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]


def spindrift(*arguments, settings=(), ranks=0, timeout=600, env=None, cwd=None):
    """The finished program: exit code and what it said. `settings` become --set options; without ranks there is no mpirun."""
    launcher = [ROOT / "ci/mpirun", ranks] if ranks else []
    words = [*launcher, PROGRAM, *arguments, *(word for text in settings for word in ("--set", text))]
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, errors="replace", check=False, timeout=timeout, env=env, cwd=cwd)


class Folder(unittest.TestCase):
    """`path` is an empty folder that goes away with the test, `out` the run in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="spindrift_test_")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.out = self.path / "run"
