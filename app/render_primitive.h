// The kinds of `dupin render --primitive`: how each turns a model into what a scene is drawn from.
#ifndef DUPIN_APP_RENDER_PRIMITIVE_H
#define DUPIN_APP_RENDER_PRIMITIVE_H

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../render/renderer.h"
#include "load.h"
#include "render_options.h"
#include "render_stats.h"

namespace dupin::app {

/// What a kind is prepared from.
struct PrimitiveInput {
  const Model& model;
  const Camera& camera;
  const RenderOptions& options;
  Progress progress;
};

class RenderPrimitive {
 public:
  virtual ~RenderPrimitive() = default;
  /// What the statistics call it.
  virtual std::string kind() const = 0;
  /// Reads the files. The reader's meshes are wanted where `deflection`, a part of the diagonal, is not 0.
  virtual Result<Loaded> load(Session& session, const RenderOptions& options) {
    return app::load(session, options.files, {deflection(options)});
  }
  virtual double deflection(const RenderOptions&) const { return 0; }
  /// Makes what is drawn; fills in the statistics' faces, prepare time and error.
  virtual Status prepare(const PrimitiveInput& input, RenderStats& stats) = 0;
  /// What `prepare` made; valid while this lives.
  virtual SceneContent content() const = 0;
  /// Called once everything has been drawn: what only the frames know.
  virtual void report_drawn(RenderStats&) const {}
};

/// One kind, and the names that it goes by.
struct PrimitiveKind {
  std::vector<std::string_view> names;
  std::unique_ptr<RenderPrimitive> (*make)(const RenderOptions& options);
};
const std::vector<PrimitiveKind>& primitive_kinds();

/// Null for an unknown name.
std::unique_ptr<RenderPrimitive> make_primitive(const RenderOptions& options);

std::unique_ptr<RenderPrimitive> make_quadric_primitive(const RenderOptions& options);
std::unique_ptr<RenderPrimitive> make_trees_primitive(const RenderOptions& options);
std::unique_ptr<RenderPrimitive> make_triangles_primitive(const RenderOptions& options);
std::unique_ptr<RenderPrimitive> make_amg_primitive(const RenderOptions& options);
std::unique_ptr<RenderPrimitive> make_points_primitive(const RenderOptions& options);

}  // namespace dupin::app

#endif
