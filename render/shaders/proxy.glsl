// Proxies are drawn a little larger than what they stand for: vertices are rounded to parts of a pixel, while what is covered is
// decided exactly in the fragment shader.
uniform vec2 picture;  // width, height in pixels

uniform vec3 depth_terms;      // window depth = x + y·depth + z/depth
uniform float zero_to_one;     // 1: clip space's depth is that of the window; 0: it is [-1, 1]

const float kGrow = 0.25;  // pixels

// Clip coordinates of a point from its clip X, Y and its depth.
vec4 to_clip(vec2 xy, float depth) {
  float w = spread > 0.0 ? depth : 1.0;
  float z = spread > 0.0 ? depth_terms.z : depth_terms.x + depth_terms.y * depth;
  return vec4(xy, zero_to_one > 0.5 ? z : 2.0 * z - w, w);
}

// How strongly edges are drawn on something of this size in pixels: not at all on a few, or it would be drawn black.
float ink_for(float size_px) { return clamp((size_px - 3.0) / 8.0, 0.0, 1.0); }

vec2 corner_of(vec4 c01, vec4 c23, int i) { return i == 0 ? c01.xy : i == 1 ? c01.zw : i == 2 ? c23.xy : c23.zw; }

// Unit tangent of the footprint's side that leaves corner i, skipping repeated corners; zero for a single point.
vec2 side_from(vec4 c01, vec4 c23, int i) {
  vec2 from = corner_of(c01, c23, i);
  for (int k = 1; k < 4; ++k) {
    vec2 d = corner_of(c01, c23, (i + k) & 3) - from;
    float l = length(d);
    if (l > 0.0) return d / l;
  }
  return vec2(0.0);
}
vec2 side_to(vec4 c01, vec4 c23, int i) {
  vec2 to = corner_of(c01, c23, i);
  for (int k = 3; k > 0; --k) {
    vec2 d = to - corner_of(c01, c23, (i + k) & 3);
    float l = length(d);
    if (l > 0.0) return d / l;
  }
  return vec2(0.0);
}

vec2 outward(vec2 side) { return vec2(side.y, -side.x); }

// Moves both sides that meet in a corner outwards, by m.x and m.y, and gives the corner's offset; sharp corners are cut short.
vec2 miter(vec2 to, vec2 from, vec2 m) {
  vec2 n1 = outward(to), n2 = outward(from);
  float c = cross2(n1, n2);
  if (abs(c) < 0.1) return (n1 + n2) * max(m.x, m.y) + to * m.x - from * m.y;
  return (vec2(n2.y, -n2.x) * m.x + vec2(-n1.y, n1.x) * m.y) / c;
}
