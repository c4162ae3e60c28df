// Parameters and curvatures of pixels against closed forms of the torus, and a spline's own points.
#include <cmath>

#include "../../render/view.h"
#include "../../sampling/sampler.h"
#include "device.h"

namespace dupin::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMajor = 3, kMinor = 1;

Model one_face(Surface surface, const Box2& uv_box, const Box3& box) {
  Model model;
  Part& part = model.parts.emplace_back();
  part.surfaces.push_back(std::move(surface));
  Face& face = part.faces.emplace_back();
  face.uv_box = uv_box;
  part.box = box;
  return model;
}

Box3 box_of(const Vec3& lo, const Vec3& hi) {
  Box3 box;
  box.add(lo);
  box.add(hi);
  return box;
}
Box2 box_of(Vec2 lo, Vec2 hi) {
  Box2 box;
  box.add(lo);
  box.add(hi);
  return box;
}

Model torus() {
  Torus geometry;
  geometry.major = kMajor, geometry.minor = kMinor;
  return one_face({geometry}, box_of(Vec2{0, 0}, Vec2{2 * kPi, 2 * kPi}),
                  box_of(Vec3{-4, -4, -1}, Vec3{4, 4, 1}));
}

/// Its triangles, coarse, in place of DPs.
void mesh_torus(Part& part, int n) {
  TriangleMesh& mesh = part.mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = 2 * kPi * i / n, v = 2 * kPi * j / n;
      const SurfaceJet jet = evaluate(part.surfaces[0], u, v, 1);
      const Vec3 normal = normalized(cross(jet.pu, jet.pv));
      const auto floats = [](const Vec3& p) {
        return std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y),
                                    static_cast<float>(p.z)};
      };
      mesh.positions.push_back(floats(jet.p));
      mesh.normals.push_back(floats(normal));
      const auto at = [n](int k, int l) { return static_cast<std::uint32_t>(k % n * n + l % n); };
      for (const std::uint32_t c :
           {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
        mesh.triangles.push_back(c);
      mesh.faces.insert(mesh.faces.end(), 2, 0);
    }
}

/// A bicubic patch that bulges and dips, over [0,1]².
Model bumpy() {
  BsplineSurface s;
  s.degree_u = s.degree_v = 3;
  s.knots_u = s.knots_v = {0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  s.count_u = s.count_v = 5;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) s.poles.push_back({i * 1.0, j * 1.0, 0.7 * std::sin(2.1 * i + 1.3 * j * j)});
  return one_face({s}, box_of(Vec2{0, 0}, Vec2{1, 1}), box_of(Vec3{0, 0, -0.7}, Vec3{4, 4, 0.7}));
}

