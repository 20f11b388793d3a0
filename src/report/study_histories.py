"""Histories of a study's runs, read once each. SPDX-License-Identifier: Apache-2.0"""
import pathlib

import numpy as np


class History:
    def __init__(self, path):
        with open(path, encoding="utf-8-sig") as file:
            header = next(line for line in file if line.split("#")[0].strip())
            self.names = [name.strip() for name in header.split("#")[0].split(",")]
            self.rows = np.loadtxt(file, delimiter=",", ndmin=2)

    def __call__(self, column):
        return self.rows[:, self.names.index(column)]


def reader(folder):
    """history(name) -> (time, column reader); `name`: of a run of the study, or a file from elsewhere."""
    known = {}

    def history(name):
        if name not in known:
            path = pathlib.Path(name)
            known[name] = History(path if path.suffix == ".csv" and path.is_absolute() else folder / name / "history.csv")
        return known[name]("time_s"), known[name]

    return history
