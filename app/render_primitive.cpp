#include "render_primitive.h"

#include <algorithm>

namespace dupin::app {

const std::vector<PrimitiveKind>& primitive_kinds() {
  static const std::vector<PrimitiveKind> kinds{
      {{"auto", "quadric"}, make_quadric_primitive},
      {{"dp", "square", "rectangle", "ellipse"}, make_points_primitive},
      {{"pop", "qsplat"}, make_trees_primitive},
      {{"amg"}, make_amg_primitive},
      {{"triangles"}, make_triangles_primitive}};
  return kinds;
}

std::unique_ptr<RenderPrimitive> make_primitive(const RenderOptions& options) {
  if (options.primitive == "auto" && options.points_files()) return make_points_primitive(options);
  for (const PrimitiveKind& kind : primitive_kinds())
    if (std::count(kind.names.begin(), kind.names.end(), options.primitive)) return kind.make(options);
  return nullptr;
}

}  // namespace dupin::app
