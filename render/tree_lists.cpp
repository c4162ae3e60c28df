#include "tree_lists.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "../core/parallel.h"

namespace dupin {
namespace {

std::vector<std::shared_ptr<const PointTree>> only_trees(const std::vector<PartTree>& trees) {
  std::vector<std::shared_ptr<const PointTree>> result;
  for (const PartTree& t : trees) result.push_back(t.tree);
  return result;
}

/// Without its face.
PointExtra extra_of(const PointTree& tree, std::uint32_t node, const EncodedNode& encoded) {
  constexpr std::uint32_t kWhole = 255U << 24, kCurvatureBits = 0xffffff, kNormalMask = 0x3fffff;
  const std::uint32_t own_normal = encoded.words[3] & kNormalMask;
  if (!tree.shape().is_leaf(node) || node == 0)
    return {(tree.curvature(node) & kCurvatureBits) | kWhole, node, 0, own_normal};
  const std::uint64_t index = TreeShape::parent(node);
  const auto parent = tree.nodes(index, 1);
  if (parent.empty()) return {kWhole, node, 0, own_normal};
  const double smaller = node_radius(encoded) / std::max(node_radius(parent[0]), 1e-300);
  const auto size = static_cast<std::uint32_t>(std::lround(255 * std::clamp(smaller, 0.0, 1.0)));
  return {(tree.curvature(index) & kCurvatureBits) | size << 24, node, 0, parent[0].words[3] & kNormalMask};
}

/// Clip X and Y times w, and the depth.
Vec3 to_clip(const PartCamera& camera, const Vec3& p) {
  return {dot(camera.rows[0].n, p) + camera.rows[0].d, dot(camera.rows[1].n, p) + camera.rows[1].d,
          dot(camera.depth.n, p) + camera.depth.d};
}

/// The pixels that points and triangles may cover, and how near they come. Points have their middles in the
/// box, and stick out of it by `margin` pixels at most, towards the viewer too.
PictureExtent extent_of(const Box3& clip, const ViewRays& view, const std::array<double, 3>& depth_terms,
                        double margin) {
  const PictureExtent everything{0, 0, view.width, view.height, std::numeric_limits<float>::max()};
  const double nearest = clip.lo.z - margin * pixel_size(view, clip.hi.z);
  if (view.perspective && !(nearest > 1e-6 * clip.hi.z)) return everything;
  const auto lowest = [&](double v) { return view.perspective ? std::min(v / clip.lo.z, v / clip.hi.z) : v; };
  const auto highest = [&](double v) {
    return view.perspective ? std::max(v / clip.lo.z, v / clip.hi.z) : v;
  };
  const auto pixel = [](double v, int size, double aside) {
    return static_cast<int>(std::clamp((v + 1) * 0.5 * size + aside, 0.0, static_cast<double>(size)));
  };
  PictureExtent extent;
  extent.x0 = pixel(lowest(clip.lo.x), view.width, -margin - 1);
  extent.x1 = pixel(highest(clip.hi.x), view.width, margin + 2);
  extent.y0 = pixel(lowest(clip.lo.y), view.height, -margin - 1);
  extent.y1 = pixel(highest(clip.hi.y), view.height, margin + 2);
  const auto& t = depth_terms;
  const double value = view.perspective ? t[2] / nearest : t[0] + t[1] * nearest;
  extent.nearest = std::nextafter(static_cast<float>(value), std::numeric_limits<float>::max());
  return extent;
}

PictureExtent extent_of_box(const PartCamera& camera, const Box3& box, const LayerPass& pass, double margin) {
  Box3 clip;
  for (int i = 0; i < 8; ++i)
    clip.add(to_clip(
        camera, {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z}));
  return extent_of(clip, pass.view, pass.renderer.draw_list().depth_terms, margin);
}

/// Whether nodes of a placement are hidden: their spheres contain all that is drawn in their place.
class HiddenNodes {
 public:
  HiddenNodes(const LayerPass& pass, const Occlusion& occlusion, const PlacedTree& placed)
      : pass_(pass),
        occlusion_(occlusion),
        camera_(placed.camera),
        grid_(placed.cut.tree().info().grid),
        origin_(grid_.origin - pass.scene.parts[placed.tree].anchor),
        reach_(Vec3{length(camera_.rows[0].n), length(camera_.rows[1].n), length(camera_.depth.n)} *
               grid_.step) {}
  bool operator()(const EncodedNode& node) const {
    const Vec3 middle = to_clip(camera_, origin_ + node_center(node) * grid_.step);
    const Vec3 reach = reach_ * node_radius(node);
    return occlusion_.hides(
        extent_of({middle - reach, middle + reach}, pass_.view, pass_.renderer.draw_list().depth_terms, 1));
  }

