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

/// Leaves have no curvature of their own: they bend as their parents do.
std::uint32_t curvature_of(const PointTree& tree, std::uint32_t node, const EncodedNode& encoded) {
  if (!tree.shape().is_leaf(node) || node == 0) return tree.curvature(node);
  const std::uint64_t index = TreeShape::parent(node);
  const auto parent = tree.nodes(index, 1);
  const std::uint32_t bits = tree.curvature(index);
  if (bits == 0 || parent.empty()) return 0;
  NodeCurvature k = decode_curvature(bits);
  const Vec3 n = node_normal(parent[0]), x = any_perpendicular(n);
  const Vec3 along = x * std::cos(k.angle) + cross(n, x) * std::sin(k.angle);
  const Vec3 own = node_normal(encoded), own_x = any_perpendicular(own);
  k.angle = std::atan2(dot(along, cross(own, own_x)), dot(along, own_x));
  const double smaller = node_radius(encoded) / std::max(node_radius(parent[0]), 1e-300);
  k.k1 *= smaller, k.k2 *= smaller;
  return encode_curvature(k);
}

/// Clip X and Y times w, and the depth.
struct ClipBox {
  Box3 box;
  void add(const PartCamera& camera, const Vec3& p, double radius = 0) {
    const Plane3* const planes[] = {&camera.rows[0], &camera.rows[1], &camera.depth};
    Vec3 value, reach;
    for (int k = 0; k < 3; ++k) {
      value[k] = dot(planes[k]->n, p) + planes[k]->d;
      reach[k] = radius * length(planes[k]->n);
    }
    box.add(value - reach), box.add(value + reach);
  }
};

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
  ClipBox clip;
  for (int i = 0; i < 8; ++i)
    clip.add(camera, {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z});
  return extent_of(clip.box, pass.view, pass.renderer.draw_list().depth_terms, margin);
}

/// Spheres contain all that is drawn in their place.
PictureExtent extent_of_sphere(const PartCamera& camera, const EncodedNode& node, const PointGrid& grid,
                               const Vec3& anchor, const LayerPass& pass) {
  ClipBox clip;
  clip.add(camera, grid.to_part(node_center(node)) - anchor, grid.step * node_radius(node));
  return extent_of(clip.box, pass.view, pass.renderer.draw_list().depth_terms, 1);
}

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
    placed_[i].drawn = false;
    if (pass.scene.instances[placed_[i].instance].visible) place_camera(pass, sides, cut, placed_[i]);
  });
  order_.clear();
  for (std::size_t i = 0; i < placed_.size(); ++i)
    if (pass.scene.instances[placed_[i].instance].visible && !placed_[i].extent.empty()) order_.push_back(i);
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return placed_[a].extent.nearest > placed_[b].extent.nearest;
  });
  last_drawn_.swap(drawn_);
  drawn_.clear();
  point_count_ = triangle_count_ = 0;
  refilled_ = false;
  cut_ms = 0;
}

void TreeLists::update(const LayerPass& pass, std::span<const std::size_t> batch,
                       const TreeLayerOptions& options, const Occlusion* occlusion) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Pieces> pieces(batch.size());
  parallel_for(batch.size(), [&](std::size_t i) {
    PlacedTree& p = placed_[batch[i]];
    p.drawn = true;
    PointCut::Hidden hidden;
    if (occlusion)
      hidden = [&](const EncodedNode& node) {
        return occlusion->hides(extent_of_sphere(p.camera, node, p.cut.tree().info().grid,
                                                 pass.scene.parts[p.tree].anchor, pass));
      };
    p.cut.update(p.view, options.coherent, hidden);
    const FaceColors& now = pass.scene.instances[p.instance].colors;
    if (p.cut.changed() || p.look.whole != now.whole || p.look.faces != now.faces) p.filled = false;
    p.look = now;
  });
  cut_ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  drawn_.insert(drawn_.end(), batch.begin(), batch.end());
  load_triangles(pass.scene, pieces, batch);
  parallel_for(batch.size(), [&](std::size_t i) {
    PlacedTree& p = placed_[batch[i]];
    if (p.filled) return;
    number(p, pieces[i]);
    fill(pass.scene, p, pieces[i]);
  });
  for (const std::size_t i : batch) {
    PlacedTree& p = placed_[i];
    refilled_ = refilled_ || !p.filled;
    p.filled = true;
    p.first_point = point_count_, p.first_triangle = triangle_count_;
    point_count_ += p.points.size(), triangle_count_ += p.triangles.size();
  }
}

