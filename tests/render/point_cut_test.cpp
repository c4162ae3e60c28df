#include "../../render/point_cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "../../core/parallel.h"
#include "../simplify/meshes.h"

namespace dupin {
namespace {

struct PlacedTree {
  std::shared_ptr<const PointTree> tree;
  ScenePart part;
  SceneInstance instance;

  explicit PlacedTree(const PolygonMesh& mesh, PointTreeKind kind = PointTreeKind::pop) {
    PointTreeOptions options;
    options.kind = kind;
    tree = *build_point_tree(mesh, options);
    part.box = tree->info().box;
    part.anchor = part.box.center();
    part.closed = true;
  }
  CutView view(const Camera& camera, const CutOptions& options = {}) const {
    const ViewRays rays = view_rays(camera);
    const PartCamera in_part = part_camera(instance, part, rays, side_planes(rays, {}));
    return cut_view(in_part, instance, rays, tree->info().grid, part.anchor, options);
  }
};

struct Lists {
  std::vector<std::uint32_t> points, leaves;
  friend bool operator==(const Lists&, const Lists&) = default;
};
Lists lists_of(const PointCut& cut) {
  Lists lists;
  cut.each_list([&](const auto& list) { lists.points.insert(lists.points.end(), list.begin(), list.end()); },
                [&](const auto& list) { lists.leaves.insert(lists.leaves.end(), list.begin(), list.end()); });
  return lists;
}

/// All bumps, so that cones, sides and sizes all matter.
PolygonMesh bumpy(int rings) {
  PolygonMesh mesh = test::ball(rings);
  for (Vec3& p : mesh.positions)
    p = p * (1 + 0.15 * std::sin(7 * p.x) * std::sin(5 * p.y + 1) + 0.05 * std::sin(31 * p.z));
  mesh.normals.clear();
  return mesh;
}

/// Once around, and nearer.
Camera on_the_way(int frame, int frames) {
  const double t = double(frame) / frames, a = 2 * std::numbers::pi * t, distance = 4.5 - 2.5 * t;
  Camera camera;
  camera.eye = {distance * std::cos(a), distance * std::sin(a), 0.8 * std::sin(2 * a)};
  camera.target = {0.3 * t, 0, 0.2 * t};
  camera.width = camera.height = 512;
  return camera;
}

TEST(PointCut, CoherentFrontsAreThoseOfAFreshWalk) {
  for (const bool parallel : {false, true})
    for (const bool silhouette : {false, true}) {
      const PlacedTree placed(bumpy(110));
      CutOptions options;
      options.threshold_px = 1.5, options.silhouette = silhouette;
      PointCut coherent(placed.tree), fresh(placed.tree);
      std::uint64_t visited = 0, all = 0;
      Lists last;
      for (int frame = 0; frame < 200; ++frame) {
        Camera camera = on_the_way(frame, 200);
        camera.orthographic = parallel, camera.ortho_height = 2.5;
        const CutView view = placed.view(camera, options);
        coherent.update(view, true), fresh.update(view, false);
        ASSERT_EQ(lists_of(coherent), lists_of(fresh)) << "frame " << frame;
        EXPECT_TRUE(coherent.changed() || lists_of(coherent) == last) << "frame " << frame;
        last = lists_of(coherent);
        if (frame > 0) visited += coherent.visited(), all += fresh.visited();
      }
      EXPECT_LT(static_cast<double>(visited), static_cast<double>(all) * (silhouette ? 0.6 : 1.0 / 3))
          << "parallel " << parallel << " silhouette " << silhouette;
      EXPECT_GT(coherent.point_count() + coherent.leaf_count(), 500u);
    }
}

TEST(PointCut, JumpsAndChangesOfOptionsAreFollowed) {
  const PlacedTree placed(bumpy(60));
  PointCut coherent(placed.tree), fresh(placed.tree);
  std::uint32_t state = 1;
  const auto random = [&state](double lo, double hi) {
    state = state * 1664525u + 1013904223u;
    return lo + (hi - lo) * (state >> 8) / double(1 << 24);
  };
  for (int frame = 0; frame < 150; ++frame) {
    Camera camera;
    camera.eye = {random(-3, 3), random(-3, 3), random(-3, 3)};
    camera.target = {random(-1, 1), random(-1, 1), random(-1, 1)};
    camera.fov_degrees = frame % 7 == 0 ? random(5, 80) : 30;
    camera.width = camera.height = 300;
    CutOptions options;
    if (frame % 11 == 0) options.threshold_px = random(0.3, 6);
    const CutView view = placed.view(camera, options);
    coherent.update(view, true), fresh.update(view, false);
    ASSERT_EQ(lists_of(coherent), lists_of(fresh)) << "frame " << frame;
  }
}

TEST(PointCut, AStillViewLooksAtNothingButTheTop) {
  const PlacedTree placed(bumpy(110));
  PointCut cut(placed.tree);
  const CutView view = placed.view(on_the_way(10, 100));
  cut.update(view, true);
  EXPECT_TRUE(cut.changed());
  const std::uint64_t first = cut.visited();
  cut.update(view, true);
  EXPECT_FALSE(cut.changed());
  EXPECT_LT(cut.visited(), first / 20);
}

/// Every leaf in view is stood for by exactly one node of the front, of no more than the threshold, unless it
/// is turned away.
TEST(PointCut, TheFrontCoversWhatIsInView) {
  const PlacedTree placed(bumpy(60));
  for (const double threshold : {0.7, 2.0, 9.0}) {
    CutOptions options;
    options.threshold_px = threshold;
    const Camera camera = on_the_way(30, 100);
    const CutView view = placed.view(camera, options);
    PointCut cut(placed.tree);
    cut.update(view, false);
    const Lists lists = lists_of(cut);
    const TreeShape& shape = placed.tree->shape();
    std::vector<int> covered(shape.leaves(), 0);
    const double pixel = pixel_size(camera, 1);
    for (const std::uint32_t node : lists.points) {
      const auto range = shape.leaves_below(node);
      for (std::uint64_t r = range.first; r < range.last; ++r) ++covered[r];
      const EncodedNode n = placed.tree->nodes(node, 1)[0];
      const double radius = node_radius(n) * placed.tree->info().grid.step;
      const double depth = view_depth(camera, placed.tree->info().grid.to_part(node_center(n))) - radius;
      EXPECT_LE(2 * radius / (depth * pixel), threshold * (1 + 1e-9));
    }
    for (const std::uint32_t rank : lists.leaves) ++covered[rank];
    MeshBlock block;
    for (std::size_t b = 0; b < placed.tree->block_count(); ++b) {
      ASSERT_TRUE(placed.tree->block(b, block));
      for (std::size_t leaf = 0; leaf + 1 < block.leaf_starts.size(); ++leaf) {
        const std::size_t rank = b * kBlockLeaves + leaf;
        ASSERT_LE(covered[rank], 1);
        if (covered[rank]) continue;
        // Left out: it must be out of the picture or seen from behind.
        bool in_picture = false;
        for (std::size_t t = block.leaf_starts[leaf]; t < block.leaf_starts[leaf + 1]; ++t) {
          Vec3 p[3];
          for (std::size_t k = 0; k < 3; ++k) {
            const auto& v = block.vertices[block.triangles[t][k]].position;
            p[k] = placed.tree->info().grid.to_part({double(v[0]), double(v[1]), double(v[2])});
          }
          const bool front = dot(cross(p[1] - p[0], p[2] - p[0]), camera.eye - p[0]) > 0;
          const CameraAxes axes = camera_axes(camera);
          const Vec3 d = p[0] - camera.eye;
          const double depth = -dot(d, axes.back), half = depth * pixel * camera.height / 2;
          in_picture = in_picture ||
                       (front && std::abs(dot(d, axes.right)) < half && std::abs(dot(d, axes.up)) < half);
        }
        EXPECT_FALSE(in_picture) << "leaf " << rank;
      }
    }
  }
}

TEST(PointCut, FromInsideNothingIsTurnedAway) {
  PlacedTree placed(bumpy(40));
  Camera camera;
  camera.eye = {0, 0, 0}, camera.target = {1, 0, 0}, camera.width = camera.height = 64;
  PointCut cut(placed.tree);
  CutView view = placed.view(camera);
  view.cull_turned_away = false;
  cut.update(view, true);
  EXPECT_GT(cut.point_count() + cut.leaf_count(), 0u);
}

TEST(PointCut, DoesNotDependOnTheNumberOfThreads) {
  const PlacedTree placed(bumpy(100), PointTreeKind::qsplat);
  PointCut several(placed.tree), one(placed.tree);
  for (int frame = 0; frame < 20; ++frame) {
    const CutView view = placed.view(on_the_way(frame, 100));
    several.update(view, true);
    set_thread_limit(1);
    one.update(view, true);
    set_thread_limit(0);
    ASSERT_EQ(lists_of(one), lists_of(several));
  }
}

}  // namespace
}  // namespace dupin
