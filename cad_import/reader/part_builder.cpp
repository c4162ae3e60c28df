#include "part_builder.h"

#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <TopLoc_Location.hxx>

#include <algorithm>
#include <cstdio>
#include <map>

#include "../../core/parallel.h"
#include "curve_fit.h"
#include "face_builder.h"
#include "geometry.h"
#include "loops.h"
#include "part_checks.h"
#include "repair.h"
#include "sanitize.h"
#include "search_domain.h"
#include "topology.h"

namespace dupin::reader {
namespace {

// What a space curve made from a pcurve may differ from it, as a part of the piece's size.
constexpr double kCurveFit = 1e-9;

// A deviation between the samples may be this much larger than at them.
constexpr double kSampling = 1.5;
// As parts of the piece's size: rounding in files, and what can still be one vertex.
constexpr double kLeastTolerance = 1e-10, kLargestMiss = 1e-3;

class SurfaceTable {
 public:
  /// The index of the face's surface in its piece's space; none for a kind that cannot be had.
  std::optional<std::uint32_t> add(const TopoDS_Face& face, std::vector<Surface>& surfaces) {
    TopLoc_Location location;
    Handle(Geom_Surface) surface = untrimmed(BRep_Tool::Surface(face, location));
    if (surface.IsNull()) return std::nullopt;
    for (const auto& [known, index] : by_handle_[surface.get()])
      if (known.IsEqual(location)) return index;
    Handle(Geom_Surface) placed = surface;
    if (!location.IsIdentity())
      placed = Handle(Geom_Surface)::DownCast(surface->Transformed(location.Transformation()));
    std::optional<Surface> converted = to_surface(placed);
    if (!converted) return std::nullopt;
    surfaces.push_back(std::move(*converted));
    const auto index = static_cast<std::uint32_t>(surfaces.size() - 1);
    by_handle_[surface.get()].emplace_back(location, index);
    return index;
  }

 private:
  std::map<const Geom_Surface*, std::vector<std::pair<TopLoc_Location, std::uint32_t>>> by_handle_;
};

class PartBuilder {
 public:
  explicit PartBuilder(const PartSource& source) : source_(source) {}

  BuiltPart run() {
    built_.part.name = source_.name;
    built_.part.color = source_.color;
    collect();
    convert_edges();
    complete_edges();
    build_faces(0);
    repair_faces();
    take_faces();
    drop_invalid();
    set_tolerances();
    drop_unused();
    set_part_box(built_.part);
    mark_smooth_edges(built_.part);
    if (built_.skipped.empty()) mark_closed(built_.part);
    return std::move(built_);
  }

 private:
  struct Pending {
    std::size_t source = 0;
    FaceTask task;
    std::optional<std::uint32_t> surface;
    FaceResult result;
    bool replaced = false;  ///< by others of the same source
  };

  void collect() {
    for (std::size_t i = 0; i < source_.faces.size(); ++i) add_pending(i, source_.faces[i].face);
  }

  void add_pending(std::size_t source, const TopoDS_Face& face) {
    Pending p;
    p.source = source;
    p.task.shape = face;
    p.surface = surfaces_.add(face, built_.part.surfaces);
    p.task.wires = wires_of(face, topology_);
    pending_.push_back(std::move(p));
  }

  void convert_edges() {
    convert_new_edges();
    Box3 box;
    for (const Edge& edge : built_.part.edges)
      if (edge.curve)
        for (int i = 0; i <= 8; ++i) {
          const Vec3 p = point_at(*edge.curve, edge.t0 + (edge.t1 - edge.t0) * i / 8);
          if (is_finite(p)) box.add(p);
        }
    size_ = box.diagonal();
    if (size_ == 0) size_ = 1;
  }

  void convert_new_edges() {
    std::vector<Edge>& edges = built_.part.edges;
    const std::size_t first = edges.size();
    edges.resize(topology_.edge_count());
    parallel_for(
        edges.size() - first, [&](std::size_t i) { edges[first + i] = to_edge(topology_.edge(first + i)); },
        64);
  }

