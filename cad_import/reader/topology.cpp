#include "topology.h"

#include <BRep_CurveRepresentation.hxx>
#include <BRep_GCurve.hxx>
#include <BRep_ListIteratorOfListOfCurveRepresentation.hxx>
#include <BRep_TEdge.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>

#include "geometry.h"

namespace dupin::reader {
namespace {

bool bounds_a_face(const TopoDS_Shape& shape) {
  return shape.Orientation() == TopAbs_FORWARD || shape.Orientation() == TopAbs_REVERSED;
}

}  // namespace

const TopoDS_Edge& Topology::edge(std::size_t i) const {
  return TopoDS::Edge(edges_(static_cast<int>(i) + 1));
}

EdgeNumbers Topology::number(const TopoDS_Edge& edge) {
  EdgeNumbers n;
  n.edge = static_cast<std::uint32_t>(edges_.Add(edge.Oriented(TopAbs_FORWARD)) - 1);
  TopoDS_Vertex first, last;
  TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), first, last);
  for (const auto& [vertex, index] : {std::pair(&first, &n.first), std::pair(&last, &n.last)})
    if (!vertex->IsNull()) {
      *index = vertices_.Add(vertex->Oriented(TopAbs_FORWARD));
      n.vertex_tolerance = std::max(n.vertex_tolerance, BRep_Tool::Tolerance(*vertex));
    }
  return n;
}

std::vector<std::vector<WireEdge>> wires_of(const TopoDS_Face& face, Topology& topology) {
  std::vector<std::vector<WireEdge>> wires;
  for (TopoDS_Iterator w(face.Oriented(TopAbs_FORWARD)); w.More(); w.Next()) {
    if (w.Value().ShapeType() != TopAbs_WIRE || !bounds_a_face(w.Value())) continue;
    std::vector<WireEdge> wire;
    for (TopoDS_Iterator e(w.Value()); e.More(); e.Next()) {
      if (e.Value().ShapeType() != TopAbs_EDGE || !bounds_a_face(e.Value())) continue;
      const TopoDS_Edge& edge = TopoDS::Edge(e.Value());
      wire.push_back({edge, topology.number(edge), edge.Orientation() == TopAbs_REVERSED});
    }
    // A wire that is used backwards lists its edges backwards too.
    if (w.Value().Orientation() == TopAbs_REVERSED) std::reverse(wire.begin(), wire.end());
    if (!wire.empty()) wires.push_back(std::move(wire));
  }
  return wires;
}

Edge to_edge(const TopoDS_Edge& shape) {
  Edge edge;
  edge.tolerance = BRep_Tool::Tolerance(shape);
  TopLoc_Location location;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(shape, location, edge.t0, edge.t1);
  if (curve.IsNull() || BRep_Tool::Degenerated(shape)) {
    BRep_Tool::Range(shape, edge.t0, edge.t1);
    return edge;
  }
  const Handle(Geom_Curve) placed =
      location.IsIdentity() ? curve
                            : Handle(Geom_Curve)::DownCast(curve->Transformed(location.Transformation()));
  edge.curve = to_curve(placed);
  return edge;
}

StoredPcurve stored_pcurve(const TopoDS_Edge& use, const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Geom_Surface)& surface = BRep_Tool::Surface(face, location);
  const TopLoc_Location relative = location.Predivided(use.Location());
  const auto& shape = static_cast<const BRep_TEdge&>(*use.TShape());
  StoredPcurve found;
  for (BRep_ListIteratorOfListOfCurveRepresentation i(shape.Curves()); i.More(); i.Next()) {
    const Handle(BRep_CurveRepresentation)& representation = i.Value();
    if (!representation->IsCurveOnSurface(surface, relative)) continue;
    found.seam = representation->IsCurveOnClosedSurface();
    const bool second = found.seam && use.Orientation() == TopAbs_REVERSED;
    found.curve = to_curve(second ? representation->PCurve2() : representation->PCurve());
    Handle(BRep_GCurve)::DownCast(representation)->Range(found.t0, found.t1);
    break;
  }
  return found;
}

}  // namespace dupin::reader
