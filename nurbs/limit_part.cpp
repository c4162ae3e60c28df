#include "limit_part.h"

#include <algorithm>

#include "bezier.h"
#include "limit_basis.h"

namespace dupin {
namespace {

/// One piece of the surface on its way to a face.
struct Piece {
  std::uint32_t node = 0;
  const LimitPatch* patch = nullptr;
  const LimitCap* cap = nullptr;
};

/// Which edges of every level are sides of pieces, and which of those a finer neighbour has in two.
class EdgeUse {
 public:
  EdgeUse(const LimitForest& forest, const std::vector<Piece>& pieces) : forest_(forest) {
    for (const CageLevel& level : forest.cage.levels) used_.emplace_back(level.edge_vertices.size(), 0);
    for (const Piece& piece : pieces) {
      const LimitNode& node = forest.nodes[piece.node];
      for (int side = 0; side < forest.corners(); ++side) used_[node.level][forest.edge(node, side)] |= kOwn;
    }
    for (std::size_t l = used_.size() - 1; l-- > 0;)
      for (std::size_t e = 0; e < used_[l].size(); ++e)
        for (std::uint32_t child : forest.cage.levels[l].edge_children[e])
          if (child != kNoIndex && used_[l + 1][child]) used_[l][e] |= kBelow;
  }

  bool is_split(std::size_t level, std::uint32_t edge) const { return used_[level][edge] & kBelow; }

 private:
  static constexpr std::uint8_t kOwn = 1, kBelow = 2;
  const LimitForest& forest_;
  std::vector<std::vector<std::uint8_t>> used_;
};

/// Part of a side: an edge over [t0, t1] of the side, which it runs along or against.
struct SidePart {
  std::size_t level = 0;
  std::uint32_t edge = 0;
  bool forward = true;
  double t0 = 0, t1 = 1;
};

void collect_parts(const LimitForest& forest, const EdgeUse& use, SidePart part, std::vector<SidePart>& out) {
  if (!use.is_split(part.level, part.edge)) {
    out.push_back(part);
    return;
  }
  const auto& children = forest.cage.levels[part.level].edge_children[part.edge];
  const CageLevel& below = forest.cage.levels[part.level + 1];
  const auto &a = below.edge_vertices[children[0]], &b = below.edge_vertices[children[1]];
  const std::uint32_t middle_vertex = a[0] == b[0] || a[0] == b[1] ? a[0] : a[1];
  const double middle = 0.5 * (part.t0 + part.t1);
  SidePart first{part.level + 1, children[part.forward ? 0 : 1], true, part.t0, middle},
      second{part.level + 1, children[part.forward ? 1 : 0], true, middle, part.t1};
  first.forward = below.edge_vertices[first.edge][1] == middle_vertex;
  second.forward = below.edge_vertices[second.edge][0] == middle_vertex;
  collect_parts(forest, use, first, out);
  collect_parts(forest, use, second, out);
}

std::vector<double> bezier_knots(int degree, double lo, double hi) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, lo);
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, hi);
  return knots;
}

/// Poles of a triangle's third side: of the polynomial along s + t = 1, from (1,0) to (0,1).
std::vector<Vec3> slanted_side(const LimitPatch& patch) {
  std::array<Vec3, 5> values;
  for (std::size_t i = 0; i <= 4; ++i) {
    const double t = static_cast<double>(i) / 4;
    values[i] = point_of(patch, {1 - t, t});
  }
  const auto poles = quartic_curve_through(values);
  return {poles.begin(), poles.end()};
}

std::vector<Vec3> side_poles(const LimitPatch& patch, int corners, int side) {
  const auto n = static_cast<std::size_t>(patch.degree);
  if (corners == 3 && side == 1) return slanted_side(patch);
  std::vector<Vec3> poles;
  for (std::size_t k = 0; k <= n; ++k) {
    const std::size_t back = n - k;
    if (side == 0) poles.push_back(patch.poles[k * (n + 1)]);
    if (side == 1) poles.push_back(patch.poles[n * (n + 1) + k]);
    if (side == 2 && corners == 4) poles.push_back(patch.poles[back * (n + 1) + n]);
    if (side == corners - 1) poles.push_back(patch.poles[back]);
  }
  return poles;
}

Vec2 corner_of_domain(const LimitNode& node, int corners, int corner) {
  const double h = node.size() * (node.flipped ? -1 : 1);
  const bool right = corner == 1 || (corner == 2 && corners == 4),
             up = corners == 4 ? corner >= 2 : corner == 2;
  return node.origin + Vec2{right ? h : 0, up ? h : 0};
}

