// Looks for points and normals that are farther off than their certificate says.
#include "../../sampling/bezier_cell.h"

#include "../../sampling/graph_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

namespace dupin {
namespace {

BezierPatch random_patch(int p, int q, bool rational, double bend, std::mt19937& rng) {
  std::uniform_real_distribution<double> value(-1, 1);
  BezierPatch patch;
  patch.degree_u = p, patch.degree_v = q, patch.rational = rational;
  patch.domain = {{0, 0}, {1, 1}};
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const double w = rational ? 1 + 0.1 * value(rng) : 1;
      const Vec3 at{static_cast<double>(i) / p + 0.03 * value(rng),
                    static_cast<double>(j) / q + 0.03 * value(rng), bend * value(rng)};
      patch.poles.push_back({at.x * w, at.y * w, at.z * w, w});
    }
  return patch;
}

/// The quadric's point above (x,y) on the sheet of its origin.
double sheet_height(const QuadricDp& dp, Vec2 p) {
  double z = 0;
  for (int i = 0; i < 60; ++i) z -= quadric_value(dp, {p.x, p.y, z}) / quadric_gradient(dp, {p.x, p.y, z}).z;
  return z;
}

struct Worst {
  double position = 0, normal = 0;  ///< measured over certified
  int cells = 0;
};

/// Surface points of the grown cell against the quadric above the same (x,y).
void compare(const BezierPatch& cell, const CellFit& fit, double lo_s, double lo_t, Worst& worst) {
  const QuadricDp& dp = fit.dp;
  const double h = 1e-5;
  for (int i = 0; i <= 12; ++i)
    for (int j = 0; j <= 12; ++j) {
      const double s = lo_s + (1 + kCellMargin - lo_s) * i / 12, t = lo_t + (1 + kCellMargin - lo_t) * j / 12;
      const Vec3 p = point_at(cell, s, t);
      const Vec3 su = point_at(cell, s + h, t) - point_at(cell, s - h, t),
                 sv = point_at(cell, s, t + h) - point_at(cell, s, t - h);
      const Vec3 d = p - dp.origin, n = dp.n();
      const Vec2 xy{dot(d, dp.u), dot(d, dp.v)};
      const double z = sheet_height(dp, xy);
      worst.position = std::max(worst.position, (std::abs(z - dot(d, n)) - 1e-15) / fit.bound);
      const Vec3 normal = normalized(cross(su, sv));
      if (length(normal) < 0.5) continue;
      const Vec3 g = drawn_normal(dp, {xy.x, xy.y, z});
      const Vec3 drawn = normalized(dp.u * g.x + dp.v * g.y + n * g.z);
      const double angle = std::asin(std::min(1.0, length(cross(drawn, normal))));
      worst.normal = std::max(worst.normal, (angle - 1e-8) / fit.normal_bound);
    }
}

using Fit = std::function<CellFit(const BezierPatch&, const CellRequest&)>;

Fit by_nets() {
  return [fitter = std::make_shared<CellFitter>()](const BezierPatch& patch, const CellRequest& request) {
    return fitter->fit(patch, request);
  };
}
Fit by_series() {
  return fit_graph;
}

/// Divides until every cell is certified, comparing each.
void search(const BezierPatch& patch, const CellRequest& request, int depth, const Fit& certify,
            Worst& worst) {
  const CellFit fit = certify(patch, request);
  if (fit.valid) {
    const CollapsedSides collapsed = collapsed_sides(patch);
    ++worst.cells;
    return compare(patch, fit, collapsed.u0 ? 0 : -kCellMargin, collapsed.v0 ? 0 : -kCellMargin, worst);
  }
  ASSERT_LT(depth, 30) << "a cell that could not be certified: twist or sheet " << !fit.quadric_decides
                       << " bound " << fit.bound << " normal " << fit.normal_bound;
  for (const BezierPatch& piece : split_patch(patch, fit.pieces_u, fit.pieces_v))
    search(piece, request, depth + 1, certify, worst);
}

class BothWays : public ::testing::TestWithParam<bool> {
 protected:
  Fit certify() const { return GetParam() ? by_series() : by_nets(); }
};
INSTANTIATE_TEST_SUITE_P(BezierCell, BothWays, ::testing::Bool(),
                         [](const auto& i) { return i.param ? "BySeries" : "ByNets"; });

TEST_P(BothWays, NoPointOrNormalViolatesItsCertificate) {
  std::mt19937 rng(11);
  for (int trial = 0; trial < 40; ++trial) {
    Worst worst;
    const BezierPatch patch =
        random_patch(1 + trial % 5, 1 + (trial / 5) % 4, trial % 2 == 1, trial % 3 == 0 ? 0.1 : 0.5, rng);
    search(patch, {1e-3, 0.02, {}, {}}, 0, certify(), worst);
    EXPECT_LE(worst.position, 1 + 1e-6);
    EXPECT_LE(worst.normal, 1 + 1e-6);
    EXPECT_GT(worst.cells, 0);
  }
}

TEST_P(BothWays, TheBoundIsNotIdle) {
  // A bound that is never approached would make many cells for nothing.
  std::mt19937 rng(12);
  double best = 0;
  for (int trial = 0; trial < 10; ++trial) {
    Worst worst;
    search(random_patch(3, 3, false, 0.4, rng), {1e-3, 0.02, {}, {}}, 0, certify(), worst);
    best = std::max(best, worst.position);
  }
  EXPECT_GT(best, 0.4);
}

TEST(BezierCell, CollapsedSidesAreCertifiedWithoutEndlessSplitting) {
  std::mt19937 rng(13);
  for (bool rational : {false, true}) {
    BezierPatch patch = random_patch(3, 3, rational, 0.2, rng);
    // A cap: the side u = 0 is the pole, the others fan out around it.
    const double w0 = 1.2;
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; j <= 3; ++j) {
        const double r = i / 3.0, a = 0.4 * j, w = rational ? (i == 0 ? w0 : 1 + 0.1 * i) : 1;
        const Vec3 p{r * std::cos(a), r * std::sin(a), -0.2 * r * r};
        patch.pole(i, j) = {p.x * w, p.y * w, p.z * w, w};
      }
    Worst worst;
    search(patch, {1e-4, 0.005, {}, {}}, 0, by_nets(), worst);
    EXPECT_LE(worst.position, 1 + 1e-6);
    EXPECT_LE(worst.normal, 1 + 1e-6);
    EXPECT_LT(worst.cells, 200) << "rational " << rational;
  }
}

TEST_P(BothWays, AQuadricPatchIsOneCell) {
  // A biquadratic patch of a paraboloid z = x² + y²: no splitting, no error.
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 2;
  const double x[3] = {-1, 0, 1}, q[3] = {1, -1, 1};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) patch.poles.push_back({0.3 * x[i], 0.3 * x[j], 0.09 * (q[i] + q[j]), 1});
  const CellFit fit = certify()(patch, {1e-9, 1e-7, {}, {}});
  EXPECT_TRUE(fit.valid);
  EXPECT_LT(fit.bound, 1e-14);
}

}  // namespace
}  // namespace dupin
