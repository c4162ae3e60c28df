// Faces as files have them that were not made by a careful modeller: without seams, without boundaries,
// turned over.
#include <gtest/gtest.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <numbers>

#include "../../cad_import/reader/convert.h"
#include "../../cad_import/reader/part_checks.h"
#include "occt_files.h"

namespace dupin::reader {
namespace {

constexpr double kPi = std::numbers::pi;

// Of all faces together, by midpoint sums over the parameter box, to a few per cent: an oracle without any of
// the reader's own integration.
double area_of(const Part& part, int cells = 200) {
  double area = 0;
  for (const Face& face : part.faces)
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const Vec2 q = face.uv_box.lo + Vec2{face.uv_box.size().x * (i + 0.5) / cells,
                                             face.uv_box.size().y * (j + 0.5) / cells};
        if (!face.loops.empty() && test::side_of_loops(part, face, q) < 0) continue;
        const SurfaceJet s = evaluate(part.surfaces[face.surface], q.x, q.y, 1);
        area += length(cross(s.pu, s.pv)) * face.uv_box.size().x * face.uv_box.size().y / (cells * cells);
      }
  return area;
}

TEST(AwkwardFaces, PrimitivesAreClosedAndOutward) {
  const TopoDS_Shape shapes[] = {BRepPrimAPI_MakeBox(1, 2, 3).Shape(), BRepPrimAPI_MakeCylinder(1, 2).Shape(),
                                 BRepPrimAPI_MakeCone(2, 0, 3).Shape(), BRepPrimAPI_MakeSphere(1.5).Shape(),
                                 BRepPrimAPI_MakeTorus(3, 1).Shape()};
  const double volumes[] = {6, 2 * kPi, 4 * kPi, 4.5 * kPi, 6 * kPi * kPi};
  for (int i = 0; i < 5; ++i) {
    SCOPED_TRACE(i);
    const BuiltPart built = test::build(shapes[i]);
    EXPECT_TRUE(built.skipped.empty());
    EXPECT_TRUE(built.part.closed);
    std::vector<std::uint32_t> all(built.part.faces.size());
    for (std::uint32_t f = 0; f < all.size(); ++f) all[f] = f;
    EXPECT_NEAR(enclosed_volume(built.part, all).signed_volume, volumes[i], 1e-5 * volumes[i]);
    EXPECT_FALSE(test::build(shapes[i].Reversed()).part.closed) << "inside out";
  }
}

TEST(AwkwardFaces, ACylinderWithoutItsSeamGetsOne) {
  const Handle(Geom_CylindricalSurface) surface = new Geom_CylindricalSurface(gp_Ax3(), 2);
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, surface, 1e-7);
  for (const double z : {0.0, 3.0}) {
    const gp_Ax2 at(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1));
    TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(gp_Circ(at, 2)).Edge();
    builder.UpdateEdge(edge, new Geom2d_Line(gp_Pnt2d(0, z), gp_Dir2d(1, 0)), face, 1e-7);
    TopoDS_Wire wire;
    builder.MakeWire(wire);
    builder.Add(wire, edge.Oriented(z == 0 ? TopAbs_FORWARD : TopAbs_REVERSED));
    builder.Add(face, wire);
  }
  const BuiltPart built = test::build(face);
  ASSERT_EQ(built.part.faces.size(), 1u) << (built.skipped.empty() ? "" : built.skipped[0].reason);
  EXPECT_NEAR(area_of(built.part), 12 * kPi, 1);
  EXPECT_FALSE(built.notes.empty());
}

TEST(AwkwardFaces, FacesWithoutBoundaries) {
  BRep_Builder builder;
  TopoDS_Face sphere, torus, plane;
  builder.MakeFace(sphere, new Geom_SphericalSurface(gp_Ax3(), 2), 1e-7);
  builder.MakeFace(torus, new Geom_ToroidalSurface(gp_Ax3(), 5, 1), 1e-7);
  builder.MakeFace(plane, new Geom_Plane(gp_Ax3()), 1e-7);
  const BuiltPart whole_sphere = test::build(sphere), whole_torus = test::build(torus);
  ASSERT_EQ(whole_sphere.part.faces.size(), 1u);
  ASSERT_EQ(whole_torus.part.faces.size(), 1u);
  EXPECT_NEAR(area_of(whole_sphere.part), 16 * kPi, 0.1);
  EXPECT_NEAR(area_of(whole_torus.part), 20 * kPi * kPi, 0.2);
  EXPECT_TRUE(whole_sphere.part.closed);
  EXPECT_TRUE(whole_torus.part.closed);
  const BuiltPart endless = test::build(plane);
  ASSERT_EQ(endless.skipped.size(), 1u);
  EXPECT_NE(endless.skipped[0].reason.find("no boundary"), std::string::npos);
}

TEST(AwkwardFaces, AClockwiseBoundaryIsTurned) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 2);
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire();
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, new Geom_Plane(gp_Ax3()), 1e-7);
  builder.Add(face, wire.Reversed());
  const BuiltPart built = test::build(face);
  ASSERT_EQ(built.part.faces.size(), 1u);
  const Trim& trim = built.part.faces[0].loops.at(0).at(0);
  const Edge& edge = built.part.edges[trim.edge];
  EXPECT_TRUE(edge.curve);
  EXPECT_FALSE(trim.reversed);  // the circle itself runs counter-clockwise
}

