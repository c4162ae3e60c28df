#include "exact_picture.h"

#include <atomic>
#include <cmath>
#include <limits>

#include "../core/parallel.h"

namespace dupin::exact {
namespace {

constexpr Color kDefaultColor{0.55F, 0.57F, 0.60F, 1};

/// Files' colors have 8 bits in sRGB by the time they are drawn.
double as_drawn(float linear) {
  const double c = std::clamp(linear, 0.0F, 1.0F);
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  const double byte = std::round(255 * encoded) / 255;
  return byte <= 0.04045 ? byte / 12.92 : std::pow((byte + 0.055) / 1.055, 2.4);
}

Vec3 albedo(const Model& model, const Hit& hit, const PictureOptions& options) {
  const Instance& instance = model.instances[hit.instance];
  const Part& part = model.parts[instance.part];
  const Face& face = part.faces[hit.face];
  const Color color = options.color    ? *options.color
                      : face.color     ? *face.color
                      : instance.color ? *instance.color
                      : part.color     ? *part.color
                                       : kDefaultColor;
  return {as_drawn(color.r), as_drawn(color.g), as_drawn(color.b)};
}

class Painter {
 public:
  Painter(const Model& model, const Camera& camera, const PictureOptions& options)
      : model_(model), camera_(camera), axes_(camera_axes(camera)), options_(options) {
    image_.width = camera.width;
    image_.height = camera.height;
    (camera.orthographic ? image_.pixel_constant : image_.pixel_per_depth) = pixel_size(camera, 1);
    const auto add = [&](unsigned output, std::initializer_list<const char*> names) {
      if (options.outputs & output)
        for (const char* name : names) image_.channel(name);
    };
    add(kColor, {"R", "G", "B", "A"});
    add(kNormal, {"N.X", "N.Y", "N.Z"});
    add(kDepth, {"Z"});
    add(kPosition, {"P.X", "P.Y", "P.Z"});
    add(kCurvature, {"k1", "k2"});
    add(kDirection, {"d1.X", "d1.Y", "d1.Z"});
    add(kFace, {"id"});
    add(kPrimitive, {"prim"});
    add(kUv, {"u", "v"});
  }

  void paint(int column, int row, const Line& ray, const std::optional<Hit>& hit) {
    const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width) +
                          static_cast<std::size_t>(column);
    if (hit)
      paint_hit(i, ray, *hit);
    else
      paint_background(i);
  }
  Image take() { return std::move(image_); }

 private:
  /// Writes the numbers to the channels, if the output was asked for. Channels stand in the order of the
  /// constructor's list.
  void set(std::size_t i, unsigned output, const char* first, std::initializer_list<double> values) {
    if (!(options_.outputs & output)) return;
    Image::Channel* channel = &image_.channel(first);
    for (const double value : values) (channel++)->values[i] = static_cast<float>(value);
  }
  void paint_background(std::size_t i) {
    if (options_.background) {
      const Color& c = *options_.background;
      set(i, kColor, "R", {c.r * c.a, c.g * c.a, c.b * c.a, c.a});
    }
    set(i, kDepth, "Z", {std::numeric_limits<double>::infinity()});
  }
  void paint_hit(std::size_t i, const Line& ray, const Hit& hit) {
    const Vec3 to_viewer = normalized(-ray.direction);
    const auto view = [&](const Vec3& v) {
      return Vec3{dot(v, axes_.right), dot(v, axes_.up), dot(v, axes_.back)};
    };
    const Vec3 facing = dot(hit.normal, to_viewer) < 0 ? -hit.normal : hit.normal;
    const Vec3 c = lit(albedo(model_, hit, options_), view(facing), view(to_viewer));
    set(i, kColor, "R", {c.x, c.y, c.z, 1});
    set(i, kNormal, "N.X", {hit.normal.x, hit.normal.y, hit.normal.z});
    set(i, kDepth, "Z", {hit.depth});
    set(i, kPosition, "P.X", {hit.point.x, hit.point.y, hit.point.z});
    set(i, kCurvature, "k1", {hit.k1, hit.k2});
    set(i, kDirection, "d1.X", {hit.d1.x, hit.d1.y, hit.d1.z});
    set(i, kFace, "id", {double(hit.number)});
    set(i, kPrimitive, "prim", {double(hit.number)});
    set(i, kUv, "u", {hit.u, hit.v});
  }

  const Model& model_;
  const Camera& camera_;
  CameraAxes axes_;
  const PictureOptions& options_;
  Image image_;
};

}  // namespace

Vec3 lit(const Vec3& albedo, const Vec3& n, const Vec3& v) {
  const Vec3 key{-0.42, 0.62, 0.66}, fill{0.80, 0.05, 0.59};
  const double sky = 0.5 + 0.5 * n.y;
  const double diffuse = 0.16 + 0.08 * sky + 0.30 * std::max(dot(n, v), 0.0) +
                         0.46 * std::max(dot(n, key), 0.0) + 0.14 * std::max(dot(n, fill), 0.0);
  const double glint = 0.10 * std::pow(std::max(dot(n, normalized(key + v)), 0.0), 32);
  return albedo * diffuse + Vec3{glint, glint, glint};
}

Result<Image> draw(const Model& model, const ExactScene& scene, const Camera& camera,
                   const PictureOptions& options) {
  Painter painter(model, camera, options);
  const double least = camera.orthographic ? -std::numeric_limits<double>::infinity() : 0;
  std::atomic<int> done{0};
  std::atomic<bool> stop{false};
  parallel_for(static_cast<std::size_t>(camera.height), [&](std::size_t row) {
    if (stop) return;
    for (int column = 0; column < camera.width; ++column) {
      const Line ray = pixel_ray(camera, column, static_cast<int>(row));
      painter.paint(column, static_cast<int>(row), ray, scene.cast(ray, least));
    }
    if (!report(options.progress, "casting rays", double(++done) / camera.height)) stop = true;
  });
  if (stop) return {StatusCode::cancelled, "cancelled"};
  return painter.take();
}

}  // namespace dupin::exact
