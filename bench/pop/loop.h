// Loop's subdivision of triangle meshes, for benchmarks that want large ones.
#ifndef DUPIN_BENCH_POP_LOOP_H
#define DUPIN_BENCH_POP_LOOP_H

#include "../../nurbs/polygon_mesh.h"

namespace dupin::bench {

/// Every triangle in four (Loop 1987, with Warren's weights); edges that have not two triangles are creases
/// by the cubic spline's rule. Only places and triangles are kept.
PolygonMesh loop_subdivided(const PolygonMesh& mesh);

}  // namespace dupin::bench

#endif
