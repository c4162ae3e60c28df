// Pictures of a surface drawn in several ways, and how much they differ from those of all of its triangles.
#ifndef DUPIN_BENCH_AMG_PICTURES_H
#define DUPIN_BENCH_AMG_PICTURES_H

#include <memory>
#include <vector>

#include "../../render/renderer.h"

namespace dupin::bench {

struct PictureError {
  double flip = 0;  ///< mean over the picture
  double rmse = 0;  ///< of 8-bit colors, over pixels that either covers
};

class Pictures {
 public:
  static Result<Pictures> open();

  /// Draws `content` from six directions, the model as large as the picture.
  Result<std::vector<Frame>> draw(const Model& model, const SceneContent& content, int size);
  /// Milliseconds a frame, the median of `frames`, from the isometric view, at one sample a pixel.
  Result<double> time(const Model& model, const SceneContent& content, int size, int frames);

 private:
  std::unique_ptr<Context> context_;
  std::unique_ptr<Renderer> renderer_;
};

/// Means over the pictures.
PictureError error_of(const std::vector<Frame>& reference, const std::vector<Frame>& frames);

/// OpenMesh's quadric decimation to about so many triangles.
Model decimated(const Model& model, std::size_t triangles);

}  // namespace dupin::bench

#endif