 private:
  const LayerPass& pass_;
  const Occlusion& occlusion_;
  const PartCamera& camera_;
  const PointGrid& grid_;
  Vec3 origin_, reach_;
};

}  // namespace

TreeLists::TreeLists(const Gl& gl, const std::vector<PartTree>& trees, const Scene::Impl& scene,
                     std::uint32_t layer)
    : trees_(trees), layer_(layer), arena_(gl, only_trees(trees)) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::size_t part = scene.instances[i].part;
    if (part < trees_.size() && trees_[part].tree) placed_.push_back({part, i, PointCut(trees_[part].tree)});
  }
}

void TreeLists::place_camera(const LayerPass& pass, const SidePlanes& sides, const CutOptions& cut,
                             PlacedTree& p) {
  const SceneInstance& instance = pass.scene.instances[p.instance];
  const ScenePart& part = pass.scene.parts[instance.part];
  const PointTreeInfo& info = p.cut.tree().info();
  p.camera = part_camera(instance, part, pass.view, sides);
  p.view = cut_view(p.camera, instance, pass.view, info.grid, part.anchor, cut);
  // Cones know what is closed; but from within, or through a section or a hidden face, anything may be seen
  // from behind.
  const Vec3 eye = transform_point(instance.to_part, pass.view.eye);
  p.view.cull_turned_away =
      !sides.cut() && !instance.hidden_faces && !(pass.view.perspective && part.box.contains(eye));
  const Box3 box{info.box.lo - part.anchor, info.box.hi - part.anchor};
  p.extent = extent_of_box(p.camera, box, pass, 1.5 * cut.threshold_px);
  // Vertices' discs may be of any size when one looks closely.
  if (info.kind == PointTreeKind::qsplat)
    p.extent = {0, 0, pass.view.width, pass.view.height, std::numeric_limits<float>::max()};
}

void TreeLists::begin(const LayerPass& pass, const TreeLayerOptions& options) {
  const SidePlanes sides = side_planes(pass.view, pass.options.sections);
  const CutOptions cut{options.threshold_px, options.silhouette, options.leaves_as_points};
  parallel_for(placed_.size(), [&](std::size_t i) {
    if (pass.scene.instances[placed_[i].instance].visible) place_camera(pass, sides, cut, placed_[i]);
  });
  order_.clear();
  for (std::size_t i = 0; i < placed_.size(); ++i)
    if (pass.scene.instances[placed_[i].instance].visible && !placed_[i].extent.empty()) order_.push_back(i);
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return placed_[a].extent.nearest > placed_[b].extent.nearest;
  });
  drawn_.clear();
  point_count_ = leaf_count_ = triangle_count_ = 0;
  cut_ms = 0;
}

void TreeLists::update(const LayerPass& pass, std::span<const std::size_t> batch,
                       const TreeLayerOptions& options, const Occlusion* occlusion) {
  const auto start = std::chrono::steady_clock::now();
  parallel_for(batch.size(), [&](std::size_t i) {
    PlacedTree& p = placed_[batch[i]];
    PointCut::Hidden hidden;
    if (occlusion) hidden = HiddenNodes(pass, *occlusion, p);
    p.cut.update(p.view, options.coherent, hidden);
    const FaceColors& now = pass.scene.instances[p.instance].colors;
    if (p.found && !p.cut.changed() && p.look.whole == now.whole && p.look.faces == now.faces) return;
    p.look = now;
    find_lists(pass.scene, p);
  });
  cut_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  drawn_.insert(drawn_.end(), batch.begin(), batch.end());
  load_triangles(batch);
  for (const std::size_t i : batch) {
    PlacedTree& p = placed_[i];
    p.first_point = point_count_, p.first_leaf = leaf_count_;
    point_count_ += p.point_count, leaf_count_ += p.leaf_count, triangle_count_ += p.triangle_count;
  }
}

