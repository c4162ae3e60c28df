// Inside the folder: one face into differential points.
#ifndef DUPIN_SAMPLING_POINT_FACES_H
#define DUPIN_SAMPLING_POINT_FACES_H

#include <optional>

#include "point_sampler.h"
#include "trim_region.h"

namespace dupin {

/// A face, and how its points are made.
class FacePoints {
 public:
  FacePoints(const Part& part, std::uint32_t index, const PointSamplingOptions& options);
  const TrimRegion& region() const { return region_; }
  const Surface& surface() const { return surface_; }
  const PointSamplingOptions& options() const { return options_; }
  /// Nothing where the surface has no curvature; limits are taken towards `inside`.
  std::optional<DifferentialPoint> at(Vec2 uv, Vec2 inside) const;

 private:
  const Face& face_;
  const Surface& surface_;
  const std::uint32_t index_;
  const PointSamplingOptions& options_;
  const TrimRegion region_;
};

/// One patch of a face.
struct PatchPoints {
  PartPoints points;
  bool undefined = false;  ///< some sample within the trims has no curvature
};
/// The grid over a patch: `refine` times as dense as the options say, but within kMostSteps (or the options'
/// grid).
SampleGrid uniform_grid(const FacePoints& face, const Box2& patch, int refine);
PatchPoints uniform_patch(const FacePoints& face, const Box2& patch, const SampleGrid& grid);
PatchPoints adaptive_patch(const FacePoints& face, const Box2& patch);

/// Appends another's points, grids and edges.
void append(const PartPoints& from, PartPoints& to);

}  // namespace dupin

#endif
