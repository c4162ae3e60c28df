#include "polygon_mesh.h"

#include <algorithm>
#include <cmath>

namespace dupin {
namespace {

// The reason why something is not valid, or nullptr.
using Reason = const char*;

bool in_range(const std::vector<std::uint32_t>& indices, std::size_t count) {
  for (const std::uint32_t i : indices)
    if (i >= count) return false;
  return true;
}

Reason check_polygons(const PolygonMesh& mesh) {
  if (!mesh.starts.empty()) {
    if (mesh.starts.front() != 0 || mesh.starts.back() != mesh.corners.size())
      return "its polygons do not cover its corners";
    for (std::size_t i = 0; i + 1 < mesh.starts.size(); ++i)
      if (mesh.starts[i + 1] < mesh.starts[i] || mesh.starts[i + 1] - mesh.starts[i] < 3)
        return "a polygon has fewer than three corners";
  } else if (mesh.corners.size() % 3 != 0) {
    return "a triangle is not complete";
  }
  return in_range(mesh.corners, mesh.positions.size()) ? nullptr : "a polygon refers to no vertex";
}

Reason check_attributes(const PolygonMesh& mesh) {
  if (mesh.corner_normals.empty() && !mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    return "a mesh has a wrong number of normals";
  if (!mesh.corner_normals.empty() && mesh.corner_normals.size() != mesh.corners.size())
    return "a mesh has a wrong number of corner normals";
  for (const std::uint32_t i : mesh.corner_normals)
    if (i >= mesh.normals.size() && i != PolygonMesh::kNoNormal) return "a corner refers to no normal";
  if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size())
    return "a mesh has a wrong number of colours";
  if (!mesh.polygon_colors.empty() && mesh.polygon_colors.size() != mesh.polygon_count())
    return "a mesh has a wrong number of polygon colours";
  if (!mesh.polygon_groups.empty() && (mesh.polygon_groups.size() != mesh.polygon_count() ||
                                       !in_range(mesh.polygon_groups, mesh.groups.size())))
    return "a polygon refers to no group";
  return nullptr;
}

Reason check_numbers(const PolygonMesh& mesh) {
  for (const Vec3& p : mesh.positions)
    if (!is_finite(p)) return "a vertex is not finite";
  for (const auto& n : mesh.normals)
    if (!std::isfinite(n[0]) || !std::isfinite(n[1]) || !std::isfinite(n[2])) return "a normal is not finite";
  return nullptr;
}

Reason check_tags(const PolygonMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  for (const auto& crease : mesh.tags.creases)
    if (crease.a >= vertices || crease.b >= vertices || !std::isfinite(crease.sharpness))
      return "a crease refers to no vertex";
  for (const auto& corner : mesh.tags.corners)
    if (corner.vertex >= vertices || !std::isfinite(corner.sharpness))
      return "a corner tag refers to no vertex";
  return in_range(mesh.tags.holes, mesh.polygon_count()) ? nullptr : "a hole refers to no polygon";
}

}  // namespace

std::size_t triangle_count(const PolygonMesh& mesh) {
  return mesh.corners.size() - 2 * mesh.polygon_count();
}

std::size_t face_count(const PolygonMesh& mesh) {
  return mesh.empty() ? mesh.groups.size() : std::max<std::size_t>(1, mesh.groups.size());
}

Box3 bounding_box(const PolygonMesh& mesh) {
  Box3 box;
  for (const Vec3& p : mesh.positions) box.add(p);
  return box;
}

std::size_t loose_point_count(const PolygonMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const std::uint32_t v : mesh.corners) used[v] = true;
  std::size_t count = 0;
  for (const bool u : used) count += !u;
  return count;
}

void simplify_layout(PolygonMesh& mesh) {
  bool triangles = true, by_vertex = mesh.normals.size() == mesh.positions.size(), first_group = true;
  for (std::size_t i = 0; triangles && i < mesh.starts.size(); ++i) triangles = mesh.starts[i] == 3 * i;
  for (std::size_t i = 0; by_vertex && i < mesh.corner_normals.size(); ++i)
    by_vertex = mesh.corner_normals[i] == mesh.corners[i];
  for (std::size_t i = 0; first_group && i < mesh.polygon_groups.size(); ++i)
    first_group = mesh.polygon_groups[i] == 0;
  if (triangles) mesh.starts = {};
  if (by_vertex) mesh.corner_normals = {};
  if (first_group) mesh.polygon_groups = {};
}

Status check(const PolygonMesh& mesh) {
  for (const auto rule : {check_polygons, check_attributes, check_numbers, check_tags})
    if (Reason reason = rule(mesh)) return {StatusCode::unreadable, reason};
  return {};
}

}  // namespace dupin
