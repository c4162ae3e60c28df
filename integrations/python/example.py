#!/usr/bin/env python3
"""A look around a CAD file from Python: example.py MODEL [PICTURE.ppm]. In an editor that knows them, each "# %%" is a cell."""

# %% Read it. Everything that could not be read is listed.
import sys

import numpy as np

import dupin

model = dupin.load(sys.argv[1])
info = model.info()
print(f"{info['format']}: {info['parts']} parts, {info['instances']} placements, {info['faces']} faces {info['kinds']}")
for name, reason, count in info["skipped"]:
    print(f"  left out: {name}: {reason} ({count})")

# %% Sample it. Columns are NumPy arrays over the library's own memory.
points = model.sample(method="adaptive")
k1 = np.abs(points.curvatures[:, 0])
print(f"{len(points)} points, box {points.positions.min(axis=0)} ... {points.positions.max(axis=0)}")
if k1.max() > 0:
    tightest = k1.argmax()
    print(f"tightest radius {1 / k1[tightest]:.4g} at {points.positions[tightest]}, face {points.faces[tightest]}")

# %% Draw it: a picture, and at every pixel the exact curvature and the face.
picture = model.render(size=(640, 480), outputs=("screen", "depth", "curvature", "face"))
seen = picture["face"] > 0
print(f"{seen.mean():.1%} of the picture is covered, by {len(np.unique(picture['face'][seen]))} faces; "
      f"depths {picture['depth'][seen].min():.4g} ... {picture['depth'][seen].max():.4g}")
zebra = model.render(size=(640, 480), shading="zebra")
print(f"zebra stripes change the picture by {dupin.compare(picture['screen'], zebra['screen'])['rmse']:.3g} grey levels (RMSE)")

# %% Keep the picture.
if len(sys.argv) > 2:
    with open(sys.argv[2], "wb") as file:
        file.write(b"P6 640 480 255\n" + np.ascontiguousarray(picture["screen"][:, :, :3]).tobytes())
