// What only the exact surfaces know of a drawn pixel: its parameters, and the curvatures where a DP's quadric
// is not the surface itself. On the CPU, from the point that was drawn: the parameters of the surface's point
// nearest to it, found from the DP's cell.
#ifndef DUPIN_RENDER_EXACT_PIXELS_H
#define DUPIN_RENDER_EXACT_PIXELS_H

#include <cstdint>
#include <vector>

#include "scene.h"
#include "view_rays.h"

namespace dupin {

/// What was drawn, pixel after pixel.
struct DrawnPixels {
  const ViewRays& view;
  const std::vector<float>& depth;            ///< along the view axis; +inf where nothing is drawn
  const std::vector<std::uint32_t>& numbers;  ///< face and primitive, 1-based
};

/// Filled where `find_exact` could say; otherwise as they were. Any may be null.
struct ExactPixels {
  std::vector<float>* uv = nullptr;         ///< 2 a pixel
  std::vector<float>* curvature = nullptr;  ///< k1, k2 in model space, towards the outward normal
  std::vector<float>* direction = nullptr;  ///< of k1, 3 a pixel, unit, model space
};

/// In parallel over rows; the same result at any number of threads. `model` is the one that the scene was
/// made from. Curvatures of planes, cylinders, cones and spheres are left as they are: their DPs have them.
void find_exact(const Model& model, const Scene::Impl& scene, const DrawnPixels& drawn,
                const ExactPixels& result);

/// Of what is farther from the surface's point found than this many pixels, or DPs' bounds, nothing is said.
inline constexpr double kFarthestPx = 4, kFarthestBounds = 4;

}  // namespace dupin

#endif
