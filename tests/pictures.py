#!/usr/bin/env python3
"""Pictures of quadric DPs beside pictures of fine triangles or exact ones, on many models and cameras.

    tests/pictures.py --dupin build/app/dupin [--exact build/bench/exact/dupin_exact] [--out FOLDER]
                      [--cameras whole,whole,close] [--size N] FILE|FOLDER...

Every camera is drawn twice, `--primitive quadric` at the default tolerances and `--primitive triangles` at a deflection of 1e-5
of the diagonal (with --exact: by the exact ray caster), and `dupin compare` measures the difference. A line each; SHORT and the reasons where a limit is missed (exit
code 1). Cameras are random but the same for a file's name every time. Needs nothing beyond Python's own library.
"""
import argparse
import hashlib
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

ENDINGS = (".step", ".stp", ".igs", ".iges", ".brep", ".brp", ".fcstd")
FOV = 30.0

# What a picture must keep to (docs/manual.md, "How exact a picture is"). Counts of pixels allow for a picture's few.
LIMITS = [
    ("holes_ppm", None, 10.5),
    ("extra_px", None, 0),
    ("normal_degrees", "p50", 0.02),
    ("normal_degrees", "p99", 0.3),
    ("depth_px", "p99", 0.25),
]
MISMATCH_PART, MISMATCH_PX = 0.0005, 10


def run(arguments, seconds):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, errors="replace", timeout=seconds)


def files_of(paths):
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            yield from sorted(p for p in path.rglob("*") if p.suffix.lower() in ENDINGS)
        else:
            yield path


def camera(rng, box, how):
    """An eye on the sphere about the model from which it fills the picture, or a fifth as far away for a close one."""
    centre = [(a + b) / 2 for a, b in zip(box["min"], box["max"])]
    diagonal = math.dist(box["min"], box["max"])
    theta, phi = rng.uniform(0, 2 * math.pi), rng.uniform(-1.0, 1.2)
    distance = diagonal * 1.05 / (2 * math.tan(math.radians(FOV / 2))) * (0.22 if how == "close" else 1.0)
    direction = (math.cos(phi) * math.cos(theta), math.cos(phi) * math.sin(theta), math.sin(phi))
    eye = [c + distance * d for c, d in zip(centre, direction)]
    numbers = lambda v: ",".join("%.12g" % x for x in v)
    return ["--eye=" + numbers(eye), "--target=" + numbers(centre), "--up-vector=0,0,1", "--fov=%g" % FOV]


def measure(geometry, name, part):
    """A number of the comparison; a distribution of nothing has none."""
    value = geometry[name]
    return (value or {}).get(part, 0) if part else value


def shortfalls(difference, stats):
    geometry, found = difference["geometry"], []
    for name, part, limit in LIMITS:
        if measure(geometry, name, part) > limit:
            found.append(f"{name} {part or ''} {measure(geometry, name, part):.4g}")
    covered = difference["covered_px"][0]
    if difference["silhouette_px"] > MISMATCH_PART * max(1, covered) + MISMATCH_PX:
        found.append(f"silhouette {difference['silhouette_px']} of {covered} px")
    faces = stats["faces"]
    if faces["drawn"] + len(faces["skipped"]) != faces["total"]:
        found.append(f"faces {faces['drawn']} + {len(faces['skipped'])} of {faces['total']}")
    for name, limit in (("bound_px", 0.5), ("normal_bound_degrees", 0.25)):
        if stats["error"][name] > limit + 1e-6:
            found.append(f"{name} {stats['error'][name]:.4g}")
    return found


