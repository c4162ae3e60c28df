// Bézier patches and curves in homogeneous form, cut out of any surface that is rational: all kinds
// but offset.
#ifndef DUPIN_NURBS_BEZIER_H
#define DUPIN_NURBS_BEZIER_H

#include <optional>
#include <vector>

#include "../core/vec.h"
#include "curve.h"
#include "surface.h"

namespace dupin {

/// A homogeneous control point: (w·x, w·y, w·z, w).
struct Vec4 {
  double x = 0, y = 0, z = 0, w = 0;
};

/// A tensor-product rational Bézier patch over the surface's parameter rectangle `domain`.
/// The patch's own parameters (s,t) run over [0,1]². For analytic kinds and revolutions u ↦ s is not affine:
/// angles become rational parameters (s = ½ + tan(u−mid)/2 / (2·tan(half/2)) of the arc), so that only the
/// corners and the middle of u and s agree exactly; `u_is_angle` / `v_is_angle` say so.
struct BezierPatch {
  int degree_u = 0, degree_v = 0;
  Box2 domain;
  bool rational = false;  ///< false: every w is 1
  bool u_is_angle = false, v_is_angle = false;
  std::vector<Vec4> poles;  ///< poles[i * (degree_v + 1) + j]
  const Vec4& pole(int i, int j) const { return poles[static_cast<std::size_t>(i * (degree_v + 1) + j)]; }
  Vec4& pole(int i, int j) { return poles[static_cast<std::size_t>(i * (degree_v + 1) + j)]; }
};

/// Largest distance of a patch from its surface at the same parameters, times the largest coordinate of a
/// pole.
inline constexpr double kBezierError = 2e-15;

/// The patches that make up the surface over `region`, which must be finite and inside the domain (or within
/// one period of it): one per knot span, arcs of at most 90 degrees. Empty for an offset surface, which is
/// not rational, and for profiles that are offset curves or hyperbolas.
std::vector<BezierPatch> bezier_patches(const Surface& surface, const Box2& region);

/// The patch over the sub-rectangle [s0,s1]×[t0,t1] of its own parameters, by blossoming (de Casteljau).
/// Where a direction is an angle the piece is put back into the standard form of an arc, so that the maps
/// below hold for it too; its parameter is then not an affine function of the whole patch's.
BezierPatch subpatch(const BezierPatch& patch, double s0, double s1, double t0, double t1);

/// From the patch's own parameter in [0,1] to the surface's u (v), and back.
double patch_to_surface_u(const BezierPatch& patch, double s);
double patch_to_surface_v(const BezierPatch& patch, double t);
double surface_to_patch_u(const BezierPatch& patch, double u);
double surface_to_patch_v(const BezierPatch& patch, double v);

/// A point of the patch at its own parameters, by de Casteljau.
Vec3 point_at(const BezierPatch& patch, double s, double t);

/// A rational Bézier curve over [t0, t1] of the curve it was cut from.
struct BezierCurve3 {
  int degree = 0;
  double t0 = 0, t1 = 1;
  bool is_angle = false;  ///< a circle's or ellipse's: related to its own parameter as a patch's to u
  std::vector<Vec4> poles;
};
/// The pieces of a curve over [t0, t1]; empty for offset curves and hyperbolas.
std::vector<BezierCurve3> bezier_curves(const Curve3& curve, double t0, double t1);

}  // namespace dupin

#endif
