// Inverted in the unit circle about the centre, p / |p|², the star's points are those of the convex hull that
// the centre sees from within. So a scan around the centre that removes reflex points finds them; the test of
// three inverted points' orientation is the test whether the middle one lies within the circle through the
// centre and the other two.
#include "star.h"

#include <algorithm>
#include <limits>

namespace dupin::amg {
namespace {

std::int64_t squared(const StarPoint& p) {
  return p.x * p.x + p.y * p.y;
}
std::int64_t turn(const StarPoint& a, const StarPoint& b) {
  return a.x * b.y - a.y * b.x;
}

/// Whether b is of the star between a and c: inside their circle through the centre.
bool stays(const StarPoint& a, const StarPoint& b, const StarPoint& c) {
  if (turn(a, c) <= 0) return true;
  return turn(a, b) * squared(c) + turn(b, c) * squared(a) - turn(a, c) * squared(b) > 0;
}

bool lower_half(const StarPoint& p) {
  return p.y < 0 || (p.y == 0 && p.x < 0);
}

bool before(const StarPoint& a, const StarPoint& b) {
  const bool la = lower_half(a), lb = lower_half(b);
  if (la != lb) return lb;
  const std::int64_t t = turn(a, b);
  if (t != 0) return t > 0;
  const std::int64_t sa = squared(a), sb = squared(b);
  return sa != sb ? sa < sb : a.index < b.index;
}

void sort_around(std::vector<StarPoint>& points) {
  std::erase_if(points, [](const StarPoint& p) { return p.x == 0 && p.y == 0; });
  std::sort(points.begin(), points.end(), before);
  const auto same_direction = [](const StarPoint& a, const StarPoint& b) {
    return lower_half(a) == lower_half(b) && turn(a, b) == 0;
  };
  points.erase(std::unique(points.begin(), points.end(), same_direction), points.end());
}

}  // namespace

void delaunay_star(std::vector<StarPoint>& points, Star& star) {
  star.points.clear();
  star.closed = false;
  sort_around(points);
  if (points.empty()) return;
  // The nearest is always of the star, so the scan can start and end there.
  const auto nearest =
      std::min_element(points.begin(), points.end(),
                       [](const StarPoint& a, const StarPoint& b) { return squared(a) < squared(b); });
  std::rotate(points.begin(), nearest, points.end());
  const auto settle = [&](const StarPoint& next) {
    while (star.points.size() > 1 && !stays(star.points[star.points.size() - 2], star.points.back(), next))
      star.points.pop_back();
  };
  for (const StarPoint& p : points) {
    settle(p);
    star.points.push_back(p);
  }
  settle(points.front());
  star.closed = star.points.size() > 2;
  for (std::size_t i = 0; i < star.points.size(); ++i)
    star.closed =
        star.closed && less_than_half_turn(star.points[i], star.points[(i + 1) % star.points.size()]);
}

double squared_reach(const Star& star) {
  if (!star.closed) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < star.points.size(); ++i) {
    const StarPoint &a = star.points[i], &b = star.points[(i + 1) % star.points.size()];
    const double ab = double(a.x - b.x) * double(a.x - b.x) + double(a.y - b.y) * double(a.y - b.y);
    const double t = double(turn(a, b));
    // The circumdiameter is the product of the sides over twice the area.
    largest = std::max(largest, double(squared(a)) * double(squared(b)) * ab / (t * t));
  }
  return largest;
}

}  // namespace dupin::amg
