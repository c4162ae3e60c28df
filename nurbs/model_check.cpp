// The invariants of a Model, in one pass: what the reader hands over is only used if all of them hold.
#include <algorithm>
#include <cmath>

#include "knots.h"
#include "model.h"

namespace dupin {
namespace {

/// Frames and directions may be this far from orthonormal.
constexpr double kOrthonormal = 1e-6;
constexpr int kDeepestOffset = 3;  ///< an offset of offsets of …
/// A gap between trims may be this many times the tolerances of the face and its edges, and no larger than
/// this part of the face's parameter box where the surface does not say (a pole).
constexpr double kGapFactor = 10, kGapOfBox = 0.02;

// Each returns the reason why something is not valid, or nullptr.
using Reason = const char*;

bool finite(double x) {
  return std::isfinite(x);
}
bool finite(const Vec2& p) {
  return finite(p.x) && finite(p.y);
}
bool finite(const Vec3& p) {
  return is_finite(p);
}
double norm(const Vec2& p) {
  return std::hypot(p.x, p.y);
}
double norm(const Vec3& p) {
  return length(p);
}

template <class V>
bool orthonormal(const V& x, const V& y) {
  return std::abs(norm(x) - 1) < kOrthonormal && std::abs(norm(y) - 1) < kOrthonormal &&
         std::abs(dot(x, y)) < kOrthonormal;
}

Reason check_knots(const std::vector<double>& knots, int degree, std::size_t poles) {
  if (degree < 1 || degree > kMaxDegree) return "a spline's degree is out of range";
  if (poles < static_cast<std::size_t>(degree) + 1) return "a spline has too few poles";
  if (knots.size() != poles + degree + 1) return "a spline has a wrong number of knots";
  for (std::size_t i = 0; i < knots.size(); ++i)
    if (!finite(knots[i]) || (i > 0 && knots[i] < knots[i - 1]))
      return "a spline's knots decrease or are not finite";
  if (!(knots[degree] < knots[poles])) return "a spline's domain is empty";
  return nullptr;
}

template <class V>
Reason check_poles(const std::vector<V>& poles, const std::vector<double>& weights) {
  for (const V& p : poles)
    if (!finite(p)) return "a pole is not finite";
  if (!weights.empty() && weights.size() != poles.size()) return "a spline has a wrong number of weights";
  for (double w : weights)
    if (!finite(w) || !(w > 0)) return "a weight is not positive";
  return nullptr;
}

template <class V>
Reason check_curve(const CurveOf<V>& curve, int depth = 0);

template <class V>
struct CurveChecker {
  int depth;

  Reason conic(const V& center, const V& x, const V& y, double a, double b) const {
    if (!finite(center) || !orthonormal(x, y)) return "a conic's axes are not perpendicular unit vectors";
    return finite(a) && finite(b) && a > 0 && b > 0 ? nullptr : "a conic's radius is not positive";
  }
  Reason operator()(const LineOf<V>& l) const {
    return finite(l.origin) && finite(l.direction) && norm(l.direction) > 0 ? nullptr
                                                                            : "a line has no direction";
  }
  Reason operator()(const CircleOf<V>& c) const { return conic(c.center, c.x, c.y, c.radius, c.radius); }
  Reason operator()(const EllipseOf<V>& e) const { return conic(e.center, e.x, e.y, e.major, e.minor); }
  Reason operator()(const ParabolaOf<V>& p) const { return conic(p.vertex, p.x, p.y, p.focal, p.focal); }
  Reason operator()(const HyperbolaOf<V>& h) const { return conic(h.center, h.x, h.y, h.major, h.minor); }
  Reason operator()(const BsplineOf<V>& s) const {
    if (Reason reason = check_knots(s.knots, s.degree, s.poles.size())) return reason;
    return check_poles(s.poles, s.weights);
  }
  Reason operator()(const OffsetCurveOf<V>& o) const {
    if (!o.base || depth >= kDeepestOffset) return "an offset curve has no base";
    if (!finite(o.distance) || !finite(o.reference)) return "an offset curve's distance is not finite";
    return check_curve(*o.base, depth + 1);
  }
};

template <class V>
Reason check_curve(const CurveOf<V>& curve, int depth) {
  return std::visit(CurveChecker<V>{depth}, curve.geometry);
}

Reason check_surface(const Surface& surface, int depth = 0);

struct SurfaceChecker {
  int depth;

