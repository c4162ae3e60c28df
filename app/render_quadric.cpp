// --primitive quadric, and auto: quadric DPs within the tolerances, and point trees of what the model has as
// meshes.
#include <algorithm>
#include <optional>

#include "../sampling/sampler.h"
#include "point_trees.h"
#include "render_primitive.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;

class QuadricPrimitive : public RenderPrimitive {
 public:
  std::string kind() const override { return "quadric"; }
  Result<Loaded> load(Session& session, const RenderOptions& options) override {
    Result<Loaded> loaded =
        app::load(session, options.files, {0, true, PointTreeKind::pop, options.tree_folder});
    if (loaded.ok()) known_ = {std::move(loaded->trees), std::move(loaded->tree_files)};
    return loaded;
  }
  SceneContent content() const override {
    SceneContent content{&dps_, {}};
    if (layers_) content.layers.push_back(layers_->layer());
    return content;
  }
  void report_drawn(RenderStats& stats) const override {
    if (layers_) stats.points = layers_->stats();
  }
  Status prepare(const PrimitiveInput& input, RenderStats& stats) override {
    Stopwatch watch;
    SamplingOptions sampling;
    sampling.camera = input.camera;
    sampling.tolerance_px = input.options.tolerance_px;
    sampling.normal_tolerance = input.options.normal_tolerance_degrees * kRadians;
    sampling.progress = input.progress;
    Result<DpScene> dps = sample_quadric_dps(input.model, sampling);
    if (!dps.ok()) return dps.status();
    dps_ = std::move(*dps);
    if (const Status status = prepare_meshes(input); !status.ok()) return status;
    stats.times.prepare = watch.lap();
    stats.faces = report_faces(input.model, dps_);
    stats.error = certified_error(dps_);
    return {};
  }

 private:
  Status prepare_meshes(const PrimitiveInput& input) {
    auto trees = make_point_trees(input.model, known_, {PointTreeKind::pop, false, input.progress});
    if (!trees.ok()) return trees.status();
    if (std::any_of(trees->begin(), trees->end(), [](const PartTree& t) { return t.tree != nullptr; }))
      layers_.emplace(std::move(*trees), input.options.trees);
    return {};
  }
  DpScene dps_;
  KnownTrees known_;
  std::optional<TreeLayers> layers_;
};

}  // namespace

std::unique_ptr<RenderPrimitive> make_quadric_primitive(const RenderOptions&) {
  return std::make_unique<QuadricPrimitive>();
}

}  // namespace dupin::app
