#!/usr/bin/python3
"""Makes the report of a run, or of several side by side, from their run directories alone.

    spindrift_report.py DIR                   DIR/report.html
    spindrift_report.py DIR DIR2 ...          DIR/comparison.html, the runs laid over each other
    spindrift_report.py STUDY                 STUDY/study.html, of the folder of `spindrift study`
    --out FILE    write there instead         --png FILE    also a picture of the (first) run

`spindrift run` and `spindrift report` call it (src/report/report.cpp). SPDX-License-Identifier: Apache-2.0"""
import argparse
import os
import pathlib
import sys
import time

PACKAGES = {"numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "jinja2": "python3-jinja2"}
SILENT_S = 5.0   # a report that takes longer says what it does


def arguments():
    parser = argparse.ArgumentParser(prog="spindrift report", description="Report of a run, or of several side by side.")
    parser.add_argument("directories", nargs="+", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--out", type=pathlib.Path, help="default: report.html in DIR, comparison.html for several")
    parser.add_argument("--png", type=pathlib.Path, help="also draw a picture of the first run")
    parser.add_argument("--verdict", action="store_true", help="also print what a run came to")
    return parser.parse_args()


def say_verdict(run):
    """The report's first lines, for who looks at the terminal."""
    import verdict
    came_to = "; ".join(f"{text} {value} {unit}".strip() for text, value, unit in verdict.answers(run))
    for line in (came_to, f"verdict: {verdict.headline(verdict.health(run))[1]}"):
        if line:
            print(line, flush=True)


def fail(code, words):
    """2 bad input, 4 what the machine lacks."""
    print(words, file=sys.stderr)
    sys.exit(code)


def guarded(action):
    try:
        action()
    except (OSError, ValueError) as error:
        fail(4, f"not written: {error}")


def surfaces(run):
    """fields/geometry.xdmf; needs h5py as all fields do."""
    try:
        import geometry_fields
        geometry_fields.write(run)
    except ModuleNotFoundError:
        pass


class Progress:
    def __init__(self):
        self.began = time.monotonic()

    def __call__(self, words):
        if (passed := time.monotonic() - self.began) > SILENT_S:
            print(f"  {passed:3.0f} s: {words}", flush=True)


def write(out, text):
    """Whole or not at all."""
    temporary = out.with_name(out.name + ".tmp")
    guarded(lambda: (temporary.write_text(text(), encoding="utf-8"), os.replace(temporary, out)))


def main():
    given = arguments()
    for folder in given.directories:
        if not folder.is_dir():
            fail(2, f"{folder} is not a run directory: {'it is a file' if folder.exists() else 'there is nothing of that name'}; "
                    "name the folder of a run (run SCENE --out FOLDER)")
        if not any((folder / name).exists() for name in ("history.csv", "summary.json", "scene.toml", "study.json")):
            fail(2, f"{folder} is not a run directory: it has neither history.csv nor summary.json; name the folder of a run (run SCENE --out FOLDER)")
    studies = [folder for folder in given.directories if (folder / "study.json").exists()]
    if studies and len(given.directories) > 1:
        fail(2, f"{studies[0]} is the folder of a study, which has a page of its own: spindrift report {studies[0]}; its runs are the folders in it")
    seen = {}
    for folder in given.directories:
        if (twice := seen.setdefault(folder.resolve(), folder)) is not folder:
            fail(2, f"{folder} is given twice: a run differs from itself by nothing; name another run beside {twice}")
    try:
        import page
        import picture
        import study_page
        from run_data import RunData
    except ModuleNotFoundError as missing:
        package = PACKAGES.get(missing.name, missing.name)
        fail(4, f"Python at {sys.executable} has no module '{missing.name}': install the package {package} (ci/setup does)")
    progress = Progress() if given.verdict else lambda words: None
    if (given.directories[0] / "study.json").exists():
        return write(given.out or given.directories[0] / "study.html", lambda: study_page.build(given.directories[0]))
    runs = [RunData(folder) for folder in given.directories]
    out = given.out or given.directories[0] / ("report.html" if len(runs) == 1 else "comparison.html")
    write(out, lambda: page.build(runs, progress))
    if len(runs) == 1:
        progress("surfaces for ParaView")
        guarded(lambda: surfaces(runs[0]))
    if given.png:
        guarded(lambda: picture.draw(runs[0], given.png))
    if given.verdict and len(runs) == 1:
        say_verdict(runs[0])


if __name__ == "__main__":
    main()
