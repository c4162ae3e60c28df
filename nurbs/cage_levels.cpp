// The one file that knows OpenSubdiv.
#include "cage_levels.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>

namespace dupin {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// A value that OpenSubdiv interpolates.
struct Point {
  Vec3 p;
  void Clear(void* = nullptr) { p = {}; }
  void AddWithWeight(const Point& other, double weight) { p += other.p * weight; }
};

thread_local std::string t_error;

void note_error(Far::ErrorType, const char* message) {
  if (t_error.empty()) t_error = message;
}
void drop_warning(const char*) {}

void catch_errors() {
  static std::once_flag once;
  std::call_once(once, [] {
    Far::SetErrorCallback(note_error);
    Far::SetWarningCallback(drop_warning);
  });
  t_error.clear();
}

/// A message of OpenSubdiv's, which may have several lines, as one.
std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "the cage cannot be subdivided" : text;
}

Sdc::Options::VtxBoundaryInterpolation boundary_of(SubdivisionTags::Boundary boundary) {
  switch (boundary) {
    case SubdivisionTags::Boundary::none:
      return Sdc::Options::VTX_BOUNDARY_NONE;
    case SubdivisionTags::Boundary::edges_and_corners:
      return Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
    default:
      return Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
  }
}

/// The arrays that OpenSubdiv's descriptor points into.
struct Descriptor {
  std::vector<int> counts, vertices, crease_ends, corners, holes;
  std::vector<float> crease_sharpness, corner_sharpness;
  std::vector<std::uint32_t> polygons;

  explicit Descriptor(const PolygonMesh& cage) {
    std::vector<int> face_of(cage.polygon_count(), -1);
    for (std::size_t i = 0; i < cage.polygon_count(); ++i) {
      const auto polygon = cage.polygon(i);
      std::vector<std::uint32_t> sorted(polygon.begin(), polygon.end());
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
      face_of[i] = static_cast<int>(polygons.size());
      polygons.push_back(static_cast<std::uint32_t>(i));
      counts.push_back(static_cast<int>(polygon.size()));
      for (std::uint32_t v : polygon) vertices.push_back(static_cast<int>(v));
    }
    for (const auto& crease : cage.tags.creases) {
      crease_ends.push_back(static_cast<int>(crease.a));
      crease_ends.push_back(static_cast<int>(crease.b));
      crease_sharpness.push_back(crease.sharpness);
    }
    for (const auto& corner : cage.tags.corners) {
      corners.push_back(static_cast<int>(corner.vertex));
      corner_sharpness.push_back(corner.sharpness);
    }
    for (std::uint32_t hole : cage.tags.holes)
      if (hole < face_of.size() && face_of[hole] >= 0) holes.push_back(face_of[hole]);
  }

  std::unique_ptr<Far::TopologyRefiner> refiner(const PolygonMesh& cage, SubdivisionScheme scheme) const {
    Far::TopologyDescriptor d;
    d.numVertices = static_cast<int>(cage.positions.size());
    d.numFaces = static_cast<int>(counts.size());
    d.numVertsPerFace = counts.data();
    d.vertIndicesPerFace = vertices.data();
    d.numCreases = static_cast<int>(crease_sharpness.size());
    d.creaseVertexIndexPairs = crease_ends.data();
    d.creaseWeights = crease_sharpness.data();
    d.numCorners = static_cast<int>(corners.size());
    d.cornerVertexIndices = corners.data();
    d.cornerWeights = corner_sharpness.data();
    d.numHoles = static_cast<int>(holes.size());
    d.holeIndices = holes.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(boundary_of(cage.tags.boundary));
    if (cage.tags.chaikin) options.SetCreasingMethod(Sdc::Options::CREASE_CHAIKIN);
    if (cage.tags.smooth_triangles) options.SetTriangleSubdivision(Sdc::Options::TRI_SUB_SMOOTH);
    const auto type = scheme == SubdivisionScheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(Factory::Create(d, Factory::Options(type, options)));
  }
};

VertexRule rule_of(Sdc::Crease::Rule rule) {
  switch (rule) {
    case Sdc::Crease::RULE_SMOOTH:
      return VertexRule::smooth;
    case Sdc::Crease::RULE_DART:
      return VertexRule::dart;
    case Sdc::Crease::RULE_CREASE:
      return VertexRule::crease;
    default:
      return VertexRule::corner;
  }
}

std::uint32_t index_of(Far::Index i) {
  return i < 0 ? kNoIndex : static_cast<std::uint32_t>(i);
}

void copy_vertices(const Far::TopologyLevel& from, CageLevel& to) {
  for (int v = 0; v < from.GetNumVertices(); ++v) {
    to.rules.push_back(rule_of(from.GetVertexRule(v)));
    bool semi = from.IsVertexSemiSharp(v);
    for (Far::Index e : from.GetVertexEdges(v)) semi = semi || from.IsEdgeSemiSharp(e);
    to.semi_sharp.push_back(semi);
  }
}

