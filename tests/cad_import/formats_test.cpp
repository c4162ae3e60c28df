// What arrives of each format: structure, names, colours, units, triangles.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../../cad_import/cad_import.h"
#include "../../cad_import/model_stream.h"
#include "../../core/parallel.h"
#include "files.h"

namespace dupin {
namespace {

using test::import_file;
using test::sample;

// The sRGB colours of samples/make_samples.cpp as linear light.
Color linear(int rgb) {
  const auto channel = [](int c) {
    const double s = c / 255.0;
    return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  };
  return {channel(rgb >> 16 & 255), channel(rgb >> 8 & 255), channel(rgb & 255), 1};
}
const Color kPaint = linear(0x2f6f8f), kBrass = linear(0xd6a84b), kSteel = linear(0xb4b9c0),
            kRed = linear(0xc8452f);

bool alike(const std::optional<Color>& a, const Color& b) {
  return a && std::abs(a->r - b.r) < 2e-3 && std::abs(a->g - b.g) < 2e-3 && std::abs(a->b - b.b) < 2e-3 &&
         a->a == b.a;
}

long count_faces(const Part& part, const Color& color) {
  return std::count_if(part.faces.begin(), part.faces.end(),
                       [&](const Face& f) { return alike(f.color, color); });
}

TEST(Formats, TheBracketIsOneClosedPartWithColouredFaces) {
  const Result<Model> model = import_file(sample("bracket.step"));
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->format, "STEP");
  EXPECT_EQ(model->source, "bracket.step");
  EXPECT_EQ(model->unit_note, "mm");
  EXPECT_TRUE(model->skipped.empty());
  ASSERT_EQ(model->parts.size(), 1u);
  const Part& part = model->parts[0];
  EXPECT_EQ(part.name, "bearing bracket");
  EXPECT_TRUE(part.closed);
  EXPECT_EQ(part.faces.size(), 49u);
  EXPECT_TRUE(alike(part.color, kPaint));
  EXPECT_EQ(count_faces(part, kBrass), 2);
  EXPECT_GT(count_faces(part, kSteel), 10);
  std::set<std::string_view> kinds;
  for (const Face& face : part.faces) kinds.insert(kind_name(part.surfaces[face.surface]));
  EXPECT_EQ(kinds, (std::set<std::string_view>{"plane", "cylinder", "cone", "torus"}));
  EXPECT_NEAR(bounding_box(*model).size().x, 110, 1e-5);
}

TEST(Formats, TheAssemblyStoresRepeatedPartsOnce) {
  const Result<Model> model = import_file(sample("assembly.step"));
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->parts.size(), 6u);
  EXPECT_EQ(model->instances.size(), 30u);
  EXPECT_EQ(face_instance_count(*model), 270u);
  std::map<std::string, int> placed;
  for (const Instance& instance : model->instances) ++placed[model->parts[instance.part].name];
  EXPECT_EQ(placed,
            (std::map<std::string, int>{
                {"flange", 2}, {"shaft", 2}, {"key", 2}, {"washer 8", 12}, {"bolt M8", 6}, {"nut M8", 6}}));
  const auto named = [&](const std::string& name) {
    return std::find_if(model->instances.begin(), model->instances.end(),
                        [&](const Instance& i) { return i.name == name; });
  };
  const auto nut = named("shaft coupling/fastener 4/nut"), key = named("shaft coupling/left key");
  ASSERT_NE(nut, model->instances.end());
  ASSERT_NE(key, model->instances.end());
  EXPECT_TRUE(alike(key->color, kRed));
  EXPECT_TRUE(alike(model->parts[key->part].color, kBrass));
  EXPECT_EQ(std::count_if(model->instances.begin(), model->instances.end(),
                          [](const Instance& i) { return i.color.has_value(); }),
            1);
  // The fourth fastener stands opposite the first: half a turn around the x axis.
  const auto first = named("shaft coupling/fastener 1/nut");
  ASSERT_NE(first, model->instances.end());
  EXPECT_NEAR(distance(first->to_world.translation, nut->to_world.translation), 68, 1e-9);
}

