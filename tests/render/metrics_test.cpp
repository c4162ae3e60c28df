// Metrics against values worked out by hand.
#include "../../render/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dupin::testing {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image gray(int width, int height, double srgb) {
  Image image{width, height, {}};
  const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
  for (const char* name : {"R", "G", "B"})
    image.channel(name).values.assign(image.pixels(), static_cast<float>(linear));
  return image;
}

TEST(ColorMetrics, EqualPicturesDoNotDiffer) {
  const auto d = compare(gray(40, 30, 0.5), gray(40, 30, 0.5), {});
  ASSERT_TRUE(d.ok() && d->color);
  EXPECT_EQ(d->color->rmse, 0);
  EXPECT_EQ(d->color->psnr, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(d->color->ssim, 1, 1e-12);
  EXPECT_EQ(d->color->flip, 0);
  EXPECT_FALSE(d->geometry);
}

TEST(ColorMetrics, ConstantDifferenceHasTheClosedForm) {
  const double a = 100 / 255.0, b = 110 / 255.0;
  const auto d = compare(gray(40, 30, a), gray(40, 30, b), {});
  ASSERT_TRUE(d.ok() && d->color);
  EXPECT_NEAR(d->color->rmse, 10, 1e-4);
  EXPECT_NEAR(d->color->psnr, 20 * std::log10(25.5), 1e-4);
  // Without variance SSIM is the luminance term alone.
  EXPECT_NEAR(d->color->ssim, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-4);
}

TEST(ColorMetrics, OneWrongPixelCountsOnce) {
  Image a = gray(10, 10, 0), b = gray(10, 10, 0);
  b.channel("G").values[37] = 1;
  const auto d = compare(a, b, {});
  EXPECT_NEAR(d->color->rmse, 255 / std::sqrt(300.0), 1e-6);
  EXPECT_NEAR(d->color->rmse_covered, 255 / std::sqrt(3.0), 1e-6) << "only B shows something, at one pixel";
}

/// Depth 1 in a rectangle, nothing elsewhere.
Image rectangle(int size, int x0, int x1, int y0, int y1) {
  Image image{size, size, {}};
  image.channel("Z").values.assign(image.pixels(), kInfinity);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) image.channel("Z").values[static_cast<std::size_t>(y * size + x)] = 1;
  return image;
}

TEST(Outline, DistancesAreThoseOfTheBorders) {
  // B's left side is 3 pixels farther in, the rest is the same; the corner of A is 3 from B's nearest.
  const Image a = rectangle(64, 10, 40, 20, 50), b = rectangle(64, 13, 40, 20, 50);
  const auto d = compare(a, b, {});
  ASSERT_TRUE(d.ok());
  EXPECT_EQ(d->silhouette, 90U);
  EXPECT_EQ(d->outline_px.max, 3);
  EXPECT_EQ(d->outline_px.p50, 0);
  EXPECT_EQ(d->outline_px.count, 4U * 29 + 2 * (26 + 29));
  EXPECT_EQ(compare(a, a, {})->outline_px.max, 0);
}

TEST(Outline, DiagonalDistancesAreEuclidean) {
  const auto d = compare(rectangle(64, 10, 11, 10, 11), rectangle(64, 13, 14, 14, 15), {});
  EXPECT_NEAR(d->outline_px.max, 5, 1e-6);
  EXPECT_EQ(d->outline_px.count, 2U);
}

TEST(Outline, IsInfiniteFromNothingAndNoneOfTwoNothings) {
  const Image nothing = rectangle(32, 0, 0, 0, 0);
  EXPECT_EQ(compare(nothing, nothing, {})->outline_px.count, 0U);
  EXPECT_EQ(compare(rectangle(32, 5, 9, 5, 9), nothing, {})->outline_px.p50,
            std::numeric_limits<double>::infinity());
  const Image full = rectangle(32, 0, 32, 0, 32);
  EXPECT_EQ(compare(full, full, {})->outline_px.count, 0U) << "the picture's border is no outline";
}

TEST(Flip, BlackAgainstWhiteIsThePapersValue) {
  // In HyAB, black is 100 from white and the farthest colors, green and blue, are 203.3 apart: with the
  // paper's exponent 0.7 and its bend at (0.4, 0.95), 0.95 + 0.05 (100^0.7 − 0.4·203.3^0.7) /
  // (0.6·203.3^0.7).
  const std::vector<float> black(3 * 64 * 64, 0.0F), white(3 * 64 * 64, 1.0F);
  for (const float v : flip_error(black, white, 64, 64, 67)) EXPECT_NEAR(v, 0.9674, 1e-3);
}

TEST(Flip, GreenAgainstBlueIsTheLargestColorDifference) {
  std::vector<float> green, blue;
  for (int i = 0; i < 64 * 64; ++i) {
    green.insert(green.end(), {0, 1, 0});
    blue.insert(blue.end(), {0, 0, 1});
  }
  for (const float v : flip_error(green, blue, 64, 64, 67)) EXPECT_NEAR(v, 1, 1e-3);
}

TEST(Flip, IsSymmetricForFlatPicturesAndSeesEdges) {
  std::vector<float> flat(3 * 64 * 64, 0.5F), line = flat;
  for (int y = 0; y < 64; ++y)
    for (int k = 0; k < 3; ++k) line[static_cast<std::size_t>(3 * (64 * y + 32) + k)] = 0;
  const auto error = flip_error(flat, line, 64, 64, 67);
  const auto at = [&](int x) { return error[static_cast<std::size_t>(64 * 32 + x)]; };
  EXPECT_GT(at(32), 0.3F);
  EXPECT_LT(at(4), 0.01F);
  EXPECT_NEAR(at(30), at(34), 1e-4);
}

