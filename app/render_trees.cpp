// --primitive pop and qsplat: trees of points over triangles, or over vertices.
#include <optional>

#include "point_trees.h"
#include "render_primitive.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

class TreesPrimitive : public RenderPrimitive {
 public:
  explicit TreesPrimitive(PointTreeKind kind) : kind_(kind) {}
  std::string kind() const override { return kind_ == PointTreeKind::pop ? "pop" : "qsplat"; }
  /// Exact faces are tessellated for it.
  double deflection(const RenderOptions& options) const override { return options.deflection; }
  SceneContent content() const override { return {nullptr, {layers_->layer()}}; }

  Result<Loaded> load(Session& session, const RenderOptions& options) override {
    Result<Loaded> loaded =
        app::load(session, options.files, {deflection(options), true, kind_, options.tree_folder});
    if (loaded.ok()) known_ = {std::move(loaded->trees), std::move(loaded->tree_files)};
    return loaded;
  }

  Status prepare(const PrimitiveInput& input, RenderStats& stats) override {
    Stopwatch watch;
    auto trees = make_point_trees(input.model, known_, {kind_, true, input.progress});
    if (!trees.ok()) return trees.status();
    layers_.emplace(std::move(*trees), input.options.trees);
    stats.times.prepare = watch.lap() + input.model.mesh_seconds;
    stats.faces = report_faces_of_triangles(input.model);
    return {};
  }
  void report_drawn(RenderStats& stats) const override { stats.points = layers_->stats(); }

 private:
  PointTreeKind kind_;
  KnownTrees known_;
  std::optional<TreeLayers> layers_;
};

}  // namespace

std::unique_ptr<RenderPrimitive> make_trees_primitive(const RenderOptions& options) {
  return std::make_unique<TreesPrimitive>(options.primitive == "qsplat" ? PointTreeKind::qsplat
                                                                        : PointTreeKind::pop);
}

}  // namespace dupin::app
