#include "repair.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <BRep_Tool.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Face.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

namespace dupin::reader {

std::vector<TopoDS_Face> repaired(const TopoDS_Face& face) {
  std::vector<TopoDS_Face> faces;
  try {
    // On a copy: healing changes edges in place, and the neighbours' are right as they are.
    BRepBuilderAPI_Copy copy(face.Oriented(TopAbs_FORWARD), false);
    const TopoDS_Shape own = copy.Shape();
    if (own.IsNull() || own.ShapeType() != TopAbs_FACE) return faces;
    ShapeFix_Face fix(TopoDS::Face(own));
    fix.SetContext(new ShapeBuild_ReShape);
    fix.SetPrecision(BRep_Tool::Tolerance(face));
    fix.Perform();
    const TopoDS_Shape result = fix.Context()->Apply(own);
    for (TopExp_Explorer e(result, TopAbs_FACE); e.More(); e.Next()) {
      // Splitting and healing may turn a face over; what they started from was FORWARD.
      const TopAbs_Orientation turned = TopAbs::Compose(face.Orientation(), e.Current().Orientation());
      faces.push_back(TopoDS::Face(e.Current().Oriented(turned)));
    }
  } catch (const Standard_Failure&) {
    faces.clear();
  }
  return faces;
}

}  // namespace dupin::reader