void place(Model& model, const Affine3& to_world) {
  model.instances.emplace_back();
  model.instances.back().to_world = to_world;
}
Affine3 scaled(double scale, bool mirrored) {
  Affine3 a = rigid({1, 2, -1}, 0.8, {});
  a.linear = a.linear * Mat3{{mirrored ? -scale : scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
  a.translation = {20, -7, 3};
  return a;
}

struct Drawn {
  Frame frame;
  Camera camera;
};
Drawn draw(const Model& model, bool triangles = false) {
  Drawn drawn;
  Camera settings;
  settings.width = 240, settings.height = 200;
  Box3 box;
  for (const Instance& instance : model.instances)
    box.add(transform_box(instance.to_world, model.parts[0].box));
  drawn.camera = *fit_view(box, "iso", settings);
  SamplingOptions sampling;
  sampling.camera = drawn.camera;
  const auto dps = sample_quadric_dps(model, sampling);
  EXPECT_TRUE(dps.ok()) << dps.status().message;
  TestDevice gl;
  const auto scene = gl.renderer->upload(model, triangles ? nullptr : &*dps);
  EXPECT_TRUE(scene.ok()) << scene.status().message;
  DrawOptions options;
  options.outputs = kEverything | kUv;
  options.exact_model = &model;
  drawn.frame = gl.draw(**scene, drawn.camera, options);
  return drawn;
}

/// Calls f(pixel, parameters, drawn point in the part's space) on every covered pixel; all of them have
/// parameters.
template <class F>
int for_pixels(const Drawn& drawn, const Model& model, F&& f) {
  const Frame& frame = drawn.frame;
  const Affine3 to_part = inverse(model.instances[0].to_world);
  int covered = 0;
  for (std::size_t i = 0; i < frame.face.size(); ++i) {
    if (frame.face[i] == 0) {
      EXPECT_TRUE(std::isnan(frame.uv[2 * i]));
      continue;
    }
    ++covered;
    const Vec2 q{frame.uv[2 * i], frame.uv[2 * i + 1]};
    const Vec3 p{frame.position[3 * i], frame.position[3 * i + 1], frame.position[3 * i + 2]};
    if (!std::isfinite(q.x + q.y)) return ADD_FAILURE() << "pixel " << i << " has no parameters", covered;
    f(i, q, transform_point(to_part, p));
  }
  return covered;
}

/// The edge of the farthest covered pixel.
double pixel_size_at(const Frame& frame) {
  double largest = 0;
  for (const float z : frame.depth)
    if (std::isfinite(z)) largest = std::max(largest, frame.pixel_constant + frame.pixel_per_depth * z);
  return largest;
}

class PlacedTorus : public ::testing::TestWithParam<std::tuple<double, bool, bool>> {};

TEST_P(PlacedTorus, HasTheParametersAndCurvaturesOfItsClosedForm) {
  const auto [scale, mirrored, triangles] = GetParam();
  Model model = torus();
  place(model, scaled(scale, mirrored));
  if (triangles) mesh_torus(model.parts[0], 96);
  const Drawn drawn = draw(model, triangles);
  const double off = triangles ? 2e-3 : 2e-2 * pixel_size_at(drawn.frame) / scale;
  const int covered = for_pixels(drawn, model, [&](std::size_t i, Vec2 q, const Vec3& p) {
    const double ring = std::hypot(p.x, p.y) - kMajor;
    EXPECT_NEAR(std::remainder(q.x - std::atan2(p.y, p.x), 2 * kPi), 0, 1e-4);
    EXPECT_NEAR(std::remainder(q.y - std::atan2(p.z, ring), 2 * kPi), 0, 1e-4);
    EXPECT_NEAR(std::hypot(ring, p.z), kMinor, std::max(off, 0.01));
    // Outward normals: it bends away from them.
    const double meridian = -1 / kMinor / scale,
                 parallel = -std::cos(q.y) / (kMajor + kMinor * std::cos(q.y)) / scale;
    EXPECT_NEAR(drawn.frame.curvature[2 * i], meridian, 1e-5 / scale);
    EXPECT_NEAR(drawn.frame.curvature[2 * i + 1], parallel, 1e-5 / scale);
    // The meridian's direction.
    const Vec3 along{-std::sin(q.y) * std::cos(q.x), -std::sin(q.y) * std::sin(q.x), std::cos(q.y)};
    const Vec3 expected = normalized(model.instances[0].to_world.linear * along);
    const Vec3 d{drawn.frame.direction[3 * i], drawn.frame.direction[3 * i + 1],
                 drawn.frame.direction[3 * i + 2]};
    EXPECT_NEAR(std::abs(dot(d, expected)), 1, 1e-6);
  });
  EXPECT_GT(covered, 5000);
}
INSTANTIATE_TEST_SUITE_P(ExactPixels, PlacedTorus,
                         ::testing::Values(std::tuple(1.0, false, false), std::tuple(2.5, true, false),
                                           std::tuple(0.4, false, false), std::tuple(1.0, true, true)));

TEST(ExactPixels, ASplinesPointAtAPixelsParametersIsThePointDrawn) {
  Model model = bumpy();
  place(model, scaled(1.5, false));
  const Drawn drawn = draw(model);
  const double pixel = pixel_size_at(drawn.frame) / 1.5;
  const int covered = for_pixels(drawn, model, [&](std::size_t, Vec2 q, const Vec3& p) {
    // Half a pixel is what the DPs are allowed.
    EXPECT_LE(length(point_at(model.parts[0].surfaces[0], q.x, q.y) - p), 0.55 * pixel);
  });
  EXPECT_GT(covered, 5000);
}

TEST(ExactPixels, AStretchedSurfacesCurvaturesAreThoseOfTheStretchedSurface) {
  // z = (x² a + y² b) / 2 as a spline, stretched along x and z, at its vertex.
  BsplineSurface s;
  s.degree_u = s.degree_v = 2;
  s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
  s.count_u = s.count_v = 3;
  const double a = 0.3, b = -0.2, x[] = {-1, 0, 1}, square[] = {1, -1, 1};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s.poles.push_back({x[i], x[j], (a * square[i] + b * square[j]) / 2});
  Model model = one_face({s}, box_of(Vec2{0, 0}, Vec2{1, 1}), box_of(Vec3{-1, -1, -0.5}, Vec3{1, 1, 0.5}));
  Affine3 stretched;
  stretched.linear = {{2, 0, 0}, {0, 1, 0}, {0, 0, 3}};
  place(model, stretched);
  Drawn drawn = draw(model);
  int at_vertex = 0;
  for (std::size_t i = 0; i < drawn.frame.face.size(); ++i) {
    if (drawn.frame.face[i] == 0 ||
        std::hypot(drawn.frame.uv[2 * i] - 0.5, drawn.frame.uv[2 * i + 1] - 0.5) > 0.01)
      continue;
    ++at_vertex;
    EXPECT_NEAR(drawn.frame.curvature[2 * i], 3 * b, 2e-3);
    EXPECT_NEAR(drawn.frame.curvature[2 * i + 1], 3 * a / 4, 2e-3);
    EXPECT_NEAR(std::abs(drawn.frame.direction[3 * i + 1]), 1, 1e-3);
  }
  EXPECT_GT(at_vertex, 0);
}

TEST(ExactPixels, ColorsOfCurvaturesAreTheSameOnDpsAndOnTriangles) {
  Model model = torus();
  place(model, scaled(1, false));
  mesh_torus(model.parts[0], 200);
  Camera settings;
  settings.width = 160, settings.height = 120;
  const Camera camera =
      *fit_view(transform_box(model.instances[0].to_world, model.parts[0].box), "iso", settings);
  SamplingOptions sampling;
  sampling.camera = camera;
  const auto dps = sample_quadric_dps(model, sampling);
  TestDevice gl;
  for (const int samples : {1, 3}) {
    DrawOptions options;
    options.outputs = kScreen;
    options.shading = Shading::mean;
    options.edges = false;
    options.samples = samples;
    options.exact_model = &model;
    const auto by_dps = gl.renderer->upload(model, &*dps), by_triangles = gl.renderer->upload(model, nullptr);
    const Frame a = gl.draw(**by_dps, camera, options), b = gl.draw(**by_triangles, camera, options);
    int different = 0;
    for (std::size_t i = 0; i < a.screen.size(); ++i) different += std::abs(a.screen[i] - b.screen[i]) > 3;
    EXPECT_LT(different, 300) << "of " << a.screen.size();  // at the outline
    options.exact_model = nullptr;
    EXPECT_NE(gl.draw(**by_triangles, camera, options).screen, b.screen);
  }
}

TEST(ExactPixels, ParametersNeedTheModel) {
  Model model = torus();
  place(model, {});
  const auto dps = sample_quadric_dps(model, {.tolerance = 0.01});
  TestDevice gl;
  const auto scene = gl.renderer->upload(model, &*dps);
  DrawOptions options;
  options.outputs = kUv;
  Camera camera;
  EXPECT_EQ(gl.renderer->draw(**scene, camera, options).status().code, StatusCode::invalid_argument);
  Model other;
  options.exact_model = &other;
  EXPECT_EQ(gl.renderer->draw(**scene, camera, options).status().code, StatusCode::invalid_argument);
}

}  // namespace
}  // namespace dupin::testing
