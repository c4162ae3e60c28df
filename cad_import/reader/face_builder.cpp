#include "face_builder.h"

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "curve_fit.h"
#include "curve_tools.h"
#include "geometry.h"
#include "loops.h"
#include "search_domain.h"

namespace dupin::reader {
namespace {

// A pcurve may leave its edge by this part of the piece's size before a better one is looked for: far below a
// pixel.
constexpr double kAgreement = 1e-6;
constexpr int kAllKnots = 100;  // no spline is as smooth
// What a fitted pcurve may add.
constexpr double kFit = 1e-8;
// A pcurve that is further off says nothing, not even on which side of a seam its edge lies.
constexpr double kWrong = 1e-3;
// Loops with larger gaps than this part of the piece's size are no loops.
constexpr double kLargestGap = 1e-3;

class FaceBuilder {
 public:
  FaceBuilder(const FaceTask& task, const Surface& surface, const std::vector<Edge>& edges, double size)
      : task_(task), surface_(surface), edges_(edges), size_(size) {}

  FaceResult run() {
    result_.face.reversed = task_.shape.Orientation() == TopAbs_REVERSED;
    result_.face.tolerance = BRep_Tool::Tolerance(task_.shape);
    for (const auto& wire : task_.wires) add_wire(wire);
    if (result_.skip) return std::move(result_);
    order_loops();
    set_box();
    return std::move(result_);
  }

 private:
  void add_wire(const std::vector<WireEdge>& wire) {
    std::vector<EdgeUse> uses;
    for (const WireEdge& e : wire) {
      std::optional<EdgeUse> use = make_use(e);
      if (use) uses.push_back(std::move(*use));
    }
    if (uses.empty()) return;
    WireLoops loops =
        assemble_loops(surface_, std::move(uses), std::max(result_.face.tolerance, kAgreement * size_));
    result_.largest_gap = std::max(result_.largest_gap, loops.gap);
    if (loops.winding) result_.repair = "its boundary runs around the surface without a seam";
    for (auto& loop : loops.loops) loops_.push_back(std::move(loop));
  }

  std::optional<EdgeUse> make_use(const WireEdge& wire_edge) {
    const Edge& edge = edges_[wire_edge.numbers.edge];
    EdgeUse use;
    use.trim.edge = wire_edge.numbers.edge;
    use.trim.reversed = wire_edge.reversed;
    use.trim.degenerate = !edge.curve;
    use.t0 = edge.t0, use.t1 = edge.t1;
    use.from = wire_edge.reversed ? wire_edge.numbers.last : wire_edge.numbers.first;
    use.to = wire_edge.reversed ? wire_edge.numbers.first : wire_edge.numbers.last;
    use.tolerance = std::max(edge.tolerance, wire_edge.numbers.vertex_tolerance);
    const bool bounded = std::isfinite(edge.t0) && std::isfinite(edge.t1) && edge.t0 < edge.t1 &&
                         std::abs(edge.t0) < 1e50 && std::abs(edge.t1) < 1e50;
    if (!bounded) return skip("an edge of it has no bounded range"), std::nullopt;

    const StoredPcurve stored = stored_pcurve(wire_edge.shape, task_.shape);
    // An edge may have pcurves on both sides of a seam and yet bound the face on one of them only.
    use.trim.seam = stored.seam && uses_of(wire_edge.numbers.edge) == 2;
    std::optional<Curve2> pcurve = matched(stored, edge);
    std::optional<Curve2> file = pcurve;
    double deviation = pcurve && edge.curve ? deviation_of(*pcurve, edge) : 0;
    use.file_wrong = !(deviation <= kWrong * size_);
    if (use.file_wrong) file.reset();
    if (edge.curve && (!pcurve || !(deviation <= kAgreement * size_)))
      refit(edge, stored.seam, pcurve, deviation);
    if (!pcurve) {
      if (!edge.curve) return std::nullopt;  // a collapsed side: the loop bridges it
      return skip("an edge's curve could not be laid onto its surface"), std::nullopt;
    }
    use.trim.pcurve = std::move(*pcurve);
    const Curve2& known = file ? *file : use.trim.pcurve;
    use.file_start = point_at(known, use.trim.reversed ? edge.t1 : edge.t0);
    use.file_end = point_at(known, use.trim.reversed ? edge.t0 : edge.t1);
    result_.deviations.emplace_back(use.trim.edge, deviation);
    if (!(deviation <= kWrong * size_)) result_.has_stray_edge = true;
    return use;
  }

