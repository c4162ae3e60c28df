// What a layer's surface_at needs: its numbers, and rays and vectors of placed parts. See layer.h.
const uint kLayerMask = 0xf8000000u, kOwnMask = 0x07ffffffu;

bool is_mine(uint number) { return (number & kLayerMask) == LAYER; }
uint own_number(uint number) { return number & kOwnMask; }

// A placed part under a pixel, in the part's space relative to its anchor.
struct Placed {
  vec3 hi, lo;    // S, in two floats
  vec3 origin;    // the ray is  S + origin + t direction,  t its depth beyond start_depth
  vec3 direction;
  vec3 row_x, row_y;  // the clip coordinates of S + p are row·p
  vec3 depth_row; // the depth of S + p is  start_depth + depth_row·p
  mat3 to_view;   // rows: takes normals (covectors) to view space
  uint first_face;
};

Placed placed_at(int instance, vec2 at) {
  int first = instance * kInstanceTexels;
  vec4 hi = texelFetch(instances, first);
  vec3 f = texelFetch(instances, first + 2).xyz, p = texelFetch(instances, first + 3).xyz, q = texelFetch(instances, first + 4).xyz;
  vec3 across = at.x * p + at.y * q, right = p * axis_scale.x, up = q * axis_scale.y;
  Placed placed;
  placed.hi = hi.xyz;
  placed.lo = texelFetch(instances, first + 1).xyz;
  placed.origin = start * across;
  placed.direction = f + spread * across;
  placed.row_x = texelFetch(instances, first + 5).xyz;
  placed.row_y = texelFetch(instances, first + 6).xyz;
  placed.depth_row = texelFetch(instances, first + 7).xyz;
  placed.to_view = transpose(mat3(right, up, spread * (axis_offset.x * right + axis_offset.y * up) - f));
  placed.first_face = floatBitsToUint(hi.w);
  return placed;
}

// The depth of a point of the part's space.
float depth_of(Placed placed, vec3 point) { return start_depth + dot(placed.depth_row, (point - placed.hi) - placed.lo); }
