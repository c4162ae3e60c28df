// --primitive dp, square, rectangle, ellipse: the papers' points and splats, sampled from faces or read from
// .dps files.
#include <algorithm>

#include "../simplify/dps_file.h"
#include "render_primitive.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// δ over the least border of its own accord.
constexpr double kFinestBorder = 32;
constexpr const char* kNames[] = {"dp", "square", "rectangle", "ellipse"};

float linear(std::uint8_t srgb) {
  const float c = static_cast<float>(srgb) / 255;
  return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
}

/// A .dps file as a part: a face a colour.
Status add_points_file(const std::string& path, Model& model, PointScene& scene) {
  Result<DpsContent> content = read_dps(path);
  if (!content.ok()) return content.status();
  Instance instance;
  instance.part = static_cast<std::uint32_t>(model.parts.size());
  Part& part = model.parts.emplace_back();
  PartPoints& points = scene.parts.emplace_back();
  part.name = path;
  for (DpsChunk& group : content->groups) {
    const auto [r, g, b] = group.colors.diffuse;
    Face& face = part.faces.emplace_back();
    face.color = Color{linear(r), linear(g), linear(b), 1};
    for (DifferentialPoint& p : group.points) {
      p.face = static_cast<std::uint32_t>(part.faces.size() - 1);
      for (const double s : {-1.0, 1.0})
        for (const double t : {-1.0, 1.0})
          part.box.add(p.position + p.u * (s * p.half_u) + p.v * (t * p.half_v));
    }
    points.points.insert(points.points.end(), group.points.begin(), group.points.end());
  }
  model.instances.push_back(instance);
  return {};
}

class PointsPrimitive : public RenderPrimitive {
 public:
  explicit PointsPrimitive(const RenderOptions& options) {
    const auto* name = std::find(std::begin(kNames), std::end(kNames), options.primitive);
    if (name != std::end(kNames)) primitive_ = static_cast<PointPrimitive>(name - std::begin(kNames));
    published_ = options.point_shading == "published";
  }

  std::string kind() const override { return kNames[static_cast<int>(primitive_)]; }

  Result<Loaded> load(Session& session, const RenderOptions& options) override {
    if (!options.points_files()) return app::load(session, options.files);
    Stopwatch watch;
    Loaded loaded;
    loaded.model.format = "dps";
    for (const std::string& file : options.files) {
      loaded.model.source += (loaded.model.source.empty() ? "" : " + ") + file;
      if (const Status status = add_points_file(file, loaded.model, points_); !status.ok()) return status;
    }
    loaded.import_seconds = watch.lap();
    read_ = true;
    return loaded;
  }

  Status prepare(const PrimitiveInput& input, RenderStats& stats) override {
    Stopwatch watch;
    if (!read_) {
      const PointOptions options = with_defaults(input);
      PointSamplingOptions sampling = options.sampling(input.model);
      sampling.progress = input.progress;
      // Of their own accord rectangles stand out over borders by a pixel; but a close-up does not make a
      // model's borders endless.
      if (sampling.border == 0 && input.options.points.method.empty())
        sampling.border = std::max(pixel(input), sampling.delta / kFinestBorder);
      Result<MadePoints> made = make_points(input.model, sampling, options);
      if (!made.ok()) return made.status();
      points_ = std::move(made->scene);
      stats.sampled = {made->before, points_.count(), made->sample_seconds, made->simplify_seconds};
    }
    stats.times.prepare = watch.lap();
    std::vector<std::vector<SkippedFace>> left_out;
    for (const PartPoints& part : points_.parts) left_out.push_back(part.skipped);
    stats.faces = report_faces(input.model, left_out);
    return {};
  }

  SceneContent content() const override { return {nullptr, {}, {&points_, primitive_, published_}}; }

 private:
  static double pixel(const PrimitiveInput& input) {
    const Camera& camera = input.camera;
    const double away = distance(camera.eye, bounding_box(input.model).center());
    const double height =
        camera.orthographic ? camera.ortho_height : 2 * away * std::tan(camera.fov_degrees * kPi / 360);
    return height / camera.height;
  }

  /// Points as dense as the curvature asks; splats, which are flat, as dense as the picture.
  PointOptions with_defaults(const PrimitiveInput& input) const {
    constexpr double kSplatSpacingPx = 2;
    PointOptions options = input.options.points;
    if (!options.method.empty() || options.grid > 0 || options.spacing > 0) return options;
    if (primitive_ == PointPrimitive::differential_point) {
      options.method = "adaptive";
    } else {
      options.spacing = kSplatSpacingPx * pixel(input);
    }
    return options;
  }

  PointPrimitive primitive_ = PointPrimitive::differential_point;
  bool published_ = true, read_ = false;
  PointScene points_;
};

}  // namespace

std::unique_ptr<RenderPrimitive> make_points_primitive(const RenderOptions& options) {
  return std::make_unique<PointsPrimitive>(options);
}

}  // namespace dupin::app
