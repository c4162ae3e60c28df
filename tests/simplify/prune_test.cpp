// Pruning: the enclosure tests against sampling, the greedy order against the papers' pseudo-code done
// slowly, and what is left covers what was there.
#include "../../simplify/prune.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "../../core/parallel.h"
#include "../../simplify/neighbors.h"
#include "../../simplify/rectangles.h"
#include "points.h"

namespace dupin::testing {
namespace {

std::vector<Shadow> random_shadows(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Shadow> shadows;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 0.4 * unit(random), a = 0.5 + 0.4 * unit(random), b = 0.5 + 0.4 * unit(random);
    shadows.push_back({{1.1 * unit(random), 1.1 * unit(random)},
                       {a * std::cos(turn), a * std::sin(turn)},
                       {-b * std::sin(turn + 0.1 * unit(random)), b * std::cos(turn)}});
  }
  return shadows;
}

bool hides(const Shadow& s, Vec2 p) {
  const double area = cross(s.a, s.b);
  return std::abs(cross(p - s.center, s.b) / area) <= 1 && std::abs(cross(s.a, p - s.center) / area) <= 1;
}
bool hidden(const std::vector<Shadow>& shadows, Vec2 p) {
  return std::any_of(shadows.begin(), shadows.end(), [&](const Shadow& s) { return hides(s, p); });
}

TEST(ExactEnclosure, AgreesWithSampling) {
  std::mt19937 random(3);
  ExactEnclosure enclosed;
  int covered = 0, open = 0, missed = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto shadows = random_shadows(random, 4 + static_cast<std::size_t>(trial % 28));
    constexpr int kSteps = 60;
    bool all = true;
    for (int i = 0; i <= kSteps && all; ++i)
      for (int j = 0; j <= kSteps && all; ++j)
        all = hidden(shadows, {0.8 * (2.0 * i / kSteps - 1), 0.5 * (2.0 * j / kSteps - 1)});
    const bool found = enclosed({0.8, 0.5}, shadows);
    EXPECT_FALSE(found && !all) << "called covered, with a hole, in trial " << trial;
    covered += found;
    open += !found;
    missed += all && !found;
  }
  EXPECT_GT(covered, 300);
  EXPECT_GT(open, 300);
  EXPECT_LT(missed, 60) << "holes between 3721 points are rare";
}

TEST(ExactEnclosure, FindsAHoleOfAThousandth) {
  // Four rectangles around a gap of 0.001 by 0.001.
  const double g = 0.0005;
  const std::vector<Shadow> shadows{{{-1 - g, 0}, {1, 0}, {0, 2}},
                                    {{1 + g, 0}, {1, 0}, {0, 2}},
                                    {{0, -1 - g}, {2, 0}, {0, 1}},
                                    {{0, 1 + g}, {2, 0}, {0, 1}}};
  ExactEnclosure enclosed;
  EXPECT_FALSE(enclosed({1, 1}, shadows));
  auto closed = shadows;
  closed.push_back({{0, 0}, {g * 1.01, 0}, {0, g * 1.01}});
  EXPECT_TRUE(enclosed({1, 1}, closed));
  EXPECT_TRUE(segments_enclosed({1, 1}, closed));
  // Off the test segments the papers' test does not see it.
  auto moved = shadows;
  for (Shadow& s : moved) s.center = s.center + Vec2{0.3, 0.15};
  EXPECT_FALSE(enclosed({0.6, 0.6}, moved));
  EXPECT_TRUE(segments_enclosed({0.6, 0.6}, moved));
}

TEST(ExactEnclosure, ShadowsThatTouchLeaveNothing) {
  const std::vector<Shadow> halves{{{-0.5, 0}, {0.5, 0}, {0, 1}}, {{0.5, 0}, {0.5, 0}, {0, 1}}};
  ExactEnclosure enclosed;
  EXPECT_TRUE(enclosed({1, 1}, halves));
  EXPECT_FALSE(enclosed({1, 1.0001}, halves));
  EXPECT_TRUE(enclosed({1, 1}, std::vector<Shadow>{{{0, 0}, {1, 0}, {0, 1}}}))
      << "a copy of the rectangle itself";
  EXPECT_FALSE(enclosed({1, 1}, std::vector<Shadow>{{{0, 0}, {2, 0}, {2, 0}}}))
      << "seen edge-on it hides nothing";
}

