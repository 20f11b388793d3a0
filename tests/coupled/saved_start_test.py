"""States of other runs that a scene starts from (start.file, sea.initial.file): what does not fit is refused by `check` as by `run`, by its key, and
`check` builds nothing for it. Usage: saved_start_test.py SPINDRIFT [CLASS...]"""
import sys
import unittest

from running import ROOT, Runs, spindrift

PENDULUM, COLUMN = ROOT / "inputs/tutorials/pendulum.toml", ROOT / "inputs/validation/dam_break/koshizuka_oka.toml"
COARSE = ["sea.particles.spacing_m=0.1"]


class SavedStart(Runs):
    def refused(self, scene, settings, key, words):
        said = []
        for command in (("check", scene), ("run", scene, "--quiet", "--no-report", "--overwrite", "--out", self.path / "refused")):
            done = spindrift(*command, settings=settings)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(f"{key} = ", done.stderr)
            self.assertIn(words, done.stderr)
            said.append(done.stderr.partition(f"{key} = ")[2])
        self.assertEqual(*said)

    def saved(self, name):
        return max((self.path / name / "checkpoints").glob("*.h5"))

    def damaged(self, saved):
        """A checkpoint with half of its bytes, one with a bit turned in its arrays, and no checkpoint at all."""
        whole = saved.read_bytes()
        half, turned, none = (self.path / f"{name}.h5" for name in ("half", "turned", "none"))
        half.write_bytes(whole[:len(whole) // 2])
        turned.write_bytes(whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:])
        none.write_text("no checkpoint")
        return half, turned, none

    def test_a_state_of_bodies_that_does_not_fit_is_refused(self):
        self.run_scene(PENDULUM, "swings", settings=["time.end_s=1.0"])
        saved = self.saved("swings")
        done = spindrift("check", PENDULUM, settings=[f"start.file={self.path / 'swings/scene.toml'}"])
        self.assertEqual(done.returncode, 0, done.stderr)
        for scene, settings, words in ((PENDULUM, ["time.end_s=0.5"], "the run ends at 0.5 s"),
                                       (PENDULUM, ["time.end_s=1.0"], "the run ends at 1 s"),
                                       (PENDULUM, ["time.window_s=0.06", "time.step_s=0.006", "time.end_s=6.0"], "no whole number of windows"),
                                       (ROOT / "tests/extremes/pendulum.toml", ["time.end_s=20.0", "time.window_s=0.05", "time.step_s=0.005"], "bodies and joints are not those")):
            self.refused(scene, [f"start.file={saved}", *settings], "start.file", words)
        self.refused(PENDULUM, [f"start.file={ROOT / 'inputs/README.md'}"], "start.file", "there is no checkpoint")
        for file in self.damaged(saved):
            self.refused(PENDULUM, [f"start.file={file}"], "start.file", str(file))

    def test_a_sea_that_does_not_fit_is_refused(self):
        self.run_scene(COLUMN, "falls", settings=[*COARSE, "time.end_s=0.1"])
        self.run_scene(PENDULUM, "swings", settings=["time.end_s=0.1"])
        file = lambda name: ["sea.initial.state=file", f"sea.initial.file={name}"]
        saved = self.saved("falls")
        for settings in (file(saved), [f"start.file={saved}"]):
            done = spindrift("check", COLUMN, settings=[*COARSE, *settings])
            self.assertEqual(done.returncode, 0, done.stderr)
            key = settings[-1].split("=")[0]
            self.refused(COLUMN, ["sea.particles.spacing_m=0.05", *settings], key, "values of particles")
        self.refused(COLUMN, [*COARSE, *file(self.saved("swings"))], "sea.initial.file", "no particles")
        self.refused(COLUMN, [*COARSE, *file(ROOT / "inputs/README.md")], "sea.initial.file", "there is no checkpoint")
        for damaged in self.damaged(saved):
            self.refused(COLUMN, [*COARSE, *file(damaged)], "sea.initial.file", str(damaged))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
