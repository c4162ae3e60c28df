#include "truth.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "../../exact/exact_picture.h"

namespace dupin::app {
namespace {

constexpr int kSeen = 24;  // rays a side, to find a surface to go close to

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string vector(const Vec3& v) {
  return number(v.x) + "," + number(v.y) + "," + number(v.z);
}

/// The point of the surface that a coarse raster of rays sees nearest to the picture's middle.
Vec3 seen_in_the_middle(const exact::ExactScene& scene, Camera camera, const Vec3& otherwise) {
  camera.height = camera.width = kSeen;
  const double least = camera.orthographic ? -std::numeric_limits<double>::infinity() : 0;
  int nearest = std::numeric_limits<int>::max();
  Vec3 seen = otherwise;
  for (int y = 0; y < kSeen; ++y)
    for (int x = 0; x < kSeen; ++x) {
      const int dx = 2 * x + 1 - kSeen, dy = 2 * y + 1 - kSeen, away = dx * dx + dy * dy;
      if (away >= nearest) continue;
      if (const auto hit = scene.cast(exact::pixel_ray(camera, x, y), least))
        nearest = away, seen = hit->point;
    }
  return seen;
}

}  // namespace

bool Truth::has_exact_faces() const {
  return has_faces_ && std::any_of(model_.parts.begin(), model_.parts.end(),
                                   [](const Part& p) { return !p.faces.empty(); });
}

const exact::ExactScene& Truth::scene() {
  if (!scene_) scene_ = std::make_unique<exact::ExactScene>(model_);
  return *scene_;
}

Result<Camera> Truth::camera(const StudyRow& row) {
  Result<Camera> made = make_camera(row.render.view, model_);
  if (!made.ok() || row.view.zoom == 1) return made;
  Camera camera = *made;
  const Vec3 away = camera.eye - camera.target;
  if (row.view.zoom > 1 && has_exact_faces())
    camera.target = seen_in_the_middle(scene(), camera, camera.target);
  camera.eye = camera.target + away / row.view.zoom;
  camera.ortho_height /= row.view.zoom;
  return camera;
}

Result<Image> Truth::picture(const StudyRow& row, const Camera& camera) {
  exact::PictureOptions options;
  options.background.reset();
  if (row.render.background != "none") options.background = row.render.background_color();
  options.color = row.render.uniform_color();
  return exact::draw(model_, scene(), camera, options);
}

std::string camera_arguments(const Camera& camera) {
  std::string text = "--eye=" + vector(camera.eye) + " --target=" + vector(camera.target) +
                     " --up-vector=" + vector(camera.up) + " --resolution " + std::to_string(camera.width) +
                     "," + std::to_string(camera.height);
  if (camera.orthographic) return text + " --orthographic --height " + number(camera.ortho_height);
  return text + " --fov " + number(camera.fov_degrees);
}

}  // namespace dupin::app