TEST(AwkwardFaces, AHalfSphereByItsEquatorAlone) {
  const Handle(Geom_SphericalSurface) surface = new Geom_SphericalSurface(gp_Ax3(), 2);
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, surface, 1e-7);
  TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 2)).Edge();
  builder.UpdateEdge(edge, new Geom2d_Line(gp_Pnt2d(0, 0), gp_Dir2d(1, 0)), face, 1e-7);
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  builder.Add(wire, edge);
  builder.Add(face, wire);
  const BuiltPart built = test::build(face);
  ASSERT_EQ(built.part.faces.size(), 1u) << (built.skipped.empty() ? "" : built.skipped[0].reason);
  EXPECT_NEAR(area_of(built.part), 8 * kPi, 0.5);
}

TEST(AwkwardFaces, AnEdgeWithoutItsCurveInSpaceGetsOne) {
  // A cylinder's side from which the circles' curves are taken.
  TopoDS_Shape shape = BRepPrimAPI_MakeCylinder(2, 3).Shape();
  BRep_Builder builder;
  int taken = 0;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    if (BRepAdaptor_Curve(edge).GetType() != GeomAbs_Circle) continue;
    builder.UpdateEdge(edge, Handle(Geom_Curve)(), 1e-7);
    ++taken;
  }
  ASSERT_GT(taken, 0);
  const BuiltPart built = test::build(shape);
  EXPECT_EQ(built.part.faces.size(), 3u);
  for (const Face& face : built.part.faces)
    for (const Loop& loop : face.loops)
      for (const Trim& trim : loop) EXPECT_TRUE(built.part.edges[trim.edge].curve);
  EXPECT_FALSE(built.notes.empty());
  EXPECT_TRUE(built.part.closed);
}

SourceDocument document_of(const TopoDS_Shape& shape) {
  SourceDocument document{"test", "mm"};
  SourceItem item;
  item.shape = shape;
  item.part_name = "thing";
  document.items.push_back(item);
  return document;
}
const Stage kQuiet = [](const char*, double) {};

TEST(AwkwardFaces, RepeatedSolidsAreStoredOnce) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (int i = 0; i < 5; ++i) {
    gp_Trsf at;
    at.SetTranslation(gp_Vec(2 * i, 0, 0));
    builder.Add(compound, box.Moved(at));
  }
  builder.Add(
      compound,
      BRepBuilderAPI_MakeFace(gp_Pln(gp_Ax3(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1))), -1, 1, -1, 1).Face());
  const Model model = convert(document_of(compound), {}, kQuiet);
  ASSERT_EQ(model.parts.size(), 2u);
  EXPECT_EQ(model.instances.size(), 6u);
  EXPECT_EQ(face_instance_count(model), 31u);
  EXPECT_TRUE(model.parts[0].closed);
  EXPECT_FALSE(model.parts[1].closed);
  EXPECT_NEAR(bounding_box(model).hi.x, 9, 1e-6);
}

TEST(AwkwardFaces, AMirroredPlacementKeepsThePart) {
  SourceDocument document = document_of(BRepPrimAPI_MakeCone(2, 1, 3).Shape());
  document.items[0].placement.linear = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Model model = convert(document, {}, kQuiet);
  ASSERT_EQ(model.instances.size(), 1u);
  EXPECT_LT(determinant(model.instances[0].to_world.linear), 0);
  EXPECT_TRUE(model.parts[0].closed);
}

TEST(AwkwardFaces, AMirroredSolidIsStillOutward) {
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 0)));
  for (const TopoDS_Shape& shape :
       {BRepPrimAPI_MakeCone(2, 1, 3).Shape(), BRepPrimAPI_MakeTorus(3, 1, 2.0).Shape()}) {
    const BuiltPart built = test::build(BRepBuilderAPI_Transform(shape, mirror, true).Shape());
    EXPECT_TRUE(built.part.closed);
    EXPECT_TRUE(built.skipped.empty());
  }
}

TEST(AwkwardFaces, AWireWithItsEdgesInDisorderIsPutInOrder) {
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(2, 3).Shape();
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  for (TopExp_Explorer e(cylinder, TopAbs_FACE); e.More(); e.Next()) {
    TopoDS_Face face = TopoDS::Face(e.Current().EmptyCopied().Oriented(TopAbs_FORWARD));
    for (TopoDS_Iterator w(e.Current().Oriented(TopAbs_FORWARD)); w.More(); w.Next()) {
      std::vector<TopoDS_Shape> edges;
      for (TopoDS_Iterator i(w.Value()); i.More(); i.Next()) edges.push_back(i.Value());
      TopoDS_Wire wire;
      builder.MakeWire(wire);
      // Seam, seam, circle, circle: an order in which nothing follows on.
      std::stable_sort(edges.begin(), edges.end(),
                       [](const auto& a, const auto& b) { return a.TShape().get() < b.TShape().get(); });
      for (const TopoDS_Shape& edge : edges) builder.Add(wire, edge);
      builder.Add(face, wire);
    }
    builder.Add(faces, face.Oriented(e.Current().Orientation()));
  }
  const BuiltPart built = test::build(faces);
  EXPECT_EQ(built.part.faces.size(), 3u);
  EXPECT_TRUE(built.part.closed);
  EXPECT_NEAR(area_of(built.part), 20 * kPi, 1);
}

}  // namespace
}  // namespace dupin::reader