/// Where others have to make room for them, these come back when they are seen.
void TreeLists::load_triangles(std::span<const std::size_t> batch) {
  const auto want = [&] {
    for (const std::size_t i : batch) {
      const PlacedTree& p = placed_[i];
      if (p.loaded == arena_.generation()) continue;
      for (const SplatList& list : p.leaves) arena_.want(p.tree, list.items);
    }
  };
  want();
  if (arena_.must_make_room()) arena_.make_room(), want();
  arena_.load();
  parallel_for(batch.size(), [&](std::size_t i) {
    PlacedTree& p = placed_[batch[i]];
    if (p.loaded == arena_.generation()) return;
    p.triangle_count = 0;
    for (const SplatList& list : p.leaves)
      for (const std::uint32_t rank : list.items) {
        const auto [first, last] = arena_.triangles_of(p.tree, rank);
        p.triangle_count += last - first;
      }
    p.loaded = arena_.generation();
  });
}

std::uint32_t TreeLists::group_of_node(const PlacedTree& p, std::uint32_t node) const {
  return p.cut.tree().groups().size() > 1 ? p.cut.tree().node_group(node) : 0;
}
std::uint32_t TreeLists::group_of_leaf(const PlacedTree& p, std::uint32_t rank) const {
  return p.cut.tree().groups().size() > 1 ? p.cut.tree().leaf_group(rank) : 0;
}

void TreeLists::find_lists(const Scene::Impl& scene, PlacedTree& p) const {
  p.points.clear(), p.leaves.clear(), p.visible_points.clear(), p.visible_leaves.clear();
  p.found = true, p.loaded = 0;
  const SceneInstance& instance = scene.instances[p.instance];
  const auto hidden = [&](std::uint32_t group) {
    return is_hidden(instance.colors.of(trees_[p.tree].first_face + group));
  };
  p.cut.each_list(
      [&](const Indices& nodes) {
        if (!instance.hidden_faces) return p.points.push_back({nodes, 0});
        for (const std::uint32_t node : nodes)
          if (!hidden(group_of_node(p, node))) p.visible_points.push_back(node);
      },
      [&](const Indices& leaves) {
        if (!instance.hidden_faces) return p.leaves.push_back({leaves, 0});
        for (const std::uint32_t rank : leaves)
          if (!hidden(group_of_leaf(p, rank))) p.visible_leaves.push_back(rank);
      });
  if (!p.visible_points.empty()) p.points.push_back({p.visible_points, 0});
  if (!p.visible_leaves.empty()) p.leaves.push_back({p.visible_leaves, 0});
  const auto number = [](std::vector<SplatList>& lists, std::size_t& count, std::uint32_t numbers) {
    count = 0;
    for (SplatList& list : lists) {
      list.first = numbers * static_cast<std::uint32_t>(count);
      count += list.items.size();
    }
  };
  number(p.points, p.point_count, 1), number(p.leaves, p.leaf_count, kMostLeafTriangles);
}

/// Per group of the tree.
TreeLists::Indices TreeLists::faces_of(const Scene::Impl& scene, const PlacedTree& p) const {
  const SceneInstance& instance = scene.instances[p.instance];
  const ScenePart& part = scene.parts[instance.part];
  const std::vector<MeshGroup>& groups = p.cut.tree().groups();
  const bool by_group =
      std::any_of(groups.begin(), groups.end(), [](const MeshGroup& g) { return g.color.has_value(); });
  Indices faces(std::max<std::size_t>(1, groups.size()));
  for (std::size_t group = 0; group < faces.size(); ++group) {
    const std::size_t face = trees_[p.tree].first_face + group;
    faces[group] = part.face_numbers[face];
    // A group without a colour has its placement's.
    const bool placed = by_group && !groups[group].color;
    if (placed || instance.colors.of(face) != instance.file_colors.of(face)) faces[group] |= kOverride;
  }
  return faces;
}

