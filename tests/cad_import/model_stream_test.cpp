#include "../../cad_import/model_stream.h"

#include <gtest/gtest.h>

#include <cstring>

#include "allocation_watch.h"

namespace dupin {
namespace {

Surface patch() {
  BsplineSurface s;
  s.degree_u = 1, s.degree_v = 2;
  s.knots_u = {0, 0, 1, 1}, s.knots_v = {0, 0, 0, 2, 2, 2};
  s.count_u = 2, s.count_v = 3;
  for (int i = 0; i < 6; ++i) s.poles.push_back({i / 3 + 0.5, i % 3 * 1.0, i % 2 * 0.25});
  s.weights = {1, 0.5, 1, 1, 0.5, 1};
  return {s};
}

// Small, but with one of everything that a stream can hold.
Model one_of_everything() {
  Model model;
  model.source = "a.step", model.format = "STEP", model.unit_note = "mm";
  Part& part = model.parts.emplace_back();
  part.name = "part", part.color = Color{0.1f, 0.2f, 0.3f, 1};
  const Curve3 circle{CircleOf<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2}};
  const Curve3 line{LineOf<Vec3>{{0, 0, 0}, {1, 0, 0}}};
  const Curve3 spline{Bspline3{1, {0, 0, 1, 1}, {{0, 0, 0}, {1, 1, 1}}, {1, 2}, false}};
  part.surfaces = {Surface{Plane{}},
                   Surface{Cylinder{{}, 2}},
                   Surface{Cone{{}, 1, 0.5}},
                   Surface{Sphere{{}, 3}},
                   Surface{Torus{{}, 3, 1}},
                   patch(),
                   Surface{Revolution{{}, {0, 0, 1}, spline}},
                   Surface{Extrusion{circle, {0, 0, 1}}},
                   Surface{OffsetSurface{std::make_shared<const Surface>(patch()), 0.5}}};
  const Curve3 curves[] = {
      line,
      circle,
      Curve3{EllipseOf<Vec3>{{}, {1, 0, 0}, {0, 1, 0}, 2, 1}},
      Curve3{ParabolaOf<Vec3>{{}, {1, 0, 0}, {0, 1, 0}, 1}},
      Curve3{HyperbolaOf<Vec3>{{}, {1, 0, 0}, {0, 1, 0}, 2, 1}},
      spline,
      Curve3{OffsetCurveOf<Vec3>{std::make_shared<const Curve3>(circle), 0.5, {0, 0, 1}}}};
  for (const Curve3& curve : curves) part.edges.push_back({curve, 0, 1, 1e-7, false});
  part.edges.push_back({std::nullopt, 0, 1, 1e-7, true});
  Face& face = part.faces.emplace_back();
  face.uv_box = {{0, 0}, {1, 1}};
  face.tolerance = 1e-6, face.color = Color{1, 0, 0, 0.5f}, face.name = "face";
  const Vec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Loop loop;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % 4];
    loop.push_back({i, i == 2, i == 1, i == 3, Curve2{LineOf<Vec2>{i == 2 ? b : a, i == 2 ? a - b : b - a}}});
  }
  face.loops.push_back(loop);
  part.box.add(Vec3{-1, -2, -3}), part.box.add(Vec3{1, 2, 3});
  part.closed = true;
  part.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  part.mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  part.mesh.triangles = {0, 1, 2}, part.mesh.faces = {0}, part.mesh.origin = {1, 2, 3};
  PolygonMesh& polygons = part.polygons;
  polygons.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
  polygons.corners = {0, 1, 2, 3, 0, 1, 4}, polygons.starts = {0, 4, 7};
  polygons.normals = {{0, 0, 1}}, polygons.corner_normals = {0, 0, 0, 0, PolygonMesh::kNoNormal, 0, 0};
  polygons.colors.resize(5, Rgba8{1, 2, 3, 255}), polygons.polygon_colors = {{9, 8, 7, 6}, {5, 4, 3, 2}};
  polygons.groups = {{"a", Color{0, 0, 1, 1}}, {"b", std::nullopt}}, polygons.polygon_groups = {1, 0};
  polygons.tags.creases = {{0, 1, 2.5F}}, polygons.tags.corners = {{2, 10}}, polygons.tags.holes = {1};
  polygons.tags.boundary = SubdivisionTags::Boundary::edges, polygons.tags.chaikin = true;
  Instance& instance = model.instances.emplace_back();
  instance.to_world.translation = {4, 5, 6}, instance.color = Color{0, 1, 0, 1}, instance.name = "a/b";
  model.skipped.push_back({"face 2", "because", 3});
  model.notes = {"one", "two"};
  model.mesh_seconds = 0.5;
  return model;
}

