# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""pvpython check_run.py RUN RANKS STATE.png RANK.png CELL_RUN CELL.png: what ParaView makes of a run's files, and of the pictures.

The files are held against each other: forces in one must be the forces in another.
"""
import os
import re
import sys
import unittest

import numpy as np
from paraview import simple as pv
from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

RUN, RANKS, STATE_PICTURE, RANK_PICTURE, CELL_RUN, CELL_PICTURE = sys.argv[1:7]
COUNT = 120  # of grains, in scene.toml
GRAIN_FIELDS = {"id": 1, "shape": 1, "radius": 1, "equivalent_radius": 1, "mass": 1, "orientation": 4, "velocity": 3,
                "angular_velocity": 3, "speed": 1, "prescribed": 1, "contacts": 1, "contact_force": 3, "rank": 1}


def series(name, run=RUN):
    return pv.PVDReader(FileName=os.path.join(os.path.abspath(run), name + ".pvd"))


def last(name, run=RUN):
    """The data of a series at its last time."""
    reader = series(name, run)
    reader.UpdatePipeline(reader.TimestepValues[-1])
    return servermanager.Fetch(reader)


def arrays(attributes):
    return {attributes.GetArrayName(n): vtk_to_numpy(attributes.GetArray(n))
            for n in range(attributes.GetNumberOfArrays())}


def places(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def pixels(file):
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars())[:, :3].reshape(height, width, 3).astype(int)


def drawn(picture):
    """Where a picture is not white."""
    return (picture < 235).any(axis=2)


def colours(picture):
    """The different ones among the strongly coloured pixels, in steps of 32."""
    strong = picture[picture.max(axis=2) - picture.min(axis=2) > 60]
    return len(np.unique(strong // 32, axis=0))


class Files(unittest.TestCase):
    def test_all_series_have_the_times_at_which_fields_were_saved(self):
        times = list(series("grains").TimestepValues)
        self.assertGreater(len(times), 5)
        for name in ["contacts", "walls", "surfaces", "membrane"]:
            self.assertEqual(list(series(name).TimestepValues), times, name)

    def test_grains_are_points_with_all_fields(self):
        data = last("grains")
        fields = arrays(data.GetPointData())
        self.assertEqual({name: 1 if a.ndim == 1 else a.shape[1] for name, a in fields.items()}, GRAIN_FIELDS)
        self.assertEqual(data.GetNumberOfPoints(), COUNT)
        self.assertEqual(list(fields["id"]), list(range(COUNT)))
        self.assertTrue(all(np.isfinite(a).all() for a in fields.values()))
        np.testing.assert_allclose(np.linalg.norm(fields["orientation"], axis=1), 1, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(fields["velocity"], axis=1), fields["speed"])
        self.assertEqual(set(fields["rank"]), set(range(int(RANKS))))

    def test_forces_at_contacts_are_those_on_grains_walls_and_membrane(self):
        contacts = arrays(last("contacts").GetCellData())
        grains = arrays(last("grains").GetPointData())
        on_grains = np.zeros((COUNT, 3))
        touching = np.zeros(COUNT, int)
        for force, grain, partner, with_wall in zip(contacts["force"], contacts["grain"], contacts["partner"],
                                                    contacts["with_wall"]):
            on_grains[grain] += force
            touching[grain] += 1
            if not with_wall:
                on_grains[partner] -= force
                touching[partner] += 1
        largest = contacts["force_magnitude"].max()
        self.assertGreater(largest, 0)
        np.testing.assert_allclose(on_grains, grains["contact_force"], atol=1e-12 * largest)
        self.assertEqual(list(touching), list(grains["contacts"]))
        walls = arrays(last("walls").GetCellData())
        on_walls = sum(walls["force"][walls["wall"] == wall][0] for wall in np.unique(walls["wall"]))
        on_membrane = arrays(last("membrane").GetPointData())["contact_force"].sum(axis=0)
        self.assertGreater(np.linalg.norm(on_membrane), 0)
        np.testing.assert_allclose(on_grains.sum(axis=0) + on_walls + on_membrane, 0, atol=1e-10 * largest)

    def test_walls_stand_around_the_grains_where_the_history_has_them(self):
        data = last("walls")
        walls = arrays(data.GetCellData())
        self.assertEqual(set(walls["wall"]), {1, 2})  # the membrane has taken the mould's place
        corners = places(data)
        heights = np.unique(corners[:, 2].round(9))
        self.assertEqual(len(heights), 2)
        self.assertAlmostEqual(heights[1], 0.075 + walls["displacement"][walls["wall"] == 2][0][2], places=9)
        centers = places(last("grains"))
        self.assertTrue(((centers[:, 2] > heights[0]) & (centers[:, 2] < heights[1])).all())
        reader = series("walls")
        reader.UpdatePipeline(0)
        first = servermanager.Fetch(reader)
        self.assertEqual(set(arrays(first.GetCellData())["wall"]), {0, 1, 2})
        np.testing.assert_allclose(np.hypot(*places(first)[:, :2].T).max(), 0.0039, rtol=1e-9)

    def test_the_membrane_encloses_the_grains(self):
        before = series("membrane")
        before.UpdatePipeline(0)
        self.assertEqual(servermanager.Fetch(before).GetNumberOfPoints(), 0)
        data = last("membrane")
        self.assertEqual(set(arrays(data.GetPointData())), {"displacement", "velocity", "contact_force"})
        self.assertGreater(data.GetNumberOfPolys(), 500)
        reach = np.hypot(*places(data)[:, :2].T)
        centers = np.hypot(*places(last("grains"))[:, :2].T)
        self.assertLess(centers.max(), reach.max())

    def test_surfaces_lie_around_their_grains_and_have_their_fields(self):
        data = last("surfaces")
        cells, points = arrays(data.GetCellData()), arrays(data.GetPointData())
        self.assertEqual(set(cells), {"id", "shape", "speed"})
        self.assertEqual(set(points), {"velocity", "angular_velocity", "mass", "equivalent_radius", "contacts",
                                       "contact_force", "rank"})
        grains = arrays(last("grains").GetPointData())
        centers = places(last("grains"))
        corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        for grain in range(COUNT):
            own = np.unique(corners[cells["id"] == grain])
            distance = np.linalg.norm(places(data)[own] - centers[grain], axis=1)
            self.assertLess(distance.max(), 1.001 * grains["radius"][grain])
            self.assertGreater(distance.max(), 0.97 * grains["radius"][grain])
            for name in points:
                expected = np.broadcast_to(grains[name][grain], points[name][own].shape)
                np.testing.assert_allclose(points[name][own], expected, rtol=1e-6, atol=1e-12, err_msg=name)


class PeriodicCell(unittest.TestCase):
    def test_grains_are_in_the_box_that_is_drawn(self):
        self.assertEqual(list(series("cell", CELL_RUN).TimestepValues), list(series("grains", CELL_RUN).TimestepValues))
        data = last("cell", CELL_RUN)
        self.assertEqual((data.GetNumberOfPoints(), data.GetNumberOfLines()), (8, 12))
        corners = places(data)
        edges = np.array([corners[1 << axis] - corners[0] for axis in range(3)])
        self.assertGreater(abs(edges[1][0]), 0.05 * edges[1][1])  # it leans
        within = np.linalg.solve(edges.T, (places(last("grains", CELL_RUN)) - corners[0]).T)
        self.assertTrue(((within > -1e-9) & (within < 1 + 1e-9)).all())

    def test_displacement_follows_a_grain_across_the_border(self):
        with open(os.path.join(CELL_RUN, "paraview", "state.py"), encoding="utf-8") as file:
            script = re.search('since_start = """(.*?)"""', file.read(), re.DOTALL).group(1)
        grains = series("grains", CELL_RUN)
        pressed = grains.TimestepValues[2]  # from here on the cell keeps its size
        start = pv.ForceTime(Input=grains, ForcedTime=pressed)
        start.UpdatePipeline(pressed)
        before = arrays(servermanager.Fetch(start).GetPointData())["cell_shift"]
        moved = pv.ProgrammableFilter(Input=[grains, start], Script=script)
        moved.UpdatePipeline(grains.TimestepValues[-1])
        fields = arrays(servermanager.Fetch(moved).GetPointData())
        crossed = np.linalg.norm(fields["cell_shift"] - before, axis=1) > 1e-3
        self.assertTrue(crossed.any())
        self.assertLess(np.linalg.norm(fields["displacement"], axis=1).max(), 2.7e-3)  # half an edge

    def test_the_state_draws_grains_and_the_box(self):
        grains = pixels(CELL_PICTURE)[:, :640]
        self.assertGreater(drawn(grains).mean(), 0.2)
        box = (abs(grains - np.array([31, 94, 140])) < 25).all(axis=2)
        self.assertGreater(box.sum(), 300)


pv._DisableFirstRenderCameraReset()


class Instances(unittest.TestCase):
    """Shapes put where the grains are cover what the surfaces of the same grains cover."""

    @staticmethod
    def silhouette(show):
        view = pv.GetActiveViewOrCreate("RenderView")
        pv.HideAll(view)
        view.ViewSize = [500, 500]
        view.UseColorPaletteForBackground = 0
        view.Background = [1, 1, 1]
        view.OrientationAxesVisibility = 0
        view.CameraParallelProjection = 1
        shown = show(view)
        shown.ColorArrayName = [None, ""]
        shown.DiffuseColor = shown.AmbientColor = [0, 0, 0]
        center = places(last("grains")).mean(axis=0)
        view.CameraFocalPoint = center
        view.CameraPosition = center + np.array([0.05, -0.04, 0.03])
        view.CameraViewUp = [0, 0, 1]
        view.CameraParallelScale = 0.008
        view.ViewTime = series("grains").TimestepValues[-1]
        pv.Render(view)
        pv.SaveScreenshot("silhouette.png", view, ImageResolution=[500, 500])
        return drawn(pixels("silhouette.png"))

    def test_instances_cover_what_surfaces_cover(self):
        def instances(orient):
            def show(view):
                shown = pv.Show(series("grains"), view, "GeometryRepresentation")
                shown.SetRepresentationType("3D Glyphs")
                shown.GlyphType = "Pipeline Connection"
                shown.GlyphType.Input = pv.XMLMultiBlockDataReader(FileName=[os.path.abspath(RUN) + "/paraview/shapes.vtm"])
                shown.UseGlyphTable = shown.UseCompositeGlyphTable = 1
                shown.GlyphTableIndexArray = "shape"
                shown.Orient = orient
                shown.OrientationMode = "Quaternion"
                shown.SelectOrientationVectors = "orientation"
                shown.Scaling = 0
                return shown
            return show

        surfaces = self.silhouette(lambda view: pv.Show(series("surfaces"), view))
        self.assertGreater(surfaces.mean(), 0.1)

        def agreement(other):
            return (surfaces & other).sum() / (surfaces | other).sum()
        self.assertGreater(agreement(self.silhouette(instances(1))), 0.98)
        self.assertLess(agreement(self.silhouette(instances(0))), 0.97)  # so the test would notice


class Pictures(unittest.TestCase):
    def test_the_state_draws_grains_by_displacement_and_forces_at_once(self):
        picture = pixels(STATE_PICTURE)
        self.assertEqual(picture.shape, (800, 1600, 3))
        grains, forces = picture[:, :800], picture[:, 800:]
        self.assertGreater(drawn(grains[200:600, 200:600]).mean(), 0.5)
        self.assertGreater(colours(grains), 12)
        self.assertGreater(drawn(forces[200:600, 200:600]).mean(), 0.05)
        self.assertGreater(colours(forces), 8)

    @unittest.skipIf(RANKS == "1", "one rank has all grains")
    def test_grains_can_be_coloured_by_the_rank_that_has_them(self):
        grains = pixels(RANK_PICTURE)[:, :640]  # without the legend
        self.assertGreater(drawn(grains).mean(), 0.02)
        dark = (grains[..., 2] > grains[..., 1] + 20) & (grains[..., 0] < 120)  # viridis from violet ...
        light = (grains[..., 0] > 100) & (grains[..., 2] < 90)                  # ... to yellow
        self.assertGreater(dark.sum(), 500)
        self.assertGreater(light.sum(), 500)


program = unittest.main(argv=["check_run"], verbosity=2, exit=False)
sys.stderr.flush()
os._exit(not program.result.wasSuccessful())  # the exit of ParaView sometimes fails in X
