// Where a line meets a rational Bézier patch: every root, by subdivision with a proof of uniqueness.
//
// The line is the intersection of two planes; on each, the patch's signed distance times its weight is a
// polynomial in Bernstein form. A piece on which either has coefficients of one sign holds no root. Elsewhere
// the pair is preconditioned by the inverse of its Jacobian in the middle, F ≈ (s − s₀, t − t₀); where the
// Bernstein coefficients of its derivatives show ‖F′ − I‖ ≤ ½, x ↦ clamp(x − F(x)) is a contraction of the
// piece, whose only fixed point is the root if there is one. Pieces that are neither are halved.
#ifndef DUPIN_EXACT_PATCH_RAY_H
#define DUPIN_EXACT_PATCH_RAY_H

#include <vector>

#include "../core/vec.h"
#include "../nurbs/bezier.h"

namespace dupin::exact {

struct Line {
  Vec3 origin, direction;  ///< any length
};

/// Control points and weights, for one patch after the other.
struct PatchPoles {
  int degree_u = 0, degree_v = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;  ///< positive
};
PatchPoles patch_poles(const BezierPatch& patch);

/// Largest distance of a root found from the true one, in the patch's own parameters, where the line is not
/// tangent: they are made exact by Newton's method on the surface itself afterwards.
inline constexpr double kPatchRootError = 1e-7;
/// Pieces are halved at most so often in each direction: what is smaller is a line touching the patch, or a
/// point where its normal vanishes.
inline constexpr int kMaxHalvings = 40;
/// The search ends after so many pieces: a line that runs within the patch meets it everywhere, and sees it
/// edge-on, that is not at all.
inline constexpr int kMostPieces = 20000;

/// Appends the roots in [0,1]², each at least once; one on a border of the patch or of a piece may be found
/// twice. The line's origin should be near the patch.
void meet(const PatchPoles& patch, const Line& line, std::vector<Vec2>& roots);

/// Two unit vectors perpendicular to the direction and to each other.
struct LinePlanes {
  Vec3 a, b;
  explicit LinePlanes(const Vec3& direction);
};

}  // namespace dupin::exact

#endif
