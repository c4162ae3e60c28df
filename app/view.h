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
  double height = 0;                    ///< 0: fitted
  std::vector<int> resolution{1024, 1024};
};

void add_view_options(CLI::App& command, ViewOptions& options);

/// Of the picture's width and height, the part that a fitted model fills at most.
inline constexpr double kFittedPart = 0.9;

/// What was not given explicitly is fitted: the target is the middle of the model's box, the eye lies where the standard view
/// has it, so far off (or a parallel picture so high) that every instance's box fills at most kFittedPart of the picture.
Result<Camera> make_camera(const ViewOptions& options, const Model& model);

}  // namespace dupin::app

#endif
