// ꟻLIP: A Difference Evaluator for Alternating Images. P. Andersson, J. Nilsson, T. Akenine-Möller, M.
// Oskarsson, K. Åström, M. D. Fairchild. Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. The symbols are
// the paper's.
#include <array>
#include <cmath>

#include "../core/parallel.h"
#include "metrics.h"

namespace dupin {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kQc = 0.7, kPc = 0.4, kPt = 0.95, kQf = 0.5, kFeatureWidthDegrees = 0.082;

using Color3 = std::array<double, 3>;

double to_linear(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// Linear sRGB to XYZ, each divided by the white's.
Color3 to_xyz(const Color3& c) {
  constexpr double m[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                              {0.2126729, 0.7151522, 0.0721750},
                              {0.0193339, 0.1191920, 0.9503041}};
  Color3 xyz{};
  for (std::size_t i = 0; i < 3; ++i)
    xyz[i] = (m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2]) / (m[i][0] + m[i][1] + m[i][2]);
  return xyz;
}
/// The inverse matrix, on XYZ divided by the white's.
Color3 to_rgb(const Color3& normalized) {
  constexpr double white[3] = {0.95047, 1.0000001, 1.08883};
  constexpr double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                              {-0.9692660, 1.8760108, 0.0415560},
                              {0.0556434, -0.2040259, 1.0572252}};
  Color3 rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = m[i][0] * normalized[0] * white[0] + m[i][1] * normalized[1] * white[1] +
             m[i][2] * normalized[2] * white[2];
  return rgb;
}

Color3 to_ycxcz(const Color3& xyz) {
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}
Color3 from_ycxcz(const Color3& c) {
  const double y = (c[0] + 16) / 116;
  return {y + c[1] / 500, y, y - c[2] / 200};
}

/// CIELAB with the Hunt effect: colors matter less where it is dark.
Color3 to_hunt_lab(const Color3& linear) {
  const Color3 xyz = to_xyz(linear);
  const auto f = [](double t) {
    constexpr double d = 6.0 / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
  };
  const double l = 116 * f(xyz[1]) - 16;
  return {l, 0.01 * l * 500 * (f(xyz[0]) - f(xyz[1])), 0.01 * l * 200 * (f(xyz[1]) - f(xyz[2]))};
}

double hyab(const Color3& a, const Color3& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

struct Grid {
  int width, height;
  std::vector<float> values;
  Grid(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float at(int x, int y) const {
    return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
  }
};

/// Convolution with kx(x)·ky(y), both of 2r + 1 values; the border's pixels go on outside.
Grid convolve(const Grid& in, const std::vector<double>& kx, const std::vector<double>& ky) {
  const int r = static_cast<int>(kx.size() / 2);
  Grid across(in.width, in.height), out(in.width, in.height);
  const auto rows = [&](const Grid& from, Grid& to, const std::vector<double>& k, int dx, int dy) {
    parallel_for(
        static_cast<std::size_t>(in.height),
        [&](std::size_t row) {
          const int y = static_cast<int>(row);
          for (int x = 0; x < in.width; ++x) {
            double sum = 0;
            for (int i = -r; i <= r; ++i)
              sum += k[static_cast<std::size_t>(i + r)] * from.at(x + i * dx, y + i * dy);
            to.values[row * static_cast<std::size_t>(in.width) + static_cast<std::size_t>(x)] =
                static_cast<float>(sum);
          }
        },
        8);
  };
  rows(in, across, kx, 1, 0);
  rows(across, out, ky, 0, 1);
  return out;
}

std::vector<double> sampled(int radius, double (*f)(double x, double s), double s) {
  std::vector<double> k;
  for (int i = -radius; i <= radius; ++i) k.push_back(f(i, s));
  return k;
}
double gauss(double x, double sigma) {
  return std::exp(-x * x / (2 * sigma * sigma));
}

/// One contrast sensitivity function: Σ aᵢ √(π/bᵢ) exp(−π² z²/bᵢ) in degrees z, scaled to sum 1 over its
/// window.
Grid filtered(const Grid& in, std::initializer_list<std::array<double, 2>> terms, int radius,
              double pixels_per_degree) {
  Grid out(in.width, in.height);
  double total = 0;
  for (const auto& [a, b] : terms) {
    const double sigma = std::sqrt(b / (2 * kPi * kPi)) * pixels_per_degree;
    const std::vector<double> k = sampled(radius, gauss, sigma);
    double sum = 0;
    for (const double v : k) sum += v;
    const double scale = a * std::sqrt(kPi / b);
    total += scale * sum * sum;
    const Grid part = convolve(in, k, k);
    for (std::size_t i = 0; i < out.values.size(); ++i)
      out.values[i] += static_cast<float>(scale * part.values[i]);
  }
  for (float& v : out.values) v = static_cast<float>(v / total);
  return out;
}

struct Prepared {
  std::array<Grid, 3> seen;  ///< Hunt-adjusted CIELAB after the eye's filters
  Grid luma;                 ///< achromatic, 0 … 1, unfiltered
};

Prepared prepare(const std::vector<float>& srgb, int width, int height, double ppd) {
  std::array<Grid, 3> opponent{Grid(width, height), Grid(width, height), Grid(width, height)};
  Grid luma(width, height);
  parallel_for(
      luma.values.size(),
      [&](std::size_t i) {
        const Color3 linear{to_linear(srgb[3 * i]), to_linear(srgb[3 * i + 1]), to_linear(srgb[3 * i + 2])};
        const Color3 c = to_ycxcz(to_xyz(linear));
        for (std::size_t k = 0; k < 3; ++k) opponent[k].values[i] = static_cast<float>(c[k]);
        luma.values[i] = static_cast<float>((c[0] + 16) / 116);
      },
      4096);
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd));
  std::array<Grid, 3> seen{filtered(opponent[0], {{1, 0.0047}}, radius, ppd),
                           filtered(opponent[1], {{1, 0.0053}}, radius, ppd),
                           filtered(opponent[2], {{34.1, 0.04}, {13.5, 0.025}}, radius, ppd)};
  parallel_for(
      luma.values.size(),
      [&](std::size_t i) {
        Color3 rgb = to_rgb(from_ycxcz({seen[0].values[i], seen[1].values[i], seen[2].values[i]}));
        for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
        const Color3 lab = to_hunt_lab(rgb);
        for (std::size_t k = 0; k < 3; ++k) seen[k].values[i] = static_cast<float>(lab[k]);
      },
      4096);
  return {std::move(seen), std::move(luma)};
}

