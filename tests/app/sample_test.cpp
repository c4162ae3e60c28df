// What `dupin sample` promises: the columns, what the statistics say, the same bytes every time, one line for
// what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json sampled(const Folder& folder, const std::string& output, std::vector<std::string> options,
             const std::string& file = sample("freeform.step")) {
  const std::string stats = folder.path(output + ".json");
  std::vector<std::string> arguments{"sample", file, "-o", folder.path(output), "--stats", stats};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(read_file(stats), nullptr, false);
}

std::vector<std::vector<double>> rows(const std::string& csv) {
  std::istringstream lines(read_file(csv));
  std::string line, cell;
  std::getline(lines, line);
  EXPECT_EQ(line, "x,y,z,nx,ny,nz,d1x,d1y,d1z,k1,k2,u,v,face,hu,hv,bound");
  std::vector<std::vector<double>> table;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    table.emplace_back();
    while (std::getline(cells, cell, ',')) table.back().push_back(std::stod(cell));
  }
  return table;
}

TEST(Sample, CsvHasAFrameAndCurvaturesInEveryRow) {
  const Folder folder;
  const json stats = sampled(folder, "a.csv", {"--grid", "12", "--delta", "3", "--epsilon", "0.02"});
  const auto table = rows(folder.path("a.csv"));
  EXPECT_EQ(table.size(), stats["points"]["written"]);
  EXPECT_EQ(stats["points"]["before"], stats["points"]["after"]);
  EXPECT_EQ(stats["delta"], 3);
  double face = 1;
  for (const auto& r : table) {
    ASSERT_EQ(r.size(), 17U);
    EXPECT_NEAR(r[3] * r[3] + r[4] * r[4] + r[5] * r[5], 1, 1e-12);
    EXPECT_NEAR(r[3] * r[6] + r[4] * r[7] + r[5] * r[8], 0, 1e-12);
    EXPECT_GE(std::abs(r[9]), std::abs(r[10]));
    EXPECT_NEAR(r[14], std::min(3.0, std::sqrt(2 * 0.02 - 0.0004) / std::abs(r[9])), 1e-9);
    EXPECT_GE(r[13], face) << "faces come in order";
    face = r[13];
  }
  EXPECT_EQ(face, stats["faces"]["drawn"]);
}

TEST(Sample, PlyHoldsWhatTheCsvSays) {
  const Folder folder;
  sampled(folder, "a.csv", {"--method", "adaptive"});
  sampled(folder, "a.ply", {"--method", "adaptive"});
  const auto table = rows(folder.path("a.csv"));
  const std::string ply = read_file(folder.path("a.ply"));
  EXPECT_THAT(ply, HasSubstr("element vertex " + std::to_string(table.size()) + "\n"));
  const std::string end = "end_header\n";
  const std::size_t data = ply.find(end) + end.size();
  ASSERT_EQ(ply.size() - data, table.size() * (16 * 8 + 4));
  for (std::size_t i = 0; i < table.size(); i += 97) {
    const char* at = ply.data() + data + i * (16 * 8 + 4);
    for (std::size_t k = 0; k < 17; ++k) {
      double value = 0;
      std::uint32_t face = 0;
      std::memcpy(k == 13 ? static_cast<void*>(&face) : &value, at, k == 13 ? 4 : 8);
      at += k == 13 ? 4 : 8;
      EXPECT_EQ(k == 13 ? face : value, table[i][k]);
    }
  }
}

TEST(Sample, SimplifyLeavesFewerAndPackedRecordsAreSmaller) {
  const Folder folder;
  const json all = sampled(folder, "all.dps", {"--grid", "40"});
  const json fewer = sampled(folder, "fewer.dps", {"--grid", "40", "--simplify"});
  const json published =
      sampled(folder, "published.dps", {"--grid", "40", "--simplify", "--simplification", "published"});
  const json raw = sampled(folder, "raw.dps", {"--grid", "40", "--simplify", "--encode", "raw"});
  EXPECT_EQ(all["points"]["after"], fewer["points"]["before"]);
  EXPECT_LT(fewer["points"]["after"].get<int>() * 3, fewer["points"]["before"].get<int>());
  EXPECT_LT(fewer["points"]["after"], published["points"]["after"]);
  EXPECT_LT(published["points"]["after"], published["points"]["before"]);
  EXPECT_LT(fewer["bytes"]["file"], all["bytes"]["file"]);
  const double points = fewer["points"]["after"], overhead = 60 + 104.0 * (2 + points / 16384 + 8);
  EXPECT_LE(fewer["bytes"]["file"].get<double>(), 13 * points + overhead);
  EXPECT_GE(raw["bytes"]["file"].get<double>(), 62 * points);
  EXPECT_LE(raw["bytes"]["file"].get<double>(), 62 * points + overhead);
}

