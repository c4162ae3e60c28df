#include "fitted_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bernstein.h"
#include "bezier_cell.h"

namespace dupin {
namespace {

constexpr int kDegree = 5, kNodes = kDegree + 1, kChecks = 7;
constexpr int kMaxHalvings = 14;
constexpr double kShareOfTolerance = 0.1;

using Matrix = std::array<std::array<double, kNodes>, kNodes>;

double node(int i) {
  return 0.5 - 0.5 * std::cos(std::numbers::pi * i / kDegree);
}

/// Takes values at the nodes to Bernstein coefficients: the inverse of the collocation matrix, by
/// Gauss–Jordan.
Matrix make_interpolation() {
  std::array<std::array<double, 2 * kNodes>, kNodes> m{};
  const auto binomial = bernstein::binomials(kDegree);
  for (int r = 0; r < kNodes; ++r) {
    const double s = node(r);
    for (int c = 0; c < kNodes; ++c) m[r][c] = binomial[c] * std::pow(s, c) * std::pow(1 - s, kDegree - c);
    m[r][kNodes + r] = 1;
  }
  for (int c = 0; c < kNodes; ++c) {
    int pivot = c;
    for (int r = c + 1; r < kNodes; ++r)
      if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
    std::swap(m[c], m[pivot]);
    const double inverse = 1 / m[c][c];
    for (double& x : m[c]) x *= inverse;
    for (int r = 0; r < kNodes; ++r) {
      if (r == c) continue;
      const double f = m[r][c];
      for (int k = 0; k < 2 * kNodes; ++k) m[r][k] -= f * m[c][k];
    }
  }
  Matrix result;
  for (int r = 0; r < kNodes; ++r)
    for (int c = 0; c < kNodes; ++c) result[r][c] = m[r][kNodes + c];
  return result;
}

Vec2 at(const Box2& box, double s, double t) {
  return {box.lo.x + box.size().x * s, box.lo.y + box.size().y * t};
}

Vec3 patch_normal(const BezierPatch& patch, double s, double t) {
  constexpr double h = 1e-4;
  return normalized(cross(point_at(patch, s + h, t) - point_at(patch, s - h, t),
                          point_at(patch, s, t + h) - point_at(patch, s, t - h)));
}

class Fitter {
 public:
  Fitter(const Surface& surface, const ToleranceField& tolerance, double normal_tolerance)
      : surface_(surface), tolerance_(tolerance), normal_tolerance_(normal_tolerance) {}

  bool fit(const Box2& box, int depth) {
    FittedPatch fitted{interpolating_patch([&](Vec2 uv) { return point_at(surface_, uv.x, uv.y); }, box)};
    for (const Vec4& pole : fitted.patch.poles)
      if (!std::isfinite(pole.x + pole.y + pole.z)) return false;
    measure(box, fitted);
    const double allowed = tolerance_.at(poles_box(fitted.patch)) * kShareOfTolerance;
    const bool good =
        fitted.position_error <= allowed && fitted.normal_error <= normal_tolerance_ * kShareOfTolerance;
    if (good || std::isinf(allowed) || depth >= kMaxHalvings) {
      patches.push_back(std::move(fitted));
      return true;
    }
    const Vec2 mid = box.center();
    const bool along_u = distance(point_at(surface_, box.lo.x, mid.y), point_at(surface_, box.hi.x, mid.y)) >=
                         distance(point_at(surface_, mid.x, box.lo.y), point_at(surface_, mid.x, box.hi.y));
    Box2 first = box, second = box;
    (along_u ? first.hi.x : first.hi.y) = along_u ? mid.x : mid.y;
    (along_u ? second.lo.x : second.lo.y) = along_u ? mid.x : mid.y;
    return fit(first, depth + 1) && fit(second, depth + 1);
  }

  std::vector<FittedPatch> patches;

 private:
  void measure(const Box2& box, FittedPatch& fitted) const {
    for (int i = 0; i < kChecks; ++i)
      for (int j = 0; j < kChecks; ++j) {
        const double s = (i + 0.37) / (kChecks - 0.26), t = (j + 0.37) / (kChecks - 0.26);
        const Vec2 uv = at(box, s, t);
        const SurfaceJet jet = evaluate(surface_, uv.x, uv.y, 1);
        fitted.position_error =
            std::max(fitted.position_error, 2 * distance(jet.p, point_at(fitted.patch, s, t)));
        const Vec3 n = normalized(cross(jet.pu, jet.pv));
        if (length(n) > 0.5)
          fitted.normal_error =
              std::max(fitted.normal_error, 2 * length(cross(n, patch_normal(fitted.patch, s, t))));
      }
  }
  const Surface& surface_;
  const ToleranceField& tolerance_;
  const double normal_tolerance_;
};

/// Where the base of an offset is less smooth, the pieces must end.
std::vector<Box2> smooth_pieces(const Surface& surface, const Box2& region) {
  std::vector<Box2> pieces;
  if (const auto* offset = std::get_if<OffsetSurface>(&surface.geometry))
    for (const BezierPatch& patch : bezier_patches(*offset->base, region)) pieces.push_back(patch.domain);
  if (pieces.empty()) pieces.push_back(region);
  return pieces;
}

}  // namespace

BezierPatch interpolating_patch(const std::function<Vec3(Vec2)>& value, const Box2& box) {
  static const Matrix interpolation = make_interpolation();
  std::array<std::array<Vec3, kNodes>, kNodes> values, half{};
  for (int i = 0; i < kNodes; ++i)
    for (int j = 0; j < kNodes; ++j) values[i][j] = value(at(box, node(i), node(j)));
  for (int i = 0; i < kNodes; ++i)
    for (int j = 0; j < kNodes; ++j)
      for (int k = 0; k < kNodes; ++k) half[i][j] += values[k][j] * interpolation[i][k];
  BezierPatch patch;
  patch.degree_u = patch.degree_v = kDegree;
  patch.domain = box;
  for (int i = 0; i < kNodes; ++i)
    for (int j = 0; j < kNodes; ++j) {
      Vec3 p{};
      for (int k = 0; k < kNodes; ++k) p += half[i][k] * interpolation[j][k];
      patch.poles.push_back({p.x, p.y, p.z, 1});
    }
  return patch;
}

std::vector<FittedPatch> fitted_patches(const Surface& surface, const Box2& region,
                                        const ToleranceField& tolerance, double normal_tolerance) {
  Fitter fitter(surface, tolerance, normal_tolerance);
  for (const Box2& piece : smooth_pieces(surface, region))
    if (!fitter.fit(piece, 0)) return {};
  return std::move(fitter.patches);
}

}  // namespace dupin
