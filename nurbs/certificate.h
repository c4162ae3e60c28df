// Inside the folder: how far a Bézier patch is from a plane, sphere, cylinder, cone, torus or surface of
// revolution, certified.
#ifndef DUPIN_NURBS_CERTIFICATE_H
#define DUPIN_NURBS_CERTIFICATE_H

#include <functional>
#include <optional>

#include "bezier.h"

namespace dupin {

struct Deviation {
  double distance = 0;  ///< model units
  double angle = 0;     ///< radians, between the normals
};

/// Bounds over one cell of a patch; infinite where the cell is too large to have any.
struct CellBounds {
  double distance = 0;  ///< NaN: some point of the cell is known to be out of tolerance, splitting is in vain
  /// The largest component of the recognised surface's unit normal along Su and Sv: |n·Su|, |n·Sv|.
  double normal_u = 0, normal_v = 0;
  /// By how much the normal used there may itself be off, radians.
  double normal_slack = 0;
};

using BoundCell = std::function<CellBounds(const BezierPatch&)>;
/// Splits the patch until `bound` is within `limit` on every cell, into at most kCertificateCells; empty if
/// that is not reached. Cells with |Su × Sv| below 1e-3 of the patch's largest need only meet the distance.
std::optional<Deviation> certify(const BezierPatch& patch, const Deviation& limit, const BoundCell& bound);
inline constexpr int kCertificateCells = 128;

/// The bounds for an analytic shape: of the implicit polynomial along the cell, divided by its gradient.
CellBounds shape_bounds(const Surface& shape, const BezierPatch& cell);

/// The bounds for the surface that `profile` sweeps about the frame's z axis, where the cell's points are
/// compared with the profile's of the same v. The profile is a patch of degree 0 in u over the same v domain
/// as the cell.
CellBounds revolution_bounds(const Frame3& axis, const BezierPatch& profile, const BezierPatch& cell);

}  // namespace dupin

#endif
