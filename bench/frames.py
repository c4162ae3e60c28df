#!/usr/bin/env python3
"""Frame times of whole pictures: quadric DPs beside triangles at 2.5e-4 and 1e-5 of the diagonal.

    bench/frames.py --dupin build/app/dupin [--size 1024] [--repeat 30] [-o ROWS.json] FILE|FOLDER...

Every file is drawn from the isometric view, one process a picture, the three kinds in turn so that a busy moment of the machine hits
all of them; the median frame of each process counts. Medians of the ratios over the files end the table. Needs nothing beyond
Python's own library.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ENDINGS = (".step", ".stp", ".igs", ".iges", ".brep", ".brp", ".fcstd")
KINDS = {
    "quadric": ["--primitive", "quadric"],
    "2.5e-4": ["--primitive", "triangles", "--deflection", "2.5e-4"],
    "1e-5": ["--primitive", "triangles", "--deflection", "1e-5"],
}


def files_of(paths):
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            yield from sorted(p for p in path.rglob("*") if p.suffix.lower() in ENDINGS)
        else:
            yield path


def draw(options, file, kind, folder):
    stats = pathlib.Path(folder) / "stats.json"
    size = f"{options.size},{options.size}"
    command = [options.dupin, "render", file, "-o", pathlib.Path(folder) / "picture.png", "--resolution", size, "--samples", "1",
               "--repeat", str(options.repeat), "--no-edges", "--quiet", "--stats", stats, *KINDS[kind]]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=options.seconds)
    if done.returncode not in (0, 4):
        raise RuntimeError(done.stderr.strip()[-120:])
    return json.loads(stats.read_text())


def row_of(options, file):
    times = {kind: [] for kind in KINDS}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.rounds):
            for kind in KINDS:
                stats = draw(options, file, kind, folder)
                times[kind].append(stats["time_s"]["frame_median"])
                last = stats["primitives"]
                if kind == "quadric":
                    count, size = last["count"], last["bytes"]
                elif kind == "2.5e-4":
                    # What any renderer of triangles needs: not the face of each, which the AOVs are drawn with here.
                    reference_size = last["bytes"] - 4 * last["count"]
    row = {"file": str(file), "dps": count, "bytes": size, "bytes_of_triangles": reference_size}
    row.update({kind: statistics.median(values) for kind, values in times.items()})
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", metavar="FILE|FOLDER")
    parser.add_argument("--dupin", required=True)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--repeat", type=int, default=30)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=int, default=300)
    parser.add_argument("-o", "--output", help="the rows as JSON lines")
    options = parser.parse_args()
    rows = []
    output = open(options.output, "w") if options.output else None
    print(f"{'file':44} {'quadric':>9} {'2.5e-4':>9} {'1e-5':>9}  ms; bytes against 2.5e-4")
    for file in files_of(options.paths):
        try:
            row = row_of(options, file)
        except (RuntimeError, subprocess.TimeoutExpired, json.JSONDecodeError) as error:
            print(f"{file.name[:44]:44} {error}", flush=True)
            continue
        rows.append(row)
        if output:
            print(json.dumps(row), file=output, flush=True)
        print(f"{file.name[:44]:44} " + " ".join(f"{1e3 * row[kind]:9.2f}" for kind in KINDS) +
              f"  {100 * row['bytes'] / max(1, row['bytes_of_triangles']):5.1f} %", flush=True)
    if not rows:
        return 1
    for kind in ("2.5e-4", "1e-5"):
        ratio = statistics.median(row[kind] / row["quadric"] for row in rows)
        print(f"median over {len(rows)} files: quadric DPs {ratio:.2f} times as fast as triangles at {kind}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
