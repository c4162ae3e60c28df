#include "part_camera.h"

namespace dupin {
namespace {

/// Clip X and Y as functions of a point in model space.
std::array<Plane3, 2> clip_rows(const ViewRays& view) {
  const Vec3 offset = view.perspective ? view.forward : Vec3{};
  const auto row = [&](const Vec3& axis, double s, double o) {
    const Vec3 n = (axis - offset * o) / s;
    return Plane3{n, -dot(n, view.eye) - (view.perspective ? 0 : o / s)};
  };
  return {row(view.right, view.sx, view.ox), row(view.up, view.sy, view.oy)};
}

Plane3 to_part(const Plane3& plane, const SceneInstance& instance, const Vec3& anchor, bool normalise) {
  // n·(L p + t) + d
  Plane3 result{transpose_times(instance.to_world.linear, plane.n),
                dot(plane.n, instance.to_world.translation) + plane.d};
  result.d += dot(result.n, anchor);
  const double l = normalise ? length(result.n) : 1;
  return {result.n / l, result.d / l};
}

}  // namespace

std::array<Plane3, 4> side_planes(const ViewRays& view) {
  std::array<Plane3, 4> planes;
  for (int i = 0; i < 4; ++i) {
    const double sign = i & 1 ? 1 : -1;
    const Vec3 axis = i < 2 ? view.right : view.up;
    const double s = i < 2 ? view.sx : view.sy, o = i < 2 ? view.ox : view.oy;
    // Inside is |(axis·p − o·w)/s| <= w with w the depth or, in parallel, 1.
    Vec3 n = axis * (sign / s);
    double d = 0;
    if (view.perspective) {
      n += view.forward * (1 - sign * o / s);
    } else {
      d = 1 - sign * o / s;
    }
    const double l = length(n);
    planes[static_cast<std::size_t>(i)] = {n / l, d / l - dot(n / l, view.eye)};
  }
  return planes;
}

PartCamera part_camera(const SceneInstance& instance, const ScenePart& part, const ViewRays& view,
                       const std::array<Plane3, 4>& sides) {
  PartCamera camera;
  for (std::size_t i = 0; i < 4; ++i) camera.sides[i] = to_part(sides[i], instance, part.anchor, true);
  camera.depth = to_part({view.forward, -dot(view.forward, view.eye)}, instance, part.anchor, false);
  const auto [row_x, row_y] = clip_rows(view);
  const std::array<Plane3, 2> rows{row_x, row_y};
  for (std::size_t k = 0; k < 2; ++k) camera.rows[k] = to_part(rows[k], instance, part.anchor, false);
  camera.perspective = view.perspective;
  const Vec3 eye = transform_point(instance.to_part, view.eye);
  camera.eye = view.perspective ? eye - part.anchor : -(instance.to_part.linear * view.forward);
  // From inside a solid, cut open by the nearest depth, or where faces are hidden, its inner sides can be
  // seen.
  camera.cull_turned_away =
      part.closed && !instance.hidden_faces && !(view.perspective && part.box.contains(eye));
  return camera;
}

bool out_of_view(const PartCamera& camera, const Box3& box, const Vec3& anchor) {
  const Vec3 center = box.center() - anchor;
  const double radius = box.diagonal() / 2;
  for (const Plane3& side : camera.sides)
    if (dot(side.n, center) + side.d < -radius) return true;
  return camera.perspective &&
         dot(camera.depth.n, center) + camera.depth.d < -radius * length(camera.depth.n);
}

}  // namespace dupin
