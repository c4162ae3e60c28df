#include "merged_patches.h"

#include <algorithm>
#include <cmath>

#include "fitted_patches.h"

namespace dupin {
namespace {

constexpr int kDegree = 5;

/// The grown block's columns, or rows.
struct Range {
  int first = 0, last = 0;
  double lo = 0, hi = 0;  ///< in parameters
};

template <class Start, class Exists>
Range grown(int from, int to, const Start& start, const Exists& exists) {
  Range r{from, to - 1, start(from), start(to)};
  const double margin = (r.hi - r.lo) * kMergedMargin, lo = r.lo - margin, hi = r.hi + margin;
  const int most = to - from;  // neighbours beyond: no more of them than the block has
  while (r.lo > lo && from - r.first < most && exists(r.first - 1)) r.lo = std::max(lo, start(--r.first));
  while (r.hi < hi && r.last - to + 1 < most && exists(r.last + 1)) {
    ++r.last;
    r.hi = std::min(hi, start(r.last + 1));
  }
  return r;
}

class Block {
 public:
  Block(const KnotStrips& grid, const SpanBlock& block)
      : grid_(grid),
        own_{{grid.column_start(block.u0), grid.row_start(block.v0)},
             {grid.column_start(block.u1), grid.row_start(block.v1)}},
        u_(grown(
            block.u0, block.u1, [&](int i) { return grid.column_start(i); },
            [&](int i) { return grid.index(i, block.v0) >= 0; })),
        v_(grown(
            block.v0, block.v1, [&](int i) { return grid.row_start(i); },
            [&](int i) { return grid.index(block.u0, i) >= 0; })) {}

  bool is_whole() const {
    for (int c = u_.first; c <= u_.last; ++c)
      for (int r = v_.first; r <= v_.last; ++r)
        if (grid_.index(c, r) < 0) return false;
    return true;
  }

  std::optional<MergedPatch> fit(double tolerance) const {
    const Box2 box{{u_.lo, v_.lo}, {u_.hi, v_.hi}};
    const BezierPatch wide = interpolating_patch([&](Vec2 uv) { return point(uv); }, box);
    if (!passes_samples(wide, box, tolerance)) return std::nullopt;
    MergedPatch out;
    for (int c = u_.first; c <= u_.last; ++c)
      for (int r = v_.first; r <= v_.last; ++r)
        if (!add_difference(c, r, wide, box, tolerance, out.beyond)) return std::nullopt;
    const Vec2 size = box.size();
    out.patch = subpatch(wide, (own_.lo.x - box.lo.x) / size.x, (own_.hi.x - box.lo.x) / size.x,
                         (own_.lo.y - box.lo.y) / size.y, (own_.hi.y - box.lo.y) / size.y);
    out.patch.domain = own_;
    const Vec2 below = own_.lo - box.lo, above = box.hi - own_.hi, own = own_.size();
    const bool beyond[4] = {grid_.index(u_.first, v_.first - 1) >= 0, grid_.index(u_.last + 1, v_.first) >= 0,
                            grid_.index(u_.first, v_.last + 1) >= 0,
                            grid_.index(u_.first - 1, v_.first) >= 0};
    const double margin[4] = {below.y / own.y, above.x / own.x, above.y / own.y, below.x / own.x};
    for (int k = 0; k < 4; ++k) out.margin[k] = beyond[k] || margin[k] > 0 ? margin[k] : 1e300;
    return out;
  }

 private:
  template <class Start>
  static int locate(double x, const Range& range, const Start& start) {
    int lo = range.first, hi = range.last;
    while (lo < hi) {
      const int middle = (lo + hi + 1) / 2;
      (start(middle) <= x ? lo : hi) = start(middle) <= x ? middle : middle - 1;
    }
    return lo;
  }

  Vec3 point(Vec2 uv) const {
    const int c = locate(uv.x, u_, [&](int i) { return grid_.column_start(i); }),
              r = locate(uv.y, v_, [&](int i) { return grid_.row_start(i); });
    const double u0 = grid_.column_start(c), v0 = grid_.row_start(r);
    return point_at(grid_.patch(static_cast<std::size_t>(grid_.index(c, r))),
                    (uv.x - u0) / (grid_.column_start(c + 1) - u0),
                    (uv.y - v0) / (grid_.row_start(r + 1) - v0));
  }

  /// Most blocks that are too large show it at a few points.
  bool passes_samples(const BezierPatch& wide, const Box2& box, double tolerance) const {
    const double at[4] = {0.21, 0.47, 0.55, 0.83};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const Vec2 uv{box.lo.x + box.size().x * at[i], box.lo.y + box.size().y * at[(j + i) % 4]};
        if (!(distance(point_at(wide, at[i], at[(j + i) % 4]), point(uv)) <= tolerance)) return false;
      }
    return true;
  }

