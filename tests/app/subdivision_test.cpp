// What `dupin render --subdivision` promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kCube =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
/// The upper face's border is sharp, two of its edges softly.
constexpr const char* kCreases =
    "t crease 2/1/0 4 5 10\nt crease 2/1/0 5 7 10\nt crease 2/1/0 7 6 1.6\nt crease 2/1/0 6 4 1.6\n";

json render(const Folder& folder, const std::string& file, const std::string& output,
            std::vector<std::string> options) {
  const std::string stats = folder.path(output + ".json");
  std::vector<std::string> arguments{"render",  file,  "-o",           folder.path(output),
                                     "--stats", stats, "--resolution", "200,160"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(read_file(stats), nullptr, false);
}

/// By the criteria of CAD faces, beside the limit of uniform refinement.
void expect_like_fine_triangles(const Folder& folder, const std::string& file) {
  const json stats = render(folder, file, "a.exr", {"--subdivision", "--aov", "normal,depth"});
  EXPECT_LE(stats["error"]["bound_px"], 0.5);
  EXPECT_LE(stats["error"]["normal_bound_degrees"], 0.25);
  EXPECT_EQ(stats["error"]["estimated_primitives"], 0);
  render(folder, file, "b.exr",
         {"--subdivision", "--aov", "normal,depth", "--primitive", "triangles", "--deflection", "1e-4"});
  const Outcome outcome = run_dupin({"compare", folder.path("b.exr"), folder.path("a.exr"), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json difference = json::parse(outcome.out);
  EXPECT_LT(difference["silhouette_px"], 20) << outcome.out;
  EXPECT_EQ(difference["geometry"]["holes_px"], 0);
  EXPECT_LT(difference["geometry"]["depth_px"]["p99"], 0.25);
  EXPECT_LT(difference["geometry"]["normal_degrees"]["p99"], 0.5);
}

TEST(Subdivision, ACageIsDrawnAsItsLimit) {
  const Folder folder;
  const std::string cube = folder.write("cube.obj", kCube);
  EXPECT_EQ(render(folder, cube, "mesh.png", {})["faces"]["total"], 1);
  EXPECT_GT(render(folder, cube, "limit.png", {"--subdivision"})["faces"]["total"], 6);
  expect_like_fine_triangles(folder, cube);
}

TEST(Subdivision, CreasesAreKept) {
  const Folder folder;
  expect_like_fine_triangles(folder, folder.write("creased.obj", std::string(kCube) + kCreases));
}

TEST(Subdivision, TrianglesFollowLoop) {
  const Folder folder;
  expect_like_fine_triangles(
      folder, folder.write("octahedron.off",
                           "OFF\n6 8 0\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n"
                           "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n"));
}

TEST(Subdivision, WhatCannotBeSubdividedIsSaidInOneLine) {
  const Folder folder;
  const std::string cube = folder.write("cube.obj", kCube);
  const Outcome loop = run_dupin({"render", cube, "-o", folder.path("a.png"), "--subdivision=loop"});
  EXPECT_EQ(loop.exit_code, 2);
  EXPECT_EQ(loop.error_lines(), 1);
  EXPECT_THAT(loop.err, HasSubstr("triangles"));
  const Outcome exact =
      run_dupin({"render", sample("bracket.step"), "-o", folder.path("a.png"), "--subdivision"});
  EXPECT_EQ(exact.exit_code, 3);
  EXPECT_THAT(exact.err, HasSubstr("no mesh"));
  EXPECT_EQ(run_dupin({"render", cube, "-o", folder.path("a.png"), "--subdivision=doo-sabin"}).exit_code, 2);
}

}  // namespace
}  // namespace dupin::test
