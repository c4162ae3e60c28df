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

SidePlanes side_planes(const ViewRays& view, std::span<const DrawOptions::Section> sections) {
  SidePlanes sides;
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
    sides.planes[static_cast<std::size_t>(i)] = {n / l, d / l - dot(n / l, view.eye)};
  }
  for (const DrawOptions::Section& section : sections) {
    const double l = length(section.normal);
    sides.planes[sides.count++] = {section.normal / l, section.offset / l};
  }
  return sides;
}

std::array<double, 4> section_terms(const DrawOptions::Section& section, const ViewRays& view) {
  const Vec3 n = normalized(section.normal);
  // A point is  eye + z forward + (w ox + sx X) right + (w oy + sy Y) up,  w the depth z or, in parallel, 1.
  const double shift = dot(n, view.right * view.ox + view.up * view.oy);
  const double along = dot(n, view.forward),
               at_eye = dot(n, view.eye) + section.offset / length(section.normal);
  return {view.sx * dot(n, view.right), view.sy * dot(n, view.up), along + (view.perspective ? shift : 0),
          at_eye + (view.perspective ? 0 : shift)};
}

PartCamera part_camera(const SceneInstance& instance, const ScenePart& part, const ViewRays& view,
                       const SidePlanes& sides) {
  PartCamera camera;
  camera.sides.count = sides.count;
  for (std::size_t i = 0; i < sides.count; ++i)
    camera.sides.planes[i] = to_part(sides.planes[i], instance, part.anchor, true);
  camera.depth = to_part({view.forward, -dot(view.forward, view.eye)}, instance, part.anchor, false);
  const auto [row_x, row_y] = clip_rows(view);
  const std::array<Plane3, 2> rows{row_x, row_y};
  for (std::size_t k = 0; k < 2; ++k) camera.rows[k] = to_part(rows[k], instance, part.anchor, false);
  camera.perspective = view.perspective;
  const Vec3 eye = transform_point(instance.to_part, view.eye);
  camera.eye = view.perspective ? eye - part.anchor : -(instance.to_part.linear * view.forward);
  // From inside a solid, or where it is open (cut by the nearest depth or a section, or with hidden faces),
  // its inner sides can be seen.
  camera.cull_turned_away =
      part.closed && !sides.cut() && !instance.hidden_faces && !(view.perspective && part.box.contains(eye));
  camera.cut_solid = part.closed && sides.cut() && !instance.hidden_faces;
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
