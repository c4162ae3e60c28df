// The invariants of a Model, in one pass: what the reader hands over is only used if all of them hold.
#include <algorithm>
#include <cmath>

#include "model.h"

namespace dupin {
namespace {

/// A gap between trims may be this many times the tolerances of the face and its edges, and no larger than
/// this part of the face's parameter box where the surface does not say (a pole).
constexpr double kGapFactor = 10, kGapOfBox = 0.02;

// Each returns the reason why something is not valid, or nothing.
using Reason = std::string;

bool finite(double x) {
  return std::isfinite(x);
}
bool finite(const Vec2& p) {
  return finite(p.x) && finite(p.y);
}
bool finite(const Vec3& p) {
  return is_finite(p);
}

Reason check_edge(const Edge& edge) {
  if (!finite(edge.t0) || !finite(edge.t1) || !(edge.t0 < edge.t1)) return "an edge's range is empty";
  if (!finite(edge.tolerance) || edge.tolerance < 0) return "an edge's tolerance is negative";
  return edge.curve ? check(*edge.curve).message : Reason{};
}

Vec2 trim_end(const Part& part, const Trim& trim, bool last) {
  const Edge& edge = part.edges[trim.edge];
  return point_at(trim.pcurve, last != trim.reversed ? edge.t1 : edge.t0);
}

/// Whether the step from a to b in the parameter plane is within the tolerance, in space and in parameters.
bool closes(const Surface& surface, const Face& face, double tolerance, Vec2 a, Vec2 b) {
  const Vec2 gap = b - a, size = face.uv_box.size();
  if (!(std::abs(gap.x) <= kGapOfBox * size.x && std::abs(gap.y) <= kGapOfBox * size.y)) return false;
  const SurfaceJet jet = evaluate(surface, a.x, a.y, 1);
  const double step = length(jet.pu * gap.x + jet.pv * gap.y);
  const double whole = length(jet.pu) * size.x + length(jet.pv) * size.y;
  return !(step > kGapFactor * tolerance + 1e-6 * whole);
}

Reason check_loop(const Part& part, const Face& face, const Loop& loop) {
  if (loop.empty()) return "a loop is empty";
  double tolerance = face.tolerance;
  for (const Trim& trim : loop) {
    if (trim.edge >= part.edges.size()) return "a trim refers to no edge";
    if (Reason reason = check(trim.pcurve).message; !reason.empty()) return reason;
    if (!trim.degenerate && !part.edges[trim.edge].curve) return "a trim's edge has no curve";
    tolerance = std::max(tolerance, part.edges[trim.edge].tolerance);
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 end = trim_end(part, loop[i], true), next = trim_end(part, loop[(i + 1) % loop.size()], false);
    if (!finite(end) || !finite(next)) return "a pcurve is not finite";
    if (!closes(part.surfaces[face.surface], face, tolerance, end, next)) return "a loop is not closed";
  }
  return {};
}

Reason check_face(const Part& part, const Face& face) {
  if (face.surface >= part.surfaces.size()) return "it refers to no surface";
  if (!finite(face.uv_box.lo) || !finite(face.uv_box.hi) || face.uv_box.empty())
    return "its parameter box is empty";
  if (!finite(face.tolerance) || face.tolerance < 0) return "its tolerance is negative";
  for (const Loop& loop : face.loops)
    if (Reason reason = check_loop(part, face, loop); !reason.empty()) return reason;
  return {};
}

Reason check_mesh(const TriangleMesh& mesh, std::size_t faces) {
  if (mesh.normals.size() != mesh.positions.size()) return "its mesh has a wrong number of normals";
  if (mesh.triangles.size() % 3 != 0 || mesh.faces.size() * 3 != mesh.triangles.size())
    return "its mesh has a wrong number of triangles";
  for (std::uint32_t index : mesh.triangles)
    if (index >= mesh.positions.size()) return "a triangle refers to no point";
  for (std::uint32_t index : mesh.faces)
    if (index >= faces) return "a triangle refers to no face";
  for (const auto* list : {&mesh.positions, &mesh.normals})
    for (const auto& p : *list)
      if (!finite(p[0]) || !finite(p[1]) || !finite(p[2])) return "its mesh is not finite";
  return finite(mesh.origin) ? "" : "its mesh is not finite";
}

Status failure(const std::string& what, std::size_t index, const std::string& where, const Reason& reason) {
  return {StatusCode::unreadable, what + " " + std::to_string(index) + where + ": " + reason};
}

Status check_part(const Part& part, std::size_t index) {
  const std::string where = " of part " + std::to_string(index);
  for (std::size_t i = 0; i < part.surfaces.size(); ++i)
    if (Reason reason = check(part.surfaces[i]).message; !reason.empty())
      return failure("surface", i, where, reason);
  for (std::size_t i = 0; i < part.edges.size(); ++i)
    if (Reason reason = check_edge(part.edges[i]); !reason.empty()) return failure("edge", i, where, reason);
  for (std::size_t i = 0; i < part.faces.size(); ++i)
    if (Reason reason = check_face(part, part.faces[i]); !reason.empty())
      return failure("face", i, where, reason);
  if (Reason reason = check_mesh(part.mesh, part.faces.size()); !reason.empty())
    return failure("part", index, "", reason);
  if (Status mesh = check(part.polygons); !mesh.ok()) return failure("part", index, "", mesh.message);
  if (!part.box.empty() && !(finite(part.box.lo) && finite(part.box.hi)))
    return failure("part", index, "", "its box is not finite");
  return {};
}

}  // namespace

Status check(const Model& model) {
  for (std::size_t i = 0; i < model.parts.size(); ++i)
    if (Status status = check_part(model.parts[i], i); !status.ok()) return status;
  for (std::size_t i = 0; i < model.instances.size(); ++i) {
    const Instance& instance = model.instances[i];
    const Mat3& m = instance.to_world.linear;
    if (instance.part >= model.parts.size()) return failure("instance", i, "", "it refers to no part");
    if (!finite(m.x) || !finite(m.y) || !finite(m.z) || !finite(instance.to_world.translation) ||
        determinant(m) == 0)
      return failure("instance", i, "", "its placement is not finite or flattens it");
  }
  return {};
}

}  // namespace dupin
