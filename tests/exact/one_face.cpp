#include "one_face.h"

namespace dupin::testing {

Model empty_model() {
  Model model;
  model.parts.emplace_back();
  model.instances.push_back({0, {}, {}, "part"});
  return model;
}

Face& add_face(Model& model, const Surface& surface, const Box2& uv_box) {
  Part& part = model.parts[0];
  part.surfaces.push_back(surface);
  Face face;
  face.surface = static_cast<std::uint32_t>(part.surfaces.size() - 1);
  face.uv_box = uv_box;
  part.faces.push_back(face);
  return part.faces.back();
}

void add_loop(Model& model, std::size_t face, const std::vector<Curve2>& pcurves,
              const std::vector<ParameterRange>& ranges, double tolerance) {
  Part& part = model.parts[0];
  Loop loop;
  for (std::size_t i = 0; i < pcurves.size(); ++i) {
    Edge edge{{}, ranges[i].lo, ranges[i].hi, tolerance, false};
    const auto* line = std::get_if<LineOf<Vec2>>(&pcurves[i].geometry);
    const auto* plane = std::get_if<Plane>(&part.surfaces[part.faces[face].surface].geometry);
    if (line && plane)
      edge.curve =
          Curve3{LineOf<Vec3>{plane->frame.to_world({line->origin.x, line->origin.y, 0}),
                              plane->frame.x * line->direction.x + plane->frame.y * line->direction.y}};
    part.edges.push_back(edge);
    loop.push_back(
        {static_cast<std::uint32_t>(part.edges.size() - 1), false, false, !edge.curve, pcurves[i]});
  }
  part.faces[face].loops.push_back(loop);
}

}  // namespace dupin::testing
