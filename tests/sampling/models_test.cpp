// Whole models: nothing of a face is missing, nothing is drawn beside it, and no bound is violated, by dense
// sampling in double precision. A few models that between them have every kind of face; DUPIN_CHECK_ALL=1
// checks every file there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../../cad_import/cad_import.h"
#include "../../core/parallel.h"
#include "../../sampling/sampler.h"
#include "../cad_import/files.h"
#include "model_check.h"

namespace dupin {
namespace {

/// Certificates are mathematics in exact arithmetic; the comparison's own rounding gets this much.
constexpr double kSlack = 1 + 1e-3;

DpScene scene_of(const Model& model, double tolerance) {
  SamplingOptions options;
  options.tolerance = tolerance;
  options.normal_tolerance = 0.5 * 3.14159265358979323846 / 180;
  Result<DpScene> scene = sample_quadric_dps(model, options);
  EXPECT_TRUE(scene.ok()) << scene.status().message;
  return scene.ok() ? std::move(*scene) : DpScene{};
}

void check_model(const std::string& path) {
  SCOPED_TRACE(path);
  Result<Model> read = test::import_file(path);
  ASSERT_TRUE(read.ok()) << read.status().message;
  const Model& model = *read;
  const double tolerance = 2.5e-4 * bounding_box(model).diagonal();
  const DpScene scene = scene_of(model, tolerance);
  test::CheckOptions options;
  options.tolerance = options.margin = tolerance;
  options.points_per_face = 60;
  options.most_dps_per_face = 60;
  long points = 0;
  for (const test::FaceReport& r : test::check_scene(model, scene, options)) {
    points += r.points + r.drawn;
    const std::string where =
        "part " + std::to_string(r.part) + " face " + std::to_string(r.face) + " (" + r.kind + ")";
    EXPECT_EQ(r.uncovered, 0) << where << ": of " << r.points << " points";
    EXPECT_EQ(r.outside, 0) << where << ": of " << r.drawn << " drawn";
    if (r.dps > 0) {
      EXPECT_LE(r.worst_position, kSlack) << where;
      EXPECT_LE(r.worst_normal, kSlack) << where;
    }
  }
  EXPECT_GT(points, 100);
  EXPECT_LE(scene.bound, tolerance * kSlack);
}

class Samples : public ::testing::TestWithParam<const char*> {};
TEST_P(Samples, AreCoveredAndWithinTheirBounds) {
  check_model(test::sample(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Shipped, Samples,
                         ::testing::Values("bracket.step", "assembly.step", "freeform.step"),
                         [](const auto& i) {
                           std::string n = i.param;
                           return n.substr(0, n.find('.'));
                         });

class RealModels : public ::testing::TestWithParam<const char*> {};
TEST_P(RealModels, AreCoveredAndWithinTheirBounds) {
  DUPIN_NEED_DATA(path, GetParam());
  check_model(path);
}
INSTANTIATE_TEST_SUITE_P(
    Data, RealModels,
    ::testing::Values("cad/nist/nist_ctc_02_asme1_ap242.stp", "cad/freecad/as1-ac-214.stp",
                      "cad/occt/linkrods.step", "cad/occt/bearing.iges", "nurbs/converted/teapot.step",
                      "nurbs/converted/v1_Camera_visible.step", "nurbs/converted/v1_HumanHead1_visible.step",
                      "cad/occt/CrankArm.brep", "cad/occt/hammer.iges", "cad/occt/Motor-c.brep",
                      "cad/kicad/RV_Disc_D9mm_W4.1mm_P5mm.step", "cad/truck/abc-0008.step",
                      "cad/occt/screw.step", "nurbs/converted/v4_DinerMug.brep",
                      "nurbs/converted/v1_HumanHead2.brep", "nurbs/converted/v5_ring.brep"),
    [](const auto& i) {
      std::string n = std::filesystem::path(i.param).stem().string();
      std::replace_if(
          n.begin(), n.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return n;
    });

TEST(Scenes, DoNotDependOnTheNumberOfThreads) {
  Result<Model> read = test::import_file(test::sample("freeform.step"));
  ASSERT_TRUE(read.ok());
  const double tolerance = 1e-4 * bounding_box(*read).diagonal();
  set_thread_limit(1);
  const DpScene one = scene_of(*read, tolerance);
  set_thread_limit(4);
  const DpScene four = scene_of(*read, tolerance);
  set_thread_limit(0);
  ASSERT_EQ(one.count(), four.count());
  for (std::size_t p = 0; p < one.parts.size(); ++p)
    for (std::size_t i = 0; i < one.parts[p].dps.size(); ++i) {
      const QuadricDp &a = one.parts[p].dps[i], &b = four.parts[p].dps[i];
      EXPECT_TRUE(a.origin == b.origin && a.u == b.u && a.lambda_u == b.lambda_u &&
                  a.footprint == b.footprint && a.first_arc == b.first_arc && a.bound == b.bound);
    }
}

TEST(Scenes, AnalyticFacesTakeFewPrimitives) {
  Result<Model> read = test::import_file(test::sample("assembly.step"));
  ASSERT_TRUE(read.ok());
  const DpScene scene = scene_of(*read, 1e-3);
  std::vector<int> counts;
  for (std::size_t p = 0; p < read->parts.size(); ++p) {
    std::vector<int> of_face(read->parts[p].faces.size());
    for (const QuadricDp& dp : scene.parts[p].dps) ++of_face[dp.face];
    for (std::size_t f = 0; f < of_face.size(); ++f)
      if (is_quadric(read->parts[p].surfaces[read->parts[p].faces[f].surface])) counts.push_back(of_face[f]);
  }
  ASSERT_FALSE(counts.empty());
  std::nth_element(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2),
                   counts.end());
  EXPECT_LE(counts[counts.size() / 2], 2);
}

/// Cells at a collapsed side were once cut until they were specks, and so were spans that are nothing but
/// what a trim misses a knot by: 62 812 and 140 425 DPs for one face.
TEST(Scenes, CollapsedSidesAndSliversTakeFewCells) {
  for (const char* file : {"cad/occt/CrankArm.brep", "cad/nist/nist_ctc_02_asme1_ap203.stp"}) {
    DUPIN_NEED_DATA(path, file);
    Result<Model> read = test::import_file(path);
    ASSERT_TRUE(read.ok());
    const DpScene scene = scene_of(*read, 1e-4 * bounding_box(*read).diagonal());
    std::size_t specks = 0;
    for (const PartDps& part : scene.parts)
      specks += static_cast<std::size_t>(
          std::count_if(part.dps.begin(), part.dps.end(), [](const QuadricDp& dp) { return dp.speck; }));
    EXPECT_LE(scene.count(), 8000u) << file;
    EXPECT_LE(specks, 30u) << file;
  }
}

/// A camera close to a fillet asks for a tolerance a thousand times smaller there, and gets it.
TEST(Scenes, CloseUpsKeepTheBoundInPixels) {
  Result<Model> read = test::import_file(test::sample("freeform.step"));
  ASSERT_TRUE(read.ok());
  const Box3 box = bounding_box(*read);
  // A point of a face that is no quadric.
  Vec3 target{};
  for (const Part& part : read->parts)
    for (const Face& face : part.faces)
      if (!is_quadric(part.surfaces[face.surface]))
        target = point_at(part.surfaces[face.surface], face.uv_box.center().x, face.uv_box.center().y);
  for (double closer : {1.0, 30.0, 1000.0}) {
    SamplingOptions options;
    Camera camera;
    camera.target = target;
    camera.eye = target + Vec3{1, 0.7, 0.8} * (box.diagonal() / closer);
    options.camera = camera;
    Result<DpScene> scene = sample_quadric_dps(*read, options);
    ASSERT_TRUE(scene.ok());
    EXPECT_GT(scene->count(), 0u);
    EXPECT_LE(scene->bound_px, options.tolerance_px);
    EXPECT_LE(scene->normal_bound, options.normal_tolerance);
    EXPECT_LT(scene->count(), 60000u) << "what is out of the picture is not refined";
  }
}

TEST(Scenes, EveryFileThereIs) {
  if (!std::getenv("DUPIN_CHECK_ALL"))
    GTEST_SKIP() << "set DUPIN_CHECK_ALL=1 to check every model in $DUPIN_DATA (half an hour)";
  const char* data = std::getenv("DUPIN_DATA");
  if (!data) GTEST_SKIP() << "no $DUPIN_DATA";
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".step" || extension == ".stp" || extension == ".iges" || extension == ".igs" ||
        extension == ".brep")
      files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files)
    if (test::import_file(file).ok()) check_model(file);
}

}  // namespace
}  // namespace dupin
