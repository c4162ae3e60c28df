#include "splat_raster.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

namespace dupin {
namespace {

constexpr int kSubpixelBits = 8, kSubpixels = 1 << kSubpixelBits;
/// Coordinates beyond this many pixels are cut off, so that products of differences fit 64 bits.
constexpr double kGuardBand = 1 << 20;

struct Projected {
  double x = 0, y = 0;  ///< pixels
  double z = 0;         ///< the depth buffer's value
};

class Projector {
 public:
  Projector(const SplatProjection& p, int width, int height)
      : p_(p), half_width_(0.5 * width), half_height_(0.5 * height) {}

  static double value(const std::array<double, 4>& plane, const Vec3& g) {
    return plane[0] * g.x + plane[1] * g.y + plane[2] * g.z + plane[3];
  }
  /// Clip X, Y and the depth.
  Vec3 clip(const Vec3& g) const { return {value(p_.x, g), value(p_.y, g), value(p_.depth, g)}; }
  Projected project(const Vec3& clip) const {
    const double w = p_.perspective ? 1 / clip.z : 1;
    return {(clip.x * w + 1) * half_width_, (clip.y * w + 1) * half_height_, buffer_depth(clip.z)};
  }
  static double value_at(const std::array<double, 4>& section, const Vec3& clip) {
    return section[0] * clip.x + section[1] * clip.y + section[2] * clip.z + section[3];
  }
  bool is_cut_away(const Vec3& clip) const {
    return std::any_of(p_.sections.begin(), p_.sections.end(),
                       [&](const auto& section) { return value_at(section, clip) < 0; });
  }
  double buffer_depth(double depth) const {
    const auto& t = p_.depth_terms;
    return p_.perspective ? t[2] / depth : t[0] + t[1] * depth;
  }

 private:
  const SplatProjection& p_;
  double half_width_, half_height_;
};

std::uint64_t key_of(double z, std::uint32_t number) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(z))} << 32 |
         static_cast<std::uint32_t>(~number);
}

void keep_larger(std::uint64_t& pixel, std::uint64_t key) {
  std::atomic_ref<std::uint64_t> shared(pixel);
  std::uint64_t now = shared.load(std::memory_order_relaxed);
  while (key > now && !shared.compare_exchange_weak(now, key, std::memory_order_relaxed)) {
  }
}

bool is_usable(const Projected& p) {
  return p.z > 0 && p.z < std::numeric_limits<float>::max() && std::abs(p.x) < kGuardBand &&
         std::abs(p.y) < kGuardBand;
}

/// How far surfaces leave a node's tangent plane, in radii, over the sine of the cone of their normals.
constexpr double kSag = 1;

/// Points that are projected together.
constexpr std::size_t kAtOnce = 64;

/// Rounded down, without a call into a library. Of less than 2^31 in size.
std::int32_t floor_of(double v) {
  constexpr double kShift = 4294967296.0;
  return static_cast<std::int32_t>(static_cast<std::int64_t>(v + kShift) - (std::int64_t{1} << 32));
}

/// Rows that one task wrote to.
struct Rows {
  int first = std::numeric_limits<int>::max(), last = 0;
  void add(int from, int to) { first = std::min(first, from), last = std::max(last, to); }
};

}  // namespace

// ---- points

class SplatRaster::Points {
 public:
  Points(SplatRaster& raster, const SplatProjection& projection, Splatting splatting)
      : raster_(raster),
        projection_(projection),
        projector_(projection, raster.width_, raster.height_),
        splatting_(splatting) {
    const auto row = [](const std::array<double, 4>& r) { return Vec3{r[0], r[1], r[2]}; };
    const Vec3 x = row(projection.x), y = row(projection.y), z = row(projection.depth);
    const Vec3 turns[] = {cross(y, z), cross(z, x), cross(x, y)};
    for (std::size_t k = 0; k < 3; ++k) cross_[k] = turns[k];
  }

  /// kAtOnce at most, with the numbers first, first + 1, ….
  void add(std::span<const EncodedNode> nodes, std::uint32_t first) {
    std::array<double, kAtOnce> x, y, z;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 center = node_center(nodes[i]);
      x[i] = center.x, y[i] = center.y, z[i] = center.z;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3 clip = projector_.clip({x[i], y[i], z[i]});
      x[i] = clip.x, y[i] = clip.y, z[i] = clip.z;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      add(nodes[i], {x[i], y[i], z[i]}, first + static_cast<std::uint32_t>(i));
  }
  const Rows& rows() const { return rows_; }

