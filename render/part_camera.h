// A camera in the space of a placed part, for choosing on the CPU what a frame draws.
#ifndef DUPIN_RENDER_PART_CAMERA_H
#define DUPIN_RENDER_PART_CAMERA_H

#include <array>
#include <span>

#include "scene.h"
#include "view_rays.h"

namespace dupin {

/// n·p + d
struct Plane3 {
  Vec3 n;
  double d;
};

/// What bounds what can be seen: the picture's four sides and the sections. Inside is positive, normals are
/// unit.
struct SidePlanes {
  std::array<Plane3, 4 + kMostSections> planes;
  std::size_t count = 4;
  bool cut() const { return count > 4; }
  const Plane3* begin() const { return planes.data(); }
  const Plane3* end() const { return planes.data() + count; }
};

/// In model space.
SidePlanes side_planes(const ViewRays& view, std::span<const DrawOptions::Section> sections);

/// The section's value, in units of its normal's length, as a function of clip X, Y, the depth and 1.
std::array<double, 4> section_terms(const DrawOptions::Section& section, const ViewRays& view);

/// In the part's space relative to its anchor.
struct PartCamera {
  SidePlanes sides;
  Plane3 depth;                ///< its value is the depth
  std::array<Plane3, 2> rows;  ///< their values are clip coordinates X and Y
  Vec3 eye;                    ///< or, in parallel, the direction towards the viewer
  bool perspective;
  bool cull_turned_away;
  bool cut_solid;  ///< by a section: one looks into it where its inner side is seen
};

/// Whether nothing of a box (in the part's space, not relative to the anchor) can be in the picture.
bool out_of_view(const PartCamera& camera, const Box3& box, const Vec3& anchor);

/// `sides`: side_planes(view, …), which all placements share.
PartCamera part_camera(const SceneInstance& instance, const ScenePart& part, const ViewRays& view,
                       const SidePlanes& sides);

}  // namespace dupin

#endif
