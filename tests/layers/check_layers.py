#!/usr/bin/env python3
"""Holds the source tree to its layers: check_layers.py ROOT, or --self-test.

A folder includes only from folders below it; Open CASCADE's headers stay in cad_import/ (and in what stands above the
library), OpenGL's in render/ and the host examples; headers that are installed include nothing of either kind.
"""
import pathlib
import re
import sys
import tempfile

# Folder -> the folders that it may include from, besides itself.
LAYERS = {
    "core": [],
    "nurbs": ["core"],
    "cad_import": ["core", "nurbs"],
    "sampling": ["core", "nurbs"],
    "simplify": ["core", "nurbs", "sampling"],
    "render": ["core", "nurbs", "sampling", "simplify"],
    "host": ["core", "nurbs", "cad_import", "sampling", "simplify", "render"],
}
LIBRARY = list(LAYERS)
LAYERS["exact"] = LIBRARY
LAYERS["app"] = LIBRARY + ["exact"]
for above in ("bench", "examples", "integrations", "samples"):
    LAYERS[above] = LIBRARY + ["exact", "app"]
LAYERS["tests"] = LIBRARY + ["exact", "app", "bench"]

OCCT_ALLOWED = {"cad_import", "samples", "examples", "tests", "bench"}
GL_ALLOWED = {"render", "examples", "integrations", "tests"}
# Open CASCADE's headers are Package_Class.hxx (or Package.hxx); nothing else here uses that ending.
OCCT = re.compile(r"\.(hxx|lxx)$")
GL = re.compile(r"^(GL|GLES\d?|EGL|KHR|epoxy|GLFW|glad|X11)/|^(osmesa|glew)\.h$|GL/osmesa\.h$")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
SOURCES = {".h", ".hpp", ".cpp", ".cc", ".c", ".inl"}


def violations_in(root, path):
    """Yields one line for each include of the file that breaks a rule."""
    relative = path.relative_to(root)
    folder = relative.parts[0]
    text = path.read_text(encoding="utf-8", errors="replace")
    for match in INCLUDE.finditer(text):
        quote, name = match.groups()
        where = f"{relative}:{text.count(chr(10), 0, match.start()) + 1}"
        if OCCT.search(name) and folder not in OCCT_ALLOWED:
            yield f"{where}: Open CASCADE's {name} outside cad_import"
        elif GL.search(name) and folder not in GL_ALLOWED:
            yield f"{where}: OpenGL's {name} outside render"
        elif OCCT.search(name) and folder == "cad_import" and path.name == "cad_import.h":
            yield f"{where}: an Open CASCADE type in the reader's interface"
        elif quote == '"':
            yield from wrong_layer(root, path, folder, name, where)
        elif name.startswith("dupin/") and folder in LIBRARY:
            yield f"{where}: <{name}> names the installed library; the tree includes relatively"


def wrong_layer(root, path, folder, name, where):
    target = (path.parent / name).resolve()
    try:
        target_folder = target.relative_to(root).parts[0]
    except ValueError:
        yield f"{where}: {name} lies outside the project"
        return
    if target_folder in LAYERS and target_folder != folder and target_folder not in LAYERS[folder]:
        yield f"{where}: {folder} includes {name}, which is no layer below it"
    if not target.exists() and "/" in name:
        yield f"{where}: {name} does not exist"


def check(root):
    root = root.resolve()
    found, files = [], 0
    for folder in LAYERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SOURCES and path.is_file():
                files += 1
                found += violations_in(root, path)
    return files, found


PLANTED = {
    "nurbs/up.h": '#include "../sampling/sampler.h"',
    "sampling/sampler.h": '#include "../nurbs/surface.h"',
    "nurbs/surface.h": "#include <vector>",
    "sampling/side.cpp": '#include "../cad_import/cad_import.h"',
    "cad_import/cad_import.h": "#include <TopoDS.hxx>",
    "render/kernel.cpp": "#include <gp_Pnt.hxx>",
    "app/window.cpp": "#include <GL/gl.h>",
    "core/own.cpp": "#include <dupin/core/vec.h>",
    "cad_import/shape.cpp": "#include <TopoDS_Shape.hxx>",
    "render/context.cpp": "#include <EGL/egl.h>",
}
EXPECTED = {"nurbs/up.h", "sampling/side.cpp", "cad_import/cad_import.h", "render/kernel.cpp", "app/window.cpp",
            "core/own.cpp"}


def self_test():
    """Plants one violation of every kind, and what is allowed, in an empty tree."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in PLANTED.items():
            (root / name).parent.mkdir(exist_ok=True)
            (root / name).write_text("// first line\n" + text + "\n")
        files, found = check(root)
        caught = {line.split(":")[0] for line in found}
        if files != len(PLANTED) or caught != EXPECTED or not all(":2:" in line for line in found):
            print(f"self-test: caught {sorted(caught)}, expected {sorted(EXPECTED)}")
            return 1
    print(f"self-test: all {len(EXPECTED)} planted violations caught, and no other")
    return 0


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    if sys.argv[1] == "--self-test":
        return self_test()
    files, found = check(pathlib.Path(sys.argv[1]))
    for line in found:
        print(line)
    print(f"{files} files, {len(found)} violations")
    return 1 if found or files < 10 else 0


if __name__ == "__main__":
    sys.exit(main())
