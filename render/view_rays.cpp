#include "view_rays.h"

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

ViewRays view_rays(const Camera& camera) {
  const CameraAxes axes = camera_axes(camera);
  ViewRays view;
  view.eye = camera.eye;
  view.right = axes.right;
  view.up = axes.up;
  view.forward = -axes.back;
  view.perspective = !camera.orthographic;
  view.width = camera.width;
  view.height = camera.height;
  const double half =
      camera.orthographic ? camera.ortho_height / 2 : std::tan(camera.fov_degrees * kPi / 360);
  view.sx = half * camera.width / camera.height;
  view.sy = -half;
  return view;
}

Result<ViewRays> view_rays(const std::array<double, 16>& v, const std::array<double, 16>& p, int width,
                           int height) {
  const Mat3 linear{{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {v[8], v[9], v[10]}};
  const Mat3 rows = transpose(linear);
  ViewRays view;
  view.scale = length(rows.x);
  if (!(view.scale > 0) || !(determinant(linear) > 0))
    return {StatusCode::invalid_argument,
            "the view matrix does not turn space into a right-handed view space"};
  view.right = rows.x / view.scale;
  view.up = rows.y / view.scale;
  view.forward = -(rows.z / view.scale);
  const double tolerance = 1e-6;
  if (std::abs(dot(view.right, view.up)) > tolerance || std::abs(dot(view.right, view.forward)) > tolerance ||
      std::abs(length(view.up) - 1) > tolerance || std::abs(length(view.forward) - 1) > tolerance)
    return {StatusCode::invalid_argument,
            "the view matrix does more than move, turn and scale alike in all directions"};
  view.eye = -(inverse(linear) * Vec3{v[12], v[13], v[14]});
  view.perspective = p[11] != 0;
  view.width = width;
  view.height = height;
  const double w = view.perspective ? -p[11] : p[15];
  if (!(w > 0) || p[0] == 0 || p[5] == 0 || p[1] != 0 || p[4] != 0 || (view.perspective && p[15] != 0))
    return {StatusCode::invalid_argument,
            "the projection is neither a frustum nor a box along the view axis"};
  // Perspective: ndc·depth·w = p0·x − p8·depth (depth = −z); parallel: ndc·w = p0·x + p12, x in the host's
  // units.
  const double unit = view.perspective ? 1 : view.scale;
  view.sx = w / p[0] / unit;
  view.sy = -w / p[5] / unit;
  view.ox = (view.perspective ? p[8] : -p[12]) / p[0] / unit;
  view.oy = (view.perspective ? p[9] : -p[13]) / p[5] / unit;
  return view;
}

ViewRays jittered(const ViewRays& view, double x_px, double y_px) {
  ViewRays result = view;
  result.ox += view.sx * 2 * x_px / view.width;
  result.oy += view.sy * 2 * y_px / view.height;
  return result;
}

ViewRays part_of(const ViewRays& view, const std::array<int, 4>& rectangle) {
  const auto [x, y, width, height] = rectangle;
  const double left = x, top = view.height - y - height;
  ViewRays part = view;
  // Pixel (c, r) of the part is pixel (left + c, top + r) of the whole.
  part.ox += view.sx * ((2 * left + width) / view.width - 1);
  part.oy += view.sy * ((2 * top + height) / view.height - 1);
  part.sx *= static_cast<double>(width) / view.width;
  part.sy *= static_cast<double>(height) / view.height;
  part.width = width;
  part.height = height;
  return part;
}

double pixel_size(const ViewRays& view, double depth) {
  const double size = std::max(std::abs(view.sx) * 2 / view.width, std::abs(view.sy) * 2 / view.height);
  return view.perspective ? size * depth : size;
}

}  // namespace dupin