 private:
  void add(const EncodedNode& node, const Vec3& clip, std::uint32_t number) {
    if ((projection_.perspective && !(clip.z > 0)) || projector_.is_cut_away(clip)) return;
    const Projected at = projector_.project(clip);
    if (!is_usable(at)) return;
    const double steps = node_radius(node);
    const double radius = steps * projection_.pixels_per_step / (projection_.perspective ? clip.z : 1);
    if (radius <= 0.5) return middle(at, key_of(at.z, number));
    if (splatting_ == Splatting::simple) {
      if (projection_.flat)
        return disc(at, {radius, radius, 1, 0}, [key = key_of(at.z, number)](double, double) { return key; });
      const Tilt tilt = tilt_of(node, clip, at, steps);
      const double narrow = projection_.foreshortened ? narrow_part(node) : 1;
      return disc(at, ellipse(radius, narrow * radius, tilt), [&](double dx, double dy) {
        const double out = (dx * dx + dy * dy) / (radius * radius);
        const double z =
            at.z + std::clamp(tilt.x * dx + tilt.y * dy, -tilt.reach, tilt.reach) - tilt.reach * out;
        return key_of(std::max(z, tilt.least), number);
      });
    }
    // Behind the whole sphere, so that no neighbour's middle is hidden.
    const double behind = projector_.buffer_depth(clip.z + steps * projection_.depth_per_step);
    if (behind > 0)
      disc(at, {radius, radius, 1, 0},
           [key = key_of(behind, number | kHole)](double, double) { return key; });
    middle(at, key_of(at.z, number));
  }

  void middle(const Projected& at, std::uint64_t key) {
    const int x = floor_of(at.x), y = floor_of(at.y);
    if (x < 0 || y < 0 || x >= raster_.width_ || y >= raster_.height_) return;
    rows_.add(y, y + 1);
    keep_larger(pixel(x, y), key);
  }

  /// How the depth buffer's value changes over a disc in its tangent plane, by no more than `reach`: the
  /// sphere's.
  struct Tilt {
    double x = 0, y = 0, reach = 0, least = 0;
  };
  Tilt tilt_of(const EncodedNode& node, const Vec3& clip, const Projected& at, double radius) const {
    Tilt tilt;
    tilt.least = projector_.buffer_depth(clip.z + 2 * radius * projection_.depth_per_step);
    tilt.reach = at.z - projector_.buffer_depth(clip.z + radius * projection_.depth_per_step);
    // The plane, m·(clip − its middle) = 0: a perspective picture has 1 / depth linear on it.
    const Vec3 n = node_normal(node), m{dot(n, cross_[0]), dot(n, cross_[1]), dot(n, cross_[2])};
    const auto& t = projection_.depth_terms;
    const double scale = projection_.perspective ? t[2] / dot(m, clip) : -t[1] / m.z;
    const double x = scale * m.x * 2 / raster_.width_, y = scale * m.y * 2 / raster_.height_;
    if (std::isfinite(x) && std::isfinite(y)) tilt.x = x, tilt.y = y;
    return tilt;
  }

  /// What is seen of a disc's radius across the direction in which it is farther away: the disc's own,
  /// foreshortened, and how far the surface may leave it as its normals turn.
  double narrow_part(const EncodedNode& node) const {
    const std::uint32_t cone = node_cone(node);
    if (cone == kNoCone) return 1;
    const Vec3 to_eye = projection_.perspective ? projection_.eye - node_center(node) : projection_.eye;
    const double cosine = std::abs(dot(node_normal(node), to_eye)) / length(to_eye);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return std::min(1.0, cosine + kSag * sine * decode_cone_sine(cone));
  }

  struct Ellipse {
    double wide, narrow;  ///< half-axes in pixels
    double x, y;          ///< unit direction of the narrow one
  };
  static Ellipse ellipse(double wide, double narrow, const Tilt& tilt) {
    const double size = std::hypot(tilt.x, tilt.y);
    if (!(size > 0)) return {wide, wide, 1, 0};
    return {wide, std::max(narrow, 0.5), tilt.x / size, tilt.y / size};
  }

