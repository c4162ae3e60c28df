#include "limit_forest.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "jets.h"
#include "limit_basis.h"

namespace dupin {
namespace {

class ForestBuilder {
 public:
  explicit ForestBuilder(CageLevels cage) { forest_.cage = std::move(cage); }

  LimitForest build() {
    const CageLevel& base = forest_.cage.levels[0];
    for (std::uint32_t f = 0; f < base.face_count(); ++f) {
      if (base.hole[f]) {
        forest_.roots.push_back(kNoIndex);
        continue;
      }
      LimitNode root;
      root.face = root.polygon = f;
      forest_.roots.push_back(static_cast<std::uint32_t>(forest_.nodes.size()));
      forest_.nodes.push_back(root);
    }
    // Children are appended behind, so this visits them too.
    for (std::uint32_t i = 0; i < forest_.nodes.size(); ++i) grow(i);
    return std::move(forest_);
  }

 private:
  void grow(std::uint32_t index) {
    LimitNode node = forest_.nodes[index];
    const CageLevel& level = forest_.cage.levels[node.level];
    if (auto patch = regular_patch(level, forest_.corners(), node.face, node.rotation)) {
      node.patch = static_cast<std::uint32_t>(forest_.patches.size());
      forest_.patches.push_back(std::move(*patch));
    } else {
      divide(level, node);
    }
    forest_.nodes[index] = node;
  }

  void divide(const CageLevel& level, LimitNode& node) {
    const auto children = level.children(node.face);
    if (children.empty() || std::find(children.begin(), children.end(), kNoIndex) != children.end()) return;
    node.first_child = static_cast<std::uint32_t>(forest_.nodes.size());
    node.children = static_cast<std::uint32_t>(children.size());
    const int corners = forest_.corners();
    const bool whole = static_cast<int>(level.vertices(node.face).size()) == corners;
    for (int k = 0; k < static_cast<int>(node.children); ++k) {
      // OpenSubdiv's child k is at the face's corner k; a triangle's last is in the middle.
      const bool middle = corners == 3 && k == 3;
      const int of_face = middle || !whole ? k : (k + node.rotation) % corners;
      LimitNode child;
      child.face = children[static_cast<std::size_t>(of_face)];
      child.polygon = node.polygon;
      child.level = static_cast<std::uint8_t>(node.level + 1);
      child.flipped = node.flipped != middle;
      child.rotation = static_cast<std::uint8_t>(middle ? middle_rotation(level, node)
                                                        : rotation_of(node, child, k, whole));
      child.origin = whole ? origin_of(node, k) : Vec2{static_cast<double>(k), 0};
      forest_.nodes.push_back(child);
    }
  }

  /// A polygon's children have its corner first, a quad's or triangle's where the parent has it.
  int rotation_of(const LimitNode& parent, const LimitNode& child, int k, bool whole) const {
    const CageLevel &above = forest_.cage.levels[parent.level], &level = forest_.cage.levels[child.level];
    const auto parents = above.vertices(parent.face);
    const std::size_t corner = static_cast<std::size_t>(k + (whole ? parent.rotation : 0)) % parents.size();
    // The edges that start and end at the parent's corner have children that meet in the child's corner.
    const auto& starts = above.edge_children[above.edges(parent.face)[corner]];
    const auto& ends =
        above.edge_children[above.edges(parent.face)[(corner + parents.size() - 1) % parents.size()]];
    const auto edges = level.edges(child.face);
    const int n = static_cast<int>(edges.size());
    for (int i = 0; i < n; ++i) {
      const std::uint32_t out = edges[static_cast<std::size_t>(i)],
                          in = edges[static_cast<std::size_t>((i + n - 1) % n)];
      if ((out == starts[0] || out == starts[1]) && (in == ends[0] || in == ends[1])) {
        const int local = whole ? k : 0;
        return ((i - local) % n + n) % n;
      }
    }
    return 0;
  }

