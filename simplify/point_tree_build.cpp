#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>

#include "../core/parallel.h"
#include "bounding_sphere.h"
#include "leaf_clusters.h"
#include "leaf_points.h"
#include "point_tree_bytes.h"
#include "point_tree_writer.h"
#include "tree_mesh.h"
#include "tree_order.h"

namespace dupin {
namespace {

constexpr std::size_t kGrain = 1024;

/// What a node's parent needs to know of it and its 16 bytes do not say.
struct NodeSums {
  double weight = 0;  ///< area, or 1 for a point without
  Vec3 center;        ///< weighted; in grid steps
  Vec3 normal;        ///< weighted
  std::array<float, 3> color{};

  void add(const NodeSums& s) {
    weight += s.weight;
    center += s.center;
    normal += s.normal;
    for (std::size_t k = 0; k < 3; ++k) color[k] += s.color[k];
  }
  Rgba8 mean_color() const {
    Rgba8 c{0, 0, 0, 255};
    for (std::size_t k = 0; k < 3; ++k)
      c[k] = static_cast<std::uint8_t>(
          std::lround(std::clamp(color[k] / static_cast<float>(weight), 0.0F, 255.0F)));
    return c;
  }
};

PointGrid grid_for(const Box3& box) {
  const Vec3 size = box.size();
  const double extent = std::max({size.x, size.y, size.z});
  PointGrid grid;
  grid.step = extent > 0 ? extent / (kLargestGridCoordinate - 2) : 1;
  grid.origin = box.lo - Vec3{1, 1, 1} * grid.step;
  return grid;
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

/// Bounds of the directions that a node's faces may have.
class ConeBuilder {
 public:
  explicit ConeBuilder(const Vec3& axis) : axis_(axis) {}
  void add(const Vec3& direction, double half_angle = 0) {
    half_angle_ = std::max(half_angle_, angle_between(axis_, direction) + half_angle);
  }
  void add_everything() { half_angle_ = 4; }
  std::uint32_t encoded() const {
    constexpr double kRightAngle = 1.5707963267948966, kRounding = 1e-7;
    return encode_cone(std::sin(half_angle_ + kRounding), half_angle_ + kRounding >= kRightAngle);
  }

 private:
  Vec3 axis_;
  double half_angle_ = 0;
};

/// The symmetric matrix that takes steps in the tangent plane to changes of the normal, by least squares over
/// the children; as curvatures it has the sign turned.
class ShapeFit {
 public:
  explicit ShapeFit(const Vec3& normal) : x_(any_perpendicular(normal)), y_(cross(normal, x_)) {}
  void add(double weight, const Vec3& step, const Vec3& turn) {
    const double x = dot(step, x_), y = dot(step, y_), u = dot(turn, x_), v = dot(turn, y_);
    xx_ += weight * x * x, xy_ += weight * x * y, yy_ += weight * y * y;
    xu_ += weight * x * u, yv_ += weight * y * v, cross_ += weight * (y * u + x * v);
  }
  NodeCurvature curvature(double radius) const {
    const double ridge = 1e-6 * (xx_ + yy_);
    if (!(ridge > 0)) return {};
    // a xx + b xy = xu,  b xy + c yy = yv,  (a + c) xy + b (xx + yy) = yu + xv
    const double xx = xx_ + ridge, yy = yy_ + ridge, both = xx_ + yy_ + ridge;
    const double b =
        (cross_ - xy_ * (xu_ / xx + yv_ / yy)) / std::max(ridge, both - xy_ * xy_ * (1 / xx + 1 / yy));
    const double a = (xu_ - b * xy_) / xx, c = (yv_ - b * xy_) / yy;
    return principal(-a * radius, -b * radius, -c * radius);
  }

 private:
  static NodeCurvature principal(double a, double b, double c) {
    const double mean = 0.5 * (a + c), half = std::hypot(0.5 * (a - c), b);
    const double angle = 0.5 * std::atan2(2 * b, a - c);  // of the larger
    NodeCurvature k{mean + half, mean - half, angle};
    if (std::abs(k.k2) > std::abs(k.k1)) {
      std::swap(k.k1, k.k2);
      k.angle += 1.5707963267948966;
    }
    return k;
  }
  Vec3 x_, y_;
  double xx_ = 0, xy_ = 0, yy_ = 0, xu_ = 0, yv_ = 0, cross_ = 0;
};

class Builder {
 public:
  Builder(const PolygonMesh& mesh, const PointTreeOptions& options) : mesh_(mesh), options_(options) {}

  Result<std::shared_ptr<const PointTree>> run() {
    if (mesh_.empty()) return {StatusCode::unreadable, "a mesh without vertices has no tree"};
    box_ = bounding_box(mesh_);
    if (!(box_.diagonal() < 1e100))
      return {StatusCode::unreadable, "the mesh is too large for numbers to hold"};
    grid_ = grid_for(box_);
    kind_ = mesh_.polygon_count() == 0 ? PointTreeKind::qsplat : options_.kind;
    for (const auto stage : {&Builder::take_mesh, &Builder::make_leaves, &Builder::order_leaves,
                             &Builder::fill_leaves, &Builder::fill_interior, &Builder::fill_blocks}) {
      if (!report(options_.progress, "building the point tree", done_)) return {StatusCode::cancelled, ""};
      (this->*stage)();
      done_ += 1.0 / 6;
    }
    return write();
  }

 private:
  bool pop() const { return kind_ == PointTreeKind::pop; }

  void take_mesh() {
    source_.emplace(mesh_);
    colors_ = source_->has_colors();
    places_.resize(mesh_.positions.size());
    parallel_for(
        places_.size(),
        [&](std::size_t i) { places_[i] = rounded_to_grid(grid_.to_grid(mesh_.positions[i])); }, 8 * kGrain);
  }

  void make_leaves() {
    if (pop()) {
      clusters_ = cluster_triangles(*source_);
    } else {
      points_ = leaf_points(*source_, places_);
    }
  }

  void order_leaves() {
    const std::size_t count = pop() ? clusters_.size() : points_.size();
    std::vector<Vec3> centers(count);
    parallel_for(
        count,
        [&](std::size_t i) { centers[i] = pop() ? cluster_center(clusters_[i]) : points_[i].sphere.center; },
        kGrain);
    shape_ = TreeShape(count);
    order_ = tree_order(shape_, centers);
  }

  Vec3 cluster_center(const LeafCluster& cluster) const {
    Box3 box;
    for (std::uint32_t i = 0; i < cluster.size; ++i)
      for (int k = 0; k < 3; ++k) box.add(places_[source_->vertex(cluster.triangles[i], k)]);
    return box.center();
  }

  void fill_leaves() {
    nodes_.resize(shape_.nodes());
    sums_.resize(shape_.nodes());
    parallel_for(
        shape_.leaves(),
        [&](std::size_t rank) {
          const std::uint64_t node = shape_.leaf_node(rank);
          nodes_[node] = pop() ? triangle_leaf(clusters_[order_[rank]], sums_[node])
                               : point_leaf(points_[order_[rank]], sums_[node]);
        },
        kGrain);
    if (!mesh_.polygon_groups.empty()) find_groups();
  }

  EncodedNode triangle_leaf(const LeafCluster& cluster, NodeSums& sums) const {
    std::vector<Sphere> circles, corners;
    std::vector<Vec3> face_normals;
    for (std::uint32_t i = 0; i < cluster.size; ++i) {
      const std::uint32_t t = cluster.triangles[i];
      const auto p = [&](int k) { return places_[source_->vertex(t, k)]; };
      circles.push_back(triangle_sphere(p(0), p(1), p(2)));
      for (int k = 0; k < 3; ++k) corners.push_back({p(k), 0});
      face_normals.push_back(cross(p(1) - p(0), p(2) - p(0)));
      sums.add(triangle_sums(t, length(face_normals.back())));
    }
    const Vec3 center = tightened_sphere(sphere_of_spheres(circles).center, corners).center;
    PointNode node;
    node.center = rounded_to_grid(center);
    node.radius = radius_around(node.center, corners);
    node.normal = decode_normal(encode_normal(normalized(sums.normal)));
    node.triangles = cluster.size;
    ConeBuilder cone(node.normal);
    for (const Vec3& n : face_normals)
      if (length(n) > 0) cone.add(n);
    if (!source_->closed[cluster.triangles[0]]) cone.add_everything();
    node.cone = cone.encoded();
    if (colors_) node.color = encode_color(sums.mean_color());
    return encode(node);
  }

  NodeSums triangle_sums(std::uint32_t triangle, double area) const {
    NodeSums s;
    s.weight = area > 0 ? area : 1e-3;  // a degenerate one still has a place, a normal and a colour
    for (int k = 0; k < 3; ++k) {
      s.center += places_[source_->vertex(triangle, k)];
      const auto& n = source_->normals[source_->corners[triangle][static_cast<std::size_t>(k)]];
      s.normal += Vec3{n[0], n[1], n[2]};
      if (!colors_) continue;
      const Rgba8 c = source_->color(triangle, k);
      for (std::size_t i = 0; i < 3; ++i) s.color[i] += c[i];
    }
    s.center = s.center * (s.weight / 3), s.normal = s.normal * (s.weight / 3);
    for (float& c : s.color) c *= static_cast<float>(s.weight / 3);
    return s;
  }

  EncodedNode point_leaf(const LeafPoint& point, NodeSums& sums) const {
    sums.weight = point.weight;
    sums.center = point.sphere.center * point.weight;
    sums.normal = point.normal * point.weight;
    for (std::size_t k = 0; k < 3; ++k) sums.color[k] = static_cast<float>(point.weight * point.color[k]);
    PointNode node;
    node.center = rounded_to_grid(point.sphere.center);
    node.radius = point.sphere.radius + distance(node.center, point.sphere.center);
    node.normal = decode_normal(encode_normal(point.normal));
    ConeBuilder cone(node.normal);
    cone.add(point.cone_axis, point.cone_half_angle);
    node.cone = cone.encoded();
    if (colors_) node.color = encode_color(point.color);
    return encode(node);
  }

  void find_groups() {
    leaf_groups_.resize(shape_.leaves());
    for (std::size_t rank = 0; rank < leaf_groups_.size(); ++rank)
      leaf_groups_[rank] =
          pop() ? source_->group(clusters_[order_[rank]].triangles[0]) : points_[order_[rank]].group;
  }

  /// Level by level from the deepest: children lie behind their parents.
  void fill_interior() {
    if (pop()) curvatures_.resize(shape_.interior());
    std::vector<std::uint64_t> firsts{0};
    while (TreeShape::first_child(firsts.back()) < shape_.nodes())
      firsts.push_back(TreeShape::first_child(firsts.back()));
    for (std::size_t level = firsts.size(); level-- > 0;) {
      const std::uint64_t first = firsts[level];
      const std::uint64_t last =
          std::min(shape_.interior(), level + 1 < firsts.size() ? firsts[level + 1] : first + 1);
      if (first < last)
        parallel_for(
            last - first, [&](std::size_t i) { fill_node(first + i); }, kGrain / 4);
    }
  }

  void fill_node(std::uint64_t index) {
    const std::uint64_t first = TreeShape::first_child(index), count = shape_.child_count(index);
    NodeSums& sums = sums_[index];
    std::array<Sphere, 4> spheres;
    for (std::uint64_t k = 0; k < count; ++k) {
      sums.add(sums_[first + k]);
      spheres[k] = {node_center(nodes_[first + k]), node_radius(nodes_[first + k])};
    }
    const std::span children(spheres.data(), count);
    PointNode node;
    node.center = rounded_to_grid(sphere_of_spheres(children).center);
    node.radius = radius_around(node.center, children) * (1 + kNesting);
    node.normal = decode_normal(encode_normal(normalized(sums.normal)));
    ConeBuilder cone(node.normal);
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::uint32_t child = node_cone(nodes_[first + k]);
      if (child == kNoCone)
        cone.add_everything();
      else
        cone.add(node_normal(nodes_[first + k]), std::asin(decode_cone_sine(child)) + kNesting);
    }
    node.cone = cone.encoded();
    if (colors_) node.color = encode_color(sums.mean_color());
    nodes_[index] = encode(node);
    if (pop())
      curvatures_[index] = encode_curvature(curvature(index, decode_radius(encode_radius(node.radius))));
  }

  NodeCurvature curvature(std::uint64_t index, double radius) const {
    const std::uint64_t first = TreeShape::first_child(index), count = shape_.child_count(index);
    const NodeSums& whole = sums_[index];
    const Vec3 center = whole.center / whole.weight, normal = normalized(whole.normal);
    ShapeFit fit(node_normal(nodes_[index]));
    for (std::uint64_t k = 0; k < count; ++k) {
      const NodeSums& s = sums_[first + k];
      fit.add(s.weight, s.center / s.weight - center, normalized(s.normal) - normal);
    }
    return fit.curvature(radius);
  }

  void fill_blocks() {
    if (!pop()) return;
    blocks_.resize((shape_.leaves() + kBlockLeaves - 1) / kBlockLeaves);
    parallel_for(
        blocks_.size(), [&](std::size_t i) { blocks_[i] = block_bytes(i); }, 4);
  }

  std::string block_bytes(std::size_t index) const {
    BlockBuilder builder(colors_);
    const std::size_t first = index * kBlockLeaves,
                      last = std::min<std::size_t>(first + kBlockLeaves, shape_.leaves());
    for (std::size_t rank = first; rank < last; ++rank) {
      const LeafCluster& cluster = clusters_[order_[rank]];
      std::array<std::array<BlockVertex, 3>, kMostLeafTriangles> triangles;
      for (std::uint32_t i = 0; i < cluster.size; ++i)
        for (int k = 0; k < 3; ++k)
          triangles[i][static_cast<std::size_t>(k)] = corner(cluster.triangles[i], k);
      builder.add_leaf({triangles.data(), cluster.size});
    }
    return builder.bytes();
  }

  BlockVertex corner(std::uint32_t triangle, int k) const {
    const Vec3& p = places_[source_->vertex(triangle, k)];
    const auto& n = source_->normals[source_->corners[triangle][static_cast<std::size_t>(k)]];
    BlockVertex v;
    for (int i = 0; i < 3; ++i) v.position[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(p[i]);
    v.normal = encode_normal({n[0], n[1], n[2]});
    if (colors_) v.color = source_->color(triangle, k), v.color[3] = 255;
    return v;
  }

  Result<std::shared_ptr<const PointTree>> write() const {
    PointTreeContent content;
    content.kind = kind_, content.source = options_.source, content.colors = colors_;
    content.grid = grid_, content.box = box_;
    content.triangles = pop() ? source_->size() : 0;
    content.nodes = nodes_, content.curvatures = curvatures_, content.leaf_groups = leaf_groups_;
    content.leaves = shape_.leaves();
    // Colours of groups say that vertices and polygons have none.
    std::vector<MeshGroup> groups = mesh_.groups;
    if (!mesh_.colors.empty() || !mesh_.polygon_colors.empty())
      for (MeshGroup& group : groups) group.color.reset();
    content.groups = &groups;
    content.blocks = &blocks_;
    content.leaf_triangles = [this](std::uint64_t rank) {
      return node_triangles(nodes_[shape_.leaf_node(rank)]);
    };
    return PointTree::from_bytes(std::make_shared<OwnedBytes>(point_tree_bytes(content), true));
  }

  /// Bounds of parents contain those of their children by this much more than rounding could take away, so
  /// that what is decided for a node follows from what is decided for its children.
  static constexpr double kNesting = 1e-9;

  const PolygonMesh& mesh_;
  const PointTreeOptions& options_;
  PointTreeKind kind_{};
  double done_ = 0;
  Box3 box_;
  PointGrid grid_;
  bool colors_ = false;
  std::optional<TreeMesh> source_;
  std::vector<Vec3> places_;  ///< each vertex on the grid
  std::vector<LeafCluster> clusters_;
  std::vector<LeafPoint> points_;
  TreeShape shape_;
  std::vector<std::uint32_t> order_;  ///< the leaf of each rank
  std::vector<EncodedNode> nodes_;
  std::vector<NodeSums> sums_;
  std::vector<std::uint32_t> curvatures_, leaf_groups_;
  std::vector<std::string> blocks_;
};

}  // namespace

Result<std::shared_ptr<const PointTree>> build_point_tree(const PolygonMesh& mesh,
                                                          const PointTreeOptions& options) {
  return Builder(mesh, options).run();
}

}  // namespace dupin
