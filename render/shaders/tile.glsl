// A tile, as tiles.h has it, for the vertex shaders that draw it.
uniform usamplerBuffer tiles;
uniform int first;

struct Tile {
  vec4 c01, c23;
  vec2 ends;   // z lo, z hi
  int slot;
  bool from_behind;
  float dp_px; // how large its DP is on the picture
  int next;    // texel after these
};

Tile tile_at(int number) {
  int at = first + number * TILE_TEXELS;
  uvec4 last = texelFetch(tiles, at + 2);
  return Tile(uintBitsToFloat(texelFetch(tiles, at)), uintBitsToFloat(texelFetch(tiles, at + 1)), uintBitsToFloat(last.xy),
              int(last.z & 0x7fffffffu), (last.z & 0x80000000u) != 0u, uintBitsToFloat(last.w), at + 3);
}

#ifdef CONIC
// a·b − c² of linear forms in (x, y, 1); its sign inside, and how steep it is at most.
struct Conic {
  vec3 a, b, c;
  float side, steepest;
};

Conic conic_at(inout int next) {
  vec4 t0 = uintBitsToFloat(texelFetch(tiles, next)), t1 = uintBitsToFloat(texelFetch(tiles, next + 1)),
       t2 = uintBitsToFloat(texelFetch(tiles, next + 2));
  next += 3;
  return Conic(t0.xyz, vec3(t0.w, t1.xy), vec3(t1.zw, t2.x), t2.y, t2.z);
}
#endif

#ifdef FLAT_ARCS
flat out vec2 reference;
flat out uvec2 flat_counts;
#if FLAT_LINES
flat out vec4 lines[FLAT_LINES];
#endif
#if FLAT_ARCS
flat out vec4 arcs[2 * FLAT_ARCS];
#endif

// The pieces, with such that bound nothing in place of those that there are not.
void fetch_pieces(int at, uint meta) {
  uvec4 head = texelFetch(heap, at);
  int line_count = int(head.x & 4095u), arc_count = int((head.x >> 12) & 4095u);
  reference = uintBitsToFloat(head.zw);
  flat_counts = uvec2((meta & kReferenceInside) != 0u ? 1u : 0u, (head.y & 255u) | ((head.y >> 12) & 255u) << 8);
#if FLAT_LINES
  for (int k = 0; k < FLAT_LINES; ++k) lines[k] = k < line_count ? heap_texel(at + 1 + k) : vec4(0.0);
#endif
#if FLAT_ARCS
  for (int k = 0; k < 2 * FLAT_ARCS; ++k) arcs[k] = k < 2 * arc_count ? heap_texel(at + 1 + line_count + k) : vec4(0.0);
#endif
}
#endif
