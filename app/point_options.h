// How faces become differential points: options that `dupin sample` and `dupin render` share.
#ifndef DUPIN_APP_POINT_OPTIONS_H
#define DUPIN_APP_POINT_OPTIONS_H

#include <string>

#include "../sampling/point_sampler.h"
#include "../simplify/prune.h"

namespace CLI {
class App;
}

namespace dupin::app {

struct PointOptions {
  std::string method;  ///< empty: uniform, or what the command chooses
  int grid = 0;
  double spacing = 0, epsilon = 0.012, delta = 0, border = 0;
  double tolerance = 0;
  std::string mesh_curvature = "fitted";
  bool simplify = false;
  std::string simplification = "exact";

  /// What is wrong with options that are fine each by itself.
  Status check() const;
  bool given() const {
    return !method.empty() || grid || spacing > 0 || epsilon != 0.012 || delta > 0 || border > 0 ||
           tolerance > 0 || simplify || mesh_curvature != "fitted";
  }
  /// Lengths that were not given follow from the model's diagonal.
  PointSamplingOptions sampling(const Model& model) const;
  PruneOptions pruning() const;
};

/// Of the diagonal: δ, and the tolerance of certified points.
inline constexpr double kDefaultDelta = 0.02, kDefaultPointTolerance = 1e-4;

/// `tolerance`: also --tolerance, in model units.
void add_point_options(CLI::App& command, PointOptions& options, bool tolerance);

/// Points of a model, and what it took.
struct MadePoints {
  PointScene scene;
  std::size_t before = 0;  ///< simplification
  double sample_seconds = 0, simplify_seconds = 0;
};
Result<MadePoints> make_points(const Model& model, const PointSamplingOptions& sampling,
                               const PointOptions& options);

}  // namespace dupin::app

#endif
