#!/usr/bin/env python3
"""The viewer's window under Xvfb, with real events: window_test.py DUPIN READER MODEL WORK. Exit code 77: no Xvfb or no xdotool."""
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

DUPIN, READER, MODEL, WORK = [os.path.realpath(a) for a in sys.argv[1:5]]
SIZE = (1200, 800)


class Screen:
    """An X server without a screen, and the viewer in it."""

    def __init__(self, *files):
        self.read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x900x24"], pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(self.read) as pipe:
            number = pipe.readline().strip()
        self.environment = dict(os.environ, DISPLAY=":" + number, DUPIN_READER=READER, QT_QPA_PLATFORM="xcb", XDG_RUNTIME_DIR=WORK)
        self.report = os.path.join(WORK, "report.json")
        if os.path.exists(self.report):
            os.remove(self.report)
        self.viewer = subprocess.Popen([DUPIN, "view", *files, "--report", self.report], env=self.environment)
        self.window = self.tool("search", "--sync", "--onlyvisible", "--name", "^Dupin$").split()[0]
        time.sleep(2)
        self.tool("windowfocus", "--sync", self.window)  # there is no window manager that would

    def tool(self, *words):
        return subprocess.run(["xdotool", *words], check=True, capture_output=True, text=True, env=self.environment, timeout=60).stdout

    def key(self, *keys):
        for key in keys:
            self.tool("key", key)
            time.sleep(0.4)

    def drag(self, button, start, end):
        self.tool("mousemove", "--window", self.window, *map(str, start), "mousedown", str(button))
        for i in range(1, 6):
            at = [round(a + (b - a) * i / 5) for a, b in zip(start, end)]
            self.tool("mousemove", "--window", self.window, *map(str, at))
        self.tool("mouseup", str(button))
        time.sleep(0.4)

    def click(self, x, y, button=1):
        self.tool("mousemove", "--window", self.window, str(x), str(y), "click", str(button))
        time.sleep(0.5)

    def picture(self, name):
        path = os.path.join(WORK, name + ".png")
        subprocess.run(["import", "-window", "root", path], env=self.environment, check=False, timeout=60)
        return path

    def close(self):
        self.key("ctrl+q")
        code = self.viewer.wait(timeout=30)
        self.stop()
        with open(self.report) as file:
            return code, json.load(file)

    def stop(self):
        for process in (self.viewer, self.server):
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
                process.wait(timeout=20)


class Window(unittest.TestCase):
    def setUp(self):
        os.makedirs(WORK, exist_ok=True)
        self.screens = []

    def tearDown(self):
        for screen in self.screens:
            screen.stop()

    def screen(self, *files):
        self.screens.append(Screen(*files))
        return self.screens[-1]

    def middle(self):
        return 760, 430  # of the 3D view, beside the panels

    def test_opens_shows_turns_and_picks(self):
        plain = self.screen(MODEL)
        plain.picture("plain")
        code, still = plain.close()
        self.assertEqual(code, 0)
        self.assertEqual(still["files"], 1)
        self.assertGreater(still["objects"], 0)
        self.assertGreater(still["loaded_ms"], still["window_ms"])
        self.assertEqual(still["message"], "")

        screen = self.screen(MODEL)
        x, y = self.middle()
        screen.drag(1, (x, y), (x + 80, y + 30))
        screen.click(x, y, 4)  # the wheel, towards the model
        screen.click(x, y)
        screen.picture("picked")
        screen.key("z", "e", "s")
        screen.picture("zebra")
        screen.key("p")
        code, moved = screen.close()
        self.assertEqual(code, 0)
        self.assertNotEqual(moved["eye"], still["eye"])
        self.assertAlmostEqual(moved["height"], still["height"] / 1.25, delta=0.01 * still["height"])
        self.assertIn("picked", moved)
        self.assertGreater(moved["picked"]["area"], 0)
        self.assertEqual((moved["shading"], moved["edges"], moved["sections"], moved["parallel"]), (6, False, 1, True))

    def test_saves_the_picture(self):
        path = os.path.join(WORK, "saved.png")
        if os.path.exists(path):
            os.remove(path)
        screen = self.screen(MODEL)
        screen.key("ctrl+s")
        dialog = screen.tool("search", "--sync", "--onlyvisible", "--name", "^Save picture$").split()[0]
        screen.tool("windowfocus", "--sync", dialog)
        screen.key("ctrl+a")
        screen.tool("type", path)
        screen.key("Return")
        time.sleep(1)
        screen.tool("windowfocus", "--sync", screen.window)
        code, seen = screen.close()
        self.assertEqual(code, 0)
        self.assertEqual(seen["message"], "saved " + path)
        with open(path, "rb") as file:
            head = file.read(24)
        self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
        width, height = (int.from_bytes(head[i : i + 4], "big") for i in (16, 20))
        self.assertTrue(300 < width < SIZE[0] and 300 < height < SIZE[1], (width, height))
        self.assertGreater(os.path.getsize(path), 2000)  # more than a background

    def test_says_why_a_file_cannot_be_read_and_goes_on(self):
        nothing = os.path.join(WORK, "nothing.step")
        with open(nothing, "w") as file:
            file.write("nothing like a model")
        screen = self.screen(nothing, MODEL)
        code, seen = screen.close()
        self.assertEqual(code, 0)
        self.assertIn("nothing.step", seen["message"])
        self.assertEqual(seen["files"], 2)
        self.assertGreater(seen["objects"], 0)

    def test_reloads_a_file_that_changes(self):
        path = os.path.join(WORK, "changing.step")
        shutil.copy(MODEL, path)
        screen = self.screen(path)
        frames = screen
        with open(path, "a") as file:
            file.write("\n")
        time.sleep(3)
        code, seen = frames.close()
        self.assertEqual(code, 0)
        self.assertGreater(seen["objects"], 0)
        self.assertGreater(seen["loaded_ms"], 3000)  # the second time


if __name__ == "__main__":
    missing = [tool for tool in ("Xvfb", "xdotool") if not shutil.which(tool)]
    if missing:
        print("not installed: " + ", ".join(missing))
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