/// Scales the negative values to the sum −1 and the positive ones to 1.
void balance(std::vector<double>& k) {
  double positive = 0, negative = 0;
  for (const double v : k) (v > 0 ? positive : negative) += v;
  for (double& v : k) v /= v > 0 ? positive : -negative;
}

/// Length of the response to a detector along x and along y: edges by the first derivative of a Gaussian,
/// points by the second.
Grid features(const Grid& luma, bool edges, double ppd) {
  const double sigma = 0.5 * kFeatureWidthDegrees * ppd;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  std::vector<double> smooth = sampled(radius, gauss, sigma);
  double sum = 0;
  for (const double v : smooth) sum += v;
  for (double& v : smooth) v /= sum;
  std::vector<double> detect = sampled(radius, gauss, sigma);
  for (int i = -radius; i <= radius; ++i)
    detect[static_cast<std::size_t>(i + radius)] *= edges ? -i : i * i / (sigma * sigma) - 1;
  balance(detect);
  const Grid x = convolve(luma, detect, smooth), y = convolve(luma, smooth, detect);
  Grid out(luma.width, luma.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = std::hypot(x.values[i], y.values[i]);
  return out;
}

double largest_color_error() {
  return std::pow(hyab(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1})), kQc);
}

double color_error(const Prepared& a, const Prepared& b, std::size_t i, double largest) {
  const auto at = [i](const Prepared& p) {
    return Color3{p.seen[0].values[i], p.seen[1].values[i], p.seen[2].values[i]};
  };
  const double e = std::pow(hyab(at(a), at(b)), kQc), bend = kPc * largest;
  return e < bend ? kPt * e / bend : kPt + (e - bend) / (largest - bend) * (1 - kPt);
}

}  // namespace

std::vector<float> flip_error(const std::vector<float>& reference, const std::vector<float>& test, int width,
                              int height, double ppd) {
  const Prepared a = prepare(reference, width, height, ppd), b = prepare(test, width, height, ppd);
  const Grid edges_a = features(a.luma, true, ppd), edges_b = features(b.luma, true, ppd);
  const Grid points_a = features(a.luma, false, ppd), points_b = features(b.luma, false, ppd);
  const double largest = largest_color_error();
  std::vector<float> error(a.luma.values.size());
  parallel_for(
      error.size(),
      [&](std::size_t i) {
        const double feature = std::max(std::abs(edges_a.values[i] - edges_b.values[i]),
                                        std::abs(points_a.values[i] - points_b.values[i]));
        const double feature_error = std::pow(std::min(1.0, feature / std::sqrt(2.0)), kQf);
        error[i] = static_cast<float>(std::pow(color_error(a, b, i, largest), 1 - feature_error));
      },
      4096);
  return error;
}

}  // namespace dupin
