// From a surface point's normal, curvatures and color to what the picture shows there. Linear light throughout.

vec3 from_srgb(uint word) {
  vec3 c = vec3(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u)) / 255.0;
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

// What a host has highlighted; the color is then that to show it by.
bool is_highlighted(uint color) { return color >> 24 == 0xfeu; }
const float kHighlight = 0.6;  // how much of it is seen where colors show something else

// Of a solid that is cut open. Where its inner side is seen, a drawing has hatches.
bool is_solid(uint color) { return color >> 24 == 0xfdu; }
vec3 hatched(vec3 color, vec2 at_px) {
  float stripe = abs(fract((at_px.x + at_px.y) / 9.0) - 0.5) * 9.0;
  return mix(0.35 * color, 0.8 * color, smoothstep(0.4, 1.4, stripe));
}

// View space with z towards the viewer: from above left.
const vec3 kKeyLight = vec3(-0.42, 0.62, 0.66);

// How bright a highlight is, of unit normals and of half vectors of any length.
float glint(vec3 n, vec3 h) {
  float g = max(dot(n, normalize(h)), 0.0), g2 = g * g, g4 = g2 * g2, g8 = g4 * g4, g16 = g8 * g8;
  return g16 * g16;
}

// A head light, the key light and a fill light from the right; n faces the viewer, and h is between the key light and v.
vec3 lit(vec3 albedo, vec3 n, vec3 v, vec3 h) {
  const vec3 fill = vec3(0.80, 0.05, 0.59);
  float sky = 0.5 + 0.5 * n.y;
  float diffuse = 0.16 + 0.08 * sky + 0.30 * max(dot(n, v), 0.0) + 0.46 * max(dot(n, kKeyLight), 0.0) + 0.14 * max(dot(n, fill), 0.0);
  return albedo * diffuse + vec3(0.10) * glint(n, h);
}
vec3 lit(vec3 albedo, vec3 n, vec3 v) { return lit(albedo, n, v, kKeyLight + v); }

// Blue below, red above, near white at zero; lightness falls evenly from the middle to both ends.
vec3 diverging(float t) {
  t = clamp(t, -1.0, 1.0);
  const vec3 white = vec3(0.88, 0.87, 0.85);
  vec3 end = t < 0.0 ? vec3(0.024, 0.075, 0.42) : vec3(0.42, 0.012, 0.022);
  vec3 mid = t < 0.0 ? vec3(0.17, 0.38, 0.80) : vec3(0.82, 0.20, 0.11);
  float u = abs(t);
  return u < 0.5 ? mix(white, mid, 2.0 * u) : mix(mid, end, 2.0 * u - 1.0);
}

uint scramble(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}
vec3 number_color(uint number) {
  uint h = scramble(number);
  float hue = float(h & 1023u) / 1024.0 * 6.0, value = 0.55 + 0.4 * float((h >> 10) & 255u) / 255.0;
  float depth = 0.45 + 0.35 * float((h >> 18) & 255u) / 255.0;
  vec3 pure = clamp(vec3(abs(hue - 3.0) - 1.0, 2.0 - abs(hue - 2.0), 2.0 - abs(hue - 4.0)), 0.0, 1.0);
  return value * mix(vec3(1.0), pure, depth);
}

// Stripes of a striped room, seen in the surface as in a mirror.
vec3 zebra(vec3 n, vec3 v) {
  vec3 r = 2.0 * dot(n, v) * n - v;
  float stripe = sin(28.0 * acos(clamp(0.3 * r.x + 0.9539 * r.y, -1.0, 1.0)));
  return mix(vec3(0.03), vec3(0.9), smoothstep(-0.15, 0.15, stripe)) * (0.6 + 0.4 * dot(n, v));
}
