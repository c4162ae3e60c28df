// A camera in the space of a placed part, for choosing on the CPU what a frame draws.
#ifndef DUPIN_RENDER_PART_CAMERA_H
#define DUPIN_RENDER_PART_CAMERA_H

#include <array>

#include "scene.h"
#include "view_rays.h"

namespace dupin {

/// n·p + d
struct Plane3 {
  Vec3 n;
  double d;
};

/// The picture's four sides as planes in model space, inside positive, normals unit.
std::array<Plane3, 4> side_planes(const ViewRays& view);

/// In the part's space relative to its anchor.
struct PartCamera {
  std::array<Plane3, 4> sides;
  Plane3 depth;                ///< its value is the depth
  std::array<Plane3, 2> rows;  ///< their values are clip coordinates X and Y
  Vec3 eye;                    ///< or, in parallel, the direction towards the viewer
  bool perspective;
  bool cull_turned_away;
};

/// Whether nothing of a box (in the part's space, not relative to the anchor) can be in the picture.
bool out_of_view(const PartCamera& camera, const Box3& box, const Vec3& anchor);

/// `sides`: side_planes(view), which all placements share.
PartCamera part_camera(const SceneInstance& instance, const ScenePart& part, const ViewRays& view,
                       const std::array<Plane3, 4>& sides);

}  // namespace dupin

#endif
