// One face: its surface, its pcurves checked against the edges' curves, its loops.
#ifndef DUPIN_CAD_IMPORT_READER_FACE_BUILDER_H
#define DUPIN_CAD_IMPORT_READER_FACE_BUILDER_H

#include <string>
#include <vector>

#include "topology.h"

namespace dupin::reader {

struct FaceTask {
  TopoDS_Face shape;
  std::vector<std::vector<WireEdge>> wires;
};

struct FaceResult {
  Face face;                          ///< uses of kNewDegenerateEdge still to be numbered
  std::optional<std::string> skip;    ///< why the face cannot be had
  std::optional<std::string> repair;  ///< why its wires need to be repaired first
  double largest_gap = 0;
  bool has_stray_edge = false;  ///< an edge lies far from its curve on the face
  std::vector<std::pair<std::uint32_t, double>>
      deviations;    ///< per edge, how far its pcurve lies from its curve
  int refitted = 0;  ///< pcurves that were made from the edge's curve
};

/// `edges` have their curves already; `size` is the piece's diagonal.
FaceResult build_face(const FaceTask& task, const Surface& surface, const std::vector<Edge>& edges,
                      double size);

}  // namespace dupin::reader

#endif