/// A plane at depth 100 that covers the middle of the picture.
Image depths(int size) {
  Image image{size, size, {}};
  image.pixel_constant = 0.5;
  for (const char* name : {"Z", "N.X", "N.Y", "N.Z"}) image.channel(name);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto i = static_cast<std::size_t>(y * size + x);
      const bool covered = x >= 5 && x < size - 5 && y >= 5 && y < size - 5;
      image.channel("Z").values[i] = covered ? 100.0F : kInfinity;
      image.channel("N.Z").values[i] = covered ? 1.0F : 0.0F;
    }
  return image;
}

TEST(GeometryMetrics, CountsHolesExtraAndSilhouette) {
  const Image a = depths(30);
  Image b = a;
  std::vector<float>& z = b.channel("Z").values;
  z[15 * 30 + 15] = kInfinity;   // a hole
  z[15 * 30 + 16] = 100 + 4.5F;  // nine pixels off: one too
  z[15 * 30 + 17] = 100 + 0.5F;  // one pixel off
  z[0] = 50;                     // far outside
  z[4 * 30 + 15] = 100;          // one pixel over the border
  const auto d = compare(a, b, {});
  ASSERT_TRUE(d.ok() && d->geometry);
  EXPECT_EQ(d->covered_a, 400U);
  EXPECT_EQ(d->covered_b, 401U);
  EXPECT_EQ(d->silhouette, 3U);
  EXPECT_EQ(d->geometry->interior, 256U);
  EXPECT_EQ(d->geometry->holes, 2U);
  EXPECT_EQ(d->geometry->extra, 1U);
  EXPECT_EQ(d->geometry->depth_px.count, 255U);
  EXPECT_NEAR(d->geometry->depth_px.max, 9, 1e-4);
  EXPECT_NEAR(d->geometry->depth_px.mean, 10.0 / 255, 1e-5);
  EXPECT_EQ(d->geometry->depth_px.p50, 0);
}

TEST(GeometryMetrics, MeasuresAngles) {
  const Image a = depths(30);
  Image b = a;
  const double angle = 3 * 3.14159265358979323846 / 180;
  for (std::size_t i = 0; i < b.pixels(); ++i)
    if (std::isfinite(b.channel("Z").values[i])) {
      b.channel("N.X").values[i] = static_cast<float>(std::sin(angle));
      b.channel("N.Z").values[i] = static_cast<float>(-std::cos(angle));
    }
  const auto d = compare(a, b, {});
  EXPECT_NEAR(d->geometry->normal_degrees.p50, 3, 1e-4);
  EXPECT_NEAR(d->geometry->normal_degrees.max, 3, 1e-4);
  EXPECT_EQ(d->geometry->opposed_normals, 256U);
}

TEST(GeometryMetrics, NamesThePixelsThatDiffer) {
  const Image a = depths(30);
  Image b = a;
  auto& z = b.channel("Z").values;
  z[15 * 30 + 15] = kInfinity;
  z[12 * 30 + 14] *= 1.001F;
  z[0] = 100;
  const auto worst = worst_pixels(a, b, {}, 3);
  ASSERT_TRUE(worst.ok());
  ASSERT_EQ(worst->size(), 3U);
  using Kind = PixelDifference::Kind;
  EXPECT_EQ((*worst)[0].kind, Kind::hole);
  EXPECT_EQ((*worst)[0].x, 15);
  EXPECT_EQ((*worst)[0].y, 15);
  EXPECT_EQ((*worst)[1].kind, Kind::extra);
  EXPECT_EQ((*worst)[1].x, 0);
  EXPECT_EQ((*worst)[2].kind, Kind::depth);
  EXPECT_EQ((*worst)[2].x, 14);
  EXPECT_GT((*worst)[2].depth_px, 0);
  EXPECT_FALSE(worst_pixels(a, depths(20), {}, 3).ok());
}

TEST(Distribution, PercentilesAreRanks) {
  std::vector<float> values;
  for (int i = 1000; i >= 1; --i) values.push_back(static_cast<float>(i));
  const Distribution d = distribution(values);
  EXPECT_EQ(d.p50, 500);
  EXPECT_EQ(d.p99, 990);
  EXPECT_EQ(d.p999, 999);
  EXPECT_EQ(d.max, 1000);
  EXPECT_NEAR(d.mean, 500.5, 1e-9);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  EXPECT_EQ(compare(gray(4, 4, 0), gray(4, 5, 0), {}).status().code, StatusCode::invalid_argument);
  EXPECT_EQ(compare(gray(4, 4, 0), depths(4), {}).status().code, StatusCode::invalid_argument);
  EXPECT_FALSE(difference_picture(gray(4, 4, 0), gray(4, 5, 0), {}).ok());
}

TEST(DifferencePicture, ShowsWhoCoversWhat) {
  const Image a = depths(20);
  Image b = a;
  b.channel("Z").values[10 * 20 + 10] = kInfinity;
  b.channel("Z").values[0] = 100;
  const auto picture = difference_picture(a, b, {});
  ASSERT_TRUE(picture.ok());
  const auto pixel = [&](int i) {
    return std::vector<int>(picture->values.begin() + 3 * i, picture->values.begin() + 3 * i + 3);
  };
  EXPECT_EQ(pixel(10 * 20 + 10), (std::vector<int>{40, 90, 255}));
  EXPECT_EQ(pixel(0), (std::vector<int>{30, 200, 60}));
  EXPECT_EQ(pixel(10 * 20 + 11), (std::vector<int>{0, 0, 0}));
}

}  // namespace
}  // namespace dupin::testing
