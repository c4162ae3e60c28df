// What is drawn, how well, how fast.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../../render/image.h"
#include "../../render/metrics.h"
#include "../report.h"
#include "subject.h"

namespace dupin::bench {
namespace {

using Json = nlohmann::json;

DrawOptions screen(int samples = 1) {
  DrawOptions draw;
  draw.outputs = kScreen;
  draw.edges = false;
  draw.samples = samples;
  return draw;
}

Frame draw(Renderer& renderer, DrawnTrees& drawn, const Camera& camera) {
  DrawOptions options = screen();
  options.outputs = kScreen | kDepth;
  auto frame = renderer.draw(*drawn.scene, camera, options);
  if (!frame.ok()) {
    std::fprintf(stderr, "%s\n", frame.status().message.c_str());
    std::exit(1);
  }
  return std::move(*frame);
}

double covered(Renderer& renderer, DrawnTrees& drawn, const Camera& camera) {
  const Frame frame = draw(renderer, drawn, camera);
  const auto count =
      std::count_if(frame.depth.begin(), frame.depth.end(), [](float z) { return std::isfinite(z); });
  return static_cast<double>(count) / static_cast<double>(frame.depth.size());
}

/// Distance at which the model covers this part of the picture.
Camera camera_that_covers(Renderer& renderer, DrawnTrees& drawn, const Box3& box, int size, double part) {
  double near = 0.3, far = 8;
  for (int i = 0; i < 8; ++i) {
    const double middle = std::sqrt(near * far);
    (covered(renderer, drawn, camera_at(box, size, middle)) > part ? near : far) = middle;
  }
  return camera_at(box, size, std::sqrt(near * far));
}

PictureDifference difference(const Frame& a, const Frame& b, const Camera& camera) {
  const auto image_of = [&](const Frame& frame) {
    Image image = to_image(screen_image(frame));
    image.channel("Z").values = frame.depth;
    image.pixel_per_depth = 2 * std::tan(camera.fov_degrees * std::numbers::pi / 360) / camera.height;
    return image;
  };
  return *compare(image_of(a), image_of(b), {});
}

/// What the frames of times_of() did, medians too.
struct Stages {
  std::vector<double> cut, lists, raster;
  void add(const TreeLayerStats& s) {
    cut.push_back(s.cut_ms), lists.push_back(s.gather_ms), raster.push_back(s.raster_ms);
  }
};

/// Medians over frames that take turns, each with a camera a little off the last one's, as when somebody
/// looks around.
std::vector<double> times_of(Renderer& renderer, std::vector<DrawnTrees*> kinds, const Camera& camera,
                             int repeat, Stages* stages = nullptr) {
  std::vector<std::vector<double>> times(kinds.size());
  for (int i = -2; i < repeat; ++i)
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      Camera moved = camera;
      const Vec3 aside = cross(camera.up, camera.eye - camera.target);
      moved.eye += aside * (0.004 * i);
      const double ms = renderer.draw_only(*kinds[k]->scene, moved, screen())->milliseconds;
      if (i >= 0) times[k].push_back(ms);
      if (i >= 0 && stages && kinds[k]->layers) stages->add(kinds[k]->layers->stats());
    }
  std::vector<double> medians;
  for (auto& t : times) medians.push_back(median(t));
  return medians;
}

}  // namespace

Json measure_cuts(const Subject& subject, Renderer& renderer, const PopOptions& options) {
  Json rows = Json::array();
  DrawnTrees trees = make_scene(renderer, subject.model, subject.pop, {});
  const Box3 box = bounding_box(subject.model);
  const std::pair<const char*, Camera> cameras[] = {
      {"far", camera_at(box, options.size, 4)},
      {"whole", camera_at(box, options.size, 1)},
      {"near", close_camera(subject.mesh(), options.size, 0.25)},
      {"close", close_camera(subject.mesh(), options.size, 0.03)}};
  for (const auto& [name, camera] : cameras) {
    const double part = covered(renderer, trees, camera);
    const TreeLayerStats stats = trees.layers->stats();
    std::printf("  cut        %-6s %9lu points %9lu triangles, %4.1f %% of the picture\n", name, stats.points,
                stats.triangles, 100 * part);
    rows.push_back(
        {{"camera", name}, {"points", stats.points}, {"triangles", stats.triangles}, {"covered", part}});
  }
  return rows;
}