  static void elevate(BezierPatch& patch, int degree_u, int degree_v) {
    while (patch.degree_u < degree_u) {
      const int p = patch.degree_u + 1, q = patch.degree_v;
      std::vector<Vec4> poles(static_cast<std::size_t>((p + 1) * (q + 1)));
      for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) {
          const double f = static_cast<double>(i) / p;
          const Vec4 a = patch.pole(std::max(i - 1, 0), j), b = patch.pole(std::min(i, p - 1), j);
          poles[static_cast<std::size_t>(i * (q + 1) + j)] = mix(a, b, f);
        }
      patch.degree_u = p, patch.poles = std::move(poles);
    }
    while (patch.degree_v < degree_v) {
      const int p = patch.degree_u, q = patch.degree_v + 1;
      std::vector<Vec4> poles(static_cast<std::size_t>((p + 1) * (q + 1)));
      for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) {
          const double f = static_cast<double>(j) / q;
          const Vec4 a = patch.pole(i, std::max(j - 1, 0)), b = patch.pole(i, std::min(j, q - 1));
          poles[static_cast<std::size_t>(i * (q + 1) + j)] = mix(a, b, f);
        }
      patch.degree_v = q, patch.poles = std::move(poles);
    }
  }
  static Vec4 mix(const Vec4& a, const Vec4& b, double f) {
    return {a.x * f + b.x * (1 - f), a.y * f + b.y * (1 - f), a.z * f + b.z * (1 - f),
            a.w * f + b.w * (1 - f)};
  }

  bool add_difference(int c, int r, const BezierPatch& wide, const Box2& box, double tolerance,
                      Remainder& out) const {
    const double u0 = grid_.column_start(c), u1 = grid_.column_start(c + 1), v0 = grid_.row_start(r),
                 v1 = grid_.row_start(r + 1);
    const Box2 piece{{std::max(u0, box.lo.x), std::max(v0, box.lo.y)},
                     {std::min(u1, box.hi.x), std::min(v1, box.hi.y)}};
    const Vec2 size = box.size(), own = own_.size();
    if (!(piece.size().x > 0 && piece.size().y > 0)) return true;
    BezierPatch a =
        subpatch(grid_.patch(static_cast<std::size_t>(grid_.index(c, r))), (piece.lo.x - u0) / (u1 - u0),
                 (piece.hi.x - u0) / (u1 - u0), (piece.lo.y - v0) / (v1 - v0), (piece.hi.y - v0) / (v1 - v0));
    BezierPatch b = subpatch(wide, (piece.lo.x - box.lo.x) / size.x, (piece.hi.x - box.lo.x) / size.x,
                             (piece.lo.y - box.lo.y) / size.y, (piece.hi.y - box.lo.y) / size.y);
    const int p = std::max(kDegree, a.degree_u), q = std::max(kDegree, a.degree_v);
    elevate(a, p, q), elevate(b, p, q);
    const auto d = [&](int i, int j) {
      const Vec4 &x = a.pole(i, j), &y = b.pole(i, j);
      return Vec3{x.x - y.x, x.y - y.y, x.z - y.z};
    };
    double value = 0, ds = 0, dt = 0;
    for (int i = 0; i <= p; ++i)
      for (int j = 0; j <= q; ++j) {
        value = std::max(value, length(d(i, j)));
        if (i < p) ds = std::max(ds, distance(d(i, j), d(i + 1, j)));
        if (j < q) dt = std::max(dt, distance(d(i, j), d(i, j + 1)));
      }
    out.value = std::max(out.value, value);
    out.ds = std::max(out.ds, ds * p * own.x / piece.size().x);
    out.dt = std::max(out.dt, dt * q * own.y / piece.size().y);
    return value <= tolerance;
  }

  const KnotStrips& grid_;
  Box2 own_;
  Range u_, v_;
};

}  // namespace

bool is_mergeable(const KnotStrips& grid) {
  const BezierPatch& first = grid.patch(0);
  if (grid.columns() * grid.rows() < 2) return false;
  for (int c = 0; c < grid.columns(); ++c)
    for (int r = 0; r < grid.rows(); ++r) {
      const int i = grid.index(c, r);
      if (i < 0) return false;
      const BezierPatch& p = grid.patch(static_cast<std::size_t>(i));
      if (p.rational || p.u_is_angle || p.v_is_angle || p.degree_u != first.degree_u ||
          p.degree_v != first.degree_v)
        return false;
    }
  return true;
}

std::optional<MergedPatch> merged_patch(const KnotStrips& grid, const SpanBlock& block, double tolerance) {
  const Block b(grid, block);
  return b.is_whole() ? b.fit(tolerance) : std::nullopt;
}

}  // namespace dupin
