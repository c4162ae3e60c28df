#include "point_trees.h"

#include <utility>

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

/// Polygons of any size keep theirs; normals stay where both have them by vertex.
void add_polygons(const PolygonMesh& from, PolygonMesh& mesh) {
  const auto first_vertex = static_cast<std::uint32_t>(mesh.positions.size());
  const auto first_group = static_cast<std::uint32_t>(mesh.groups.size());
  for (std::uint32_t i = 0; i <= mesh.polygon_count() && mesh.starts.empty(); ++i)
    if (3 * i <= mesh.corners.size()) mesh.starts.push_back(3 * i);
  mesh.positions.insert(mesh.positions.end(), from.positions.begin(), from.positions.end());
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t i = 0; i < from.polygon_count(); ++i) {
    for (const std::uint32_t v : from.polygon(i)) mesh.corners.push_back(first_vertex + v);
    mesh.starts.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    mesh.polygon_groups.push_back(first_group + from.group_of(i));
  }
  if (from.groups.empty()) mesh.groups.emplace_back();
  mesh.groups.insert(mesh.groups.end(), from.groups.begin(), from.groups.end());
  simplify_layout(mesh);
}

}  // namespace

PolygonMesh tessellation(const Part& part) {
  PolygonMesh mesh;
  add_tessellation(part, mesh);
  if (part.polygons.polygon_count() > 0) add_polygons(part.polygons, mesh);
  return mesh;
}

Result<std::vector<PartTree>> make_point_trees(const Model& model, const TreeRequest& request) {
  std::vector<PartTree> trees(model.parts.size());
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const Part& part = model.parts[i];
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
    options.progress = request.progress;
    auto tree = build_point_tree(mesh, options);
    if (!tree.ok()) return {tree.status().code, model.source + ": " + tree.status().message};
    trees[i].tree = std::move(*tree);
  }
  return trees;
}

}  // namespace dupin::app
