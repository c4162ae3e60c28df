// The quadric F(p) = z − ½(λu x² + λv y²) − a xz − b yz − ½c z²: bend = (λu, λv, a, b).
float quadric_form(vec4 bend, float c, vec3 p) {
  return -0.5 * (bend.x * p.x * p.x + bend.y * p.y * p.y + c * p.z * p.z) - p.z * (bend.z * p.x + bend.w * p.y);
}
vec3 quadric_gradient(vec4 bend, float c, vec3 p) {
  return vec3(-bend.x * p.x - bend.z * p.z, -bend.y * p.y - bend.w * p.z, 1.0 - bend.z * p.x - bend.w * p.y - c * p.z);
}

// The ray o + t d, with o near the DP, meets F = 0 at t = C / q and at t = q / A: free of cancellation. F falls along the ray at the
// first if the slope is negative, and then rises at the second; and the other way round.
struct Roots {
  float A, C, q, slope;
  float discriminant;  // negative, or no number: the ray misses
};

Roots quadric_roots(vec4 bend, float c, vec3 o, vec3 d) {
  Roots r;
  r.A = quadric_form(bend, c, d);
  r.C = o.z + quadric_form(bend, c, o);
  r.slope = dot(quadric_gradient(bend, c, o), d);
  r.discriminant = r.slope * r.slope - 4.0 * r.A * r.C;
  float root = sqrt(max(r.discriminant, 0.0));
  r.q = -0.5 * (r.slope + (r.slope < 0.0 ? -root : root));
  return r;
}

// Two 16-bit numbers, ±kMostTilt.
vec2 unpacked_tilt(uint word) {
  return vec2(int(word << 16u) >> 16, int(word) >> 16) * (0.25 / 32767.0);
}

// The gradient of the normal's own terms, of first and third order, to be taken from the quadric's.
vec2 cubic_gradient(vec4 k, vec2 tilt, vec2 p) {
  return tilt + vec2(3.0 * k.x * p.x * p.x + 2.0 * k.y * p.x * p.y + k.z * p.y * p.y,
              k.y * p.x * p.x + 2.0 * k.z * p.x * p.y + 3.0 * k.w * p.y * p.y);
}
