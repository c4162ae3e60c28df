// A tile of a planar DP is drawn itself. What is covered follows from its sides as linear functions of (X, Y): with (x, y, 1)·W linear in
// the picture's coordinates, so is n·(x, y)·W + d·W, and a conic is a quadratic form.
flat out vec2 centre;  // of the picture; what follows are functions of the pixels from there (curved.vert)
flat out vec3 side0, side1, side2, side3;
flat out uint id;
#ifdef AT_ONCE
flat out vec3 normal, own;
flat out vec4 sight;
#endif
#ifdef CONIC
flat out vec3 form_a, form_b;
flat out vec4 form_c, form_w;  // c and the sign inside; W and what is added for rounding
#endif
#if defined(PIECES) || defined(EDGES)
flat out vec3 row_x, row_y, row_w;
#endif
#ifdef PIECES
flat out ivec2 pieces;  // texel, slot's meta
flat out float rounding;
#endif
#ifdef EDGES
flat out float ink;
#ifdef PIECES
flat out vec4 no_edge;  // 0 for the sides that are feature edges, much for others
#else
flat out uvec4 edges;
#endif
#endif

// In pixels; a corner that is there twice has no side.
vec3 side_function(vec2 a, vec2 b, mat3 rows, float rounding) {
  vec2 d = b - a;
  float l = length(d);
  if (l == 0.0) return vec3(0.0, 0.0, 1e30);
  vec2 inward = vec2(-d.y, d.x) / l;
  vec3 side = rows * vec3(inward, rounding - dot(inward, a));
  return side / max(length(side.xy), 1e-30);
}

void main() {
  int i = gl_VertexID & 3;
  Tile tile = tile_at(gl_VertexID >> 2);
  int slot = tile.slot, next = tile.next;
  uvec4 t0 = texelFetch(slots, slot * kSlotTexels), t1 = texelFetch(slots, slot * kSlotTexels + 1);
  vec3 s = uintBitsToFloat(t0.xyz), f = uintBitsToFloat(t1.xyz), p = slot_texel(slot, 2).xyz;
  vec4 t3 = slot_texel(slot, 3);
  vec4 rx = slot_texel(slot, 8), ry = slot_texel(slot, 9), rf = slot_texel(slot, 10);
  float z0 = rf.w;
  vec3 q = t3.xyz, a = reach(z0) * p, b = reach(z0) * q;
  vec4 c01 = tile.c01, c23 = tile.c23;

  // The ray meets z = 0 in (o.xy d.z − d.xy o.z) / d.z; the product of what is linear in X, Y in o and d cancels, as they are
  // parallel or one of them is zero. W = ∓d.z has the sign that is positive where the ray comes from the viewer's side.
  vec3 fs = spread * p, gs = spread * q;
  vec2 h0 = s.xy * f.z - f.xy * s.z;
  vec2 hx = s.xy * fs.z - fs.xy * s.z + a.xy * f.z - f.xy * a.z;
  vec2 hy = s.xy * gs.z - gs.xy * s.z + b.xy * f.z - f.xy * b.z;
  float eye_z = spread > 0.0 ? s.z - z0 * f.z : -f.z;
  float sign_w = eye_z < 0.0 ? 1.0 : -1.0;
  mat3 rows = sign_w * mat3(hx.x, hy.x, h0.x, hx.y, hy.y, h0.y, fs.z, gs.z, f.z);  // columns: xW, yW, W over (X, Y, 1), and then over pixels

  centre = 0.5 * picture;
  rows = matrixCompMult(rows, mat3(vec3(2.0 / picture, 1.0), vec3(2.0 / picture, 1.0), vec3(2.0 / picture, 1.0)));
  float widen = t3.w;
  side0 = side_function(c01.xy, c01.zw, rows, widen);
  side1 = side_function(c01.zw, c23.xy, rows, widen);
  side2 = side_function(c23.xy, c23.zw, rows, widen);
  side3 = side_function(c23.zw, c01.xy, rows, widen);
  id = uint(slot) + 1u;
#ifdef AT_ONCE
  planar_look(slot, normal, own);
  sight = sight_from(centre);
#endif
#ifdef CONIC
  Conic conic = conic_at(next);
  form_a = rows * conic.a;
  form_b = rows * conic.b;
  form_c = vec4(rows * conic.c, conic.side);
  form_w = vec4(rows[2], widen * conic.steepest);
#endif
#if defined(PIECES) || defined(EDGES)
  row_x = rows[0];
  row_y = rows[1];
  row_w = rows[2];
#endif
#ifdef PIECES
  pieces = ivec2(t1.w, t0.w);
  rounding = widen;
#endif
#ifdef FLAT_ARCS
  fetch_pieces(int(t1.w), t0.w);
#endif

  // Both sides that meet in the corner are moved out by kGrow pixels.
  vec2 c = corner_of(c01, c23, i), to = side_to(c01, c23, i), from = side_from(c01, c23, i);
  vec2 ju, jv;
  jacobian(c, rx, ry, rf, ju, jv);
  float extent = length(c23.xy - c01.xy) + length(c23.zw - c01.zw);
#ifdef EDGES
  ink = ink_for(tile.dp_px);
#ifdef PIECES
  uint features = t0.w >> 8;
  no_edge = vec4((features & 1u) != 0u ? 0.0 : 1e30, (features & 2u) != 0u ? 0.0 : 1e30,
                 (features & 4u) != 0u ? 0.0 : 1e30, (features & 8u) != 0u ? 0.0 : 1e30);
#else
  edges = texelFetch(tiles, next);
#endif
#endif
  c += miter(to, from, min(kGrow * vec2(way_per_pixel(ju, jv, to), way_per_pixel(ju, jv, from)), vec2(extent)));
  vec3 at = vec3(c, 1.0);
  gl_Position = to_clip(vec2(dot(rx.xyw, at), dot(ry.xyw, at)), dot(rf.xyw, at));
}
