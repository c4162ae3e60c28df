// Domains in pictures, beside the same surface as triangles.
#include <cmath>

#include "../../render/domain_prefixes.h"
#include "../../render/view.h"
#include "../../simplify/point_sources.h"
#include "../simplify/meshes.h"
#include "device.h"

namespace dupin::testing {
namespace {

constexpr int kSize = 200;

Model model_of(const PolygonMesh& mesh) {
  Model model;
  Part& part = model.parts.emplace_back();
  part.polygons = mesh;
  part.box = bounding_box(mesh);
  model.instances.emplace_back();
  return model;
}

Model bumpy_ball() {
  PolygonMesh mesh = test::ball(24);
  for (Vec3& p : mesh.positions) p = p * (1 + 0.1 * std::sin(7 * p.x) * std::sin(5 * p.y + 1));
  mesh.normals.clear();
  return model_of(mesh);
}

/// Levels with about so many domains each.
std::vector<DomainSet> levels_of(const Part& part, const std::vector<double>& counts) {
  const SurfacePoints points = *mesh_points(part);
  const Result<DomainBases> bases = decompose(points, {});
  if (!bases) throw std::runtime_error(bases.status().message);
  std::vector<DomainSet> sets;
  for (const double count : counts) {
    std::size_t level = 0;
    while (level + 1 < bases->levels() && bases->domains(level) < count) ++level;
    sets.push_back(*make_domain_set(points, *bases, level, {}));
  }
  return sets;
}

Camera looking(double distance, double angle = 0.4) {
  Camera camera;
  camera.eye = {distance * std::cos(angle), distance * std::sin(angle), 0.4 * distance};
  camera.width = camera.height = kSize;
  return camera;
}

DrawOptions everything() {
  DrawOptions options;
  options.outputs = kEverything;
  return options;
}

struct Drawn {
  TestDevice gl;
  DomainScene domains;
  std::unique_ptr<Scene> scene;

  Drawn(const Model& model, std::vector<DomainSet> levels, DomainContent content = {}) {
    domains.parts.resize(model.parts.size());
    domains.parts[0] = std::move(levels);
    content.scene = &domains;
    SceneContent all;
    all.domains = content;
    auto made = gl.renderer->upload(model, all);
    EXPECT_TRUE(made.ok()) << made.status().message;
    scene = std::move(*made);
  }
  Frame draw(const Camera& camera, const DrawOptions& options = everything()) {
    return gl.draw(*scene, camera, options);
  }
};

Frame as_triangles(const Model& model, const Camera& camera) {
  TestDevice gl;
  auto scene = gl.renderer->upload(model, static_cast<const DpScene*>(nullptr));
  EXPECT_TRUE(scene.ok());
  return gl.draw(**scene, camera, everything());
}

struct Difference {
  double coverage = 0;  ///< pixels that only one covers, as a part of those of the first
  double color = 0;     ///< root of the mean square, where both cover
  double normal = 0;    ///< degrees, mean
  double depth = 0;     ///< 95 of 100 are within, in pixels
};
Difference difference(const Frame& a, const Frame& b, const Camera& camera) {
  double both = 0, one = 0, first = 0, color = 0, normal = 0;
  std::vector<double> depths;
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    const bool in_a = std::isfinite(a.depth[i]), in_b = std::isfinite(b.depth[i]);
    first += in_a, one += in_a != in_b;
    if (!in_a || !in_b) continue;
    ++both;
    double cosine = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      color += std::pow(a.color[4 * i + k] - b.color[4 * i + k], 2);
      cosine += a.normal[3 * i + k] * b.normal[3 * i + k];
    }
    normal += std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / 3.14159265358979;
    depths.push_back(std::abs(a.depth[i] - b.depth[i]) / pixel_size(camera, a.depth[i]));
  }
  if (both == 0) return {1, 1, 180, 1e9};
  std::sort(depths.begin(), depths.end());
  return {one / first, std::sqrt(color / (3 * both)), normal / both, depths[depths.size() * 95 / 100]};
}

TEST(DomainLayer, LooksLikeTheSurface) {
  const Model model = bumpy_ball();
  for (const bool parallel : {false, true}) {
    Camera camera = looking(6);
    camera.orthographic = parallel, camera.ortho_height = 3;
    Drawn drawn(model, levels_of(model.parts[0], {150}));
    const Frame frame = drawn.draw(camera);
    const Difference d = difference(as_triangles(model, camera), frame, camera);
    EXPECT_LT(d.coverage, 0.03);
    EXPECT_LT(d.color, 0.05);
    EXPECT_LT(d.normal, 5);
    EXPECT_LT(d.depth, 3);
    EXPECT_GT(frame.stats.primitives, 50U);
    EXPECT_LT(frame.stats.primitives, 600U);
  }
}

TEST(DomainLayer, NormalMapsHeightsAndBlendingEachHelp) {
  const Model model = bumpy_ball();
  const Camera camera = looking(6);
  const Frame triangles = as_triangles(model, camera);
  const std::vector<DomainSet> levels = levels_of(model.parts[0], {100});
  const auto of = [&](const DomainContent& content) {
    Drawn drawn(model, levels, content);
    return difference(triangles, drawn.draw(camera), camera);
  };
  DomainContent flat_shaded, flat, opaque;
  flat_shaded.normal_maps = false;
  flat.heights = false;
  opaque.blend = DomainBlend::opaque;
  const Difference best = of({});
  EXPECT_LT(best.color, 0.6 * of(flat_shaded).color);
  EXPECT_LT(best.coverage, 0.7 * of(flat).coverage);
  EXPECT_LE(best.normal, of(opaque).normal);
}

