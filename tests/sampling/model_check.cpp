#include "model_check.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "../../core/parallel.h"
#include "../../nurbs/invert.h"

namespace dupin::test {
namespace {

/// A face's trims, finely flattened: in parameters and in space.
struct Outline {
  std::vector<std::vector<Vec2>> uv;
  std::vector<Vec3> points;  ///< consecutive pairs are segments
};

bool is_seam(const Face& face, const Trim& trim) {
  int uses = 0;
  for (const Loop& loop : face.loops)
    for (const Trim& other : loop) uses += other.edge == trim.edge;
  return trim.seam && uses > 1;
}

Outline outline_of(const Part& part, const Face& face) {
  constexpr int kSides = 256;
  Outline outline;
  for (const Loop& loop : face.loops) {
    std::vector<Vec2> polygon;
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      for (int i = 0; i < kSides; ++i) {
        const double f0 = static_cast<double>(i) / kSides, f1 = static_cast<double>(i + 1) / kSides;
        const double a =
            trim.reversed ? edge.t1 + (edge.t0 - edge.t1) * f0 : edge.t0 + (edge.t1 - edge.t0) * f0;
        const double b =
            trim.reversed ? edge.t1 + (edge.t0 - edge.t1) * f1 : edge.t0 + (edge.t1 - edge.t0) * f1;
        polygon.push_back(point_at(trim.pcurve, a));
        if (!edge.curve || is_seam(face, trim)) continue;
        outline.points.push_back(point_at(*edge.curve, a));
        outline.points.push_back(point_at(*edge.curve, b));
      }
    }
    outline.uv.push_back(std::move(polygon));
  }
  return outline;
}

bool inside_polygons(const Outline& outline, Vec2 p) {
  bool inside = outline.uv.empty();
  for (const auto& polygon : outline.uv)
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
      if ((polygon[i].y > p.y) != (polygon[j].y > p.y) &&
          p.x < polygon[j].x +
                    (polygon[i].x - polygon[j].x) * (p.y - polygon[j].y) / (polygon[i].y - polygon[j].y))
        inside = !inside;
  return inside;
}

double distance_to_outline(const Outline& outline, const Vec3& p) {
  double least = 1e300;
  for (std::size_t i = 0; i + 1 < outline.points.size(); i += 2) {
    const Vec3 a = outline.points[i], d = outline.points[i + 1] - a;
    const double dd = dot(d, d), s = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0;
    const Vec3 e = p - a - d * s;
    least = std::min(least, dot(e, e));
  }
  return std::sqrt(least);
}

/// The quadric's height above (x,y) on its origin's sheet, nearest to z.
double sheet_height(const QuadricDp& dp, Vec2 p, double z) {
  for (int i = 0; i < 50; ++i) {
    const double g = quadric_gradient(dp, {p.x, p.y, z}).z;
    if (std::abs(g) < 1e-9) break;
    const double step = quadric_value(dp, {p.x, p.y, z}) / g;
    z -= step;
    if (std::abs(step) < 1e-15 * (1 + std::abs(z))) break;
  }
  return z;
}

Vec3 local(const QuadricDp& dp, const Vec3& p) {
  const Vec3 d = p - dp.origin;
  return {dot(d, dp.u), dot(d, dp.v), dot(d, dp.n())};
}

bool covered(const PartDps& dps, const std::vector<std::uint32_t>& mine, const Vec3& p, double slack) {
  for (std::uint32_t i : mine) {
    const QuadricDp& dp = dps.dps[i];
    Vec3 l = local(dp, p);
    const double z = sheet_height(dp, {l.x, l.y}, l.z);
    if (std::abs(z - l.z) > 2 * dp.bound + slack) continue;
    l.z = z;
    if (region_contains(dps, dp, l)) return true;
  }
  return false;
}

/// Damped Gauss–Newton for the nearest point; false where it stalls away from one.
bool nearest(const Surface& surface, const Vec3& p, Vec2& uv, const Box2& limits) {
  double lambda = 1e-12;
  SurfaceJet jet = evaluate(surface, uv.x, uv.y, 1);
  double best = dot(p - jet.p, p - jet.p);
  for (int i = 0; i < 60; ++i) {
    const Vec3 r = p - jet.p;
    const double a = dot(jet.pu, jet.pu), b = dot(jet.pu, jet.pv), c = dot(jet.pv, jet.pv),
                 x = dot(r, jet.pu), y = dot(r, jet.pv);
    const double A = a * (1 + lambda), C = c * (1 + lambda), det = A * C - b * b;
    if (!(std::abs(det) > 0)) return false;
    Vec2 next = uv + Vec2{(x * C - y * b) / det, (A * y - b * x) / det};
    next.x = std::clamp(next.x, limits.lo.x, limits.hi.x),
    next.y = std::clamp(next.y, limits.lo.y, limits.hi.y);
    const SurfaceJet trial = evaluate(surface, next.x, next.y, 1);
    const double d = dot(p - trial.p, p - trial.p);
    if (d <= best) {
      const bool done = length(trial.p - jet.p) <= 1e-13 * (1 + length(jet.p));
      uv = next, jet = trial, best = d, lambda = std::max(1e-12, lambda / 10);
      if (done) return true;
    } else {
      lambda *= 10;
      if (lambda > 1e6) return true;
    }
  }
  return true;
}

Box2 grown(const Box2& box, double by) {
  const Vec2 m = box.size() * by;
  return {box.lo - m, box.hi + m};
}

/// A closed surface's parameters from seam to seam, whether it is periodic or only closed; 0 where it is
/// open.
Vec2 closure(const Surface& surface) {
  Vec2 length{period_u(surface), period_v(surface)};
  const Box2 box = domain(surface);
  const Vec2 size = box.size();
  if (!std::isfinite(size.x) || !std::isfinite(size.y)) return length;
  const double tiny = 1e-7 * distance(point_at(surface, box.lo.x, box.lo.y),
                                      point_at(surface, box.center().x, box.center().y));
  double apart_u = 0, apart_v = 0;
  for (double f : {0.1, 0.4, 0.8}) {
    const Vec2 at = box.lo + size * f;
    apart_u =
        std::max(apart_u, distance(point_at(surface, box.lo.x, at.y), point_at(surface, box.hi.x, at.y)));
    apart_v =
        std::max(apart_v, distance(point_at(surface, at.x, box.lo.y), point_at(surface, at.x, box.hi.y)));
  }
  if (apart_u <= tiny) length.x = size.x;
  if (apart_v <= tiny) length.y = size.y;
  return length;
}

/// Across a seam the face goes on at the parameters' other end.
void cross_seam(const Surface& surface, const Outline& outline, const Vec3& p, const Vec2& closed,
                const Box2& cell, Vec2& uv) {
  if (inside_polygons(outline, uv)) return;
  double least = distance(point_at(surface, uv.x, uv.y), p);
  const Vec2 from = uv;
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b) {
      const Vec2 by{a * closed.x, b * closed.y};
      if (by.x == 0 && by.y == 0) continue;
      Vec2 q = from + by;
      const Box2 limits = grown({cell.lo + by, cell.hi + by}, 1.0);
      if (!nearest(surface, p, q, limits) || !inside_polygons(outline, q)) continue;
      if (const double d = distance(point_at(surface, q.x, q.y), p); d < least) least = d, uv = q;
    }
}

