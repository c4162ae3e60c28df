// Regions of every kind, bounded by chance.
#ifndef DUPIN_TESTS_RENDER_RANDOM_REGIONS_H
#define DUPIN_TESTS_RENDER_RANDOM_REGIONS_H

#include <numbers>
#include <random>

#include "../../core/camera.h"
#include "hand_made.h"

namespace dupin::testing {

struct RandomRegions {
  std::mt19937 rng;
  double real(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(rng); }
  int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(rng); }
  bool coin() { return whole(0, 1) == 1; }

  /// A convex quadrilateral about the origin, a rectangle half of the time.
  std::array<Vec2, 4> footprint() {
    if (coin()) {
      const double x0 = real(-1, -0.6), y0 = real(-1, -0.6), x1 = real(0.6, 1), y1 = real(0.6, 1);
      return {Vec2{x0, y0}, Vec2{x1, y0}, Vec2{x1, y1}, Vec2{x0, y1}};
    }
    std::array<Vec2, 4> corners;
    for (int i = 0; i < 4; ++i) {
      const double angle = (i + real(0.3, 0.7)) * std::numbers::pi / 2;
      corners[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return corners;
  }

  /// A closed chain around a centre; `arcs` of its edges are conics, to either side.
  void loop(PartDps& part, QuadricDp& dp, Vec2 centre, double radius, int corners, double arcs) {
    std::vector<Vec2> p;
    for (int i = 0; i < corners; ++i) {
      const double angle = (i + real(-0.3, 0.3)) * 2 * std::numbers::pi / corners, r = radius * real(0.6, 1);
      p.push_back(centre + Vec2{std::cos(angle) * r, std::sin(angle) * r});
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec2 a = p[i], b = p[(i + 1) % p.size()], side{a.y - b.y, b.x - a.x};
      if (real(0, 1) < arcs) {
        part.arcs.push_back(
            {a, (a + b) * 0.5 + (b - a) * real(-0.3, 0.3) + side * (real(0.05, 0.3) * (coin() ? 1 : -1)), b,
             real(0.2, 2.5), coin()});
        ++dp.arcs;
      } else {
        part.lines.push_back({a, b, coin()});
        ++dp.lines;
      }
    }
  }

  void ellipse(PartDps& part, QuadricDp& dp, Vec2 centre, double radius) {
    const double turn = real(0, std::numbers::pi), a = 1 / radius, b = 1 / (radius * real(0.3, 1));
    const double c = std::cos(turn), s = std::sin(turn);
    part.ellipses.push_back({centre, a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c, coin()});
    ++dp.ellipses;
  }

  void add_pieces(PartDps& part, QuadricDp& dp, int most_corners) {
    dp.first_line = static_cast<std::uint32_t>(part.lines.size());
    dp.first_arc = static_cast<std::uint32_t>(part.arcs.size());
    dp.first_ellipse = static_cast<std::uint32_t>(part.ellipses.size());
    const double arcs = whole(0, 2) / 2.0;
    if (whole(0, 5) > 0)
      loop(part, dp, {real(-0.2, 0.2), real(-0.2, 0.2)}, real(0.6, 1.3), whole(3, most_corners), arcs);
    for (int k = whole(0, 3); k > 0; --k) {
      const Vec2 centre{real(-0.6, 0.6), real(-0.6, 0.6)};
      if (coin()) {
        ellipse(part, dp, centre, real(0.05, 0.4));
      } else {
        loop(part, dp, centre, real(0.1, 0.4), whole(3, most_corners), arcs);
      }
    }
    dp.reference = {real(-0.5, 0.5), real(-0.5, 0.5)};
    dp.reference_inside = coin();
  }

  void add_planes(PartDps& part, QuadricDp& dp) {
    dp.first_plane = static_cast<std::uint32_t>(part.planes.size());
    for (int k = whole(0, 2); k > 0; --k) {
      const double angle = real(0, 2 * std::numbers::pi);
      part.planes.push_back(
          {normalized(Vec3{std::cos(angle), std::sin(angle), real(-0.5, 0.5)}), real(0.1, 0.9), coin()});
      ++dp.planes;
    }
  }

  QuadricDp dp(PartDps& part, bool planar, int most_corners) {
    const Vec3 u = normalized(Vec3{real(-1, 1), real(-1, 1), real(-1, 1)});
    const Vec3 v = normalized(cross(u, Vec3{real(-1, 1), real(-1, 1), real(-1, 1)}));
    const Vec3 origin{real(-3, 3), real(-3, 3), real(-3, 3)};
    QuadricDp result = planar ? plane_rectangle(origin, u, v, 2, 2)
                              : bent_square(origin, u, v, real(-0.9, 0.9), real(-0.9, 0.9),
                                            {real(-0.2, 0.2), real(-0.2, 0.2), 0}, 1);
    if (!planar && whole(0, 3) == 0) result = whole_cylinder(origin, u, v, real(0.7, 1), 1);
    result.flipped = coin();
    result.feature_sides = static_cast<std::uint8_t>(whole(0, 63));
    result.footprint = footprint();
    add_pieces(part, result, most_corners);
    if (!planar) add_planes(part, result);
    return result;
  }

  /// From a side from which the DP is not seen at a grazing angle.
  Camera camera(const QuadricDp& dp, double distance) {
    Camera c;
    c.width = 160, c.height = 140;
    c.orthographic = coin();
    c.ortho_height = distance * 0.5;
    c.target = dp.origin;
    const double side = coin() ? 1 : -1;
    c.eye =
        dp.origin + normalized(dp.n() * side + dp.u * real(-0.9, 0.9) + dp.v * real(-0.9, 0.9)) * distance;
    c.up = dp.u + dp.v * 0.3;
    return c;
  }
};

}  // namespace dupin::testing

#endif
