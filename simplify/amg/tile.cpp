#include "tile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "symmetric_eigen3.h"

namespace dupin::amg {
namespace {

constexpr int kMostSamples = 8;          // along a texel's edge, where it is larger than the points' spacing
constexpr double kMostCanvas = 1 << 22;  // samples of a tile
constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();
/// A rim point's surface reaches this part of its spacing beyond it.
constexpr double kRimReach = 0.5;

/// The places of numbers in a list, by open addressing.
class Places {
 public:
  explicit Places(const std::vector<std::uint32_t>& numbers) : numbers_(numbers) {
    while ((1U << (32 - shift_)) < 2 * numbers.size()) --shift_;
    slots_.assign(std::size_t{1} << (32 - shift_), kNoPoint);
    for (std::uint32_t k = 0; k < numbers.size(); ++k) slots_[slot_of(numbers[k])] = k;
  }
  std::uint32_t of(std::uint32_t number) const { return slots_[slot_of(number)]; }

 private:
  /// Where it is, or would be.
  std::size_t slot_of(std::uint32_t number) const {
    // Well mixed: what lies together in space may have numbers with any pattern.
    std::uint32_t mixed = (number ^ number >> 16) * 0x7feb352dU;
    mixed = (mixed ^ mixed >> 15) * 0x846ca68bU;
    std::size_t slot = (mixed ^ mixed >> 16) >> shift_;
    while (slots_[slot] != kNoPoint && numbers_[slots_[slot]] != number)
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }
  const std::vector<std::uint32_t>& numbers_;
  std::vector<std::uint32_t> slots_;
  int shift_ = 31;
};

struct Sample {
  float z = -std::numeric_limits<float>::infinity(), psi = 0;
  std::array<float, 3> normal{};
  std::uint32_t nearest = kNoPoint;
  bool covered() const { return nearest != kNoPoint; }
};

/// A point of the domain in the primitive's frame, x and y in samples.
struct Corner {
  double x, y, z;
  float psi;
  std::array<float, 3> normal;
  std::uint32_t point;
};

double twice_area(const Corner& a, const Corner& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width), height_(height), samples_(std::size_t(width) * std::size_t(height)) {}
  Sample& at(int x, int y) { return samples_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
  int width() const { return width_; }
  int height() const { return height_; }

  void triangle(const Corner& a, const Corner& b, const Corner& c) {
    const double area = twice_area(a, b, c.x, c.y);
    if (area == 0) return;
    const auto [x0, x1] = range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), width_);
    const auto [y0, y1] = range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), height_);
    const double bx = (c.x - b.x) / area, by = (c.y - b.y) / area, cx = (a.x - c.x) / area,
                 cy = (a.y - c.y) / area;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double px = x + 0.5, py = y + 0.5, wa = bx * (py - b.y) - by * (px - b.x),
                     wb = cx * (py - c.y) - cy * (px - c.x), wc = 1 - wa - wb;
        if (wa < 0 || wb < 0 || wc < 0) continue;
        const auto mix = [&](double va, double vb, double vc) {
          return static_cast<float>(wa * va + wb * vb + wc * vc);
        };
        const float z = mix(a.z, b.z, c.z);
        Sample& s = at(x, y);
        if (s.covered() && s.z >= z) continue;
        s.z = z;
        s.psi = mix(a.psi, b.psi, c.psi);
        for (std::size_t k = 0; k < 3; ++k) s.normal[k] = mix(a.normal[k], b.normal[k], c.normal[k]);
        s.nearest = wa >= wb && wa >= wc ? a.point : wb >= wc ? b.point : c.point;
      }
  }

  /// Only where no triangle is: Ψ falls to 0 linearly towards the radius; the largest counts.
  void disc(const Corner& a, double radius, std::vector<float>& falling) {
    const auto [x0, x1] = range(a.x - radius, a.x + radius, width_);
    const auto [y0, y1] = range(a.y - radius, a.y + radius, height_);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double d = std::hypot(x + 0.5 - a.x, y + 0.5 - a.y) / radius;
        float& before = falling[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
        const float now = static_cast<float>(1 - d);
        if (now <= before) continue;
        Sample& s = at(x, y);
        if (s.covered() && before == 0) continue;
        before = now;
        s = {static_cast<float>(a.z), a.psi * now, a.normal, a.point};
      }
  }

 private:
  /// Samples whose centers lie between.
  static std::pair<int, int> range(double lo, double hi, int size) {
    // Rounded by hand: without SSE 4.1, ceil and floor are calls.
    const double from = std::clamp(lo - 0.5, 0.0, double(size)), to = std::clamp(hi + 0.5, 0.0, double(size));
    const int first = static_cast<int>(from);
    return {first < from ? first + 1 : first, static_cast<int>(to)};
  }
  int width_, height_;
  std::vector<Sample> samples_;
};

