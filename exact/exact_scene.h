// The exact ray caster: what is seen of a model's exact trimmed surfaces along a ray, in double precision.
//
// It is the ground truth that pictures of DPs and of triangles are measured against, so it shares no step
// with either: no DPs, no clips, no triangles, no GL. Surfaces are met as surface_caster.h says, trims
// decided on the pcurves as trim_region.h says, and a point found is made exact by Newton's method on the
// surface's own evaluator. It is slow.
//
// Cracks: where two faces meet, their pcurves agree with each other only to within the edge's tolerance, and
// a ray could pass between them. What lies between is filled (crack_strips.h, `Hit::in_crack`).
#ifndef DUPIN_EXACT_EXACT_SCENE_H
#define DUPIN_EXACT_EXACT_SCENE_H

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../core/camera.h"
#include "../nurbs/model.h"
#include "patch_ray.h"

namespace dupin::exact {

struct Hit {
  double depth = 0;  ///< the ray's parameter
  Vec3 point;        ///< model space
  Vec3 normal;       ///< unit, outward; not finite where the surface has none
  double k1 = 0, k2 = 0;
  Vec3 d1;                     ///< of k1, unit
  std::uint32_t instance = 0;  ///< index in the model
  std::uint32_t face = 0;      ///< index in the part
  std::uint32_t number = 0;    ///< 1-based over all face instances, in the model's order
  double u = 0, v = 0;         ///< of the face's surface
  bool in_crack = false;       ///< between two faces that share an edge
};

/// The ray through the centre of a pixel; the direction's component along the view axis is 1, so that its
/// parameter is the depth.
Line pixel_ray(const Camera& camera, int column, int row);

class ExactScene {
 public:
  /// The model must outlive it.
  explicit ExactScene(const Model& model);
  ~ExactScene();

  /// The nearest point with a parameter of at least `least`; of equally near ones the lowest face number's.
  std::optional<Hit> cast(const Line& ray, double least) const;

  /// Faces of which crossings may be missed (SurfaceCaster::complete), one line each.
  std::vector<std::string> incomplete_faces() const;
  /// The widest gap between consecutive pcurves of a loop, as a part of its face's parameter box.
  double widest_gap() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dupin::exact

#endif
