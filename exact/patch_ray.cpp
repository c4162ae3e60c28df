#include "patch_ray.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "../nurbs/knots.h"

namespace dupin::exact {
namespace {

constexpr double kSlack = 1e-13;  // of the largest coefficient: rounding must lose no root
constexpr double kBorder = 1e-9;  // pieces reach so far beyond themselves, in their own parameters
constexpr double kContraction = 0.5;
constexpr int kMaxSteps = 80;

using Coefficients = std::vector<double>;

double& at(Coefficients& c, int rows, int i, int j) {
  return c[static_cast<std::size_t>(i * rows + j)];
}
double at(const Coefficients& c, int rows, int i, int j) {
  return c[static_cast<std::size_t>(i * rows + j)];
}

/// Both polynomials over one piece, and where the piece lies in the patch.
struct Piece {
  Coefficients a, b;
  double s0 = 0, t0 = 0, size_s = 1, size_t_ = 1;
  int halvings_s = 0, halvings_t = 0;
};

struct Range {
  double lo = INFINITY, hi = -INFINITY;
  void add(double x) { lo = std::min(lo, x), hi = std::max(hi, x); }
  bool holds_zero(double slack) const { return lo <= slack && hi >= -slack; }
  /// Largest distance from x.
  double off(double x) const { return std::max(std::abs(lo - x), std::abs(hi - x)); }
};

void bernstein_basis(int degree, double x, double* out) {
  out[0] = 1;
  for (int n = 1; n <= degree; ++n) {
    double carried = 0;
    for (int i = 0; i < n; ++i) {
      const double b = out[i];
      out[i] = carried + (1 - x) * b;
      carried = x * b;
    }
    out[n] = carried;
  }
}

class Solver {
 public:
  Solver(const PatchPoles& patch, const Line& line, std::vector<Vec2>& roots)
      : m_(patch.degree_u), n_(patch.degree_v), roots_(roots) {
    const LinePlanes planes(line.direction);
    Piece whole;
    for (std::size_t k = 0; k < patch.points.size(); ++k) {
      const Vec3 d = patch.points[k] - line.origin;
      whole.a.push_back(patch.weights[k] * dot(planes.a, d));
      whole.b.push_back(patch.weights[k] * dot(planes.b, d));
      slack_a_ = std::max(slack_a_, kSlack * std::abs(whole.a.back()));
      slack_b_ = std::max(slack_b_, kSlack * std::abs(whole.b.back()));
    }
    search(whole);
  }

 private:
  bool may_hold_root(const Piece& piece) const {
    Range a, b;
    for (std::size_t k = 0; k < piece.a.size(); ++k) a.add(piece.a[k]), b.add(piece.b[k]);
    return a.holds_zero(slack_a_) && b.holds_zero(slack_b_);
  }

  /// Mean derivatives over the piece, from its corners.
  Vec2 mean_slopes(const Coefficients& c) const {
    const int r = n_ + 1;
    const double c00 = at(c, r, 0, 0), c01 = at(c, r, 0, n_), c10 = at(c, r, m_, 0), c11 = at(c, r, m_, n_);
    return {0.5 * (c10 + c11 - c00 - c01), 0.5 * (c01 + c11 - c00 - c10)};
  }

  /// The piece with its polynomials turned into F ≈ (s − s₀, t − t₀); false if they are (nearly) dependent.
  bool precondition(const Piece& piece, Piece& f) const {
    const Vec2 a = mean_slopes(piece.a), b = mean_slopes(piece.b);
    const double det = cross(a, b);
    if (!(std::abs(det) > 1e-9 * (length(a) * length(b)))) return false;
    f.a.resize(piece.a.size());
    f.b.resize(piece.a.size());
    for (std::size_t k = 0; k < piece.a.size(); ++k) {
      f.a[k] = (piece.a[k] * b.y - piece.b[k] * a.y) / det;
      f.b[k] = (piece.b[k] * a.x - piece.a[k] * b.x) / det;
    }
    return true;
  }

  Range slope_s(const Coefficients& c) const {
    Range range;
    for (int i = 0; i < m_; ++i)
      for (int j = 0; j <= n_; ++j) range.add(m_ * (at(c, n_ + 1, i + 1, j) - at(c, n_ + 1, i, j)));
    return range;
  }
  Range slope_t(const Coefficients& c) const {
    Range range;
    for (int i = 0; i <= m_; ++i)
      for (int j = 0; j < n_; ++j) range.add(n_ * (at(c, n_ + 1, i, j + 1) - at(c, n_ + 1, i, j)));
    return range;
  }
  /// The largest row sum of |F′ − I|.
  double nonlinearity(const Piece& f) const {
    return std::max(slope_s(f.a).off(1) + slope_t(f.a).off(0), slope_s(f.b).off(0) + slope_t(f.b).off(1));
  }

