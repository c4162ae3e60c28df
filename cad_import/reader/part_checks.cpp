#include "part_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "../../core/parallel.h"
#include "face_bounds.h"

namespace dupin::reader {
namespace {

struct Use {
  const Face* face = nullptr;
  const Trim* trim = nullptr;
  std::uint32_t face_index = 0;
  bool runs_backwards() const { return trim->reversed != face->reversed; }
};

std::vector<std::vector<Use>> uses_by_edge(const Part& part) {
  std::vector<std::vector<Use>> uses(part.edges.size());
  for (std::uint32_t f = 0; f < part.faces.size(); ++f)
    for (const Loop& loop : part.faces[f].loops)
      for (const Trim& trim : loop)
        if (!trim.degenerate) uses[trim.edge].push_back({&part.faces[f], &trim, f});
  return uses;
}

Vec3 outward_normal(const Part& part, const Use& use, double t) {
  const Vec2 q = point_at(use.trim->pcurve, t);
  const SurfaceJet s = evaluate(part.surfaces[use.face->surface], q.x, q.y, 1);
  const Vec3 n = cross(s.pu, s.pv);
  if (!(length(n) > 1e-9 * length(s.pu) * length(s.pv))) return {};
  return normalized(use.face->reversed ? -n : n);
}

bool is_smooth(const Part& part, const Edge& edge, const Use& a, const Use& b) {
  static const double kLeast = std::cos(kSmoothDegrees * std::numbers::pi / 180);
  const double sign =
      a.runs_backwards() != b.runs_backwards() ? 1 : -1;  // the same way: one of them is turned over
  for (const double s : {0.03, 0.27, 0.5, 0.73, 0.97}) {
    const double t = edge.t0 + (edge.t1 - edge.t0) * s;
    const Vec3 n = outward_normal(part, a, t), m = outward_normal(part, b, t);
    if (length(n) == 0 || length(m) == 0) continue;  // a singular point says nothing
    if (!(sign * dot(n, m) >= kLeast)) return false;
  }
  return true;
}

// Gauss–Legendre on [0, 1]: over an eighth of a turn, or a cubic span, three points leave less than a
// millionth, and only the volume's sign is asked for.
constexpr int kPoints = 3;
constexpr double kNodes[kPoints] = {0.11270166537925831, 0.5, 0.88729833462074169};
constexpr double kWeights[kPoints] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

// Where to split [a, b] so that three points a piece are enough: at the surface's knots, or every 45°.
std::vector<double> stops(const Surface& surface, bool along_u, double a, double b) {
  std::vector<double> result{a};
  const double lo = std::min(a, b), hi = std::max(a, b);
  if (const auto* spline = std::get_if<BsplineSurface>(&surface.geometry)) {
    const auto& knots = along_u ? spline->knots_u : spline->knots_v;
    for (const double k : knots)
      if (k > lo && k < hi && (result.size() == 1 || k > result.back())) result.push_back(k);
    if (a > b) std::reverse(result.begin() + 1, result.end());
  } else {
    const double period = along_u ? period_u(surface) : period_v(surface);
    const int pieces = period > 0 ? static_cast<int>(std::ceil((hi - lo) / period * 8)) : 4;
    for (int i = 1; i < pieces; ++i) result.push_back(a + (b - a) * i / pieces);
  }
  result.push_back(b);
  return result;
}

class FaceVolume {
 public:
  FaceVolume(const Part& part, const Face& face, const Vec3& origin)
      : part_(part), face_(face), surface_(part.surfaces[face.surface]), origin_(origin) {}

  // By Green's theorem: ∬ f du dv = ∮ g dv with g(u,v) = ∫ f(s,v) ds from the box's left side to u.
  double value() {
    double sum = 0;
    if (face_.loops.empty()) {
      sum = along_v(face_.uv_box.hi.x, face_.uv_box.lo.y, face_.uv_box.hi.y);
    } else {
      for (const Loop& loop : face_.loops)
        for (const Trim& trim : loop) sum += trim.reversed ? -along(trim) : along(trim);
    }
    return face_.reversed ? -sum : sum;
  }

 private:
  double density(double u, double v) const {
    const SurfaceJet s = evaluate(surface_, u, v, 1);
    const double f = dot(s.p - origin_, cross(s.pu, s.pv)) / 3;
    return std::isfinite(f) ? f : 0;
  }

  double inner(double u, double v) const {
    const std::vector<double> at = stops(surface_, true, face_.uv_box.lo.x, u);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      for (int k = 0; k < kPoints; ++k) {
        const double h = at[i + 1] - at[i];
        sum += h * kWeights[k] * density(at[i] + h * kNodes[k], v);
      }
    return sum;
  }

  double along_v(double u, double v0, double v1) const {
    const std::vector<double> at = stops(surface_, false, v0, v1);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      for (int k = 0; k < kPoints; ++k) {
        const double h = at[i + 1] - at[i];
        sum += h * kWeights[k] * inner(u, at[i] + h * kNodes[k]);
      }
    return sum;
  }

