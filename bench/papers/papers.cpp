// The tables of Kalaiah & Varshney (2003) with our points: what sampling, simplification, encoding and
// drawing give and cost for their five models (table1), differential points beside splats at the same number,
// quality and speed (table2), bytes and frame times over the error (curves), what packed records lose
// (encoding), and the time of simplification
// over the number of points (scale). docs/benchmarks.md has results.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../../simplify/prune.h"
#include "encoding.h"
#include "stage.h"

namespace dupin::bench {
namespace {

using Json = nlohmann::json;

constexpr int kWidth = 800, kHeight = 600;  // as in the papers

struct Options {
  std::string data, output, pictures, model;
  int frames = 9, most_grid = 395;
};

void fail(const Status& status) {
  std::fprintf(stderr, "dupin_bench_papers: %s\n", status.message.c_str());
  std::exit(1);
}
template <class T>
T need(Result<T> result) {
  if (!result.ok()) fail(result.status());
  return std::move(*result);
}

/// A model of Table I with its parameters; a grid of 0: a mesh. The papers give ε and δ of the head and of
/// Venus; these two also with parameters that fit their results in the units of our files.
struct Subject {
  const char* name;
  const char* file;
  int grid;
  double epsilon, delta;
};
constexpr Subject kTeapot{"teapot", "nurbs/converted/teapot.step", 70, 0.012, 0.08};
constexpr Subject kSubjects[] = {kTeapot,
                                 {"camera", "nurbs/converted/v1_Camera_visible.step", 22, 0.02, 0.2},
                                 {"head", "nurbs/converted/v1_HumanHead1_visible.step", 45, 0.012, 2},
                                 {"head_0.2", "nurbs/converted/v1_HumanHead1_visible.step", 45, 0.012, 0.2},
                                 {"bunny", "mesh/stanford/stanford-bunny.obj", 0, 0.012, 0.0005},
                                 {"venus", "mesh/big/classic/igea_134k.ply.gz", 0, 1e-6, 0.05},
                                 {"venus_1e-4", "mesh/big/classic/igea_134k.ply.gz", 0, 1e-4, 0.001}};

class Bench {
 public:
  explicit Bench(const Options& options) : options_(options) {
    if (!options.output.empty()) rows_.open(options.output);
  }

  void table1() {
    std::printf(
        "| model | points | | raw MB | packed MB | sample s | simplify s | cpu s | frame ms | cpu ms | rmse "
        "| holes "
        "|\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Subject& subject : kSubjects) {
      if (!options_.model.empty() && options_.model != subject.name) continue;
      const auto stage = need(Stage::open(options_.data + "/" + subject.file, "iso", kWidth, kHeight));
      const Clock start = Clock::now();
      const PointScene all = sampled(*stage, subject);
      const double sample_seconds = (Clock::now() - start).wall;
      line(subject.name, "all", *stage, all, sample_seconds, {});
      for (const bool published : {true, false}) {
        PointScene fewer = all;
        const Clock before = Clock::now();
        if (const Status status = prune(fewer, published ? papers_prune_options() : PruneOptions{});
            !status.ok())
          fail(status);
        line(subject.name, published ? "published" : "exact", *stage, fewer, sample_seconds,
             Clock::now() - before);
      }
      PointSamplingOptions adaptive;  // of a mesh: its vertices, with our curvatures and rectangles
      adaptive.method = PointMethod::adaptive;
      adaptive.epsilon = subject.epsilon;
      adaptive.delta = subject.delta;
      const Clock before = Clock::now();
      const PointScene points = need(sample_points(stage->model(), adaptive));
      line(subject.name, stage->is_mesh() ? "fitted" : "adaptive", *stage, points,
           (Clock::now() - before).wall, {});
    }
  }

