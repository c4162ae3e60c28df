// Loops, pcurves, closed parts and the count of faces, against OCCT's classifiers.
#include <gtest/gtest.h>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <map>
#include <random>

#include "../../cad_import/reader/convert.h"
#include "files.h"
#include "occt_files.h"

namespace dupin::reader {
namespace {

using test::side_of_loops;

bool occt_inside(const TopoDS_Face& face, const Surface& surface, Vec2 q) {
  // OCCT's pcurves may lie whole periods from ours.
  const double turn_u = period_u(surface), turn_v = period_v(surface);
  for (int i = turn_u > 0 ? -1 : 0; i <= (turn_u > 0 ? 1 : 0); ++i)
    for (int j = turn_v > 0 ? -1 : 0; j <= (turn_v > 0 ? 1 : 0); ++j) {
      const BRepClass_FaceClassifier at(face, gp_Pnt2d(q.x + i * turn_u, q.y + j * turn_v), 1e-9);
      if (at.State() == TopAbs_IN) return true;
    }
  return false;
}

void expect_pcurves_on_curves(const Part& part, const Face& face) {
  const Surface& surface = part.surfaces[face.surface];
  const double size = part.box.diagonal();
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      EXPECT_EQ(trim.degenerate, !edge.curve);
      if (!edge.curve) continue;
      for (int i = 0; i <= 23; ++i) {  // not where the reader looked
        const double t = edge.t0 + (edge.t1 - edge.t0) * i / 23;
        const Vec2 q = point_at(trim.pcurve, t);
        EXPECT_LE(distance(point_at(surface, q.x, q.y), point_at(*edge.curve, t)),
                  edge.tolerance + 1e-9 * size);
      }
    }
}

// A seam runs twice, once each way; nothing else does.
void expect_seams_run_twice(const Face& face) {
  std::map<std::uint32_t, std::pair<int, int>> runs;
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop)
      if (!trim.degenerate) ++(trim.reversed ? runs[trim.edge].second : runs[trim.edge].first);
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop)
      if (trim.seam) {
        EXPECT_EQ(runs[trim.edge], std::pair(1, 1));
      }
}

void expect_same_region(const Part& part, const Face& face, const TopoDS_Face& shape, std::mt19937& random,
                        int& different, int& compared) {
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 8; ++i) {
    const Vec2 q =
        face.uv_box.lo + Vec2{face.uv_box.size().x * unit(random), face.uv_box.size().y * unit(random)};
    const int side = side_of_loops(part, face, q);
    if (side == 0) continue;
    ++compared;
    if ((side > 0) != occt_inside(shape, part.surfaces[face.surface], q)) ++different;
  }
}

void check_file(const std::string& path) {
  const auto document = test::read_document(path);
  ASSERT_TRUE(document);
  std::mt19937 random(3);
  int different = 0, compared = 0;
  for (const SourceItem& item : document->items) {
    const BuiltPart built = test::build(item.shape);
    for (std::size_t i = 0; i < built.part.faces.size(); ++i) {
      SCOPED_TRACE("face " + std::to_string(i));
      const Face& face = built.part.faces[i];
      expect_pcurves_on_curves(built.part, face);
      expect_seams_run_twice(face);
      if (!face.loops.empty())
        expect_same_region(built.part, face, built.shapes[i], random, different, compared);
    }
  }
  EXPECT_GT(compared, 0);
  // OCCT's classifier works with the file's own pcurves, ours may have been made anew.
  EXPECT_LE(different, compared / 500) << "of " << compared;
}

class Topology : public testing::TestWithParam<std::string> {};

TEST_P(Topology, RegionsAndPcurvesAreRight) {
  DUPIN_NEED_DATA(path, GetParam());
  check_file(path);
}

// Solids' volumes, and the count of faces wherever they are placed.
TEST_P(Topology, ClosedPartsAndFaceCountsAreRight) {
  DUPIN_NEED_DATA(path, GetParam());
  const auto document = test::read_document(path);
  ASSERT_TRUE(document);
  const Model model = convert(*document, {}, [](const char*, double) {});
  ASSERT_TRUE(check(model).ok()) << check(model).message;
  std::size_t faces = 0;
  for (const SourceItem& item : document->items)
    for (TopExp_Explorer e(item.shape, TopAbs_FACE); e.More(); e.Next()) ++faces;
  std::size_t skipped = 0;
  for (const SkippedFace& s : model.skipped) skipped += s.count;
  EXPECT_EQ(face_instance_count(model) + skipped, faces);
}
INSTANTIATE_TEST_SUITE_P(Files, Topology, testing::ValuesIn(test::varied_files()));

TEST(TopologyOfSamples, EverythingIsRight) {
  for (const char* name : {"bracket.step", "assembly.step", "freeform.step"}) {
    SCOPED_TRACE(name);
    check_file(test::sample(name));
    const auto document = test::read_document(test::sample(name));
    const Model model = convert(*document, {}, [](const char*, double) {});
    for (const Part& part : model.parts) EXPECT_TRUE(part.closed) << part.name;
  }
}

TEST(TopologyOfSamples, EdgesAreSharedByTheirFaces) {
  const auto document = test::read_document(test::sample("bracket.step"));
  const BuiltPart built = test::build(document->items.at(0).shape);
  std::map<std::uint32_t, int> uses;
  for (const Face& face : built.part.faces)
    for (const Loop& loop : face.loops)
      for (const Trim& trim : loop)
        if (!trim.degenerate) ++uses[trim.edge];
  for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2) << "edge " << edge;
}

TEST(TopologyOfSamples, SmoothEdgesAreThoseThatFilletsRunOutIn) {
  const auto document = test::read_document(test::sample("bracket.step"));
  const Part part = test::build(document->items.at(0).shape).part;
  int torus_smooth = 0, plane_plane_smooth = 0;
  std::map<std::uint32_t, std::vector<std::string>> kinds;
  for (const Face& face : part.faces)
    for (const Loop& loop : face.loops)
      for (const Trim& trim : loop) kinds[trim.edge].emplace_back(kind_name(part.surfaces[face.surface]));
  for (const auto& [edge, around] : kinds) {
    if (!part.edges[edge].smooth) continue;
    if (std::count(around.begin(), around.end(), "torus") == 1) ++torus_smooth;
    if (around == std::vector<std::string>{"plane", "plane"}) ++plane_plane_smooth;
  }
  EXPECT_GT(torus_smooth, 4);
  EXPECT_EQ(plane_plane_smooth, 0);
}

TEST(TopologyOfSamples, TheBoxHoldsTheFacesAndLittleElse) {
  for (const char* name : {"bracket.step", "freeform.step"}) {
    const auto document = test::read_document(test::sample(name));
    const Part part = test::build(document->items.at(0).shape).part;
    Box3 sampled;
    for (const Face& face : part.faces)
      for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
          const Vec2 q = face.uv_box.lo +
                         Vec2{face.uv_box.size().x * (i + 0.5) / 40, face.uv_box.size().y * (j + 0.5) / 40};
          if (side_of_loops(part, face, q) > 0) sampled.add(point_at(part.surfaces[face.surface], q.x, q.y));
        }
    for (int k = 0; k < 8; ++k) EXPECT_TRUE(part.box.contains(sampled.corner(k))) << name;
    EXPECT_LT(part.box.diagonal(), 1.06 * sampled.diagonal()) << name;
  }
}

}  // namespace
}  // namespace dupin::reader
