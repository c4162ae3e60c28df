// Point trees in pictures: beside the same meshes as triangles, and beside everything else that a scene
// holds.
#include "../../render/tree_layer.h"

#include <cmath>
#include <numbers>

#include "../../core/parallel.h"
#include "../../render/gl.h"
#include "../../render/view.h"
#include "../simplify/meshes.h"
#include "device.h"

namespace dupin::testing {
namespace {

constexpr int kSize = 200;

PolygonMesh bumpy(int rings, double radius = 1) {
  PolygonMesh mesh = test::ball(rings);
  for (Vec3& p : mesh.positions)
    p = p * (radius * (1 + 0.15 * std::sin(7 * p.x) * std::sin(5 * p.y + 1) + 0.05 * std::sin(31 * p.z)));
  mesh.normals.clear();
  return mesh;
}

Model model_of(const PolygonMesh& mesh) {
  Model model;
  Part& part = model.parts.emplace_back();
  part.polygons = mesh;
  part.box = bounding_box(mesh);
  model.instances.emplace_back();
  return model;
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

/// A model's meshes as trees, on a device of its own.
struct Drawn {
  TestDevice gl;
  std::unique_ptr<TreeLayers> layers;
  std::unique_ptr<Scene> scene;

  Drawn(const Model& model, const TreeLayerOptions& options, PointTreeKind kind = PointTreeKind::pop,
        const DpScene* dps = nullptr) {
    std::vector<PartTree> trees;
    PointTreeOptions build;
    build.kind = kind;
    for (const Part& part : model.parts) {
      PartTree& tree = trees.emplace_back();
      tree.first_face = static_cast<std::uint32_t>(part.faces.size());
      if (!part.polygons.empty()) tree.tree = *build_point_tree(part.polygons, build);
    }
    layers = std::make_unique<TreeLayers>(trees, options);
    auto made = gl.renderer->upload(model, SceneContent{dps, {layers->layer()}});
    EXPECT_TRUE(made.ok()) << made.status().message;
    scene = std::move(*made);
  }
  Frame draw(const Camera& camera, const DrawOptions& options = everything()) {
    return gl.draw(*scene, camera, options);
  }
};

Frame as_triangles(const Model& model, const Camera& camera, const DrawOptions& options = everything()) {
  TestDevice gl;
  auto scene = gl.renderer->upload(model, static_cast<const DpScene*>(nullptr));
  EXPECT_TRUE(scene.ok());
  return gl.draw(**scene, camera, options);
}

struct Difference {
  double coverage = 0;  ///< pixels that only one covers, as a part of those of the first
  double color = 0;     ///< root of the mean square over pixels that both cover
  double depth = 0;     ///< the largest but for a hundredth, in pixels
};
Difference difference(const Frame& a, const Frame& b, const Camera& camera) {
  std::size_t both = 0, one = 0, first = 0;
  double sum = 0;
  std::vector<double> depths;
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    const bool in_a = std::isfinite(a.depth[i]), in_b = std::isfinite(b.depth[i]);
    first += in_a, one += in_a != in_b;
    if (!in_a || !in_b) continue;
    ++both;
    for (std::size_t k = 0; k < 3; ++k) sum += std::pow(a.color[4 * i + k] - b.color[4 * i + k], 2);
    depths.push_back(std::abs(a.depth[i] - b.depth[i]) / pixel_size(camera, a.depth[i]));
  }
  std::sort(depths.begin(), depths.end());
  return {static_cast<double>(one) / static_cast<double>(std::max<std::size_t>(1, first)),
          std::sqrt(sum / (3.0 * static_cast<double>(std::max<std::size_t>(1, both)))),
          depths.empty() ? 0 : depths[depths.size() * 99 / 100]};
}

TEST(TreeLayer, NearIsAsItsTriangles) {
  const Model model = model_of(bumpy(40));
  for (const bool parallel : {false, true}) {
    Camera camera = looking(3.5);
    camera.orthographic = parallel, camera.ortho_height = 2.5;
    Drawn drawn(model, {});
    const Frame frame = drawn.draw(camera), triangles = as_triangles(model, camera);
    EXPECT_GT(drawn.layers->stats().triangles, 1000u);
    const Difference d = difference(triangles, frame, camera);
    EXPECT_LT(d.coverage, 1e-3);
    EXPECT_LT(d.color, 2e-3);
    EXPECT_LT(d.depth, 0.05);
  }
}

TEST(TreeLayer, SectionsCutPointsAndTriangles) {
  const Model model = model_of(bumpy(40));
  DrawOptions options = everything();
  options.sections = {{{1, 0.3, 0.2}, -0.1}, {{-0.2, 1, 0.5}, 0.3}};
  for (const double distance : {3.5, 40.0}) {
    const Camera camera = looking(distance);
    const Frame frame = Drawn(model, {}).draw(camera, options);
    const Frame whole = Drawn(model, {}).draw(camera);
    const Frame triangles = as_triangles(model, camera, options);
    EXPECT_LT(difference(triangles, frame, camera).coverage, distance < 10 ? 0.002 : 0.12) << distance;
    EXPECT_GT(difference(whole, frame, camera).coverage, 0.1) << distance;
    for (std::size_t i = 0; i < frame.depth.size(); ++i)
      if (std::isfinite(frame.depth[i])) {
        const Vec3 p{frame.position[3 * i], frame.position[3 * i + 1], frame.position[3 * i + 2]};
        for (const auto& s : options.sections) EXPECT_GT(dot(s.normal, p) + s.offset, -0.01 * distance);
      }
  }
}

TEST(TreeLayer, FarIsPointsThatLookLikeItsTriangles) {
  const Model model = model_of(test::ball(160));
  const Camera camera = looking(12);
  TreeLayerOptions options;
  options.threshold_px = 1.5;
  Drawn drawn(model, options);
  const Frame frame = drawn.draw(camera), triangles = as_triangles(model, camera);
  const TreeLayerStats stats = drawn.layers->stats();
  EXPECT_GT(stats.points, 1500u);
  EXPECT_LT(stats.triangles, stats.points);
  const Difference d = difference(triangles, frame, camera);
  EXPECT_LT(d.coverage, 0.05) << "half a pixel of the silhouette";
  EXPECT_LT(d.color, 0.02);
  EXPECT_LT(d.depth, 3);
  // No holes: of the pixels that triangles cover none is left out.
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    EXPECT_FALSE(std::isfinite(triangles.depth[i]) && !std::isfinite(frame.depth[i])) << i;
}

TEST(TreeLayer, AQSplatTreeCoversWhatItsTrianglesCover) {
  const Model model = model_of(bumpy(60));
  const Camera camera = looking(4);
  Drawn drawn(model, {}, PointTreeKind::qsplat);
  const Frame frame = drawn.draw(camera), triangles = as_triangles(model, camera);
  EXPECT_EQ(drawn.layers->stats().triangles, 0u);
  std::size_t holes = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    holes += std::isfinite(triangles.depth[i]) && !std::isfinite(frame.depth[i]);
  EXPECT_LT(holes, 20u) << "spheres that touch along edges leave little of a triangle's middle";
}

TEST(TreeLayer, PointsOfSeveralPixelsShadeSmoothly) {
  const Model model = model_of(test::ball(160));
  const Camera camera = looking(5);
  const Frame triangles = as_triangles(model, camera);
  for (const bool reconstruct : {false, true}) {
    TreeLayerOptions options;
    options.threshold_px = 7, options.reconstruct = reconstruct;
    Drawn drawn(model, options);
    const Frame frame = drawn.draw(camera);
    EXPECT_GT(drawn.layers->stats().points, 10 * drawn.layers->stats().triangles);
    // Without differentials, or without reconstruction, each point would be flat: 0.03.
    EXPECT_LT(difference(triangles, frame, camera).color, 0.013) << reconstruct;
  }
}

/// Discs that are narrow where they are seen at a slant keep to the outline, and leave no hole.
TEST(TreeLayer, PointsKeepToTheOutlineWithoutHoles) {
  for (const Model& model : {model_of(test::ball(160)), model_of(bumpy(200))})
    for (const bool parallel : {false, true}) {
      Camera camera = looking(5);
      camera.orthographic = parallel, camera.ortho_height = 2.6;
      const Frame triangles = as_triangles(model, camera);
      const auto outside = [&](bool foreshortened) {
        TreeLayerOptions options;
        options.threshold_px = 8, options.foreshortened = foreshortened;
        Drawn drawn(model, options);
        const Frame frame = drawn.draw(camera);
        EXPECT_GT(drawn.layers->stats().points, 10 * drawn.layers->stats().triangles);
        std::size_t more = 0;
        for (std::size_t i = 0; i < frame.depth.size(); ++i) {
          const bool covered = std::isfinite(frame.depth[i]), expected = std::isfinite(triangles.depth[i]);
          EXPECT_FALSE(expected && !covered) << i;
          more += covered && !expected;
        }
        return more;
      };
      EXPECT_LT(5 * outside(true), 3 * outside(false));
    }
}

TEST(TreeLayer, CoherentFramesAreTheFreshOnes) {
  const Model model = model_of(bumpy(60));
  TreeLayerOptions options;
  options.threshold_px = 2;
  Drawn coherent(model, options);
  options.coherent = false;
  TreeLayers fresh({{*build_point_tree(model.parts[0].polygons, {}), 0}}, options);
  const auto scene = coherent.gl.renderer->upload(model, SceneContent{nullptr, {fresh.layer()}});
  ASSERT_TRUE(scene.ok());
  DrawOptions draw;
  draw.outputs = kColor | kPrimitive;
  for (int frame = 0; frame < 12; ++frame) {
    const Camera camera = looking(5 - 0.03 * frame, 0.02 * frame);
    const Frame a = coherent.draw(camera, draw), b = coherent.gl.draw(**scene, camera, draw);
    ASSERT_EQ(a.primitive, b.primitive) << "frame " << frame;
    ASSERT_EQ(a.color, b.color) << "frame " << frame;
  }
  EXPECT_LT(coherent.layers->stats().visited, fresh.stats().visited / 2);
}

/// Three in a row from the viewer away, and more around, of a mesh that is taken apart for walking.
Model crowd() {
  Model model = model_of(bumpy(60));
  const Instance one = model.instances[0];
  model.instances.clear();
  for (int i = 0; i < 36; ++i) {
    model.instances.push_back(one);
    model.instances.back().to_world.translation = {1.6 * (i % 4), 1.6 * (i / 4 % 3), 1.6 * (i / 12)};
  }
  return model;
}

TEST(TreeLayer, WhatNearerPlacementsHideIsLeftOutAndNotMissed) {
  const Model model = crowd();
  for (const bool parallel : {false, true})
    for (const bool reconstruct : {false, true}) {
      TreeLayerOptions options;
      options.threshold_px = 3, options.reconstruct = reconstruct;
      Drawn hiding(model, options);
      options.occlusion = false;
      TreeLayers all_drawn({{*build_point_tree(model.parts[0].polygons, {}), 0}}, options);
      const auto scene = hiding.gl.renderer->upload(model, SceneContent{nullptr, {all_drawn.layer()}});
      ASSERT_TRUE(scene.ok());
      for (int frame = 0; frame < 4; ++frame) {
        Camera camera = looking(9 - 1.5 * frame, 0.3 * frame);
        camera.target = {2.4, 1.6, 1.6};
        camera.orthographic = parallel, camera.ortho_height = 6;
        const Frame a = hiding.draw(camera), b = hiding.gl.draw(**scene, camera, everything());
        EXPECT_EQ(a.primitive, b.primitive) << frame;
        EXPECT_EQ(a.color, b.color) << frame;
        EXPECT_EQ(a.depth, b.depth) << frame;
        EXPECT_EQ(a.face, b.face) << frame;
        const TreeLayerStats some = hiding.layers->stats(), all = all_drawn.stats();
        EXPECT_LT(some.points + some.triangles, all.points + all.triangles) << frame;
      }
      EXPECT_GT(hiding.layers->stats().hidden, 0u);
      EXPECT_EQ(all_drawn.stats().hidden, 0u);
    }
}

TEST(TreeLayer, ThreadsAndRunsDoNotMatter) {
  const Model model = model_of(bumpy(60));
  TreeLayerOptions options;
  options.threshold_px = 3;
  Drawn drawn(model, options);
  const Frame several = drawn.draw(looking(4));
  set_thread_limit(1);
  Drawn again(model, options);
  const Frame one = again.draw(looking(4));
  set_thread_limit(0);
  EXPECT_EQ(one.color, several.color);
  EXPECT_EQ(one.depth, several.depth);
  EXPECT_EQ(one.primitive, several.primitive);
}

TEST(TreeLayer, PlacementsHaveTheirOwnFacesColoursAndPrimitives) {
  PolygonMesh mesh = bumpy(40, 0.3);
  mesh.groups = {{"upper", Color{1, 0, 0, 1}}, {"lower", Color{0, 0, 1, 1}}};
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    mesh.polygon_groups.push_back(mesh.positions[mesh.corners[i]].z > 0 ? 0 : 1);
  Model model = model_of(mesh);
  for (int i = 0; i < 2; ++i) {
    if (i > 0) model.instances.push_back(model.instances[0]);
    model.instances.back().to_world.translation = {0, i == 0 ? -0.5 : 0.5, 0};
  }
  // The second is stretched and mirrored.
  model.instances[1].to_world.linear = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1.5}};
  Camera camera;
  camera.eye = {4, 0, 0}, camera.width = camera.height = kSize;
  Drawn drawn(model, {});
  const Frame frame = drawn.draw(camera);
  const auto at = [&](double y, double z) {
    const double pixel = pixel_size(camera, 4);
    return static_cast<std::size_t>(kSize / 2 - z / pixel) * kSize +
           static_cast<std::size_t>(kSize / 2 + y / pixel);
  };
  const std::size_t left_up = at(-0.5, 0.15), left_down = at(-0.5, -0.15), right_up = at(0.5, 0.15),
                    right_down = at(0.5, -0.15);
  EXPECT_EQ(frame.face[left_up], 1u);
  EXPECT_EQ(frame.face[left_down], 2u);
  EXPECT_EQ(frame.face[right_up], 3u);
  EXPECT_EQ(frame.face[right_down], 4u);
  EXPECT_GT(frame.color[4 * left_up], 4 * frame.color[4 * left_up + 2]);
  EXPECT_GT(frame.color[4 * right_down + 2], 4 * frame.color[4 * right_down]);
  EXPECT_GT(frame.normal[3 * right_up], 0.5F) << "outwards, though mirrored";
  const auto primitives = static_cast<std::uint32_t>(drawn.scene->info().primitives);
  EXPECT_LE(frame.primitive[left_up], primitives);
  EXPECT_GT(frame.primitive[right_up], primitives);
  EXPECT_EQ(drawn.scene->info().placed_primitives, 2 * primitives);
  const Difference d = difference(as_triangles(model, camera), frame, camera);
  EXPECT_LT(d.coverage, 0.02);
}

