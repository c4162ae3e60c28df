"""Runs inside FreeCAD (freecad_test.py starts it): does what DUPIN_TEST_CASE says, and writes what it saw as JSON."""
import faulthandler
import json
import os
import time
import traceback

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

OUT = os.environ["DUPIN_TEST_OUT"]
seen = {}
crash = open(os.path.join(OUT, "crash"), "w")
faulthandler.enable(crash)  # where it was, if FreeCAD crashes


def spin(seconds, until=lambda: False):
    """Lets FreeCAD live, at most so long; whether what was waited for came."""
    end = time.time() + seconds
    while time.time() < end:
        QtGui.QApplication.processEvents()
        if until():
            return True
        time.sleep(0.003)
    return until()


def shot(name):
    """What the window shows."""
    spin(0.15)
    view = Gui.ActiveDocument.ActiveView.graphicsView()
    corner = view.viewport().mapToGlobal(QtCore.QPoint(0, 0))
    screen = QtGui.QApplication.primaryScreen()
    path = os.path.join(OUT, name + ".ppm")
    screen.grabWindow(0, corner.x(), corner.y(), view.viewport().width(), view.viewport().height()).save(path)
    seen.setdefault("pictures", {})[name] = path


def camera():
    node = Gui.ActiveDocument.ActiveView.getCameraNode()
    turn = node.orientation.getValue()
    from pivy import coin

    along, up = turn.multVec(coin.SbVec3f(0, 0, -1)).getValue(), turn.multVec(coin.SbVec3f(0, 1, 0)).getValue()
    eye = node.position.getValue().getValue()
    return {"eye": list(eye), "target": [e + a for e, a in zip(eye, along)], "up": list(up), "height": node.height.getValue(),
            "size": list(Gui.ActiveDocument.ActiveView.getSize())}


def plain_views():
    """White behind, nothing that is not the document's in front."""
    view = App.ParamGet("User parameter:BaseApp/Preferences/View")
    for name, on in (("Gradient", False), ("Simple", True), ("CornerCoordSystem", False), ("ShowNaviCube", False),
                     ("ShowAxisCross", False), ("UseNavigationAnimations", False)):
        view.SetBool(name, on)
    view.SetUnsigned("BackgroundColor", 0xFFFFFFFF)
    view.SetBool("EnablePreselection", False)
    App.ParamGet("User parameter:BaseApp/Preferences/NaviCube").SetBool("ShowNaviCube", False)


def settled():
    import dupin_view

    return all(s.prepared for s in dupin_view._shown.values()) and not dupin_view.busy()


def exact(objects=()):
    """The command, on these objects or all, until it is done."""
    import dupin_view

    Gui.Selection.clearSelection()
    for obj in objects:
        Gui.Selection.addSelection(obj)
    before = dupin_view.of(Gui.ActiveDocument.ActiveView).frames
    Gui.runCommand("Dupin_ShowExact")
    Gui.Selection.clearSelection()
    view = dupin_view.of(Gui.ActiveDocument.ActiveView)
    assert spin(20, lambda: settled() and (view.frames > before or not dupin_view._shown)), "not ready in time"
    spin(0.1)
    return view


def fit():
    view, since, size = Gui.ActiveDocument.ActiveView, time.time(), None
    while time.time() < since + 0.7:  # until FreeCAD's windows have their sizes
        spin(0.05)
        if view.getSize() != size:
            since, size = time.time(), view.getSize()
    view.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    return view


def fine(obj):
    """FreeCAD's own, as fine as it is worth."""
    obj.ViewObject.Deviation = 0.01
    obj.ViewObject.AngularDeflection = 1


def step_file():
    """A STEP file beside FreeCAD's own picture, dupin render's and other shadings."""
    import ImportGui

    ImportGui.open(os.environ["DUPIN_TEST_MODEL"])
    fit()
    obj = next(o for o in App.ActiveDocument.Objects if getattr(o, "Shape", None))
    fine(obj)
    obj.ViewObject.DisplayMode = "Shaded"
    spin(0.2)
    shot("own")
    view = exact()
    shot("exact")
    seen["camera"], seen["stats"], seen["color"] = camera(), view.stats, list(obj.ViewObject.ShapeColor[:3])
    Gui.runCommand("Dupin_Zebra")
    shot("zebra")
    Gui.runCommand("Dupin_Curvature")
    shot("curvature")
    Gui.runCommand("Dupin_Curvature")  # off again
    saved = os.path.join(OUT, "saved.png")
    view.save(saved, factor=1)
    seen["pictures"]["saved"] = os.path.join(OUT, "saved.ppm")
    QtGui.QImage(saved).save(seen["pictures"]["saved"])
    Gui.runCommand("Dupin_Compare")
    seen["dialog"] = [w.windowTitle() for w in QtGui.QApplication.topLevelWidgets() if w.isVisible() and "essellation" in w.windowTitle()]
    for widget in QtGui.QApplication.topLevelWidgets():
        if widget.windowTitle() in seen["dialog"]:
            widget.close()
    spin(0.1)
    Gui.ActiveDocument.ActiveView.getCameraNode().height = seen["camera"]["height"] / 50
    spin(10, lambda: view.stats["bound_px"] <= 0.5)
    seen["zoomed"] = view.stats["bound_px"]
    Gui.ActiveDocument.ActiveView.getCameraNode().height = seen["camera"]["height"]
    exact()  # a second time: as before
    shot("again")
    seen["error"] = view.error


