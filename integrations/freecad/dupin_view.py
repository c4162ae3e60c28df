"""Exact shapes in FreeCAD's 3D views.

A shown object has, in the groups of its scene graph that draw its faces, a callback node in front of these. Whenever a view
draws itself the nodes say which objects it shows, and where: visibility, placements, containers and links are Coin's. A
callback node at the end of the view's scene graph then draws all of them with the camera and clipping planes of the
traversal, into the framebuffer that is bound, against its depth. A draw style makes the tessellation invisible, which can
still be picked. Dupin leaves OpenGL's state as it found it, so that what Coin remembers of it stays true; Coin's render
caches are told not to keep what a callback drew.
"""
import os
import tempfile
import time

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from pivy import coin
from PySide import QtCore, QtGui

import dupin
import dupin_shapes

TOLERANCE_PX = 0.5  # a resting view is refined to this
SELECTED = [0.013, 0.42, 0.013]  # FreeCAD's green, linear
READERS = 4         # files read at once
TAKE_S = 0.4        # between changes of what is drawn while more is being prepared
REST_S = 0.1        # a camera that stands still so long rests
CLOSED_MS = 300     # until a window that closes is gone
_shown = {}         # Shown by document and object name
_views = []
_lost = []          # scenes whose contexts went without notice


def key_of(obj):
    return obj.Document.Name, obj.Name


class Shown:
    """A document object that is drawn exactly, once it is prepared; until then as FreeCAD does."""

    def __init__(self, obj):
        self.obj, self.key = obj, key_of(obj)
        self.prepared, self.job, self.path = None, None, None
        self.version = 0   # of what is prepared
        self.look = self.baked = None
        self.hidden = []   # (group, its nodes)
        self.outlined = False

    def start(self):
        """Begins to prepare what the object is now."""
        self.drop_job()
        try:
            self.look = dupin_shapes.colors(self.obj)
            descriptor, self.path = tempfile.mkstemp(suffix=".FCStd", prefix="dupin")
            with os.fdopen(descriptor, "wb") as file:
                file.write(dupin_shapes.file_of(self.obj, self.look))
            self.job, self.job_look = dupin.Job(self.path), self.look
        except Exception:
            self.drop_job()
            raise

    def drop_job(self):
        if self.job:
            self.job.cancel()
        self.job = None
        if self.path:
            os.unlink(self.path)
        self.path = None

    def take(self):
        """Of a job that is done; raises what it failed of."""
        job, self.job = self.job, None
        try:
            self.prepared, self.baked = job.result(), self.job_look
        finally:
            self.drop_job()
        self.version += 1
        self.hide_tessellation()

    def color(self):
        """In place of the colors that it was prepared with; None: those."""
        return None if self.look == self.baked else dupin_shapes.linear(self.look[0][0], self.look[1])

    def look_again(self):
        """After its colors may have changed. Whether it must be prepared again."""
        before, self.look = self.look, dupin_shapes.colors(self.obj)
        if before[1] != self.look[1]:
            self.hide_tessellation()
        return self.look != self.baked and len(self.look[0]) > 1

    def faces_of(self, names):
        """Numbers of faces that FreeCAD calls so, where they are the same here."""
        info = self.prepared.model.info()
        if info["instances"] != 1 or info["faces"] != len(self.obj.Shape.Faces) or info["skipped"]:
            return ()
        return tuple(int(name[4:]) - 1 for name in names if name.startswith("Face") and name[4:].isdigit())

    def hide_tessellation(self):
        self.show_tessellation()
        if self.look[1] > 0:
            return  # what one sees through is FreeCAD's: Dupin draws what is opaque
        for group, edges, outer in dupin_shapes.face_groups(self.obj.ViewObject):
            here, invisible, behind = coin.SoCallback(), coin.SoDrawStyle(), coin.SoPolygonOffset()
            here.setCallback(lambda _, action, edges=edges, outer=outer: self._traversed(action, edges, outer))
            invisible.style = coin.SoDrawStyle.INVISIBLE
            invisible.setOverride(True)
            # FreeCAD shows triangles that are selected all the same: Dupin's selected faces hide them.
            behind.factor, behind.units = 2, 2000
            nodes = (here, invisible, behind)
            for place, node in enumerate(nodes):
                group.insertChild(node, place)
            group.ref()  # pivy does not keep nodes
            self.hidden.append((group, nodes))

    def show_tessellation(self):
        for group, nodes in self.hidden:
            for node in nodes:
                if group.findChild(node) >= 0:
                    group.removeChild(node)
            group.unref()
        self.hidden = []

    def touch(self):
        for _, nodes in self.hidden:
            nodes[0].touch()

    def _traversed(self, action, edges, outer):
        if outer:
            self.outlined = edges  # what is in it comes next
            return
        edges, self.outlined = edges or self.outlined, False
        if action.isOfType(coin.SoGLRenderAction.getClassTypeId()):
            state = action.getState()
            coin.SoCacheElement.invalidate(state)
            for view in _views:
                if view.drawing:
                    view.found.append((self, matrix(coin.SoModelMatrixElement.get(state)), edges))
        elif action.isOfType(coin.SoGetBoundingBoxAction.getClassTypeId()) and self.prepared.model.box is not None:
            low, high = self.prepared.model.box.tolist()
            coin.cast(action, "SoGetBoundingBoxAction").extendBy(coin.SbBox3f(*low, *high))


