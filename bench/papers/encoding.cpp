#include "encoding.h"

#include <algorithm>
#include <cmath>

#include "../../simplify/dp_codec.h"
#include "../../simplify/dps_file.h"

namespace dupin::bench {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

double degrees_between(const Vec3& a, const Vec3& b) {
  return kDegrees * std::atan2(length(cross(a, b)), dot(a, b));
}

void raise(double& most, double value) {
  most = std::max(most, value);
}

void add_errors(const DifferentialPoint& was, const DifferentialPoint& is, const PackedRange& range,
                EncodingErrors& errors) {
  const Vec3 size = range.box.size();
  for (int k = 0; k < 3; ++k)
    if (size[k] > 0) raise(errors.position, std::abs(is.position[k] - was.position[k]) / size[k]);
  raise(errors.normal_degrees, degrees_between(is.n(), was.n()));
  raise(errors.direction_degrees, std::max(degrees_between(is.u, was.u), degrees_between(is.v, was.v)));
  if (std::abs(was.lambda_u) <= kLeastCurvature * range.most_curvature) return;  // flat
  raise(errors.curvature, std::abs(is.lambda_u / was.lambda_u - 1));
  raise(errors.rho, std::abs(is.rho() - was.rho()));
}

}  // namespace

EncodingErrors pack_and_unpack(PointScene& scene) {
  EncodingErrors errors;
  for (PartPoints& part : scene.parts)
    for (std::size_t first = 0; first < part.points.size(); first += kMostChunkPoints) {
      DifferentialPoint* chunk = part.points.data() + first;
      const std::size_t count = std::min(kMostChunkPoints, part.points.size() - first);
      const bool sizes = std::any_of(chunk, chunk + count, [](const auto& p) { return p.own_size; });
      const PackedRange range = packed_range(chunk, count, sizes);
      std::vector<std::uint8_t> bytes;
      for (std::size_t i = 0; i < count; ++i) pack(chunk[i], range, bytes);
      const std::uint8_t* at = bytes.data();
      for (std::size_t i = 0; i < count; ++i) {
        DifferentialPoint decoded;
        if (!unpack(at, bytes.data() + bytes.size(), range, scene.epsilon, scene.delta, decoded)) break;
        add_errors(chunk[i], decoded, range, errors);
        decoded.face = chunk[i].face;
        chunk[i] = decoded;
      }
    }
  return errors;
}

}  // namespace dupin::bench