  Vec2 value(const Piece& f, Vec2 x) const {
    std::array<double, kMaxDegree + 1> bs, bt;
    bernstein_basis(m_, x.x, bs.data());
    bernstein_basis(n_, x.y, bt.data());
    Vec2 sum;
    for (int i = 0; i <= m_; ++i) {
      Vec2 row;
      for (int j = 0; j <= n_; ++j) {
        const double w = bt[static_cast<std::size_t>(j)];
        row += Vec2{at(f.a, n_ + 1, i, j), at(f.b, n_ + 1, i, j)} * w;
      }
      sum += row * bs[static_cast<std::size_t>(i)];
    }
    return sum;
  }

  /// The only root of a piece on which the step is a contraction.
  void find_only_root(const Piece& piece, const Piece& f) {
    const auto clamp = [](double x) { return std::clamp(x, -kBorder, 1 + kBorder); };
    Vec2 x{0.5, 0.5};
    for (int step = 0; step < kMaxSteps; ++step) {
      const Vec2 off = value(f, x), next{clamp(x.x - off.x), clamp(x.y - off.y)};
      const double moved = std::max(std::abs(next.x - x.x), std::abs(next.y - x.y));
      x = next;
      if (moved < 0.1 * kPatchRootError) break;
    }
    const Vec2 off = value(f, x);
    if (std::max(std::abs(off.x), std::abs(off.y)) < kPatchRootError) add(piece, x);
  }
  void add(const Piece& piece, Vec2 x) {
    roots_.push_back({std::clamp(piece.s0 + x.x * piece.size_s, 0.0, 1.0),
                      std::clamp(piece.t0 + x.y * piece.size_t_, 0.0, 1.0)});
  }

  Piece half(const Piece& piece, bool along_s, bool upper) const {
    Piece h = piece;
    for (Coefficients* c : {&h.a, &h.b}) halve(*c, along_s, upper);
    double& size = along_s ? h.size_s : h.size_t_;
    size *= 0.5;
    if (upper) (along_s ? h.s0 : h.t0) += size;
    ++(along_s ? h.halvings_s : h.halvings_t);
    return h;
  }
  void halve(Coefficients& c, bool along_s, bool upper) const {
    const int degree = along_s ? m_ : n_, others = along_s ? n_ : m_, r = n_ + 1;
    const auto pole = [&](int i, int other) -> double& {
      return along_s ? at(c, r, i, other) : at(c, r, other, i);
    };
    for (int o = 0; o <= others; ++o)
      for (int level = 1; level <= degree; ++level)
        if (upper)
          for (int i = 0; i <= degree - level; ++i) pole(i, o) = 0.5 * (pole(i, o) + pole(i + 1, o));
        else
          for (int i = degree; i >= level; --i) pole(i, o) = 0.5 * (pole(i - 1, o) + pole(i, o));
  }

  /// Along which direction the polynomials vary more; what was halved enough is not halved further.
  bool halves_s(const Piece& piece) const {
    if (piece.halvings_t >= kMaxHalvings) return true;
    if (piece.halvings_s >= kMaxHalvings) return false;
    const auto width = [](const Range& r) { return std::max(std::abs(r.lo), std::abs(r.hi)); };
    return std::max(width(slope_s(piece.a)) / slack_a_, width(slope_s(piece.b)) / slack_b_) >=
           std::max(width(slope_t(piece.a)) / slack_a_, width(slope_t(piece.b)) / slack_b_);
  }

  void search(const Piece& piece) {
    if (++searched_ > kMostPieces || !may_hold_root(piece)) return;
    Piece f;
    if (precondition(piece, f)) {
      Range a, b;
      for (std::size_t k = 0; k < f.a.size(); ++k) a.add(f.a[k]), b.add(f.b[k]);
      if (!a.holds_zero(kBorder) || !b.holds_zero(kBorder)) return;
      if (nonlinearity(f) <= kContraction) return find_only_root(piece, f);
    }
    if (piece.halvings_s >= kMaxHalvings && piece.halvings_t >= kMaxHalvings) return add(piece, {0.5, 0.5});
    const bool along_s = halves_s(piece);
    search(half(piece, along_s, false));
    search(half(piece, along_s, true));
  }

  const int m_, n_;
  std::vector<Vec2>& roots_;
  double slack_a_ = 1e-300, slack_b_ = 1e-300;
  int searched_ = 0;
};

}  // namespace

LinePlanes::LinePlanes(const Vec3& direction) : a(any_perpendicular(normalized(direction))) {
  b = cross(normalized(direction), a);
}

PatchPoles patch_poles(const BezierPatch& patch) {
  PatchPoles poles{patch.degree_u, patch.degree_v, {}, {}};
  for (const Vec4& p : patch.poles) {
    poles.points.push_back(Vec3{p.x, p.y, p.z} / p.w);
    poles.weights.push_back(p.w);
  }
  return poles;
}

void meet(const PatchPoles& patch, const Line& line, std::vector<Vec2>& roots) {
  Solver(patch, line, roots);
}

}  // namespace dupin::exact