TEST(Formats, TheFreeformCoverIsClosed) {
  const Result<Model> model = import_file(sample("freeform.step"));
  ASSERT_TRUE(model.ok()) << model.status().message;
  ASSERT_EQ(model->parts.size(), 1u);
  EXPECT_TRUE(model->parts[0].closed);
  EXPECT_EQ(model->parts[0].faces.size(), 12u);
}

TEST(Formats, UnitsBecomeMillimetres) {
  DUPIN_NEED_DATA(inch, "cad/occt-import-js/cube-in.step");
  Box3 first;
  for (const char* name : {"in", "m", "mm"}) {
    const Result<Model> model =
        import_file(test::data(std::string("cad/occt-import-js/cube-") + name + ".step"));
    ASSERT_TRUE(model.ok()) << name;
    const Box3 box = bounding_box(*model);
    if (first.empty()) first = box;
    EXPECT_NEAR(distance(box.lo, first.lo) + distance(box.hi, first.hi), 0, 1e-5) << name;
    EXPECT_NEAR(box.size().x, 1000, 1e-5) << name;
  }
}

TEST(Formats, FilesWithoutAUnitAreInTheAssumedOne) {
  DUPIN_NEED_DATA(path, "cad/occt/screw.step");
  DUPIN_NEED_DATA(brep, "cad/occt/wedge_ok.brep");
  const auto size_in = [&](const std::string& file, const char* unit) {
    ImportOptions options;
    options.assumed_unit = unit;
    const Result<Model> model = import_cad(file, options);
    return model.ok() ? bounding_box(*model).diagonal() : -1;
  };
  EXPECT_NEAR(size_in(brep, "inch"), 25.4 * size_in(brep, "mm"), 1e-4);
  EXPECT_NEAR(size_in(brep, "um"), 1e-3 * size_in(brep, "mm"), 1e-9);
  EXPECT_EQ(size_in(path, "inch"), size_in(path, "mm")) << "STEP has units of its own";
  const Result<Model> model = import_file(brep);
  EXPECT_NE(model->unit_note.find("mm"), std::string::npos);
  EXPECT_NE(model->unit_note.find("no unit"), std::string::npos);
}

TEST(Formats, Iges) {
  DUPIN_NEED_DATA(path, "cad/freecad/SOD_323.igs");
  const Result<Model> model = import_file(path);
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->format, "IGES");
  EXPECT_GE(face_instance_count(*model) + model->skipped.size(), 75u);
  EXPECT_GT(std::count_if(model->parts[0].faces.begin(), model->parts[0].faces.end(),
                          [](const Face& f) { return alike(f.color, linear(0xcccccc)); }),
            10);
}

TEST(Formats, FcstdHasTheFacesColoursOfItsView) {
  DUPIN_NEED_DATA(path, "cad/occt-import-js/cube.FCStd");
  const Result<Model> model = import_file(path);
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->format, "FCStd");
  ASSERT_EQ(model->parts.size(), 1u);
  const Part& part = model->parts[0];
  EXPECT_EQ(part.name, "Cube");
  EXPECT_TRUE(part.closed);
  EXPECT_EQ(count_faces(part, linear(0x00ff00)) + count_faces(part, linear(0xff0000)) +
                count_faces(part, linear(0x0000ff)),
            2);
  EXPECT_EQ(count_faces(part, linear(0xcccccc)), 3);
  EXPECT_NEAR(bounding_box(*model).diagonal(), std::sqrt(300.0), 1e-5);
}

TEST(Formats, FcstdShowsABodyAndNotItsFeatures) {
  DUPIN_NEED_DATA(path, "cad/freecad/Drilling_1.FCStd");
  const Result<Model> model = import_file(path);
  ASSERT_TRUE(model.ok()) << model.status().message;
  ASSERT_EQ(model->instances.size(), 1u);
  EXPECT_EQ(face_instance_count(*model), 58u);
  EXPECT_EQ(model->parts[0].name, "Drilling1");  // the body's label
}

