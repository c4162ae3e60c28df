#include "stage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "../../cad_import/cad_import.h"
#include "../../render/view.h"
#include "../../sampling/sampler.h"
#include "../../simplify/dp_codec.h"
#include "../../simplify/dps_file.h"
#include "../report.h"

namespace dupin::bench {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr std::size_t kSplatBytes = 32;

/// Of the file that holds the points packed.
std::size_t packed_size(const PointScene& scene) {
  const auto path =
      std::filesystem::temp_directory_path() / ("dupin-bench-" + std::to_string(::getpid()) + ".dps");
  auto writer = DpsWriter::create(path.string(), {DpsEncoding::packed, scene.epsilon, scene.delta});
  if (!writer.ok()) return 0;
  for (const PartPoints& part : scene.parts)
    if (!writer->add({}, part.points).ok()) return 0;
  const bool written = writer->finish().ok();
  const std::size_t bytes = writer->bytes();
  std::filesystem::remove(path);
  return written ? bytes : 0;
}

/// Counts pixels whose depth is far behind the reference's, and far before it.
void compare_depths(const Image& reference, const Image& drawn, Measured& measured) {
  const std::vector<float>&a = reference.find("Z")->values, &b = drawn.find("Z")->values;
  const int width = reference.width, height = reference.height;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  for (int y = kInteriorRadius; y < height - kInteriorRadius; ++y)
    for (int x = kInteriorRadius; x < width - kInteriorRadius; ++x) {
      const double z = a[at(x, y)],
                   limit = kHoleDepthPx * (reference.pixel_constant + reference.pixel_per_depth * z);
      // Beside a farther part of the surface another primitive may be right by half a pixel.
      double least = z, most = z;
      for (int dy = -kInteriorRadius; dy <= kInteriorRadius; ++dy)
        for (int dx = -kInteriorRadius; dx <= kInteriorRadius; ++dx) {
          const double near = a[at(x + dx, y + dy)];
          least = std::min(least, near);
          most = std::max(most, near);
        }
      if (!std::isfinite(most)) continue;
      measured.holes += !(b[at(x, y)] <= most + limit);
      measured.blocked += b[at(x, y)] < least - limit;
    }
}

}  // namespace

Clock Clock::now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

Result<std::unique_ptr<Stage>> Stage::open(const std::string& path, const std::string& view, int width,
                                           int height) {
  auto stage = std::make_unique<Stage>();
  auto model = import_cad(path, {});
  if (!model.ok()) return model.status();
  stage->model_ = std::move(*model);
  for (const Part& part : stage->model_.parts)
    stage->mesh_ = stage->mesh_ || part.polygons.polygon_count() > 0;
  Camera settings;
  settings.width = width;
  settings.height = height;
  const auto camera = fit_view(bounding_box(stage->model_), view, settings);
  if (!camera.ok()) return camera.status();
  stage->camera_ = *camera;
  auto context = create_context(Device::automatic);
  if (!context.ok()) return context.status();
  stage->context_ = std::move(*context);
  auto renderer = Renderer::create(stage->context_->loader());
  if (!renderer.ok()) return renderer.status();
  stage->renderer_ = std::move(*renderer);
  stage->draw_.edges = false;
  if (stage->mesh_) {
    auto scene = stage->renderer_->upload(stage->model_, nullptr);
    if (!scene.ok()) return scene.status();
    if (const auto drawn = stage->measure(**scene, 0); !drawn.ok()) return drawn.status();
  } else if (const auto drawn = stage->measure_quadric(0.05, 0.05, 0); !drawn.ok()) {
    return drawn.status();
  }
  stage->reference_ = stage->last_;
  return stage;
}

Result<Measured> Stage::measure(Scene& scene, int frames) {
  Measured measured;
  measured.points = scene.info().primitives;
  std::vector<double> ms, processor;
  for (int i = 0; i < frames + (frames > 0 ? 2 : 0); ++i) {  // programs are compiled by the first
    const Clock start = Clock::now();
    DrawOptions timed = draw_;
    timed.outputs = kScreen;
    const auto drawn = renderer_->draw_only(scene, camera_, timed);
    if (!drawn.ok()) return drawn.status();
    if (i < 2) continue;
    ms.push_back(drawn->milliseconds);
    processor.push_back(1e3 * (Clock::now() - start).processor);
  }
  if (frames > 0) {
    measured.ms = median(ms);
    measured.processor_ms = median(processor);
  }
  DrawOptions outputs = draw_;
  outputs.outputs = kColor | kNormal | kDepth;
  auto frame = renderer_->draw(scene, camera_, outputs);
  if (!frame.ok()) return frame.status();
  last_ = to_image(*frame);
  if (reference_.width == 0) return measured;
  const auto difference = compare(reference_, last_, {});
  if (!difference.ok()) return difference.status();
  measured.rmse = difference->color->rmse;
  measured.silhouette = difference->silhouette;
  compare_depths(reference_, last_, measured);
  measured.normal_degrees = difference->geometry->normal_degrees.mean;
  return measured;
}

Result<Measured> Stage::measure(const PointContent& content, int frames) {
  auto scene = renderer_->upload(model_, {nullptr, {}, content});
  if (!scene.ok()) return scene.status();
  auto measured = measure(**scene, frames);
  if (!measured.ok()) return measured;
  const bool dp = content.primitive == PointPrimitive::differential_point;
  measured->raw_bytes = measured->points * (dp ? kRawBytes : kSplatBytes);
  if (dp) measured->packed_bytes = packed_size(*content.scene);
  return measured;
}

Result<Measured> Stage::measure_quadric(double tolerance_px, double normal_degrees, int frames) {
  SamplingOptions sampling;
  sampling.camera = camera_;
  sampling.tolerance_px = tolerance_px;
  sampling.normal_tolerance = normal_degrees * kRadians;
  const auto dps = sample_quadric_dps(model_, sampling);
  if (!dps.ok()) return dps.status();
  auto scene = renderer_->upload(model_, &*dps);
  if (!scene.ok()) return scene.status();
  auto measured = measure(**scene, frames);
  if (measured.ok()) measured->raw_bytes = (*scene)->info().bytes;
  return measured;
}

}  // namespace dupin::bench
