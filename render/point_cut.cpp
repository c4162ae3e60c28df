#include "point_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../core/parallel.h"

namespace dupin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Subtrees that are walked on their own, and trees that are not worth being taken apart.
constexpr std::uint64_t kChunks = 256, kSmallTree = 4096;
/// Subtrees that one task walks.
constexpr std::size_t kChunksAtOnce = 8;
/// Normals within this (the sine of the angle) of perpendicular to the view are a silhouette's.
constexpr double kSilhouetteSine = 0.17;
/// Beyond this an angle's slack would have to think of how fast a sphere grows to the eye.
constexpr double kNearRatio = 0.45;
/// Slacks keep this far from what rounding could change.
constexpr double kSafety = 0.999, kRounding = 1e-9;
/// Fronts are begun anew when motions have become too large for the entries' floats.
constexpr double kMostMotion = 1e4;

double plane_at(const Plane3& plane, const Vec3& p) {
  return dot(plane.n, p) + plane.d;
}

/// From one plane to another.
class PlaneChange {
 public:
  PlaneChange(const Plane3& a, const Plane3& b) : a_(a), b_(b), turn_(length(a.n - b.n)) {}
  /// The most by which the value can have changed within a sphere.
  double within(const Vec3& center, double radius) const {
    return std::abs(plane_at(a_, center) - plane_at(b_, center)) + radius * turn_;
  }

 private:
  const Plane3 &a_, &b_;
  double turn_;
};

/// By how much a placement stretches what it stretches most.
double largest_stretch(const Mat3& m) {
  double largest = 0;
  for (Vec3 v : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    for (int i = 0; i < 30; ++i) v = normalized(transpose_times(m, m * v));
    largest = std::max(largest, length(m * v));
  }
  return largest * (1 + 1e-9);
}

/// How far an eye at the distance l from a sphere's centre may move before the angle at which it sees the
/// centre, and the one that the sphere subtends (of the sine `ratio`), change by `angle` together. Up to the
/// way w both turn by no more than (1 + 5 ratio) ∫ dw / (l − w), as long as the ratio stays below 0.6 and l −
/// w above l / 4.
double way_for(double angle, double l, double ratio) {
  const double rate = 1 + 5 * ratio;
  const double way = l * angle / (rate + angle);
  return std::min({way, 0.75 * l, l * (1 - ratio / 0.6)});
}

Plane3 to_grid(const Plane3& plane, const PointGrid& grid, const Vec3& anchor) {
  return {plane.n * grid.step, dot(plane.n, grid.origin - anchor) + plane.d};
}

bool same(const CutOptions& a, const CutOptions& b) {
  return a.threshold_px == b.threshold_px && a.silhouette == b.silhouette &&
         a.leaves_as_points == b.leaves_as_points;
}

}  // namespace

CutView cut_view(const PartCamera& camera, const SceneInstance& instance, const ViewRays& view,
                 const PointGrid& grid, const Vec3& anchor, const CutOptions& options) {
  CutView cut;
  for (std::size_t i = 0; i < 4; ++i) {
    const Plane3 plane = to_grid(camera.sides.planes[i], grid, anchor);
    cut.sides[i] = {plane.n / grid.step, plane.d / grid.step};
  }
  cut.depth = to_grid(camera.depth, grid, anchor);
  cut.perspective = camera.perspective;
  cut.eye = camera.perspective ? grid.to_grid(camera.eye + anchor) : normalized(camera.eye);
  cut.pixels_per_step = grid.step * largest_stretch(instance.to_world.linear) / pixel_size(view, 1);
  cut.options = options;
  return cut;
}

PointCut::PointCut(std::shared_ptr<const PointTree> tree)
    : tree_(std::move(tree)), trusted_nodes_(tree_->trusted_nodes()) {
  std::uint64_t width = 1;
  const TreeShape& shape = tree_->shape();
  if (shape.nodes() > kSmallTree)
    while (width < kChunks) first_chunk_ = TreeShape::first_child(first_chunk_), width *= 4;
  chunk_count_ = static_cast<std::size_t>(width);
  chunks_.resize(chunk_count_);
  for (std::size_t i = 0; i < chunk_count_; ++i) chunks_[i].root = first_chunk_ + i;
}