double height(double x, double y) {
  return 0.3 * std::sin(1.3 * x + 0.2) * std::cos(0.9 * y) + 0.05 * x * y;
}
SurfaceJet jet_at(double x, double y) {
  const double s = std::sin(1.3 * x + 0.2), c = std::cos(1.3 * x + 0.2), sy = std::sin(0.9 * y),
               cy = std::cos(0.9 * y);
  SurfaceJet jet;
  jet.p = {x, y, height(x, y)};
  jet.pu = {1, 0, 0.39 * c * cy + 0.05 * y};
  jet.pv = {0, 1, -0.27 * s * sy + 0.05 * x};
  jet.puu = {0, 0, -0.507 * s * cy};
  jet.puv = {0, 0, -0.351 * c * sy + 0.05};
  jet.pvv = {0, 0, -0.243 * s * cy};
  return jet;
}

DifferentialPoint point_over(double x, double y, double epsilon, double delta) {
  const SurfaceJet jet = jet_at(x, y);
  const Curvature c = principal_curvature(jet);
  DifferentialPoint p;
  p.position = jet.p;
  p.u = c.d1;
  p.v = c.d2;
  p.lambda_u = c.k1;
  p.lambda_v = c.k2;
  set_extents(p, epsilon, delta);
  return p;
}

/// A wavy sheet over [-2, 2]², as one grid or two that share a border.
PartPoints sheet(std::uint32_t side, int grids, double epsilon = 0.01, double delta = 0.4) {
  PartPoints part;
  for (int g = 0; g < grids; ++g) {
    part.grids.push_back({static_cast<std::uint32_t>(part.grid_points.size()), side, side});
    for (std::uint32_t i = 0; i < side; ++i)
      for (std::uint32_t j = 0; j < side; ++j) {
        const double x = -2 + 4.0 * (g + static_cast<double>(i) / (side - 1)) / grids,
                     y = -2 + 4.0 * j / (side - 1);
        part.grid_points.push_back(static_cast<std::uint32_t>(part.points.size()));
        part.points.push_back(point_over(x, y, epsilon, delta));
      }
  }
  return part;
}

std::vector<bool> kept(const PartPoints& part, const PruneOptions& options) {
  const auto keep = points_to_keep({part}, options);
  EXPECT_TRUE(keep.ok());
  return keep ? (*keep)[0] : std::vector<bool>{};
}
std::size_t count(const std::vector<bool>& keep) {
  return static_cast<std::size_t>(std::count(keep.begin(), keep.end(), true));
}

/// The papers' pseudo-code, with everything computed anew in every step.
class SlowPruning {
 public:
  SlowPruning(const PartPoints& part, const PruneOptions& options) : options_(options) {
    for (const DifferentialPoint& p : part.points) rectangles_.push_back(rectangle_of(p, options));
    neighbors_.resize(part.points.size());
    for (const auto& own : neighbor_pairs(part, rectangles_, options).in_grids)
      for (const auto& [a, b] : own) neighbors_[a].insert(b), neighbors_[b].insert(a);
  }
  std::vector<bool> run() {
    std::vector<bool> keep(rectangles_.size(), true);
    std::set<std::uint32_t> heap;
    for (std::uint32_t i = 0; i < rectangles_.size(); ++i) heap.insert(i);
    while (!heap.empty()) {
      const std::uint32_t p =
          *std::max_element(heap.begin(), heap.end(), [&](std::uint32_t a, std::uint32_t b) {
            const double x = redundancy(a), y = redundancy(b);
            return x != y ? x < y : a > b;
          });
      heap.erase(p);
      if (!enclosed(p)) continue;
      keep[p] = false;
      const auto around = neighbors_[p];
      for (const std::uint32_t q : around) neighbors_[q].erase(p);
      for (const std::uint32_t a : around)
        for (const std::uint32_t b : around)
          if (a != b && overlaps(rectangles_[a], rectangles_[b])) neighbors_[a].insert(b);
      neighbors_[p].clear();
    }
    return keep;
  }

 private:
  double redundancy(std::uint32_t p) const {
    double sum = 0;
    for (const std::uint32_t q : neighbors_[p])
      sum += similarity(rectangles_[std::min(p, q)], rectangles_[std::max(p, q)]);
    return neighbors_[p].empty() ? 0 : sum / static_cast<double>(neighbors_[p].size());
  }
  bool enclosed(std::uint32_t p) const {
    std::vector<Shadow> shadows;
    for (const std::uint32_t q : neighbors_[p]) shadows.push_back(project(rectangles_[q], rectangles_[p]));
    return !shadows.empty() && segments_enclosed({rectangles_[p].half_u, rectangles_[p].half_v}, shadows);
  }
  const PruneOptions& options_;
  std::vector<Rectangle> rectangles_;
  std::vector<std::set<std::uint32_t>> neighbors_;
};

