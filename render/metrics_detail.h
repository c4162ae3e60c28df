// What the files behind metrics.h share.
#ifndef DUPIN_RENDER_METRICS_DETAIL_H
#define DUPIN_RENDER_METRICS_DETAIL_H

#include <cmath>

#include "metrics.h"

namespace dupin {

/// R, G, B as an 8-bit screen shows them, over white, 0 … 1, pixel after pixel.
std::vector<float> screen_colors(const Image& image);
bool has_colors(const Image& image);
/// 1 for every pixel that shows something.
std::vector<std::uint8_t> coverage(const Image& image);

/// PictureDifference::outline_px
Distribution outline_distances(const std::vector<std::uint8_t>& covered_a,
                               const std::vector<std::uint8_t>& covered_b, int width, int height);

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

/// Two pictures' depths, and what their differences mean.
class Depths {
 public:
  Depths(const Image& a, const Image& b, const CompareOptions& options);
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(a_.width) + static_cast<std::size_t>(x);
  }
  /// Of a pixel, in model units.
  double edge(std::size_t i) const { return pixel_edge(a_, b_, za_[i], options_); }
  bool interior(int x, int y) const;
  bool extra(int x, int y) const;
  /// In edges of a pixel; infinite where B has nothing.
  double difference(std::size_t i) const { return std::abs(static_cast<double>(zb_[i]) - za_[i]) / edge(i); }
  double depth_a(std::size_t i) const { return za_[i]; }
  double depth_b(std::size_t i) const { return zb_[i]; }

 private:
  const Image &a_, &b_;
  const CompareOptions& options_;
  const std::vector<float>&za_, &zb_;
};

}  // namespace dupin

#endif
