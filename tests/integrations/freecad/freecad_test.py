#!/usr/bin/env python3
"""The workbench in the real FreeCAD under Xvfb: freecad_test.py CASE MODULE_FOLDER WORKBENCH READER MODEL WORK.

Exit code 77 where FreeCAD or Xvfb is not installed. What is done is in in_freecad.py; this looks at what was seen.
"""
import json
import os
import shutil
import subprocess
import sys
import unittest

CASE = sys.argv[1]
MODULE, WORKBENCH, READER, MODEL, WORK = [os.path.realpath(a) for a in sys.argv[2:7]]
SECONDS = 100
LEVELS = 2  # grey levels that pictures may differ by away from edges

if not shutil.which("freecad") or not shutil.which("xvfb-run"):
    print("FreeCAD or Xvfb is not installed")
    sys.exit(77)
try:
    import numpy as np
except ImportError:
    print("NumPy is not installed")
    sys.exit(77)

seen, pictures = {}, {}


def picture(path):
    """A P6 file, h x w x 3."""
    with open(path, "rb") as file:
        assert file.readline() == b"P6\n"
        width, height = map(int, file.readline().split())
        file.readline()
        return np.frombuffer(file.read(), np.uint8).reshape(height, width, 3).astype(int)


def install(home):
    """The workbench and the module, as a user would put them."""
    folder = os.path.join(home, ".local/share/FreeCAD/Mod/Dupin")
    os.makedirs(folder)
    for source in (WORKBENCH, MODULE):
        for name in os.listdir(source):
            if name.endswith((".py", ".xml", ".so")):
                os.symlink(os.path.join(source, name), os.path.join(folder, name))


def setUpModule():
    shutil.rmtree(WORK, ignore_errors=True)
    home = os.path.join(WORK, "home")
    os.makedirs(home, mode=0o700)
    install(home)
    environment = dict(os.environ, HOME=home, XDG_RUNTIME_DIR=home, DUPIN_READER=READER, DUPIN_TEST_CASE=CASE, DUPIN_TEST_OUT=WORK,
                       DUPIN_TEST_MODEL=MODEL, QTWEBENGINE_DISABLE_SANDBOX="1", LIBGL_ALWAYS_SOFTWARE="1", QT_QPA_PLATFORM="xcb")
    for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME"):
        environment.pop(name, None)
    script = os.path.join(os.path.dirname(os.path.realpath(__file__)), "in_freecad.py")
    with open(os.path.join(WORK, "log"), "w") as log:
        subprocess.run(["timeout", str(SECONDS), "xvfb-run", "-a", "-s", "-screen 0 1280x900x24 -dpi 96 +extension GLX", "freecad", script],
                       env=environment, stdout=log, stderr=subprocess.STDOUT, check=False)
    try:
        with open(os.path.join(WORK, "seen.json")) as file:
            seen.update(json.load(file))
    except OSError:
        for name in ("log", "crash"):
            with open(os.path.join(WORK, name)) as file:
                print(file.read())
        raise
    assert seen.get("done"), seen.get("failure")
    pictures.update({name: picture(path) for name, path in seen["pictures"].items()})


def hue(image):
    """Which color each pixel has, whatever the light: its channels that are nearly as bright as its brightest; 7: grey or white."""
    return ((4 * image > 3 * image.max(2, keepdims=True)) * [4, 2, 1]).sum(2)


