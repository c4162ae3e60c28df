// A ray caster over quadric DPs in double, written without a look at the renderer: every DP, both roots,
// region_contains.
#ifndef DUPIN_TESTS_RENDER_ORACLE_H
#define DUPIN_TESTS_RENDER_ORACLE_H

#include <optional>

#include "../../core/camera.h"
#include "../../render/renderer.h"
#include "hand_made.h"

namespace dupin::testing {

struct OracleHit {
  double depth = 0;                       ///< along the view axis
  Vec3 point, normal;                     ///< model space; the normal outward
  std::uint32_t face = 0, primitive = 0;  ///< 1-based
  double k1 = 0, k2 = 0;
};

struct Ray {
  Vec3 origin, direction;  ///< the direction's component along the view axis is 1
};
Ray pixel_ray(const Camera& camera, double column, double row);

using Sections = std::vector<DrawOptions::Section>;

/// What is seen through (column + ½, row + ½).
std::optional<OracleHit> cast(const HandMade& scene, const Camera& camera, const Ray& ray,
                              const Sections& sections = {});

/// A frame with every number picture, held against the ray caster at every pixel.
struct Differences {
  int pixels = 0, covered = 0;
  int coverage = 0;         ///< only one of the two saw something
  int other_primitive = 0;  ///< not the same thing: at silhouettes and where two meet
  double depth_px = 0, normal_degrees = 0, curvature = 0,
         position_px = 0;  ///< largest; curvature relative to the primitive's largest
};
Differences differences(const HandMade& scene, const Camera& camera, const Frame& frame,
                        const Sections& sections = {});

}  // namespace dupin::testing

#endif