  /// The middle triangle's first corner lies on the side opposite the parent's first: shared by the children
  /// at 1 and 2.
  int middle_rotation(const CageLevel& above, const LimitNode& parent) const {
    const std::uint32_t middle = above.children(parent.face)[3];
    const CageLevel& level = forest_.cage.levels[parent.level + 1];
    const auto vertices = level.vertices(middle);
    const std::uint32_t opposite =
        above.edges(parent.face)[static_cast<std::size_t>((1 + parent.rotation) % 3)];
    const auto& halves = above.edge_children[opposite];
    if (halves[0] == kNoIndex) return 0;
    const auto &a = level.edge_vertices[halves[0]], &b = level.edge_vertices[halves[1]];
    const std::uint32_t shared = a[0] == b[0] || a[0] == b[1] ? a[0] : a[1];
    return static_cast<int>(std::find(vertices.begin(), vertices.end(), shared) - vertices.begin()) % 3;
  }

  Vec2 origin_of(const LimitNode& node, int k) const {
    const double half = 0.5 * node.size() * (node.flipped ? -1 : 1);
    const bool triangle = forest_.corners() == 3;
    const double s = k == 1 || (k == 2 && !triangle) || (k == 3 && triangle) ? half : 0;
    const double t = k == 2 || k == 3 ? half : 0;
    return node.origin + Vec2{s, t};
  }