/// Points of the face: all of them must be in some region.
void check_coverage(const Part& part, const PartDps& dps, const Outline& outline,
                    const std::vector<std::uint32_t>& mine, const CheckOptions& options, FaceReport& report) {
  const Face& face = part.faces[report.face];
  const Surface& surface = part.surfaces[face.surface];
  std::mt19937 rng(report.face + 1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int tries = 0; tries < 6 * options.points_per_face && report.points < options.points_per_face;
       ++tries) {
    const Vec2 uv{face.uv_box.lo.x + face.uv_box.size().x * unit(rng),
                  face.uv_box.lo.y + face.uv_box.size().y * unit(rng)};
    if (!inside_polygons(outline, uv)) continue;
    const Vec3 p = point_at(surface, uv.x, uv.y);
    if (distance_to_outline(outline, p) <= options.margin) continue;
    ++report.points;
    report.uncovered += !covered(dps, mine, p, 1e-7 * part.box.diagonal());
  }
}

/// Points drawn: all of them must be on the face, no farther off than their DP's bounds say.
void check_bounds(const Part& part, const PartDps& dps, const Outline& outline,
                  const std::vector<std::uint32_t>& mine, const CheckOptions& options, FaceReport& report) {
  const Face& face = part.faces[report.face];
  const Surface& surface = part.surfaces[face.surface];
  const double rounding = 1e-9 * part.box.diagonal();
  const Vec2 closed = closure(surface);
  double edge_reach = 0;
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) edge_reach = std::max(edge_reach, 8 * part.edges[trim.edge].tolerance);
  const std::size_t stride =
      std::max<std::size_t>(1, mine.size() / static_cast<std::size_t>(options.most_dps_per_face));
  for (std::size_t m = 0; m < mine.size(); m += stride) {
    const QuadricDp& dp = dps.dps[mine[m]];
    for (int i = 0; i < options.points_per_dp; ++i)
      for (int j = 0; j < options.points_per_dp; ++j) {
        const double s = (i + 0.5) / options.points_per_dp, t = (j + 0.5) / options.points_per_dp;
        const auto& f = dp.footprint;
        const Vec2 xy =
            f[0] * ((1 - s) * (1 - t)) + f[1] * (s * (1 - t)) + f[2] * (s * t) + f[3] * ((1 - s) * t);
        const Vec3 l{xy.x, xy.y, sheet_height(dp, xy, 0)};
        if (!std::isfinite(l.z) || std::abs(quadric_value(dp, l)) > rounding || !region_contains(dps, dp, l))
          continue;
        ++report.drawn;
        const Vec3 p = dp.origin + dp.u * l.x + dp.v * l.y + dp.n() * l.z;
        Vec2 uv = dp.cell.lo + Vec2{dp.cell.size().x * s, dp.cell.size().y * t};
        if (dp.exact) uv = dp.cell.center();
        Vec2 best = uv;
        double least = 1e300;
        for (int a = 0; a < 5; ++a)
          for (int b = 0; b < 5; ++b) {
            const Vec2 q =
                dp.cell.lo + Vec2{dp.cell.size().x * (a + 0.5) / 5, dp.cell.size().y * (b + 0.5) / 5};
            const double d = distance(point_at(surface, q.x, q.y), p);
            if (d < least) least = d, best = q;
          }
        uv = best;
        // Closed forms where there are some: descent may run over a sphere's pole, into parameters that name
        // the same points.
        if (is_quadric(surface))
          uv = *invert(surface, p, dp.cell.center());
        else if (!nearest(surface, p, uv, grown(dp.cell, 1.0))) {
          ++report.unresolved;
          continue;
        }
        if (!is_quadric(surface)) cross_seam(surface, outline, p, closed, dp.cell, uv);
        // A recognised spline's certificate is nurbs' own (recognize_test): here the quadric is held against
        // what was recognised.
        const bool recognized = face.recognized && is_quadric(face.recognized->surface);
        const Surface& drawn_surface = recognized ? face.recognized->surface : surface;
        const auto there =
            recognized ? invert(drawn_surface, p, {3.14159265358979, 0}) : std::optional<Vec2>(uv);
        const SurfaceJet jet = evaluate(drawn_surface, there->x, there->y, 1);
        // At its border a face may reach over what the file's own edges are off (QuadricDp::bound).
        const bool beyond = !inside_polygons(outline, uv);
        const double reach = beyond ? edge_reach : 0;
        // The nearest point may be one of an edge, where descent in the parameters gets stuck at the domain's
        // end.
        const double off =
            beyond ? std::min(distance(p, jet.p), distance_to_outline(outline, p)) : distance(p, jet.p);
        report.worst_position =
            std::max(report.worst_position, (off - rounding - reach) / (dp.bound + rounding));
        const Vec3 n = normalized(cross(jet.pu, jet.pv)) * (face.reversed ? -1.0 : 1.0);
        const Vec3 g = drawn_normal(dp, l);
        const Vec3 drawn = normalized(dp.u * g.x + dp.v * g.y + dp.n() * g.z) * (dp.flipped ? -1.0 : 1.0);
        if (!dp.speck && !beyond && length(n) > 0.5) {
          const double angle = std::atan2(length(cross(n, drawn)), dot(n, drawn));
          report.worst_normal = std::max(report.worst_normal, angle / (dp.normal_bound + 1e-6));
        }
        if (!inside_polygons(outline, uv) && distance_to_outline(outline, p) > options.margin + edge_reach) {
          // A period away it may be inside.
          const double pu = closed.x, pv = closed.y;
          bool elsewhere = false;
          for (int a = -1; a <= 1; ++a)
            for (int b = -1; b <= 1; ++b) elsewhere |= inside_polygons(outline, uv + Vec2{a * pu, b * pv});
          report.outside += !elsewhere;
        }
      }
  }
}

}  // namespace

