// What is seen at a pixel, and which faces a rectangle has.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "../nurbs/surface.h"
#include "../render/view_rays.h"
#include "host_scene_impl.h"

namespace dupin {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Where the DPs' surface is simpler than the file's, that is the better name.
const Surface& plain_surface(const Part& part, const Face& face) {
  return face.recognized ? face.recognized->surface : part.surfaces[face.surface];
}

std::optional<double> radius_of(const Surface& surface, const Vec3& p) {
  struct {
    const Vec3& p;
    std::optional<double> operator()(const Cylinder& s) const { return s.radius; }
    std::optional<double> operator()(const Sphere& s) const { return s.radius; }
    std::optional<double> operator()(const Torus& s) const { return s.minor; }
    std::optional<double> operator()(const Cone& s) const {
      const Vec3 from = p - s.frame.origin;
      return length(from - s.frame.z * dot(from, s.frame.z));
    }
    std::optional<double> operator()(const Plane&) const { return {}; }
    std::optional<double> operator()(const BsplineSurface&) const { return {}; }
    std::optional<double> operator()(const Revolution&) const { return {}; }
    std::optional<double> operator()(const Extrusion&) const { return {}; }
    std::optional<double> operator()(const OffsetSurface&) const { return {}; }
  } visitor{p};
  return std::visit(visitor, surface.geometry);
}

/// The distance of a point from a curve over [t0, t1]: the best of samples, then of ever smaller steps.
double distance_to(const Curve3& curve, double t0, double t1, const Vec3& p) {
  constexpr int kSamples = 64;
  double best = std::numeric_limits<double>::infinity(), at = t0, step = (t1 - t0) / kSamples;
  const auto try_at = [&](double t) {
    t = std::clamp(t, t0, t1);
    const double d = distance(point_at(curve, t), p);
    if (!(d < best)) return false;
    best = d, at = t;
    return true;
  };
  for (int i = 0; i <= kSamples; ++i) try_at(t0 + step * i);
  for (int i = 0; i < 24; ++i)
    if (!try_at(at - step) && !try_at(at + step)) step /= 2;
  return best;
}

Vec3 vec3(const std::vector<float>& values) {
  return values.size() < 3 ? Vec3{kNaN, kNaN, kNaN} : Vec3{values[0], values[1], values[2]};
}

}  // namespace

void describe_face(const Model& model, const FaceName& name, const Affine3& to_world, Hit& hit) {
  const Instance& instance = model.instances[name.instance];
  const Part& part = model.parts[instance.part];
  hit.part = part.name;
  hit.instance = instance.name;
  if (name.face >= part.faces.size()) {
    hit.surface = "mesh";
    const std::size_t group = name.face - part.faces.size();
    if (group < part.polygons.groups.size()) hit.face = part.polygons.groups[group].name;
    hit.k1 = hit.k2 = kNaN;
    hit.direction = {kNaN, kNaN, kNaN};
    return;
  }
  const Face& face = part.faces[name.face];
  const Surface& surface = plain_surface(part, face);
  hit.face = face.name;
  hit.surface = kind_name(surface);
  hit.radius = radius_of(surface, transform_point(inverse(to_world), hit.point));
}

void find_edge(const Model& model, const FaceName& name, const Affine3& to_world, double pixel, Hit& hit) {
  const Part& part = model.parts[model.instances[name.instance].part];
  if (name.face >= part.faces.size()) return;
  const Vec3 p = transform_point(inverse(to_world), hit.point);
  const double scale = std::cbrt(std::abs(determinant(to_world.linear)));
  double nearest = kEdgeReach * pixel / scale;
  for (const Loop& loop : part.faces[name.face].loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      if (!edge.curve || trim.seam) continue;
      const double d = distance_to(*edge.curve, edge.t0, edge.t1, p);
      if (d >= nearest) continue;
      nearest = d;
      hit.edge = trim.edge;
      hit.edge_distance_px = d * scale / pixel;
    }
}

Result<std::optional<Hit>> HostScene::pick(const HostView& view, int x, int y, const DrawOptions& options) {
  if (const Status status = impl_->update(); !status.ok()) return status;
  if (!impl_->scene) return std::optional<Hit>{};
  DrawOptions own = options;
  own.outputs = kFace | kPosition | kNormal | kDepth | kCurvature | kDirection | kUv;
  own.samples = 1;
  own.exact_model = impl_->model.get();
  const auto frame = impl_->renderer->read_host_view(*impl_->scene, view, {x, y, 1, 1}, own);
  if (!frame) return frame.status();
  if (frame->face.empty() || frame->face[0] == 0) return std::optional<Hit>{};
  const FaceName name = impl_->scene->face_name(frame->face[0]);
  Hit hit;
  hit.target = impl_->target_of(name);
  hit.point = vec3(frame->position);
  hit.normal = vec3(frame->normal);
  hit.depth = frame->depth[0];
  hit.k1 = frame->curvature[0], hit.k2 = frame->curvature[1];
  hit.direction = vec3(frame->direction);
  hit.uv = {frame->uv[0], frame->uv[1]};
  const Affine3 to_world =
      impl_->objects.at(hit.target.object).to_world * impl_->model->instances[name.instance].to_world;
  describe_face(*impl_->model, name, to_world, hit);
  find_edge(*impl_->model, name, to_world, frame->pixel_constant + frame->pixel_per_depth * hit.depth, hit);
  return std::optional<Hit>(hit);
}

Result<std::vector<Target>> HostScene::pick_rectangle(const HostView& view,
                                                      const std::array<int, 4>& rectangle,
                                                      const DrawOptions& options) {
  if (const Status status = impl_->update(); !status.ok()) return status;
  if (!impl_->scene) return std::vector<Target>{};
  DrawOptions own = options;
  own.outputs = kFace;
  own.samples = 1;
  own.exact_model = nullptr;
  const auto frame = impl_->renderer->read_host_view(*impl_->scene, view, rectangle, own);
  if (!frame) return frame.status();
  std::set<std::uint32_t> numbers(frame->face.begin(), frame->face.end());
  numbers.erase(0);
  std::vector<Target> targets;
  for (const std::uint32_t number : numbers)
    targets.push_back(impl_->target_of(impl_->scene->face_name(number)));
  return targets;
}

}  // namespace dupin
