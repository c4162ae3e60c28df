// Point trees as files: `dupin tree`, what is drawn and said of a .dpt file, and the trees that `dupin
// render` keeps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "command.h"

namespace dupin::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A bumpy closed surface of 2 n² quadrilaterals in two groups.
std::string mesh_text(int n, double size = 1) {
  std::string text;
  const double step = 3.14159265358979 / n;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double r = size * (1 + 0.1 * std::sin(5 * i * step) * std::sin(3 * j * step));
      text += "v " + std::to_string(r * std::sin(i * step) * std::cos(j * step)) + ' ' +
              std::to_string(r * std::sin(i * step) * std::sin(j * step)) + ' ' +
              std::to_string(r * std::cos(i * step)) + '\n';
    }
  for (int i = 0; i < n; ++i) {
    if (i == 0 || i == n / 2) text += i == 0 ? "g upper\n" : "g lower\n";
    for (int j = 0; j < 2 * n; ++j) {
      const int a = 2 * n * i + 1, b = 2 * n * (i + 1) + 1, next = (j + 1) % (2 * n);
      text += "f";
      for (const int v : {a + j, b + j, b + next, a + next}) text += ' ' + std::to_string(v);
      text += '\n';
    }
  }
  return text;
}

Outcome render(const std::string& file, const std::string& output, std::vector<std::string> options = {}) {
  std::vector<std::string> arguments{"render",       file,      "-o",        output,
                                     "--resolution", "120,100", "--samples", "1"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome;
}

std::string tree_of(const Folder& folder, const std::string& file, std::vector<std::string> options = {}) {
  const std::string tree = folder.path("a.dpt");
  std::vector<std::string> arguments{"tree", file, "-o", tree};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run_dupin(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return tree;
}

void expect_the_same(const std::string& a, const std::string& b) {
  EXPECT_FALSE(read_file(a).empty());
  EXPECT_TRUE(read_file(a) == read_file(b)) << a << " and " << b << " differ";
}

TEST(Tree, IsDrawnAsTheMeshItWasMadeOf) {
  const Folder folder;
  const std::string mesh = folder.write("a.obj", mesh_text(40));
  const std::string tree = tree_of(folder, mesh);
  for (const char* primitive : {"pop", "qsplat", "auto", "triangles"}) {
    // The kind of tree that qsplat wants is another: it is made of the .dpt file's triangles.
    const bool exact = std::string(primitive) == "pop" || std::string(primitive) == "auto";
    render(mesh, folder.path("mesh.png"), {"--primitive", primitive});
    render(tree, folder.path("tree.png"), {"--primitive", primitive});
    if (exact) {
      expect_the_same(folder.path("mesh.png"), folder.path("tree.png"));
      continue;
    }
    const Outcome compared =
        run_dupin({"compare", folder.path("mesh.png"), folder.path("tree.png"), "--json"});
    EXPECT_LT(json::parse(compared.out)["rmse"].get<double>(), 3) << primitive << compared.out;
  }
}

TEST(Tree, OfVerticesIsDrawnAsQsplatDrawsTheMesh) {
  const Folder folder;
  const std::string mesh = folder.write("a.obj", mesh_text(40));
  const std::string tree = tree_of(folder, mesh, {"--kind", "qsplat"});
  render(mesh, folder.path("mesh.png"), {"--primitive", "qsplat"});
  render(tree, folder.path("tree.png"), {"--primitive", "qsplat"});
  expect_the_same(folder.path("mesh.png"), folder.path("tree.png"));
}

TEST(Tree, HasTheGroupsTheBoxAndTheSpaceOfItsFile) {
  const Folder folder;
  const std::string mesh = folder.write("a.obj", mesh_text(20));
  const std::string tree = tree_of(folder, mesh, {"--units", "inch"});
  const Outcome info = run_dupin({"info", tree, "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const json said = json::parse(info.out);
  const json of_mesh = json::parse(run_dupin({"info", mesh, "--json", "--units", "inch"}).out);
  EXPECT_EQ(said["format"], "point tree");
  EXPECT_EQ(said["point_tree"]["kind"], "pop");
  EXPECT_EQ(said["point_tree"]["triangles"], 2 * 2 * 20 * 20) << "degenerate triangles at the poles too";
  EXPECT_EQ(said["point_tree"]["bytes"], std::filesystem::file_size(tree));
  EXPECT_EQ(said["units"], of_mesh["units"]);
  for (const char* corner : {"min", "max"})
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(said["bounding_box"][corner][k], of_mesh["bounding_box"][corner][k], 1e-4);
  EXPECT_THAT(run_dupin({"info", tree}).out, HasSubstr("nodes over"));
  render(tree, folder.path("face.exr"), {"--aov", "face"});
  render(mesh, folder.path("mesh.exr"), {"--aov", "face", "--units", "inch"});
  expect_the_same(folder.path("mesh.exr"), folder.path("face.exr"));
}

TEST(Tree, OfACadFileIsOfItsTessellation) {
  const Folder folder;
  const std::string cad = sample("assembly.step"), tree = tree_of(folder, cad);
  render(cad, folder.path("cad.png"), {"--no-edges"});
  render(tree, folder.path("tree.png"));
  render(cad, folder.path("parts.png"), {"--no-edges", "--primitive", "pop"});
  for (const char* picture : {"tree.png", "parts.png"}) {
    const Outcome compared = run_dupin({"compare", folder.path("cad.png"), folder.path(picture), "--json"});
    ASSERT_EQ(compared.exit_code, 0) << compared.err;
    EXPECT_LT(json::parse(compared.out)["rmse"].get<double>(), 10) << picture << compared.out;
  }
}

TEST(Tree, IsTheSameFileEveryTime) {
  const Folder folder;
  const std::string mesh = folder.write("a.obj", mesh_text(30));
  const std::string first = read_file(tree_of(folder, mesh));
  EXPECT_TRUE(first == read_file(tree_of(folder, mesh)));
}

TEST(Tree, SaysInOneLineWhatIsWrong) {
  const Folder folder;
  const std::string mesh = folder.write("a.obj", mesh_text(10));
  const auto fails = [&](const std::vector<std::string>& arguments, int code) {
    const Outcome outcome = run_dupin(arguments);
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    return outcome.err;
  };
  fails({"tree", mesh, "-o", folder.path("a.ply")}, 2);
  fails({"tree", folder.path("none.obj"), "-o", folder.path("b.dpt")}, 3);
  fails({"tree", folder.write("empty.obj", "# nothing\n"), "-o", folder.path("b.dpt")}, 3);
  EXPECT_FALSE(std::filesystem::exists(folder.path("b.dpt")));

  const std::string tree = tree_of(folder, mesh);
  std::string bytes = read_file(tree);
  fails({"render", folder.write("short.dpt", bytes.substr(0, bytes.size() / 2)), "-o", folder.path("a.png")},
        3);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] + 1);
  const std::string damaged = folder.write("damaged.dpt", bytes);
  EXPECT_THAT(fails({"render", damaged, "-o", folder.path("a.png"), "--primitive", "triangles"}, 3),
              HasSubstr("damaged.dpt"));
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.png")));
}

TEST(TreeCache, IsFilledUsedAndMadeAgain) {
  const Folder folder, cache;
  const std::string mesh = folder.write("a.obj", mesh_text(40));
  const std::vector<std::string> options{"--tree-cache", cache.path("")};
  render(mesh, folder.path("first.png"), options);
  const std::vector<std::string> kept = cache.names();
  ASSERT_EQ(kept.size(), 1u);
  render(mesh, folder.path("plain.png"));
  expect_the_same(folder.path("plain.png"), folder.path("first.png"));
  render(mesh, folder.path("second.png"), options);
  expect_the_same(folder.path("first.png"), folder.path("second.png"));
  EXPECT_EQ(cache.names(), kept);

  // What is kept is what is drawn: another tree under that name shows; a damaged one does not.
  const std::string other = folder.write("b.obj", mesh_text(6, 0.5));
  std::filesystem::copy_file(tree_of(folder, other), cache.path(kept[0]),
                             std::filesystem::copy_options::overwrite_existing);
  render(mesh, folder.path("other.png"), options);
  EXPECT_TRUE(read_file(folder.path("other.png")) != read_file(folder.path("first.png")));
  std::filesystem::resize_file(cache.path(kept[0]), 100);
  render(mesh, folder.path("again.png"), options);
  expect_the_same(folder.path("first.png"), folder.path("again.png"));

  folder.write("a.obj", mesh_text(39));
  render(mesh, folder.path("changed.png"), options);
  EXPECT_EQ(cache.names().size(), 2u) << "a file that has changed has another tree";
}

}  // namespace
}  // namespace dupin::test