class PartBuilder {
 public:
  PartBuilder(const LimitForest& forest, const PolygonMesh& cage, std::vector<Piece> pieces)
      : forest_(forest), cage_(cage), pieces_(std::move(pieces)), use_(forest, pieces_) {
    for (const CageLevel& level : forest.cage.levels)
      edges_.emplace_back(level.edge_vertices.size(), kNoIndex);
  }

  Part build() {
    for (const Piece& piece : pieces_) add_edges(piece);
    for (const Piece& piece : pieces_) add_face(piece);
    mark_borders();
    return std::move(part_);
  }

 private:
  SidePart whole_side(const LimitNode& node, int side) const {
    SidePart part;
    part.level = node.level;
    part.edge = forest_.edge(node, side);
    part.forward = forest_.cage.levels[node.level].edge_vertices[part.edge][0] == forest_.vertex(node, side);
    return part;
  }

  /// The curves of sides that no neighbour has in two.
  void add_edges(const Piece& piece) {
    const LimitNode& node = forest_.nodes[piece.node];
    for (int side = 0; side < forest_.corners(); ++side) {
      const SidePart part = whole_side(node, side);
      std::uint32_t& index = edges_[part.level][part.edge];
      if (index != kNoIndex || use_.is_split(part.level, part.edge)) continue;
      index = static_cast<std::uint32_t>(part_.edges.size());
      Bspline3 curve;
      curve.degree = piece.patch->degree;
      curve.knots = bezier_knots(curve.degree, 0, 1);
      curve.poles = side_poles(*piece.patch, forest_.corners(), side);
      if (!part.forward) std::reverse(curve.poles.begin(), curve.poles.end());
      Edge edge;
      edge.curve = Curve3{std::move(curve)};
      edge.t1 = 1;
      edge.smooth = forest_.cage.levels[part.level].edge_faces[part.edge][0] != kNoIndex;
      part_.edges.push_back(std::move(edge));
    }
  }

  Loop loop_of(const LimitNode& node) const {
    Loop loop;
    const int corners = forest_.corners();
    std::vector<SidePart> parts;
    for (int side = 0; side < corners; ++side) {
      const Vec2 a = corner_of_domain(node, corners, side),
                 b = corner_of_domain(node, corners, (side + 1) % corners);
      parts.clear();
      collect_parts(forest_, use_, whole_side(node, side), parts);
      for (const SidePart& part : parts) {
        Trim trim;
        trim.edge = edges_[part.level][part.edge];
        trim.reversed = !part.forward;
        const Vec2 from = a + (b - a) * part.t0, to = a + (b - a) * part.t1;
        trim.pcurve = Curve2{part.forward ? LineOf<Vec2>{from, to - from} : LineOf<Vec2>{to, from - to}};
        loop.push_back(std::move(trim));
      }
    }
    return loop;
  }

  BsplineSurface surface_of(const LimitNode& node, const LimitPatch& patch) const {
    const double h = node.size();
    const Vec2 lo = node.flipped ? node.origin - Vec2{h, h} : node.origin;
    BsplineSurface s;
    s.degree_u = s.degree_v = patch.degree;
    s.count_u = s.count_v = patch.degree + 1;
    s.knots_u = bezier_knots(patch.degree, lo.x, lo.x + h);
    s.knots_v = bezier_knots(patch.degree, lo.y, lo.y + h);
    s.poles = patch.poles;
    if (node.flipped) std::reverse(s.poles.begin(), s.poles.end());
    return s;
  }

  void add_face(const Piece& piece) {
    const LimitNode& node = forest_.nodes[piece.node];
    Face face;
    face.surface = static_cast<std::uint32_t>(part_.surfaces.size());
    Surface surface{surface_of(node, *piece.patch)};
    const double h = node.size();
    face.uv_box.lo = node.flipped ? node.origin - Vec2{h, h} : node.origin;
    face.uv_box.hi = face.uv_box.lo + Vec2{h, h};
    face.loops.push_back(loop_of(node));
    const std::uint32_t polygon = forest_.cage.polygons[node.polygon];
    if (!cage_.groups.empty()) face.color = cage_.groups[cage_.group_of(polygon)].color;
    if (piece.cap)
      face.recognized = std::make_shared<RecognizedSurface>(
          RecognizedSurface{surface, piece.cap->deviation, piece.cap->normal_deviation});
    part_.surfaces.push_back(std::move(surface));
    part_.faces.push_back(std::move(face));
  }