def matrix(value):
    """Coin multiplies rows from the left."""
    return np.array(value.getValue()).T


class Drawn:
    """What an OpenGL context has of the shown objects."""

    def __init__(self):
        self.scene = dupin.Scene()
        self.slots = {}  # by object and how often it was met before: [number, version, placement, visible, color, selected]
        self.refined, self.last, self.last_camera, self.time, self.stats = None, None, None, 0, {}
        self.waits_for = None  # "rest": the camera's, to refine then; "finer": what is being prepared

    def update(self, found):
        met, wanted, selected = {}, set(), selection()
        for shown, place, _ in found:
            count = met[shown.key] = met.get(shown.key, -1) + 1
            wanted.add((shown.key, count))
            slot = self.slots.setdefault((shown.key, count), [None, 0, None, True, None, None])
            self._update(slot, shown, place)
            self._highlight(slot, shown, selected.get(shown.key))
        for key, slot in list(self.slots.items()):
            if key in wanted:
                continue
            if key[0] not in _shown:
                self.scene.remove(slot[0])
                del self.slots[key]
            elif slot[3]:
                self.scene.set_visible(slot[0], False)
                slot[3] = False

    def _update(self, slot, shown, place):
        number, version, old, seen, color, _ = slot
        if number is None:
            slot[0] = number = self.scene.add(shown.prepared, place)
        elif version != shown.version:
            self.scene.replace(number, shown.prepared)
        if old is not None and not np.array_equal(old, place):
            self.scene.place(number, place)
        if not seen:
            self.scene.set_visible(number, True)
        if color != shown.color():
            self.scene.set_color(number, shown.color())
        slot[1:5] = [shown.version, place, True, shown.color()]

    def _highlight(self, slot, shown, names):
        """The whole object where there are no names of faces."""
        if names == slot[5]:
            return
        for chosen, color in ((slot[5], None), (names, SELECTED)):
            if chosen == ():
                self.scene.set_highlight(slot[0], color)
            for face in shown.faces_of(chosen or ()):
                self.scene.set_highlight(slot[0], color, 0, face)
        slot[5] = names

    def draw(self, camera, options, wait):
        refining = self.scene.refining  # looked at before: what is ready is drawn
        self.stats = self.scene.draw(*camera, **options)
        view = camera_bytes(camera) + b"".join(s[2].tobytes() + bytes([s[1] % 251, s[3]]) for s in self.slots.values())
        same, self.last, self.last_camera, self.time = view == self.last, view, camera, time.monotonic()
        if self.stats["bound_px"] <= TOLERANCE_PX or (view == self.refined and not refining):
            self.waits_for = None
        elif view == self.refined:
            self.waits_for = "finer"
        elif same or wait:
            self.refined, self.waits_for = view, "finer"
            self.scene.refine(*camera, tolerance_px=TOLERANCE_PX)
        else:
            self.waits_for = "rest"
        if wait and self.waits_for:
            while self.scene.refining:
                time.sleep(0.002)
            self.stats = self.scene.draw(*camera, **options)

    def due(self):
        """Whether it is time to draw again."""
        if self.waits_for == "rest":
            return time.monotonic() > self.time + REST_S
        return self.waits_for == "finer" and not self.scene.refining


def selection():
    """Names of what is selected of objects; none: all."""
    return {(s.DocumentName, s.ObjectName): tuple(s.SubElementNames) for s in Gui.Selection.getSelectionEx("*")}


def camera_bytes(camera):
    return b"".join(np.asarray(c, dtype=float).tobytes() for c in camera)


