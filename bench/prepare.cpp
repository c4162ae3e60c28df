// Preparing to draw: Dupin's quadric DPs, certificates and trims included, beside Open CASCADE's triangles.
//
// Both sides get the same file in the same process, one run of each in turn, and as many threads as there
// are. The tolerance is a fraction of the model's diagonal for both. Normals are to be no worse than the
// triangles' interpolated ones: the largest certified angle that Dupin is allowed is what 99 % of the
// triangles' area stays below, on the faces that are no quadric
// (--normals DEG sets another). Every file is measured in a process of its own, so that a crash of the kernel
// costs one row.
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "../cad_import/cad_import.h"
#include "../core/parallel.h"
#include "../sampling/sampler.h"
#include "occt_side.h"
#include "report.h"

namespace dupin::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kPi = 3.14159265358979323846;
// Normals of triangles that are all but exact (ruled faces), or all but arbitrary (collapsed ones), set no
// standard.
constexpr double kFinestNormalDegrees = 0.02, kCoarsestNormalDegrees = 5;

struct Options {
  std::vector<std::string> paths;
  std::vector<double> tolerances{2.5e-4, 1e-5};
  double normal_degrees = 0;  ///< 0: as good as the triangles'
  double angle_radians = 0.5;
  int runs = 3, threads = 0, seconds_a_file = 300;
  std::string output;
};

std::size_t count_on_curved(const Model& model, const DpScene& scene) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    for (const QuadricDp& dp : scene.parts[i].dps)
      count += !is_quadric(model.parts[i].surfaces[model.parts[i].faces[dp.face].surface]);
  return count;
}

std::size_t skipped_faces(const DpScene& scene) {
  std::size_t count = 0;
  for (const PartDps& part : scene.parts) count += part.skipped.size();
  return count;
}

Json measure_at(const Options& options, const Model& model, OcctShape& shape, double tolerance) {
  const double diagonal = bounding_box(model).diagonal();
  shape.mesh(tolerance * diagonal, options.angle_radians);
  const OcctShape::Triangles triangles = shape.triangles();
  const double normal_degrees =
      options.normal_degrees > 0
          ? options.normal_degrees
          : std::clamp(triangles.normal_p99_degrees, kFinestNormalDegrees, kCoarsestNormalDegrees);
  SamplingOptions sampling;
  sampling.tolerance = tolerance * diagonal;
  sampling.normal_tolerance = normal_degrees * kPi / 180;

  std::vector<double> ours, theirs;
  Result<DpScene> scene(StatusCode::cancelled, "no run");
  for (int run = 0; run < options.runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    scene = sample_quadric_dps(model, sampling);
    ours.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (!scene.ok()) return {{"failed", scene.status().message}};
    theirs.push_back(shape.mesh(tolerance * diagonal, options.angle_radians));
  }
  return {{"tolerance", tolerance},
          {"normal_degrees", normal_degrees},
          {"triangle_normal_p99_degrees", triangles.normal_p99_degrees},
          {"dupin_s", median(ours)},
          {"mesh_s", median(theirs)},
          {"faster", median(theirs) / median(ours)},
          {"dps", scene->count()},
          {"triangles", triangles.triangles},
          {"dps_on_curved", count_on_curved(model, *scene)},
          {"triangles_on_curved", triangles.on_curved},
          {"bound", scene->bound / diagonal},
          {"normal_bound_degrees", scene->normal_bound * 180 / kPi},
          {"skipped_faces", skipped_faces(*scene)}};
}

/// One JSON line a tolerance to standard output.
int measure(const Options& options, const std::string& path) {
  const auto print = [&](Json row) {
    row["file"] = path;
    std::cout << row.dump() << std::endl;
    return 0;
  };
  set_thread_limit(options.threads);
  const Result<Model> model = import_cad(path, {});
  if (!model.ok()) return print({{"failed", model.status().message}});
  const auto shape = OcctShape::read(path);
  if (!shape) return print({{"failed", "Open CASCADE does not read it here"}});
  for (double tolerance : options.tolerances) print(measure_at(options, *model, *shape, tolerance));
  return 0;
}

/// In a child process: neither side's threads, memory or crashes reach the next file.
std::vector<Json> measure_apart(const Options& options, const std::string& path) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    alarm(static_cast<unsigned>(options.seconds_a_file));
    _exit(measure(options, path));
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  std::vector<Json> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (Json row = Json::parse(line, nullptr, false); row.is_object()) rows.push_back(row);
  if (WIFSIGNALED(status)) {
    const bool late = WTERMSIG(status) == SIGALRM;
    rows.push_back({{"file", path}, {"failed", late ? "took too long" : strsignal(WTERMSIG(status))}});
  }
  return rows;
}

std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  static const std::vector<std::string> kEndings{".step", ".stp", ".iges", ".igs", ".brep", ".brp"};
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      const std::string ending = entry.path().extension().string();
      if (std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end())
        files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

int run(const Options& options) {
  const std::vector<std::string> files = files_of(options.paths);
  if (files.empty()) return std::fprintf(stderr, "no CAD files; set DUPIN_DATA or name some\n"), 2;
  std::ofstream output;
  if (!options.output.empty()) output.open(options.output);
  std::vector<Json> all;
  std::printf("%s\n", table_line(nullptr).c_str());
  for (const std::string& file : files) {
    for (const Json& row : measure_apart(options, file)) {
      std::printf("%s\n", table_line(&row).c_str());
      std::fflush(stdout);
      if (output) output << row.dump() << std::endl;
      all.push_back(row);
    }
  }
  print_summary(all);
  return 0;
}

}  // namespace
}  // namespace dupin::bench

int main(int argc, char** argv) {
  dupin::bench::Options options;
  CLI::App app{"Dupin's preparation beside Open CASCADE's tessellation, on the same files in one run."};
  app.add_option("PATH", options.paths, "Files, or folders of them (default: $DUPIN_DATA)");
  app.add_option("--tolerance", options.tolerances, "Fractions of the diagonal")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--normals", options.normal_degrees,
                 "Largest certified angle in degrees (default: the triangles' 99 %)");
  app.add_option("--angle", options.angle_radians, "The mesh's angular deflection in radians")
      ->capture_default_str();
  app.add_option("--runs", options.runs, "Runs of each, in turn; medians count")->capture_default_str();
  app.add_option("--threads", options.threads, "Dupin's threads (default: one per core, as the mesh has)");
  app.add_option("--seconds", options.seconds_a_file, "Longest time for one file")->capture_default_str();
  app.add_option("-o,--output", options.output, "JSON lines, a row each");
  CLI11_PARSE(app, argc, argv);
  if (const char* data = std::getenv("DUPIN_DATA"); options.paths.empty() && data) options.paths = {data};
  return dupin::bench::run(options);
}
