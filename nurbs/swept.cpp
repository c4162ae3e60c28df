// Surfaces of revolution and linear extrusion: derivatives from those of the profile.
#include "jets.h"

namespace dupin {

void evaluate_into(const Revolution& surface, double u, double v, int order, Vec3* out, Sides sides) {
  const Vec3& axis = surface.axis_direction;
  const TrigJet trig(u, order);
  Vec3 profile[kMaxOrder + 1];
  evaluate_into(surface.profile, v, order, profile, sides.v_from_left);
  profile[0] -= surface.axis_origin;
  for (int j = 0; j <= order; ++j) {
    const Vec3 along = axis * dot(axis, profile[j]), across = profile[j] - along,
               turned = cross(axis, across);
    for (int i = 0; i + j <= order; ++i) out[jet_index(i, j)] = across * trig.c[i] + turned * trig.s[i];
    out[jet_index(0, j)] += along;
  }
  out[0] += surface.axis_origin;
}

void evaluate_into(const Extrusion& surface, double u, double v, int order, Vec3* out, Sides sides) {
  Vec3 profile[kMaxOrder + 1];
  evaluate_into(surface.profile, u, order, profile, sides.u_from_left);
  for (int k = 0; k < jet_size(order); ++k) out[k] = Vec3{};
  for (int i = 0; i <= order; ++i) out[jet_index(i, 0)] = profile[i];
  out[0] += surface.direction * v;
  if (order >= 1) out[jet_index(0, 1)] = surface.direction;
}

}  // namespace dupin
