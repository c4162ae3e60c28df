// Differential points in few bytes: the 13-byte record of Kalaiah & Varshney (2003, section VI), and their 62
// bytes.
//
//   packed: position 3 × u16 | û and v̂ 4 bytes | λu u16 | ρ = λv/λu 1 byte                 = 13
//           then, where sizes are stored: 0, the rectangle follows from ε and δ | or width, height, both not
//           0
//   raw:    diffuse and specular colour 2 × 3 bytes | position, û, v̂, n, λu, λv as 14 floats = 62
//           then, where sizes are stored: half_u, half_v as floats
//
// Positions are in the box of their chunk. The paper has 2 bytes for each principal direction; as v̂ is
// perpendicular to û, the four are better shared out as 21 bits for û, on an octahedron, and 11 for the angle
// of v̂ about it: the normal û × v̂, which a picture shows, then turns by a fifth of a degree at most. λu is a
// sign and a logarithm. All integers and floats are little-endian.
#ifndef DUPIN_SIMPLIFY_DP_CODEC_H
#define DUPIN_SIMPLIFY_DP_CODEC_H

#include <cstdint>
#include <vector>

#include "../sampling/differential_point.h"

namespace dupin {

inline constexpr std::size_t kPackedBytes = 13, kRawBytes = 62, kRawSizeBytes = 8;

/// Of a decoded position, in each coordinate: times the box's extent there.
inline constexpr double kPackedPositionError = 0.5 / 65535 * (1 + 1e-9);
/// Of a decoded normal and of a decoded principal direction, in radians.
inline constexpr double kPackedNormalError = 0.0034, kPackedDirectionError = 0.0034;
/// Of a decoded λu: this part of it, or kLeastCurvature times the chunk's largest. Of ρ: absolute.
inline constexpr double kPackedCurvatureError = 3e-4, kLeastCurvature = 1e-8,
                        kPackedRhoError = 0.5 / 127 * (1 + 1e-9);

/// ρ as one of 255 values with 0 and ±1 among them: (code − 128) / 127.
std::uint8_t rho_code(double rho);
double rho_of(std::uint8_t code);

/// What the numbers of a chunk's packed records refer to.
struct PackedRange {
  Box3 box;
  double least_curvature = 0, most_curvature = 0;  ///< of |λu|; 0, 0: all flat
  double least_size = 0, most_size = 0;            ///< of stored half-extents; 0, 0: none is stored
};
PackedRange packed_range(const DifferentialPoint* points, std::size_t count, bool sizes);

/// Appends a record; sizes are stored with it if `range` has any, by this factor at most too large and never
/// too small.
void pack(const DifferentialPoint& point, const PackedRange& range, std::vector<std::uint8_t>& bytes);
double packed_size_factor(const PackedRange& range);
/// Reads one record and moves `at` behind it; false if it does not end before `end`.
bool unpack(const std::uint8_t*& at, const std::uint8_t* end, const PackedRange& range, double epsilon,
            double delta, DifferentialPoint& point);

}  // namespace dupin

#endif
