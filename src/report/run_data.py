"""One run directory, read: scene, history, summary, log, trace. What is missing or broken is said in `notes`, never an error.
Called by spindrift_report.py; tested in tests/src/report. SPDX-License-Identifier: Apache-2.0"""
import functools
import gzip
import json
import pathlib
import tomllib
import warnings
import zlib

import numpy as np

import quantities

CHUNK_BYTES = 64 << 20
TRACE_LIMIT_BYTES = 200 << 20
SILENT = ("output.", "checkpoint.", "runtime.", "time.end_s", "sea.fields.", "coupling.placement", "coupling.air_ranks")   # keys that change no result


def columns(path):
    """{name: values} of a CSV file with comments."""
    rows = [line.split(",") for line in path.read_text(encoding="utf-8-sig").splitlines() if line.strip() and not line.startswith("#")]
    return {name.strip(): [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def with_bases(path):
    """A turbine file's tables with those of the files that its `base` names; what names a file in them is a path."""
    def taken(key):
        given = found.pop(key, [])
        return [given] if isinstance(given, str) else given

    found, whole = tomllib.loads(path.read_text(encoding="utf-8-sig")), {}
    for base in taken("base"):
        _overlay(whole, with_bases(path.parent / base))
    for key in taken("without"):
        *tables, last = key.split(".")
        functools.reduce(dict.__getitem__, tables, whole).pop(last)
    return _overlay(whole, _placed(found, path.parent))


def _overlay(under, over):
    for key, value in over.items():
        under[key] = _overlay(under[key], value) if isinstance(value, dict) and isinstance(under.get(key), dict) else value
    return under


def _placed(value, folder, key=""):
    if isinstance(value, dict):
        return {name: _placed(inner, folder, name) for name, inner in value.items()}
    if isinstance(value, list):
        return [_placed(inner, folder) for inner in value]
    return str(folder / value) if key in ("file", "operation", "planform") and value else value


class RunData:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.notes = []
        self.name = self.folder.resolve().name
        self.scene_text = self._text("scene.toml")
        self.scene = self._scene()
        self.summary = self._json("summary.json")
        self.columns, self.values = self._history()  # names; array[column, row]
        self.log = self._text("log.txt").splitlines()
        self.tasks = []
        self.trace = self._trace()
        self._round_off = {}  # by kind or unit
        self.described = {c.get("name"): c for c in self.summary.get("columns", []) if isinstance(c, dict)}

    @property
    def own_title(self):
        return str(self.summary.get("title") or self.name)

    @property
    def title(self):
        """The scene's, with what the command line made of it: a picture must not pass for that of another run."""
        return f"{self.own_title}, {self.changed}" if self.changed else self.own_title

    @property
    def changed(self):
        """'with waves.period_s = 30': what --set changed of the results, unless it gave a title too."""
        changed = self.changed_keys()
        if not changed or any(words.startswith("output.title") for words in map(str, self.summary.get("set") or [])):
            return ""
        left_out = [words.partition("=")[2].strip("[] ").replace('"', "") for words in changed if words.startswith("without=")]
        given = [words.replace("=", " = ", 1) for words in changed if not words.startswith("without=")]
        said = ", ".join([*(f"without {what}" for what in left_out), *(["with " + ", ".join(given)] if given else [])])
        return said if len(said) <= 65 else f"with {len(changed)} keys changed" if len(changed) > 1 else f"with {changed[0].partition('=')[0]} changed"

    def changed_keys(self):
        """What --set changed of the results, as given: KEY=VALUE."""
        return [words for words in map(str, self.summary.get("set") or []) if not words.startswith(SILENT)]

    @property
    def time(self):
        return self.values[0] if len(self.columns) else np.empty(0)

    def column(self, name):
        return self.values[self.columns.index(name)]

    def round_off(self, name):
        """What a column must exceed to count: 1e-12 of the largest value among the columns of its unit; of motions and loads of bodies so much
        of the largest of their kind that nobody looks for it, as a motion that none drives is left by iterations that end. What has no unit
        is of its own kind, for a residual is not small beside a CFL number; but the coefficients of forces are one."""
        def kind_of(column):
            alike = quantities.kind_of_body(column) or quantities.unit_of(column, self.described)
            return alike or ("coefficient" if column.endswith("_coefficient") else column)

        kind = kind_of(name)
        if kind not in self._round_off:
            def largest(like):
                values = self.values[[like(other) for other in self.columns]]
                return np.abs(values[np.isfinite(values)]).max(initial=0.0)

            alike = largest(lambda other: kind_of(other) == kind)
            if kind == "moment":   # at an arm of a metre
                alike = max(alike, largest(lambda other: quantities.kind_of_body(other) == "force"))
            share, least = {"displacement": (1e-6, 0.0), "angle": (1e-6, 1e-6), "force": (1e-8, 0.0), "moment": (1e-8, 0.0)}.get(kind, (1e-12, 0.0))
            self._round_off[kind] = max(share * alike, least)
        return self._round_off[kind]

    def mean_range(self):
        """Rows and words of the range that means are taken over: the summary's last that holds rows, else, of a run that did not end, as long a one
        as the run would have taken (Output::mean_length): output.means_over_s, or a third."""
        def rows(start, end):
            margin = 1e-9 * max(1.0, abs(end))
            steady = (self.scene.get("aero", {}).get("flow") or {}).get("time") == "steady"
            chosen = (self.time >= start - margin) & (self.time <= end + margin)
            return chosen, f"pseudo-steps {np.ceil(start - margin):.0f} to {end:.0f}" if steady else f"{start:.4g} to {end:.4g} s"

        for found in list((self.summary.get("ranges") or {}).values())[::-1]:
            if isinstance(found, dict) and isinstance(found.get("from_s"), (int, float)) and isinstance(found.get("to_s"), (int, float)):
                chosen = rows(found["from_s"], found["to_s"])
                if chosen[0].any():
                    return chosen
        wanted = (self.scene.get("output") or {}).get("means_over_s") or 0.0
        return rows(max(self.time[0], self.time[-1] - (wanted if wanted > 0.0 else (self.time[-1] - self.time[0]) / 3.0)), self.time[-1])

    def rotors(self):
        """What the columns of each rotor begin with, and its section: [rotor], or each [rotors.NAME]."""
        several = self.scene.get("rotors")
        if isinstance(several, dict) and several:
            return [(f"rotor.{name}", given) for name, given in several.items()]
        given = self.scene.get("rotor", {})
        return [("rotor", given if isinstance(given, dict) else {})]

    def _named_by_rotor(self, key, rotor):
        """The file that a key of a rotor's section names; paths of scene.toml start at the run directory."""
        name = (self.rotors()[0][1] if rotor is None else rotor).get(key)
        return self.folder / name if isinstance(name, str) and name else None

    def turbine(self, rotor=None):
        """Of a rotor's section, without one of the first: the [turbine] of the turbine file and its bases, {} where there is none or it is gone."""
        try:
            return with_bases(self._named_by_rotor("turbine", rotor))["turbine"]
        except (AttributeError, OSError, KeyError, TypeError, ValueError, RecursionError):
            return {}

    def blades(self, rotor=None):
        """Of a rotor's section, without one of the first."""
        found = self.turbine(rotor).get("blades", 3)
        return found if isinstance(found, int) else 3

    def operation(self, rotor=None):
        """{column: values} of the turbine's steady operation, None where neither scene nor turbine file names one."""
        path = self._named_by_rotor("operation", rotor)
        if path is None and isinstance(named := self.turbine(rotor).get("operation"), str) and named:
            path = pathlib.Path(named)
        try:
            return columns(path)
        except (AttributeError, OSError, ValueError, IndexError):
            return None

    def _text(self, name):
        try:
            return (self.folder / name).read_text(encoding="utf-8-sig", errors="replace")
        except FileNotFoundError:
            return ""
        except OSError as error:
            self.notes.append(f"{name} cannot be read: {error.strerror}")
            return ""

    def _json(self, name):
        text = self._text(name)
        if not text:
            self.notes.append(f"{name} is missing: the run did not come to an orderly end, or goes on")
            return {}
        try:
            found = json.loads(text)
            return found if isinstance(found, dict) else {}
        except ValueError as error:
            self.notes.append(f"{name} is not valid JSON: {error}")
            return {}

    def _scene(self):
        try:
            return tomllib.loads(self.scene_text)
        except tomllib.TOMLDecodeError as error:
            self.notes.append(f"scene.toml cannot be read: {error}")
            return {}

    def _history(self):
        path = self.folder / "history.csv"
        if not path.exists():
            self.notes.append("history.csv is missing: there is nothing to plot")
            return [], np.empty((0, 0))
        with open(path, "rb") as file:
            names = file.readline().decode("utf-8-sig", errors="replace").strip().split(",")
            blocks, rest = [], b""
            while chunk := file.read(CHUNK_BYTES):
                text, newline, rest = (rest + chunk).rpartition(b"\n")  # a half-written last line stays behind
                if newline:
                    blocks.append(self._rows(text.rstrip(b"\r").replace(b"\r\n", b"\n"), len(names)))
        rows = np.concatenate(blocks) if blocks else np.empty((0, len(names)))
        return (names, rows.T) if names != [""] else ([], np.empty((0, 0)))

    def _rows(self, text, width):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # it stops at what is no number; counted below
            values = np.fromstring(text.replace(b"\n", b","), sep=",")
        if len(values) == width * (text.count(b"\n") + 1):
            return values.reshape(-1, width)
        rows = []
        for line in text.split(b"\n"):
            try:
                row = [float(field) for field in line.split(b",")]
            except ValueError:
                row = []
            if len(row) == width:
                rows.append(row)
        self.notes.append(f"history.csv: {text.count(10) + 1 - len(rows)} of its lines are damaged and left out")
        return np.array(rows).reshape(-1, width)

    def _trace(self):
        """Seconds by task label (its first two parts), of the complete events of trace.json.gz; `tasks`: (start [s], end [s], module, (rank, thread)) of each."""
        path = self.folder / "trace.json.gz"
        if not path.exists():
            return {}
        try:
            with gzip.open(path) as file:
                text = file.read(TRACE_LIMIT_BYTES + 1)
            if len(text) > TRACE_LIMIT_BYTES:
                self.notes.append("trace.json.gz is too large to be summed up here; open it in the Perfetto viewer")
                return {}
            found = json.loads(text)
            events = found.get("traceEvents", []) if isinstance(found, dict) else found
            seconds = {}
            for event in events:
                if event.get("ph") == "X":
                    words, took, start = str(event.get("name", "")).split("/"), 1e-6 * float(event.get("dur", 0.0)), 1e-6 * float(event.get("ts", 0.0))
                    label = "/".join(words[:2])
                    seconds[label] = seconds.get(label, 0.0) + took
                    self.tasks.append((start, start + took, words[0], (event.get("pid", 0), event.get("tid", 0))))
            return seconds
        except (OSError, EOFError, zlib.error, ValueError, AttributeError, TypeError) as error:
            self.notes.append(f"trace.json.gz cannot be read: {error}")
            return {}