PointCut::Decision PointCut::decide(const EncodedNode& node, bool leaf) const {
  const Vec3 c = node_center(node);
  const double r = node_radius(node);
  Decision d{false, State::culled, {kInfinity, kInfinity, kInfinity}};

  double side = kInfinity;
  for (const Plane3& plane : view_.sides) side = std::min(side, plane_at(plane, c));
  d.slack.side = std::abs(side + r);
  if (side < -r) return d;

  bool silhouette = false;
  const std::uint32_t cone = node_cone(node);
  const bool whole = cone == kNoCone;
  if (view_.options.silhouette || (view_.cull_turned_away && !whole)) {
    const Vec3 to_eye = view_.perspective ? view_.eye - c : view_.eye;
    const double l = length(to_eye), ratio = view_.perspective ? r / l : 0;
    if (!(ratio < kNearRatio)) {
      d.slack.eye = 0;
      silhouette = view_.options.silhouette;
    } else {
      // All normals are turned away if the angle to the axis is at least 90° + the cone's + what the sphere
      // subtends.
      const double sine = whole ? 1 : decode_cone_sine(cone), cosine = std::sqrt(1 - sine * sine);
      const double across = std::sqrt(1 - ratio * ratio);
      const double sum_sine = sine * across + cosine * ratio, sum_cosine = cosine * across - sine * ratio;
      const double turn = dot(node_normal(node), to_eye) / l;
      double angle = sum_cosine > 0 ? std::abs(turn + sum_sine) : -sum_cosine;
      if (whole && !view_.options.silhouette) angle = kInfinity;
      const bool turned_away = view_.cull_turned_away && sum_cosine > 0 && turn < -sum_sine;
      if (view_.options.silhouette) {
        // Some normal may be less than the silhouette's angle away from perpendicular, or turned away.
        silhouette = !(sum_cosine > 0) || turn < sum_sine + kSilhouetteSine;
        angle = whole ? kInfinity : std::min(angle, std::abs(turn - sum_sine - kSilhouetteSine));
      }
      d.slack.eye = view_.perspective ? way_for(angle, l, ratio) : angle;
      if (turned_away) {
        d.slack.side = kInfinity;
        return d;
      }
    }
  }

  bool large;
  if (view_.perspective) {
    // The nearest depth of the sphere decides: then children are never larger than their parents.
    const double depth = plane_at(view_.depth, c) - r * length(view_.depth.n);
    const double least = 2 * r * view_.pixels_per_step / view_.options.threshold_px;
    large = depth < least;
    d.slack.depth = std::abs(depth - least);
  } else {
    large = 2 * r * view_.pixels_per_step > view_.options.threshold_px;
  }
  if (leaf) {
    const bool points = tree_->info().kind == PointTreeKind::qsplat ||
                        (view_.options.leaves_as_points && !large && !silhouette);
    d.state = points ? State::point : State::triangles;
    return d;
  }
  d.open = large || silhouette;
  d.state = State::point;
  return d;
}

/// The walk of one chunk. Depth-first, front to next front.
class PointCut::Walk {
 public:
  Walk(const PointCut& cut, Chunk& chunk) : cut_(cut), shape_(cut.tree_->shape()), chunk_(chunk) {
    const double scale = kLargestGridCoordinate;
    rounding_ = {kRounding * (std::abs(cut.view_.depth.d) + scale * length(cut.view_.depth.n)),
                 kRounding * scale, kRounding * scale};
  }

  void fresh() {
    chunk_.motion = {0, 0, 0};
    go_down(chunk_.root, cut_.node_at(chunk_.root), kNoParent);
    finish(true);
  }

