"""fields/geometry.xdmf and wake.xdmf: bodies, tower, nacelle, blades and lines, and the slow air behind a resolved rotor, as surfaces over time, beside
the fields of air and water; fields/paraview.py opens all of them as the run's pictures show them (paraview --script=fields/paraview.py).
Called by spindrift_report.py; read back in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import numpy as np

import geometry
import run_fields
import verdict
import wake

KINDS = list(geometry.COLOURS)
MOST_TIMES = 200
MOST_CELLS = 2_000_000   # cut for the wake, of all its times: some ten seconds

STATE = '''# Opens the fields of this run in ParaView:  paraview --script={folder}/paraview.py
# What is hidden at first is in the pipeline browser: particles, the air and its walls.
import pathlib
from paraview.simple import *

folder = pathlib.Path(__file__).resolve().parent if "__file__" in globals() else pathlib.Path({folder!r})
view = GetActiveViewOrCreate("RenderView")
view.UseColorPaletteForBackground, view.BackgroundColorMode = 0, "Gradient"
view.Background, view.Background2 = [0.93, 0.96, 0.98], [0.55, 0.70, 0.86]
colours = {colours!r}


sources = {{}}
for name in ("geometry", "surface", "particles", "wake", "walls", "air"):
    if (folder / f"{{name}}.xdmf").exists():
        sources[name] = OpenDataFile(str(folder / f"{{name}}.xdmf"))
        RenameSource(name, sources[name])
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()


def show(name, by, opacity=1.0, representation="Surface", hidden=False):
    """Coloured by an array of the points or cells, or plainly by three numbers."""
    if name not in sources:
        return None
    shown = Show(sources[name], view)
    shown.SetRepresentationType(representation)
    shown.Opacity = opacity
    if isinstance(by, list):
        ColorBy(shown, None)
        shown.AmbientColor = shown.DiffuseColor = by
    else:
        ColorBy(shown, by)
        shown.RescaleTransferFunctionToDataRange()
    if hidden:
        Hide(sources[name], view)
    return shown


geometry = show("geometry", ("CELLS", "kind"))
if geometry:
    kinds = GetColorTransferFunction("kind")
    kinds.InterpretValuesAsCategories = 1
    kinds.Annotations = [word for n, kind in enumerate(colours) for word in (str(n), kind)]
    kinds.IndexedColors = [part for colour in colours.values() for part in colour]
    geometry.LineWidth = 3.0
water = show("surface", [0.16, 0.42, 0.58], opacity=0.6, hidden={plane})
show("particles", ("POINTS", "velocity"), representation="Points", hidden=bool(water) and not {plane})
wake = show("wake", ("POINTS", "axial_wind"), hidden=True)
if wake:   # slower than {slow} of the wind, from the disc to a diameter behind it
    slow = Clip(Input=sources["wake"], ClipType="Scalar", Scalars=["POINTS", "axial_wind"], Value={slow}, Invert=1)
    for radii, invert in ((0.03, 0), (2.0, 1)):
        slow = Clip(Input=slow, ClipType="Plane", Invert=invert)
        slow.ClipType.Origin = [x + radii * {radius} * n for x, n in zip({hub}, {axis})]
        slow.ClipType.Normal = {axis}
    RenameSource("slow air", slow)
    shown = Show(slow, view)
    shown.Opacity = 0.85
    ColorBy(shown, ("POINTS", "axial_wind"))
    wind = GetColorTransferFunction("axial_wind")
    wind.ApplyPreset("Viridis (matplotlib)", True)
    wind.RescaleTransferFunction(0.0, 1.2)
    bar = GetScalarBar(wind, view)
    bar.Title, bar.ComponentTitle, bar.TitleColor, bar.LabelColor = "axial wind / free wind", "", [0.1, 0.1, 0.1], [0.1, 0.1, 0.1]
    shown.SetScalarBarVisibility(view, True)
show("walls", ("CELLS", "pressure_coefficient"), hidden=bool(geometry))
show("air", ("CELLS", "velocity"), hidden=bool(geometry or wake))
Render()   # the first one resets the camera
view.CameraViewUp = [0.0, 0.0, 1.0]
middle, length = {middle!r}, {length!r}   # of the bodies and the turbine [m]
if {plane}:   # a section or a tank, seen along y
    view.CameraParallelProjection = 1
    low = sources.get("walls") or sources.get("particles") or next(iter(sources.values()))
    low, high = (low.GetDataInformation().GetBounds()[n::2] for n in (0, 1))
    view.CameraFocalPoint = [0.5 * (a + b) for a, b in zip(low, high)]
    view.CameraPosition = [view.CameraFocalPoint[0], low[1] - 10.0 * (high[0] - low[0]), view.CameraFocalPoint[2]]
    view.CameraParallelScale = 0.5 * max(high[0] - low[0], high[2] - low[2])
elif length:
    view.CameraFocalPoint = middle
    view.CameraPosition = [middle[0] - 1.7 * length, middle[1] - 1.95 * length, middle[2] + 0.5 * length]
else:
    view.CameraPosition = [-600.0, -700.0, 250.0]
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
    """Nothing where the run has no fields. Returns the files written."""
    folder = run.folder / "fields"
    if not folder.is_dir() or not len(run.time):
        return []
    scene, times = geometry.Scene3d(run), _times(run)
    pieces = scene.pieces(times[0])
    solid = [piece.points for piece in pieces if piece.kind != "line"] or [piece.points for piece in pieces]
    low, high = (f(np.concatenate(solid), axis=0) for f in (np.min, np.max)) if solid else (np.zeros(3), np.zeros(3))
    state = folder / "paraview.py"
    rotor = scene.rotor
    state.write_text(STATE.format(
        folder=str(folder.resolve()), colours=geometry.COLOURS, middle=_numbers(0.5 * (low + high)), length=round(float((high - low).max()), 4),
        plane=verdict.is_plane(run), slow=wake.SLOW, radius=float(wake.tip(scene)) if rotor else 0.0, hub=_numbers(rotor.hub(times[-1]) if rotor else np.zeros(3)),
        axis=_numbers(rotor.frame(times[-1])[0] if rotor else [1, 0, 0])), encoding="utf-8")
    return [state, *([_solids(folder, scene, times)] if pieces else []), *_slow_air(run, scene, folder)]


def _numbers(values):
    return [round(float(x), 4) for x in values]


def _slow_air(run, scene, folder):
    """wake.xdmf, of a resolved rotor."""
    fields = run_fields.Fields(run)
    if scene.rotor is None or wake.wind(scene) <= 0.0 or not fields.files["air"]:
        return []
    import h5py
    times, steps = fields.times("air"), ""
    cells = sum(block["velocity"][..., 0].size for block in fields.air(times[-1])[0])
    most = min(MOST_TIMES, max(1, MOST_CELLS // max(cells, 1)))
    with h5py.File(folder / "wake.h5", "w") as file:
        for n, t in enumerate(times[::-1][:: -(-len(times) // most)][::-1]):   # the last one always
            found = [surface for surface in wake.surfaces(scene, fields.air(t)[0], t) if surface is not None]
            if not found:
                continue
            points, values = (np.concatenate(parts).astype(np.float32) for parts in zip(*found))
            count = len(points)
            file[f"points_{n}"], file[f"axial_wind_{n}"], file[f"cells_{n}"] = points.reshape(-1, 3), values.ravel(), np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
            steps += (f'<Grid Name="wake" GridType="Uniform"><Time Value="{t:.12g}"/>\n'
                      f'<Topology TopologyType="Triangle" NumberOfElements="{count}">{_item("wake", f"{count} 3", "Int", f"cells_{n}")}</Topology>\n'
                      f'<Geometry GeometryType="XYZ">{_item("wake", f"{3 * count} 3", "Float", f"points_{n}")}</Geometry>\n'
                      f'<Attribute Name="axial_wind" AttributeType="Scalar" Center="Node">{_item("wake", 3 * count, "Float", f"axial_wind_{n}")}</Attribute>\n</Grid>\n')
    return [_in_time(folder, "wake", steps)] if steps else []


def _solids(folder, scene, times):
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
                      f'<Topology TopologyType="Mixed" NumberOfElements="{len(kinds)}">{_item("geometry", len(flat), "Int", "cells")}</Topology>\n'
                      f'<Geometry GeometryType="XYZ">{_item("geometry", f"{len(points)} 3", "Float", f"points_{n}")}</Geometry>\n'
                      f'<Attribute Name="kind" AttributeType="Scalar" Center="Cell">{_item("geometry", len(kinds), "Int", "kind")}</Attribute>\n</Grid>\n')
    return _in_time(folder, "geometry", steps)


def _in_time(folder, name, steps):
    path = folder / f"{name}.xdmf"
    path.write_text(f'<?xml version="1.0"?>\n<Xdmf Version="2.2"><Domain>\n<Grid Name="{name}" GridType="Collection" CollectionType="Temporal">\n'
                    + steps + "</Grid>\n</Domain></Xdmf>\n", encoding="utf-8")
    return path


def _item(file, dimensions, kind, name):
    return f'<DataItem Dimensions="{dimensions}" NumberType="{kind}" Precision="4" Format="HDF">{file}.h5:/{name}</DataItem>'