  Reason frame(const Frame3& f) const {
    if (!finite(f.origin) || !orthonormal(f.x, f.y) || !orthonormal(f.y, f.z) || !orthonormal(f.z, f.x))
      return "a surface's frame is not orthonormal";
    return nullptr;
  }
  Reason frame_and_radius(const Frame3& f, double radius) const {
    if (Reason reason = frame(f)) return reason;
    return finite(radius) && radius > 0 ? nullptr : "a surface's radius is not positive";
  }
  Reason operator()(const Plane& p) const { return frame(p.frame); }
  Reason operator()(const Cylinder& c) const { return frame_and_radius(c.frame, c.radius); }
  Reason operator()(const Cone& c) const {
    if (!finite(c.radius) || c.radius < 0) return "a cone's radius is negative";
    if (!(std::abs(c.half_angle) < 1.5707963267948967) || c.half_angle == 0)
      return "a cone's angle is out of range";
    return frame(c.frame);
  }
  Reason operator()(const Sphere& s) const { return frame_and_radius(s.frame, s.radius); }
  Reason operator()(const Torus& t) const {
    if (!finite(t.major) || t.major < 0) return "a torus's major radius is negative";
    return frame_and_radius(t.frame, t.minor);
  }
  Reason operator()(const BsplineSurface& s) const {
    if (s.count_u < 2 || s.count_v < 2) return "a spline surface has too few poles";
    if (Reason reason = check_knots(s.knots_u, s.degree_u, static_cast<std::size_t>(s.count_u)))
      return reason;
    if (Reason reason = check_knots(s.knots_v, s.degree_v, static_cast<std::size_t>(s.count_v)))
      return reason;
    if (s.poles.size() != static_cast<std::size_t>(s.count_u) * static_cast<std::size_t>(s.count_v))
      return "a spline surface has a wrong number of poles";
    return check_poles(s.poles, s.weights);
  }
  Reason operator()(const Revolution& r) const {
    if (!finite(r.axis_origin) || !(std::abs(length(r.axis_direction) - 1) < kOrthonormal))
      return "a revolution's axis is not a unit vector";
    return check_curve(r.profile);
  }
  Reason operator()(const Extrusion& e) const {
    if (!(std::abs(length(e.direction) - 1) < kOrthonormal))
      return "an extrusion's direction is not a unit vector";
    return check_curve(e.profile);
  }
  Reason operator()(const OffsetSurface& o) const {
    if (!o.base || depth >= kDeepestOffset) return "an offset surface has no base";
    return finite(o.distance) ? check_surface(*o.base, depth + 1)
                              : "an offset surface's distance is not finite";
  }
};

Reason check_surface(const Surface& surface, int depth) {
  return std::visit(SurfaceChecker{depth}, surface.geometry);
}

Reason check_edge(const Edge& edge) {
  if (!finite(edge.t0) || !finite(edge.t1) || !(edge.t0 < edge.t1)) return "an edge's range is empty";
  if (!finite(edge.tolerance) || edge.tolerance < 0) return "an edge's tolerance is negative";
  return edge.curve ? check_curve(*edge.curve) : nullptr;
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
    if (Reason reason = check_curve(trim.pcurve)) return reason;
    if (!trim.degenerate && !part.edges[trim.edge].curve) return "a trim's edge has no curve";
    tolerance = std::max(tolerance, part.edges[trim.edge].tolerance);
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 end = trim_end(part, loop[i], true), next = trim_end(part, loop[(i + 1) % loop.size()], false);
    if (!finite(end) || !finite(next)) return "a pcurve is not finite";
    if (!closes(part.surfaces[face.surface], face, tolerance, end, next)) return "a loop is not closed";
  }
  return nullptr;
}

Reason check_face(const Part& part, const Face& face) {
  if (face.surface >= part.surfaces.size()) return "it refers to no surface";
  if (!finite(face.uv_box.lo) || !finite(face.uv_box.hi) || face.uv_box.empty())
    return "its parameter box is empty";
  if (!finite(face.tolerance) || face.tolerance < 0) return "its tolerance is negative";
  for (const Loop& loop : face.loops)
    if (Reason reason = check_loop(part, face, loop)) return reason;
  return nullptr;
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
  return finite(mesh.origin) ? nullptr : "its mesh is not finite";
}

Status failure(const std::string& what, std::size_t index, const std::string& where, Reason reason) {
  return {StatusCode::unreadable, what + " " + std::to_string(index) + where + ": " + reason};
}

Status check_part(const Part& part, std::size_t index) {
  const std::string where = " of part " + std::to_string(index);
  for (std::size_t i = 0; i < part.surfaces.size(); ++i)
    if (Reason reason = check_surface(part.surfaces[i])) return failure("surface", i, where, reason);
  for (std::size_t i = 0; i < part.edges.size(); ++i)
    if (Reason reason = check_edge(part.edges[i])) return failure("edge", i, where, reason);
  for (std::size_t i = 0; i < part.faces.size(); ++i)
    if (Reason reason = check_face(part, part.faces[i])) return failure("face", i, where, reason);
  if (Reason reason = check_mesh(part.mesh, part.faces.size())) return failure("part", index, "", reason);
  if (Status mesh = check(part.polygons); !mesh.ok()) return failure("part", index, "", mesh.message.c_str());
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
