#include "trim_region.h"

#include "../nurbs/bezier.h"

namespace dupin {
namespace {

constexpr double kNudge = 1e-9;  ///< of the box
constexpr std::size_t kMostBins = 1024;

void append_pcurve(const Trim& trim, const Edge& edge, std::vector<Vec2>& polygon) {
  std::vector<double> ends{edge.t0};
  int steps = kTrimSteps;
  if (std::holds_alternative<LineOf<Vec2>>(trim.pcurve.geometry)) {
    steps = 1;
  } else {
    for (const double t : breaks(trim.pcurve, edge.t0, edge.t1, 2)) ends.push_back(t);
  }
  ends.push_back(edge.t1);
  std::vector<Vec2> points;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    for (int k = 0; k < steps; ++k)
      points.push_back(point_at(trim.pcurve, ends[i] + (ends[i + 1] - ends[i]) * k / steps));
  points.push_back(point_at(trim.pcurve, ends.back()));
  if (trim.reversed) std::reverse(points.begin(), points.end());
  polygon.insert(polygon.end(), points.begin(), points.end());
}

/// Whether a segment meets a box (Liang and Barsky).
bool meets(Vec2 a, Vec2 b, const Box2& box) {
  double t0 = 0, t1 = 1;
  const Vec2 d = b - a;
  for (int k = 0; k < 2; ++k)
    for (const double side : {-1.0, 1.0}) {
      const double p = side * d[k], q = side > 0 ? box.hi[k] - a[k] : a[k] - box.lo[k];
      if (p == 0 && q < 0) return false;
      if (p < 0) t0 = std::max(t0, q / p);
      if (p > 0) t1 = std::min(t1, q / p);
    }
  return t0 <= t1;
}

}  // namespace

TrimRegion::TrimRegion(const Part& part, const Face& face) : box_(face.uv_box) {
  std::vector<Segment> segments;
  for (const Loop& loop : face.loops) {
    std::vector<Vec2> polygon;
    for (const Trim& trim : loop) append_pcurve(trim, part.edges[trim.edge], polygon);
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
      segments.push_back({polygon[j], polygon[i]});
  }
  whole_ = segments.empty();
  if (whole_) return;
  box_ = {};
  for (const Segment& s : segments) box_.add(s.a);
  bins_.resize(std::clamp<std::size_t>(segments.size() / 4, 1, kMostBins));
  for (const Segment& s : segments) {
    const std::size_t first = bin(std::min(s.a.y, s.b.y)), last = bin(std::max(s.a.y, s.b.y));
    for (std::size_t i = first; i <= last; ++i) bins_[i].push_back(s);
  }
}

std::size_t TrimRegion::bin(double v) const {
  const double part = (v - box_.lo.y) / std::max(box_.size().y, 1e-300);
  return static_cast<std::size_t>(std::clamp(part, 0.0, 1.0) * static_cast<double>(bins_.size() - 1));
}

Vec2 TrimRegion::nudged(Vec2 uv) const {
  const Vec2 center = box_.center();
  return uv + (center - uv) * kNudge;
}

bool TrimRegion::contains(Vec2 uv) const {
  const Vec2 p = nudged(uv);
  if (whole_) return box_.contains(p);
  bool inside = false;
  for (const auto& [a, b] : bins_[bin(p.y)]) {
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

TrimRegion::Overlap TrimRegion::overlap(const Box2& cell) const {
  // A loop along the cell's own sides does not cross it.
  const Vec2 margin = cell.size() * 1e-6;
  const Box2 inner{cell.lo + margin, cell.hi - margin};
  if (!whole_)
    for (std::size_t i = bin(inner.lo.y); i <= bin(inner.hi.y); ++i)
      for (const auto& [a, b] : bins_[i])
        if (meets(a, b, inner)) return Overlap::crossing;
  return contains(cell.center()) ? Overlap::inside : Overlap::outside;
}

std::vector<Box2> parameter_patches(const Surface& surface, const Box2& region) {
  if (const auto* offset = std::get_if<OffsetSurface>(&surface.geometry))
    return parameter_patches(*offset->base, region);
  std::vector<Box2> patches;
  for (const BezierPatch& patch : bezier_patches(surface, region)) patches.push_back(patch.domain);
  if (patches.empty()) patches.push_back(region);
  return patches;
}

}  // namespace dupin
