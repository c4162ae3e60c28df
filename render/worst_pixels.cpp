// Single pixels at which two pictures differ, for a person who looks for the reason.
#include <algorithm>
#include <array>

#include "metrics_detail.h"

namespace dupin {
namespace {

using Kind = PixelDifference::Kind;

std::uint32_t number(const Image& image, std::size_t pixel) {
  const Image::Channel* ids = image.find("id");
  return ids ? static_cast<std::uint32_t>(ids->values[pixel]) : 0;
}

/// The largest of one measure, at most so many; of equal ones the first.
class Largest {
 public:
  Largest(Kind kind, double PixelDifference::*measure, std::size_t most)
      : kind_(kind), measure_(measure), most_(most) {}
  void add(PixelDifference d) {
    if (!(d.*measure_ > 0) || (kept_.size() == most_ && !(d.*measure_ > kept_.back().*measure_))) return;
    d.kind = kind_;
    const auto at = std::upper_bound(
        kept_.begin(), kept_.end(), d,
        [&](const PixelDifference& x, const PixelDifference& y) { return x.*measure_ > y.*measure_; });
    kept_.insert(at, d);
    if (kept_.size() > most_) kept_.pop_back();
  }
  const std::vector<PixelDifference>& kept() const { return kept_; }

 private:
  Kind kind_;
  double PixelDifference::*measure_;
  std::size_t most_;
  std::vector<PixelDifference> kept_;
};

}  // namespace

Result<std::vector<PixelDifference>> worst_pixels(const Image& a, const Image& b,
                                                  const CompareOptions& options, std::size_t most) {
  if (a.width != b.width || a.height != b.height || !a.find("Z") || !b.find("Z"))
    return {StatusCode::invalid_argument, "the pictures differ in size or have no depths to compare"};
  const Depths depths(a, b, options);
  const NormalAngles normals(a, b);
  std::array<std::vector<PixelDifference>, 3> first;  // holes, drawn outside, silhouette
  Largest deepest(Kind::depth, &PixelDifference::depth_px, most),
      most_turned(Kind::normal, &PixelDifference::normal_degrees, most);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const std::size_t i = depths.index(x, y);
      const bool in_a = std::isfinite(depths.depth_a(i)), in_b = std::isfinite(depths.depth_b(i));
      if (!in_a && !in_b) continue;
      PixelDifference d{Kind::silhouette, x,           y, depths.depth_a(i), depths.depth_b(i), INFINITY, 0,
                        number(a, i),     number(b, i)};
      if (in_a && in_b) {
        d.depth_px = depths.difference(i);
        d.normal_degrees = normals.available() ? normals.at(i).degrees : 0;
      }
      const bool interior = depths.interior(x, y), hole = interior && !(d.depth_px <= kHoleDepthPx);
      if (hole || in_a != in_b) {
        d.kind = hole ? Kind::hole : depths.extra(x, y) ? Kind::extra : Kind::silhouette;
        auto& list = first[static_cast<std::size_t>(d.kind)];
        if (list.size() < most) list.push_back(d);
      } else if (interior) {
        deepest.add(d);
        most_turned.add(d);
      }
    }
  std::vector<PixelDifference> all;
  for (const auto& list : {first[0], first[1], first[2], deepest.kept(), most_turned.kept()})
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace dupin
