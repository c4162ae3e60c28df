#include "complete_model.h"

#include <cmath>

#include "../nurbs/bezier.h"
#include "../nurbs/bounds.h"
#include "../nurbs/recognize.h"

namespace dupin {
namespace {

/// Of the face's parameter box, which contains its loops.
Box3 face_box(const Surface& surface, const Box2& uv) {
  Box3 box;
  for (const BezierPatch& patch : bezier_patches(surface, uv)) box.add(bounding_box(patch));
  if (!box.empty()) return box;
  // Kinds without Bézier patches (offsets): samples, and what may lie between them.
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const Vec2 size = uv.hi - uv.lo;
      const Vec3 p = point_at(surface, uv.lo.x + size.x * i / kSteps, uv.lo.y + size.y * j / kSteps);
      if (is_finite(p)) box.add(p);
    }
  const Vec3 pad = Vec3{1, 1, 1} * (0.1 * box.diagonal());
  if (!box.empty()) box.lo -= pad, box.hi += pad;
  return box;
}

bool usable(const Box2& box) {
  return std::isfinite(box.lo.x) && std::isfinite(box.lo.y) && std::isfinite(box.hi.x) &&
         std::isfinite(box.hi.y) && box.lo.x < box.hi.x && box.lo.y < box.hi.y;
}

/// A plane has no border of its own: its face gets the box's four sides for edges.
void add_rectangle(Part& part, Face& face) {
  const Plane* plane = std::get_if<Plane>(&part.surfaces[face.surface].geometry);
  if (!plane || !face.loops.empty()) return;
  const Box2& box = face.uv_box;
  const Vec2 corners[] = {box.lo, {box.hi.x, box.lo.y}, box.hi, {box.lo.x, box.hi.y}};
  Loop& loop = face.loops.emplace_back();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 from = corners[i], along = corners[(i + 1) % 4] - from;
    const Vec3 start = point_at(part.surfaces[face.surface], from.x, from.y);
    Edge& edge = part.edges.emplace_back();
    edge.curve = Curve3{LineOf<Vec3>{start, plane->frame.x * along.x + plane->frame.y * along.y}};
    edge.t1 = 1;
    Trim& trim = loop.emplace_back();
    trim.edge = static_cast<std::uint32_t>(part.edges.size() - 1);
    trim.pcurve = Curve2{LineOf<Vec2>{from, along}};
  }
}

Status set_box(Part& part) {
  Box3 box = part.polygons.empty() ? Box3{} : bounding_box(part.polygons);
  for (std::size_t i = 0; i < part.faces.size(); ++i) {
    const Face& face = part.faces[i];
    const std::string name = "face " + std::to_string(i) + " of part '" + part.name + "'";
    if (face.surface >= part.surfaces.size())
      return {StatusCode::invalid_argument, name + ": there is no such surface"};
    if (!usable(face.uv_box))
      return {StatusCode::invalid_argument, name + ": its parameter box is empty or infinite"};
    box.add(face_box(part.surfaces[face.surface], face.uv_box));
    add_rectangle(part, part.faces[i]);
  }
  part.box = box;
  return {};
}

}  // namespace

Status complete(Model& model) {
  // What is wrong with a curve or a surface is found before anything is evaluated; boxes come after that.
  for (Part& part : model.parts) part.box = {};
  if (model.instances.empty())
    for (std::uint32_t i = 0; i < model.parts.size(); ++i) model.instances.emplace_back().part = i;
  if (Status status = check(model); !status.ok()) return {StatusCode::invalid_argument, status.message};
  for (Part& part : model.parts)
    if (Status status = set_box(part); !status.ok()) return status;
  if (Status status = check(model); !status.ok()) return {StatusCode::invalid_argument, status.message};
  recognize_faces(model);
  return {};
}

}  // namespace dupin