TEST(TreeLayer, WhatAHostHidesColorsAndMovesIsFollowed) {
  PolygonMesh mesh = bumpy(40, 0.5);
  mesh.colors.assign(mesh.positions.size(), {0, 255, 0, 255});
  mesh.groups.resize(2);
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    mesh.polygon_groups.push_back(mesh.positions[mesh.corners[i]].z > 0 ? 0 : 1);
  Camera camera;
  camera.eye = {4, 0, 0}, camera.width = camera.height = kSize;
  const auto pixel = [&](double z) {
    return static_cast<std::size_t>(kSize / 2 - z / pixel_size(camera, 4)) * kSize + kSize / 2;
  };
  Drawn drawn(model_of(mesh), {});
  const std::size_t up = pixel(0.25), down = pixel(-0.25);
  const Frame before = drawn.draw(camera);
  EXPECT_GT(before.color[4 * up + 1], 4 * before.color[4 * up]) << "the vertices' green";
  drawn.scene->set_visible(0, false, 0);
  drawn.scene->set_color(0, Color{1, 0, 0, 1}, 1);
  const Frame half = drawn.draw(camera);
  EXPECT_TRUE(std::isinf(half.depth[pixel(0.45)]));
  EXPECT_EQ(half.face[down], 2u);
  EXPECT_GT(half.color[4 * down], 4 * half.color[4 * down + 1]);
  drawn.scene->set_visible(0, false);
  EXPECT_EQ(drawn.draw(camera).stats.covered_pixels, 0u);
  drawn.scene->reset_looks();
  EXPECT_EQ(drawn.draw(camera).color, before.color);
  Affine3 aside;
  aside.translation = {0, 0, 10};
  drawn.scene->place(0, aside);
  EXPECT_EQ(drawn.draw(camera).stats.covered_pixels, 0u);
  drawn.scene->place(0, {});
  EXPECT_EQ(drawn.draw(camera).color, before.color);
}

