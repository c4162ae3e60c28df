// dupin_bench_amg: what the paper's tables and the project's own bars say of domains (docs/benchmarks.md).
//
//   tables FILE…    points, levels, polygons, texels, seconds, frame times
//   scaling         seconds by number of points
//   errors FILE…    image error by number of polygons, beside opaque, unlit by normal maps, decimated
//   triangles far FILE…       parts of 64 pixels: image error, frame times beside all triangles or all DPs
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "../../cad_import/cad_import.h"
#include "../../render/tree_layer.h"
#include "../../sampling/sampler.h"
#include "../../simplify/point_sources.h"
#include "pictures.h"

namespace dupin::bench {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

struct Options {
  std::vector<std::string> files;
  std::size_t most_points = 2'000'000;
  int frames = 15, size = 512;
};

struct Source {
  Model model;
  SurfacePoints points;
  bool exact = false;  ///< of exact faces
};

/// The first part, alone; of exact faces points as dense as pixels of a picture of that size.
Result<Source> read(const std::string& path, int size) {
  auto model = import_cad(path, {});
  if (!model) return model.status();
  Source source;
  source.model.parts.push_back(model->parts.at(0));
  source.model.instances.emplace_back();
  const Part& part = source.model.parts[0];
  source.exact = !part.faces.empty();
  if (!source.exact) {
    auto points = mesh_points(part);
    if (!points) return points.status();
    source.points = std::move(*points);
    return source;
  }
  SamplingOptions sampling;
  const double spacing = part.box.diagonal() / size;
  sampling.tolerance = 0.1 * spacing;
  const auto dps = sample_quadric_dps(source.model, sampling);
  if (!dps) return dps.status();
  auto points = dp_points(dps->parts[0], spacing);
  if (!points) return points.status();
  source.points = std::move(*points);
  return source;
}

SceneContent content_of(const DomainScene& scene, const DomainContent& how = {}) {
  SceneContent content;
  content.domains = how;
  content.domains.scene = &scene;
  return content;
}

int fail(const Status& status) {
  std::fprintf(stderr, "dupin_bench_amg: %s\n", status.message.c_str());
  return 1;
}

int tables(const Options& options) {
  auto pictures = Pictures::open();
  if (!pictures) return fail(pictures.status());
  std::printf("%-28s %8s %5s %7s %8s %7s %7s %9s | ms at 128, 256, 512; published 512\n", "model", "points",
              "level", "polys", "texels", "sd s", "dpc s", "s/100k");
  for (const std::string& file : options.files) {
    auto source = read(file, 1000);
    if (!source) return fail(source.status());
    double start = now();
    const auto bases = decompose(source->points, {});
    if (!bases) return fail(bases.status());
    const double sd = now() - start;
    for (std::size_t level = 0; level < bases->levels() && bases->domains(level) < 2500; ++level) {
      start = now();
      auto set = make_domain_set(source->points, *bases, level, {});
      if (!set) return fail(set.status());
      const double dpc = now() - start;
      std::printf("%-28s %8zu   L-%zu %7zu %8zu %7.2f %7.2f %9.2f |", name_of(file).c_str(),
                  source->points.size(), level, set->primitives.size(), set->atlas.psi.size(), sd, dpc,
                  1e5 * (sd + dpc) / static_cast<double>(source->points.size()));
      DomainScene scene;
      scene.parts.resize(1);
      scene.parts[0].push_back(std::move(*set));
      for (const int size : {128, 256, 512})
        std::printf(" %.2f", *pictures->time(source->model, content_of(scene), size, options.frames));
      DomainContent published;
      published.blend = DomainBlend::published;
      std::printf("; %.2f\n",
                  *pictures->time(source->model, content_of(scene, published), 512, options.frames));
      std::fflush(stdout);
    }
  }
  return 0;
}

/// A bumpy sphere of loose points with normals.
SurfacePoints bumpy(std::size_t count) {
  SurfacePoints points;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count),
                 r = std::sqrt(1 - z * z), turn = static_cast<double>(i) * 2.399963229728653;
    const Vec3 n{r * std::cos(turn), r * std::sin(turn), z};
    points.positions.push_back(n * (1 + 0.1 * std::sin(7 * n.x) * std::sin(5 * n.y + 1) * std::sin(6 * n.z)));
    points.normals.push_back(n);
  }
  return points;
}

int scaling(const Options& options) {
  std::printf("%8s %7s %7s %7s %7s %7s %9s\n", "points", "around", "matrix", "amg", "sd s", "dpc s",
              "s/100k");
  for (std::size_t count = 31250; count <= options.most_points; count *= 4) {
    const SurfacePoints points = bumpy(count);
    double start = now();
    const auto bases = decompose(points, {});
    if (!bases) return fail(bases.status());
    const double sd = now() - start;
    std::size_t level = 0;
    while (level + 1 < bases->levels() && bases->domains(level) < 300) ++level;
    start = now();
    const auto set = make_domain_set(points, *bases, level, {});
    if (!set) return fail(set.status());
    const double dpc = now() - start;
    const auto& t = bases->times();
    std::printf("%8zu %7.2f %7.2f %7.2f %7.2f %7.2f %9.3f\n", count, t.neighborhoods, t.matrix, t.multigrid,
                sd, dpc, 1e5 * (sd + dpc) / static_cast<double>(count));
    std::fflush(stdout);
  }
  return 0;
}

