// Proxies are drawn a little larger than what they stand for: vertices are rounded to parts of a pixel, while what is covered is
// decided exactly in the fragment shader.
uniform vec2 picture;  // width, height in pixels

uniform vec3 depth_terms;      // window depth = x + y·depth + z/depth
uniform float zero_to_one;     // 1: clip space's depth is that of the window; 0: it is [-1, 1]

const float kGrow = 0.25;  // pixels

#ifdef SECTIONS
uniform vec4 sections[SECTIONS];  // what is seen has values >= 0 of  dot(section, (clip X, clip Y, depth, 1))
out float gl_ClipDistance[SECTIONS];
void cut(vec2 xy, float depth) {
  for (int i = 0; i < SECTIONS; ++i) gl_ClipDistance[i] = dot(sections[i], vec4(xy, depth, 1.0));
}
void cut_nothing() {
  for (int i = 0; i < SECTIONS; ++i) gl_ClipDistance[i] = 1.0;
}
#else
void cut(vec2 xy, float depth) {}
void cut_nothing() {}
#endif

// Clip coordinates of a point from its clip X, Y and its depth.
vec4 to_clip(vec2 xy, float depth) {
  cut(xy, depth);
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

// How a point (x, y) of a DP's plane z = 0 moves on the picture, in pixels: columns for x and y.
void jacobian(vec2 c, vec4 rx, vec4 ry, vec4 rf, out vec2 ju, out vec2 jv) {
  vec3 at = vec3(c, 1.0);
  vec2 clip = vec2(dot(rx.xyw, at), dot(ry.xyw, at));
  float w = spread > 0.0 ? dot(rf.xyw, at) : 1.0, w2 = max(w * w, 1e-30);
  ju = (vec2(rx.x, ry.x) * w - spread * clip * rf.x) / w2 * picture * 0.5;
  jv = (vec2(rx.y, ry.y) * w - spread * clip * rf.y) / w2 * picture * 0.5;
}

// How far a side along the unit tangent is moved, in the plane, for it to move by a pixel on the picture: moved by m it moves m |J| / |J tangent|.
float way_per_pixel(vec2 ju, vec2 jv, vec2 tangent) {
  return length(ju * tangent.x + jv * tangent.y) / max(abs(cross2(ju, jv)), 1e-30);
}

#ifdef AT_ONCE
uniform vec2 ray_scale;  // 1 / axis_scale

// The direction to the viewer is (xy + zw·from, 1), not of unit length, with `from` the pixels from that centre of the picture.
vec4 sight_from(vec2 centre) {
  vec2 per_pixel = -spread * ray_scale * 2.0 / picture;
  return vec4(-spread * axis_offset + per_pixel * (centre - 0.5 * picture), per_pixel);
}

// A planar DP's normal in view space and its color.
void planar_look(int slot, out vec3 normal, out vec3 own) {
  vec3 f = slot_texel(slot, 1).xyz, q = slot_texel(slot, 3).xyz;
  vec4 p = slot_texel(slot, 2);
  normal = normalize(to_view(vec3(0.0, 0.0, 1.0), p.xyz, q, f));
  own = own_color(floatBitsToUint(p.w), floatBitsToUint(slot_texel(slot, 5).w), floatBitsToUint(slot_texel(slot, 11).x));
}
#endif
