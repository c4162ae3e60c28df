// Quadric DPs as the GPU reads them: records of 16-byte texels (RGBA32UI; floats by their bits), of variable
// length.
//
//   texel  x             y             z             w
//   0      origin, relative to the part's anchor     meta (below)
//   1      the quaternion's three smallest parts     face, among the part's drawn faces
//   2      footprint: x lo, y lo, x hi, y hi; or, unless kRectangle, corners 0 and 1, and a texel with
//   corners 2 and 3 then, unless kPlanar:
//          λu            λv            a             b
//          c             z lo          z hi          the normal's tilt: 16 bits each, ±kMostTilt
//          c0 c1 c2 c3 of the normal's cubic terms, if kCubic
//   then, if kPieces:
//          counts: lines | arcs << 12 | ellipses << 24; the same of those that are feature edges; reference
//          x, y
//   then the planes (n, d), lines (p0, p1), arcs (p0, p1; p2, 4w², 0) and ellipses (center, mxx, mxy; myy, 0,
//   0, 0), each kind with its feature edges first. All but the planes are relative to the reference; an arc's
//   triangle p0 p1 p2 is counter-clockwise.
//
// meta: flags in bits 0–4 and 14, the quaternion's largest part in bits 6–7, feature_sides in bits 8–13,
// planes in bits 16–23 and those of them that are feature edges in bits 24–31.
#ifndef DUPIN_RENDER_GPU_ENCODE_H
#define DUPIN_RENDER_GPU_ENCODE_H

#include <array>
#include <cstdint>
#include <vector>

#include "../core/status.h"
#include "../sampling/quadric_dp.h"

namespace dupin {

using Texel = std::array<std::uint32_t, 4>;

constexpr std::uint32_t kPlanar = 1, kFlipped = 2, kRectangle = 4, kPieces = 8, kReferenceInside = 16,
                        kCubic = 1u << 14;  // meta's flags
constexpr std::uint32_t kLargestPartShift = 6, kFeatureSidesShift = 8, kPlaneCountShift = 16,
                        kFeaturePlaneShift = 24;
constexpr std::uint32_t kMaxPlanes = 255, kMaxLines = 4095, kMaxArcs = 4095, kMaxEllipses = 255;

/// Appends the DP's record; `face` is the number to store for its face. Fails with limit if it has more
/// pieces than a record can count.
Status encode_dp(const PartDps& part, const QuadricDp& dp, const Vec3& anchor, std::uint32_t face,
                 std::vector<Texel>& texels);

/// An arc's two texels, relative to a reference.
void append_arc(const ArcPiece& arc, Vec2 reference, std::vector<Texel>& texels);

/// The frame that a record's texel 1 stands for, as the shader decodes it: u, v, n in float.
std::array<Vec3, 3> decode_frame(const Texel& second, std::uint32_t meta);

}  // namespace dupin

#endif
