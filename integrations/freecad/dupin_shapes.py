"""Objects of FreeCAD's documents: which have shapes, how these look, and what Dupin reads of them."""
import io
import struct
import zipfile

import FreeCAD as App
from pivy import coin

CONSTRUCTION = ("PartDesign::Plane", "PartDesign::ShapeBinder", "PartDesign::SubShapeBinder", "PartDesign::CoordinateSystem")

DOCUMENT = """<?xml version="1.0"?><Document><Objects><Object type="Part::Feature" name="o"/></Objects><ObjectData><Object name="o">
<Properties><Property name="Shape" type="Part::PropertyPartShape"><Part file="s.%s"/></Property></Properties></Object></ObjectData></Document>"""
VIEW = """<?xml version="1.0"?><Document><ViewProviderData><ViewProvider name="o"><Properties>
<Property name="DiffuseColor" type="App::PropertyColorList"><ColorList file="c"/></Property>
<Property name="Transparency" type="App::PropertyPercent"><Integer value="%d"/></Property>
</Properties></ViewProvider></ViewProviderData></Document>"""


def has_faces(obj):
    """Whether it is a shape of its own, not one that is only for construction or a container of others."""
    if obj.TypeId in CONSTRUCTION or not getattr(obj, "ViewObject", None):
        return False
    if obj.TypeId == "PartDesign::Body" and getattr(obj.ViewObject, "DisplayModeBody", "") != "Tip":
        return False  # its tip is what is shown
    shape = getattr(obj, "Shape", None)
    return bool(shape) and not shape.isNull() and bool(shape.Faces) and not is_link(obj)


def is_link(obj):
    return obj.getLinkedObject(True) != obj


def below(obj):
    """The objects with faces that an object stands for: itself, what it links to, what it groups."""
    if is_link(obj):
        return below(obj.getLinkedObject(True))
    if has_faces(obj):
        return [obj]
    if obj.TypeId == "PartDesign::Body":
        return [obj.Tip] if obj.Tip and has_faces(obj.Tip) else []
    found = []
    for child in getattr(obj, "Group", []):
        found += [o for o in below(child) if o not in found]
    return found


def visible(obj):
    groups = [p for p in obj.InList if obj in getattr(p, "Group", [])]
    return bool(obj.ViewObject) and obj.ViewObject.Visibility and all(visible(p) for p in groups)


def shown(document):
    """The objects with faces that the document shows."""
    found = []
    for obj in document.Objects:
        if getattr(obj, "ViewObject", None) and (has_faces(obj) or is_link(obj)) and visible(obj):
            found += [o for o in below(obj) if o not in found]
    return found


def colors(obj):
    """One color, or one a face: red, green, blue as a screen shows them, and the transparency in percent."""
    view = obj.ViewObject
    transparency = int(getattr(view, "Transparency", 0))
    each = [tuple(c[:3]) for c in getattr(view, "DiffuseColor", [])]
    if len(each) > 1 and len(each) == len(obj.Shape.Faces) and len(set(each)) > 1:
        return each, transparency
    return [each[0] if each else tuple(getattr(view, "ShapeColor", (0.8, 0.8, 0.8))[:3])], transparency


def linear(color, transparency):
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color] + [1 - transparency / 100]


def file_of(obj, look):
    """The bytes of an FCStd file that holds the shape alone, as if it stood at the origin, and its colors face by face."""
    still = obj.Shape.copy()  # without its triangles
    still.Placement = App.Placement()
    each, transparency = look
    packed = [sum(int(round(255 * v)) << shift for v, shift in zip(c, (24, 16, 8))) for c in each]
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("Document.xml", DOCUMENT % "brp")
        archive.writestr("GuiDocument.xml", VIEW % transparency)
        archive.writestr("s.brp", still.exportBrepToString())
        archive.writestr("c", struct.pack("<%dI" % (1 + len(packed)), len(packed), *packed))
    return out.getvalue()


def face_groups(view_object):
    """The groups of the scene graph that show an object with its faces, each with whether they show its edges too, and whether
    another of them is in it: what shows edges has what shows faces alone."""
    groups, switch = [], view_object.SwitchNode
    for i in range(switch.getNumChildren()):
        group = switch.getChild(i)
        if group.isOfType(coin.SoGroup.getClassTypeId()) and holds(group, coin.SoIndexedFaceSet):
            groups.append(group)
    return [(g, holds(g, coin.SoIndexedLineSet), any(g.findChild(other) >= 0 for other in groups)) for g in groups]


def holds(group, kind):
    search = coin.SoSearchAction()
    search.setType(kind.getClassTypeId(), True)
    search.setSearchingAll(True)
    search.apply(group)
    return search.getPath() is not None