/// Texels as means of their samples, and then of those beside them where there are none.
struct Texels {
  int width, height;
  std::vector<float> z, psi;
  std::vector<std::array<float, 3>> normal;
  std::vector<std::uint32_t> nearest;

  Texels(int w, int h)
      : width(w),
        height(h),
        z(std::size_t(w) * std::size_t(h)),
        psi(z.size()),
        normal(z.size()),
        nearest(z.size(), kNoPoint) {}
  std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }

  void gather(Canvas& canvas, int samples) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) gather_one(canvas, samples, x, y);
  }

  void fill_rest() {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < z.size(); ++i)
      if (nearest[i] != kNoPoint) front.push_back(i);
    if (front.empty()) return;
    std::vector<bool> done(z.size());
    for (const std::size_t i : front) done[i] = true;
    while (!front.empty()) {
      std::vector<std::size_t> next;
      for (const std::size_t i : front)
        each_beside(i, [&](std::size_t j) {
          if (!done[j] && nearest[j] == kNoPoint) nearest[j] = nearest[i], next.push_back(j);
        });
      for (const std::size_t j : next) average_beside(j, done);
      for (const std::size_t j : next) done[j] = true;
      front = std::move(next);
    }
  }

 private:
  void gather_one(Canvas& canvas, int samples, int x, int y) {
    const std::size_t i = index(x, y);
    int count = 0;
    for (int sy = y * samples; sy < (y + 1) * samples; ++sy)
      for (int sx = x * samples; sx < (x + 1) * samples; ++sx) {
        const Sample& s = canvas.at(sx, sy);
        if (!s.covered()) continue;
        ++count;
        z[i] += s.z;
        psi[i] += s.psi;
        for (std::size_t k = 0; k < 3; ++k) normal[i][k] += s.normal[k];
        nearest[i] = s.nearest;
      }
    if (count == 0) return;
    z[i] /= static_cast<float>(count);
    psi[i] /= static_cast<float>(samples * samples);
  }

  template <class What>
  void each_beside(std::size_t i, const What& what) const {
    const int x = static_cast<int>(i % std::size_t(width)), y = static_cast<int>(i / std::size_t(width));
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if ((dx || dy) && x + dx >= 0 && x + dx < width && y + dy >= 0 && y + dy < height)
          what(index(x + dx, y + dy));
  }

  void average_beside(std::size_t j, const std::vector<bool>& done) {
    float count = 0;
    each_beside(j, [&](std::size_t i) {
      if (!done[i]) return;
      ++count;
      z[j] += z[i];
      for (std::size_t k = 0; k < 3; ++k) normal[j][k] += normal[i][k];
    });
    z[j] /= count;
  }
};

std::uint8_t byte(double unit) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(unit, 0.0, 1.0)));
}

std::array<std::uint8_t, 3> normal_bytes(const std::array<float, 3>& n) {
  const double l = std::hypot(double(n[0]), double(n[1]), double(n[2]));
  std::array<std::uint8_t, 3> bytes{128, 128, 255};
  for (std::size_t k = 0; k < 3 && l > 0; ++k)
    bytes[k] = static_cast<std::uint8_t>(128 + std::lround(127 * double(n[k]) / l));
  return bytes;
}

class TileMaker {
 public:
  TileMaker(const TileSource& source, const TileDomain& domain, double texel, DomainPrimitive& primitive)
      : source_(source), domain_(domain), primitive_(primitive), n_(primitive.n()) {
    // Samples as dense as the points.
    double spacing = 0;
    for (const std::uint32_t p : domain.points) spacing += source.spacings[p];
    spacing /= static_cast<double>(std::max<std::size_t>(1, domain.points.size()));
    const double ratio = spacing > 0 ? std::ceil(texel / spacing) : 1;
    width_ = static_cast<int>(primitive.width);
    height_ = static_cast<int>(primitive.height);
    samples_ = static_cast<int>(std::clamp(ratio, 1.0, double(kMostSamples)));
    while (samples_ > 1 && double(width_) * height_ * samples_ * samples_ > kMostCanvas) --samples_;
  }

