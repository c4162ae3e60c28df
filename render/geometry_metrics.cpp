// Depths and normals of two pictures, held against each other where the reference is smooth.
#include <cmath>

#include "../core/parallel.h"
#include "../core/vec.h"
#include "metrics_detail.h"

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;

void add_row(const Depths& depths, const NormalAngles& normals, int y, int width, GeometryMetrics& m,
             std::vector<float>& depth, std::vector<float>& angle) {
  for (int x = 0; x < width; ++x) {
    const std::size_t i = depths.index(x, y);
    m.extra += depths.extra(x, y);
    if (!depths.interior(x, y)) continue;
    ++m.interior;
    const double d = depths.difference(i);
    m.holes += !(d <= kHoleDepthPx);
    if (!std::isfinite(d)) continue;
    depth.push_back(static_cast<float>(d));
    if (!normals.available()) continue;
    const NormalAngles::Angle a = normals.at(i);
    angle.push_back(static_cast<float>(a.degrees));
    m.opposed_normals += a.opposed;
  }
}

}  // namespace

Depths::Depths(const Image& a, const Image& b, const CompareOptions& options)
    : a_(a), b_(b), options_(options), za_(a.find("Z")->values), zb_(b.find("Z")->values) {}

bool Depths::interior(int x, int y) const {
  const int r = kInteriorRadius;
  if (x < r || y < r || x >= a_.width - r || y >= a_.height - r) return false;
  const float z = za_[index(x, y)];
  if (!std::isfinite(z)) return false;
  const double reach = kContinuousDepthPx * edge(index(x, y));
  for (int j = -r; j <= r; ++j)
    for (int i = -r; i <= r; ++i)
      if (!(std::abs(za_[index(x + i, y + j)] - z) <= reach)) return false;  // also where it is infinite
  return true;
}

bool Depths::extra(int x, int y) const {
  if (!std::isfinite(zb_[index(x, y)])) return false;
  for (int j = std::max(0, y - kInteriorRadius); j <= std::min(a_.height - 1, y + kInteriorRadius); ++j)
    for (int i = std::max(0, x - kInteriorRadius); i <= std::min(a_.width - 1, x + kInteriorRadius); ++i)
      if (std::isfinite(za_[index(i, j)])) return false;
  return true;
}

double pixel_edge(const Image& a, const Image& b, double depth, const CompareOptions& options) {
  for (const Image* image : {&a, &b})
    if (image->pixel_per_depth > 0 || image->pixel_constant > 0)
      return image->pixel_constant + image->pixel_per_depth * depth;
  return 2 * std::tan(options.fov_degrees * kPi / 360) / a.height * depth;
}

NormalAngles::NormalAngles(const Image& a, const Image& b) {
  constexpr const char* kNames[] = {"N.X", "N.Y", "N.Z"};
  for (int k = 0; k < 3; ++k) {
    const Image::Channel *in_a = a.find(kNames[k]), *in_b = b.find(kNames[k]);
    available_ = available_ && in_a && in_b;
    if (available_) a_[k] = &in_a->values, b_[k] = &in_b->values;
  }
}

NormalAngles::Angle NormalAngles::at(std::size_t i) const {
  const Vec3 a{(*a_[0])[i], (*a_[1])[i], (*a_[2])[i]}, b{(*b_[0])[i], (*b_[1])[i], (*b_[2])[i]};
  const double c = dot(a, b);
  return {std::atan2(length(cross(a, b)), std::abs(c)) * 180 / kPi, c < 0};
}

GeometryMetrics geometry_metrics(const Image& a, const Image& b, const CompareOptions& options) {
  const Depths depths(a, b, options);
  const NormalAngles normals(a, b);
  const auto rows = static_cast<std::size_t>(a.height);
  std::vector<GeometryMetrics> parts(rows);
  std::vector<std::vector<float>> depth(rows), angle(rows);
  parallel_for(
      rows,
      [&](std::size_t y) {
        add_row(depths, normals, static_cast<int>(y), a.width, parts[y], depth[y], angle[y]);
      },
      16);
  GeometryMetrics m;
  std::vector<float> all_depths, all_angles;
  for (std::size_t y = 0; y < rows; ++y) {
    m.interior += parts[y].interior;
    m.holes += parts[y].holes;
    m.extra += parts[y].extra;
    m.opposed_normals += parts[y].opposed_normals;
    all_depths.insert(all_depths.end(), depth[y].begin(), depth[y].end());
    all_angles.insert(all_angles.end(), angle[y].begin(), angle[y].end());
  }
  m.depth_px = distribution(all_depths);
  m.normal_degrees = distribution(all_angles);
  return m;
}

}  // namespace dupin
