// What a CAD file holds, in our own terms: parts with exact faces or polygons, placed by instances.
//
// Geometry is stored once a part; an assembly's repeated parts are instances. Faces refer to surfaces, and
// edges to curves, by index within their part. Lengths are millimetres unless `unit_note` says otherwise.
//
// Invariants, which `check(model)` verifies and the reader's hand-over relies on: every index is in range,
// every number is finite, knot vectors are non-decreasing and of the right length, every loop is closed in
// the parameter plane to within the face's tolerance (seams run twice, collapsed edges are straight segments
// in parameters).
#ifndef DUPIN_NURBS_MODEL_H
#define DUPIN_NURBS_MODEL_H

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../core/status.h"
#include "../core/vec.h"
#include "color.h"
#include "curve.h"
#include "polygon_mesh.h"
#include "surface.h"

namespace dupin {

/// A curve shared by the faces that meet in it.
struct Edge {
  std::optional<Curve3> curve;  ///< none for a degenerate edge (a pole of a sphere, a collapsed side)
  double t0 = 0, t1 = 0;        ///< the edge is the curve over [t0, t1], t0 < t1
  double tolerance = 0;  ///< how far curve, pcurves and vertices may lie from each other, in model units
  bool smooth = false;  ///< its two faces meet with a common tangent plane (or it is a seam): no feature line
};

/// One use of an edge by a loop. The pcurve runs with the edge's parameter over the edge's [t0, t1].
struct Trim {
  std::uint32_t edge = 0;
  bool reversed = false;    ///< the loop runs from t1 to t0
  bool seam = false;        ///< the same edge bounds this face twice; the surface goes on across it
  bool degenerate = false;  ///< a point in space: the edge has no curve
  Curve2 pcurve;            ///< in the surface's parameters
};

/// Closed; the face lies to the left in the parameter plane (for a right-handed u, v).
using Loop = std::vector<Trim>;

/// The simpler surface that a face's spline is (recognize.h), and how far off it is, certified.
struct RecognizedSurface {
  Surface surface;
  double deviation = 0;         ///< model units
  double normal_deviation = 0;  ///< radians
};

struct Face {
  std::uint32_t surface = 0;
  /// Set by `recognize_faces`. Parameters, trims and `uv_box` stay those of `surface`. Shared between copies:
  /// never changed.
  std::shared_ptr<const RecognizedSurface> recognized;
  bool reversed = false;    ///< the outward normal is -(Su × Sv)
  std::vector<Loop> loops;  ///< empty: bounded by `uv_box` alone (a whole sphere or torus, a natural patch)
  Box2 uv_box;              ///< contains the loops; finite
  double tolerance = 0;     ///< in model units
  std::optional<Color> color;
  std::string name;
};

/// The tessellated reference of a part's faces.
struct TriangleMesh {
  std::vector<std::array<float, 3>> positions;  ///< relative to `origin`
  std::vector<std::array<float, 3>> normals;    ///< unit, outward; as many as positions
  std::vector<std::uint32_t> triangles;         ///< three indices each, counter-clockwise seen from outside
  std::vector<std::uint32_t> faces;             ///< per triangle the index of its face in the part
  Vec3 origin;
};

struct Part {
  std::string name;
  std::optional<Color> color;
  std::vector<Surface> surfaces;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  bool closed =
      false;  ///< the faces bound a solid without a gap, normals outward: turned-away faces are never seen
  /// What the file has as polygons or points, besides or instead of exact faces; empty for most parts.
  PolygonMesh polygons;
  Box3 box;           ///< contains every face, polygon and point
  TriangleMesh mesh;  ///< only when a tessellation was asked for; of `faces` alone
};

struct Instance {
  std::uint32_t part = 0;
  Affine3 to_world;
  std::optional<Color> color;  ///< overrides the part's, not its faces' own
  std::string name;            ///< its path in the assembly, "/" between levels
};

struct SkippedFace {
  std::string name;         ///< the face's name, or "face N of PART"
  std::string reason;       ///< one line
  std::uint32_t count = 1;  ///< how many face instances that is
};

struct Model {
  std::string source;     ///< the file's name, for messages
  std::string format;     ///< "STEP", "IGES", "BREP", "FCStd", …
  std::string unit_note;  ///< "mm", or what was assumed
  std::vector<Part> parts;
  std::vector<Instance> instances;
  std::vector<SkippedFace> skipped;
  std::vector<std::string> notes;  ///< what was repaired or assumed, one line each
  double mesh_seconds = 0;         ///< what the tessellation took, when one was asked for
};

/// A part's faces: exact ones, then the groups of its polygons.
std::size_t face_count(const Part& part);
/// Face instances: every instance's faces, drawn ones only (those in `skipped` are not among them).
std::size_t face_instance_count(const Model& model);
/// Every instance placed; empty for an empty model.
Box3 bounding_box(const Model& model);
/// The first invariant that does not hold, or ok.
Status check(const Model& model);

}  // namespace dupin

#endif
