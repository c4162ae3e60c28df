#include "view.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace dupin::app {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct StandardView {
  const char* name;
  Vec3 from, up;  ///< the direction from the model to the eye
};
// Z is up; the front is seen along +Y, as CAD systems have it.
constexpr std::array<StandardView, 7> kViews{{{"iso", {1, -1, 1}, {0, 0, 1}},
                                              {"front", {0, -1, 0}, {0, 0, 1}},
                                              {"back", {0, 1, 0}, {0, 0, 1}},
                                              {"left", {-1, 0, 0}, {0, 0, 1}},
                                              {"right", {1, 0, 0}, {0, 0, 1}},
                                              {"top", {0, 0, 1}, {0, 1, 0}},
                                              {"bottom", {0, 0, -1}, {0, -1, 0}}}};

std::vector<std::string> view_names() {
  std::vector<std::string> names;
  for (const StandardView& view : kViews) names.emplace_back(view.name);
  return names;
}

const StandardView& find_view(const std::string& name) {
  for (const StandardView& view : kViews)
    if (name == view.name) return view;
  return kViews.front();
}

Vec3 to_vec(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

std::vector<Vec3> instance_corners(const Model& model) {
  std::vector<Vec3> corners;
  for (const Instance& instance : model.instances) {
    const Box3& box = model.parts[instance.part].box;
    if (box.empty()) continue;
    for (int i = 0; i < 8; ++i) corners.push_back(transform_point(instance.to_world, box.corner(i)));
  }
  return corners;
}

/// The tangents of half the angles of view that the model may fill, horizontally and vertically.
std::pair<double, double> usable_tangents(const Camera& camera) {
  const double vertical = std::tan(camera.fov_degrees * kPi / 360) * kFittedPart;
  return {vertical * camera.width / camera.height, vertical};
}

/// Where the eye has to be along an axis of the picture, and how far back at least, for every corner to be
/// seen: a corner at (x, z) is where |x − eye| <= tan · (eye_z − z), which is x + tan·z <= eye + tan·eye_z
/// and x − tan·z >= eye − tan·eye_z.
struct AxisFit {
  double eye, eye_z;
};
AxisFit fit_axis(const std::vector<Vec3>& corners, const Vec3& origin, const Vec3& axis, const Vec3& back,
                 double tangent) {
  double hi = -std::numeric_limits<double>::infinity(), lo = -hi;
  for (const Vec3& corner : corners) {
    const Vec3 d = corner - origin;
    hi = std::max(hi, dot(d, axis) + tangent * dot(d, back));
    lo = std::min(lo, dot(d, axis) - tangent * dot(d, back));
  }
  return {(hi + lo) / 2, (hi - lo) / 2 / tangent};
}

/// The nearest eye that sees every corner, looking along −back; with a fixed target, the nearest on the line
/// through it.
Vec3 fitted_eye(const Camera& camera, const CameraAxes& axes, const std::vector<Vec3>& corners,
                bool fixed_target) {
  const auto [tan_x, tan_y] = usable_tangents(camera);
  if (!fixed_target) {
    const AxisFit x = fit_axis(corners, camera.target, axes.right, axes.back, tan_x);
    const AxisFit y = fit_axis(corners, camera.target, axes.up, axes.back, tan_y);
    return camera.target + axes.right * x.eye + axes.up * y.eye + axes.back * std::max(x.eye_z, y.eye_z);
  }
  double distance = 0;
  for (const Vec3& corner : corners) {
    const Vec3 d = corner - camera.target;
    const double z = dot(d, axes.back);
    distance =
        std::max({distance, z + std::abs(dot(d, axes.right)) / tan_x, z + std::abs(dot(d, axes.up)) / tan_y});
  }
  return camera.target + axes.back * distance;
}

double fitted_height(const Camera& camera, const CameraAxes& axes, const std::vector<Vec3>& corners) {
  double half = 0;
  for (const Vec3& corner : corners) {
    const Vec3 d = corner - camera.target;
    half = std::max(
        {half, std::abs(dot(d, axes.up)), std::abs(dot(d, axes.right)) * camera.height / camera.width});
  }
  return 2 * half / kFittedPart;
}

Status check_options(const ViewOptions& options) {
  const auto bad = [](const char* why) { return Status{StatusCode::invalid_argument, why}; };
  if (options.height > 0 && !options.orthographic) return bad("--height goes with --orthographic");
  for (const auto* v : {&options.eye, &options.target, &options.up})
    for (double x : *v)
      if (!std::isfinite(x)) return bad("a camera's coordinates must be finite numbers");
  if (!options.up.empty() && length(to_vec(options.up)) == 0) return bad("--up-vector must not be zero");
  return {};
}

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& options) {
  const char* group = "Camera";
  command.add_option("--view", options.view, "Standard view, fitted to the model")
      ->check(CLI::IsMember(view_names()))
      ->capture_default_str()
      ->group(group);
  const auto vector = [&](const char* name, std::vector<double>& to, const char* text) {
    command.add_option(name, to, text)->delimiter(',')->expected(3)->type_name("X,Y,Z")->group(group);
  };
  vector("--eye", options.eye, "Where the camera is");
  vector("--target", options.target, "What it looks at (default: the middle of the model)");
  vector("--up-vector", options.up, "What is up in the picture (default: the view's)");
  command.add_option("--fov", options.fov_degrees, "Vertical angle of view")
      ->check(CLI::Range(1e-6, 179.0))
      ->type_name("DEG")
      ->capture_default_str()
      ->group(group);
  command.add_flag("--orthographic", options.orthographic, "Parallel projection")->group(group);
  command
      .add_option("--height", options.height,
                  "Parallel projection: model units from bottom to top (default: fitted)")
      ->check(CLI::PositiveNumber)
      ->type_name("H")
      ->group(group);
  command.add_option("--resolution", options.resolution, "Size of the picture in pixels")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1, 16384))
      ->type_name("W,H")
      ->capture_default_str()
      ->group(group);
}

