// Our curves and surfaces against OCCT's own evaluators, on every face and edge of real and shipped files.
#include <gtest/gtest.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

#include <random>

#include "../../cad_import/reader/geometry.h"
#include "../../cad_import/reader/topology.h"
#include "files.h"
#include "occt_files.h"

namespace dupin::reader {
namespace {

// Differences relative to the values' own size and that of their neighbourhood.
void compare(const Vec3& ours, const gp_XYZ& theirs, double scale, double tolerance, const char* what) {
  EXPECT_LE(distance(ours, to_vec(theirs)), tolerance * scale) << what;
}

void compare_surface(const Surface& surface, const Face& face, const TopoDS_Face& shape,
                     std::mt19937& random) {
  const BRepAdaptor_Surface theirs(shape, false);
  std::uniform_real_distribution<double> unit(0, 1);
  const Box2& box = face.uv_box;
  for (int i = 0; i < 12; ++i) {
    // Corners on purpose, then anywhere inside.
    const double a = i < 4 ? i % 2 : unit(random), b = i < 4 ? i / 2 : unit(random);
    const double u = box.lo.x + a * box.size().x, v = box.lo.y + b * box.size().y;
    gp_Pnt p;
    gp_Vec du, dv, duu, dvv, duv;
    try {
      theirs.D2(u, v, p, du, dv, duu, dvv, duv);
    } catch (const Standard_Failure&) {
      continue;  // a singular point of an offset: OCCT has no answer to compare with
    }
    const SurfaceJet s = evaluate(surface, u, v, 2);
    const double size = length(s.p) + box.size().x * length(s.pu) + box.size().y * length(s.pv) + 1e-3;
    compare(s.p, p.XYZ(), size, 1e-12, "point");
    if (i < 4)
      continue;  // a corner may lie on a knot, where OCCT may take the derivatives from the other side
    const double first = length(s.pu) + length(s.pv) + 1e-9 * size,
                 second = length(s.puu) + length(s.puv) + length(s.pvv);
    compare(s.pu, du.XYZ(), first, 1e-9, "Su");
    compare(s.pv, dv.XYZ(), first, 1e-9, "Sv");
    const double shortest = std::min(box.size().x, box.size().y),
                 rates = second + first / shortest + size / (shortest * shortest);
    compare(s.puu, duu.XYZ(), rates, 1e-8, "Suu");
    compare(s.puv, duv.XYZ(), rates, 1e-8, "Suv");
    compare(s.pvv, dvv.XYZ(), rates, 1e-8, "Svv");
  }
}

void compare_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    const Edge ours = to_edge(edge);
    if (BRep_Tool::Degenerated(edge)) {
      EXPECT_FALSE(ours.curve);
      continue;
    }
    if (!ours.curve) continue;  // edges that have pcurves only are made from those, and tested there
    const BRepAdaptor_Curve theirs(edge);
    EXPECT_EQ(ours.t0, theirs.FirstParameter());
    EXPECT_EQ(ours.t1, theirs.LastParameter());
    for (int k = 0; k <= 8; ++k) {
      const double t = ours.t0 + (ours.t1 - ours.t0) * k / 8;
      gp_Pnt p;
      gp_Vec d;
      theirs.D1(t, p, d);
      const CurveJet<Vec3> c = evaluate(*ours.curve, t, 1);
      const double size = length(c[0]) + (ours.t1 - ours.t0) * length(c[1]) + 1e-3;
      compare(c[0], p.XYZ(), size, 1e-12, "curve");
      compare(c[1], d.XYZ(), length(c[1]) + 1e-9 * size, 1e-9, "tangent");
    }
  }
}

void compare_file(const std::string& path) {
  const std::optional<SourceDocument> document = test::read_document(path);
  ASSERT_TRUE(document) << path;
  std::mt19937 random(7);
  std::size_t faces = 0;
  for (const SourceItem& item : document->items) {
    const BuiltPart built = test::build(item.shape);
    for (std::size_t i = 0; i < built.part.faces.size(); ++i, ++faces) {
      SCOPED_TRACE("face " + std::to_string(faces));
      const Face& face = built.part.faces[i];
      compare_surface(built.part.surfaces[face.surface], face, built.shapes[i], random);
      EXPECT_EQ(face.reversed, built.shapes[i].Orientation() == TopAbs_REVERSED);
    }
    compare_edges(item.shape);
  }
  EXPECT_GT(faces, 0u);
}

class Evaluators : public testing::TestWithParam<std::string> {};

TEST_P(Evaluators, AgreeWithOcct) {
  DUPIN_NEED_DATA(path, GetParam());
  compare_file(path);
}
INSTANTIATE_TEST_SUITE_P(Files, Evaluators, testing::ValuesIn(test::varied_files()));

TEST(EvaluatorsOfSamples, AgreeWithOcct) {
  for (const char* name : {"bracket.step", "assembly.step", "freeform.step"})
    compare_file(test::sample(name));
}

}  // namespace
}  // namespace dupin::reader
