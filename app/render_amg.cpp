// --primitive amg: a few textured domains a part.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>

#include "../sampling/sampler.h"
#include "../simplify/domain_file.h"
#include "../simplify/point_sources.h"
#include "output_file.h"
#include "render_primitive.h"
#include "stopwatch.h"

namespace dupin::app {
namespace {

/// Without a picture to go by: exact faces have points this part of the part's diagonal apart.
constexpr double kDefaultSpacing = 1.0 / 400;
constexpr double kSamplingError = 0.1;  ///< of the DPs that points are taken from, in spacings

/// The edge of a pixel where a placement of the part is nearest, in the part's units; infinite for a part
/// that is not placed.
double smallest_pixel(const Model& model, std::size_t part, const Camera& camera) {
  double smallest = std::numeric_limits<double>::infinity();
  const Box3& box = model.parts[part].box;
  for (const Instance& instance : model.instances) {
    if (instance.part != part || box.empty()) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i)
      nearest = std::min(nearest, view_depth(camera, transform_point(instance.to_world, box.corner(i))));
    // With the eye in its midst a part is as near as its own size allows to look at it.
    const double scale = std::cbrt(std::abs(determinant(instance.to_world.linear)));
    nearest = std::max(nearest, 0.1 * scale * box.diagonal());
    smallest = std::min(smallest, pixel_size(camera, nearest) / scale);
  }
  return smallest;
}

/// Red, green and blue of a domain, 0 … 1, none of them dark: hues a golden angle apart.
std::array<double, 3> domain_color(std::uint32_t domain) {
  const double hue = std::fmod(domain * 0.6180339887498949, 1.0);
  std::array<double, 3> color;
  for (std::size_t k = 0; k < 3; ++k)
    color[k] =
        0.2 + 0.8 * std::clamp(std::abs(std::fmod(6 * hue + 6 - 2 * double(k), 6.0) - 3) - 1, 0.0, 1.0);
  return color;
}

std::uint32_t color_word(const std::array<double, 3>& color) {
  std::uint32_t word = 0xff000000U;
  for (std::size_t k = 0; k < 3; ++k)
    word |= static_cast<std::uint32_t>(std::lround(255 * color[k])) << 8 * k;
  return word;
}

/// The paper's figure 5: Σ Ψ color of the domain.
std::vector<std::uint32_t> domain_colors(const DomainBasis& basis) {
  std::vector<std::uint32_t> colors;
  for (std::size_t i = 0; i + 1 < basis.starts.size(); ++i) {
    std::array<double, 3> sum{};
    for (std::uint64_t k = basis.starts[i]; k < basis.starts[i + 1]; ++k)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += basis.value[k] * domain_color(basis.domain[k])[c];
    for (double& c : sum) c = std::min(c, 1.0);
    colors.push_back(color_word(sum));
  }
  return colors;
}

/// The paper's figure 1: black at edges, white where it is flat.
std::vector<std::uint32_t> classifier_colors(const std::vector<double>& classifier) {
  std::vector<std::uint32_t> colors;
  for (const double c : classifier) {
    const double gray = std::clamp(c / kFlatClassifier, 0.0, 1.0);
    colors.push_back(color_word({gray, gray, gray}));
  }
  return colors;
}

/// Changes where domains cannot be the model's any more.
std::uint64_t model_key(const Model& model) {
  std::uint64_t key = 0xcbf29ce484222325U;  // FNV-1a over words
  const auto add = [&](std::uint64_t word) { key = (key ^ word) * 0x100000001b3U; };
  for (const Part& part : model.parts) {
    add(part.faces.size());
    add(part.polygons.positions.size());
    for (const Vec3& corner : {part.box.lo, part.box.hi})
      for (int k = 0; k < 3; ++k) add(std::bit_cast<std::uint64_t>(corner[k]));
  }
  return key;
}

Status load_domains(const std::string& path, const Model& model, DomainScene& domains) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return {StatusCode::unreadable, path + ": it cannot be read"};
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  Result<DomainFile> file = read_domains(bytes);
  if (!file) return {file.status().code, path + ": " + file.status().message};
  bool fits = file->key == model_key(model) && file->scene.parts.size() == model.parts.size();
  for (std::size_t i = 0; fits && i < model.parts.size(); ++i)
    for (const DomainSet& set : file->scene.parts[i])
      fits = fits &&
             (set.faces.empty() || set.faces.back() < std::max<std::size_t>(1, face_count(model.parts[i])));
  if (!fits) return {StatusCode::unreadable, path + ": these domains are of another model"};
  domains = std::move(file->scene);
  return {};
}

class AmgPrimitive : public RenderPrimitive {
 public:
  explicit AmgPrimitive(const RenderOptions& options) : options_(options.amg) {}

  std::string kind() const override { return "amg"; }
  SceneContent content() const override {
    SceneContent content;
    content.domains.scene = &domains_;
    content.domains.blend = options_.blend == "opaque"      ? DomainBlend::opaque
                            : options_.blend == "published" ? DomainBlend::published
                                                            : DomainBlend::surface;
    content.domains.normal_maps = options_.normal_maps;
    content.domains.heights = options_.heights;
    return content;
  }

