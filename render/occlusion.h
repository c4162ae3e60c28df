// What is certainly hidden behind what has been drawn already.
#ifndef DUPIN_RENDER_OCCLUSION_H
#define DUPIN_RENDER_OCCLUSION_H

#include <cstdint>
#include <vector>

#include "splat_raster.h"

namespace dupin {

/// Pixels [x0, x1) × [y0, y1) that something may cover, and the depth buffer's value (larger is nearer) that
/// nothing of it exceeds.
struct PictureExtent {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  float nearest = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

/// For tiles of the picture the farthest that is visible in them (Greene et al. 1993, with one level).
class Occlusion {
 public:
  static constexpr int kTile = 8;

  void begin(int width, int height);
  /// Something has been drawn there since.
  void mark(const PictureExtent& drawn);
  /// Looks at the picture anew where it has been marked.
  void refresh(const SplatRaster& raster);
  /// Whether every pixel of the extent had something nearer at the last refresh. An extent beyond the picture
  /// is not hidden.
  bool hides(const PictureExtent& extent) const;

 private:
  void look(int row, int column, const SplatRaster& raster);
  int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
  std::vector<float> farthest_;  ///< of each tile; 0 while a pixel is empty
  std::vector<char> due_;        ///< its pixels have changed
};

}  // namespace dupin

#endif
