// How large an error may be where: the same everywhere, or what a camera can resolve.
#ifndef DUPIN_SAMPLING_TOLERANCE_FIELD_H
#define DUPIN_SAMPLING_TOLERANCE_FIELD_H

#include <vector>

#include "sampler.h"

namespace dupin {

/// For one part, in its own space. With a camera, every instance of the part is looked at.
class ToleranceField {
 public:
  ToleranceField(const SamplingOptions& options, const Model& model, std::uint32_t part);

  /// The largest deviation that stays within the tolerances for everything in the box; infinite where no
  /// instance of it is in the picture and only that counts.
  double at(const Box3& box) const;
  /// What `at` is in pixels; 0 without a camera.
  double tolerance_px() const { return has_camera_ ? tolerance_px_ : 0; }

 private:
  /// A camera as an instance of the part sees it.
  struct View {
    Affine3 to_world;
    double scale;  ///< the largest stretch of a length by the instance
  };
  /// Size of a pixel, in the part's units, at the box's nearest visible point; infinite if it is out of the
  /// picture.
  double pixel_in_part(const View& view, const Box3& box) const;
  double finest_pixel(const Box3& box) const;

  double fixed_ = 0, tolerance_px_ = 0;
  bool has_camera_ = false;
  Camera camera_;
  Vec3 right_, up_, forward_;
  double tan_x_ = 0, tan_y_ = 0, least_depth_ = 0, obliqueness_ = 1;
  std::vector<View> views_;
};

}  // namespace dupin

#endif