TEST(Sample, CertifiedPointsKeepTheirTolerance) {
  const Folder folder;
  const json stats = sampled(folder, "a.csv", {"--method", "certified", "--tolerance", "0.01"});
  EXPECT_LE(stats["bound"], 0.01);
  EXPECT_GT(stats["points"]["after"], 10);
  EXPECT_TRUE(stats["epsilon"].is_null());
}

TEST(Sample, PlacesAnAssembly) {
  const Folder folder;
  const json stats = sampled(folder, "a.csv", {"--grid", "5"}, sample("assembly.step"));
  EXPECT_GT(stats["points"]["written"], stats["points"]["after"]);
  EXPECT_EQ(rows(folder.path("a.csv")).size(), stats["points"]["written"]);
}

TEST(Sample, IsTheSameEveryTimeAtAnyNumberOfThreads) {
  const Folder folder;
  const std::vector<std::string> options{"--grid", "40", "--simplify"};
  sampled(folder, "a.dps", {"--grid", "40", "--simplify", "--threads", "1"});
  sampled(folder, "b.dps", {"--grid", "40", "--simplify", "--threads", "2"});
  EXPECT_EQ(read_file(folder.path("a.dps")), read_file(folder.path("b.dps")));
}

TEST(Sample, WrongUseIsOneLineAndExitCode2) {
  const Folder folder;
  const std::string file = sample("freeform.step"), out = folder.path("a.dps");
  const std::vector<std::vector<std::string>> wrong{
      {"sample", file, "-o", folder.path("a.xyz")},
      {"sample", file, "-o", folder.path("a.csv"), "--encode", "raw"},
      {"sample", file, "-o", out, "--grid", "1"},
      {"sample", file, "-o", out, "--grid", "5", "--spacing", "1"},
      {"sample", file, "-o", out, "--method", "adaptive", "--grid", "5"},
      {"sample", file, "-o", out, "--epsilon", "2"},
      {"sample", file, "-o", out, "--delta", "-1"},
      {"sample", file, "-o", out, "--tolerance", "1"},
      {"sample", file}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = run_dupin(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments.back();
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
  }
  EXPECT_TRUE(folder.names().empty()) << "a failing command leaves nothing behind";
}

TEST(Sample, MoreSamplesThanThereIsRoomForIsALimit) {
  const Folder folder;
  const Outcome outcome =
      run_dupin({"sample", sample("freeform.step"), "-o", folder.path("a.dps"), "--grid", "100000"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
  EXPECT_TRUE(folder.names().empty());
}

TEST(Sample, AMeshHasAPointAtEveryVertexThatLiesOnASurface) {
  const Folder folder;
  // A pyramid, a vertex beside it, and a triangle without area.
  const std::string file =
      folder.write("a.obj",
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0.1\nv 7 7 7\nv 8 0 0\nv 9 0 0\nv 10 0 0\n"
                   "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 7 8 9\n");
  for (const char* curvature : {"fitted", "taubin"}) {
    const json stats = sampled(folder, "a.csv", {"--mesh-curvature", curvature}, file);
    EXPECT_EQ(stats["points"]["written"], 5);
    EXPECT_EQ(stats["faces"]["drawn"], 1);
    ASSERT_EQ(stats["notes"].size(), 3U);
    EXPECT_THAT(stats["notes"][0].get<std::string>(), HasSubstr("1 vertices that no polygon uses"));
    EXPECT_THAT(stats["notes"][2].get<std::string>(),
                HasSubstr("3 vertices have only triangles without area"));
    const auto table = rows(folder.path("a.csv"));
    EXPECT_NEAR(table[4][9], -0.2 / 0.51, 0.02) << "the apex";
  }
}

TEST(Sample, AFileThatIsNoModelIsUnreadable) {
  const Folder folder;
  const std::string file = folder.write("x.step", "nothing");
  EXPECT_EQ(run_dupin({"sample", file, "-o", folder.path("a.dps")}).exit_code, 3);
}

}  // namespace
}  // namespace dupin::test
