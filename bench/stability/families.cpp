#include "families.h"

#include <cmath>

namespace dupin::bench {
namespace {

constexpr double kNearest = 1e-6;

std::vector<double> clamped_knots(int degree, int spans) {
  std::vector<double> knots(static_cast<std::size_t>(degree), 0.0);
  for (int i = 0; i <= spans; ++i) knots.push_back(static_cast<double>(i) / spans);
  knots.insert(knots.end(), static_cast<std::size_t>(degree), 1.0);
  return knots;
}

/// Poles over [0,1]², moved by `noise` and lifted by `height`, both in parts of the grid's step.
BsplineSurface bumpy(Random& random, int degree_u, int degree_v, double noise, double height, int spans = 1) {
  BsplineSurface s;
  s.degree_u = degree_u, s.degree_v = degree_v;
  s.count_u = degree_u + spans, s.count_v = degree_v + spans;
  s.knots_u = clamped_knots(degree_u, spans), s.knots_v = clamped_knots(degree_v, spans);
  const double du = 1.0 / (s.count_u - 1), dv = 1.0 / (s.count_v - 1);
  for (int i = 0; i < s.count_u; ++i)
    for (int j = 0; j < s.count_v; ++j)
      s.poles.push_back({du * (i + random.between(-noise, noise)), dv * (j + random.between(-noise, noise)),
                         random.between(-height, height)});
  return s;
}

void add_weights(Random& random, BsplineSurface& s, double least, double most) {
  for (std::size_t i = 0; i < s.poles.size(); ++i) s.weights.push_back(random.log_between(least, most));
}

Vec3& pole(BsplineSurface& s, int i, int j) {
  return s.poles[static_cast<std::size_t>(i * s.count_v + j)];
}

BsplineSurface any_bumpy(Random& random) {
  BsplineSurface s = bumpy(random, random.integer(2, 5), random.integer(2, 5), 0.3, 0.3);
  if (random.integer(0, 1)) add_weights(random, s, 0.3, 3);
  return s;
}

double anywhere(Random& random) {
  return random.between(0.001, 0.999);
}
double near_start(Random& random) {
  return random.log_between(kNearest, 1);
}

Trial collapsed_edge(Random& random) {
  Trial t{any_bumpy(random), near_start(random), anywhere(random)};
  for (int j = 1; j < t.surface.count_v; ++j) pole(t.surface, 0, j) = pole(t.surface, 0, 0);
  return t;
}

/// A Bézier triangle of degree n as a patch whose edge u = 0 is a point: row i is the triangle's row raised
/// to degree n.
Trial triangular_patch(Random& random) {
  const int n = random.integer(2, 5);
  Trial t{bumpy(random, n, n, 0, 0), near_start(random), anywhere(random)};
  for (int i = 0; i <= n; ++i) {
    std::vector<Vec3> row;
    for (int j = 0; j <= i; ++j)
      row.push_back({(i + random.between(-0.2, 0.2)) / n, (j - 0.5 * i + random.between(-0.2, 0.2)) / n,
                     random.between(-0.3, 0.3)});
    while (static_cast<int>(row.size()) <= n) {
      const auto d = static_cast<double>(row.size());
      std::vector<Vec3> raised{row.front()};
      for (std::size_t j = 1; j < row.size(); ++j) {
        const double part = static_cast<double>(j) / d;
        raised.push_back(row[j - 1] * part + row[j] * (1 - part));
      }
      raised.push_back(row.back());
      row = std::move(raised);
    }
    for (int j = 0; j <= n; ++j) pole(t.surface, i, j) = row[static_cast<std::size_t>(j)];
  }
  return t;
}

/// An eighth of a sphere; the pole at u = 0.
Trial sphere_pole(Random& random) {
  const double r = random.log_between(1e-3, 1e3), c = std::sqrt(0.5);
  Trial t{bumpy(random, 2, 2, 0, 0), near_start(random), anywhere(random)};
  const Vec3 around[3] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const double radius[3] = {0, 1, 1}, height[3] = {1, 1, 0}, w[3] = {1, c, 1};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      pole(t.surface, i, j) = (around[j] * radius[i] + Vec3{0, 0, height[i]}) * r;
      t.surface.weights.push_back(w[i] * w[j]);
    }
  return t;
}

Trial near_parallel(Random& random) {
  Trial t{any_bumpy(random), anywhere(random), anywhere(random)};
  const double angle = random.log_between(1e-8, 1e-2);
  for (Vec3& p : t.surface.poles) p = {p.x + p.y, p.y * angle, p.z * angle};
  return t;
}

/// A paraboloid of revolution's neighbourhood, a little bent.
Trial near_umbilic(Random& random) {
  Trial t{bumpy(random, 4, 4, 0, 0), random.between(0.45, 0.55), random.between(0.45, 0.55)};
  const double k = random.between(0.5, 2), bend = random.log_between(1e-12, 1e-3);
  // x² has the Bernstein coefficients i(i − 1) / (n(n − 1)).
  const auto square = [](int i) { return i * (i - 1) / 12.0; };
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j) {
      const double x = i / 4.0, y = j / 4.0;
      pole(t.surface, i, j) = {x, y,
                               0.5 * k * (square(i) - x + square(j) - y) + bend * random.between(-1, 1)};
    }
  return t;
}

