// How a picture's pixels become rays, for any camera or any pair of view and projection matrices, in double.
//
// Picture coordinates X, Y run over [-1, 1] with Y = -1 at the top row. At depth z along the view axis a
// pixel sees the point
//     (ox + sx·X, oy + sy·Y)·z  (perspective)   or   (ox + sx·X, oy + sy·Y)  (parallel)
// in the view's right and up directions.
#ifndef DUPIN_RENDER_VIEW_RAYS_H
#define DUPIN_RENDER_VIEW_RAYS_H

#include <array>

#include "../core/camera.h"
#include "../core/status.h"

namespace dupin {

struct ViewRays {
  Vec3 eye;
  Vec3 right, up, forward;  ///< unit, perpendicular
  bool perspective = true;
  double sx = 1, sy = -1;
  double ox = 0, oy = 0;
  int width = 0, height = 0;
  double scale = 1;  ///< the host's view-space length of one model unit

  double depth(const Vec3& p) const { return dot(p - eye, forward); }
};

ViewRays view_rays(const Camera& camera);

/// Column-major matrices as OpenGL has them, for a picture whose row 0 is the *bottom* of the host's viewport
/// flipped to our top. The view may move, turn and scale alike in all directions; the projection may be any
/// frustum or box, off-centre too.
Result<ViewRays> view_rays(const std::array<double, 16>& view, const std::array<double, 16>& projection,
                           int width, int height);

/// The same view with every sample moved by a part of a pixel (right, down).
ViewRays jittered(const ViewRays& view, double x_px, double y_px);

/// The part of the view that a rectangle (x, y, width, height) sees, in pixels from the lower left corner:
/// pixel for pixel the same rays.
ViewRays part_of(const ViewRays& view, const std::array<int, 4>& rectangle);

/// The edge of a pixel, in model units, at a depth; the larger of the two directions.
double pixel_size(const ViewRays& view, double depth);

}  // namespace dupin

#endif
