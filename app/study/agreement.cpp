#include "agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace dupin::app {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// What is compared of one picture.
struct Surfaces {
  explicit Surfaces(const Image& image) : colors(to_image8(image)), z(image.find("Z")) {
    for (int k = 0; k < 3; ++k) {
      static constexpr const char* kNames[] = {"N.X", "N.Y", "N.Z"};
      normal[k] = image.find(kNames[k]);
    }
  }
  bool complete() const { return z && normal[0] && normal[1] && normal[2] && colors.channels >= 3; }
  float n(int k, std::size_t i) const { return normal[k]->values[i]; }

  Image8 colors;
  const Image::Channel *z, *normal[3] = {};
};

/// Unsigned: surfaces that are seen from behind are lit like those that are seen from before.
bool same_normal(const Surfaces& a, const Surfaces& b, std::size_t i) {
  static const double kLeast = std::cos(kAgreeingDegrees * kPi / 180);
  double dot = 0, aa = 0, bb = 0;
  for (int k = 0; k < 3; ++k) {
    const double x = a.n(k, i), y = b.n(k, i);
    dot += x * y, aa += x * x, bb += y * y;
  }
  return std::abs(dot) >= kLeast * std::sqrt(aa * bb) && aa > 0 && bb > 0;
}

int color_difference(const Image8& a, const Image8& b, std::size_t i) {
  int most = 0;
  for (int k = 0; k < 3; ++k) {
    const int x = a.values[i * static_cast<std::size_t>(a.channels) + static_cast<std::size_t>(k)],
              y = b.values[i * static_cast<std::size_t>(b.channels) + static_cast<std::size_t>(k)];
    most = std::max(most, std::abs(x - y));
  }
  return most;
}

}  // namespace

Agreement agreement(const Image& reference, const Image& picture) {
  const Surfaces a(reference), b(picture);
  if (!a.complete() || !b.complete() || reference.pixels() != picture.pixels()) return {};
  std::uint64_t counts[256] = {};
  Agreement result;
  for (std::size_t i = 0; i < reference.pixels(); ++i) {
    const double za = a.z->values[i], zb = b.z->values[i];
    const double edge = reference.pixel_constant + reference.pixel_per_depth * za;
    if (!(std::abs(za - zb) <= kAgreeingDepthPx * edge) || !same_normal(a, b, i)) continue;
    ++counts[color_difference(a.colors, b.colors, i)];
    ++result.pixels;
  }
  std::uint64_t below = 0;
  for (int d = 0; d < 256; ++d) {
    if (counts[d] == 0) continue;
    if (100 * below < 99 * result.pixels) result.color_p99 = d;
    result.color_max = d;
    below += counts[d];
  }
  return result;
}

}  // namespace dupin::app