TEST(DomainLayer, DrawsTheCoarsestLevelThatIsFineEnough) {
  const Model model = bumpy_ball();
  Drawn drawn(model, levels_of(model.parts[0], {20, 200}));
  const std::uint64_t coarse = drawn.domains.parts[0][0].primitives.size(),
                      fine = drawn.domains.parts[0][1].primitives.size();
  ASSERT_LT(coarse, fine);
  EXPECT_EQ(drawn.draw(looking(3)).stats.primitives, fine);
  EXPECT_EQ(drawn.draw(looking(2000)).stats.primitives, coarse);
  Camera away = looking(6);
  away.target = {12, 6, 4};
  EXPECT_EQ(drawn.draw(away).stats.primitives, 0U);
}

TEST(DomainLayer, IsCutBySections) {
  const Model model = bumpy_ball();
  const std::vector<DomainSet> levels = levels_of(model.parts[0], {150});
  for (const DomainBlend blend : {DomainBlend::surface, DomainBlend::published}) {
    DomainContent content;
    content.blend = blend;
    Drawn drawn(model, levels, content);
    const Camera camera = looking(6, 0);
    DrawOptions options = everything();
    options.sections.push_back({{0, 1, 0}, 0});
    const Frame frame = drawn.draw(camera, options);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      if (!std::isfinite(frame.depth[i])) continue;
      ++seen;
      ASSERT_GT(frame.position[3 * i + 1], -1e-3);
    }
    EXPECT_GT(seen, 1000U);
  }
}

TEST(DomainLayer, IsPlacedScaledAndNumbered) {
  Model model = bumpy_ball();
  model.instances.emplace_back();
  model.instances[0].to_world.translation = {0, -1.5, 0};
  model.instances[1].to_world.linear = {{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}};
  model.instances[1].to_world.translation = {0, 1.5, 0};
  Drawn drawn(model, levels_of(model.parts[0], {150}));
  Camera camera = looking(8, 0);
  const Frame frame = drawn.draw(camera), triangles = as_triangles(model, camera);
  const Difference d = difference(triangles, frame, camera);
  EXPECT_LT(d.coverage, 0.03);
  EXPECT_LT(d.normal, 6);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    if (!std::isfinite(frame.depth[i])) continue;
    if (std::isfinite(triangles.depth[i])) {
      ASSERT_EQ(frame.face[i], triangles.face[i]);
    }
    ASSERT_GE(frame.primitive[i], 1U);
    ASSERT_LE(frame.primitive[i], 2 * drawn.domains.parts[0][0].primitives.size());
  }
}

TEST(DomainLayer, BlendsAndLocksAsPublished) {
  const Model model = bumpy_ball();
  DomainContent content;
  content.blend = DomainBlend::published;
  const std::vector<DomainSet> levels = levels_of(model.parts[0], {300});
  for (const bool parallel : {false, true}) {
    Drawn drawn(model, levels, content);
    Camera camera = looking(6);
    camera.orthographic = parallel, camera.ortho_height = 3;
    const Frame frame = drawn.draw(camera), again = drawn.draw(camera),
                triangles = as_triangles(model, camera);
    const Difference d = difference(triangles, frame, camera);
    EXPECT_LT(d.coverage, 0.1) << "its named faults are at contours";
    EXPECT_LT(d.normal, 8);
    EXPECT_LT(d.color, 0.25);
    EXPECT_EQ(frame.color, again.color);
    EXPECT_EQ(frame.primitive, again.primitive);
  }
}

TEST(DomainPrefixes, AreDrawnFrontToBackEachWithItsNeighbors) {
  // 2 is in front with neighbor 0; 3 looks away; 1 is alone at the back.
  const PrefixPlan plan = plan_prefixes({{5, true, {2, 3}}, {9, true, {}}, {1, true, {0}}, {2, false, {0}}});
  EXPECT_EQ(plan.order, (std::vector<std::uint32_t>{2, 0, 1}));
  ASSERT_EQ(plan.steps.size(), 3U);
  EXPECT_EQ(plan.steps[0].count, 2U);
  EXPECT_EQ(plan.steps[0].lock, 0U);
  EXPECT_EQ(plan.steps[1].count, 0U) << "drawn already: only locked";
  EXPECT_EQ(plan.steps[1].lock, 1U);
  EXPECT_EQ(plan.steps[2].count, 1U);
  EXPECT_TRUE(plan_prefixes({}).steps.empty());
}

TEST(DomainLayer, RefusesDomainsOfAnotherModel) {
  const Model model = bumpy_ball();
  TestDevice gl;
  DomainScene none;
  SceneContent content;
  content.domains.scene = &none;
  EXPECT_EQ(gl.renderer->upload(model, content).status().code, StatusCode::invalid_argument);
}

}  // namespace
}  // namespace dupin::testing
