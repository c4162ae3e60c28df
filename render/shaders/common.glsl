// What every stage shares: the buffers, and a frame's camera.
//
// instances, 10 texels each (draw_list.cpp): S hi, first face | S lo, scale ratio | F | P | Q | row x | row y | row f | - | -
//   The ray of picture point (X, Y) is  S + start (X P + Y Q) + t (F + spread (X P + Y Q)),  t its depth beyond start_depth;
//   spread is 1 in perspective and 0 in parallel.
// slots, 12 texels for each DP of the frame, the DP's frame and this frame's camera together (prepare.vert):
//   Here rays start at the depth z0 of the DP's origin, where numbers are as small as the DP:  s + reach(z0) (X P + Y Q) + t (F + …).
//   0 s, meta | 1 F, pieces' texel | 2 P, color | 3 Q, rounding | 4 λu λv a b | 5 c, z lo, z hi, face
//   6, 7 footprint | 8, 9 rows x, y: clip coordinates are row·(p, 1) | 10 row f: the depth | 11 primitive, scale ratio, cubic terms' texel, z0
uniform usamplerBuffer heap;
uniform samplerBuffer instances;
uniform usamplerBuffer slots;
uniform float start, spread, start_depth;

const int kSlotTexels = 12;
const int kInstanceTexels = 10;
const uint kPlanar = 1u, kFlipped = 2u, kRectangle = 4u, kPieces = 8u, kReferenceInside = 16u, kCubic = 1u << 14;
// In a tile's meta: what is seen is the inner side.
const uint kFromBehind = 1u << 15;
// Numbers in the id picture: 0 background; or slot + 1, with kFallingRoot if F falls along the ray where it met a curved quadric (wherever
// the ray starts that a root is found from), and how much of the pixel a
// feature edge covers; or a triangle's number with kTriangle, in the two top bits; or, with both of them set, a layer and its number (layer.h).
const uint kTriangle = 0x80000000u, kFallingRoot = 0x40000000u, kSlotMask = 0x00ffffffu, kTriangleMask = 0x3fffffffu;
const int kEdgeShift = 24;
const float kEdgeLevels = 63.0;

// How far apart, at a depth along the view axis, the rays of picture points are.
float reach(float depth) { return spread > 0.0 ? depth : 1.0; }

vec4 slot_texel(int slot, int i) { return uintBitsToFloat(texelFetch(slots, slot * kSlotTexels + i)); }
vec4 heap_texel(int i) { return uintBitsToFloat(texelFetch(heap, i)); }

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
