// Meshes as cages of subdivision surfaces.
#include <algorithm>
#include <cmath>

#include "../nurbs/subdivision.h"
#include "load.h"

namespace dupin::app {
namespace {

SubdivisionScheme scheme_of(const std::string& name) {
  if (name == "loop") return SubdivisionScheme::loop;
  return name == "catmull-clark" ? SubdivisionScheme::catmull_clark : SubdivisionScheme::automatic;
}

/// A polygon as long as the cage bends about once in it: n segments are off by an eighth of 1/n² of its
/// length.
int segments_for(const PolygonMesh& cage, double diagonal, double deflection) {
  double longest = 0;
  for (std::size_t i = 0; i < cage.polygon_count(); ++i) {
    const auto polygon = cage.polygon(i);
    for (std::size_t c = 0; c < polygon.size(); ++c)
      longest = std::max(
          longest, distance(cage.positions[polygon[c]], cage.positions[polygon[(c + 1) % polygon.size()]]));
  }
  const double allowed = deflection * diagonal;
  return static_cast<int>(
      std::clamp(std::ceil(std::sqrt(longest / (8 * std::max(allowed, 1e-300)))), 1.0, 1024.0));
}

Status subdivide(Session& session, Part& part, SubdivisionScheme scheme, double deflection) {
  const Result<SubdivisionSurface> surface = SubdivisionSurface::make(part.polygons, {scheme, 0});
  if (!surface.ok()) return surface.status();
  if (const SharpenedCreases sharp = surface->sharpened(); sharp.count > 0)
    session.warn(std::to_string(sharp.count) + " creases of sharpness " +
                 std::to_string(static_cast<int>(sharp.sharpness)) + " and more are drawn infinitely sharp");
  LimitPartOptions options;
  if (deflection > 0)
    options.segments_per_edge =
        segments_for(part.polygons, bounding_box(part.polygons).diagonal(), deflection);
  Part limit = surface->part(options);
  limit.name = part.name;
  limit.color = part.color;
  part = std::move(limit);
  return {};
}

}  // namespace

Status subdivide(Session& session, Model& model, const std::string& scheme, double mesh_deflection) {
  std::size_t cages = 0;
  for (Part& part : model.parts) {
    if (part.polygons.polygon_count() == 0) continue;
    const std::string name = part.name.empty() ? model.source : part.name;
    if (!part.faces.empty()) {
      session.note(name + " has exact faces: its mesh is no cage");
      continue;
    }
    if (Status status = subdivide(session, part, scheme_of(scheme), mesh_deflection); !status.ok()) {
      status.message = model.source + ": " + status.message;
      return status;
    }
    ++cages;
  }
  if (cages == 0) return {StatusCode::unreadable, model.source + ": has no mesh to subdivide"};
  return {};
}

}  // namespace dupin::app
