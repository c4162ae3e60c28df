// Where a plane curve's second coordinate has its extremes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "../nurbs/bezier.h"
#include "roots.h"
#include "trim_region.h"

namespace dupin::exact {
namespace {

constexpr int kOffsetSamples = 256;

Curve3 in_space(const Bspline2& spline) {
  Bspline3 out{spline.degree, spline.knots, {}, spline.weights, spline.periodic};
  for (const Vec2& p : spline.poles) out.poles.push_back({p.x, p.y, 0});
  return {out};
}

/// y' = (N' W − N W') / W²: the numerator's Bernstein coefficients, of degree 2p − 1.
std::vector<double> slope_numerator(const BezierCurve3& piece) {
  const int p = piece.degree;
  std::vector<double> c(static_cast<std::size_t>(2 * p), 0.0);
  const auto binomial = [](int n, int k) {
    double b = 1;
    for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
    return b;
  };
  // Σᵢⱼ p C(p−1,i) C(p,j) [(Nᵢ₊₁ − Nᵢ) Wⱼ − (Wᵢ₊₁ − Wᵢ) Nⱼ] s^{i+j} (1−s)^{…}
  for (int i = 0; i < p; ++i)
    for (int j = 0; j <= p; ++j) {
      const Vec4 &a = piece.poles[static_cast<std::size_t>(i)],
                 &b = piece.poles[static_cast<std::size_t>(i + 1)],
                 &q = piece.poles[static_cast<std::size_t>(j)];
      c[static_cast<std::size_t>(i + j)] +=
          binomial(p - 1, i) * binomial(p, j) * ((b.y - a.y) * q.w - (b.w - a.w) * q.y);
    }
  for (int k = 0; k < 2 * p; ++k) c[static_cast<std::size_t>(k)] /= binomial(2 * p - 1, k);
  return c;
}

struct Turns {
  const Curve2& curve;
  double t0, t1;

  std::vector<double> operator()(const LineOf<Vec2>&) const { return {}; }
  std::vector<double> operator()(const CircleOf<Vec2>& c) const { return angles(std::atan2(c.y.y, c.x.y)); }
  std::vector<double> operator()(const EllipseOf<Vec2>& e) const {
    return angles(std::atan2(e.minor * e.y.y, e.major * e.x.y));
  }
  std::vector<double> operator()(const ParabolaOf<Vec2>& p) const {
    return inside({-2 * p.focal * p.y.y / p.x.y});
  }
  std::vector<double> operator()(const HyperbolaOf<Vec2>& h) const {
    return inside({std::atanh(-h.minor * h.y.y / (h.major * h.x.y))});
  }
  std::vector<double> operator()(const Bspline2& spline) const {
    std::vector<double> found;
    for (const BezierCurve3& piece : bezier_curves(in_space(spline), t0, t1)) {
      found.push_back(piece.t0);  // corners may stand at knots
      const std::vector<double> slope = slope_numerator(piece);
      for (const double s : bernstein_sign_changes(slope))
        found.push_back(piece.t0 + s * (piece.t1 - piece.t0));
    }
    return inside(std::move(found));
  }
  std::vector<double> operator()(const OffsetCurveOf<Vec2>&) const {
    std::vector<double> found, ends{t0}, between = breaks(curve, t0, t1, 1);
    ends.insert(ends.end(), between.begin(), between.end());
    ends.push_back(t1);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      found.push_back(ends[i]);
      add_sampled_turns(ends[i], ends[i + 1], found);
    }
    return inside(std::move(found));
  }

 private:
  std::vector<double> inside(std::vector<double> found) const {
    std::erase_if(found, [&](double t) { return !(t > t0 && t < t1); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }
  /// first + k·π
  std::vector<double> angles(double first) const {
    constexpr double kPi = std::numbers::pi;
    std::vector<double> found;
    for (double k = std::ceil((t0 - first) / kPi); first + k * kPi < t1; ++k)
      found.push_back(first + k * kPi);
    return inside(std::move(found));
  }
  double slope(double t) const { return evaluate(curve, t, 1)[1].y; }
  void add_sampled_turns(double a, double b, std::vector<double>& found) const {
    const auto at = [&](int i) { return a + (b - a) * (i + 0.5) / kOffsetSamples; };
    for (int i = 0; i + 1 < kOffsetSamples; ++i) {
      double lo = at(i), hi = at(i + 1);
      if ((slope(lo) > 0) == (slope(hi) > 0)) continue;
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (lo + hi);
        ((slope(middle) > 0) == (slope(lo) > 0) ? lo : hi) = middle;
      }
      found.push_back(0.5 * (lo + hi));
    }
  }
};

}  // namespace

std::vector<double> turns_in_v(const Curve2& curve, double t0, double t1) {
  return std::visit(Turns{curve, t0, t1}, curve.geometry);
}

}  // namespace dupin::exact
