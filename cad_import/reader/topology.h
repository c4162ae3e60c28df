// A piece's faces, edges and vertices numbered, and its edges' curves.
#ifndef DUPIN_CAD_IMPORT_READER_TOPOLOGY_H
#define DUPIN_CAD_IMPORT_READER_TOPOLOGY_H

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>

#include <vector>

#include "../../nurbs/model.h"

namespace dupin::reader {

struct EdgeNumbers {
  std::uint32_t edge = 0;
  int first = -1, last = -1;  ///< vertices at t0 and t1
  double vertex_tolerance = 0;
};

/// Edges and vertices of a piece, by what they are and where, not by their orientation.
class Topology {
 public:
  EdgeNumbers number(const TopoDS_Edge& edge);
  std::size_t edge_count() const { return static_cast<std::size_t>(edges_.Extent()); }
  const TopoDS_Edge& edge(std::size_t i) const;

 private:
  TopTools_IndexedMapOfShape edges_, vertices_;
};

/// One use of an edge in a face's wire, with the face seen along its surface's own normal.
struct WireEdge {
  TopoDS_Edge shape;  ///< oriented as the wire runs
  EdgeNumbers numbers;
  bool reversed = false;
};

/// The edges of each wire that bounds the face. Internal and external ones are left out.
std::vector<std::vector<WireEdge>> wires_of(const TopoDS_Face& face, Topology& topology);

/// The 3D curve and range of an edge in its piece's space; no curve for degenerate edges and those without
/// one.
Edge to_edge(const TopoDS_Edge& shape);

/// The pcurve that the file has for this use of an edge, over `t0` … `t1` of the edge; none if there is none.
struct StoredPcurve {
  std::optional<Curve2> curve;
  double t0 = 0, t1 = 0;  ///< its own range, which may differ from the edge's
  bool seam = false;      ///< the face has two for the same edge
};
StoredPcurve stored_pcurve(const TopoDS_Edge& use, const TopoDS_Face& face);

}  // namespace dupin::reader

#endif