std::vector<FaceReport> check_scene(const Model& model, const DpScene& scene, const CheckOptions& options) {
  std::vector<FaceReport> reports;
  for (std::uint32_t p = 0; p < model.parts.size(); ++p) {
    const Part& part = model.parts[p];
    std::vector<std::vector<std::uint32_t>> mine(part.faces.size());
    for (std::uint32_t i = 0; i < scene.parts[p].dps.size(); ++i)
      mine[scene.parts[p].dps[i].face].push_back(i);
    const std::size_t first = reports.size();
    reports.resize(first + part.faces.size());
    parallel_for(part.faces.size(), [&](std::size_t f) {
      FaceReport& report = reports[first + f];
      report.part = p, report.face = static_cast<std::uint32_t>(f);
      report.kind = kind_name(part.surfaces[part.faces[f].surface]);
      report.dps = static_cast<int>(mine[f].size());
      const Outline outline = outline_of(part, part.faces[f]);
      // Nearer to an edge than it is wrong by its own account nothing can be said.
      CheckOptions mine_options = options;
      for (const Loop& loop : part.faces[f].loops)
        for (const Trim& trim : loop)
          mine_options.margin =
              std::max(mine_options.margin, options.margin + part.edges[trim.edge].tolerance);
      check_coverage(part, scene.parts[p], outline, mine[f], mine_options, report);
      check_bounds(part, scene.parts[p], outline, mine[f], mine_options, report);
    });
  }
  return reports;
}

}  // namespace dupin::test