class ExactView:
    """One of FreeCAD's 3D views."""

    def __init__(self, view):
        self.view, self.graph = view, view.getSceneGraph()
        self.shading, self.stats, self.error, self.frames = "lit", {}, None, 0
        self.found, self.drawing, self.suspended = [], False, False
        self.context, self.drawn = None, None
        self.first, self.last = coin.SoCallback(), coin.SoCallback()
        self.first.setCallback(self._begin)
        self.last.setCallback(self._end)
        self.graph.ref()
        self.graph.insertChild(self.first, 0)
        self.graph.addChild(self.last)
        self.closing = Closing(self)

    def leave(self):
        """Lets go of the view, and of what its context has."""
        _views.remove(self)
        for node in (self.first, self.last):
            self.graph.removeChild(node)
        self.graph.unref()
        if self.drawn and self.context is not None:
            viewport = self.view.graphicsView().viewport()
            viewport.makeCurrent()
            self.drawn = None
            viewport.doneCurrent()

    def redraw(self):
        # Objects that came later stand behind it.
        count = self.graph.getNumChildren()
        if self.graph.getChild(count - 1) != self.last:
            self.graph.removeChild(self.last)
            self.graph.addChild(self.last)
        self.last.touch()

    # ---- during a traversal

    def _begin(self, _, action):
        if action.isOfType(coin.SoGLRenderAction.getClassTypeId()):
            self.found, self.drawing = [], True

    def _end(self, _, action):
        if not self.drawing or not action.isOfType(coin.SoGLRenderAction.getClassTypeId()):
            return
        self.drawing = False
        found, self.found = self.found, []
        if self.suspended:
            return
        state = action.getState()
        coin.SoCacheElement.invalidate(state)
        try:
            self._draw(state, found)
            self.error = None
        except Exception as error:
            if str(error) != self.error:
                App.Console.PrintError("Dupin: %s\n" % error)
            self.error = str(error)

    def _draw(self, state, found):
        context = QtGui.QOpenGLContext.currentContext()
        own = context is None or context is self._own_context()
        if own and context is not self.context:
            self._enter(context)
        if not found and not self.drawn:
            return
        if own and not self.drawn:
            self.drawn = Drawn()
        drawn = self.drawn if own else Drawn()  # of a picture that is saved: gone after it
        drawn.update(found)
        options = {"shading": self.shading, "edges": any(edges for _, _, edges in found), "sections": sections(state)}
        drawn.draw(camera(state), options, wait=not own)
        self.stats = drawn.stats
        self.frames += 1
        if own and drawn.waits_for:
            _watch.wake()

    def _own_context(self):
        return self.view.graphicsView().viewport().context()

    def _enter(self, context):
        if self.drawn:
            _lost.append(self.drawn)
        self.context, self.drawn = context, None
        if context is not None:
            context.aboutToBeDestroyed.connect(self._context_goes, QtCore.Qt.DirectConnection)

    def _context_goes(self):
        """The context goes, and what is in it. Without it being current nothing of it may be deleted."""
        if self.drawn:
            _lost.append(self.drawn)
        self.context, self.drawn = None, None

    # ---- pictures

    def save(self, path, factor=2):
        width, height = self.view.getSize()
        self.view.saveImage(path, factor * width, factor * height, "Current")

    def compare(self, folder):
        """Two pictures, of the tessellations and of the exact shapes, and how much they differ."""
        names = [os.path.join(folder, n) for n in ("tessellation.png", "exact.png")]
        width, height = self.view.getSize()
        there = [s for s in _shown.values() if s.hidden]
        self.suspended = True
        for shown in there:
            shown.show_tessellation()
        try:
            self.view.saveImage(names[0], width, height, "Current")
        finally:
            self.suspended = False
            for shown in there:
                shown.hide_tessellation()
        self.view.saveImage(names[1], width, height, "Current")
        return names, dupin.compare(*names)


class Closing(QtCore.QObject):
    """Sees a view's window close: afterwards FreeCAD crashes where one asks anything of the view."""

    def __init__(self, exact):
        super().__init__()
        self.exact, shown = exact, exact.view.graphicsView()
        windows = _area.subWindowList() + [w for w in QtGui.QApplication.topLevelWidgets() if w is not Gui.getMainWindow()]
        self.windows = [w for w in windows if w.isAncestorOf(shown)]
        for window in self.windows:
            window.installEventFilter(self)

    def eventFilter(self, window, event):
        if event.type() == QtCore.QEvent.Close and self.exact in _views:
            self.exact.leave()
            QtCore.QTimer.singleShot(CLOSED_MS, attach)  # if it did not close, or went on as a window of its own
        return False


def camera(state):
    """View and projection matrix and viewport of a traversal."""
    region = coin.SoViewportRegionElement.get(state)
    viewport = list(region.getViewportOriginPixels().getValue()) + list(region.getViewportSizePixels().getValue())
    return (matrix(coin.SoViewingMatrixElement.get(state)), matrix(coin.SoProjectionMatrixElement.get(state)), viewport)


