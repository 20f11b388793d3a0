"""An installation into an empty prefix and runs of its program, for installed_test.py and pages_test.py. SPDX-License-Identifier: Apache-2.0"""
import os
import pathlib
import subprocess
import tempfile
import unittest

ENVIRONMENT = dict(os.environ) | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}


def start(*words, **settings):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, env=ENVIRONMENT, check=False, **settings)


class Prefix(unittest.TestCase):
    build = None   # the build tree; the test sets it

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="spindrift_installed_")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.prefix, cls.runs = pathlib.Path(cls.folder.name) / "prefix", pathlib.Path(cls.folder.name) / "runs"
        done = start("cmake", "--install", cls.build, "--prefix", cls.prefix)
        assert done.returncode == 0, done.stderr
        cls.pages = cls.build / "pages"   # where reports and pictures of them are kept
        cls.pages.mkdir(exist_ok=True)
        cls.program, cls.inputs = cls.prefix / "bin/spindrift", cls.prefix / "share/spindrift/inputs"

    def run_scene(self, name, *more):
        out = self.runs / pathlib.Path(name).stem
        if not out.exists():
            done = start(self.program, "run", self.inputs / name, "--out", out, *more)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("report: ", done.stdout)
        return out
