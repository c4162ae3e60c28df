#include "limit_basis.h"

#include <algorithm>
#include <map>

namespace dupin {
namespace {

/// Bézier poles of the middle span of four uniform B-spline control points.
std::array<Vec3, 4> to_bezier(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {(a + b * 4 + c) / 6, (b * 2 + c) / 3, (b + c * 2) / 3, (b + c * 4 + d) / 6};
}

std::array<Vec3, 4> cubic_through(const std::array<Vec3, 4>& f) {
  const Vec3 a = f[1] * 64 - f[0] * 27 - f[3], b = f[2] * 64 - f[3] * 27 - f[0];
  return {f[0], (a * 3 - b) / 72, (b * 3 - a) / 72, f[3]};
}

using Lattice = std::map<std::array<int, 2>, double>;
constexpr std::array<std::array<int, 2>, 6> kRing{{{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}}};

/// One step of Loop's regular rules; places are those of a lattice twice as fine.
Lattice refined(const Lattice& from) {
  Lattice to;
  for (const auto& [at, value] : from) {
    const int x = 2 * at[0], y = 2 * at[1];
    to[{x, y}] += value * 5 / 8;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto &a = kRing[k], &b = kRing[(k + 1) % 6];
      to[{x + a[0], y + a[1]}] += value * 3 / 8;
      to[{x + 2 * a[0], y + 2 * a[1]}] += value / 16;
      to[{x + a[0] + b[0], y + a[1] + b[1]}] += value / 8;
    }
  }
  return to;
}

/// The box spline of the lattice's origin.
double box_spline_at_quarters(int x, int y) {
  static const Lattice kFine = refined(refined({{{0, 0}, 1.0}}));
  const auto value = [&](int i, int j) {
    const auto found = kFine.find({i, j});
    return found == kFine.end() ? 0 : found->second;
  };
  double sum = value(x, y) / 2;
  for (const auto& step : kRing) sum += value(x + step[0], y + step[1]) / 12;
  return sum;
}

/// newton[k][i]: Bernstein coefficient i, in degree 4, of the binomial C(4x, k).
using Newton = std::array<std::array<double, 5>, 5>;
Newton newton_polynomials() {
  constexpr double kBinomial[5][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
  Newton out{};
  std::array<double, 5> power{1};  // coefficients of x^m
  for (int k = 0; k <= 4; ++k) {
    for (int i = 0; i <= 4; ++i)
      for (int m = 0; m <= i; ++m) out[k][i] += power[m] * kBinomial[i][m] / kBinomial[4][m];
    std::array<double, 5> next{};
    for (int m = 0; m <= 4; ++m) {
      next[m] -= power[m] * k / (k + 1);
      if (m < 4) next[m + 1] += power[m] * 4 / (k + 1);
    }
    power = next;
  }
  return out;
}

/// Whatever can be added and scaled, from values at (i/4, j/4).
template <class T>
std::array<T, 25> quartic_poles(const std::array<T, 25>& values) {
  static const Newton kNewton = newton_polynomials();
  std::array<T, 25> d = values;  // becomes the differences Δᵢ Δⱼ at the origin
  for (int round = 1; round <= 4; ++round)
    for (int i = 4; i >= round; --i)
      for (int j = 0; i + j <= 4; ++j) d[5 * i + j] = d[5 * i + j] - d[5 * (i - 1) + j];
  for (int round = 1; round <= 4; ++round)
    for (int i = 0; i <= 4; ++i)
      for (int j = 4 - i; j >= round; --j) d[5 * i + j] = d[5 * i + j] - d[5 * i + j - 1];
  std::array<T, 25> poles{};
  for (int p = 0; p <= 4; ++p)
    for (int q = 0; q <= 4; ++q)
      for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j)
          poles[5 * p + q] = poles[5 * p + q] + d[5 * i + j] * (kNewton[i][p] * kNewton[j][q]);
  return poles;
}

/// matrix[pole][support point].
using BoxMatrix = std::array<std::array<double, 12>, 25>;
BoxMatrix box_matrix() {
  BoxMatrix matrix{};
  for (std::size_t k = 0; k < 12; ++k) {
    std::array<double, 25> values{};
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; i + j <= 4; ++j)
        values[5 * i + j] = box_spline_at_quarters(i - 4 * kLoopSupport[k][0], j - 4 * kLoopSupport[k][1]);
    const auto poles = quartic_poles(values);
    for (std::size_t p = 0; p < 25; ++p) matrix[p][k] = poles[p];
  }
  return matrix;
}

}  // namespace

LimitPatch from_bicubic_spline(const std::array<Vec3, 16>& control) {
  std::array<std::array<Vec3, 4>, 4> rows;
  for (std::size_t r = 0; r < 4; ++r)
    rows[r] = to_bezier(control[4 * r], control[4 * r + 1], control[4 * r + 2], control[4 * r + 3]);
  LimitPatch patch;
  for (std::size_t i = 0; i < 4; ++i)
    for (const Vec3& pole : to_bezier(rows[0][i], rows[1][i], rows[2][i], rows[3][i]))
      patch.poles.push_back(pole);
  return patch;
}

LimitPatch from_box_spline(const std::array<Vec3, 12>& control) {
  static const BoxMatrix kMatrix = box_matrix();
  LimitPatch patch{4, std::vector<Vec3>(25)};
  for (std::size_t p = 0; p < 25; ++p) {
    // Relative to one point, so that a cage far from the origin loses nothing.
    for (std::size_t k = 1; k < 12; ++k) patch.poles[p] += (control[k] - control[0]) * kMatrix[p][k];
    patch.poles[p] += control[0];
  }
  return patch;
}

LimitPatch bicubic_through(const std::array<Vec3, 16>& values) {
  std::array<std::array<Vec3, 4>, 4> rows;
  for (std::size_t i = 0; i < 4; ++i)
    rows[i] = cubic_through({values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]});
  LimitPatch patch{3, std::vector<Vec3>(16)};
  for (std::size_t j = 0; j < 4; ++j) {
    const auto column = cubic_through({rows[0][j], rows[1][j], rows[2][j], rows[3][j]});
    for (std::size_t i = 0; i < 4; ++i) patch.poles[4 * i + j] = column[i];
  }
  return patch;
}

LimitPatch quartic_through(const std::array<Vec3, 25>& values) {
  std::array<Vec3, 25> relative;
  for (std::size_t i = 0; i < 25; ++i) relative[i] = values[i] - values[0];
  const auto poles = quartic_poles(relative);
  LimitPatch patch{4, {}};
  for (const Vec3& pole : poles) patch.poles.push_back(pole + values[0]);
  return patch;
}

std::array<Vec3, 5> quartic_curve_through(const std::array<Vec3, 5>& values) {
  std::array<Vec3, 25> line{};
  for (std::size_t i = 0; i <= 4; ++i)
    for (std::size_t j = 0; i + j <= 4; ++j) line[5 * i + j] = values[i];
  const LimitPatch constant_across = quartic_through(line);
  std::array<Vec3, 5> poles;
  for (std::size_t i = 0; i <= 4; ++i) poles[i] = constant_across.poles[5 * i];
  return poles;
}

}  // namespace dupin
