// From the pictures of a frame to its numbers in memory.
#include <limits>

#include "../core/parallel.h"
#include "exact_pixels.h"
#include "renderer_impl.h"

namespace dupin {
namespace {

/// out[i] = in[i·stride + first …], `count` numbers a pixel.
template <class T>
std::vector<T> channels(const std::vector<T>& in, std::size_t stride, std::size_t first, std::size_t count) {
  const std::size_t pixels = in.size() / stride;
  std::vector<T> out(pixels * count);
  parallel_for(
      pixels,
      [&](std::size_t i) {
        for (std::size_t k = 0; k < count; ++k) out[i * count + k] = in[i * stride + first + k];
      },
      65536);
  return out;
}

/// In double from the depth: a float cannot hold a point's place in a large model and its place in the pixel.
std::vector<float> positions(const ViewRays& view, const std::vector<float>& depth) {
  std::vector<float> out(depth.size() * 3, 0.0F);
  parallel_for(
      static_cast<std::size_t>(view.height),
      [&](std::size_t row) {
        for (int column = 0; column < view.width; ++column) {
          const std::size_t i = row * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(column);
          const double z = depth[i];
          if (!std::isfinite(z)) continue;
          const double x = (column + 0.5) * 2 / view.width - 1,
                       y = (static_cast<double>(row) + 0.5) * 2 / view.height - 1;
          const double across = view.perspective ? z : 1;
          const Vec3 p = view.eye + view.forward * z + view.right * ((view.ox + view.sx * x) * across) +
                         view.up * ((view.oy + view.sy * y) * across);
          for (int k = 0; k < 3; ++k) out[3 * i + static_cast<std::size_t>(k)] = static_cast<float>(p[k]);
        }
      },
      16);
  return out;
}

}  // namespace

void Renderer::Impl::read_numbers(std::vector<float>& depth, std::vector<std::uint32_t>& numbers) {
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::vector<float> texels(pixels * 4);
  read(kNormalDepthPicture, GL_RGBA, GL_FLOAT, texels.data());
  depth = channels(texels, 4, 3, 1);
  numbers.resize(pixels * 2);
  read(kNumbersPicture, GL_RG_INTEGER, GL_UNSIGNED_INT, numbers.data());
}

void Renderer::Impl::read_frame(const Scene::Impl& scene, const ViewRays& view, const DrawOptions& options,
                                Frame& frame) {
  frame.width = width_;
  frame.height = height_;
  (view.perspective ? frame.pixel_per_depth : frame.pixel_constant) = pixel_size(view, 1);
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const unsigned wanted = options.outputs, pictures = pictures_for(wanted);
  if (wanted & kColor) {
    frame.color.resize(pixels * 4);
    read(kColorPicture, GL_RGBA, GL_FLOAT, frame.color.data());
    if (options.samples > 1)
      for (float& value : frame.color) value /= static_cast<float>(options.samples);
  }
  if (wanted & kScreen) {
    frame.screen.resize(pixels * 4);
    read(kScreenPicture, GL_RGBA, GL_UNSIGNED_BYTE, frame.screen.data());
  }
  std::vector<float> texels;
  if (pictures & 1U << kNormalDepthPicture) {
    texels.resize(pixels * 4);
    read(kNormalDepthPicture, GL_RGBA, GL_FLOAT, texels.data());
    if (wanted & kNormal) frame.normal = channels(texels, 4, 0, 3);
    const std::vector<float> depth = channels(texels, 4, 3, 1);
    if (wanted & kPosition) frame.position = positions(view, depth);
    if (wanted & kDepth) frame.depth = depth;
  }
  if (wanted & kCurvature) {
    frame.curvature.resize(pixels * 2);
    read(kCurvaturePicture, GL_RG, GL_FLOAT, frame.curvature.data());
  }
  if (wanted & kDirection) {
    texels.resize(pixels * 4);
    read(kDirectionPicture, GL_RGBA, GL_FLOAT, texels.data());
    frame.direction = channels(texels, 4, 0, 3);
  }
  if (pictures & 1U << kNumbersPicture) {
    std::vector<std::uint32_t> numbers(pixels * 2);
    read(kNumbersPicture, GL_RG_INTEGER, GL_UNSIGNED_INT, numbers.data());
    if (wanted & kFace) frame.face = channels(numbers, 2, 0, 1);
    if (wanted & kPrimitive) frame.primitive = channels(numbers, 2, 1, 1);
  }
  if (options.exact_model && (wanted & (kUv | kCurvature | kDirection))) {
    if (wanted & kUv) frame.uv.assign(pixels * 2, std::numeric_limits<float>::quiet_NaN());
    std::vector<float> depth;
    std::vector<std::uint32_t> numbers;
    read_numbers(depth, numbers);
    find_exact(*options.exact_model, scene, {view, depth, numbers},
               {wanted & kUv ? &frame.uv : nullptr, wanted & kCurvature ? &frame.curvature : nullptr,
                wanted & kDirection ? &frame.direction : nullptr});
  }
  std::vector<std::uint32_t> ids(pixels);
  read_ids(ids.data());
  for (const std::uint32_t id : ids) frame.stats.covered_pixels += id != 0;
}

}  // namespace dupin
