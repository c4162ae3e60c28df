// What lies over a knot line, and merged knot spans: looks for differences that exceed their bounds.
#include "../../sampling/knot_strips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../../sampling/bezier_cell.h"
#include "../../sampling/merged_patches.h"
#include "../../sampling/thin_spans.h"

namespace dupin {
namespace {

using Rng = std::mt19937;

double real(Rng& rng, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(rng);
}

Vec4 weighted(const Vec3& p, double w) {
  return {p.x * w, p.y * w, p.z * w, w};
}

BezierPatch random_patch(Rng& rng, const Box2& domain, bool rational) {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 3;
  patch.domain = domain;
  patch.rational = rational;
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; j <= 3; ++j) {
      const Vec2 uv = domain.lo + Vec2{domain.size().x * i / 3, domain.size().y * j / 3};
      patch.poles.push_back(
          weighted({uv.x + real(rng, -0.03, 0.03), uv.y + real(rng, -0.03, 0.03), real(rng, -0.2, 0.2)},
                   rational ? real(rng, 0.8, 1.2) : 1));
    }
  return patch;
}

/// A patch that goes on from another's side u = 1 with a continuous first derivative, `speed` times as fast
/// as its domain says.
BezierPatch smooth_neighbour(Rng& rng, const BezierPatch& a, double width, double speed) {
  BezierPatch b = random_patch(rng, {{1, 0}, {1 + width, 1}}, a.rational);
  for (int j = 0; j <= 3; ++j) {
    const Vec4 &end = a.pole(3, j), &before = a.pole(2, j);
    const double f = width * speed;
    b.pole(0, j) = end;
    b.pole(1, j) = {end.x + f * (end.x - before.x), end.y + f * (end.y - before.y),
                    end.z + f * (end.z - before.z), end.w + f * (end.w - before.w)};
  }
  return b;
}

/// From p to the neighbour's curve t = const.
double distance_along(const BezierPatch& b, const Vec3& p, double t) {
  double lo = 0, hi = 0.6;
  for (int i = 0; i < 200; ++i) {
    const double x = lo + (hi - lo) / 3, y = hi - (hi - lo) / 3;
    (distance(point_at(b, x, t), p) < distance(point_at(b, y, t), p) ? hi : lo) =
        distance(point_at(b, x, t), p) < distance(point_at(b, y, t), p) ? y : x;
  }
  return distance(point_at(b, lo, t), p);
}

TEST(KnotStrips, NothingOverAKnotIsFartherOffThanItsBound) {
  Rng rng(5);
  for (int trial = 0; trial < 60; ++trial) {
    const BezierPatch a = random_patch(rng, {{0, 0}, {1, 1}}, trial % 2 == 1);
    const BezierPatch b = smooth_neighbour(rng, a, real(rng, 0.5, 2), trial % 3 == 0 ? 1 : real(rng, 0.5, 2));
    const SideStrip strip = KnotStrips({&a, &b}, false, false).strip(0, 1);
    ASSERT_FALSE(strip.smooth);
    EXPECT_LT(strip.crease(), 1e-9);
    double most = 0;
    for (double sigma : {0.01, 0.03, 0.1})
      for (double t : {0.0, 0.3, 0.5, 0.9, 1.0}) {
        const double off = distance_along(b, point_at(a, 1 + sigma, t), t), bound = strip.at(sigma).value;
        EXPECT_LE(off, bound * (1 + 1e-6) + 1e-12) << trial << " " << sigma;
        most = std::max(most, off / bound);
      }
    EXPECT_GT(most, 0.05) << "an idle bound";
  }
}

TEST(KnotStrips, WhatDiffersInParametrisationAloneIsNoDifference) {
  Rng rng(6);
  for (bool rational : {false, true}) {
    const BezierPatch whole = random_patch(rng, {{0, 0}, {1, 1}}, rational);
    BezierPatch a = subpatch(whole, 0, 0.3, 0, 1), b = subpatch(whole, 0.3, 1, 0, 1);
    a.domain = {{0, 0}, {1, 1}}, b.domain = {{1, 0}, {1.5, 1}};  // 4.7 times too fast
    const SideStrip strip = KnotStrips({&a, &b}, false, false).strip(0, 1);
    EXPECT_LT(strip.at(SideStrip::kMostSigma).value, 1e-12);
    EXPECT_LT(strip.at(SideStrip::kMostSigma).ds, 1e-11);
  }
}

TEST(KnotStrips, ACreaseIsSeenAndSidesWithoutNeighboursAreSmooth) {
  Rng rng(7);
  const BezierPatch a = random_patch(rng, {{0, 0}, {1, 1}}, false);
  BezierPatch b = smooth_neighbour(rng, a, 1, 1);
  for (int j = 0; j <= 3; ++j) b.pole(1, j).z += 0.1;
  const KnotStrips grid({&a, &b}, false, false);
  EXPECT_NEAR(grid.strip(0, 1).crease(), 0.3, 0.05);
  for (int side : {0, 2, 3}) EXPECT_TRUE(grid.strip(0, side).smooth);
  EXPECT_EQ(grid.neighbour(0, 1), 1);
  EXPECT_EQ(grid.neighbour(1, 1), -1);
  EXPECT_EQ(KnotStrips({&a, &b}, true, false).neighbour(1, 1), 0);
}

/// One smooth patch in n × n spans, each pole moved by up to `noise`.
std::vector<BezierPatch> spans(Rng& rng, int n, double noise) {
  BezierPatch whole = random_patch(rng, {{0, 0}, {1, 1}}, false);
  std::vector<BezierPatch> out = split_patch(whole, n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      BezierPatch& p = out[static_cast<std::size_t>(i * n + j)];
      p.domain = {{1.0 * i / n, 1.0 * j / n}, {1.0 * (i + 1) / n, 1.0 * (j + 1) / n}};
      for (Vec4& pole : p.poles) pole.z += real(rng, -noise, noise);
    }
  return out;
}

TEST(MergedPatches, NothingOfABlockOrItsMarginIsFartherOffThanItsBound) {
  Rng rng(8);
  for (int trial = 0; trial < 20; ++trial) {
    const int n = 6;
    const std::vector<BezierPatch> patches = spans(rng, n, 1e-4);
    std::vector<const BezierPatch*> all;
    for (const BezierPatch& p : patches) all.push_back(&p);
    const KnotStrips grid(all, false, false);
    ASSERT_TRUE(is_mergeable(grid));
    const SpanBlock block{1, 3 + trial % 3, 2, 4};
    const auto merged = merged_patch(grid, block, 1e-2);
    ASSERT_TRUE(merged);
    const Vec2 lo{1.0 / n, 2.0 / n}, size{1.0 * (block.u1 - 1) / n, 2.0 / n};
    double most = 0;
    for (double s = -0.1; s <= 1.1; s += 0.037)
      for (double t = -0.1; t <= 1.1; t += 0.041) {
        const Vec2 uv = lo + Vec2{size.x * s, size.y * t};
        const int i = static_cast<int>(uv.x * n), j = static_cast<int>(uv.y * n);
        const Vec3 p = point_at(patches[static_cast<std::size_t>(i * n + j)], uv.x * n - i, uv.y * n - j);
        const double off = distance(point_at(merged->patch, s, t), p);
        EXPECT_LE(off, merged->beyond.value * (1 + 1e-9));
        most = std::max(most, off);
      }
    EXPECT_GT(most, 0.1 * merged->beyond.value) << "an idle bound";
    for (double margin : merged->margin) EXPECT_GE(margin, kMergedMargin * (1 - 1e-9));
    EXPECT_FALSE(merged_patch(grid, block, 1e-5)) << "off by more than that";
  }
}

/// Two cubic patches and a thin one between them, of one polynomial or bent off it.
std::vector<FittedPatch> with_thin_span(double bend) {
  const auto at = [&](double u, double v) {
    return Vec3{u, v, 0.1 * u * u + 0.05 * u * v * v + (u > 1 ? bend * (u - 1) : 0)};
  };
  std::vector<FittedPatch> patches;
  for (const auto& [lo, hi] : {std::pair{0.0, 1.0}, std::pair{1.0, 1.001}, std::pair{1.001, 2.0}})
    patches.push_back({interpolating_patch(
        [&, a = lo, b = hi](Vec2 uv) {
          const double u = std::clamp(uv.x, a + 1e-15, b);
          return at(u, uv.y);
        },
        {{lo, 0}, {hi, 1}})});
  return patches;
}

TEST(ThinSpans, AreTakenInOnlyWhereTheNeighbourCarriedOnIsTheSurface) {
  std::vector<FittedPatch> same = with_thin_span(0);
  absorb_thin_spans(same, {1e-6, 1e-4});
  ASSERT_EQ(same.size(), 2u);
  EXPECT_LE(same[0].position_error, 1e-9);
  const double end = same[0].patch.domain.hi.x, start = same[1].patch.domain.lo.x;
  EXPECT_EQ(end, start);
  for (const FittedPatch& p : same)
    for (double s : {0.0, 0.5, 0.9995, 1.0}) {
      const double u = patch_to_surface_u(p.patch, s);
      EXPECT_NEAR(point_at(p.patch, s, 0.5).z, 0.1 * u * u + 0.0125 * u, 1e-9);
    }
  std::vector<FittedPatch> bent = with_thin_span(0.01);  // both neighbours turn by more than is allowed
  bent[2].patch = bent[0].patch, bent[2].patch.domain = {{1.001, 0}, {2.001, 1}};
  absorb_thin_spans(bent, {1e-6, 1e-4});
  EXPECT_EQ(bent.size(), 3u);
}

}  // namespace
}  // namespace dupin