TEST(Prune, AsPublishedDoesWhatThePseudoCodeDoes) {
  const PartPoints part = sheet(24, 1);
  const PruneOptions options = papers_prune_options();
  const std::vector<bool> fast = kept(part, options), slow = SlowPruning(part, options).run();
  // Sums that are kept up to date round otherwise than new ones; near ties may fall the other way.
  std::size_t other = 0;
  for (std::size_t i = 0; i < slow.size(); ++i) other += fast[i] != slow[i];
  EXPECT_LE(other, slow.size() / 50);
  EXPECT_LT(count(fast), slow.size() / 3);
}

TEST(Similarity, IsOneOnAPlaneAndFallsWithDisagreement) {
  DifferentialPoint a, b;
  a.half_u = a.half_v = b.half_u = b.half_v = 1;
  b.position = {0.5, 0.2, 0};
  EXPECT_DOUBLE_EQ(similarity(rectangle_of(a, {}), rectangle_of(b, {})), 1);
  b.u = {0, std::cos(0.3), std::sin(0.3)};
  b.v = {-1, 0, 0};
  EXPECT_NEAR(similarity(rectangle_of(a, {}), rectangle_of(b, {})), std::cos(0.3), 1e-12);
  // On a sphere each predicts the other's normal, to third order in the angle between them.
  a = b = {};
  a.lambda_u = a.lambda_v = b.lambda_u = b.lambda_v = -1;
  a.position = {0, 0, 1};
  b.position = {0, std::sin(0.2), std::cos(0.2)};
  b.u = {1, 0, 0};
  b.v = {0, std::cos(0.2), -std::sin(0.2)};
  EXPECT_GT(similarity(rectangle_of(a, {}), rectangle_of(b, {})), 1 - 1e-4);
}

/// Points of the sheet that no kept rectangle holds, seen along the surface's normal there.
int holes(const PartPoints& part, const std::vector<bool>& keep) {
  int uncovered = 0;
  for (int i = 0; i <= 150; ++i)
    for (int j = 0; j <= 150; ++j) {
      const SurfaceJet jet = jet_at(-2 + 4.0 * i / 150, -2 + 4.0 * j / 150);
      const Vec3 n = normalized(cross(jet.pu, jet.pv));
      bool covered = false;
      for (std::size_t k = 0; k < keep.size() && !covered; ++k) {
        if (!keep[k]) continue;
        const DifferentialPoint& p = part.points[k];
        // Where the normal through the surface's point meets the rectangle's plane.
        const double t = dot(p.position - jet.p, p.n()) / dot(n, p.n());
        const Vec3 d = jet.p + n * t - p.position;
        covered = std::abs(t) < 0.1 && std::abs(dot(d, p.u)) <= p.half_u && std::abs(dot(d, p.v)) <= p.half_v;
      }
      uncovered += !covered;
    }
  return uncovered;
}

TEST(Prune, LeavesNoHole) {
  for (const int grids : {1, 2}) {
    const PartPoints part = sheet(grids == 1 ? 60 : 40, grids);
    ASSERT_EQ(holes(part, std::vector<bool>(part.points.size(), true)), 0);
    const std::vector<bool> keep = kept(part, {});
    EXPECT_LT(count(keep), part.points.size() / 6);
    EXPECT_EQ(holes(part, keep), 0) << grids << " grids";
  }
}

TEST(Prune, GoesAcrossTheBordersOfPatches) {
  const PartPoints part = sheet(40, 2);
  PruneOptions options;
  const auto between = [&](const std::vector<bool>& keep) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) n += keep[i] && std::abs(part.points[i].position.x) < 0.1;
    return n;
  };
  const std::size_t across = between(kept(part, options));
  options.across_patches = false;
  EXPECT_LT(2 * across, between(kept(part, options)));
}

TEST(Prune, IsTheSameForAnyNumberOfThreads) {
  const PartPoints part = sheet(150, 2);
  set_thread_limit(1);
  const std::vector<bool> one = kept(part, {});
  set_thread_limit(0);
  EXPECT_EQ(one, kept(part, {}));
}

TEST(Prune, WorksAlongTheEdgesOfAMesh) {
  PartPoints part = sheet(60, 1);
  for (std::uint32_t i = 0; i < 60; ++i)
    for (std::uint32_t j = 0; j < 60; ++j) {
      const std::uint32_t p = i * 60 + j;
      if (i + 1 < 60) part.edges.push_back({p, p + 60});
      if (j + 1 < 60) part.edges.push_back({p, p + 1});
      if (i + 1 < 60 && j + 1 < 60) part.edges.push_back({p, p + 61});
    }
  part.grids.clear();
  part.grid_points.clear();
  const std::vector<bool> keep = kept(part, {});
  EXPECT_LT(count(keep), 60U * 60U / 4);
  EXPECT_EQ(holes(part, keep), 0);
}

