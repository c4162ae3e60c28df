// Splines and frames drawn from a seed, the same on every machine.
#ifndef DUPIN_TESTS_NURBS_RANDOM_GEOMETRY_H
#define DUPIN_TESTS_NURBS_RANDOM_GEOMETRY_H

#include <cstdint>

#include "../../nurbs/curve.h"
#include "../../nurbs/surface.h"

namespace dupin::testing {

/// splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  double between(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }
  int integer(int lo, int hi) {
    return lo + static_cast<int>(next() % static_cast<std::uint64_t>(hi - lo + 1));
  }
  Vec3 point(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Vec3 direction();
  Frame3 frame(bool left_handed = false);

 private:
  std::uint64_t next();
  std::uint64_t state_;
};

struct SplineOptions {
  int degree_u = 3, degree_v = 3;
  int extra_u = 3, extra_v = 3;  ///< poles beyond degree + 1 (beyond degree where periodic)
  bool rational = false;
  bool periodic_u = false;
  bool repeat_knots = false;
  Vec3 origin;
};

/// Clamped at both ends, or periodic; knots in [0, 1] (times any multiplicities).
std::vector<double> random_knots(Random& random, int degree, int extra, bool repeat);
std::vector<double> periodic_knots(Random& random, int degree, int extra);

/// Over a bumpy height field of extent 2, so that the partials are never close to parallel.
BsplineSurface random_surface(Random& random, const SplineOptions& options);
Bspline3 random_curve(Random& random, int degree, int extra, bool rational, bool periodic,
                      const Vec3& origin = {});
Bspline2 random_plane_curve(Random& random, int degree, int extra, bool rational);

/// A parameter of [lo, hi] at least 1e-6 from every knot.
double off_knots(Random& random, const std::vector<double>& knots, double lo, double hi);
/// The shortest span that is not empty.
double shortest_span(const std::vector<double>& knots);

}  // namespace dupin::testing

#endif
