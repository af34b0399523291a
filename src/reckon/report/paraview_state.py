# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
# Written by `reckon paraview`: draws this run in ParaView (5.10 or newer), the grains as the surfaces of their shapes.
#   paraview --script=paraview/state.py                       or Run Script in the Python shell of a ParaView that is open
#   pvpython paraview/state.py PICTURE.png [FIELD] [TIME]     one picture: FIELD colours the grains, TIME in seconds
import math
import os
import sys

import paraview.simple
from paraview.simple import *

paraview.simple._DisableFirstRenderCameraReset()

counted_from = @counted_from@  # [s]: displacement and rotation count from this saved time@of_stage@

units = @units@  # of what can colour the grains

# ParaView's window does not tell a script where it lies; then the run must be where it was.
folder = os.path.dirname(os.path.dirname(os.path.abspath(__file__))) if "__file__" in globals() else @folder@

# Of a grain now against where it was, by id. Grains leave, but none comes later. In a periodic cell its own way counts,
# not the jumps of the image that is drawn.
since_start = """
import numpy as np
def ways(grains):
    shift = grains.PointData["cell_shift"] if "cell_shift" in grains.PointData.keys() else 0
    return np.asarray(grains.Points) + np.asarray(shift)
now, start = inputs[0], inputs[1]
ids = np.asarray(now.PointData["id"])
start_ids = np.asarray(start.PointData["id"])
row = np.minimum(np.searchsorted(start_ids, ids), len(start_ids) - 1)
known = start_ids[row] == ids
moved = ways(now) - ways(start)[row]
moved[~known] = 0
cosine = np.abs((np.asarray(now.PointData["orientation"]) * np.asarray(start.PointData["orientation"])[row]).sum(axis=1))
turned = 2 * np.degrees(np.arccos(np.minimum(cosine, 1)))
turned[~known] = 0
for name in now.PointData.keys():
    output.PointData.append(now.PointData[name], name)
output.PointData.append(moved, "displacement")
output.PointData.append(turned, "rotation")
"""


def series(name):
    """The reader of NAME.pvd, or None where the run has not written it."""
    file = os.path.join(folder, name + ".pvd")
    return PVDReader(registrationName=name, FileName=file) if os.path.exists(file) else None


def new_view(title, title_text):
    view = CreateView("RenderView", title)
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    view.OrientationAxesLabelColor = [0, 0, 0]
    view.CameraParallelProjection = 1
    text = Text(registrationName=title + " title", Text=title_text)
    shown = Show(text, view)
    shown.Color = [0, 0, 0]
    shown.FontSize = 14
    shown.WindowLocation = "Upper Left Corner"
    return view


def draw_grains(grains, shapes, view, opacity=1.0):
    """Every grain is its shape's surface, turned and put where the grain is, drawn by the graphics card from one copy."""
    shown = Show(grains, view, "GeometryRepresentation")
    shown.SetRepresentationType("3D Glyphs")
    if shapes:
        shown.GlyphType = "Pipeline Connection"
        shown.GlyphType.Input = shapes
        shown.UseGlyphTable = 1
        shown.UseCompositeGlyphTable = 1
        shown.GlyphTableIndexArray = "shape"
        shown.Orient = 1
        shown.OrientationMode = "Quaternion"
        shown.SelectOrientationVectors = "orientation"
        shown.Scaling = 0
    else:  # the shapes are gone: spheres of equal volume
        shown.GlyphType = "Sphere"
        shown.GlyphType.Radius = 1
        shown.Scaling = 1
        shown.SelectScaleArray = "equivalent_radius"
        shown.ScaleMode = "Magnitude"
        shown.ScaleFactor = 1
    shown.Opacity = opacity
    shown.DiffuseColor = shown.AmbientColor = [0.75, 0.75, 0.78]
    shown.Specular = 0.1
    return shown


def colour(shown, view, kind, field, title, preset):
    ColorBy(shown, (kind, field))
    shown.RescaleTransferFunctionToDataRange(False, True)
    table = GetColorTransferFunction(field)
    table.ApplyPreset(preset, True)
    bar = GetScalarBar(table, view)
    bar.Title = title
    bar.ComponentTitle = ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.WindowLocation = "Lower Right Corner"
    bar.ScalarBarLength = 0.3
    shown.SetScalarBarVisibility(view, True)


def draw_boundary(walls, membrane, cell, view):
    if cell:
        shown = Show(cell, view)
        shown.ColorArrayName = [None, ""]
        shown.AmbientColor = shown.DiffuseColor = [0.12, 0.37, 0.55]
        shown.LineWidth = 2
    if walls:
        shown = Show(walls, view)
        shown.ColorArrayName = [None, ""]
        shown.SetRepresentationType("Feature Edges")
        shown.AmbientColor = shown.DiffuseColor = [0.35, 0.35, 0.35]
    if membrane:
        shown = Show(membrane, view)
        shown.ColorArrayName = [None, ""]
        shown.SetRepresentationType("Wireframe")
        shown.AmbientColor = shown.DiffuseColor = [0.55, 0.55, 0.6]
        shown.Opacity = 0.25


