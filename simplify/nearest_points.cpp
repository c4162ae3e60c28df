#include "nearest_points.h"

#include <nanoflann.hpp>

namespace dupin {
namespace {

struct Points {
  const std::vector<Vec3>& list;
  std::size_t kdtree_get_point_count() const { return list.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return list[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace

struct NearestPoints::Tree {
  Points points;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::uint32_t>
      index;
  explicit Tree(const std::vector<Vec3>& list) : points{list}, index(3, points, {16}) { index.buildIndex(); }
};

NearestPoints::NearestPoints(const std::vector<Vec3>& points) : tree_(std::make_unique<Tree>(points)) {}
NearestPoints::~NearestPoints() = default;

std::vector<std::uint32_t> NearestPoints::find(const Vec3& place, std::size_t count) const {
  std::vector<std::uint32_t> indices(count);
  std::vector<double> squares(count);
  const double at[3] = {place.x, place.y, place.z};
  indices.resize(tree_->index.knnSearch(at, count, indices.data(), squares.data()));
  return indices;
}

}  // namespace dupin
