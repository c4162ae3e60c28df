// Several meshes as one.
#ifndef DUPIN_NURBS_JOIN_MESHES_H
#define DUPIN_NURBS_JOIN_MESHES_H

#include "polygon_mesh.h"

namespace dupin {

/// Vertices, polygons and groups of `from` behind those of `to`; a mesh without groups gets one. What only
/// one of them has by vertex or by polygon gets for the other what that looks like: no normals; the colour of
/// the polygon or of the group, or `plain`. Subdivision tags are dropped.
void append(PolygonMesh& to, const PolygonMesh& from, const Rgba8& plain);

}  // namespace dupin

#endif