  // Edges that have a pcurve but no curve in space, and are no points, get one.
  void complete_edges() {
    int made = 0;
    for (const Pending& p : pending_)
      for (const auto& wire : p.task.wires)
        for (const WireEdge& use : wire) {
          Edge& edge = built_.part.edges[use.numbers.edge];
          if (edge.curve || !p.surface || BRep_Tool::Degenerated(use.shape)) continue;
          const StoredPcurve stored = stored_pcurve(use.shape, p.task.shape);
          if (!stored.curve || !(stored.t0 < stored.t1)) continue;
          edge.t0 = stored.t0, edge.t1 = stored.t1;
          edge.curve =
              fit_curve(built_.part.surfaces[*p.surface], *stored.curve, edge.t0, edge.t1, kCurveFit * size_);
          if (edge.curve) ++made;
        }
    if (made > 0)
      note(made, "edge had no curve in space: made from its curve on a face",
           "edges had no curves in space: made from their curves on a face");
  }

  void build_faces(std::size_t first) {
    parallel_for(
        pending_.size() - first,
        [&](std::size_t i) {
          Pending& p = pending_[first + i];
          if (p.surface)
            p.result = build_face(p.task, built_.part.surfaces[*p.surface], built_.part.edges, size_);
          else
            p.result.skip = "its surface is of a kind that is not supported";
        },
        8);
  }

  // Faces that do not close as they are get a second chance.
  void repair_faces() {
    const std::size_t count = pending_.size();
    int mended = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!pending_[i].result.skip && !pending_[i].result.repair) continue;
      if (!pending_[i].surface) continue;
      const std::size_t first = pending_.size();
      for (const TopoDS_Face& face : repaired(pending_[i].task.shape)) add_pending(pending_[i].source, face);
      convert_new_edges();
      complete_edges();
      build_faces(first);
      const bool good = pending_.size() > first &&
                        std::all_of(pending_.begin() + static_cast<std::ptrdiff_t>(first), pending_.end(),
                                    [](const Pending& p) { return is_good(p.result); });
      if (good)
        ++mended, pending_[i].replaced = true;
      else
        pending_.resize(first);
    }
    if (mended > 0)
      note(mended, "face's boundary did not close and was mended",
           "faces' boundaries did not close and were mended");
    std::stable_sort(pending_.begin(), pending_.end(),
                     [](const Pending& a, const Pending& b) { return a.source < b.source; });
  }

  static bool is_good(const FaceResult& result) {
    return !result.skip && !result.repair && !result.has_stray_edge;
  }

  void take_faces() {
    deviations_.assign(built_.part.edges.size(), 0);
    int refitted = 0;
    for (std::size_t i = 0; i < pending_.size(); ++i) {
      Pending& p = pending_[i];
      if (p.replaced) continue;
      const FaceSource& source = source_.faces[p.source];
      if (!p.result.skip) p.result.skip = p.result.repair;
      if (p.result.skip) {
        built_.skipped.push_back({face_name(p.source), *p.result.skip, 1});
        continue;
      }
      refitted += p.result.refitted;
      Face face = std::move(p.result.face);
      face.surface = *p.surface;
      face.color = source.color;
      face.name = source.name;
      number_new_edges(face);
      for (const auto& [edge, deviation] : p.result.deviations)
        deviations_[edge] = std::max(deviations_[edge], kSampling * deviation);
      built_.part.faces.push_back(std::move(face));
      built_.shapes.push_back(p.task.shape);
    }
    if (refitted > 0)
      note(refitted, "edge's curve on a face lay off the edge: projected anew",
           "edges' curves on faces lay off the edges: projected anew");
  }

