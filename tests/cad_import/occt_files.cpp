#include "occt_files.h"

#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

namespace dupin::test {

std::optional<reader::SourceDocument> read_document(const std::string& path) {
  reader::ImportRequest request;
  request.path = path;
  Result<reader::SourceDocument> document = reader::read_document(request, [](const char*, double) {});
  if (!document.ok()) return std::nullopt;
  return std::move(*document);
}

reader::PartSource all_faces(const TopoDS_Shape& shape) {
  reader::PartSource source;
  for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next())
    source.faces.push_back({TopoDS::Face(e.Current()), {}, {}});
  return source;
}

reader::BuiltPart build(const TopoDS_Shape& shape) {
  return reader::build_part(all_faces(shape));
}

const std::vector<std::string>& varied_files() {
  static const std::vector<std::string> kFiles{"cad/nist/nist_ctc_05_asme1_ap242.stp",
                                               "cad/nist/nist_ftc_06_asme1_ap242-e2.stp",
                                               "cad/occt/linkrods.step",
                                               "cad/occt/screw.step",
                                               "cad/occt/MODERN_Sink_1.brep",
                                               "cad/occt/CrankArm.brep",
                                               "cad/occt/fuse.brep",
                                               "cad/occt/hammer.iges",
                                               "cad/freecad/SOT23.igs",
                                               "cad/freecad/cylinderSeam10.brep",
                                               "cad/freecad/Y_Rod_Mount.brep",
                                               "cad/tigl/nacelle.stp",
                                               "cad/tigl/curvesToSurfaceContinuous.brep",
                                               "cad/truck/abc-0035.step",
                                               "cad/gmsh-doc/component8.step",
                                               "cad/kicad/SMA_Amphenol_132291-12_Vertical.step",
                                               "nurbs/converted/teapot.brep",
                                               "nurbs/converted/gismo_sphere_u6p.step",
                                               "nurbs/converted/v5_extrusions.step",
                                               "nurbs/converted/v4_WishBone.step",
                                               "nurbs/converted/v1_Camera_visible.step"};
  return kFiles;
}

int side_of_loops(const Part& part, const Face& face, Vec2 q) {
  const Vec2 size = face.uv_box.size();
  bool inside = false;
  for (const Loop& loop : face.loops)
    for (const Trim& trim : loop) {
      const Edge& edge = part.edges[trim.edge];
      std::vector<double> stops = breaks(trim.pcurve, edge.t0, edge.t1, 2);
      stops.insert(stops.begin(), edge.t0);
      stops.push_back(edge.t1);
      for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
        Vec2 a = point_at(trim.pcurve, stops[s]);
        for (int k = 1; k <= 24; ++k) {
          const Vec2 b = point_at(trim.pcurve, stops[s] + (stops[s + 1] - stops[s]) * k / 24);
          // Near, measured in parts of the face's box.
          const Vec2 d{(b.x - a.x) / size.x, (b.y - a.y) / size.y},
              w{(q.x - a.x) / size.x, (q.y - a.y) / size.y};
          const double along = dot(d, d) > 0 ? std::clamp(dot(w, d) / dot(d, d), 0.0, 1.0) : 0;
          if (length(w - d * along) < 0.01) return 0;
          if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y))
            inside = !inside;
          a = b;
        }
      }
    }
  return inside ? 1 : -1;
}

}  // namespace dupin::test
