// Triangles on the limit surface by uniform refinement and limit masks: a reference beside the exact patches.
#include <algorithm>
#include <cmath>

#include "limit_part.h"

namespace dupin {
namespace {

/// Faces of one level with the node of the forest that each lies in.
std::vector<std::uint32_t> nodes_of_children(const LimitForest& forest, const CageLevel& level,
                                             const std::vector<std::uint32_t>& nodes,
                                             std::size_t next_count) {
  std::vector<std::uint32_t> out(next_count, kNoIndex);
  for (std::uint32_t f = 0; f < level.face_count(); ++f) {
    if (nodes[f] == kNoIndex) continue;
    const LimitNode& node = forest.nodes[nodes[f]];
    const auto children = level.children(f);
    for (std::size_t k = 0; k < children.size(); ++k) {
      const auto corners = static_cast<std::size_t>(forest.corners());
      const bool turned = children.size() == 4 && !(corners == 3 && k == 3) && node.level > 0;
      const std::size_t local = turned ? (k + corners - node.rotation % corners) % corners : k;
      out[children[k]] = node.leaf() ? nodes[f] : node.first_child + static_cast<std::uint32_t>(local);
    }
  }
  return out;
}

void add_polygon(const CageLevel& level, std::uint32_t face, std::uint32_t of, TriangleMesh& mesh) {
  const auto vertices = level.vertices(face);
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    for (std::uint32_t v : {vertices[0], vertices[i - 1], vertices[i]}) mesh.triangles.push_back(v);
    mesh.faces.push_back(of);
  }
}

std::array<float, 3> to_float(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// Across a crease each side has its normal: vertices there are doubled, one for each smooth fan. They are
/// given the area-weighted normal of their side's triangles.
class CreaseNormals {
 public:
  CreaseNormals(const CageLevel& level, TriangleMesh& mesh) : level_(level), mesh_(mesh) {}

  void split() {
    std::vector<std::uint8_t> sharp(level_.points.size(), 0);
    for (std::size_t e = 0; e < level_.edge_vertices.size(); ++e)
      if (level_.edge_faces[e][0] == kNoIndex)
        for (std::uint32_t v : level_.edge_vertices[e]) sharp[v] = 1;
    for (std::size_t v = 0; v < sharp.size(); ++v) sharp[v] |= level_.rules[v] == VertexRule::corner;
    std::vector<std::vector<std::uint32_t>> triangles(sharp.size());
    for (std::uint32_t t = 0; t < mesh_.faces.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        if (const std::uint32_t v = mesh_.triangles[3 * t + c]; sharp[v]) triangles[v].push_back(t);
    for (std::uint32_t v = 0; v < sharp.size(); ++v)
      if (sharp[v]) split_vertex(v, triangles[v]);
  }

 private:
  Vec3 point(std::uint32_t v) const {
    const auto& p = mesh_.positions[v];
    return {p[0], p[1], p[2]};
  }
  Vec3 normal(std::uint32_t t) const {
    const Vec3 a = point(mesh_.triangles[3 * t]);
    return cross(point(mesh_.triangles[3 * t + 1]) - a, point(mesh_.triangles[3 * t + 2]) - a);
  }

  /// Triangles of one fan share edges at the vertex that are no creases: found by their normals' agreement,
  /// which a fine mesh has.
  void split_vertex(std::uint32_t v, std::vector<std::uint32_t> triangles) {
    constexpr double kOneFan = 0.9;
    bool first = true;
    while (!triangles.empty()) {
      const Vec3 seed = normalized(normal(triangles.front()));
      Vec3 sum;
      std::vector<std::uint32_t> fan, rest;
      for (std::uint32_t t : triangles) {
        const Vec3 n = normal(t);
        const bool same = t == triangles.front() || dot(n, seed) > kOneFan * length(n);
        (same ? fan : rest).push_back(t);
        if (same) sum += n;
      }
      const std::uint32_t to = first ? v : static_cast<std::uint32_t>(mesh_.positions.size());
      if (!first) mesh_.positions.push_back(mesh_.positions[v]), mesh_.normals.push_back({});
      mesh_.normals[to] = to_float(length(sum) > 0 ? normalized(sum) : Vec3{0, 0, 1});
      for (std::uint32_t t : fan)
        for (std::size_t c = 0; c < 3; ++c)
          if (mesh_.triangles[3 * t + c] == v) mesh_.triangles[3 * t + c] = to;
      triangles.swap(rest);
      first = false;
    }
  }

  const CageLevel& level_;
  TriangleMesh& mesh_;
};

}  // namespace

int tessellation_levels(const PolygonMesh& cage, int segments, std::size_t most_triangles) {
  const double per_face = 2 * static_cast<double>(std::max<std::size_t>(cage.polygon_count(), 1));
  int level = 1;
  while (level < 10 && (1 << level) < segments &&
         per_face * std::ldexp(1.0, 2 * (level + 1)) <= static_cast<double>(most_triangles))
    ++level;
  return level;
}

TriangleMesh tessellate_limit(const LimitForest& forest, const PolygonMesh& cage,
                              const std::vector<std::uint32_t>& face_of, int levels) {
  const Result<CageLevels> refined = refine_cage(cage, {forest.cage.scheme, levels, false});
  TriangleMesh mesh;
  if (!refined.ok()) return mesh;
  std::vector<std::uint32_t> nodes = forest.roots;
  for (std::size_t l = 0; l + 1 < refined->levels.size(); ++l)
    nodes = nodes_of_children(forest, refined->levels[l], nodes, refined->levels[l + 1].face_count());
  const CageLevel& last = refined->levels.back();
  Box3 box;
  for (const Vec3& p : refined->limits) box.add(p);
  mesh.origin = box.center();
  for (std::size_t v = 0; v < refined->limits.size(); ++v) {
    mesh.positions.push_back(to_float(refined->limits[v] - mesh.origin));
    const Vec3 n = cross(refined->tangents_u[v], refined->tangents_v[v]);
    mesh.normals.push_back(to_float(length(n) > 0 ? normalized(n) : Vec3{0, 0, 1}));
  }
  for (std::uint32_t f = 0; f < last.face_count(); ++f)
    if (nodes[f] != kNoIndex && face_of[nodes[f]] != kNoIndex) add_polygon(last, f, face_of[nodes[f]], mesh);
  CreaseNormals(last, mesh).split();
  return mesh;
}

}  // namespace dupin
