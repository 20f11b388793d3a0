"""Pictures of a run in three dimensions, off screen: floats, tower, nacelle, blades, lines, the water's surface, the wake and the tip vortices.
VTK draws (python3-vtk9, or the one inside ParaView); what there is to draw comes from geometry.py and the run's fields. Called by
spindrift_picture.py; tested in tests/src/report/geometry_test.py. SPDX-License-Identifier: Apache-2.0"""
import functools
import math

import numpy as np
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401  text in the window
import vtkmodules.vtkRenderingFreeType  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPlane, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkClipPolyData, vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkActor2D, vtkLight, vtkPolyDataMapper, vtkPolyDataMapper2D, vtkRenderer, vtkRenderWindow,
                                            vtkTextActor, vtkWindowToImageFilter)

import geometry
import run_fields
import wake

COLOURS = geometry.COLOURS | {"sea": (0.16, 0.42, 0.58), "ground": (0.66, 0.69, 0.62)}
SKY, HAZE = (0.55, 0.70, 0.86), (0.93, 0.96, 0.98)
NEAR_SEA, FAR_SEA = 8.0, 400.0   # lengths of the scene: where waves are drawn, where the sea ends
CAMERAS = {"scene": (-1.0, -1.15, 0.28), "side": (0.0, -1.0, 0.04), "front": (-1.0, 0.0, 0.06), "top": (0.0, -0.02, 1.0), "rotor": (-1.0, -0.75, 0.18)}


def poly_data(points, polygons=(), lines=()):
    data = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, np.float32), deep=True))
    data.SetPoints(places)
    for cells, put in ((polygons, data.SetPolys), (lines, data.SetLines)):
        if len(cells):
            flat = np.insert(cells, 0, cells.shape[1], axis=1).ravel() if isinstance(cells, np.ndarray) else [n for c in cells for n in (len(c), *c)]
            array = vtkCellArray()
            array.ImportLegacyFormat(numpy_to_vtkIdTypeArray(np.asarray(flat, np.int64), deep=True))
            put(array)
    return data


def triangles(points, values=None):
    """(n, 3, 3) as a surface with shared corners; values (n, 3) at them."""
    flat = points.reshape(-1, 3)
    data = poly_data(flat, np.arange(len(flat)).reshape(-1, 3))
    if values is not None:
        data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(values.ravel(), np.float32), deep=True))
    clean = vtkCleanPolyData()
    clean.SetInputData(data)
    clean.SetTolerance(1e-7)
    clean.Update()
    return clean.GetOutput()


def clipped(data, plane, level):
    """What lies where the scalar is below `level`, or on the side of a plane (point, normal) that its normal points to."""
    clip = vtkClipPolyData()
    clip.SetInputData(data)
    if plane is None:
        clip.SetValue(level)
        clip.InsideOutOn()
    else:
        side = vtkPlane()
        side.SetOrigin(*plane[0])
        side.SetNormal(*plane[1])
        clip.SetClipFunction(side)
    clip.Update()
    return clip.GetOutput()


def smooth(data, angle=35.0):
    normals = vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(angle)
    normals.Update()
    return normals.GetOutput()


def motion(before, after):
    """The rigid motion between two places of the same points, as VTK's matrix (Kabsch 1976, Acta Cryst. A32, 922)."""
    centre, moved = before.mean(axis=0), after.mean(axis=0)
    u, _, v = np.linalg.svd((before - centre).T @ (after - moved))
    turn = (u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))]) @ v).T
    matrix = vtkMatrix4x4()
    matrix.DeepCopy([value for row, shift in zip(turn, moved - turn @ centre) for value in (*row, shift)] + [0, 0, 0, 1])
    return matrix


def wind_colours():
    """Slow air dark violet, free wind pale: viridis, which reads the same in print and for most eyes."""
    import matplotlib
    table, colours = vtkLookupTable(), matplotlib.colormaps["viridis"](np.linspace(0, 1, 256))
    table.SetNumberOfTableValues(256)
    for i, (r, g, b, _) in enumerate(colours):
        table.SetTableValue(i, r, g, b, 1.0)
    table.SetRange(0.0, 1.2)
    table.Build()
    return table