  void coherent() {
    const std::vector<Entry>& front = chunk_.front;
    find_due();
    bool changed = false;
    std::size_t i = 0;
    for (std::size_t k = 0; k < chunk_.due.size(); ++k) {
      if (k + kAhead < chunk_.due.size()) fetch(front[chunk_.due[k + kAhead]].node);
      const std::size_t due = chunk_.due[k];
      if (due < i) continue;  // something above stands for it
      keep(i, due);
      const Entry& e = front[due];
      const std::uint64_t top = look_again(e, changed);
      i = due + 1;
      if (top != e.node)
        while (i < front.size() && TreeShape::is_below(front[i].node, top)) ++i;
    }
    keep(i, front.size());
    finish(changed);
  }

 private:
  /// Entries that wait for memory while others are looked at.
  static constexpr std::size_t kAhead = 8;

  void find_due() {
    const std::vector<Entry>& front = chunk_.front;
    std::size_t count = 0;
    chunk_.due.resize(front.size());
    for (std::size_t i = 0; i < front.size(); ++i) {
      chunk_.due[count] = static_cast<std::uint32_t>(i);
      count += is_due(front[i]);
    }
    chunk_.due.resize(count);
  }
  void keep(std::size_t first, std::size_t last) {
    const auto at = [&](std::size_t i) { return chunk_.front.begin() + static_cast<std::ptrdiff_t>(i); };
    chunk_.next.insert(chunk_.next.end(), at(first), at(last));
  }
  void fetch(std::uint64_t node) const {
    if (!cut_.trusted_nodes_) return;
    __builtin_prefetch(cut_.trusted_nodes_ + node);
    if (node > 0) __builtin_prefetch(cut_.trusted_nodes_ + TreeShape::parent(node));
  }

  /// Until which motions a node's parent is certainly open. Culling does not count: where a parent is culled
  /// all its children are, and draw as little themselves.
  struct ParentDue {
    float depth, eye;
  };
  static constexpr ParentDue kNoParent{std::numeric_limits<float>::infinity(),
                                       std::numeric_limits<float>::infinity()};

  /// Without branches: which of the three it is cannot be foreseen.
  bool is_due(const Entry& e) const {
    return static_cast<int>(e.depth < chunk_.motion.depth) | static_cast<int>(e.side < chunk_.motion.side) |
           static_cast<int>(e.eye < chunk_.motion.eye);
  }
  bool silhouette() const { return cut_.view_.options.silhouette; }

  Decision look(std::uint64_t node, const EncodedNode& encoded) {
    ++chunk_.visited;
    return cut_.decide(encoded, shape_.is_leaf(node));
  }

  /// Puts what now stands for an entry into the next front, and says for which node that stands: this one or
  /// one above it.
  std::uint64_t look_again(const Entry& e, bool& changed) {
    const bool parent_due = e.depth < chunk_.motion.depth || (silhouette() && e.eye < chunk_.motion.eye);
    if (parent_due && !parent_open(e.node)) return close(e.node, changed);
    const EncodedNode encoded = cut_.node_at(e.node);
    const Decision d = look(e.node, encoded);
    // Culled nodes may be put together again: fronts must not only grow.
    if (!d.open && d.state == State::culled && !parent_due && !parent_open(e.node))
      return close(e.node, changed);
    const bool parent_known = parent_due || (!d.open && d.state == State::culled);
    const ParentDue parent = parent_known ? parent_due_of(e.node) : ParentDue{e.depth, e.eye};
    changed = changed || d.open || static_cast<State>(e.state) != d.state;
    if (d.open)
      go_into(e.node, d, parent);
    else
      push(e.node, d, parent);
    return e.node;
  }

  bool parent_open(std::uint64_t node) {
    if (node == chunk_.root) return true;
    const std::uint64_t parent = TreeShape::parent(node);
    if (parent != parent_) parent_ = parent, parent_decision_ = look(parent, cut_.node_at(parent));
    return parent_decision_.open;
  }