def sections(state):
    """Coin's clipping planes: what is on the side of their normals stays."""
    planes = coin.SoClipPlaneElement.getInstance(state)
    found = [planes.get(i) for i in range(min(planes.getNum(), 6))]
    return [list(p.getNormal().getValue()) + [-p.getDistanceFromOrigin()] for p in found]


# ---- what is shown


def of(view):
    """The ExactView of one of FreeCAD's views."""
    graph = view.getSceneGraph()
    for own in _views:
        if own.graph == graph:
            return own
    _views.append(ExactView(view))
    return _views[-1]


def attach():
    """Every view of a document with exact objects draws them."""
    for name in {document for document, _ in _shown}:
        try:
            document = Gui.getDocument(name)
        except NameError:  # it is being closed
            continue
        for view in document.mdiViewsOfType("Gui::View3DInventor"):
            of(view)


def is_shown(obj):
    return key_of(obj) in _shown


def show(objects):
    """Draws these exactly, as soon as each is prepared."""
    for obj in objects:
        if not is_shown(obj):
            _shown[key_of(obj)] = Shown(obj)
            _watch.queue(_shown[key_of(obj)])
    attach()
    _watch.look()
    _watch.wake()


def hide(keys):
    """Draws these as FreeCAD does."""
    for key in keys:
        shown = _shown.pop(key, None)
        if shown:
            shown.drop_job()
            shown.show_tessellation()
    redraw()


def redraw():
    for view in _views:
        view.redraw()


def busy():
    """Whether anything is being prepared, or will be if the cameras rest."""
    return bool(_watch.waiting or any(s.job for s in _shown.values()) or any(v.drawn and v.drawn.waits_for for v in _views))


class Watch(QtCore.QObject):
    """Looks, while something is being prepared, whether it is done."""

    def __init__(self):
        super().__init__()
        self.waiting, self.taken = [], 0
        self.timer = QtCore.QTimer(self)
        self.timer.setInterval(20)
        self.timer.timeout.connect(self.look)

    def queue(self, shown):
        if shown not in self.waiting:
            self.waiting.append(shown)

    def wake(self):
        if not self.timer.isActive():
            self.timer.start()

    def look(self):
        ready = [s for s in _shown.values() if s.job and s.job.done]
        running = sum(1 for s in _shown.values() if s.job) - len(ready)
        if (running or self.waiting) and time.monotonic() < self.taken + TAKE_S:
            ready = []  # several together: every change of what is drawn is a frame
        for shown in ready:
            self._guard(shown, shown.take)
            self.taken = time.monotonic()
        while self.waiting and running < READERS:
            shown = self.waiting.pop(0)
            if shown.key in _shown:
                self._guard(shown, shown.start)
                running += 1
        for view in _views:
            if ready or (view.drawn and view.drawn.due()):
                view.redraw()
        if not busy():
            self.timer.stop()

    @staticmethod
    def _guard(shown, step):
        try:
            step()
        except Exception as error:
            App.Console.PrintError("Dupin: %s: %s\n" % (shown.obj.Label, error))
            hide([shown.key])


class Observer:
    """Follows what is changed in documents."""

    def slotChangedObject(self, obj, prop):
        shown = next((s for s in _shown.values() if s.obj is obj), None)
        if shown and prop == "Shape":
            shown.drop_job()
            shown.show_tessellation()  # the edited one, until the exact one is ready
            if obj.Shape.isNull() or not obj.Shape.Faces:
                hide([shown.key])
            else:
                _watch.queue(shown)
                _watch.wake()

    def slotDeletedObject(self, obj):
        hide([key for key, shown in _shown.items() if shown.obj is obj])

    def slotDeletedDocument(self, document):
        hide([key for key in _shown if key[0] == document.Name])


class ViewObserver:
    """Follows how objects look."""

    def slotChangedObject(self, view_object, prop):
        if prop not in ("ShapeColor", "DiffuseColor", "Transparency", "ShapeMaterial", "ShapeAppearance"):
            return
        # Not by what it shows: one that is just being made crashes FreeCAD where it is asked.
        shown = next((s for s in _shown.values() if s.obj.ViewObject is view_object), None)
        if shown and shown.prepared:
            if shown.look_again():
                _watch.queue(shown)
                _watch.wake()
            shown.touch()


_watch = Watch()
_observers = Observer(), ViewObserver()
App.addDocumentObserver(_observers[0])
Gui.addDocumentObserver(_observers[1])
_area = Gui.getMainWindow().findChild(QtGui.QMdiArea)
_area.subWindowActivated.connect(lambda _: attach())
