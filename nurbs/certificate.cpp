// Certified deviations through Bernstein coefficients.
//
// With the implicit polynomial f of a shape, F = f∘S · wᵈ is a polynomial of d times the patch's degree, and
// its coefficients over those of wᵈ bound |f| along the patch. What turns |f| into a distance e (r, R, α of
// the shape; ρ, z cylindrical coordinates):
//   sphere, cylinder   f = |p|² − r² (ρ for the cylinder)      e = |f| / (|p| + r)
//   cone               f = ρ² cos² α − z² sin² α              e = |f| / (ρ cos α + z sin α), z from the apex
//   torus              f = (A − 2Rρ)(A + 2Rρ), A = |p|² + R² − r²   e = |f| / ((A + 2Rρ)(e' + 2r)), e' = the
//   signed e
// Each denominator is bounded below on the cell, first roughly, then with the e just found.
// The derivatives of F/wᵈ bound n·Su and n·Sv in the same way: ∇f·Su = ∂(f∘S)/∂u.
#include "certificate.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "homogeneous.h"
#include "tensor.h"

namespace dupin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Rounding of the coefficients, in terms of the sum of the magnitudes that enter them.
constexpr double kRounding = 256 * std::numeric_limits<double>::epsilon();
/// Where |Su × Sv| is below this part of the largest, nothing is asked of the normal.
constexpr double kCollapsed = 1e-3;

/// A quotient F/D over the cell: bounds of its size and of its derivatives' sizes.
struct Quotient {
  double size, u, v;
};

Quotient bound_quotient(const Tensor& f, const Tensor& d, double rounding) {
  const double least = coefficient_range(d).lo;
  if (!(least > 0)) return {kInfinity, kInfinity, kInfinity};
  const double size = largest_quotient(f, d) + rounding;
  const auto derivative = [&](const Tensor& fu, const Tensor& du, int degree) {
    return (largest_coefficient(fu) + size * largest_coefficient(du)) / least + 2 * degree * rounding;
  };
  return {size, derivative(derivative_u(f), derivative_u(d), f.p),
          derivative(derivative_v(f), derivative_v(d), f.q)};
}

ParameterRange range_of(const Tensor& f, const Tensor& d) {
  ParameterRange range{kInfinity, -kInfinity};
  for (std::size_t i = 0; i < f.c.size(); ++i) {
    if (!(d.c[i] > 0)) return {-kInfinity, kInfinity};
    range.lo = std::min(range.lo, f.c[i] / d.c[i]);
    range.hi = std::max(range.hi, f.c[i] / d.c[i]);
  }
  return range;
}

/// `gradient`: a lower bound of |∇f| on the cell.
CellBounds divided(double distance, const Quotient& f, double gradient, double slack) {
  if (!(gradient > 0) || !std::isfinite(distance)) return {distance, kInfinity, kInfinity, kInfinity};
  return {distance, f.u / gradient, f.v / gradient, slack};
}

/// f = |p|² − r² over the given coordinates.
CellBounds round_bounds(const Tensor& square, const Tensor& w, double radius) {
  const Tensor d = squared(w);
  const double rounding = kRounding * (range_of(square, d).hi + radius * radius);
  const Quotient f = bound_quotient(square - d * (radius * radius), d, rounding);
  const double rough = f.size / radius;
  const double e = rough < radius ? f.size / (2 * radius - rough) : rough;
  return divided(e, f, 2 * (radius - e), 0);
}

CellBounds cone_bounds(const Cone& cone, const HomogeneousTensors& t) {
  const double sine = std::sin(cone.half_angle), cosine = std::cos(cone.half_angle);
  const Tensor d = squared(t.w), across = squared(t.x[0]) + squared(t.x[1]), along = squared(t.x[2]);
  const double rounding =
      kRounding * (range_of(across, d).hi * cosine * cosine + range_of(along, d).hi * sine * sine);
  const Quotient f = bound_quotient(across * (cosine * cosine) - along * (sine * sine), d, rounding);
  const double least = range_of(t.x[2], t.w).lo * sine;
  // At the apex: e² <= e (ρ cos α + z sin α) for z >= 0.
  double e = std::sqrt(f.size) + 2 * std::max(0.0, -least);
  if (least > 0) {
    const double rough = std::min(e, f.size / least);
    e = rough < 2 * least ? std::min(rough, f.size / (2 * least - rough)) : rough;
  }
  if (!(least > 2 * e)) return {e, kInfinity, kInfinity, kInfinity};
  return divided(e, f, 2 * (least - e), e / least);
}

