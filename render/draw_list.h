// What one frame draws: every placement's camera in the part's own space, and the DPs that may be seen,
// nearest first.
#ifndef DUPIN_RENDER_DRAW_LIST_H
#define DUPIN_RENDER_DRAW_LIST_H

#include <array>
#include <cstdint>
#include <vector>

#include "scene.h"
#include "view_rays.h"

namespace dupin {

/// A camera in the space of a placed part, relative to its anchor; texels of shaders/common.glsl's
/// `instances`. Points are S + hi and lo parts, so that no digit is lost far from the origin.
using InstanceTexels = std::array<std::array<float, 4>, 10>;

/// One entry of the list: shaders/prepare.vert's input.
struct DrawItem {
  std::uint32_t record, instance, primitive, color;
};

/// A rectangle of a planar DP's (x, y): two texels of planar.vert's `inner`.
struct InnerRectangle {
  std::array<float, 4> rectangle;  ///< x lo, y lo, x hi, y hi
  std::uint32_t slot = 0, unused[3] = {};
};

struct TriangleRun {
  std::uint32_t instance, first_triangle, triangles, first_primitive;
};

/// What a DP's proxy and region are made of; each combination has a program of its own, so that the usual ones are the fastest.
constexpr std::uint32_t kCurvedKind = 1, kPlanesKind = 2, kLinesKind = 4, kArcsKind = 8, kEllipsesKind = 16;
constexpr std::uint32_t kPrismKind = 32;      ///< curved: too near to the eye for a proxy in the picture's plane
constexpr std::uint32_t kFrontOnlyKind = 64;  ///< curved: only its outer side can be seen

constexpr std::uint32_t kFeaturesKind = 1024;  ///< curved: has feature edges
/// Curved, bounded by this many arcs that are no feature edges and nothing else, as most cells of free-form faces are: the arcs go with the proxy.
constexpr std::uint32_t kFlatArcsShift = 7, kFlatArcsKind = 7u << kFlatArcsShift, kMostFlatArcs = 4;

/// Consecutive items of one kind.
struct DrawGroup {
  std::uint32_t kind = 0, count = 0;
};

struct DrawList {
  std::vector<InstanceTexels> instances;
  std::vector<DrawItem> items;
  std::vector<DrawGroup> groups;  ///< planar ones first
  std::vector<InnerRectangle> inner;
  /// For each band of kBandRows rows from the top the columns [first, last) outside of which nothing is drawn.
  std::vector<std::array<int, 2>> bands;
  std::vector<TriangleRun> runs;
  std::uint32_t primitives() const;
  double start_depth = 0;                ///< rays start here: in front of everything, and not behind the eye
  double near_depth = 0, far_depth = 0;  ///< everything drawn lies between
  /// The depth buffer holds x + y·depth + z/depth: 1 at the nearest depth, and less farther away, as floats are densest near 0, where
  /// perspective squeezes depths together. An empty pixel has 0.
  std::array<double, 3> depth_terms{};
  double farthest_in_buffer = 0;  ///< the least that anything drawn has there
  /// Between an empty pixel's value and that of anything drawn.
  float covered_depth() const { return static_cast<float>(0.5 * farthest_in_buffer); }
};

/// Rows of the picture that share one horizontal extent of what is seen in them.
inline constexpr int kBandRows = 64;

/// Resets `list` and fills it; keeps its memory.
void build_draw_list(const Scene::Impl& scene, const ViewRays& view, DrawList& list);

}  // namespace dupin

#endif
