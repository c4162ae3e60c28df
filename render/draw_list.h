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

struct TriangleRun {
  std::uint32_t instance, first_triangle, triangles, first_primitive;
};

/// The kinds of DPs, each with a program of its own, in drawing order.
enum DpKind { kPlanarWhole, kPlanarPieces, kCurvedWhole, kCurvedPieces, kDpKinds };

struct DrawList {
  std::vector<InstanceTexels> instances;
  std::vector<DrawItem> items;  ///< all of a kind together
  std::array<std::uint32_t, kDpKinds> count{};
  std::vector<TriangleRun> runs;
  std::uint32_t primitives() const;
  double start_depth = 0;                ///< rays start here: in front of everything, and not behind the eye
  double near_depth = 0, far_depth = 0;  ///< everything drawn lies between
};

/// Resets `list` and fills it; keeps its memory.
void build_draw_list(const Scene::Impl& scene, const ViewRays& view, DrawList& list);

}  // namespace dupin

#endif
