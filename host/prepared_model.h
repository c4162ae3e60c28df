// A model with all that takes time before it can be drawn, and that needs no OpenGL context: its differential
// points, and the point trees of its meshes.
//
// Immutable once made, so that any number of threads, contexts and scenes may share one.
#ifndef DUPIN_HOST_PREPARED_MODEL_H
#define DUPIN_HOST_PREPARED_MODEL_H

#include <memory>
#include <optional>
#include <vector>

#include "../core/camera.h"
#include "../core/progress.h"
#include "../core/status.h"
#include "../nurbs/model.h"
#include "../render/tree_layer.h"
#include "../sampling/quadric_dp.h"

namespace dupin {

/// What a host gets that asks for nothing: half a pixel of a picture that shows the whole model 2,000 pixels
/// wide.
inline constexpr double kDefaultTolerance = 2.5e-4;  ///< of the diagonal of the model's box

struct PrepareOptions {
  /// Largest distance between what is drawn and the surface, model units; 0: kDefaultTolerance.
  double tolerance = 0;
  double normal_tolerance = 0.25 * 3.14159265358979323846 / 180;  ///< radians
  /// With a camera, what it sees is finer where `tolerance_px` pixels are less than `tolerance`.
  std::optional<Camera> camera;
  double tolerance_px = 0.5;
  /// Called from any thread; returning false ends the work with StatusCode::cancelled.
  Progress progress;
};

struct PreparedModel {
  std::shared_ptr<const Model> model;
  DpScene dps;
  std::vector<PartTree> trees;  ///< one a part; null where it has no polygons
  double tolerance = 0;         ///< that was asked for, or the default in model units
};

/// Uses every core (see core/parallel.h); the result does not depend on how many.
Result<std::shared_ptr<const PreparedModel>> prepare(std::shared_ptr<const Model> model,
                                                     const PrepareOptions& options = {});

/// Several as one, in order: parts, instances and what is left out come one after the other.
PreparedModel joined(const std::vector<std::shared_ptr<const PreparedModel>>& models);

}  // namespace dupin

#endif
