// Point trees' nodes and vertices, decoded as simplify/point_node.cpp does.
vec3 node_place(uvec2 words) {
  return vec3(float(words.x & 0x1fffffu), float((words.x >> 21 | words.y << 11) & 0x1fffffu), float(words.y >> 10 & 0x1fffffu));
}

float node_radius(uint word) {
  uint bits = word & 0xffffu;
  return bits == 0u ? 0.0 : uintBitsToFloat((bits >> 11) + 117u << 23 | (bits & 0x7ffu) << 12);
}

vec3 node_normal(uint word) {
  vec2 p = vec2(float(word & 0x7ffu), float(word >> 11 & 0x7ffu)) * (2.0 / 2047.0) - 1.0;
  float z = 1.0 - abs(p.x) - abs(p.y);
  if (z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  return normalize(vec3(p, z));
}

// As a word of 8 bits a channel.
uint node_color(uint word2, uint word3) {
  uint c = word2 >> 24 << 8 | word3 >> 24, r = c >> 11, g = c >> 5 & 63u, b = c & 31u;
  return (r * 255u + 15u) / 31u | (g * 255u + 31u) / 63u << 8 | (b * 255u + 15u) / 31u << 16 | 0xff000000u;
}

// The first of the axes that node curvatures' angles count from: core/vec.h's any_perpendicular.
vec3 node_axis(vec3 n) {
  vec3 a = abs(n);
  return normalize(cross(n, a.x <= a.y && a.x <= a.z ? vec3(1.0, 0.0, 0.0) : a.y <= a.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0)));
}

float signed_square(uint bits) {
  float x = float(int(bits << 24) >> 24) / 127.0;
  return x * abs(x);
}