  void table2() {
    const auto stage = need(Stage::open(options_.data + "/" + kTeapot.file, "iso", kWidth, kHeight));
    const PointScene points = sampled(*stage, kTeapot);
    const Measured dp = need(stage->measure({&points}, options_.frames));
    std::printf(
        "| test | primitive | points | MB | frame ms | cpu ms | rmse |\n|---|---|---|---|---|---|---|\n");
    row2("1", "dp", dp);
    for (std::size_t k = 0; k < 3; ++k) row2("1", kSplatNames[k], splats(*stage, kSplats[k], kTeapot.grid));
    row2("2: quality", "dp", dp);
    for (std::size_t k = 0; k < 3; ++k)
      row2("2: quality", kSplatNames[k],
           densest(*stage, kSplats[k], [&](const Measured& m) { return m.rmse <= dp.rmse; }));
    row2("3: speed", "dp", dp);
    for (std::size_t k = 0; k < 3; ++k)
      row2("3: speed", kSplatNames[k],
           densest(*stage, kSplats[k], [&](const Measured& m) { return m.processor_ms >= dp.processor_ms; }));
  }

  void curves() {
    const auto stage = need(Stage::open(options_.data + "/" + kTeapot.file, "iso", kWidth, kHeight));
    std::printf(
        "| primitive | | points | raw kB | packed kB | frame ms | cpu ms | rmse | normals ° | holes | "
        "blocked |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
    std::vector<Measured> adaptive, simplified, splat_rows[3];
    for (int k = 0; k < 9; ++k) {
      const Subject finer{"", "", 70 + 20 * k, 0.024 * std::pow(2, -k), 0.2 * std::pow(2, -0.5 * k)};
      PointSamplingOptions options;
      options.method = PointMethod::adaptive;
      options.epsilon = finer.epsilon;
      options.delta = finer.delta;
      const PointScene points = need(sample_points(stage->model(), options));
      adaptive.push_back(curve("dp adaptive", finer, need(stage->measure({&points}, options_.frames))));
      PointScene fewer = sampled(*stage, finer);
      if (const Status status = prune(fewer, {}); !status.ok()) fail(status);
      simplified.push_back(curve("dp simplified", finer, need(stage->measure({&fewer}, options_.frames))));
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (const int grid : {35, 50, 70, 100, 140, 200, 280, options_.most_grid})
        splat_rows[k].push_back(
            curve(kSplatNames[k], {"", "", grid, 0, 0}, splats(*stage, kSplats[k], grid)));
    for (const auto& [px, degrees] : {std::pair{4.0, 4.0}, {1.0, 1.0}, {0.5, 0.25}, {0.1, 0.05}})
      curve("quadric", {"", "", 0, px, degrees}, need(stage->measure_quadric(px, degrees, options_.frames)));
    std::printf(
        "\nAt equal error:\n\n| splat | points | raw kB | cpu ms | rmse | dp adaptive | of the bytes | times "
        "as fast | dp simplified | of the bytes | times as fast |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (std::size_t k = 0; k < 3; ++k)
      for (const Measured& splat : splat_rows[k]) equal_error(kSplatNames[k], splat, adaptive, simplified);
  }

  void encoding() {
    std::printf(
        "| model | points | position / box | normal ° | direction ° | λu | ρ | rmse as sampled | rmse "
        "decoded "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
    for (const Subject& subject : kSubjects) {
      if (!options_.model.empty() && options_.model != subject.name) continue;
      const auto stage = need(Stage::open(options_.data + "/" + subject.file, "iso", kWidth, kHeight));
      PointScene points = sampled(*stage, subject);
      const Measured before = need(stage->measure({&points}, 0));
      const EncodingErrors e = pack_and_unpack(points);
      const Measured after = need(stage->measure({&points}, 0));
      std::printf("| %s | %zu | %.3g | %.4f | %.4f | %.2g | %.4f | %.3f | %.3f |\n", subject.name,
                  points.count(), e.position, e.normal_degrees, e.direction_degrees, e.curvature, e.rho,
                  before.rmse, after.rmse);
      std::fflush(stdout);
    }
  }

  void scale() {
    const Model model = need(import_model());
    std::printf(
        "| points | after | sample s | simplify s | cpu s | µs cpu a point | ns cpu / (n log2 n) "
        "|\n|---|---|---|---|---|---|---|\n");
    for (const int grid : {18, 25, 35, 50, 70, 99, 140, 198, 280, 395}) {
      if (grid > options_.most_grid) break;
      PointSamplingOptions options;
      options.grid = grid;
      options.epsilon = kTeapot.epsilon;
      options.delta = kTeapot.delta;
      Clock start = Clock::now();
      PointScene points = need(sample_points(model, options));
      const double sample_seconds = (Clock::now() - start).wall;
      const auto n = static_cast<double>(points.count());
      start = Clock::now();
      if (const Status status = prune(points, {}); !status.ok()) fail(status);
      const Clock took = Clock::now() - start;
      std::printf("| %.0f | %zu | %.3f | %.3f | %.3f | %.2f | %.1f |\n", n, points.count(), sample_seconds,
                  took.wall, took.processor, 1e6 * took.processor / n,
                  1e9 * took.processor / (n * std::log2(n)));
      std::fflush(stdout);
      write({{"table", "scale"},
             {"points", n},
             {"after", points.count()},
             {"simplify_s", took.wall},
             {"cpu_s", took.processor}});
    }
  }

 private:
  static constexpr PointPrimitive kSplats[] = {PointPrimitive::square, PointPrimitive::rectangle,
                                               PointPrimitive::ellipse};
  static constexpr const char* kSplatNames[] = {"square", "rectangle", "ellipse"};

  Result<Model> import_model() const {
    auto stage = Stage::open(options_.data + "/" + kTeapot.file, "iso", 16, 16);
    if (!stage.ok()) return stage.status();
    return (*stage)->model();
  }

  static PointScene sampled(const Stage& stage, const Subject& subject) {
    PointSamplingOptions options;
    options.grid = subject.grid;
    options.epsilon = subject.epsilon;
    options.delta = subject.delta;
    options.mesh = papers_mesh_options();
    options.mesh.delta = subject.delta;
    return need(sample_points(stage.model(), options));
  }

  Measured splats(Stage& stage, PointPrimitive primitive, int grid) const {
    Subject finer = kTeapot;
    finer.grid = grid;
    const PointScene points = sampled(stage, finer);
    return need(stage.measure({&points, primitive}, std::max(3, options_.frames / 2)));
  }

  /// The first grid, by steps of a tenth, that is dense enough; or the densest.
  template <class Enough>
  Measured densest(Stage& stage, PointPrimitive primitive, const Enough& enough) const {
    Measured m;
    for (double grid = 40; grid <= options_.most_grid; grid *= 1.1) {
      m = splats(stage, primitive, static_cast<int>(grid));
      if (enough(m)) break;
    }
    return m;
  }

  void line(const char* model, const char* what, Stage& stage, const PointScene& points,
            double sample_seconds, const Clock& simplify) {
    const Measured m = need(stage.measure({&points}, options_.frames));
    std::printf("| %s | %zu | %s | %.2f | %.2f | %.3f | %.3f | %.3f | %.1f | %.1f | %.2f | %llu |\n", model,
                m.points, what, 1e-6 * static_cast<double>(m.raw_bytes),
                1e-6 * static_cast<double>(m.packed_bytes), sample_seconds, simplify.wall, simplify.processor,
                m.ms, m.processor_ms, m.rmse, static_cast<unsigned long long>(m.holes));
    std::fflush(stdout);
    if (!options_.pictures.empty()) {
      if (const Status status = stage.write_last(options_.pictures + "/" + model + "_" + what + ".png");
          !status.ok())
        fail(status);
      if (const Status status = stage.write_reference(options_.pictures + "/" + model + "_exact.png");
          !status.ok())
        fail(status);
    }
    write(json(m, {{"table", "1"},
                   {"model", model},
                   {"what", what},
                   {"sample_s", sample_seconds},
                   {"simplify_s", simplify.wall}}));
  }

  void row2(const char* test, const char* primitive, const Measured& m) {
    std::printf("| %s | %s | %zu | %.2f | %.1f | %.1f | %.2f |\n", test, primitive, m.points,
                1e-6 * static_cast<double>(m.raw_bytes), m.ms, m.processor_ms, m.rmse);
    std::fflush(stdout);
    write(json(m, {{"table", "2"}, {"test", test}, {"primitive", primitive}}));
  }

  Measured curve(const char* primitive, const Subject& by, const Measured& m) {
    char how[64];
    if (by.grid > 0 && by.epsilon == 0)
      std::snprintf(how, sizeof how, "%d² a patch", by.grid);
    else
      std::snprintf(how, sizeof how, by.grid ? "ε %.3g δ %.3g" : "%.3g px, %.3g°", by.epsilon, by.delta);
    std::printf("| %s | %s | %zu | %.0f | %.0f | %.1f | %.1f | %.3f | %.3f | %llu | %llu |\n", primitive, how,
                m.points, 1e-3 * static_cast<double>(m.raw_bytes), 1e-3 * static_cast<double>(m.packed_bytes),
                m.ms, m.processor_ms, m.rmse, m.normal_degrees, static_cast<unsigned long long>(m.holes),
                static_cast<unsigned long long>(m.blocked));
    std::fflush(stdout);
    write(json(m, {{"table", "curves"}, {"primitive", primitive}, {"how", how}}));
    return m;
  }

  /// The points of the least bytes that are at least as good as the splats.
  static const Measured* as_good(const Measured& splat, const std::vector<Measured>& points) {
    const Measured* best = nullptr;
    for (const Measured& m : points)
      if (m.rmse <= splat.rmse && (!best || m.raw_bytes < best->raw_bytes)) best = &m;
    return best;
  }

  void equal_error(const char* name, const Measured& splat, const std::vector<Measured>& adaptive,
                   const std::vector<Measured>& simplified) {
    std::printf("| %s | %zu | %.0f | %.1f | %.3f |", name, splat.points,
                1e-3 * static_cast<double>(splat.raw_bytes), splat.processor_ms, splat.rmse);
    for (const auto* points : {&adaptive, &simplified}) {
      const Measured* m = as_good(splat, *points);
      if (!m) {
        std::printf(" none | | |");
        continue;
      }
      const double bytes = static_cast<double>(m->raw_bytes) / static_cast<double>(splat.raw_bytes),
                   speed = splat.processor_ms / m->processor_ms;
      std::printf(" %zu (%.2f) | %.1f %% | %.1f |", m->points, m->rmse, 100 * bytes, speed);
      write({{"table", "equal error"},
             {"splat", name},
             {"splat_points", splat.points},
             {"rmse", splat.rmse},
             {"points", m->points},
             {"bytes_ratio", bytes},
             {"speed_ratio", speed}});
    }
    std::printf("\n");
  }

  static Json json(const Measured& m, Json row) {
    row.update(Json{{"points", m.points},
                    {"raw_bytes", m.raw_bytes},
                    {"packed_bytes", m.packed_bytes},
                    {"ms", m.ms},
                    {"processor_ms", m.processor_ms},
                    {"rmse", m.rmse},
                    {"normal_degrees", m.normal_degrees},
                    {"holes", m.holes},
                    {"blocked", m.blocked},
                    {"silhouette", m.silhouette}});
    return row;
  }
  void write(const Json& row) {
    if (rows_.is_open()) rows_ << row.dump() << std::endl;
  }

  const Options& options_;
  std::ofstream rows_;
};

int run(int argc, char** argv) {
  Options options;
  if (const char* data = std::getenv("DUPIN_DATA")) options.data = data;
  CLI::App app{"The papers' tables with our points"};
  app.add_option("--data", options.data, "The folder of models (default: $DUPIN_DATA)");
  app.add_option("-o", options.output, "Rows as JSON lines");
  app.add_option("--pictures", options.pictures, "A folder for table1's pictures");
  app.add_option("--model", options.model,
                 "Of table1: teapot, camera, head, head_0.2, bunny, venus or venus_1e-4");
  app.add_option("--frames", options.frames, "Timed frames of each kind")->check(CLI::Range(1, 1000));
  app.add_option("--most-grid", options.most_grid, "Densest grid of a patch")->check(CLI::Range(20, 1000));
  std::vector<std::string> tables;
  app.add_option("TABLE", tables, "table1, table2, curves, encoding, scale")
      ->required()
      ->check(CLI::IsMember({"table1", "table2", "curves", "encoding", "scale"}));
  CLI11_PARSE(app, argc, argv);
  Bench bench(options);
  for (const std::string& table : tables) {
    if (table == "table1") bench.table1();
    if (table == "table2") bench.table2();
    if (table == "curves") bench.curves();
    if (table == "encoding") bench.encoding();
    if (table == "scale") bench.scale();
  }
  return 0;
}

}  // namespace
}  // namespace dupin::bench

int main(int argc, char** argv) {
  return dupin::bench::run(argc, argv);
}
