#include "neighbors.h"

#include <algorithm>
#include <nanoflann.hpp>

#include "../core/parallel.h"

namespace dupin {
namespace {

constexpr std::uint32_t kTile = 96;         ///< samples along a side of a block of a grid
constexpr std::size_t kBlockPoints = 8192;  ///< of a block in space, at most
/// Of the angle between normals of one sheet: radians, and times the larger curvature and the distance, which
/// is what it would be if that curvature went on; as chords of the unit circle.
constexpr double kFreeTurn = 0.05, kTurnFactor = 1.5;
constexpr std::size_t kAcross = 8;         ///< nearest points of other patches that a border point looks at
constexpr std::size_t kWithoutOrder = 12;  ///< nearest points that a point without grid or edges looks at

/// Whether two points can lie on one smooth piece of surface: their normals differ by no more than the
/// curvature allows over their distance, nor does the way from one to the other leave their planes by more.
/// Rectangles that reach over a sharp edge do not stand for the surface behind it.
bool same_sheet(const Rectangle& p, const Rectangle& q, const Vec3& d) {
  const double most = std::max(std::abs(p.lambda_u), std::abs(q.lambda_u)), distance = length(d);
  const double turn = std::min(kFreeTurn + kTurnFactor * most * distance, kMostTurn);
  const Vec3 chord = p.n - q.n;
  return dot(chord, chord) <= turn * turn && std::abs(dot(d, p.n)) <= turn * distance &&
         std::abs(dot(d, q.n)) <= turn * distance;
}

/// Some of a part's points for nanoflann.
struct Cloud {
  const std::vector<Rectangle>& rectangles;
  std::vector<std::uint32_t> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t k) const {
    return rectangles[points[i]].position[static_cast<int>(k)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

/// For each of the cloud's points its nearest ones that `wanted` lets through.
template <class Wanted>
std::vector<Pair> nearest_pairs(const Cloud& cloud, std::size_t look_at, std::size_t most,
                                const PruneOptions& options, const Wanted& wanted) {
  const std::size_t count = cloud.points.size();
  if (count < 2) return {};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  std::vector<std::vector<Pair>> found(count);
  parallel_for(
      count,
      [&](std::size_t i) {
        std::vector<std::uint32_t> nearest(std::min(look_at, count));
        std::vector<double> distances(nearest.size());
        const std::uint32_t p = cloud.points[i];
        const Vec3& at = cloud.rectangles[p].position;
        const double query[3] = {at.x, at.y, at.z};
        const std::size_t got = tree.knnSearch(query, nearest.size(), nearest.data(), distances.data());
        std::size_t taken = 0;
        for (std::size_t k = 0; k < got && taken < most; ++k) {
          const std::uint32_t q = cloud.points[nearest[k]];
          if (q == p || !wanted(p, q)) continue;
          ++taken;
          if (related(cloud.rectangles[p], cloud.rectangles[q], options))
            found[i].push_back({std::min(p, q), std::max(p, q)});
        }
      },
      256);
  std::vector<Pair> pairs;
  for (const auto& own : found) pairs.insert(pairs.end(), own.begin(), own.end());
  return pairs;
}

void grid_pairs(const PartPoints& part, const SampleGrid& grid, const std::vector<Rectangle>& rectangles,
                const PruneOptions& options, std::vector<Pair>& pairs) {
  const int reach = options.grid_neighbors == 24 ? 2 : 1;
  const auto rows = static_cast<int>(grid.rows), columns = static_cast<int>(grid.columns);
  const auto at = [&](int i, int j) {
    return part.grid_points[grid.first + static_cast<std::uint32_t>(i) * grid.columns +
                            static_cast<std::uint32_t>(j)];
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const std::uint32_t p = at(i, j);
      if (p == kNoPoint) continue;
      // Each pair from the one of the two that comes first.
      for (int di = 0; di <= reach; ++di)
        for (int dj = di == 0 ? 1 : -reach; dj <= reach; ++dj) {
          if (i + di >= rows || j + dj < 0 || j + dj >= columns) continue;
          const std::uint32_t q = at(i + di, j + dj);
          if (q != kNoPoint && related(rectangles[p], rectangles[q], options))
            pairs.push_back({std::min(p, q), std::max(p, q)});
        }
    }
}

/// Points at the border of their grid or of the trims, with the grid that they are of.
void border_points(const PartPoints& part, std::vector<std::uint32_t>& points,
                   std::vector<std::uint32_t>& grid_of) {
  for (std::uint32_t g = 0; g < part.grids.size(); ++g) {
    const SampleGrid& grid = part.grids[g];
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return part.grid_points[grid.first + i * grid.columns + j];
    };
    for (std::uint32_t i = 0; i < grid.rows; ++i)
      for (std::uint32_t j = 0; j < grid.columns; ++j) {
        const std::uint32_t p = at(i, j);
        if (p == kNoPoint) continue;
        const bool border = i == 0 || j == 0 || i + 1 == grid.rows || j + 1 == grid.columns ||
                            at(i - 1, j) == kNoPoint || at(i + 1, j) == kNoPoint ||
                            at(i, j - 1) == kNoPoint || at(i, j + 1) == kNoPoint;
        if (!border) continue;
        points.push_back(p);
        grid_of[p] = g;
      }
  }
}

/// Splits points in space at the median of their longer extent until they are few enough.
void split_in_space(const PartPoints& part, std::vector<std::uint32_t> points, Blocks& blocks) {
  if (points.size() <= kBlockPoints) {
    std::sort(points.begin(), points.end());
    for (const std::uint32_t p : points) blocks.block[p] = static_cast<std::uint32_t>(blocks.points.size());
    blocks.points.push_back(std::move(points));
    return;
  }
  Box3 box;
  for (const std::uint32_t p : points) box.add(part.points[p].position);
  const Vec3 size = box.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double x = part.points[a].position[axis], y = part.points[b].position[axis];
    return x != y ? x < y : a < b;
  });
  split_in_space(part, {points.begin(), middle}, blocks);
  split_in_space(part, {middle, points.end()}, blocks);
}

}  // namespace

