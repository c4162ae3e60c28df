// Plane, cylinder, cone, sphere and torus: every derivative in closed form.
#include "jets.h"

namespace dupin {
namespace {

void clear(int order, Vec3* out) {
  for (int k = 0; k < jet_size(order); ++k) out[k] = Vec3{};
}

/// The i-th derivative of cos u·X + sin u·Y.
Vec3 radial(const Frame3& f, const TrigJet& u, int i) {
  return f.x * u.c[i] + f.y * u.s[i];
}

}  // namespace

void evaluate_into(const Plane& plane, double u, double v, int order, Vec3* out, Sides) {
  clear(order, out);
  out[0] = plane.frame.origin + plane.frame.x * u + plane.frame.y * v;
  if (order >= 1) out[jet_index(1, 0)] = plane.frame.x, out[jet_index(0, 1)] = plane.frame.y;
}

void evaluate_into(const Cylinder& cylinder, double u, double v, int order, Vec3* out, Sides) {
  clear(order, out);
  const Frame3& f = cylinder.frame;
  const TrigJet trig(u, order);
  for (int i = 0; i <= order; ++i) out[jet_index(i, 0)] = radial(f, trig, i) * cylinder.radius;
  out[0] = f.origin + (out[0] + f.z * v);
  if (order >= 1) out[jet_index(0, 1)] = f.z;
}

void evaluate_into(const Cone& cone, double u, double v, int order, Vec3* out, Sides) {
  clear(order, out);
  const Frame3& f = cone.frame;
  const TrigJet trig(u, order);
  const double sine = std::sin(cone.half_angle), cosine = std::cos(cone.half_angle);
  const double radius = cone.radius + v * sine;
  for (int i = 0; i <= order; ++i) {
    const Vec3 e = radial(f, trig, i);
    out[jet_index(i, 0)] = e * radius;
    if (i < order) out[jet_index(i, 1)] = e * sine;
  }
  out[0] = f.origin + (out[0] + f.z * (v * cosine));
  if (order >= 1) out[jet_index(0, 1)] += f.z * cosine;
}

namespace {

/// Sphere and torus: O + (R + r cos v) e(u) + r sin v Z.
void revolved_circle(const Frame3& f, double major, double minor, double u, double v, int order, Vec3* out) {
  const TrigJet tu(u, order), tv(v, order);
  for (int i = 0; i <= order; ++i) {
    const Vec3 e = radial(f, tu, i);
    for (int j = 0; i + j <= order; ++j) out[jet_index(i, j)] = e * ((j == 0 ? major : 0) + minor * tv.c[j]);
  }
  for (int j = 0; j <= order; ++j) out[jet_index(0, j)] += f.z * (minor * tv.s[j]);
  out[0] = f.origin + out[0];
}

}  // namespace

void evaluate_into(const Sphere& sphere, double u, double v, int order, Vec3* out, Sides) {
  revolved_circle(sphere.frame, 0, sphere.radius, u, v, order, out);
}

void evaluate_into(const Torus& torus, double u, double v, int order, Vec3* out, Sides) {
  revolved_circle(torus.frame, torus.major, torus.minor, u, v, order, out);
}

}  // namespace dupin