  Status prepare(const PrimitiveInput& input, RenderStats& stats) override {
    Stopwatch watch;
    std::vector<std::vector<SkippedFace>> left_out(input.model.parts.size());
    if (!options_.load.empty()) {
      if (Status got = load_domains(options_.load, input.model, domains_); !got.ok()) return got;
      describe_loaded();
    }
    OutputFile kept;
    if (!options_.save.empty())
      if (Status opened = kept.open(options_.save); !opened.ok()) return opened;
    domains_.parts.resize(input.model.parts.size());
    for (std::size_t i = 0; i < input.model.parts.size() && options_.load.empty(); ++i)
      if (Status made = prepare_part(input, i, left_out[i]); !made.ok()) return made;
    stats.times.prepare = watch.lap();
    stats.faces = report_faces(input.model, left_out);
    stats.domains = stats_;
    if (options_.save.empty()) return {};
    const bool whole =
        std::all_of(left_out.begin(), left_out.end(), [](const auto& faces) { return faces.empty(); });
    if (!whole)
      return {StatusCode::unreadable,
              options_.save + ": faces were left out, which a file of domains cannot say"};
    Status status = kept.write(write_domains(domains_, model_key(input.model)));
    return status.ok() ? kept.commit() : status;
  }

 private:
  void describe_loaded() {
    for (const auto& levels : domains_.parts)
      for (const DomainSet& set : levels) {
        stats_.points += set.points;
        stats_.texels += set.atlas.psi.size();
        stats_.deviation_99 = std::max(stats_.deviation_99, set.deviation_99);
      }
  }

  Result<SurfacePoints> face_points(const PrimitiveInput& input, const Part& part, double spacing,
                                    std::vector<SkippedFace>& left_out) const {
    SamplingOptions sampling;
    sampling.tolerance = kSamplingError * spacing;
    sampling.normal_tolerance = input.options.normal_tolerance_degrees * std::numbers::pi / 180;
    sampling.progress = input.progress;
    Model one;
    one.parts.push_back(part);
    Result<DpScene> dps = sample_quadric_dps(one, sampling);
    if (!dps) return dps.status();
    left_out = dps->parts[0].skipped;
    return dp_points(dps->parts[0], spacing);
  }

  Result<SurfacePoints> points_of(const PrimitiveInput& input, std::size_t index,
                                  std::vector<SkippedFace>& left_out) const {
    const Part& part = input.model.parts[index];
    SurfacePoints points;
    if (!part.faces.empty()) {
      const double shown = smallest_pixel(input.model, index, input.camera);
      if (!std::isfinite(shown)) return points;
      const double spacing =
          options_.spacing > 0 ? options_.spacing : std::max(shown, kDefaultSpacing * part.box.diagonal());
      Result<SurfacePoints> made = face_points(input, part, spacing, left_out);
      if (!made) return made.status();
      points = std::move(*made);
    }
    if (!part.polygons.empty()) {
      Result<SurfacePoints> made = mesh_points(part, options_.spacing);
      if (!made) return made.status();
      append(*made, points);
    }
    return points;
  }

  Status prepare_part(const PrimitiveInput& input, std::size_t index, std::vector<SkippedFace>& left_out) {
    Result<SurfacePoints> points = points_of(input, index, left_out);
    if (!points) return points.status();
    if (points->size() == 0) return {};
    DecomposeOptions decompose_options;
    decompose_options.neighbors = static_cast<std::size_t>(options_.neighbors);
    decompose_options.progress = input.progress;
    Stopwatch watch;
    const Result<DomainBases> bases = decompose(*points, decompose_options);
    if (!bases) return bases.status();
    stats_.decomposition += watch.lap();
    if (input.options.shading == "classifier") points->colors = classifier_colors(bases->classifier());
    Result<DomainSet> set = choose_level(input, index, *points, *bases);
    if (!set) return set.status();
    stats_.construction += watch.lap();
    stats_.points += points->size();
    stats_.texels += set->atlas.psi.size();
    stats_.deviation_99 = std::max(stats_.deviation_99, set->deviation_99);
    domains_.parts[index].push_back(std::move(*set));
    return {};
  }

  /// The level that is asked for, or the coarsest that is within the tolerance, or the finest.
  Result<DomainSet> choose_level(const PrimitiveInput& input, std::size_t index, SurfacePoints& points,
                                 const DomainBases& bases) {
    DomainPrimitiveOptions primitive_options;
    primitive_options.texel = options_.texel;
    primitive_options.progress = input.progress;
    const double tolerance = input.options.tolerance_px * smallest_pixel(input.model, index, input.camera);
    const bool given = options_.level >= 0;
    for (std::size_t level = given ? std::min(static_cast<std::size_t>(options_.level), bases.levels() - 1)
                                   : 0;
         ; ++level) {
      if (input.options.shading == "domains") points.colors = domain_colors(bases.level(level));
      Result<DomainSet> set = make_domain_set(points, bases, level, primitive_options);
      if (set && !given && set->deviation_99 > tolerance && level + 1 < bases.levels()) continue;
      stats_.level = std::max(stats_.level, level);
      stats_.levels = std::max(stats_.levels, bases.levels());
      return set;
    }
  }

  AmgOptions options_;
  DomainScene domains_;
  DomainStats stats_;
};

}  // namespace

std::unique_ptr<RenderPrimitive> make_amg_primitive(const RenderOptions& options) {
  return std::make_unique<AmgPrimitive>(options);
}

}  // namespace dupin::app
