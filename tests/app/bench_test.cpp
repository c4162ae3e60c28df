// What `dupin bench` promises: every primitive over its knob, and both sides of every comparison do the same
// work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "command.h"
#include "study_table.h"

namespace dupin::test {
namespace {

using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

/// A vector of a command line, "--name=x,y,z".
std::array<double, 3> vector_of(const std::string& command, const std::string& name) {
  std::array<double, 3> v{};
  const std::size_t at = command.find("--" + name + "=");
  EXPECT_NE(at, std::string::npos) << command;
  EXPECT_EQ(std::sscanf(command.c_str() + at + name.size() + 3, "%lf,%lf,%lf", &v[0], &v[1], &v[2]), 3);
  return v;
}

/// The edge of a pixel at the target, of views of 30 degrees.
double pixel_edge(const std::string& command, double height) {
  const auto eye = vector_of(command, "eye"), target = vector_of(command, "target");
  const double away = std::hypot(eye[0] - target[0], eye[1] - target[1], eye[2] - target[2]);
  return 2 * away * std::tan(15 * kPi / 180) / height;
}

double diagonal(const std::string& model) {
  const auto info = nlohmann::json::parse(run_dupin({"info", model, "--json"}).out);
  const auto &lo = info["bounding_box"]["min"], &hi = info["bounding_box"]["max"];
  return std::hypot(hi[0].get<double>() - lo[0].get<double>(), hi[1].get<double>() - lo[1].get<double>(),
                    hi[2].get<double>() - lo[2].get<double>());
}

/// How far from the surface a row may draw, in pixels, by what its knob says.
double claimed_pixels(const Row& row, double diagonal_pixels) {
  const std::string& primitive = row.at("primitive");
  if (primitive == "quadric" || primitive == "amg") return number(row, "tolerance");
  if (primitive == "triangles") return number(row, "deflection") * diagonal_pixels;
  if (primitive == "pop") return number(row, "deflection") * diagonal_pixels + number(row, "splat-size");
  if (primitive == "dp") return std::max(1.0, 0.02 / 32 * diagonal_pixels);  // what rectangles stand out by
  // Spheres around vertices of a tessellation reach over their longest edges.
  if (primitive == "qsplat") return diagonal_pixels;
  // Splats reach to the next samples, N over each patch, in both of its directions.
  return 2 * diagonal_pixels / (number(row, "grid") - 1);
}

struct Side {
  const char* primitive;
  std::vector<const char*> models;
  const char* sizes;
  std::size_t rows;
  /// The part of the surface that one picture at least has where the exact one has it, normals within 0.1
  /// degrees. Spheres around the few vertices of a plane have little of it.
  double agreeing = 0.5;
};
void PrintTo(const Side& side, std::ostream* out) {
  *out << side.primitive;
}

class BothSides : public testing::TestWithParam<Side> {};

// Every row of `dupin bench`: its own camera, that of its command, puts the surfaces where the exact picture has
// them, and its outline too, as far as its knob claims; and where both see the same place, both show the same
// color, rounding apart.
TEST_P(BothSides, DoTheSameWorkInEveryConfiguration) {
  const Side& side = GetParam();
  const Folder folder;
  std::string corpus;
  std::map<std::string, double> diagonals;
  for (const char* name : side.models) {
    corpus += (corpus.empty() ? "" : ",") + sample(name);
    diagonals[sample(name)] = diagonal(sample(name));
  }
  const Outcome outcome = run_dupin({"bench", "--corpus", corpus, "-o", folder.path("r"), "--sizes", side.sizes,
                                     "--frames", "1", "--prepares", "1", "--programs", "0", "--no-report",
                                     "--primitives", side.primitive});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<Row> rows = table(folder.path("r/timed.csv"));
  ASSERT_EQ(rows.size(), side.rows);
  std::vector<std::string> commands(rows.size());
  std::istringstream lines(read_file(folder.path("r/rows.jsonl")));
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line);
    commands[json["row"].get<std::size_t>()] = json["command"];
  }
  double most_agreeing = 0;
  for (const Row& row : rows) {
    const std::string& command = commands[static_cast<std::size_t>(number(row, "row"))];
    SCOPED_TRACE(row.at("row") + " " + command);
    ASSERT_EQ(row.at("status"), "ok");
    const double claimed =
        claimed_pixels(row, diagonals[row.at("model")] / pixel_edge(command, number(row, "height")));
    if (!row.at("outline_p99_px").empty()) {
      EXPECT_LE(number(row, "outline_p99_px"), claimed + 1.5);
    }
    EXPECT_LE(number(row, "depth_p50_px"), claimed + 0.5);
    const double agreeing = number(row, "agreeing_px") / number(row, "reference_covered_px");
    most_agreeing = std::max(most_agreeing, agreeing);
    if (agreeing > 0.02) {
      EXPECT_LE(number(row, "agreeing_color_p99"), 2);
    }
    EXPECT_GT(number(row, "frame_ms"), 0);
    EXPECT_GT(number(row, "frame_cpu_ms"), 0);
    EXPECT_GT(number(row, "prepare_s"), 0);
    EXPECT_GT(number(row, "bytes"), 0);
    EXPECT_FALSE(row.at("commit").empty() || row.at("cpu").empty());
  }
  EXPECT_GT(most_agreeing, side.agreeing) << "too few pixels were compared in every picture";
}

const std::vector<const char*> kBoth{"bracket.step", "freeform.step"};
INSTANTIATE_TEST_SUITE_P(
    Bench, BothSides,
    testing::Values(Side{"quadric", kBoth, "96", 30}, Side{"triangles", {"bracket.step"}, "96,128", 24},
                    Side{"dp", kBoth, "96", 18}, Side{"square", kBoth, "96", 18},
                    Side{"rectangle", kBoth, "96", 18}, Side{"ellipse", kBoth, "96", 18},
                    Side{"pop", {"bracket.step"}, "96,128", 24}, Side{"qsplat", {"freeform.step"}, "96", 12, 0},
                    Side{"amg", {"freeform.step"}, "64", 9, 0.2}),
    [](const auto& info) { return std::string(info.param.primitive); });

TEST(Bench, ListsWhatItWouldMeasure) {
  const Outcome outcome = run_dupin({"bench", "--corpus", sample("bracket.step"), "--list"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* primitive :
       {"quadric", "triangles", "dp", "square", "rectangle", "ellipse", "pop", "qsplat", "amg"})
    EXPECT_THAT(outcome.out, HasSubstr(std::string("--primitive ") + primitive + " "));
}

TEST(Bench, RefusesWhatCannotBeMeasuredBeforeAnyWork) {
  const Folder folder;
  const std::vector<std::vector<std::string>> wrong{
      {"--corpus", folder.path("nowhere")}, {"--corpus", sample("bracket.step"), "--primitives", "voxel"},
      {"--corpus", sample("bracket.step"), "--sizes", "0"}, {"--corpus", sample("bracket.step"), "--programs=-1"}};
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), {"bench", "-o", folder.path("r")});
    const Outcome outcome = run_dupin(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments.back() << outcome.err;
    EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
    EXPECT_THAT(folder.names(), testing::IsEmpty());
  }
}

}  // namespace
}  // namespace dupin::test
