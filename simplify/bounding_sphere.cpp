#include "bounding_sphere.h"

#include <cmath>
#include <optional>

namespace dupin {
namespace {

/// The circle of a triangle by the paper's two cases, with the triangle's normal (zero if it has none).
struct Circle {
  Vec3 center;
  double radius = 0;
  Vec3 normal;
};

Circle over_edge(const Vec3& a, const Vec3& b, const Vec3& normal) {
  return {(a + b) * 0.5, 0.5 * distance(a, b), normal};
}

Circle triangle_circle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b, n = cross(ab, ac);
  const double ab2 = dot(ab, ab), ac2 = dot(ac, ac), bc2 = dot(bc, bc), n2 = dot(n, n);
  const double longest = std::max({ab2, ac2, bc2});
  // An angle is obtuse where its opposite side's square is more than the sum of the others'.
  if (2 * longest >= ab2 + ac2 + bc2 || !(n2 > 1e-28 * longest * longest)) {
    if (longest == ab2) return over_edge(a, b, n);
    return longest == ac2 ? over_edge(a, c, n) : over_edge(b, c, n);
  }
  const Vec3 to_center = (cross(n, ab) * ac2 + cross(ac, n) * ab2) / (2 * n2);
  return {a + to_center, length(to_center), n};
}

Sphere of_two(const Sphere& a, const Sphere& b) {
  const double d = distance(a.center, b.center), r = (d + a.radius + b.radius) / 2;
  return {d > 0 ? a.center + (b.center - a.center) * ((r - a.radius) / d) : a.center, r};
}

Sphere of_three(const Sphere& a, const Sphere& b, const Sphere& c) {
  const Circle circle = triangle_circle(a.center, b.center, c.center);
  return {circle.center, circle.radius + std::max({a.radius, b.radius, c.radius})};
}

/// With its centre on the axis of the circle of a, b, c, at the height where the sphere around them and the
/// one around d are the same size; the circle's own centre where d lies within.
Sphere of_four(const Sphere& a, const Sphere& b, const Sphere& c, const Sphere& d) {
  const Circle base = triangle_circle(a.center, b.center, c.center);
  const double base_radius = std::max({a.radius, b.radius, c.radius});
  const double l = length(base.normal);
  const Vec3 axis = l > 0 ? base.normal / l : Vec3{};
  const Vec3 to_d = d.center - base.center;
  const double height = dot(to_d, axis), aside2 = std::max(0.0, dot(to_d, to_d) - height * height);
  const auto around_base = [&](double t) {
    return std::sqrt(base.radius * base.radius + t * t) + base_radius;
  };
  const auto around_d = [&](double t) { return std::sqrt(aside2 + (height - t) * (height - t)) + d.radius; };
  double lo = 0, hi = height;  // on the way to d the first grows and the second shrinks
  if (around_d(0) <= around_base(0)) hi = 0;
  for (int i = 0; i < 40 && lo != hi; ++i) {
    const double middle = 0.5 * (lo + hi);
    (around_d(middle) > around_base(middle) ? lo : hi) = middle;
  }
  return {base.center + axis * hi, std::max(around_base(hi), around_d(hi))};
}

std::optional<Sphere> containing_one(std::span<const Sphere> spheres) {
  for (const Sphere& s : spheres)
    if (radius_around(s.center, spheres) <= s.radius) return s;
  return std::nullopt;
}

/// Steps towards the farthest sphere that get shorter: Bădoiu and Clarkson's way to the smallest one. The
/// first are short, since the start is near it already.
Sphere tightened(Sphere sphere, std::span<const Sphere> spheres) {
  constexpr int kSteps = 24, kFirstStep = 8;
  Vec3 at = sphere.center;
  for (int i = 0; i < kSteps; ++i) {
    const Sphere* farthest = spheres.data();
    double reach = -1;
    for (const Sphere& s : spheres)
      if (const double r = distance(at, s.center) + s.radius; r > reach) reach = r, farthest = &s;
    if (reach < sphere.radius) sphere = {at, reach};
    at += (farthest->center - at) / (kFirstStep + i);
  }
  return sphere;
}

}  // namespace

Sphere triangle_sphere(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Circle circle = triangle_circle(a, b, c);
  const Vec3& o = circle.center;
  return {o, std::max({distance(o, a), distance(o, b), distance(o, c)})};
}

double radius_around(const Vec3& center, std::span<const Sphere> spheres) {
  double radius = 0;
  for (const Sphere& s : spheres) radius = std::max(radius, distance(center, s.center) + s.radius);
  return radius;
}

Sphere published_sphere_of_spheres(std::span<const Sphere> s) {
  if (const auto one = containing_one(s)) return *one;
  Sphere best;
  if (s.size() == 2) {
    best = of_two(s[0], s[1]);
  } else if (s.size() == 3) {
    best = of_three(s[0], s[1], s[2]);
  } else {
    best = of_four(s[0], s[1], s[2], s[3]);
    for (const Sphere& other :
         {of_four(s[0], s[1], s[3], s[2]), of_four(s[0], s[2], s[3], s[1]), of_four(s[1], s[2], s[3], s[0])})
      if (other.radius < best.radius) best = other;
  }
  return best;
}

Sphere tightened_sphere(const Vec3& start, std::span<const Sphere> spheres) {
  return tightened({start, radius_around(start, spheres)}, spheres);
}

Sphere sphere_of_spheres(std::span<const Sphere> spheres) {
  // Around the published centre there may be room already: the rules add the largest radius wherever it is.
  return tightened_sphere(published_sphere_of_spheres(spheres).center, spheres);
}

}  // namespace dupin