  long uses_of(std::uint32_t edge) const {
    long count = 0;
    for (const auto& wire : task_.wires)
      count += std::count_if(wire.begin(), wire.end(),
                             [&](const WireEdge& other) { return other.numbers.edge == edge; });
    return count;
  }

  // The stored pcurve over the edge's own parameters.
  static std::optional<Curve2> matched(const StoredPcurve& stored, const Edge& edge) {
    if (!stored.curve) return std::nullopt;
    const double b = (stored.t1 - stored.t0) / (edge.t1 - edge.t0);
    if (std::abs(stored.t0 - edge.t0) + std::abs(stored.t1 - edge.t1) <= 1e-12 * (1 + std::abs(edge.t1)))
      return stored.curve;
    if (!(b > 0)) return std::nullopt;
    return reparametrized(*stored.curve, stored.t0 - b * edge.t0, b);
  }

  // Sampled between all knots of either curve: that is where they may part.
  double deviation_of(const Curve2& pcurve, const Edge& edge) const {
    std::vector<double> stops = breaks(*edge.curve, edge.t0, edge.t1, kAllKnots);
    const std::vector<double> more = breaks(pcurve, edge.t0, edge.t1, kAllKnots);
    stops.insert(stops.end(), more.begin(), more.end());
    stops.push_back(edge.t0), stops.push_back(edge.t1);
    std::sort(stops.begin(), stops.end());
    const int pieces = stops.size() > 8 ? 6 : 24;
    double worst = 0;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i)
      for (int k = 0; k < pieces + (i + 2 == stops.size() ? 1 : 0); ++k) {
        const double t = stops[i] + (stops[i + 1] - stops[i]) * k / pieces;
        const Vec2 q = point_at(pcurve, t);
        const double d = distance(point_at(surface_, q.x, q.y), point_at(*edge.curve, t));
        if (!(d <= worst)) worst = std::isfinite(d) ? d : std::numeric_limits<double>::infinity();
      }
    return worst;
  }

  // Replaces a missing or worse pcurve by the projection of the edge's curve.
  void refit(const Edge& edge, bool seam, std::optional<Curve2>& pcurve, double& deviation) {
    // On which side of the seam a projection falls is anyone's guess, so it must be needed badly.
    if (seam && pcurve && deviation <= kWrong * size_) return;
    std::optional<Curve2> fitted;
    if (const auto* plane = std::get_if<Plane>(&surface_.geometry))
      fitted = in_plane(*edge.curve, plane->frame);
    if (!fitted || (pcurve && !(deviation_of(*fitted, edge) < 0.5 * deviation))) {
      if (domain_.empty()) domain_ = search_domain(surface_, edges_, task_.wires);
      fitted = fit_pcurve(surface_, domain_, *edge.curve, edge.t0, edge.t1, kFit * size_);
    }
    if (!fitted) return;
    if (pcurve) {
      const double middle = (edge.t0 + edge.t1) / 2;
      translate(*fitted, whole_periods(surface_, point_at(*pcurve, middle) - point_at(*fitted, middle)));
      if (deviation <= kWrong * size_ && passes_elsewhere(*fitted, *pcurve, edge)) return;
    }
    const double reached = deviation_of(*fitted, edge);
    if (pcurve && !(reached < 0.5 * deviation)) return;
    if (pcurve) ++result_.refitted;
    pcurve = std::move(fitted), deviation = reached;
  }

  // Past a pole a projection may take the other way round than the file's curve, which then bounds another
  // region.
  bool passes_elsewhere(const Curve2& a, const Curve2& b, const Edge& edge) const {
    const Vec2 d =
        point_at(a, edge.t1) - point_at(a, edge.t0) - (point_at(b, edge.t1) - point_at(b, edge.t0));
    const double turn_u = period_u(surface_), turn_v = period_v(surface_);
    return (turn_u > 0 && std::abs(d.x) > turn_u / 2) || (turn_v > 0 && std::abs(d.y) > turn_v / 2);
  }

  void skip(const char* reason) {
    if (!result_.skip) result_.skip = reason;
  }

