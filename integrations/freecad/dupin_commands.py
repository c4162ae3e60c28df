"""The workbench's commands."""
import tempfile

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

NAMES = ["Dupin_ShowExact", "Dupin_Curvature", "Dupin_Zebra", "Dupin_Compare", "Dupin_SavePicture"]


def chosen():
    """The selected objects with faces; without a selection, all that are seen."""
    import dupin_shapes

    found = []
    for obj in Gui.Selection.getSelection():
        found += [o for o in dupin_shapes.below(obj) if o not in found]
    return found or dupin_shapes.shown(App.ActiveDocument)


def show_exact():
    import dupin_view

    objects = chosen()
    if objects and all(dupin_view.is_shown(o) for o in objects):
        dupin_view.hide([dupin_view.key_of(o) for o in objects])
        return
    if not objects:
        App.Console.PrintWarning("Dupin: nothing that is selected or seen has faces\n")
    dupin_view.show(objects)


def shade(kind):
    import dupin_view

    view = dupin_view.of(Gui.ActiveDocument.ActiveView)
    view.shading = "lit" if view.shading == kind else kind
    if not any(dupin_view.is_shown(o) for o in App.ActiveDocument.Objects):
        dupin_view.show(chosen())
    view.redraw()


def compare():
    import dupin_view

    view = dupin_view.of(Gui.ActiveDocument.ActiveView)
    with tempfile.TemporaryDirectory() as folder:
        names, found = view.compare(folder)
        text = "RMSE %.3g grey levels; %d pixels are covered by one of them alone" % (
            found["rmse"], found["silhouette_px"])
        App.Console.PrintMessage("Dupin: tessellation and exact shapes: %s\n" % text)
        pictures = [QtGui.QPixmap(name) for name in names]
    dialog = QtGui.QDialog(Gui.getMainWindow())
    dialog.setWindowTitle("Tessellation (left) and exact shapes (right)")
    dialog.setAttribute(QtCore.Qt.WA_DeleteOnClose)
    layout = QtGui.QGridLayout(dialog)
    for column, picture in enumerate(pictures):
        label = QtGui.QLabel()
        label.setPixmap(picture.scaledToWidth(min(picture.width(), 700), QtCore.Qt.SmoothTransformation))
        layout.addWidget(label, 0, column)
    layout.addWidget(QtGui.QLabel(text), 1, 0, 1, 2)
    dialog.show()
    return found


def save_picture():
    import dupin_view

    path, _ = QtGui.QFileDialog.getSaveFileName(Gui.getMainWindow(), "Save picture", "", "PNG (*.png)")
    if path:
        dupin_view.of(Gui.ActiveDocument.ActiveView).save(path if path.lower().endswith(".png") else path + ".png")


class Command:
    def __init__(self, text, tip, run):
        self.text, self.tip, self.run = text, tip, run

    def GetResources(self):
        return {"MenuText": self.text, "ToolTip": self.tip}

    def IsActive(self):
        return Gui.ActiveDocument is not None and hasattr(Gui.ActiveDocument.ActiveView, "getSceneGraph")

    def Activated(self, index=0):
        try:
            self.run()
        except Exception as error:  # FreeCAD goes on; the user reads why
            App.Console.PrintError("Dupin: %s\n" % error)


def register():
    commands = (
        Command("Show exact", "Draw the selected shapes, or all, from their exact surfaces; or as before", show_exact),
        Command("Curvature", "Color by mean curvature, or as before", lambda: shade("mean")),
        Command("Zebra", "Reflected stripes, or as before", lambda: shade("zebra")),
        Command("Compare with tessellation", "How much this view's pictures of both differ", compare),
        Command("Save picture", "Save this view at twice its size", save_picture))
    for name, command in zip(NAMES, commands):
        Gui.addCommand(name, command)