  /// The pixels whose centres lie within; at least the one that the middle lies in.
  template <class Key>
  void disc(const Projected& at, const Ellipse& e, const Key& key) {
    // xx dx² + 2 xy dx dy + yy dy² <= 1
    const double across = 1 / (e.narrow * e.narrow), along = 1 / (e.wide * e.wide);
    const double xx = e.x * e.x * across + e.y * e.y * along, xy = e.x * e.y * (across - along);
    const double high = std::sqrt(e.x * e.x * e.wide * e.wide + e.y * e.y * e.narrow * e.narrow);
    const int y0 = std::max(0, static_cast<int>(std::ceil(at.y - high - 0.5)));
    const int y1 = std::min(raster_.height_, static_cast<int>(std::floor(at.y + high - 0.5)) + 1);
    if (y0 < y1) rows_.add(y0, y1);
    for (int y = y0; y < y1; ++y) {
      // Over a row: the middle, and half the width √(1 − dy²/high²) / √xx.
      const double dy = y + 0.5 - at.y, middle_x = at.x - xy / xx * dy;
      const double half = std::sqrt(std::max(0.0, 1 - dy * dy / (high * high)) / xx);
      const int x0 = std::max(0, static_cast<int>(std::ceil(middle_x - half - 0.5)));
      const int x1 = std::min(raster_.width_, static_cast<int>(std::floor(middle_x + half - 0.5)) + 1);
      for (int x = x0; x < x1; ++x) keep_larger(pixel(x, y), key(x + 0.5 - at.x, dy));
    }
    middle(at, key(0, 0));
  }

  std::uint64_t& pixel(int x, int y) {
    return raster_.pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width_) +
                           static_cast<std::size_t>(x)];
  }

  SplatRaster& raster_;
  const SplatProjection& projection_;
  Projector projector_;
  Splatting splatting_;
  std::array<Vec3, 3> cross_;  ///< take normals from the grid to clip coordinates
  Rows rows_;
};

// ---- triangles

class SplatRaster::Triangles {
 public:
  Triangles(SplatRaster& raster, const SplatProjection& projection, std::span<const SplatVertex> vertices)
      : raster_(raster),
        projection_(projection),
        projector_(projection, raster.width_, raster.height_),
        vertices_(vertices) {}

