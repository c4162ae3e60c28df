#include "surfaces.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

namespace dupin::test {
namespace {

void add(SurfacePoints& points, const Vec3& p, std::uint32_t face) {
  points.positions.push_back(p);
  points.faces.push_back(face);
}

Vec3 on_octant(std::uint32_t octant, double a, double b) {
  return {octant & 1 ? a : -a, octant & 2 ? b : -b, octant & 4 ? 1 - a - b : a + b - 1};
}

Vec3 on_side(std::uint32_t side, double a, double b) {
  const double w = side & 1 ? 1 : -1;
  return side / 2 == 0 ? Vec3{w, a, b} : side / 2 == 1 ? Vec3{a, w, b} : Vec3{a, b, w};
}

}  // namespace

SurfacePoints octahedron(int count, unsigned seed) {
  SurfacePoints points;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < count; ++i) {
    double a = unit(random), b = unit(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    add(points, on_octant(static_cast<std::uint32_t>(i % 8), a, b), static_cast<std::uint32_t>(i % 8));
  }
  return points;
}

SurfacePoints octahedron_lattice(int count) {
  SurfacePoints points;
  const int n = static_cast<int>(std::lround(std::sqrt(count / 4.0)));
  for (std::uint32_t octant = 0; octant < 8; ++octant)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) add(points, on_octant(octant, double(i) / n, double(j) / n), octant);
  return points;
}

SurfacePoints cube(int count, unsigned seed) {
  SurfacePoints points;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-1, 1);
  for (int i = 0; i < count; ++i) {
    const double a = side(random), b = side(random);
    add(points, on_side(static_cast<std::uint32_t>(i % 6), a, b), static_cast<std::uint32_t>(i % 6));
  }
  return points;
}

SurfacePoints cube_lattice(int count) {
  SurfacePoints points;
  const int n = static_cast<int>(std::lround(std::sqrt(count / 6.0)));
  for (std::uint32_t side = 0; side < 6; ++side)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        add(points, on_side(side, 2.0 * i / (n - 1) - 1, 2.0 * j / (n - 1) - 1), side);
  return points;
}

SurfacePoints sphere_mesh(int rings) {
  SurfacePoints points;
  const int around = 2 * rings;
  const auto vertex = [&](int i, int j) {
    return i == 0 ? 0U : i == rings ? 1U : static_cast<std::uint32_t>(2 + (i - 1) * around + j % around);
  };
  points.positions = {{0, 0, 1}, {0, 0, -1}};
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
      points.positions.push_back(
          {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
    }
  points.normals = points.positions;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                          d = vertex(i, j + 1);
      if (a != d) points.triangles.insert(points.triangles.end(), {a, b, d});
      if (b != c) points.triangles.insert(points.triangles.end(), {d, b, c});
    }
  return points;
}

SurfacePoints read_obj(const std::string& path) {
  SurfacePoints points;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    Vec3 v;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3) points.positions.push_back(v);
    if (line.rfind("f ", 0) != 0) continue;
    std::istringstream words(line.substr(2));
    std::vector<std::uint32_t> polygon;
    for (std::string word; words >> word;)
      polygon.push_back(static_cast<std::uint32_t>(std::strtoul(word.c_str(), nullptr, 10) - 1));
    for (std::size_t k = 2; k < polygon.size(); ++k)
      points.triangles.insert(points.triangles.end(), {polygon[0], polygon[k - 1], polygon[k]});
  }
  return points;
}

}  // namespace dupin::test