TEST(TreeLayer, HidesAndIsHiddenByDps) {
  HandMade made;
  made.add(plane_rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4));
  made.model.parts.resize(2);
  made.dps.parts.resize(2);
  made.model.parts[1].polygons = test::ball(30, 0.8);
  made.model.parts[1].box = bounding_box(made.model.parts[1].polygons);
  for (std::uint32_t i = 0; i < 2; ++i) {
    made.model.instances.emplace_back();
    made.model.instances.back().part = i;
  }
  Camera camera;
  camera.eye = {0, 0, 6}, camera.up = {0, 1, 0}, camera.width = camera.height = kSize;
  Drawn drawn(made.model, {}, PointTreeKind::pop, &made.dps);
  const Frame above = drawn.draw(camera);
  const std::size_t middle = kSize / 2 * kSize + kSize / 2, side = kSize / 2 * kSize + kSize / 2 + 70;
  EXPECT_NEAR(above.depth[middle], 6 - 0.8, 1e-3) << "the ball's top is above the plate";
  EXPECT_EQ(above.face[middle], 2u);
  EXPECT_NEAR(above.depth[side], 6, 1e-3) << "the plate hides the ball's lower half";
  EXPECT_EQ(above.face[side], 1u);
}

TEST(TreeLayer, ABallsCurvatureIsInItsPoints) {
  const double radius = 2;
  Model model = model_of(test::ball(150, radius));
  model.instances[0].to_world.linear = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
  TreeLayerOptions options;
  options.threshold_px = 8;
  Drawn drawn(model, options);
  Camera camera;
  camera.eye = {30, 0, 4}, camera.width = camera.height = kSize;
  const Frame frame = drawn.draw(camera);
  const std::size_t middle = kSize / 2 * kSize + kSize / 2;
  EXPECT_NEAR(frame.curvature[2 * middle], -1 / (3 * radius), 0.02);
  // The normals follow the sphere within each point.
  double worst = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    if (!std::isfinite(frame.depth[i])) continue;
    const Vec3 p{frame.position[3 * i], frame.position[3 * i + 1], frame.position[3 * i + 2]};
    const Vec3 n{frame.normal[3 * i], frame.normal[3 * i + 1], frame.normal[3 * i + 2]};
    const double seen_from = dot(normalized(p), normalized(camera.eye));
    if (seen_from > 0.3) worst = std::max(worst, std::acos(std::min(1.0, dot(n, normalized(p)))));
  }
  EXPECT_LT(worst, 0.05) << "the points themselves span 0.08 rad";
}