class Checker:
    def __init__(self, options):
        self.options = options
        self.out = pathlib.Path(options.out)
        self.out.mkdir(parents=True, exist_ok=True)

    def render(self, file, kind, view, name):
        picture, stats = self.out / f"{name}.{kind}.exr", self.out / f"{name}.{kind}.json"
        extra = ["--deflection", "1e-5"] if kind == "triangles" else []
        size = f"{self.options.size},{self.options.size}"
        done = run([self.options.dupin, "render", file, "-o", picture, "--primitive", kind, "--resolution", size, "--no-edges",
                    "--aov", "normal,depth,face", "--stats", stats, "--quiet", "--memory-limit",
                    self.options.memory, *extra, *view], self.options.seconds)
        if done.returncode not in (0, 4):
            raise RuntimeError(f"{kind}: exit {done.returncode}: {done.stderr.strip()[-160:]}")
        return picture, json.loads(stats.read_text())

    def cast(self, file, view, name):
        picture = self.out / f"{name}.exact.exr"
        size = f"{self.options.size},{self.options.size}"
        done = run([self.options.exact, file, "-o", picture, "--resolution", size, "--aov", "normal,depth,face", "--quiet", *view],
                   self.options.seconds)
        if done.returncode != 0:
            raise RuntimeError(f"exact: exit {done.returncode}: {done.stderr.strip()[-160:]}")
        return picture

    def check(self, file, number, view):
        """One line about one picture, and what it misses."""
        name = f"{file.name}.{number}"
        picture, quadric = self.render(file, "quadric", view, name)
        if self.options.exact:
            reference, triangles = self.cast(file, view, name), None
        else:
            reference, triangles = self.render(file, "triangles", view, name)
        done = run([self.options.dupin, "compare", reference, picture, "--json", "--pixels", "5"], self.options.seconds)
        if done.returncode != 0:
            raise RuntimeError(f"compare: exit {done.returncode}: {done.stderr.strip()[-160:]}")
        difference = json.loads(done.stdout)
        if not self.options.keep:
            reference.unlink()
            picture.unlink()
        number_of = lambda stats: stats["primitives"]["count"]
        geometry = difference["geometry"]
        line = (f"{file.name}.{number}: holes {geometry['holes_px']} px, silhouette {difference['silhouette_px']} of "
                f"{difference['covered_px'][0]}, normals 99 % {measure(geometry, 'normal_degrees', 'p99'):.3f} deg, "
                f"depth 99 % {measure(geometry, 'depth_px', 'p99'):.4f} px, {number_of(quadric)} DPs, frame "
                f"{1e3 * quadric['time_s']['first_frame']:.1f} ms")
        if triangles:
            line += f"; {number_of(triangles)} triangles, {1e3 * triangles['time_s']['first_frame']:.1f} ms"
        for pixel in difference.get("pixels", []):
            if pixel["kind"] in ("hole", "extra"):
                line += f"; {pixel['kind']} at {pixel['x']},{pixel['y']} of face {pixel['face'][0] or pixel['face'][1]}"
        return line, shortfalls(difference, quadric)

    def check_file(self, file):
        """Yields (line, shortfalls) for each camera."""
        info = run([self.options.dupin, "info", file, "--json"], self.options.seconds)
        if info.returncode not in (0, 4):
            yield f"{file.name}: not read: {info.stderr.strip()[-160:]}", ["unreadable"] if self.options.strict else []
            return
        box = json.loads(info.stdout)["bounding_box"]
        if box is None:
            yield f"{file.name}: empty", []
            return
        rng = random.Random(hashlib.md5(file.name.encode()).hexdigest())
        for number, how in enumerate(self.options.cameras.split(",")):
            view = camera(rng, box, how)
            try:
                yield self.check(file, number, view)
            except (RuntimeError, subprocess.TimeoutExpired, json.JSONDecodeError) as error:
                yield f"{file.name}.{number}", [str(error)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", metavar="FILE|FOLDER")
    parser.add_argument("--dupin", required=True, help="the command")
    parser.add_argument("--exact", help="dupin_exact, whose pictures are then the reference")
    parser.add_argument("--out", default=None, help="where pictures and statistics go")
    parser.add_argument("--cameras", default="whole,whole,close")
    parser.add_argument("--size", type=int, default=768)
    parser.add_argument("--seconds", type=int, default=300, help="longest time for one command")
    parser.add_argument("--memory", default="8G", help="the command's memory limit")
    parser.add_argument("--strict", action="store_true", help="an unreadable file is a shortfall")
    parser.add_argument("--keep", action="store_true", help="keep the pictures")
    options = parser.parse_args()
    folder = None
    if options.out is None:
        folder = tempfile.TemporaryDirectory()
        options.out = folder.name
    checker, pictures, short = Checker(options), 0, 0
    for file in files_of(options.paths):
        for line, missed in checker.check_file(file):
            pictures += 1
            short += bool(missed)
            print(("SHORT " if missed else "") + line + (": " + ", ".join(missed) if missed else ""), flush=True)
    print(f"{pictures} pictures, {short} short")
    return 1 if short or not pictures else 0


if __name__ == "__main__":
    sys.exit(main())
