#include "neighborhoods.h"

#include <algorithm>
#include <cmath>

#include "../../core/parallel.h"
#include "neighbors.h"
#include "star.h"

namespace dupin::amg {
namespace {

constexpr std::size_t kChunk = 512;
/// A star is closed by the nearest few nearly always; more are looked at only if it is not.
constexpr std::size_t kFirstStarPoints = 12, kSecondStarPoints = 24;
/// λ1 / λ0 below this: the neighbors are on a line and have no tangent plane.
constexpr double kCollinear = 1e-12;
/// Of a point without a triangle: it is tied to as many of its neighbors, like a point of a curve.
constexpr std::size_t kCurveNeighbors = 2;

/// A range of points, worked on by one thread with memory of its own.
class Chunk {
 public:
  Chunk(const UniquePoints& points, const NeighborhoodOptions& options, Neighborhoods& result)
      : points_(points), options_(options), result_(result) {}

  Fans fans;  ///< of the loose points of the chunk

  void run(const NeighborTree& tree, std::uint32_t begin, std::uint32_t end, const std::vector<bool>& loose) {
    for (std::uint32_t i = begin; i < end; ++i) {
      find_neighbors(tree, i);
      describe(i);
      if (loose[i]) add_fan(i);
    }
  }

 private:
  void find_neighbors(const NeighborTree& tree, std::uint32_t i) {
    squared_radius_ =
        tree.nearest(points_.positions[i], options_.neighbors + 1, options_.radius, guess_, found_);
    std::erase_if(found_, [&](const Neighbor& n) {
      return n.index == i ||
             (!points_.normals.empty() && !same_sheet(points_.normals[i], points_.normals[n.index]));
    });
    // The nearest first, as far as anything depends on it.
    std::partial_sort(found_.begin(), found_.begin() + std::min(kSecondStarPoints, found_.size()),
                      found_.end(), nearer);
    around_.clear();
    for (const Neighbor& n : found_) around_.push_back(points_.positions[n.index]);
  }

  void describe(std::uint32_t i) {
    moments_ = moments(points_.positions[i], around_);
    result_.classifiers[i] = classifier(moments_, std::max(std::sqrt(squared_radius_), options_.radius));
    const bool known = !points_.normals.empty() && dot(points_.normals[i], points_.normals[i]) > 0;
    result_.normals[i] = known ? points_.normals[i] : moments_.first.vectors[2];
    result_.spacings[i] =
        found_.empty() ? 0
                       : std::sqrt(found_[std::min(kSpacingNeighbor, found_.size()) - 1].squared_distance);
  }

  void add_fan(std::uint32_t i) {
    make_star(i);
    for (const StarPoint& p : star_.points) fans.points.push_back(p.index);
    // A star that leaves half the plane open begins after the gap, so that the last and the first are its
    // ends.
    fans.closed.push_back(star_.closed);
    fans.first.push_back(fans.points.size());
  }

  void make_star(std::uint32_t i) {
    star_.points.clear();
    star_.closed = false;
    const auto& [l0, l1, l2] = moments_.first.values;
    if (found_.empty() || !(l1 > kCollinear * l0)) return take_curve_neighbors();
    for (const std::size_t count : {kFirstStarPoints, kSecondStarPoints, found_.size()}) {
      if (count > found_.size()) continue;
      const bool all = count >= found_.size();
      const double reach = all ? squared_radius_ : found_[count - 1].squared_distance,
                   scale = kStarRange / std::sqrt(reach);
      project(i, count, scale);
      delaunay_star(flat_, star_);
      if (all || squared_reach(star_) < kStarRange * kStarRange) break;
    }
    begin_after_gap();
    if (star_.points.size() < 2) take_curve_neighbors();
  }

  void project(std::uint32_t i, std::size_t count, double scale) {
    const Vec3 &x = points_.positions[i], &e0 = moments_.first.vectors[0], &e1 = moments_.first.vectors[1];
    flat_.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 d = (around_[k] - x) * scale;
      flat_.push_back({std::llround(dot(d, e0)), std::llround(dot(d, e1)), found_[k].index});
    }
  }

