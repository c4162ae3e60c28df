// From exact faces to differential points: the papers' uniform sampling, and two that need no super-sampling.
#ifndef DUPIN_SAMPLING_POINT_SAMPLER_H
#define DUPIN_SAMPLING_POINT_SAMPLER_H

#include "../core/progress.h"
#include "../core/status.h"
#include "differential_point.h"
#include "mesh_points.h"

namespace dupin {

enum class PointMethod {
  /// Equal steps in the parameters of each patch (knot span; arc of at most a right angle), its borders
  /// included.
  uniform,
  /// Cells of the parameter domain, halved until the rectangle at the middle reaches over the cell: density
  /// follows
  /// the local half-extents. Rectangles are no larger than their cells need. Reach is tested at eight points
  /// of the
  /// cell's border.
  adaptive,
  /// At the middles of the cells of sampler.h's quadric DPs within `tolerance`, with the DPs' certified
  /// bounds
  /// (the origins of those that are the surface itself); rectangles hold their footprints.
  certified,
};
inline constexpr std::string_view kPointMethodNames[] = {"uniform", "adaptive", "certified"};

struct PointSamplingOptions {
  PointMethod method = PointMethod::uniform;
  double epsilon = 0.012;  ///< 0 < ε <= 1
  double delta = 0;        ///< model units, > 0; for certified points not needed
  /// Uniform: so many samples along both parameters of a patch; 0: by `spacing`.
  int grid = 0;
  /// Uniform: the largest distance of neighbouring samples (along three lines of each patch each way); 0: as
  /// far as the rectangles reach, so that each covers what lies between it and the next.
  double spacing = 0;
  /// Adaptive: cells across a trim are halved to this size, by which their rectangles may stand out; so are
  /// cells at a side of the surface over which their rectangles stand out farther; 0: δ / 8.
  double border = 0;
  /// Certified: the largest distance from the surface.
  double tolerance = 0;
  MeshPointOptions mesh;  ///< of meshes; epsilon and first_face are set by the sampler
  Progress progress;
};

/// By need or spacing, a patch has at most so many samples along a parameter.
inline constexpr int kMostSteps = 1024;
/// In all; more are refused with `limit`.
inline constexpr std::size_t kMostPoints = 200'000'000;

/// Every face of every part, in parallel, and the vertices of its polygons (mesh_points.h; not for certified
/// points, which a mesh has none of); the result does not depend on the number of threads. Faces without a
/// point are listed in PartPoints::skipped with the reason. A face that uniform sampling misses (its trims
/// lie between the samples) is sampled more densely until it is not.
Result<PointScene> sample_points(const Model& model, const PointSamplingOptions& options);

}  // namespace dupin

#endif
