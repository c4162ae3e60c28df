// Frame times of whole pictures: quadric DPs beside triangles at 2.5e-4 and 1e-5 of the diagonal, drawn by
// the same renderer with the same camera and shading. The three kinds take turns within each file, so that a
// busy moment of the machine hits all of them; medians count. Processor time, of all threads, is shown too:
// it hardly depends on what else the machine does.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "../cad_import/cad_import.h"
#include "../cad_import/model_stream.h"
#include "../render/renderer.h"
#include "../render/view.h"
#include "../sampling/sampler.h"
#include "report.h"

namespace dupin::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Options {
  std::vector<std::string> paths;
  int size = 1024, repeat = 10, rounds = 3, samples = 1;
  bool edges = false, only_quadric = false, prepare = false;
  std::string view = "iso", cache, output;
};

struct Kind {
  const char* name;
  double deflection;  ///< 0: quadric DPs
};
constexpr std::array<Kind, 3> kKinds{{{"quadric", 0}, {"2.5e-4", 2.5e-4}, {"1e-5", 1e-5}}};

double processor_milliseconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

/// From the cache if it is there and was written by this version.
Result<Model> read(const Options& options, const std::string& path, double deflection) {
  ImportOptions import;
  import.mesh_deflection = deflection;
  import.time_limit_seconds = 300;
  if (options.cache.empty()) return import_cad(path, import);
  const std::size_t key = std::hash<std::string>{}(fs::absolute(path).string() + std::to_string(deflection));
  const fs::path stored = fs::path(options.cache) / (std::to_string(key) + ".model");
  if (std::ifstream in{stored, std::ios::binary}) {
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    if (auto model = read_model(bytes); model.ok()) return model;
  }
  auto model = import_cad(path, import);
  if (!model.ok()) return model;
  const std::string bytes = write_model(*model);
  std::ofstream(stored, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return model;
}

/// One kind of one file, ready to draw.
struct Drawn {
  std::unique_ptr<Scene> scene;
  std::vector<double> wall, processor;
};

struct Bench {
  const Options& options;
  std::unique_ptr<Context> context;
  std::unique_ptr<Renderer> renderer;
  DrawOptions draw;
  Camera camera;

  Result<Drawn> prepare(const std::string& path, const Kind& kind) const {
    auto model = read(options, path, kind.deflection);
    if (!model.ok()) return model.status();
    if (kind.deflection > 0) return upload(*model, nullptr);
    SamplingOptions sampling;
    sampling.camera = camera;
    const auto dps = sample_quadric_dps(*model, sampling);
    if (!dps.ok()) return dps.status();
    return upload(*model, &*dps);
  }

  Result<Drawn> upload(const Model& model, const DpScene* dps) const {
    auto scene = renderer->upload(model, dps);
    if (!scene.ok()) return scene.status();
    Drawn drawn;
    drawn.scene = std::move(*scene);
    return drawn;
  }

  void time(Drawn& drawn, int frames) const {
    for (int i = 0; i < frames; ++i) {
      const double before = processor_milliseconds();
      const auto stats = renderer->draw_only(*drawn.scene, camera, draw);
      if (!stats.ok()) return;
      drawn.wall.push_back(stats->milliseconds);
      drawn.processor.push_back(processor_milliseconds() - before);
    }
  }

  Json measure(const std::string& path) {
    const auto model = read(options, path, 0);
    if (!model.ok()) return {{"failed", model.status().message}};
    Camera settings;
    settings.width = settings.height = options.size;
    const auto fitted = fit_view(bounding_box(*model), options.view, settings);
    if (!fitted.ok()) return {{"failed", fitted.status().message}};
    camera = *fitted;
    Json row;
    std::vector<Drawn> kinds;
    for (const Kind& kind : kKinds) {
      if (options.only_quadric && kind.deflection > 0) continue;
      auto drawn = prepare(path, kind);
      if (!drawn.ok()) return {{"failed", drawn.status().message}};
      if (options.prepare) continue;
      time(*drawn, 2);  // programs are compiled by the first frame
      drawn->wall.clear();
      drawn->processor.clear();
      kinds.push_back(std::move(*drawn));
    }
    for (int round = 0; round < options.rounds; ++round)
      for (Drawn& drawn : kinds) time(drawn, options.repeat);
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const SceneInfo& info = kinds[k].scene->info();
      // What any renderer of triangles needs: not the face of each, which the AOVs are drawn with here.
      const std::size_t bytes = info.bytes - (kKinds[k].deflection > 0 ? 4 * info.primitives : 0);
      row[kKinds[k].name] = {
          {"ms", median(kinds[k].wall)},
          {"processor_ms", median(kinds[k].processor)},
          {"least_processor_ms", *std::min_element(kinds[k].processor.begin(), kinds[k].processor.end())},
          {"primitives", info.primitives},
          {"bytes", bytes}};
    }
    return row;
  }
};

