// Cameras: the standard views, fitted to a model, and explicit ones.
#ifndef DUPIN_APP_VIEW_H
#define DUPIN_APP_VIEW_H

#include <optional>
#include <string>
#include <vector>

#include "../core/camera.h"
#include "../core/status.h"
#include "../nurbs/model.h"

namespace CLI {
class App;
}

namespace dupin::app {

struct ViewOptions {
  std::string view = "iso";
  std::vector<double> eye, target, up;  ///< empty or three numbers
  double fov_degrees = 30;
  bool orthographic = false;
  double height = 0;  ///< 0: fitted
  std::vector<int> resolution{1024, 1024};
};

void add_view_options(CLI::App& command, ViewOptions& options);

/// Of the picture's width and height, the part that a fitted model fills at most.
inline constexpr double kFittedPart = 0.9;

/// What was not given explicitly is fitted. Without an eye, the camera looks as the standard view does, from
/// as near (or in parallel projection as high) as lets every instance's box fill at most kFittedPart of the
/// picture; a target that is given stays in the middle. With an eye but no target it looks at the middle of
/// the model's box.
Result<Camera> make_camera(const ViewOptions& options, const Model& model);

}  // namespace dupin::app

#endif
