#include "sampler.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "../core/parallel.h"
#include "../nurbs/invert.h"
#include "boundary.h"
#include "patch_faces.h"
#include "quadric_faces.h"
#include "tolerance_field.h"

namespace dupin {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;

/// One face's DPs on their own, so that faces can be made in any order.
struct FaceDps {
  PartDps dps;
  std::string failure;
};

/// The parameters of a point on an analytic surface, angles in [0, 2π).
Vec2 parameters_on(const Surface& surface, const Vec3& p) {
  auto angle = [](const Vec3& l) {
    const double a = std::atan2(l.y, l.x);
    return a < 0 ? a + kTwoPi : a;
  };
  if (const auto* c = std::get_if<Cylinder>(&surface.geometry)) {
    const Vec3 l = c->frame.to_local(p);
    return {angle(l), l.z};
  }
  if (const auto* c = std::get_if<Cone>(&surface.geometry)) {
    Vec3 l = c->frame.to_local(p);
    const double v = l.z / std::cos(c->half_angle);
    if (c->radius + v * std::sin(c->half_angle) < 0) l.x = -l.x, l.y = -l.y;
    return {angle(l), v};
  }
  const auto& s = std::get<Sphere>(surface.geometry);
  const Vec3 l = s.frame.to_local(p);
  return {angle(l), std::atan2(l.z, std::hypot(l.x, l.y))};
}

/// Whether a parameter point, known up to the period of u, is inside.
bool inside_with_period(const FaceBoundary& boundary, Vec2 uv) {
  const Box2& box = boundary.uv_box;
  double u = uv.x - std::floor((uv.x - box.lo.x) / kTwoPi) * kTwoPi;
  for (; u <= box.hi.x + 1e-9; u += kTwoPi)
    if (uv_inside(boundary, {u, uv.y})) return true;
  return false;
}

/// A rectangle of parameters with what the face reaches over its edges.
Box2 grown_over_edges(const Surface& surface, Box2 box, const UvRectangle& rectangle) {
  if (!rectangle.rectangle) return box;
  const double* reach = rectangle.side_reach;
  double around = 1, along = 1;  // lengths of a unit of u and v
  if (const auto* c = std::get_if<Cylinder>(&surface.geometry)) around = c->radius;
  if (const auto* c = std::get_if<Cone>(&surface.geometry))
    around = std::abs(c->radius + box.center().y * std::sin(c->half_angle));
  if (const auto* s = std::get_if<Sphere>(&surface.geometry))
    along = s->radius, around = s->radius * std::cos(box.center().y);
  if (!(around > 0)) return box;
  box.lo.x -= reach[0] / around, box.hi.x += reach[1] / around;
  box.lo.y -= reach[2] / along, box.hi.y += reach[3] / along;
  return box;
}

/// A recognised surface's parameters for a region of the spline that it was recognised in, by a grid of
/// points.
class Recast {
 public:
  Recast(const Surface& spline, const Surface& recognized, const Box2& uv_box) {
    constexpr int kSteps = 16;
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; j <= kSteps; ++j) {
        const Vec2 uv{uv_box.lo.x + uv_box.size().x * i / kSteps, uv_box.lo.y + uv_box.size().y * j / kSteps};
        const Vec3 p = point_at(spline, uv.x, uv.y);
        if (j > 0) spacing_ = std::max(spacing_, distance(p, points_.back().first));
        if (i > 0) spacing_ = std::max(spacing_, distance(p, points_[points_.size() - kSteps - 1].first));
        points_.push_back({p, uv});
        // The region's middle lies at u = π, opposite the seam.
        if (const auto q = invert(recognized, p, {kTwoPi / 2, 0})) box_.add(*q);
      }
    // Between the grid's points the region may reach a little farther; a whole turn's first and last points
    // are the same angle.
    const Vec2 margin = box_.size() * (1.0 / kSteps);
    box_ = {box_.lo - margin, box_.hi + margin};
    if (std::holds_alternative<Plane>(recognized.geometry)) return;
    const bool whole = box_.size().x > 0.85 * kTwoPi;
    box_.lo.x = whole ? 0 : std::max(box_.lo.x, 0.0),
    box_.hi.x = whole ? kTwoPi : std::min(box_.hi.x, kTwoPi);
    if (std::holds_alternative<Sphere>(recognized.geometry))
      box_.lo.y = std::max(box_.lo.y, -kTwoPi / 4), box_.hi.y = std::min(box_.hi.y, kTwoPi / 4);
  }
  const Box2& box() const { return box_; }
  /// The largest distance between neighbouring points of the grid.
  double spacing() const { return spacing_; }
  Vec2 nearest_parameters(const Vec3& p) const {
    double least = 1e300;
    Vec2 best{};
    for (const auto& [q, uv] : points_)
      if (const double d = dot(q - p, q - p); d < least) least = d, best = uv;
    return best;
  }

