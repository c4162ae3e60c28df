// dupin compare, as a tool calls it; the measures themselves are tested in tests/render.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../../render/image.h"
#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;

/// A picture of one value a channel, with a square of another in the middle.
Image square(int size, float value, float depth) {
  Image image;
  image.width = image.height = size;
  image.pixel_per_depth = 1e-3;
  for (const char* name : {"R", "G", "B", "A", "N.X", "N.Y", "N.Z", "Z"}) image.channel(name);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * size + x;
      const bool inside = x >= size / 4 && x < size * 3 / 4 && y >= size / 4 && y < size * 3 / 4;
      for (const char* name : {"R", "G", "B"}) image.channel(name).values[i] = inside ? value : 0;
      image.channel("A").values[i] = 1;
      image.channel("N.Z").values[i] = inside ? 1 : 0;
      image.channel("Z").values[i] = inside ? depth : std::numeric_limits<float>::infinity();
    }
  return image;
}

json compare_files(const std::string& a, const std::string& b, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"compare", a, b, "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(outcome.out, nullptr, false);
}

TEST(Compare, APictureIsLikeItself) {
  const Folder folder;
  ASSERT_TRUE(write_exr(folder.path("a.exr"), square(64, 0.5f, 10)).ok());
  const json d = compare_files(folder.path("a.exr"), folder.path("a.exr"));
  EXPECT_EQ(d["rmse"], 0);
  EXPECT_TRUE(d["psnr"].is_null());
  EXPECT_EQ(d["ssim"], 1);
  EXPECT_EQ(d["flip"], 0);
  EXPECT_EQ(d["silhouette_px"], 0);
  EXPECT_EQ(d["covered_px"], (json{32 * 32, 32 * 32}));
  EXPECT_EQ(d["geometry"]["holes_px"], 0);
  EXPECT_EQ(d["geometry"]["interior_px"], 28 * 28);
}

TEST(Compare, DepthIsMeasuredInPixels) {
  const Folder folder;
  ASSERT_TRUE(write_exr(folder.path("a.exr"), square(64, 0.5f, 10)).ok());
  ASSERT_TRUE(write_exr(folder.path("b.exr"), square(64, 0.5f, 10.02f)).ok());
  const json d = compare_files(folder.path("a.exr"), folder.path("b.exr"));
  EXPECT_NEAR(d["geometry"]["depth_px"]["p50"].get<double>(), 2, 1e-3);  // a pixel is 0.01 there
  EXPECT_EQ(d["geometry"]["normal_degrees"]["max"], 0);
}

TEST(Compare, PngsAreComparedByColor) {
  const Folder folder;
  ASSERT_TRUE(write_png(folder.path("a.png"), to_image8(square(64, 0.5f, 10))).ok());
  ASSERT_TRUE(write_png(folder.path("b.png"), to_image8(square(64, 0.4f, 10))).ok());
  const json d = compare_files(folder.path("a.png"), folder.path("b.png"));
  EXPECT_GT(d["rmse"], 1);
  EXPECT_GT(d["psnr"], 10);
  EXPECT_LT(d["ssim"], 1);
  EXPECT_GT(d["flip"], 0);
  EXPECT_FALSE(d.contains("geometry"));
}

TEST(Compare, WritesAPictureOfWhere) {
  const Folder folder;
  ASSERT_TRUE(write_exr(folder.path("a.exr"), square(64, 0.5f, 10)).ok());
  ASSERT_TRUE(write_exr(folder.path("b.exr"), square(64, 0.1f, 10)).ok());
  compare_files(folder.path("a.exr"), folder.path("b.exr"), {"--diff", folder.path("d.png")});
  const Result<Image8> diff = read_png(folder.path("d.png"));
  ASSERT_TRUE(diff.ok());
  EXPECT_EQ(diff->width, 64);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const Folder folder;
  ASSERT_TRUE(write_exr(folder.path("a.exr"), square(64, 0.5f, 10)).ok());
  ASSERT_TRUE(write_exr(folder.path("b.exr"), square(32, 0.5f, 10)).ok());
  const std::string text = folder.write("text.png", "no picture");
  const auto before = folder.names();
  EXPECT_EQ(run_dupin({"compare", folder.path("a.exr"), folder.path("b.exr"), "--diff", folder.path("d.png")})
                .exit_code,
            2);
  EXPECT_EQ(run_dupin({"compare", folder.path("a.exr"), text}).exit_code, 3);
  EXPECT_EQ(run_dupin({"compare", folder.path("a.exr"), folder.path("missing.exr")}).exit_code, 3);
  EXPECT_EQ(folder.names(), before);
}

}  // namespace
}  // namespace dupin::test
