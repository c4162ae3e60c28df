#!/usr/bin/env python3
"""An example's window beside `dupin render`: in_a_window.py XVFB_RUN HOST DUPIN MODEL WORK.

Without anything of the host's own, the picture is within LEVELS gray levels of `dupin render`'s at the same camera wherever that
has no edge; with it, each hides a part of the other; no state of the context changes and no error is left. Exit code 77: no OpenGL.
"""
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from png_file import png_pixels  # noqa: E402

XVFB_RUN, HOST, DUPIN, MODEL, WORK = sys.argv[1:6]
LEVELS, EDGE = 2, 12  # an edge: gray levels apart within a pixel's neighbours


def png(path):
    """Width, height and rows of RGB pixels."""
    width, height, rows, n = png_pixels(path)
    return width, height, [[tuple(r[n * x:n * x + 3]) for x in range(width)] for r in rows]


def host(name, *more):
    path = os.path.join(WORK, os.path.basename(HOST) + "_" + name + ".png")
    if os.path.exists(path):
        os.remove(path)
    reader = os.environ.get("DUPIN_READER") or os.path.join(os.path.dirname(DUPIN), "..", "cad_import", "dupin-reader")
    done = subprocess.run([XVFB_RUN, "-a", "-s", "-screen 0 800x600x24", HOST, MODEL, "--frames", "3", "--picture", path, *more],
                          capture_output=True, text=True, timeout=100, env=dict(os.environ, DUPIN_READER=reader))
    print(name + ":", done.stdout, done.stderr)
    if "OpenGL 3.3 is needed" in done.stderr or "no window with OpenGL" in done.stderr:
        sys.exit(77)
    assert done.returncode == 0, done.returncode
    assert "an OpenGL error" not in done.stdout
    states = re.findall(r"^state: (\d+) values, changed: (.*)$", done.stdout, re.M)
    assert states and all(int(count) > 150 and not changed for count, changed in states), states
    return png(path), re.search(r"^camera: (.*)$", done.stdout, re.M)[1].split()


def apart(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


def compare(drawn, expected):
    (width, height, a), (width_b, height_b, b) = drawn, expected
    assert (width, height) == (width_b, height_b)
    worst = checked = model = edges = 0
    for y in range(1, height - 1):
        for x in range(1, width - 1):
            around = [b[y + j][x + i] for j in (-1, 0, 1) for i in (-1, 0, 1)]
            if any(apart(b[y][x], other) > EDGE for other in around):
                edges += 1
                continue
            checked += 1
            model += b[y][x] != (255, 255, 255)
            worst = max(worst, apart(a[y][x], b[y][x]))
    print(f"away from edges: {checked} pixels, {model} of them the model's, at most {worst} levels apart; {edges} at edges")
    assert model > 5000 and edges < 0.1 * width * height
    assert worst <= LEVELS


def red(pixel):
    return pixel[0] > 60 and pixel[0] > 1.6 * max(pixel[1], pixel[2])


def occlusion(alone, both):
    """Where the model is seen alone, the sheet hides some of it; where the sheet would be seen, the model hides some of it."""
    (width, height, a), (_, _, b) = alone, both
    hidden = sum(a[y][x] != (255, 255, 255) and red(b[y][x]) for y in range(height) for x in range(width))
    kept = sum(a[y][x] != (255, 255, 255) and apart(a[y][x], b[y][x]) <= LEVELS and not red(b[y][x]) for y in range(height) for x in range(width))
    sheet = sum(red(pixel) for row in b for pixel in row)
    print(f"the sheet: {sheet} pixels, {hidden} of them before the model, which keeps {kept}")
    assert hidden > 500 and kept > 500 and sheet > 2 * hidden


def main():
    alone, camera = host("alone", "--alone")
    expected = os.path.join(WORK, os.path.basename(HOST) + "_expected.png")
    subprocess.run([DUPIN, "render", MODEL, "-o", expected, "--samples", "1", *camera], check=True, timeout=100)
    compare(alone, png(expected))
    occlusion(alone, host("both")[0])


main()
