// Inside the folder: differential points as pruning sees them, and what their rectangles say of each other.
#ifndef DUPIN_SIMPLIFY_RECTANGLES_H
#define DUPIN_SIMPLIFY_RECTANGLES_H

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "../sampling/differential_point.h"

namespace dupin {

struct PruneOptions;

struct Rectangle {
  Vec3 position, u, v, n;
  double lambda_u, lambda_v;
  double half_u, half_v;  ///< as tested: already made smaller
  double radius;
};
Rectangle rectangle_of(const DifferentialPoint& point, const PruneOptions& options);

/// Half of a pair's term in eq. 6: how near the normal fields, normalised, come to each other's normals.
double similarity(const Rectangle& p, const Rectangle& q);

/// A rectangle projected along the normal of another into that one's plane: center ± a ± b.
struct Shadow {
  Vec2 center, a, b;
};
Shadow project(const Rectangle& q, const Rectangle& onto);

/// Whether either of them, projected into the other's plane, meets it there.
bool overlaps(const Rectangle& p, const Rectangle& q);

/// A convex polygon of few corners; copies those alone.
struct Piece {
  static constexpr std::size_t kMost = 24;
  double x[kMost], y[kMost];  // NOLINT: not initialised on purpose, pieces are made by the million
  std::size_t count;
  Piece() : count(0) {}                                    // NOLINT
  Piece(const Piece& other) : count(0) { *this = other; }  // NOLINT
  Piece& operator=(const Piece& other) {
    count = other.count;
    std::copy_n(other.x, count, x);
    std::copy_n(other.y, count, y);
    return *this;
  }
  void add(double px, double py) {
    x[count] = px;
    y[count++] = py;
  }
};

/// Whether the union of shadows holds the rectangle |x| <= half.x, |y| <= half.y, but for kSliver. Keeps its
/// memory.
class ExactEnclosure {
 public:
  bool operator()(Vec2 half, std::span<const Shadow> shadows);

 private:
  /// What of the piece is outside of the shadow goes to next_; false if that takes too many corners.
  bool subtract(Piece& piece, const Shadow& shadow, double least_area);
  Piece rest_;
  std::vector<Piece> pieces_, next_;
  std::vector<std::size_t> order_;
};

/// Whether the union of shadows holds the papers' test segments of the rectangle.
bool segments_enclosed(Vec2 half, std::span<const Shadow> shadows);

}  // namespace dupin

#endif
