// A node of a point tree as 16 bytes: a sphere, a normal and the cone around it, a colour.
//
// word 0, 1   x, y, z of the centre, 21 bits each, in steps of the tree's grid
// word 2      radius (16 bits: 5 of exponent, 11 of mantissa), sine of the cone's half-angle (8), colour (8)
// word 3      normal on an octahedron (11 + 11), triangles of a leaf − 1 (2), colour (8)
//
// Whatever bounds something is rounded outwards: a decoded sphere contains what it stands for. The shaders
// decode nodes too (shaders/tree_node.glsl): both must do the same.
#ifndef DUPIN_SIMPLIFY_POINT_NODE_H
#define DUPIN_SIMPLIFY_POINT_NODE_H

#include <array>
#include <cstdint>

#include "../core/vec.h"
#include "../nurbs/polygon_mesh.h"

namespace dupin {

inline constexpr int kGridBits = 21;
inline constexpr std::uint32_t kLargestGridCoordinate = (1U << kGridBits) - 1;
inline constexpr int kNormalBits = 11;
inline constexpr std::uint32_t kMostLeafTriangles = 4;
inline constexpr std::uint32_t kNoCone = 255;
/// How far a decoded normal is from the one that was encoded, in radians (tested).
inline constexpr double kNormalError = 2.2e-3;

/// Where a tree's grid lies in its part's space.
struct PointGrid {
  Vec3 origin;
  double step = 1;
  Vec3 to_part(const Vec3& grid) const { return origin + grid * step; }
  Vec3 to_grid(const Vec3& part) const { return (part - origin) / step; }
};

/// Decoded; lengths in steps of the grid.
struct PointNode {
  Vec3 center;
  double radius = 0;
  Vec3 normal;                  ///< unit
  std::uint32_t cone = 0;       ///< kNoCone: normals in all directions, or a surface whose inside can be seen
  std::uint32_t triangles = 0;  ///< of a leaf
  std::uint32_t color = 0;      ///< 5, 6, 5 bits, red highest
};

struct EncodedNode {
  std::array<std::uint32_t, 4> words{};
};
static_assert(sizeof(EncodedNode) == 16);

/// Rounds to the grid; radius and cone must hold for the rounded values already, but are rounded up
/// themselves.
EncodedNode encode(const PointNode& node);
PointNode decode(const EncodedNode& node);

/// The centre of `node` as it will be decoded.
Vec3 rounded_to_grid(const Vec3& center);
/// The smallest encodable radius that is not less.
std::uint32_t encode_radius(double radius);
double decode_radius(std::uint32_t bits);
/// The normal as it will be decoded.
std::uint32_t encode_normal(const Vec3& unit);
Vec3 decode_normal(std::uint32_t bits);
/// The next larger step of the sine; kNoCone from a right angle on.
std::uint32_t encode_cone(double half_angle_sine, bool beyond_right_angle);
inline double decode_cone_sine(std::uint32_t cone) {
  return cone / 254.0;
}

std::uint32_t encode_color(const Rgba8& color);
Rgba8 decode_color(std::uint32_t color);

// ---- what culling needs, without the rest

inline Vec3 node_center(const EncodedNode& n) {
  constexpr std::uint32_t kMask = kLargestGridCoordinate;
  return {static_cast<double>(n.words[0] & kMask),
          static_cast<double>((n.words[0] >> 21 | n.words[1] << 11) & kMask),
          static_cast<double>(n.words[1] >> 10 & kMask)};
}
inline double node_radius(const EncodedNode& n) {
  return decode_radius(n.words[2] & 0xffff);
}
inline std::uint32_t node_cone(const EncodedNode& n) {
  return n.words[2] >> 16 & 0xff;
}
inline Vec3 node_normal(const EncodedNode& n) {
  return decode_normal(n.words[3] & 0x3fffff);
}
inline std::uint32_t node_triangles(const EncodedNode& n) {
  return (n.words[3] >> 22 & 3) + 1;
}

/// Principal curvatures of the surface that a node stands for, by how its children's normals differ: 0 in a
/// leaf.
struct NodeCurvature {
  double k1 = 0, k2 = 0;  ///< times the node's radius; |k1| >= |k2|, positive towards the normal
  double angle = 0;       ///< of k1's direction, from any_perpendicular(normal) counter-clockwise, 0 … π
};
/// k·r is at most 1 in size, with steps that are finer near 0; 8 bits each.
std::uint32_t encode_curvature(const NodeCurvature& curvature);
NodeCurvature decode_curvature(std::uint32_t bits);

}  // namespace dupin

#endif
