// `dupin render` of differential points and splats, sampled or read from .dps files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json drawn(const Folder& folder, const std::string& file, const std::string& output,
           std::vector<std::string> options) {
  const std::string stats = folder.path(output + ".json");
  std::vector<std::string> arguments{"render",  file,  "-o",           folder.path(output),
                                     "--stats", stats, "--resolution", "200,150"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(read_file(stats), nullptr, false);
}

/// RMSE of 8-bit colors, silhouette pixels that differ.
json compared(const std::string& a, const std::string& b) {
  const Outcome outcome = run_dupin({"compare", a, b, "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(outcome.out, nullptr, false);
}

TEST(RenderPoints, LookLikeTheSurface) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  const json exact = drawn(folder, file, "exact.png", {"--no-edges"});
  for (const char* shading : {"published", "analytic"}) {
    const json points =
        drawn(folder, file, "dp.png", {"--no-edges", "--primitive", "dp", "--point-shading", shading});
    EXPECT_EQ(points["primitives"]["kind"], "dp");
    EXPECT_GT(points["primitives"]["count"], 100);
    EXPECT_EQ(points["faces"]["drawn"], exact["faces"]["drawn"]);
    EXPECT_TRUE(points["error"]["bound"].is_null());
    const json difference = compared(folder.path("exact.png"), folder.path("dp.png"));
    EXPECT_LT(difference["rmse"].get<double>(), 12) << shading << difference.dump();
  }
  for (const char* splat : {"square", "rectangle", "ellipse"}) {
    drawn(folder, file, "splat.png", {"--no-edges", "--primitive", splat});
    EXPECT_LT(compared(folder.path("exact.png"), folder.path("splat.png"))["rmse"].get<double>(), 25)
        << splat;
  }
}

TEST(RenderPoints, TakeTheOptionsOfSampling) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  const auto count = [&](std::vector<std::string> options) {
    options.insert(options.end(), {"--primitive", "dp"});
    return drawn(folder, file, "a.png", options)["primitives"]["count"].get<int>();
  };
  const int coarse = count({"--grid", "10"}), fine = count({"--grid", "20"}),
            simplified = count({"--grid", "20", "--simplify"});
  EXPECT_GT(fine, 3 * coarse);
  EXPECT_LT(simplified, fine);
  EXPECT_LT(count({"--method", "adaptive", "--epsilon", "0.05"}),
            count({"--method", "adaptive", "--epsilon", "0.001"}));
}

TEST(RenderPoints, OfADpsFileAreThoseThatWereWritten) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  const std::vector<std::string> options{"--method", "adaptive", "--epsilon", "0.005", "--delta", "4"};
  for (const char* encoding : {"raw", "packed"}) {
    std::vector<std::string> sampling{"sample", file, "-o", folder.path("a.dps"), "--encode", encoding};
    sampling.insert(sampling.end(), options.begin(), options.end());
    ASSERT_EQ(run_dupin(sampling).exit_code, 0);
    std::vector<std::string> direct{"--primitive", "dp"};
    direct.insert(direct.end(), options.begin(), options.end());
    const json sampled = drawn(folder, file, "sampled.png", direct);
    const json read = drawn(folder, folder.path("a.dps"), "read.png", {});
    EXPECT_EQ(read["primitives"]["kind"], "dp");
    EXPECT_EQ(read["primitives"]["count"], sampled["primitives"]["count"]);
    // The view is fitted to what the file holds, rectangles included, which is a little more than the
    // surface.
    EXPECT_LT(compared(folder.path("sampled.png"), folder.path("read.png"))["rmse"].get<double>(), 25)
        << encoding;
    EXPECT_EQ(
        drawn(folder, folder.path("a.dps"), "ellipse.png", {"--primitive", "ellipse"})["primitives"]["kind"],
        "ellipse");
  }
}

TEST(RenderPoints, WithoutAColorAreTheSameInAFile) {
  const Folder folder;
  const std::string mesh = folder.write("plate.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
  const std::vector<std::string> camera{"--eye", "0,-3,4", "--target", "0,0,0", "--primitive", "dp"};
  ASSERT_EQ(run_dupin({"sample", mesh, "-o", folder.path("a.dps")}).exit_code, 0);
  drawn(folder, mesh, "sampled.png", camera);
  drawn(folder, folder.path("a.dps"), "read.png", camera);
  EXPECT_LT(compared(folder.path("sampled.png"), folder.path("read.png"))["rmse"].get<double>(), 3);
}

TEST(RenderPoints, ADamagedDpsFileIsUnreadable) {
  const Folder folder;
  ASSERT_EQ(
      run_dupin({"sample", sample("freeform.step"), "-o", folder.path("a.dps"), "--grid", "8"}).exit_code, 0);
  std::string bytes = read_file(folder.path("a.dps"));
  bytes[bytes.size() / 2] ^= 4;
  const Outcome outcome = run_dupin({"render", folder.write("b.dps", bytes), "-o", folder.path("b.png")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("b.dps: a chunk is damaged"));
  EXPECT_THAT(folder.names(), testing::ElementsAre("a.dps", "b.dps"));
}

TEST(RenderPoints, LightsOfOnesOwnShowOnEveryPrimitive) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  for (const char* primitive : {"quadric", "dp", "ellipse", "triangles"}) {
    drawn(folder, file, "usual.png", {"--primitive", primitive});
    drawn(folder, file, "lit.png",
          {"--primitive", primitive, "--light", "500,-300,800", "--light=-500,0,100"});
    EXPECT_GT(compared(folder.path("usual.png"), folder.path("lit.png"))["rmse"].get<double>(), 5)
        << primitive;
  }
}

TEST(RenderPoints, WrongUseIsOneLineAndExitCode2) {
  const Folder folder;
  const std::string file = sample("freeform.step"), out = folder.path("a.png"),
                    dps = folder.write("x.dps", "");
  const std::vector<std::vector<std::string>> wrong{
      {"render", file, "-o", out, "--epsilon", "0.1"},
      {"render", file, "-o", out, "--point-shading", "analytic"},
      {"render", file, dps, "-o", out},
      {"render", dps, "-o", out, "--primitive", "quadric"},
      {"render", dps, "-o", out, "--simplify"},
      {"render", file, "-o", out, "--light", "1,2"},
      {"render", file, "-o", out, "--primitive", "dp", "--method", "adaptive", "--grid", "4"}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = run_dupin(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments.back();
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
  }
}

}  // namespace
}  // namespace dupin::test