  void begin_after_gap() {
    if (star_.closed) return;
    for (std::size_t k = 0; k < star_.points.size(); ++k) {
      const std::size_t next = (k + 1) % star_.points.size();
      if (less_than_half_turn(star_.points[k], star_.points[next])) continue;
      std::rotate(star_.points.begin(), star_.points.begin() + static_cast<std::ptrdiff_t>(next),
                  star_.points.end());
      return;
    }
  }

  void take_curve_neighbors() {
    star_.points.clear();
    for (std::size_t k = 0; k < std::min(kCurveNeighbors, found_.size()); ++k)
      star_.points.push_back({0, 0, found_[k].index});
  }

  const UniquePoints& points_;
  const NeighborhoodOptions& options_;
  Neighborhoods& result_;
  std::vector<Neighbor> found_;
  std::vector<Vec3> around_;
  std::vector<StarPoint> flat_;
  Moments moments_;
  Star star_;
  double guess_ = 0, squared_radius_ = 0;
};

void append(const Fans& from, Fans& to) {
  const std::uint64_t before = to.points.size();
  for (std::size_t k = 1; k < from.first.size(); ++k) to.first.push_back(before + from.first[k]);
  to.points.insert(to.points.end(), from.points.begin(), from.points.end());
  to.closed.insert(to.closed.end(), from.closed.begin(), from.closed.end());
}

}  // namespace

Moments moments(const Vec3& center, const std::vector<Vec3>& points) {
  Moments m;
  for (const Vec3& p : points) m.offset += p - center;
  const double n = static_cast<double>(points.size()) + 1;  // the center is one of them
  m.offset = m.offset / n;
  Symmetric3 s{};
  const auto add = [&](const Vec3& d) {
    s[0] += d.x * d.x, s[1] += d.x * d.y, s[2] += d.x * d.z;
    s[3] += d.y * d.y, s[4] += d.y * d.z, s[5] += d.z * d.z;
  };
  add(-m.offset);
  for (const Vec3& p : points) add(p - center - m.offset);
  for (double& v : s) v /= n;
  m.first = eigen(s);
  return m;
}

double classifier(const Moments& m, double radius) {
  const double l0 = m.first.values[0], l2 = std::max(0.0, m.first.values[2]);
  const double s = l0 > 0 && radius > 0 ? length(m.offset) * l2 / (radius * l0) : 0;
  return 1 / (kClassifierAlpha + kClassifierBeta * s * s);
}

bool together(const UniquePoints& points, const Neighborhoods& around, std::uint32_t a, std::uint32_t b) {
  return distance(points.positions[a], points.positions[b]) <=
         kLargestGap * std::min(around.spacings[a], around.spacings[b]);
}

Result<Neighborhoods> neighborhoods(const UniquePoints& points, const NeighborhoodOptions& options,
                                    const Progress& progress) {
  const std::size_t count = points.positions.size();
  Neighborhoods result;
  result.classifiers.resize(count);
  result.normals.resize(count);
  result.spacings.resize(count);
  std::vector<bool> loose(count);
  for (const std::uint32_t i : points.loose) loose[i] = true;
  const NeighborTree tree(points.positions);
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<Fans> fans(chunks);
  parallel_for(chunks, [&](std::size_t c) {
    Chunk chunk(points, options, result);
    chunk.run(tree, static_cast<std::uint32_t>(c * kChunk),
              static_cast<std::uint32_t>(std::min(count, (c + 1) * kChunk)), loose);
    fans[c] = std::move(chunk.fans);
  });
  for (const Fans& f : fans) append(f, result.fans);
  if (!report(progress, "neighborhoods", 1)) return {StatusCode::cancelled, ""};
  return result;
}

}  // namespace dupin::amg
