#include "join_meshes.h"

#include <algorithm>
#include <cmath>

namespace dupin {
namespace {

template <class T>
void add(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}
void add_shifted(std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& from, std::size_t by) {
  for (const std::uint32_t i : from)
    to.push_back(i == PolygonMesh::kNoNormal ? i : i + static_cast<std::uint32_t>(by));
}

std::uint8_t srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0F, 1.0F);
  return static_cast<std::uint8_t>(
      std::lround(255 * (c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1 / 2.4F) - 0.055F)));
}

Rgba8 polygon_color(const PolygonMesh& mesh, std::size_t polygon, const Rgba8& plain) {
  if (!mesh.polygon_colors.empty()) return mesh.polygon_colors[polygon];
  const std::uint32_t g = mesh.group_of(polygon);
  if (g >= mesh.groups.size() || !mesh.groups[g].color) return plain;
  const Color& c = *mesh.groups[g].color;
  return {srgb_byte(c.r), srgb_byte(c.g), srgb_byte(c.b), static_cast<std::uint8_t>(std::lround(255 * c.a))};
}

std::vector<Rgba8> polygon_colors(const PolygonMesh& mesh, const Rgba8& plain) {
  std::vector<Rgba8> colors(mesh.polygon_count());
  for (std::size_t i = 0; i < colors.size(); ++i) colors[i] = polygon_color(mesh, i, plain);
  return colors;
}

/// A vertex has the colour of the last polygon that it belongs to.
std::vector<Rgba8> vertex_colors(const PolygonMesh& mesh, const Rgba8& plain) {
  if (!mesh.colors.empty()) return mesh.colors;
  std::vector<Rgba8> colors(mesh.positions.size(), plain);
  for (std::size_t i = 0; i < mesh.polygon_count(); ++i)
    for (const std::uint32_t v : mesh.polygon(i)) colors[v] = polygon_color(mesh, i, plain);
  return colors;
}

void join_colors(PolygonMesh& to, const PolygonMesh& from, const Rgba8& plain) {
  if (!to.colors.empty() || !from.colors.empty()) {
    to.colors = vertex_colors(to, plain);
    add(to.colors, vertex_colors(from, plain));
    to.polygon_colors.clear();
  } else if (!to.polygon_colors.empty() || !from.polygon_colors.empty()) {
    to.polygon_colors = polygon_colors(to, plain);
    add(to.polygon_colors, polygon_colors(from, plain));
  }
}

std::vector<std::uint32_t> corner_normals(const PolygonMesh& mesh) {
  if (mesh.normals.empty()) return std::vector<std::uint32_t>(mesh.corners.size(), PolygonMesh::kNoNormal);
  return mesh.corner_normals.empty() ? mesh.corners : mesh.corner_normals;
}

bool normals_by_vertex(const PolygonMesh& mesh) {
  return mesh.corner_normals.empty() && mesh.normals.size() == mesh.positions.size();
}

void join_normals(PolygonMesh& to, const PolygonMesh& from) {
  if (to.normals.empty() && from.normals.empty()) return;
  if (!normals_by_vertex(to) || !normals_by_vertex(from)) {
    to.corner_normals = corner_normals(to);
    add_shifted(to.corner_normals, corner_normals(from), to.normals.size());
  }
  add(to.normals, from.normals);
}

void join_polygons(PolygonMesh& to, const PolygonMesh& from) {
  if (!to.starts.empty() || !from.starts.empty()) {
    if (to.starts.empty())
      for (std::size_t i = 0; i <= to.corners.size(); i += 3)
        to.starts.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t i = 0; i < from.polygon_count(); ++i)
      to.starts.push_back(to.starts.back() + static_cast<std::uint32_t>(from.corner_count(i)));
  }
  add_shifted(to.corners, from.corners, to.positions.size());
}

void join_groups(PolygonMesh& to, const PolygonMesh& from) {
  if (to.groups.empty() && !to.positions.empty()) to.groups.emplace_back();
  to.polygon_groups.resize(to.polygon_count(), 0);
  for (std::size_t i = 0; i < from.polygon_count(); ++i)
    to.polygon_groups.push_back(static_cast<std::uint32_t>(to.groups.size()) + from.group_of(i));
  add(to.groups, from.groups);
  if (from.groups.empty()) to.groups.emplace_back();
}

}  // namespace

void append(PolygonMesh& to, const PolygonMesh& from, const Rgba8& plain) {
  if (from.empty()) return;
  join_colors(to, from, plain);
  join_normals(to, from);
  join_groups(to, from);
  join_polygons(to, from);
  add(to.positions, from.positions);
  to.tags = {};
}

}  // namespace dupin
