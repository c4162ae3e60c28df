#ifdef CURVES
// The second fundamental form in an orthonormal frame of the tangent plane, in view space: −∇²F over |∇F|, with ∇²F taken to where
// the placement and the camera put it. Its eigenvalues, the one that is larger in size first, and that one's direction.
void principal_curvatures(vec3 n, float gradient, mat3 to_local, vec4 bend, float c, out vec2 k, out vec3 direction) {
  vec3 e1 = normalize(abs(n.x) < 0.6 ? cross(n, vec3(1.0, 0.0, 0.0)) : cross(n, vec3(0.0, 1.0, 0.0))), e2 = cross(n, e1);
  mat3 form = mat3(bend.x, 0.0, bend.z, 0.0, bend.y, bend.w, bend.z, bend.w, c);
  vec3 l1 = to_local * e1, l2 = to_local * e2, m1 = form * l1;
  float h11 = dot(l1, m1) / gradient, h12 = dot(l2, m1) / gradient, h22 = dot(l2, form * l2) / gradient;
  float mean = 0.5 * (h11 + h22), half_gap = 0.5 * (h11 - h22), radius = length(vec2(half_gap, h12));
  bool upper = mean >= 0.0;
  k = upper ? vec2(mean + radius, mean - radius) : vec2(mean - radius, mean + radius);
  // Of the two ways to write an eigenvector of a symmetric 2x2 matrix, the one that does not cancel.
  vec2 v = half_gap >= 0.0 == upper ? vec2(abs(half_gap) + radius, upper ? h12 : -h12)
                                    : vec2(upper ? h12 : -h12, abs(half_gap) + radius);
  direction = dot(v, v) > 0.0 ? normalize(v.x * e1 + v.y * e2) : e1;
}
#endif
