#include "neighbors.h"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>

namespace dupin::amg {
namespace {

struct Cloud {
  const std::vector<Vec3>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::uint32_t i, std::size_t axis) const {
    return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Index =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;
constexpr std::size_t kLeafSize = 16;
constexpr double kGuessMargin = 1.2;  // of squared radii
constexpr double kGuessGrowth = 2;

/// Everything within a radius. Choosing the nearest of a few too many afterwards takes a third of the time of
/// keeping them sorted while they come.
struct Ball {
  double squared_radius;
  std::vector<Neighbor>& found;
  bool full() const { return true; }
  std::size_t size() const { return found.size(); }
  double worstDist() const { return squared_radius; }
  bool addPoint(double squared_distance, std::uint32_t index) {
    found.push_back({index, squared_distance});
    return true;
  }
};

}  // namespace

struct NeighborTree::Tree {
  Cloud cloud;
  Index index;
  double squared_diagonal = 0;
  explicit Tree(const std::vector<Vec3>& points)
      : cloud{points}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
    Box3 box;
    for (const Vec3& p : points) box.add(p);
    squared_diagonal = box.diagonal() * box.diagonal();
  }
  void within(const Vec3& point, double squared_radius, std::vector<Neighbor>& found) const {
    const double query[3] = {point.x, point.y, point.z};
    found.clear();
    Ball ball{squared_radius, found};
    index.findNeighbors(ball, query, nanoflann::SearchParams());
  }
};

NeighborTree::NeighborTree(const std::vector<Vec3>& points) : tree_(std::make_unique<Tree>(points)) {}
NeighborTree::~NeighborTree() = default;

double NeighborTree::nearest(const Vec3& point, std::size_t count, double radius, double& guess,
                             std::vector<Neighbor>& found) const {
  const std::size_t all = tree_->cloud.points.size();
  count = std::min(count, all);
  // The tree leaves out what is exactly at the radius, and a query may lie outside the points' box.
  double squared_radius = std::max(guess * kGuessMargin, radius * radius);
  if (!(squared_radius > 0)) squared_radius = tree_->squared_diagonal / static_cast<double>(all + 1);
  if (!(squared_radius > 0)) squared_radius = std::numeric_limits<double>::max();
  for (tree_->within(point, squared_radius, found); found.size() < count; squared_radius *= kGuessGrowth)
    tree_->within(point, squared_radius * kGuessGrowth, found);
  if (count == 0 || found.empty()) return 0;
  const auto last = found.begin() + static_cast<std::ptrdiff_t>(count) - 1;
  std::nth_element(found.begin(), last, found.end(), nearer);
  guess = last->squared_distance;
  double farthest = guess;
  const auto end = std::partition(last + 1, found.end(),
                                  [&](const Neighbor& n) { return n.squared_distance < radius * radius; });
  for (auto n = last + 1; n != end; ++n) farthest = std::max(farthest, n->squared_distance);
  found.erase(end, found.end());
  return farthest;
}

}  // namespace dupin::amg
