// What figure 10 of Reniers & Telea (2006) leaves: sums over each pixel's prefix, and the domain that locked it. Where the sum of Ψ is less than 1
// it is darker, as published.
uniform sampler2D prefix_normal, prefix_color;
uniform usampler2D face_picture;
uniform usamplerBuffer colors;

// The highest byte of a color says more of its face than its color.
uint to_word(vec3 c, uint face_color) {
  uvec3 b = uvec3(clamp(c, 0.0, 1.0) * 255.0 + 0.5);
  return b.x | b.y << 8 | b.z << 16 | face_color & 0xff000000u;
}
vec3 of_word(uint c) { return vec3(c & 255u, c >> 8 & 255u, c >> 16 & 255u) / 255.0; }

Surface surface_at(uint number, vec2 at) {
  uvec4 run = run_of(own_number(number));
  int index = int(run.z + own_number(number) - run.x);
  Placed placed = placed_at(int(run.y), at);
  Domain d = domain_at(index);
  vec3 o = in_domain(d, placed.origin - ((d.center - placed.hi) - placed.lo)), w = in_domain(d, placed.direction);
  float t = -o.z / w.z;
  vec4 normal = texelFetch(prefix_normal, ivec2(gl_FragCoord.xy), 0);
  vec3 color = texelFetch(prefix_color, ivec2(gl_FragCoord.xy), 0).xyz;
  uint face = d.face;
#ifdef TEXTURE_FACES
  face = texelFetch(face_picture, ivec2(texel_place(d, o.xy + t * w.xy)), 0).x;
#endif
  Surface result;
  result.normal = normalize(placed.to_view * (dot(normal.xyz, normal.xyz) > 0.0 ? normal.xyz : d.n));
  result.depth = start_depth + t;
  result.face = placed.first_face + face + 1u;
  result.primitive = run.w + uint(index) - run.z + 1u;
  result.color = texelFetch(colors, int(result.face) - 1).x;
  if (result.color >> 24 != 0xfeu) {
#ifdef TEXTURE_COLORS
    result.color = to_word(color, result.color);
#else
    result.color = to_word(of_word(result.color) * min(normal.w, 1.0), result.color);
#endif
  }
  result.edge = 0.0;
  result.direction = vec3(0.0);
  result.curvature = vec2(0.0);
  return result;
}