TEST(TreeLayer, OpenSurfacesShowTheirBackAndClosedOnesTheirInside) {
  Model model = model_of(test::terrain(30));
  Camera camera;
  camera.eye = {0.5, 0.5, -3}, camera.target = {0.5, 0.5, 0}, camera.up = {0, 1, 0};
  camera.width = camera.height = kSize;
  EXPECT_GT(Drawn(model, {}).draw(camera).stats.covered_pixels, 8000u);
  model = model_of(test::ball(30));
  camera.eye = {0, 0, 0}, camera.target = {1, 0, 0}, camera.up = {0, 0, 1};
  EXPECT_EQ(Drawn(model, {}).draw(camera).stats.covered_pixels, static_cast<std::uint64_t>(kSize * kSize));
}

TEST(TreeLayer, PointsWithoutPolygonsAreDrawn) {
  PolygonMesh points = test::ball(40);
  points.corners.clear();
  const Camera camera = looking(4);
  Drawn drawn(model_of(points), {});
  const Frame frame = drawn.draw(camera), solid = as_triangles(model_of(test::ball(40)), camera);
  const Difference d = difference(solid, frame, camera);
  EXPECT_LT(d.coverage, 0.15);
  EXPECT_LT(d.color, 0.08);
}

TEST(TreeLayer, SeveralSamplesAndAHostsOptionsWork) {
  const Model model = model_of(bumpy(60));
  Drawn drawn(model, {});
  DrawOptions options;
  options.outputs = kColor;
  options.samples = 4;
  options.background.reset();
  const Frame frame = drawn.draw(looking(4), options);
  std::size_t partly = 0;
  for (std::size_t i = 3; i < frame.color.size(); i += 4)
    partly += frame.color[i] > 0.1F && frame.color[i] < 0.9F;
  EXPECT_GT(partly, 100u) << "the silhouette is smooth";
}