std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  static const std::vector<std::string> kEndings{".step", ".stp", ".iges",  ".igs",
                                                 ".brep", ".brp", ".fcstd", ".gz"};
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      std::string ending = entry.path().extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end())
        files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void print_row(const std::string& path, const Json& row) {
  const std::string name = fs::path(path).filename().string();
  if (row.contains("failed")) {
    std::printf("%-40.40s %s\n", name.c_str(), row["failed"].get<std::string>().c_str());
  } else {
    std::printf("%-40.40s", name.c_str());
    for (const char* number : {"ms", "processor_ms"})
      for (const Kind& kind : kKinds)
        if (row.contains(kind.name)) std::printf(" %8.2f", row[kind.name][number].get<double>());
    const auto bytes = [&](const Kind& kind) {
      return row.contains(kind.name) ? row[kind.name]["bytes"].get<double>() : 0.0;
    };
    std::printf(" %7zu %8.1f KB %6.1f %%\n", row["quadric"]["primitives"].get<std::size_t>(),
                bytes(kKinds[0]) / 1e3, 100 * bytes(kKinds[0]) / std::max(1.0, bytes(kKinds[1])));
  }
  std::fflush(stdout);
}

void print_summary(const std::vector<Json>& rows) {
  for (std::size_t k = 1; k < kKinds.size(); ++k)
    for (const char* number : {"ms", "processor_ms"}) {
      std::vector<double> ratios;
      for (const Json& row : rows)
        if (row.contains(kKinds[k].name))
          ratios.push_back(row[kKinds[k].name][number].get<double>() / row["quadric"][number].get<double>());
      if (!ratios.empty())
        std::printf("median over %zu files: quadric DPs %.2f times as fast as triangles at %s (%s)\n",
                    ratios.size(), median(ratios), kKinds[k].name, number);
    }
  std::vector<double> bytes;
  for (const Json& row : rows)
    if (row.contains("2.5e-4"))
      bytes.push_back(row["quadric"]["bytes"].get<double>() /
                      std::max(1.0, row["2.5e-4"]["bytes"].get<double>()));
  if (!bytes.empty())
    std::printf("median over the files: %.1f %% of the triangles' bytes at 2.5e-4\n", 100 * median(bytes));
}

int run(const Options& options) {
  const std::vector<std::string> files = files_of(options.paths);
  if (files.empty()) return std::fprintf(stderr, "no CAD files; set DUPIN_DATA or name some\n"), 2;
  auto context = create_context(Device::automatic);
  if (!context.ok()) return std::fprintf(stderr, "%s\n", context.status().message.c_str()), 6;
  auto renderer = Renderer::create((*context)->loader());
  if (!renderer.ok()) return std::fprintf(stderr, "%s\n", renderer.status().message.c_str()), 6;
  Bench bench{options, std::move(*context), std::move(*renderer), {}, {}};
  bench.draw.edges = options.edges;
  bench.draw.samples = options.samples;
  bench.draw.outputs = kScreen;
  std::ofstream output;
  if (!options.output.empty()) output.open(options.output);
  std::printf("%-40s %26s %26s\n%-40s", "on", bench.renderer->gl_renderer().c_str(), "", "file");
  for (const char* number : {"ms", "cpu"})
    for (const Kind& kind : kKinds)
      std::printf(" %8s", (std::string(number) + ' ' + kind.name).substr(0, 8).c_str());
  std::printf("     DPs  their bytes, of 2.5e-4's\n");
  std::vector<Json> rows;
  for (const std::string& file : files) {
    Json row = bench.measure(file);
    if (options.prepare) continue;
    print_row(file, row);
    row["file"] = file;
    if (output) output << row.dump() << std::endl;
    if (!row.contains("failed")) rows.push_back(std::move(row));
  }
  print_summary(rows);
  return 0;
}

}  // namespace
}  // namespace dupin::bench

int main(int argc, char** argv) {
  dupin::bench::Options options;
  CLI::App app{"Frame times of quadric DPs beside triangles, drawn by the same renderer in one process."};
  app.add_option("PATH", options.paths, "Files, or folders of them (default: $DUPIN_DATA)");
  app.add_option("--size", options.size, "Pictures are SIZE x SIZE")->capture_default_str();
  app.add_option("--samples", options.samples, "Samples a pixel")->capture_default_str();
  app.add_option("--repeat", options.repeat, "Frames of each kind in a round")->capture_default_str();
  app.add_option("--rounds", options.rounds, "Rounds")->capture_default_str();
  app.add_option("--view", options.view, "A standard view")->capture_default_str();
  app.add_flag("--edges", options.edges, "With feature edges");
  app.add_flag("--only-quadric", options.only_quadric, "No triangles");
  app.add_option("--cache", options.cache, "A folder where models that were read are kept");
  app.add_flag("--prepare", options.prepare, "Only fill the cache");
  app.add_option("-o,--output", options.output, "JSON lines, a row each");
  CLI11_PARSE(app, argc, argv);
  if (options.paths.empty())
    if (const char* data = std::getenv("DUPIN_DATA")) options.paths.push_back(data);
  return dupin::bench::run(options);
}
