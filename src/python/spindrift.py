"""Spindrift's results in Python: open a run, its columns with units, its fields; run a scene and get its result; read a study.

    import spindrift
    run = spindrift.open("runs/demo/coupled")
    run["platform.pitch_deg"]                  # numpy array, one value per row of history.csv
    run.units["platform.pitch_deg"]            # "deg"
    run.mean("rotor.thrust_N", after=8.0)
    for field in run.fields("air"):            # h5py is needed
        print(field.time, field.blocks(), field["ring_1/pressure"].shape)
    result = spindrift.run("scene.toml", out="run1", set={"time.end_s": 60.0})
    study = spindrift.open_study("runs/steps")

Pure Python on numpy; h5py for fields. The program is found beside this module where both are installed, in the environment variable
SPINDRIFT, or on the path. Tested in tests/src/python/spindrift_test.py. SPDX-License-Identifier: Apache-2.0"""
import builtins
import json
import os
import pathlib
import shutil
import subprocess
import tomllib

import numpy as np

__all__ = ["Run", "Field", "Study", "RunFailed", "open", "open_study", "run", "program"]


class RunFailed(RuntimeError):
    """A run that did not end with exit code 0: `code`, `output` of the program."""

    def __init__(self, code, output):
        super().__init__(f"spindrift ended with exit code {code}: " + (output.strip().splitlines() or ["it says nothing"])[-1])
        self.code, self.output = code, output


class Run:
    """A run directory: `time`, columns by name, `units`, `summary`, `scene`."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        path = self.directory / "history.csv"
        if not path.exists():
            raise FileNotFoundError(f"{self.directory} is not a run directory: it has no history.csv")
        with builtins.open(path, encoding="utf-8-sig") as file:
            self.columns = file.readline().strip().split(",")
            lines = [line for line in file if line.endswith("\n") and line.count(",") == len(self.columns) - 1]   # the last one may be half written
        values = np.array([line.split(",") for line in lines], dtype=float).reshape(-1, len(self.columns))
        self._values = dict(zip(self.columns, values.T))
        self.summary = self._json("summary.json")
        scene = self.directory / "scene.toml"
        self.scene = tomllib.loads(scene.read_text(encoding="utf-8-sig")) if scene.exists() else {}
        self.units = {c["name"]: c.get("unit", "") for c in self.summary.get("columns", [])}
        self.meanings = {c["name"]: c.get("meaning", "") for c in self.summary.get("columns", [])}

    def _json(self, name):
        path = self.directory / name
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}

    @property
    def time(self):
        """Simulated time of each row [s]."""
        return self._values["time_s"]

    @property
    def exit_code(self):
        """0 done, 3 numerical failure, 5 stopped on request ...; None of a run at work, or killed."""
        return self.summary.get("exit_code")

    def __getitem__(self, name):
        try:
            return self._values[name]
        except KeyError:
            near = [c for c in self.columns if name.lower() in c.lower() or c.rpartition(".")[2] == name.rpartition(".")[2]]
            raise KeyError(f"{self.directory}: no column '{name}'" + (f"; near: {', '.join(near[:5])}" if near else "")) from None

    def __contains__(self, name):
        return name in self._values

    def __len__(self):
        return len(self.time)

    def __repr__(self):
        return f"<spindrift.Run {self.directory}: {len(self)} rows, {len(self.columns)} columns, to {self.time[-1] if len(self) else 0:g} s>"

    def mean(self, name, after=None, before=None):
        """Trapezoidal mean of a column over after <= time <= before [s]; the whole run where they are not given."""
        chosen = np.ones(len(self), bool)
        if after is not None:
            chosen &= self.time >= after
        if before is not None:
            chosen &= self.time <= before
        time, values = self.time[chosen], self[name][chosen]
        if len(time) < 2:
            raise ValueError(f"no two rows between {after} and {before} s")
        return float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(time)) / (time[-1] - time[0]))

    def fields(self, name):
        """The outputs fields/NAME_*.h5 in the order of their times; NAME: air, walls, particles, surface."""
        found = [Field(path) for path in (self.directory / "fields").glob(f"{name}_*.h5")]
        if not found:
            there = sorted({p.name.rpartition("_")[0] for p in (self.directory / "fields").glob("*.h5")})
            raise FileNotFoundError(f"{self.directory} has no fields '{name}'" + (f"; there are {', '.join(there)}" if there else ""))
        return sorted(found, key=lambda field: field.time)


class Field:
    """One output of fields: `time` [s]; arrays by path ("position", "ring_1/pressure"), their units; of grids the points of a block."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        with self._file() as file:
            self.time = float(file.attrs["time_s"])

    def _file(self):
        import h5py
        return h5py.File(self.path)

    def names(self):
        """Paths of all arrays."""
        import h5py
        found = []
        with self._file() as file:
            file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None)
        return found

    def __getitem__(self, name):
        with self._file() as file:
            return file[name][...]

    def blocks(self):
        """Names of a grid's blocks."""
        return sorted({name.partition("/")[0] for name in self.names() if "/" in name})

    def points(self, block):
        """Corners of a block's cells [m], (nk + 1, nj + 1, ni + 1, 3); of a grid that stands they are in the file of another output."""
        with self._file() as file:
            there = file.attrs.get("points_file", self.path.name)
        other = Field(self.path.parent / (there.decode() if isinstance(there, bytes) else str(there)))
        return other[f"{block}/points"]

    def unit(self, name):
        with self._file() as file:
            unit = file[name].attrs.get("unit", "")
            return unit.decode() if isinstance(unit, bytes) else str(unit)

    def __repr__(self):
        return f"<spindrift.Field {self.path.name} at {self.time:g} s>"


