// Where the points of decompositions come from: mesh parts, and exact faces by way of their DPs.
#ifndef DUPIN_SIMPLIFY_POINT_SOURCES_H
#define DUPIN_SIMPLIFY_POINT_SOURCES_H

#include "../nurbs/model.h"
#include "../sampling/quadric_dp.h"
#include "surface_points.h"

namespace dupin {

/// The polygons of a part as triangles, a point for each vertex and normal that it is shaded with; loose
/// points as they are. Edges longer than `longest` (0: any) are halved until none is, so that points are as
/// dense as is asked for on large triangles too. Faces are numbered as face_count(part) says; colors are the
/// file's. limit: more than `most` points.
Result<SurfacePoints> mesh_points(const Part& part, double longest = 0, std::size_t most = kMostSourcePoints);

/// Points of DPs on the lines of a cubic lattice: each is where a line that is the nearest lattice direction
/// to the normal there meets the surface, `spacing` apart, so that neighboring DPs continue each other's.
/// What is narrower than the spacing may be missed. Points have no colors: they are the faces'.
Result<SurfacePoints> dp_points(const PartDps& dps, double spacing, std::size_t most = kMostSourcePoints);

/// Two sources as one.
void append(const SurfacePoints& from, SurfacePoints& to);

}  // namespace dupin

#endif
