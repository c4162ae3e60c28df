// --primitive triangles: the reader's meshes.
#include "render_primitive.h"

namespace dupin::app {
namespace {

class TrianglesPrimitive : public RenderPrimitive {
 public:
  std::string kind() const override { return "triangles"; }
  double deflection(const RenderOptions& options) const override { return options.deflection; }
  SceneContent content() const override { return {}; }
  Status prepare(const PrimitiveInput& input, RenderStats& stats) override {
    stats.times.prepare = input.model.mesh_seconds;
    stats.faces = report_faces_of_triangles(input.model);
    return {};
  }
};

}  // namespace

std::unique_ptr<RenderPrimitive> make_triangles_primitive(const RenderOptions&) {
  return std::make_unique<TrianglesPrimitive>();
}

}  // namespace dupin::app
