// Faces on planes, cylinders, cones and spheres: one or a few DPs that are the surface itself.
#ifndef DUPIN_SAMPLING_QUADRIC_FACES_H
#define DUPIN_SAMPLING_QUADRIC_FACES_H

#include <functional>

#include "boundary.h"
#include "quadric_dp.h"

namespace dupin {

/// The DP of the quadric pᵀAp + 2·linear·p + constant = 0 at a point p of it, n towards the side to which it
/// bends (the gradient's side, or the other where `flip`). Bounds, footprint and region are left to the
/// caller.
struct ImplicitQuadric {
  Vec3 axx_ayy_azz, ayz_axz_axy;  ///< the symmetric matrix A
  Vec3 linear;
  double constant = 0;
};
ImplicitQuadric implicit_quadric(const Surface& surface);
double value(const ImplicitQuadric& q, const Vec3& p);
Vec3 gradient(const ImplicitQuadric& q, const Vec3& p);
QuadricDp quadric_dp_at(const ImplicitQuadric& q, const Vec3& p, const Vec3& n);

/// What a face on a quadric needs to become DPs.
struct QuadricFaceInput {
  const Part& part;
  const Face& face;
  std::uint32_t face_index;
  const Surface& surface;  ///< plane, cylinder, cone or sphere
  const FaceBoundary& boundary;
  Box2 uv_box;  ///< on `surface`, holding the face
  /// The face is exactly `uv_box`, bounded as this says (never for a plane).
  UvRectangle rectangle;
  /// Whether a point of the surface is inside the face.
  std::function<bool(const Vec3&)> inside;
  bool outward_is_normal = true;  ///< the face's outward normal is the surface's Su × Sv
};

/// Appends the face's DPs; the number of them.
int make_plane_face(const QuadricFaceInput& in, PartDps& out);
int make_curved_quadric_face(const QuadricFaceInput& in, PartDps& out);

}  // namespace dupin

#endif
