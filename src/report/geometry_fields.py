"""fields/geometry.xdmf: bodies, tower, nacelle, blades and lines as surfaces over time, beside the fields of air and water, and
fields/paraview.py, which opens all of them with sensible looks (paraview --script=fields/paraview.py).
Called by spindrift_report.py; read back in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import numpy as np

import geometry
import run_fields

KINDS = ["float", "brace", "tower", "nacelle", "hub", "blade", "line"]
MOST_TIMES = 200

STATE = '''# Opens the fields of this run in ParaView:  paraview --script={folder}/paraview.py
import pathlib
from paraview.simple import *

folder = pathlib.Path(__file__).resolve().parent if "__file__" in globals() else pathlib.Path({folder!r})
view = GetActiveViewOrCreate("RenderView")


def show(name, color=None, by=None, opacity=1.0, representation="Surface"):
    if not (folder / f"{{name}}.xdmf").exists():
        return None
    source = OpenDataFile(str(folder / f"{{name}}.xdmf"))
    RenameSource(name, source)
    shown = Show(source, view)
    shown.SetRepresentationType(representation)
    shown.Opacity = opacity
    ColorBy(shown, by)
    if by is None and color:
        shown.AmbientColor = shown.DiffuseColor = color
    return source


show("geometry", by=("CELLS", "kind"))
show("surface", color=[0.16, 0.42, 0.58], opacity=0.6)
show("particles", by=("POINTS", "velocity"), representation="Points")
show("walls", by=("CELLS", "pressure_coefficient"))
air = show("air", by=("CELLS", "velocity"), opacity=0.0)
if air is not None:   # the upright plane through the middle of the air
    plane = Slice(Input=air)
    plane.SliceType.Normal = [0.0, 1.0, 0.0]
    shown = Show(plane, view)
    ColorBy(shown, ("CELLS", "velocity"))
    Hide(air, view)
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
view.CameraPosition, view.CameraViewUp = [-600.0, -700.0, 250.0], [0.0, 0.0, 1.0]
ResetCamera()
Render()
'''


def _times(run):
    """Those of the run's outputs, else evenly through it."""
    fields = run_fields.Fields(run)
    found = sorted({round(t, 9) for name in fields.files for t in fields.times(name) if run.time[0] <= t <= run.time[-1]})
    found = found or list(np.linspace(run.time[0], run.time[-1], 50))
    return found[:: -(-len(found) // MOST_TIMES)]


def _cells(pieces):
    """Xdmf's mixed list: 3 n ... a polygon, 2 n ... a polyline; the kind of each cell."""
    flat, kinds, first = [], [], 0
    for piece in pieces:
        for code, cells in ((3, piece.polygons), (2, piece.lines)):
            for cell in cells:
                flat += [code, len(cell), *(first + int(i) for i in cell)]
                kinds.append(KINDS.index(piece.kind))
        first += len(piece.points)
    return np.array(flat, np.int32), np.array(kinds, np.int32)


def write(run):
    """Nothing where the run has no fields or no bodies. Returns the files written."""
    folder = run.folder / "fields"
    if not folder.is_dir() or not len(run.time):
        return []
    state = folder / "paraview.py"
    state.write_text(STATE.format(folder=str(folder.resolve())), encoding="utf-8")
    scene = geometry.Scene3d(run)
    times = _times(run)
    if not scene.pieces(times[0]):
        return [state]
    import h5py
    flat, kinds = _cells(scene.pieces(times[0]))
    steps = ""
    with h5py.File(folder / "geometry.h5", "w") as file:
        file["cells"], file["kind"] = flat, kinds
        file["kind"].attrs["names"] = KINDS
        for n, t in enumerate(times):
            points = np.concatenate([piece.points for piece in scene.pieces(t)])
            file[f"points_{n}"] = points.astype(np.float32)
            steps += (f'<Grid Name="geometry" GridType="Uniform"><Time Value="{t:.12g}"/>\n'
                      f'<Topology TopologyType="Mixed" NumberOfElements="{len(kinds)}">{_item(len(flat), "Int", "cells")}</Topology>\n'
                      f'<Geometry GeometryType="XYZ">{_item(f"{len(points)} 3", "Float", f"points_{n}")}</Geometry>\n'
                      f'<Attribute Name="kind" AttributeType="Scalar" Center="Cell">{_item(len(kinds), "Int", "kind")}</Attribute>\n</Grid>\n')
    (folder / "geometry.xdmf").write_text('<?xml version="1.0"?>\n<Xdmf Version="2.2"><Domain>\n<Grid Name="geometry" GridType="Collection" CollectionType="Temporal">\n'
                                          + steps + "</Grid>\n</Domain></Xdmf>\n", encoding="utf-8")
    return [state, folder / "geometry.xdmf"]


def _item(dimensions, kind, name):
    return f'<DataItem Dimensions="{dimensions}" NumberType="{kind}" Precision="4" Format="HDF">geometry.h5:/{name}</DataItem>'
