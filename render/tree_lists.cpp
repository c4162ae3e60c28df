#include "tree_lists.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

TreeLists::TreeLists(const Gl& gl, const std::vector<PartTree>& trees, const Scene::Impl& scene,
                     std::uint32_t layer)
    : trees_(trees), layer_(layer), arena_(gl, only_trees(trees)) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::size_t part = scene.instances[i].part;
    if (part < trees_.size() && trees_[part].tree)
      placed_.push_back({part, i, PointCut(trees_[part].tree), {}});
  }
  looks_.resize(placed_.size());
}

void TreeLists::find(const Scene::Impl& scene, const ViewRays& view,
                     std::span<const DrawOptions::Section> sections, const TreeLayerOptions& options) {
  const SidePlanes sides = side_planes(view, sections);
  const CutOptions cut{options.threshold_px, options.silhouette, options.leaves_as_points};
  parallel_for(placed_.size(), [&](std::size_t i) {
    PlacedTree& p = placed_[i];
    const SceneInstance& instance = scene.instances[p.instance];
    if (!instance.visible) return;
    const ScenePart& part = scene.parts[instance.part];
    p.camera = part_camera(instance, part, view, sides);
    p.view = cut_view(p.camera, instance, view, p.cut.tree().info().grid, part.anchor, cut);
    // Cones know what is closed; but from within anything may be seen from behind.
    const Vec3 eye = transform_point(instance.to_part, view.eye);
    p.view.cull_turned_away = sections.empty() && !(view.perspective && part.box.contains(eye));
    p.cut.update(p.view, options.coherent);
  });
}

bool TreeLists::looks_changed(const Scene::Impl& scene) {
  bool changed = false;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const FaceColors& now = scene.instances[placed_[i].instance].colors;
    if (looks_[i].whole == now.whole && looks_[i].faces == now.faces) continue;
    looks_[i] = now;
    changed = true;
  }
  return changed;
}

std::uint32_t TreeLists::group_of_node(const PlacedTree& p, std::uint32_t node) const {
  return p.cut.tree().groups().size() > 1 ? p.cut.tree().node_group(node) : 0;
}
std::uint32_t TreeLists::group_of_leaf(const PlacedTree& p, std::uint32_t rank) const {
  return p.cut.tree().groups().size() > 1 ? p.cut.tree().leaf_group(rank) : 0;
}

TreeLists::Pieces TreeLists::pieces_of(const Scene::Impl& scene, const PlacedTree& p) const {
  Pieces pieces;
  const SceneInstance& instance = scene.instances[p.instance];
  if (!instance.visible) return pieces;
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
  return pieces;
}

void TreeLists::number(std::vector<Pieces>& pieces) {
  std::size_t points = 0, triangles = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    PlacedTree& p = placed_[i];
    p.first_point = points, p.first_triangle = triangles;
    for (Piece& piece : pieces[i].points) piece.at = points, points += piece.list->size();
    for (Piece& piece : pieces[i].leaves) {
      piece.at = triangles;
      for (const std::uint32_t rank : *piece.list) {
        const auto [first, last] = arena_.triangles_of(p.tree, rank);
        triangles += last - first;
      }
    }
    p.points = points - p.first_point, p.triangles = triangles - p.first_triangle;
  }
  points_.resize(points), extras_.resize(points);
  drawn_.resize(triangles), indices_.resize(triangles);
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

void TreeLists::fill_points(const PlacedTree& p, const Piece& piece, const Indices& faces) {
  const PointTree& tree = p.cut.tree();
  std::size_t at = piece.at;
  for (const std::uint32_t node : *piece.list) {
    const auto encoded = tree.nodes(node, 1);
    points_[at] = encoded.empty() ? EncodedNode{} : encoded[0];
    extras_[at] = {curvature_of(tree, node, points_[at]), node, faces[group_of_node(p, node)], 0};
    ++at;
  }
}

void TreeLists::fill_triangles(const PlacedTree& p, const Piece& piece, const Indices& faces) {
  std::size_t at = piece.at;
  for (const std::uint32_t rank : *piece.list) {
    const auto [first, last] = arena_.triangles_of(p.tree, rank);
    const std::uint32_t face = faces[group_of_leaf(p, rank)];
    for (std::uint32_t t = first; t < last; ++t) {
      indices_[at] = t;
      drawn_[at++] = {t, face};
    }
  }
}

void TreeLists::fill(const Scene::Impl& scene, const PlacedTree& p, const Pieces& pieces) {
  const Indices faces = faces_of(scene, p);
  parallel_for(pieces.points.size(), [&](std::size_t i) { fill_points(p, pieces.points[i], faces); });
  parallel_for(pieces.leaves.size(), [&](std::size_t i) { fill_triangles(p, pieces.leaves[i], faces); });
}

bool TreeLists::gather(const Scene::Impl& scene) {
  bool changed = looks_changed(scene) || !gathered_;
  for (const PlacedTree& p : placed_)
    changed = changed || (scene.instances[p.instance].visible && p.cut.changed());
  if (!changed) return false;
  gathered_ = true;
  std::vector<Pieces> pieces(placed_.size());
  parallel_for(placed_.size(), [&](std::size_t i) {
    pieces[i] = pieces_of(scene, placed_[i]);
    if (!pieces[i].visible_points.empty()) pieces[i].points.push_back({&pieces[i].visible_points, 0});
    if (!pieces[i].visible_leaves.empty()) pieces[i].leaves.push_back({&pieces[i].visible_leaves, 0});
  });
  for (std::size_t i = 0; i < placed_.size(); ++i)
    for (const Piece& piece : pieces[i].leaves) arena_.want(placed_[i].tree, *piece.list);
  arena_.load();
  number(pieces);
  parallel_for(placed_.size(), [&](std::size_t i) { fill(scene, placed_[i], pieces[i]); });
  make_runs(scene);
  return true;
}

void TreeLists::make_runs(const Scene::Impl& scene) {
  point_runs_.clear(), triangle_runs_.clear();
  for (const PlacedTree& p : placed_) {
    const SceneInstance& instance = scene.instances[p.instance];
    const std::uint32_t primitive =
        instance.first_primitive + scene.parts[instance.part].first_in_layer[layer_];
    if (p.points > 0)
      point_runs_.push_back({static_cast<std::uint32_t>(p.first_point), p.instance, 0, primitive});
    if (p.triangles > 0)
      triangle_runs_.push_back({static_cast<std::uint32_t>(p.first_triangle), p.instance, 0, primitive});
  }
}

}  // namespace dupin