  /// Of a node whose parent has just been found open.
  ParentDue parent_due_of(std::uint64_t node) const {
    return node == chunk_.root ? kNoParent : due_as_parent(parent_decision_);
  }

  /// A node's parent is not open any more: the highest such node stands for all below it.
  std::uint64_t close(std::uint64_t node, bool& changed) {
    Decision closed{};
    while (!parent_open(node)) closed = parent_decision_, node = TreeShape::parent(node);
    changed = true;
    // Of a culled one some children may not have been due, since they had been culled before.
    while (!chunk_.next.empty() && TreeShape::is_below(chunk_.next.back().node, node)) chunk_.next.pop_back();
    push(node, closed, parent_due_of(node));
    return node;
  }

  void go_down(std::uint64_t node, const EncodedNode& encoded, const ParentDue& parent) {
    const Decision d = look(node, encoded);
    if (d.open)
      go_into(node, d, parent);
    else
      push(node, d, parent);
  }

  /// Where the children's page is damaged the node stands for them.
  void go_into(std::uint64_t node, const Decision& d, const ParentDue& parent) {
    const auto children = cut_.tree_->nodes(TreeShape::first_child(node), shape_.child_count(node));
    if (children.empty()) return push(node, d, parent);
    const ParentDue mine = due_as_parent(d);
    for (std::size_t k = 0; k < children.size(); ++k)
      go_down(TreeShape::first_child(node) + k, children[k], mine);
  }

  ParentDue due_as_parent(const Decision& d) const {
    return {due(chunk_.motion.depth, d.slack.depth - rounding_.depth),
            silhouette() ? due(chunk_.motion.eye, d.slack.eye - rounding_.eye) : kNoParent.eye};
  }

  void push(std::uint64_t node, const Decision& d, const ParentDue& parent) {
    Entry e;
    e.node = static_cast<std::uint32_t>(node);
    e.state = static_cast<std::uint32_t>(d.state);
    e.depth = std::min(parent.depth, due(chunk_.motion.depth, d.slack.depth - rounding_.depth));
    e.side = due(chunk_.motion.side, d.slack.side - rounding_.side);
    e.eye = due(chunk_.motion.eye, d.slack.eye - rounding_.eye);
    if (silhouette()) e.eye = std::min(e.eye, parent.eye);
    chunk_.next.push_back(e);
  }
  static float due(double motion, double slack) {
    if (!(slack < kInfinity)) return std::numeric_limits<float>::infinity();
    const double at = motion + kSafety * std::max(0.0, slack);
    return static_cast<float>(at - std::abs(at) * 1e-6);
  }

  void finish(bool changed) {
    chunk_.front.swap(chunk_.next);
    chunk_.next.clear();
    chunk_.has_front = true;
    chunk_.changed = changed;
    if (!changed) return;
    list(State::point, chunk_.points);
    list(State::triangles, chunk_.leaves);
    for (std::uint32_t& leaf : chunk_.leaves) leaf = static_cast<std::uint32_t>(shape_.leaf_rank(leaf));
  }

  void list(State state, std::vector<std::uint32_t>& nodes) const {
    nodes.resize(chunk_.front.size());
    std::size_t count = 0;
    for (const Entry& e : chunk_.front) {
      nodes[count] = e.node;
      count += static_cast<State>(e.state) == state;
    }
    nodes.resize(count);
  }

  const PointCut& cut_;
  const TreeShape& shape_;
  Chunk& chunk_;
  Slack rounding_;
  std::uint64_t parent_ = ~std::uint64_t{0};  ///< the last parent that was looked at
  Decision parent_decision_{};
};

