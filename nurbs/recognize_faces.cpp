#include <atomic>

#include "../core/parallel.h"
#include "bezier.h"
#include "bounds.h"
#include "model.h"
#include "recognize.h"

namespace dupin {
namespace {

/// The extent of a face's surface over its region, by a few points: only the scale of a tolerance.
double extent(const Surface& surface, const Box2& uv) {
  constexpr int kSteps = 4;
  Box3 box;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j)
      box.add(point_at(surface, uv.lo.x + uv.size().x * i / kSteps, uv.lo.y + uv.size().y * j / kSteps));
  return box.diagonal();
}

}  // namespace

int recognize_faces(Model& model) {
  std::atomic<int> count{0};
  for (Part& part : model.parts)
    parallel_for(part.faces.size(), [&](std::size_t i) {
      Face& face = part.faces[i];
      const Surface& surface = part.surfaces[face.surface];
      if (is_quadric(surface) || std::holds_alternative<Torus>(surface.geometry)) return;
      const auto found =
          recognize(surface, face.uv_box, kRecognitionTolerance * extent(surface, face.uv_box));
      if (!found) return;
      face.recognized = std::make_shared<RecognizedSurface>(
          RecognizedSurface{found->surface, found->deviation, found->normal_deviation});
      ++count;
    });
  return count;
}

}  // namespace dupin
