// A finite rectangle of a surface's parameters in which a face must lie, from its edges' points.
#ifndef DUPIN_CAD_IMPORT_READER_SEARCH_DOMAIN_H
#define DUPIN_CAD_IMPORT_READER_SEARCH_DOMAIN_H

#include <vector>

#include "topology.h"

namespace dupin::reader {

/// Box of points of the edges' curves: enough to say where and how large a face is, no strict bound.
Box3 edge_box(const std::vector<Edge>& edges, const std::vector<std::vector<WireEdge>>& wires);

Box2 search_domain(const Surface& surface, const std::vector<Edge>& edges,
                   const std::vector<std::vector<WireEdge>>& wires);

}  // namespace dupin::reader

#endif
