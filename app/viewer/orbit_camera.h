// A camera that turns around a point, moves across the picture and zooms to what is under the pointer.
#ifndef DUPIN_APP_VIEWER_ORBIT_CAMERA_H
#define DUPIN_APP_VIEWER_ORBIT_CAMERA_H

#include <string_view>

#include "../../core/camera.h"
#include "../../render/renderer.h"

namespace dupin::app {

class OrbitCamera {
 public:
  void resize(int width, int height);
  /// What `fit` and the nearest and farthest depth are for.
  void set_box(const Box3& box) { box_ = box; }
  /// From a standard side (render/view.h), fitted to the box.
  void look_from(std::string_view name);
  /// The whole box, from where it is looked at now.
  void fit();
  void set_parallel(bool parallel) { parallel_ = parallel; }
  bool parallel() const { return parallel_; }

  // By pixels, to the right and down.
  /// About the vertical and the picture's horizontal; what is in front follows the pointer.
  void orbit(double dx, double dy);
  /// What is at the depth of the turning point follows the pointer.
  void pan(double dx, double dy);
  /// Larger by the factor; what is at the turning point's depth under the pixel stays there.
  void zoom(double factor, double x, double y);

  Camera camera() const;
  HostView view() const;
  const Vec3& center() const { return center_; }
  /// Of a pixel at the turning point, model units.
  double pixel() const;

 private:
  double tangent() const;
  void set_axes(const Vec3& back, const Vec3& up);

  Box3 box_;
  Vec3 center_;
  Vec3 right_{1, 0, 0}, up_{0, 0, 1}, back_{0, -1, 0};
  double distance_ = 10, fov_degrees_ = 30;
  bool parallel_ = false;
  int width_ = 1, height_ = 1;
};

}  // namespace dupin::app

#endif
