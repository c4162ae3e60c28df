#include "rectangles.h"

#include "prune.h"

namespace dupin {
namespace {

/// More pieces than this, and the rectangle is taken for not enclosed.
constexpr std::size_t kMostPieces = 128;
/// What is at least left of a half-extent for the tests.
constexpr double kLeastTested = 0.25;

/// arcsin(x)/x; a series where it is as good.
double arcsine_ratio(double x) {
  const double s = x * x;
  if (s < 0.01) return 1 + s * (1.0 / 6 + s * (3.0 / 40 + s * (15.0 / 336 + s * (105.0 / 3456))));
  const double a = std::abs(x);
  return (a < 1 ? std::asin(a) : std::asin(1.0)) / a;
}

/// |⟨N_q, N_p(u, v)⟩| at the projection of q's position into p's plane.
double predicts(const Rectangle& p, const Vec3& to_q, const Vec3& normal) {
  const double x = dot(to_q, p.u), y = dot(to_q, p.v), r2 = x * x + y * y;
  const double sine = r2 > 0 ? (p.lambda_u * x * x + p.lambda_v * y * y) / std::sqrt(r2) : 0;
  const double stretch = arcsine_ratio(sine), nx = -p.lambda_u * x * stretch, ny = -p.lambda_v * y * stretch;
  const double along = nx * dot(normal, p.u) + ny * dot(normal, p.v) + dot(normal, p.n);
  return std::abs(along) / std::sqrt(nx * nx + ny * ny + 1);
}

/// Along an axis, the parallelogram's extent around its centre.
double extent(const Shadow& s, Vec2 axis) {
  return std::abs(dot(s.a, axis)) + std::abs(dot(s.b, axis));
}

/// The separating axis theorem for a parallelogram and an upright rectangle.
bool meets(const Shadow& s, double half_u, double half_v) {
  if (std::abs(s.center.x) > half_u + extent(s, {1, 0}) || std::abs(s.center.y) > half_v + extent(s, {0, 1}))
    return false;
  for (const Vec2 side : {s.a, s.b}) {
    const Vec2 axis{-side.y, side.x};
    const double reach = extent(s, axis) + std::abs(axis.x) * half_u + std::abs(axis.y) * half_v;
    if (std::abs(dot(s.center, axis)) > reach) return false;
  }
  return true;
}

bool holds(const Shadow& s, Vec2 p) {
  const Vec2 d = p - s.center;
  const double area = std::abs(cross(s.a, s.b)) * (1 + kSliver);
  return std::abs(cross(d, s.b)) <= area && std::abs(cross(s.a, d)) <= area && area > 0;
}

double area_of(const Piece& p) {
  double sum = 0;
  for (std::size_t i = 2; i < p.count; ++i)
    sum += (p.x[i - 1] - p.x[0]) * (p.y[i] - p.y[0]) - (p.y[i - 1] - p.y[0]) * (p.x[i] - p.x[0]);
  return 0.5 * std::abs(sum);
}

/// How far each corner is beyond the line n·x = d, and on which of its sides there are any: 1 below or on it,
/// 2 above.
unsigned sides_of(const Piece& piece, Vec2 n, double d, double* sides) {
  unsigned found = 0;
  for (std::size_t i = 0; i < piece.count; ++i) {
    sides[i] = n.x * piece.x[i] + n.y * piece.y[i] - d;
    found |= sides[i] > 0 ? 2U : 1U;
  }
  return found;
}

/// Splits a convex polygon at a line that passes through it.
void split(const Piece& piece, const double* sides, Piece& above, Piece& below) {
  above.count = below.count = 0;
  std::size_t last = piece.count - 1;
  for (std::size_t i = 0; i < piece.count; last = i++) {
    if ((sides[i] > 0) != (sides[last] > 0)) {
      const double t = sides[last] / (sides[last] - sides[i]);
      const double x = piece.x[last] + (piece.x[i] - piece.x[last]) * t,
                   y = piece.y[last] + (piece.y[i] - piece.y[last]) * t;
      above.add(x, y);
      below.add(x, y);
    }
    (sides[i] > 0 ? above : below).add(piece.x[i], piece.y[i]);
  }
}

/// The part of the segment from a to b that a shadow hides, as parameters.
bool hidden_part(const Shadow& s, Vec2 a, Vec2 b, double& t0, double& t1) {
  const double area = cross(s.a, s.b), size = std::abs(area);
  if (!(size > 0)) return false;
  t0 = 0;
  t1 = 1;
  const Vec2 from = a - s.center, way = b - a;
  for (int k = 0; k < 2; ++k) {
    const double at = k == 0 ? cross(from, s.b) : cross(s.a, from),
                 step = k == 0 ? cross(way, s.b) : cross(s.a, way);
    if (step == 0) {
      if (std::abs(at) > size) return false;
      continue;
    }
    const double enter = (-size - at) / step, leave = (size - at) / step;
    t0 = std::max(t0, std::min(enter, leave));
    t1 = std::min(t1, std::max(enter, leave));
  }
  return t0 < t1;
}

bool segment_enclosed(Vec2 a, Vec2 b, std::span<const Shadow> shadows) {
  // Left to right: what is covered so far grows as long as some shadow goes on from there.
  double reached = 0;
  for (bool grown = true; grown && reached < 1;) {
    grown = false;
    for (const Shadow& s : shadows) {
      double t0, t1;
      if (!hidden_part(s, a, b, t0, t1) || t0 > reached + 1e-12 || t1 <= reached + 1e-12) continue;
      reached = t1;
      grown = true;
    }
  }
  return reached >= 1 - 1e-9;
}

}  // namespace

Rectangle rectangle_of(const DifferentialPoint& p, const PruneOptions& options) {
  const auto tested = [&](double lambda, double half) {
    const double smaller = half * (1 - options.scale_down) - options.slant * sagitta(lambda, half);
    return std::max(smaller, kLeastTested * half);
  };
  const double half_u = tested(p.lambda_u, p.half_u), half_v = tested(p.lambda_v, p.half_v);
  return {p.position, p.u,        p.v,
          p.n(),      p.lambda_u, p.lambda_v,
          half_u,     half_v,     std::sqrt(half_u * half_u + half_v * half_v)};
}

double similarity(const Rectangle& p, const Rectangle& q) {
  const Vec3 d = q.position - p.position;
  return 0.5 * (predicts(p, d, q.n) + predicts(q, -d, p.n));
}

Shadow project(const Rectangle& q, const Rectangle& onto) {
  const Vec3 d = q.position - onto.position;
  const auto flat = [&](const Vec3& w) { return Vec2{dot(w, onto.u), dot(w, onto.v)}; };
  return {flat(d), flat(q.u) * q.half_u, flat(q.v) * q.half_v};
}

bool overlaps(const Rectangle& p, const Rectangle& q) {
  const Vec3 d = q.position - p.position;
  const double reach = p.radius + q.radius;
  if (dot(d, d) > reach * reach) return false;
  return meets(project(q, p), p.half_u, p.half_v) || meets(project(p, q), q.half_u, q.half_v);
}

bool ExactEnclosure::subtract(Piece& inside, const Shadow& shadow, double least_area) {
  Vec2 normals[4];
  double offsets[4], sides[Piece::kMost];
  for (int k = 0; k < 4; ++k) {
    const Vec2 along = k < 2 ? shadow.a : shadow.b,
               away = (k < 2 ? shadow.b : shadow.a) * (k % 2 == 0 ? 1 : -1);
    // The side at center + away, parallel to `along`; its outer normal points with `away`.
    const Vec2 n{-along.y, along.x};
    normals[k] = dot(n, away) < 0 ? -n : n;
    offsets[k] = dot(normals[k], shadow.center + away);
    if (sides_of(inside, normals[k], offsets[k], sides) != 2) continue;
    next_.push_back(inside);  // it is beyond a side: whole
    return true;
  }
  for (int k = 0; k < 4; ++k) {
    if (sides_of(inside, normals[k], offsets[k], sides) == 1) continue;
    if (inside.count + 2 > Piece::kMost) return false;
    Piece& outside = next_.emplace_back();
    split(inside, sides, outside, rest_);
    if (area_of(outside) <= least_area) next_.pop_back();
    inside = rest_;
    if (inside.count == 0) return true;
  }
  return true;
}

bool ExactEnclosure::operator()(Vec2 half, std::span<const Shadow> shadows) {
  const Vec2 corners[] = {{-half.x, -half.y}, {half.x, -half.y}, half, {-half.x, half.y}};
  unsigned all = 0;
  for (const Shadow& s : shadows) {
    unsigned held = 0;
    for (unsigned k = 0; k < 4; ++k) held |= static_cast<unsigned>(holds(s, corners[k])) << k;
    if (held == 15) return true;  // both are convex
    all |= held;
  }
  if (all != 15) return false;
  // The nearest are likely to hide the most.
  order_.resize(shadows.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const double x = dot(shadows[a].center, shadows[a].center), y = dot(shadows[b].center, shadows[b].center);
    return x != y ? x < y : a < b;
  });
  const double least = kSliver * 4 * half.x * half.y;
  pieces_.resize(1);
  pieces_[0].count = 0;
  for (const Vec2 corner : corners) pieces_[0].add(corner.x, corner.y);
  for (const std::size_t i : order_) {
    const Shadow& shadow = shadows[i];
    if (cross(shadow.a, shadow.b) == 0) continue;
    next_.clear();
    for (Piece& piece : pieces_)
      if (!subtract(piece, shadow, least)) return false;
    std::swap(pieces_, next_);
    if (pieces_.empty()) return true;
    if (pieces_.size() > kMostPieces) return false;
  }
  return false;
}

bool segments_enclosed(Vec2 h, std::span<const Shadow> shadows) {
  // Corners A C E G and middles of sides B D F H, in turn: AE CG BF HD BH HF FD DB.
  const Vec2 a{-h.x, h.y}, b{0, h.y}, c = h, d{h.x, 0}, e{h.x, -h.y}, f{0, -h.y}, g{-h.x, -h.y}, i{-h.x, 0};
  const std::pair<Vec2, Vec2> segments[] = {{a, e}, {c, g}, {b, f}, {i, d}, {b, i}, {i, f}, {f, d}, {d, b}};
  for (const auto& [from, to] : segments)
    if (!segment_enclosed(from, to, shadows)) return false;
  return true;
}

}  // namespace dupin