int errors(const Options& options) {
  auto pictures = Pictures::open();
  if (!pictures) return fail(pictures.status());
  std::printf("mean FLIP, and RMSE of covered pixels in steps of 8 bits\n%-28s %6s", "model", "polys");
  for (const char* kind : {"domains", "no normal maps", "opaque", "published", "publ. no maps", "triangles"})
    std::printf(" %14s", kind);
  std::printf("\n");
  for (const std::string& file : options.files) {
    const auto source = read(file, options.size);
    if (!source) return fail(source.status());
    const auto bases = decompose(source->points, {});
    if (!bases) return fail(bases.status());
    const auto full = pictures->draw(source->model, {}, options.size);
    if (!full) return fail(full.status());
    for (std::size_t level = 0; level < bases->levels() && bases->domains(level) < 3000; ++level) {
      if (bases->domains(level) < 20) continue;
      auto set = make_domain_set(source->points, *bases, level, {});
      if (!set) return fail(set.status());
      DomainScene scene;
      scene.parts.resize(1);
      scene.parts[0].push_back(std::move(*set));
      const std::size_t polygons = scene.parts[0][0].primitives.size();
      std::printf("%-28s %6zu", name_of(file).c_str(), polygons);
      const auto show = [&](const Model& model, const SceneContent& content) {
        const auto frames = pictures->draw(model, content, options.size);
        const PictureError error = frames ? error_of(*full, *frames) : PictureError{-1, -1};
        std::printf(" %6.4f  %6.2f", error.flip, error.rmse);
      };
      DomainContent how;
      show(source->model, content_of(scene, how));
      how.normal_maps = false;
      show(source->model, content_of(scene, how));
      how = {};
      how.blend = DomainBlend::opaque;
      show(source->model, content_of(scene, how));
      how.blend = DomainBlend::published;
      show(source->model, content_of(scene, how));
      how.normal_maps = false;
      show(source->model, content_of(scene, how));
      show(decimated(source->model, polygons), {});
      std::printf("\n");
      std::fflush(stdout);
    }
  }
  return 0;
}

/// The same mesh as a point tree.
double pop_time(Pictures& pictures, const Model& model, int size, int frames) {
  std::vector<PartTree> trees(1);
  auto tree = build_point_tree(model.parts[0].polygons, {});
  if (!tree) return -1;
  trees[0].tree = *tree;
  TreeLayers layers(trees, {});
  SceneContent content;
  content.layers.push_back(layers.layer());
  const auto time = pictures.time(model, content, size, frames);
  return time ? *time : -1;
}

int far(const Options& options) {
  auto pictures = Pictures::open();
  if (!pictures) return fail(pictures.status());
  constexpr int kSize = 64;
  std::printf("%-28s %9s %7s %8s %8s %9s %9s %9s %7s\n", "model", "full", "domains", "FLIP", "RMSE",
              "full ms", "pop ms", "dom. ms", "faster");
  for (const std::string& file : options.files) {
    const auto source = read(file, 2 * kSize);
    if (!source) return fail(source.status());
    SceneContent whole;
    DpScene dps;
    std::size_t primitives = source->points.triangles.size() / 3;
    if (source->exact) {
      SamplingOptions sampling;
      sampling.tolerance = source->model.parts[0].box.diagonal() / kSize / 2;
      auto sampled = sample_quadric_dps(source->model, sampling);
      if (!sampled) return fail(sampled.status());
      dps = std::move(*sampled);
      whole.dps = &dps;
      primitives = dps.parts[0].dps.size();
    }
    const auto bases = decompose(source->points, {});
    if (!bases) return fail(bases.status());
    const double pixel = source->model.parts[0].box.diagonal() / kSize;
    DomainPrimitiveOptions how;
    how.texel = pixel / 2;
    DomainScene scene;
    scene.parts.resize(1);
    for (std::size_t level = 0; level < bases->levels(); ++level) {
      auto set = make_domain_set(source->points, *bases, level, how);
      if (!set) return fail(set.status());
      if (set->deviation_99 > 0.5 * pixel && level + 1 < bases->levels()) continue;
      scene.parts[0].push_back(std::move(*set));
      break;
    }
    const auto full = pictures->draw(source->model, whole, kSize),
               drawn = pictures->draw(source->model, content_of(scene), kSize);
    if (!full || !drawn) return fail(full ? drawn.status() : full.status());
    const PictureError error = error_of(*full, *drawn);
    const double full_ms = *pictures->time(source->model, whole, kSize, options.frames),
                 domain_ms = *pictures->time(source->model, content_of(scene), kSize, options.frames);
    const double pop_ms = source->exact ? 0 : pop_time(*pictures, source->model, kSize, options.frames);
    std::printf("%-28s %9zu %7zu %8.4f %8.2f %9.3f %9.3f %9.3f %7.1f\n", name_of(file).c_str(), primitives,
                scene.parts[0][0].primitives.size(), error.flip, error.rmse, full_ms, pop_ms, domain_ms,
                full_ms / domain_ms);
    std::fflush(stdout);
  }
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Domains: times, sizes, image errors"};
  app.require_subcommand(1);
  Options options;
  int (*chosen)(const Options&) = nullptr;
  const auto add = [&](const char* name, int (*what)(const Options&), bool files) {
    CLI::App* command = app.add_subcommand(name);
    if (files) command->add_option("FILE", options.files)->required();
    command->add_option("--most-points", options.most_points);
    command->add_option("--frames", options.frames);
    command->add_option("--size", options.size);
    command->callback([&chosen, what] { chosen = what; });
  };
  add("tables", tables, true);
  add("scaling", scaling, false);
  add("errors", errors, true);
  add("far", far, true);
  CLI11_PARSE(app, argc, argv);
  return chosen(options);
}

}  // namespace
}  // namespace dupin::bench

int main(int argc, char** argv) {
  return dupin::bench::run(argc, argv);
}
