// The quadric F(p) = z − ½(λu x² + λv y²) − a xz − b yz − ½c z²: bend = (λu, λv, a, b).
float quadric_form(vec4 bend, float c, vec3 p) {
  return -0.5 * (bend.x * p.x * p.x + bend.y * p.y * p.y + c * p.z * p.z) - p.z * (bend.z * p.x + bend.w * p.y);
}
vec3 quadric_gradient(vec4 bend, float c, vec3 p) {
  return vec3(-bend.x * p.x - bend.z * p.z, -bend.y * p.y - bend.w * p.z, 1.0 - bend.z * p.x - bend.w * p.y - c * p.z);
}

// The two values of t at which o + t d meets F, with o near the DP: C / q and q / A, free of cancellation. False if there are none.
// F falls along the ray at the first if B < 0, and then rises at the second; and the other way round.
bool quadric_roots(vec4 bend, float c, vec3 o, vec3 d, out float first, out float second, out float slope) {
  float A = quadric_form(bend, c, d), B = dot(quadric_gradient(bend, c, o), d), C = o.z + quadric_form(bend, c, o);
  float disc = B * B - 4.0 * A * C;
  slope = B;
  if (!(disc >= 0.0)) return false;
  float q = -0.5 * (B + (B < 0.0 ? -1.0 : 1.0) * sqrt(disc));
  first = C / q;
  second = q / A;
  return true;
}