  /// Where the surface ends, at a hole too.
  void mark_borders() {
    std::vector<std::uint8_t> uses(part_.edges.size(), 0);
    for (const Face& face : part_.faces)
      for (const Trim& trim : face.loops[0])
        uses[trim.edge] = static_cast<std::uint8_t>(std::min(uses[trim.edge] + 1, 2));
    for (std::size_t e = 0; e < uses.size(); ++e)
      if (uses[e] < 2) part_.edges[e].smooth = false;
  }

  const LimitForest& forest_;
  const PolygonMesh& cage_;
  std::vector<Piece> pieces_;
  EdgeUse use_;
  std::vector<std::vector<std::uint32_t>> edges_;  ///< the Part's edge, by level and edge
  Part part_;
};

/// In the order of polygons: pieces of one polygon are neighbours in the list.
std::vector<Piece> pieces_of(const LimitForest& forest, const LimitCover& cover) {
  std::vector<Piece> pieces;
  for (std::uint32_t node : cover.regular)
    pieces.push_back({node, &forest.patches[forest.nodes[node].patch], nullptr});
  for (const LimitCap& cap : cover.caps) pieces.push_back({cap.node, &cap.patch, &cap});
  std::sort(pieces.begin(), pieces.end(), [&](const Piece& a, const Piece& b) {
    const LimitNode &na = forest.nodes[a.node], &nb = forest.nodes[b.node];
    return na.polygon != nb.polygon ? na.polygon < nb.polygon : a.node < b.node;
  });
  return pieces;
}

/// Of a triangle s + t <= 1 only what is near it: beyond, the polynomial may go anywhere.
void add_triangle(const LimitPatch& patch, Box3& box) {
  const BezierPatch whole = to_bezier(patch);
  for (const Box2& near : squares_of_triangle())
    for (const Vec4& pole : subpatch(whole, near.lo.x, near.hi.x, near.lo.y, near.hi.y).poles)
      box.add(Vec3{pole.x, pole.y, pole.z});
}

/// The limit's own, which is the same for any choice of pieces: caps are within their deviation of it.
Box3 box_of(const LimitForest& forest) {
  constexpr int kLargeTriangles = 3;  // levels
  Box3 box;
  for (const LimitNode& node : forest.nodes) {
    if (!node.leaf()) continue;
    if (!node.regular()) {
      for (int corner = 0; corner < forest.corners(); ++corner) box.add(corner_limit(forest, node, corner));
    } else if (const LimitPatch& patch = forest.patches[node.patch];
               patch.degree == 4 && node.level <= kLargeTriangles) {
      add_triangle(patch, box);
    } else {
      for (const Vec3& pole : patch.poles) box.add(pole);
    }
  }
  return box;
}

std::vector<std::uint32_t> faces_by_node(const LimitForest& forest, const std::vector<Piece>& pieces) {
  std::vector<std::uint32_t> face_of(forest.nodes.size(), kNoIndex);
  for (std::size_t i = 0; i < pieces.size(); ++i) face_of[pieces[i].node] = static_cast<std::uint32_t>(i);
  // Children stand behind their parents.
  for (const LimitNode& node : forest.nodes) {
    const std::uint32_t own = face_of[static_cast<std::size_t>(&node - forest.nodes.data())];
    for (std::uint32_t c = 0; c < node.children && own != kNoIndex; ++c) face_of[node.first_child + c] = own;
  }
  // What is in several faces counts as the first one's.
  for (std::size_t i = forest.nodes.size(); i-- > 0;)
    if (face_of[i] == kNoIndex && !forest.nodes[i].leaf()) face_of[i] = face_of[forest.nodes[i].first_child];
  return face_of;
}

}  // namespace

Part make_limit_part(const LimitForest& forest, const PolygonMesh& cage, double diagonal,
                     const LimitPartOptions& options) {
  // Every piece has triangles: none is smaller than they are.
  const bool triangles = options.segments_per_edge > 0;
  const int levels = triangles ? tessellation_levels(cage, options.segments_per_edge, options.most_triangles)
                               : kMaxSubdivisionLevels;
  const LimitCover cover = make_cover(forest, diagonal, options, levels);
  const std::vector<Piece> pieces = pieces_of(forest, cover);
  Part part = PartBuilder(forest, cage, pieces).build();
  part.box = box_of(forest);
  if (triangles) part.mesh = tessellate_limit(forest, cage, faces_by_node(forest, pieces), levels);
  return part;
}

}  // namespace dupin