  double along(const Trim& trim) const {
    const Edge& edge = part_.edges[trim.edge];
    if (const auto* line = std::get_if<LineOf<Vec2>>(&trim.pcurve.geometry)) {
      if (line->direction.y == 0) return 0;
      if (line->direction.x == 0)
        return along_v(line->origin.x, point_at(trim.pcurve, edge.t0).y, point_at(trim.pcurve, edge.t1).y);
    }
    std::vector<double> at = breaks(trim.pcurve, edge.t0, edge.t1, 2);
    at.insert(at.begin(), edge.t0);
    at.push_back(edge.t1);
    const int pieces = at.size() > 8 ? 1 : 4;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      for (int p = 0; p < pieces; ++p)
        for (int k = 0; k < kPoints; ++k) {
          const double h = (at[i + 1] - at[i]) / pieces, t = at[i] + h * (p + kNodes[k]);
          const CurveJet<Vec2> q = evaluate(trim.pcurve, t, 1);
          sum += h * kWeights[k] * q[1].y * inner(q[0].x, q[0].y);
        }
    return sum;
  }

  const Part& part_;
  const Face& face_;
  const Surface& surface_;
  Vec3 origin_;
};

// The faces of each connected shell.
std::vector<std::vector<std::uint32_t>> shells(const Part& part) {
  std::vector<std::uint32_t> root(part.faces.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t f) {
    while (root[f] != f) f = root[f] = root[root[f]];
    return f;
  };
  for (const auto& uses : uses_by_edge(part))
    for (std::size_t i = 1; i < uses.size(); ++i) root[find(uses[i].face_index)] = find(uses[0].face_index);
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<int> index(part.faces.size(), -1);
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    int& i = index[find(f)];
    if (i < 0) i = static_cast<int>(result.size()), result.emplace_back();
    result[i].push_back(f);
  }
  return result;
}

// A volume below this part of what its faces contribute has no certain sign.
constexpr double kCertainVolume = 1e-5;

}  // namespace

void mark_smooth_edges(Part& part) {
  const auto uses = uses_by_edge(part);
  parallel_for(
      part.edges.size(),
      [&](std::size_t e) {
        part.edges[e].smooth = uses[e].size() == 2 && is_smooth(part, part.edges[e], uses[e][0], uses[e][1]);
      },
      64);
}

bool is_watertight(const Part& part) {
  for (const auto& uses : uses_by_edge(part)) {
    // As often one way as the other; more than once each where a solid touches itself.
    const auto backwards =
        std::count_if(uses.begin(), uses.end(), [](const Use& use) { return use.runs_backwards(); });
    if (static_cast<std::size_t>(2 * backwards) != uses.size()) return false;
  }
  // A face without loops is closed in itself only if its surface is.
  for (const Face& face : part.faces) {
    if (!face.loops.empty()) continue;
    const Surface& surface = part.surfaces[face.surface];
    const bool sphere = std::holds_alternative<Sphere>(surface.geometry);
    const double turn = period_u(surface), across = period_v(surface);
    const bool around = turn > 0 && face.uv_box.size().x > 0.999999 * turn;
    if (!around || !(sphere || (across > 0 && face.uv_box.size().y > 0.999999 * across))) return false;
  }
  return !part.faces.empty();
}

Volume enclosed_volume(const Part& part, const std::vector<std::uint32_t>& faces) {
  std::vector<double> values(faces.size());
  const Vec3 origin = part.box.center();
  parallel_for(
      faces.size(),
      [&](std::size_t i) { values[i] = FaceVolume(part, part.faces[faces[i]], origin).value(); }, 16);
  Volume volume;
  for (const double v : values) volume.signed_volume += v, volume.scale += std::abs(v);
  return volume;
}

void mark_closed(Part& part) {
  part.closed = false;
  if (!is_watertight(part)) return;
  std::vector<Volume> volumes;
  for (const auto& shell : shells(part)) volumes.push_back(enclosed_volume(part, shell));
  const auto outer = std::max_element(volumes.begin(), volumes.end(), [](const Volume& a, const Volume& b) {
    return std::abs(a.signed_volume) < std::abs(b.signed_volume);
  });
  for (auto v = volumes.begin(); v != volumes.end(); ++v) {
    const double outward = v == outer ? v->signed_volume : -v->signed_volume;
    if (!(outward > kCertainVolume * v->scale)) return;
  }
  part.closed = true;
}

void set_part_box(Part& part) {
  std::vector<Box3> edge_boxes(part.edges.size()), boxes(part.faces.size());
  parallel_for(
      part.edges.size(),
      [&](std::size_t i) {
        const Edge& edge = part.edges[i];
        if (!edge.curve) return;
        edge_boxes[i] = curve_bounds(*edge.curve, edge.t0, edge.t1);
        const Vec3 pad = Vec3{1, 1, 1} * edge.tolerance;
        edge_boxes[i].lo -= pad, edge_boxes[i].hi += pad;
      },
      64);
  parallel_for(
      part.faces.size(), [&](std::size_t i) { boxes[i] = face_bounds(part, part.faces[i], edge_boxes); }, 16);
  part.box = {};
  for (const Box3& box : boxes) part.box.add(box);
}

}  // namespace dupin::reader