  // The outer loop, which encloses most, first and counter-clockwise.
  void order_loops() {
    std::vector<double> areas;
    for (const auto& loop : loops_) areas.push_back(signed_area(loop));
    if (!areas.empty()) {
      const auto less = [](double a, double b) { return std::abs(a) < std::abs(b); };
      const auto outer = std::max_element(areas.begin(), areas.end(), less) - areas.begin();
      std::swap(loops_[0], loops_[static_cast<std::size_t>(outer)]);
      std::swap(areas[0], areas[static_cast<std::size_t>(outer)]);
      if (areas[0] < 0) turn_outer_loop();
      bring_inner_loops_over();
    }
    for (auto& uses : loops_) {
      Loop loop;
      for (EdgeUse& use : uses) {
        const Box2 box = bounds(use.trim.pcurve, use.t0, use.t1);
        result_.face.uv_box.add(box.lo);
        result_.face.uv_box.add(box.hi);
        loop.push_back(std::move(use.trim));
      }
      result_.face.loops.push_back(std::move(loop));
    }
    result_.face.tolerance = std::max(result_.face.tolerance, result_.largest_gap);
    if (result_.largest_gap > kLargestGap * size_) {
      char text[80];
      std::snprintf(text, sizeof text, "its boundary does not close, by %.3g", result_.largest_gap);
      result_.repair = text;
    }
  }

  Box2 loop_box(const std::vector<EdgeUse>& loop) const {
    Box2 box;
    for (const EdgeUse& use : loop) {
      const Box2 piece = bounds(use.trim.pcurve, use.t0, use.t1);
      box.add(piece.lo);
      box.add(piece.hi);
    }
    return box;
  }

  // On a periodic surface a hole may have come out whole turns away from the outline that it is in.
  void bring_inner_loops_over() {
    if (loops_.size() < 2 || (period_u(surface_) == 0 && period_v(surface_) == 0)) return;
    const Box2 outer = loop_box(loops_[0]);
    for (std::size_t i = 1; i < loops_.size(); ++i) {
      const Vec2 center = loop_box(loops_[i]).center();
      Vec2 by = whole_periods(surface_, outer.center() - center);
      if (center.x >= outer.lo.x && center.x <= outer.hi.x) by.x = 0;
      if (center.y >= outer.lo.y && center.y <= outer.hi.y) by.y = 0;
      if (by == Vec2{}) continue;
      for (EdgeUse& use : loops_[i]) translate(use.trim.pcurve, by);
    }
  }

  // On an open surface a clockwise outer loop is a slip; on one that closes on itself it may be a hole whose
  // natural boundary was left out.
  void turn_outer_loop() {
    if (loops_.size() == 1 && period_u(surface_) == 0 && period_v(surface_) == 0) {
      std::reverse(loops_[0].begin(), loops_[0].end());
      for (EdgeUse& use : loops_[0]) use.trim.reversed = !use.trim.reversed;
    } else {
      result_.repair = "its boundary runs the wrong way round";
    }
  }

  void set_box() {
    Box2& box = result_.face.uv_box;
    if (result_.face.loops.empty()) {
      TopLoc_Location location;
      BRep_Tool::Surface(task_.shape, location)->Bounds(box.lo.x, box.hi.x, box.lo.y, box.hi.y);
      const double largest = std::max({-box.lo.x, -box.lo.y, box.hi.x, box.hi.y});
      if (!(largest < 1e50)) skip("it has no boundary, and its surface none either");
      return;
    }
    const Box2 whole = domain(surface_);
    if (period_u(surface_) == 0)
      box.lo.x = std::max(box.lo.x, whole.lo.x), box.hi.x = std::min(box.hi.x, whole.hi.x);
    if (period_v(surface_) == 0)
      box.lo.y = std::max(box.lo.y, whole.lo.y), box.hi.y = std::min(box.hi.y, whole.hi.y);
    if (!(box.lo.x < box.hi.x && box.lo.y < box.hi.y)) skip("its boundary encloses nothing");
  }

  const FaceTask& task_;
  const Surface& surface_;
  const std::vector<Edge>& edges_;
  double size_;
  Box2 domain_;
  std::vector<std::vector<EdgeUse>> loops_;
  FaceResult result_;
};

}  // namespace

FaceResult build_face(const FaceTask& task, const Surface& surface, const std::vector<Edge>& edges,
                      double size) {
  return FaceBuilder(task, surface, edges, size).run();
}

}  // namespace dupin::reader
