#include "metrics.h"

#include <array>
#include <cmath>
#include <limits>

#include "../core/parallel.h"
#include "metrics_detail.h"

namespace dupin {
namespace {

constexpr double kPixelsPerDegree =
    67.020643276582254;  // a 0.7 m wide screen of 3840 pixels, 0.7 m away: the paper's
constexpr int kSsimRadius = 5;
constexpr double kSsimSigma = 1.5, kSsimC1 = 0.01 * 0.01, kSsimC2 = 0.03 * 0.03;

double sum_of(const std::vector<double>& parts) {
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

/// Σ over all pixels of f(pixel), added row by row, so that it does not depend on the threads.
template <class F>
double sum_over_rows(int width, int height, F f) {
  std::vector<double> rows(static_cast<std::size_t>(height), 0.0);
  parallel_for(
      rows.size(),
      [&](std::size_t y) {
        for (int x = 0; x < width; ++x) rows[y] += f(x, static_cast<int>(y));
      },
      8);
  return sum_of(rows);
}

/// Structural similarity at one pixel of two pictures of luma, with the window cut off at the border.
class Ssim {
 public:
  Ssim(const std::vector<float>& a, const std::vector<float>& b, int width, int height)
      : a_(a), b_(b), width_(width), height_(height) {
    for (int i = -kSsimRadius; i <= kSsimRadius; ++i)
      weights_.push_back(std::exp(-i * i / (2 * kSsimSigma * kSsimSigma)));
  }
  double operator()(int x, int y) const {
    double w = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (int j = std::max(-kSsimRadius, -y); j <= std::min(kSsimRadius, height_ - 1 - y); ++j)
      for (int i = std::max(-kSsimRadius, -x); i <= std::min(kSsimRadius, width_ - 1 - x); ++i) {
        const auto at = static_cast<std::size_t>(y + j) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x + i);
        const double k = weights_[static_cast<std::size_t>(i + kSsimRadius)] *
                         weights_[static_cast<std::size_t>(j + kSsimRadius)];
        const double va = a_[at], vb = b_[at];
        w += k;
        ma += k * va;
        mb += k * vb;
        aa += k * va * va;
        bb += k * vb * vb;
        ab += k * va * vb;
      }
    ma /= w;
    mb /= w;
    const double sa = aa / w - ma * ma, sb = bb / w - mb * mb, sab = ab / w - ma * mb;
    return (2 * ma * mb + kSsimC1) * (2 * sab + kSsimC2) /
           ((ma * ma + mb * mb + kSsimC1) * (sa + sb + kSsimC2));
  }

 private:
  const std::vector<float>&a_, &b_;
  int width_, height_;
  std::vector<double> weights_;
};

std::vector<float> luma(const std::vector<float>& srgb) {
  std::vector<float> y(srgb.size() / 3);
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] = 0.2126F * srgb[3 * i] + 0.7152F * srgb[3 * i + 1] + 0.0722F * srgb[3 * i + 2];
  return y;
}

ColorMetrics color_metrics(const Image& a, const Image& b, const std::vector<std::uint8_t>& in_a,
                           const std::vector<std::uint8_t>& in_b) {
  const std::vector<float> ca = screen_colors(a), cb = screen_colors(b);
  const double pixels = static_cast<double>(a.pixels());
  const auto square = [&](std::size_t pixel) {
    double sum = 0;
    for (std::size_t k = 3 * pixel; k < 3 * pixel + 3; ++k)
      sum += (ca[k] - cb[k]) * (ca[k] - cb[k]) * 255.0 * 255.0;
    return sum;
  };
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x);
  };
  const double squares = sum_over_rows(a.width, a.height, [&](int x, int y) { return square(index(x, y)); });
  double covered = 0, covered_squares = 0;
  for (std::size_t i = 0; i < in_a.size(); ++i)
    if (in_a[i] || in_b[i]) covered += 1, covered_squares += square(i);
  ColorMetrics m;
  m.rmse = std::sqrt(squares / (3 * pixels));
  m.rmse_covered = covered > 0 ? std::sqrt(covered_squares / (3 * covered)) : 0;
  m.psnr = m.rmse > 0 ? 20 * std::log10(255 / m.rmse) : std::numeric_limits<double>::infinity();
  const std::vector<float> ya = luma(ca), yb = luma(cb);
  m.ssim = sum_over_rows(a.width, a.height, Ssim(ya, yb, a.width, a.height)) / pixels;
  double error = 0;
  for (const float e : flip_error(ca, cb, a.width, a.height, kPixelsPerDegree)) error += e;
  m.flip = error / pixels;
  return m;
}

}  // namespace

