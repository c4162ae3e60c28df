#!/usr/bin/env python3
"""The Python module on the shipped samples, beside the command: dupin_test.py SAMPLES DUPIN."""
import ast
import gc
import os
import subprocess
import sys
import tempfile
import unittest
import weakref

import numpy as np

import dupin

SAMPLES, COMMAND = sys.argv[1], sys.argv[2]


def sample(name):
    return os.path.join(SAMPLES, name)


class Models(unittest.TestCase):
    def test_says_what_a_file_holds(self):
        model = dupin.load(sample("assembly.step"))
        info = model.info()
        self.assertEqual(model.format, "STEP")
        self.assertEqual(info["instances"], len(model.instances))
        self.assertGreater(info["instances"], info["parts"])
        self.assertEqual(sum(info["kinds"].values()), info["faces"])
        self.assertTrue((model.box[0] < model.box[1]).all())

    def test_reads_bytes_too(self):
        with open(sample("bracket.step"), "rb") as file:
            model = dupin.load_bytes(file.read())
        self.assertEqual(model.info()["faces"], dupin.load(sample("bracket.step")).info()["faces"])

    def test_says_why_a_file_cannot_be_read(self):
        with self.assertRaises(dupin.Error) as caught:
            dupin.load("/nowhere/at/all.step")
        self.assertEqual(caught.exception.code, "unreadable")
        with self.assertRaises(dupin.Error) as caught:
            dupin.load_bytes(b"nothing like a model")
        self.assertEqual(caught.exception.code, "unreadable")

    def test_progress_is_told_and_stops(self):
        model, told = dupin.load(sample("freeform.step")), []
        model.prepare(progress=lambda stage, fraction: told.append((stage, fraction)))
        self.assertEqual(told[0], ("prepare", 0.0))
        self.assertEqual(told[-1], ("prepare", 1.0))
        with self.assertRaises(dupin.Error) as caught:
            model.prepare(progress=lambda stage, fraction: False)
        self.assertEqual(caught.exception.code, "cancelled")

    def test_a_job_runs_beside(self):
        job = dupin.Job(sample("bracket.step"))
        prepared = job.result()
        self.assertTrue(job.done)
        self.assertGreater(prepared.primitives, 10)
        self.assertEqual(prepared.model.format, "STEP")


class Sampling(unittest.TestCase):
    def test_arrays_are_the_commands_columns(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "points.csv")
            subprocess.run([COMMAND, "sample", sample("assembly.step"), "-o", path, "--quiet"], check=True)
            table = np.genfromtxt(path, delimiter=",", names=True)
        points = dupin.load(sample("assembly.step")).sample()
        self.assertEqual(len(points), len(table))
        for array, names in ((points.positions, "x y z"), (points.normals, "nx ny nz"), (points.directions, "d1x d1y d1z"),
                             (points.curvatures, "k1 k2"), (points.uv, "u v"), (points.half_extents, "hu hv")):
            for column, name in enumerate(names.split()):
                np.testing.assert_allclose(array[:, column], table[name], rtol=1e-9, atol=1e-9, err_msg=name)

    def test_columns_are_views_that_outlive_everything_else(self):
        points = dupin.load(sample("bracket.step")).sample()
        positions, curvatures = points.positions, points.curvatures
        self.assertFalse(positions.flags.owndata)
        self.assertEqual(positions.__array_interface__["data"][0] // 4096, points.positions.__array_interface__["data"][0] // 4096)
        copy = positions.copy()
        del points
        gc.collect()
        np.testing.assert_array_equal(positions, copy)
        self.assertTrue(np.isfinite(curvatures).all())

    def test_wrong_options_are_refused(self):
        model = dupin.load(sample("bracket.step"))
        self.assertRaises(ValueError, model.sample, method="random")
        self.assertRaises(dupin.Error, model.sample, epsilon=2.0)
        self.assertRaises(TypeError, model.sample, density=3)


class Pictures(unittest.TestCase):
    def test_is_the_commands_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "picture.png")
            subprocess.run([COMMAND, "render", sample("bracket.step"), "-o", path, "--resolution", "200,150", "--quiet"], check=True)
            picture = dupin.load(sample("bracket.step")).render(size=(200, 150))["screen"]
            difference = dupin.compare(path, picture)
        self.assertLess(difference["rmse"], 0.5)
        self.assertEqual(difference["silhouette_px"], 0)

    def test_has_every_output(self):
        names = ("color", "normal", "depth", "position", "curvature", "direction", "face", "primitive", "uv", "screen")
        picture = dupin.load(sample("bracket.step")).render(size=(80, 60), outputs=names, background=None)
        self.assertEqual(set(picture), set(names))
        for name in names:
            self.assertEqual(picture[name].shape[:2], (60, 80), name)
        seen = picture["face"] > 0
        np.testing.assert_array_equal(seen, np.isfinite(picture["depth"]))
        np.testing.assert_allclose(np.linalg.norm(picture["normal"][seen], axis=1), 1, atol=1e-3)
        self.assertTrue(np.isfinite(picture["uv"][seen]).all())

    def test_sections_and_views(self):
        model = dupin.load(sample("bracket.step"))
        middle = model.box.mean(axis=0)
        whole = model.render(size=(80, 60), outputs=("position", "face"))
        cut = model.render(size=(80, 60), outputs=("position", "face"), sections=[(1, 0, 0, -middle[0])])
        seen = cut["face"] > 0
        self.assertTrue((cut["position"][seen][:, 0] > middle[0] - 1e-3).all())
        self.assertLess(seen.sum(), (whole["face"] > 0).sum())
        self.assertRaises(ValueError, model.render, shading="pink")
        self.assertRaises(TypeError, model.render, colour=1)
        self.assertRaises(dupin.Error, model.render, size=(100000, 100000))

    def test_a_scene_needs_a_context(self):
        with self.assertRaises(dupin.Error) as caught:
            dupin.Scene()
        self.assertEqual(caught.exception.code, "no_device")


class Stubs(unittest.TestCase):
    def test_describe_what_the_module_has(self):
        with open(os.path.join(os.path.dirname(dupin.__file__), "dupin.pyi")) as file:
            tree = ast.parse(file.read())
        for node in tree.body:
            if isinstance(node, ast.FunctionDef):
                self.assertTrue(getattr(dupin, node.name).__doc__)
            if not isinstance(node, ast.ClassDef) or node.name in ("Picture", "Error"):
                continue
            own = getattr(dupin, node.name)
            told = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            told |= {n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
            has = {name for name in vars(own) if not name.startswith("_")}
            self.assertEqual({name for name in told if not name.startswith("_")}, has, node.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
