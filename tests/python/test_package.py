# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package makes, runs and reads what the program does, to the same bits.

    test_package.py RECKON      RECKON: the program; the package is on PYTHONPATH
"""
import ast
import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy
import reckon

PROGRAM = sys.argv.pop(1)
ROOT = pathlib.Path(__file__).resolve().parents[2]


def scene(**changes):
    """Eight spheres of a library `balls.h5` fall onto a floor."""
    tables = {
        "seed": 3,
        "material": {"density": 2650, "friction": 0.5},
        "contact": {"law": "linear", "normal_stiffness": "2 kN/m", "restitution": 0.5},
        "body": {"gravity": [0, 0, -9.81]},
        "grains": [{"library": "balls.h5",
                    "fill": {"count": 8, "box": {"low": [0, 0, 0], "high": ["4 mm", "4 mm", "8 mm"]}}}],
        "wall": [{"name": "floor", "plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}],
        "time": {"steps": 200},
        "output": {"history_interval": 50, "fields_interval": 100},
    }
    tables.update(changes)
    return tables


def _numbers(table, skip=""):
    """All numbers of a dictionary, those of arrays and dictionaries in it included."""
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _numbers(value, skip)
        elif name != skip:
            yield from numpy.ravel(value)


def _numbers_in(header):
    """The count of numbers of the columns of history.csv in Python, where a tensor of six has nine."""
    return len(header) + 3 * sum(name.replace("_Pa", "").endswith("_xx") for name in header)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        cls.shapes = reckon.generate_shapes(2, seed=5, voxels_per_diameter=12, node_count=60)
        reckon.save_shapes(cls.shapes, cls.folder / "balls.h5")

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def scene(self, **changes):
        return reckon.Scene(scene(**changes), self.folder)


class Shapes(Package):
    def test_a_library_gives_back_what_was_saved(self):
        library = reckon.ShapeLibrary(self.folder / "balls.h5")
        self.assertEqual(len(library), 2)
        self.assertEqual(library.names, [shape.name for shape in self.shapes])
        for made, read in zip(self.shapes, (library[0], library[library.names[1]])):
            numpy.testing.assert_array_equal(made.level_set, read.level_set)
            numpy.testing.assert_array_equal(made.nodes, read.nodes)
            self.assertEqual(made.volume, read.volume)
        self.assertEqual(library[-1].name, library.names[1])

    def test_the_grid_is_a_view_that_outlives_its_shape_and_cannot_be_written(self):
        grid = reckon.ShapeLibrary(self.folder / "balls.h5")[0].level_set
        numpy.testing.assert_array_equal(grid, self.shapes[0].level_set)
        self.assertFalse(grid.flags.owndata)
        with self.assertRaises(ValueError):
            grid[0, 0, 0] = 1

    def test_samples_are_grid_values_at_vertices_and_near_zero_at_nodes(self):
        shape = self.shapes[0]
        k, j, i = (n // 2 for n in shape.level_set.shape)
        vertex = numpy.array(shape.origin) + shape.spacing * numpy.array([i, j, k])
        phi, gradient = shape.sample([vertex, [1, 1, 1]])
        self.assertAlmostEqual(phi[0] / shape.spacing, shape.level_set[k, j, i] / shape.spacing, places=6)
        self.assertTrue(math.isnan(phi[1]) and numpy.isnan(gradient[1]).all())
        phi, gradient = shape.sample(shape.nodes)
        # Nodes lie on the true surface, which the grid of 12 voxels has to a tenth of a spacing.
        self.assertLess(abs(phi).max(), 0.1 * shape.spacing)
        self.assertAlmostEqual(numpy.linalg.norm(gradient, axis=1).mean(), 1, places=1)

    def test_what_is_missing_is_said(self):
        library = reckon.ShapeLibrary(self.folder / "balls.h5")
        with self.assertRaisesRegex(IndexError, "has 2 shapes"):
            library[2]
        with self.assertRaisesRegex(KeyError, "no shape"):
            library["pebble"]
        with self.assertRaisesRegex(reckon.Error, "none.h5"):
            reckon.ShapeLibrary(self.folder / "none.h5")
        with self.assertRaisesRegex(reckon.Error, "rows of three"):
            self.shapes[0].sample([1, 2, 3])


class Scenes(Package):
    def test_all_faults_come_as_one_error(self):
        with self.assertRaises(reckon.Error) as raised:
            self.scene(material={"density": -1, "frictoin": 0.5})
        self.assertIn("2 faults", str(raised.exception))
        self.assertIn("frictoin", str(raised.exception))

    def test_the_text_of_an_error_is_the_command_lines(self):
        file = self.folder / "faulty.toml"
        file.write_text("[material]\ndensity = -1\n")
        said = subprocess.run([PROGRAM, "check", file], capture_output=True, text=True).stderr
        with self.assertRaises(reckon.Error) as raised:
            reckon.Scene.from_file(file)
        fault = [line.strip() for line in str(raised.exception).splitlines() if "density" in line]
        self.assertEqual(len(fault), 1)
        self.assertIn(fault[0], said)

    def test_values_may_be_those_of_numpy_and_paths(self):
        scene = self.scene()
        tables = scene.tables
        tables["body"] = {"gravity": numpy.array([0.0, 0.0, -9.81])}
        tables["time"] = {"steps": numpy.int64(5)}
        for grains in tables["grains"]:
            grains["library"] = pathlib.Path(grains["library"])
        changed = reckon.Scene(tables, scene._directory)
        self.assertEqual(changed.tables["body"]["gravity"], [0.0, 0.0, -9.81])
        self.assertEqual(changed.tables["time"], {"steps": 5})
        friction = changed.changed({"material.friction": numpy.float32(0.5)})
        self.assertEqual(friction.tables["material"]["friction"], 0.5)

    def test_changes_by_key_leave_the_rest(self):
        changed = self.scene().changed({"material.friction": 0.1, "wall.0.friction": 0.2})
        self.assertEqual(changed.tables["material"], {"density": 2650, "friction": 0.1})
        self.assertEqual(changed.tables["wall"][0]["friction"], 0.2)
        self.assertEqual(changed.grain_count, 8)
        with self.assertRaisesRegex(reckon.Error, "Count from 0"):
            changed.changed({"wall.3.friction": 0.2})
        with self.assertRaisesRegex(reckon.Error, "not a table"):
            changed.changed({"seed.friction": 0.2})


class Simulations(Package):
    def test_steps_are_those_of_a_run(self):
        simulation = reckon.Simulation(self.scene())
        self.assertEqual(simulation.planned_steps, 200)
        simulation.step(199)
        simulation.step()
        self.assertEqual(simulation.step_number, 200)
        self.assertEqual(simulation.time, 200 * simulation.time_step)
        stepped = simulation.grains()

        run = reckon.run(self.scene(), self.folder / "run", overwrite=True)
        self.assertEqual(run.report["end"], "complete")
        saved = run.fields()
        self.assertEqual(saved["step"], 200)
        for name in ("id", "position", "orientation", "velocity", "angular_velocity"):
            numpy.testing.assert_array_equal(stepped[name], saved["grains"][name], name)
        self.assertEqual(simulation.measure()["energy"]["total"], run.report["last"]["energy"]["total"])
        touching = simulation.contacts()
        self.assertEqual(len(touching["grain"]), len(saved["contacts"]["grain"]))
        numpy.testing.assert_array_equal(touching["force"], saved["contacts"]["force"])
        self.assertEqual(saved["cell_corners"].shape, (0, 3))  # no periodic cell, no shift into it
        self.assertFalse(saved["grains"]["cell_shift"].any())

    def test_a_measurement_has_every_column_of_the_history(self):
        box = {"low": [0, 0, 0], "high": ["4 mm", "4 mm", "8 mm"]}
        closed = self.scene(wall=[{"name": "box", "box": box}], output={"history_interval": 50, "sample": True},
                            time={}, stage=[{"name": "fall", "steps": 200}])
        run = reckon.run(closed, self.folder / "columns")
        simulation = reckon.Simulation(closed)
        simulation.step(200)
        with open(run.folder / "history.csv") as file:
            header, *_, last = csv.reader(file)
        for name, measured in (("Simulation.measure", simulation.measure()), ("report", run.report["last"])):
            self.assertEqual(len(list(_numbers(measured, skip="total"))), _numbers_in(header), name)
            self.assertEqual(measured["void_ratio"], float(last[header.index("void_ratio")]))
            self.assertEqual(measured["energy"]["balance_error"], float(last[header.index("balance_error_J")]))
            self.assertEqual(measured["stress"][2, 0], float(last[header.index("stress_zx_Pa")]))
            self.assertEqual(measured["wall_force"][4, 2], float(last[header.index("box.z-:fz_N")]))

    def test_the_program_reads_and_writes_the_same_runs(self):
        file = self.folder / "scene.toml"
        file.write_text(self.scene().text)
        subprocess.run([PROGRAM, "run", file, "--out", self.folder / "by-program", "--quiet"], check=True)
        reckon.run(self.scene(), self.folder / "by-package")
        by_program, by_package = (reckon.Run(self.folder / name) for name in ("by-program", "by-package"))
        self.assertEqual((by_program.folder / "history.csv").read_bytes(),
                         (by_package.folder / "history.csv").read_bytes())
        self.assertEqual(by_program.steps, [0, 100, 200])
        history = by_package.history
        self.assertEqual(list(history["step"]), [0, 50, 100, 150, 200])
        self.assertEqual(history["time_s"][0], 0)
        self.assertIn("[material]", by_package.scene)
        self.assertEqual(by_package.record["status"], by_program.record["status"])

    def test_a_ruined_run_says_so(self):
        box = {"low": [0, 0, 0], "high": ["4 mm", "4 mm", "8 mm"]}
        soft = self.scene(
            contact={"law": "area", "normal_stiffness": "1e8 N/m^3", "restitution": 0.5}, time={}, body={"damping": 500},
            wall=[{"name": "box", "box": box}], output={"history_interval": 50, "sample": True},
            stage=[{"name": "press", "steps": 1500,
                    "control": [{"wall": "box", "stress": "20 kPa", "rate_limit": 200}]}])
        with self.assertWarnsRegex(reckon.InvalidRunWarning, "mean nothing"):
            run = reckon.run(soft, self.folder / "soft")
        self.assertFalse(run.valid)
        self.assertFalse(run.report["valid"])
        self.assertIn("deep_overlap", [code for code, _ in run.reasons])
        self.assertEqual(run.reasons, run.report["reasons"])
        self.assertFalse(run.record["valid"])
        fine = reckon.run(self.scene(), self.folder / "fine")
        self.assertTrue(fine.valid)
        self.assertEqual(fine.reasons, [])

    def test_the_guide_of_shapes_works_word_for_word(self):
        page = (ROOT / "docs" / "guide" / "python.md").read_text()
        block = page.split("## Shapes")[1].split("```python\n")[1].split("```")[0]
        block = block.replace("generate_shapes(20,", "generate_shapes(2, voxels_per_diameter=12,")
        self.assertIn("or library[", block)
        asked = block.split("or library[")[1].split("]")[0]
        with tempfile.TemporaryDirectory() as folder:
            exec(block.replace('"sand.h5"', f'"{folder}/sand.h5"'), names := {})
            self.assertEqual(names["library"][ast.literal_eval(asked)].name, names["library"][0].name)

    def test_an_exception_of_progress_ends_the_run_in_order(self):
        def refuse(step, steps):
            raise ValueError("enough")

        with self.assertRaisesRegex(ValueError, "enough"):
            reckon.run(self.scene(time={"steps": 100000000}), self.folder / "refused", progress=refuse)
        self.assertTrue(list((self.folder / "refused" / "checkpoints").iterdir()))

    def test_no_run_and_no_stage(self):
        with self.assertRaisesRegex(reckon.Error, "no run"):
            reckon.Run(self.folder)
        with self.assertRaisesRegex(reckon.Error, "no further stage"):
            reckon.Simulation(self.scene()).begin_next_stage()


class Stubs(unittest.TestCase):
    def test_the_stub_names_what_the_module_has(self):
        tree = ast.parse((ROOT / "python" / "reckon" / "_reckon.pyi").read_text())

        def names(body):
            of_functions = {node.name for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
            return of_functions | {node.target.id for node in body if isinstance(node, ast.AnnAssign)}

        from reckon import _reckon
        own = {name for name in dir(_reckon) if name == "__version__" or not name.startswith("__")}
        self.assertEqual(names(tree.body), own)
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and node.name != "Error":
                members = {name for name in vars(getattr(_reckon, node.name))
                           if not name.startswith("__") or name in ("__len__", "__getitem__")}
                self.assertEqual(names(node.body) - {"__init__"}, members, node.name)


if __name__ == "__main__":
    unittest.main()
