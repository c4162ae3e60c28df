// Pictures by the exact ray caster, with the channels of `dupin render`'s EXR files.
#ifndef DUPIN_EXACT_EXACT_PICTURE_H
#define DUPIN_EXACT_EXACT_PICTURE_H

#include "../core/progress.h"
#include "../render/image.h"
#include "exact_scene.h"

namespace dupin::exact {

struct PictureOptions {
  unsigned outputs = kColor | kNormal | kDepth;  ///< Output bits of render/renderer.h; kPrimitive is the face
  std::optional<Color> background = Color{1, 1, 1, 1};
  std::optional<Color> color;  ///< instead of the file's
  Progress progress;
};

/// One ray a pixel, lit as `Shading::lit` says, in parallel over rows. `cancelled` if progress asks for it.
Result<Image> draw(const Model& model, const ExactScene& scene, const Camera& camera,
                   const PictureOptions& options);

/// The light of looks.glsl on a surface of the linear color `albedo`; `normal` and `to_viewer` are unit, in
/// view space (right, up, towards the viewer), and the normal faces the viewer.
Vec3 lit(const Vec3& albedo, const Vec3& normal, const Vec3& to_viewer);

}  // namespace dupin::exact

#endif
