// dupin_exact: a picture by the exact ray caster, with the camera options of `dupin render`.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "../../app/exit_code.h"
#include "../../app/load.h"
#include "../../app/output_file.h"
#include "../../app/session.h"
#include "../../app/view.h"
#include "../../exact/exact_picture.h"

namespace {

using namespace dupin;

struct Options {
  app::CommonOptions common;
  app::ViewOptions view;
  std::vector<std::string> files, aovs{"color", "normal", "depth"};
  std::string output;
  std::vector<int> pixel;
};

constexpr std::pair<const char*, Output> kNames[] = {
    {"color", kColor},       {"normal", kNormal},       {"depth", kDepth},
    {"position", kPosition}, {"curvature", kCurvature}, {"direction", kDirection},
    {"face", kFace},         {"primitive", kPrimitive}, {"uv", kUv}};

/// Everything about one pixel, for a person.
void print_pixel(const Model& model, const exact::ExactScene& scene, const Camera& camera, int column,
                 int row) {
  const exact::Line ray = exact::pixel_ray(camera, column, row);
  const auto hit = scene.cast(ray, camera.orthographic ? -INFINITY : 0);
  if (!hit) {
    std::printf("pixel %d,%d: nothing\n", column, row);
    return;
  }
  const Part& part = model.parts[model.instances[hit->instance].part];
  const Surface& surface = part.surfaces[part.faces[hit->face].surface];
  std::printf("pixel %d,%d: face %u (%s, \"%s\"), depth %.12g = (%.12g, %.12g, %.12g), u,v %.12g, %.12g, ",
              column, row, hit->number, std::string(kind_name(surface)).c_str(),
              part.faces[hit->face].name.c_str(), hit->depth, hit->point.x, hit->point.y, hit->point.z,
              hit->u, hit->v);
  std::printf("normal (%.9g, %.9g, %.9g), curvatures %.9g, %.9g, pixel %.6g%s\n", hit->normal.x,
              hit->normal.y, hit->normal.z, hit->k1, hit->k2, pixel_size(camera, hit->depth),
              hit->in_crack ? ", in a crack between faces" : "");
}

int run(const Options& options) {
  app::Session session(options.common);
  app::OutputFile output;
  if (!options.output.empty())
    if (const Status status = output.open(options.output); !status.ok()) return session.fail(status);
  Result<app::Loaded> loaded = app::load(session, options.files);
  if (!loaded.ok()) return session.fail(loaded.status());
  const Model& model = loaded->model;
  const Result<Camera> camera = app::make_camera(options.view, model);
  if (!camera.ok()) return session.fail(camera.status());
  const auto start = std::chrono::steady_clock::now();
  const exact::ExactScene scene(model);
  for (const std::string& face : scene.incomplete_faces()) session.warn("crossings may be missed: " + face);
  if (!options.pixel.empty()) print_pixel(model, scene, *camera, options.pixel[0], options.pixel[1]);
  if (options.output.empty()) return app::kDone;
  exact::PictureOptions picture;
  picture.outputs = 0;
  for (const auto& [name, bit] : kNames)
    if (std::count(options.aovs.begin(), options.aovs.end(), name)) picture.outputs |= bit;
  picture.progress = session.progress();
  const Result<Image> image = draw(model, scene, *camera, picture);
  if (!image.ok()) return session.fail(image.status());
  if (const Status status = write_exr(output.working_path(), *image); !status.ok())
    return session.fail(status);
  if (const Status status = output.commit(); !status.ok()) return session.fail(status);
  session.done();
  session.note(
      "cast in " +
      std::to_string(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()) + " s");
  return app::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"The exact picture of CAD files, by ray casting: the ground truth of benchmarks.",
               "dupin_exact"};
  app.add_option("FILE", options.files, "STEP, IGES, BREP or FCStd")->required();
  app.add_option("-o,--output", options.output, "The picture, .exr");
  dupin::app::add_view_options(app, options.view);
  app.add_option("--aov", options.aovs, "Channels, as `dupin render` has them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(
          {"color", "normal", "depth", "position", "curvature", "direction", "face", "primitive", "uv"}));
  app.add_option("--pixel", options.pixel, "Say everything about this pixel")->delimiter(',')->expected(2);
  dupin::app::add_common_options(app, options.common);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : (app.exit(error), dupin::app::kWrongUsage);
  }
  dupin::app::remove_unfinished_outputs_on_signals();
  return run(options);
}
