// Inside the folder: derivative jets of any order up to kMaxOrder, laid out as triangles.
//
// An offset needs one order more of its base than is asked of it, so the families evaluate beyond the three
// orders of the public jets. Entry (i, j), the derivative ∂ⁱ⁺ʲ/∂uⁱ∂vʲ, stands at jet_index(i, j): by total
// order, then by j, which is also the order of SurfaceJet's members.
#ifndef DUPIN_NURBS_JETS_H
#define DUPIN_NURBS_JETS_H

#include "curve.h"
#include "surface.h"

namespace dupin {

inline constexpr int kMaxOrder = 5;
constexpr int jet_index(int i, int j) {
  return (i + j) * (i + j + 1) / 2 + j;
}
constexpr int jet_size(int order) {
  return (order + 1) * (order + 2) / 2;
}

/// Binomial coefficients up to kMaxOrder, and factorials.
inline constexpr double kBinomial[kMaxOrder + 1][kMaxOrder + 1] = {{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0},
                                                                   {1, 2, 1, 0, 0, 0}, {1, 3, 3, 1, 0, 0},
                                                                   {1, 4, 6, 4, 1, 0}, {1, 5, 10, 10, 5, 1}};
inline constexpr double kFactorial[kMaxOrder + 1] = {1, 1, 2, 6, 24, 120};

/// Derivatives 0 … order of cos and sin.
struct TrigJet {
  double c[kMaxOrder + 1], s[kMaxOrder + 1];
  TrigJet(double angle, int order) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const double cycle[4] = {cosine, -sine, -cosine, sine};
    for (int k = 0; k <= order; ++k) {
      c[k] = cycle[k & 3];
      s[k] = cycle[(k + 3) & 3];
    }
  }
};

/// t brought into [lo, hi]: wrapped if periodic, else clamped. A periodic spline's start is its end, seen
/// `from_left`.
inline double into_domain(double t, double lo, double hi, bool periodic, bool from_left = false) {
  if (periodic && from_left && t == lo) return hi;
  if (t >= lo && t <= hi) return t;
  if (!periodic) return t < lo ? lo : t > hi ? hi : t;
  const double wrapped = t - (hi - lo) * std::floor((t - lo) / (hi - lo));
  return wrapped >= lo && wrapped <= hi ? wrapped : lo;
}

// All write order + 1 entries (curves) or jet_size(order) entries (surfaces).
void evaluate_into(const Curve2& curve, double t, int order, Vec2* out, bool from_left = false);
void evaluate_into(const Curve3& curve, double t, int order, Vec3* out, bool from_left = false);
void evaluate_into(const Surface& surface, double u, double v, int order, Vec3* out, Sides sides = {});

void evaluate_into(const Plane& plane, double u, double v, int order, Vec3* out, Sides = {});
void evaluate_into(const Cylinder& cylinder, double u, double v, int order, Vec3* out, Sides = {});
void evaluate_into(const Cone& cone, double u, double v, int order, Vec3* out, Sides = {});
void evaluate_into(const Sphere& sphere, double u, double v, int order, Vec3* out, Sides = {});
void evaluate_into(const Torus& torus, double u, double v, int order, Vec3* out, Sides = {});
void evaluate_into(const BsplineSurface& surface, double u, double v, int order, Vec3* out, Sides sides);
void evaluate_into(const Revolution& surface, double u, double v, int order, Vec3* out, Sides sides);
void evaluate_into(const Extrusion& surface, double u, double v, int order, Vec3* out, Sides sides);
void evaluate_into(const OffsetSurface& surface, double u, double v, int order, Vec3* out, Sides sides);

}  // namespace dupin

#endif