class Study:
    """The folder of a study: `rungs` (dicts as in study.json: name, cost, errors by metric, on_front, failed), `front` (their names), `answer` (the name of
    the cheapest that meets all targets, None where none does), `sentence`, `metrics`."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        path = self.directory / "study.json"
        if not path.exists():
            raise FileNotFoundError(f"{self.directory} is not the folder of a study: it has no study.json")
        self.summary = json.loads(path.read_text(encoding="utf-8"))
        self.rungs, self.metrics = self.summary["rungs"], self.summary["metrics"]
        self.front, self.answer, self.sentence = self.summary["front"], self.summary["answer"], self.summary["sentence"]

    def __repr__(self):
        return f"<spindrift.Study {self.directory}: {len(self.rungs)} rungs, {self.sentence}>"

    def rung(self, name):
        found = [r for r in self.rungs if r["name"] == name]
        if not found:
            raise KeyError(f"{self.directory}: no rung '{name}'; there are: {', '.join(r['name'] for r in self.rungs)}")
        return found[0]

    def error(self, name, metric):
        """Error of a rung in a metric, and its interval (low, high)."""
        e = self.rung(name)["errors"][metric]
        return e["error"], (e["low"], e["high"])

    def core_seconds(self, name):
        """Cost of a run of a rung [core-s]."""
        return self.rung(name)["cost"]["core_s"]

    def open(self, name):
        """The run of a rung, or of a replica of it (its folder's name)."""
        return Run(self.directory / name)


def open(directory):  # noqa: A001  spindrift.open reads better than any other name
    """A run directory as a `Run`."""
    return Run(directory)


def open_study(directory):
    return Study(directory)


def program():
    """Path of the program: $SPINDRIFT, beside an installed module, on the path."""
    if chosen := os.environ.get("SPINDRIFT"):
        return chosen
    for folder in pathlib.Path(__file__).resolve().parents:
        if (folder / "bin/spindrift").exists():
            return str(folder / "bin/spindrift")
    if found := shutil.which("spindrift"):
        return found
    raise FileNotFoundError("the program spindrift is not found: set the environment variable SPINDRIFT to its path")


def run(scene, out, set=None, until=None, ranks=1, threads=None, overwrite=False, restart=False, report=True):  # noqa: A002  as on the command line
    """Runs a scene and opens the result. `set`: {"time.end_s": 60.0, ...}. Raises RunFailed with the program's output where it does not end well."""
    words = [program(), "run", str(scene), "--out", str(out)]
    for key, value in (set or {}).items():
        words += ["--set", f"{key}={_toml(value)}"]
    words += ["--until", str(until)] if until is not None else []
    words += [flag for flag, wanted in (("--overwrite", overwrite), ("--restart", restart), ("--no-report", not report)) if wanted]
    if ranks > 1:
        words = ["mpirun", "-n", str(ranks)] + words
    environment = dict(os.environ) | ({"OMP_NUM_THREADS": str(threads)} if threads else {})
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RunFailed(done.returncode, done.stdout + done.stderr)
    return Run(out)


def _toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    if isinstance(value, np.generic):
        return _toml(value.item())
    return repr(value)
