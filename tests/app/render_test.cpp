// What `dupin render` promises when all is well: pictures, statistics, the same bytes every time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// Renders a sample with the options; returns the statistics.
json render(const Folder& folder, const std::string& output, std::vector<std::string> options = {},
            const std::string& file = sample("bracket.step"), const Environment& environment = {}) {
  const std::string stats = folder.path(output + ".json");
  std::vector<std::string> arguments{"render",  file,  "-o",           folder.path(output),
                                     "--stats", stats, "--resolution", "160,120"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_dupin(arguments, environment);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(read_file(stats), nullptr, false);
}

TEST(Render, StatisticsSayWhatWasDone) {
  const Folder folder;
  const json stats = render(folder, "a.png");
  ASSERT_TRUE(stats.is_object());
  EXPECT_EQ(stats["file"], sample("bracket.step"));
  EXPECT_GT(stats["faces"]["total"], 10);
  EXPECT_EQ(stats["faces"]["drawn"].get<int>() + static_cast<int>(stats["faces"]["skipped"].size()),
            stats["faces"]["total"]);
  EXPECT_EQ(stats["primitives"]["kind"], "quadric");
  EXPECT_GE(stats["primitives"]["count"], stats["faces"]["drawn"]);
  EXPECT_GT(stats["primitives"]["bytes"], 0);
  EXPECT_GT(stats["primitives"]["clips"], 0);
  EXPECT_GE(stats["error"]["bound"], 0);
  EXPECT_LE(stats["error"]["bound_px"], 0.5);
  EXPECT_LE(stats["error"]["normal_bound_degrees"], 0.25);
  EXPECT_EQ(stats["image"]["width"], 160);
  EXPECT_EQ(stats["image"]["height"], 120);
  EXPECT_GT(stats["image"]["covered_pixels"], 1000);
  EXPECT_LT(stats["image"]["covered_pixels"], 160 * 120);
  EXPECT_GT(stats["peak_rss_bytes"], 1'000'000);
  EXPECT_FALSE(stats["device"].get<std::string>().empty());
  EXPECT_FALSE(stats["gl_renderer"].get<std::string>().empty());
}

TEST(Render, TheStagesAddUpToTheTotal) {
  const Folder folder;
  const json t = render(folder, "a.png")["time_s"];
  double sum = 0;
  for (const char* stage : {"import", "prepare", "context", "upload", "first_frame", "write"}) {
    EXPECT_GT(t[stage].get<double>(), 0) << stage;
    sum += t[stage].get<double>();
  }
  EXPECT_GT(t["frame_median"].get<double>(), 0);
  EXPECT_LE(sum, t["total"].get<double>() * 1.001);
}

TEST(Render, TrianglesReportTheirMeshingAsPreparationAndCertifyNothing) {
  const Folder folder;
  const json stats = render(folder, "a.png", {"--primitive", "triangles", "--deflection", "1e-4"});
  EXPECT_EQ(stats["primitives"]["kind"], "triangles");
  EXPECT_GT(stats["primitives"]["count"], 100);
  EXPECT_GT(stats["time_s"]["prepare"].get<double>(), 0);
  EXPECT_TRUE(stats["error"]["bound"].is_null());
}

TEST(Render, FinerTolerancesGiveSmallerBounds) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  const json coarse = render(folder, "a.png", {"--tolerance", "2", "--normal-tolerance", "5"}, file);
  const json fine = render(folder, "b.png", {"--tolerance", "0.05", "--normal-tolerance", "0.1"}, file);
  EXPECT_LE(fine["error"]["bound_px"], 0.05);
  EXPECT_LE(fine["error"]["normal_bound_degrees"], 0.1);
  EXPECT_GT(fine["primitives"]["count"], coarse["primitives"]["count"]);
}

TEST(Render, NothingButTheOutputsIsLeft) {
  const Folder folder;
  render(folder, "a.png");
  EXPECT_THAT(folder.names(), ElementsAre("a.png", "a.png.json"));
}

class SameBytes : public testing::TestWithParam<const char*> {};

TEST_P(SameBytes, TwiceAndAtOneAndTwoThreads) {
  const Folder folder;
  const std::string ending = GetParam();
  const auto draw = [&](const std::string& name, std::vector<std::string> options) {
    if (ending == "exr")
      options.insert(options.end(),
                     {"--aov", "color,normal,depth,position,curvature,direction,face,primitive,uv"});
    render(folder, name + "." + ending, options);
    return read_file(folder.path(name + "." + ending));
  };
  const std::string first = draw("a", {});
  EXPECT_GT(first.size(), 1000u);
  EXPECT_TRUE(first == draw("b", {}));
  EXPECT_TRUE(first == draw("c", {"--threads", "1"}));
  EXPECT_TRUE(first == draw("d", {"--threads", "2"}));
  EXPECT_TRUE(first == draw("e", {"--repeat", "3"}));
}
INSTANTIATE_TEST_SUITE_P(Render, SameBytes, testing::Values("png", "exr"));