std::vector<float> screen_colors(const Image& image) {
  Image over = image;
  if (const Image::Channel* alpha = over.find("A")) {
    const std::vector<float> a = alpha->values;
    for (const char* name : {"R", "G", "B"}) {
      std::vector<float>& c = over.channel(name).values;
      for (std::size_t i = 0; i < c.size(); ++i) c[i] += 1 - std::clamp(a[i], 0.0F, 1.0F);
    }
    std::fill(over.channel("A").values.begin(), over.channel("A").values.end(), 1.0F);
  }
  const Image8 bytes = to_image8(over);
  std::vector<float> values(bytes.values.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(bytes.values[i]) / 255.0F;
  return values;
}

bool has_colors(const Image& image) {
  return image.find("R") && image.find("G") && image.find("B");
}

std::vector<std::uint8_t> coverage(const Image& image) {
  std::vector<std::uint8_t> covered(image.pixels(), 0);
  if (const Image::Channel* z = image.find("Z")) {
    for (std::size_t i = 0; i < covered.size(); ++i) covered[i] = std::isfinite(z->values[i]);
    return covered;
  }
  if (const Image::Channel* a = image.find("A")) {
    const auto [least, most] = std::minmax_element(a->values.begin(), a->values.end());
    if (*least < 0.5F && *most >= 0.5F) {
      for (std::size_t i = 0; i < covered.size(); ++i) covered[i] = a->values[i] >= 0.5F;
      return covered;
    }
  }
  if (!has_colors(image)) return covered;
  const std::vector<float> colors = screen_colors(image);
  for (std::size_t i = 0; i < covered.size(); ++i)
    covered[i] =
        !std::equal(colors.begin(), colors.begin() + 3, colors.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return covered;
}

Distribution distribution(std::vector<float>& values) {
  Distribution d;
  d.count = values.size();
  if (values.empty()) return d;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return static_cast<double>(values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1]);
  };
  double sum = 0;
  for (const float v : values) sum += v;
  d.mean = sum / static_cast<double>(values.size());
  d.p50 = at(0.5);
  d.p90 = at(0.9);
  d.p99 = at(0.99);
  d.p999 = at(0.999);
  d.max = values.back();
  return d;
}

Result<PictureDifference> compare(const Image& a, const Image& b, const CompareOptions& options) {
  if (a.width != b.width || a.height != b.height)
    return {StatusCode::invalid_argument, "the pictures' sizes differ: " + std::to_string(a.width) + "x" +
                                              std::to_string(a.height) + " and " + std::to_string(b.width) +
                                              "x" + std::to_string(b.height)};
  const bool colors = has_colors(a) && has_colors(b), depths = a.find("Z") && b.find("Z");
  if (a.pixels() == 0 || (!colors && !depths))
    return {StatusCode::invalid_argument, "the pictures have neither colors nor depths in common"};
  PictureDifference result;
  result.width = a.width;
  result.height = a.height;
  const std::vector<std::uint8_t> in_a = coverage(a), in_b = coverage(b);
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    result.covered_a += in_a[i];
    result.covered_b += in_b[i];
    result.silhouette += in_a[i] != in_b[i];
  }
  result.outline_px = outline_distances(in_a, in_b, a.width, a.height);
  if (colors) result.color = color_metrics(a, b, in_a, in_b);
  if (depths) result.geometry = geometry_metrics(a, b, options);
  return result;
}

}  // namespace dupin
