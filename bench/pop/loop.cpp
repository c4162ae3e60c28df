#include "loop.h"

#include <algorithm>
#include <array>

#include "../../nurbs/mesh_triangles.h"

namespace dupin::bench {
namespace {

struct Edge {
  std::uint32_t a, b;  ///< a < b
  std::uint32_t side;  ///< 3 · triangle + corner of its start
  std::uint32_t opposite;
};

class Loop {
 public:
  explicit Loop(const PolygonMesh& mesh) : mesh_(mesh) {
    for (const std::uint32_t corner : triangulate(mesh)) vertices_.push_back(mesh.corners[corner]);
    for (std::uint32_t side = 0; side < vertices_.size(); ++side) {
      const std::uint32_t t = side / 3 * 3, k = side % 3;
      const std::uint32_t a = vertices_[side], b = vertices_[t + (k + 1) % 3];
      edges_.push_back({std::min(a, b), std::max(a, b), side, vertices_[t + (k + 2) % 3]});
    }
    std::sort(edges_.begin(), edges_.end(), [](const Edge& x, const Edge& y) {
      return std::array{x.a, x.b, x.side} < std::array{y.a, y.b, y.side};
    });
  }

  PolygonMesh run() {
    result_.positions.resize(mesh_.positions.size());
    std::vector<std::uint32_t> middle(vertices_.size());
    std::vector<Sums> smooth(mesh_.positions.size()), crease(mesh_.positions.size());
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t end = i;
      while (end < edges_.size() && edges_[end].a == edges_[i].a && edges_[end].b == edges_[i].b) ++end;
      const bool inner = end - i == 2;
      const Edge& e = edges_[i];
      const Vec3 &a = mesh_.positions[e.a], &b = mesh_.positions[e.b];
      for (auto* sums : {&smooth, &crease})
        if (sums == &smooth || !inner) (*sums)[e.a].add(b), (*sums)[e.b].add(a);
      for (std::size_t k = i; k < end; ++k)
        middle[edges_[k].side] = static_cast<std::uint32_t>(result_.positions.size());
      result_.positions.push_back(
          inner ? (a + b) * 0.375 +
                      (mesh_.positions[e.opposite] + mesh_.positions[edges_[i + 1].opposite]) * 0.125
                : (a + b) * 0.5);
      i = end;
    }
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v)
      result_.positions[v] = moved(mesh_.positions[v], smooth[v], crease[v]);
    for (std::size_t t = 0; t < vertices_.size(); t += 3)
      for (const auto& [x, y, z] : {std::array{vertices_[t], middle[t], middle[t + 2]},
                                    std::array{vertices_[t + 1], middle[t + 1], middle[t]},
                                    std::array{vertices_[t + 2], middle[t + 2], middle[t + 1]},
                                    std::array{middle[t], middle[t + 1], middle[t + 2]}})
        for (const std::uint32_t v : {x, y, z}) result_.corners.push_back(v);
    return std::move(result_);
  }

 private:
  struct Sums {
    Vec3 sum;
    int count = 0;
    void add(const Vec3& p) { sum += p, ++count; }
  };
  static Vec3 moved(const Vec3& p, const Sums& smooth, const Sums& crease) {
    if (smooth.count == 0 || (crease.count > 0 && crease.count != 2)) return p;
    if (crease.count == 2) return p * 0.75 + crease.sum * 0.125;
    const double beta = smooth.count == 3 ? 3.0 / 16 : 3.0 / (8 * smooth.count);
    return p * (1 - smooth.count * beta) + smooth.sum * beta;
  }

  const PolygonMesh& mesh_;
  std::vector<std::uint32_t> vertices_;  ///< three a triangle
  std::vector<Edge> edges_;              ///< of each triangle, those of two vertices together
  PolygonMesh result_;
};

}  // namespace

PolygonMesh loop_subdivided(const PolygonMesh& mesh) {
  return Loop(mesh).run();
}

}  // namespace dupin::bench
