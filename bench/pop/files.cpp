// Building trees, their sizes, and pictures from their files.
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "../report.h"
#include "subject.h"

namespace dupin::bench {
namespace {

using Json = nlohmann::json;

double build(const Subject& subject, PointTreeKind kind, std::shared_ptr<const PointTree>& tree) {
  PointTreeOptions options;
  options.kind = kind;
  tree.reset();
  const auto start = std::chrono::steady_clock::now();
  auto made = build_point_tree(subject.mesh(), options);
  const double ms = milliseconds(start);
  if (made.ok()) tree = std::move(*made);
  return ms;
}

}  // namespace

Json measure_build(Subject& subject, int repeat) {
  std::vector<double> pop, qsplat;
  for (int i = 0; i < repeat; ++i) {
    pop.push_back(build(subject, PointTreeKind::pop, subject.pop));
    qsplat.push_back(build(subject, PointTreeKind::qsplat, subject.qsplat));
  }
  const double million = 1e-6 * static_cast<double>(triangle_count(subject.mesh()));
  const double bytes = static_cast<double>(subject.pop->byte_count()),
               others = static_cast<double>(subject.qsplat->byte_count());
  const Json row{{"triangles", triangle_count(subject.mesh())},
                 {"pop_ms", median(pop)},
                 {"qsplat_ms", median(qsplat)},
                 {"seconds_per_million", 1e-3 * median(pop) / million},
                 {"bytes", subject.pop->byte_count()},
                 {"bytes_of_qsplat", bytes / others}};
  std::printf(
      "  build      %8.0f ms, %.2f s per million triangles; %.1f MB, %.2f bytes a triangle, %.3f of "
      "QSplat's\n",
      median(pop), 1e-3 * median(pop) / million, 1e-6 * bytes, 1e-6 * bytes / million, bytes / others);
  return row;
}

/// The whole command, from its start to its end.
Json measure_file(const Subject& subject, const PopOptions& options) {
  namespace fs = std::filesystem;
  if (options.dupin.empty()) return nullptr;
  const fs::path folder = fs::temp_directory_path() / ("dupin_bench_pop." + std::to_string(std::rand()));
  fs::create_directories(folder);
  const fs::path tree = folder / "a.dpt";
  if (!write_point_tree(*subject.pop, tree.string()).ok()) return nullptr;
  const std::string command = options.dupin + " render " + tree.string() + " -o " +
                              (folder / "a.png").string() + " --samples 1 >/dev/null 2>&1";
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    if (std::system(command.c_str()) != 0) return nullptr;
    times.push_back(milliseconds(start));
  }
  fs::remove_all(folder);
  std::printf("  from file  %8.0f ms for a picture of 1024 x 1024, the whole command\n", median(times));
  return {{"ms", median(times)}};
}

}  // namespace dupin::bench
