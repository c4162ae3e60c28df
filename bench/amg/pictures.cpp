#include "pictures.h"

#include <cmath>

#include "../../render/metrics.h"
#include "../../render/view.h"
#include "../report.h"

namespace dupin::bench {
namespace {

constexpr const char* kViews[] = {"iso", "front", "back", "left", "right", "top"};
constexpr double kPixelsPerDegree = 67;

std::vector<float> colors_of(const Frame& frame) {
  std::vector<float> colors;
  for (std::size_t i = 0; i < frame.screen.size(); i += 4)
    for (std::size_t k = 0; k < 3; ++k) colors.push_back(static_cast<float>(frame.screen[i + k]) / 255);
  return colors;
}

/// What is not the background, white.
bool covered(const Frame& frame, std::size_t pixel) {
  const std::uint8_t* c = frame.screen.data() + 4 * pixel;
  return c[0] != 255 || c[1] != 255 || c[2] != 255;
}

PictureError error_of(const Frame& reference, const Frame& frame) {
  PictureError error;
  const std::vector<float> a = colors_of(reference), b = colors_of(frame),
                           flip = flip_error(a, b, frame.width, frame.height, kPixelsPerDegree);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < flip.size(); ++i) {
    error.flip += flip[i] / static_cast<double>(flip.size());
    if (!covered(reference, i) && !covered(frame, i)) continue;
    for (std::size_t k = 0; k < 3; ++k) sum += std::pow(255 * (a[3 * i + k] - b[3 * i + k]), 2), ++count;
  }
  error.rmse = count > 0 ? std::sqrt(sum / count) : 0;
  return error;
}

Result<Camera> camera_of(const Model& model, const char* view, int size) {
  Camera settings;
  settings.width = settings.height = size;
  return fit_view(bounding_box(model), view, settings);
}

}  // namespace

Result<Pictures> Pictures::open() {
  Pictures pictures;
  auto context = create_context(Device::automatic);
  if (!context) return context.status();
  pictures.context_ = std::move(*context);
  auto renderer = Renderer::create(pictures.context_->loader());
  if (!renderer) return renderer.status();
  pictures.renderer_ = std::move(*renderer);
  return pictures;
}

Result<std::vector<Frame>> Pictures::draw(const Model& model, const SceneContent& content, int size) {
  const auto scene = renderer_->upload(model, content);
  if (!scene) return scene.status();
  DrawOptions options;
  options.outputs = kScreen;
  options.samples = 4;
  options.edges = false;
  options.background = Color{1, 1, 1, 1};
  std::vector<Frame> frames;
  for (const char* view : kViews) {
    const auto camera = camera_of(model, view, size);
    if (!camera) return camera.status();
    auto frame = renderer_->draw(**scene, *camera, options);
    if (!frame) return frame.status();
    frames.push_back(std::move(*frame));
  }
  return frames;
}

Result<double> Pictures::time(const Model& model, const SceneContent& content, int size, int frames) {
  const auto scene = renderer_->upload(model, content);
  if (!scene) return scene.status();
  const auto camera = camera_of(model, "iso", size);
  if (!camera) return camera.status();
  DrawOptions options;
  options.outputs = kScreen;
  options.samples = 1;
  options.edges = false;
  std::vector<double> times;
  for (int i = 0; i < frames + 2; ++i) {
    const auto stats = renderer_->draw_only(**scene, *camera, options);
    if (!stats) return stats.status();
    if (i >= 2) times.push_back(stats->milliseconds);  // programs are compiled by the first
  }
  return median(times);
}

PictureError error_of(const std::vector<Frame>& reference, const std::vector<Frame>& frames) {
  PictureError mean;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const PictureError error = error_of(reference[i], frames[i]);
    mean.flip += error.flip / static_cast<double>(frames.size());
    mean.rmse += error.rmse / static_cast<double>(frames.size());
  }
  return mean;
}

}  // namespace dupin::bench