// Mesa's software renderer works in as many threads and with as wide vectors as the machine has. Its shader
// cache does not tell widths apart, so it is left out: code cached for wide vectors overruns its buffers
// where narrow ones are asked for (Mesa 22.3).
TEST(Render, SoftwareDrawsTheSameBytesAtAnyThreadCountAndVectorWidth) {
  const Folder folder;
  const auto draw = [&](const std::string& name, const Environment& environment) {
    const json stats = render(folder, name, {"--samples", "2"}, sample("freeform.step"), environment);
    return std::pair(stats["gl_renderer"].get<std::string>(), read_file(folder.path(name)));
  };
  const auto [renderer, first] = draw("a.png", {});
  if (renderer.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "no llvmpipe here: " << renderer;
  EXPECT_GT(first.size(), 1000u);
  for (const char* threads : {"0", "1", "5"})
    EXPECT_TRUE(first == draw("b.png", {{"LP_NUM_THREADS", threads}}).second) << threads << " threads";
  for (const char* width : {"128", "256"}) {
    const auto [narrow, picture] =
        draw("c.png", {{"LP_NATIVE_VECTOR_WIDTH", width}, {"MESA_SHADER_CACHE_DISABLE", "1"}});
    EXPECT_THAT(narrow, HasSubstr(std::string(width) + " bits"));
    EXPECT_TRUE(first == picture) << width << " bits";
  }
}

TEST(Render, SeveralFilesBecomeOnePicture) {
  const Folder folder;
  const json one = render(folder, "a.png");
  const std::string stats = folder.path("both.json");
  const Outcome outcome = run_dupin({"render", sample("bracket.step"), sample("freeform.step"), "-o",
                                     folder.path("b.png"), "--stats", stats, "--resolution", "160,120"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json both = json::parse(read_file(stats));
  EXPECT_EQ(both["file"].size(), 2u);
  EXPECT_GT(both["faces"]["total"], one["faces"]["total"]);
}

/// What an option changes must be seen in the picture.
class Changes : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(Changes, ThePicture) {
  const Folder folder;
  render(folder, "a.png");
  render(folder, "b.png", GetParam());
  EXPECT_FALSE(read_file(folder.path("a.png")) == read_file(folder.path("b.png")));
}
INSTANTIATE_TEST_SUITE_P(
    Render, Changes,
    testing::Values(
        std::vector<std::string>{"--view", "top"}, std::vector<std::string>{"--no-edges"},
        std::vector<std::string>{"--background", "black"}, std::vector<std::string>{"--background", "none"},
        std::vector<std::string>{"--color", "red"}, std::vector<std::string>{"--orthographic"},
        std::vector<std::string>{"--samples", "1"}, std::vector<std::string>{"--section=1,0,0,-20"},
        std::vector<std::string>{"--fov", "60", "--eye=200,-200,200"},
        std::vector<std::string>{"--shading", "normal"}, std::vector<std::string>{"--shading", "zebra"},
        std::vector<std::string>{"--shading", "mean"}, std::vector<std::string>{"--shading", "face"},
        std::vector<std::string>{"--shading", "primitive"}));

TEST(Render, BothDevicesDraw) {
  const Folder folder;
  EXPECT_THAT(render(folder, "a.png", {"--device", "egl"})["device"].get<std::string>(), HasSubstr("EGL"));
  EXPECT_THAT(render(folder, "b.png", {"--device", "osmesa"})["device"].get<std::string>(),
              HasSubstr("OSMesa"));
}

// A thousand times closer: the bound in pixels still holds, and the picture is full of the surface looked at.
TEST(Render, CloseUpsKeepTheBound) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  const Outcome outcome = run_dupin({"info", file, "--json"});
  const json box = json::parse(outcome.out)["bounding_box"];
  std::vector<double> middle, size;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = box["min"][axis], hi = box["max"][axis];
    middle.push_back((lo + hi) / 2 + 0.01 * (hi - lo));
    size.push_back(hi - lo);
  }
  // From above the first surface met is the cover's skin.
  const json whole = render(folder, "whole.png", {"--view", "top", "--orthographic"}, file);
  const std::string at = std::to_string(middle[0]) + "," + std::to_string(middle[1]) + ",";
  const json close = render(folder, "close.png",
                            {"--eye=" + at + std::to_string(box["max"][2].get<double>() + size[2]),
                             "--target=" + at + "0", "--up-vector", "0,1,0", "--orthographic", "--height",
                             std::to_string(std::max(size[0], size[1]) / 1000)},
                            file);
  EXPECT_LE(whole["error"]["bound_px"], 0.5);
  EXPECT_LE(close["error"]["bound_px"], 0.5);
  EXPECT_LE(close["error"]["normal_bound_degrees"], 0.25);
  EXPECT_EQ(close["image"]["covered_pixels"], 160 * 120);
  EXPECT_LT(close["error"]["bound"].get<double>(), whole["error"]["bound"].get<double>());
}

TEST(Info, SaysWhatTheSampleHolds) {
  const Outcome outcome = run_dupin({"info", sample("bracket.step"), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json info = json::parse(outcome.out);
  EXPECT_EQ(info["format"], "STEP");
  EXPECT_EQ(info["units"], "mm");
  EXPECT_EQ(info["faces"]["total"], info["faces"]["readable"]);
  int faces = 0;
  for (const auto& [kind, count] : info["faces"]["by_surface"].items()) faces += count.get<int>();
  EXPECT_EQ(faces, info["faces"]["readable"]);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_LT(info["bounding_box"]["min"][axis].get<double>(),
              info["bounding_box"]["max"][axis].get<double>());
  const Outcome table = run_dupin({"info", sample("bracket.step")});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_THAT(table.out, HasSubstr("STEP"));
}

TEST(Info, RepeatedPartsAreStoredOnce) {
  const Outcome outcome = run_dupin({"info", sample("assembly.step"), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json info = json::parse(outcome.out);
  EXPECT_LT(info["parts"], info["instances"]);
}

}  // namespace
}  // namespace dupin::test
