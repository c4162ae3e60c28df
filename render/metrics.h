// How much two pictures of one size differ: as a viewer sees them, and as measurements of geometry.
#ifndef DUPIN_RENDER_METRICS_H
#define DUPIN_RENDER_METRICS_H

#include <cstdint>
#include <optional>

#include "image.h"

namespace dupin {

/// Colors as a screen shows them (8-bit sRGB, over white where they are transparent).
struct ColorMetrics {
  double rmse = 0;          ///< over all pixels and R, G, B, in steps of 8 bits (0 … 255)
  double rmse_covered = 0;  ///< the same over the pixels that either picture covers; 0 where neither does
  double psnr = 0;          ///< decibel; +inf for equal pictures
  double ssim =
      1;  ///< mean structural similarity of luma (Wang et al. 2004: Gaussian window, σ = 1.5, 11 × 11)
  double flip = 0;  ///< mean ꟻLIP of Andersson et al. 2020, 0 … 1, at 67 pixels a degree
};

struct Distribution {
  std::uint64_t count = 0;
  double mean = 0, p50 = 0, p90 = 0, p99 = 0, p999 = 0, max = 0;
};
/// Percentiles are the smallest value that at least that share of the values does not exceed. Reorders the
/// values.
Distribution distribution(std::vector<float>& values);

/// Interior pixels of A: A covers them and every pixel within kInteriorRadius, with depths that differ from
/// the centre's by at most kContinuousDepthPx pixels.
inline constexpr int kInteriorRadius = 2;
inline constexpr double kContinuousDepthPx = 12;
/// A hole: an interior pixel at which B has nothing, or a surface nearer or farther by more than this, in
/// pixels: seen through, or stopped up.
inline constexpr double kHoleDepthPx = 8;

struct GeometryMetrics {
  std::uint64_t interior = 0, holes = 0;
  std::uint64_t extra = 0;            ///< covered by B, with nothing of A within kInteriorRadius pixels
  std::uint64_t opposed_normals = 0;  ///< interior pixels whose normals point to opposite sides
  Distribution depth_px;  ///< |difference| in edges of a pixel there, over interior pixels that B covers
  Distribution
      normal_degrees;  ///< unsigned angle, over the same pixels; empty where a picture has no normals
};

struct PictureDifference {
  int width = 0, height = 0;
  std::uint64_t covered_a = 0, covered_b = 0;
  std::uint64_t silhouette = 0;  ///< pixels that only one of the two covers
  /// From every outline pixel of each (covered, beside one that is not) to the nearest of the other's, in
  /// pixels: its largest is the Hausdorff distance. Infinite where only one has an outline.
  Distribution outline_px;
  std::optional<ColorMetrics> color;        ///< where both have R, G, B
  std::optional<GeometryMetrics> geometry;  ///< where both have Z
};

struct CompareOptions {
  /// Vertical field of view, for the size of a pixel where neither picture tells it.
  double fov_degrees = 30;
};

/// A is the reference. What a pixel covers is told by Z (finite), else by A (at least ½) where it varies,
/// else by the color's not being that of the top left corner. invalid_argument if the sizes differ, or the
/// pictures have no channels in common to compare.
Result<PictureDifference> compare(const Image& a, const Image& b, const CompareOptions& options);

/// A pixel at which two pictures differ, with what each has there.
struct PixelDifference {
  enum class Kind { hole, extra, silhouette, depth, normal };
  Kind kind = Kind::hole;
  int x = 0, y = 0;
  double depth_a = 0, depth_b = 0;  ///< infinite: nothing is drawn
  double depth_px = 0;              ///< their difference in edges of a pixel; infinite where one has nothing
  double normal_degrees = 0;        ///< unsigned; 0 where there are none to compare
  std::uint32_t face_a = 0, face_b = 0;  ///< of the "id" channels; 0: none
};
inline constexpr const char* kDifferenceNames[] = {"hole", "extra", "silhouette", "depth", "normal"};

/// The first `most` holes, the first `most` pixels drawn outside, the first `most` others that only one
/// covers, by rows; then the `most` interior pixels, no holes, with the largest difference in depth, and
/// those with the largest in normal. invalid_argument where the sizes differ or a picture has no Z.
Result<std::vector<PixelDifference>> worst_pixels(const Image& a, const Image& b,
                                                  const CompareOptions& options, std::size_t most);

/// Where two pictures differ: the ꟻLIP error (or, without colors, the depth and normal differences, 1 for 2
/// pixels or 2 degrees) from black over red and yellow to white; what only A covers in blue, only B in green.
Result<Image8> difference_picture(const Image& a, const Image& b, const CompareOptions& options);

/// ꟻLIP for low dynamic range of every pixel, from sRGB-encoded R, G, B in 0 … 1, pixel after pixel.
std::vector<float> flip_error(const std::vector<float>& reference, const std::vector<float>& test, int width,
                              int height, double pixels_per_degree);

}  // namespace dupin

#endif