def force_chains(contacts, time, size):
    """Bars between touching grains, their area as the force."""
    points = CellDatatoPointData(registrationName="forces at ends", Input=contacts)
    contacts.UpdatePipeline(time)
    force = contacts.CellData["force_magnitude"]
    largest = force.GetRange()[1] if force and contacts.GetDataInformation().GetNumberOfCells() else 1
    radius = Calculator(registrationName="bars", Input=points)
    radius.ResultArrayName = "bar"
    radius.Function = f"{0.3 * size} * sqrt(force_magnitude / {largest})"
    bars = Tube(registrationName="force chains", Input=radius)
    bars.Scalars = ["POINTS", "bar"]
    bars.VaryRadius = "By Absolute Scalar"
    bars.NumberofSides = 8
    return bars


def look(view, bounds):
    """Obliquely, with all of a box in sight."""
    backward = [0.62, -0.72, 0.32]
    length = math.hypot(*backward)
    backward = [b / length for b in backward]
    right = [-backward[1] / math.hypot(*backward[:2]), backward[0] / math.hypot(*backward[:2]), 0]
    upward = [backward[1] * right[2] - backward[2] * right[1], backward[2] * right[0] - backward[0] * right[2],
              backward[0] * right[1] - backward[1] * right[0]]
    half = [(bounds[2 * axis + 1] - bounds[2 * axis]) / 2 for axis in range(3)]
    focus = [bounds[2 * axis] + half[axis] for axis in range(3)]
    reach = [math.fsum(math.fabs(h * d) for h, d in zip(half, direction)) for direction in (right, upward)]
    view.CameraFocalPoint = focus
    view.CameraPosition = [f + 4 * math.hypot(*half) * b for f, b in zip(focus, backward)]
    view.CameraViewUp = [0, 0, 1]
    view.CameraParallelScale = 1.12 * (reach[0] if reach[0] > reach[1] else reach[1])


def draw(arguments):
    from builtins import abs, max, min  # whatever a filter has made of these names

    grains = series("grains")
    contacts, membrane, walls, surfaces = series("contacts"), series("membrane"), series("walls"), series("surfaces")
    cell = series("cell")
    shapes_file = os.path.join(folder, "paraview", "shapes.vtm")
    shapes = None
    if os.path.exists(shapes_file):
        shapes = XMLMultiBlockDataReader(registrationName="shapes", FileName=[shapes_file])

    start = ForceTime(registrationName="grains at the start", Input=grains)
    start.ForcedTime = counted_from
    moved = ProgrammableFilter(registrationName="grains with displacement", Input=[grains, start])
    moved.Script = since_start

    field = arguments[1] if len(arguments) > 1 else "displacement"
    times = list(grains.TimestepValues) if hasattr(grains.TimestepValues, "__len__") else [grains.TimestepValues]
    time = float(arguments[2]) if len(arguments) > 2 else times[-1]
    time = min(times, key=lambda saved: abs(saved - time))
    GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    GetAnimationScene().AnimationTime = time
    grains.UpdatePipeline(time)
    size = grains.PointData["equivalent_radius"].GetRange()[1] if grains.PointData["equivalent_radius"] else 1

    left = new_view("grains", f"Grains by {field}")
    main = draw_grains(moved, shapes, left)
    unit = f" [{units[field]}]" if field in units else ""
    colour(main, left, "POINTS", field, field.replace("_", " ") + unit, "Viridis (matplotlib)")
    draw_boundary(walls, membrane, cell, left)
    views = [left]

    if contacts:
        right = new_view("forces", "Contact forces")
        chains = Show(force_chains(contacts, time, size), right)
        if contacts.GetDataInformation().GetNumberOfCells() > 0:
            colour(chains, right, "POINTS", "force_magnitude", "contact force [N]", "Viridis (matplotlib)")
        draw_boundary(walls, membrane, cell, right)
        views.append(right)

    # More to look at, with a click on its eye: velocities as arrows, the surfaces as triangles for cuts and filters.
    arrows = Glyph(registrationName="velocities", Input=grains, GlyphType="Arrow")
    arrows.OrientationArray = ["POINTS", "velocity"]
    arrows.ScaleArray = ["POINTS", "velocity"]
    fastest = grains.PointData["speed"].GetRange()[1] if grains.PointData["speed"] else 0
    arrows.ScaleFactor = 4 * size / (fastest or 1)
    arrows.GlyphMode = "All Points"
    for source in [arrows, surfaces]:
        if source:
            Hide(source, left)

    layout = CreateLayout("run")
    layout.AssignView(0, left)
    if len(views) > 1:
        layout.AssignView(layout.SplitHorizontal(0, 0.5) + 1, right)
    for view in views:
        view.ViewTime = time
    bounds = grains.GetDataInformation().GetBounds()
    bounds = [bound + (size if n % 2 else -size) for n, bound in enumerate(bounds)]
    for view in views:
        look(view, bounds)
    if len(views) > 1:
        AddCameraLink(left, right, "both")
    SetActiveView(left)

    if arguments:
        layout.SetSize(800 * len(views), 800)
        RenderAllViews()
        SaveScreenshot(os.path.abspath(arguments[0]), layout, SaveAllViews=1, ImageResolution=[800 * len(views), 800])
    else:
        RenderAllViews()


draw(sys.argv[1:] if "__file__" in globals() else [])