struct Way {
  const char* name;
  bool pop;
  TreeLayerOptions options;
};
std::vector<Way> ways() {
  TreeLayerOptions circles, circles_silhouette, silhouette;
  circles.foreshortened = circles_silhouette.foreshortened = false;
  circles_silhouette.silhouette = silhouette.silhouette = true;
  return {{"qsplat", false, {}},
          {"pop published", true, circles},
          {"pop published silhouette", true, circles_silhouette},
          {"pop", true, {}},
          {"pop silhouette", true, silhouette}};
}

Json measure_error(const Subject& subject, Renderer& renderer, const PopOptions& options) {
  Json rows = Json::array();
  DrawnTrees triangles = make_scene(renderer, subject.model, nullptr, {});
  const std::pair<const char*, Camera> cameras[] = {
      {"half", camera_at(bounding_box(subject.model), options.size, 2)},
      {"whole", camera_at(bounding_box(subject.model), options.size, 1)},
      {"near", close_camera(subject.mesh(), options.size, 0.25)}};
  for (const auto& [name, camera] : cameras) {
    const Frame reference = draw(renderer, triangles, camera);
    for (Way& way : ways())
      for (const double threshold : {1.0, 2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 20.0}) {
        way.options.threshold_px = threshold;
        DrawnTrees trees =
            make_scene(renderer, subject.model, way.pop ? subject.pop : subject.qsplat, way.options);
        const PictureDifference d = difference(reference, draw(renderer, trees, camera), camera);
        const TreeLayerStats stats = trees.layers->stats();
        std::printf(
            "  error      %-6s %-24s %4.1f px %9lu points %9lu triangles  RMSE %5.2f  FLIP %.4f  outline %lu "
            "px  holes %lu\n",
            name, way.name, threshold, stats.points, stats.triangles, d.color->rmse_covered, d.color->flip,
            d.silhouette, d.geometry ? d.geometry->holes : 0);
        rows.push_back({{"camera", name},
                        {"kind", way.name},
                        {"threshold", threshold},
                        {"points", stats.points},
                        {"triangles", stats.triangles},
                        {"rmse", d.color->rmse_covered},
                        {"flip", d.color->flip},
                        {"outline", d.silhouette}});
      }
  }
  return rows;
}

Json measure_frames(const Subject& subject, Renderer& renderer, const PopOptions& options) {
  Json rows = Json::array();
  DrawnTrees triangles = make_scene(renderer, subject.model, nullptr, {});
  DrawnTrees pop = make_scene(renderer, subject.model, subject.pop, {});
  const std::pair<const char*, Camera> cameras[] = {
      {"quarter", camera_that_covers(renderer, triangles, bounding_box(subject.model), options.size, 0.25)},
      {"near", close_camera(subject.mesh(), options.size, 0.25)},
      {"close", close_camera(subject.mesh(), options.size, 0.03)}};
  for (const auto& [name, camera] : cameras) {
    const auto ms = times_of(renderer, {&pop, &triangles}, camera, options.repeat);
    const TreeLayerStats s = pop.layers->stats();
    std::printf(
        "  frame      %-7s pop %7.2f ms (cut %.2f, lists %.2f, raster %.2f), triangles %7.2f ms: %.2f "
        "times\n",
        name, ms[0], s.cut_ms, s.gather_ms, s.raster_ms, ms[1], ms[1] / ms[0]);
    rows.push_back({{"camera", name}, {"pop_ms", ms[0]}, {"triangles_ms", ms[1]}});
  }
  return rows;
}

