// One model in one view, drawn as the papers draw it: points and splats against the exact surface.
#ifndef DUPIN_BENCH_PAPERS_STAGE_H
#define DUPIN_BENCH_PAPERS_STAGE_H

#include <memory>
#include <string>

#include "../../render/image.h"
#include "../../render/metrics.h"
#include "../../render/renderer.h"
#include "../../sampling/point_sampler.h"

namespace dupin::bench {

/// What one representation is and costs.
struct Measured {
  std::size_t points = 0;
  std::size_t raw_bytes = 0;     ///< 62 a differential point, 32 a splat (position, normal, radius, colour)
  std::size_t packed_bytes = 0;  ///< of the .dps file; 0 for splats
  double ms = 0, processor_ms = 0;      ///< of a frame; median
  double rmse = 0, normal_degrees = 0;  ///< 8-bit colour over all pixels; mean angle to the exact normal
  /// Pixels well within the reference's outline at which there is nothing, or something more than
  /// kHoleDepthPx behind it; and at which something is as far before it.
  std::uint64_t holes = 0, blocked = 0;
  std::uint64_t silhouette = 0;  ///< pixels that only one of the two covers
};

/// Seconds of this thread's clock, and of all threads' processors.
struct Clock {
  double wall = 0, processor = 0;
  static Clock now();
  friend Clock operator-(const Clock& a, const Clock& b) {
    return {a.wall - b.wall, a.processor - b.processor};
  }
};

class Stage {
 public:
  /// Reads the file and draws its reference: quadric DPs to a twentieth of a pixel and of a degree; a mesh,
  /// its triangles with the means of their normals.
  static Result<std::unique_ptr<Stage>> open(const std::string& path, const std::string& view, int width,
                                             int height);

  const Model& model() const { return model_; }
  bool is_mesh() const { return mesh_; }
  const Camera& camera() const { return camera_; }

  /// Draws the points, in `frames` timed frames.
  Result<Measured> measure(const PointContent& content, int frames);
  /// Quadric DPs within a tolerance in pixels; packed_bytes and raw_bytes are what is uploaded.
  Result<Measured> measure_quadric(double tolerance_px, double normal_degrees, int frames);
  /// Writes the reference, or the last measured picture.
  Status write_reference(const std::string& path) const { return write_png(path, to_image8(reference_)); }
  Status write_last(const std::string& path) const { return write_png(path, to_image8(last_)); }

 private:
  Result<Measured> measure(Scene& scene, int frames);

  Model model_;
  Camera camera_;
  DrawOptions draw_;
  bool mesh_ = false;
  std::unique_ptr<Context> context_;
  std::unique_ptr<Renderer> renderer_;
  Image reference_, last_;
};

}  // namespace dupin::bench

#endif
