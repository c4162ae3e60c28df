#!/usr/bin/env python3
"""Whole processes, from the file to the picture: bench/programs.py --dupin build/app/dupin -o FOLDER FILE...

Dupin beside the programs that a user would run instead, where they are installed: F3D, and FreeCAD off-screen. Where there is no display, one Xvfb
is started for all. They take turns on every file; medians count. Writes FOLDER/programs.csv, which dupin-report shows with the study of that folder.
"""
import argparse
import csv
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import tempfile
import time

FREECAD_MACRO = """
import FreeCAD, FreeCADGui, Import, ImportGui, os
ImportGui.open({file!r})
view = FreeCADGui.activeDocument().activeView()
view.viewIsometric()
view.fitAll()
view.saveImage({picture!r}, {size}, {size}, "White")
os._exit(0)
"""


def dupin(program):
    return lambda file, picture, size: [program, "render", file, "-o", picture, "--resolution", f"{size},{size}", "--quiet"]


def f3d(program):
    return lambda file, picture, size: [program, file, f"--output={picture}", f"--resolution={size},{size}", "--no-background", "--quiet"]


def freecad(program):
    def command(file, picture, size):
        macro = pathlib.Path(picture).with_suffix(".FCMacro")
        macro.write_text(FREECAD_MACRO.format(file=str(file), picture=str(picture), size=size))
        return [program, macro]
    return command


def programs(options):
    """Name -> command; those that are not installed are named."""
    found = {"dupin": dupin(options.dupin)}
    for name, make, names in (("F3D", f3d, ["f3d"]), ("FreeCAD", freecad, ["freecad", "FreeCAD"])):
        program = next((p for p in map(shutil.which, names) if p), None)
        if program and os.environ.get("DISPLAY"):
            found[name] = make(program)
        else:
            print(f"{name}: not installed, or no display and no Xvfb; left out")
    return found


def start_display():
    """A display of our own where there is none; the process to end afterwards."""
    if os.environ.get("DISPLAY") or not shutil.which("Xvfb"):
        return None
    ours, theirs = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(theirs), "-screen", "0", "1280x1280x24"], pass_fds=[theirs],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(theirs)
    with os.fdopen(ours) as pipe:
        os.environ["DISPLAY"] = ":" + pipe.readline().strip()
    return server


def run(command, picture, seconds):
    """(wall seconds, processor seconds), or None without a picture."""
    picture.unlink(missing_ok=True)
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    environment = os.environ | {"QT_QPA_PLATFORM": os.environ.get("QT_QPA_PLATFORM", "xcb"), "QTWEBENGINE_DISABLE_SANDBOX": "1"}
    try:
        done = subprocess.run(command, capture_output=True, timeout=seconds, env=environment)
    except subprocess.TimeoutExpired:
        return None
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 4) or not picture.exists():
        return None
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--dupin", required=True)
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--seconds", type=float, default=120)
    options = parser.parse_args()
    server = start_display()
    try:
        measure(options, programs(options))
    finally:
        if server:
            server.terminate()


def measure(options, found):
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        picture = pathlib.Path(scratch) / "picture.png"
        for file in map(pathlib.Path, options.files):
            times = {name: [] for name in found}
            for _ in range(options.rounds):
                for name, command in found.items():
                    times[name].append(run(command(file.resolve(), picture, options.size), picture, options.seconds))
            for name, list_ in times.items():
                good = [t for t in list_ if t]
                walls = sorted(t[0] for t in good)
                rows.append({"file": file.name, "program": name, "seconds": f"{statistics.median(walls):.3f}" if good else "no picture",
                             "least": f"{walls[0]:.3f}" if good else "", "most": f"{walls[-1]:.3f}" if good else "",
                             "processor seconds": f"{statistics.median(t[1] for t in good):.3f}" if good else "", "rounds": len(good)})
                print(" ".join(f"{v}" for v in rows[-1].values()), flush=True)
    folder = pathlib.Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "programs.csv", "w", newline="", encoding="utf-8") as out:
        table = csv.DictWriter(out, list(rows[0]))
        table.writeheader()
        table.writerows(rows)


main()
