#!/usr/bin/env python3
"""What Python adds to sampling: python_sampling.py MODEL DUPIN [GRID]. Medians of five runs each, in turn, of `dupin sample`'s own time for
sampling and of Model.sample with all its columns read, which the module's path must be on PYTHONPATH for."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import dupin

MODEL, COMMAND = sys.argv[1], sys.argv[2]
GRID = int(sys.argv[3]) if len(sys.argv) > 3 else 32


def by_command(folder):
    stats = os.path.join(folder, "stats.json")
    subprocess.run([COMMAND, "sample", MODEL, "-o", os.path.join(folder, "points.dps"), "--grid", str(GRID), "--stats", stats, "--quiet"], check=True)
    with open(stats) as file:
        told = json.load(file)
    return told["time_s"]["sample"], told["points"]["written"]


def by_module(model):
    start = time.perf_counter()
    points = model.sample(grid=GRID)
    columns = (points.positions, points.normals, points.curvatures, points.directions, points.uv)
    taken = time.perf_counter() - start
    assert all(len(c) == len(points) for c in columns)
    return taken, len(points)


model = dupin.load(MODEL)
times = {"command": [], "module": []}
with tempfile.TemporaryDirectory() as folder:
    for _ in range(5):
        seconds, count = by_command(folder)
        times["command"].append(seconds)
        seconds, own = by_module(model)
        times["module"].append(seconds)
        assert own == count
command, module = (statistics.median(times[k]) for k in ("command", "module"))
print(f"{count} points: command {command:.3f} s, Python {module:.3f} s, ratio {module / command:.2f}")
