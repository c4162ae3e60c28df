// dupin compare: how much two pictures differ.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "../render/image.h"
#include "../render/metrics.h"
#include "commands.h"
#include "exit_code.h"
#include "output_file.h"
#include "session.h"

namespace dupin::app {
namespace {

using Json = nlohmann::ordered_json;

struct PictureCompareOptions {
  CommonOptions common;
  CompareOptions compare;
  std::string a, b, diff;
  bool json = false;
  std::size_t pixels = 0;
};

/// JSON has no infinity: equal pictures have a PSNR of null.
Json finite(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json quantiles(const Distribution& d) {
  return {{"count", d.count},     {"mean", finite(d.mean)}, {"p50", finite(d.p50)}, {"p90", finite(d.p90)},
          {"p99", finite(d.p99)}, {"p999", finite(d.p999)}, {"max", finite(d.max)}};
}

Json to_json(const GeometryMetrics& g) {
  return {{"interior_px", g.interior},
          {"holes_px", g.holes},
          {"holes_ppm", g.interior ? 1e6 * double(g.holes) / double(g.interior) : 0.0},
          {"extra_px", g.extra},
          {"opposed_normals_px", g.opposed_normals},
          {"depth_px", g.depth_px.count ? quantiles(g.depth_px) : Json(nullptr)},
          {"normal_degrees", g.normal_degrees.count ? quantiles(g.normal_degrees) : Json(nullptr)}};
}

Json to_json(const PictureDifference& d) {
  Json json{{"width", d.width}, {"height", d.height}};
  if (d.color) {
    json["rmse"] = d.color->rmse;
    json["rmse_covered"] = d.color->rmse_covered;
    json["psnr"] = finite(d.color->psnr);
    json["ssim"] = d.color->ssim;
    json["flip"] = d.color->flip;
  }
  json["covered_px"] = {d.covered_a, d.covered_b};
  json["silhouette_px"] = d.silhouette;
  json["outline_px"] = d.outline_px.count ? quantiles(d.outline_px) : Json(nullptr);
  if (d.geometry) json["geometry"] = to_json(*d.geometry);
  return json;
}

void print(const char* name, const char* unit, const Distribution& d) {
  if (d.count)
    std::printf("%-12s half below %.4g, 99 %% below %.4g, 99.9 %% below %.4g, largest %.4g %s\n", name, d.p50,
                d.p99, d.p999, d.max, unit);
}

void print_table(const PictureDifference& d) {
  if (d.color) {
    std::printf("RMSE         %.4f of 255, %.4f over covered pixels\nPSNR         ", d.color->rmse,
                d.color->rmse_covered);
    std::printf(std::isfinite(d.color->psnr) ? "%.2f dB\n" : "infinite: the pictures are the same\n",
                d.color->psnr);
    std::printf("SSIM         %.6f\nFLIP         %.6f\n", d.color->ssim, d.color->flip);
  }
  std::printf("silhouette   %llu pixels differ (%llu and %llu covered)\n",
              static_cast<unsigned long long>(d.silhouette), static_cast<unsigned long long>(d.covered_a),
              static_cast<unsigned long long>(d.covered_b));
  print("outline", "pixels", d.outline_px);
  if (!d.geometry) return;
  const GeometryMetrics& g = *d.geometry;
  std::printf("interior     %llu pixels, %llu holes, %llu drawn outside, %llu normals opposed\n",
              static_cast<unsigned long long>(g.interior), static_cast<unsigned long long>(g.holes),
              static_cast<unsigned long long>(g.extra), static_cast<unsigned long long>(g.opposed_normals));
  print("depth", "pixels", g.depth_px);
  print("normals", "degrees", g.normal_degrees);
}

Json to_json(const PixelDifference& d) {
  return {{"kind", kDifferenceNames[static_cast<int>(d.kind)]},
          {"x", d.x},
          {"y", d.y},
          {"depth", {finite(d.depth_a), finite(d.depth_b)}},
          {"depth_px", finite(d.depth_px)},
          {"normal_degrees", d.normal_degrees},
          {"face", {d.face_a, d.face_b}}};
}

void print(const PixelDifference& d) {
  std::printf("%-12s pixel %d,%d: depths %.7g and %.7g, %.4g pixels; normals %.4g degrees; faces %u and %u\n",
              kDifferenceNames[static_cast<int>(d.kind)], d.x, d.y, d.depth_a, d.depth_b, d.depth_px,
              d.normal_degrees, d.face_a, d.face_b);
}

Status write_diff(OutputFile& output, const Image& a, const Image& b, const CompareOptions& options) {
  const Result<Image8> picture = difference_picture(a, b, options);
  if (!picture.ok()) return picture.status();
  if (const Status status = write_png(output.working_path(), *picture); !status.ok()) return status;
  return output.commit();
}

int run(const PictureCompareOptions& options) {
  Session session(options.common);
  OutputFile diff;
  if (!options.diff.empty())
    if (const Status status = diff.open(options.diff); !status.ok()) return session.fail(status);
  const Result<Image> a = read_image(options.a);
  if (!a.ok()) return session.fail(a.status());
  const Result<Image> b = read_image(options.b);
  if (!b.ok()) return session.fail(b.status());
  const Result<PictureDifference> difference = compare(*a, *b, options.compare);
  if (!difference.ok()) return session.fail(difference.status());
  if (!options.diff.empty())
    if (const Status status = write_diff(diff, *a, *b, options.compare); !status.ok())
      return session.fail(status);
  std::vector<PixelDifference> pixels;
  if (options.pixels > 0) {
    Result<std::vector<PixelDifference>> worst = worst_pixels(*a, *b, options.compare, options.pixels);
    if (!worst.ok()) return session.fail(worst.status());
    pixels = std::move(*worst);
  }
  if (options.json) {
    Json json = to_json(*difference);
    for (const PixelDifference& d : pixels) json["pixels"].push_back(to_json(d));
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(*difference);
    for (const PixelDifference& d : pixels) print(d);
  }
  if (std::fflush(stdout) != 0)
    return session.fail({StatusCode::cannot_write, "standard output: cannot write"});
  return kDone;
}

}  // namespace

void add_compare_command(CLI::App& app, Command& chosen) {
  const auto options = std::make_shared<PictureCompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Measure how much two pictures differ");
  command->add_option("A", options->a, "The reference: PNG or EXR")->required();
  command->add_option("B", options->b, "What is compared with it, of the same size")->required();
  command->add_flag("--json", options->json, "As JSON, for programs");
  command->add_option("--diff", options->diff, "Write a picture of where they differ")->type_name("OUT.png");
  command
      ->add_option("--fov", options->compare.fov_degrees,
                   "Vertical angle of view, for the size of a pixel where neither picture tells it")
      ->check(CLI::Range(1e-6, 179.0))
      ->type_name("DEG")
      ->capture_default_str();
  command
      ->add_option("--pixels", options->pixels,
                   "List up to N pixels of each kind of difference; needs depths")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  add_common_options(*command, options->common);
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace dupin::app