 private:
  std::vector<std::pair<Vec3, Vec2>> points_;
  Box2 box_;
  double spacing_ = 0;
};

class PartSampler {
 public:
  PartSampler(const Model& model, std::uint32_t part, const SamplingOptions& options)
      : part_(model.parts[part]),
        options_(options),
        field_(options, model, part),
        edges_(part_, [this](const Box3& box) { return field_.at(box); }) {}

  void sample_face(std::uint32_t index, FaceDps& out) const {
    const Face& face = part_.faces[index];
    const Surface& surface = part_.surfaces[face.surface];
    if (is_quadric(surface)) return sample_quadric(index, face, surface, out);
    const FaceBoundary boundary = face_boundary(part_, index, edges_, true);
    if (face.recognized && is_quadric(face.recognized->surface))
      return sample_recognized(index, face, boundary, out);
    const PatchFaceInput in{part_, face, index, boundary, field_, options_.normal_tolerance};
    const PatchFaceResult result = make_patch_face(in, out.dps);
    if (!result.rational && !result.defined)
      out.failure = "its " + std::string(kind_name(surface)) + " surface is not defined everywhere";
  }

 private:
  /// A spline that is a quadric: its DPs are the quadric, its trims come from their curves in space, and
  /// whether a point is inside is asked of the spline's own parameters.
  void sample_recognized(std::uint32_t index, const Face& face, const FaceBoundary& boundary,
                         FaceDps& out) const {
    const RecognizedSurface& recognized = *face.recognized;
    const Surface& spline = part_.surfaces[face.surface];
    const Recast recast(spline, recognized.surface, boundary.uv_box);
    auto inside = [&](const Vec3& p) {
      const Vec2 near = recast.nearest_parameters(p);
      const auto found = invert(spline, p, near);
      // A seam or a pole is inside, not on the outline that the loops make of it.
      const Box2& box = boundary.uv_box;
      const Vec2 margin = box.size() * 1e-6, uv = found ? *found : near;
      // The quadric goes on where the spline ends.
      // Newton's method may stall at a pole: then the nearest point known has to do.
      const double off = distance(point_at(spline, uv.x, uv.y), p);
      if (off >
          std::max(found ? 0 : recast.spacing(), 1e-6 * part_.box.diagonal() + 10 * recognized.deviation))
        return false;
      return uv_inside(boundary, {std::clamp(uv.x, box.lo.x + margin.x, box.hi.x - margin.x),
                                  std::clamp(uv.y, box.lo.y + margin.y, box.hi.y - margin.y)});
    };
    const QuadricFaceInput in{part_,        face, index,  recognized.surface, boundary,
                              recast.box(), {},   inside, !face.reversed};
    if (std::holds_alternative<Plane>(recognized.surface.geometry))
      make_plane_face(in, out.dps);
    else
      make_curved_quadric_face(in, out.dps);
    for (QuadricDp& dp : out.dps.dps) {
      dp.bound = std::hypot(dp.bound, recognized.deviation);
      dp.normal_bound = recognized.normal_deviation;
      dp.cell = boundary.uv_box;
    }
  }

