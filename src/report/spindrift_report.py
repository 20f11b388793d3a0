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

PACKAGES = {"numpy": "python3-numpy", "matplotlib": "python3-matplotlib"}


def arguments():
    parser = argparse.ArgumentParser(prog="spindrift report", description="Report of a run, or of several side by side.")
    parser.add_argument("directories", nargs="+", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--out", type=pathlib.Path, help="default: report.html in DIR, comparison.html for several")
    parser.add_argument("--png", type=pathlib.Path, help="also draw a picture of the first run")
    return parser.parse_args()


def guarded(action):
    try:
        action()
    except (OSError, ValueError) as error:
        sys.exit(f"report not written: {error}")


def write(out, text):
    """Whole or not at all."""
    temporary = out.with_name(out.name + ".tmp")
    guarded(lambda: (temporary.write_text(text(), encoding="utf-8"), os.replace(temporary, out)))


def main():
    given = arguments()
    for folder in given.directories:
        if not folder.is_dir():
            sys.exit(f"{folder} is not a run directory")
    try:
        import page
        import picture
        import study_page
        from run_data import RunData
    except ModuleNotFoundError as missing:
        package = PACKAGES.get(missing.name, missing.name)
        sys.exit(f"Python at {sys.executable} has no module '{missing.name}': install the package {package} (ci/setup does)")
    if (given.directories[0] / "study.json").exists():
        return write(given.out or given.directories[0] / "study.html", lambda: study_page.build(given.directories[0]))
    runs = [RunData(folder) for folder in given.directories]
    out = given.out or given.directories[0] / ("report.html" if len(runs) == 1 else "comparison.html")
    write(out, lambda: page.build(runs))
    if given.png:
        guarded(lambda: picture.draw(runs[0], given.png))


if __name__ == "__main__":
    main()
