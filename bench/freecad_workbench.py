#!/usr/bin/env python3
"""What FreeCAD's workbench takes, beside FreeCAD's own view: freecad_workbench.py MODULE_FOLDER READER OUT MODEL...

For each model, in FreeCAD under Xvfb: seconds from the command *Show exact* to the frame that shows everything exactly; the median
frame while the camera turns, of FreeCAD's own view and of the exact one, ten of each in turn; and pictures in OUT of both zoomed
100 times into the outline that a row of the view meets first, a part ROW (0.25) of its height from the top.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS, FRAMES, ZOOM = 3, 10, 100


def in_freecad():
    import traceback

    import FreeCAD as App
    import FreeCADGui as Gui
    from pivy import coin
    from PySide import QtCore, QtGui

    out, seen = os.environ["DUPIN_BENCH_OUT"], {}

    def spin(seconds, until=lambda: False):
        end = time.time() + seconds
        while time.time() < end and not until():
            QtGui.QApplication.processEvents()
            time.sleep(0.002)

    def frames(view):
        """Milliseconds each: what the GPU does is waited for."""
        camera, widget, taken = view.getCameraNode(), view.graphicsView().viewport(), []
        for _ in range(FRAMES):
            camera.orientation = camera.orientation.getValue() * coin.SbRotation(coin.SbVec3f(0, 0, 1), 0.03)
            start = time.perf_counter()
            view.redraw()
            QtGui.QApplication.processEvents()
            widget.makeCurrent()
            gl.glFinish()
            widget.doneCurrent()
            taken.append(1000 * (time.perf_counter() - start))
        return taken

    def aim(view, exact, row):
        """Moves what the row meets first from the left to the middle of the view."""
        spin(0.5)
        widget, node = view.graphicsView().viewport(), view.getCameraNode()
        width, height = view.getSize()
        y = int((1 - row) * height)
        widget.makeCurrent()
        x = next((x for x in range(0, width, 1) if exact.drawn.scene.pick(*exact.drawn.last_camera, x, y)), width // 2)
        widget.doneCurrent()
        pixel, turn = node.height.getValue() / height, node.orientation.getValue()
        across, up = turn.multVec(coin.SbVec3f(1, 0, 0)), turn.multVec(coin.SbVec3f(0, 1, 0))
        node.position = node.position.getValue() + across * ((x - width / 2) * pixel) + up * ((y - height / 2) * pixel)

    def picture(view, name):
        spin(0.3)
        widget = view.graphicsView().viewport()
        corner = widget.mapToGlobal(QtCore.QPoint(0, 0))
        QtGui.QApplication.primaryScreen().grabWindow(0, corner.x(), corner.y(), widget.width(), widget.height()).save(
            os.path.join(out, name + ".png"))

    def work():
        import ctypes

        import ImportGui

        nonlocal gl
        gl = ctypes.CDLL("libGL.so.1")
        model = os.environ["DUPIN_BENCH_MODEL"]
        stem = os.path.splitext(os.path.basename(model))[0]
        Gui.activateWorkbench("DupinWorkbench")
        if model.lower().endswith("fcstd"):
            App.openDocument(model)
        else:
            ImportGui.open(model)
        view = Gui.ActiveDocument.ActiveView
        spin(1)
        view.viewIsometric()
        Gui.SendMsgToActiveView("ViewFit")
        spin(0.5)
        start = time.perf_counter()
        Gui.runCommand("Dupin_ShowExact")
        import dupin_view

        exact = dupin_view.of(view)
        spin(30, lambda: exact.error or (exact.drawn and {key for key, _ in exact.drawn.slots} == set(dupin_view._shown)))
        seen["seconds"], seen["objects"], seen["error"] = time.perf_counter() - start, len(dupin_view._shown), exact.error
        seen["primitives"], seen["size"] = exact.stats.get("primitives"), view.getSize()
        shown = list(dupin_view._shown.values())
        own, ours = [], []
        for _ in range(ROUNDS):
            ours += frames(view)
            exact.suspended = True
            for s in shown:
                s.show_tessellation()
            own += frames(view)
            exact.suspended = False
            for s in shown:
                s.hide_tessellation()
        seen["own_ms"], seen["exact_ms"] = own, ours
        spin(0.5)

        view.viewIsometric()
        Gui.SendMsgToActiveView("ViewFit")
        row = float(os.environ.get("ROW", "0.25"))
        for _ in range(2):
            aim(view, exact, row)
            camera = view.getCameraNode()
            camera.height = camera.height.getValue() / ZOOM ** 0.5
            row = 0.5
            spin(15, lambda: not dupin_view.busy() and exact.stats["bound_px"] <= 0.5)
            spin(0.3)
        seen["zoomed_px"] = exact.stats["bound_px"]
        picture(view, stem + "_exact")
        Gui.runCommand("Dupin_ShowExact")
        picture(view, stem + "_freecad")

    def main():
        try:
            work()
        except Exception:
            seen["failure"] = traceback.format_exc()
        with open(os.path.join(out, "seen.json"), "w") as file:
            json.dump(seen, file, default=str)
        os._exit(0)

    gl = None
    QtCore.QTimer.singleShot(500, main)


def run(module, reader, out, model):
    workbench = os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(__file__))), "integrations", "freecad")
    with tempfile.TemporaryDirectory() as home:
        folder = os.path.join(home, ".local/share/FreeCAD/Mod/Dupin")
        os.makedirs(folder)
        for source in (workbench, module):
            for name in os.listdir(source):
                if name.endswith((".py", ".xml", ".so")):
                    os.symlink(os.path.join(source, name), os.path.join(folder, name))
        environment = dict(os.environ, HOME=home, XDG_RUNTIME_DIR=home, DUPIN_READER=reader, DUPIN_BENCH_OUT=out,
                           DUPIN_BENCH_MODEL=model, QTWEBENGINE_DISABLE_SANDBOX="1")
        with open(os.path.join(out, "log"), "w") as log:
            subprocess.run(["timeout", "120", "xvfb-run", "-a", "-s", "-screen 0 1280x900x24 -dpi 96 +extension GLX", "freecad",
                            os.path.realpath(__file__)], env=environment, stdout=log, stderr=subprocess.STDOUT, check=False)
    with open(os.path.join(out, "seen.json")) as file:
        seen = json.load(file)
    if "failure" in seen or seen["error"]:
        print(seen.get("failure") or seen["error"])
        return
    print("%s: exact after %.2f s (%d objects, %d primitives, %s pixels); a frame %.0f ms, FreeCAD's own %.0f ms; zoomed: within %.3g px" % (
        os.path.basename(model), seen["seconds"], seen["objects"], seen["primitives"], seen["size"], statistics.median(seen["exact_ms"]),
        statistics.median(seen["own_ms"]), seen["zoomed_px"]))


if os.environ.get("DUPIN_BENCH_MODEL"):
    in_freecad()
elif __name__ == "__main__":
    module, reader, out = [os.path.realpath(a) for a in sys.argv[1:4]]
    os.makedirs(out, exist_ok=True)
    for model in map(os.path.realpath, sys.argv[4:]):
        run(module, reader, out, model)
