#include "thin_spans.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dupin {
namespace {

/// A span is taken in by one that is at least this many times as wide.
constexpr double kMuchWider = 4;

double start(const BezierPatch& p, bool u) {
  return u ? p.domain.lo.x : p.domain.lo.y;
}

std::vector<double> starts(const std::vector<FittedPatch>& patches, bool u) {
  std::vector<double> all;
  for (const FittedPatch& p : patches) all.push_back(start(p.patch, u));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// A patch's poles, each line of them along the direction that is looked at.
Vec3 pole(const BezierPatch& p, bool u, int along, int line) {
  const Vec4& b = u ? p.pole(along, line) : p.pole(line, along);
  return Vec3{b.x, b.y, b.z} / b.w;
}

double width(const BezierPatch& p, bool u) {
  const int n = u ? p.degree_u : p.degree_v, lines = u ? p.degree_v : p.degree_u;
  double most = 0;
  for (int l = 0; l <= lines; ++l) most = std::max(most, distance(pole(p, u, 0, l), pole(p, u, n, l)));
  return most;
}

/// The polar form of a line of poles at k arguments b and the rest a (Ramshaw): the k-th pole over [a,b].
Vec3 blossom(std::vector<Vec3> line, int k, double a, double b) {
  for (int n = static_cast<int>(line.size()) - 1; n > 0; --n) {
    const double t = n <= k ? b : a;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
      line[i] = line[i] * (1 - t) + line[i + 1] * t;
  }
  return line[0];
}

/// The polynomial patch over [s0,s1] of the direction, which may lie beyond [0,1].
BezierPatch carried_on(const BezierPatch& p, bool u, double s0, double s1) {
  const int n = u ? p.degree_u : p.degree_v, lines = u ? p.degree_v : p.degree_u;
  BezierPatch out = p;
  std::vector<Vec3> line(static_cast<std::size_t>(n + 1));
  for (int l = 0; l <= lines; ++l) {
    for (int i = 0; i <= n; ++i) line[static_cast<std::size_t>(i)] = pole(p, u, i, l);
    for (int k = 0; k <= n; ++k) {
      const Vec3 b = blossom(line, k, s0, s1);
      (u ? out.pole(k, l) : out.pole(l, k)) = {b.x, b.y, b.z, 1};
    }
  }
  return out;
}

/// Of a difference of polynomial patches: of itself, and of its derivatives over and along the spans.
struct Difference {
  double value = 0, over = 0, along = 0;
};
Difference difference(const BezierPatch& a, const BezierPatch& b, bool u) {
  const int n = u ? a.degree_u : a.degree_v, lines = u ? a.degree_v : a.degree_u;
  const auto d = [&](int i, int l) { return pole(a, u, i, l) - pole(b, u, i, l); };
  Difference out;
  for (int l = 0; l <= lines; ++l)
    for (int i = 0; i <= n; ++i) {
      out.value = std::max(out.value, length(d(i, l)));
      if (i < n) out.over = std::max(out.over, n * distance(d(i, l), d(i + 1, l)));
      if (l < lines) out.along = std::max(out.along, lines * distance(d(i, l), d(i, l + 1)));
    }
  return out;
}

/// Least |∂S| along one direction, and a direction from which it does not turn far; 0 if it may.
struct Flow {
  Vec3 mean;
  double least = 0, turn = 0;  ///< turn: the largest sine of an angle to the mean
};
Flow flow(const BezierPatch& p, bool u) {
  const int n = u ? p.degree_u : p.degree_v, lines = u ? p.degree_v : p.degree_u;
  Flow f;
  for (int l = 0; l <= lines; ++l) f.mean += pole(p, u, n, l) - pole(p, u, 0, l);
  if (!(length(f.mean) > 0)) return f;
  f.mean = normalized(f.mean), f.least = 1e300;
  for (int l = 0; l <= lines; ++l)
    for (int i = 0; i < n; ++i) {
      const Vec3 d = (pole(p, u, i + 1, l) - pole(p, u, i, l)) * n;
      f.least = std::min(f.least, dot(d, f.mean));
      f.turn = std::max(f.turn, length(cross(d, f.mean)) / std::max(dot(d, f.mean), 1e-300));
    }
  f.least = std::max(f.least, 0.0);
  return f;
}

/// By how much normals of `thin` and of a patch that differs by `d` may differ: (|Ds| |St| + |Ss| |Dt|) / |Ss
/// × St|, twice, for normals of both.
double turned(const BezierPatch& thin, const Difference& d, bool u) {
  const Flow over = flow(thin, u), along = flow(thin, !u);
  const double sine = length(cross(over.mean, along.mean)) - over.turn - along.turn;
  if (!(sine > 0.1) || !(over.least > 0) || !(along.least > 0)) return 4;
  return 2 * (d.over / over.least + d.along / along.least) / sine;
}

class Grid {
 public:
  Grid(std::vector<FittedPatch>& patches, const ThinSpanTolerances& tolerances)
      : patches_(patches), tolerances_(tolerances) {}

  bool is_full() const {
    const std::size_t count = starts(patches_, true).size() * starts(patches_, false).size();
    if (count != patches_.size() || count < 2) return false;
    const BezierPatch& first = patches_[0].patch;
    return std::all_of(patches_.begin(), patches_.end(), [&](const FittedPatch& p) {
      return !p.patch.rational && p.patch.degree_u == first.degree_u && p.patch.degree_v == first.degree_v;
    });
  }

  /// One pass over the spans of one direction.
  void absorb(bool u) {
    collect(u);
    for (std::size_t i = 0; i < spans_.size() && spans_.size() > 1;) {
      const double own = width_of(spans_[i]);
      const double before = i > 0 ? width_of(spans_[i - 1]) : 0,
                   after = i + 1 < spans_.size() ? width_of(spans_[i + 1]) : 0;
      const bool back = before >= after;
      const bool done =
          kMuchWider * own <= std::max(before, after) && take_in(spans_[i], spans_[back ? i - 1 : i + 1], u);
      if (!done) {
        ++i;
        continue;
      }
      spans_.erase(spans_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    std::erase_if(patches_, [](const FittedPatch& p) { return p.patch.poles.empty(); });
  }

 private:
  using Span = std::vector<std::size_t>;  ///< patches in the order of the other direction

  void collect(bool u) {
    const std::vector<double> begin = starts(patches_, u);
    spans_.assign(begin.size(), {});
    for (std::size_t i = 0; i < patches_.size(); ++i)
      spans_[static_cast<std::size_t>(
                 std::lower_bound(begin.begin(), begin.end(), start(patches_[i].patch, u)) - begin.begin())]
          .push_back(i);
    for (Span& s : spans_)
      std::sort(s.begin(), s.end(), [&](std::size_t a, std::size_t b) {
        return start(patches_[a].patch, !u) < start(patches_[b].patch, !u);
      });
    widths_.assign(patches_.size(), 0);
    for (std::size_t i = 0; i < patches_.size(); ++i) widths_[i] = width(patches_[i].patch, u);
  }

  double width_of(const Span& span) const {
    double most = 0;
    for (std::size_t i : span) most = std::max(most, widths_[i]);
    return most;
  }

  bool take_in(const Span& thin, const Span& wide, bool u) {
    std::vector<FittedPatch> grown;
    for (std::size_t r = 0; r < thin.size(); ++r) {
      std::optional<FittedPatch> g = with(patches_[wide[r]], patches_[thin[r]], u);
      if (!g) return false;
      grown.push_back(std::move(*g));
    }
    for (std::size_t r = 0; r < thin.size(); ++r) {
      patches_[wide[r]] = std::move(grown[r]);
      patches_[thin[r]].patch.poles.clear();
    }
    return true;
  }

  std::optional<FittedPatch> with(const FittedPatch& wide, const FittedPatch& thin, bool u) const {
    const Box2 &w = wide.patch.domain, &t = thin.patch.domain;
    const double lo = u ? w.lo.x : w.lo.y, size = u ? w.size().x : w.size().y;
    const double s0 = ((u ? t.lo.x : t.lo.y) - lo) / size, s1 = ((u ? t.hi.x : t.hi.y) - lo) / size;
    const Difference d = difference(carried_on(wide.patch, u, s0, s1), thin.patch, u);
    const double position = thin.position_error + d.value;
    if (!(position <= tolerances_.position)) return std::nullopt;
    const double normal = thin.normal_error + turned(thin.patch, d, u);
    if (!(normal <= tolerances_.normal)) return std::nullopt;
    FittedPatch out{carried_on(wide.patch, u, std::min(0.0, s0), std::max(1.0, s1)),
                    std::max(wide.position_error, position), std::max(wide.normal_error, normal)};
    out.patch.domain = {{std::min(w.lo.x, t.lo.x), std::min(w.lo.y, t.lo.y)},
                        {std::max(w.hi.x, t.hi.x), std::max(w.hi.y, t.hi.y)}};
    return out;
  }

  std::vector<FittedPatch>& patches_;
  const ThinSpanTolerances& tolerances_;
  std::vector<Span> spans_;
  std::vector<double> widths_;
};

}  // namespace

void absorb_thin_spans(std::vector<FittedPatch>& patches, const ThinSpanTolerances& tolerances) {
  Grid grid(patches, tolerances);
  if (!grid.is_full()) return;
  grid.absorb(true);
  grid.absorb(false);
}

}  // namespace dupin
