// --primitive quadric, and auto: quadric DPs within the tolerances.
#include "../sampling/sampler.h"
#include "render_primitive.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;

class QuadricPrimitive : public RenderPrimitive {
 public:
  std::string kind() const override { return "quadric"; }
  SceneContent content() const override { return {&dps_, {}}; }
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
    stats.times.prepare = watch.lap();
    stats.faces = report_faces(input.model, dps_);
    stats.error = certified_error(dps_);
    return {};
  }

 private:
  DpScene dps_;
};

}  // namespace

std::unique_ptr<RenderPrimitive> make_quadric_primitive(const RenderOptions&) {
  return std::make_unique<QuadricPrimitive>();
}

}  // namespace dupin::app
