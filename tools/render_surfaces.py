#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a file of grain surfaces (as `reckon surfaces` writes it) to a PNG, without a screen.

  tools/render_surfaces.py SURFACES.vtp PICTURE.png [--width 1200] [--height 1000]

Each grain has a colour of its own. Needs python3-paraview or python3-vtk9.
"""
import argparse

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: registers the renderer
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)


def sand_colours(count):
    """Browns and grays that repeat with a long period."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(count)
    for n in range(count):
        light = 0.45 + 0.5 * ((n * 0.618034) % 1)
        warm = (n * 0.754878) % 1
        table.SetTableValue(n, light, light * (0.86 - 0.12 * warm), light * (0.72 - 0.3 * warm), 1)
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("surfaces")
    parser.add_argument("picture")
    parser.add_argument("--width", type=int, default=1200)
    parser.add_argument("--height", type=int, default=1000)
    options = parser.parse_args()

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(options.surfaces)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(reader.GetOutputPort())
    normals.SetFeatureAngle(60)
    normals.Update()
    data = normals.GetOutput()
    ids = data.GetCellData().GetArray("id") or data.GetPointData().GetArray("id")
    if ids is None:
        raise SystemExit(f"{options.surfaces}: has no array 'id'")
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    if data.GetCellData().GetArray("id"):
        mapper.SetScalarModeToUseCellFieldData()
    else:
        mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("id")
    low, high = ids.GetRange()
    mapper.SetScalarRange(low, high)
    mapper.SetLookupTable(sand_colours(int(high - low) + 1))
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetSpecular(0.15)

    renderer = vtkRenderer()
    renderer.AddActor(actor)
    renderer.SetBackground(1, 1, 1)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(options.width, options.height)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetViewUp(0, 0, 1)
    camera.SetPosition(1, -1.6, 0.9)
    camera.SetFocalPoint(0, 0, 0)
    renderer.ResetCamera()
    camera.Zoom(1.35)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetFileName(options.picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
