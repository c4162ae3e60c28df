#include "point_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "stopwatch.h"

namespace dupin::app {

Status PointOptions::check() const {
  const auto bad = [](const char* why) { return Status{StatusCode::invalid_argument, why}; };
  if (!method.empty() && method != "uniform" && (grid != 0 || spacing != 0))
    return bad("--grid and --spacing go with --method uniform");
  if (grid != 0 && spacing != 0) return bad("--grid and --spacing exclude each other");
  if (method != "adaptive" && border != 0) return bad("--border goes with --method adaptive");
  if (method != "certified" && tolerance != 0)
    return bad("--tolerance goes with --method certified; others have --epsilon and --delta");
  return {};
}

PointSamplingOptions PointOptions::sampling(const Model& model) const {
  const double diagonal = bounding_box(model).diagonal();
  PointSamplingOptions result;
  const auto* name = std::find(std::begin(kPointMethodNames), std::end(kPointMethodNames), method);
  if (!method.empty()) result.method = static_cast<PointMethod>(name - std::begin(kPointMethodNames));
  result.grid = grid;
  result.spacing = spacing;
  result.epsilon = epsilon;
  result.delta = delta > 0 ? delta : kDefaultDelta * diagonal;
  if (mesh_curvature == "taubin") result.mesh.curvature = MeshCurvature::taubin;
  result.mesh.delta = delta;
  result.border = border;
  result.tolerance = tolerance > 0 ? tolerance : kDefaultPointTolerance * diagonal;
  return result;
}

PruneOptions PointOptions::pruning() const {
  return simplification == "published" ? papers_prune_options() : PruneOptions{};
}

void add_point_options(CLI::App& command, PointOptions& options, bool tolerance) {
  const char* group = "Differential points";
  const CLI::Range positive(1e-300, 1e300);
  command
      .add_option("--method", options.method,
                  "uniform: equal steps in each patch's parameters; adaptive: as dense as the curvature "
                  "asks; certified: the "
                  "quadric DPs' own")
      ->check(CLI::IsMember({"uniform", "adaptive", "certified"}))
      ->group(group);
  command
      .add_option("--grid", options.grid,
                  "Uniform: N × N samples a patch (default: as many as the rectangles' sizes ask)")
      ->check(CLI::Range(2, 100000))
      ->type_name("N")
      ->group(group);
  command
      .add_option("--spacing", options.spacing,
                  "Uniform: the largest distance between samples, in model units")
      ->check(positive)
      ->type_name("S")
      ->group(group);
  command
      .add_option("--epsilon", options.epsilon,
                  "Largest deviation of the osculating circles, as a part of their radius")
      ->check(CLI::Range(1e-12, 1.0))
      ->type_name("E")
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--delta", options.delta,
                  "Largest half-width of a rectangle, in model units (default: 2 % of the diagonal; for "
                  "meshes as far as edges ask)")
      ->check(positive)
      ->type_name("D")
      ->group(group);
  command
      .add_option("--border", options.border,
                  "Adaptive: how far rectangles may stand out over a face's borders (default: δ / 8; where "
                  "the method "
                  "is not given either, in pictures a pixel)")
      ->check(positive)
      ->type_name("B")
      ->group(group);
  if (tolerance)
    command
        .add_option("--tolerance", options.tolerance,
                    "Certified: the largest distance from the surface, in model units (default: 1e-4 of the "
                    "diagonal)")
        ->check(positive)
        ->type_name("T")
        ->group(group);
  command
      .add_option(
          "--mesh-curvature", options.mesh_curvature,
          "At vertices of meshes: fitted to the edges' normal curvatures, or by Taubin's tensor as published")
      ->check(CLI::IsMember({"fitted", "taubin"}))
      ->capture_default_str()
      ->group(group);
  command.add_flag("--simplify", options.simplify, "Leave out points whose neighbours cover what they do")
      ->group(group);
  command
      .add_option("--simplification", options.simplification,
                  "exact: by polygon clipping and across patches; published: as Kalaiah and Varshney have it")
      ->check(CLI::IsMember({"exact", "published"}))
      ->capture_default_str()
      ->group(group);
}

Result<MadePoints> make_points(const Model& model, const PointSamplingOptions& sampling,
                               const PointOptions& options) {
  Stopwatch watch;
  MadePoints made;
  Result<PointScene> scene = sample_points(model, sampling);
  if (!scene.ok()) return scene.status();
  made.scene = std::move(*scene);
  made.before = made.scene.count();
  made.sample_seconds = watch.lap();
  if (!options.simplify) return made;
  PruneOptions pruning = options.pruning();
  pruning.progress = sampling.progress;
  const Status status = prune(made.scene, pruning);
  if (!status.ok()) return status;
  made.simplify_seconds = watch.lap();
  return made;
}

}  // namespace dupin::app