  void add(const SplatTriangle& triangle, std::uint32_t number) {
    Snapped corners[3];
    bool whole = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Known& known = vertex(triangle[k]);
      corners[k] = known.at;
      whole = whole && known.usable;
    }
    if (whole)
      fill(corners, number);
    else
      cut({vertex(triangle[0]).clip, vertex(triangle[1]).clip, vertex(triangle[2]).clip}, number);
  }
  const Rows& rows() const { return rows_; }

 private:
  /// In parts of a pixel.
  struct Snapped {
    std::int32_t x = 0, y = 0;
    double z = 0;
  };
  static Snapped snap(const Projected& p) {
    return {floor_of(p.x * kSubpixels + 0.5), floor_of(p.y * kSubpixels + 0.5), p.z};
  }
  struct Known {
    std::uint32_t index = 0xffffffffu;
    bool usable = false;  ///< in front of the nearest depth, in the guard band, and not cut away
    Snapped at;
    Vec3 clip;
  };
  static constexpr std::size_t kKnown = 1024;

  /// Neighbouring triangles share vertices.
  const Known& vertex(std::uint32_t index) {
    Known& known = known_[index % kKnown];
    if (known.index == index) return known;
    const SplatVertex& v = vertices_[index];
    EncodedNode node;
    node.words[0] = v.words[0], node.words[1] = v.words[1];
    known.index = index;
    known.clip = projector_.clip(node_center(node));
    known.usable = !projection_.perspective || known.clip.z >= projection_.nearest_depth;
    if (!known.usable) return known;
    const Projected at = projector_.project(known.clip);
    known.usable = is_usable(at) && !projector_.is_cut_away(known.clip);
    if (known.usable) known.at = snap(at);
    return known;
  }

  /// Against the nearest depth, the guard band's four sides and the sections, in clip coordinates.
  void cut(std::vector<Vec3> polygon, std::uint32_t number) {
    std::vector<Vec3> next;
    const double sx = 0.5 * raster_.width_, sy = 0.5 * raster_.height_;
    const double bx = kGuardBand / 2 / sx, by = kGuardBand / 2 / sy;
    const std::size_t sides = 5 + projection_.sections.size();
    for (std::size_t side = 0; side < sides && polygon.size() >= 3; ++side) {
      const auto inside = [&](const Vec3& p) {
        const double w = projection_.perspective ? p.z : 1;
        switch (side) {
          case 0:
            return projection_.perspective ? p.z - projection_.nearest_depth : 1.0;
          case 1:
            return bx * w - p.x;
          case 2:
            return bx * w + p.x;
          case 3:
            return by * w - p.y;
          case 4:
            return by * w + p.y;
          default:
            return Projector::value_at(projection_.sections[side - 5], p);
        }
      };
      next.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double fa = inside(a), fb = inside(b);
        if (fa >= 0) next.push_back(a);
        if ((fa >= 0) != (fb >= 0)) next.push_back(a + (b - a) * (fa / (fa - fb)));
      }
      polygon.swap(next);
    }
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const Projected p[3] = {projector_.project(polygon[0]), projector_.project(polygon[i]),
                              projector_.project(polygon[i + 1])};
      if (!is_usable(p[0]) || !is_usable(p[1]) || !is_usable(p[2])) continue;
      const Snapped corners[3] = {snap(p[0]), snap(p[1]), snap(p[2])};
      fill(corners, number);
    }
  }

  struct Edge {
    std::int64_t a, b, c;  ///< a x + b y + c at pixel (x, y); covered where it is not negative
  };
  /// Of three corners in an order that makes the inside positive. A pixel's centre on an edge belongs to the
  /// triangle that has the edge on its top or left.
  static Edge edge(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) {
    const std::int64_t dx = x1 - x0, dy = y1 - y0;
    const bool owned = dy < 0 || (dy == 0 && dx > 0);
    const std::int64_t half = kSubpixels / 2;
    Edge e;
    e.a = -dy * kSubpixels, e.b = dx * kSubpixels;
    e.c = dx * (half - y0) - dy * (half - x0) - (owned ? 0 : 1);
    return e;
  }

  void fill(const Snapped* p, std::uint32_t number) {
    std::int64_t x[3] = {p[0].x, p[1].x, p[2].x}, y[3] = {p[0].y, p[1].y, p[2].y};
    double z[3] = {p[0].z, p[1].z, p[2].z};
    // Pixels whose centres lie in the box.
    const auto first = [](std::int64_t lo) { return (lo + kSubpixels / 2 - 1) >> kSubpixelBits; };
    const auto last = [](std::int64_t hi) { return ((hi - kSubpixels / 2) >> kSubpixelBits) + 1; };
    const std::int64_t x0 = std::max<std::int64_t>(0, first(std::min({x[0], x[1], x[2]})));
    const std::int64_t x1 = std::min<std::int64_t>(raster_.width_, last(std::max({x[0], x[1], x[2]})));
    const std::int64_t y0 = std::max<std::int64_t>(0, first(std::min({y[0], y[1], y[2]})));
    const std::int64_t y1 = std::min<std::int64_t>(raster_.height_, last(std::max({y[0], y[1], y[2]})));
    if (x0 >= x1 || y0 >= y1) return;
    const std::int64_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area == 0) return;
    if (area < 0) std::swap(x[1], x[2]), std::swap(y[1], y[2]), std::swap(z[1], z[2]);
    rows_.add(static_cast<int>(y0), static_cast<int>(y1));
    const Edge e[3] = {edge(x[0], y[0], x[1], y[1]), edge(x[1], y[1], x[2], y[2]),
                       edge(x[2], y[2], x[0], y[0])};

    const double scale = static_cast<double>(kSubpixels) / static_cast<double>(std::abs(area));
    const double dz1 = z[1] - z[0], dz2 = z[2] - z[0];
    const double slope_x =
        (dz1 * static_cast<double>(y[2] - y[0]) - dz2 * static_cast<double>(y[1] - y[0])) * scale;
    const double slope_y =
        (dz2 * static_cast<double>(x[1] - x[0]) - dz1 * static_cast<double>(x[2] - x[0])) * scale;
    const double lowest = std::min({z[0], z[1], z[2]}), highest = std::max({z[0], z[1], z[2]});
    const double at_zero = z[0] - slope_x * (static_cast<double>(x[0]) / kSubpixels - 0.5) -
                           slope_y * (static_cast<double>(y[0]) / kSubpixels - 0.5);
    for (std::int64_t row = y0; row < y1; ++row) {
      std::int64_t from = x0, to = x1;
      for (const Edge& k : e) narrow(k, row, from, to);
      std::uint64_t* const pixels = raster_.pixels_.data() + row * raster_.width_;
      for (std::int64_t column = from; column < to; ++column) {
        const double depth =
            std::clamp(at_zero + slope_x * static_cast<double>(column) + slope_y * static_cast<double>(row),
                       lowest, highest);
        keep_larger(pixels[column], key_of(depth, number));
      }
    }
  }

  static std::int64_t floor_div(std::int64_t a, std::int64_t b) {
    const std::int64_t q = a / b;
    return q * b != a && (a < 0) != (b < 0) ? q - 1 : q;
  }
  /// The columns of a row where an edge's value is not negative.
  static void narrow(const Edge& e, std::int64_t row, std::int64_t& from, std::int64_t& to) {
    const std::int64_t at_zero = e.b * row + e.c;
    if (e.a == 0) {
      if (at_zero < 0) to = from;
    } else if (to - from <= 8) {  // stepping is cheaper than dividing
      while (from < to && e.a * from + at_zero < 0) ++from;
      while (from < to && e.a * (to - 1) + at_zero < 0) --to;
    } else if (e.a > 0) {
      from = std::max(from, -floor_div(at_zero, e.a));  // the least x with a x >= -c
    } else {
      to = std::min(to, floor_div(at_zero, -e.a) + 1);
    }
  }

  SplatRaster& raster_;
  const SplatProjection& projection_;
  Projector projector_;
  std::span<const SplatVertex> vertices_;
  std::vector<Known> known_ = std::vector<Known>(kKnown);
  Rows rows_;
};

