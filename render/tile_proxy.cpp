#include "tile_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dupin {
namespace {

constexpr double kGrow = 0.25;  // pixels
/// A prism is drawn by its picture if its nearest point is no nearer than this part of its farthest depth.
constexpr double kNearest = 0.2;
/// What a pixel of the outline costs, in pixels of the inside: processors and GPUs work on blocks of pixels.
constexpr double kOutline = 1.5;

using Points = std::array<Vec2, 8>;  // corners 0–3 at one end, 4–7 at the other
using Corners = std::array<Vec2, 4>;

Plane3 in_frame(const Plane3& plane, const Vec3& origin, const Vec3& u, const Vec3& v, const Vec3& n) {
  return {{dot(plane.n, u), dot(plane.n, v), dot(plane.n, n)}, dot(plane.n, origin) + plane.d};
}

double cost(const Corners& c) {
  double area = 0, outline = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    area += cross(c[k], c[(k + 1) % 4]) / 2;
    outline += length(c[(k + 1) % 4] - c[k]);
  }
  return std::abs(area) + kOutline * outline;
}

/// Around the points, with a side along `axis`.
Corners rectangle(const Points& points, Vec2 axis) {
  const double l = length(axis);
  axis = l > 1e-6 ? axis / l : Vec2{1, 0};
  const Vec2 normal{-axis.y, axis.x};
  Vec2 lo{dot(points[0], axis), dot(points[0], normal)}, hi = lo;
  for (std::size_t i = 1; i < 8; ++i) {
    const double along = dot(points[i], axis), across = dot(points[i], normal);
    lo = {std::min(lo.x, along), std::min(lo.y, across)};
    hi = {std::max(hi.x, along), std::max(hi.y, across)};
  }
  lo = lo - Vec2{kGrow, kGrow}, hi = hi + Vec2{kGrow, kGrow};
  const auto at = [&](double x, double y) { return axis * x + normal * y; };
  return {at(lo.x, lo.y), at(hi.x, lo.y), at(hi.x, hi.y), at(lo.x, hi.y)};
}

/// Sides along those of the quadrilateral halfway between the prism's ends. A side without length cuts its
/// corner off. False where two sides are nearly parallel.
bool along_sides(const Points& points, Corners& result) {
  Corners middle, ways;
  for (std::size_t k = 0; k < 4; ++k) middle[k] = (points[k] + points[k + 4]) * 0.5;
  double turn = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 way = middle[(k + 1) % 4] - middle[k];
    const double l = length(way);
    turn += cross(middle[k] - middle[0], way);
    ways[k] = l > 1e-3 ? way / l : Vec2{0, 0};
  }
  for (std::size_t k = 0; k < 4; ++k)
    if (ways[k].x == 0 && ways[k].y == 0) {
      const Vec2 way = ways[(k + 3) % 4] + ways[(k + 1) % 4];
      const double l = length(way);
      if (l < 0.1) return false;
      ways[k] = way / l;
    }
  std::array<Vec2, 4> normals;
  std::array<double, 4> ends;
  for (std::size_t k = 0; k < 4; ++k) {
    normals[k] = turn < 0 ? Vec2{-ways[k].y, ways[k].x} : Vec2{ways[k].y, -ways[k].x};
    ends[k] = dot(normals[k], points[0]);
    for (std::size_t i = 1; i < 8; ++i) ends[k] = std::max(ends[k], dot(normals[k], points[i]));
    ends[k] += kGrow;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t before = (k + 3) % 4;
    const Vec2 a = normals[before], b = normals[k];
    const double c = cross(a, b);
    if (std::abs(c) < 0.1 || (c < 0) != (turn < 0)) return false;
    result[k] = Vec2{ends[before] * b.y - ends[k] * a.y, ends[k] * a.x - ends[before] * b.x} / c;
  }
  return true;
}

