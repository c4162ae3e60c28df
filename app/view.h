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

/// What is not given is the standard view's, fitted to the model's box. A target without an eye is looked at
/// from the same side and as far off; an eye without a target looks at the middle of the box, Z up.
Result<Camera> make_camera(const ViewOptions& options, const Model& model);

}  // namespace dupin::app

#endif