  void sample_quadric(std::uint32_t index, const Face& face, const Surface& surface, FaceDps& out) const {
    const bool plane = std::holds_alternative<Plane>(surface.geometry);
    const FaceBoundary boundary = face_boundary(part_, index, edges_, !plane);
    auto inside = [&](const Vec3& p) { return inside_with_period(boundary, parameters_on(surface, p)); };
    QuadricFaceInput in{part_, face, index, surface, boundary, boundary.uv_box, {}, inside, !face.reversed};
    if (plane) {
      if (boundary.loops.empty())
        out.failure = "its plane has no boundary";
      else
        make_plane_face(in, out.dps);
      return;
    }
    in.rectangle = uv_rectangle(part_, index, edges_, boundary);
    in.uv_box = grown_over_edges(surface, in.uv_box, in.rectangle);
    make_curved_quadric_face(in, out.dps);
  }

  const Part& part_;
  const SamplingOptions& options_;
  const ToleranceField field_;
  const PartEdges edges_;
};

/// What all parts' faces share.
struct Run {
  const Model& model;
  const SamplingOptions& options;
  std::size_t total = 0;
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stop{false};

  void count_one() {
    const std::size_t now = ++done;
    if ((now & 63) == 0 &&
        !report(options.progress, "prepare", static_cast<double>(now) / static_cast<double>(total)))
      stop = true;
  }
};

std::string listed_name(const Part& part, std::size_t face) {
  const std::string& name = part.faces[face].name;
  return name.empty() ? "face " + std::to_string(face + 1) + " of " + part.name : name;
}

void sample_part(Run& run, std::uint32_t p, PartDps& out) {
  const Part& part = run.model.parts[p];
  const PartSampler sampler(run.model, p, run.options);
  std::vector<FaceDps> faces(part.faces.size());
  parallel_for(
      faces.size(),
      [&](std::size_t i) {
        if (run.stop) return;
        sampler.sample_face(static_cast<std::uint32_t>(i), faces[i]);
        run.count_one();
      },
      4);
  if (run.stop) return;
  std::size_t dps = 0;
  for (const FaceDps& face : faces) dps += face.dps.dps.size();
  out.dps.reserve(dps);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool none = faces[i].dps.dps.empty();
    append(std::as_const(faces[i].dps), out);
    faces[i].dps = {};
    if (faces[i].failure.empty() && none) out.out_of_picture.push_back(static_cast<std::uint32_t>(i));
    if (!faces[i].failure.empty()) out.skipped.push_back({listed_name(part, i), faces[i].failure, 1});
  }
}

}  // namespace

Result<DpScene> sample_quadric_dps(const Model& model, const SamplingOptions& options) {
  if (!options.camera && !(options.tolerance > 0))
    return {StatusCode::invalid_argument, "the tolerance must be above 0"};
  DpScene scene;
  scene.parts.resize(model.parts.size());
  Run run{model, options};
  for (const Part& part : model.parts) run.total += part.faces.size();
  // In parallel over parts, too: assemblies have many of a few faces each.
  parallel_for(scene.parts.size(), [&](std::size_t p) {
    if (!run.stop) sample_part(run, static_cast<std::uint32_t>(p), scene.parts[p]);
  });
  if (run.stop) return {StatusCode::cancelled, "cancelled"};
  for (const PartDps& part : scene.parts) {
    scene.bound_px = std::max(scene.bound_px, part.bound_px);
    for (const QuadricDp& dp : part.dps) {
      scene.bound = std::max(scene.bound, dp.bound);
      if (!dp.speck) scene.normal_bound = std::max(scene.normal_bound, dp.normal_bound);
    }
  }
  return scene;
}

}  // namespace dupin