Trial repeated_knots(Random& random) {
  Trial t{bumpy(random, 3, 3, 0.2, 0.2, 5), 0, anywhere(random)};
  const int times = random.integer(2, 3);
  const double knot = t.surface.knots_u[5];
  for (int i = 0; i < times; ++i) t.surface.knots_u[static_cast<std::size_t>(5 + i)] = knot;
  t.u = knot + random.log_between(kNearest, 0.1) * (random.integer(0, 1) ? 1 : -1);
  return t;
}

/// Su vanishes on the edge u = 0, and the profiles come to a cusp.
Trial cusp(Random& random) {
  Trial t{any_bumpy(random), near_start(random), anywhere(random)};
  for (int j = 0; j < t.surface.count_v; ++j) pole(t.surface, 1, j) = pole(t.surface, 0, j);
  return t;
}

Trial extreme_weights(Random& random) {
  Trial t{bumpy(random, random.integer(2, 5), random.integer(2, 5), 0.3, 0.3), anywhere(random),
          anywhere(random)};
  add_weights(random, t.surface, 1e-6, 1e6);
  return t;
}

Trial high_degree(Random& random) {
  Trial t{bumpy(random, random.integer(20, 25), random.integer(20, 25), 0.3, 0.3), anywhere(random),
          anywhere(random)};
  if (random.integer(0, 1)) add_weights(random, t.surface, 0.1, 10);
  return t;
}

Trial far_away(Random& random) {
  Trial t{any_bumpy(random), anywhere(random), anywhere(random)};
  const Vec3 shift{random.between(-1e8, 1e8), random.between(-1e8, 1e8), 1e8};
  for (Vec3& p : t.surface.poles) p += shift;
  return t;
}

Trial odd_units(Random& random) {
  Trial t{any_bumpy(random), anywhere(random), anywhere(random)};
  const double unit = random.integer(0, 1) ? 1e-9 : 1e9;
  for (Vec3& p : t.surface.poles) p = p * unit;
  return t;
}

Trial sliver(Random& random) {
  Trial t{any_bumpy(random), anywhere(random), anywhere(random)};
  const double width = random.log_between(1e-8, 1e-3);
  for (Vec3& p : t.surface.poles) p = {p.x, p.y * width, p.z * width};
  return t;
}

/// A closed tube, not periodic: its ends meet in a seam with a common tangent plane.
Trial seam(Random& random) {
  Trial t{bumpy(random, 3, 3, 0.2, 0.2, 9), 0, anywhere(random)};
  BsplineSurface& s = t.surface;
  const int last = s.count_u - 1;
  for (int i = 0; i <= last; ++i)
    for (int j = 0; j < s.count_v; ++j) {
      const double a = 6.28318530717958647692 * i / last, r = 1 + 0.1 * random.between(-1, 1);
      pole(s, i, j) = {r * std::cos(a), r * std::sin(a), static_cast<double>(j) / 4};
    }
  for (int j = 0; j < s.count_v; ++j) {
    pole(s, last, j) = pole(s, 0, j);
    pole(s, last - 1, j) = pole(s, 0, j) * 2 - pole(s, 1, j);
  }
  const double from = random.log_between(kNearest, 0.05);
  t.u = random.integer(0, 1) ? from : 1 - from;
  return t;
}

}  // namespace

double Random::log_between(double lo, double hi) {
  return std::exp(between(std::log(lo), std::log(hi)));
}

Trial random_patch(Random& random) {
  Trial t{bumpy(random, random.integer(1, 15), random.integer(1, 15), 0.3, 0.3), anywhere(random),
          anywhere(random)};
  add_weights(random, t.surface, 0.1, 10);
  return t;
}

Trial wild_patch(Random& random) {
  Trial t{bumpy(random, random.integer(1, 15), random.integer(1, 15), 0, 0), anywhere(random),
          anywhere(random)};
  for (Vec3& p : t.surface.poles) p = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  add_weights(random, t.surface, 0.1, 10);
  return t;
}

const std::vector<Family>& hard_families() {
  static const std::vector<Family> families{{"collapsed edges", collapsed_edge},
                                            {"triangular patches", triangular_patch},
                                            {"poles of spheres", sphere_pole},
                                            {"near-parallel partials", near_parallel},
                                            {"near-umbilics", near_umbilic},
                                            {"repeated knots", repeated_knots},
                                            {"cusps", cusp},
                                            {"weights from 1e-6 to 1e6", extreme_weights},
                                            {"degrees 20 to 25", high_degree},
                                            {"1e8 sizes from the origin", far_away},
                                            {"units of 1e-9 and 1e9", odd_units},
                                            {"slivers", sliver},
                                            {"seams", seam}};
  return families;
}

}  // namespace dupin::bench
