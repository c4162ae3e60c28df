#include "point_node.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace dupin {
namespace {

constexpr int kMantissaBits = 11, kExponentBias = 10;
constexpr double kNormalSteps = (1 << kNormalBits) - 1;

std::uint32_t clamp_grid(double x) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(x + 0.5), 0.0, double{kLargestGridCoordinate}));
}

double sign_of(double x) {
  return x < 0 ? -1 : 1;
}

std::uint32_t octahedron_step(double x) {
  return static_cast<std::uint32_t>(
      std::clamp(std::floor((0.5 * x + 0.5) * kNormalSteps + 0.5), 0.0, kNormalSteps));
}

/// 8 bits of x in [-1, 1] by its root.
std::uint32_t encode_root(double x) {
  const double root = std::sqrt(std::min(1.0, std::abs(x)));
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(sign_of(x) * 127 * root)) & 0xff);
}
double decode_root(std::uint32_t bits) {
  const double x = static_cast<std::int8_t>(bits & 0xff) / 127.0;
  return sign_of(x) * x * x;
}

}  // namespace

Vec3 rounded_to_grid(const Vec3& c) {
  return {double(clamp_grid(c.x)), double(clamp_grid(c.y)), double(clamp_grid(c.z))};
}

std::uint32_t encode_radius(double radius) {
  if (!(radius > 0)) return 0;
  int exponent;
  const double mantissa = 2 * std::frexp(radius, &exponent);  // 1 … 2
  std::int64_t bits = (static_cast<std::int64_t>(exponent) - 1 + kExponentBias) << kMantissaBits;
  bits += static_cast<std::int64_t>(std::ceil((mantissa - 1) * (1 << kMantissaBits)));
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(bits, 1, 0xffff));
}

double decode_radius(std::uint32_t bits) {
  if (bits == 0) return 0;
  // The exponent and mantissa of a double in its place.
  const std::uint64_t exponent = (bits >> kMantissaBits) + 1023 - kExponentBias;
  const std::uint64_t mantissa = bits & ((1U << kMantissaBits) - 1);
  return std::bit_cast<double>(exponent << 52 | mantissa << (52 - kMantissaBits));
}

std::uint32_t encode_normal(const Vec3& n) {
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) return encode_normal({0, 0, 1});
  double x = n.x / sum, y = n.y / sum;
  if (n.z < 0) {
    const double folded = (1 - std::abs(y)) * sign_of(x);
    y = (1 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  return octahedron_step(x) | octahedron_step(y) << kNormalBits;
}

Vec3 decode_normal(std::uint32_t bits) {
  constexpr std::uint32_t kMask = (1U << kNormalBits) - 1;
  double x = 2 * ((bits & kMask) / kNormalSteps) - 1,
         y = 2 * ((bits >> kNormalBits & kMask) / kNormalSteps) - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double folded = (1 - std::abs(y)) * sign_of(x);
    y = (1 - std::abs(x)) * sign_of(y);
    x = folded;
  }
  return normalized({x, y, z});
}

std::uint32_t encode_cone(double sine, bool beyond_right_angle) {
  if (beyond_right_angle || !(sine < 1)) return kNoCone;
  return std::min(kNoCone, static_cast<std::uint32_t>(std::ceil(std::max(0.0, sine) * 254)));
}

std::uint32_t encode_color(const Rgba8& c) {
  const auto scaled = [](int value, int most) {
    return static_cast<std::uint32_t>((value * most + 127) / 255);
  };
  return scaled(c[0], 31) << 11 | scaled(c[1], 63) << 5 | scaled(c[2], 31);
}

Rgba8 decode_color(std::uint32_t color) {
  const auto byte = [](std::uint32_t value, std::uint32_t most) {
    return static_cast<std::uint8_t>((value * 255 + most / 2) / most);
  };
  return {byte(color >> 11 & 31, 31), byte(color >> 5 & 63, 63), byte(color & 31, 31), 255};
}

EncodedNode encode(const PointNode& node) {
  const std::uint32_t x = clamp_grid(node.center.x), y = clamp_grid(node.center.y),
                      z = clamp_grid(node.center.z);
  EncodedNode out;
  out.words[0] = x | y << 21;
  out.words[1] = y >> 11 | z << 10;
  out.words[2] = encode_radius(node.radius) | node.cone << 16 | (node.color >> 8 & 0xff) << 24;
  const std::uint32_t count = node.triangles > 0 ? node.triangles - 1 : 0;
  out.words[3] = encode_normal(node.normal) | count << 22 | (node.color & 0xff) << 24;
  return out;
}

PointNode decode(const EncodedNode& n) {
  return {node_center(n), node_radius(n),    node_normal(n),
          node_cone(n),   node_triangles(n), (n.words[2] >> 24) << 8 | n.words[3] >> 24};
}

std::uint32_t encode_curvature(const NodeCurvature& c) {
  const double turn = c.angle / std::numbers::pi;
  const auto angle = static_cast<std::uint32_t>(std::lround((turn - std::floor(turn)) * 256)) & 0xff;
  return encode_root(c.k1) | encode_root(c.k2) << 8 | angle << 16;
}

NodeCurvature decode_curvature(std::uint32_t bits) {
  return {decode_root(bits), decode_root(bits >> 8), (bits >> 16 & 0xff) * std::numbers::pi / 256};
}

}  // namespace dupin