Blocks make_blocks(const PartPoints& part) {
  constexpr std::uint32_t kNone = kNoPoint;
  Blocks blocks;
  blocks.block.assign(part.points.size(), kNone);
  for (const SampleGrid& grid : part.grids)
    for (std::uint32_t i = 0; i < grid.rows; i += kTile)
      for (std::uint32_t j = 0; j < grid.columns; j += kTile) {
        std::vector<std::uint32_t> own;
        for (std::uint32_t r = i; r < std::min(i + kTile, grid.rows); ++r)
          for (std::uint32_t c = j; c < std::min(j + kTile, grid.columns); ++c)
            if (const std::uint32_t p = part.grid_points[grid.first + r * grid.columns + c]; p != kNoPoint)
              own.push_back(p);
        for (const std::uint32_t p : own) blocks.block[p] = static_cast<std::uint32_t>(blocks.points.size());
        if (!own.empty()) blocks.points.push_back(std::move(own));
      }
  std::vector<std::uint32_t> rest;
  for (std::uint32_t p = 0; p < blocks.block.size(); ++p)
    if (blocks.block[p] == kNone) rest.push_back(p);
  if (!rest.empty()) split_in_space(part, std::move(rest), blocks);
  return blocks;
}

bool related(const Rectangle& p, const Rectangle& q, const PruneOptions& options) {
  const Vec3 d = q.position - p.position;
  const double reach = p.radius + q.radius;
  if (dot(d, d) > reach * reach) return false;
  if (options.enclosure == EnclosureTest::exact && !same_sheet(p, q, d)) return false;
  return overlaps(p, q);
}

NeighborPairs neighbor_pairs(const PartPoints& part, const std::vector<Rectangle>& rectangles,
                             const PruneOptions& options) {
  NeighborPairs pairs;
  pairs.in_grids.resize(part.grids.size());
  parallel_for(part.grids.size(), [&](std::size_t g) {
    grid_pairs(part, part.grids[g], rectangles, options, pairs.in_grids[g]);
  });
  for (const auto& [a, b] : part.edges)
    if (a != b && related(rectangles[a], rectangles[b], options))
      pairs.others.push_back({std::min(a, b), std::max(a, b)});
  const auto add = [&](const std::vector<Pair>& more) {
    pairs.others.insert(pairs.others.end(), more.begin(), more.end());
  };
  if (!part.grids.empty() && options.across_patches) {
    std::vector<std::uint32_t> border, grid_of(part.points.size(), kNoPoint);
    border_points(part, border, grid_of);
    add(nearest_pairs(Cloud{rectangles, std::move(border)}, 4 * kAcross, kAcross, options,
                      [&](std::uint32_t p, std::uint32_t q) { return grid_of[p] != grid_of[q]; }));
  }
  if (part.grids.empty() && part.edges.empty()) {
    std::vector<std::uint32_t> all(part.points.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    add(nearest_pairs(Cloud{rectangles, std::move(all)}, kWithoutOrder + 1, kWithoutOrder, options,
                      [](std::uint32_t, std::uint32_t) { return true; }));
  }
  std::sort(pairs.others.begin(), pairs.others.end());
  pairs.others.erase(std::unique(pairs.others.begin(), pairs.others.end()), pairs.others.end());
  return pairs;
}

}  // namespace dupin