  void number_new_edges(Face& face) {
    for (Loop& loop : face.loops)
      for (Trim& trim : loop) {
        if (trim.edge != kNewDegenerateEdge) continue;
        trim.edge = static_cast<std::uint32_t>(built_.part.edges.size());
        built_.part.edges.push_back({std::nullopt, 0, 1, face.tolerance, false});
      }
  }

  void drop_invalid() {
    std::vector<std::size_t> stay;
    for (SkippedFace& face : remove_invalid_faces(built_.part, stay))
      built_.skipped.push_back(std::move(face));
    if (stay.size() == built_.shapes.size()) return;
    std::vector<TopoDS_Face> shapes;
    for (const std::size_t i : stay) shapes.push_back(built_.shapes[i]);
    built_.shapes = std::move(shapes);
  }

  // Measured ones: a file's own may be anything. Edges that follow each other may miss each other at their
  // vertex.
  void set_tolerances() {
    deviations_.resize(built_.part.edges.size(), 0);
    for (const Face& face : built_.part.faces)
      for (const Loop& loop : face.loops) {
        std::vector<const Trim*> real;
        for (const Trim& trim : loop)
          if (built_.part.edges[trim.edge].curve) real.push_back(&trim);
        for (std::size_t i = 0; i < real.size(); ++i) {
          const Trim &a = *real[i], &b = *real[(i + 1) % real.size()];
          const double gap = distance(end_of(a, true), end_of(b, false));
          if (!(gap < kLargestMiss * size_)) continue;  // a collapsed side lies between them
          for (const std::uint32_t edge : {a.edge, b.edge})
            deviations_[edge] = std::max(deviations_[edge], gap);
        }
      }
    for (std::size_t i = 0; i < deviations_.size(); ++i)
      built_.part.edges[i].tolerance = std::max(deviations_[i], kLeastTolerance * size_);
  }

  Vec3 end_of(const Trim& trim, bool last) const {
    const Edge& edge = built_.part.edges[trim.edge];
    return point_at(*edge.curve, last != trim.reversed ? edge.t1 : edge.t0);
  }

  // Edges of faces that were skipped may have anything in them.
  void drop_unused() {
    std::vector<std::uint32_t> number(built_.part.edges.size(), kNewDegenerateEdge);
    std::vector<Edge> used;
    for (Face& face : built_.part.faces)
      for (Loop& loop : face.loops)
        for (Trim& trim : loop) {
          std::uint32_t& n = number[trim.edge];
          if (n == kNewDegenerateEdge) {
            n = static_cast<std::uint32_t>(used.size());
            used.push_back(std::move(built_.part.edges[trim.edge]));
          }
          trim.edge = n;
        }
    built_.part.edges = std::move(used);
    std::vector<std::uint32_t> surface_number(built_.part.surfaces.size(), 0);
    std::vector<Surface> surfaces;
    std::vector<bool> seen(built_.part.surfaces.size(), false);
    for (Face& face : built_.part.faces) {
      if (!seen[face.surface]) {
        seen[face.surface] = true;
        surface_number[face.surface] = static_cast<std::uint32_t>(surfaces.size());
        surfaces.push_back(std::move(built_.part.surfaces[face.surface]));
      }
      face.surface = surface_number[face.surface];
    }
    built_.part.surfaces = std::move(surfaces);
  }

  std::string face_name(std::size_t i) const {
    if (!source_.faces[i].name.empty()) return source_.faces[i].name;
    return "face " + std::to_string(i + 1) + " of " + (source_.name.empty() ? "the part" : source_.name);
  }

  void note(int count, const char* one, const char* many) {
    built_.notes.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
  }

  const PartSource& source_;
  BuiltPart built_;
  Topology topology_;
  SurfaceTable surfaces_;
  std::vector<Pending> pending_;
  std::vector<double>
      deviations_;  ///< per edge, how far curve, pcurves and vertices were seen to lie from each other
  double size_ = 1;
};

}  // namespace

BuiltPart build_part(const PartSource& source) {
  return PartBuilder(source).run();
}

}  // namespace dupin::reader
