"""Reads fields through their XDMF file with h5py and checks them against the formulas of fields_test.cpp.
read_fields.py grid FILE.xdmf moving|resting OUTPUTS      read_fields.py particles FILE.xdmf COUNT
SPDX-License-Identifier: Apache-2.0"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np


def read(item, folder):
    """The array of a DataItem, in the shape and type that the XDMF promises."""
    name, path = item.text.strip().split(":")
    with h5py.File(folder / name, "r") as file:
        values = file[path][...]
    assert values.shape == tuple(int(n) for n in item.get("Dimensions").split()), (path, values.shape, item.get("Dimensions"))
    kind = {"Float": "f", "Int": "i"}[item.get("NumberType")]
    assert values.dtype == np.dtype(f"{kind}{item.get('Precision')}"), (path, values.dtype)
    return values


def series(path):
    root = ElementTree.parse(path).getroot()
    temporal = root.find("Domain/Grid")
    assert temporal.get("CollectionType") == "Temporal"
    return temporal.findall("Grid")


def check_grid(path, moving, outputs):
    shapes = {"inner": (4, 3, 2), "wall": (6, 5, 0), "wake": (5, 1, 1), "outer": (48, 41, 40)}
    steps = series(path)
    assert len(steps) == outputs, len(steps)
    with_points = set()
    for n, step in enumerate(steps):
        t = 0.5 * (n + 1)
        assert float(step.find("Time").get("Value")) == t
        blocks = step.findall("Grid")
        assert [block.get("Name") for block in blocks] == list(shapes)
        for b, (block, (ni, nj, nk)) in enumerate(zip(blocks, shapes.values())):
            corners, cells = ((nk + 1, nj + 1, ni + 1), (nk, nj, ni)) if nk else ((nj + 1, ni + 1), (nj, ni))
            item = block.find("Geometry/DataItem")
            with_points.add(item.text.split(":")[0])
            points = read(item, path.parent)
            k, j, i = np.meshgrid(range(nk + 1), range(nj + 1), range(ni + 1), indexing="ij")
            expected = np.stack([i + 100.0 * b, j + (t if moving else 0.0), k + 0.1 * i], axis=-1)
            np.testing.assert_array_equal(points, expected if nk else expected[0])
            topology = block.find("Topology")
            assert topology.get("Dimensions") == " ".join(map(str, corners)) and topology.get("TopologyType") == f"{len(cells)}DSMesh"
            values = {a.get("Name"): read(a.find("DataItem"), path.parent) for a in block.findall("Attribute")}
            cell = np.arange(np.prod(cells), dtype=float).reshape(cells)
            np.testing.assert_array_equal(values["pressure"], (1000.0 * b + cell + 0.5 * t).astype("f4"))
            np.testing.assert_array_equal(values["velocity"], np.stack([cell + t, 2 * cell, 0 * cell - b], axis=-1).astype("f4"))
            np.testing.assert_array_equal(values["absolute"], 101325.0 + 1e-9 * cell)
        # A file says all of it without the XDMF, in an array of points and one of each field for a block.
        with h5py.File(path.parent / blocks[0].find("Attribute/DataItem").text.split(":")[0], "r") as file:
            arrays = []
            file.visititems(lambda name, found: arrays.append(name) if isinstance(found, h5py.Dataset) else None)
            own = file.attrs["points_file"] in (file.filename.rpartition("/")[2], file.filename.rpartition("/")[2].encode())
            expected = {f"{block}/{array}" for block in shapes for array in ("pressure", "velocity", "absolute", *(["points"] if own else []))}
            assert set(arrays) == expected, arrays
            there = file.attrs["points_file"]
            assert (there.decode() if isinstance(there, bytes) else there) == item.text.split(":")[0]
            assert file["inner/velocity"].attrs["unit"] in ("m/s", b"m/s")
            assert file.attrs["time_s"] == t
    # At rest the points are in the first output of each of the two processes.
    assert len(with_points) == (outputs if moving else 2), with_points


def check_particles(path, count):
    steps = series(path)
    assert len(steps) == 2
    for step, t in zip(steps, (0.0, 1.5)):
        assert float(step.find("Time").get("Value")) == t
        assert int(step.find("Topology").get("NumberOfElements")) == count
        values = {a.get("Name"): read(a.find("DataItem"), path.parent) for a in step.findall("Attribute")}
        ids = values["id"]
        assert sorted(ids) == list(range(count))
        n = ids.astype(float)
        np.testing.assert_allclose(read(step.find("Geometry/DataItem"), path.parent), np.stack([0.1 * n, 0 * n + t, 0 * n - 1], axis=-1))
        np.testing.assert_array_equal(values["density"], (1000 + n).astype("f4"))
        np.testing.assert_array_equal(values["velocity"], np.stack([0 * n, 0 * n + t, 2 * n], axis=-1).astype("f4"))


if sys.argv[1] == "grid":
    check_grid(pathlib.Path(sys.argv[2]), sys.argv[3] == "moving", int(sys.argv[4]))
else:
    check_particles(pathlib.Path(sys.argv[2]), int(sys.argv[3]))