TEST(Prune, WorksOnPointsWithoutOrder) {
  PartPoints part = sheet(60, 1);
  part.grids.clear();
  part.grid_points.clear();
  const std::vector<bool> keep = kept(part, {});
  EXPECT_LT(count(keep), 60U * 60U / 4);
  EXPECT_EQ(holes(part, keep), 0);
}

TEST(Prune, SidesOfAThinPlateDoNotHideEachOther) {
  PartPoints part = sheet(30, 1);
  const std::size_t top = part.points.size();
  for (std::size_t i = 0; i < top; ++i) {
    DifferentialPoint p = part.points[i];
    p.position = p.position - p.n() * 1e-6;
    p.v = -p.v;
    p.lambda_u = -p.lambda_u;
    p.lambda_v = -p.lambda_v;
    part.points.push_back(p);
  }
  part.grids.clear();
  part.grid_points.clear();
  const std::vector<bool> keep = kept(part, {});
  std::vector<bool> above(keep.begin(), keep.begin() + static_cast<std::ptrdiff_t>(top));
  above.resize(keep.size(), false);
  EXPECT_EQ(holes(part, above), 0);
}

TEST(Prune, RectanglesThatReachOverASharpEdgeDoNotCoverWhatIsBehindIt) {
  constexpr int kSide = 21;
  PartPoints part;
  for (int plane = 0; plane < 2; ++plane) {
    const double slope = plane * 0.8;  // radians, downwards from the edge x = 0
    const Vec3 away{plane == 0 ? -1 : std::cos(slope), 0, -std::sin(slope)};
    part.grids.push_back({static_cast<std::uint32_t>(part.grid_points.size()), kSide, kSide});
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        DifferentialPoint p;
        p.u = plane == 0 ? -away : away;
        p.position = away * (0.05 * i) + p.v * (0.05 * j);
        p.half_u = p.half_v = 0.2;
        part.grid_points.push_back(static_cast<std::uint32_t>(part.points.size()));
        part.points.push_back(p);
      }
  }
  const std::vector<bool> keep = kept(part, {});
  EXPECT_LT(count(keep), part.points.size() / 6);
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const DifferentialPoint& at = part.points[i];
    bool covered = false;
    for (std::size_t k = 0; k < keep.size() && !covered; ++k) {
      const DifferentialPoint& p = part.points[k];
      const Vec3 d = at.position - p.position;
      covered = keep[k] && std::abs(dot(d, p.n())) < 1e-12 && std::abs(dot(d, p.u)) <= 0.2 + 1e-9 &&
                std::abs(dot(d, p.v)) <= 0.2 + 1e-9;
    }
    EXPECT_TRUE(covered) << i;
  }
}

TEST(Prune, SceneKeepsItsGridsAndEdgesInStep) {
  PointScene scene;
  scene.parts = {sheet(40, 2), {}};
  scene.parts[0].edges = {{0, 1}, {5, 700}};
  const PartPoints before = scene.parts[0];
  ASSERT_TRUE(prune(scene, {}).ok());
  const PartPoints& part = scene.parts[0];
  ASSERT_EQ(part.grid_points.size(), before.grid_points.size());
  std::size_t named = 0;
  for (std::size_t i = 0; i < part.grid_points.size(); ++i) {
    if (part.grid_points[i] == kNoPoint) continue;
    ++named;
    EXPECT_EQ(part.points[part.grid_points[i]].position, before.points[before.grid_points[i]].position);
  }
  EXPECT_EQ(named, part.points.size());
  for (const auto& [a, b] : part.edges) EXPECT_LT(std::max<std::size_t>(a, b), part.points.size());
}

TEST(Prune, OptionsOutOfRangeAreRefused) {
  PruneOptions options;
  options.grid_neighbors = 9;
  EXPECT_EQ(points_to_keep({}, options).status().code, StatusCode::invalid_argument);
  options = {};
  options.scale_down = 1;
  EXPECT_EQ(points_to_keep({}, options).status().code, StatusCode::invalid_argument);
  options = {};
  options.slant = -1;
  EXPECT_EQ(points_to_keep({}, options).status().code, StatusCode::invalid_argument);
}

TEST(Prune, StopsWhenAsked) {
  PruneOptions options;
  options.progress = [](std::string_view, double) { return false; };
  EXPECT_EQ(points_to_keep({sheet(20, 1)}, options).status().code, StatusCode::cancelled);
}

}  // namespace
}  // namespace dupin::testing