/// Once around and nearer: a frame's picture, and the nodes looked at, beside a fresh walk's.
Json measure_orbit(const Subject& subject, Renderer& renderer, const PopOptions& options) {
  TreeLayerOptions fresh_walk;
  fresh_walk.coherent = false;
  DrawnTrees coherent = make_scene(renderer, subject.model, subject.pop, {}),
             fresh = make_scene(renderer, subject.model, subject.pop, fresh_walk);
  const Box3 box = bounding_box(subject.model);
  const Camera first = camera_at(box, options.size, 1.5);
  const double distance = length(first.eye - first.target), height = (first.eye - first.target).z / distance;
  std::uint64_t visited = 0, all = 0;
  int different = 0;
  std::vector<double> cut, cut_fresh;
  for (int i = 0; i < options.frames; ++i) {
    const double t = static_cast<double>(i) / options.frames, a = 2 * std::numbers::pi * t;
    const double d = distance * (1 - 0.75 * t), flat = std::sqrt(1 - height * height);
    Camera camera = first;
    camera.eye = camera.target + Vec3{flat * std::cos(a), flat * std::sin(a), height} * d;
    const Frame one = draw(renderer, coherent, camera), other = draw(renderer, fresh, camera);
    different += one.screen != other.screen || one.depth != other.depth;
    if (i == 0) continue;
    visited += coherent.layers->stats().visited, all += fresh.layers->stats().visited;
    cut.push_back(coherent.layers->stats().cut_ms), cut_fresh.push_back(fresh.layers->stats().cut_ms);
  }
  const double part = static_cast<double>(visited) / static_cast<double>(std::max<std::uint64_t>(1, all));
  std::printf(
      "  orbit      %d frames: %d differ; %.1f %% of a fresh walk's nodes visited; cut %.2f ms, fresh %.2f "
      "ms\n",
      options.frames, different, 100 * part, median(cut), median(cut_fresh));
  return {{"frames", options.frames}, {"different", different}, {"visited", part}};
}

/// Cubes of 1, 8 and 64 that fill the same picture, and rows of them that hide nothing of each other.
Json measure_instances(const Subject& subject, Renderer& renderer, const PopOptions& options) {
  Json rows = Json::array();
  const Box3 box = bounding_box(subject.model);
  const Vec3 size = box.size() * 1.05;
  const std::array<std::array<int, 3>, 6> grids{
      {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {1, 1, 1}, {4, 1, 2}, {8, 1, 8}}};
  std::vector<double> last(2, 0);
  for (const auto& grid : grids) {
    Model model = subject.model;
    const Instance one = model.instances[0];
    model.instances.clear();
    for (int i = 0; i < grid[0] * grid[1] * grid[2]; ++i) {
      model.instances.push_back(one);
      const int x = i % grid[0], y = i / grid[0] % grid[1], z = i / grid[0] / grid[1];
      model.instances.back().to_world.translation += Vec3{x * size.x, y * size.y, z * size.z};
    }
    DrawnTrees trees = make_scene(renderer, model, subject.pop, {});
    const Camera camera = camera_that_covers(renderer, trees, bounding_box(model), options.size / 2, 0.25);
    Stages stages;
    const double ms = times_of(renderer, {&trees}, camera, options.repeat, &stages)[0];
    const bool cube = grid[1] > 1 || (&grid == grids.data());
    const TreeLayerStats s = trees.layers->stats();
    std::printf(
        "  instances  %2d x %d x %d %7.2f ms (cut %.2f, lists %.2f, raster %.2f), %8lu points %8lu "
        "triangles, %lu hidden, %lu visited\n",
        grid[0], grid[1], grid[2], ms, median(stages.cut), median(stages.lists), median(stages.raster),
        s.points, s.triangles, s.hidden, s.visited);
    rows.push_back(
        {{"grid", grid}, {"ms", ms}, {"hidden", cube}, {"points", s.points}, {"triangles", s.triangles}});
  }
  return rows;
}

}  // namespace dupin::bench
