#include "image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "../core/parallel.h"

namespace dupin {
namespace {

double to_linear(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// The linear value above which each 8-bit sRGB value is the nearest.
std::array<float, 256> encoding_thresholds() {
  std::array<float, 256> t{};
  for (int i = 1; i < 256; ++i)
    t[static_cast<std::size_t>(i)] = static_cast<float>(to_linear((i - 0.5) / 255));
  return t;
}
std::uint8_t encode(float linear) {
  static const std::array<float, 256> kThresholds = encoding_thresholds();
  if (!(linear > 0)) return 0;
  return static_cast<std::uint8_t>(std::upper_bound(kThresholds.begin() + 1, kThresholds.end(), linear) -
                                   kThresholds.begin() - 1);
}

template <class T>
void add(Image& image, const std::vector<T>& values, std::initializer_list<const char*> names) {
  if (values.empty()) return;
  std::size_t k = 0;
  for (const char* name : names) {
    std::vector<float>& channel = image.channel(name).values;
    for (std::size_t i = 0; i < image.pixels(); ++i)
      channel[i] = static_cast<float>(values[i * names.size() + k]);
    ++k;
  }
}

}  // namespace

const Image::Channel* Image::find(std::string_view name) const {
  for (const Channel& channel : channels)
    if (channel.name == name) return &channel;
  return nullptr;
}

Image::Channel& Image::channel(std::string_view name) {
  for (Channel& channel : channels)
    if (channel.name == name) return channel;
  channels.push_back({std::string(name), std::vector<float>(pixels(), 0.0F)});
  return channels.back();
}

Image to_image(const Frame& frame) {
  Image image{frame.width, frame.height, {}};
  image.pixel_constant = frame.pixel_constant;
  image.pixel_per_depth = frame.pixel_per_depth;
  add(image, frame.color, {"R", "G", "B", "A"});
  add(image, frame.normal, {"N.X", "N.Y", "N.Z"});
  add(image, frame.depth, {"Z"});
  add(image, frame.position, {"P.X", "P.Y", "P.Z"});
  add(image, frame.curvature, {"k1", "k2"});
  add(image, frame.direction, {"d1.X", "d1.Y", "d1.Z"});
  add(image, frame.face, {"id"});
  add(image, frame.primitive, {"prim"});
  add(image, frame.uv, {"u", "v"});
  return image;
}

Image8 screen_image(const Frame& frame) {
  Image8 image{frame.width, frame.height, 4, frame.screen};
  const std::size_t pixels = image.values.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i)
    if (image.values[4 * i + 3] != 255) return image;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t k = 0; k < 3; ++k) image.values[3 * i + k] = image.values[4 * i + k];
  image.values.resize(3 * pixels);
  image.channels = 3;
  return image;
}

Image8 to_image8(const Image& image) {
  const Image::Channel* const color[] = {image.find("R"), image.find("G"), image.find("B")};
  const Image::Channel* const alpha = image.find("A");
  const bool opaque =
      !alpha || std::all_of(alpha->values.begin(), alpha->values.end(), [](float a) { return a >= 1; });
  Image8 result{image.width, image.height, opaque ? 3 : 4, {}};
  const auto n = static_cast<std::size_t>(result.channels);
  result.values.resize(image.pixels() * n);
  encode(0);  // the table, before several threads want it
  parallel_for(
      image.pixels(),
      [&](std::size_t i) {
        const float a = opaque ? 1.0F : std::clamp(alpha->values[i], 0.0F, 1.0F);
        for (std::size_t k = 0; k < 3; ++k)
          result.values[i * n + k] = color[k] && a > 0 ? encode(color[k]->values[i] / a) : std::uint8_t{0};
        if (!opaque) result.values[i * n + 3] = static_cast<std::uint8_t>(std::lround(a * 255));
      },
      16384);
  return result;
}

Image to_image(const Image8& image) {
  Image result{image.width, image.height, {}};
  std::array<float, 256> linear;
  for (int i = 0; i < 256; ++i)
    linear[static_cast<std::size_t>(i)] = static_cast<float>(to_linear(i / 255.0));
  for (const char* name : {"R", "G", "B", "A"}) result.channel(name);
  const auto n = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < result.pixels(); ++i) {
    const float a = n == 4 ? static_cast<float>(image.values[i * n + 3]) / 255.0F : 1.0F;
    for (std::size_t k = 0; k < 3; ++k)
      result.channels[k].values[i] = linear[image.values[i * n + (n >= 3 ? k : 0)]] * a;
    result.channels[3].values[i] = a;
  }
  return result;
}

Result<Image> read_image(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char first[4] = {};
  if (!file || !file.read(first, 4)) return {StatusCode::unreadable, path + ": cannot be read"};
  if (std::string_view(first, 4) == "\x76\x2f\x31\x01") return read_exr(path);
  auto png = read_png(path);
  if (!png) return png.status();
  return to_image(*png);
}

}  // namespace dupin
