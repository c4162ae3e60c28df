#include "view.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <iterator>

#include "../render/view.h"

namespace dupin::app {
namespace {

Vec3 to_vec(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
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
      ->check(CLI::IsMember(std::vector<std::string>(std::begin(kViewNames), std::end(kViewNames))))
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
  Camera settings;
  settings.fov_degrees = options.fov_degrees;
  settings.orthographic = options.orthographic;
  settings.width = options.resolution[0];
  settings.height = options.resolution[1];
  const Box3 box = bounding_box(model);
  const Result<Camera> fitted = fit_view(box, options.view, settings);
  if (!fitted.ok()) return fitted.status();

  Camera camera = *fitted;
  const Vec3 from_target = camera.eye - camera.target;
  if (!options.eye.empty()) {
    camera.eye = to_vec(options.eye);
    camera.target = box.empty() ? Vec3{} : box.center();
    camera.up = {0, 0, 1};  // an explicit eye turns away from the standard view
  }
  if (!options.target.empty()) {
    camera.target = to_vec(options.target);
    if (options.eye.empty()) camera.eye = camera.target + from_target;
  }
  if (!options.up.empty()) camera.up = to_vec(options.up);
  if (options.height > 0) camera.ortho_height = options.height;
  if (camera.eye == camera.target)
    return {StatusCode::invalid_argument, "--eye and --target are the same point"};
  return camera;
}

}  // namespace dupin::app
