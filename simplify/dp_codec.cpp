#include "dp_codec.h"

namespace dupin {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr int kCurvatures = 32766;  ///< codes 1 … 32767 in logarithmic steps
constexpr int kSizes = 254;

double sign(double v) {
  return v < 0 ? -1 : 1;
}

/// Octahedral coordinates in [-1, 1]² to a direction (Meyer et al. 2010), and back.
Vec3 from_octahedron(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z >= 0) return normalized({x, y, z});
  return normalized({(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), z});
}
Vec2 to_octahedron(const Vec3& d) {
  const double l = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  const Vec2 p{d.x / l, d.y / l};
  if (d.z >= 0) return p;
  return {(1 - std::abs(p.y)) * sign(p.x), (1 - std::abs(p.x)) * sign(p.y)};
}

/// û by an octahedron's square with kDirections points a side, the middle and the borders among them; v̂ by
/// its angle.
constexpr std::uint32_t kDirections = 1447, kAngles = 2048;
constexpr double kMiddle = 723;

std::uint32_t frame_code(const Vec3& u, const Vec3& n) {
  const Vec2 p = to_octahedron(u);
  const double x = std::round(p.x * kMiddle), y = std::round(p.y * kMiddle);
  // v̂ perpendicular to the decoded û and to n: û × v̂ is then as near to n as û lets it.
  const Vec3 d = from_octahedron(x / kMiddle, y / kMiddle);
  const Vec3 e1 = any_perpendicular(d), e2 = cross(d, e1), v = cross(n, d);
  const double turn = std::atan2(dot(v, e2), dot(v, e1)) / kTwoPi;
  const auto angle =
      static_cast<std::uint32_t>(std::lround((turn < 0 ? turn + 1 : turn) * kAngles) % kAngles);
  return static_cast<std::uint32_t>(x + kMiddle) + kDirections * static_cast<std::uint32_t>(y + kMiddle) +
         (angle << 21);
}

void decode_frame(std::uint32_t code, Vec3& u, Vec3& v) {
  const std::uint32_t cell = std::min(code & 0x1fffffU, kDirections * kDirections - 1);
  u = from_octahedron((cell % kDirections - kMiddle) / kMiddle, (cell / kDirections - kMiddle) / kMiddle);
  const Vec3 e1 = any_perpendicular(u), e2 = cross(u, e1);
  const double angle = kTwoPi * (code >> 21) / kAngles;
  v = e1 * std::cos(angle) + e2 * std::sin(angle);
}

void put16(std::vector<std::uint8_t>& bytes, int value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 255));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}
int get16(const std::uint8_t* at) {
  return at[0] | at[1] << 8;
}

int coordinate_code(double x, double lo, double hi) {
  return hi > lo ? static_cast<int>(std::lround(std::clamp((x - lo) / (hi - lo), 0.0, 1.0) * 65535)) : 0;
}

int curvature_code(double lambda, const PackedRange& range) {
  const double size = std::abs(lambda);
  if (!(size >= range.least_curvature) || size == 0) return 0;
  const double span = std::log(range.most_curvature / range.least_curvature);
  const double part = span > 0 ? std::log(size / range.least_curvature) / span : 0;
  return 1 + static_cast<int>(std::lround(std::clamp(part, 0.0, 1.0) * (kCurvatures - 1))) +
         (lambda < 0 ? 32768 : 0);
}
double curvature_of(int code, const PackedRange& range) {
  if ((code & 32767) == 0) return 0;
  const double part = ((code & 32767) - 1.0) / (kCurvatures - 1);
  const double size =
      range.least_curvature * std::exp(part * std::log(range.most_curvature / range.least_curvature));
  return code & 32768 ? -size : size;
}