CellBounds torus_bounds(const Torus& torus, const HomogeneousTensors& t) {
  const double major = torus.major, minor = torus.minor;
  const Tensor d = squared(t.w), across = squared(t.x[0]) + squared(t.x[1]);
  const Tensor a = across + squared(t.x[2]) + d * (major * major - minor * minor);
  const double rho2 = std::max(0.0, range_of(across, d).lo), size = range_of(a, d).hi + 4 * major * major;
  const Quotient f =
      bound_quotient(squared(a) - across * d * (4 * major * major), squared(d), kRounding * size * size);
  const double other = range_of(a, d).lo + 2 * major * std::sqrt(rho2);  // A + 2Rρ
  if (!(other > 0)) return {kInfinity, kInfinity, kInfinity, kInfinity};
  const double rough = f.size / (other * minor);
  const double e = rough < minor ? f.size / (other * (2 * minor - rough)) : rough;
  // ∇f = other ∇g + g ∇other with |∇g| = 2 (r ± e), |g| <= e (2r + e), |∇other| <= 2 (2R + r + e).
  const double main = 2 * other * (minor - e), rest = e * (2 * minor + e) * 2 * (2 * major + minor + e);
  return divided(e, f, main - rest, main > 0 ? rest / main : kInfinity);
}

/// Bounds of |Su|, |Sv| and |Su × Sv| over a cell.
struct Metric {
  double longest_u, longest_v;
  double least_area, largest_area;
  bool split_u;  ///< the area varies more along u
};

double longest(const HomogeneousTensors& t, bool along_u, bool rational) {
  const auto derivative = [along_u](const Tensor& a) { return along_u ? derivative_u(a) : derivative_v(a); };
  const Tensor dw = derivative(t.w);
  double square = 0;
  for (const Tensor& x : t.x) {
    const double size =
        rational ? largest_quotient(raised(t.w * derivative(x) - dw * x, 2 * x.p, 2 * x.q), squared(t.w))
                 : largest_coefficient(derivative(x));
    square += size * size;
  }
  return std::sqrt(square);
}

Metric metric_of(const BezierPatch& cell) {
  Frame3 frame;
  frame.origin = homogeneous::projected(cell.pole(cell.degree_u / 2, cell.degree_v / 2));
  const HomogeneousTensors t = homogeneous_tensors(cell, frame);
  const std::array<Tensor, 3> n = normal_tensors(t, cell.rational);
  const int p = n[0].p, q = n[0].q;
  const std::span<const double> bu = binomials(p), bv = binomials(q);
  std::vector<double> rows(static_cast<std::size_t>(p) + 1, 0.0),
      columns(static_cast<std::size_t>(q) + 1, 0.0);
  Vec3 sum;
  for (int i = 0; i <= p; ++i)
    for (int j = 0; j <= q; ++j) {
      const Vec3 c = Vec3{n[0].at(i, j), n[1].at(i, j), n[2].at(i, j)} / (bu[i] * bv[j]);
      rows[i] = std::max(rows[i], length(c));
      columns[j] = std::max(columns[j], length(c));
      sum += c;
    }
  const Vec3 m = normalized(sum);
  const ParameterRange along = coefficient_range(n[0] * m.x + n[1] * m.y + n[2] * m.z),
                       w = coefficient_range(t.w);
  const auto evenness = [](const std::vector<double>& list) {
    const auto [least, most] = std::minmax_element(list.begin(), list.end());
    return *most > 0 ? *least / *most : 1;
  };
  const double most = *std::max_element(rows.begin(), rows.end());
  const double heaviest = cell.rational ? w.hi * w.hi * w.hi : 1,
               lightest = cell.rational ? w.lo * w.lo * w.lo : 1;
  return {longest(t, true, cell.rational), longest(t, false, cell.rational),
          std::max(0.0, along.lo) / heaviest, lightest > 0 ? most / lightest : kInfinity,
          evenness(rows) < evenness(columns)};
}

}  // namespace