class Drawing:
    """A window that is filled again for every time; `seen` counts what the last one shows, by kind."""

    def __init__(self, run, size=(1600, 900), camera="scene", finer=1):
        """`finer`: samples of a pixel along each side, which smooth its edges."""
        self.run, self.scene, self.camera, self.seen, self.finer = run, geometry.Scene3d(run), camera, {}, finer
        self.fields = run_fields.Fields(run)
        self.renderer, self.window = vtkRenderer(), vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetSize(*(finer * side for side in size))
        self.window.SetMultiSamples(0)
        self.renderer.UseFXAAOn()
        self.window.AddRenderer(self.renderer)
        self.renderer.SetBackground(*HAZE)
        self.renderer.SetBackground2(*SKY)
        self.renderer.GradientBackgroundOn()
        self.renderer.SetUseDepthPeeling(1)   # translucent surfaces in their true order
        self.renderer.SetMaximumNumberOfPeels(4)
        self.window.SetAlphaBitPlanes(1)
        self.colours, self.placed, self._wake_of, self._solid = wind_colours(), False, {}, {}
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(-300.0, -500.0, 700.0)
        light.SetFocalPoint(0.0, 0.0, 50.0)
        light.SetIntensity(0.85)
        self.renderer.AddLight(light)
        fill = vtkLight()
        fill.SetLightTypeToHeadlight()
        fill.SetIntensity(0.45)
        self.renderer.AddLight(fill)
        self.wind = wake.wind(self.scene)

    # ---- pieces -------------------------------------------------------------------------------------------------------------------------

    def add(self, kind, data, colour=None, opacity=1.0, scalars=False):
        if data.GetNumberOfCells() == 0:
            return
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(data)
        actor = vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        if scalars:
            mapper.SetLookupTable(self.colours)
            mapper.UseLookupTableScalarRangeOn()
        else:
            mapper.ScalarVisibilityOff()
            look.SetColor(*(colour or COLOURS.get(kind, (0.7, 0.7, 0.7))))
        look.SetOpacity(opacity)
        look.SetAmbient(0.25)
        look.SetDiffuse(0.8)
        look.SetSpecular(0.35 if kind == "sea" else 0.15)
        look.SetSpecularPower(40 if kind == "sea" else 20)
        return self.show(kind, actor)

    def show(self, kind, actor):
        self.renderer.AddActor(actor)
        self.seen[kind] = self.seen.get(kind, 0) + 1
        return actor

    def solids(self, t):
        """Bodies are meshed once and moved; lines bend."""
        thick = 0.0035 * self.extent()
        for n, piece in enumerate(self.scene.pieces(t)):
            if piece.lines:
                tube = vtkTubeFilter()
                tube.SetInputData(poly_data(piece.points, lines=piece.lines))
                tube.SetRadius(thick)
                tube.SetNumberOfSides(8)
                tube.Update()
                self.add("line", tube.GetOutput())
            elif piece.bends:
                self.add(piece.kind, smooth(poly_data(piece.points, piece.polygons)))
            elif n in self._solid:
                points, actor = self._solid[n]
                actor.SetUserMatrix(motion(points, piece.points))
                self.show(piece.kind, actor)
            else:
                self._solid[n] = piece.points, self.add(piece.kind, smooth(poly_data(piece.points, piece.polygons)))

    @functools.cached_property
    def bounds(self):
        """Lowest and highest corner of what is drawn at the start; of a floating turbine without its lines, which reach far."""
        pieces = self.scene.pieces(self.run.time[0])
        solid = [p.points for p in pieces if p.kind != "line"]
        shaped = bool(self.scene.rotors) or any(body.get(shape) for body in self.scene.bodies.values() for shape in ("cylinders", "boxes", "spheres", "meshes"))
        points = solid if shaped else [p.points for p in pieces]
        for rotor in self.scene.rotors:   # the whole disc, wherever the blades are
            points.append(rotor.hub0 + rotor.tip * np.array([[0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]))
        if not points:
            return np.array([-50.0, -50.0, -50.0]), np.array([50.0, 50.0, 50.0])
        every = np.concatenate(points)
        return every.min(axis=0), every.max(axis=0)

    def extent(self):
        """Length that the picture is about [m]."""
        low, high = self.bounds
        return (1.0 if self.scene.rotors or not self.water_model() else 2.0) * (high - low).max()

    def water_model(self):
        model = (self.run.scene.get("sea") or {}).get("model")
        return model if model != "none" else None

    def ground(self):
        """What a turbine without a sea stands on."""
        pieces = [p for p in self.scene.pieces(self.run.time[0]) if p.kind == "tower"]
        if not pieces or self.scene.rotor is None or self.scene.rotor.carrier() not in self.scene.bodies:
            return
        level, far, middle = min(p.points[:, 2].min() for p in pieces), FAR_SEA * self.extent(), self.centre()
        around = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)   # a square's corners would bend the horizon
        edge = np.column_stack([middle[0] + far * np.cos(around), middle[1] + far * np.sin(around), np.full(len(around), level)])
        self.add("ground", poly_data(edge, [list(range(len(edge)))]), opacity=0.55)

    def water(self, t):
        if not self.water_model():
            self.ground()
            return
        found = self.fields.surface(t, [piece.points for piece in self.scene.pieces(t) if piece.kind == "float" and piece.points[:, 2].min() < 0.0 < piece.points[:, 2].max()])
        if found is not None:
            x, y, z, tank = found
            self.sheet(x, y, z)
            self.sides(x, y, z, tank)
            self.walls()
            return
        near, far = NEAR_SEA * self.extent(), FAR_SEA * self.extent()   # far: where a flat sea looks as if it ended in the horizon
        beyond = np.geomspace(near, far, 25)[1:]
        middle, along = self.centre(), np.concatenate([-beyond[::-1], np.linspace(-near, near, 801), beyond])
        across = np.concatenate([-beyond[::-1], np.linspace(-near, near, 41), beyond])
        x, y = geometry.round_edge(*np.meshgrid(along, across), near, far)
        # Waves fade out before the sheet is too coarse for them.
        shown = np.clip(2.0 - 4.0 * np.hypot(x, y) / near, 0.0, 1.0)
        self.sheet(middle[0] + x, middle[1] + y, shown * self.scene.elevation(middle[0] + along, t))

    def sheet(self, x, y, z):
        nj, ni = z.shape
        points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
        n = np.arange(nj * ni).reshape(nj, ni)
        quads = np.stack([n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]], axis=-1).reshape(-1, 4)
        self.add("sea", smooth(poly_data(points, quads), 180.0), opacity=0.62)

    def sides(self, x, y, z, bed):
        """The cut faces of a tank, so that its depth is seen."""
        for edge in ((x[0], y[0], z[0]), (x[-1], y[-1], z[-1]), (x[:, 0], y[:, 0], z[:, 0]), (x[:, -1], y[:, -1], z[:, -1])):
            top = np.stack(edge, axis=-1)
            n = len(top)
            points = np.concatenate([top, np.column_stack([top[:, :2], np.full(n, bed)])])
            self.add("tank", poly_data(points, [[i, i + 1, n + i + 1, n + i] for i in range(n - 1)]), (0.10, 0.30, 0.45), 0.45)

    def walls(self):
        """Beaches and sills from files, as far as they reach; a basin would hide what it holds."""
        for given in (self.run.scene["sea"].get("tank") or {}).get("meshes", []):
            if given.get("water", "outside") == "outside":
                self.add("wall", poly_data(*geometry.mesh(given)), (0.62, 0.56, 0.45))

    def wake(self, t):
        """Slow air in the upright plane through the axis, and the surfaces of tip vortices, coloured by the axial wind."""
        if self.scene.rotor is None or self.wind <= 0.0:
            return
        blocks, time = self.fields.air(t)
        if not blocks:
            return
        if time not in self._wake_of:
            self._wake_of = {time: self._wake(blocks, time)}
        plane, vortices = self._wake_of[time]
        if plane is not None:
            self.add("wake", plane, opacity=0.85, scalars=True).GetProperty().LightingOff()
        if vortices is not None:
            self.add("vortices", vortices, opacity=0.9, scalars=True)

    def _wake(self, blocks, time):
        plane, vortices = wake.surfaces(self.scene, blocks, time)
        if plane is not None:   # only what is slow of its triangles, and what lies behind the disc
            hub, frame, tip = self.scene.rotor.hub(time), self.scene.rotor.frame(time), self.scene.rotor.tip
            plane = clipped(triangles(*plane), None, wake.SLOW)
            for place, normal in (((0.03 * tip, 0, 0), (1, 0, 0)), ((2.0 * tip, 0, 0), (-1, 0, 0)), ((0, 0, 1.25 * tip), (0, 0, -1)), ((0, 0, -1.25 * tip), (0, 0, 1))):
                plane = clipped(plane, (hub + np.array(place) @ frame, np.array(normal, float) @ frame), 0.0)
        return plane, smooth(triangles(*vortices), 180.0) if vortices is not None else None

    # ---- picture ------------------------------------------------------------------------------------------------------------------------

    def centre(self):
        low, high = self.bounds
        return 0.5 * (low + high)

    def place_camera(self):
        """Once: a film's camera stands."""
        if self.placed:
            return
        self.placed = True
        middle, length = self.centre(), self.extent()
        if self.scene.rotors:
            middle += [0.12 * length, 0.0, 0.0]
        if self.camera == "rotor" and self.scene.rotors:
            middle, length = np.mean([rotor.hub0 for rotor in self.scene.rotors], axis=0) + [0.25 * length, 0.0, 0.0], 0.95 * length
        view = np.array(CAMERAS[self.camera])
        view /= np.linalg.norm(view)
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(*middle)
        camera.SetViewAngle(28.0)
        place = middle + view * 2.6 * length
        if self.water_model() and self.camera != "top":
            place[2] = max(place[2], 0.1 * length)   # above the water
        camera.SetPosition(*place)
        camera.SetViewUp(0.0, 0.0, 1.0) if abs(view[2]) < 0.99 else camera.SetViewUp(0.0, 1.0, 0.0)
        self.length = length

    def words(self, t):
        width, height = self.window.GetSize()

        def text(words, x, y, size, bold=False, right=False):
            actor = vtkTextActor()
            actor.SetInput(words)
            look = actor.GetTextProperty()
            look.SetFontSize(int(size * height / 900))
            look.SetColor(0.12, 0.15, 0.19)
            look.SetFontFamilyToArial()
            if bold:
                look.BoldOn()
            if right:
                look.SetJustificationToRight()
            actor.SetPosition(x, y)
            self.renderer.AddActor2D(actor)

        title = self.run.own_title if len(self.run.own_title) < 64 else self.run.own_title[:61] + "..."
        text(title, 0.02 * width, 0.938 * height, 34, bold=True)
        steady = (self.run.scene.get("aero", {}).get("flow") or {}).get("time") == "steady" and not self.scene.bodies
        text(("steady" if steady else f"t = {t:.1f} s") + (f", {self.run.changed}" if self.run.changed else ""), 0.02 * width, 0.89 * height, 29)
        if sketched := self.scene.sketched:
            names = " and ".join(filter(None, (", ".join(sketched[:-1]), sketched[-1])))
            text(f"sketched, not in the scene: {names}", 0.02 * width, 0.005 * height, 23)
        self.scale_bar(text, width, height)

    def scale_bar(self, text, width, height):
        """A bar of a round length at the distance that the camera looks at."""
        camera = self.renderer.GetActiveCamera()
        tall = 2 * camera.GetDistance() * math.tan(math.radians(0.5 * camera.GetViewAngle()))
        metres = next(m for m in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 1e9) if m >= 0.11 * tall)
        pixels = int(metres / tall * height)
        x, y, half = int(0.02 * width), int(0.052 * height), 5 * self.finer
        mapper = vtkPolyDataMapper2D()
        mapper.SetInputData(poly_data(np.array([[x, y, 0], [x + pixels, y, 0], [x, y - half, 0], [x, y + half, 0], [x + pixels, y - half, 0], [x + pixels, y + half, 0]]),
                                      lines=[[0, 1], [2, 3], [4, 5]]))
        bar = vtkActor2D()
        bar.SetMapper(mapper)
        bar.GetProperty().SetColor(0.12, 0.15, 0.19)
        bar.GetProperty().SetLineWidth(3 * self.finer)
        self.renderer.AddActor2D(bar)
        text(f"{metres:g} m", x, y + 0.014 * height, 27)

    def legend(self):
        if not (self.seen.get("wake") or self.seen.get("vortices")):
            return
        bar = vtkScalarBarActor()
        bar.SetLookupTable(self.colours)
        bar.SetTitle("axial wind / free wind")
        bar.SetNumberOfLabels(4)
        bar.SetLabelFormat("%.1f")
        bar.SetOrientationToHorizontal()
        bar.SetPosition(0.70, 0.02)
        bar.SetWidth(0.28)
        bar.SetHeight(0.09)
        for look in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
            look.SetColor(0.12, 0.15, 0.19)
            look.ItalicOff()
            look.BoldOff()
            look.ShadowOff()
        self.renderer.AddActor2D(bar)

    def draw(self, t):
        """The picture at time t as an array (height, width, 3) of bytes, first row on top."""
        self.renderer.RemoveAllViewProps()
        self.seen = {}
        self.place_camera()
        self.solids(t)
        self.wake(t)
        self.water(t)
        self.words(t)
        self.legend()
        self.renderer.SetNearClippingPlaneTolerance(2e-4)   # the sea's far end must not cut off what is near
        self.renderer.ResetCameraClippingRange()
        self.window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.Update()
        image = grab.GetOutput()
        width, height, _ = image.GetDimensions()
        pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 3)[::-1]
        if self.finer == 1:
            return pixels
        return pixels.reshape(height // self.finer, self.finer, width // self.finer, self.finer, 3).mean(axis=(1, 3)).round().astype(np.uint8)