/// Rounded up, but for what the logarithm's own rounding moves.
std::uint8_t size_code(double half, const PackedRange& range) {
  const double span = std::log(range.most_size / range.least_size);
  const double part = span > 0 ? std::log(half / range.least_size) / span : 0;
  return static_cast<std::uint8_t>(1 + std::clamp(std::ceil(part * kSizes - 1e-9), 0.0, kSizes + 0.0));
}
double size_of(std::uint8_t code, const PackedRange& range) {
  return range.least_size *
         std::exp((code - 1) / (kSizes + 0.0) * std::log(range.most_size / range.least_size));
}

}  // namespace

std::uint8_t rho_code(double rho) {
  return static_cast<std::uint8_t>(128 + std::lround(std::clamp(rho, -1.0, 1.0) * 127));
}
double rho_of(std::uint8_t code) {
  return std::max(-1.0, (code - 128) / 127.0);
}

PackedRange packed_range(const DifferentialPoint* points, std::size_t count, bool sizes) {
  PackedRange range;
  double least = INFINITY, least_size = INFINITY;
  for (std::size_t i = 0; i < count; ++i) {
    const DifferentialPoint& p = points[i];
    range.box.add(p.position);
    range.most_curvature = std::max(range.most_curvature, std::abs(p.lambda_u));
    if (p.lambda_u != 0) least = std::min(least, std::abs(p.lambda_u));
    range.most_size = std::max({range.most_size, p.half_u, p.half_v});
    least_size = std::min({least_size, p.half_u, p.half_v});
  }
  if (range.most_curvature > 0)
    range.least_curvature = std::max(least, kLeastCurvature * range.most_curvature);
  range.least_size = sizes ? std::max(least_size, 1e-6 * range.most_size) : 0;
  if (!sizes) range.most_size = 0;
  return range;
}

double packed_size_factor(const PackedRange& range) {
  return range.most_size > 0 ? std::pow(range.most_size / range.least_size, 1.0 / kSizes) * (1 + 1e-9) : 1;
}

void pack(const DifferentialPoint& point, const PackedRange& range, std::vector<std::uint8_t>& bytes) {
  for (int k = 0; k < 3; ++k)
    put16(bytes, coordinate_code(point.position[k], range.box.lo[k], range.box.hi[k]));
  const std::uint32_t frame = frame_code(point.u, point.n());
  put16(bytes, static_cast<int>(frame & 65535));
  put16(bytes, static_cast<int>(frame >> 16));
  put16(bytes, curvature_code(point.lambda_u, range));
  bytes.push_back(rho_code(point.rho()));
  if (range.most_size <= 0) return;
  if (!point.own_size) {
    bytes.push_back(0);
  } else {
    bytes.push_back(size_code(point.half_u, range));
    bytes.push_back(size_code(point.half_v, range));
  }
}

bool unpack(const std::uint8_t*& at, const std::uint8_t* end, const PackedRange& range, double epsilon,
            double delta, DifferentialPoint& point) {
  if (static_cast<std::size_t>(end - at) < kPackedBytes) return false;
  for (int k = 0; k < 3; ++k)
    point.position[k] = range.box.lo[k] + (range.box.hi[k] - range.box.lo[k]) * (get16(at + 2 * k) / 65535.0);
  decode_frame(static_cast<std::uint32_t>(get16(at + 6)) | static_cast<std::uint32_t>(get16(at + 8)) << 16,
               point.u, point.v);
  point.lambda_u = curvature_of(get16(at + 10), range);
  point.lambda_v = point.lambda_u * rho_of(at[12]);
  at += kPackedBytes;
  point.own_size = false;
  if (range.most_size > 0) {
    if (at == end) return false;
    point.own_size = *at != 0;
    if (point.own_size && (end - at < 2 || at[1] == 0)) return false;
  }
  if (epsilon > 0 || !point.own_size) set_extents(point, epsilon, delta);
  if (point.own_size) {
    point.half_u = size_of(at[0], range);
    point.half_v = size_of(at[1], range);
  }
  if (range.most_size > 0) at += point.own_size ? 2 : 1;
  return true;
}

}  // namespace dupin
