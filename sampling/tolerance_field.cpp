#include "tolerance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dupin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Nothing nearer than this part of the whole model's size is resolved any finer: a camera inside a wall
/// would ask for ever more.
constexpr double kLeastDepth = 1e-7;
/// The picture's border grows by this much, so that what just touches it is there.
constexpr double kFrustumMargin = 1.02;

double largest_stretch(const Mat3& m) {
  // The Frobenius norm bounds it; for a rotation with scale s it is s·√3, so divide where all columns are
  // equally long.
  const double x = length(m.x), y = length(m.y), z = length(m.z);
  const double most = std::max({x, y, z}), least = std::min({x, y, z});
  return most - least <= 1e-9 * most ? most : std::hypot(x, y, z);
}

}  // namespace

ToleranceField::ToleranceField(const SamplingOptions& options, const Model& model, std::uint32_t part)
    : fixed_(options.tolerance),
      tolerance_px_(options.tolerance_px),
      has_camera_(options.camera.has_value()) {
  if (!has_camera_) return;
  camera_ = *options.camera;
  const CameraAxes axes = camera_axes(camera_);
  right_ = axes.right, up_ = axes.up, forward_ = -axes.back;
  const double aspect = static_cast<double>(camera_.width) / camera_.height;
  tan_y_ = std::tan(camera_.fov_degrees * 3.14159265358979323846 / 360) * kFrustumMargin;
  tan_x_ = tan_y_ * aspect;
  // Off the axis an error towards the eye also moves sideways: by at most this factor more.
  obliqueness_ = camera_.orthographic ? 1 : std::sqrt(1 + tan_x_ * tan_x_ + tan_y_ * tan_y_);
  least_depth_ = bounding_box(model).diagonal() * kLeastDepth;
  for (const Instance& instance : model.instances)
    if (instance.part == part)
      views_.push_back({instance.to_world, largest_stretch(instance.to_world.linear)});
}

double ToleranceField::pixel_in_part(const View& view, const Box3& box) const {
  const Vec3 center = transform_point(view.to_world, box.center()) - camera_.eye;
  const double radius = box.diagonal() / 2 * view.scale;
  const double depth = dot(center, forward_), x = dot(center, right_), y = dot(center, up_);
  if (camera_.orthographic) {
    const double half_y = camera_.ortho_height / 2 * kFrustumMargin,
                 half_x = half_y * camera_.width / camera_.height;
    if (std::abs(x) > half_x + radius || std::abs(y) > half_y + radius) return kInfinity;
    return pixel_size(camera_, 1) / view.scale;
  }
  if (depth < -radius) return kInfinity;
  const double norm_x = std::sqrt(1 + tan_x_ * tan_x_), norm_y = std::sqrt(1 + tan_y_ * tan_y_);
  if ((std::abs(x) - depth * tan_x_) / norm_x > radius || (std::abs(y) - depth * tan_y_) / norm_y > radius)
    return kInfinity;
  return pixel_size(camera_, std::max(depth - radius, least_depth_)) / (view.scale * obliqueness_);
}

double ToleranceField::finest_pixel(const Box3& box) const {
  double least = kInfinity;
  for (const View& view : views_) least = std::min(least, pixel_in_part(view, box));
  return least;
}

double ToleranceField::at(const Box3& box) const {
  if (!has_camera_) return fixed_;
  const double seen = tolerance_px_ * finest_pixel(box);
  return fixed_ > 0 ? std::min(fixed_, seen) : seen;
}

}  // namespace dupin
