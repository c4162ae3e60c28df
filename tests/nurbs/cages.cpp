#include "cages.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "../../nurbs/limit_basis.h"

namespace dupin::test {
namespace {

double noise(std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(-1, 1)(random);
}

}  // namespace

PolygonMesh cage_of(std::vector<Vec3> positions, const std::vector<std::vector<std::uint32_t>>& polygons) {
  PolygonMesh mesh;
  mesh.positions = std::move(positions);
  mesh.starts.push_back(0);
  for (const auto& polygon : polygons) {
    mesh.corners.insert(mesh.corners.end(), polygon.begin(), polygon.end());
    mesh.starts.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }
  simplify_layout(mesh);
  return mesh;
}

PolygonMesh cube_cage() {
  std::vector<Vec3> p;
  for (int i = 0; i < 8; ++i) p.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  return cage_of(p, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

PolygonMesh icosahedron_cage() {
  const double g = std::numbers::phi;
  std::vector<Vec3> p{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  return cage_of(p, {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}});
}

namespace {

std::vector<std::vector<std::uint32_t>> lattice_polygons(int nu, int nv, bool wrap, bool triangles) {
  std::vector<std::vector<std::uint32_t>> polygons;
  const int last_u = wrap ? nu : nu - 1, last_v = wrap ? nv : nv - 1;
  for (int i = 0; i < last_u; ++i)
    for (int j = 0; j < last_v; ++j) {
      const auto at = [&](int a, int b) { return static_cast<std::uint32_t>((a % nu) * nv + b % nv); };
      const std::uint32_t p = at(i, j), q = at(i + 1, j), r = at(i + 1, j + 1), s = at(i, j + 1);
      if (triangles) {
        polygons.push_back({p, q, s});
        polygons.push_back({q, r, s});
      } else {
        polygons.push_back({p, q, r, s});
      }
    }
  return polygons;
}

}  // namespace

PolygonMesh torus_cage(int around, int across, bool triangles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Vec3> p;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = 3 + std::cos(b) + 0.1 * noise(random);
      p.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
    }
  return cage_of(p, lattice_polygons(around, across, true, triangles));
}

PolygonMesh grid_cage(int nu, int nv, bool triangles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Vec3> p;
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j)
      p.push_back({i + 0.1 * noise(random), j + 0.1 * noise(random), 0.5 * noise(random)});
  return cage_of(p, lattice_polygons(nu, nv, false, triangles));
}

FanCage::Place FanCage::canonical(int k, int i, int j) const {
  if (i == 0 && j == 0) return {0, 0, 0};
  if (i == 0) return {(k + 1) % valence_, j, 0};
  return {(k % valence_ + valence_) % valence_, i, j};
}

FanCage::FanCage(int valence, bool triangles, std::uint64_t seed) : valence_(valence), triangles_(triangles) {
  std::mt19937_64 random(seed);
  std::map<Place, std::uint32_t> index;
  std::vector<Vec3> positions;
  for (int k = 0; k < valence; ++k)
    for (int i = 0; i <= kRadius; ++i)
      for (int j = 0; j <= kRadius; ++j) {
        const Place place = canonical(k, i, j);
        if (index.count(place)) continue;
        const double a = 2 * std::numbers::pi * k / valence, b = 2 * std::numbers::pi * (k + 1) / valence;
        const double x = i * std::cos(a) + j * std::cos(b), y = i * std::sin(a) + j * std::sin(b);
        const Vec3 p{x + 0.1 * noise(random), y + 0.1 * noise(random),
                     0.3 * std::sin(x) + 0.2 * x * y * 0.3 + 0.1 * noise(random)};
        index[place] = static_cast<std::uint32_t>(positions.size());
        positions.push_back(p);
        control_[place] = p;
      }
  std::vector<std::vector<std::uint32_t>> polygons;
  for (int k = 0; k < valence; ++k)
    for (int i = 0; i < kRadius; ++i)
      for (int j = 0; j < kRadius; ++j) {
        const auto at = [&](int a, int b) { return index.at(canonical(k, a, b)); };
        if (triangles) {
          polygons.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
          polygons.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        } else {
          polygons.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
      }
  mesh_ = cage_of(positions, polygons);
}

/// A place near sector k's quadrant, which may lie in the sector before or after.
FanCage::Place FanCage::step(const Place& from, int di, int dj) const {
  const auto [k, i, j] = from;
  const int a = i + di, b = j + dj;
  if (a >= 0 && b >= 0) return canonical(k, a, b);
  // Over a spoke a quad lattice turns by a right angle, a triangular one keeps its six neighbours.
  if (b < 0 && a >= 0)
    return triangles_ ? canonical(k - 1 + valence_, -b, a + b) : canonical(k - 1 + valence_, -b, a);
  if (a < 0 && b >= 0) return triangles_ ? canonical(k + 1, a + b, -a) : canonical(k + 1, b, -a);
  return {-1, 0, 0};
}

std::map<FanCage::Place, double> FanCage::vertex_rule(const Place& at) const {
  std::map<Place, double> sum;
  const auto [k, i, j] = at;
  const bool centre = i == 0 && j == 0;
  const double n = centre ? valence_ : triangles_ ? 6 : 4;
  std::vector<Place> edges, faces;
  if (centre) {
    for (int s = 0; s < valence_; ++s)
      edges.push_back(canonical(s, 1, 0)), faces.push_back(canonical(s, 1, 1));
  } else {
    constexpr int kQuad[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    constexpr int kTriangle[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
    for (int r = 0; r < static_cast<int>(n); ++r) {
      const int* d = triangles_ ? kTriangle[r] : kQuad[r];
      edges.push_back(step(at, d[0], d[1]));
      if (!triangles_) {
        const int* e = kQuad[(r + 1) % 4];
        faces.push_back(step(at, d[0] + e[0], d[1] + e[1]));
      }
    }
  }
  if (triangles_) {
    const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4, beta = (5.0 / 8 - c * c) / n;
    sum[at] += 1 - n * beta;
    for (const Place& p : edges) sum[p] += beta;
    return sum;
  }
  sum[at] += 1 - 7 / (4 * n);
  for (const Place& p : edges) sum[p] += 3 / (2 * n * n);
  for (const Place& p : faces) sum[p] += 1 / (4 * n * n);
  return sum;
}

std::map<FanCage::Place, double> FanCage::rule(const Place& fine) const {
  const auto [k, i, j] = fine;
  std::map<Place, double> sum;
  const auto add = [&](int a, int b, double w) { sum[step({k, 0, 0}, a, b)] += w; };
  const int a = i / 2, b = j / 2;
  if (i % 2 == 0 && j % 2 == 0) return vertex_rule(canonical(k, a, b));
  if (triangles_) {
    // The edge's ends, and the far corners of its two triangles.
    if (j % 2 == 0) {
      add(a, b, 3.0 / 8), add(a + 1, b, 3.0 / 8), add(a, b + 1, 1.0 / 8);
      sum[step({k, a + 1, b}, 0, -1)] += 1.0 / 8;
    } else if (i % 2 == 0) {
      add(a, b, 3.0 / 8), add(a, b + 1, 3.0 / 8), add(a + 1, b, 1.0 / 8);
      sum[step({k, a, b + 1}, -1, 0)] += 1.0 / 8;
    } else {
      add(a + 1, b, 3.0 / 8), add(a, b + 1, 3.0 / 8), add(a, b, 1.0 / 8), add(a + 1, b + 1, 1.0 / 8);
    }
    return sum;
  }
  if (i % 2 == 1 && j % 2 == 1) {
    for (int x : {a, a + 1})
      for (int y : {b, b + 1}) add(x, y, 0.25);
    return sum;
  }
  const int du = j % 2 == 0 ? 1 : 0, dv = 1 - du;  // along the edge
  for (int end = 0; end < 2; ++end) {
    const int x = a + end * du, y = b + end * dv;
    add(x, y, 3.0 / 8);
    add(x + dv, y + du, 1.0 / 16);
    // Opposite; where the edge starts in the centre, its neighbour spoke.
    const bool spoke = x == 0 && y == 0;
    sum[spoke ? canonical(du ? k - 1 + valence_ : k + 2, 1, 0) : step({k, x, y}, -dv, -du)] += 1.0 / 16;
  }
  return sum;
}

std::map<FanCage::Place, Vec3> FanCage::refined(const std::map<Place, Vec3>& coarse,
                                                const std::vector<Place>& wanted) const {
  std::map<Place, Vec3> fine;
  for (const Place& place : wanted) {
    Vec3 p;
    for (const auto& [from, weight] : rule(place)) p += coarse.at(from) * weight;
    fine[place] = p;
  }
  return fine;
}

/// What polygon 0 depends on: the centre's ring, and the places around its other corners.
std::vector<FanCage::Place> FanCage::support() const {
  std::vector<Place> places;
  const auto add = [&](const Place& p) {
    if (std::find(places.begin(), places.end(), p) == places.end()) places.push_back(p);
  };
  add({0, 0, 0});
  for (int k = 0; k < valence_; ++k) {
    add(canonical(k, 1, 0));
    if (!triangles_) add(canonical(k, 1, 1));
  }
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 2; ++j)
      if (!triangles_ || i + j <= 2) add(canonical(0, i, j));
  add(step({0, 2, 0}, 0, -1));
  add(step({0, 1, 0}, 0, -1));
  add(step({0, 0, 2}, -1, 0));
  add(step({0, 0, 1}, -1, 0));
  return places;
}

SurfaceJet FanCage::stam(double u, double v) const {
  const auto places = support();
  const auto count = static_cast<Eigen::Index>(places.size());
  const auto column = [&](const Place& p) {
    return static_cast<Eigen::Index>(std::find(places.begin(), places.end(), p) - places.begin());
  };
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index r = 0; r < count; ++r)
    for (const auto& [from, weight] : rule(places[static_cast<std::size_t>(r)])) a(r, column(from)) += weight;
  Eigen::MatrixXd c(count, 3);
  for (Eigen::Index r = 0; r < count; ++r) {
    const Vec3& p = control_.at(places[static_cast<std::size_t>(r)]);
    c.row(r) << p.x, p.y, p.z;
  }
  int depth = 0;
  double scale = 1;
  const auto far = [&] { return triangles_ ? u + v >= 0.5 : std::max(u, v) >= 0.5; };
  while (!far()) u *= 2, v *= 2, scale *= 2, ++depth;
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(a);
  Eigen::MatrixXcd power = eigen.eigenvectors() *
                           eigen.eigenvalues().array().pow(depth).matrix().asDiagonal() *
                           eigen.eigenvectors().fullPivLu().solve(c.cast<std::complex<double>>());
  std::map<Place, Vec3> level;
  for (Eigen::Index r = 0; r < count; ++r)
    level[places[static_cast<std::size_t>(r)]] = {power(r, 0).real(), power(r, 1).real(), power(r, 2).real()};
  // One more step, after which the point lies in a regular piece.
  u *= 2, v *= 2, scale *= 2;
  LimitPatch patch;
  Vec2 local;
  double turn = 1;
  if (triangles_) {
    const bool middle = u < 1 && v < 1;
    const int x = u >= 1 ? 1 : 0, y = v >= 1 && u < 1 ? 1 : 0;
    std::array<Vec3, 12> q;
    for (std::size_t m = 0; m < 12; ++m) {
      const int di = kLoopSupport[m][0], dj = kLoopSupport[m][1];
      const Place base = middle ? Place{0, 1, 1} : Place{0, x, y};
      const Place at = step(base, middle ? -di : di, middle ? -dj : dj);
      q[m] = refined(level, {at}).at(at);
    }
    patch = from_box_spline(q);
    local = middle ? Vec2{1 - u, 1 - v} : Vec2{u - x, v - y};
    turn = middle ? -1 : 1;
  } else {
    const int x = u >= 1 ? 1 : 0, y = v >= 1 ? 1 : 0;
    std::array<Vec3, 16> q;
    for (int r = 0; r < 4; ++r)
      for (int s = 0; s < 4; ++s) {
        const Place at = step({0, x, y}, s - 1, r - 1);
        q[static_cast<std::size_t>(4 * r + s)] = refined(level, {at}).at(at);
      }
    patch = from_bicubic_spline(q);
    local = {u - x, v - y};
  }
  Vec3 d[6];
  evaluate_patch(patch, local, 2, d);
  const double rate = scale * turn;
  return {d[0], d[1] * rate, d[2] * rate, d[3] * (rate * rate), d[4] * (rate * rate), d[5] * (rate * rate)};
}

}  // namespace dupin::test