// The header made right again, so that the damage reaches the decoder.
std::string resealed(std::string bytes) {
  const std::uint64_t length = bytes.size() - kModelStreamHeaderBytes;
  const std::uint64_t checksum = stream_checksum(std::span(bytes).subspan(kModelStreamHeaderBytes));
  std::memcpy(bytes.data() + 16, &length, 8);
  std::memcpy(bytes.data() + 24, &checksum, 8);
  return bytes;
}

TEST(ModelStream, ComesBackAsItWent) {
  const Model model = one_of_everything();
  ASSERT_TRUE(check(model).ok()) << check(model).message;
  const std::string bytes = write_model(model);
  const Result<Model> back = read_model(bytes);
  ASSERT_TRUE(back.ok()) << back.status().message;
  EXPECT_EQ(write_model(*back), bytes);
  EXPECT_EQ(back->parts[0].surfaces.size(), 9u);
  EXPECT_EQ(back->parts[0].edges[6].curve->geometry.index(), 6u);
  EXPECT_EQ(back->parts[0].faces[0].color, model.parts[0].faces[0].color);
  EXPECT_TRUE(back->parts[0].faces[0].loops[0][2].reversed);
  EXPECT_TRUE(back->parts[0].faces[0].loops[0][3].degenerate);
  EXPECT_EQ(back->instances[0].to_world, model.instances[0].to_world);
  EXPECT_EQ(back->skipped[0].count, 3u);
  EXPECT_EQ(back->notes, model.notes);
  EXPECT_EQ(back->parts[0].polygons.starts, model.parts[0].polygons.starts);
  EXPECT_EQ(back->parts[0].polygons.groups[0].color, model.parts[0].polygons.groups[0].color);
  EXPECT_EQ(back->parts[0].polygons.tags.corners[0].sharpness, 10);
  EXPECT_EQ(back->parts[0].mesh.triangles, model.parts[0].mesh.triangles);
}

TEST(ModelStream, EveryTruncationIsRefused) {
  const std::string bytes = write_model(one_of_everything());
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(read_model(std::span(bytes).first(n)).ok()) << n;
    if (n <= kModelStreamHeaderBytes) continue;
    EXPECT_FALSE(read_model(resealed(bytes.substr(0, n))).ok()) << n;
  }
  EXPECT_FALSE(read_model(resealed(bytes + '\0')).ok());
}

TEST(ModelStream, EveryFlippedByteIsNoticed) {
  std::string bytes = write_model(one_of_everything());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const int flip : {1, 0x80, 0xff}) {
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      EXPECT_FALSE(read_model(bytes).ok()) << i;
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
    }
}

TEST(ModelStream, DamageUnderARightChecksumNeverCrashesOrAllocatesMuch) {
  const std::string bytes = write_model(one_of_everything());
  int accepted = 0;
  test::watch_allocations();
  for (std::size_t i = kModelStreamHeaderBytes; i < bytes.size(); ++i)
    for (const int flip : {1, 2, 0x40, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      const Result<Model> model = read_model(resealed(damaged));
      if (!model.ok()) continue;
      ++accepted;  // a changed coordinate is a valid model; it must be usable
      EXPECT_TRUE(check(*model).ok());
    }
  EXPECT_GT(accepted, 0);
  EXPECT_LT(test::largest_allocation(), 4096 * sizeof(Face));
}

TEST(ModelStream, CountsBeyondTheEndAreNotBelieved) {
  const std::string bytes = write_model(one_of_everything());
  test::watch_allocations();
  for (std::size_t i = kModelStreamHeaderBytes; i + 8 <= bytes.size(); ++i) {
    std::string damaged = bytes;
    const std::uint64_t huge = 0x0000ffffffffffffu;
    std::memcpy(damaged.data() + i, &huge, 8);
    (void)read_model(resealed(damaged));
  }
  EXPECT_LT(test::largest_allocation(), 4096 * sizeof(Face));
}

TEST(ModelStream, NestingHasAnEnd) {
  Model model = one_of_everything();
  Surface surface = patch();
  for (int i = 0; i < kModelStreamMaxNesting + 2; ++i)
    surface = Surface{OffsetSurface{std::make_shared<const Surface>(surface), 0.1}};
  model.parts[0].surfaces.push_back(surface);
  EXPECT_FALSE(read_model(write_model(model)).ok());
}

TEST(ModelStream, AModelThatBreaksAnInvariantIsRefused) {
  Model model = one_of_everything();
  model.instances[0].part = 7;
  const Result<Model> back = read_model(write_model(model));
  ASSERT_FALSE(back.ok());
  EXPECT_EQ(back.status().code, StatusCode::unreadable);
}

}  // namespace
}  // namespace dupin