/// Above the chunks every frame walks anew. A node that is drawn there has a chunk of its own behind the
/// others.
void PointCut::walk_top(std::uint64_t node, const Hidden& hidden, std::vector<std::size_t>& active) {
  if (node >= first_chunk_) {
    if (hidden && hidden(node_at(node))) return;
    const auto chunk = static_cast<std::size_t>(node - first_chunk_);
    active.push_back(chunk);
    segments_.push_back({chunk});
    return;
  }
  ++visited_;
  const Decision d = decide(node_at(node), tree_->shape().is_leaf(node));
  if (!d.open && d.state == State::culled) return;
  if (hidden && hidden(node_at(node))) return;
  if (d.open) {
    for (std::uint64_t k = 0; k < tree_->shape().child_count(node); ++k)
      walk_top(TreeShape::first_child(node) + k, hidden, active);
    return;
  }
  Chunk single;
  single.root = node;
  if (d.state == State::point)
    single.points.push_back(static_cast<std::uint32_t>(node));
  else
    single.leaves.push_back(static_cast<std::uint32_t>(tree_->shape().leaf_rank(node)));
  segments_.push_back({chunks_.size()});
  chunks_.push_back(std::move(single));
}

/// Chunks that were not walked lately keep up too.
void PointCut::add_motion(const CutView& last) {
  const double eye = distance(view_.eye, last.eye), depth_scale = length(view_.depth.n);
  const double stretch = std::abs(depth_scale - length(last.depth.n));
  const PlaneChange depth(view_.depth, last.depth);
  const std::array sides{
      PlaneChange(view_.sides[0], last.sides[0]), PlaneChange(view_.sides[1], last.sides[1]),
      PlaneChange(view_.sides[2], last.sides[2]), PlaneChange(view_.sides[3], last.sides[3])};
  const double most = kMostMotion * kLargestGridCoordinate;
  for (std::size_t i = 0; i < chunk_count_; ++i) {
    Chunk& chunk = chunks_[i];
    if (!chunk.has_front) continue;
    const EncodedNode root = node_at(chunk.root);
    const Vec3 c = node_center(root);
    const double r = node_radius(root);
    chunk.motion.depth += depth.within(c, r) + r * stretch;
    double side = 0;
    for (const PlaneChange& plane : sides) side = std::max(side, plane.within(c, r));
    chunk.motion.side += side;
    chunk.motion.eye += eye;
    if (chunk.motion.side > most || chunk.motion.eye > most ||
        chunk.motion.depth > most * std::max(depth_scale, 1e-300))
      chunk.has_front = false;
  }
}

void PointCut::update(const CutView& view, bool coherent, const Hidden& hidden) {
  const CutView last = view_;
  view_ = view;
  const bool comparable = has_view_ && coherent && last.perspective == view.perspective &&
                          last.cull_turned_away == view.cull_turned_away &&
                          last.pixels_per_step == view.pixels_per_step && same(last.options, view.options);
  has_view_ = true;
  if (comparable)
    add_motion(last);
  else
    for (std::size_t i = 0; i < chunk_count_; ++i) chunks_[i].has_front = false;

  chunks_.resize(chunk_count_);
  last_segments_.swap(segments_);
  segments_.clear();
  visited_ = 0;
  std::vector<std::size_t> active;
  walk_top(0, hidden, active);
  const auto run = [&](std::size_t i) {
    Chunk& chunk = chunks_[active[i]];
    chunk.visited = 0;
    if (chunk.has_front)
      Walk(*this, chunk).coherent();
    else
      Walk(*this, chunk).fresh();
  };
  parallel_for(active.size(), run, kChunksAtOnce);

  point_count_ = leaf_count_ = 0;
  changed_ = !comparable || segments_.size() != last_segments_.size() ||
             !std::equal(segments_.begin(), segments_.end(), last_segments_.begin(),
                         [](const Segment& a, const Segment& b) { return a.chunk == b.chunk; });
  for (const std::size_t i : active)
    visited_ += chunks_[i].visited, changed_ = changed_ || chunks_[i].changed;
  for (const Segment& s : segments_) {
    changed_ = changed_ || s.chunk >= chunk_count_;
    point_count_ += chunks_[s.chunk].points.size(), leaf_count_ += chunks_[s.chunk].leaves.size();
  }
}

}  // namespace dupin