@unittest.skipUnless(CASE == "step_file", "another case")
class StepFile(unittest.TestCase):
    def test_covers_what_the_fine_tessellation_covers(self):
        own, exact = [(pictures[name] != 255).any(2) for name in ("own", "exact")]
        self.assertGreater(own.sum(), 50000)
        self.assertLess((own != exact).sum(), 0.002 * own.sum())

    def test_is_dupins_own_picture(self):
        sys.path.insert(0, MODULE)
        os.environ["DUPIN_READER"] = READER
        import dupin

        camera = seen["camera"]
        drawn = dupin.load(MODEL).render(
            size=camera["size"], eye=camera["eye"], target=camera["target"], up=camera["up"], orthographic=True,
            height=camera["height"], edges=False, samples=1, outputs=("screen", "face"))
        face = drawn["face"]
        inner = np.ones(face.shape, bool)
        for axis in (0, 1):
            for step in (-2, -1, 1, 2):
                inner &= np.roll(face, step, axis) == face
        difference = abs(drawn["screen"][:, :, :3].astype(int) - pictures["exact"]).max(2)[inner & (face > 0)]
        self.assertGreater(difference.size, 50000)
        self.assertLess((difference > LEVELS).mean(), 1e-4)

    def test_shades(self):
        for name in ("zebra", "curvature"):
            self.assertGreater((abs(pictures[name] - pictures["exact"]).max(2) > 20).sum(), 20000, name)

    def test_saves_what_is_seen(self):
        self.assertLess((abs(pictures["saved"] - pictures["exact"]).max(2) > LEVELS).mean(), 1e-4)

    def test_compares(self):
        self.assertEqual(len(seen["dialog"]), 1)

    def test_zooms_without_facets(self):
        self.assertLessEqual(seen["zoomed"], 0.5)
        self.assertIsNone(seen["error"])

    def test_a_second_time_shows_the_tessellation(self):
        self.assertLess((pictures["again"] != pictures["own"]).any(2).mean(), 1e-4)


@unittest.skipUnless(CASE == "document", "another case")
class Document(unittest.TestCase):
    def assert_same_hues(self, one, other, part=0.002):
        a, b = hue(pictures[one]), hue(pictures[other])
        self.assertEqual(a.shape, b.shape)
        self.assertGreater((a != 7).sum(), 5000)
        self.assertLess((a != b).sum(), part * (a != 7).sum(), one + " and " + other)

    def count(self, name, which):
        return int((hue(pictures[name]) == which).sum())

    def test_hides_and_is_hidden(self):
        self.assertEqual(seen["one"], 1)
        self.assertGreater(self.count("own", 2), 3000)
        self.assert_same_hues("own", "occluded")
        self.assertGreater((pictures["own"] != pictures["occluded"]).any(2).sum(), 1000)  # in another light

    def test_follows_visibility(self):
        self.assertEqual(self.count("rod alone", 4), 0)
        self.assertGreater(self.count("rod alone", 2), self.count("own", 2))
        self.assertEqual(self.count("slab alone", 2), 0)
        self.assertGreater(self.count("slab alone", 4), self.count("own", 4))

    def test_follows_color(self):
        self.assertEqual(self.count("blue", 1), self.count("occluded", 2))
        self.assertEqual(self.count("blue", 2), 0)

    def test_shows_the_selection(self):
        self.assertEqual(seen["slots"], 1)  # met once
        rod = self.count("blue", 1)
        self.assertEqual(self.count("selected", 1), 0)
        self.assertGreater(self.count("selected", 2), 0.99 * rod)
        top = hue(pictures["top selected"])
        self.assertGreater((top == 2).sum(), 0.2 * rod)
        self.assertLess(np.argwhere(top == 2)[:, 0].mean(), np.argwhere(top == 1)[:, 0].mean())  # above the rest

    def test_leaves_what_is_seen_through_to_freecad(self):
        self.assertGreater((pictures["seen through"] != pictures["occluded"]).any(2).sum(), 3000)
        self.assertLess((pictures["opaque again"] != pictures["occluded"]).any(2).mean(), 1e-4)

    def test_follows_edits_and_placements(self):
        self.assertGreater(self.count("longer", 2), 1.2 * self.count("occluded", 2))
        self.assert_same_hues("longer", "longer own")
        self.assert_same_hues("moved", "moved own")
        self.assertNotEqual(self.count("moved", 2), self.count("longer", 2))

    def test_draws_links(self):
        self.assertGreater(self.count("link", 2), 1.5 * self.count("moved", 2))
        self.assert_same_hues("link", "link own")

    def test_colors_faces(self):
        self.assertGreater(self.count("faces", 6), 5000)  # yellow
        self.assert_same_hues("faces", "faces own")

    def test_clips(self):
        self.assertLess((pictures["clipped"] != 255).any(2).sum(), 0.9 * (pictures["faces"] != 255).any(2).sum())

    def test_goes_on_after_what_cannot_be_read(self):
        self.assertTrue(seen["refused"])
        self.assertEqual((seen["left"], seen["goes on"]), (0, 1))

    def test_goes_on_after_closing(self):
        self.assertEqual(seen["closed"], 0)
        self.assertEqual(seen["next"]["primitives"], 3)  # the faces of a box that one sees
        self.assertIsNone(seen["error"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
