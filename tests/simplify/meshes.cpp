#include "meshes.h"

#include <cmath>
#include <numbers>
#include <random>

namespace dupin::test {

PolygonMesh ball(int rings, double radius, const Vec3& center) {
  PolygonMesh mesh;
  const int around = 2 * rings;
  const auto add = [&](double theta, double phi) {
    const Vec3 n{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    mesh.positions.push_back(center + n * radius);
    mesh.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  };
  add(0, 0);
  for (int i = 1; i < rings; ++i)
    for (int k = 0; k < around; ++k) add(std::numbers::pi * i / rings, 2 * std::numbers::pi * k / around);
  add(std::numbers::pi, 0);
  const auto at = [&](int i, int k) {
    if (i == 0) return 0U;
    if (i == rings) return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    return static_cast<std::uint32_t>(1 + (i - 1) * around + k % around);
  };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      if (i > 0) mesh.corners.insert(mesh.corners.end(), {at(i, k), at(i + 1, k), at(i, k + 1)});
      if (i + 1 < rings)
        mesh.corners.insert(mesh.corners.end(), {at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)});
    }
  return mesh;
}

PolygonMesh terrain(int n) {
  PolygonMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const double x = double(i) / n, y = double(k) / n;
      mesh.positions.push_back({x, y, 0.1 * std::sin(9 * x) * std::cos(7 * y)});
    }
  const auto at = [n](int i, int k) { return static_cast<std::uint32_t>(i * (n + 1) + k); };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      mesh.corners.insert(mesh.corners.end(), {at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k),
                                               at(i + 1, k + 1), at(i, k + 1)});
  return mesh;
}

PolygonMesh box() {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  mesh.corners = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

PolygonMesh soup(int triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1, 1), step(-0.05, 0.05);
  PolygonMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 p{place(random), place(random), place(random)};
    for (int k = 0; k < 3; ++k) {
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(p + Vec3{step(random), step(random), step(random)});
    }
  }
  return mesh;
}

PolygonMesh joined(const PolygonMesh& a, const PolygonMesh& b) {
  PolygonMesh mesh;
  mesh.positions = a.positions;
  mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
  mesh.corners = a.corners;
  for (const std::uint32_t v : b.corners)
    mesh.corners.push_back(static_cast<std::uint32_t>(a.positions.size()) + v);
  return mesh;
}

}  // namespace dupin::test