void TreeLists::gather(const Scene::Impl& scene, const SeenNumbers& seen) {
  load_seen(seen.triangles);
  points_.resize(seen.points.size()), extras_.resize(seen.points.size());
  triangles_.resize(seen.triangles.size());
  parallel_for(drawn_.size(), [&](std::size_t i) {
    gather_points(scene, placed_[drawn_[i]], seen.points);
    gather_triangles(scene, placed_[drawn_[i]], seen.triangles);
  });
  make_runs(scene, seen);
}

void TreeLists::gather_points(const Scene::Impl& scene, const PlacedTree& p, const NumberSet& seen) {
  const PointTree& tree = p.cut.tree();
  const Indices faces = faces_of(scene, p);
  parallel_for(p.points.size(), [&](std::size_t i) {
    const SplatList& list = p.points[i];
    const std::size_t first = p.first_point + list.first;
    seen.each(first, first + list.items.size(), [&](std::size_t number, std::uint32_t at) {
      const std::uint32_t node = list.items[number - first];
      const auto encoded = tree.nodes(node, 1);
      points_[at] = encoded.empty() ? EncodedNode{} : encoded[0];
      extras_[at] = extra_of(tree, node, points_[at]);
      extras_[at].face = faces[group_of_node(p, node)];
    });
  });
}

void TreeLists::gather_triangles(const Scene::Impl& scene, const PlacedTree& p, const NumberSet& seen) {
  const Indices faces = faces_of(scene, p);
  parallel_for(p.leaves.size(), [&](std::size_t i) {
    const SplatList& list = p.leaves[i];
    const std::size_t first = kMostLeafTriangles * p.first_leaf + list.first;
    seen.each(
        first, first + kMostLeafTriangles * list.items.size(), [&](std::size_t number, std::uint32_t at) {
          const std::size_t slot = number - first;
          const std::uint32_t rank = list.items[slot / kMostLeafTriangles];
          triangles_[at] = {
              arena_.triangles_of(p.tree, rank)[0] + static_cast<std::uint32_t>(slot % kMostLeafTriangles),
              faces[group_of_leaf(p, rank)]};
        });
  });
}

/// Of those drawn early in a frame the triangles may have had to make room.
void TreeLists::load_seen(const NumberSet& seen) {
  const auto want = [&] {
    for (const std::size_t i : drawn_) {
      const PlacedTree& p = placed_[i];
      if (p.loaded == arena_.generation()) continue;
      for (const SplatList& list : p.leaves) {
        const std::size_t first = kMostLeafTriangles * p.first_leaf + list.first;
        seen.each(first, first + kMostLeafTriangles * list.items.size(),
                  [&](std::size_t number, std::uint32_t) {
                    arena_.want(p.tree, list.items.subspan((number - first) / kMostLeafTriangles, 1));
                  });
      }
    }
  };
  want();
  if (arena_.must_make_room()) {
    arena_.make_room();
    want();
  }
  arena_.load();
}

void TreeLists::make_runs(const Scene::Impl& scene, const SeenNumbers& seen) {
  point_runs_.clear(), triangle_runs_.clear();
  for (const std::size_t i : drawn_) {
    const PlacedTree& p = placed_[i];
    const SceneInstance& instance = scene.instances[p.instance];
    const std::uint32_t primitive =
        instance.first_primitive + scene.parts[instance.part].first_in_layer[layer_];
    const auto add = [&](std::vector<TreeRun>& runs, const NumberSet& numbers, std::size_t first,
                         std::size_t count) {
      const std::uint32_t from = numbers.less_than(first), to = numbers.less_than(first + count);
      if (from < to) runs.push_back({from, p.instance, 0, primitive});
    };
    add(point_runs_, seen.points, p.first_point, p.point_count);
    add(triangle_runs_, seen.triangles, kMostLeafTriangles * p.first_leaf, kMostLeafTriangles * p.leaf_count);
  }
}

}  // namespace dupin
