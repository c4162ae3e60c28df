// What one frame draws: every placement's camera in the part's own space, and the DPs that may be seen,
// nearest first.
#ifndef DUPIN_RENDER_DRAW_LIST_H
#define DUPIN_RENDER_DRAW_LIST_H

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene.h"
#include "view_rays.h"

namespace dupin {

/// A camera in the space of a placed part, relative to its anchor: texels of shaders/common.glsl's
/// `instances`. S comes in two floats, so that no digit is lost far from the origin.
using InstanceTexels = std::array<std::array<float, 4>, 10>;

/// One entry of the list: shaders/prepare.vert's input. Its place is its slot.
struct DrawItem {
  std::uint32_t record, instance, primitive,
      color;  ///< instance: with kFromBehindItem if its inner side is seen
};
inline constexpr std::uint32_t kFromBehindItem = 0x80000000U;

struct TriangleRun {
  std::uint32_t instance, first_triangle, triangles, first_primitive;
  std::uint32_t first_face, color;  ///< color: of all of them, unless own_colors
  bool own_colors, hidden_faces;
};

/// What a DP's proxy and region are made of; each combination has a program of its own, so that the usual
/// ones are the fastest.
constexpr std::uint32_t kCurvedKind = 1, kPlanesKind = 2, kLinesKind = 4, kArcsKind = 8, kEllipsesKind = 16;
constexpr std::uint32_t kPrismKind = 32;  ///< curved: too near to the eye for a proxy in the picture's plane
constexpr std::uint32_t kOneRootKind = 64;  ///< curved: only its outer, or only its inner, side can be seen
constexpr std::uint32_t kFeaturesKind = 1024;  ///< curved: has feature edges
constexpr std::uint32_t kInsideKind = 2048;    ///< planar: rectangles that need no test
/// Bounded by no more than so many lines and arcs and nothing else: they go with the proxy. 1 + index in
/// kFlatPieces.
constexpr std::uint32_t kFlatShift = 7, kFlatKind = 7u << kFlatShift;
struct FlatPieces {
  std::uint32_t lines, arcs;
};
inline constexpr FlatPieces kFlatPieces[] = {{0, 1}, {0, 2}, {0, 4}, {2, 0}, {4, 2}, {4, 4}};
/// The outputs of a vertex shader that they need, in components; OpenGL 3.3 promises fewer.
inline constexpr int kFlatComponents = 128;

/// Consecutive slots of one kind; or, of planar DPs with pieces, rectangles of one kind from a texel of
/// `rectangles` on.
struct DrawGroup {
  std::uint32_t kind = 0, first = 0, count = 0;
  bool curved() const { return kind & kCurvedKind; }
  bool by_rectangles() const { return !curved() && kind != 0; }
};
/// The texels of one rectangle of that kind (RGBA32UI):  x lo, y lo, x hi, y hi | slot, lines | arcs << 8 |
/// feature lines << 16 | feature arcs << 24, reference | lines | arcs,  with as many of the latter as the
/// kind has room for, relative to the reference. Bit 31 of the slot: reference_inside.
std::uint32_t rectangle_texels(std::uint32_t kind);

/// Rows of the picture that share one horizontal extent of what is seen in them.
inline constexpr int kBandRows = 64;

struct DrawList {
  std::vector<InstanceTexels> instances;
  std::vector<DrawItem> items;
  std::vector<DrawGroup> groups;  ///< planar ones first
  std::vector<Texel> rectangles;
  std::vector<TriangleRun> runs;
  /// For each band of kBandRows rows from the top the columns [first, last) outside of which nothing is
  /// drawn.
  std::vector<std::array<int, 2>> bands;
  double start_depth = 0;                ///< rays start here: in front of everything, and not behind the eye
  double near_depth = 0, far_depth = 0;  ///< everything drawn lies between
  /// The depth buffer holds x + y·depth + z/depth: 1 at the nearest depth, and less farther away, as floats
  /// are densest near 0, where perspective squeezes depths together. An empty pixel has 0.
  std::array<double, 3> depth_terms{};
  double bound_px = 0;            ///< largest of the DPs' bounds
  double farthest_in_buffer = 0;  ///< the least that anything drawn has there

  /// Between an empty pixel's value and that of anything drawn.
  float covered_depth() const { return static_cast<float>(0.5 * farthest_in_buffer); }
  std::uint32_t primitives() const;
};

/// Resets `list` and fills it; keeps its memory.
/// Without `flats` no kind is one of kFlatPieces.
void build_draw_list(const Scene::Impl& scene, const ViewRays& view,
                     std::span<const DrawOptions::Section> sections, bool flats, DrawList& list);

}  // namespace dupin

#endif
