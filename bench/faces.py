#!/usr/bin/env python3
"""Is every face of every CAD file drawn or reported, and within the certified bounds?

    bench/faces.py --dupin build/app/dupin -o faces.jsonl FILE|FOLDER...

Draws each file once at the default tolerances (half a pixel, a quarter degree), in a process of its own with a time limit,
and sums up what --stats says. The exit status is 1 if a face is neither drawn nor reported, or a bound is not held.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ENDINGS = {".step", ".stp", ".iges", ".igs", ".brep", ".brp", ".fcstd"}


def files_of(paths):
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            yield from sorted(p for p in path.rglob("*") if p.suffix.lower() in ENDINGS and p.is_file())
        else:
            yield path


def measure(dupin, path, seconds):
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder, "stats.json")
        command = [dupin, "render", str(path), "-o", str(pathlib.Path(folder, "p.png")), "--samples", "1", "--stats", str(stats)]
        try:
            run = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return {"file": str(path), "failed": "took too long"}
        if not stats.exists():  # with faces left out there is a picture, and an exit status
            return {"file": str(path), "failed": (run.stderr.strip().splitlines() or [f"exit status {run.returncode}"])[-1]}
        s = json.loads(stats.read_text())
    return {"file": str(path), "total": s["faces"]["total"], "drawn": s["faces"]["drawn"],
            "reported": len(s["faces"]["skipped"]), "primitives": s["primitives"]["count"],
            "bound_px": s["error"]["bound_px"], "normal_bound_degrees": s["error"]["normal_bound_degrees"],
            "prepare_s": s["time_s"]["prepare"]}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("paths", nargs="+")
    parser.add_argument("--dupin", required=True)
    parser.add_argument("--seconds", type=float, default=90)
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    rows = []
    for path in files_of(options.paths):
        rows.append(measure(options.dupin, path, options.seconds))
        print(json.dumps(rows[-1]), flush=True)
    if options.output:
        pathlib.Path(options.output).write_text("".join(json.dumps(r) + "\n" for r in rows))
    done = [r for r in rows if "failed" not in r]
    lost = [r["file"] for r in done if r["total"] > r["drawn"] + r["reported"]]
    broken = [r["file"] for r in done if r["bound_px"] > 0.5 or r["normal_bound_degrees"] > 0.25]
    total, drawn = sum(r["total"] for r in done), sum(r["drawn"] for r in done)
    print(f"{len(done)} files drawn, {len(rows) - len(done)} not; {drawn} of {total} faces drawn; "
          f"faces lost in {len(lost)} files, bounds broken in {len(broken)}", file=sys.stderr)
    return 1 if lost or broken else 0


if __name__ == "__main__":
    sys.exit(main())
