// `dupin render --primitive amg`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;

json drawn(const Folder& folder, const std::string& file, const std::string& output,
           std::vector<std::string> options) {
  const std::string stats = folder.path(output + ".json");
  std::vector<std::string> arguments{"render",  file,  "-o",           folder.path(output),
                                     "--stats", stats, "--resolution", "160,120"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(read_file(stats), nullptr, false);
}

double flip(const std::string& a, const std::string& b) {
  const Outcome outcome = run_dupin({"compare", a, b, "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return json::parse(outcome.out, nullptr, false)["flip"].get<double>();
}

/// A scan of a sphere: points alone.
std::string scan(const Folder& folder, int points) {
  const std::string path = folder.path("scan.ply");
  std::ofstream file(path);
  file << "ply\nformat ascii 1.0\nelement vertex " << points
       << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (int i = 0; i < points; ++i) {
    const double z = 1 - (2.0 * i + 1) / points, r = std::sqrt(1 - z * z), turn = i * 2.399963229728653;
    file << r * std::cos(turn) << ' ' << r * std::sin(turn) << ' ' << z << '\n';
  }
  return path;
}

TEST(RenderAmg, OfACadPartLooksLikeIt) {
  const Folder folder;
  const std::string file = sample("freeform.step");
  drawn(folder, file, "exact.png", {"--no-edges"});
  const json stats = drawn(folder, file, "amg.png", {"--primitive", "amg"});
  EXPECT_EQ(stats["primitives"]["kind"], "amg");
  EXPECT_EQ(stats["faces"]["drawn"], 12);
  EXPECT_TRUE(stats["error"]["bound"].is_null());
  EXPECT_GT(stats["domains"]["points"], 1000);
  EXPECT_LT(stats["primitives"]["count"], stats["domains"]["points"]);
  EXPECT_LT(flip(folder.path("exact.png"), folder.path("amg.png")), 0.03);
}

TEST(RenderAmg, OfAScanHasAsManyDomainsAsItsLevel) {
  const Folder folder;
  const std::string file = scan(folder, 3000);
  std::size_t before = 0;
  for (int level = 0; level < 4; ++level) {
    const json stats =
        drawn(folder, file, "scan.png", {"--primitive", "amg", "--amg-level", std::to_string(level)});
    EXPECT_EQ(stats["domains"]["level"], level);
    EXPECT_EQ(stats["domains"]["points"], 3000);
    EXPECT_GT(stats["primitives"]["count"], before);
    EXPECT_GT(stats["image"]["covered_pixels"], 2000);
    before = stats["primitives"]["count"];
  }
}

TEST(RenderAmg, ShadesByDomainsAndByTheClassifier) {
  const Folder folder;
  const std::string file = sample("bracket.step");
  drawn(folder, file, "lit.png", {"--primitive", "amg", "--amg-level", "5"});
  for (const char* shading : {"domains", "classifier"}) {
    drawn(folder, file, "shaded.png", {"--primitive", "amg", "--amg-level", "5", "--shading", shading});
    EXPECT_GT(flip(folder.path("lit.png"), folder.path("shaded.png")), 0.02) << shading;
  }
}

TEST(RenderAmg, DrawsKeptDomainsAsTheyWere) {
  const Folder folder;
  const std::string file = sample("bracket.step"), kept = folder.path("kept.dom");
  drawn(folder, file, "a.png", {"--primitive", "amg", "--amg-level", "4", "--amg-save", kept});
  const json stats = drawn(folder, file, "b.png", {"--primitive", "amg", "--amg-load", kept});
  EXPECT_LT(flip(folder.path("a.png"), folder.path("b.png")), 1e-3);
  EXPECT_EQ(stats["faces"]["drawn"], 49);
  EXPECT_GT(stats["domains"]["texels"], 1000);
  const auto refused = [&](std::vector<std::string> arguments, int code) {
    arguments.insert(arguments.end(), {"--primitive", "amg", "-o", folder.path("c.png")});
    EXPECT_EQ(run_dupin(arguments).exit_code, code);
  };
  refused({"render", sample("freeform.step"), "--amg-load", kept}, 3);
  refused({"render", file, "--amg-load", file}, 3);
  refused({"render", file, "--amg-load", kept, "--amg-level", "2"}, 2);
  EXPECT_THAT(folder.names(), testing::Not(testing::Contains("c.png")));
}

TEST(RenderAmg, ChangesWithItsOptions) {
  const Folder folder;
  const std::string file = scan(folder, 3000);
  drawn(folder, file, "a.png", {"--primitive", "amg", "--amg-level", "3"});
  const std::vector<std::vector<std::string>> cases{{"--no-amg-normal-maps"},  {"--no-amg-heights"},
                                                    {"--amg-blend", "opaque"}, {"--amg-blend", "published"},
                                                    {"--amg-texel", "0.3"},    {"--amg-neighbors", "12"}};
  for (const auto& options : cases) {
    std::vector<std::string> all{"--primitive", "amg", "--amg-level", "3"};
    all.insert(all.end(), options.begin(), options.end());
    drawn(folder, file, "b.png", all);
    EXPECT_NE(read_file(folder.path("a.png")), read_file(folder.path("b.png"))) << options[0];
  }
}

}  // namespace
}  // namespace dupin::test
