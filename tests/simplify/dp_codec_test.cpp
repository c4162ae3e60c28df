// 13-byte records decode to within what dp_codec.h states.
#include "../../simplify/dp_codec.h"

#include <gtest/gtest.h>

#include "points.h"

namespace dupin::testing {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
  return 2 * std::asin(std::min(1.0, distance(a, b) / 2));
}

struct Decoded {
  PackedRange range;
  std::size_t bytes = 0;
  std::vector<DifferentialPoint> points;
};
Decoded through(const std::vector<DifferentialPoint>& points, bool sizes) {
  Decoded decoded;
  decoded.range = packed_range(points.data(), points.size(), sizes);
  std::vector<std::uint8_t> bytes;
  for (const DifferentialPoint& p : points) pack(p, decoded.range, bytes);
  decoded.bytes = bytes.size();
  const std::uint8_t* at = bytes.data();
  for (std::size_t i = 0; i < points.size(); ++i) {
    DifferentialPoint& p = decoded.points.emplace_back();
    EXPECT_TRUE(unpack(at, bytes.data() + bytes.size(), decoded.range, kEpsilon, kDelta, p));
  }
  EXPECT_EQ(at, bytes.data() + bytes.size());
  return decoded;
}

TEST(PackedRecords, DecodeToWithinTheirStatedErrors) {
  const std::vector<DifferentialPoint> points = random_points(200000, 11, false);
  const Decoded decoded = through(points, false);
  EXPECT_EQ(decoded.bytes, 13 * points.size());
  double normal = 0, direction = 0, other = 0, curvature = 0, rho = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DifferentialPoint &p = points[i], &q = decoded.points[i];
    for (int k = 0; k < 3; ++k)
      ASSERT_LE(std::abs(p.position[k] - q.position[k]), kPackedPositionError * decoded.range.box.size()[k]);
    normal = std::max(normal, angle_between(p.n(), q.n()));
    direction = std::max(direction, angle_between(p.u, q.u));
    other = std::max(other, angle_between(p.v, q.v));
    curvature =
        std::max(curvature, std::abs(p.lambda_u - q.lambda_u) /
                                std::max(std::abs(p.lambda_u), kLeastCurvature / kPackedCurvatureError *
                                                                   decoded.range.most_curvature));
    rho = std::max(rho, std::abs(p.rho() - q.rho()));
    if (p.lambda_v == 0 || p.lambda_v == p.lambda_u) {
      ASSERT_EQ(q.lambda_v, p.lambda_v == 0 ? 0 : q.lambda_u) << "0 and 1 are exact";
    }
    ASSERT_NEAR(dot(q.u, q.v), 0, 1e-12);
    ASSERT_NEAR(length(q.n()), 1, 1e-12);
  }
  EXPECT_LE(normal, kPackedNormalError);
  EXPECT_GT(normal, kPackedNormalError / 3) << "the stated error says nothing";
  EXPECT_LE(direction, kPackedDirectionError);
  EXPECT_LE(other, kPackedDirectionError);
  EXPECT_LE(curvature, kPackedCurvatureError);
  EXPECT_LE(rho, kPackedRhoError);
}

TEST(PackedRecords, KeepDirectionsAlongTheAxes) {
  std::vector<DifferentialPoint> points(2);
  points[0].u = {0, 0, -1};
  points[0].v = {0, 1, 0};
  points[0].lambda_u = 1;
  set_extents(points[0], kEpsilon, kDelta);
  points[1] = points[0];
  points[1].position = {1, 1, 1};
  for (const DifferentialPoint& p : through(points, false).points) {
    EXPECT_LT(distance(p.u, {0, 0, -1}), 1e-12);
    EXPECT_LT(distance(p.v, {0, 1, 0}), 1e-12);
  }
}

TEST(PackedRecords, StoredSizesAreNeverTooSmall) {
  const std::vector<DifferentialPoint> points = random_points(20000, 5, true);
  const Decoded decoded = through(points, true);
  const double factor = packed_size_factor(decoded.range);
  EXPECT_LT(factor, 1.06);
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DifferentialPoint &p = points[i], &q = decoded.points[i];
    ASSERT_EQ(p.own_size, q.own_size);
    bytes += p.own_size ? 15 : 14;
    if (!p.own_size) continue;
    ASSERT_GE(q.half_u, p.half_u * (1 - 1e-9));
    ASSERT_LE(q.half_u, p.half_u * factor);
    ASSERT_GE(q.half_v, p.half_v * (1 - 1e-9));
    ASSERT_LE(q.half_v, p.half_v * factor);
  }
  EXPECT_EQ(decoded.bytes, bytes);
}

TEST(PackedRecords, ThatEndTooSoonAreNotRead) {
  const std::vector<DifferentialPoint> points = random_points(10, 5, true);
  const PackedRange range = packed_range(points.data(), points.size(), true);
  std::vector<std::uint8_t> bytes;
  pack(points[0], range, bytes);
  ASSERT_EQ(bytes.size(), 15U);
  DifferentialPoint p;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    const std::uint8_t* at = cut.data();
    EXPECT_FALSE(unpack(at, cut.data() + n, range, kEpsilon, kDelta, p)) << n;
  }
}

}  // namespace
}  // namespace dupin::testing