/// Counts the buffers and textures that are alive.
int names_alive = 0;
using GlNames = void (*)(GLsizei, GLuint*);
GlNames gen_buffers, delete_buffers, gen_textures, delete_textures;
template <GlNames& call, int sign>
void counted(GLsizei count, GLuint* names) {
  names_alive += sign * static_cast<int>(count);
  call(count, names);
}
void* counting_loader(const Context& context, const std::string& name) {
  void* const found = context.loader()(name.c_str());
  const auto count = [&](GlNames& call, GlNames by) {
    call = reinterpret_cast<GlNames>(found);
    return reinterpret_cast<void*>(by);
  };
  if (name == "glGenBuffers") return count(gen_buffers, counted<gen_buffers, 1>);
  if (name == "glDeleteBuffers") return count(delete_buffers, counted<delete_buffers, -1>);
  if (name == "glGenTextures") return count(gen_textures, counted<gen_textures, 1>);
  if (name == "glDeleteTextures") return count(delete_textures, counted<delete_textures, -1>);
  return found;
}

TEST(TreeLayer, WhatAProgramKeepsOfALayerMayOutliveItsSceneAndItsContext) {
  auto context = create_context(Device::automatic);
  ASSERT_TRUE(context.ok());
  auto renderer = Renderer::create([&](const char* name) { return counting_loader(**context, name); });
  ASSERT_TRUE(renderer.ok()) << renderer.status().message;
  const Model model = model_of(bumpy(20));
  TreeLayers layers({{*build_point_tree(model.parts[0].polygons, {}), 0}}, {});
  const int before = names_alive;
  const auto draw = [&] {
    auto scene = (*renderer)->upload(model, SceneContent{nullptr, {layers.layer()}});
    EXPECT_TRUE(scene.ok()) << scene.status().message;
    EXPECT_TRUE((*renderer)->draw(**scene, looking(4), everything()).ok());
    return std::move(*scene);
  };
  auto first = draw();
  const int of_renderer_and_scene = names_alive;
  EXPECT_GT(of_renderer_and_scene, before);
  auto second = draw();
  first.reset();  // the layer is the second scene's now
  EXPECT_TRUE((*renderer)->draw(*second, looking(3), everything()).ok());
  EXPECT_EQ(names_alive, of_renderer_and_scene);
  second.reset();
  renderer->reset();
  EXPECT_EQ(names_alive, 0) << "all went with the scene and the renderer";
  context->reset();
  EXPECT_GT(layers.stats().points + layers.stats().triangles, 0u);
}

}  // namespace
}  // namespace dupin::testing