def document():
    """Edits, visibility, colors, placements, links, occlusion, clipping planes, what cannot be read, and closing."""
    import dupin_view

    doc = App.newDocument("Edits")
    box, rod = doc.addObject("Part::Box", "Slab"), doc.addObject("Part::Cylinder", "Rod")
    box.Length, box.Width, box.Height = 40, 40, 10
    rod.Radius, rod.Height, rod.Placement.Base = 6, 40, App.Vector(20, 20, -15)
    box.ViewObject.ShapeColor, rod.ViewObject.ShapeColor = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    for obj in (box, rod):
        obj.ViewObject.DisplayMode = "Shaded"
        fine(obj)
    doc.recompute()
    fit()
    spin(0.2)
    shot("own")
    view = exact([rod])  # FreeCAD's slab hides a part of it, and it a part of the slab
    seen["one"] = len(dupin_view._shown)
    shot("occluded")

    rod.ViewObject.Transparency = 50
    shot("seen through")
    rod.ViewObject.Transparency = 0
    shot("opaque again")

    box.ViewObject.Visibility = False
    shot("rod alone")
    box.ViewObject.Visibility = True
    rod.ViewObject.Visibility = False
    shot("slab alone")
    rod.ViewObject.Visibility = True
    rod.ViewObject.ShapeColor = (0.0, 0.0, 1.0)
    shot("blue")
    seen["slots"] = len(view.drawn.slots)
    Gui.Selection.addSelection(rod)
    shot("selected")
    Gui.Selection.clearSelection()
    top = max(range(3), key=lambda i: rod.Shape.Faces[i].CenterOfMass.z)
    Gui.Selection.addSelection(doc.Name, rod.Name, "Face%d" % (top + 1))
    shot("top selected")
    Gui.Selection.clearSelection()
    rod.ViewObject.ShapeColor = (0.0, 1.0, 0.0)
    rod.Height = 60  # edited: FreeCAD's own at once, the exact one soon
    doc.recompute()
    assert spin(10, settled)
    shot("longer")
    dupin_view.hide([dupin_view.key_of(rod)])
    shot("longer own")
    exact([rod])
    rod.Placement.Base = App.Vector(5, 35, -15)
    doc.recompute()
    shot("moved")
    dupin_view.hide([dupin_view.key_of(rod)])
    shot("moved own")
    link = doc.addObject("App::Link", "Again")
    link.LinkedObject, link.Placement.Base = rod, App.Vector(28, -30, 0)
    doc.recompute()
    shot("link own")
    exact([rod])
    shot("link")
    doc.removeObject(link.Name)
    exact([box])
    each = [(1.0, 0.5, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 0.0)]
    box.ViewObject.DiffuseColor = each
    assert spin(10, settled)
    shot("faces")
    dupin_view.hide([dupin_view.key_of(box)])
    shot("faces own")
    exact([box])
    Gui.ActiveDocument.ActiveView.toggleClippingPlane(1, True, True, App.Placement(App.Vector(20, 20, 5), App.Rotation(App.Vector(1, 0, 0), 90)))
    shot("clipped")
    Gui.ActiveDocument.ActiveView.toggleClippingPlane(0)
    seen["error"] = view.error

    # What cannot be prepared is shown as before, and said.
    import dupin_shapes

    good, dupin_shapes.file_of = dupin_shapes.file_of, lambda *_: b"PK no shape"
    box.Length = 50
    doc.recompute()
    spin(10, lambda: not dupin_view.is_shown(box))
    dupin_shapes.file_of = good
    seen["refused"] = not dupin_view.is_shown(box)
    shot("refused")
    doc.removeObject(rod.Name)
    spin(0.2)
    seen["left"] = len(dupin_view._shown)
    exact([box])
    seen["goes on"] = len(dupin_view._shown)
    App.closeDocument(doc.Name)
    spin(0.3)
    seen["closed"] = len(dupin_view._shown)
    App.newDocument("Next").addObject("Part::Box", "Box")
    App.ActiveDocument.recompute()
    fit()
    seen["next"] = exact().stats


def main():
    try:
        plain_views()
        Gui.activateWorkbench("DupinWorkbench")
        globals()[os.environ["DUPIN_TEST_CASE"]]()
        seen["done"] = True
    except Exception:
        seen["failure"] = traceback.format_exc()
    with open(os.path.join(OUT, "seen.json"), "w") as file:
        json.dump(seen, file, default=str)
    os._exit(0)


QtCore.QTimer.singleShot(300, main)