// ----

void SplatRaster::begin(int width, int height) {
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (width != width_ || height != height_) {
    pixels_.assign(size, 0);
  } else {
    const auto row = [&](int y) { return pixels_.begin() + static_cast<std::ptrdiff_t>(y) * width_; };
    if (rows_[0] < rows_[1]) std::fill(row(rows_[0]), row(rows_[1]), 0);
  }
  width_ = width, height_ = height;
  rows_ = {height, 0};
}

void SplatRaster::add_rows(int first, int last) {
  if (first >= last) return;
  const std::lock_guard guard(rows_lock_);
  rows_ = {std::min(rows_[0], first), std::max(rows_[1], last)};
}

void SplatRaster::add_points(const SplatProjection& projection, std::span<const SplatList> lists,
                             const CopyNodes& copy_nodes, Splatting splatting) {
  Points points(*this, projection, splatting);
  std::array<EncodedNode, kAtOnce> nodes;
  for (const SplatList& list : lists)
    for (std::size_t from = 0; from < list.items.size(); from += kAtOnce) {
      const auto items = list.items.subspan(from, std::min(kAtOnce, list.items.size() - from));
      copy_nodes(items, nodes.data());
      points.add({nodes.data(), items.size()}, list.first + static_cast<std::uint32_t>(from));
    }
  add_rows(points.rows().first, points.rows().last);
}

void SplatRaster::add_triangles(const SplatProjection& projection, std::span<const SplatVertex> vertices,
                                std::span<const SplatTriangle> triangles, std::span<const SplatList> lists,
                                const TrianglesOf& triangles_of) {
  Triangles filler(*this, projection, vertices);
  std::array<std::array<std::uint32_t, 2>, kAtOnce> ranges;
  for (const SplatList& list : lists)
    for (std::size_t from = 0; from < list.items.size(); from += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, list.items.size() - from);
      // Leaves that are drawn lie apart in memory: it is asked for all of them before any is drawn.
      for (std::size_t i = 0; i < count; ++i) {
        ranges[i] = triangles_of(list.items[from + i]);
        if (ranges[i][0] < ranges[i][1]) __builtin_prefetch(&triangles[ranges[i][0]]);
      }
      for (std::size_t i = 0; i < count; ++i)
        for (std::uint32_t t = ranges[i][0]; t < ranges[i][1]; ++t)
          for (std::size_t k = 0; k < 3; ++k) __builtin_prefetch(&vertices[triangles[t][k]]);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t number = (kTriangle | list.first) + static_cast<std::uint32_t>(4 * (from + i));
        for (std::uint32_t t = ranges[i][0]; t < ranges[i][1]; ++t)
          filler.add(triangles[t], number + (t - ranges[i][0]));
      }
    }
  add_rows(filler.rows().first, filler.rows().last);
}

}  // namespace dupin
