// The picture of where two pictures differ.
#include <array>
#include <cmath>

#include "metrics_detail.h"

namespace dupin {
namespace {

constexpr double kPixelsPerDegree = 67.020643276582254;
constexpr double kFullDepthPx = 2, kFullDegrees = 2;

/// Black, red, yellow, white, each lighter than the one before.
std::array<std::uint8_t, 3> heat(double t) {
  const double u = 3 * std::clamp(t, 0.0, 1.0);
  const auto byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
  };
  return {byte(u), byte(u - 1), byte(u - 2)};
}

std::vector<float> errors(const Image& a, const Image& b, const CompareOptions& options) {
  if (has_colors(a) && has_colors(b))
    return flip_error(screen_colors(a), screen_colors(b), a.width, a.height, kPixelsPerDegree);
  std::vector<float> error(a.pixels(), 0.0F);
  const NormalAngles normals(a, b);
  const std::vector<float>&za = a.find("Z")->values, &zb = b.find("Z")->values;
  for (std::size_t i = 0; i < error.size(); ++i) {
    if (!std::isfinite(za[i]) || !std::isfinite(zb[i])) continue;
    double e = std::abs(static_cast<double>(za[i]) - zb[i]) / pixel_edge(a, b, za[i], options) / kFullDepthPx;
    if (normals.available()) e = std::max(e, normals.at(i).degrees / kFullDegrees);
    error[i] = static_cast<float>(e);
  }
  return error;
}

}  // namespace

Result<Image8> difference_picture(const Image& a, const Image& b, const CompareOptions& options) {
  const bool colors = has_colors(a) && has_colors(b), depths = a.find("Z") && b.find("Z");
  if (a.width != b.width || a.height != b.height || a.pixels() == 0 || (!colors && !depths))
    return {StatusCode::invalid_argument, "the pictures differ in size or have nothing in common to compare"};
  const std::vector<float> error = errors(a, b, options);
  const std::vector<std::uint8_t> in_a = coverage(a), in_b = coverage(b);
  Image8 picture{a.width, a.height, 3, {}};
  picture.values.reserve(3 * a.pixels());
  for (std::size_t i = 0; i < error.size(); ++i) {
    std::array<std::uint8_t, 3> c = heat(error[i]);
    if (in_a[i] && !in_b[i]) c = {40, 90, 255};
    if (in_b[i] && !in_a[i]) c = {30, 200, 60};
    picture.values.insert(picture.values.end(), c.begin(), c.end());
  }
  return picture;
}

}  // namespace dupin
