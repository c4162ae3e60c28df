// Model: what it holds, and that every invariant that does not hold is found.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "../../nurbs/model.h"

namespace dupin {
namespace {

Trim side(std::uint32_t edge, bool reversed, Vec2 from, Vec2 to) {
  Trim trim;
  trim.edge = edge;
  trim.reversed = reversed;
  trim.pcurve = {LineOf<Vec2>{from, to - from}};
  return trim;
}

/// A unit square in a plane, twice instanced; an edge of it runs backwards.
Model square() {
  Part part;
  part.surfaces = {{Plane{}}};
  const Vec2 corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Face face;
  face.uv_box = {{0, 0}, {1, 1}};
  face.tolerance = 1e-7;
  face.loops.resize(1);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const bool reversed = i == 2;
    const Vec2 a = corners[reversed ? (i + 1) % 4 : i], b = corners[reversed ? i : (i + 1) % 4];
    part.edges.push_back({Curve3{LineOf<Vec3>{{a.x, a.y, 0}, {b.x - a.x, b.y - a.y, 0}}}, 0, 1, 1e-7, false});
    face.loops[0].push_back(side(i, reversed, a, b));
  }
  part.faces = {face};
  part.box = {{0, 0, 0}, {1, 1, 0}};
  Model model;
  model.parts = {part};
  model.instances.resize(2);
  model.instances[1].to_world.translation = {10, 0, 5};
  return model;
}

TEST(Model, CountsInstancesAndBoundsThem) {
  const Model model = square();
  EXPECT_EQ(face_instance_count(model), 2u);
  const Box3 box = bounding_box(model);
  EXPECT_EQ(box.lo, (Vec3{0, 0, 0}));
  EXPECT_EQ(box.hi, (Vec3{11, 1, 5}));
  EXPECT_TRUE(bounding_box(Model{}).empty());
  EXPECT_EQ(face_instance_count(Model{}), 0u);
}

TEST(ModelCheck, AcceptsAValidModel) {
  EXPECT_TRUE(check(square()).ok()) << check(square()).message;
  EXPECT_TRUE(check(Model{}).ok());
}

TEST(ModelCheck, AcceptsGapsWithinTheTolerance) {
  Model model = square();
  Face& face = model.parts[0].faces[0];
  face.tolerance = 1e-3;
  face.loops[0][0] = side(0, false, {0, 1e-3}, {1, 1e-3});
  EXPECT_TRUE(check(model).ok());
}

TEST(ModelCheck, AcceptsAPoleWhereOnlyParametersMove) {
  Model model = square();
  Part& part = model.parts[0];
  part.surfaces[0] = {Sphere{{}, 1}};
  // From the pole v = π/2 down a meridian and back up another: u jumps along the collapsed edge only.
  constexpr double kPole = 1.5707963267948966;
  Face& face = part.faces[0];
  face.uv_box = {{0, 0}, {1, kPole}};
  face.loops[0] = {side(0, false, {0, 0}, {1, 0}), side(1, false, {1, 0}, {1, kPole}),
                   side(2, false, {1, kPole}, {0, kPole}), side(3, false, {0, kPole}, {0, 0})};
  face.loops[0][2].degenerate = true;
  part.edges[2].curve.reset();
  EXPECT_TRUE(check(model).ok()) << check(model).message;
  face.loops[0].erase(face.loops[0].begin() + 2);
  EXPECT_FALSE(check(model).ok());
}

struct Damage {
  const char* message;  ///< part of what check says
  std::function<void(Model&)> apply;
};

Surface flat_spline() {
  BsplineSurface s;
  s.degree_u = s.degree_v = 1;
  s.count_u = s.count_v = 2;
  s.knots_u = s.knots_v = {0, 0, 1, 1};
  s.poles = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
  return {s};
}
BsplineSurface& with_spline(Model& m) {
  m.parts[0].surfaces[0] = flat_spline();
  return std::get<BsplineSurface>(m.parts[0].surfaces[0].geometry);
}
TriangleMesh& with_mesh(Model& m) {
  TriangleMesh& mesh = m.parts[0].mesh;
  mesh.positions = mesh.normals = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  mesh.triangles = {0, 1, 2};
  mesh.faces = {0};
  return mesh;
}
Surface offset_of(Surface s) {
  return {OffsetSurface{std::make_shared<const Surface>(std::move(s)), 1}};
}
LineOf<Vec3>& edge_line(Model& m) {
  return std::get<LineOf<Vec3>>(m.parts[0].edges[0].curve->geometry);
}

const double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Damage>& damages() {
  static const std::vector<Damage> kDamages = {
      {"no part", [](Model& m) { m.instances[0].part = 1; }},
      {"placement", [](Model& m) { m.instances[0].to_world.translation.x = kNan; }},
      {"placement", [](Model& m) { m.instances[0].to_world.linear.x = {}; }},
      {"no surface", [](Model& m) { m.parts[0].faces[0].surface = 7; }},
      {"no edge", [](Model& m) { m.parts[0].faces[0].loops[0][0].edge = 4; }},
      {"has no curve", [](Model& m) { m.parts[0].edges[1].curve.reset(); }},
      {"is empty", [](Model& m) { m.parts[0].faces[0].loops.emplace_back(); }},
      {"not closed",
       [](Model& m) {
         m.parts[0].faces[0].loops[0][0] = side(0, false, {0, 1e-3}, {1, 0});
       }},
      {"not closed", [](Model& m) { m.parts[0].faces[0].loops[0].pop_back(); }},
      {"not closed", [](Model& m) { m.parts[0].faces[0].loops[0][1].reversed = true; }},
      {"box is empty", [](Model& m) { m.parts[0].faces[0].uv_box = {}; }},
      {"tolerance", [](Model& m) { m.parts[0].faces[0].tolerance = kNan; }},
      {"tolerance", [](Model& m) { m.parts[0].edges[0].tolerance = -1; }},
      {"range is empty", [](Model& m) { m.parts[0].edges[0].t1 = 0; }},
      {"no direction", [](Model& m) { edge_line(m).direction = {}; }},
      {"no direction", [](Model& m) { edge_line(m).origin.z = kNan; }},
      {"perpendicular",
       [](Model& m) {
         m.parts[0].edges[0].curve = {CircleOf<Vec3>{{}, {1, 0, 0}, {1, 0, 0}, 1}};
       }},
      {"radius",
       [](Model& m) {
         m.parts[0].edges[0].curve = {CircleOf<Vec3>{{}, {1, 0, 0}, {0, 1, 0}, 0}};
       }},
      {"orthonormal",
       [](Model& m) {
         std::get<Plane>(m.parts[0].surfaces[0].geometry).frame.x = {2, 0, 0};
       }},
      {"radius",
       [](Model& m) {
         m.parts[0].surfaces[0] = {Sphere{{}, -1}};
       }},
      {"angle",
       [](Model& m) {
         m.parts[0].surfaces[0] = {Cone{{}, 1, 1.6}};
       }},
      {"major",
       [](Model& m) {
         m.parts[0].surfaces[0] = {Torus{{}, -1, 0.5}};
       }},
      {"axis", [](Model& m) { m.parts[0].surfaces[0] = {Revolution{}}; }},
      {"direction", [](Model& m) { m.parts[0].surfaces[0] = {Extrusion{}}; }},
      {"base", [](Model& m) { m.parts[0].surfaces[0] = {OffsetSurface{}}; }},
      {"base",
       [](Model& m) { m.parts[0].surfaces[0] = offset_of(offset_of(offset_of(offset_of({Plane{}})))); }},
      {"degree", [](Model& m) { with_spline(m).degree_u = 26; }},
      {"number of knots", [](Model& m) { with_spline(m).knots_v.push_back(1); }},
      {"decrease", [](Model& m) { with_spline(m).knots_u[1] = 2; }},
      {"domain",
       [](Model& m) {
         with_spline(m).knots_u = {0, 0, 0, 0};
       }},
      {"number of poles", [](Model& m) { with_spline(m).poles.pop_back(); }},
      {"too few", [](Model& m) { with_spline(m).count_u = -2; }},
      {"not finite", [](Model& m) { with_spline(m).poles[0].x = kNan; }},
      {"weight",
       [](Model& m) {
         with_spline(m).weights = {1, 1, 1, 0};
       }},
      {"weights",
       [](Model& m) {
         with_spline(m).weights = {1, 1, 1};
       }},
      {"refers to no point", [](Model& m) { with_mesh(m).triangles[0] = 3; }},
      {"refers to no face", [](Model& m) { with_mesh(m).faces[0] = 1; }},
      {"normals", [](Model& m) { with_mesh(m).normals.pop_back(); }},
      {"triangles", [](Model& m) { with_mesh(m).triangles.pop_back(); }},
      {"finite", [](Model& m) { with_mesh(m).positions[1][2] = std::numeric_limits<float>::infinity(); }}};
  return kDamages;
}

TEST(ModelCheck, FindsWhatDoesNotHold) {
  Model with_everything = square();
  with_spline(with_everything);
  with_mesh(with_everything);
  ASSERT_TRUE(check(with_everything).ok()) << check(with_everything).message;
  for (const Damage& damage : damages()) {
    Model model = square();
    damage.apply(model);
    const Status status = check(model);
    EXPECT_EQ(status.code, StatusCode::unreadable) << damage.message;
    EXPECT_NE(status.message.find(damage.message), std::string::npos)
        << damage.message << ": " << status.message;
  }
}

}  // namespace
}  // namespace dupin