  Tile run() {
    Canvas canvas(width_ * samples_, height_ * samples_);
    make_corners(canvas);
    for (std::size_t k = 0; k < domain_.corners.size(); k += 3)
      canvas.triangle(corners_[domain_.corners[k]], corners_[domain_.corners[k + 1]],
                      corners_[domain_.corners[k + 2]]);
    draw_rim(canvas);
    Texels texels(width_, height_);
    texels.gather(canvas, samples_);
    texels.fill_rest();
    Tile tile = quantised(texels);
    for (const Corner& c : corners_)
      if (c.psi >= 0.5)
        tile.deviations.push_back(
            static_cast<float>(std::abs(c.z - height_at(tile, c.x / samples_, c.y / samples_))));
    return tile;
  }

 private:
  void make_corners(const Canvas& canvas) {
    const double sx = canvas.width() / (2 * primitive_.half_u),
                 sy = canvas.height() / (2 * primitive_.half_v);
    for (std::size_t k = 0; k < domain_.points.size(); ++k) {
      const std::uint32_t p = domain_.points[k];
      const Vec3 d = source_.points.positions[p] - primitive_.center;
      const Vec3& normal = source_.normals[p];
      std::array<double, 3> n{dot(normal, primitive_.u), dot(normal, primitive_.v), dot(normal, n_)};
      const float side = !source_.oriented && n[2] < 0 ? -1 : 1;
      corners_.push_back({(dot(d, primitive_.u) + primitive_.half_u) * sx,
                          (dot(d, primitive_.v) + primitive_.half_v) * sy,
                          dot(d, n_),
                          domain_.values[k],
                          {side * float(n[0]), side * float(n[1]), side * float(n[2])},
                          p});
    }
    samples_per_unit_ = std::min(sx, sy);
  }

  void draw_rim(Canvas& canvas) const {
    std::vector<float> falling;
    std::vector<bool> alone(corners_.size(), true);
    for (const std::uint32_t c : domain_.corners) alone[c] = false;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const Corner& c = corners_[k];
      if (!source_.rim[c.point] || !(c.psi > 0)) continue;
      if (falling.empty()) falling.resize(std::size_t(canvas.width()) * std::size_t(canvas.height()));
      // At least so wide that it covers the center of a sample, and what nothing else shows half of one.
      const double radius =
          std::max(alone[k] ? 1.5 : 0.75, kRimReach * source_.spacings[c.point] * samples_per_unit_);
      canvas.disc(c, radius, falling);
    }
  }

  Tile quantised(const Texels& texels) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (std::size_t i = 0; i < texels.z.size(); ++i)
      if (texels.psi[i] > 0) lo = std::min(lo, double(texels.z[i])), hi = std::max(hi, double(texels.z[i]));
    if (!(lo <= hi)) lo = hi = 0;
    primitive_.lo = lo;
    primitive_.hi = hi;
    Tile tile;
    for (std::size_t i = 0; i < texels.z.size(); ++i) {
      tile.psi.push_back(byte(texels.psi[i]));
      const auto n = normal_bytes(texels.normal[i]);
      tile.normal_height.push_back({n[0], n[1], n[2], byte(hi > lo ? (texels.z[i] - lo) / (hi - lo) : 0)});
      tile.nearest.push_back(texels.nearest[i] != kNoPoint ? texels.nearest[i] : domain_.points.front());
    }
    return tile;
  }

  /// Between texels, as it is drawn; x and y in texels.
  double height_at(const Tile& tile, double x, double y) const {
    const double fx = std::clamp(x - 0.5, 0.0, width_ - 1.0), fy = std::clamp(y - 0.5, 0.0, height_ - 1.0);
    const int x0 = std::min(static_cast<int>(fx), width_ - 2),
              y0 = std::min(static_cast<int>(fy), height_ - 2);
    const auto at = [&](int i, int j) {
      return double(tile.normal_height[std::size_t(j) * std::size_t(width_) + std::size_t(i)][3]);
    };
    const double tx = fx - x0, ty = fy - y0;
    const double h = (1 - ty) * ((1 - tx) * at(x0, y0) + tx * at(x0 + 1, y0)) +
                     ty * ((1 - tx) * at(x0, y0 + 1) + tx * at(x0 + 1, y0 + 1));
    return primitive_.lo + (primitive_.hi - primitive_.lo) * h / 255;
  }

  const TileSource& source_;
  const TileDomain& domain_;
  DomainPrimitive& primitive_;
  Vec3 n_;
  std::vector<Corner> corners_;
  int samples_ = 1, width_ = 0, height_ = 0;
  double samples_per_unit_ = 1;
};