Result<Camera> make_camera(const ViewOptions& options, const Model& model) {
  if (const Status status = check_options(options); !status.ok()) return status;
  const StandardView& view = find_view(options.view);
  const Box3 box = bounding_box(model);
  const std::vector<Vec3> corners = instance_corners(model);

  Camera camera;
  camera.fov_degrees = options.fov_degrees;
  camera.orthographic = options.orthographic;
  camera.width = options.resolution[0];
  camera.height = options.resolution[1];
  camera.target = !options.target.empty() ? to_vec(options.target) : box.empty() ? Vec3{} : box.center();
  // An explicit eye turns away from the standard view, and Z is up unless said otherwise.
  camera.up = !options.up.empty() ? to_vec(options.up) : options.eye.empty() ? view.up : Vec3{0, 0, 1};
  camera.eye = options.eye.empty() ? camera.target + normalized(view.from) : to_vec(options.eye);
  if (camera.eye == camera.target)
    return {StatusCode::invalid_argument, "--eye and --target are the same point"};

  const CameraAxes axes = camera_axes(camera);
  // A model without extent in any direction is looked at from one unit away.
  const double extent = box.diagonal() > 0 ? box.diagonal() : 1;
  if (options.eye.empty() && camera.orthographic) {
    camera.eye = camera.target + axes.back * extent;  // a parallel picture does not depend on the distance
  } else if (options.eye.empty() && box.diagonal() > 0) {
    camera.eye = fitted_eye(camera, axes, corners, !options.target.empty());
    if (options.target.empty())
      camera.target = camera.eye - axes.back * dot(camera.eye - camera.target, axes.back);
  } else if (options.eye.empty()) {
    camera.eye = camera.target + axes.back * extent;
  }
  if (camera.orthographic) {
    const double fitted = fitted_height(camera, axes, corners);
    camera.ortho_height = options.height > 0 ? options.height : fitted > 0 ? fitted : extent;
  }
  return camera;
}

}  // namespace dupin::app
