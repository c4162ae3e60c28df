#include "point_trees.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../nurbs/join_meshes.h"

namespace dupin::app {
namespace {

void add_tessellation(const Part& part, PolygonMesh& mesh) {
  const TriangleMesh& from = part.mesh;
  for (const auto& p : from.positions) mesh.positions.push_back(from.origin + Vec3{p[0], p[1], p[2]});
  mesh.normals = from.normals;
  mesh.corners = from.triangles;
  mesh.polygon_groups = from.faces;
  for (const Face& face : part.faces) mesh.groups.push_back({face.name, face.color});
}

/// Of what has no colour, as the renderer has it (kPlainColor).
constexpr Rgba8 kPlain{196, 198, 203, 255};

/// Into model space; with the colours that a placement gives to what has none.
void place_mesh(const Instance& instance, const Part& part, PolygonMesh& mesh) {
  const Mat3 turn = cofactor(instance.to_world.linear);
  const bool mirrored = determinant(instance.to_world.linear) < 0;
  for (Vec3& p : mesh.positions) p = transform_point(instance.to_world, p);
  for (auto& n : mesh.normals) {
    const Vec3 turned = normalized(turn * Vec3{n[0], n[1], n[2]}) * (mirrored ? -1.0 : 1.0);
    n = {static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z)};
  }
  for (std::size_t i = 0; mirrored && i < mesh.polygon_count(); ++i) {
    const auto first = mesh.corners.begin() + static_cast<std::ptrdiff_t>(mesh.first_corner(i));
    std::reverse(first, first + static_cast<std::ptrdiff_t>(mesh.corner_count(i)));
  }
  if (mesh.groups.empty()) mesh.groups.push_back({part.name, std::nullopt});
  for (MeshGroup& group : mesh.groups)
    if (!group.color) group.color = instance.color ? instance.color : part.color;
}

/// From the part to model space, as its first placement has it.
double scale_of(const Model& model, std::size_t part) {
  for (const Instance& instance : model.instances)
    if (instance.part == part) return std::cbrt(std::abs(determinant(instance.to_world.linear)));
  return 1;
}

}  // namespace

PolygonMesh tessellation(const Part& part) {
  PolygonMesh mesh;
  add_tessellation(part, mesh);
  if (part.polygons.polygon_count() > 0) append(mesh, part.polygons, kPlain);
  simplify_layout(mesh);
  return mesh;
}

PlacedMesh placed_mesh(const Model& model) {
  PlacedMesh placed;
  const auto whole = [](const Part& part) { return part.faces.empty() ? part.polygons : tessellation(part); };
  if (model.parts.size() == 1 && model.instances.size() == 1) {
    const Mat3& m = model.instances[0].to_world.linear;
    placed.scale = scale_of(model, 0);
    const Mat3 scaled{{placed.scale, 0, 0}, {0, placed.scale, 0}, {0, 0, placed.scale}};
    if (m == scaled && model.instances[0].to_world.translation == Vec3{}) {
      placed.mesh = whole(model.parts[0]);
      return placed;
    }
  }
  placed.scale = 1;
  for (const Instance& instance : model.instances) {
    PolygonMesh mesh = whole(model.parts[instance.part]);
    place_mesh(instance, model.parts[instance.part], mesh);
    append(placed.mesh, mesh, kPlain);
  }
  simplify_layout(placed.mesh);
  return placed;
}

Result<std::vector<PartTree>> make_point_trees(const Model& model, const KnownTrees& known,
                                               const TreeRequest& request) {
  std::vector<PartTree> trees(model.parts.size());
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const Part& part = model.parts[i];
    if (i < known.trees.size() && known.trees[i]) {
      trees[i] = {known.trees[i], static_cast<std::uint32_t>(part.faces.size())};
      continue;
    }
    const bool tessellated = request.faces && !part.mesh.triangles.empty();
    PolygonMesh made;
    if (tessellated)
      made = tessellation(part);
    else
      trees[i].first_face = static_cast<std::uint32_t>(part.faces.size());
    const PolygonMesh& mesh = tessellated ? made : part.polygons;
    if (mesh.empty()) continue;
    PointTreeOptions options;
    options.kind = request.kind;
    options.source.name = part.name;
    options.source.unit_note = model.unit_note;
    options.source.scale = scale_of(model, i);
    options.progress = request.progress;
    auto tree = build_point_tree(mesh, options);
    if (!tree.ok()) return {tree.status().code, model.source + ": " + tree.status().message};
    trees[i].tree = std::move(*tree);
    if (i < known.files.size() && !known.files[i].empty())
      (void)write_point_tree(*trees[i].tree, known.files[i]);
  }
  return trees;
}

}  // namespace dupin::app
