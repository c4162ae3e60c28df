#include "random_geometry.h"

#include <algorithm>
#include <cmath>

namespace dupin::testing {

std::uint64_t Random::next() {
  std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

Vec3 Random::direction() {
  for (;;) {
    const Vec3 d = point(1);
    if (const double l = length(d); l > 0.1 && l < 1) return d / l;
  }
}

Frame3 Random::frame(bool left_handed) {
  Frame3 f;
  f.origin = point(3);
  f.z = direction();
  f.x = normalized(cross(f.z, direction()));
  f.y = cross(f.z, f.x) * (left_handed ? -1.0 : 1.0);
  return f;
}

std::vector<double> random_knots(Random& random, int degree, int extra, bool repeat) {
  std::vector<double> inner;
  while (static_cast<int>(inner.size()) < extra) {
    const double t = random.between(0.05, 0.95);
    const int times =
        repeat ? std::min(random.integer(1, degree), extra - static_cast<int>(inner.size())) : 1;
    const bool near =
        std::any_of(inner.begin(), inner.end(), [t](double k) { return std::abs(k - t) < 0.02; });
    if (!near) inner.insert(inner.end(), static_cast<std::size_t>(times), t);
  }
  std::sort(inner.begin(), inner.end());
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  knots.insert(knots.end(), inner.begin(), inner.end());
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 1.0);
  return knots;
}

std::vector<double> periodic_knots(Random& random, int degree, int extra) {
  const int spans = degree + extra;
  std::vector<double> steps;
  double total = 0;
  for (int i = 0; i < spans; ++i) total += steps.emplace_back(random.between(0.5, 1.5));
  std::vector<double> knots(static_cast<std::size_t>(spans + 2 * degree + 1));
  knots[degree] = 0;
  for (int i = 0; i < spans + degree; ++i)
    knots[degree + i + 1] = i + 1 == spans ? 1 : knots[degree + i] + steps[i % spans] / total;
  for (int i = degree; i > 0; --i) knots[i - 1] = knots[i] - steps[(i - 1 + spans - degree) % spans] / total;
  return knots;
}

BsplineSurface random_surface(Random& random, const SplineOptions& o) {
  BsplineSurface s;
  s.degree_u = o.degree_u;
  s.degree_v = o.degree_v;
  s.periodic_u = o.periodic_u;
  s.knots_u = o.periodic_u ? periodic_knots(random, o.degree_u, o.extra_u)
                           : random_knots(random, o.degree_u, o.extra_u, o.repeat_knots);
  s.knots_v = random_knots(random, o.degree_v, o.extra_v, o.repeat_knots);
  s.count_u = static_cast<int>(s.knots_u.size()) - o.degree_u - 1;
  s.count_v = static_cast<int>(s.knots_v.size()) - o.degree_v - 1;
  const int distinct_u = o.periodic_u ? s.count_u - o.degree_u : s.count_u;
  const auto greville = [](const std::vector<double>& knots, int degree, int i) {
    double sum = 0;
    for (int k = 1; k <= degree; ++k) sum += knots[i + k];
    return sum / degree;
  };
  for (int i = 0; i < s.count_u; ++i)
    for (int j = 0; j < s.count_v; ++j) {
      if (i >= distinct_u) {
        const std::size_t same = static_cast<std::size_t>(i - distinct_u) * s.count_v + j;
        s.poles.push_back(s.poles[same]);
        if (o.rational) s.weights.push_back(s.weights[same]);
        continue;
      }
      const double x = greville(s.knots_u, o.degree_u, i), y = greville(s.knots_v, o.degree_v, j);
      const double angle = 2 * 3.14159265358979323846 * i / distinct_u,
                   radius = 0.7 + random.between(-0.1, 0.1);
      const Vec3 p = o.periodic_u ? Vec3{radius * std::cos(angle), radius * std::sin(angle), 2 * y - 1}
                                  : Vec3{2 * x - 1, 2 * y - 1, random.between(-0.2, 0.2)};
      s.poles.push_back(o.origin + p);
      if (o.rational) s.weights.push_back(random.between(0.6, 1.6));
    }
  return s;
}

Bspline3 random_curve(Random& random, int degree, int extra, bool rational, bool periodic,
                      const Vec3& origin) {
  Bspline3 c;
  c.degree = degree;
  c.periodic = periodic;
  c.knots = periodic ? periodic_knots(random, degree, extra) : random_knots(random, degree, extra, false);
  const int count = static_cast<int>(c.knots.size()) - degree - 1,
            distinct = periodic ? count - degree : count;
  for (int i = 0; i < count; ++i) {
    c.poles.push_back(i < distinct ? origin + random.point(1) : c.poles[i - distinct]);
    if (rational) c.weights.push_back(i < distinct ? random.between(0.6, 1.6) : c.weights[i - distinct]);
  }
  return c;
}

Bspline2 random_plane_curve(Random& random, int degree, int extra, bool rational) {
  Bspline2 c;
  c.degree = degree;
  c.knots = random_knots(random, degree, extra, false);
  for (std::size_t i = 0; i + degree + 1 < c.knots.size(); ++i) {
    c.poles.push_back({static_cast<double>(i) + random.between(-0.4, 0.4), random.between(-1, 1)});
    if (rational) c.weights.push_back(random.between(0.6, 1.6));
  }
  return c;
}

double off_knots(Random& random, const std::vector<double>& knots, double lo, double hi) {
  for (;;) {
    const double t = random.between(lo, hi);
    if (std::none_of(knots.begin(), knots.end(), [t](double k) { return std::abs(k - t) < 1e-6; })) return t;
  }
}

double shortest_span(const std::vector<double>& knots) {
  double shortest = knots.back() - knots.front();
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (knots[i] > knots[i - 1]) shortest = std::min(shortest, knots[i] - knots[i - 1]);
  return shortest;
}

}  // namespace dupin::testing