CellBounds shape_bounds(const Surface& shape, const BezierPatch& cell) {
  const auto tensors = [&cell](const Frame3& frame) { return homogeneous_tensors(cell, frame); };
  if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
    const HomogeneousTensors t = tensors(plane->frame);
    const ParameterRange x = range_of(t.x[0], t.w), y = range_of(t.x[1], t.w);
    const double size = std::max({std::abs(x.lo), std::abs(x.hi), std::abs(y.lo), std::abs(y.hi)});
    const Quotient f = bound_quotient(t.x[2], t.w, kRounding * size);
    return divided(f.size, f, 1, 0);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    const HomogeneousTensors t = tensors(sphere->frame);
    return round_bounds(squared(t.x[0]) + squared(t.x[1]) + squared(t.x[2]), t.w, sphere->radius);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) {
    const HomogeneousTensors t = tensors(cylinder->frame);
    return round_bounds(squared(t.x[0]) + squared(t.x[1]), t.w, cylinder->radius);
  }
  if (const auto* cone = std::get_if<Cone>(&shape.geometry)) {
    Frame3 frame = cone->frame;
    frame.origin -= frame.z * (cone->radius / std::tan(cone->half_angle));
    return cone_bounds(*cone, tensors(frame));
  }
  if (const auto* torus = std::get_if<Torus>(&shape.geometry))
    return torus_bounds(*torus, tensors(torus->frame));
  return {kInfinity, kInfinity, kInfinity, kInfinity};
}

// With ρ and z of cell and profile at the same v, E = Δρ e_r + Δz e_z takes the cell's point to one of the
// swept surface, whose normal m there is perpendicular to S − E's derivatives: m·Su = m·Eu.
CellBounds revolution_bounds(const Frame3& axis, const BezierPatch& profile, const BezierPatch& cell) {
  const HomogeneousTensors t = homogeneous_tensors(cell, axis), t0 = homogeneous_tensors(profile, axis);
  const Tensor across = squared(t.x[0]) + squared(t.x[1]), across0 = squared(t0.x[0]) + squared(t0.x[1]);
  const Tensor w2 = squared(t.w), w02 = squared(t0.w);
  const ParameterRange rho2 = range_of(across, w2), rho02 = range_of(across0, w02), z = range_of(t.x[2], t.w);
  const double height = std::max(std::abs(z.lo), std::abs(z.hi));
  const Quotient dz = bound_quotient(t.x[2] * t0.w - t0.x[2] * t.w, t.w * t0.w, kRounding * height);
  const Quotient square =
      bound_quotient(across * w02 - across0 * w2, w2 * w02, kRounding * (rho2.hi + rho02.hi));
  const double sum = 2 * std::sqrt(std::max(0.0, std::min(rho2.lo, rho02.lo)));  // below ρ + ρ₀
  const double drho = std::min(std::sqrt(square.size), square.size / sum);
  const double su = longest(t, true, cell.rational), sv = longest(t, false, cell.rational);
  const double pv = longest(t0, false, profile.rational);
  const double u = dz.u + (square.u + drho * 3 * su) / sum,
               v = dz.v + (square.v + drho * (3 * sv + pv)) / sum;
  return {dz.size + drho, sum > 0 ? u : kInfinity, sum > 0 ? v : kInfinity, 0};
}

std::optional<Deviation> certify(const BezierPatch& patch, const Deviation& limit, const BoundCell& bound) {
  Deviation out;
  double largest_area = 0;  // |Su × Sv| with respect to the surface's parameters, known to be reached
  std::deque<BezierPatch> cells{patch};
  for (int used = 0; !cells.empty(); ++used) {
    if (used == kCertificateCells) return std::nullopt;
    const BezierPatch cell = std::move(cells.front());
    cells.pop_front();
    const CellBounds b = bound(cell);
    if (std::isnan(b.distance)) return std::nullopt;
    const Metric metric = metric_of(cell);
    const double unit = cell.domain.size().x * cell.domain.size().y;
    largest_area = std::max(largest_area, metric.least_area / unit);
    // The part of the unit normal m that lies in the tangent plane is (m·Su (Sv × n) + m·Sv (n × Su)) / |Su ×
    // Sv|.
    const double sine = (b.normal_u * metric.longest_v + b.normal_v * metric.longest_u) / metric.least_area;
    const double angle = sine < 1 ? std::asin(sine) + b.normal_slack : kInfinity;
    const bool collapsed = metric.largest_area / unit < kCollapsed * largest_area;
    if (b.distance <= limit.distance && (collapsed || angle <= limit.angle)) {
      out.distance = std::max(out.distance, b.distance);
      if (!collapsed) out.angle = std::max(out.angle, angle);
    } else if (metric.split_u) {
      cells.push_back(subpatch(cell, 0, 0.5, 0, 1));
      cells.push_back(subpatch(cell, 0.5, 1, 0, 1));
    } else {
      cells.push_back(subpatch(cell, 0, 1, 0, 0.5));
      cells.push_back(subpatch(cell, 0, 1, 0.5, 1));
    }
  }
  return out;
}

}  // namespace dupin