/// The axes by principal components, n on the side of the normals.
void orient(const TileSource& source, const TileDomain& domain, DomainPrimitive& primitive) {
  Vec3 middle, normal;
  double weight = 0;
  for (std::size_t k = 0; k < domain.points.size(); ++k) {
    middle += source.points.positions[domain.points[k]] * double(domain.values[k]);
    normal += source.normals[domain.points[k]] * double(domain.values[k]);
    weight += domain.values[k];
  }
  middle = middle / weight;
  Symmetric3 s{};
  for (std::size_t k = 0; k < domain.points.size(); ++k) {
    const Vec3 d = source.points.positions[domain.points[k]] - middle;
    const double w = domain.values[k] / weight;
    s[0] += w * d.x * d.x, s[1] += w * d.x * d.y, s[2] += w * d.x * d.z;
    s[3] += w * d.y * d.y, s[4] += w * d.y * d.z, s[5] += w * d.z * d.z;
  }
  const Eigen3 axes = eigen(s);
  Vec3 n = axes.vectors[2];
  // Without an extent across, the normals say where the plane is.
  if (!(axes.values[1] > 1e-12 * axes.values[0]) && length(normal) > 0) {
    n = normalized(normal);
    primitive.u = axes.values[0] > 0 && std::abs(dot(axes.vectors[0], n)) < 0.99
                      ? normalized(axes.vectors[0] - n * dot(axes.vectors[0], n))
                      : any_perpendicular(n);
  } else {
    primitive.u = axes.vectors[0];
    if (source.oriented && dot(normal, n) < 0) n = -n;
  }
  primitive.v = cross(n, primitive.u);
  primitive.center = middle;
}

}  // namespace

void find_corners(const std::vector<std::uint32_t>& triangles, TileDomain& domain) {
  const Places places(domain.points);
  domain.corners.clear();
  domain.corners.reserve(3 * domain.triangles.size());
  for (const std::uint32_t t : domain.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      domain.corners.push_back(places.of(triangles[3 * std::size_t{t} + k]));
}

DomainPrimitive support(const TileSource& source, const TileDomain& domain, double texel) {
  DomainPrimitive primitive;
  orient(source, domain, primitive);
  Box2 box;
  for (const std::uint32_t p : domain.points) {
    const Vec3 d = source.points.positions[p] - primitive.center;
    const double reach = source.rim[p] ? kRimReach * source.spacings[p] : 0;
    const Vec2 at{dot(d, primitive.u), dot(d, primitive.v)};
    box.add(at - Vec2{reach, reach});
    box.add(at + Vec2{reach, reach});
  }
  // A texel more on every side, so that what is at the border is between texels too.
  primitive.center += primitive.u * box.center().x + primitive.v * box.center().y;
  const auto texels = [&](double size) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(size / texel) + 2, 3.0, double(kMostDomainTile)));
  };
  const auto half = [&](double size, std::uint32_t count) {
    return 0.5 * std::max(size * count / (count - 2.0), texel * count);
  };
  primitive.width = texels(box.size().x);
  primitive.height = texels(box.size().y);
  primitive.half_u = half(box.size().x, primitive.width);
  primitive.half_v = half(box.size().y, primitive.height);
  return primitive;
}

Tile make_tile(const TileSource& source, const TileDomain& domain, double texel, DomainPrimitive& primitive) {
  return TileMaker(source, domain, texel, primitive).run();
}

}  // namespace dupin::amg