/// Triangles that had to make room take the lists with them that refer to them.
void TreeLists::load_triangles(const Scene::Impl& scene, std::vector<Pieces>& pieces,
                               std::span<const std::size_t> batch) {
  const auto want = [&] {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      PlacedTree& p = placed_[batch[i]];
      if (p.filled) continue;
      if (pieces[i].points.empty() && pieces[i].leaves.empty()) find_pieces(scene, p, pieces[i]);
      for (const Piece& piece : pieces[i].leaves) arena_.want(p.tree, *piece.list);
    }
  };
  want();
  if (!arena_.must_make_room()) return arena_.load();
  arena_.make_room();
  for (PlacedTree& p : placed_) p.filled = false;
  want();
  arena_.load();
  // What this frame has drawn already comes back, in the same order.
  for (const std::size_t i : drawn_) {
    PlacedTree& p = placed_[i];
    if (std::find(batch.begin(), batch.end(), i) != batch.end()) continue;
    Pieces again;
    find_pieces(scene, p, again);
    for (const Piece& piece : again.leaves) arena_.want(p.tree, *piece.list);
    arena_.load();
    number(p, again);
    fill(scene, p, again);
    p.filled = refilled_ = true;
  }
}

std::uint32_t TreeLists::group_of_node(const PlacedTree& p, std::uint32_t node) const {
  return p.cut.tree().groups().size() > 1 ? p.cut.tree().node_group(node) : 0;
}
std::uint32_t TreeLists::group_of_leaf(const PlacedTree& p, std::uint32_t rank) const {
  return p.cut.tree().groups().size() > 1 ? p.cut.tree().leaf_group(rank) : 0;
}

void TreeLists::find_pieces(const Scene::Impl& scene, const PlacedTree& p, Pieces& pieces) const {
  const SceneInstance& instance = scene.instances[p.instance];
  const auto hidden = [&](std::uint32_t group) {
    return is_hidden(instance.colors.of(trees_[p.tree].first_face + group));
  };
  p.cut.each_list(
      [&](const Indices& nodes) {
        if (!instance.hidden_faces) return pieces.points.push_back({&nodes, 0});
        for (const std::uint32_t node : nodes)
          if (!hidden(group_of_node(p, node))) pieces.visible_points.push_back(node);
      },
      [&](const Indices& leaves) {
        if (!instance.hidden_faces) return pieces.leaves.push_back({&leaves, 0});
        for (const std::uint32_t rank : leaves)
          if (!hidden(group_of_leaf(p, rank))) pieces.visible_leaves.push_back(rank);
      });
  if (!pieces.visible_points.empty()) pieces.points.push_back({&pieces.visible_points, 0});
  if (!pieces.visible_leaves.empty()) pieces.leaves.push_back({&pieces.visible_leaves, 0});
}

void TreeLists::number(PlacedTree& p, Pieces& pieces) {
  std::size_t points = 0, triangles = 0;
  for (Piece& piece : pieces.points) piece.at = points, points += piece.list->size();
  for (Piece& piece : pieces.leaves) {
    piece.at = triangles;
    for (const std::uint32_t rank : *piece.list) {
      const auto [first, last] = arena_.triangles_of(p.tree, rank);
      triangles += last - first;
    }
  }
  p.points.resize(points), p.extras.resize(points);
  p.triangles.resize(triangles), p.triangle_indices.resize(triangles);
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

void TreeLists::fill_points(PlacedTree& p, const Piece& piece, const Indices& faces) {
  const PointTree& tree = p.cut.tree();
  std::size_t at = piece.at;
  for (const std::uint32_t node : *piece.list) {
    const auto encoded = tree.nodes(node, 1);
    p.points[at] = encoded.empty() ? EncodedNode{} : encoded[0];
    p.extras[at] = {curvature_of(tree, node, p.points[at]), node, faces[group_of_node(p, node)], 0};
    ++at;
  }
}

void TreeLists::fill_triangles(PlacedTree& p, const Piece& piece, const Indices& faces) {
  std::size_t at = piece.at;
  for (const std::uint32_t rank : *piece.list) {
    const auto [first, last] = arena_.triangles_of(p.tree, rank);
    const std::uint32_t face = faces[group_of_leaf(p, rank)];
    for (std::uint32_t t = first; t < last; ++t) {
      p.triangle_indices[at] = t;
      p.triangles[at++] = {t, face};
    }
  }
}

void TreeLists::fill(const Scene::Impl& scene, PlacedTree& p, const Pieces& pieces) {
  const Indices faces = faces_of(scene, p);
  parallel_for(pieces.points.size(), [&](std::size_t i) { fill_points(p, pieces.points[i], faces); });
  parallel_for(pieces.leaves.size(), [&](std::size_t i) { fill_triangles(p, pieces.leaves[i], faces); });
}

bool TreeLists::finish(const Scene::Impl& scene) {
  if (!refilled_ && drawn_ == last_drawn_) return false;
  make_runs(scene);
  return true;
}

void TreeLists::make_runs(const Scene::Impl& scene) {
  point_runs_.clear(), triangle_runs_.clear();
  for (const std::size_t i : drawn_) {
    const PlacedTree& p = placed_[i];
    const SceneInstance& instance = scene.instances[p.instance];
    const std::uint32_t primitive =
        instance.first_primitive + scene.parts[instance.part].first_in_layer[layer_];
    if (!p.points.empty())
      point_runs_.push_back({static_cast<std::uint32_t>(p.first_point), p.instance, 0, primitive});
    if (!p.triangles.empty())
      triangle_runs_.push_back({static_cast<std::uint32_t>(p.first_triangle), p.instance, 0, primitive});
  }
}

}  // namespace dupin