void copy_edges(const Far::TopologyLevel& from, bool last, CageLevel& to) {
  for (int e = 0; e < from.GetNumEdges(); ++e) {
    const auto vertices = from.GetEdgeVertices(e);
    to.edge_vertices.push_back({index_of(vertices[0]), index_of(vertices[1])});
    const auto faces = from.GetEdgeFaces(e);
    const bool open = faces.size() == 2 && !from.IsEdgeInfSharp(e) && !from.IsEdgeNonManifold(e);
    to.edge_faces.push_back(open ? std::array{index_of(faces[0]), index_of(faces[1])}
                                 : std::array{kNoIndex, kNoIndex});
    if (last) continue;
    const auto children = from.GetEdgeChildEdges(e);
    to.edge_children.push_back(children.size() == 2 ? std::array{index_of(children[0]), index_of(children[1])}
                                                    : std::array{kNoIndex, kNoIndex});
  }
}

void copy_faces(const Far::TopologyLevel& from, bool last, CageLevel& to) {
  to.face_starts.push_back(0);
  if (!last) to.child_starts.push_back(0);
  for (int f = 0; f < from.GetNumFaces(); ++f) {
    for (Far::Index v : from.GetFaceVertices(f)) to.face_vertices.push_back(index_of(v));
    for (Far::Index e : from.GetFaceEdges(f)) to.face_edges.push_back(index_of(e));
    to.face_starts.push_back(static_cast<std::uint32_t>(to.face_vertices.size()));
    to.hole.push_back(from.IsFaceHole(f));
    if (last) continue;
    for (Far::Index child : from.GetFaceChildFaces(f)) to.child_faces.push_back(index_of(child));
    to.child_starts.push_back(static_cast<std::uint32_t>(to.child_faces.size()));
  }
}

std::vector<Vec3> positions(const std::vector<Point>& points) {
  std::vector<Vec3> out;
  out.reserve(points.size());
  for (const Point& point : points) out.push_back(point.p);
  return out;
}

void copy_levels(const Far::TopologyRefiner& refiner, const PolygonMesh& cage, CageLevels& out) {
  const Far::PrimvarRefinerReal<double> values(refiner);
  std::vector<Point> points, next;
  for (const Vec3& p : cage.positions) points.push_back({p});
  for (int l = 0; l <= refiner.GetMaxLevel(); ++l) {
    const Far::TopologyLevel& from = refiner.GetLevel(l);
    const bool last = l == refiner.GetMaxLevel();
    CageLevel level;
    level.points = positions(points);
    copy_vertices(from, level);
    copy_edges(from, last, level);
    copy_faces(from, last, level);
    out.levels.push_back(std::move(level));
    if (last) break;
    next.assign(static_cast<std::size_t>(refiner.GetLevel(l + 1).GetNumVertices()), Point{});
    values.Interpolate(l + 1, points, next);
    points.swap(next);
  }
  std::vector<Point> limits(points.size()), u(points.size()), v(points.size());
  values.Limit(points, limits, u, v);
  out.limits = positions(limits), out.tangents_u = positions(u), out.tangents_v = positions(v);
}

Result<SubdivisionScheme> scheme_for(const PolygonMesh& cage, SubdivisionScheme wanted) {
  if (cage.polygon_count() == 0) return {StatusCode::unreadable, "a cage without polygons"};
  bool triangles = true;
  for (std::size_t i = 0; i < cage.polygon_count(); ++i) triangles = triangles && cage.corner_count(i) == 3;
  if (wanted == SubdivisionScheme::loop && !triangles)
    return {StatusCode::invalid_argument, "Loop's scheme needs a cage of triangles alone"};
  if (wanted != SubdivisionScheme::automatic) return wanted;
  return triangles ? SubdivisionScheme::loop : SubdivisionScheme::catmull_clark;
}

}  // namespace

Result<CageLevels> refine_cage(const PolygonMesh& cage, const RefineOptions& options) {
  const Result<SubdivisionScheme> scheme = scheme_for(cage, options.scheme);
  if (!scheme.ok()) return scheme.status();
  Descriptor descriptor(cage);
  if (descriptor.counts.empty())
    return {StatusCode::unreadable, "every polygon of the cage uses a vertex twice"};
  catch_errors();
  const auto refiner = descriptor.refiner(cage, *scheme);
  if (!refiner) return {StatusCode::unreadable, first_line(t_error)};
  if (options.adaptive) {
    Far::TopologyRefiner::AdaptiveOptions adaptive(options.levels);
    adaptive.useInfSharpPatch = true;
    refiner->RefineAdaptive(adaptive);
  } else {
    Far::TopologyRefiner::UniformOptions uniform(options.levels);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
  }
  CageLevels out;
  out.scheme = *scheme;
  out.polygons = std::move(descriptor.polygons);
  copy_levels(*refiner, cage, out);
  if (!t_error.empty()) return {StatusCode::unreadable, first_line(t_error)};
  correct_dart_limits(out);
  return out;
}

}  // namespace dupin
