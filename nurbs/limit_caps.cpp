#include "limit_caps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "../core/parallel.h"
#include "bezier.h"
#include "bounds.h"
#include "homogeneous.h"
#include "tensor.h"

namespace dupin {
namespace {

/// A square of a node's local parameters; for a triangle turned by half a turn the corner (0,0) is the upper
/// right one.
struct Square {
  Vec2 origin;
  double size = 1;
  bool flipped = false;
};

/// The i-th child's square, as ForestBuilder lays children out.
Square child_square(int corners, const Square& s, int child) {
  const double half = (s.flipped ? -0.5 : 0.5) * s.size;
  const bool triangle = corners == 3;
  const Vec2 step{child == 1 || (child == 2 && !triangle) || (child == 3 && triangle) ? half : 0,
                  child >= 2 ? half : 0};
  return {s.origin + step, 0.5 * s.size, s.flipped != (triangle && child == 3)};
}

BezierPatch piece_of(const BezierPatch& patch, const Square& s) {
  const Vec2 lo = s.flipped ? s.origin - Vec2{s.size, s.size} : s.origin;
  BezierPatch piece = subpatch(patch, lo.x, lo.x + s.size, lo.y, lo.y + s.size);
  if (s.flipped) std::reverse(piece.poles.begin(), piece.poles.end());
  return piece;
}

Vec3 xyz(const Vec4& p) {
  return {p.x, p.y, p.z};
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, distance(a[i], b[i]));
  return most;
}
double largest_length(const std::vector<Vec3>& a) {
  double most = 0;
  for (const Vec3& p : a) most = std::max(most, length(p));
  return most;
}

std::vector<Vec3> differences(const std::vector<Vec4>& poles, int degree, bool along_u) {
  std::vector<Vec3> out;
  const std::size_t n = static_cast<std::size_t>(degree) + 1;
  for (std::size_t i = 0; i + (along_u ? 1 : 0) < n; ++i)
    for (std::size_t j = 0; j + (along_u ? 0 : 1) < n; ++j)
      out.push_back(
          (xyz(poles[(i + (along_u ? 1 : 0)) * n + j + (along_u ? 0 : 1)]) - xyz(poles[i * n + j])) *
          static_cast<double>(degree));
  return out;
}

/// A number that |Su × Sv| is nowhere below, or 0, from the cone of its directions.
double least_normal(const BezierPatch& patch, const NormalCone& cone) {
  if (!cone.bounded()) return 0;
  Frame3 frame;
  frame.origin = xyz(patch.poles.front());
  const auto n = normal_tensors(homogeneous_tensors(patch, frame), false);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n[0].p; ++i)
    for (int j = 0; j <= n[0].q; ++j) {
      const Vec3 scaled{n[0].at(i, j), n[1].at(i, j), n[2].at(i, j)};
      least = std::min(least, dot(scaled, cone.axis) / (binomials(n[0].p)[static_cast<std::size_t>(i)] *
                                                        binomials(n[0].q)[static_cast<std::size_t>(j)]));
    }
  return std::max(least, 0.0);
}

/// The angle between the normals N = Su × Sv of two patches at the same parameters, by the better of two
/// bounds. Where their derivatives agree, |N − M| is at most |Su − Tu| |Sv| + |Tu| |Sv − Tv|, and its
/// quotient with |N| is the angle's sine at least. Close to an extraordinary vertex they do not, but both
/// patches are almost flat: the angle of their cones.
double normal_difference(const BezierPatch& s, const BezierPatch& t) {
  const auto su = differences(s.poles, s.degree_u, true), sv = differences(s.poles, s.degree_v, false),
             tu = differences(t.poles, t.degree_u, true), tv = differences(t.poles, t.degree_v, false);
  const double off =
      largest_difference(su, tu) * largest_length(sv) + largest_length(tu) * largest_difference(sv, tv);
  const NormalCone cs = normal_cone(s), ct = normal_cone(t);
  const double least = least_normal(s, cs);
  double angle = off < least ? std::asin(off / least) : std::numbers::pi;
  if (cs.bounded() && ct.bounded())
    angle = std::min(
        angle, cs.angle + ct.angle + std::atan2(length(cross(cs.axis, ct.axis)), dot(cs.axis, ct.axis)));
  return angle;
}

/// By vertex, the box of all faces around it. The limit over a face lies in the hull of the faces around its
/// corners.
std::vector<Box3> boxes_around(const CageLevel& level) {
  std::vector<Box3> boxes(level.points.size());
  for (std::uint32_t f = 0; f < level.face_count(); ++f) {
    Box3 face;
    for (std::uint32_t v : level.vertices(f)) face.add(level.points[v]);
    for (std::uint32_t v : level.vertices(f)) boxes[v].add(face.lo), boxes[v].add(face.hi);
  }
  return boxes;
}

class CapCheck {
 public:
  CapCheck(const LimitForest& forest, const CapHulls& hulls, LimitCap& cap)
      : forest_(forest), hulls_(hulls), cap_(cap), patch_(to_bezier(cap.patch)) {}

