// What the files behind metrics.h share.
#ifndef DUPIN_RENDER_METRICS_DETAIL_H
#define DUPIN_RENDER_METRICS_DETAIL_H

#include "metrics.h"

namespace dupin {

/// R, G, B as an 8-bit screen shows them, over white, 0 … 1, pixel after pixel.
std::vector<float> screen_colors(const Image& image);
bool has_colors(const Image& image);
/// 1 for every pixel that shows something.
std::vector<std::uint8_t> coverage(const Image& image);

/// The edge of a pixel, in model units, at a depth, as the picture's file tells it or from the field of view.
double pixel_edge(const Image& a, const Image& b, double depth, const CompareOptions& options);
GeometryMetrics geometry_metrics(const Image& a, const Image& b, const CompareOptions& options);

/// The unsigned angle between two pictures' normals at a pixel, in degrees.
class NormalAngles {
 public:
  NormalAngles(const Image& a, const Image& b);
  bool available() const { return available_; }
  struct Angle {
    double degrees;
    bool opposed;
  };
  Angle at(std::size_t pixel) const;

 private:
  const std::vector<float>*a_[3] = {}, *b_[3] = {};
  bool available_ = true;
};

}  // namespace dupin

#endif
