// Point trees of meshes beside their triangles, and beside QSplat's trees of their vertices.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "../../cad_import/cad_import.h"
#include "loop.h"
#include "subject.h"

namespace dupin::bench {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(path))
      if (entry.is_regular_file()) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Result<Subject> subject_of(const std::string& file, int loop) {
  auto model = import_cad(file, {});
  if (!model.ok()) return model.status();
  if (model->parts.size() != 1 || model->parts[0].polygons.polygon_count() == 0)
    return {StatusCode::unreadable, "not one mesh"};
  Subject subject{fs::path(file).filename().string(), std::move(*model), {}, {}};
  Part& part = subject.model.parts[0];
  if (loop == 0) return subject;
  subject.name += ", Loop-subdivided " + std::to_string(loop) + "x";
  for (int i = 0; i < loop; ++i) part.polygons = loop_subdivided(part.polygons);
  part.box = bounding_box(part.polygons);
  return subject;
}

nlohmann::json measure(Subject& subject, Renderer& renderer, const PopOptions& options) {
  const auto wanted = [&](const char* what) {
    return options.what.empty() ||
           std::find(options.what.begin(), options.what.end(), what) != options.what.end();
  };
  nlohmann::json row{{"mesh", subject.name}};
  row["build"] = measure_build(subject, wanted("build") ? 3 : 1);
  if (wanted("file")) row["file"] = measure_file(subject, options);
  if (wanted("cuts")) row["cuts"] = measure_cuts(subject, renderer, options);
  if (wanted("error")) row["error"] = measure_error(subject, renderer, options);
  if (wanted("frames")) row["frames"] = measure_frames(subject, renderer, options);
  if (wanted("orbit")) row["orbit"] = measure_orbit(subject, renderer, options);
  if (wanted("instances")) row["instances"] = measure_instances(subject, renderer, options);
  return row;
}

int run(const PopOptions& options) {
  auto device = Device3d::create();
  if (!device.ok()) return std::fprintf(stderr, "%s\n", device.status().message.c_str()), 6;
  std::ofstream output;
  if (!options.output.empty()) output.open(options.output);
  std::printf("on %s\n", (*device)->renderer().gl_renderer().c_str());
  for (const std::string& file : files_of(options.files))
    for (const int loop : options.loop) {
      auto subject = subject_of(file, loop);
      if (!subject.ok()) {
        std::printf("%s: %s\n", file.c_str(), subject.status().message.c_str());
        continue;
      }
      std::printf("%s: %zu triangles\n", subject->name.c_str(), triangle_count(subject->mesh()));
      const auto row = measure(*subject, (*device)->renderer(), options);
      if (output) output << row.dump() << std::endl;
      std::fflush(stdout);
    }
  return 0;
}

}  // namespace
}  // namespace dupin::bench

int main(int argc, char** argv) {
  dupin::bench::PopOptions options;
  CLI::App app{"Point trees of meshes beside their triangles and beside QSplat's trees."};
  app.add_option("PATH", options.files, "Mesh files, or folders of them")->required();
  app.add_option("--loop", options.loop, "How often each is subdivided by Loop's rules; several are allowed")
      ->capture_default_str();
  app.add_option("--what", options.what, "build, file, cuts, error, frames, orbit, instances; all");
  app.add_option("--size", options.size, "Pictures are SIZE x SIZE")->capture_default_str();
  app.add_option("--repeat", options.repeat, "Frames that a median is of")->capture_default_str();
  app.add_option("--frames", options.frames, "Of the orbit")->capture_default_str();
  app.add_option("--dupin", options.dupin, "The command, to time pictures from files with");
  app.add_option("-o,--output", options.output, "JSON lines, a row each");
  CLI11_PARSE(app, argc, argv);
  return dupin::bench::run(options);
}
