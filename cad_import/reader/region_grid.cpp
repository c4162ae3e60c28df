#include "region_grid.h"

#include <algorithm>
#include <cmath>

namespace dupin::reader {
namespace {

constexpr int kSamplesPerPiece = 12;

std::vector<Vec2> polyline(const Part& part, const Trim& trim) {
  const Edge& edge = part.edges[trim.edge];
  std::vector<double> stops{edge.t0};
  if (!std::holds_alternative<LineOf<Vec2>>(trim.pcurve.geometry)) {
    std::vector<double> at = breaks(trim.pcurve, edge.t0, edge.t1, 2);
    at.insert(at.begin(), edge.t0);
    at.push_back(edge.t1);
    stops.clear();
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      for (int k = 0; k < kSamplesPerPiece; ++k)
        stops.push_back(at[i] + (at[i + 1] - at[i]) * k / kSamplesPerPiece);
  }
  stops.push_back(edge.t1);
  if (trim.reversed) std::reverse(stops.begin(), stops.end());
  std::vector<Vec2> points;
  for (const double t : stops) points.push_back(point_at(trim.pcurve, t));
  return points;
}

}  // namespace

RegionGrid::RegionGrid(const Part& part, const Face& face, int cells_u, int cells_v)
    : box_(face.uv_box),
      cells_u_(cells_u),
      cells_v_(cells_v),
      touched_(static_cast<std::size_t>(cells_u) * cells_v, face.loops.empty() ? 1 : 0),
      crossings_(cells_v) {
  for (const Loop& loop : face.loops) {
    std::vector<Vec2> points;
    for (const Trim& trim : loop)
      for (const Vec2 p : polyline(part, trim)) points.push_back(p);
    for (std::size_t i = 0; i < points.size(); ++i) mark_line(points[i], points[(i + 1) % points.size()]);
  }
  fill();
}

void RegionGrid::mark_line(Vec2 a, Vec2 b) {
  const Vec2 cell{box_.size().x / cells_u_, box_.size().y / cells_v_};
  const auto place = [&](Vec2 p) { return Vec2{(p.x - box_.lo.x) / cell.x, (p.y - box_.lo.y) / cell.y}; };
  const Vec2 p = place(a), q = place(b);
  const int steps = 1 + static_cast<int>(2 * std::max(std::abs(q.x - p.x), std::abs(q.y - p.y)));
  for (int s = 0; s <= steps; ++s) {
    const Vec2 m = p + (q - p) * (static_cast<double>(s) / steps);
    const int i = std::clamp(static_cast<int>(m.x), 0, cells_u_ - 1),
              j = std::clamp(static_cast<int>(m.y), 0, cells_v_ - 1);
    touched_[static_cast<std::size_t>(j) * cells_u_ + i] = 1;
  }
  // Half-open in v, so that a point between two pieces counts once.
  const double lo = std::min(p.y, q.y), hi = std::max(p.y, q.y);
  for (int j = std::max(0, static_cast<int>(std::ceil(lo - 0.5))); j < cells_v_ && j + 0.5 < hi; ++j)
    if (j + 0.5 >= lo) crossings_[j].push_back(p.x + (q.x - p.x) * (j + 0.5 - p.y) / (q.y - p.y));
}

void RegionGrid::fill() {
  for (int j = 0; j < cells_v_; ++j) {
    std::vector<double>& row = crossings_[j];
    std::sort(row.begin(), row.end());
    for (std::size_t k = 0; k + 1 < row.size(); k += 2)
      for (int i = std::max(0, static_cast<int>(std::ceil(row[k] - 0.5)));
           i < cells_u_ && i + 0.5 < row[k + 1]; ++i)
        touched_[static_cast<std::size_t>(j) * cells_u_ + i] = 1;
  }
}

}  // namespace dupin::reader