  void visit(const LimitNode& node, const Square& square) {
    if (node.regular()) return compare(node, square);
    if (node.leaf()) return enclose(node, square);
    for (std::uint32_t i = 0; i < node.children; ++i)
      visit(forest_.nodes[node.first_child + i],
            child_square(forest_.corners(), square, static_cast<int>(i)));
  }

 private:
  void compare(const LimitNode& node, const Square& square) {
    const BezierPatch exact = to_bezier(forest_.patches[node.patch]), piece = piece_of(patch_, square);
    if (forest_.corners() == 4) return compare(exact, piece);
    // Only what is near the triangle: beyond, polynomials may go anywhere.
    for (const Box2& near : squares_of_triangle())
      compare(subpatch(exact, near.lo.x, near.hi.x, near.lo.y, near.hi.y),
              subpatch(piece, near.lo.x, near.hi.x, near.lo.y, near.hi.y));
  }
  void compare(const BezierPatch& exact, const BezierPatch& piece) {
    double off = 0;
    for (std::size_t i = 0; i < exact.poles.size(); ++i)
      off = std::max(off, distance(xyz(exact.poles[i]), xyz(piece.poles[i])));
    cap_.deviation = std::max(cap_.deviation, off);
    cap_.normal_deviation = std::max(cap_.normal_deviation, normal_difference(exact, piece));
  }
  void enclose(const LimitNode& node, const Square& square) {
    Box3 box;
    for (std::uint32_t v : forest_.cage.levels[node.level].vertices(node.face)) {
      const Box3 around = hulls_.around(node.level, v);
      box.add(around.lo), box.add(around.hi);
    }
    for (const Vec4& pole : piece_of(patch_, square).poles) box.add(xyz(pole));
    cap_.deviation = std::max(cap_.deviation, box.diagonal());
  }

  const LimitForest& forest_;
  const CapHulls& hulls_;
  LimitCap& cap_;
  BezierPatch patch_;
};

/// Irregular nodes of a level, and whether all of them can be interpolated.
std::vector<std::uint32_t> irregular_nodes(const LimitForest& forest, int level) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < forest.nodes.size(); ++i)
    if (forest.nodes[i].level == level && !forest.nodes[i].regular()) nodes.push_back(i);
  return nodes;
}

bool good_enough(const LimitCap& cap, double diagonal, const LimitPartOptions& options) {
  if (cap.deviation > options.position_tolerance * diagonal) return false;
  return cap.normal_deviation <= options.normal_tolerance || cap.size <= options.least_size * diagonal;
}

}  // namespace

std::vector<Box2> squares_of_triangle() {
  constexpr int kSquares = 4;
  std::vector<Box2> squares;
  for (int i = 0; i < kSquares; ++i)
    for (int j = 0; i + j < kSquares; ++j) {
      const Vec2 lo = Vec2{static_cast<double>(i), static_cast<double>(j)} / kSquares;
      squares.push_back({lo, lo + Vec2{1, 1} / kSquares});
    }
  return squares;
}

BezierPatch to_bezier(const LimitPatch& patch) {
  BezierPatch out;
  out.degree_u = out.degree_v = patch.degree;
  out.domain = {{0, 0}, {1, 1}};
  for (const Vec3& p : patch.poles) out.poles.push_back({p.x, p.y, p.z, 1});
  return out;
}

CapHulls::CapHulls(const LimitForest& forest) : levels_(forest.cage.levels.size()) {
  for (const LimitNode& node : forest.nodes)
    if (node.leaf() && !node.regular() && levels_[node.level].empty())
      levels_[node.level] = boxes_around(forest.cage.levels[node.level]);
}

LimitCap make_cap(const LimitForest& forest, const CapHulls& hulls, std::uint32_t node) {
  LimitCap cap;
  cap.node = node;
  cap.patch = interpolant(forest, forest.nodes[node]);
  Box3 box;
  for (const Vec3& pole : cap.patch.poles) box.add(pole);
  cap.size = box.diagonal();
  CapCheck(forest, hulls, cap).visit(forest.nodes[node], {});
  return cap;
}

LimitCover make_cover(const LimitForest& forest, double diagonal, const LimitPartOptions& options,
                      int deepest) {
  LimitCover cover;
  const CapHulls hulls(forest);
  const int last = static_cast<int>(forest.cage.levels.size()) - 1;
  int depth = 1;
  for (;; ++depth) {
    const auto nodes = irregular_nodes(forest, depth);
    // Only what has two more levels can be interpolated: the last chance, where something is irregular for
    // ever.
    const bool final = depth >= deepest || (depth >= last - 2 && !hulls.empty());
    std::atomic<bool> good{true};
    cover.caps.assign(nodes.size(), {});
    parallel_for(
        nodes.size(),
        [&](std::size_t i) {
          if (!good && !final) return;
          cover.caps[i] = make_cap(forest, hulls, nodes[i]);
          if (!good_enough(cover.caps[i], diagonal, options)) good = false;
        },
        16);
    if (good || final) break;
  }
  for (std::uint32_t i = 0; i < forest.nodes.size(); ++i)
    if (forest.nodes[i].regular() && forest.nodes[i].level <= depth) cover.regular.push_back(i);
  return cover;
}

}  // namespace dupin
