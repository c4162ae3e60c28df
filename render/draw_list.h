// What one frame draws: every placement's camera in the part's own space, and the DPs that may be seen,
// nearest first.
#ifndef DUPIN_RENDER_DRAW_LIST_H
#define DUPIN_RENDER_DRAW_LIST_H

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene.h"
#include "tiles.h"
#include "view_rays.h"

namespace dupin {

/// A camera in the space of a placed part, relative to its anchor: texels of shaders/common.glsl's
/// `instances`. S comes in two floats, so that no digit is lost far from the origin.
using InstanceTexels = std::array<std::array<float, 4>, 10>;

/// One entry of the list: shaders/prepare.vert's input. Its place is its slot.
struct DrawItem {
  std::uint32_t record, instance, primitive, color;
};

struct TriangleRun {
  std::uint32_t instance, first_triangle, triangles, first_primitive;
  std::uint32_t first_face, color;  ///< color: of all of them, unless own_colors
  bool own_colors, hidden_faces;
};

/// Tiles of one kind: `count` of them from texel `first` on.
struct DrawGroup {
  std::uint32_t kind = 0, first = 0, count = 0;
};

/// Rows of the picture that share one horizontal extent of what is seen in them.
inline constexpr int kBandRows = 64;

struct DrawList {
  std::vector<InstanceTexels> instances;
  std::vector<DrawItem> items;
  std::vector<DrawGroup> groups;  ///< planar ones first
  std::vector<Texel> tiles;       ///< see tiles.h
  std::uint32_t first_edge = 0;   ///< where in them the runs of edges begin
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
void build_draw_list(const Scene::Impl& scene, const ViewRays& view,
                     std::span<const DrawOptions::Section> sections, const TileOptions& options,
                     DrawList& list);

}  // namespace dupin

#endif
