#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "../../core/parallel.h"
#include "../point_sources.h"

namespace dupin {
namespace {

struct Hit {
  Vec3 position, normal;
  std::uint32_t face;
};

double cross_of(Vec2 a, Vec2 b, Vec2 c) {
  return cross(b - a, c - a);
}

/// Counter-clockwise.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 && cross_of(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The DP's intersections with lattice lines in one of the three directions.
class LatticeScan {
 public:
  LatticeScan(const PartDps& part, const QuadricDp& dp, double spacing, std::size_t most,
              std::vector<Hit>& hits)
      : part_(part), dp_(dp), spacing_(spacing), most_(most), hits_(hits) {
    axes_[0] = dp.u;
    axes_[1] = dp.v;
    axes_[2] = dp.n();
    for (int i = 0; i < 8; ++i) {
      const Vec2 c = dp.footprint[static_cast<std::size_t>(i & 3)];
      corners_.push_back(dp.origin + dp.u * c.x + dp.v * c.y + dp.n() * (i & 4 ? dp.z_hi : dp.z_lo));
    }
  }

  void run(int axis) {
    axis_ = axis;
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::vector<Vec2> flat;
    for (const Vec3& p : corners_) flat.push_back({p[b], p[c]});
    const std::vector<Vec2> hull = convex_hull(flat);
    Box2 box;
    for (const Vec2& p : hull) box.add(p);
    // A little more on each side: lines along the border belong to one of two DPs at least.
    const double margin = 1e-9 * spacing_;
    for (double y = first(box.lo.y - margin); y <= box.hi.y + margin && hits_.size() <= most_;
         y += spacing_) {
      const auto [lo, hi] = extent(hull, std::clamp(y, box.lo.y, box.hi.y));
      for (double x = first(lo - margin); x <= hi + margin && hits_.size() <= most_; x += spacing_)
        line(b, c, x, y);
    }
  }

 private:
  /// The lattice has its lines at odd multiples of half the spacing, where fewer models have their edges.
  double first(double from) const { return (std::ceil(from / spacing_ - 0.5) + 0.5) * spacing_; }

  static std::pair<double, double> extent(const std::vector<Vec2>& hull, double y) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec2 &p = hull[i], &q = hull[(i + 1) % hull.size()];
      if ((p.y < y && q.y < y) || (p.y > y && q.y > y)) continue;
      const double t = q.y != p.y ? (y - p.y) / (q.y - p.y) : 0, x = p.x + t * (q.x - p.x);
      lo = std::min({lo, x, p.y == q.y ? q.x : x});
      hi = std::max({hi, x, p.y == q.y ? q.x : x});
    }
    return {lo, hi};
  }

  Vec3 to_dp(const Vec3& v) const { return {dot(v, axes_[0]), dot(v, axes_[1]), dot(v, axes_[2])}; }

  void line(int b, int c, double x, double y) {
    // From beside the DP's middle, where numbers are as small as it is.
    Vec3 from = dp_.origin, along;
    from[b] = x;
    from[c] = y;
    along[axis_] = 1;
    const Vec3 o = to_dp(from - dp_.origin), d = to_dp(along);
    const auto form = [&](const Vec3& p, const Vec3& q) {
      return 0.5 * (dp_.lambda_u * p.x * q.x + dp_.lambda_v * p.y * q.y + dp_.c * p.z * q.z) +
             0.5 * (dp_.a * (p.x * q.z + p.z * q.x) + dp_.b * (p.y * q.z + p.z * q.y));
    };
    // F(o + t d) = −A t² + B t + C
    const double A = form(d, d), B = d.z - 2 * form(o, d), C = o.z - form(o, o);
    const double root = B * B + 4 * A * C;
    if (!(root >= 0)) return;
    const double q = 0.5 * (B + (B >= 0 ? 1 : -1) * std::sqrt(root));
    if (q != 0) hit(from, o, d, -C / q);
    if (A != 0) hit(from, o, d, q / A);
  }

  void hit(const Vec3& from, const Vec3& o, const Vec3& d, double t) {
    if (!std::isfinite(t)) return;
    const Vec3 p = o + d * t;
    if (!region_contains(part_, dp_, p)) return;
    const Vec3 g = quadric_gradient(dp_, p), flat = axes_[0] * g.x + axes_[1] * g.y + axes_[2] * g.z;
    for (int k = 0; k < 3; ++k)
      if (k != axis_ && (k < axis_ ? std::abs(flat[k]) >= std::abs(flat[axis_])
                                   : std::abs(flat[k]) > std::abs(flat[axis_])))
        return;
    const Vec3 m = drawn_normal(dp_, p), n = axes_[0] * m.x + axes_[1] * m.y + axes_[2] * m.z;
    if (!(length(n) > 0)) return;
    Vec3 position = from;
    position[axis_] += t;
    hits_.push_back({position, normalized(dp_.flipped ? -n : n), dp_.face});
  }

  const PartDps& part_;
  const QuadricDp& dp_;
  double spacing_;
  std::size_t most_;
  std::vector<Hit>& hits_;
  std::array<Vec3, 3> axes_;
  std::vector<Vec3> corners_;
  int axis_ = 0;
};

}  // namespace

Result<SurfacePoints> dp_points(const PartDps& dps, double spacing, std::size_t most) {
  if (!(spacing > 0)) return {StatusCode::invalid_argument, "points of faces need a spacing"};
  std::vector<std::vector<Hit>> hits(dps.dps.size());
  std::atomic<std::size_t> count{0};
  parallel_for(
      dps.dps.size(),
      [&](std::size_t i) {
        LatticeScan scan(dps, dps.dps[i], spacing, most, hits[i]);
        for (int axis = 0; axis < 3 && count <= most; ++axis) scan.run(axis);
        count += hits[i].size();
      },
      8);
  if (count > most) return {StatusCode::limit, "more points than one decomposition can take"};
  SurfacePoints points;
  for (const auto& some : hits)
    for (const Hit& hit : some) {
      points.positions.push_back(hit.position);
      points.normals.push_back(hit.normal);
      points.faces.push_back(hit.face);
    }
  return points;
}

}  // namespace dupin
