// What is true of a whole part: which edges are smooth, whether it is closed, how large it is.
#ifndef DUPIN_CAD_IMPORT_READER_PART_CHECKS_H
#define DUPIN_CAD_IMPORT_READER_PART_CHECKS_H

#include "../../nurbs/model.h"

namespace dupin::reader {

/// Faces that meet at less than this have a common tangent plane.
inline constexpr double kSmoothDegrees = 0.5;

/// Sets Edge::smooth from the faces' normals along each edge.
void mark_smooth_edges(Part& part);

/// Every edge bounds faces from both sides alike.
bool is_watertight(const Part& part);

/// The volume that the faces enclose, positive if their normals point outward, and the area's scale that says
/// whether its sign is certain.
struct Volume {
  double signed_volume = 0;
  double scale = 0;  ///< the sum of the faces' absolute contributions
};
/// Of the faces in `faces`.
Volume enclosed_volume(const Part& part, const std::vector<std::uint32_t>& faces);

/// Sets Part::closed: watertight, and every shell of it turned the right way (outer shells outward, voids
/// inward).
void mark_closed(Part& part);

void set_part_box(Part& part);

}  // namespace dupin::reader

#endif
