// A pinhole or parallel camera in double precision, and how large a pixel is where.
//
// Pixel (0,0) is the top left; the ray of a pixel goes through its centre. The vertical field of view is
// gluPerspective's, the view gluLookAt's.
#ifndef DUPIN_CORE_CAMERA_H
#define DUPIN_CORE_CAMERA_H

#include "vec.h"

namespace dupin {

struct Camera {
  Vec3 eye{0, 0, 1}, target{0, 0, 0}, up{0, 0, 1};
  double fov_degrees = 30;  ///< vertical; perspective only
  bool orthographic = false;
  double ortho_height = 1;  ///< model units from the bottom of the picture to the top; orthographic only
  int width = 1024, height = 1024;
};

/// Right, up and backward (towards the viewer) axes; right-handed, unit. `up` parallel to the view is
/// replaced.
struct CameraAxes {
  Vec3 right, up, back;
};
inline CameraAxes camera_axes(const Camera& camera) {
  const Vec3 back = normalized(camera.eye - camera.target);
  Vec3 right = cross(camera.up, back);
  right = length(right) > 1e-12 * length(camera.up) ? normalized(right) : any_perpendicular(back);
  return {right, cross(back, right), back};
}

/// Depth along the view axis, positive in front of the eye.
inline double view_depth(const Camera& camera, const Vec3& p) {
  return -dot(p - camera.eye, camera_axes(camera).back);
}

/// The edge of a pixel, in model units, at a depth along the view axis.
inline double pixel_size(const Camera& camera, double depth) {
  const double height = camera.orthographic
                            ? camera.ortho_height
                            : 2 * depth * std::tan(camera.fov_degrees * 3.14159265358979323846 / 360);
  return height / camera.height;
}

}  // namespace dupin

#endif
