// The statistics of `dupin render` (docs/manual.md, "Statistics").
#ifndef DUPIN_APP_RENDER_STATS_H
#define DUPIN_APP_RENDER_STATS_H

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../nurbs/model.h"
#include "../render/tree_layer.h"
#include "../sampling/quadric_dp.h"

namespace dupin::app {

/// Seconds of each stage.
struct StageTimes {
  double import = 0, prepare = 0, context = 0, upload = 0, first_frame = 0, frame_median = 0, write = 0,
         total = 0;
};

/// Face instances of the files: drawn + skipped.size() = total.
struct FaceReport {
  std::size_t drawn = 0;
  std::vector<SkippedFace> skipped;  ///< one entry a face instance
  std::size_t total() const { return drawn + skipped.size(); }
};
/// What the reader left out and, of each part, what is listed in `left_out`.
FaceReport report_faces(const Model& model, const std::vector<std::vector<SkippedFace>>& left_out);
nlohmann::ordered_json to_json(const FaceReport& faces);
/// What the reader left out and what has no DPs.
FaceReport report_faces(const Model& model, const DpScene& scene);
/// What the reader left out and what the kernel made no triangles of.
FaceReport report_faces_of_triangles(const Model& model);

struct CertifiedError {
  double bound = 0, bound_px = 0, normal_bound_degrees = 0;
  std::size_t estimated = 0;  ///< primitives of offset surfaces, whose bound is partly sampled
  std::size_t specks =
      0;  ///< primitives at singular points, smaller than the tolerance: no bound of their normal
};
CertifiedError certified_error(const DpScene& scene);

/// Differential points that were sampled for this, before and after simplification.
struct SampledPoints {
  std::size_t before = 0, after = 0;
  double sample_seconds = 0, simplify_seconds = 0;
};

/// --primitive amg, all parts together.
struct DomainStats {
  std::size_t points = 0, texels = 0;
  std::size_t level = 0, levels = 0;  ///< the finest that is drawn, and how many the part with most has
  double deviation_99 = 0;            ///< the largest of the parts', in their own units (DomainSet)
  double decomposition = 0, construction = 0;  ///< seconds
};

struct RenderStats {
  std::vector<std::string> files;
  FaceReport faces;
  std::string primitive;
  std::uint64_t primitives = 0, bytes = 0, clips = 0;
  std::optional<CertifiedError> error;   ///< none for triangles
  std::optional<TreeLayerStats> points;  ///< of meshes' point trees, in the last frame
  std::optional<SampledPoints> sampled;
  std::optional<DomainStats> domains;
  StageTimes times;
  int width = 0, height = 0;
  std::uint64_t covered_pixels = 0;
  std::string device, gl_renderer;
};
nlohmann::ordered_json to_json(const RenderStats& stats);

/// "import 0.73 s, prepare …" for a person.
std::string describe(const StageTimes& times);

}  // namespace dupin::app

#endif