/// Whether a pixel's centre may lie in it, of a picture of twice this size.
bool covers_pixels(const Corners& corners, Vec2 half) {
  Vec2 lo = corners[0], hi = lo;
  for (const Vec2 c : corners) {
    lo = {std::min(lo.x, c.x), std::min(lo.y, c.y)};
    hi = {std::max(hi.x, c.x), std::max(hi.y, c.y)};
  }
  const auto covers = [](double from, double to, double half) {
    const double first = std::max(std::ceil(from + half - 0.5), 0.0),
                 last = std::min(std::floor(to + half - 0.5), 2 * half - 1);
    return first <= last;
  };
  return covers(lo.x, hi.x, half.x) && covers(lo.y, hi.y, half.y);
}

}  // namespace

PictureOfDp::PictureOfDp(const PartCamera& camera, const Vec3& origin, const Vec3& u, const Vec3& v,
                         const Vec3& n, Vec2 half_size)
    : x_(in_frame(camera.rows[0], origin, u, v, n)),
      y_(in_frame(camera.rows[1], origin, u, v, n)),
      depth_(in_frame(camera.depth, origin, u, v, n)),
      half_size_(half_size),
      perspective_(camera.perspective) {
  x_ = {x_.n * half_size.x, x_.d * half_size.x};
  y_ = {y_.n * half_size.y, y_.d * half_size.y};
  // Along the plane of one depth.
  const double volume = dot(cross(x_.n, y_.n), depth_.n);
  steps_ = {cross(y_.n, depth_.n) / volume, cross(depth_.n, x_.n) / volume};
}

PictureOfDp::Seen PictureOfDp::around(const std::array<Vec3, 8>& hull, TileProxy& proxy) const {
  Points points;
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  std::array<int, 4> beyond{};  // points on the far side of each side of the picture
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3& p = hull[i];
    const double depth = dot(depth_.n, p) + depth_.d, w = perspective_ ? depth : 1;
    const Vec2 at{dot(x_.n, p) + x_.d, dot(y_.n, p) + y_.d}, edge = half_size_ * w;
    nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
    beyond[0] += at.x<-edge.x, beyond[1] += at.x> edge.x;
    beyond[2] += at.y<-edge.y, beyond[3] += at.y> edge.y;
    points[i] = at / w;
  }
  if (*std::max_element(beyond.begin(), beyond.end()) == 8) return Seen::nothing;
  if (perspective_ && farthest <= 0) return Seen::nothing;
  if (perspective_ && !(nearest > 0 && nearest >= kNearest * farthest)) return Seen::near_eye;
  proxy.corners = rectangle(points, points[1] - points[0] + points[5] - points[4]);
  double least = cost(proxy.corners);
  const auto prefer = [&](const Corners& corners) {
    const double c = cost(corners);
    if (c < least) least = c, proxy.corners = corners;
  };
  prefer(rectangle(points, points[2] - points[1] + points[6] - points[5]));
  if (Corners corners; along_sides(points, corners)) prefer(corners);
  // It is drawn as two triangles with the side from corner 0 to 2 in common: the shorter one.
  Corners& c = proxy.corners;
  if (!covers_pixels(c, half_size_)) return Seen::nothing;
  if (length(c[3] - c[1]) < length(c[2] - c[0])) std::rotate(c.begin(), c.begin() + 1, c.end());
  proxy.area = std::abs(cross(c[2] - c[0], c[3] - c[1])) / 2;
  return Seen::in_proxy;
}

Vec3 PictureOfDp::at(Vec2 pixel) const {
  const double w = perspective_ ? depth_.d : 1;
  return steps_[0] * (pixel.x * w - x_.d) + steps_[1] * (pixel.y * w - y_.d);
}

double PictureOfDp::px_per_unit(const std::array<Vec3, 8>& points) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) nearest = std::min(nearest, dot(depth_.n, p) + depth_.d);
  const double scale = std::max(length(x_.n), length(y_.n));
  if (!perspective_) return scale;
  return nearest > 0 ? scale / nearest : std::numeric_limits<double>::infinity();
}

}  // namespace dupin
