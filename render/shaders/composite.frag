// Puts a drawn picture into a host's framebuffer: its color, and its depth as the host's own projection would have it.
uniform sampler2D colors, depths;   // color with straight alpha; the depth buffer or, with DEPTH_PICTURE, depth in w
uniform vec3 depth_terms;           // the depth buffer holds x + y·depth + z/depth, 0 where nothing is drawn
uniform ivec3 place;                // the viewport's x and y, and its height
uniform vec3 host_depth;            // window depth = x + y·depth + z/depth
uniform vec2 host_range;            // nearest and farthest window depth that is not clipped, in order
uniform int encode;                 // 1: the framebuffer stores what a screen shows, 0: it converts linear light itself
layout(location = 0) out vec4 out_color;

vec3 to_srgb(vec3 c) { return mix(12.92 * c, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }

float drawn_depth(ivec2 at) {
#ifdef DEPTH_PICTURE
  return texelFetch(depths, at, 0).w;  // +inf where nothing is drawn
#else
  float d = texelFetch(depths, at, 0).x;
  return d <= 0.0 ? uintBitsToFloat(0x7f800000u) : spread > 0.0 ? depth_terms.z / d : (d - depth_terms.x) / depth_terms.y;
#endif
}

float depth_at(ivec2 at) {
#ifdef DEPTH_PICTURE
  ivec2 last = textureSize(depths, 0) - 1;
  float z = drawn_depth(at);
  if (!isinf(z)) return z;
  // Only some of the pixel's samples saw something: it is as deep as what is seen beside it.
  for (int k = 0; k < 9; ++k) z = min(z, drawn_depth(clamp(at + ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), last)));
  return z;
#else
  return drawn_depth(at);
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) - place.xy;
  at.y = place.z - 1 - at.y;
  vec4 c = texelFetch(colors, at, 0);
  float z = depth_at(at);
  if (c.a <= 0.0 || isinf(z)) discard;
  float window = host_depth.x + host_depth.y * z + host_depth.z / z;
  if (window < host_range.x || window > host_range.y) discard;
  gl_FragDepth = window;
  out_color = vec4((encode == 1 ? to_srgb(c.rgb) : c.rgb) * c.a, c.a);
}