  LimitForest forest_;
};

}  // namespace

double LimitNode::size() const {
  return std::ldexp(1.0, -level);
}

std::uint32_t LimitForest::vertex(const LimitNode& node, int corner) const {
  const auto vertices = cage.levels[node.level].vertices(node.face);
  return vertices[static_cast<std::size_t>(corner + node.rotation) % vertices.size()];
}
std::uint32_t LimitForest::edge(const LimitNode& node, int side) const {
  const auto edges = cage.levels[node.level].edges(node.face);
  return edges[static_cast<std::size_t>(side + node.rotation) % edges.size()];
}

LimitForest make_limit_forest(CageLevels cage) {
  return ForestBuilder(std::move(cage)).build();
}

int child_at(int corners, Vec2& local) {
  const bool right = local.x >= 0.5, up = local.y >= 0.5;
  if (corners == 4) {
    local = local * 2 - Vec2{right ? 1.0 : 0.0, up ? 1.0 : 0.0};
    return right ? (up ? 2 : 1) : (up ? 3 : 0);
  }
  if (right || up) {
    local = local * 2 - Vec2{right ? 1.0 : 0.0, right ? 0.0 : 1.0};
    return right ? 1 : 2;
  }
  const bool middle = local.x + local.y > 0.5;
  local = middle ? Vec2{1, 1} - local * 2 : local * 2;
  return middle ? 3 : 0;
}

const LimitNode& leaf_at(const LimitForest& forest, const LimitNode& node, Vec2& local) {
  const LimitNode* at = &node;
  while (!at->leaf())
    at = &forest.nodes[at->first_child + static_cast<std::uint32_t>(child_at(forest.corners(), local))];
  return *at;
}

namespace {

/// The last node at a local corner, and the corner's place in it.
const LimitNode& last_at_corner(const LimitForest& forest, const LimitNode& node, int& corner) {
  const LimitNode* at = &node;
  if (!at->leaf() &&
      static_cast<int>(forest.cage.levels[at->level].vertices(at->face).size()) != forest.corners())
    at = &forest.nodes[at->first_child + static_cast<std::uint32_t>(corner)], corner = 0;
  while (!at->leaf()) at = &forest.nodes[at->first_child + static_cast<std::uint32_t>(corner)];
  return *at;
}

Vec2 corner_parameters(int corners, int corner) {
  if (corners == 3) return {corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0};
  return {corner == 1 || corner == 2 ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0};
}

}  // namespace

Vec3 corner_limit(const LimitForest& forest, const LimitNode& node, int corner) {
  const LimitNode& last = last_at_corner(forest, node, corner);
  if (last.regular())
    return point_of(forest.patches[last.patch], corner_parameters(forest.corners(), corner));
  const std::uint32_t vertex = forest.vertex(last, corner);
  // A face that OpenSubdiv did not refine further has no limits of its own: only with fewer levels than it
  // has rules.
  if (last.level + 1u != forest.cage.levels.size()) return forest.cage.levels[last.level].points[vertex];
  return forest.cage.limits[vertex];
}

Vec3 corner_limit_normal(const LimitForest& forest, const LimitNode& node, int corner) {
  const LimitNode& last = last_at_corner(forest, node, corner);
  Vec3 n;
  if (last.regular()) {
    Vec3 jets[3];
    evaluate_patch(forest.patches[last.patch], corner_parameters(forest.corners(), corner), 1, jets);
    n = cross(jets[1], jets[2]);
  } else if (last.level + 1u == forest.cage.levels.size()) {
    const std::uint32_t vertex = forest.vertex(last, corner);
    n = cross(forest.cage.tangents_u[vertex], forest.cage.tangents_v[vertex]);
  }
  return length(n) > 0 ? normalized(n) : Vec3{};
}

void evaluate_patch(const LimitPatch& patch, Vec2 local, int order, Vec3* jets) {
  const auto n = static_cast<std::size_t>(patch.degree);
  // Differences along both ways first, then sums with Bernstein values, which are positive.
  for (int k = 0; k <= order; ++k)
    for (int b = 0; b <= k; ++b) {
      const auto a = static_cast<std::size_t>(k - b), bb = static_cast<std::size_t>(b);
      std::array<Vec3, 25> d;
      std::copy(patch.poles.begin(), patch.poles.end(), d.begin());
      double factor = 1;
      for (std::size_t r = 0; r < a; ++r, factor *= static_cast<double>(n - r + 1))
        for (std::size_t i = 0; i + r < n; ++i)
          for (std::size_t j = 0; j <= n; ++j)
            d[i * (n + 1) + j] = d[(i + 1) * (n + 1) + j] - d[i * (n + 1) + j];
      for (std::size_t r = 0; r < bb; ++r, factor *= static_cast<double>(n - r + 1))
        for (std::size_t i = 0; i + a <= n; ++i)
          for (std::size_t j = 0; j + r < n; ++j)
            d[i * (n + 1) + j] = d[i * (n + 1) + j + 1] - d[i * (n + 1) + j];
      // De Casteljau.
      for (std::size_t m = n - a; m > 0; --m)
        for (std::size_t i = 0; i < m; ++i)
          for (std::size_t j = 0; j + bb <= n; ++j)
            d[i * (n + 1) + j] = d[i * (n + 1) + j] * (1 - local.x) + d[(i + 1) * (n + 1) + j] * local.x;
      for (std::size_t m = n - bb; m > 0; --m)
        for (std::size_t j = 0; j < m; ++j) d[j] = d[j] * (1 - local.y) + d[j + 1] * local.y;
      jets[jet_index(k - b, b)] = d[0] * factor;
    }
}

Vec3 point_of(const LimitPatch& patch, Vec2 local) {
  Vec3 p;
  evaluate_patch(patch, local, 0, &p);
  return p;
}

namespace {

/// The limit at a place that is a corner of pieces two levels down.
Vec3 quarter_point(const LimitForest& forest, const LimitNode& node, Vec2 local) {
  const LimitNode* at = &node;
  for (int level = 0; level < 2 && !at->leaf(); ++level)
    at = &forest.nodes[at->first_child + static_cast<std::uint32_t>(child_at(forest.corners(), local))];
  if (at->regular()) return point_of(forest.patches[at->patch], local);
  const int corner = forest.corners() == 3 ? (local.x > 0.5   ? 1
                                              : local.y > 0.5 ? 2
                                                              : 0)
                                           : (local.y > 0.5   ? (local.x > 0.5 ? 2 : 3)
                                              : local.x > 0.5 ? 1
                                                              : 0);
  return corner_limit(forest, *at, corner);
}

}  // namespace

LimitPatch interpolant(const LimitForest& forest, const LimitNode& node) {
  if (forest.corners() == 4) {
    constexpr double kAt[4] = {0, 0.25, 0.75, 1};
    std::array<Vec3, 16> values;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) values[4 * i + j] = quarter_point(forest, node, {kAt[i], kAt[j]});
    return bicubic_through(values);
  }
  std::array<Vec3, 25> values{};
  for (std::size_t i = 0; i <= 4; ++i)
    for (std::size_t j = 0; i + j <= 4; ++j)
      values[5 * i + j] =
          quarter_point(forest, node, {static_cast<double>(i) / 4, static_cast<double>(j) / 4});
  return quartic_through(values);
}

}  // namespace dupin
