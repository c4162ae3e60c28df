#include "../../sampling/conic_arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;
const LocalTolerance kLoose = [](const Box3&) { return 1e-3; };

Edge edge_on(Curve3 curve, double t0, double t1) {
  Edge edge;
  edge.curve = std::move(curve);
  edge.t0 = t0, edge.t1 = t1;
  return edge;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double dd = dot(d, d), s = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0;
  return distance(p, a + d * s);
}

/// Least distance from p to the chain, every arc replaced by a fine polygon.
double distance_to_chain(const Vec3& p, const ArcChain& chain, int samples) {
  double least = 1e300;
  for (const ConicArc3& arc : chain.arcs)
    for (int i = 0; i < samples; ++i)
      least = std::min(least, distance_to_segment(p, point_at(arc, static_cast<double>(i) / samples),
                                                  point_at(arc, (i + 1.0) / samples)));
  return least;
}

TEST(ConicArc, CirclesAreExactWhateverTheirLength) {
  for (double turn : {0.1, 1.0, kPi, 5.0, 2 * kPi}) {
    const CircleOf<Vec3> circle{{1, 2, 3}, {0, 1, 0}, {0, 0, 1}, 2.5};
    const ArcChain chain = approximate_edge(edge_on({circle}, 0.3, 0.3 + turn), kLoose);
    for (const ConicArc3& arc : chain.arcs)
      for (int i = 0; i <= 10; ++i) EXPECT_NEAR(distance(point_at(arc, i / 10.0), circle.center), 2.5, 1e-14);
    EXPECT_NEAR(distance(chain.arcs.back().p2, circle.center + circle.x * (2.5 * std::cos(0.3 + turn)) +
                                                   circle.y * (2.5 * std::sin(0.3 + turn))),
                0, 1e-14);
  }
}

TEST(ConicArc, EllipsesParabolasAndHyperbolasAreExact) {
  const EllipseOf<Vec3> ellipse{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, 1};
  for (const ConicArc3& arc : approximate_edge(edge_on({ellipse}, -1, 4), kLoose).arcs)
    for (int i = 0; i <= 10; ++i) {
      const Vec3 p = point_at(arc, i / 10.0);
      EXPECT_NEAR(p.x * p.x / 9 + p.y * p.y, 1, 1e-13);
    }
  const ParabolaOf<Vec3> parabola{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.5};
  for (const ConicArc3& arc : approximate_edge(edge_on({parabola}, -1, 4), kLoose).arcs)
    for (int i = 0; i <= 10; ++i) {
      const Vec3 p = point_at(arc, i / 10.0);
      EXPECT_NEAR(p.x, p.y * p.y / 2, 1e-13);
    }
  const HyperbolaOf<Vec3> hyperbola{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 1};
  for (const ConicArc3& arc : approximate_edge(edge_on({hyperbola}, -1.5, 2), kLoose).arcs)
    for (int i = 0; i <= 10; ++i) {
      const Vec3 p = point_at(arc, i / 10.0);
      EXPECT_NEAR(p.x * p.x / 4 - p.y * p.y, 1, 1e-12);
    }
}

TEST(ConicArc, SplinesStayWithinTheToleranceAndSayByHowMuch) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int degree : {1, 2, 3, 5, 7})
    for (bool rational : {false, true}) {
      Bspline3 spline;
      spline.degree = degree;
      const int poles = degree + 6;
      for (int i = 0; i < poles; ++i) {
        spline.poles.push_back({i + 0.5 * value(rng), 3 * value(rng), value(rng)});
        if (rational) spline.weights.push_back(1.5 + value(rng));
      }
      for (int i = 0; i < poles + degree + 1; ++i)
        spline.knots.push_back(std::clamp(i - degree, 0, poles - degree));
      const double t1 = poles - degree;
      const Edge edge = edge_on({spline}, 0, t1);
      const ArcChain chain = approximate_edge(edge, kLoose);
      EXPECT_LE(chain.deviation, 1e-3);
      for (int i = 0; i <= 200; ++i)
        EXPECT_LE(distance_to_chain(point_at(*edge.curve, t1 * i / 200), chain, 64), 1e-3 + 2e-4)
            << "degree " << degree;
      for (std::size_t i = 1; i < chain.arcs.size(); ++i) EXPECT_EQ(chain.arcs[i - 1].p2, chain.arcs[i].p0);
    }
}

TEST(ConicArc, PartsLieOnTheWhole) {
  const ConicArc3 arc{{0, 0, 0}, {1, 2, 1}, {3, 0, 0}, 0.4, false, 0, 1};
  const ConicArc3 part = sub_arc(arc, 0.2, 0.7);
  EXPECT_NEAR(distance(part.p0, point_at(arc, 0.2)), 0, 1e-15);
  EXPECT_NEAR(distance(part.p2, point_at(arc, 0.7)), 0, 1e-15);
  for (int i = 0; i <= 10; ++i) {
    double least = 1e300;
    for (int k = 0; k <= 20000; ++k)
      least = std::min(least, distance(point_at(part, i / 10.0), point_at(arc, k / 20000.0)));
    EXPECT_LT(least, 2e-4);
  }
}

TEST(ConicArc, ClippingKeepsExactlyTheInnerSide) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const ConicArc3 arc{{value(rng), value(rng), value(rng)},
                        {value(rng), value(rng), value(rng)},
                        {value(rng), value(rng), value(rng)},
                        0.2 + std::abs(value(rng)),
                        trial % 5 == 0,
                        0,
                        1};
    const Vec3 n = normalized({value(rng), value(rng), value(rng)});
    const double d = 0.3 * value(rng);
    std::vector<ConicArc3> parts;
    clip_to_half_space(arc, n, d, parts);
    for (const ConicArc3& part : parts)
      for (int i = 0; i <= 16; ++i) EXPECT_GE(dot(n, point_at(part, i / 16.0)) + d, -1e-12);
    ArcChain chain;
    chain.arcs = parts;
    for (int i = 0; i <= 50; ++i) {
      const Vec3 p = point_at(arc, i / 50.0);
      if (dot(n, p) + d > 1e-3) {
        EXPECT_LT(distance_to_chain(p, chain, 500), 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace dupin
