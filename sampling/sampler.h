// From exact faces to quadric DPs with clips and certified error bounds.
#ifndef DUPIN_SAMPLING_SAMPLER_H
#define DUPIN_SAMPLING_SAMPLER_H

#include <optional>

#include "../core/camera.h"
#include "../core/progress.h"
#include "../core/status.h"
#include "../nurbs/model.h"
#include "quadric_dp.h"

namespace dupin {

struct SamplingOptions {
  /// Largest distance between a drawn point and the surface, in model units; what holds when there is no
  /// camera.
  double tolerance = 0;
  /// With a camera, the tolerance of a cell is `tolerance_px` pixels at the cell's nearest visible point, and
  /// cells that are out of the picture are not refined. With a camera and a `tolerance` above 0 both hold.
  std::optional<Camera> camera;
  double tolerance_px = 0.5;
  /// Largest angle between a drawn and the true normal, in radians.
  double normal_tolerance = 0.25 * 3.14159265358979323846 / 180;
  Progress progress;
};

/// Every face of every part, in parallel over faces; the result does not depend on the number of threads.
/// Faces for which no DP could be made are listed in their PartDps::skipped with the reason.
Result<DpScene> sample_quadric_dps(const Model& model, const SamplingOptions& options);

}  // namespace dupin

#endif