TEST(Formats, HiddenFcstdObjectsAreNoted) {
  DUPIN_NEED_DATA(path, "cad/freecad/strange_part_with_holes.fcstd");
  const Result<Model> model = import_file(path);
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->instances.size(), 1u);
  ASSERT_FALSE(model->notes.empty());
  EXPECT_NE(model->notes[0].find("hidden"), std::string::npos);
}

TEST(Formats, GzipOfAnything) {
  const std::string packed = test::scratch() + "/bracket.step.gz";
  const std::string content = test::read_file(sample("bracket.step"));
  gzFile out = ::gzopen(packed.c_str(), "wb");
  ASSERT_NE(out, nullptr);
  ::gzwrite(out, content.data(), static_cast<unsigned>(content.size()));
  ::gzclose(out);
  const Result<Model> model = import_file(packed);
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->format, "STEP");
  EXPECT_EQ(model->source, "bracket.step.gz");
  EXPECT_EQ(face_instance_count(*model), 49u);

  const std::string bytes = test::read_file(packed);
  const Status cut = import_file(test::write_file("cut.gz", bytes.substr(0, bytes.size() / 2))).status();
  EXPECT_EQ(cut.code, StatusCode::unreadable);
}

TEST(Formats, OldEuclidBrepFilesOfAnyName) {
  DUPIN_NEED_DATA(path, "cad/occt/EngineBlock.rle");
  const Result<Model> model = import_file(path);
  ASSERT_TRUE(model.ok()) << model.status().message;
  EXPECT_EQ(model->format, "BREP");
}

TEST(Formats, TheSameFileGivesTheSameModelAtAnyThreadCount) {
  std::string first;
  for (const int threads : {1, 2, 5}) {
    set_thread_limit(threads);
    Result<Model> model = import_file(sample("freeform.step"));
    ASSERT_TRUE(model.ok()) << model.status().message;
    const std::string bytes = write_model(*model);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads;
  }
  set_thread_limit(0);
}

TEST(Formats, TrianglesLieOnTheirFaces) {
  for (const char* name : {"bracket.step", "assembly.step", "freeform.step"}) {
    SCOPED_TRACE(name);
    ImportOptions options;
    options.mesh_deflection = 1e-3;
    const Result<Model> model = import_cad(sample(name), options);
    ASSERT_TRUE(model.ok()) << model.status().message;
    EXPECT_GT(model->mesh_seconds, 0);
    const double deflection = 1e-3 * bounding_box(*model).diagonal();
    for (const Part& part : model->parts) {
      const TriangleMesh& mesh = part.mesh;
      std::vector<int> triangles(part.faces.size(), 0);
      int turned = 0;
      for (std::size_t t = 0; t < mesh.faces.size(); ++t) {
        ++triangles[mesh.faces[t]];
        Vec3 corner[3], normal{};
        for (int k = 0; k < 3; ++k) {
          const auto& p = mesh.positions[mesh.triangles[3 * t + k]];
          const auto& n = mesh.normals[mesh.triangles[3 * t + k]];
          corner[k] = Vec3{p[0], p[1], p[2]} + mesh.origin;
          normal += Vec3{n[0], n[1], n[2]};
          EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-5);
        }
        const Vec3 flat = cross(corner[1] - corner[0], corner[2] - corner[0]);
        if (length(flat) > deflection * deflection && dot(normal, flat) < 0) ++turned;
      }
      EXPECT_EQ(turned, 0) << part.name;
      EXPECT_EQ(std::count(triangles.begin(), triangles.end(), 0), 0) << part.name;
      for (const auto& p : mesh.positions) {
        const Vec3 q = Vec3{p[0], p[1], p[2]} + mesh.origin;
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(q[k] > part.box.lo[k] - 0.01 && q[k] < part.box.hi[k] + 0.01);
      }
    }
  }
}

TEST(Formats, NoTrianglesUnlessAskedFor) {
  const Result<Model> model = import_file(sample("bracket.step"));
  ASSERT_TRUE(model.ok());
  EXPECT_TRUE(model->parts[0].mesh.positions.empty());
  EXPECT_EQ(model->mesh_seconds, 0);
}

}  // namespace
}  // namespace dupin
