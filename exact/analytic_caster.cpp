// Planes, cylinders, cones, spheres and tori: the roots of the implicit form along the line.
#include <cmath>
#include <numbers>

#include "../nurbs/bezier.h"
#include "../nurbs/bounds.h"
#include "roots.h"
#include "surface_caster.h"

namespace dupin::exact {
namespace {

using Real = long double;

/// The line in the surface's frame, started near the region and scaled by its size: o + τ d, |d| = 1.
struct LocalLine {
  Real o[3], d[3];
  Real t0, step;  // t = t0 + τ · step
};

Power square_sum(const LocalLine& l, int axes) {
  Power q(3, 0);
  for (int k = 0; k < axes; ++k) {
    q[0] += l.o[k] * l.o[k];
    q[1] += 2 * l.o[k] * l.d[k];
    q[2] += l.d[k] * l.d[k];
  }
  return q;
}
Power product(const Power& a, const Power& b) {
  Power c(a.size() + b.size() - 1, 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

/// The implicit form along the line, lengths in units of `size`.
struct Implicit {
  const LocalLine& line;
  Real size;
  Power operator()(const Plane&) const { return {line.o[2], line.d[2]}; }
  Power operator()(const Cylinder& c) const {
    const Real r = c.radius / size;
    Power q = square_sum(line, 2);
    q[0] -= r * r;
    return q;
  }
  Power operator()(const Cone& c) const {
    const Real slope = std::tan(static_cast<Real>(c.half_angle)), r = c.radius / size;
    const Power radius{r + slope * line.o[2], slope * line.d[2]};
    Power q = square_sum(line, 2), square = product(radius, radius);
    for (std::size_t i = 0; i < 3; ++i) q[i] -= square[i];
    return q;
  }
  Power operator()(const Sphere& s) const {
    const Real r = s.radius / size;
    Power q = square_sum(line, 3);
    q[0] -= r * r;
    return q;
  }
  Power operator()(const Torus& t) const {
    const Real major = t.major / size, minor = t.minor / size;
    Power sum = square_sum(line, 3);
    sum[0] += major * major - minor * minor;
    Power q = product(sum, sum);
    const Power ring = square_sum(line, 2);
    for (std::size_t i = 0; i < 3; ++i) q[i] -= 4 * major * major * ring[i];
    return q;
  }
  template <class Other>
  Power operator()(const Other&) const {
    return {};
  }
};

/// Parameters of a point of the surface, in its frame. Two where a torus passes through its axis.
struct Parameters {
  Vec3 p;
  using Found = std::vector<Vec2>;
  Found operator()(const Plane&) const { return {{p.x, p.y}}; }
  Found operator()(const Cylinder&) const { return {{std::atan2(p.y, p.x), p.z}}; }
  Found operator()(const Cone& c) const {
    const double v = p.z / std::cos(c.half_angle);
    const double sign = c.radius + v * std::sin(c.half_angle) < 0 ? -1 : 1;  // beyond the apex
    return {{std::atan2(sign * p.y, sign * p.x), v}};
  }
  Found operator()(const Sphere&) const {
    return {{std::atan2(p.y, p.x), std::atan2(p.z, std::hypot(p.x, p.y))}};
  }
  Found operator()(const Torus& t) const {
    const double ring = std::hypot(p.x, p.y);
    Found found{{std::atan2(p.y, p.x), std::atan2(p.z, ring - t.major)}};
    // Only the sheet of the tube that the point is on: its distance from the tube's centre is the minor
    // radius.
    const double near = std::abs(std::hypot(ring - t.major, p.z) - t.minor),
                 far = std::abs(std::hypot(ring + t.major, p.z) - t.minor);
    if (far < near) found = {{std::atan2(-p.y, -p.x), std::atan2(p.z, -ring - t.major)}};
    return found;
  }
  template <class Other>
  Found operator()(const Other&) const {
    return {};
  }
};

Frame3 frame_of(const Surface& surface) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.frame; })
          return s.frame;
        else
          return Frame3{};
      },
      surface.geometry);
}

class AnalyticCaster : public SurfaceCaster {
 public:
  AnalyticCaster(const Surface& surface, const Box2& region) : surface_(surface), frame_(frame_of(surface)) {
    Box3 box;
    for (const BezierPatch& patch : bezier_patches(surface, region)) box.add(bounding_box(patch));
    boxes_.push_back(box);
    size_ = std::max(box.diagonal(), 1e-300);
  }

  void meet(std::size_t, const Line& line, std::vector<Crossing>& out) const override {
    const LocalLine local = localize(line);
    const Power f = std::visit(Implicit{local, size_}, surface_.geometry);
    for (const Real root : roots_between(f, -1, 1)) {
      const Vec3 p{static_cast<double>(size_ * (local.o[0] + root * local.d[0])),
                   static_cast<double>(size_ * (local.o[1] + root * local.d[1])),
                   static_cast<double>(size_ * (local.o[2] + root * local.d[2]))};
      for (const Vec2& uv : std::visit(Parameters{p}, surface_.geometry))
        out.push_back({static_cast<double>(local.t0 + root * local.step), uv});
    }
  }

 private:
  /// |τ| <= 1 covers the whole box: the line starts at its point nearest to the box's centre.
  LocalLine localize(const Line& line) const {
    const Real dd = dot(line.direction, line.direction), size = size_;
    LocalLine local;
    local.t0 = dot(boxes_[0].center() - line.origin, line.direction) / static_cast<double>(dd);
    local.step = size / std::sqrt(dd);
    const Vec3 axes[3] = {frame_.x, frame_.y, frame_.z}, from = line.origin - frame_.origin;
    const auto product = [](const Vec3& a, const Vec3& b) {
      return Real(a.x) * b.x + Real(a.y) * b.y + Real(a.z) * b.z;
    };
    for (int k = 0; k < 3; ++k) {
      const Real along = product(line.direction, axes[k]);
      local.o[k] = (product(from, axes[k]) + local.t0 * along) / size;
      local.d[k] = along / std::sqrt(dd);
    }
    return local;
  }

  const Surface& surface_;
  Frame3 frame_;
  Real size_ = 1;
};

}  // namespace

std::unique_ptr<SurfaceCaster> make_analytic_caster(const Surface& surface, const Box2& region) {
  return std::make_unique<AnalyticCaster>(surface, region);
}

}  // namespace dupin::exact
